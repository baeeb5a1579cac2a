//! Increments of a load case against obstacles.

use super::obstacle::Obstacle;
use super::touch::{ContactPoint, Held, Hold, Touch};
use crate::fe::finite_strain::{Deformation, FiniteStrainModel, Form, Linearization};
use crate::fe::material::hyperelastic::PlasticState;
use crate::large::equation::{Equation, Evaluation, Inertia};
use crate::large::increments::Increments;
use crate::large::newton::largest_row_sum;
use crate::large::stepper::require_finite;
use crate::large::{LargeError, LargeSettings, LoadCase, LoadReport};
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::lu::{LuError, SparseLu};
use std::sync::Arc;

/// An increment is cut to 1/64 where it leads to where a law has no energy.
const MOST_CUTS: usize = 6;

/// Loads, held dofs and obstacles, and from where to where they go.
#[derive(Clone, Copy, Debug)]
pub struct ContactCase<'a> {
    /// Loads and held dofs.
    pub load: LoadCase<'a>,
    /// What the surface of the body is kept out of; where several are near, a node is kept out of one.
    pub obstacles: &'a [Obstacle],
}

/// Finds equilibria of one body of large strain between rigid obstacles.
///
/// What touches stays known to the next case, for the same list of obstacles. Friction is that of the slip of every increment: many show a load that turns round.
///
/// ```
/// use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
/// use foil2d::fe::material::hyperelastic::NeoHookean;
/// use foil2d::fe::mesh::{CellKind, generate::rectangle};
/// use foil2d::large::{ContactCase, ContactStepper, LargeSettings, LoadCase, Obstacle};
///
/// // A disc of 10 cm goes 2 cm into a block.
/// let mesh = rectangle([0.4, 0.2], [16, 8], CellKind::Tri6)?;
/// let law = NeoHookean::plane_strain(1e6, 0.3);
/// let model = FiniteStrainModel::assemble(FiniteStrainDescription::new(mesh, law, 1000.0))?;
/// let rest = model.rest_positions().to_vec();
/// let is_held: Vec<bool> = rest.chunks_exact(2).flat_map(|x| [x[1] == 0.0; 2]).collect();
/// let disc = Obstacle::disc([0.2, 0.3], 0.1).moving_by([0.0, -0.02]);
///
/// let none = vec![0.0; rest.len()];
/// let load = LoadCase { from: &none, to: &none, is_held: &is_held, places: &rest, n_increments: 4 };
/// let mut positions = rest.clone();
/// let mut stepper = ContactStepper::new(model, LargeSettings::default())?;
/// stepper.solve(ContactCase { load, obstacles: &[disc] }, &mut positions)?;
/// let pressed: f64 = stepper.contacts().iter().map(|point| point.normal_force * point.normal[1]).sum();
/// let held: f64 = stepper.reaction().chunks_exact(2).map(|force| force[1]).sum();
/// assert!(held > 5e3 && (pressed + held).abs() < 1e-3 * held);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ContactStepper {
    model: Arc<FiniteStrainModel>,
    settings: LargeSettings,
    deformation: Deformation,
    matrix: BlockMatrix,
    lu: SparseLu,
    touches: Vec<Touch>,
    end: Vec<f64>,
    load: Vec<f64>,
    residual: Vec<f64>,
    reaction: Vec<f64>,
    contacts: Vec<ContactPoint>,
    report: LoadReport,
}

/// What is put back where a case finds no end.
struct Before {
    positions: Vec<f64>,
    flowed: Vec<PlasticState>,
    touches: Vec<Touch>,
}

impl ContactStepper {
    /// A solver for equilibria; the decay of the settings is not used.
    ///
    /// # Errors
    /// If a setting is out of its range, or there is no memory for the factor.
    pub fn new(
        model: impl Into<Arc<FiniteStrainModel>>,
        settings: LargeSettings,
    ) -> Result<Self, LargeError> {
        settings.check()?;
        let model = model.into();
        let n_dofs = model.n_dofs();
        let matrix = model.new_matrix();
        let zeros = vec![0.0; n_dofs];
        Ok(Self {
            deformation: model.deformation(model.rest_positions()),
            lu: SparseLu::analyze(&matrix, &[]).map_err(|_| LargeError::Memory { n_dofs })?,
            matrix,
            touches: Vec::new(),
            end: zeros.clone(),
            load: zeros.clone(),
            residual: zeros.clone(),
            reaction: zeros,
            contacts: Vec::new(),
            report: LoadReport::default(),
            settings,
            model,
        })
    }

    /// Forces that hold the held dofs in the last equilibrium (N); zero at others.
    pub fn reaction(&self) -> &[f64] {
        &self.reaction
    }

    /// What touches in the last equilibrium.
    pub fn contacts(&self) -> &[ContactPoint] {
        &self.contacts
    }

    /// What has flowed at the quadrature points in all cases, as [`LoadStepper::flowed`](crate::large::LoadStepper::flowed).
    pub fn flowed(&self) -> &[PlasticState] {
        self.deformation.flowed()
    }

    /// Moves `positions` (m) to the equilibrium at the end of a case.
    ///
    /// # Errors
    /// Who stopped the last attempt; positions then are as they were. [`LargeError::Obstacle`] and the errors of lists for what is wrong before.
    ///
    /// # Panics
    /// If there is not one flag per dof.
    pub fn solve(
        &mut self,
        case: ContactCase<'_>,
        positions: &mut [f64],
    ) -> Result<LoadReport, LargeError> {
        let n_dofs = self.model.n_dofs();
        let load = case.load;
        assert_eq!(load.is_held.len(), n_dofs, "one flag per dof");
        require_finite("the positions", positions, n_dofs)?;
        require_finite("the load at the beginning", load.from, n_dofs)?;
        require_finite("the load at the end", load.to, n_dofs)?;
        require_finite("the places", load.places, n_dofs)?;
        for (index, obstacle) in case.obstacles.iter().enumerate() {
            obstacle.check(index)?;
        }
        let before = Before {
            positions: positions.to_vec(),
            flowed: self.deformation.flowed().to_vec(),
            touches: self.touches.clone(),
        };
        self.report = LoadReport::default();
        self.list_touches(&case);
        let outcome = self.follow(&case, &before, positions);
        if outcome.is_err() {
            positions.copy_from_slice(&before.positions);
            self.deformation.begin_with(&before.flowed);
            self.touches = before.touches;
        }
        outcome?;
        Ok(self.report)
    }

    /// The nodes of the surface that can move; those that touched last do so again.
    fn list_touches(&mut self, case: &ContactCase<'_>) {
        let known = std::mem::take(&mut self.touches);
        let boundary = self.model.mesh().boundary();
        let nodes = boundary.loops().iter().flat_map(|one| one.nodes());
        for &node in nodes {
            let is_held = [0, 1].map(|axis| case.load.is_held[2 * node + axis]);
            let Some(mut touch) = Touch::new(node, is_held) else {
                continue;
            };
            let last = known.iter().find(|last| last.node == node);
            if let Some(last) = last.filter(|last| last.obstacle < case.obstacles.len()) {
                (touch.obstacle, touch.hold) = (last.obstacle, last.hold);
            }
            self.touches.push(touch);
        }
        if case.obstacles.is_empty() {
            self.touches.clear();
        }
    }

    fn follow(
        &mut self,
        case: &ContactCase<'_>,
        before: &Before,
        positions: &mut [f64],
    ) -> Result<(), LargeError> {
        let mut increments = Increments::new(case.load.n_increments, self.settings.max_cutbacks);
        let mut previous = positions.to_vec();
        let mut share = 0.0;
        while let Some([reached, ahead]) = increments.next() {
            let touches = self.touches.clone();
            for touch in &mut self.touches {
                touch.begin(case.obstacles, positions, share);
            }
            self.guess(
                case,
                [reached, ahead],
                [&before.positions, &previous],
                positions,
            );
            match self.iterate(case, reached, positions) {
                Ok(()) => {
                    previous.copy_from_slice(positions);
                    positions.copy_from_slice(&self.end);
                    let flowed = self.deformation.flowed_mut();
                    self.report.flowed += self.model.commit_flow(&self.end, flowed);
                    self.report.n_increments += 1;
                    share = reached;
                    increments.accept();
                }
                Err(error) => {
                    self.touches = touches;
                    if !increments.halve() {
                        return Err(error);
                    }
                    self.report.n_cutbacks += 1;
                }
            }
        }
        Ok(())
    }

    /// Loads of an increment, and where it is sought from: on as the last one went.
    fn guess(
        &mut self,
        case: &ContactCase<'_>,
        [reached, ahead]: [f64; 2],
        [first, previous]: [&[f64]; 2],
        positions: &[f64],
    ) {
        let load = &case.load;
        for (dof, &x) in positions.iter().enumerate() {
            self.load[dof] = load.from[dof] + reached * (load.to[dof] - load.from[dof]);
            self.end[dof] = match load.is_held[dof] {
                true if reached == 1.0 => load.places[dof],
                true => first[dof] + reached * (load.places[dof] - first[dof]),
                false => x + ahead * (x - previous[dof]),
            };
        }
    }

    /// Moves the guess to an equilibrium.
    fn iterate(
        &mut self,
        case: &ContactCase<'_>,
        share: f64,
        start: &[f64],
    ) -> Result<(), LargeError> {
        let length = self.model.mesh().boundary().mean_segment_length();
        let tolerance = self.settings.tolerance;
        let (mut last, mut largest): (Option<f64>, f64) = (None, 0.0);
        let mut increment: Vec<f64> = vec![0.0; start.len()];
        for iteration in 0..=self.settings.max_iterations {
            let now = self.evaluate_back(case, start, &mut increment)?;
            // The forces of a guess, in which held dofs alone have moved, tell nothing.
            let no_force = match iteration {
                0 => f64::INFINITY,
                _ => tolerance * largest.max(now.scale),
            };
            let has_changed = self.revise(case.obstacles, share, [no_force, tolerance * length]);
            let (norm, way, scale) = self.judge(case.obstacles, share, now);
            largest = scale;
            let limit = tolerance * scale;
            let is_there = !has_changed && way <= tolerance * length;
            let rounding = f64::EPSILON
                * largest_row_sum(&self.matrix)
                * start.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            let is_slow = last.is_some_and(|last| norm > 0.25 * last);
            if is_there && (norm <= limit || is_slow && norm <= rounding) {
                self.report.n_at_rounding += usize::from(norm > limit);
                if norm <= limit {
                    let left = norm / scale.max(f64::MIN_POSITIVE);
                    self.report.residual = self.report.residual.max(left);
                }
                return self.note(case.obstacles, share, tolerance * length);
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
            increment.copy_from_slice(&self.residual);
            self.renew(case, share, &mut increment)?;
            for (end, increment) in self.end.iter_mut().zip(&increment) {
                *end += increment;
            }
            self.report.n_iterations += 1;
        }
        Ok(())
    }

    /// The residual at the iterate, or at a nearer one along the last increment where the law has no energy at this one.
    fn evaluate_back(
        &mut self,
        case: &ContactCase<'_>,
        start: &[f64],
        increment: &mut [f64],
    ) -> Result<Evaluation, LargeError> {
        let mut n_cuts = 0;
        loop {
            let equation = Equation {
                model: &self.model,
                form: Form::Equilibrium,
                inertia: Inertia {
                    acceleration: 0.0,
                    drag: 0.0,
                },
                load: &self.load,
                start,
                coast: start,
                is_held: case.load.is_held,
                most_growth: f64::INFINITY,
            };
            let (residual, reaction) = (&mut self.residual, &mut self.reaction);
            let outcome = equation.evaluate(&self.end, &mut self.deformation, residual, reaction);
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
            for (end, increment) in self.end.iter_mut().zip(increment.iter_mut()) {
                *increment *= 0.5;
                *end -= *increment;
            }
        }
    }

    fn look(&self, touch: &Touch, obstacles: &[Obstacle], share: f64) -> Held {
        touch.look(obstacles, &self.end, &self.residual, share)
    }

    /// Whether other equations hold than before.
    fn revise(&mut self, obstacles: &[Obstacle], share: f64, nothing: [f64; 2]) -> bool {
        let (end, residual) = (&self.end, &self.residual);
        let touches = self.touches.iter_mut();
        touches.fold(false, |has_changed, touch| {
            has_changed | touch.revise(obstacles, end, residual, share, nothing)
        })
    }

    /// What is out of balance (N) and out of place (m), and the largest force (N).
    fn judge(&self, obstacles: &[Obstacle], share: f64, now: Evaluation) -> (f64, f64, f64) {
        let mut is_touched = vec![false; self.model.n_nodes()];
        let (mut norm, mut way, mut scale) = (0.0f64, 0.0f64, now.scale);
        for touch in &self.touches {
            if touch.hold == Hold::Open {
                continue;
            }
            let held = self.look(touch, obstacles, share);
            let [left, off] = touch.residual(&held, obstacles[touch.obstacle].friction());
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

    /// Replaces the residual by the increment of the positions.
    fn renew(
        &mut self,
        case: &ContactCase<'_>,
        share: f64,
        increment: &mut [f64],
    ) -> Result<(), LargeError> {
        self.matrix.fill_zero();
        let kind = Linearization::Consistent;
        self.model
            .add_tangent(Form::Equilibrium, kind, &self.deformation, &mut self.matrix);
        if case.load.is_held.contains(&true) {
            self.matrix.constrain(case.load.is_held);
        }
        for touch in &self.touches {
            let held = touch.look(case.obstacles, &self.end, &self.residual, share);
            let friction = case.obstacles[touch.obstacle].friction();
            touch.write(&held, friction, &mut self.matrix, increment);
        }
        self.report.n_factorizations += 1;
        let n_dofs = self.model.n_dofs();
        let singular = LargeError::Singular { factor: share };
        self.lu
            .factorize(&self.matrix, &[])
            .map_err(|error| match error {
                LuError::Singular => singular,
                LuError::Memory { .. } => LargeError::Memory { n_dofs },
            })?;
        self.lu.solve_in_place(increment);
        match increment.iter().all(|x| x.is_finite()) {
            true => Ok(()),
            false => Err(singular),
        }
    }

    /// Writes down what touches, unless a node is in a second obstacle by more than is allowed (m).
    fn note(&mut self, obstacles: &[Obstacle], share: f64, allowed: f64) -> Result<(), LargeError> {
        let mut contacts = Vec::new();
        for touch in self.touches.iter().filter(|one| one.hold != Hold::Open) {
            let held = self.look(touch, obstacles, share);
            let place = crate::math::node_vec(&self.end, touch.node);
            for (second, other) in obstacles.iter().enumerate() {
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
