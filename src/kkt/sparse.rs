//! The rows of an island as one sparse problem on friction cones, for islands of many contacts.
//!
//! Flexible blocks enter with their whole effective matrix, in their frames, free rigid ones as two nodes: the centre of mass, and the
//! angle beside a dof that nothing moves. The dense problem of [`delassus`](super::delassus) costs the cube of the number of rows, this
//! one little more than factorizing the bodies: operations decide.

mod asked;
mod layout;
mod turning;

pub(super) use self::asked::Asked;
use self::layout::Shape;
use super::delassus::compliance;
use super::follow::LARGE_TOLERANCE;
use super::island::{Island, KktError};
use super::joined::JOINED;
use super::joint_system::Rows;
use crate::constraint::joint::unit_wrench;
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::complementarity::{RowKind, Status};
use crate::linalg::cone::{
    ConeEntry, ConeLaw, ConeOutcome, ConeProblem, ConeRow, ConeSolver, ConeStatus,
};
use crate::math::Vec2;
use crate::system::{Block, Point, Response};

/// Scalar rows up to which the dense problem is always the quicker one.
const ALWAYS_DENSE: usize = 24;

/// Operations that the dense problem may take more often than the sparse one takes for a factor (-): its laws hold to rounding, and not to a
/// thousandth of the margin.
const WORTH: f64 = 4.0;

/// Share of its own mobility that every row gives way by to its force (-): `w = (W + s D) p + b`, `D` the diagonal of `W`.
///
/// Where a body fits between two that nothing moves, forces of any size press it and change nothing; an interior point goes to the middle of all
/// of them. With this what rows disagree about, `d`, ends in a force of `d / (s D)`, and what carries `p` rests nearer by a
/// millionth of the way that `p` would move it in the step. Friction gives way to the change of its force only, as it would creep.
pub(super) const YIELDING: f64 = 1e-6;

/// Share of a joint's force that it gives way to as contacts do (-); to the rest only as it changes, or a chain would open.
const JOINT_SHARE: f64 = 0.05;

/// What is kept of an island from step to step: its unknowns and factors.
#[derive(Debug)]
struct Kept {
    shapes: Vec<Shape>,
    matrix: BlockMatrix,
    /// First node of every block.
    first: Vec<usize>,
    /// One for each response: what rests keeps its factors.
    solvers: [ConeSolver; 4],
    /// Whether it has been asked for since the step began.
    is_in_use: bool,
}

/// The sparse problem of an island, with its buffers, and what is kept of those of the step before.
#[derive(Debug, Default)]
pub(super) struct Sparse {
    kept: Vec<Kept>,
    /// The island at hand among these.
    at: usize,
    rows: Vec<ConeRow>,
    entries: Vec<ConeEntry>,
    /// Place of every cone row's first component among the scalar rows.
    places: Vec<usize>,
    load: Vec<f64>,
    multipliers: Vec<[f64; 2]>,
    slip: Vec<f64>,
    /// Couples of every block by which forces turn it beyond what they did before, by their levers and by the reference arms (N m).
    couples: Vec<[f64; 2]>,
    answer: Vec<f64>,
}

impl Island {
    /// Forgets what is kept of sparse problems that the step before did not ask for.
    pub fn begin_step(&mut self) {
        self.sparse.forget_unused();
    }

    /// Whether the scalar rows at hand are better solved as a sparse problem: where they are many, and where contacts and joints may hold the same
    /// motion, which the dense one takes for forces of any size.
    pub(super) fn is_sparse(&self, n_rows: usize) -> bool {
        let presses_joined = self.contacts.iter().any(|contact| self.is_joined(contact));
        if self.path.is_empty() || n_rows <= ALWAYS_DENSE && !presses_joined {
            return false;
        }
        let mut operations = 0.0;
        for block in &self.blocks {
            match block {
                Block::Flex(block) if block.is_explicit() => return false,
                Block::Flex(block) => operations += block.factor_operations(),
                // Links answer together, by no matrix of their own.
                Block::Rigid(block) if block.link_response().is_some() => return false,
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
    pub(super) fn solve_sparse(&mut self, asked: Asked) -> Result<ConeOutcome, KktError> {
        let mut sparse = std::mem::take(&mut self.sparse);
        let outcome = self.state_sparse(&mut sparse, asked);
        let outcome = outcome.and_then(|()| self.answer_sparse(&mut sparse, asked));
        self.sparse = sparse;
        self.n_pivots += outcome
            .as_ref()
            .map_or(0, |outcome| outcome.n_factorizations);
        outcome
    }

    /// Notes how far every contact that presses moves under its force and gives way to it: along its normal where the rows at hand are solved
    /// as a sparse problem, along its tangent where they contradict each other.
    pub(super) fn note_yielding(&mut self, b0: f64) {
        let is_sparse = self.is_sparse(2 * self.contacts.len() + self.ties.len());
        let yields = match self.softness {
            0.0 if is_sparse => [YIELDING, 0.0],
            softness => [0.0, softness],
        };
        for contact in &mut self.contacts {
            (contact.yielding, contact.mobility) = ([0.0; 2], None);
            if yields != [0.0; 2] && contact.multiplier[0] > 0.0 {
                let row = &contact.kinematics;
                let own = compliance(&self.blocks, row, row, Response::Position);
                let own = own.unwrap_or_default();
                let along = [row.normal, row.tangent()].map(|along| along.dot(&(own * along)));
                let mobility = along.map(|along| b0 * along.max(0.0));
                contact.yielding = [0, 1].map(|k| yields[k] * mobility[k]);
                contact.mobility = Some(mobility);
            }
        }
    }

    fn state_sparse(&self, sparse: &mut Sparse, asked: Asked) -> Result<(), KktError> {
        sparse.fill_matrix(&self.blocks);
        sparse.rows.clear();
        sparse.entries.clear();
        sparse.places.clear();
        sparse.multipliers.clear();
        sparse.slip.clear();
        sparse.couples.clear();
        sparse.couples.resize(self.blocks.len(), [0.0; 2]);
        if asked.of == Response::Position {
            let grips = [&self.applied_grips[..], &self.joint_grips];
            sparse.add_up_couples(&self.blocks, &self.contacts, &self.ties, grips);
        }
        let mut row = 0;
        while row < self.rows.len() {
            let index = self.rows[row].contact;
            let contact = &self.contacts[index];
            let has_friction = matches!(self.kinds.get(row + 1), Some(RowKind::Friction { normal, .. }) if *normal == row);
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
                    &self.blocks,
                    a.block,
                    (a.grip.point, a.grip.lever),
                    directions,
                );
            }
            let own = compliance(&self.blocks, kinematics, kinematics, asked.of);
            let scale = own.map_or([0.0; 2], |own| {
                [normal, tangent].map(|along| along.dot(&(own * along)).max(0.0))
            });
            // What damped surfaces without mass yield beyond what `A` knows.
            let yielded = match asked.of {
                Response::Position => {
                    compliance(&self.blocks, kinematics, kinematics, Response::Velocity)
                }
                _ => None,
            };
            let softness = match asked.of {
                Response::Position => 0.0,
                _ if contact.is_hard => 0.0,
                _ => {
                    let share = contact.holds_velocity().max(1e-12);
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
                .map(|a| a.weight * sparse.turned(&self.blocks, a.block, a.grip))
                .sum();
            // Gaps are measured where the forces that act already have made it yield.
            let (give, given) = match asked.of {
                Response::Position => {
                    let yielding = scale.map(|own| self.softness.max(YIELDING) * own);
                    let softness = scale.map(|own| self.softness * own);
                    // What friction holds against itself slips a little, or its forces grow from pass to pass.
                    let contradicts = self.softness > 0.0;
                    let kept = [softness[0], if contradicts { 0.0 } else { yielding[1] }];
                    (
                        [0, 1].map(|k| give[k] + yielding[k]),
                        [0, 1].map(|k| (give[k] + kept[k]) * contact.multiplier[k]),
                    )
                }
                _ => {
                    let joined = f64::from(self.is_joined(contact)) * JOINED.get();
                    let share = asked.give.max(joined);
                    ([0, 1].map(|k| give[k] + share * scale[k]), [0.0; 2])
                }
            };
            let friction = match self.kinds.get(row + 1) {
                Some(RowKind::Friction { coefficient, .. }) if has_friction => *coefficient,
                _ => 0.0,
            };
            let second = |values: &[f64]| if has_friction { values[row + 1] } else { 0.0 };
            let acted = if self.acted.is_empty() || asked.of == Response::Position {
                [0.0; 2]
            } else {
                [self.acted[row], second(&self.acted)]
            };
            sparse.rows.push(ConeRow {
                entries: (first, sparse.entries.len() as u32),
                law: ConeLaw::Contact { friction },
                free: [
                    self.free[row] - given[0] + normal.dot(&turned),
                    second(&self.free) - given[1] + tangent.dot(&turned),
                ],
                give,
                acted,
                scale,
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
            sparse
                .multipliers
                .push([self.multipliers[row], second(&self.multipliers)]);
            row += step;
        }
        for slot in 0..self.joint_rows.len() {
            let place = self.rows.len() + slot;
            let tie = &self.ties[self.joint_rows[slot]];
            let grips = match asked.which {
                Rows::Kept => &self.joint_grips,
                Rows::End => &self.end_grips,
            };
            let direction = match asked.which {
                Rows::Kept => tie.direction,
                Rows::End => tie.end,
            };
            let is_turn = tie.row.measure.is_turn();
            let first = sparse.entries.len() as u32;
            for grip in &grips[tie.row.grips.0..tie.row.grips.1] {
                sparse.joint_grip(&self.blocks, grip, direction, is_turn);
            }
            let scale = self.joint_mobility(self.joint_rows[slot], asked.of, asked.which);
            let yielding = match asked.of {
                Response::Position => YIELDING * scale,
                _ => 0.0,
            };
            let own = &grips[tie.row.grips.0..tie.row.grips.1];
            let turned = own.iter().map(|grip| {
                let turned = sparse.turned(&self.blocks, grip.block, grip.grip());
                grip.weight * direction.dot(&turned)
            });
            let turned: f64 = turned.sum();
            sparse.rows.push(ConeRow {
                entries: (first, sparse.entries.len() as u32),
                law: match self.kinds[place] {
                    RowKind::Bilateral => ConeLaw::Bilateral,
                    RowKind::Box { low, high } => ConeLaw::Box { low, high },
                    _ => ConeLaw::Unilateral,
                },
                free: [
                    self.free[place] - (1.0 - JOINT_SHARE) * yielding * tie.multiplier + turned,
                    0.0,
                ],
                give: [
                    self.joint_gives[slot]
                        + yielding
                        + asked.give * scale
                        + (1.0 / tie.share_of(asked.of) - 1.0) * scale,
                    0.0,
                ],
                acted: [0.0; 2],
                scale: [scale, 0.0],
            });
            sparse.places.push(place);
            sparse.slip.push(0.0);
            sparse.multipliers.push([self.multipliers[place], 0.0]);
        }
        sparse.load.clear();
        sparse.load.resize(2 * sparse.n_nodes(), 0.0);
        if asked.of == Response::Position {
            self.load_applied(sparse);
        }
        Ok(())
    }

    /// Takes the forces that act already out of the load: `r = -G₀ᵀ p`.
    fn load_applied(&self, sparse: &mut Sparse) {
        sparse.scratch_begin();
        for contact in &self.contacts {
            let [normal, tangent] = contact.multiplier;
            let force = -(normal * contact.applied.normal + tangent * contact.applied.tangent());
            for a in contact.applied.attachments() {
                let grip = (a.grip.point, a.grip.lever);
                sparse.push_load(&self.blocks, a.block, grip, a.weight * force);
            }
        }
        for tie in &self.ties {
            let is_turn = tie.row.measure.is_turn();
            for grip in &self.applied_grips[tie.row.grips.0..tie.row.grips.1] {
                match (&self.blocks[grip.block], grip.point) {
                    (Block::Flex(_), Point::Node(_)) => {
                        let force = -tie.multiplier * grip.weight * tie.applied;
                        sparse.push_load(&self.blocks, grip.block, (grip.point, grip.lever), force);
                    }
                    _ => {
                        let wrench = unit_wrench(grip, tie.applied, is_turn);
                        let wrench = wrench.map(|value| -tie.multiplier * value);
                        sparse.push_wrench(&self.blocks, grip.block, wrench);
                    }
                }
            }
        }
    }

    fn answer_sparse(
        &mut self,
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
        solver.settings.gap_tolerance = 0.2 * LARGE_TOLERANCE * self.path.least_margin() / unit;
        solver.settings.slip_tolerance = 1e-4;
        solver.settings.tolerance = 1e-6;
        solver.scales_start = asked.of == Response::Velocity;
        let outcome = solver.solve_like(like, &problem, multipliers, slip, answer)?;
        let n = self.kinds.len();
        self.multipliers.fill(0.0);
        self.statuses.clear();
        self.statuses.resize(n, Status::Open);
        self.responses.clear();
        self.responses.resize(n, 0.0);
        self.diagonals.clear();
        self.diagonals.resize(n, 0.0);
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
                self.multipliers[place + k] = multipliers[slot][k];
                self.responses[place + k] = motion[k] + row.give[k] * multipliers[slot][k];
                self.diagonals[place + k] = row.scale[k] + row.give[k];
                let pressed = if status == Status::Open {
                    Status::Open
                } else {
                    Status::Stick
                };
                self.statuses[place + k] = if is_contact && k == 0 {
                    pressed
                } else {
                    status
                };
            }
        }
        Ok(outcome)
    }
}
