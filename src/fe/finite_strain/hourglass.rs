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
use super::point::{Form, middle};
use crate::fe::element::{Element, ElementError};
use crate::fe::material::Material;
use crate::math::{LANES, Number, Wide};

/// The signs of the corners in a mode.
pub(super) const PATTERN: [f64; 4] = [1.0, -1.0, 1.0, -1.0];

/// The modes of one cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hourglass<T = f64> {
    /// `γ` (-).
    shape: [T; 4],
    /// `k` (N/m).
    isotropic: T,
    /// `K` as `[xx, yy, xy]` (N/m).
    stiffness: [T; 3],
}

/// A cell on its way: the mean gradient and the amplitudes `q` (m).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shape<T = f64> {
    pub gradient: [T; 4],
    pub amplitude: [T; 2],
    /// What of `c` has flowed (m).
    pub flowed: [T; 2],
}

impl<T: Number> Shape<T> {
    #[inline(always)]
    fn middle(self, other: Self) -> Self {
        Self {
            gradient: middle(self.gradient, other.gradient),
            amplitude: mean(self.amplitude, other.amplitude),
            flowed: self.flowed,
        }
    }

    /// `c = Fᵀ q`, less what has flowed (m).
    #[inline(always)]
    fn pulled(&self) -> [T; 2] {
        let ([xx, xy, yx, yy], [x, y]) = (self.gradient, self.amplitude);
        let [along, across] = self.flowed;
        [xx * x + yx * y - along, xy * x + yy * y - across]
    }

    /// `∂c_i/∂x_a` for the gradient of the shape function of node `a` and its share of the mode: rows `i`, columns x, y.
    #[inline(always)]
    fn slope(&self, [by_x, by_y]: [T; 2], share: T) -> [[T; 2]; 2] {
        let ([xx, xy, yx, yy], [x, y]) = (self.gradient, self.amplitude);
        [
            [by_x * x + share * xx, by_x * y + share * yx],
            [by_y * x + share * xy, by_y * y + share * yy],
        ]
    }
}

impl Shape {
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
}

/// The mean of two pairs.
#[inline(always)]
fn mean<T: Number>(one: [T; 2], other: [T; 2]) -> [T; 2] {
    [(one[0] + other[0]) * 0.5, (one[1] + other[1]) * 0.5]
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

    /// Stored energy (J).
    pub fn energy(&self, at: &Shape) -> f64 {
        let pulled = at.pulled();
        let force = self.answer(self.isotropic, pulled);
        let [x, y] = at.amplitude;
        0.5 * (self.isotropic * (x * x + y * y) + force[0] * pulled[0] + force[1] * pulled[1])
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
        let isotropic = if grows_only { 0.0 } else { self.isotropic };
        let along = (form, scale, gradients);
        self.add_rising(rising, along, (&at, stress, isotropic), blocks);
        if !grows_only {
            return;
        }
        let along = [x * x, x * y, x * y, y * y].map(|part| self.isotropic * part / length);
        for b in 0..4 {
            for (a, row) in blocks.iter_mut().enumerate().take(b + 1) {
                for (entry, along) in row[b].iter_mut().zip(along) {
                    *entry += scale * self.shape[a] * self.shape[b] * along;
                }
            }
        }
    }
}

impl<T: Number> Hourglass<T> {
    /// The amplitudes of the modes (m), of positions relative to any one.
    #[inline(always)]
    pub fn amplitude(&self, positions: &[[T; 2]]) -> [T; 2] {
        let mut sum = [T::ZERO; 2];
        for (&share, &[x, y]) in self.shape.iter().zip(positions) {
            sum[0] += share * x;
            sum[1] += share * y;
        }
        sum
    }

    /// `K a - k a`, or `K a` with `k` zero.
    #[inline(always)]
    fn answer(&self, isotropic: T, [x, y]: [T; 2]) -> [T; 2] {
        let [xx, yy, xy] = self.stiffness;
        [(xx - isotropic) * x + xy * y, xy * x + (yy - isotropic) * y]
    }

    /// Where the derivatives are taken, what acts along them, and how much of the end is in the first.
    #[inline(always)]
    fn stress(&self, form: Form, start: &Shape<T>, end: &Shape<T>) -> (Shape<T>, [T; 2], f64) {
        match form {
            Form::Equilibrium => (*end, self.answer(self.isotropic, end.pulled()), 1.0),
            Form::EnergyMomentum { decay } => {
                let (before, after) = (start.pulled(), end.pulled());
                let lasting = self.answer(self.isotropic, mean(before, after));
                let change = [after[0] - before[0], after[1] - before[1]];
                let decaying = self.answer(T::ZERO, change);
                let sum = |k: usize| lasting[k] + decaying[k] * (0.5 * decay);
                (start.middle(*end), [sum(0), sum(1)], 0.5)
            }
        }
    }

    /// Adds the forces on the nodes (N).
    #[inline(always)]
    pub fn add_force(
        &self,
        form: Form,
        gradients: &[[T; 2]],
        (start, end): (&Shape<T>, &Shape<T>),
        force: &mut [[T; 2]],
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

    /// Adds the consistent tangent to the blocks `a <= b`.
    #[inline(always)]
    pub fn add_consistent_tangent<const N: usize>(
        &self,
        form: Form,
        gradients: &[[T; 2]; N],
        (start, end): (&Shape<T>, &Shape<T>),
        blocks: &mut [[[T; 4]; N]; N],
    ) {
        let (at, stress, scale) = self.stress(form, start, end);
        let along = (form, scale, gradients);
        self.add_rising(self, along, (&at, stress, self.isotropic), blocks);
    }

    /// Adds what the stress `S` along the derivatives and its rise make of the tangent.
    ///
    /// - `rising`: what the stress rises as.
    /// - `isotropic`: `k` as far as turns of the amplitude are resisted (N/m).
    #[inline(always)]
    fn add_rising<const N: usize>(
        &self,
        rising: &Self,
        (form, scale, gradients): (Form, f64, &[[T; 2]; N]),
        (at, stress, isotropic): (&Shape<T>, [T; 2], T),
        blocks: &mut [[[T; 4]; N]; N],
    ) {
        let decay = match form {
            Form::Equilibrium => 0.0,
            Form::EnergyMomentum { decay } => decay,
        };
        // What the stress rises by as `c` does: one half of the conserving part is of the end, and half the decay.
        let rise = |column: [T; 2]| {
            let lasting = rising.answer(self.isotropic, column);
            let decaying = self.answer(T::ZERO, column);
            let sum = |k: usize| lasting[k] * scale + decaying[k] * (0.5 * decay);
            [sum(0), sum(1)]
        };
        for b in 0..N.min(4) {
            let slope = at.slope(gradients[b], self.shape[b]);
            let risen = [
                rise([slope[0][0], slope[1][0]]),
                rise([slope[0][1], slope[1][1]]),
            ];
            for (a, row) in blocks.iter_mut().enumerate().take(b + 1) {
                let own = at.slope(gradients[a], self.shape[a]);
                // The second derivative of `c_i` is the same for both axes.
                let bend =
                    |i: usize| gradients[a][i] * self.shape[b] + self.shape[a] * gradients[b][i];
                let spherical = (isotropic * self.shape[a] * self.shape[b]
                    + stress[0] * bend(0)
                    + stress[1] * bend(1))
                    * scale;
                let block = &mut row[b];
                for (place, entry) in block.iter_mut().enumerate() {
                    let (of, by) = (place / 2, place % 2);
                    *entry += own[0][of] * risen[by][0] + own[1][of] * risen[by][1];
                }
                block[0] += spherical;
                block[3] += spherical;
            }
        }
    }
}

impl Hourglass<Wide> {
    /// The modes of cells side by side.
    pub fn side_by_side(of: [&Hourglass; LANES]) -> Self {
        let lanes = |part: &dyn Fn(&Hourglass) -> f64| Wide::from_fn(|lane| part(of[lane]));
        Self {
            shape: std::array::from_fn(|a| lanes(&|one| one.shape[a])),
            isotropic: lanes(&|one| one.isotropic),
            stiffness: std::array::from_fn(|k| lanes(&|one| one.stiffness[k])),
        }
    }
}
