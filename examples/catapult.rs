//! A catapult: an arm that is drawn back, and throws a ball when it is let go.
//!
//! ```text
//!        lip
//!   O __/        the arm at rest stands up to the left by half a right angle;
//!       \        drawn back it lies nearly level, and the ball lies on it.
//!        \
//!         \ clamp
//! ---------------------------------- ground
//! ```
//!
//! A cord takes the end of the arm back and is let go of: `detach`. What the arm has stored it gives to the ball and to its own vibration;
//! of what the ball gets follow its speed and its range, `R = v cos φ (v sin φ + √(v² sin² φ + 2 g h))/g`.

pub mod support;

use foil2d::pipeline::Quality;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use serde::Serialize;
use std::error::Error;
use support::cli::Options;
use support::film::{Film, Legend, View};

const GRAVITY: f64 = 9.81;
const DT: f64 = 1.0 / 240.0;
/// The arm (m): its length, thickness, and the length and thickness of the lip at its end.
const LENGTH: f64 = 1.2;
const THICKNESS: f64 = 0.06;
const LIP: [f64; 2] = [0.06, 0.06];
const WIDTH: f64 = 0.1;
const YOUNG: f64 = 1e8;
/// Where the arm is clamped (m), and which way it points (rad).
const CLAMP: [f64; 2] = [0.0, 0.3];
const DIRECTION: f64 = 0.75 * std::f64::consts::PI;
/// Stiffness of the cord (N/m).
const CORD: f64 = 4000.0;
const RADIUS: f64 = 0.07;
const MASS: f64 = 1.0;
/// How far its end is drawn back (m), in so many steps, and those that the ball lies on it.
const DRAWN: f64 = 0.7;
const DRAW: usize = 240;
const WAIT: usize = 12;
const THROW: usize = 600;

/// Headline numbers.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Outcome {
    /// What the arm stores when it is let go of (J).
    pub stored_j: f64,
    /// Share of that in the ball's motion and height once it has left (-).
    pub efficiency: f64,
    /// The ball's speed (m/s) and direction above the level (degrees) then.
    pub speed_m_per_s: f64,
    pub elevation_deg: f64,
    /// How far from where it has left the arm the ball lands (m), and what the parabola says.
    pub range_m: [f64; 2],
    /// The range of a ball that gets all that is stored, at half a right angle and from the same height (m).
    pub ideal_range_m: f64,
    /// Most energy of arm and ball over that when the arm is let go of, over what is stored (-).
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
    arm: FlexBodyHandle,
    ball: RigidBodyHandle,
    hand: RigidBodyHandle,
    hold: AttachmentHandle,
}

fn vector([x, y]: [f64; 2]) -> Vector {
    Vector::new(x as Real, y as Real)
}

/// A place along the arm and above it as it stands undrawn (m), in the world (m).
fn place([along, above]: [f64; 2]) -> [f64; 2] {
    let (sin, cos) = DIRECTION.sin_cos();
    [
        CLAMP[0] + along * cos + above * sin,
        CLAMP[1] + along * sin - above * cos,
    ]
}

impl Scene {
    fn new() -> Result<Self, Box<dyn Error>> {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, -GRAVITY as Real);
        world.integration_parameters.dt = DT as Real;
        world.insert_collider(
            ColliderBuilder::cuboid(30.0, 0.5)
                .translation(vector([20.0, -0.5]))
                .friction(1.0),
            None,
        );
        let (ball, _) = world.insert(
            // It waits aside until the arm is drawn.
            RigidBodyBuilder::dynamic()
                .translation(vector([-3.0, 2.0]))
                .gravity_scale(0.0)
                .can_sleep(false),
            ColliderBuilder::ball(RADIUS as Real)
                .mass(MASS as Real)
                .friction(0.6),
        );
        let mut flex_bodies = FlexBodySet::new();
        // The upper face of the arm, on which the ball lies, is that to the right as it stands.
        let outline = [
            [0.0, 0.0],
            [0.0, -THICKNESS],
            [LENGTH, -THICKNESS],
            [LENGTH, LIP[0]],
            [LENGTH - LIP[1], LIP[0]],
            [LENGTH - LIP[1], 0.0],
        ];
        let outline: Vec<[f64; 2]> = outline.map(|[x, y]| [x, -y]).into_iter().rev().collect();
        let wood = LinearElastic::plane_stress(YOUNG, 0.3).density(300.0);
        let arm = flex_bodies.insert(
            FlexBodyBuilder::polygon(&outline, &[], 0.04)
                .material(wood.rayleigh(2e-4))
                .thickness(WIDTH)
                .translation(CLAMP)
                .rotation(DIRECTION)
                .friction(0.6)
                .pin_where(|[x, _]| x < 1e-9, Pin::both()),
            &mut world,
        )?;
        let hand = world.insert_body(
            RigidBodyBuilder::kinematic_position_based()
                .translation(vector(place([LENGTH, -THICKNESS]))),
        );
        // A cord, so that the end goes the way that the arm lets it.
        let end = AttachmentBuilder::spring_damper(arm, CORD, 40.0)
            .rest_length(0.0)
            .where_(|[x, y]| (x - LENGTH).abs() < 1e-9 && (y - THICKNESS).abs() < 1e-9);
        let hold = flex_bodies.attach(end.to_rigid_body(hand), &world.bodies)?;
        Ok(Self {
            world,
            flex_bodies,
            pipeline: FlexPipeline::new(),
            arm,
            ball,
            hand,
            hold,
        })
    }

    /// Draws the end back by so much (m), the way it goes under a load across: nearer to the clamp by 3/5 of the square over the length.
    fn draw_back(&mut self, by: f64) {
        let to = place([LENGTH - 0.6 * by * by / LENGTH, -by - THICKNESS]);
        self.world.bodies[self.hand].set_next_kinematic_translation(vector(to));
    }

    /// Lays the ball on the arm, beside the lip.
    fn load(&mut self) {
        let arm = &self.flex_bodies[self.arm];
        let nearest = |to: [f64; 2]| {
            let nodes = arm.mesh().nodes().iter().enumerate();
            let apart = |at: &[f64; 2]| (at[0] - to[0]).hypot(at[1] - to[1]);
            let found = nodes.min_by(|a, b| apart(a.1).total_cmp(&apart(b.1)));
            arm.position(found.map_or(0, |(node, _)| node))
        };
        let corner = nearest([LENGTH - LIP[1], 0.0]);
        let before = nearest([LENGTH - LIP[1] - 2.0 * RADIUS, 0.0]);
        let [x, y] = [corner[0] - before[0], corner[1] - before[1]];
        let length = x.hypot(y);
        let [x, y] = [x / length, y / length];
        let at = [
            corner[0] + RADIUS * (-1.1 * x + 1.1 * y),
            corner[1] + RADIUS * (-1.1 * y - 1.1 * x),
        ];
        let ball = &mut self.world.bodies[self.ball];
        ball.set_translation(vector(at), true);
        ball.set_gravity_scale(1.0, true);
    }

    fn step(&mut self, outcome: &mut Outcome) -> Result<(), Box<dyn Error>> {
        let report = self.pipeline.step(&mut self.world, &mut self.flex_bodies)?;
        outcome.unsolved += usize::from(report.quality() != Quality::Solved);
        outcome.max_penetration_m = outcome.max_penetration_m.max(report.gap_violation());
        Ok(())
    }

    fn ball(&self) -> [f64; 2] {
        let at = self.world.bodies[self.ball].translation();
        [at.x, at.y].map(f64::from)
    }

    fn velocity(&self) -> [f64; 2] {
        let v = self.world.bodies[self.ball].linvel();
        [v.x, v.y].map(f64::from)
    }

    /// Kinetic and potential energy of the ball (J).
    fn ball_energy(&self) -> f64 {
        let [vx, vy] = self.velocity();
        let spin = f64::from(self.world.bodies[self.ball].angvel());
        let spin = 0.5 * RADIUS * RADIUS * spin * spin;
        MASS * (0.5 * (vx * vx + vy * vy + spin) + GRAVITY * self.ball()[1])
    }

    /// Energy of arm and ball (J).
    fn energy(&self) -> f64 {
        let arm = &self.flex_bodies[self.arm];
        let own = arm.energy();
        let height = arm.centre_of_mass()[1];
        own.kinetic + own.elastic + arm.mass() * GRAVITY * height + self.ball_energy()
    }

    fn draw(&self, film: &mut Film, time: f64) -> Result<(), Box<dyn Error>> {
        let arm = &self.flex_bodies[self.arm];
        let panel = film.panel(format!("{time:.2} s"));
        panel.line(
            [[-3.0, 0.0], [12.0, 0.0]],
            "stroke=\"#555\" stroke-width=\"3\"",
        );
        panel.stress(arm, 1e6)?;
        panel.disc(self.ball(), RADIUS, "fill=\"#b33\"");
        panel.contact_forces(arm);
        Ok(())
    }
}

/// How far a ball flies that leaves at this height above where it lands (m) with this speed (m/s) and angle above the level (rad).
fn range(height: f64, speed: f64, angle: f64) -> f64 {
    let [along, up] = [speed * angle.cos(), speed * angle.sin()];
    along * (up + (up * up + 2.0 * GRAVITY * height).sqrt()) / GRAVITY
}

/// Draws the arm back, lets it go and waits for the ball to land; pictures go to `film` if there is one.
pub fn run(options: &Options, mut film: Option<&mut Film>) -> Result<Outcome, Box<dyn Error>> {
    let mut outcome = Outcome::default();
    let mut scene = Scene::new()?;
    let n_steps = options.n_steps(DRAW + WAIT + THROW);
    let (mut begin, mut ball_before) = (0.0, 0.0);
    let (mut left, mut last_touch, mut landed) = (None, 0, None);
    for step in 0..n_steps {
        if step == DRAW {
            scene.load();
        }
        if step < DRAW {
            scene.draw_back(DRAWN * (step + 1) as f64 / DRAW as f64);
        } else if step == DRAW + WAIT {
            outcome.stored_j = scene.flex_bodies[scene.arm].energy().elastic;
            (begin, ball_before) = (scene.energy(), scene.ball_energy());
            scene.flex_bodies.detach(scene.hold)?;
        }
        scene.step(&mut outcome)?;
        if step >= DRAW + WAIT && landed.is_none() {
            let gained = (scene.energy() - begin) / outcome.stored_j;
            outcome.energy_gained = outcome.energy_gained.max(gained);
            let touches = !scene.pipeline.report().contacts().is_empty();
            let is_low = scene.ball()[1] < RADIUS + 1e-3;
            if touches && !is_low {
                last_touch = step;
                left = None;
            } else if left.is_none() && step > last_touch + 2 {
                left = Some((scene.ball(), scene.velocity(), scene.ball_energy()));
            }
            if is_low && left.is_some() {
                landed = Some(scene.ball());
            }
        }
        if let Some(film) = film.as_deref_mut()
            && (step == DRAW / 2
                || step >= DRAW + WAIT - 1
                    && (step - DRAW - WAIT + 1).is_multiple_of(12)
                    && step < DRAW + WAIT + 120)
        {
            scene.draw(film, (step + 1) as f64 * DT)?;
        }
    }
    if let Some((from, [vx, vy], energy)) = left {
        let (speed, angle) = (vx.hypot(vy), vy.atan2(vx));
        let height = from[1] - RADIUS;
        outcome.speed_m_per_s = speed;
        outcome.elevation_deg = angle.to_degrees();
        outcome.efficiency = (energy - ball_before) / outcome.stored_j;
        outcome.range_m[1] = range(height, speed, angle);
        if let Some(landed) = landed {
            outcome.range_m[0] = landed[0] - from[0];
        }
        let all = (2.0 * (outcome.stored_j + ball_before) / MASS - 2.0 * GRAVITY * from[1]).sqrt();
        outcome.ideal_range_m = range(height, all, std::f64::consts::FRAC_PI_4);
    }
    Ok(outcome)
}

#[allow(dead_code, reason = "tests call `run`")]
fn main() -> Result<(), Box<dyn Error>> {
    let view = View {
        x: [-1.6, 3.4],
        y: [-0.1, 3.4],
    };
    let legend = Legend {
        colours: "von Mises stress (MPa)".to_owned(),
        full: 8.0,
        arrow: [1e-3, 200.0],
        longest: 0.6,
    };
    let notes = vec!["An arm of 1.2 m by 60 mm, 100 MPa; a ball of 1 kg.".to_owned()];
    let film = Film::new("Catapult", notes, view, legend);
    film.record("catapult", run)
}
