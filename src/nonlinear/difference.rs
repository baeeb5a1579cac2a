//! Tangents by central differences: `∂Q_i/∂x_j = (Q_i(x_j + h) - Q_i(x_j - h)) / 2h`.

use super::force::InternalForce;

/// The cube root of the rounding: the error of truncation and of rounding, `h²` and `ε/h`, are then alike.
const RELATIVE_STEP: f64 = 6.055e-6;

/// Vectors of the differences.
#[derive(Clone, Debug, Default)]
pub(super) struct Differences {
    point: [Vec<f64>; 2],
    above: Vec<f64>,
    below: Vec<f64>,
}

impl Differences {
    pub(super) fn new(n_dofs: usize) -> Self {
        let zeros = vec![0.0; n_dofs];
        Self {
            point: [zeros.clone(), zeros.clone()],
            above: zeros.clone(),
            below: zeros,
        }
    }

    /// Writes `∂Q/∂x` and `∂Q/∂ẋ`, row-major, and returns the number of evaluations.
    ///
    /// The differences are taken over lengths and speeds of the motion itself, for which `dt` turns one into the other: a
    /// law that changes over shorter ones needs a tangent of its own.
    pub(super) fn tangent(
        &mut self,
        law: &(impl InternalForce + ?Sized),
        motion: [&[f64]; 2],
        dt: f64,
        tangents: [&mut [f64]; 2],
    ) -> usize {
        let n_dofs = motion[0].len();
        let largest = |values: &[f64]| values.iter().fold(0.0, |most, v| f64::max(most, v.abs()));
        let length = largest(motion[0]).max(dt * largest(motion[1]));
        // At rest in the origin there is nothing to compare with.
        let length = if length > 0.0 { length } else { 1.0 };
        for (kind, (tangent, scale)) in tangents.into_iter().zip([length, length / dt]).enumerate()
        {
            self.point[0].copy_from_slice(motion[0]);
            self.point[1].copy_from_slice(motion[1]);
            for column in 0..n_dofs {
                let centre = motion[kind][column];
                let [up, down] = [1.0, -1.0].map(|sign| centre + sign * RELATIVE_STEP * scale);
                self.point[kind][column] = up;
                law.force(&self.point[0], &self.point[1], &mut self.above);
                self.point[kind][column] = down;
                law.force(&self.point[0], &self.point[1], &mut self.below);
                self.point[kind][column] = centre;
                // As rounded, not as meant.
                let distance = up - down;
                for (row, (above, below)) in self.above.iter().zip(&self.below).enumerate() {
                    tangent[row * n_dofs + column] = (above - below) / distance;
                }
            }
        }
        4 * n_dofs
    }
}
