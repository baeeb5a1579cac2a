//! Grounds of segments and height fields, and what stands and drives on them.

use super::*;
use std::f64::consts::PI;

/// What the ground is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Made {
    Cuboid,
    /// A polyline of segments of this length along x (m).
    Polyline(f64),
    /// A height field with cells of this length (m).
    Heights(f64),
}

/// How high the ground is over x (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relief {
    Flat,
    /// A valley 0.8 m deep.
    Valley,
    /// Waves of 0.12 m and a length of 3.7 m, from x = 3 m on.
    Waves,
}

impl Relief {
    pub fn height(self, x: f64) -> f64 {
        match self {
            Self::Flat => 0.0,
            Self::Valley => -0.8 * (-x * x / 0.7).exp(),
            Self::Waves if x > 3.0 => 0.12 * (1.7 * (x - 3.0)).sin(),
            Self::Waves => 0.0,
        }
    }
}

/// Ground from x = -`half` to `half` (m).
pub fn ground_of(made: Made, relief: Relief, half: f64) -> ColliderBuilder {
    let heights = |cell: f64| {
        let n = (2.0 * half / cell).round() as usize;
        let points = (0..=n).map(move |i| -half + 2.0 * half * i as f64 / n as f64);
        points.map(move |x| [x, relief.height(x)])
    };
    match made {
        Made::Cuboid => ColliderBuilder::cuboid(real(half), 0.5).translation(vec2(0.0, -0.5)),
        Made::Polyline(cell) => {
            ColliderBuilder::polyline(heights(cell).map(|[x, y]| vec2(x, y)).collect(), None)
        }
        Made::Heights(cell) => ColliderBuilder::heightfield(
            heights(cell).map(|[_, y]| real(y)).collect(),
            vec2(2.0 * half, 1.0),
        ),
    }
}

/// A soft body of half a metre or so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    Square,
    Disc,
    /// Five-pointed.
    Star,
}

impl Form {
    pub fn builder(self) -> FlexBodyBuilder {
        match self {
            Self::Square => FlexBodyBuilder::rectangle([0.5, 0.5], [5, 5]),
            Self::Disc => FlexBodyBuilder::disc(0.3, 0.1),
            Self::Star => {
                let corners: Vec<[f64; 2]> = (0..10)
                    .map(|k| {
                        let angle = PI * (0.5 + f64::from(k) / 5.0);
                        let radius = if k % 2 == 0 { 0.6 } else { 0.22 };
                        [radius * angle.cos(), radius * angle.sin()]
                    })
                    .collect();
                FlexBodyBuilder::polygon(&corners, &[], 0.12)
            }
        }
    }
}

/// A tyre of 0.45 m on a hub, with its centre here (m) and this Young's modulus (Pa).
pub fn tyre(at: [f64; 2], young: f64) -> FlexBodyBuilder {
    FlexBodyBuilder::annulus(0.22, 0.45, 0.09)
        .material(elastic(young, 200.0, 5e-3))
        .thickness(0.3)
        .friction(1.0)
        .translation(at)
}

/// A ball of 5 kg that fills the tyre without touching it.
pub fn hub_ball(radius: f64) -> ColliderBuilder {
    ColliderBuilder::ball(real(radius)).mass(5.0).friction(1.0)
}

/// Welds a tyre to its hub.
pub fn mount(scene: &mut Scene, tyre: FlexBodyHandle, hub: RigidBodyHandle) {
    let weld = AttachmentBuilder::weld(tyre)
        .where_(|[x, y]| x.hypot(y) < 0.221)
        .to_rigid_body(hub);
    scene
        .bodies
        .attach(weld, &scene.world.bodies)
        .expect("the hub is there");
}

/// Radius of the car's wheels (m), and the speed at which their motors turn them (rad/s).
pub const WHEEL: [f64; 2] = [0.45, 6.0];

/// A car of 110 kg and two wheels on motors, at x = 0 just above the ground: soft tyres with this Young's modulus (Pa), or rigid wheels.
pub fn car(scene: &mut Scene, young: Option<f64>) -> RigidBodyHandle {
    let groups =
        |own: Group, others: Group| InteractionGroups::new(own, others, InteractionTestMode::And);
    let inner = groups(Group::GROUP_1, Group::GROUP_3);
    let outer = groups(Group::GROUP_2, Group::ALL & !Group::GROUP_1);
    let (chassis, _) = scene.rigid(
        RigidBodyBuilder::dynamic().translation(vec2(0.0, 0.75)),
        ColliderBuilder::cuboid(1.0, 0.2)
            .mass(100.0)
            .collision_groups(inner),
    );
    for x in [-0.8, 0.8] {
        let (radius, seen) = match young {
            Some(_) => (0.2, inner),
            None => (WHEEL[0], outer),
        };
        let (hub, _) = scene.rigid(
            RigidBodyBuilder::dynamic().translation(vec2(x, 0.46)),
            hub_ball(radius).collision_groups(seen),
        );
        if let Some(young) = young {
            let tyre = scene.flexible(tyre([x, 0.46], young).collision_groups(outer));
            mount(scene, tyre, hub);
        }
        let axle = hinge([x, -0.29], [0.0, 0.0])
            .contacts_enabled(false)
            .motor_velocity(real(-WHEEL[1]), 200.0);
        scene.world.impulse_joints.insert(chassis, hub, axle, true);
    }
    chassis
}
