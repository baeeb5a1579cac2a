//! The energy stage: contact may store energy and give it back; what it would add is taken from the velocities.
//!
//! With `E` the kinetic and elastic energy and `W` the work of applied forces and of prescribed motion, the step may end
//! with `E' <= E + W + reserve`. The reserve is what contact has taken since it began, as far as that is the swing of the integrator about
//! the energy and no more: the rest is heat of dampers and impacts, which gives nothing back. Beyond that the end velocity is
//! changed along the response to the contact forces, which leaves momentum alone. A step gives back what it has gained itself; what it cannot is a
//! debt, and later losses pay it before they count as taken.
//!
//! With joints the reserve is all that was taken, unless forces act wholly within their step: they swing in the stored accelerations by more
//! than that, and velocities that are changed against it make it grow. Their debts are taken from any step, as are those of
//! bodies that are parted.

use super::active_contact::ActiveContact;
use super::calm::remove_relative_motion;
use super::delassus::RowDirection;
use super::island::{Island, SolveSettings};
use super::joints::Among;
use super::ledgers::Ledger;
use super::summary::IslandSummary;
use super::work::{
    end_energy, kinetic_energy, load_energy, momentum_at_most, start_energy, work_of_driven,
};
use super::{gathered, momentum, together};
use crate::math::{Vec2, judged::Judged, rounding};
use crate::system::{Block, Response};

/// Keeps contact, and turning frames, from adding energy, to what presses each other by itself: what flies beside it lends it none. Where there are
/// joints, all of the island has one account.
///
/// What contact has taken and may give back is kept in [`Island::reserves`], by the flexible blocks of a ledger alike; a debt is kept until it
/// is paid.
pub(super) fn limit_energy(
    island: &mut Island,
    settings: &SolveSettings,
    summary: &mut IslandSummary,
) {
    let mut ledgers = std::mem::take(&mut island.ledgers);
    let (blocks, contacts) = (&island.blocks[..], &island.contacts[..]);
    match island.joints.ties.is_empty() {
        true => ledgers.part(blocks, contacts, &island.pressed_before),
        false => ledgers.pool(blocks, contacts),
    }
    for block in 0..island.blocks.len() {
        let members = (&island.blocks[..], &island.contacts[..]);
        if let Some(ledger) = ledgers.led_by(block, members) {
            limit_ledger(island, ledger, settings, summary);
        }
    }
    island.ledgers = ledgers;
}

/// Energies of a ledger (J).
struct Balance {
    start: [f64; 2],
    end: [f64; 2],
    work: f64,
}

impl Balance {
    fn of(
        island: &Island,
        ledger: Ledger<'_>,
        settings: &SolveSettings,
        summary: &IslandSummary,
    ) -> Self {
        // What is known of the whole, joints included, need not be found again.
        if ledger.blocks.len() == island.blocks.len() {
            return Self {
                start: summary.start_energy,
                end: summary.end_energy,
                work: summary.work,
            };
        }
        Self {
            start: start_energy(members(island, ledger)),
            end: end_energy(members(island, ledger)),
            work: island.own_work(
                settings,
                (members(island, ledger), |block| ledger.has(block)),
                contacts_of(island, ledger),
            ),
        }
    }
}

/// The blocks of a ledger.
fn members<'a>(island: &'a Island, ledger: Ledger<'a>) -> impl Iterator<Item = &'a Block> {
    ledger.blocks.iter().map(|&block| &island.blocks[block])
}

/// The contacts of a ledger.
fn contacts_of<'a>(
    island: &'a Island,
    ledger: Ledger<'a>,
) -> impl Iterator<Item = &'a ActiveContact> {
    let own = ledger.contacts.iter();
    own.map(|&contact| &island.contacts[contact])
}

fn limit_ledger(
    island: &mut Island,
    ledger: Ledger<'_>,
    settings: &SolveSettings,
    summary: &mut IslandSummary,
) {
    let Balance { start, end, work } = Balance::of(island, ledger, settings, summary);
    let reserves = ledger.blocks.iter().map(|&block| island.reserves[block]);
    let before: f64 = reserves.sum();
    let mut reserve = before;
    let touches = contacts_of(island, ledger)
        .any(|contact| contact.multiplier[0] > 0.0 || contact.remembered.normal > 0.0);
    let [kinetic, elastic] = end;
    // By how much energy may swing does not depend on how fast all of it moves.
    let seen = seen_energy(island, ledger, settings.dt, kinetic) + elastic;
    let swings = island.has_swinging_joints(settings.is_within);
    let kept = match (touches, swings) {
        (false, false) => 0.0,
        (false, true) => seen,
        (true, false) => SWING * seen,
        (true, true) => f64::INFINITY,
    };
    reserve = reserve.min(kept);
    let gain = kinetic + elastic - start[0] - start[1] - work;
    reserve -= gain;
    let band = if touches { ROUND_OFF } else { SWING.get() };
    // What is there by mistake is no measure of it.
    let had = start[0] + start[1] + work.abs();
    let owed = -reserve - band * seen.min(had);
    // Older debts are paid by what later steps lose. Taken out of these, they are impulses that no contact of theirs has asked for: a soft disc
    // that rolled with one was driven by them. What swings in joints comes back in the steps after, and what parts overlaps is brought by several.
    let is_brought_back = swings || summary.is_parting;
    let debt = if is_brought_back {
        owed
    } else {
        owed.min(gain)
    };
    // At rest under load there are only rounding errors to take.
    let is_still = kinetic <= ROUND_OFF * elastic;
    let calmed_before = summary.calmed;
    if debt > 0.0 && !is_still {
        reserve += take(island, ledger, (debt, swings), settings, summary);
    }
    let left = summary.calmed - calmed_before - reserve - (-before).max(0.0);
    if left > 0.0 {
        let brought = had + load_energy(members(island, ledger));
        summary.added = summary.added.max(left / brought);
    }
    let is_flexible = |block: &Block| matches!(block, Block::Flex(_));
    let flexible = members(island, ledger).filter(|block| is_flexible(block));
    let n_sharing = flexible.count();
    for &block in ledger.blocks {
        if is_flexible(&island.blocks[block]) {
            island.reserves[block] = reserve / n_sharing as f64;
        }
    }
}

/// Takes a debt (J) out of the velocities of a ledger, as far as they have it; returns what was taken.
fn take(
    island: &mut Island,
    ledger: Ledger<'_>,
    (debt, swings): (f64, bool),
    settings: &SolveSettings,
    summary: &mut IslandSummary,
) -> f64 {
    let mut taken = 0.0;
    let mut take_along = |island: &mut Island, axis: usize, excess: f64| {
        let [removed, driven] = remove_along_contacts(island, (ledger, axis), excess, settings);
        summary.work += driven;
        summary.end_energy[0] += driven;
        removed
    };
    let touches = contacts_of(island, ledger)
        .any(|contact| contact.multiplier[0] > 0.0 || contact.remembered.normal > 0.0);
    if touches {
        taken = take_along(island, 0, debt);
    }
    if taken < debt {
        taken += remove_vibration(island, ledger, debt - taken);
    }
    if taken < debt {
        // By what sliding contacts may have pushed along.
        let pushed = contacts_of(island, ledger).map(|contact| contact.pushed_along());
        let most = pushed.sum::<f64>() / settings.dt;
        if most > 0.0 {
            taken += take_along(island, 1, most.min(debt - taken));
        }
    }
    if taken < debt && (swings || island.presses_joined()) {
        let leaders = together::groups_of(island, |block| !block.is_prescribed());
        let joints = (&island.joints.ties[..], &island.joints.grips[..]);
        let excess = debt - taken;
        let calmed = remove_relative_motion(&mut island.blocks, joints, &leaders, excess);
        summary.calmed += calmed;
        taken += calmed;
    }
    summary.limited += taken;
    summary.end_energy[0] -= taken;
    taken
}

/// Kinetic energy of a ledger as it is seen from the slowest of the driven bodies that touch or hold something of it (J).
fn seen_energy(island: &Island, ledger: Ledger<'_>, dt: f64, kinetic: f64) -> f64 {
    let of_contacts = contacts_of(island, ledger)
        .filter(|contact| contact.is_closed() || contact.remembered.normal > 0.0)
        .flat_map(|contact| contact.kinematics.attachments().iter().map(|a| a.block));
    let grips = island.joints.grips.iter().map(|grip| grip.block);
    let velocities = of_contacts
        .chain(grips)
        .filter_map(|block| match &island.blocks[block] {
            Block::Rigid(block) if block.is_prescribed() => {
                let [x, y, _] = block.moved();
                Some(Vec2::new(x, y) / dt)
            }
            _ => None,
        });
    let slowest = velocities.min_by(|one, other| one.norm().total_cmp(&other.norm()));
    let Some(velocity) = slowest.filter(|velocity| *velocity != Vec2::zeros()) else {
        return kinetic;
    };
    let moving = members(island, ledger).filter(|block| !block.is_prescribed());
    let seen = moving.map(|block| {
        let moments = block.end_moments();
        moments.mass * velocity.dot(&(0.5 * velocity - moments.velocity))
    });
    (kinetic + seen.sum::<f64>()).max(0.0)
}

/// Changes the end velocity along the response to the contact forces until `excess` (J) is gone, or as far as that
/// direction carries energy; returns what was removed, and what driven bodies did with it (J).
///
/// - `axis`: along the normals (0), or against what slides, as friction would (1): what lies taut around something has no normal motion.
fn remove_along_contacts(
    island: &mut Island,
    (ledger, axis): (Ledger<'_>, usize),
    excess: f64,
    settings: &SolveSettings,
) -> [f64; 2] {
    island.problem.rows.clear();
    island.problem.multipliers.clear();
    for &index in ledger.contacts {
        let contact = &island.contacts[index];
        let force = contact.multiplier[0].max(contact.remembered.normal);
        let counts = axis == 0 || contact.pushed_along() > 0.0;
        if force > 0.0 && !contact.is_hard && counts {
            let row = &contact.kinematics;
            let (direction, along) = match axis {
                0 => (row.normal, 1.0),
                _ => {
                    let velocity = row.relative(&island.blocks, |block, grip| block.velocity(grip));
                    (row.tangent(), -velocity.dot(&row.tangent()).signum())
                }
            };
            island.problem.rows.push(RowDirection {
                contact: index,
                axis,
                direction,
            });
            island.problem.multipliers.push(along * force * settings.dt);
        }
    }
    if island.problem.rows.is_empty() {
        return [0.0; 2];
    }
    // Along what contacts and joints together allow.
    let among = Among {
        blocks: &island.blocks,
        contacts: &island.contacts,
    };
    if island
        .joints
        .answer_contacts(&mut island.problem, among, settings)
        .is_err()
    {
        return [0.0; 2];
    }
    gathered::clear_impulses(island);
    gathered::gather_rows(island, Response::Velocity);
    gathered::respond(island);
    // Kinetic energy along v' + s z, less what driven bodies do on that way, is a parabola in s; three samples give it exactly.
    let driven = work_of_driven(&island.blocks, &island.wrenches, settings.dt);
    let before = kinetic_energy(&island.blocks);
    let after = add_responses(island, 1.0) - driven;
    let mirrored = add_responses(island, -2.0) + driven;
    let curvature = 0.5 * (after + mirrored) - before;
    let slope = 0.5 * (after - mirrored);
    // What presses against something that does not give way moves nothing, however often it is taken: it is taken no more often than would
    // undo it and bring all that moves to rest.
    let pressed: f64 = island.problem.multipliers[..island.problem.rows.len()]
        .iter()
        .map(|impulse| impulse.abs())
        .sum();
    let most = 1.0 + momentum_at_most(members(island, ledger)) / pressed;
    let step = step_of_parabola(curvature, slope, excess)
        .min(most)
        .max(-most);
    for (row, impulse) in island.problem.rows.iter().zip(&island.problem.multipliers) {
        island.contacts[row.contact].impulse[row.axis] += step * impulse;
    }
    let of_joints = &island.problem.multipliers[island.problem.rows.len()..];
    for (&row, impulse) in island.joints.listed.iter().zip(of_joints) {
        island.joints.ties[row].impulse += step * impulse;
    }
    add_responses(island, 1.0 + step);
    // What has flown away has slid since its row was measured: the levers of its force have a couple.
    momentum::balance_angular_momentum(island);
    let done = step * driven;
    [before + done - kinetic_energy(&island.blocks), done]
}

/// Adds a multiple of the responses to the velocities; returns the kinetic energy (J).
fn add_responses(island: &mut Island, scale: f64) -> f64 {
    gathered::add_to_rigid(island, Response::Velocity, scale);
    gathered::add_to_flexible(island, Response::Velocity, scale);
    kinetic_energy(&island.blocks)
}

/// Scales down the vibration of the flexible blocks of a ledger until `excess` (J) is gone; returns what was removed.
fn remove_vibration(island: &mut Island, ledger: Ledger<'_>, excess: f64) -> f64 {
    let mut vibration = 0.0;
    for &block in ledger.blocks {
        if let Block::Flex(block) = &mut island.blocks[block] {
            vibration += block.vibration_energy();
        }
    }
    if vibration <= 0.0 {
        return 0.0;
    }
    let before = kinetic_energy(&island.blocks);
    let factor = (1.0 - excess / vibration).max(0.0).sqrt();
    for &block in ledger.blocks {
        if let Block::Flex(block) = &mut island.blocks[block] {
            block.scale_vibration(factor);
        }
    }
    before - kinetic_energy(&island.blocks)
}

/// Energy error of one step by rounding, relative.
const ROUND_OFF: f64 = rounding::SUM;

/// Change of energy, relative, within which the integrator swings about it and gains nothing in the long run: of a body that turns freely,
/// and of what rests on each other and rocks.
const SWING: Judged = Judged::new("kkt::SWING", 1e-3);

/// The root nearer to zero of `curvature s² + slope s + excess = 0`, or the lowest point of the parabola.
fn step_of_parabola(curvature: f64, slope: f64, excess: f64) -> f64 {
    if curvature <= 0.0 {
        return 0.0;
    }
    let discriminant = slope * slope - 4.0 * curvature * excess;
    if discriminant <= 0.0 {
        return -slope / (2.0 * curvature);
    }
    let root = discriminant.sqrt().copysign(slope);
    (root - slope) / (2.0 * curvature)
}
