//! The bridge, the truck and the crates, in SI units; the origin is at mid-span, on the level of the bearings.

use foil2d::body::FlexBody;
use foil2d::pipeline::Participant;
use foil2d::prelude::*;
use foil2d::rapier::math::Real;
use foil2d::rapier::prelude::*;

/// Gravity of rapier's default world (m/s²).
pub const GRAVITY: f64 = 9.81;
/// Length, depth and width of the deck (m).
pub const DECK: [f64; 3] = [22.0, 0.6, 0.3];
/// Clear span between the piers (m).
pub const SPAN: f64 = 20.0;
/// Half extents of a pier (m).
pub const PIER: [f64; 2] = [0.75, 1.5];
/// Young's modulus (Pa), Poisson's ratio (-), density (kg/m³) and yield stress (Pa) of the deck.
pub const STEEL: [f64; 4] = [2.1e11, 0.3, 7800.0, 2.35e8];
/// Damping ratio of the first bending mode of the bare deck (-).
pub const DAMPING_RATIO: f64 = 0.05;

const WHEEL_RADIUS: f64 = 0.5;
const WHEEL_MASS: f64 = 500.0;
const TRUCK_START: f64 = -7.0;
const TRUCK_SPEED: f64 = 6.0;
/// Coefficient of the brakes, which rub on the wheels (-).
const BRAKE: f64 = 0.2;

/// What may be varied: the mesh and the integrator.
#[derive(Clone, Copy, Debug)]
pub struct Setup {
    /// Cells along and across the deck.
    pub divisions: [usize; 2],
    /// Step length (s).
    pub dt: f64,
    /// The integrator.
    pub integrator: Beta2,
}

/// A rigid body of the scene.
#[derive(Clone, Copy, Debug)]
pub struct Member {
    /// What it is called in the summary.
    pub name: &'static str,
    /// Its handle in rapier's world.
    pub handle: RigidBodyHandle,
}

/// A crate that the crane lets go at a given time.
struct Crate {
    name: &'static str,
    time: f64,
    /// Side (m), mass (kg), position of the centre (m), angle (rad).
    side: f64,
    mass: f64,
    at: [f64; 2],
    angle: f64,
}

/// Everything that moves, and what it stands on.
pub struct Scene {
    pub world: PhysicsWorld,
    pub flex_bodies: FlexBodySet,
    pub flex: FlexPipeline,
    pub deck: FlexBodyHandle,
    pub piers: [ColliderHandle; 2],
    pub members: Vec<Member>,
    waiting: Vec<Crate>,
    n_steps: usize,
    dt: f64,
}

fn vector(x: f64, y: f64) -> Vector {
    Vector::new(x as Real, y as Real)
}

/// First bending frequency of the bare deck on its clear span (rad/s): `(π/L)² sqrt(EI/ρA)`.
pub fn first_frequency() -> f64 {
    let [young, _, density, _] = STEEL;
    let radius_of_gyration = DECK[1] / 12f64.sqrt();
    (std::f64::consts::PI / SPAN).powi(2) * radius_of_gyration * (young / density).sqrt()
}

impl Scene {
    /// The bridge at rest on its falsework, the truck rolling onto it, the crates on the crane.
    pub fn new(setup: &Setup) -> Result<Self, Box<dyn std::error::Error>> {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = setup.dt as Real;
        let piers = [(-1.0, 0.6), (1.0, 0.03)].map(|(side, friction)| {
            // A fixed bearing on the left, a sliding one on the right.
            let centre = vector(side * (0.5 * SPAN + PIER[0]), -PIER[1]);
            let pier = ColliderBuilder::cuboid(PIER[0] as Real, PIER[1] as Real)
                .translation(centre)
                .friction(friction as Real)
                .friction_combine_rule(CoefficientCombineRule::Min);
            world.insert_collider(pier, None)
        });
        let mut flex_bodies = FlexBodySet::new();
        let deck = flex_bodies.insert(deck(setup), &mut world)?;
        let mut scene = Self {
            flex: FlexPipeline::new().with_integrator(setup.integrator),
            world,
            flex_bodies,
            deck,
            piers,
            members: Vec::new(),
            waiting: crates(),
            n_steps: 0,
            dt: setup.dt,
        };
        scene.insert_truck();
        Ok(scene)
    }

    /// Lets go what is due and takes one step.
    pub fn step(&mut self) -> Result<(), Box<dyn std::error::Error>> {
        let time = self.time();
        while self.waiting.first().is_some_and(|next| next.time <= time) {
            let next = self.waiting.remove(0);
            self.insert_crate(&next);
        }
        self.flex.step(&mut self.world, &mut self.flex_bodies)?;
        self.n_steps += 1;
        Ok(())
    }

    /// Time since the falsework was removed (s).
    pub fn time(&self) -> f64 {
        self.n_steps as f64 * self.dt
    }

    /// The deck.
    pub fn deck(&self) -> &FlexBody {
        &self.flex_bodies[self.deck]
    }

    /// Weight of everything that is in the scene (N).
    pub fn weight(&self) -> f64 {
        let rigid: f64 = self
            .members
            .iter()
            .map(|member| f64::from(self.world.bodies[member.handle].mass()))
            .sum();
        GRAVITY * (rigid + self.deck().mass())
    }

    /// Vertical forces of the two piers on the deck in the last step (N).
    pub fn support_forces(&self) -> [f64; 2] {
        self.piers.map(|pier| {
            let [_, on_pier] = self.flex.report().force_on(Participant::Rigid(pier));
            -on_pier
        })
    }

    /// Speed of the fastest point of a rigid body, bounded from above (m/s).
    pub fn speed(&self, member: &Member) -> f64 {
        let body = &self.world.bodies[member.handle];
        let reach = body
            .colliders()
            .iter()
            .map(|&handle| {
                let collider = &self.world.colliders[handle];
                let offset = collider.translation() - body.center_of_mass();
                f64::from(offset.length() + collider.shape().compute_local_bounding_sphere().radius)
            })
            .fold(0.0, f64::max);
        f64::from(body.linvel().length()) + reach * f64::from(body.angvel().abs())
    }

    /// Largest speed of any rigid body or node (m/s).
    pub fn largest_speed(&self) -> f64 {
        let nodes = self.deck().velocities().chunks_exact(2);
        let nodes = nodes.map(|v| v[0].hypot(v[1]));
        let rigid = self.members.iter().map(|member| self.speed(member));
        nodes.chain(rigid).fold(0.0, f64::max)
    }

    /// Whether all positions and velocities are finite.
    pub fn is_finite(&self) -> bool {
        let deck = self.deck();
        let mut dofs = deck.positions().iter().chain(deck.velocities());
        dofs.all(|x| x.is_finite())
            && self.members.iter().all(|member| {
                let body = &self.world.bodies[member.handle];
                let pose = body.position();
                [
                    pose.translation.x,
                    pose.translation.y,
                    pose.rotation.angle(),
                    body.linvel().x,
                    body.linvel().y,
                    body.angvel(),
                ]
                .iter()
                .all(|x| x.is_finite())
            })
    }

    /// Two wheels, and a body whose frame rests on them between guards: the frame rubs on the wheels as a brake.
    fn insert_truck(&mut self) {
        let top = DECK[1];
        let frame_y = top + 2.0 * WHEEL_RADIUS;
        let cuboid = |half: [f64; 2], at: [f64; 2], mass: f64| {
            ColliderBuilder::cuboid(half[0] as Real, half[1] as Real)
                .translation(vector(at[0], at[1]))
                .mass(mass as Real)
                .friction(0.6)
        };
        let brake = |collider: ColliderBuilder| {
            collider
                .friction(BRAKE as Real)
                .friction_combine_rule(CoefficientCombineRule::Min)
        };
        let body = RigidBodyBuilder::dynamic()
            .translation(vector(TRUCK_START, frame_y))
            .linvel(vector(TRUCK_SPEED, 0.0));
        let body = self.world.insert_body(body);
        let mut parts = vec![
            brake(cuboid([3.2, 0.1], [0.0, 0.1], 3000.0)),
            cuboid([3.2, 0.1], [0.0, 0.3], 3000.0),
            cuboid([0.8, 0.75], [2.4, 1.15], 3500.0),
            cuboid([0.06, 0.25], [-3.13, 0.65], 300.0),
        ];
        for axle in [-1.9, 1.9] {
            for side in [-1.0, 1.0] {
                let guard = axle + side * (WHEEL_RADIUS + 0.102);
                parts.push(brake(cuboid([0.1, 0.3], [guard, -0.3], 300.0)));
            }
        }
        for part in parts {
            self.world.insert_collider(part, Some(body));
        }
        self.members.push(Member {
            name: "truck",
            handle: body,
        });
        for (name, axle) in [("rear wheels", -1.9), ("front wheels", 1.9)] {
            let wheel = RigidBodyBuilder::dynamic()
                .translation(vector(TRUCK_START + axle, top + WHEEL_RADIUS))
                .linvel(vector(TRUCK_SPEED, 0.0))
                .angvel((-TRUCK_SPEED / WHEEL_RADIUS) as Real);
            let handle = self.world.insert_body(wheel);
            let tyre = ColliderBuilder::ball(WHEEL_RADIUS as Real)
                .mass(WHEEL_MASS as Real)
                .friction(0.8);
            self.world.insert_collider(tyre, Some(handle));
            self.members.push(Member { name, handle });
        }
    }

    fn insert_crate(&mut self, new: &Crate) {
        let body = RigidBodyBuilder::dynamic()
            .translation(vector(new.at[0], new.at[1]))
            .rotation(new.angle as Real);
        let handle = self.world.insert_body(body);
        let half = (0.5 * new.side) as Real;
        let shape = ColliderBuilder::cuboid(half, half)
            .mass(new.mass as Real)
            .friction(0.5);
        self.world.insert_collider(shape, Some(handle));
        self.members.push(Member {
            name: new.name,
            handle,
        });
    }
}

fn deck(setup: &Setup) -> FlexBodyBuilder {
    let [young, poisson, density, _] = STEEL;
    // Stiffness damping: ζ = β ω / 2.
    let stiffness_damping = 2.0 * DAMPING_RATIO / first_frequency();
    FlexBodyBuilder::rectangle([DECK[0], DECK[1]], setup.divisions)
        .material(
            LinearElastic::plane_stress(young, poisson)
                .density(density)
                .rayleigh(stiffness_damping),
        )
        .thickness(DECK[2])
        .translation([-0.5 * DECK[0], 0.0])
        .friction(0.7)
}

/// The load of the crane, in the order in which it lets go.
fn crates() -> Vec<Crate> {
    let top = DECK[1];
    let new = |name, time, side, mass, at, angle| Crate {
        name,
        time,
        side,
        mass,
        at,
        angle,
    };
    vec![
        new("lower crate", 0.2, 1.2, 2000.0, [5.0, top + 0.9], 0.0),
        new("middle crate", 0.8, 1.0, 1200.0, [5.1, top + 2.2], 0.0),
        new("upper crate", 1.4, 0.8, 600.0, [5.0, top + 3.1], 0.0),
        new("tilted crate", 2.0, 0.9, 900.0, [8.0, top + 2.4], 0.5),
        new("cargo", 5.0, 1.1, 1500.0, [-1.5, top + 3.0], 0.15),
    ]
}
