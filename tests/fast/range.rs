//! The range: a target, a projectile aimed at it, and what became of them.

use crate::common::*;
use crate::crossing::{Frame, P, encloses, mix, net_crossings, side};
use std::f64::consts::{PI, TAU};

/// What is shot at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// A sheet of one layer of cells, held at both ends.
    Clamped,
    /// The same, free.
    Free,
    /// A fixed cuboid 1 cm thick.
    Plate,
    /// A fixed segment.
    Segment,
    /// A fixed polyline.
    Polyline,
}

/// What is shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projectile {
    Ball,
    Box,
    Capsule,
    Polygon,
    /// A flexible rectangle.
    Flexible,
}

/// The side that shots come from: the left of the middle line.
const BEGAN: i32 = 1;

/// One shot.
#[derive(Clone, Copy, Debug)]
pub struct Shot {
    pub target: Target,
    pub projectile: Projectile,
    pub speed: f64,
    pub dt: f64,
    /// Turns the whole scene (rad).
    pub turn: f64,
    /// Direction of flight from the normal of the target (rad).
    pub incidence: f64,
    pub spin: f64,
    pub size: f64,
    pub density: f64,
    pub young: f64,
    pub sheet_young: f64,
    pub sheet_density: f64,
    pub thickness: f64,
    pub length: f64,
    pub n_cells: usize,
    pub n_bullet: usize,
    /// Where it is aimed at, from the middle of the target (m).
    pub aim: f64,
    pub distance: f64,
    pub is_ccd: bool,
    pub friction: f64,
    pub rayleigh: f64,
}

fn log_between(dice: &mut Dice, low: f64, high: f64) -> f64 {
    low * (high / low).powf(dice.roll())
}

impl Shot {
    pub fn random(seed: u64) -> Self {
        let mut dice = Dice(seed.wrapping_mul(0x2545_F491_4F6C_DD1D));
        let dice = &mut dice;
        let is_sheet = dice.roll() < 0.7;
        let target = if is_sheet {
            dice.pick(&[Target::Clamped, Target::Free])
        } else {
            dice.pick(&[Target::Plate, Target::Segment, Target::Polyline])
        };
        let rigid = [
            Projectile::Ball,
            Projectile::Box,
            Projectile::Capsule,
            Projectile::Polygon,
        ];
        let projectile = if is_sheet && dice.roll() < 0.7 {
            dice.pick(&rigid)
        } else {
            Projectile::Flexible
        };
        let length = dice.between(2.0, 6.0);
        let size = log_between(dice, 0.05, 0.4);
        Self {
            target,
            projectile,
            speed: log_between(dice, 10.0, 1000.0),
            dt: dice.pick(&[1.0 / 60.0, 1.0 / 120.0, 1.0 / 240.0]),
            turn: dice.between(0.0, TAU),
            incidence: dice.between(-1.0, 1.0),
            spin: dice.pick(&[0.0, 1.0, 1.0]) * dice.between(-60.0, 60.0),
            size,
            density: log_between(dice, 100.0, 8000.0),
            young: log_between(dice, 1e6, 2e11),
            sheet_young: log_between(dice, 1e6, 2e11),
            sheet_density: log_between(dice, 500.0, 8000.0),
            thickness: log_between(dice, 0.01, 0.1),
            length,
            n_cells: dice.pick(&[10, 20, 40]),
            n_bullet: dice.pick(&[2, 4, 6]),
            aim: dice.between(-0.3, 0.3) * length,
            distance: dice.between(0.6, 6.0),
            is_ccd: dice.roll() < 0.4,
            friction: dice.between(0.0, 0.8),
            rayleigh: dice.pick(&[0.0, 1e-4, 1e-3]),
        }
    }

    fn out(&self, [x, y]: P) -> P {
        let (sin, cos) = self.turn.sin_cos();
        [cos * x - sin * y, sin * x + cos * y]
    }
}

/// A scene with a shot in it.
pub struct Range {
    pub shot: Shot,
    scene: Scene,
    pub sheet: Option<FlexBodyHandle>,
    pub rigid: Option<RigidBodyHandle>,
    pub bullet: Option<FlexBodyHandle>,
    wall: Vec<P>,
}

/// How a shot ended.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    pub error: Option<String>,
    pub tunnelled: Option<String>,
    pub not_finite: bool,
    pub n_unfinished: usize,
}

impl Range {
    pub fn new(shot: Shot) -> Self {
        let mut range = Self {
            shot,
            scene: Scene::in_free_space(shot.dt),
            sheet: None,
            rigid: None,
            bullet: None,
            wall: Vec::new(),
        };
        range.put_target();
        range.put_projectile();
        range
    }

    fn put_target(&mut self) {
        let shot = self.shot;
        let half = 0.5 * shot.length;
        let [from, to] = [[-half, 0.0], [half, 0.0]].map(|end| shot.out(end));
        let friction = real(shot.friction);
        match shot.target {
            Target::Clamped | Target::Free => {
                let corner = shot.out([-half, -0.5 * shot.thickness]);
                let mut sheet =
                    FlexBodyBuilder::rectangle([shot.length, shot.thickness], [shot.n_cells, 1])
                        .material(elastic(shot.sheet_young, shot.sheet_density, shot.rayleigh))
                        .friction(shot.friction)
                        .rotation(shot.turn)
                        .translation(corner);
                if shot.target == Target::Clamped {
                    sheet = sheet.pin_where(
                        move |[x, _]| x < 1e-9 || x > shot.length - 1e-9,
                        Pin::both(),
                    );
                }
                self.sheet = Some(self.scene.flexible(sheet));
            }
            Target::Plate => {
                self.scene.fixed(
                    ColliderBuilder::cuboid(real(half), 0.005)
                        .rotation(real(shot.turn))
                        .friction(friction),
                );
            }
            Target::Segment => {
                self.scene.fixed(
                    ColliderBuilder::segment(vec2(from[0], from[1]), vec2(to[0], to[1]))
                        .friction(friction),
                );
            }
            Target::Polyline => {
                let n = shot.n_cells;
                let points = (0..=n)
                    .map(|i| mix(from, to, i as f64 / n as f64))
                    .map(|[x, y]| vec2(x, y))
                    .collect();
                self.scene
                    .fixed(ColliderBuilder::polyline(points, None).friction(friction));
            }
        }
        self.wall = vec![from, to];
    }

    fn put_projectile(&mut self) {
        let shot = self.shot;
        let (sin, cos) = shot.incidence.sin_cos();
        let way = [sin, -cos];
        let clear = shot.distance + shot.size * 1.5;
        let start = shot.out([shot.aim - clear * way[0], -clear * way[1]]);
        let velocity = shot.out(way).map(|part| part * shot.speed);
        let size = shot.size;
        if shot.projectile == Projectile::Flexible {
            let corner = shot.out([-0.5 * size, -0.5 * size]);
            let bullet = FlexBodyBuilder::rectangle([size, size], [shot.n_bullet; 2])
                .material(elastic(shot.young, shot.density, shot.rayleigh))
                .friction(shot.friction)
                .rotation(shot.turn)
                .translation([start[0] + corner[0], start[1] + corner[1]])
                .linvel(velocity)
                .angvel(shot.spin);
            self.bullet = Some(self.scene.flexible(bullet));
            return;
        }
        let half = real(0.5 * size);
        let shape = match shot.projectile {
            Projectile::Ball => ColliderBuilder::ball(half),
            Projectile::Capsule => ColliderBuilder::capsule_x(half, real(0.2 * size)),
            Projectile::Polygon => {
                let corners: Vec<_> = (0..5)
                    .map(|i| TAU * f64::from(i) / 5.0)
                    .map(|angle| vec2(0.5 * size * angle.cos(), 0.5 * size * angle.sin()))
                    .collect();
                ColliderBuilder::convex_hull(&corners).expect("a pentagon is convex")
            }
            _ => ColliderBuilder::cuboid(half, real(0.3 * size)),
        };
        let body = RigidBodyBuilder::dynamic()
            .translation(vec2(start[0], start[1]))
            .rotation(real(shot.turn + PI * shot.aim))
            .linvel(vec2(velocity[0], velocity[1]))
            .angvel(real(shot.spin))
            .ccd_enabled(shot.is_ccd);
        let collider = shape
            .density(real(shot.density))
            .friction(real(shot.friction));
        self.rigid = Some(self.scene.rigid(body, collider).0);
    }

    /// The projectile's centre and the middle line of the target.
    pub fn frame(&self) -> Frame {
        let point = match (self.rigid, self.bullet) {
            (Some(body), _) => {
                let at = self.scene.world.bodies[body].center_of_mass();
                [f64::from(at.x), f64::from(at.y)]
            }
            (_, Some(body)) => {
                let body = self.scene.body(body);
                let corners = body.mesh().cell(body.mesh().middle_cell()).corners();
                let sum = corners.iter().fold([0.0; 2], |[x, y], &node| {
                    let at = body.position(node);
                    [x + at[0], y + at[1]]
                });
                sum.map(|sum| sum / corners.len() as f64)
            }
            _ => [0.0; 2],
        };
        let line = self.sheet.map_or_else(
            || self.wall.clone(),
            |sheet| {
                let (body, n) = (self.scene.body(sheet), self.shot.n_cells + 1);
                (0..n)
                    .map(|i| mix(body.position(i), body.position(n + i), 0.5))
                    .collect()
            },
        );
        Frame { point, line }
    }

    fn is_finite(&self) -> bool {
        sick_flexible(&self.scene.bodies).is_none() && sick_rigid(&self.scene.world).is_none()
    }

    /// The surface of a flexible projectile.
    fn surface(&self) -> Vec<P> {
        let Some(bullet) = self.bullet else {
            return Vec::new();
        };
        let body = self.scene.body(bullet);
        let nodes = body.mesh().boundary().nodes().iter();
        nodes.map(|&node| body.position(node)).collect()
    }

    /// Steps until the shot must have arrived and been turned back.
    ///
    /// What is inside of a body that is crushed to nothing comes out of its surface, as nothing but small strains keeps it there. Then the
    /// report must say so, and from then on the body is where most of its surface is, until that has come past an end of the target: there it
    /// goes round, on ways that are not straight from frame to frame.
    pub fn run(&mut self) -> Outcome {
        let mut outcome = Outcome::default();
        let flight = (self.shot.distance + self.shot.size) / (self.shot.speed * self.shot.dt);
        let n_steps = flight.ceil() as usize + 12;
        let mut net = 0;
        let (mut before, mut surface_before) = (self.frame(), self.surface());
        let mut surface_nets = vec![0; surface_before.len()];
        let [mut is_round, mut was_crushed, mut is_draped] = [false; 3];
        for step in 0..n_steps {
            let (is_overbent, is_whole) = match self.scene.try_step() {
                Ok(report) => {
                    outcome.n_unfinished += report.n_unfinished();
                    let mut overbent = report.overbent().iter();
                    let is_overbent = overbent.any(|one| Some(one.body) == self.bullet);
                    (is_overbent, report.n_parts() <= 1)
                }
                Err(error) => {
                    outcome.error = Some(format!("step {step}: {error}"));
                    return outcome;
                }
            };
            if !self.is_finite() {
                outcome.not_finite = true;
                return outcome;
            }
            let (mut after, surface) = (self.frame(), self.surface());
            // Within a step in parts a free sheet may turn round what hit it, on ways that are not straight.
            let is_straight = is_whole || self.shot.target != Target::Free;
            if is_straight {
                net += net_crossings(&before, &after);
            }
            is_round |= !is_straight;
            let middle = after.point;
            for (node, total) in surface_nets.iter_mut().enumerate() {
                (before.point, after.point) = (surface_before[node], surface[node]);
                *total += net_crossings(&before, &after);
            }
            after.point = middle;
            let now = side(&after);
            is_round |= now == 0;
            is_draped |= surface.iter().any(|&point| {
                let line = after.line.clone();
                side(&Frame { point, line }) == 0
            });
            let is_crushed = self.bullet.is_some() && !encloses(&surface, middle);
            was_crushed |= is_crushed;
            let n_passed = surface_nets.iter().filter(|net| **net != 0).count();
            if outcome.tunnelled.is_none() {
                if was_crushed {
                    if is_crushed && !is_overbent {
                        outcome.tunnelled = Some(format!("step {step}: crushed without a word"));
                    } else if !is_draped && 2 * n_passed > surface.len() {
                        outcome.tunnelled = Some(format!("step {step}: {n_passed} of the surface"));
                    }
                } else if net != 0 {
                    outcome.tunnelled = Some(format!("step {step}: net {net}, side {now}"));
                } else if !is_round && now != BEGAN {
                    outcome.tunnelled = Some(format!("step {step}: side {now}"));
                }
            }
            (before, surface_before) = (after, surface);
        }
        outcome
    }
}
