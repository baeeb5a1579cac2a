//! Operations on flexible bodies.

use crate::chance::Chance;
use crate::common::*;
use crate::play::{Outcome, Play};
use foil2d::body::{AttachmentTarget, ContactSettings, FlexBodyError};
use foil2d::rapier::math::Real;

fn builder(chance: &mut Chance) -> FlexBodyBuilder {
    let material = elastic(chance.within(1e6, 1e8), 1000.0, 2e-3);
    let builder = match chance.below(5) {
        0 => FlexBodyBuilder::rectangle([0.6, 0.4], [3, 3]),
        1 => FlexBodyBuilder::disc(0.3, 0.2),
        2 => FlexBodyBuilder::rectangle([1.5, 0.15], [8, 1]),
        3 => FlexBodyBuilder::annulus(0.2, 0.4, 0.2),
        _ => {
            FlexBodyBuilder::rectangle([1.5, 0.2], [6, 2]).pin_where(|[x, _]| x == 0.0, Pin::both())
        }
    };
    let hooks = ActiveHooks::all();
    builder
        .material(material)
        .translation(chance.at())
        .rotation(chance.within(-3.0, 3.0))
        .linvel([chance.within(-3.0, 3.0), 0.0])
        .angvel(chance.within(-3.0, 3.0))
        .friction(chance.within(0.0, 1.0))
        .active_events(ActiveEvents::all())
        .active_hooks(if chance.one_in(2) {
            hooks
        } else {
            ActiveHooks::empty()
        })
}

impl Play {
    pub fn insert_flexible(&mut self) -> Outcome<&'static str> {
        if self.flexible.len() < 5 {
            let scene = &mut self.scene;
            let builder = builder(&mut self.chance);
            let handle = scene.bodies.insert(builder, &mut scene.world)?;
            self.flexible.push(handle);
        }
        Ok("insert flexible")
    }

    pub fn remove_flexible(&mut self) -> Outcome<&'static str> {
        if self.flexible.is_empty() {
            return Ok("nothing flexible");
        }
        let slot = self.chance.below(self.flexible.len());
        let handle = self.flexible[slot];
        let carrier = self.scene.bodies[handle].rigid_body_handle();
        let name = match self.chance.below(6) {
            0 => {
                // What rapier holds of it stays behind.
                self.scene.bodies.forget(handle)?;
                self.empty_carriers.push(carrier);
                "forget flexible"
            }
            1 => {
                self.lose_carrier(handle, carrier);
                self.scene.bodies.forget(handle)?;
                "lose carrier"
            }
            2 => {
                self.scene.bodies.remove(handle, &mut self.scene.world)?;
                let scene = &mut self.scene;
                let again = scene
                    .bodies
                    .insert(builder(&mut self.chance), &mut scene.world)?;
                self.flexible.push(again);
                "replace flexible"
            }
            _ => {
                self.scene.bodies.remove(handle, &mut self.scene.world)?;
                "remove flexible"
            }
        };
        self.flexible.swap_remove(slot);
        self.gone.push(handle);
        let again = self.scene.bodies.remove(handle, &mut self.scene.world);
        assert_eq!(again.err(), Some(FlexBodyError::Stale(handle)));
        self.forget_orphans();
        Ok(name)
    }

    /// Removes a carrier as if it were a rigid body: the next step names the body it carried.
    fn lose_carrier(&mut self, handle: FlexBodyHandle, carrier: RigidBodyHandle) {
        self.scene.world.remove_body(carrier);
        // No error is asked for what has left the world, and spoiled bodies would leave it first.
        if !self.scene.bodies[handle].is_quarantined() && self.spoiled.is_empty() {
            self.context = format!("seed {:#x}, step {} (lost)", self.seed, self.n_steps);
            self.step_refused(FlexBodyError::NoCarrier(handle).into());
        }
    }

    pub fn change_flexible(&mut self) -> Outcome<&'static str> {
        let Some(handle) = self.chance.pick(&self.flexible) else {
            return Ok("nothing flexible");
        };
        let operation = self.chance.below(14);
        if operation >= 11 {
            return Ok(self.change_carrier(operation, handle));
        }
        let chance = &mut self.chance;
        let body = &mut self.scene.bodies[handle];
        let node = chance.below(body.n_nodes());
        let [x, y] = chance.at();
        let name = match operation {
            0 => {
                if !self.spoiled.contains(&handle) {
                    body.set_nodal_force(node, [100.0 * x, 100.0 * (y - 2.0)])?;
                }
                "nodal force"
            }
            1 | 2 => {
                let dofs = 0..2 * body.n_nodes();
                let velocities: Vec<f64> = dofs
                    .map(|dof| if dof % 2 == 0 { x } else { y - 2.0 })
                    .collect();
                body.set_velocities(&velocities)?;
                "velocities"
            }
            3 => {
                body.set_body_force([x, y - 2.0])?;
                "body force"
            }
            4 => {
                body.set_gravity_scale(chance.within(-0.5, 2.0))?;
                "gravity scale"
            }
            5 => {
                body.set_sensor(!body.contact_settings().is_sensor);
                "sensor"
            }
            6 => {
                let groups = [
                    InteractionGroups::all(),
                    InteractionGroups::all(),
                    InteractionGroups::none(),
                ];
                body.set_collision_groups(groups[chance.below(3)]);
                body.set_solver_groups(groups[chance.below(3)]);
                "groups"
            }
            7 => {
                let contact = ContactSettings {
                    friction: chance.within(0.0, 1.0),
                    restitution: chance.within(0.0, 1.0),
                    contact_skin: chance.within(0.0, 0.02),
                    active_hooks: ActiveHooks::all(),
                    ..*body.contact_settings()
                };
                body.set_contact_settings(contact)?;
                "contact settings"
            }
            8 => {
                if body.fixed_dofs()[2 * node] {
                    body.set_pin_displacement(node, [0.01 * x, 0.01 * (y - 2.0)])?;
                }
                "pin displacement"
            }
            9 => {
                body.wake_up();
                "wake"
            }
            _ => {
                let types = [ActiveCollisionTypes::all(), ActiveCollisionTypes::default()];
                body.set_active_collision_types(types[chance.below(2)]);
                "collision types"
            }
        };
        Ok(name)
    }

    /// What a user may do to the carrier of a body and to the surface on it.
    fn change_carrier(&mut self, operation: usize, handle: FlexBodyHandle) -> &'static str {
        let body = &self.scene.bodies[handle];
        if body.is_quarantined() {
            return "out of the world";
        }
        let carrier = &mut self.scene.world.bodies[body.rigid_body_handle()];
        match operation {
            11 => {
                let collider = &mut self.scene.world.colliders[body.collider_handle()];
                collider.set_enabled(!collider.is_enabled());
                "enable surface"
            }
            12 => {
                carrier.set_enabled(!carrier.is_enabled());
                "enable carrier"
            }
            _ => {
                carrier.sleep();
                "sleep"
            }
        }
    }

    /// Gives a body a load or a carrier a velocity that is no number, or takes such loads back and the body in again.
    pub fn spoil_or_mend(&mut self) -> Outcome<&'static str> {
        let Some(handle) = self.chance.pick(&self.flexible) else {
            return Ok("nothing flexible");
        };
        let scene = &mut self.scene;
        let body = &mut scene.bodies[handle];
        if body.is_quarantined() {
            if self.chance.one_in(2) {
                for node in 0..body.n_nodes() {
                    body.set_nodal_force(node, [0.0; 2])?;
                }
                self.spoiled.retain(|&other| other != handle);
            }
            // What holds the body has moved on without it.
            let held: Vec<_> = scene
                .bodies
                .iter_attachments()
                .filter(|(_, held)| {
                    held.body() == handle || held.target() == AttachmentTarget::Flexible(handle)
                })
                .map(|(held, _)| held)
                .collect();
            for held in held {
                scene.bodies.detach(held)?;
                self.ties.retain(|tie| tie.handle != held);
            }
            let (bodies, colliders) = (&mut scene.world.bodies, &mut scene.world.colliders);
            scene.bodies.reinstate(handle, bodies, colliders)?;
            return Ok("reinstate");
        }
        if self.chance.one_in(3) {
            let carrier = body.rigid_body_handle();
            scene.world.bodies[carrier].set_linvel(Vector::new(Real::NAN, 0.0), true);
        } else {
            let node = self.chance.below(body.n_nodes());
            body.set_nodal_force(node, [f64::MAX, 0.0])?;
        }
        self.spoiled.push(handle);
        Ok("spoil")
    }
}
