//! A body whose surface has its mass while nothing touches it, and none while something does: how a motion goes on from one mass to the other.
//!
//! Places stay. The two masses see different momenta in a body that vibrates: velocities keep the momentum they had, and the angular momentum about
//! the centre of mass, by a rigid motion, and what is left of the kinetic energy scales the rest of them, so that no energy comes or goes.

use super::frame::{Arms, Frame};
use super::state::FlexState;
use crate::fe::model::Model;
use crate::math::{Vec2, add_node_vec, cross, node_vec, perp, rounding};

/// A mass, and the arms of the frame by it.
#[derive(Clone, Copy)]
pub(super) struct Measured<'a> {
    pub model: &'a Model,
    pub arms: &'a Arms,
}

impl Measured<'_> {
    /// Velocity that the whole body has in common (m/s): that of its pins along what they hold, else that of its centre of mass.
    fn common_velocity(&self, velocity: &[f64], is_fixed: &[bool]) -> Vec2 {
        let mean = self.arms.centre(Frame::Free, velocity, Vec2::zeros());
        let along = [0, 1].map(|axis| {
            let pinned = || {
                (axis..velocity.len())
                    .step_by(2)
                    .filter(|&dof| is_fixed[dof])
            };
            match pinned().count() {
                0 => mean[axis],
                n => pinned().map(|dof| velocity[dof]).sum::<f64>() / n as f64,
            }
        });
        Vec2::from(along)
    }

    /// What the frame turns about (m).
    fn centre(&self, state: &FlexState, kind: Frame) -> Vec2 {
        self.arms.centre(kind, &state.position, state.frame.centre)
    }

    /// Moment of inertia about a point (kg m²).
    fn inertia(&self, position: &[f64], about: Vec2) -> f64 {
        let mut turning = vec![0.0; position.len()];
        add_turn(&mut turning, position, about, 1.0);
        self.model.mass().moment(about, position, &turning)
    }
}

/// Makes a motion one of another mass; `false`, and nothing changed, where its energy cannot go on.
///
/// - `insists`: whether it has to, with another energy then.
pub(super) fn take_over(
    state: &mut FlexState,
    kind: Frame,
    is_fixed: &[bool],
    [old, new]: [Measured<'_>; 2],
    insists: bool,
) -> bool {
    let common = match kind {
        // To the last digit, as it goes on.
        Frame::Free => state.frame.velocity,
        Frame::Hinged(_) | Frame::Fixed => old.common_velocity(&state.velocity, is_fixed),
    };
    let [before, centre] = [old, new].map(|one| one.centre(state, kind));
    let own = relative(&state.velocity, common);
    let energy = old.model.mass().inner(&own, &own);
    let mut rest = relative(
        &state.velocity,
        new.common_velocity(&state.velocity, is_fixed),
    );
    let mut left = energy;
    let mut spin = 0.0;
    if kind != Frame::Fixed {
        let [was, is] = [(old, before, &own), (new, centre, &rest)]
            .map(|(one, centre, own)| one.model.mass().moment(centre, &state.position, own));
        let inertia = new.inertia(&state.position, centre);
        add_turn(&mut rest, &state.position, centre, -is / inertia);
        spin = was / inertia;
        left -= inertia * spin * spin;
    }
    let vibrating = new.model.mass().inner(&rest, &rest);
    if (left - vibrating).abs() > rounding::SHARE * energy {
        if left < 0.0 && !insists {
            return false;
        }
        let scale = if left > 0.0 && vibrating > 0.0 {
            (left / vibrating).sqrt()
        } else {
            1.0
        };
        rest.iter_mut().for_each(|value| *value *= scale);
    }
    add_turn(&mut rest, &state.position, centre, spin);
    for ((velocity, rest), dof) in state.velocity.iter_mut().zip(&rest).zip(0..) {
        if !is_fixed[dof] {
            *velocity = common[dof % 2] + rest;
        }
    }
    state.torque -= cross(centre - before, new.arms.mass * state.frame.acceleration);
    state.frame.centre = centre;
    state.split_position(new.arms, kind);
    state.split_velocity(new.arms, kind);
    carry_forces([old, new], kind, &mut state.acceleration);
    state.kinetic_energy = 0.5 * new.model.mass().inner(&state.velocity, &state.velocity);
    true
}

/// Makes accelerations those by which the new mass takes the same forces; nodes without mass have none, and take over none.
///
/// Other accelerations would do work in the next step, by which what the step does not resolve could grow.
fn carry_forces([old, new]: [Measured<'_>; 2], kind: Frame, acceleration: &mut [f64]) {
    let masses = old.arms.node_mass.iter().zip(&new.arms.node_mass);
    for ((old, new), acceleration) in masses.zip(acceleration.chunks_exact_mut(2)) {
        if *new > 0.0 {
            acceleration
                .iter_mut()
                .for_each(|value| *value *= old / new);
        }
    }
    new.arms.split(kind, acceleration);
}

/// Velocities beside a common one (m/s).
fn relative(velocity: &[f64], common: Vec2) -> Vec<f64> {
    let pairs = velocity.chunks_exact(2);
    pairs
        .flat_map(|v| [v[0] - common.x, v[1] - common.y])
        .collect()
}

fn add_turn(velocity: &mut [f64], position: &[f64], about: Vec2, spin: f64) {
    for node in 0..velocity.len() / 2 {
        let arm = node_vec(position, node) - about;
        add_node_vec(velocity, node, spin * perp(arm));
    }
}

#[cfg(test)]
mod tests {
    use crate::body::{FlexBody, FlexBodyBuilder, Pin};
    use crate::fe::material::LinearElastic;
    use crate::math::{cos, sin};

    const NEAR: f64 = 1e-12;

    /// A bar that is bent, turned and stretched, flies, spins and vibrates.
    fn bar(pin: impl Fn(FlexBodyBuilder) -> FlexBodyBuilder) -> FlexBody {
        let bar = FlexBodyBuilder::rectangle([1.0, 0.2], [10, 4])
            .small_strain()
            .material(LinearElastic::plane_stress(1e6, 0.3).density(1000.0));
        let mut body = pin(bar).build().expect("a sound bar");
        let held = body.is_fixed.clone();
        for node in 0..body.n_nodes() {
            let [x, y] = body.mesh().nodes()[node];
            let moves = [
                [3e-3 * sin(4.0 * x) + 2e-3 * x * y, 4e-3 * cos(5.0 * x)],
                [
                    7.0 - 2.0 * y + 0.3 * sin(3.0 * x),
                    2.0 * x + 0.5 * cos(7.0 * x) * (1.0 + y),
                ],
            ];
            for axis in 0..2 {
                if !held[2 * node + axis] {
                    body.state.position[2 * node + axis] += moves[0][axis];
                    body.state.velocity[2 * node + axis] = moves[1][axis];
                }
            }
        }
        body.state.frame.centre =
            body.arms
                .centre(body.frame, &body.state.position, body.arms.origin);
        body.state.split_position(&body.arms, body.frame);
        body.velocity_changed();
        body
    }

    /// Momentum, angular momentum about the centre, kinetic energy.
    fn figures(body: &FlexBody) -> [f64; 4] {
        let [x, y] = body.momentum();
        let spin = body.polar_moment() * body.angvel();
        [x, y, spin, body.energy().kinetic]
    }

    #[track_caller]
    fn assert_same(now: &[f64], before: &[f64]) {
        for (now, before) in now.iter().zip(before) {
            assert!(
                (now - before).abs() < NEAR * before.abs(),
                "{now} for {before}"
            );
        }
    }

    #[test]
    fn a_free_body_keeps_momentum_spin_and_energy() {
        let mut body = bar(|bar| bar);
        let [before, places] = [figures(&body).to_vec(), body.state.position.clone()];
        let [free, touched] = [body.free_model(), body.touched_model()].map(|model| model.mass());
        assert_ne!(free.node_sums(), touched.node_sums());
        for is_touched in [true, false, true, false] {
            body.set_touched(is_touched, false);
            assert_eq!(body.model().has_massless_nodes(), is_touched);
            assert_same(&figures(&body), &before);
            assert_same(&[body.state.kinetic_energy], &before[3..]);
            assert_eq!(body.state.position, places);
        }
    }

    /// One that only flies and spins goes on as it was.
    #[test]
    fn a_rigid_motion_is_the_same_by_both_masses() {
        let mut body = FlexBodyBuilder::rectangle([1.0, 0.2], [10, 4])
            .small_strain()
            .material(LinearElastic::plane_stress(1e6, 0.3).density(1000.0))
            .translation([3.0, 4.0])
            .linvel([5.0, -2.0])
            .angvel(3.0)
            .build()
            .expect("a sound bar");
        let before = body.state.velocity.clone();
        body.set_touched(true, false);
        for (now, before) in body.state.velocity.iter().zip(&before) {
            assert!((now - before).abs() < NEAR, "{now} for {before}");
        }
    }

    /// A bar on pins keeps what the pins do not take, and its energy.
    #[test]
    fn a_body_on_pins_keeps_its_energy() {
        let pins: [fn(FlexBodyBuilder) -> FlexBodyBuilder; 3] = [
            |bar| bar.pin(0, Pin::both()),
            |bar| bar.pin_where(|[x, _]| x < 0.01, Pin::both()),
            |bar| bar.pin_where(|[_, y]| y < 0.01, Pin { x: false, y: true }),
        ];
        for (at, pin) in pins.into_iter().enumerate() {
            let mut body = bar(pin);
            let before = figures(&body);
            for is_touched in [true, false] {
                body.set_touched(is_touched, false);
                assert_eq!(body.model().has_massless_nodes(), is_touched);
                assert_same(&figures(&body)[3..], &before[3..]);
                if at == 2 {
                    assert_same(&figures(&body)[..1], &before[..1]);
                }
            }
        }
    }
}
