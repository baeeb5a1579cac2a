//! A ball on a trampoline: a strip between two posts that is pulled taut, and the same strip slack.
//!
//! ```text
//!                 O   ball, 20 kg, falls 1 m
//!   |<--=========================-->|
//!   |        3 m, 8 mm thick        |     the ends are pinned, and drawn apart
//! ```
//!
//! The pins move the ends apart before the ball comes: tension before the load, as of any net. How deep the ball goes follows from energy: what
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
/// How far each end is drawn (m).
const DRAWN: f64 = 0.15;
/// Steps of drawing and of bouncing.
const DRAW: usize = 60;
const BOUNCE: usize = 300;

/// Headline numbers.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Outcome {
    /// On the strip that is pulled taut.
    pub taut: Bounce,
    /// On the same one as it is.
    pub slack: Bounce,
}

/// What one ball does.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Bounce {
    /// Tension before the ball comes (N), and what the neo-Hookean law that is Hooke's at rest says of a strip without weight: `E w h (λ - 1/λ)/2`.
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
    /// Pinned nodes, and which way they are drawn.
    ends: Vec<(usize, f64)>,
}

impl Scene {
    fn new() -> Result<Self, Box<dyn Error>> {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, -GRAVITY as Real);
        world.integration_parameters.dt = DT as Real;
        let at = HEIGHT + RADIUS + DROP;
        // It waits above until the strip is taut.
        let (ball, _) = world.insert(
            RigidBodyBuilder::dynamic()
                .translation(Vector::new(0.0, at as Real))
                .gravity_scale(0.0)
                .can_sleep(false),
            ColliderBuilder::ball(RADIUS as Real)
                .mass(MASS as Real)
                .friction(0.3),
        );
        let mut flex_bodies = FlexBodySet::new();
        let net = LinearElastic::plane_stress(YOUNG, 0.0).density(300.0);
        let is_end = |[x, _]: [f64; 2]| !(1e-9..=LENGTH - 1e-9).contains(&x);
        let strip = flex_bodies.insert(
            FlexBodyBuilder::rectangle([LENGTH, THICKNESS], [60, 1])
                .material(net.rayleigh(1e-4))
                .thickness(WIDTH)
                .translation([-0.5 * LENGTH, HEIGHT - THICKNESS])
                .friction(0.3)
                .pin_where(is_end, Pin::both()),
            &mut world,
        )?;
        let nodes = flex_bodies[strip].mesh().nodes().iter().enumerate();
        let ends = nodes.filter(|(_, at)| is_end(**at));
        let ends = ends
            .map(|(node, [x, _])| (node, (x - 0.5 * LENGTH).signum()))
            .collect();
        Ok(Self {
            world,
            flex_bodies,
            pipeline: FlexPipeline::new(),
            strip,
            ball,
            ends,
        })
    }

    fn draw_ends(&mut self, by: f64) -> Result<(), Box<dyn Error>> {
        let Some(strip) = self.flex_bodies.get_mut(self.strip) else {
            return Ok(());
        };
        for &(node, side) in &self.ends {
            strip.set_pin_displacement(node, [side * by, 0.0])?;
        }
        Ok(())
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
        let right = self.ends.iter().filter(|(_, side)| *side > 0.0);
        right.map(|&(node, _)| strip.reaction(node)[0]).sum()
    }

    fn draw(&self, film: &mut Film, time: f64) -> Result<(), Box<dyn Error>> {
        let strip = &self.flex_bodies[self.strip];
        let panel = film.panel(format!("{time:.2} s"));
        for side in [-1.0, 1.0] {
            let x = side * (0.5 * LENGTH + DRAWN);
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
    drawn: f64,
    n_steps: usize,
    mut film: Option<&mut Film>,
) -> Result<Bounce, Box<dyn Error>> {
    let mut scene = Scene::new()?;
    let half = 0.5 * LENGTH + drawn;
    let stretch = half / (0.5 * LENGTH);
    let expected = 0.5 * YOUNG * WIDTH * THICKNESS * (stretch - 1.0 / stretch);
    let mut bounce = Bounce {
        depth_m: [0.0, depth_of_threads(half)],
        tension_n: [0.0, expected],
        ..Bounce::default()
    };
    let brought = MASS * GRAVITY * (DROP + bounce.depth_m[1]);
    let (mut begin, mut lowest, mut is_back, mut highest) = (0.0, 0.0f64, false, 0.0f64);
    for step in 0..n_steps {
        if step < DRAW {
            scene.draw_ends(drawn * (step + 1) as f64 / DRAW as f64)?;
        } else if step == DRAW {
            bounce.tension_n[0] = scene.tension();
            begin = scene.energy();
            scene.world.bodies[scene.ball].set_gravity_scale(1.0, true);
        }
        let report = scene
            .pipeline
            .step(&mut scene.world, &mut scene.flex_bodies)?;
        bounce.unsolved += usize::from(report.quality() != Quality::Solved);
        bounce.max_penetration_m = bounce.max_penetration_m.max(report.gap_violation());
        if step > DRAW {
            let gained = (scene.energy() - begin) / brought;
            bounce.energy_gained = bounce.energy_gained.max(gained);
            lowest = lowest.min(scene.height());
            is_back |= lowest < 0.0 && scene.height() > 0.0;
            if is_back {
                highest = highest.max(scene.height());
            }
        }
        if let Some(film) = film.as_deref_mut()
            && step > DRAW
            && step % 20 == 0
            && step < DRAW + 180
        {
            scene.draw(film, (step - DRAW) as f64 * DT)?;
        }
    }
    bounce.depth_m[0] = -lowest;
    bounce.rebound = highest / DROP;
    Ok(bounce)
}

/// Both strips; pictures of the taut one go to `film` if there is one.
pub fn run(options: &Options, film: Option<&mut Film>) -> Result<Outcome, Box<dyn Error>> {
    let n_steps = options.n_steps(DRAW + BOUNCE);
    Ok(Outcome {
        taut: bounce(DRAWN, n_steps, film)?,
        slack: bounce(0.0, n_steps, None)?,
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
        vec!["A strip of 3 m by 8 mm, 2 MPa, drawn by a tenth; a ball of 20 kg.".to_owned()];
    let film = Film::new("Trampoline", notes, view, legend);
    film.record("trampoline", run)
}
