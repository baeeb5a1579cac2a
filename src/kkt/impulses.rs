//! Rows of velocities and accelerations, and the impulses that solve them.

use super::cones;
use super::delassus::assemble;
use super::island::{ActiveContact, Island, KktError, SolveSettings};
use super::jammed::are_jammed;
use super::joints::{Among, Rows};
use super::rebound::rebound;
use super::sparse::Asked;
use crate::linalg::complementarity::{INDEPENDENT, RowKind, Status, give};
use crate::math::{perp, rounding};
use crate::system::Response;

/// States the impact law at the contacts that count and hold velocities, as velocities or masses respond.
pub(super) fn velocity_rows(
    island: &mut Island,
    settings: &SolveSettings,
    counts: impl Fn(&ActiveContact) -> bool,
) {
    state_rows(island, counts, |island, index| {
        let rebound = rebound(island, index, settings);
        let law = island.candidates[island.contacts[index].candidate].law;
        let contact = &mut island.contacts[index];
        // A resolved impact rebounds by its elasticity.
        let rebound = match contact.rebound {
            Some(at_end) => at_end,
            None if contact.is_hard => rebound,
            None => contact.rigid * rebound,
        };
        contact.parting = [rebound, 0.0];
        let row = &contact.kinematics;
        let velocity = row.relative(&island.blocks, |block, grip| block.velocity(grip));
        [
            velocity.dot(&row.normal) - rebound,
            (velocity - law.carried / settings.dt).dot(&row.tangent()),
        ]
    });
    list_acted(island, settings.b1);
}

/// States rows at the contacts that count and hold velocities.
///
/// - `free`: what the rows of a contact are without forces, along its normal and its tangent.
fn state_rows(
    island: &mut Island,
    counts: impl Fn(&ActiveContact) -> bool,
    free: impl Fn(&mut Island, usize) -> [f64; 2],
) {
    island.problem.clear_rows();
    for index in 0..island.contacts.len() {
        let contact = &island.contacts[index];
        if contact.is_closed() && contact.holds_velocity() != 0.0 && counts(contact) {
            let free = free(island, index);
            let contact = &island.contacts[index];
            let friction = island.candidates[contact.candidate].law.friction;
            island
                .problem
                .push(index, &contact.kinematics, friction, free);
        }
    }
}

/// Begins with the forces of the position stage at contacts of rigid bodies, on which they have not acted; how long they would have to
/// act for impulses is left to the solver.
fn guess_impulses(island: &mut Island) {
    island.problem.multipliers.clear();
    island
        .problem
        .multipliers
        .resize(island.problem.kinds.len(), 0.0);
    for (row, direction) in island.problem.rows.iter().enumerate() {
        let contact = &island.contacts[direction.contact];
        if contact.is_hard && island.problem.impulse_give == 0.0 {
            island.problem.multipliers[row] = contact.multiplier[direction.axis];
        }
    }
}

/// Solves the rows listed, those of the contacts and those of the joints after them, for impulses (or forces, of accelerations). All rows give
/// way a little where impulses [jam](super::jammed).
pub(super) fn solve_impulses(island: &mut Island, of: Response, dt: f64) -> Result<(), KktError> {
    island.problem.acted.resize(island.problem.kinds.len(), 0.0);
    if of != Response::Acceleration {
        island.problem.impulse_give = 0.0;
    }
    solve_impulses_once(island, of, dt)?;
    if of == Response::Velocity
        && are_jammed(
            &island.blocks,
            &island.contacts,
            [&island.problem.free, &island.problem.multipliers]
                .map(|values| &values[..island.problem.rows.len()]),
            dt,
        )
    {
        island.problem.impulse_give = give(INDEPENDENT);
        solve_impulses_once(island, of, dt)?;
    }
    Ok(())
}

fn solve_impulses_once(island: &mut Island, of: Response, dt: f64) -> Result<(), KktError> {
    let n = island.problem.kinds.len();
    if of != Response::ByMass && cones::is_sparse(island, n) {
        guess_impulses(island);
        let asked = Asked {
            of,
            which: Rows::End,
            unit: dt,
            give: island.problem.impulse_give,
        };
        cones::solve_sparse(island, asked)?;
        return Ok(());
    }
    match of {
        Response::Velocity => hold_wedged(island, dt),
        Response::Acceleration => hold_wedged(island, 1.0),
        _ => {}
    }
    let contacts = &island.contacts;
    assemble(
        &island.blocks,
        &island.problem.rows,
        of,
        |index| &contacts[index].kinematics,
        &mut island.problem.delassus,
    );
    soften(island);
    let among = Among {
        blocks: &island.blocks,
        contacts: &island.contacts,
    };
    island
        .joints
        .expand_softened(&mut island.problem, among, of);
    for row in 0..n {
        island.problem.delassus[row * (n + 1)] *= 1.0 + island.problem.impulse_give;
    }
    solve_rows(island)?;
    island.problem.responses.clear();
    island.problem.diagonals.clear();
    for row in 0..n {
        let line = &island.problem.delassus[row * n..(row + 1) * n];
        let moved = line
            .iter()
            .zip(&island.problem.multipliers)
            .map(|(w, p)| w * p);
        island.problem.responses.push(moved.sum());
        island.problem.diagonals.push(line[row]);
    }
    Ok(())
}

/// Lets the friction of rigid bodies that began in each other hold with what its position stage had: forces that press overlaps apart
/// wedge bodies with each other, and velocities know nothing of these. Such bodies would fall while they stand.
///
/// - `unit`: what forces act for (s), or 1 if forces are asked for.
fn hold_wedged(island: &mut Island, unit: f64) {
    for (row, direction) in island.problem.rows.iter().enumerate() {
        let contact = &island.contacts[direction.contact];
        let is_wedged = contact.is_parting() && contact.status[1] != Status::Open;
        if let (RowKind::Friction { coefficient, .. }, true) =
            (island.problem.kinds[row], is_wedged)
        {
            let most = (coefficient * contact.multiplier[0] * unit).max(0.0);
            island.problem.kinds[row] = RowKind::Box {
                low: -most,
                high: most,
            };
        }
    }
}

/// Lists what has acted already of the soft rows' multipliers: `scale` times those of the position stage.
pub(super) fn list_acted(island: &mut Island, scale: f64) {
    island.problem.acted.clear();
    for direction in &island.problem.rows {
        let contact = &island.contacts[direction.contact];
        let acted = if contact.is_hard {
            0.0
        } else {
            scale * contact.multiplier[direction.axis]
        };
        island.problem.acted.push(acted);
    }
}

/// Leaves impulses and the velocities of rows after them on the contacts.
pub(super) fn read_impulses(island: &mut Island) {
    for (row, direction) in island.problem.rows.iter().enumerate() {
        let change = change_of(island, row);
        let contact = &mut island.contacts[direction.contact];
        contact.parting[direction.axis] += island.problem.free[row] + change;
        contact.impulse[direction.axis] = island.problem.multipliers[row];
    }
}

/// What impulses have changed the velocity of a row by (m/s).
pub(super) fn change_of(island: &Island, row: usize) -> f64 {
    let contact = &island.contacts[island.problem.rows[row].contact];
    let share = if contact.is_hard {
        1.0
    } else {
        contact.holds_velocity().max(rounding::SUM)
    };
    let impulse = island.problem.multipliers[row];
    island.problem.responses[row] - (1.0 - share) * island.problem.diagonals[row] * impulse
}

/// Weights soft rows: `W_ii (1 - φ)/φ` on the diagonal lets a resolved contact keep its velocity.
fn soften(island: &mut Island) {
    let n = island.problem.rows.len();
    for row in 0..n {
        let contact = &island.contacts[island.problem.rows[row].contact];
        if !contact.is_hard {
            let share = contact.holds_velocity().max(rounding::SUM);
            island.problem.delassus[row * n + row] *= 1.0 + (1.0 - share) / share;
        }
    }
}

pub(super) fn solve_rows(island: &mut Island) -> Result<(), KktError> {
    island.problem.multipliers.clear();
    island
        .problem
        .multipliers
        .resize(island.problem.kinds.len(), 0.0);
    island.problem.statuses.clear();
    island
        .problem
        .statuses
        .resize(island.problem.kinds.len(), Status::Stick);
    island.problem.solver.set_redundancy_tolerance(1e-6);
    island
        .joints
        .tell_independence(&mut island.problem, &island.blocks);
    if !island.problem.acted.is_empty() {
        // Rows of joints follow those of contacts.
        island.problem.acted.resize(island.problem.kinds.len(), 0.0);
    }
    island.problem.solve()?;
    Ok(())
}

/// States the law of accelerations at the contacts that count and hold velocities.
pub(super) fn acceleration_rows(
    island: &mut Island,
    settings: &SolveSettings,
    counts: impl Fn(&ActiveContact) -> bool,
) {
    state_rows(island, counts, |island, index| {
        let contact = &island.contacts[index];
        let row = &contact.kinematics;
        // What vibrates faster than steps has no acceleration that lasts: a force that holds it is still there when the contact has opened.
        let share = match contact.is_massless {
            true => 1.0 - contact.unresolved,
            false => 1.0,
        };
        let mut acceleration = row.relative(&island.blocks, |block, grip| {
            block.smooth_acceleration(grip, share)
        });
        for a in row.attachments() {
            let answer = island.blocks[a.block].acceleration_under(island.wrenches[a.block]);
            acceleration += a.weight * (answer.0 + answer.1 * perp(a.grip.lever));
        }
        let [parting, sliding] = contact.parting.map(|velocity| velocity / settings.dt);
        [
            acceleration.dot(&row.normal) + parting,
            acceleration.dot(&row.tangent()) + sliding,
        ]
    });
    list_acted(island, 1.0);
}
