//! The rows of an island as one sparse problem on friction cones, for islands of many contacts.
//!
//! Flexible blocks enter with their whole effective matrix, in their frames, free rigid ones as two nodes: the centre of mass, and the
//! angle beside a dof that nothing moves. The dense problem of [`delassus`](super::delassus) costs the cube of the number of rows, this
//! one little more than factorizing the bodies: operations decide.

use super::delassus::compliance;
use super::island::{Island, KktError};
use super::joints::JOINED;
use super::joints::Rows;
use super::sparse::{Asked, Kept, Sparse};
use super::tolerances::{LARGE_TOLERANCE, YIELDING};
use crate::constraint::joint::unit_wrench;
use crate::linalg::complementarity::{RowKind, Status};
use crate::linalg::cone::{ConeLaw, ConeOutcome, ConeProblem, ConeRow, ConeStatus};
use crate::math::{Vec2, rounding};
use crate::system::{Block, Point, Response};

/// Scalar rows up to which the dense problem is always the quicker one.
const ALWAYS_DENSE: usize = 24;

/// Operations that the dense problem may take more often than the sparse one takes for a factor (-): its laws hold to rounding, and not to a
/// thousandth of the margin.
const WORTH: f64 = 4.0;

/// Share of a joint's force that it gives way to as contacts do (-); to the rest only as it changes, or a chain would open.
const JOINT_SHARE: f64 = 0.05;

/// Whether the scalar rows at hand are better solved as a sparse problem: where they are many, and where contacts and joints may hold the same
/// motion, which the dense one takes for forces of any size.
pub(super) fn is_sparse(island: &Island, n_rows: usize) -> bool {
    let presses_joined = island
        .contacts
        .iter()
        .any(|contact| island.joints.joins(contact));
    if island.path.is_empty() || n_rows <= ALWAYS_DENSE && !presses_joined {
        return false;
    }
    let mut operations = 0.0;
    for block in &island.blocks {
        match block {
            Block::Flex(block) if block.is_explicit() => return false,
            Block::Flex(block) => operations += block.factor_operations(),
            Block::Rigid(_) => operations += 64.0,
        }
    }
    let n = n_rows as f64;
    presses_joined || n * n * n / 3.0 > WORTH * operations
}

/// Solves the rows, kinds and free motions at hand from the multipliers given; writes multipliers, statuses, responses and diagonals.
///
/// `free` is what the rows are under the forces that act along [`ActiveContact::applied`](super::ActiveContact) and the joints'
/// applied rows if positions are asked for, and without forces of these rows otherwise.
pub(super) fn solve_sparse(island: &mut Island, asked: Asked) -> Result<ConeOutcome, KktError> {
    let mut sparse = std::mem::take(&mut island.sparse);
    let outcome = state_sparse(island, &mut sparse, asked);
    let outcome = outcome.and_then(|()| answer_sparse(island, &mut sparse, asked));
    island.sparse = sparse;
    island.problem.n_pivots += outcome
        .as_ref()
        .map_or(0, |outcome| outcome.n_factorizations);
    outcome
}

/// Notes how far every contact that presses moves under its force and gives way to it: along its normal where the rows at hand are solved
/// as a sparse problem, along its tangent where they contradict each other.
pub(super) fn note_yielding(island: &mut Island, b0: f64) {
    let is_sparse = is_sparse(island, 2 * island.contacts.len() + island.joints.ties.len());
    let yields = match island.passes.softness {
        0.0 if is_sparse => [YIELDING, 0.0],
        softness => [0.0, softness],
    };
    for contact in &mut island.contacts {
        (contact.yielding, contact.mobility) = ([0.0; 2], None);
        if yields != [0.0; 2] && contact.multiplier[0] > 0.0 {
            let row = &contact.kinematics;
            let own = compliance(&island.blocks, row, row, Response::Position);
            let own = own.unwrap_or_default();
            let along = [row.normal, row.tangent()].map(|along| along.dot(&(own * along)));
            let mobility = along.map(|along| b0 * along.max(0.0));
            contact.yielding = [0, 1].map(|k| yields[k] * mobility[k]);
            contact.mobility = Some(mobility);
        }
    }
}

fn state_sparse(island: &Island, sparse: &mut Sparse, asked: Asked) -> Result<(), KktError> {
    sparse.fill_matrix(&island.blocks);
    sparse.rows.clear();
    sparse.entries.clear();
    sparse.places.clear();
    sparse.multipliers.clear();
    sparse.slip.clear();
    sparse.couples.clear();
    sparse.couples.resize(island.blocks.len(), [0.0; 2]);
    if asked.of == Response::Position {
        let grips = [&island.joints.applied_grips[..], &island.joints.grips];
        sparse.add_up_couples(&island.blocks, &island.contacts, &island.joints.ties, grips);
    }
    let mut row = 0;
    while row < island.problem.rows.len() {
        let index = island.problem.rows[row].contact;
        let contact = &island.contacts[index];
        let has_friction = matches!(island.problem.kinds.get(row + 1), Some(RowKind::Friction { normal, .. }) if *normal == row);
        let step = 1 + usize::from(has_friction);
        if contact.is_lost && asked.of == Response::Position {
            row += step;
            continue;
        }
        let kinematics = &contact.kinematics;
        let (normal, tangent) = (kinematics.normal, kinematics.tangent());
        let first = sparse.entries.len() as u32;
        for a in kinematics.attachments() {
            let directions = [a.weight * normal, a.weight * tangent];
            sparse.grip(
                &island.blocks,
                a.block,
                (a.grip.point, a.grip.lever),
                directions,
            );
        }
        let own = compliance(&island.blocks, kinematics, kinematics, asked.of);
        let scale = own.map_or([0.0; 2], |own| {
            [normal, tangent].map(|along| along.dot(&(own * along)).max(0.0))
        });
        // What damped surfaces without mass yield beyond what `A` knows.
        let yielded = match asked.of {
            Response::Position => {
                compliance(&island.blocks, kinematics, kinematics, Response::Velocity)
            }
            _ => None,
        };
        let softness = match asked.of {
            Response::Position => 0.0,
            _ if contact.is_hard => 0.0,
            _ => {
                let share = contact.holds_velocity().max(rounding::SUM);
                (1.0 - share) / share
            }
        };
        let give = match yielded {
            Some(known) => {
                let along = [normal, tangent].map(|along| along.dot(&(known * along)));
                [0, 1].map(|k| (scale[k] - along[k]).max(0.0))
            }
            None => scale.map(|own| softness * own),
        };
        let turned: Vec2 = (kinematics.attachments().iter())
            .map(|a| a.weight * sparse.turned(&island.blocks, a.block, a.grip))
            .sum();
        // Gaps are measured where the forces that act already have made it yield.
        let (give, given) = match asked.of {
            Response::Position => {
                let yielding = scale.map(|own| island.passes.softness.max(YIELDING) * own);
                let softness = scale.map(|own| island.passes.softness * own);
                // What friction holds against itself slips a little, or its forces grow from pass to pass.
                let contradicts = island.passes.softness > 0.0;
                let kept = [softness[0], if contradicts { 0.0 } else { yielding[1] }];
                (
                    [0, 1].map(|k| give[k] + yielding[k]),
                    [0, 1].map(|k| (give[k] + kept[k]) * contact.multiplier[k]),
                )
            }
            _ => {
                let joined = f64::from(island.joints.joins(contact)) * JOINED.get();
                let share = asked.give.max(joined);
                ([0, 1].map(|k| give[k] + share * scale[k]), [0.0; 2])
            }
        };
        let friction = match island.problem.kinds.get(row + 1) {
            Some(RowKind::Friction { coefficient, .. }) if has_friction => *coefficient,
            _ => 0.0,
        };
        let second = |values: &[f64]| if has_friction { values[row + 1] } else { 0.0 };
        let acted = if island.problem.acted.is_empty() || asked.of == Response::Position {
            [0.0; 2]
        } else {
            [island.problem.acted[row], second(&island.problem.acted)]
        };
        sparse.rows.push(ConeRow {
            entries: (first, sparse.entries.len() as u32),
            law: ConeLaw::Contact { friction },
            free: [
                island.problem.free[row] - given[0] + normal.dot(&turned),
                second(&island.problem.free) - given[1] + tangent.dot(&turned),
            ],
            give,
            acted,
            scale,
            local: f64::INFINITY,
        });
        sparse.places.push(row);
        // What slid at the last look slides on, about as far.
        let slides = matches!(
            contact.status[1],
            Status::SlipPositive | Status::SlipNegative
        );
        let far = match asked.of {
            Response::Position => contact.slip.abs() / asked.unit,
            Response::Velocity => contact.slip.abs() / asked.unit,
            Response::Acceleration | Response::ByMass => 0.0,
        };
        sparse.slip.push(if slides { far } else { 0.0 });
        sparse.multipliers.push([
            island.problem.multipliers[row],
            second(&island.problem.multipliers),
        ]);
        row += step;
    }
    for slot in 0..island.joints.listed.len() {
        let place = island.problem.rows.len() + slot;
        let tie = &island.joints.ties[island.joints.listed[slot]];
        let grips = match asked.which {
            Rows::Kept => &island.joints.grips,
            Rows::End => &island.joints.end_grips,
        };
        let direction = match asked.which {
            Rows::Kept => tie.direction,
            Rows::End => tie.end,
        };
        let is_turn = tie.row.measure.is_turn();
        let first = sparse.entries.len() as u32;
        for grip in &grips[tie.row.grips.0..tie.row.grips.1] {
            sparse.joint_grip(&island.blocks, grip, direction, is_turn);
        }
        let scale = island.joints.mobility(
            &island.blocks,
            island.joints.listed[slot],
            (asked.of, asked.which),
        );
        let own = &grips[tie.row.grips.0..tie.row.grips.1];
        // What welds a stiff body by many nodes holds their places to each other too, which a share of the whole body's motion would let go.
        let local = sparse.local_mobility(&island.blocks, own);
        let yielding = match asked.of {
            Response::Position if !tie.is_hard => (YIELDING * scale).min(LARGE_TOLERANCE * local),
            _ => 0.0,
        };
        let turned = own.iter().map(|grip| {
            let turned = sparse.turned(&island.blocks, grip.block, grip.grip());
            grip.weight * direction.dot(&turned)
        });
        let turned: f64 = turned.sum();
        sparse.rows.push(ConeRow {
            entries: (first, sparse.entries.len() as u32),
            law: match island.problem.kinds[place] {
                RowKind::Bilateral => ConeLaw::Bilateral,
                RowKind::Box { low, high } => ConeLaw::Box { low, high },
                _ => ConeLaw::Unilateral,
            },
            free: [
                island.problem.free[place] - (1.0 - JOINT_SHARE) * yielding * tie.multiplier
                    + turned,
                0.0,
            ],
            give: [
                island.joints.gives[slot]
                    + yielding
                    + asked.give * scale
                    + (1.0 / tie.share_of(asked.of) - 1.0) * scale,
                0.0,
            ],
            acted: [0.0; 2],
            scale: [scale, 0.0],
            local,
        });
        sparse.places.push(place);
        sparse.slip.push(0.0);
        sparse
            .multipliers
            .push([island.problem.multipliers[place], 0.0]);
    }
    sparse.load.clear();
    sparse.load.resize(2 * sparse.n_nodes(), 0.0);
    if asked.of == Response::Position {
        load_applied(island, sparse);
    }
    Ok(())
}

/// Takes the forces that act already out of the load: `r = -G₀ᵀ p`.
fn load_applied(island: &Island, sparse: &mut Sparse) {
    sparse.scratch_begin();
    for contact in &island.contacts {
        let [normal, tangent] = contact.multiplier;
        let force = -(normal * contact.applied.normal + tangent * contact.applied.tangent());
        for a in contact.applied.attachments() {
            let grip = (a.grip.point, a.grip.lever);
            sparse.push_load(&island.blocks, a.block, grip, a.weight * force);
        }
    }
    for tie in &island.joints.ties {
        let is_turn = tie.row.measure.is_turn();
        for grip in &island.joints.applied_grips[tie.row.grips.0..tie.row.grips.1] {
            match (&island.blocks[grip.block], grip.point) {
                (Block::Flex(_), Point::Node(_)) => {
                    let force = -tie.multiplier * grip.weight * tie.applied;
                    sparse.push_load(&island.blocks, grip.block, (grip.point, grip.lever), force);
                }
                _ => {
                    let wrench = unit_wrench(grip, tie.applied, is_turn);
                    let wrench = wrench.map(|value| -tie.multiplier * value);
                    sparse.push_wrench(&island.blocks, grip.block, wrench);
                }
            }
        }
    }
}

fn answer_sparse(
    island: &mut Island,
    sparse: &mut Sparse,
    asked: Asked,
) -> Result<ConeOutcome, KktError> {
    let Sparse {
        kept,
        at,
        rows,
        entries,
        places,
        load,
        multipliers,
        slip,
        answer,
        ..
    } = sparse;
    let Some(Kept {
        matrix, solvers, ..
    }) = kept.get_mut(*at)
    else {
        return Ok(ConeOutcome::default());
    };
    let [first, others @ ..] = solvers;
    let of_others = match asked.of {
        Response::Position => None,
        Response::Velocity => Some(0),
        Response::Acceleration => Some(1),
        Response::ByMass => Some(2),
    };
    let problem = ConeProblem {
        matrix,
        load,
        rows,
        entries,
    };
    let (solver, like) = match of_others {
        None => (first, None),
        Some(index) => (&mut others[index], Some(&*first)),
    };
    let unit = match asked.of {
        Response::Position | Response::Velocity => asked.unit,
        Response::Acceleration | Response::ByMass => asked.unit * asked.unit,
    };
    // A fifth of what a pass accepts at the most; where it accepts less, the solver goes by what the start misses, as it does.
    solver.settings.gap_tolerance = 0.2 * LARGE_TOLERANCE * island.path.least_margin() / unit;
    solver.settings.slip_tolerance = 1e-4;
    solver.settings.tolerance = 1e-6;
    solver.scales_start = asked.of == Response::Velocity;
    let outcome = solver.solve_like(like, &problem, multipliers, slip, answer)?;
    let n = island.problem.kinds.len();
    island.problem.multipliers.fill(0.0);
    island.problem.statuses.clear();
    island.problem.statuses.resize(n, Status::Open);
    island.problem.responses.clear();
    island.problem.responses.resize(n, 0.0);
    island.problem.diagonals.clear();
    island.problem.diagonals.resize(n, 0.0);
    for (slot, row) in rows.iter().enumerate() {
        let place = places[slot];
        let status = match solver.status()[slot] {
            ConeStatus::Open => Status::Open,
            ConeStatus::Stick => Status::Stick,
            ConeStatus::SlipPositive => Status::SlipPositive,
            ConeStatus::SlipNegative => Status::SlipNegative,
        };
        let motion = problem.motion(row, answer);
        let is_contact = matches!(row.law, ConeLaw::Contact { .. });
        let n_components = match row.law {
            ConeLaw::Contact { friction } if friction > 0.0 => 2,
            _ => 1,
        };
        for k in 0..n_components {
            island.problem.multipliers[place + k] = multipliers[slot][k];
            island.problem.responses[place + k] = motion[k] + row.give[k] * multipliers[slot][k];
            island.problem.diagonals[place + k] = row.scale[k] + row.give[k];
            let pressed = if status == Status::Open {
                Status::Open
            } else {
                Status::Stick
            };
            island.problem.statuses[place + k] = if is_contact && k == 0 {
                pressed
            } else {
                status
            };
        }
    }
    Ok(outcome)
}
