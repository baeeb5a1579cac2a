//! Operations on rigid bodies and colliders.

use crate::chance::Chance;
use crate::common::*;
use crate::play::{Part, Play};
use foil2d::body::AttachmentTarget;

fn shape(chance: &mut Chance) -> SharedShape {
    let size = real(chance.within(0.1, 0.3));
    let corner = |x: f32, y: f32| vec2(f64::from(x), f64::from(y)) * size;
    match chance.below(8) {
        0 => SharedShape::ball(size),
        1 => SharedShape::cuboid(size, size),
        2 => SharedShape::capsule_x(size, 0.5 * size),
        3 => SharedShape::triangle(corner(-1.0, -1.0), corner(1.0, -1.0), corner(0.0, 1.0)),
        4 => SharedShape::round_cuboid(size, size, 0.1 * size),
        5 => SharedShape::segment(corner(-1.0, 0.0), corner(1.0, 0.2)),
        6 => SharedShape::polyline(
            vec![corner(-1.0, 0.0), corner(0.0, 0.5), corner(1.0, 0.0)],
            None,
        ),
        _ => SharedShape::compound(vec![
            (Pose::translation(-size, 0.0), SharedShape::ball(size)),
            (
                Pose::translation(size, 0.0),
                SharedShape::cuboid(size, size),
            ),
        ]),
    }
}

fn collider(chance: &mut Chance) -> ColliderBuilder {
    let hooks = [ActiveHooks::all(), ActiveHooks::empty()];
    ColliderBuilder::new(shape(chance))
        .density(real(chance.within(100.0, 2000.0)))
        .friction(real(chance.within(0.0, 1.0)))
        .restitution(real(chance.within(0.0, 0.8)))
        .sensor(chance.one_in(6))
        .active_events(ActiveEvents::all())
        .active_hooks(hooks[chance.below(2)])
}

const TYPES: [RigidBodyType; 5] = [
    RigidBodyType::Dynamic,
    RigidBodyType::Dynamic,
    RigidBodyType::Fixed,
    RigidBodyType::KinematicVelocityBased,
    RigidBodyType::KinematicPositionBased,
];

impl Play {
    /// A body with one collider, or with none and a mass of its own.
    pub fn insert_rigid(&mut self) -> &'static str {
        if self.rigid.len() >= 10 {
            return "enough rigid bodies";
        }
        let chance = &mut self.chance;
        let [x, y] = chance.at();
        let body = RigidBodyBuilder::new(TYPES[chance.below(5)])
            .translation(vec2(x, y))
            .ccd_enabled(chance.one_in(4));
        let world = &mut self.scene.world;
        if chance.one_in(5) {
            let mass = MassProperties::new(vec2(0.0, 0.0), 50.0, 2.0);
            let body = world.insert_body(body.additional_mass_properties(mass));
            self.rigid.push(body);
        } else {
            let (body, handle) = world.insert(body, collider(chance));
            self.rigid.push(body);
            self.parts.push(Part {
                handle,
                parent: Some(body),
            });
        }
        "insert rigid"
    }

    pub fn remove_rigid(&mut self) -> &'static str {
        if !self.empty_carriers.is_empty() && self.chance.one_in(2) {
            let slot = self.chance.below(self.empty_carriers.len());
            let carrier = self.empty_carriers.swap_remove(slot);
            self.scene.world.remove_body(carrier);
            return "remove empty carrier";
        }
        if self.rigid.is_empty() {
            return "nothing rigid";
        }
        let handle = self.rigid.swap_remove(self.chance.below(self.rigid.len()));
        self.scene.world.remove_body(handle);
        "remove rigid"
    }

    /// Puts a body elsewhere: into another, beside the walls, or far away.
    pub fn move_rigid(&mut self) -> &'static str {
        let Some(handle) = self.chance.pick(&self.rigid) else {
            return "nothing rigid";
        };
        // What is joined to a clamped body would stretch it to many times its length, and store more than it can carry.
        let mut ties = self.ties.iter();
        let is_held = ties.any(|tie| tie.target == AttachmentTarget::RigidBody(handle))
            || self.links.iter().any(|link| link.ends.contains(&handle));
        let (world, chance) = (&mut self.scene.world, &mut self.chance);
        let (name, at) = match chance.below(4) {
            0 => {
                let other = chance.pick(&self.rigid).unwrap_or(handle);
                ("teleport into rigid", world.bodies[other].translation())
            }
            1 => {
                let flexible = chance.pick(&self.flexible);
                let at = flexible.map(|body| self.scene.bodies[body].centre_of_mass());
                let [x, y] = at.unwrap_or([0.0, 1.0]);
                ("teleport into flexible", vec2(x, y))
            }
            2 if !is_held => ("teleport far", vec2(chance.within(-40.0, 40.0), 30.0)),
            _ => {
                let [x, y] = chance.at();
                ("teleport", vec2(x, y))
            }
        };
        let body = &mut world.bodies[handle];
        if body.body_type() == RigidBodyType::KinematicPositionBased && chance.one_in(2) {
            // At this step, not at once: as fast as it takes, so only where the world is small.
            let [x, y] = chance.at();
            let step = (vec2(x, y) - body.translation()).clamp_length_max(0.5);
            body.set_next_kinematic_translation(body.translation() + step);
            return "kinematic target";
        }
        body.set_translation(at, true);
        name
    }

    pub fn change_rigid(&mut self) -> &'static str {
        let Some(handle) = self.chance.pick(&self.rigid) else {
            return "nothing rigid";
        };
        let (world, chance) = (&mut self.scene.world, &mut self.chance);
        let [x, y] = chance.at();
        let body = &mut world.bodies[handle];
        match chance.below(9) {
            0 => {
                body.set_linvel(vec2(10.0 * x, 20.0 * (y - 2.0)), true);
                "velocity"
            }
            1 => {
                body.set_angvel(real(5.0 * x), true);
                "spin"
            }
            2 => {
                body.set_enabled(!body.is_enabled());
                "enable"
            }
            3 => {
                body.set_body_type(TYPES[chance.below(5)], true);
                "type"
            }
            4 => {
                if body.is_sleeping() {
                    body.wake_up(true);
                } else {
                    body.sleep();
                }
                "sleep rigid"
            }
            5 => {
                let axes = [
                    LockedAxes::empty(),
                    LockedAxes::ROTATION_LOCKED,
                    LockedAxes::TRANSLATION_LOCKED_X,
                    LockedAxes::TRANSLATION_LOCKED,
                ];
                body.set_locked_axes(axes[chance.below(4)], true);
                "axes"
            }
            6 => {
                body.set_dominance_group(chance.below(3) as i8 - 1);
                "dominance"
            }
            7 => {
                body.reset_forces(true);
                body.add_force(vec2(100.0 * x, 100.0 * (y - 2.0)), true);
                "force"
            }
            _ => {
                body.set_additional_mass(real(chance.within(0.0, 1000.0)), true);
                "mass"
            }
        }
    }

    pub fn change_colliders(&mut self) -> &'static str {
        let (world, chance) = (&mut self.scene.world, &mut self.chance);
        let operation = chance.below(8);
        if operation < 2 && self.parts.len() < 20 {
            let [x, y] = chance.at();
            let parent = chance.pick(&self.rigid).filter(|_| operation == 0);
            let at = if parent.is_some() {
                vec2(0.1 * x, 0.1 * (y - 2.0))
            } else {
                vec2(x, y)
            };
            let handle = world.insert_collider(collider(chance).translation(at), parent);
            self.parts.push(Part { handle, parent });
            return "add collider";
        }
        // Floor and walls stay.
        let Some(slot) = (self.parts.len() > 3).then(|| 3 + chance.below(self.parts.len() - 3))
        else {
            return "no collider";
        };
        let Part { handle, parent } = self.parts[slot];
        let collider = &mut world.colliders[handle];
        match operation {
            0..=2 => {
                world.remove_collider(handle);
                self.parts.remove(slot);
                "remove collider"
            }
            3 => {
                collider.set_shape(shape(chance));
                "shape"
            }
            4 => {
                collider.set_enabled(!collider.is_enabled());
                "enable collider"
            }
            5 => {
                collider.set_sensor(!collider.is_sensor());
                "sensor collider"
            }
            6 => {
                let [x, y] = chance.at();
                if parent.is_some() {
                    collider.set_translation_wrt_parent(vec2(0.1 * x, 0.1 * (y - 2.0)));
                } else {
                    collider.set_translation(vec2(x, y));
                }
                "move collider"
            }
            _ => {
                let parent = chance.pick(&self.rigid);
                world
                    .colliders
                    .set_parent(handle, parent, &mut world.bodies);
                self.parts[slot].parent = parent;
                "new parent"
            }
        }
    }
}
