//! A rope of large strain swings down with a ball at its end, meets a peg and winds around it.
//!
//! ```text
//!   pin o=============================O ball, 2 kg
//!              2.4 m, .04 m thick
//!               (o) peg
//! ```
//!
//! The rope is a strip one cell thick of a corotated material, 20 MPa: it turns by more than a whole turn, carries the ball, and bends
//! as stiff as it is. Nothing brings energy but gravity, and what the film's colours show is Cauchy's stress.

pub mod support;

use foil2d::fe::material::Rayleigh;
use foil2d::pipeline::Quality;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use serde::Serialize;
use std::error::Error;
use support::cli::Options;
use support::doctor::require_sound;
use support::film::{Film, Legend, View};

const LENGTH: f64 = 2.4;
const THICKNESS: f64 = 0.04;
const HEIGHT: f64 = 3.0;
const PEG: [f64; 2] = [0.2, 1.9];
const PEG_RADIUS: f64 = 0.12;
const BALL_RADIUS: f64 = 0.1;
const DT: f64 = 1.0 / 120.0;
const GRAVITY: f64 = 9.81;

/// The headline numbers.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Outcome {
    pub steps: usize,
    /// Steps that were not solved as they are.
    pub unsolved: usize,
    /// Largest energy over that at the beginning, less what the fall brought, over that (-).
    pub energy_gained: f64,
    /// Largest length of the rope's middle line over that at rest (-).
    pub longest: f64,
    /// Largest turn of the ball about the peg (rad).
    pub wound: f64,
    /// Largest overlap told of in any step (m).
    pub max_penetration_m: f64,
    /// Largest force on the rope while it touches the peg (N).
    pub peg_force_n: f64,
    /// Largest von Mises stress (Pa).
    pub von_mises_pa: f64,
}

struct Scene {
    world: PhysicsWorld,
    flex_bodies: FlexBodySet,
    pipeline: FlexPipeline,
    rope: FlexBodyHandle,
    ball: RigidBodyHandle,
}

impl Scene {
    fn new() -> Result<Self, Box<dyn Error>> {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, -GRAVITY as Real);
        world.integration_parameters.dt = DT as Real;
        let peg = ColliderBuilder::ball(PEG_RADIUS as Real).friction(0.6);
        world.insert_collider(
            peg.translation(Vector::new(PEG[0] as Real, PEG[1] as Real)),
            None,
        );
        let at = [LENGTH + BALL_RADIUS, HEIGHT + 0.5 * THICKNESS];
        let (ball, _) = world.insert(
            RigidBodyBuilder::dynamic().translation(Vector::new(at[0] as Real, at[1] as Real)),
            ColliderBuilder::ball(BALL_RADIUS as Real).mass(2.0),
        );
        let mut flex_bodies = FlexBodySet::new();
        let solid = HyperelasticSolid::new(Corotated::plane_strain(2e7, 0.3))
            .with_density(1000.0)
            .with_damping(Rayleigh {
                mass: 0.0,
                stiffness: 1e-4,
            });
        let rope = flex_bodies.insert(
            FlexBodyBuilder::rectangle_of([LENGTH, THICKNESS], [60, 1], CellKind::Tri6)
                .material(solid)
                .thickness(THICKNESS)
                .translation([0.0, HEIGHT])
                .friction(0.6),
            &mut world,
        )?;
        let begin = AttachmentBuilder::pin(rope).where_(|[x, _]| x < 1e-9);
        flex_bodies.attach(begin.to_world(), &world.bodies)?;
        let end = AttachmentBuilder::pin(rope).where_(|[x, _]| x > LENGTH - 1e-9);
        flex_bodies.attach(end.to_rigid_body(ball), &world.bodies)?;
        Ok(Self {
            world,
            flex_bodies,
            pipeline: FlexPipeline::new(),
            rope,
            ball,
        })
    }

    fn body(&self) -> &FlexBody {
        &self.flex_bodies[self.rope]
    }

    fn ball_at(&self) -> [f64; 2] {
        let at = self.world.bodies[self.ball].translation();
        [at.x, at.y].map(f64::from)
    }

    /// Kinetic, stored and potential energy (J).
    fn energy(&self) -> f64 {
        let body = self.body();
        let own = body.energy();
        let ball = &self.world.bodies[self.ball];
        let (mass, v, spin) = (
            f64::from(ball.mass()),
            ball.linvel(),
            f64::from(ball.angvel()),
        );
        let [vx, vy] = [v.x, v.y].map(f64::from);
        let inertia = 0.5 * mass * BALL_RADIUS * BALL_RADIUS;
        let height = body.mass() * body.centre_of_mass()[1] + mass * self.ball_at()[1];
        own.kinetic
            + own.elastic
            + GRAVITY * height
            + 0.5 * (mass * (vx * vx + vy * vy) + inertia * spin * spin)
    }

    /// Length of the lower edge and the upper one, their mean (m).
    fn length(&self) -> f64 {
        let body = self.body();
        let edge = |y: f64| {
            let nodes = body.mesh().nodes();
            let mut along: Vec<usize> = (0..nodes.len())
                .filter(|&node| (nodes[node][1] - y).abs() < 1e-9)
                .collect();
            along.sort_by(|&a, &b| nodes[a][0].total_cmp(&nodes[b][0]));
            let lengths = along.windows(2).map(|pair| {
                let [from, to] = [pair[0], pair[1]].map(|node| body.position(node));
                (to[0] - from[0]).hypot(to[1] - from[1])
            });
            lengths.sum::<f64>()
        };
        0.5 * (edge(0.0) + edge(THICKNESS))
    }

    fn draw(&self, film: &mut Film, time: f64) -> Result<(), Box<dyn Error>> {
        let body = self.body();
        let panel = film.panel(format!("{time:.2} s"));
        panel.disc(PEG, PEG_RADIUS, "fill=\"#555\"");
        panel.stress(body, 1e6)?;
        panel.disc(self.ball_at(), BALL_RADIUS, "fill=\"#b33\"");
        panel.contact_forces(body);
        Ok(())
    }
}

/// Lets the rope swing for four seconds; pictures go to `film` if there is one.
pub fn run(options: &Options, mut film: Option<&mut Film>) -> Result<Outcome, Box<dyn Error>> {
    let mut scene = Scene::new()?;
    require_sound(&scene.world, &scene.flex_bodies, &scene.pipeline)?;
    let mut outcome = Outcome {
        steps: options.n_steps(480),
        ..Outcome::default()
    };
    let begin = scene.energy();
    let brought = GRAVITY * LENGTH * (2.0 + 0.5 * scene.body().mass());
    let mut most = begin;
    let (mut turned, mut last) = (0.0f64, None::<f64>);
    let every = (outcome.steps / 8).max(1);
    let mut recorder = options.recorder("A rope swings around a peg");
    for step in 0..outcome.steps {
        let report = scene
            .pipeline
            .step(&mut scene.world, &mut scene.flex_bodies)?;
        outcome.unsolved += usize::from(report.quality() != Quality::Solved);
        outcome.max_penetration_m = outcome.max_penetration_m.max(report.gap_violation());
        let touches = !report.contacts().is_empty();
        let force = scene.body().total_contact_force();
        if touches {
            outcome.peg_force_n = outcome.peg_force_n.max(force[0].hypot(force[1]));
        }
        let time = (step + 1) as f64 * DT;
        recorder.record(time, &scene.world, &scene.flex_bodies, &scene.pipeline)?;
        most = most.max(scene.energy());
        outcome.longest = outcome.longest.max(scene.length() / LENGTH);
        let [x, y] = scene.ball_at();
        let angle = (y - PEG[1]).atan2(x - PEG[0]);
        if let Some(before) = last {
            let change = angle - before;
            turned += change - std::f64::consts::TAU * (change / std::f64::consts::TAU).round();
        }
        last = Some(angle);
        outcome.wound = outcome.wound.max(turned.abs());
        let largest = scene.body().von_mises()?.into_iter().fold(0.0, f64::max);
        outcome.von_mises_pa = outcome.von_mises_pa.max(largest);
        if let Some(film) = film.as_deref_mut()
            && step % every == every - 1
        {
            scene.draw(film, (step + 1) as f64 * DT)?;
        }
    }
    recorder.write()?;
    outcome.energy_gained = (most - begin) / brought;
    Ok(outcome)
}

#[allow(dead_code, reason = "tests call `run`")]
fn main() -> Result<(), Box<dyn Error>> {
    let view = View {
        x: [-1.5, 2.7],
        y: [0.2, 3.4],
    };
    let legend = Legend {
        colours: "von Mises stress (MPa)".to_owned(),
        full: 2.0,
        arrow: [4e-4, 1000.0],
        longest: 0.4,
    };
    let notes =
        vec!["A rope, 2.4 m by 40 mm, 20 MPa, with a ball of 2 kg; a fixed peg.".to_owned()];
    let film = Film::new("Rope around a peg", notes, view, legend);
    film.record("rope", run)
}
