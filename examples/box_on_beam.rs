//! A rigid box, 10 to 1000 times heavier than the flexible beam it stands on.
//!
//! ```text
//!                +-------+  mass 400 kg * ratio
//!                |  0.4  |
//!  +-------------+-------+-------------+
//!  |  2 x 0.2 m, 40 x 4 cells, 400 kg  |  E = 1e8 Pa * ratio
//!  o-----------------------------------o  both bottom corners pinned
//! ```
//!
//! The box is set on the straight beam and let go. The beam's stiffness grows with the load, so it always sags by about
//! 4.5 mm and takes the same time, while the ratio of the masses that are solved together grows.
//!
//! To come to rest within ten seconds the beam has Rayleigh damping `C = beta K` with beta = 0.01 s, a quarter of
//! critical for the bouncing box. That damps stiff vibrations so much that the trapezoidal rule turns them into a change
//! of sign at every step; a member of the Beta-2 family that forgets them, rho = 0.9, takes them out.

#[path = "support/cli.rs"]
pub mod cli;
#[path = "support/doctor.rs"]
mod doctor;

use clap::Parser;
use cli::{Options, print_json};
use foil2d::pipeline::Participant;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;
use std::error::Error;

const SPAN: f64 = 2.0;
const DEPTH: f64 = 0.2;
const DIVISIONS: [usize; 2] = [40, 4];
const BOX_HALF: f64 = 0.2;
const BEAM_MASS: f64 = 400.0;
const GRAVITY: f64 = 9.81;
const DT: f64 = 1.0 / 60.0;
const N_STEPS: usize = 600;
/// The last two seconds are measured.
const N_MEASURED: usize = 120;

/// Headline numbers at one ratio of masses.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Outcome {
    pub ratio: f64,
    /// Mean vertical contact force on the box over its weight (-).
    pub force_over_weight: f64,
    /// Root mean square of the box's speed (m/s).
    pub jitter_m_per_s: f64,
    /// Sag at mid-span against the static solution on the same mesh under the friction found (-).
    pub sag_error: f64,
    /// The same against the static solution without friction (-).
    pub sag_error_without_friction: f64,
    /// The sag itself (m).
    pub sag_m: f64,
    /// Deepest overlap in any step (m).
    pub max_penetration_m: f64,
}

/// Stands the box on the beam at mass ratios of 10, 100 and 1000.
pub fn run(options: &Options) -> Result<Vec<Outcome>, Box<dyn Error>> {
    [10.0, 100.0, 1000.0]
        .map(|ratio| stand(ratio, options))
        .into_iter()
        .collect()
}

fn beam(ratio: f64) -> FlexBodyBuilder {
    let material = LinearElastic::plane_stress(1e8 * ratio, 0.3)
        .density(BEAM_MASS / (SPAN * DEPTH))
        .rayleigh(0.01);
    FlexBodyBuilder::rectangle([SPAN, DEPTH], DIVISIONS)
        .small_strain()
        .material(material)
        .pin_where(|[x, y]| y == 0.0 && (x == 0.0 || x == SPAN), Pin::both())
}

/// The node in column `i`, row `j`.
const fn node(i: usize, j: usize) -> usize {
    j * (DIVISIONS[0] + 1) + i
}

fn stand(ratio: f64, options: &Options) -> Result<Outcome, Box<dyn Error>> {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = DT as Real;
    world.gravity = Vector::new(0.0, -GRAVITY as Real);
    let mut flex_bodies = FlexBodySet::new();
    let beam_handle = flex_bodies.insert(beam(ratio), &mut world)?;
    let box_body = world.insert_body(RigidBodyBuilder::dynamic().translation(Vector::new(
        (0.5 * SPAN) as Real,
        (DEPTH + BOX_HALF) as Real,
    )));
    let box_mass = BEAM_MASS * ratio;
    let shape = ColliderBuilder::cuboid(BOX_HALF as Real, BOX_HALF as Real).mass(box_mass as Real);
    let box_collider = world.insert_collider(shape, Some(box_body));
    let mut pipeline = FlexPipeline::new().with_integrator(Beta2::damped(0.9)?);

    doctor::require_sound(&world, &flex_bodies, &pipeline)?;
    let n_steps = options.n_steps(N_STEPS);
    let n_measured = N_MEASURED.min(n_steps);
    let (mut force, mut squared_speed, mut max_penetration_m) = (0.0, 0.0, 0.0f64);
    let title = format!("A box {ratio} times heavier than its beam");
    let mut recorder = options.recorder_of(&ratio.to_string(), &title);
    for step in 0..n_steps {
        let report = pipeline.step(&mut world, &mut flex_bodies)?;
        max_penetration_m = max_penetration_m.max(report.gap_violation());
        if step + n_measured >= n_steps {
            force += report.force_on(Participant::Rigid(box_collider))[1];
            squared_speed += f64::from(world.bodies[box_body].linvel().length_squared());
        }
        recorder.record((step + 1) as f64 * DT, &world, &flex_bodies, &pipeline)?;
    }
    recorder.write()?;
    let beam = &flex_bodies[beam_handle];
    let middle = node(DIVISIONS[0] / 2, DIVISIONS[1] / 2);
    let sag_m = -beam.displacement(middle)[1];
    let sag_of = |stood| -> Result<f64, Box<dyn Error>> {
        Ok(-static_displacement(ratio, stood)?[2 * middle + 1])
    };
    let exact = sag_of(Some(beam))?;
    let without_friction = sag_of(None)?;
    Ok(Outcome {
        ratio,
        force_over_weight: force / n_measured as f64 / (box_mass * GRAVITY),
        jitter_m_per_s: (squared_speed / n_measured as f64).sqrt(),
        sag_error: sag_m / exact - 1.0,
        sag_error_without_friction: sag_m / without_friction - 1.0,
        sag_m,
        max_penetration_m,
    })
}

/// Solves `K u = f` densely for the beam under its own weight and half the box's under each of the box's corners.
///
/// Statics leaves friction open: how hard the box keeps the beam's upper side from shortening depends on how it settled.
/// So the horizontal forces are those that `stood` ended with; without them the beam would sag 2 % more. The point
/// supports rule out a converged solution to compare with: under a point, plane elasticity sinks in without bound as the
/// mesh is refined.
fn static_displacement(
    ratio: f64,
    stood: Option<&FlexBody>,
) -> Result<DVector<f64>, Box<dyn Error>> {
    let beam = beam(ratio).contact_inertia(ContactInertia::Kept).build()?;
    let stiffness = beam.model().stiffness();
    let n_nodes = beam.n_nodes();
    let mut matrix = DMatrix::zeros(2 * n_nodes, 2 * n_nodes);
    for row in 0..n_nodes {
        for &column in stiffness.neighbours(row) {
            let column = column as usize;
            if let Some(&[xx, xy, yx, yy]) = stiffness.block(row, column) {
                let entries = [((0, 0), xx), ((0, 1), xy), ((1, 0), yx), ((1, 1), yy)];
                for ((i, j), value) in entries {
                    matrix[(2 * row + i, 2 * column + j)] = value;
                }
            }
        }
    }
    let mut load = DVector::zeros(2 * n_nodes);
    for (node, mass) in beam.model().mass().node_sums().iter().enumerate() {
        load[2 * node] = stood.map_or(0.0, |stood| stood.contact_force(node)[0]);
        load[2 * node + 1] = -mass * GRAVITY;
    }
    // The box's corners stand over these nodes of the upper side.
    for column in [16, 24] {
        load[2 * node(column, DIVISIONS[1]) + 1] -= 0.5 * BEAM_MASS * ratio * GRAVITY;
    }
    for (dof, &is_fixed) in beam.fixed_dofs().iter().enumerate() {
        if is_fixed {
            matrix.row_mut(dof).fill(0.0);
            matrix.column_mut(dof).fill(0.0);
            matrix[(dof, dof)] = 1.0;
            load[dof] = 0.0;
        }
    }
    let factor = matrix
        .cholesky()
        .ok_or("the stiffness of the pinned beam is positive definite")?;
    Ok(factor.solve(&load))
}

#[allow(dead_code, reason = "tests call `run`")]
fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    let outcomes = run(&options)?;
    println!("box : beam   force / weight       jitter        sag   off static    overlap");
    for outcome in &outcomes {
        println!(
            "{:>6} : 1     {:.9}    {:.1e} m/s   {:.3} mm   {:+.4} %   {:.0e} m",
            outcome.ratio,
            outcome.force_over_weight,
            outcome.jitter_m_per_s,
            1e3 * outcome.sag_m,
            100.0 * outcome.sag_error,
            outcome.max_penetration_m,
        );
    }
    if options.json {
        print_json(&outcomes);
    }
    Ok(())
}
