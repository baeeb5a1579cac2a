//! A jumper on a springboard: the board bends by three tenths of its length, and throws the jumper up again.
//!
//! ```text
//!                  O   jumper, 70 kg, falls .6 m
//!   |============-----      3 m, 40 mm thick
//!   clamp                   L = 2.75 m from the clamp to where the jumper stands
//! ```
//!
//! The board is light beside the jumper and has no weight here, so that the elastica, `EI θ'' = -P cos θ`, tells both how deep it sags under a jumper
//! who stands still and, by its energy, how deep one who falls goes: what the jumper loses in height the board stores.

pub mod support;

use foil2d::pipeline::{Participant, Quality};
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use serde::Serialize;
use std::error::Error;
use support::cli::Options;
use support::film::{Film, Legend, View};

const GRAVITY: f64 = 9.81;
const DT: f64 = 1.0 / 240.0;
const LENGTH: f64 = 3.0;
const THICKNESS: f64 = 0.04;
const WIDTH: f64 = 0.5;
const YOUNG: f64 = 7.7e9;
const MASS: f64 = 70.0;
const RADIUS: f64 = 0.1;
/// Where the jumper stands (m).
const PLACE: f64 = 2.75;
const DROP: f64 = 0.6;
/// Steps of the jump, and of coming to rest.
const JUMP: usize = 480;
const REST: usize = 1200;

/// Headline numbers; of pairs, the second is the elastica's.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Outcome {
    /// How deep the board is pressed where a jumper stands still on it (m).
    pub sag_m: [f64; 2],
    /// Force under that jumper over the weight (-).
    pub force_over_weight: f64,
    /// How deep it is pressed by the fall (m).
    pub depth_m: [f64; 2],
    /// Deepest place of the board's tip over the length (-).
    pub tip_over_length: f64,
    /// How high the jumper is thrown over how high the fall was, above the level board (-).
    pub rebound: f64,
    /// Most energy over that at the beginning, over what the fall brings (-).
    pub energy_gained: f64,
    /// Steps that were not solved as they are.
    pub unsolved: usize,
    /// Largest overlap told of in any step (m).
    pub max_penetration_m: f64,
}

struct Scene {
    world: PhysicsWorld,
    flex_bodies: FlexBodySet,
    pipeline: FlexPipeline,
    board: FlexBodyHandle,
    jumper: RigidBodyHandle,
    feet: ColliderHandle,
}

impl Scene {
    /// - `drop`: how far the jumper is above the board (m).
    /// - `damping`: stiffness damping of the board (s).
    fn new(drop: f64, damping: f64) -> Result<Self, Box<dyn Error>> {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, -GRAVITY as Real);
        world.integration_parameters.dt = DT as Real;
        let at = Vector::new(PLACE as Real, (RADIUS + drop) as Real);
        let (jumper, feet) = world.insert(
            RigidBodyBuilder::dynamic()
                .translation(at)
                .locked_axes(LockedAxes::ROTATION_LOCKED)
                .can_sleep(false),
            ColliderBuilder::ball(RADIUS as Real)
                .mass(MASS as Real)
                .friction(1.5),
        );
        let mut flex_bodies = FlexBodySet::new();
        let wood = LinearElastic::plane_stress(YOUNG, 0.0).density(100.0);
        let board = flex_bodies.insert(
            FlexBodyBuilder::rectangle_of([LENGTH, THICKNESS], [60, 1], CellKind::Tri6)
                .material(wood.rayleigh(damping))
                .thickness(WIDTH)
                .translation([0.0, -THICKNESS])
                .friction(1.5)
                .gravity_scale(0.0)
                .can_sleep(false)
                .pin_where(|[x, _]| x < 1e-9, Pin::both()),
            &mut world,
        )?;
        Ok(Self {
            world,
            flex_bodies,
            pipeline: FlexPipeline::new(),
            board,
            jumper,
            feet,
        })
    }

    /// Place of the jumper's middle (m).
    fn jumper(&self) -> [f64; 2] {
        let at = self.world.bodies[self.jumper].translation();
        [at.x, at.y].map(f64::from)
    }

    /// Kinetic, stored and potential energy (J).
    fn energy(&self) -> f64 {
        let own = self.flex_bodies[self.board].energy();
        let v = self.world.bodies[self.jumper].linvel();
        let [vx, vy] = [v.x, v.y].map(f64::from);
        let height = self.jumper()[1];
        own.kinetic + own.elastic + MASS * (0.5 * (vx * vx + vy * vy) + GRAVITY * height)
    }

    /// Where the feet touch, along the unbent board and below the level of its upper face (m), if they do.
    fn footprint(&self) -> Option<[f64; 2]> {
        let report = self.pipeline.report();
        let contacts = report.contacts_of(Participant::Rigid(self.feet));
        let pressed = contacts.max_by(|a, b| a.normal_force.total_cmp(&b.normal_force))?;
        let board = &self.flex_bodies[self.board];
        let nodes = board.mesh().nodes().iter().enumerate();
        let mut face: Vec<usize> = nodes
            .filter(|(_, at)| at[1] > THICKNESS - 1e-9)
            .map(|(node, _)| node)
            .collect();
        let along = |node: usize| board.mesh().nodes()[node][0];
        face.sort_by(|&a, &b| along(a).total_cmp(&along(b)));
        let place = face.windows(2).find_map(|ends| {
            let [from, to] = [board.position(ends[0])[0], board.position(ends[1])[0]];
            let share = (pressed.position[0] - from) / (to - from);
            let is_here = (0.0..=1.0).contains(&share);
            is_here.then(|| along(ends[0]) + share * (along(ends[1]) - along(ends[0])))
        })?;
        Some([place, -pressed.position[1]])
    }

    fn tip(&self) -> f64 {
        let board = &self.flex_bodies[self.board];
        let nodes = board.mesh().nodes().iter().enumerate();
        let at_end = nodes.filter(|(_, at)| at[0] > LENGTH - 1e-9);
        let heights = at_end.map(|(node, _)| board.position(node)[1] + 0.5 * THICKNESS);
        heights.fold(f64::INFINITY, f64::min)
    }

    fn draw(&self, film: &mut Film, time: f64) -> Result<(), Box<dyn Error>> {
        let board = &self.flex_bodies[self.board];
        let panel = film.panel(format!("{time:.2} s"));
        panel.line(
            [[0.0, -0.4], [0.0, 0.3]],
            "stroke=\"#555\" stroke-width=\"5\"",
        );
        panel.stress(board, 1e6)?;
        panel.disc(self.jumper(), RADIUS, "fill=\"#b33\"");
        panel.contact_forces(board);
        Ok(())
    }
}

/// How deep a dead load at `length` (m) presses the elastica (m), and what it stores (J): shooting for the end where the moment is none.
fn elastica(length: f64, load: f64) -> [f64; 2] {
    const N: usize = 2000;
    let bending = YOUNG * WIDTH * THICKNESS.powi(3) / 12.0;
    let ds = length / N as f64;
    // Angle below the level, its slope, depth and energy along the board, by the rule of Runge and Kutta.
    let shoot = |slope: f64| {
        let rate = |[angle, slope, ..]: [f64; 4]| {
            let bend = -load / bending * angle.cos();
            [slope, bend, angle.sin(), 0.5 * bending * slope * slope]
        };
        let mut at = [0.0, slope, 0.0, 0.0];
        for _ in 0..N {
            let on = |rate: [f64; 4], by: f64| [0, 1, 2, 3].map(|k| at[k] + by * rate[k]);
            let one = rate(at);
            let two = rate(on(one, 0.5 * ds));
            let three = rate(on(two, 0.5 * ds));
            let four = rate(on(three, ds));
            let mean = [0, 1, 2, 3].map(|k| (one[k] + 2.0 * (two[k] + three[k]) + four[k]) / 6.0);
            at = on(mean, ds);
        }
        at
    };
    // The end bends back if the slope at the clamp is too small.
    let (mut low, mut high) = (0.0, load * length / bending);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if shoot(middle)[1] < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let end = shoot(low);
    [end[2], end[3]]
}

/// How deep the elastica goes under a jumper who falls from `DROP` (m).
fn deepest() -> f64 {
    let weight = MASS * GRAVITY;
    let (mut low, mut high) = (weight, 20.0 * weight);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        let [depth, stored] = elastica(PLACE, middle);
        if stored < weight * (DROP + depth) {
            low = middle;
        } else {
            high = middle;
        }
    }
    elastica(PLACE, low)[0]
}

fn stand(n_steps: usize, outcome: &mut Outcome) -> Result<(), Box<dyn Error>> {
    let mut scene = Scene::new(0.0, 0.1)?;
    for _ in 0..n_steps {
        let report = scene
            .pipeline
            .step(&mut scene.world, &mut scene.flex_bodies)?;
        outcome.unsolved += usize::from(report.quality() != Quality::Solved);
    }
    let force = scene
        .pipeline
        .report()
        .force_on(Participant::Rigid(scene.feet));
    outcome.force_over_weight = force[1] / (MASS * GRAVITY);
    if let Some([place, depth]) = scene.footprint() {
        outcome.sag_m = [depth, elastica(place, MASS * GRAVITY)[0]];
    }
    Ok(())
}

fn jump(
    n_steps: usize,
    outcome: &mut Outcome,
    mut film: Option<&mut Film>,
) -> Result<(), Box<dyn Error>> {
    let mut scene = Scene::new(DROP, 1e-4)?;
    let begin = scene.energy();
    let brought = MASS * GRAVITY * DROP;
    let (mut lowest, mut tip, mut highest) = (0.0f64, 0.0f64, 0.0f64);
    let (mut is_down, mut is_up) = (false, false);
    for step in 0..n_steps {
        let report = scene
            .pipeline
            .step(&mut scene.world, &mut scene.flex_bodies)?;
        outcome.unsolved += usize::from(report.quality() != Quality::Solved);
        outcome.max_penetration_m = outcome.max_penetration_m.max(report.gap_violation());
        let gained = (scene.energy() - begin) / brought;
        outcome.energy_gained = outcome.energy_gained.max(gained);
        let height = scene.jumper()[1] - RADIUS;
        is_down |= height < -0.1;
        is_up |= is_down && height > 0.0;
        if is_up {
            highest = highest.max(height);
        } else {
            (lowest, tip) = (lowest.min(height), tip.min(scene.tip()));
        }
        if let Some(film) = film.as_deref_mut()
            && step % 36 == 0
            && step < 400
        {
            scene.draw(film, (step + 1) as f64 * DT)?;
        }
    }
    outcome.depth_m = [-lowest, deepest()];
    outcome.tip_over_length = -tip / LENGTH;
    outcome.rebound = highest / DROP;
    Ok(())
}

/// A jumper who stands and one who falls; pictures of the fall go to `film` if there is one.
pub fn run(options: &Options, film: Option<&mut Film>) -> Result<Outcome, Box<dyn Error>> {
    let mut outcome = Outcome::default();
    stand(options.n_steps(REST), &mut outcome)?;
    jump(options.n_steps(JUMP), &mut outcome, film)?;
    Ok(outcome)
}

#[allow(dead_code, reason = "tests call `run`")]
fn main() -> Result<(), Box<dyn Error>> {
    let view = View {
        x: [-0.1, 3.3],
        y: [-1.2, 0.9],
    };
    let legend = Legend {
        colours: "von Mises stress (MPa)".to_owned(),
        full: 40.0,
        arrow: [1.5e-4, 2000.0],
        longest: 0.6,
    };
    let notes = vec!["A board of 3 m by 40 mm, 7.7 GPa; a jumper of 70 kg.".to_owned()];
    let film = Film::new("Springboard", notes, view, legend);
    film.record("springboard", run)
}
