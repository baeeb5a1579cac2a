//! Where another path crosses, and how to go on along that one.

use super::bordered::{Row, dot};
use super::corrector::Point;
use super::length::length;
use super::report::PathPoint;
use super::stepper::PathStepper;
use crate::large::LargeError;
use crate::math::rounding::SHARE;

/// A crossing is found when its bracket is this small beside the increment that has passed it.
const NEAR: f64 = SHARE;

/// Where a bracket is smaller than that, what has been found is a crossing though its neighbourhood has no tangent to rounding: of a column
/// of two hundred times its thickness, that is a thousandth of the increment.
const ROUGHLY: f64 = 1e-2;

/// Where in a bracket is looked, in turn, for a place that has a tangent (-).
const PLACES: [f64; 5] = [0.5, 0.25, 0.75, 0.125, 0.875];

/// A point where another path crosses, such as the critical load of a column.
#[derive(Clone, Debug, PartialEq)]
pub struct BranchPoint {
    /// The load factor there (-).
    pub factor: f64,
    /// Where the nodes are there (m).
    pub positions: Vec<f64>,
    /// How they move as the other path begins (-); the longest way along an axis is one.
    pub mode: Vec<f64>,
}

impl PathStepper {
    /// Goes on until the body changes its stability between limit points, and stands where it does: another path crosses there.
    ///
    /// Paths cross where body, mesh and load have a symmetry. Triangles that lean one way are an imperfection, as a shape that is not quite straight: the path then
    /// turns into the other one, and long increments that leap over that turn are told as [`LargeError::Turn`].
    ///
    /// ```
    /// use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
    /// use foil2d::fe::material::hyperelastic::Corotated;
    /// use foil2d::fe::mesh::{CellKind, generate::rectangle};
    /// use foil2d::large::{PathCase, PathSettings, PathStepper};
    ///
    /// // A straight column, clamped below, E h³/12 = 1 N m²: Euler's load is π²/4.
    /// let mesh = rectangle([0.02, 1.0], [1, 30], CellKind::Quad8)?;
    /// let law = Corotated::plane_strain(12.0 / 0.02f64.powi(3), 0.0);
    /// let model = FiniteStrainModel::assemble(FiniteStrainDescription::new(mesh, law, 1.0))?;
    /// let rest = model.rest_positions().to_vec();
    /// let is_held = rest.chunks_exact(2).flat_map(|x| [x[1] == 0.0; 2]).collect();
    /// let mut load = vec![0.0; rest.len()];
    /// for (node, x) in rest.chunks_exact(2).enumerate().filter(|(_, x)| x[1] == 1.0) {
    ///     load[2 * node + 1] = if x[0] == 0.01 { -4.0 / 6.0 } else { -1.0 / 6.0 };
    /// }
    ///
    /// let case = PathCase::dead(load, is_held, &rest);
    /// let mut path = PathStepper::new(model, case, &rest, PathSettings::default())?;
    /// let branch = path.follow_to_branch()?;
    /// assert!((branch.factor / (std::f64::consts::PI.powi(2) / 4.0) - 1.0).abs() < 1e-3);
    /// let bent = path.switch(&branch, 0.05)?;
    /// assert!(bent.is_stable && bent.factor > branch.factor);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As of [`advance`](Self::advance); [`LargeError::Unreached`] if no path crosses in as many increments as allowed. The path then is where
    /// the last increment has brought it.
    pub fn follow_to_branch(&mut self) -> Result<BranchPoint, LargeError> {
        for _ in 0..self.settings.max_increments {
            let before = self.clone();
            self.advance()?;
            let is_same = before.is_stable == self.is_stable
                || before.limit_points.len() != self.limit_points.len();
            if is_same {
                continue;
            }
            let row = before.normal();
            let way = difference(&self.point.positions, &before.point.positions);
            // The tangent of the path before goes on through a crossing.
            let (tangent, was_stable) = (before.tangent.clone(), before.is_stable);
            let point = before.find_crossing(dot(&row.positions, &way))?;
            let mode = self.corrector.mode(&point)?;
            self.move_to(point.clone(), tangent, was_stable)?;
            return Ok(BranchPoint {
                factor: point.factor,
                positions: point.positions,
                mode,
            });
        }
        Err(LargeError::Unreached {
            n_increments: self.settings.max_increments,
            factor: self.point.factor,
        })
    }

    /// Bisects an increment of this length by the stability of its ends.
    fn find_crossing(mut self, whole: f64) -> Result<Point, LargeError> {
        let (mut low, mut high) = (0.0, whole);
        let mut best = self.attempt(whole)?.point;
        while high - low > NEAR * whole {
            let mut look = |place: f64| {
                let at = low + place * (high - low);
                self.attempt(at).map(|reached| (at, reached))
            };
            let mut found = look(PLACES[0]);
            for place in &PLACES[1..] {
                found = found.or_else(|first| look(*place).map_err(|_| first));
            }
            let (at, reached) = match found {
                Ok(found) => found,
                // So near that the tangent has no digits left.
                Err(_) if high - low <= ROUGHLY * whole => break,
                Err(error) => return Err(error),
            };
            if reached.is_stable == self.is_stable {
                low = at;
            } else {
                high = at;
            }
            best = reached.point;
        }
        Ok(best)
    }

    /// Leaves the path for the one that crosses it, by a deflection of this size (m) along the mode, and stands there; another sign leads to its
    /// other half.
    ///
    /// # Errors
    /// If no equilibrium is found there; the path then is where it was. A larger deflection may do, where both paths are still near each other.
    ///
    /// # Panics
    /// If the branch is of another body.
    pub fn switch(
        &mut self,
        branch: &BranchPoint,
        deflection: f64,
    ) -> Result<PathPoint, LargeError> {
        if !(deflection != 0.0 && deflection.is_finite()) {
            return Err(LargeError::Setting {
                name: "the deflection",
                value: deflection,
                range: "the numbers but 0",
            });
        }
        let before = self.clone();
        let outcome = self.leave(branch, deflection);
        if outcome.is_err() {
            *self = before;
            self.come_back()?;
        }
        outcome
    }

    fn leave(&mut self, branch: &BranchPoint, deflection: f64) -> Result<PathPoint, LargeError> {
        let scale = deflection.signum() / length(&self.weights, &branch.mode);
        let along: Vec<f64> = branch.mode.iter().map(|x| scale * x).collect();
        let pairs = branch.positions.iter().zip(&branch.mode);
        let mut point = Point {
            positions: pairs.map(|(x, mode)| x + deflection * mode).collect(),
            factor: branch.factor,
        };
        self.tangent = (along, 0.0);
        let row: Row = self.normal();
        self.corrector.correct(&row, &mut point)?;
        let (tangent, is_stable) = self.tangent_at(&point)?;
        let way = difference(&point.positions, &branch.positions);
        self.length = length(&self.weights, &way).min(self.settings.longest);
        self.move_to(point, tangent, is_stable)?;
        Ok(self.point())
    }
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}
