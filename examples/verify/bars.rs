//! The guided elastic bar over a rigid floor that B1, B2 and the scheme table share.
//!
//! ```text
//!    |#|      L = 10 m, E = 900 Pa, rho = 1 kg/m³, section 1 m², nu = 0
//!    |#|      c = sqrt(E / rho) = 30 m/s
//!    |#| v0   nodes move along the bar only, strains are small-strain theory's
//!    |#|
//!   =====
//! ```

use super::scene::Scene;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use std::error::Error;
use std::time::Instant;

pub const LENGTH: f64 = 10.0;
pub const YOUNG: f64 = 900.0;
pub const DENSITY: f64 = 1.0;
pub const WAVE_SPEED: f64 = 30.0;
/// Contact lasts as long as a wave runs up and down (s).
pub const CONTACT_TIME: f64 = 2.0 * LENGTH / WAVE_SPEED;
const SECTION: f64 = 1.0;

/// Where the mass of the bar sits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mass {
    /// Lumped, and the two nodes that meet the floor gave theirs away.
    Redistributed,
    /// Consistent, and the two nodes that meet the floor gave theirs away.
    ConsistentRedistributed,
    /// Lumped.
    Kept,
    /// Consistent: the nodes that meet the floor keep theirs too.
    Consistent,
}

/// A way to step the bar through its impacts.
#[derive(Clone, Copy, Debug)]
pub struct Scheme {
    pub name: &'static str,
    pub integrator: Beta2,
    pub impact: ImpactTreatment,
    pub mass: Mass,
    pub contact: ContactMethod,
}

impl Scheme {
    /// What the library recommends for impacts at the pace of explicit steps.
    pub fn explicit() -> Self {
        Self {
            name: "central difference",
            integrator: Beta2::central_difference(),
            ..Self::recommended()
        }
    }

    /// What it recommends for impacts that a longer step resolves.
    pub fn recommended() -> Self {
        Self {
            name: "trapezoidal",
            integrator: Beta2::trapezoidal(),
            impact: ImpactTreatment::Stabilized,
            mass: Mass::Redistributed,
            contact: ContactMethod::Lagrange,
        }
    }
}

/// How the bar is let go.
#[derive(Clone, Copy, Debug)]
pub struct Drop {
    pub n_cells: usize,
    pub dt: f64,
    pub gravity: f64,
    /// Distance to the floor (m) and velocity towards it (m/s) at the start.
    pub gap: f64,
    pub speed: f64,
    pub n_steps: usize,
}

/// What was seen at the end of each step.
#[derive(Clone, Debug, Default)]
pub struct Record {
    pub times: Vec<f64>,
    /// Contact pressure (Pa).
    pub pressure: Vec<f64>,
    /// Kinetic, elastic and potential energy less the swing of explicit steps, over that at the start (-).
    pub energy: Vec<f64>,
    /// Height of the lower end (m).
    pub bottom: Vec<f64>,
    /// Velocity of the centre of mass (m/s).
    pub velocity: Vec<f64>,
    /// Deepest overlap (m).
    pub penetration: f64,
    pub n_newton: usize,
    /// Steps in which the iterations of the constraint functions failed.
    pub n_failed: usize,
    pub n_pivots: usize,
    /// Mean wall-clock time of a step (µs).
    pub microseconds: f64,
    /// Why the steps ended early, if they did.
    pub ended: Option<String>,
}

/// Lets the bar go and watches it.
pub fn drop_bar(scheme: &Scheme, drop: &Drop) -> Result<Record, Box<dyn Error + Send + Sync>> {
    let mut scene = Scene::new(drop.dt, scheme.integrator)
        .with_gravity(0.0, -drop.gravity)
        .with_impact(scheme.impact)
        .with_contact(scheme.contact);
    scene.world.insert_collider(
        ColliderBuilder::cuboid(20.0, 10.0).translation(Vector::new(0.0, -10.0)),
        None,
    );
    let (kind, inertia) = match scheme.mass {
        Mass::Redistributed => (
            MassKind::Lumped,
            ContactInertia::RedistributedAt(vec![0, 1]),
        ),
        Mass::ConsistentRedistributed => (
            MassKind::Consistent,
            ContactInertia::RedistributedAt(vec![0, 1]),
        ),
        Mass::Kept => (MassKind::Lumped, ContactInertia::Kept),
        Mass::Consistent => (MassKind::Consistent, ContactInertia::Kept),
    };
    let width = LENGTH / drop.n_cells as f64;
    let builder = FlexBodyBuilder::rectangle([width, LENGTH], [1, drop.n_cells])
        .small_strain()
        .material(LinearElastic::plane_stress(YOUNG, 0.0).density(DENSITY))
        .thickness(SECTION / width)
        .mass_kind(kind)
        .contact_inertia(inertia)
        .pin_where(|_| true, Pin::x())
        .translation([0.0, drop.gap])
        .linvel([0.0, -drop.speed]);
    let bar = scene.add(builder)?;
    let energy = |body: &FlexBody| {
        let energy = body.energy();
        let potential = drop.gravity * body.mass() * (body.centre_of_mass()[1] - 0.5 * LENGTH);
        energy.kinetic + energy.elastic + potential
    };
    let at_start = energy(scene.body(bar));
    let mut record = Record::default();
    let start = Instant::now();
    for step in 1..=drop.n_steps {
        let report = match scene.step() {
            Ok(report) => report,
            Err(error) => {
                record.ended = Some(error.to_string());
                break;
            }
        };
        record.penetration = record.penetration.max(report.gap_violation());
        record.n_newton = record.n_newton.max(report.n_newton());
        record.n_failed += report.n_failed();
        record.n_pivots += report.n_pivots();
        let body = scene.body(bar);
        record.times.push(step as f64 * scene.dt());
        record
            .pressure
            .push(body.total_contact_force()[1] / SECTION);
        // What an explicit step conserves; zero for the others.
        let swing = scene.flex.report().energy().swing;
        record.energy.push((energy(body) - swing) / at_start);
        record.bottom.push(body.position(0)[1]);
        record.velocity.push(body.linvel()[1]);
    }
    let n_taken = record.times.len().max(1) as f64;
    record.microseconds = 1e6 * start.elapsed().as_secs_f64() / n_taken;
    Ok(record)
}

impl Record {
    /// Index of the step that ends nearest to a time.
    fn index(&self, time: f64) -> Option<usize> {
        let index = self.times.partition_point(|&t| t < time - 1e-4);
        (index < self.times.len()).then_some(index)
    }

    /// A recorded value at a time; NaN if the steps ended before.
    pub fn at(&self, values: &[f64], time: f64) -> f64 {
        self.index(time).map_or(f64::NAN, |index| values[index])
    }

    /// Pairs of time and value, for a figure.
    pub fn curve(&self, values: &[f64]) -> Vec<[f64; 2]> {
        self.times
            .iter()
            .zip(values)
            .map(|(&t, &v)| [t, v])
            .collect()
    }

    /// End of the last step with a contact force before a time (s).
    pub fn release(&self, before: f64) -> f64 {
        let is_pressed = |&step: &usize| self.times[step] < before && self.pressure[step] > 0.0;
        let last = (0..self.times.len()).rev().find(is_pressed);
        last.map_or(f64::NAN, |step| self.times[step])
    }

    /// Root mean square and largest value of `p - exact(t)` over a span of time (s).
    pub fn pressure_error(&self, [from, to]: [f64; 2], exact: impl Fn(f64) -> f64) -> [f64; 2] {
        let errors = self.times.iter().zip(&self.pressure);
        let errors = errors.filter(|(time, _)| (from..=to).contains(*time));
        let (n, square, peak) = errors.fold((0.0, 0.0, 0.0f64), |(n, square, peak), (&t, &p)| {
            let error = p - exact(t);
            (n + 1.0, square + error * error, peak.max(error.abs()))
        });
        [(square / n).sqrt(), peak]
    }

    /// Mean pressure over a span of time (Pa).
    pub fn mean_pressure(&self, [from, to]: [f64; 2]) -> f64 {
        let within = self.times.iter().zip(&self.pressure);
        let within = within.filter(|(time, _)| (from..=to).contains(*time));
        let (n, sum) = within.fold((0.0, 0.0), |(n, sum), (_, p)| (n + 1.0, sum + p));
        sum / n
    }
}
