//! Impulses that jam: a body between two that are driven together, or in a narrow wedge that closes.
//!
//! What is driven gives way to nothing, and the law of impacts has an answer only where bodies can be thrown out: by impulses that take a
//! million times the energy that there is, and out of a wedge of a hundredth at a hundred times the speed of its faces. Materials yield before. Where all
//! rows give way by a thousandth of their mobility, impulses bring no energy, and what is driven goes into what does not get out.

use super::active_contact::ActiveContact;
use super::work::{kinetic_energy, mass_and_energy};
use crate::linalg::complementarity::{INDEPENDENT, give};
use crate::system::Block;

/// Whether the impulses of contacts take more energy from the motion before than there is.
///
/// Where nothing is driven, the laws take no more than the kinetic energy, whatever the masses: `-½ P·w` of all rows. Between driven bodies that is what
/// there would be if each body came against all others with the largest velocity of these; what gets out of a wedge takes more, as far as the wedge is
/// wider than what rows give way by. What loads bring within the step is there as well: of a stiff body at rest that is all, and surfaces without mass
/// move by it.
///
/// - `free`, `impulses`: what the rows of contacts are without impulses (m/s), and these (N s).
/// - `dt`: length of the step (s).
pub(super) fn are_jammed(
    blocks: &[Block],
    contacts: &[ActiveContact],
    [free, impulses]: [&[f64]; 2],
    dt: f64,
) -> bool {
    let taken = free.iter().zip(impulses);
    let taken: f64 = taken.map(|(motion, impulse)| -0.5 * motion * impulse).sum();
    if taken * give(INDEPENDENT) <= kinetic_energy(blocks) {
        return false;
    }
    let driven = contacts.iter().flat_map(|contact| {
        let grips = contact.kinematics.attachments().iter();
        grips.filter_map(|one| match &blocks[one.block] {
            Block::Rigid(block) if block.is_prescribed() => Some(block.velocity(one.grip.lever)),
            _ => None,
        })
    });
    let fastest = driven.map(|velocity| velocity.norm()).fold(0.0, f64::max);
    let there: f64 = blocks
        .iter()
        .map(|block| {
            let (mass, energy) = mass_and_energy(block);
            let by_loads = match mass.is_finite() && mass > 0.0 {
                true => dt * block.resultant().norm() / mass.sqrt(),
                false => 0.0,
            };
            0.5 * ((2.0 * energy).sqrt() + mass.sqrt() * fastest + by_loads).powi(2)
        })
        .sum();
    taken * give(INDEPENDENT) > there
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraint::contact::{Kinematics, Remembered};
    use crate::integrator::Beta2;
    use crate::kkt::together::tests::rigid;
    use crate::math::Vec2;
    use crate::path::samples::Random;
    use crate::system::{Point, RigidBlock, RigidLoad, RigidMotion, Step};

    const ALONG: Vec2 = Vec2::new(1.0, 0.0);

    /// Impulses take what there is from bodies that are stopped, whatever they weigh, and no laws take a thousand times as much.
    #[test]
    fn what_stops_bodies_jams_nothing_and_what_takes_a_thousand_times_their_energy_does() {
        let mut random = Random::new(3);
        for _ in 0..20 {
            let (body, _) = rigid(&mut random, Vec2::zeros());
            let Block::Rigid(one) = &body else {
                panic!("it is rigid");
            };
            let (mass, velocity) = (one.mass()[0], one.current().velocity.x);
            let blocks = [body];
            let jams = |impulse| are_jammed(&blocks, &[], [&[velocity], &[impulse]], 0.0);
            let stops = -mass * velocity;
            let [before, taken] = [kinetic_energy(&blocks), 0.5 * mass * velocity.powi(2)];
            assert!(taken <= before);
            assert!(!jams(stops) && !jams(-stops));
            assert!(!jams(0.9e3 * before / taken * stops));
            assert!(jams(1.1e3 * before / taken * stops));
        }
    }

    /// A driven wall brings its own: what it sets in motion is not jammed, and a thousand times that is.
    #[test]
    fn a_driven_wall_may_bring_what_sets_a_body_in_motion() {
        let step = Step::new(&Beta2::default(), 1e-2);
        let load = RigidLoad {
            inverse_mass: [0.5, 0.5, 1.0],
            force: [0.0; 3],
            damping: [0.0; 3],
        };
        let body = RigidBlock::free(RigidMotion::default(), None, &load, &step);
        let driven = RigidMotion {
            velocity: 3.0 * ALONG,
            ..RigidMotion::default()
        };
        let wall = RigidBlock::prescribed(driven, driven);
        let blocks = [body, wall].map(Block::Rigid);
        let arm = Point::Arm(Vec2::zeros());
        let grips =
            [(0, 1.0), (1, -1.0)].map(|(block, weight)| (block, arm, weight, Vec2::zeros()));
        let row = Kinematics::with_levers(0.0, ALONG, Vec2::zeros(), &grips);
        let contact = ActiveContact::new(0, row, Remembered::default(), 0.5, &blocks);
        let jams = |impulse| are_jammed(&blocks, &[contact], [&[-3.0], &[impulse]], 0.0);
        assert!(!jams(2.0 * 3.0));
        assert!(!jams(0.9e3 * 2.0 * 3.0));
        assert!(jams(1.1e3 * 2.0 * 3.0));
    }

    /// What stops a body at rest that a force has acted on for a step takes what that has brought, and what takes a thousand times as much jams.
    #[test]
    fn loads_bring_what_they_do_within_a_step() {
        let (mass, force, dt) = (2.0, 30.0, 0.1);
        let load = RigidLoad {
            inverse_mass: [1.0 / mass, 1.0 / mass, 1.0],
            force: [force, 0.0, 0.0],
            damping: [0.0; 3],
        };
        let step = Step::new(&Beta2::default(), dt);
        let mut body = RigidBlock::free(RigidMotion::default(), None, &load, &step);
        body.stop_at(Vec2::zeros(), 0.0);
        let blocks = [Block::Rigid(body)];
        let speed = force * dt / mass;
        let jams = |impulse: f64| are_jammed(&blocks, &[], [&[-speed], &[impulse]], dt);
        assert!(kinetic_energy(&blocks) == 0.0);
        assert!(!jams(0.9e3 * mass * speed) && jams(1.1e3 * mass * speed));
    }
}
