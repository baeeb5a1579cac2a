//! Force laws to begin with: `Q = k x + k3 x³` (Duffing's spring), `Q = c |ẋ| ẋ` (drag), and sums.

use super::force::{InternalForce, TangentSource};

/// A spring and a damper from every dof to its origin: `Q = k x + k3 x³ + c ẋ`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CubicSpring {
    /// `k` (N/m).
    pub linear: f64,
    /// `k3` (N/m³); negative for a softening spring.
    pub cubic: f64,
    /// `c` (N s/m).
    pub damping: f64,
}

impl InternalForce for CubicSpring {
    fn force(&self, position: &[f64], velocity: &[f64], force: &mut [f64]) {
        for ((force, x), v) in force.iter_mut().zip(position).zip(velocity) {
            *force = self.linear * x + self.cubic * x * x * x + self.damping * v;
        }
    }

    fn tangent(&self, x: &[f64], v: &[f64], k: &mut [f64], c: &mut [f64]) -> TangentSource {
        add_diagonal(k, x, |x| self.linear + 3.0 * self.cubic * x * x);
        add_diagonal(c, v, |_| self.damping);
        TangentSource::Supplied
    }
}

/// Drag that grows with the square of the speed of every dof, `Q = c |ẋ| ẋ`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct QuadraticDrag {
    /// `c` (N s²/m²).
    pub coefficient: f64,
}

impl InternalForce for QuadraticDrag {
    fn force(&self, _position: &[f64], velocity: &[f64], force: &mut [f64]) {
        for (force, v) in force.iter_mut().zip(velocity) {
            *force = self.coefficient * v.abs() * v;
        }
    }

    fn tangent(&self, _: &[f64], v: &[f64], _: &mut [f64], c: &mut [f64]) -> TangentSource {
        add_diagonal(c, v, |v| 2.0 * self.coefficient * v.abs());
        TangentSource::Supplied
    }
}

/// Adds a slope per dof to the diagonal of a tangent.
fn add_diagonal(tangent: &mut [f64], motion: &[f64], slope: impl Fn(f64) -> f64) {
    let stride = motion.len() + 1;
    for (entry, &at) in tangent.iter_mut().step_by(stride).zip(motion) {
        *entry += slope(at);
    }
}

/// Two forces that act together; its tangent is supplied if both supply theirs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sum<A, B>(pub A, pub B);

impl<A: InternalForce, B: InternalForce> InternalForce for Sum<A, B> {
    fn force(&self, position: &[f64], velocity: &[f64], force: &mut [f64]) {
        self.0.force(position, velocity, force);
        let mut other = vec![0.0; force.len()];
        self.1.force(position, velocity, &mut other);
        for (force, other) in force.iter_mut().zip(&other) {
            *force += other;
        }
    }

    fn tangent(&self, x: &[f64], v: &[f64], k: &mut [f64], c: &mut [f64]) -> TangentSource {
        let first = self.0.tangent(x, v, k, c);
        if first == TangentSource::FiniteDifferences {
            return first;
        }
        // A law may write instead of add: give the second one zeros of its own.
        let (mut other_k, mut other_c) = (vec![0.0; k.len()], vec![0.0; c.len()]);
        let second = self.1.tangent(x, v, &mut other_k, &mut other_c);
        let (own, other) = (k.iter_mut().chain(c), other_k.iter().chain(&other_c));
        for (own, other) in own.zip(other) {
            *own += other;
        }
        second
    }
}
