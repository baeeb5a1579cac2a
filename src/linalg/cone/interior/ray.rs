//! The rays that the force of a row is a sum over.

/// One ray of a force, with its bounds and their slacks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ray {
    /// `+1`, `-1`, or 0 on rows of one component.
    pub sign: f64,
    pub bounds: [f64; 2],
    pub force: f64,
    /// At the lower and the upper bound; zero where that is infinite.
    pub slack: [f64; 2],
    /// `w + mu sigma ± mu w_t - y_low + y_high`.
    pub gap: f64,
    pub change: f64,
    pub slack_change: [f64; 2],
    /// What each product `y z` should become less by.
    pub target: [f64; 2],
}

/// The rays of one row.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pair {
    pub n_rays: usize,
    pub rays: [Ray; 2],
    /// `(C + Θ)⁻¹`, `[00, 01, 11]`.
    pub stiffness: [f64; 3],
}

impl Default for Ray {
    /// A ray without bounds and force.
    fn default() -> Self {
        Self {
            sign: 0.0,
            bounds: [f64::NEG_INFINITY, f64::INFINITY],
            force: 0.0,
            slack: [0.0; 2],
            gap: 0.0,
            change: 0.0,
            slack_change: [0.0; 2],
            target: [0.0; 2],
        }
    }
}

impl Ray {
    pub fn has_bound(&self, side: usize) -> bool {
        self.bounds[side].is_finite()
    }

    /// The distance of the force from a bound.
    pub fn room(&self, side: usize) -> f64 {
        if side == 0 {
            self.force - self.bounds[0]
        } else {
            self.bounds[1] - self.force
        }
    }

    pub fn product(&self) -> f64 {
        (0..2)
            .filter(|&side| self.has_bound(side))
            .map(|side| self.slack[side] * self.room(side))
            .sum()
    }

    pub fn room_change(&self, side: usize) -> f64 {
        if side == 0 { self.change } else { -self.change }
    }

    /// What the slacks add to the diagonal and to the right-hand side.
    pub fn eliminated(&self) -> (f64, f64) {
        let (mut diagonal, mut right) = (0.0, self.gap);
        for side in (0..2).filter(|&side| self.has_bound(side)) {
            diagonal += self.slack[side] / self.room(side);
            right += [1.0, -1.0][side] * self.target[side] / self.room(side);
        }
        (diagonal, right)
    }
}

impl Pair {
    pub fn force(&self, mu: f64) -> Option<[f64; 2]> {
        (self.n_rays > 0).then(|| self.combine(mu, self.rays.map(|ray| ray.force)))
    }

    pub fn combine(&self, mu: f64, along: [f64; 2]) -> [f64; 2] {
        let mut force = [0.0; 2];
        for (ray, along) in self.rays[..self.n_rays].iter().zip(along) {
            force[0] += along;
            force[1] += ray.sign * mu * along;
        }
        force
    }

    pub fn stiffen(&self, right: [f64; 2]) -> [f64; 2] {
        let [first, cross, second] = self.stiffness;
        [
            first * right[0] + cross * right[1],
            cross * right[0] + second * right[1],
        ]
    }
}
