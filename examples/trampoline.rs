//! A ball on a trampoline: a strip between two posts that is built taut, and the same strip slack.
//!
//! ```text
//!                 O   ball, 20 kg, falls 1 m
//!   |<--=========================-->|
//!   |        3 m, 8 mm thick        |     the ends are pinned, 3.3 m from each other
//! ```
//!
//! `pre_stretch` builds it under tension: as long as its posts are apart, and a tenth less free of stress. How deep the ball goes follows from energy: what
//! it loses in height the strip stores.

pub mod support;

use foil2d::pipeline::Quality;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use serde::Serialize;
use std::error::Error;
use support::cli::Options;
use support::film::{Film, Legend, View};

const GRAVITY: f64 = 9.81;
const DT: f64 = 1.0 / 120.0;
const LENGTH: f64 = 3.0;
const THICKNESS: f64 = 0.008;
const HEIGHT: f64 = 1.2;
const WIDTH: f64 = 0.5;
const YOUNG: f64 = 2e6;
const MASS: f64 = 20.0;
const RADIUS: f64 = 0.15;
const DROP: f64 = 1.0;
/// How much longer than free of stress the taut strip is (-).
const STRETCH: f64 = 1.1;
const STEPS: usize = 300;

/// Headline numbers.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Outcome {
    /// On the strip that is built taut.
    pub taut: Bounce,
    /// On the same one as it is.
    pub slack: Bounce,
}

/// What one ball does.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Bounce {
    /// Tension in the first step (N), and what the neo-Hookean law that is Hooke's at rest says: `E w h (λ - 1/λ)/2`.
    pub tension_n: [f64; 2],
    /// How deep the ball's lowest point goes below the posts (m), and what energy says of two straight threads without weight that obey Hooke's law.
    pub depth_m: [f64; 2],
    /// How high the ball comes back over how high it fell from, above the posts (-).
    pub rebound: f64,
    /// Most energy over that at the beginning of the fall, over what the fall brings (-).
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
    strip: FlexBodyHandle,
    ball: RigidBodyHandle,
    /// Pinned nodes of the right end.
    right: Vec<usize>,
}

impl Scene {
    /// A strip that is so much longer than free of stress.
    fn new(stretch: f64) -> Result<Self, Box<dyn Error>> {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, -GRAVITY as Real);
        world.integration_parameters.dt = DT as Real;
        let at = HEIGHT + RADIUS + DROP;
        let (ball, _) = world.insert(
            RigidBodyBuilder::dynamic()
                .translation(Vector::new(0.0, at as Real))
                .can_sleep(false),
            ColliderBuilder::ball(RADIUS as Real)
                .mass(MASS as Real)
                .friction(0.3),
        );
        let mut flex_bodies = FlexBodySet::new();
        let net = LinearElastic::plane_stress(YOUNG, 0.0).density(300.0);
        let span = stretch * LENGTH;
        let is_right = move |[x, _]: [f64; 2]| x > span - 1e-9;
        let strip = flex_bodies.insert(
            FlexBodyBuilder::rectangle([span, THICKNESS], [60, 1])
                .material(net.rayleigh(1e-4))
                .thickness(WIDTH)
                .pre_stretch(PreStretch::along_x(stretch))
                .translation([-0.5 * span, HEIGHT - THICKNESS])
                .friction(0.3)
                .pin_where(move |at| at[0] < 1e-9 || is_right(at), Pin::both()),
            &mut world,
        )?;
        let nodes = flex_bodies[strip].mesh().nodes().iter().enumerate();
        let right = nodes.filter(|(_, at)| is_right(**at));
        let right = right.map(|(node, _)| node).collect();
        Ok(Self {
            world,
            flex_bodies,
            pipeline: FlexPipeline::new(),
            strip,
            ball,
            right,
        })
    }

    /// Height of the ball's lowest point above the posts (m).
    fn height(&self) -> f64 {
        f64::from(self.world.bodies[self.ball].translation().y) - RADIUS - HEIGHT
    }

    /// Kinetic, stored and potential energy (J).
    fn energy(&self) -> f64 {
        let strip = &self.flex_bodies[self.strip];
        let own = strip.energy();
        let ball = &self.world.bodies[self.ball];
        let [vx, vy, spin] = [ball.linvel().x, ball.linvel().y, ball.angvel()].map(f64::from);
        let spin = 0.5 * RADIUS * RADIUS * spin * spin;
        own.kinetic
            + own.elastic
            + GRAVITY * strip.mass() * strip.centre_of_mass()[1]
            + MASS * (0.5 * (vx * vx + vy * vy + spin) + GRAVITY * (self.height() + HEIGHT))
    }

    /// Force that holds the right end, along the strip (N).
    fn tension(&self) -> f64 {
        let strip = &self.flex_bodies[self.strip];
        let right = self.right.iter();
        right.map(|&node| strip.reaction(node)[0]).sum()
    }

    fn draw(&self, film: &mut Film, time: f64) -> Result<(), Box<dyn Error>> {
        let strip = &self.flex_bodies[self.strip];
        let panel = film.panel(format!("{time:.2} s"));
        for side in [-1.0, 1.0] {
            let x = side * 0.5 * STRETCH * LENGTH;
            panel.line(
                [[x, 0.0], [x, HEIGHT]],
                "stroke=\"#555\" stroke-width=\"4\"",
            );
        }
        panel.stress(strip, 1e3)?;
        let at = self.world.bodies[self.ball].translation();
        panel.disc([at.x, at.y].map(f64::from), RADIUS, "fill=\"#b33\"");
        panel.contact_forces(strip);
        Ok(())
    }
}

/// Two threads of this length at rest (m), each drawn from the middle to a post `half` away: how deep they are when they have stored what a fall from `DROP` brings (m).
fn depth_of_threads(half: f64) -> f64 {
    let rest = 0.5 * LENGTH;
    let stiffness = YOUNG * WIDTH * THICKNESS / rest;
    let stored = |depth: f64| {
        let stretch = (half.hypot(depth) - rest).max(0.0);
        stiffness * stretch * stretch
    };
    let (mut low, mut high) = (0.0, 4.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let brought = MASS * GRAVITY * (DROP + middle);
        if stored(middle) - stored(0.0) < brought {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

fn bounce(
    stretch: f64,
    n_steps: usize,
    mut film: Option<&mut Film>,
) -> Result<Bounce, Box<dyn Error>> {
    let mut scene = Scene::new(stretch)?;
    let expected = 0.5 * YOUNG * WIDTH * THICKNESS * (stretch - 1.0 / stretch);
    let mut bounce = Bounce {
        depth_m: [0.0, depth_of_threads(0.5 * stretch * LENGTH)],
        tension_n: [0.0, expected],
        ..Bounce::default()
    };
    let brought = MASS * GRAVITY * (DROP + bounce.depth_m[1]);
    let begin = scene.energy();
    let (mut lowest, mut is_back, mut highest) = (0.0f64, false, 0.0f64);
    for step in 0..n_steps {
        let report = scene
            .pipeline
            .step(&mut scene.world, &mut scene.flex_bodies)?;
        bounce.unsolved += usize::from(report.quality() != Quality::Solved);
        bounce.max_penetration_m = bounce.max_penetration_m.max(report.gap_violation());
        if step == 0 {
            bounce.tension_n[0] = scene.tension();
        }
        let gained = (scene.energy() - begin) / brought;
        bounce.energy_gained = bounce.energy_gained.max(gained);
        lowest = lowest.min(scene.height());
        is_back |= lowest < 0.0 && scene.height() > 0.0;
        if is_back {
            highest = highest.max(scene.height());
        }
        if let Some(film) = film.as_deref_mut()
            && step % 20 == 19
            && step < 180
        {
            scene.draw(film, (step + 1) as f64 * DT)?;
        }
    }
    bounce.depth_m[0] = -lowest;
    bounce.rebound = highest / DROP;
    Ok(bounce)
}

/// Both strips; pictures of the taut one go to `film` if there is one.
pub fn run(options: &Options, film: Option<&mut Film>) -> Result<Outcome, Box<dyn Error>> {
    let n_steps = options.n_steps(STEPS);
    Ok(Outcome {
        taut: bounce(STRETCH, n_steps, film)?,
        slack: bounce(1.0, n_steps, None)?,
    })
}

#[allow(dead_code, reason = "tests call `run`")]
fn main() -> Result<(), Box<dyn Error>> {
    let view = View {
        x: [-1.8, 1.8],
        y: [0.0, 2.6],
    };
    let legend = Legend {
        colours: "von Mises stress (kPa)".to_owned(),
        full: 600.0,
        arrow: [2e-4, 1000.0],
        longest: 0.5,
    };
    let notes =
        vec!["A strip of 3 m by 8 mm, 2 MPa, built longer by a tenth; a ball of 20 kg.".to_owned()];
    let film = Film::new("Trampoline", notes, view, legend);
    film.record("trampoline", run)
}
