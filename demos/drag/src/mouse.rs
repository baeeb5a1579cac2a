//! Bodies that follow the mouse.

use crate::playground::Playground;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use std::error::Error;

/// Frequency of a body on the mouse's spring (rad/s), and its damping ratio (-).
const FREQUENCY: f64 = 12.0;
const DAMPING_RATIO: f64 = 0.7;

/// What the mouse holds.
pub enum Held {
    /// The nearest node of a flexible body's surface, by a spring that follows the mouse from this point (m).
    Flexible {
        spring: AttachmentHandle,
        from: [f64; 2],
    },
    /// A rigid body, by a joint to one that is where the mouse is.
    Rigid { mouse: RigidBodyHandle },
}

/// Stiffness (N/m) and damping (N s/m) of the spring for a mass (kg).
fn spring_for(mass: f64) -> [f64; 2] {
    [
        mass * FREQUENCY * FREQUENCY,
        2.0 * DAMPING_RATIO * mass * FREQUENCY,
    ]
}

fn vector([x, y]: [f64; 2]) -> Vector {
    Vector::new(x as Real, y as Real)
}

impl Playground {
    /// Takes hold of the body at a point (m), if there is one.
    pub fn take_hold(&mut self, at: [f64; 2]) -> Result<(), Box<dyn Error>> {
        self.let_go()?;
        let mut bodies = self.flex_bodies.iter();
        let found = bodies.find(|(_, body)| body.contains(at));
        if let Some((handle, body)) = found {
            let node = body.pick(at).node;
            let [stiffness, damping] = spring_for(body.mass());
            let spring = AttachmentBuilder::spring_damper(handle, stiffness, damping)
                .node(node)
                .rest_length(0.0)
                .at_point(body.position(node))
                .to_world();
            drop(bodies);
            let spring = self.flex_bodies.attach(spring, &self.world.bodies)?;
            self.held = Some(Held::Flexible { spring, from: at });
            return Ok(());
        }
        drop(bodies);
        let filter = QueryFilter::only_dynamic();
        let mut hits = self.world.intersect_point(vector(at), filter);
        let body = hits.find_map(|(_, collider)| collider.parent());
        drop(hits);
        if let Some(body) = body {
            self.hold_rigid(body, at);
        }
        Ok(())
    }

    fn hold_rigid(&mut self, body: RigidBodyHandle, at: [f64; 2]) {
        let [stiffness, damping] =
            spring_for(f64::from(self.world.bodies[body].mass())).map(|x| x as Real);
        let anchor = self.world.bodies[body]
            .position()
            .inverse_transform_point(vector(at));
        let mouse = RigidBodyBuilder::kinematic_position_based().translation(vector(at));
        let mouse = self.world.insert_body(mouse);
        let joint = GenericJointBuilder::new(JointAxesMask::empty())
            .local_anchor2(anchor)
            .motor_model(JointAxis::LinX, MotorModel::ForceBased)
            .motor_model(JointAxis::LinY, MotorModel::ForceBased)
            .motor_position(JointAxis::LinX, 0.0, stiffness, damping)
            .motor_position(JointAxis::LinY, 0.0, stiffness, damping);
        self.world.insert_impulse_joint(mouse, body, joint);
        self.world.wake_up(body, true);
        self.held = Some(Held::Rigid { mouse });
    }

    /// Leads what is held to a point (m).
    pub fn lead(&mut self, to: [f64; 2]) -> Result<(), Box<dyn Error>> {
        match &self.held {
            Some(Held::Flexible { spring, from }) => {
                let offset = [to[0] - from[0], to[1] - from[1]];
                self.flex_bodies
                    .attachment_mut(*spring)?
                    .set_target(offset, 0.0)?;
            }
            Some(Held::Rigid { mouse }) => {
                self.world.bodies[*mouse].set_next_kinematic_translation(vector(to));
            }
            None => {}
        }
        Ok(())
    }

    /// Lets go of what is held.
    pub fn let_go(&mut self) -> Result<(), Box<dyn Error>> {
        match self.held.take() {
            Some(Held::Flexible { spring, .. }) => {
                self.flex_bodies.detach(spring)?;
            }
            Some(Held::Rigid { mouse }) => {
                self.world.remove_body(mouse);
            }
            None => {}
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Holds what is at a point, leads it by 1 m up within a second and waits for three more.
    fn lift(playground: &mut Playground, from: [f64; 2]) {
        playground.take_hold(from).expect("a body to hold");
        assert!(playground.held.is_some(), "there is a body at {from:?}");
        for step in 0..240 {
            let up = (f64::from(step) / 60.0).min(1.0);
            playground.lead([from[0], from[1] + up]).expect("a target");
            playground.step().expect("a step");
        }
    }

    #[test]
    fn a_flexible_body_hangs_on_the_mouse_and_falls_when_let_go() {
        let mut playground = Playground::new().expect("a world");
        let (block, _) = playground.flex_bodies.iter().nth(1).expect("the block");
        let centre = playground.flex_bodies[block].centre_of_mass();
        // Near its top, so that it hangs below.
        lift(&mut playground, [centre[0], centre[1] + 0.5]);
        let body = &playground.flex_bodies[block];
        let held = body.centre_of_mass()[1];
        assert!(held > centre[1] + 0.5, "off the floor: {held} m");
        playground.let_go().expect("lets go");
        for _ in 0..120 {
            playground.step().expect("a step");
        }
        let height = playground.flex_bodies[block].centre_of_mass()[1];
        assert!(height < held - 0.3, "it falls: {height} m");
    }

    /// Nothing else touches the ring, so over any time the pull of the mouse gives it its weight and what it gains in momentum.
    #[test]
    fn a_flexible_body_follows_the_mouse_which_pulls_with_its_weight() {
        let mut playground = Playground::new().expect("a world");
        let (ring, body) = playground.flex_bodies.iter().nth(2).expect("the ring");
        let [x, y] = body.centre_of_mass();
        let (node, weight) = (body.pick([x, y + 0.6]).node, 9.81 * body.mass());
        let start = body.position(node);
        lift(&mut playground, [x, y + 0.6]);
        let Some(Held::Flexible { spring, .. }) = playground.held else {
            panic!("the ring is held");
        };
        let before = playground.flex_bodies[ring].momentum();
        let (mut pull, mut below) = ([0.0; 2], 0.0);
        let n_steps = 60;
        for _ in 0..n_steps {
            playground.step().expect("a step");
            let attached = playground.flex_bodies.attachment(spring).expect("a spring");
            pull = [0, 1].map(|k| pull[k] + playground.dt() * attached.force()[k]);
            below += start[1] + 1.0 - playground.flex_bodies[ring].position(node)[1];
        }
        let after = playground.flex_bodies[ring].momentum();
        let seconds = f64::from(n_steps) * playground.dt();
        let expected = [
            after[0] - before[0],
            after[1] - before[1] + weight * seconds,
        ];
        for (pull, expected) in pull.into_iter().zip(expected) {
            let error = (pull - expected).abs() / (weight * seconds);
            assert!(error < 1e-5, "{pull} N s against {expected} N s");
        }
        // It hangs under the cursor by what the weight stretches the spring.
        let (below, stretch) = (below / f64::from(n_steps), 9.81 / (FREQUENCY * FREQUENCY));
        assert!(
            (below / stretch - 1.0).abs() < 0.05,
            "{below} m against {stretch} m"
        );
    }

    #[test]
    fn a_rigid_box_follows_the_mouse_and_falls_when_let_go() {
        let mut playground = Playground::new().expect("a world");
        for _ in 0..60 {
            playground.step().expect("a step");
        }
        let held = playground
            .world
            .intersect_point(vector([4.7, 1.0]), QueryFilter::only_dynamic())
            .next();
        let (_, collider) = held.expect("the upper box");
        let body = collider.parent().expect("a body");
        lift(&mut playground, [4.7, 1.0]);
        let height = |playground: &Playground| playground.world.bodies[body].translation().y;
        let stretch = 9.81 / (FREQUENCY * FREQUENCY);
        let place = f64::from(height(&playground));
        assert!(place > 1.7 - stretch && place < 2.1, "{place} m");
        playground.let_go().expect("lets go");
        for _ in 0..120 {
            playground.step().expect("a step");
        }
        assert!(height(&playground) < 1.1, "it falls");
    }
}
