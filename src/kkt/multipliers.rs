//! Multipliers of the working set: rows of `G`, the Delassus matrix and one complementarity problem `w = W p + b`.

use super::cones;
use super::delassus::{assemble, compliance};
use super::island::{Island, KktError, SolveSettings};
use super::joints::{Among, Rows};
use super::sparse::Asked;
use super::summary::IslandSummary;
use super::working_set::slip;
use crate::constraint::contact::Kinematics;
use crate::linalg::complementarity::RowKind;
use crate::math::{Vec2, rounding};
use crate::system::{Block, Point, Response};

/// Multiple of the tolerance by which redundant rows may contradict each other.
const AVERAGED: f64 = 10.0;

/// One complementarity problem on the working set.
pub(super) fn solve_multipliers(
    island: &mut Island,
    settings: &SolveSettings,
    has_new_rows: bool,
    tolerance: f64,
    summary: &mut IslandSummary,
) -> Result<(), KktError> {
    if island.contacts.is_empty() && island.joints.ties.is_empty() {
        return Ok(());
    }
    for contact in &island.contacts {
        prepare(&mut island.blocks, &contact.kinematics);
        if has_new_rows {
            prepare(&mut island.blocks, &contact.applied);
        }
    }
    island.joints.prepare(&mut island.blocks);
    position_rows(island, settings.b0);
    let n_ties = island
        .joints
        .ties
        .iter()
        .filter(|tie| tie.is_movable)
        .count();
    if cones::is_sparse(island, island.problem.rows.len() + n_ties) {
        island.joints.list_positions(&mut island.problem, settings);
        let asked = Asked {
            of: Response::Position,
            which: Rows::Kept,
            unit: settings.b0,
            give: 0.0,
        };
        let outcome = cones::solve_sparse(island, asked)?;
        summary.residual = outcome.residual;
        read_multipliers(island);
        return Ok(());
    }
    let contacts = &island.contacts;
    let kinematics = |index: usize| &contacts[index].kinematics;
    assemble(
        &island.blocks,
        &island.problem.rows,
        Response::Position,
        kinematics,
        &mut island.problem.delassus,
    );
    take_out_multipliers(island, has_new_rows);
    yield_to_changes(island);
    let among = Among {
        blocks: &island.blocks,
        contacts: &island.contacts,
    };
    island
        .joints
        .add_positions(&mut island.problem, among, (settings, has_new_rows));
    let_go(island);
    let redundancy = redundancy_tolerance(island, tolerance / settings.b0);
    island.problem.solver.set_redundancy_tolerance(redundancy);
    island
        .joints
        .tell_independence(&mut island.problem, &island.blocks);
    island.problem.acted.clear();
    let outcome = island.problem.solve()?;
    summary.residual = outcome.residual;
    read_multipliers(island);
    Ok(())
}

/// Takes over a solution of the position problem.
fn read_multipliers(island: &mut Island) {
    for (row, direction) in island.problem.rows.iter().enumerate() {
        let contact = &mut island.contacts[direction.contact];
        contact.multiplier[direction.axis] = island.problem.multipliers[row];
        contact.status[direction.axis] = island.problem.statuses[row];
    }
    island.joints.take_multipliers(&island.problem);
}

/// Rows of the working set, with gaps and slips divided by `b0` and the multipliers that they were measured under.
pub(super) fn position_rows(island: &mut Island, b0: f64) {
    island.problem.clear_rows();
    island.problem.multipliers.clear();
    island.problem.statuses.clear();
    for (index, contact) in island.contacts.iter().enumerate() {
        let row = &contact.kinematics;
        let law = island.candidates[contact.candidate].law;
        let friction = law.friction;
        let slip = match contact.base {
            Some(_) => contact.slip,
            None => slip(row, &island.blocks) - contact.aside - law.carried.dot(&row.tangent()),
        };
        let free = [row.gap, slip].map(|way| way / b0);
        island.problem.push(index, row, friction, free);
        let n_rows = 1 + usize::from(friction > 0.0);
        let (known, statuses) = (&contact.multiplier[..n_rows], &contact.status[..n_rows]);
        island.problem.multipliers.extend_from_slice(known);
        island.problem.statuses.extend_from_slice(statuses);
    }
}

/// Lets every contact give way by the island's softness, along its normal to the change of its own multipliers, and along its tangent to
/// all of them: friction that holds against itself slips a little, or its forces grow from pass to pass.
fn yield_to_changes(island: &mut Island) {
    if island.passes.softness == 0.0 {
        return;
    }
    let n = island.problem.rows.len();
    for row in 0..n {
        let give = island.passes.softness * island.problem.delassus[row * (n + 1)];
        island.problem.delassus[row * (n + 1)] += give;
        if !matches!(island.problem.kinds[row], RowKind::Friction { .. }) {
            island.problem.free[row] -= give * island.problem.multipliers[row];
        }
    }
}

/// Takes contacts that geometry has lost out of the problem: what would answer to them is open.
fn let_go(island: &mut Island) {
    let n = island.problem.kinds.len();
    for (row, direction) in island.problem.rows.iter().enumerate() {
        if !island.contacts[direction.contact].is_lost {
            continue;
        }
        let own = island.problem.delassus[row * n + row];
        for other in 0..n {
            island.problem.delassus[row * n + other] = 0.0;
            island.problem.delassus[other * n + row] = 0.0;
        }
        island.problem.delassus[row * n + row] = own;
        island.problem.free[row] = match island.problem.kinds[row] {
            RowKind::Friction { .. } => 0.0,
            _ => own * island.problem.multipliers[row].abs(),
        };
    }
}

/// The natural-map residual of rows that move by `velocity` beyond what they may (m/s²): redundant rows that contradict
/// each other by less are averaged.
fn redundancy_tolerance(island: &Island, velocity: f64) -> f64 {
    let n = island.problem.kinds.len();
    let (mut largest, mut scale) = (0.0f64, 0.0f64);
    for (row, free) in island.problem.free.iter().enumerate() {
        let own = island.problem.delassus[row * n + row];
        if own > 0.0 {
            largest = largest.max(own);
            let load = free.abs().max(own * island.problem.multipliers[row].abs());
            scale = scale.max(load / own.sqrt());
        }
    }
    let residual = AVERAGED * velocity / (largest.sqrt() * scale);
    residual.clamp(rounding::SUM, rounding::SINGLE)
}

/// `b -= W p`: what the rows would be without the multipliers they were measured under.
///
/// Where the rows have changed since, the response is `G A⁻¹ G₀ᵀ p` with the rows `G₀` of that iterate: under a
/// heavy neighbour a force that turns by 1e-4 rad may throw a light body across the scene.
pub(super) fn take_out_multipliers(island: &mut Island, has_new_rows: bool) {
    let n = island.problem.rows.len();
    if n == 0 {
        return;
    }
    if !has_new_rows {
        for (free, row) in island
            .problem
            .free
            .iter_mut()
            .zip(island.problem.delassus.chunks_exact(n))
        {
            let response: f64 = row
                .iter()
                .zip(&island.problem.multipliers)
                .map(|(w, p)| w * p)
                .sum();
            *free -= response;
        }
        return;
    }
    let mut row = 0;
    while row < n {
        let contact = &island.contacts[island.problem.rows[row].contact];
        let mut response = Vec2::zeros();
        for other in island
            .contacts
            .iter()
            .filter(|other| other.multiplier[0] > 0.0)
        {
            let applied = &other.applied;
            let found = compliance(
                &island.blocks,
                &contact.kinematics,
                applied,
                Response::Position,
            );
            if let Some(compliance) = found {
                let [normal, tangent] = other.multiplier;
                let force = normal * applied.normal + tangent * applied.tangent();
                response += compliance * force;
            }
        }
        let first = row;
        while row < n && island.problem.rows[row].contact == island.problem.rows[first].contact {
            island.problem.free[row] -= island.problem.rows[row].direction.dot(&response);
            row += 1;
        }
    }
}

/// Makes the compliances of a contact's nodes known.
pub(super) fn prepare(blocks: &mut [Block], kinematics: &Kinematics) {
    for attachment in kinematics.attachments() {
        if let (Block::Flex(block), Point::Node(node)) =
            (&mut blocks[attachment.block], attachment.grip.point)
        {
            block.prepare_compliance(node);
        }
    }
}
