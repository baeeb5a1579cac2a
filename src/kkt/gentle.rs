//! The end of a step whose forces cannot be trusted: where the surfaces were first stopped, with velocities that no contact has added to.
//!
//! Positions stay on the feasible path. Velocities are those of the motion without contact, projected so that nothing that touches
//! approaches: a projection in the metric of the masses takes energy and never gives any, and its impulses come in pairs.

use super::active_contact::ActiveContact;
use super::follow;
use super::island::{Island, KktError, SolveSettings};
use super::summary::IslandSummary;
use super::tolerances::PARTING_RATE;
use super::work::{applied_work, end_energy};
use super::working_set;
use crate::constraint::contact::ContactMemory;
use crate::linalg::complementarity::Status;
use crate::math::{are_held, judged::Judged};
use crate::system::Block;

/// Energy beyond what there was and what loads have done that tells of forces that are none (-): as much as the tests of energy allow.
pub const GAINED: Judged = Judged::new("kkt::GAINED", 0.01);

/// Energy gained in a step, relative to what there was and was brought, that no swing of stored accelerations explains (-).
pub const DOUBLED: Judged = Judged::new("kkt::DOUBLED", 1.0);

/// Whether a step that is not solved has gained energy.
///
/// Parts of a step that gain a little each are not to gain much together: each has its share. What contact has taken before is not theirs to
/// give back.
pub(super) fn has_gained(
    island: &Island,
    settings: &SolveSettings,
    summary: &IslandSummary,
) -> bool {
    let [before, after] = [summary.start_energy, summary.end_energy].map(|[k, e]| k + e);
    // What stands together where the step began has gained nothing.
    let is_unsolved = summary.is_cut || summary.is_stopped && !island.path.is_empty();
    // Forces that no solution gave do no work to count on: neither of joints nor of driven bodies.
    let supply = applied_work(&island.blocks).max(0.0);
    let gain = after - before - supply;
    let share = GAINED * settings.dt / settings.whole;
    is_unsolved && (gain.is_nan() || gain > share * (before + supply))
}

/// Whether bodies that touch have come to more kinetic energy than twice what was brought and what they part with, by the margin at least: no
/// forces that mean anything do that.
pub(super) fn is_thrown(island: &Island, summary: &IslandSummary) -> bool {
    let most = (1.0 + DOUBLED.get()) * summary.brought() + parting_energy(island);
    let may_touch = !island.path.is_empty() || !island.contacts.is_empty();
    may_touch && summary.end_energy[0] > most
}

/// Whether contact has set more in motion than it had taken before and what could be taken from the velocities again: forces that hold each
/// other, as those on a corner that friction wedges into a notch, may be of any size, and what is left of them where levers turn drives.
///
/// What parts overlaps may store and lift as much as they are deep, but moves nothing faster than it is asked to part. Joints bring what they
/// close.
///
/// - `had`: what contact had taken before and may give back (J).
pub(super) fn is_fed(island: &Island, summary: &IslandSummary, had: f64) -> bool {
    let is_pressed = island.contacts.iter().any(ActiveContact::is_closed);
    if !is_pressed || summary.is_unsolved() || !island.joints.ties.is_empty() {
        return false;
    }
    let [kinetic, elastic] =
        [0, 1].map(|kind| summary.end_energy[kind] - summary.start_energy[kind]);
    let given = (-elastic).max(0.0) + summary.work.max(0.0) + had.max(0.0);
    kinetic - given > GAINED * summary.brought() + parting_energy(island)
}

/// Kinetic energy of bodies that part from the deepest overlap at twice the pace asked for, or from the margin where that is more (J).
pub(super) fn parting_energy(island: &Island) -> f64 {
    let overlaps = island.contacts.iter().map(|contact| -contact.allowance);
    let deepest = overlaps.fold(island.passes.margin, f64::max);
    let masses = island.blocks.iter().map(|block| match block {
        Block::Flex(block) => block.mass(),
        Block::Rigid(block) => block.mass()[0].max(block.mass()[1]),
    });
    2.0 * masses.sum::<f64>() * (PARTING_RATE * deepest).powi(2)
}

/// Whether some rigid body has come to a motion that rapier's numbers do not hold.
pub(super) fn is_flung(island: &Island) -> bool {
    island.blocks.iter().any(|block| match block {
        Block::Flex(_) => false,
        Block::Rigid(block) => {
            let motion = block.current();
            let [place, velocity] = [motion.centre, motion.velocity];
            let numbers = [
                place.x,
                place.y,
                velocity.x,
                velocity.y,
                motion.angle,
                motion.spin,
            ];
            !(are_held(&numbers) && block.smooth_end.iter().all(|value| value.is_finite()))
        }
    })
}

/// Ends the step where it was first stopped, or where it began, without forces of position.
///
/// # Errors
/// If a number is not finite.
pub(super) fn end_gently(
    island: &mut Island,
    settings: &SolveSettings,
    memory: &ContactMemory,
    summary: &mut IslandSummary,
) -> Result<(), KktError> {
    (summary.is_cut, summary.is_stopped) = (false, true);
    let tolerance = working_set::gap_tolerance(island, settings);
    if !follow::return_to_first_stop(island) {
        follow::return_to_start(island, settings, memory, tolerance);
    }
    let touching = island.path.least_margin();
    for contact in &mut island.contacts {
        let is_near = contact.base.is_none_or(|base| base.gap <= touching);
        // Closed for the law of velocities, with no force of position to speak of.
        let pressed = if is_near { f64::MIN_POSITIVE } else { 0.0 };
        contact.multiplier = [pressed, 0.0];
        (contact.impulse, contact.midway) = ([0.0; 2], [0.0; 2]);
        contact.settled = [0.0; 2];
        contact.status = [Status::Open; 2];
        contact.is_massless = false;
    }
    for tie in &mut island.joints.ties {
        tie.multiplier = 0.0;
        (tie.kick, tie.impulse) = (0.0, 0.0);
    }
    working_set::correct(island);
    island.path.stop(&mut island.blocks);
    working_set::measure_signed(island);
    follow::end_losses(island);
    for block in &mut island.blocks {
        match block {
            Block::Flex(block) => {
                block.place_velocities();
                block.measure_elastic_energy();
            }
            Block::Rigid(block) => block.forget_contact(),
        }
    }
    summary.gap_violation = working_set::gap_violation(island, true);
    settings.treatment().finish(island, settings, summary)?;
    let joint_work = island.joint_work(settings);
    summary.work = island.actual_work(settings) + joint_work.all;
    summary.stopped = joint_work.stopped;
    summary.end_energy = end_energy(&island.blocks);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraint::contact::{ContactLaw, Kinematics, Owner, Remembered};
    use crate::integrator::Beta2;
    use crate::kkt::{ActiveContact, Way};
    use crate::math::Vec2;
    use crate::system::{Point, RigidBlock, RigidLoad, RigidMotion, Step};

    const MARGIN: f64 = 0.01;

    /// Two balls of 2 kg, a metre apart, and whether they are led along a path.
    fn balls(are_led: bool) -> Island {
        let mut island = Island::default();
        let load = RigidLoad {
            inverse_mass: [0.5, 0.5, 1.0],
            force: [0.0; 3],
            damping: [0.0; 3],
        };
        let members = [0.0, 1.0].map(|x| {
            let motion = RigidMotion {
                centre: Vec2::new(x, 0.0),
                ..RigidMotion::default()
            };
            let step = Step::new(&Beta2::default(), 1e-2);
            let body = RigidBlock::free(motion, None, &load, &step);
            island.blocks.push(Block::Rigid(body));
            let centre = [(0, Vec2::zeros(), Vec2::zeros())];
            let block = island.blocks.len() - 1;
            let blocks = &island.blocks;
            island
                .path
                .rigid_member(block, blocks, 0, [0.1; 2], &centre, &[[0, 0]])
        });
        let way = Way {
            members,
            owners: [Owner::Collider(0), Owner::Collider(1)],
            law: ContactLaw::default(),
            places: (0, 0),
            closing: 0.2,
            margin: MARGIN,
            reach: 0.1,
        };
        assert!(!are_led || island.path.add_way(way));
        island
    }

    /// Twice what was brought is much, more than that is too much; what began in each other, or within the margin, may part at its pace besides.
    #[test]
    fn bodies_are_thrown_by_more_than_twice_what_was_brought() {
        let mut summary = IslandSummary {
            start_energy: [10.0, 5.0],
            work: -3.0,
            load_energy: 2.0,
            ..IslandSummary::default()
        };
        let mut island = balls(true);
        island.passes.margin = MARGIN;
        // Both at twice the pace at which so much parts.
        let parting = |way: f64| 2.0 * 0.5 * 2.0 * (2.0 * PARTING_RATE.get() * way).powi(2);
        let at_margin = parting(MARGIN);
        for (more, expected) in [(-40.0, false), (-0.1, false), (0.1, true), (1e20, true)] {
            summary.end_energy = [40.0 + at_margin + more, 1e3];
            assert_eq!(is_thrown(&island, &summary), expected, "{more} J");
            assert!(!is_thrown(&balls(false), &summary));
        }
        let grips = [0, 1].map(|block| {
            (
                block,
                Point::Arm(Vec2::zeros()),
                1.0 - 2.0 * block as f64,
                Vec2::zeros(),
            )
        });
        let row = Kinematics::with_levers(0.0, Vec2::new(1.0, 0.0), Vec2::zeros(), &grips);
        let mut contact = ActiveContact::new(0, row, Remembered::default(), 0.0, &island.blocks);
        contact.allowance = -0.1;
        island.contacts.push(contact);
        for (more, expected) in [(-0.1, false), (0.1, true)] {
            summary.end_energy = [40.0 + parting(0.1) + more, 0.0];
            assert_eq!(is_thrown(&island, &summary), expected, "{more} J");
        }
    }

    /// What is set in motion is fed, but for what was released, done and taken before, a hundredth of what there was and what parting brings; what is stored
    /// or lifted is not, nor is anything without contact.
    #[test]
    fn motion_that_nothing_explains_is_fed() {
        let mut island = balls(true);
        island.passes.margin = MARGIN;
        let grips = [0, 1].map(|block| {
            let way = 1.0 - 2.0 * block as f64;
            (block, Point::Arm(Vec2::zeros()), way, Vec2::zeros())
        });
        let row = Kinematics::with_levers(0.0, Vec2::new(1.0, 0.0), Vec2::zeros(), &grips);
        let mut contact = ActiveContact::new(0, row, Remembered::default(), 0.0, &island.blocks);
        contact.multiplier[0] = 1.0;
        assert!(contact.is_closed());
        island.contacts.push(contact);
        let mut summary = IslandSummary {
            start_energy: [10.0, 5.0],
            load_energy: 1.0,
            ..IslandSummary::default()
        };
        // 4 kg at twice the pace at which the margin parts.
        let parting = 0.5 * 4.0 * (2.0 * PARTING_RATE.get() * MARGIN).powi(2);
        // Work, energy released and energy that contact had taken before; how much motion that explains.
        for (work, elastic, had, explained) in [
            (0.0, 5.0, -3.0, 0.16),
            (2.0, 5.0, 0.0, 2.18),
            (-2.0, 5.0, 0.0, 0.18),
            (0.0, 1.0, 0.0, 4.16),
            (0.0, 9.0, 0.0, 0.16),
            (0.0, 5.0, 7.0, 7.16),
        ] {
            summary.work = work;
            for (more, expected) in [(-0.01, false), (0.01, true)] {
                summary.end_energy = [10.0 + explained + parting + more, elastic];
                let found = is_fed(&island, &summary, had);
                assert_eq!(found, expected, "{work} {elastic} {had}: {more}");
            }
        }
        summary.is_cut = true;
        assert!(!is_fed(&island, &summary, 0.0));
        summary.is_cut = false;
        island.contacts.clear();
        assert!(!is_fed(&island, &summary, 0.0));
    }
}
