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

    fn tangent(
        &self,
        position: &[f64],
        _velocity: &[f64],
        stiffness: &mut [f64],
        damping: &mut [f64],
    ) -> TangentSource {
        let n_dofs = position.len();
        for (dof, x) in position.iter().enumerate() {
            stiffness[dof * (n_dofs + 1)] += self.linear + 3.0 * self.cubic * x * x;
            damping[dof * (n_dofs + 1)] += self.damping;
        }
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

    fn tangent(
        &self,
        position: &[f64],
        velocity: &[f64],
        _stiffness: &mut [f64],
        damping: &mut [f64],
    ) -> TangentSource {
        let n_dofs = position.len();
        for (dof, v) in velocity.iter().enumerate() {
            damping[dof * (n_dofs + 1)] += 2.0 * self.coefficient * v.abs();
        }
        TangentSource::Supplied
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

    fn tangent(
        &self,
        position: &[f64],
        velocity: &[f64],
        stiffness: &mut [f64],
        damping: &mut [f64],
    ) -> TangentSource {
        let first = self.0.tangent(position, velocity, stiffness, damping);
        if first == TangentSource::FiniteDifferences {
            return first;
        }
        // A law may write instead of add: give the second one zeros of its own.
        let size = stiffness.len();
        let (mut k, mut c) = (vec![0.0; size], vec![0.0; size]);
        let second = self.1.tangent(position, velocity, &mut k, &mut c);
        for (own, other) in stiffness
            .iter_mut()
            .zip(&k)
            .chain(damping.iter_mut().zip(&c))
        {
            *own += other;
        }
        second
    }
}
