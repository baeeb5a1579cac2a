//! Increments along a path, with its limit points and ends.

use super::bordered::{Row, dot};
use super::case::{PathCase, PathEnd, PathSettings};
use super::corrector::{Corrector, Point};
use super::length::{length, weights};
use super::report::{LimitPoint, PathPoint, PathReport};
use crate::fe::finite_strain::FiniteStrainModel;
use crate::large::LargeError;
use crate::large::stepper::require_finite;
use std::sync::Arc;

/// Iterations that an increment should take: fewer make the next one longer.
const FEW_ITERATIONS: f64 = 5.0;

/// Cosine between the tangents before and after an increment at least, some 37°: a sharper turn is another path, or a kink to be seen.
const LEAST_COSINE: f64 = 0.8;

/// A limit point is found when its bracket is this small beside the increment, or the load factor as flat beside the tangent before it.
const FLAT: f64 = 1e-7;

/// Points that are tried for it.
const MOST_TRIES: usize = 30;

/// Follows the equilibria of one body of large strain along a path of loads and places, past limit points and snaps.
///
/// ```
/// use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
/// use foil2d::fe::material::hyperelastic::Corotated;
/// use foil2d::fe::mesh::{CellKind, generate::rectangle};
/// use foil2d::large::{PathCase, PathEnd, PathSettings, PathStepper};
///
/// // A flat arch between hinges, pushed down in its middle until it has snapped through.
/// let mesh = rectangle([1.0, 0.02], [20, 1], CellKind::Tri6)?;
/// let mut description = FiniteStrainDescription::new(mesh, Corotated::plane_strain(1e6, 0.0), 1.0);
/// for p in description.rest_positions.chunks_exact_mut(2) {
///     p[1] += 0.16 * p[0] * (1.0 - p[0]);
/// }
/// let rest = description.rest_positions.clone();
/// let model = FiniteStrainModel::assemble(description)?;
/// let node = |x: f64, y: f64| {
///     let near = |p: &[f64]| (p[0] - x).hypot(p[1] - y) < 1e-9;
///     rest.chunks_exact(2).position(near).unwrap_or(0)
/// };
/// let (left, right, crown) = (node(0.0, 0.01), node(1.0, 0.01), node(0.5, 0.05));
/// let mut is_held = vec![false; rest.len()];
/// for dof in [2 * left, 2 * left + 1, 2 * right, 2 * right + 1, 2 * crown] {
///     is_held[dof] = true;
/// }
/// let mut load = vec![0.0; rest.len()];
/// load[2 * crown + 1] = -1.0;
///
/// let case = PathCase::dead(load, is_held, &rest);
/// let mut path = PathStepper::new(model, case, &rest, PathSettings::default())?;
/// path.follow(PathEnd::Place { dof: 2 * crown + 1, place: -0.02 })?;
/// let [up, down] = path.limit_points() else { panic!("two limit points") };
/// assert!(up.is_maximum && !down.is_maximum && down.factor < up.factor);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct PathStepper {
    pub(super) corrector: Corrector,
    pub(super) settings: PathSettings,
    /// Of every dof in the square of a length along the path (1/m²).
    pub(super) weights: Vec<f64>,
    pub(super) point: Point,
    /// Of length one along the path.
    pub(super) tangent: (Vec<f64>, f64),
    pub(super) is_stable: bool,
    /// Of the next increment (-).
    pub(super) length: f64,
    pub(super) limit_points: Vec<LimitPoint>,
    report: PathReport,
}

/// The end of an increment.
pub(super) struct Reached {
    pub(super) point: Point,
    tangent: (Vec<f64>, f64),
    pub(super) is_stable: bool,
    n_iterations: usize,
}

/// The beginning of an increment.
struct Before {
    point: Point,
    rate: f64,
    n_limit_points: usize,
}

impl PathStepper {
    /// A path that begins at `beginning` (m) with the load factor 0, where the body is in equilibrium with the loads there.
    ///
    /// # Errors
    /// If a list has the wrong length or a number that is not finite, a setting is out of its range, the tangent at the beginning is
    /// singular, or nothing moves with the load factor.
    pub fn new(
        model: impl Into<Arc<FiniteStrainModel>>,
        case: PathCase,
        beginning: &[f64],
        settings: PathSettings,
    ) -> Result<Self, LargeError> {
        let model = model.into();
        settings.check()?;
        case.check(&model)?;
        require_finite("the positions", beginning, model.n_dofs())?;
        let weights = weights(&model);
        let limits = [settings.tolerance, settings.max_iterations as f64];
        let mut corrector = Corrector::new(model, case, beginning, limits)?;
        let point = Point {
            positions: beginning.to_vec(),
            factor: 0.0,
        };
        let by_factor = Row {
            positions: vec![0.0; weights.len()],
            factor: 1.0,
        };
        let (along, rate, is_stable) = corrector.tangent(&by_factor, &point)?;
        if corrector.is_singular() {
            return Err(LargeError::Singular { factor: 0.0 });
        }
        let size = length(&weights, &along);
        if !(size > 0.0 && size.is_finite()) {
            return Err(LargeError::Still);
        }
        let scale = settings.first.signum() / size;
        Ok(Self {
            length: (settings.first.abs() * size).min(settings.longest),
            tangent: (along.iter().map(|x| scale * x).collect(), scale * rate),
            corrector,
            settings,
            weights,
            point,
            is_stable,
            limit_points: Vec::new(),
            report: PathReport::default(),
        })
    }

    /// Where the nodes are (m).
    pub fn positions(&self) -> &[f64] {
        &self.point.positions
    }

    /// Forces that hold the held dofs (N); zero at others.
    pub fn reaction(&self) -> &[f64] {
        &self.corrector.reaction
    }

    /// Limit points passed so far.
    pub fn limit_points(&self) -> &[LimitPoint] {
        &self.limit_points
    }

    /// What the path has taken so far.
    pub fn report(&self) -> PathReport {
        let work = self.corrector.work;
        PathReport {
            n_iterations: work.n_iterations,
            n_factorizations: work.n_factorizations,
            n_at_rounding: work.n_at_rounding,
            residual: work.residual,
            ..self.report
        }
    }

    /// The point reached last.
    pub fn point(&self) -> PathPoint {
        PathPoint {
            factor: self.point.factor,
            rate: self.tangent.1,
            is_stable: self.is_stable,
            n_limit_points: self.limit_points.len(),
        }
    }

    /// Goes on by one increment, whose length it chooses.
    ///
    /// # Errors
    /// Who stopped the shortest increment; the path then is where it was.
    pub fn advance(&mut self) -> Result<PathPoint, LargeError> {
        let shortest = self.length * 0.5_f64.powi(self.settings.max_cutbacks as i32);
        loop {
            match self.attempt(self.length) {
                Ok(reached) => {
                    if self.tangent.1 * reached.tangent.1 < 0.0 {
                        self.find_limit_point(&reached)?;
                    }
                    self.move_to(reached.point, reached.tangent, reached.is_stable)?;
                    let growth = (FEW_ITERATIONS / reached.n_iterations.max(1) as f64).sqrt();
                    let next = self.length * growth.clamp(0.5, 2.0);
                    self.length = next.min(self.settings.longest);
                    self.report.n_increments += 1;
                    return Ok(self.point());
                }
                Err(error) if 0.5 * self.length < shortest => {
                    self.come_back()?;
                    return Err(error);
                }
                Err(_) => {
                    self.report.n_cutbacks += 1;
                    self.length *= 0.5;
                }
            }
        }
    }

    /// Goes on until an end is reached, and there to the tolerance.
    ///
    /// # Errors
    /// As of [`advance`](Self::advance); [`LargeError::Unreached`], if the end is not found in as many increments as allowed. The path then
    /// is where the last increment has brought it.
    ///
    /// # Panics
    /// If the end names a dof that does not exist.
    pub fn follow(&mut self, end: PathEnd) -> Result<PathPoint, LargeError> {
        if end.ahead(&self.point.positions, self.point.factor) == 0.0 {
            return Ok(self.point());
        }
        for _ in 0..self.settings.max_increments {
            let before = Before {
                point: self.point.clone(),
                rate: self.tangent.1,
                n_limit_points: self.limit_points.len(),
            };
            let ahead = end.ahead(&self.point.positions, self.point.factor);
            self.advance()?;
            let left = end.ahead(&self.point.positions, self.point.factor);
            if ahead * left > 0.0 {
                continue;
            }
            if left == 0.0 {
                return Ok(self.point());
            }
            let found = self.go_back_to(&before, ahead / (ahead - left), end);
            if found.is_err() {
                self.come_back()?;
            }
            return found;
        }
        Err(LargeError::Unreached {
            n_increments: self.settings.max_increments,
            factor: self.point.factor,
        })
    }

    /// Takes the last increment back but for about a `share`, where an end is.
    fn go_back_to(
        &mut self,
        before: &Before,
        share: f64,
        end: PathEnd,
    ) -> Result<PathPoint, LargeError> {
        let towards = |a: f64, b: f64| a + share * (b - a);
        let pairs = before.point.positions.iter().zip(&self.point.positions);
        let mut point = Point {
            positions: pairs.map(|(a, b)| towards(*a, *b)).collect(),
            factor: towards(before.point.factor, self.point.factor),
        };
        let mut row = Row {
            positions: vec![0.0; self.weights.len()],
            factor: 0.0,
        };
        match end {
            PathEnd::Factor(factor) => {
                point.factor = factor;
                row.factor = 1.0;
            }
            PathEnd::Place { dof, place } => {
                point.positions[dof] = place;
                row.positions[dof] = 1.0;
            }
        }
        self.corrector.correct(&row, &mut point)?;
        let (tangent, is_stable) = self.tangent_at(&point)?;
        if before.rate * tangent.1 > 0.0 {
            // What the increment has passed is beyond the end.
            self.limit_points.truncate(before.n_limit_points);
        }
        self.move_to(point, tangent, is_stable)?;
        Ok(self.point())
    }

    /// The end of an increment of this length.
    pub(super) fn attempt(&mut self, length: f64) -> Result<Reached, LargeError> {
        let (along, rate) = &self.tangent;
        let pairs = self.point.positions.iter().zip(along);
        let mut point = Point {
            positions: pairs.map(|(x, along)| x + length * along).collect(),
            factor: self.point.factor + length * rate,
        };
        let row = self.normal();
        let n_iterations = self.corrector.correct(&row, &mut point)?;
        let (tangent, is_stable) = self.tangent_at(&point)?;
        let cosine = dot(&row.positions, &tangent.0);
        if cosine < LEAST_COSINE {
            return Err(LargeError::Turn {
                factor: point.factor,
                cosine,
            });
        }
        Ok(Reached {
            point,
            tangent,
            is_stable,
            n_iterations,
        })
    }

    /// The plane normal to the tangent.
    pub(super) fn normal(&self) -> Row {
        let pairs = self.tangent.0.iter().zip(&self.weights);
        Row {
            positions: pairs.map(|(along, weight)| along * weight).collect(),
            factor: 0.0,
        }
    }

    /// The tangent of length one at a point, on the side of the one here.
    pub(super) fn tangent_at(
        &mut self,
        point: &Point,
    ) -> Result<((Vec<f64>, f64), bool), LargeError> {
        let row = self.normal();
        let (mut along, rate, is_stable) = self.corrector.tangent(&row, point)?;
        let size = length(&self.weights, &along);
        if !(size > 0.0 && size.is_finite()) {
            return Err(LargeError::Singular {
                factor: point.factor,
            });
        }
        along.iter_mut().for_each(|x| *x /= size);
        Ok(((along, rate / size), is_stable))
    }

    /// Finds where the load factor turns on the increment that has reached `end`, by the regula falsi as in Illinois.
    fn find_limit_point(&mut self, end: &Reached) -> Result<(), LargeError> {
        let whole = self.length;
        let end_rate = end.tangent.1;
        let (mut low, mut high) = ((0.0, self.tangent.1), (whole, end_rate));
        let mut best = (end.point.clone(), end_rate);
        let flat = FLAT * self.tangent.1.abs().max(end_rate.abs());
        for _ in 0..MOST_TRIES {
            if best.1.abs() <= flat || high.0 - low.0 <= FLAT * whole {
                break;
            }
            let at = low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1);
            let Reached { point, tangent, .. } = self.attempt(at)?;
            let rate = tangent.1;
            if rate * low.1 > 0.0 {
                low = (at, rate);
                high.1 *= 0.5;
            } else {
                high = (at, rate);
                low.1 *= 0.5;
            }
            if rate.abs() < best.1.abs() {
                best = (point, rate);
            }
        }
        self.limit_points.push(LimitPoint {
            factor: best.0.factor,
            is_maximum: end_rate < 0.0,
            positions: best.0.positions,
        });
        Ok(())
    }

    pub(super) fn move_to(
        &mut self,
        point: Point,
        tangent: (Vec<f64>, f64),
        is_stable: bool,
    ) -> Result<(), LargeError> {
        self.point = point;
        self.tangent = tangent;
        self.is_stable = is_stable;
        self.come_back()
    }

    /// Brings the reactions to the point of the path.
    pub(super) fn come_back(&mut self) -> Result<(), LargeError> {
        let point = self.point.clone();
        self.corrector.evaluate_at(&point)
    }
}
