//! What a run was like: watched step by step, told at its end.

use crate::body::{FlexBodyHandle, FlexBodySet};
use crate::kkt::GAINED;
use crate::math::REAL_EPSILON;
use crate::pipeline::{Quality, StepReport, Unsolved};
use std::fmt;

/// Watches a run.
///
/// ```
/// use foil2d::doctor::Course;
/// use foil2d::prelude::*;
/// use foil2d::rapier::prelude::*;
///
/// let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
/// world.insert_collider(ColliderBuilder::cuboid(5.0, 0.5).translation(Vector::new(0.0, -0.5)), None);
/// let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
/// let block = FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(rubber).translation([0.0, 0.1]);
/// flex_bodies.insert(block, &mut world)?;
///
/// let (mut flex, mut course) = (FlexPipeline::new(), Course::default());
/// for _ in 0..60 {
///     let report = flex.step(&mut world, &mut flex_bodies)?;
///     course.watch(report, &flex_bodies);
/// }
/// let told = course.report();
/// assert_eq!((told.n_steps, told.n_unfinished), (60, 0));
/// println!("{told}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Course {
    told: CourseReport,
    /// The most that had been dissipated (J).
    most_dissipated: f64,
}

/// What a run was like.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CourseReport {
    /// Steps watched.
    pub n_steps: usize,
    /// Steps that were solved in parts, or with a joint left open.
    pub n_cut: usize,
    /// Steps that were not finished.
    pub n_unfinished: usize,
    /// What was not finished last.
    pub unfinished: Option<Unsolved>,
    /// The largest overlap told (m).
    pub gap_violation: f64,
    /// The largest opening of a joint told (m).
    pub joint_violation: f64,
    /// The largest strain that small strains have left out, and whose (-).
    pub neglected_strain: Option<(FlexBodyHandle, f64)>,
    /// The farthest that a body has turned against its first orientation, and which (rad).
    pub turn: Option<(FlexBodyHandle, f64)>,
    /// Energy of the islands in the first step and in the last (J).
    pub energy: [f64; 2],
    /// What has been dissipated (J).
    pub dissipated: f64,
    /// The most that was gained, and not brought by loads, since some step before (J): what had been dissipated by then less what has been since.
    pub gained: f64,
    /// The largest kinetic and elastic energy there was (J).
    pub most_energy: f64,
    /// Bodies that left the world since their motion would not have been finite.
    pub quarantined: Vec<FlexBodyHandle>,
}

impl CourseReport {
    /// Whether more energy was gained than the hundredth of the largest that contact may add (J).
    pub fn has_gained(&self) -> bool {
        self.gained > GAINED.get() * self.most_energy
    }
}

impl Course {
    /// Takes in a step.
    pub fn watch(&mut self, report: &StepReport, flex_bodies: &FlexBodySet) {
        let told = &mut self.told;
        let energy = report.energy();
        if told.n_steps == 0 {
            told.energy[0] = energy.total();
        }
        told.energy[1] = energy.total();
        told.dissipated = energy.dissipated;
        told.most_energy = told.most_energy.max(energy.kinetic + energy.elastic);
        // What an explicit step swings by comes back.
        let dissipated = energy.dissipated + energy.swing;
        self.most_dissipated = self.most_dissipated.max(dissipated);
        let gained = self.most_dissipated - dissipated;
        if gained > REAL_EPSILON * energy.total().abs() {
            told.gained = told.gained.max(gained);
        }
        told.n_steps += 1;
        match report.quality() {
            Quality::Solved => {}
            Quality::Cut => told.n_cut += 1,
            Quality::Unfinished => {
                told.n_unfinished += 1;
                let mut unsolved = report.unsolved().iter();
                told.unfinished = unsolved
                    .find(|one| one.quality == Quality::Unfinished)
                    .cloned();
            }
        }
        told.gap_violation = told.gap_violation.max(report.gap_violation());
        told.joint_violation = told.joint_violation.max(report.joint_violation());
        for bent in report.overbent() {
            let found = Some((bent.body, bent.neglected_strain));
            told.neglected_strain = larger(told.neglected_strain, found);
        }
        for (handle, body) in flex_bodies.iter() {
            told.turn = larger(told.turn, Some((handle, body.angle().abs())));
        }
        told.quarantined.extend(report.quarantined_flex_bodies());
    }

    /// What the run was like so far.
    pub fn report(&self) -> &CourseReport {
        &self.told
    }
}

fn larger(
    one: Option<(FlexBodyHandle, f64)>,
    other: Option<(FlexBodyHandle, f64)>,
) -> Option<(FlexBodyHandle, f64)> {
    match (one, other) {
        (Some(first), Some(second)) if first.1 >= second.1 => Some(first),
        (first, second) => second.or(first),
    }
}

impl fmt::Display for CourseReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} steps, {} cut, {} unfinished; overlaps up to {:.2e} m, joints open up to {:.2e} m",
            self.n_steps, self.n_cut, self.n_unfinished, self.gap_violation, self.joint_violation
        )?;
        let [first, last] = self.energy;
        writeln!(
            f,
            "energy {first:.4e} J at the beginning, {last:.4e} J at the end, {:.4e} J dissipated",
            self.dissipated
        )?;
        if self.has_gained() {
            writeln!(
                f,
                "{:.4e} J were gained that no load brought, where there were {:.4e} J at most: shorten the step",
                self.gained, self.most_energy
            )?;
        }
        if let Some((body, turn)) = self.turn.filter(|(_, turn)| *turn > 1e-3) {
            writeln!(f, "{body:?} turned farthest, by {turn:.3} rad")?;
        }
        if let Some((body, strain)) = self.neglected_strain {
            writeln!(
                f,
                "{body:?} was bent beyond small strains, by {strain:.3}: leave `.small_strain()` out"
            )?;
        }
        if let Some(unsolved) = &self.unfinished {
            writeln!(
                f,
                "steps of {:?} were not finished: shorten the step, or look at what holds them",
                unsolved.bodies
            )?;
        }
        for body in &self.quarantined {
            writeln!(f, "{body:?} left the world: its motion was not finite")?;
        }
        Ok(())
    }
}
