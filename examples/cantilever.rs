//! A cantilever under its own weight and in free vibration, against the converged solution of plane elasticity.
//!
//! ```text
//!  /|-----------------------------------+
//!  /|   L = 1 m, h = 0.1 m, 20 x 2      | tip     | gravity
//!  /|-----------------------------------+         v
//! ```
//!
//! Three questions, all put to the pipeline and not to a separate static or modal solver:
//!
//! - Does it bend right? The static tip is where a beam with much mass-proportional damping comes to rest.
//! - Does it vibrate right? The frequency is counted over twenty free periods.
//! - Does it keep its energy? Ten thousand steps of the trapezoidal rule.

#[path = "support/cli.rs"]
pub mod cli;

use clap::Parser;
use cli::{Options, print_json};
use foil2d::body::BuildError;
use foil2d::pipeline::StepError;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use serde::Serialize;
use std::error::Error;
use std::f64::consts::TAU;

const LENGTH: f64 = 1.0;
const HEIGHT: f64 = 0.1;
const DIVISIONS: [usize; 2] = [20, 2];
const GRAVITY: f64 = 0.1;
const SOFT: f64 = 1e6;

/// Converged solution in plane stress for `E = SOFT`: downward deflection of the tip (m) and first frequency (Hz).
/// The one scales with 1/E, the other with its root.
const TIP: f64 = 15.1218e-3;
const FREQUENCY: f64 = 0.507_408;

/// The trapezoidal rule lengthens a period by `(2 pi / 200)² / 12`, 0.008 %.
const STEPS_PER_PERIOD: usize = 200;

/// Errors against the converged solution, `computed / exact - 1` (-).
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Errors {
    pub tip_error: f64,
    pub frequency_error: f64,
}

/// The same for each element.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Elements {
    pub qm6: Errors,
    pub tri6: Errors,
    pub tri3: Errors,
}

/// The same for one Young's modulus (Pa).
#[derive(Clone, Copy, Debug, Serialize)]
pub struct AtStiffness {
    pub young: f64,
    #[serde(flatten)]
    pub errors: Errors,
}

/// The headline numbers; errors at the top are those of the default element, QM6.
#[derive(Clone, Debug, Serialize)]
pub struct Outcome {
    #[serde(flatten)]
    pub errors: Errors,
    pub elements: Elements,
    pub stiffness: Vec<AtStiffness>,
    /// Largest `|E / E0 - 1|` over 10,000 undamped steps (-).
    pub energy_drift: f64,
}

/// Measures all three elements, three stiffnesses and the energy.
pub fn run(options: &Options) -> Result<Outcome, Box<dyn Error>> {
    let qm6 = errors(CellKind::Quad4, SOFT, options)?;
    let stiffness = [SOFT, 2e9, 2e11].map(|young| {
        let errors = errors(CellKind::Quad4, young, options)?;
        Ok(AtStiffness { young, errors })
    });
    Ok(Outcome {
        errors: qm6,
        elements: Elements {
            qm6,
            tri6: errors(CellKind::Tri6, SOFT, options)?,
            tri3: errors(CellKind::Tri3, SOFT, options)?,
        },
        stiffness: stiffness
            .into_iter()
            .collect::<Result<_, Box<dyn Error>>>()?,
        energy_drift: energy_drift(options)?,
    })
}

fn errors(kind: CellKind, young: f64, options: &Options) -> Result<Errors, Box<dyn Error>> {
    let exact_tip = TIP * SOFT / young;
    let exact_frequency = FREQUENCY * (young / SOFT).sqrt();
    // The step follows the period, so that a stiff beam is resolved as well as a soft one.
    let dt = 1.0 / (exact_frequency * STEPS_PER_PERIOD as f64);

    // A mass part of twice the first frequency damps every mode at the rate of that frequency: after six periods
    // exp(-12 pi) is left.
    let damped = material(young).rayleigh_mass(2.0 * TAU * exact_frequency);
    let mut resting = Scene::new(kind, damped, GRAVITY, dt)?;
    for _ in 0..options.n_steps(6 * STEPS_PER_PERIOD) {
        resting.step()?;
    }
    let tip = -resting.tip();

    let shape = resting.body().local_displacements();
    let mut vibrating = Scene::new(kind, material(young), 0.0, dt)?;
    vibrating.strike(shape, TAU * exact_frequency)?;
    let frequency = vibrating.frequency(shape, options.n_steps(20 * STEPS_PER_PERIOD + 10))?;
    Ok(Errors {
        tip_error: tip / exact_tip - 1.0,
        frequency_error: frequency / exact_frequency - 1.0,
    })
}

/// Largest deviation of the energy of the struck beam, relative.
fn energy_drift(options: &Options) -> Result<f64, Box<dyn Error>> {
    let mut scene = Scene::new(CellKind::Quad4, material(SOFT), 0.0, 1.0 / 60.0)?;
    // A velocity that grows along the beam excites more than the first mode.
    let nodes = scene.body().mesh().nodes();
    let velocities: Vec<f64> = nodes.iter().flat_map(|&[x, _]| [0.0, 0.05 * x]).collect();
    scene.strike(&velocities, 1.0)?;
    let energy = |scene: &Scene| {
        let energy = scene.body().energy();
        energy.kinetic + energy.elastic
    };
    let at_start = energy(&scene);
    let mut drift = 0.0f64;
    for _ in 0..options.n_steps(10_000) {
        scene.step()?;
        drift = drift.max((energy(&scene) / at_start - 1.0).abs());
    }
    Ok(drift)
}

fn material(young: f64) -> LinearElastic {
    LinearElastic::plane_stress(young, 0.3).density(1000.0)
}

/// A rapier world that holds the beam and nothing else.
struct Scene {
    world: PhysicsWorld,
    flex_bodies: FlexBodySet,
    beam: FlexBodyHandle,
    tip_node: usize,
    pipeline: FlexPipeline,
}

impl Scene {
    fn new(
        kind: CellKind,
        material: LinearElastic,
        gravity: f64,
        dt: f64,
    ) -> Result<Self, BuildError> {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, -gravity as Real);
        world.integration_parameters.dt = dt as Real;
        let mut flex_bodies = FlexBodySet::new();
        // Nothing touches this beam: its boundary keeps its mass.
        let builder = FlexBodyBuilder::rectangle_of([LENGTH, HEIGHT], DIVISIONS, kind)
            .small_strain()
            .material(material)
            .contact_inertia(ContactInertia::Kept)
            .pin_where(|[x, _]| x == 0.0, Pin::both());
        let beam = flex_bodies.insert(builder, &mut world)?;
        // The middle of the end face.
        let nodes = flex_bodies[beam].mesh().nodes();
        let distance = |&[x, y]: &[f64; 2]| (x - LENGTH).hypot(y - 0.5 * HEIGHT);
        let tip_node = (0..nodes.len())
            .min_by(|&a, &b| distance(&nodes[a]).total_cmp(&distance(&nodes[b])))
            .unwrap_or(0);
        Ok(Self {
            world,
            flex_bodies,
            beam,
            tip_node,
            pipeline: FlexPipeline::new().with_integrator(Beta2::trapezoidal()),
        })
    }

    fn body(&self) -> &FlexBody {
        &self.flex_bodies[self.beam]
    }

    fn step(&mut self) -> Result<(), StepError> {
        self.pipeline
            .step(&mut self.world, &mut self.flex_bodies)
            .map(|_| ())
    }

    fn tip(&self) -> f64 {
        self.body().displacement(self.tip_node)[1]
    }

    /// Gives the beam `rate * shape` as its velocity.
    fn strike(&mut self, shape: &[f64], rate: f64) -> Result<(), Box<dyn Error>> {
        let velocities: Vec<f64> = shape.iter().map(|u| rate * u).collect();
        Ok(self.flex_bodies[self.beam].set_velocities(&velocities)?)
    }

    /// Frequency (Hz) at which the part of the motion along `shape` passes zero upwards.
    fn frequency(&mut self, shape: &[f64], n_steps: usize) -> Result<f64, StepError> {
        let mut passes = Vec::new();
        let mut before = 0.0;
        for step in 0..n_steps {
            self.step()?;
            let body = self.body();
            let now = body.model().mass().inner(body.local_displacements(), shape);
            if before < 0.0 && now >= 0.0 {
                passes.push(step as f64 - now / (now - before));
            }
            before = now;
        }
        // The step that was taken, in rapier's precision.
        let dt = f64::from(self.world.integration_parameters.dt);
        Ok(match (passes.first(), passes.last()) {
            (Some(first), Some(last)) => (passes.len() - 1) as f64 / ((last - first) * dt),
            _ => 0.0,
        })
    }
}

#[allow(dead_code, reason = "tests call `run`")]
fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    options.refuse_replay()?;
    let outcome = run(&options)?;
    println!("cantilever 1 x 0.1 m, 20 x 2 cells, against the converged plane solution");
    println!("                     static tip    first frequency");
    let Elements { qm6, tri6, tri3 } = outcome.elements;
    for (name, errors) in [("QM6 (default)", qm6), ("Tri6", tri6), ("Tri3", tri3)] {
        print_errors(name, &errors);
    }
    for at in &outcome.stiffness {
        print_errors(&format!("QM6, E = {:.0e} Pa", at.young), &at.errors);
    }
    println!(
        "energy of free vibration, 10,000 steps: within {:.1e} of its start",
        outcome.energy_drift
    );
    if options.json {
        print_json(&outcome);
    }
    Ok(())
}

fn print_errors(name: &str, errors: &Errors) {
    let (tip, frequency) = (100.0 * errors.tip_error, 100.0 * errors.frequency_error);
    println!("{name:<20} {tip:>+9.4} %       {frequency:>+9.4} %");
}
