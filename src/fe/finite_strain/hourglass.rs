//! What four-node cells resist bending with: their gradient of deformation is the mean one, and their two hourglass modes have a stiffness
//! of their own, that of the QM6 element at rest.
//!
//! With the shape `γ` that sees no linear motion (Flanagan, Belytschko 1981) and the mean gradient `F`,
//!
//! ```text
//! q = Σ γ_a x_a,    c = Fᵀ q,    W = A t w(F) + k/2 q·q + 1/2 c·(K - k I) c
//! ```
//!
//! `K` is what the QM6 element answers the modes with (N/m), 2 × 2, and `k` its smaller eigenvalue. Neither `q·q` nor `c` knows of rotations, and
//! both are quadratic in the positions: their mean over a step times their derivative in its middle conserves energy and angular
//! momentum. On parallelograms the cell at rest *is* the QM6 element, which bends without locking; under pressure along its sides the part
//! `k` stays.

use super::linearization::Linearization;
use super::point::Form;
use crate::fe::element::{Element, ElementError};
use crate::fe::material::Material;

/// The signs of the corners in a mode.
pub(super) const PATTERN: [f64; 4] = [1.0, -1.0, 1.0, -1.0];

/// The modes of one cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hourglass {
    /// `γ` (-).
    shape: [f64; 4],
    /// `k` (N/m).
    isotropic: f64,
    /// `K` as `[xx, yy, xy]` (N/m).
    stiffness: [f64; 3],
}

/// A cell on its way: the mean gradient and the amplitudes `q` (m).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shape {
    pub gradient: [f64; 4],
    pub amplitude: [f64; 2],
    /// What of `c` has flowed (m).
    pub flowed: [f64; 2],
}

impl Shape {
    fn middle(self, other: Self) -> Self {
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        Self {
            gradient: std::array::from_fn(|k| mean(self.gradient[k], other.gradient[k])),
            amplitude: std::array::from_fn(|k| mean(self.amplitude[k], other.amplitude[k])),
            flowed: self.flowed,
        }
    }

    /// `c = Fᵀ q`, less what has flowed (m).
    fn pulled(&self) -> [f64; 2] {
        let ([xx, xy, yx, yy], [x, y]) = (self.gradient, self.amplitude);
        let [along, across] = self.flowed;
        [xx * x + yx * y - along, xy * x + yy * y - across]
    }

    /// What must have flowed for `c` to be what is left of the one of another shape after that has.
    pub fn moved_to(&self, other: &Self, flowed: [f64; 2]) -> [f64; 2] {
        let (own, left) = (
            Self {
                flowed: [0.0; 2],
                ..*self
            },
            Self { flowed, ..*other },
        );
        let (own, left) = (own.pulled(), left.pulled());
        std::array::from_fn(|k| own[k] - left[k])
    }

    /// `∂c_i/∂x_a` for the gradient of the shape function of node `a` and its share of the mode: rows `i`, columns x, y.
    fn slope(&self, [by_x, by_y]: [f64; 2], share: f64) -> [[f64; 2]; 2] {
        let ([xx, xy, yx, yy], [x, y]) = (self.gradient, self.amplitude);
        [
            [by_x * x + share * xx, by_x * y + share * yx],
            [by_y * x + share * xy, by_y * y + share * yy],
        ]
    }
}

impl Hourglass {
    /// The modes of a cell with these corners (m) and gradients of the shape functions at its centre (1/m).
    pub fn new(
        element: &dyn Element,
        corners: &[[f64; 2]],
        gradients: &[[f64; 2]],
        material: &dyn Material,
        thickness: f64,
    ) -> Result<Self, ElementError> {
        let along = |axis: usize| -> f64 {
            let pairs = PATTERN.iter().zip(corners);
            pairs.map(|(sign, corner)| sign * corner[axis]).sum()
        };
        let (x, y) = (along(0), along(1));
        let shape = std::array::from_fn(|a| {
            0.25 * (PATTERN[a] - x * gradients[a][0] - y * gradients[a][1])
        });
        let mut stiffness = [0.0; 64];
        element.stiffness(corners, material, thickness, &mut stiffness)?;
        let answer = |row: usize, column: usize| -> f64 {
            let entries = (0..4).flat_map(|a| (0..4).map(move |b| (a, b)));
            entries
                .map(|(a, b)| {
                    PATTERN[a] * PATTERN[b] * stiffness[8 * (2 * a + row) + 2 * b + column]
                })
                .sum()
        };
        let [xx, yy, xy] = [answer(0, 0), answer(1, 1), answer(0, 1)];
        let half = 0.5 * (xx - yy);
        let radius = (half * half + xy * xy).sqrt();
        Ok(Self {
            shape,
            isotropic: 0.5 * (xx + yy) - radius,
            stiffness: [xx, yy, xy],
        })
    }

    /// The amplitudes of the modes (m), of positions relative to any one.
    pub fn amplitude(&self, positions: &[[f64; 2]; 4]) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (share, [x, y]) in self.shape.iter().zip(positions) {
            sum[0] += share * x;
            sum[1] += share * y;
        }
        sum
    }

    /// `K a - k a`, or `K a` with `k` zero.
    fn answer(&self, isotropic: f64, [x, y]: [f64; 2]) -> [f64; 2] {
        let [xx, yy, xy] = self.stiffness;
        [(xx - isotropic) * x + xy * y, xy * x + (yy - isotropic) * y]
    }

    /// Stored energy (J).
    pub fn energy(&self, at: &Shape) -> f64 {
        let pulled = at.pulled();
        let force = self.answer(self.isotropic, pulled);
        let [x, y] = at.amplitude;
        0.5 * (self.isotropic * (x * x + y * y) + force[0] * pulled[0] + force[1] * pulled[1])
    }

    /// Where the derivatives are taken, what acts along them, and how much of the end is in the first.
    fn stress(&self, form: Form, start: &Shape, end: &Shape) -> (Shape, [f64; 2], f64) {
        match form {
            Form::Equilibrium => (*end, self.answer(self.isotropic, end.pulled()), 1.0),
            Form::EnergyMomentum { decay } => {
                let [before, after] = [start.pulled(), end.pulled()];
                let mean = std::array::from_fn(|k| 0.5 * (before[k] + after[k]));
                let change = std::array::from_fn(|k| after[k] - before[k]);
                let lasting = self.answer(self.isotropic, mean);
                let decaying = self.answer(0.0, change);
                let sum = std::array::from_fn(|k| lasting[k] + 0.5 * decay * decaying[k]);
                (start.middle(*end), sum, 0.5)
            }
        }
    }

    /// Adds the forces on the nodes (N).
    pub fn add_force(
        &self,
        form: Form,
        gradients: &[[f64; 2]; 4],
        (start, end): (&Shape, &Shape),
        force: &mut [[f64; 2]; 4],
    ) {
        let (at, [first, second], _) = self.stress(form, start, end);
        for ((force, gradient), share) in force.iter_mut().zip(gradients).zip(self.shape) {
            let [of_first, of_second] = at.slope(*gradient, share);
            for axis in 0..2 {
                force[axis] += self.isotropic * share * at.amplitude[axis]
                    + first * of_first[axis]
                    + second * of_second[axis];
            }
        }
    }

    /// `u = c·K c` (J).
    fn squared(&self, pulled: [f64; 2]) -> f64 {
        let [x, y] = self.answer(0.0, pulled);
        x * pulled[0] + y * pulled[1]
    }

    /// Modes that flow where `√u` reaches `g`: stored and dissipated energy (J), and what of `c` has flowed then, of a trial shape at the end.
    ///
    /// All of the stiffness is `K` then, and `c` is that of the elastic gradient, which a body that flows never loses.
    pub fn flow(&self, limit: f64, at: &Shape) -> ([f64; 2], [f64; 2]) {
        let pulled = at.pulled();
        let size = self.squared(pulled).sqrt();
        if size <= limit {
            return ([0.5 * size * size, 0.0], at.flowed);
        }
        let share = 1.0 - limit / size;
        let flowed = std::array::from_fn(|k| at.flowed[k] + share * pulled[k]);
        ([0.5 * limit * limit, limit * (size - limit)], flowed)
    }

    /// Brings the modes of a shape to a limit: the energy that they lose (J), and what of `c` has flowed then.
    pub fn ease(&self, limit: f64, at: &Shape) -> (f64, [f64; 2]) {
        let pulled = at.pulled();
        let size = self.squared(pulled).sqrt();
        if size <= limit {
            return (0.0, at.flowed);
        }
        let share = 1.0 - limit / size;
        let flowed = std::array::from_fn(|k| at.flowed[k] + share * pulled[k]);
        (0.5 * (size * size - limit * limit), flowed)
    }

    /// What answers as such modes do between two shapes: with the secant of their incremental potential `φ = u/2`, or `g √u - g²/2` where
    /// `√u > g`, by which forces do its work; and with its tangent.
    pub fn flowing(&self, form: Form, limit: f64, [start, end]: [&Shape; 2]) -> [Self; 2] {
        let after = self.squared(end.pulled());
        let size = after.sqrt();
        let own = Self {
            isotropic: 0.0,
            ..*self
        };
        if size <= limit {
            return [own, own];
        }
        let (secant, fall, at) = match form {
            Form::Equilibrium => (limit / size, limit / (size * after), *end),
            Form::EnergyMomentum { .. } => {
                let change = after - self.squared(start.pulled());
                // What begins beyond the limit does so by rounding.
                if change <= f64::EPSILON * after {
                    return [own, own];
                }
                let lost = (size - limit) * (size - limit) / change;
                let fall = 4.0 * (1.0 - lost - limit / size) / change;
                (1.0 - lost, fall.max(0.0), start.middle(*end))
            }
        };
        // The mean of what is pulled, not what the mean shape pulls.
        let pulled = match form {
            Form::Equilibrium => at.pulled(),
            Form::EnergyMomentum { .. } => {
                let [before, after] = [start.pulled(), end.pulled()];
                std::array::from_fn(|k| 0.5 * (before[k] + after[k]))
            }
        };
        let [x, y] = self.answer(0.0, pulled);
        let products = [x * x, y * y, x * y];
        let scaled = self.stiffness.map(|entry| secant * entry);
        let risen = std::array::from_fn(|k| scaled[k] - fall * products[k]);
        let with = |stiffness| Self { stiffness, ..own };
        [with(scaled), with(risen)]
    }

    /// Adds the tangent to the blocks `a <= b`.
    pub fn add_tangent(
        &self,
        of: (Form, Linearization),
        gradients: &[[f64; 2]; 4],
        pair: (&Shape, &Shape),
        blocks: &mut [[[f64; 4]; 4]; 4],
    ) {
        self.add_tangent_rising(self, of, gradients, pair, blocks);
    }

    /// The same where forces rise as those of another do.
    pub fn add_tangent_rising(
        &self,
        rising: &Self,
        (form, kind): (Form, Linearization),
        gradients: &[[f64; 2]; 4],
        (start, end): (&Shape, &Shape),
        blocks: &mut [[[f64; 4]; 4]; 4],
    ) {
        let (at, stress, scale) = self.stress(form, start, end);
        let stress = match kind {
            Linearization::Consistent => stress,
            Linearization::Definite | Linearization::Impulsive { .. } => [0.0; 2],
        };
        // The amplitude turns with the body: of an impulse only its growth is resisted.
        let [x, y] = at.amplitude;
        let length = x * x + y * y;
        let grows_only = matches!(kind, Linearization::Impulsive { .. }) && length > 0.0;
        let along = [x * x, x * y, x * y, y * y].map(|part| self.isotropic * part / length);
        let isotropic = if grows_only { 0.0 } else { self.isotropic };
        let decay = match form {
            Form::Equilibrium => 0.0,
            Form::EnergyMomentum { decay } => decay,
        };
        // What the stress rises by as `c` does: one half of the conserving part is of the end, and half the decay.
        let rise = |column: [f64; 2]| {
            let (lasting, decaying) = (
                rising.answer(self.isotropic, column),
                self.answer(0.0, column),
            );
            [0, 1].map(|k| scale * lasting[k] + 0.5 * decay * decaying[k])
        };
        for b in 0..4 {
            let slope = at.slope(gradients[b], self.shape[b]);
            let risen = [0, 1].map(|axis| rise([slope[0][axis], slope[1][axis]]));
            for (a, row) in blocks.iter_mut().enumerate().take(b + 1) {
                let own = at.slope(gradients[a], self.shape[a]);
                // The second derivative of `c_i` is the same for both axes.
                let bend =
                    |i: usize| gradients[a][i] * self.shape[b] + self.shape[a] * gradients[b][i];
                let spherical = scale
                    * (isotropic * self.shape[a] * self.shape[b]
                        + stress[0] * bend(0)
                        + stress[1] * bend(1));
                let block = &mut row[b];
                for (place, entry) in block.iter_mut().enumerate() {
                    let (of, by) = (place / 2, place % 2);
                    *entry += own[0][of] * risen[by][0] + own[1][of] * risen[by][1];
                    if grows_only {
                        *entry += scale * self.shape[a] * self.shape[b] * along[place];
                    }
                }
                block[0] += spherical;
                block[3] += spherical;
            }
        }
    }
}
