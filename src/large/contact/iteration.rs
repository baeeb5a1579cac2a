//! Newton's iteration against obstacles, which looks anew at every iterate what touches.

use super::obstacle::Obstacle;
use super::passage::passed;
use super::touch::{ContactPoint, Held, Hold, Touch};
use crate::fe::finite_strain::{Deformation, FiniteStrainModel, Linearization};
use crate::large::equation::{Equation, Evaluation};
use crate::large::load_case::{Equilibrator, Increment};
use crate::large::newton::{Work, largest, largest_row_sum};
use crate::large::{LargeError, LargeSettings};
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::lu::{LuError, SparseLu};
use crate::math::{Vec2, node_vec, perp, rounding};
use nalgebra::Matrix3;

/// An increment is cut to 1/64 where it leads to where a law has no energy.
const MOST_CUTS: usize = 6;

/// Matrix, factor and vectors of the iteration, and what touches.
#[derive(Clone, Debug)]
pub(super) struct Iteration {
    settings: LargeSettings,
    pub(super) deformation: Deformation,
    matrix: BlockMatrix,
    lu: SparseLu,
    /// Those of the case at hand.
    pub(super) obstacles: Vec<Obstacle>,
    pub(super) touches: Vec<Touch>,
    /// What is out of balance at the last evaluation (N).
    residual: Vec<f64>,
    /// Forces that hold the held dofs, at the last evaluation (N).
    pub(super) reaction: Vec<f64>,
    /// What touches in the last equilibrium.
    pub(super) contacts: Vec<ContactPoint>,
    pub(super) work: Work,
}

impl Iteration {
    /// # Errors
    /// If there is no memory for the factor.
    pub(super) fn new(
        model: &FiniteStrainModel,
        settings: LargeSettings,
    ) -> Result<Self, LargeError> {
        let n_dofs = model.n_dofs();
        let matrix = model.new_matrix();
        let zeros = vec![0.0; n_dofs];
        Ok(Self {
            deformation: model.deformation(model.rest_positions()),
            lu: SparseLu::analyze(&matrix, &[]).map_err(|_| LargeError::Memory { n_dofs })?,
            matrix,
            obstacles: Vec::new(),
            touches: Vec::new(),
            residual: zeros.clone(),
            reaction: zeros,
            contacts: Vec::new(),
            work: Work::default(),
            settings,
        })
    }

    /// The nodes of the surface that can move; those that touched last do so again.
    pub(super) fn list_touches(&mut self, model: &FiniteStrainModel, is_held: &[bool]) {
        let known = std::mem::take(&mut self.touches);
        let boundary = model.mesh().boundary();
        let nodes = boundary.loops().iter().flat_map(|one| one.nodes());
        for &node in nodes {
            let is_held = [0, 1].map(|axis| is_held[2 * node + axis]);
            let Some(mut touch) = Touch::new(node, is_held) else {
                continue;
            };
            let last = known.iter().find(|last| last.node == node);
            if let Some(last) = last.filter(|last| last.obstacle < self.obstacles.len()) {
                (touch.obstacle, touch.hold) = (last.obstacle, last.hold);
            }
            self.touches.push(touch);
        }
        if self.obstacles.is_empty() {
            self.touches.clear();
        }
    }

    /// Moves the guess to an equilibrium.
    fn iterate(&mut self, increment: &Increment<'_>, end: &mut [f64]) -> Result<(), LargeError> {
        let [_, share] = increment.shares;
        let equation = increment.equation(f64::INFINITY);
        let length = increment.model.mesh().boundary().mean_segment_length();
        let tolerance = self.settings.tolerance;
        let (mut last, mut last_scale): (Option<f64>, f64) = (None, 0.0);
        let mut moved: Vec<f64> = vec![0.0; end.len()];
        for iteration in 0..=self.settings.max_iterations {
            let now = self.evaluate_back(&equation, &mut moved, end)?;
            // The forces of a guess, in which held dofs alone have moved, tell nothing.
            let no_force = match iteration {
                0 => f64::INFINITY,
                _ => tolerance * last_scale.max(now.scale),
            };
            let has_changed = self.revise(end, share, [no_force, tolerance * length]);
            let (norm, way, scale) = self.judge(end, share, now);
            last_scale = scale;
            let limit = tolerance * scale;
            let is_there = !has_changed && way <= tolerance * length;
            let rounding = f64::EPSILON * largest_row_sum(&self.matrix) * largest(equation.start);
            let is_slow = last.is_some_and(|last| norm > 0.25 * last);
            if is_there && (norm <= limit || is_slow && norm <= rounding) {
                self.work.n_at_rounding += usize::from(norm > limit);
                if norm <= limit {
                    let left = norm / scale.max(f64::MIN_POSITIVE);
                    self.work.residual = self.work.residual.max(left);
                }
                let segments = increment.model.mesh().boundary().segments();
                let ways = [increment.start, end];
                if let Some((node, obstacle)) =
                    passed(&self.obstacles, segments, ways, increment.shares)
                {
                    return Err(LargeError::Passed { node, obstacle });
                }
                return self.note(end, share, tolerance * length);
            }
            if iteration == self.settings.max_iterations {
                return Err(LargeError::NotConverged {
                    iterations: iteration,
                    node: now.node,
                    residual: norm,
                    limit,
                });
            }
            last = Some(norm);
            moved.copy_from_slice(&self.residual);
            self.renew(&equation, share, end, &mut moved)?;
            for (end, moved) in end.iter_mut().zip(&moved) {
                *end += moved;
            }
            self.work.n_iterations += 1;
        }
        Ok(())
    }

    /// The residual at the iterate, or at a nearer one along the last way where the law has no energy at this one.
    fn evaluate_back(
        &mut self,
        equation: &Equation<'_>,
        moved: &mut [f64],
        end: &mut [f64],
    ) -> Result<Evaluation, LargeError> {
        let mut n_cuts = 0;
        loop {
            let (residual, reaction) = (&mut self.residual, &mut self.reaction);
            let outcome = equation.evaluate(end, &mut self.deformation, residual, reaction);
            let reason = match outcome {
                Ok(now) if now.norm.is_finite() => return Ok(now),
                Ok(now) => LargeError::Diverged {
                    node: now.node,
                    residual: now.norm,
                },
                Err(error) => error.into(),
            };
            n_cuts += 1;
            if n_cuts > MOST_CUTS {
                return Err(reason);
            }
            for (end, moved) in end.iter_mut().zip(moved.iter_mut()) {
                *moved *= 0.5;
                *end -= *moved;
            }
        }
    }

    fn look(&self, touch: &Touch, end: &[f64], share: f64) -> Held {
        touch.look(&self.obstacles, end, &self.residual, share)
    }

    /// Whether other equations hold than before.
    fn revise(&mut self, end: &[f64], share: f64, nothing: [f64; 2]) -> bool {
        let (obstacles, residual) = (&self.obstacles, &self.residual);
        let touches = self.touches.iter_mut();
        touches.fold(false, |has_changed, touch| {
            has_changed | touch.revise(obstacles, end, residual, share, nothing)
        })
    }

    /// What is out of balance (N) and out of place (m), and the largest force (N).
    fn judge(&self, end: &[f64], share: f64, now: Evaluation) -> (f64, f64, f64) {
        let mut is_touched = vec![false; end.len() / 2];
        let (mut norm, mut way, mut scale) = (0.0f64, 0.0f64, now.scale);
        for touch in &self.touches {
            if touch.hold == Hold::Open {
                continue;
            }
            let held = self.look(touch, end, share);
            let [left, off] = touch.residual(&held, self.obstacles[touch.obstacle].friction());
            norm = norm.max(left);
            way = way.max(off);
            scale = scale.max(held.force.abs());
            is_touched[touch.node] = true;
        }
        for (dof, left) in self.residual.iter().enumerate() {
            if !is_touched[dof / 2] {
                norm = norm.max(left.abs());
            }
        }
        (norm, way, scale)
    }

    /// Replaces the residual in `way` by the way of the positions that it asks for (m).
    fn renew(
        &mut self,
        equation: &Equation<'_>,
        share: f64,
        end: &[f64],
        way: &mut [f64],
    ) -> Result<(), LargeError> {
        let kind = Linearization::Consistent;
        equation.assemble(kind, &self.deformation, &mut self.matrix);
        for touch in &self.touches {
            let held = touch.look(&self.obstacles, end, &self.residual, share);
            let friction = self.obstacles[touch.obstacle].friction();
            touch.write(&held, friction, &mut self.matrix, way);
        }
        let singular = LargeError::Singular { factor: share };
        if moves_freely(&self.matrix, end) {
            return Err(singular);
        }
        self.work.n_factorizations += 1;
        self.lu
            .factorize(&self.matrix, &[])
            .map_err(|error| match error {
                LuError::Singular => singular,
                LuError::Memory { .. } => LargeError::Memory { n_dofs: end.len() },
            })?;
        self.lu.solve_in_place(way);
        match way.iter().all(|x| x.is_finite()) {
            true => Ok(()),
            false => Err(singular),
        }
    }

    /// Writes down what touches, unless a node is in a second obstacle by more than is allowed (m).
    fn note(&mut self, end: &[f64], share: f64, allowed: f64) -> Result<(), LargeError> {
        let mut contacts = Vec::new();
        for touch in self.touches.iter().filter(|one| one.hold != Hold::Open) {
            let held = self.look(touch, end, share);
            let place = node_vec(end, touch.node);
            for (second, other) in self.obstacles.iter().enumerate() {
                let gap = other.beside(place, share).gap;
                if second != touch.obstacle && gap < -allowed {
                    let (node, first) = (touch.node, touch.obstacle);
                    return Err(LargeError::Wedged {
                        node,
                        obstacles: [first, second],
                        depth: -gap,
                    });
                }
            }
            contacts.push(ContactPoint {
                node: touch.node,
                obstacle: touch.obstacle,
                position: place.into(),
                normal: held.beside.normal.into(),
                normal_force: held.force,
                friction_force: held.friction,
                sticks: touch.hold == Hold::Sticks,
            });
        }
        self.contacts = contacts;
        Ok(())
    }
}

/// Whether a rigid motion of a body at these positions (m) meets no resistance: the least square of `A r` over all of them. A factor need not tell, as rounding
/// leaves it something.
fn moves_freely(matrix: &BlockMatrix, positions: &[f64]) -> bool {
    let n = positions.len() / 2;
    let places = || (0..n).map(|node| node_vec(positions, node));
    let centre = places().sum::<Vec2>() / n as f64;
    let squares: f64 = places().map(|place| (place - centre).norm_squared()).sum();
    let radius = (squares / n as f64).sqrt();
    let answers = [0, 1, 2].map(|motion| {
        let rates = places().flat_map(|place| match motion {
            0 => [1.0, 0.0],
            1 => [0.0, 1.0],
            _ => (perp(place - centre) / radius).into(),
        });
        let (rates, mut answer) = (rates.collect::<Vec<f64>>(), vec![0.0; 2 * n]);
        matrix.multiply(&rates, &mut answer);
        answer
    });
    let gram = Matrix3::from_fn(|i, j| {
        let pairs = answers[i].iter().zip(&answers[j]);
        pairs.map(|(one, other)| one * other).sum::<f64>()
    });
    let nothing = rounding::SUM * largest_row_sum(matrix);
    gram.symmetric_eigenvalues().min() <= n as f64 * nothing * nothing
}

impl Equilibrator for Iteration {
    fn deformation(&mut self) -> &mut Deformation {
        &mut self.deformation
    }

    fn work(&self) -> Work {
        self.work
    }

    fn find(&mut self, increment: &Increment<'_>, end: &mut [f64]) -> Result<(), LargeError> {
        let touches = self.touches.clone();
        let [began, _] = increment.shares;
        for touch in &mut self.touches {
            touch.begin(&self.obstacles, increment.start, began);
        }
        let outcome = self.iterate(increment, end);
        if outcome.is_err() {
            self.touches = touches;
        }
        outcome
    }
}
