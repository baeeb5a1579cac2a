//! How far rigid bodies that the step began with in each other can part, and joints between them that it began with apart can close.
//!
//! What overlaps is to part by a share of the overlap. Where a body stands in two others that do not give way, or many are pressed into a
//! bin that is too small for them, no motion does that on every row, and forces that try grow without bound. So it is asked first how the
//! free rigid bodies would part if nothing but their masses resisted, and no faster than they can without sliding far along each other:
//!
//! ```text
//! min ½ aᵀ M a + Σ (eᵢ² + (uᵢ mᵢ / m)²) / 2 s Dᵢ,    Nᵢ a + eᵢ >= mᵢ,    uᵢ = Tᵢ a,    gᵢ + Nᵢ a >= min(gᵢ, 0)
//! ```
//!
//! with `M` what they resist by, `g` the gaps that the step began with, `mᵢ` what is missing on row `i`, `m` the most of them and of what joints miss, `N` and `T` the
//! rows along normals and tangents, and `D` their own mobilities; the first two for rows with `g < 0` only. Then every row is asked for what this
//! motion reaches, and slips from there. The rows agree by construction, those of friction too: that motion obeys all of them. Where bodies
//! only slide out of each other, along walls that lean by `θ`, the motion `t` is where `t² + (m - t θ)²` is least: no longer than half of what is
//! missing.
//!
//! Joints hold in that motion. Those that the step began with apart, or that passes do not close, close as far as that costs no more than what is
//! missing, and open no farther.

use super::active_contact::ActiveContact;
use super::delassus::compliance;
use super::joints::ActiveJoint;
use super::tolerances::SOFTNESS;
use crate::constraint::contact::Kinematics;
use crate::constraint::joint::{JointGrip, unit_wrench};
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::complementarity::RowKind;
use crate::linalg::cone::{
    ConeEntry, ConeError, ConeLaw, ConeProblem, ConeRow, ConeSettings, ConeSolver,
};
use crate::math::{Vec2, cross};
use crate::system::{Block, Response};

/// Share of what is missing to which the motion is found (-). Rows that ask for what it reaches agree whatever it is; only what is no deeper may be so
/// by that much.
const FINENESS: f64 = 1e-4;

/// The question, with its buffers.
#[derive(Debug, Default)]
pub(super) struct Parting {
    /// First node of every block that moves.
    first: Vec<Option<u32>>,
    rows: Vec<ConeRow>,
    entries: Vec<ConeEntry>,
    load: Vec<f64>,
    multipliers: Vec<[f64; 2]>,
    slip: Vec<f64>,
    motion: Vec<f64>,
    /// Contacts, the first row of each, and the gap that the step began with there (m).
    asked: Vec<(usize, usize, f64)>,
    /// Joint rows that close, and their rows.
    closed: Vec<(usize, usize)>,
}

impl Parting {
    /// Asks contacts and joints of rigid bodies for no more than these can move by, if some of them began with an overlap, or open.
    ///
    /// - `slop`: how far a joint may be open, or an overlap deep, to count as none (m or rad).
    /// - `contradicts`: whether passes do not bring the laws to hold, so that joints may be asked that the step began with closed.
    /// - `began`: the gap of a contact that the step began with, along the row as it is (m).
    ///
    /// # Errors
    /// If a number is not finite; contacts and joints are then left as they were.
    pub fn share_out(
        &mut self,
        blocks: &[Block],
        contacts: &mut [ActiveContact],
        joints: (&mut [ActiveJoint], &[JointGrip]),
        (slop, contradicts): (f64, bool),
        began: impl Fn(&ActiveContact) -> f64,
    ) -> Result<(), ConeError> {
        let (ties, grips) = joints;
        let parts = contacts.iter().any(ActiveContact::is_parting);
        // What did not count as an overlap when the step began was none, however far along the row the bodies have turned since.
        let deepest = if parts { f64::INFINITY } else { slop };
        let began = |contact: &ActiveContact| began(contact).max(-deepest);
        let overlaps = |contact: &ActiveContact| contact.is_hard && began(contact) < 0.0;
        let is_open = |tie: &ActiveJoint| tie.is_open(slop, contradicts);
        let is_concerned =
            parts || contradicts && contacts.iter().any(overlaps) || ties.iter().any(is_open);
        if !is_concerned {
            return Ok(());
        }
        let matrix = self.lay_out(blocks);
        self.rows.clear();
        self.entries.clear();
        let open = ties.iter().filter(|tie| is_open(tie));
        let most = open.map(|tie| missing_way(blocks, tie, grips));
        let most = most.fold(0.0, f64::max);
        self.state_contacts(blocks, contacts, most, began);
        self.state_joints(blocks, (ties, grips), is_open);
        self.multipliers.clear();
        self.multipliers.resize(self.rows.len(), [0.0; 2]);
        self.slip.clear();
        self.slip.resize(self.rows.len(), 0.0);
        let Self {
            rows,
            entries,
            load,
            multipliers,
            slip,
            motion,
            asked,
            closed,
            ..
        } = self;
        let problem = ConeProblem {
            matrix: &matrix,
            load,
            rows,
            entries,
        };
        // Nothing is kept from step to step: what is restored goes on as what was never stored.
        let mut solver = ConeSolver::new(ConeSettings {
            tolerance: FINENESS * SOFTNESS[0],
            ..ConeSettings::default()
        });
        solver.solve(&problem, multipliers, slip, motion)?;
        for &(index, first, began) in &*asked {
            let (contact, row) = (&mut contacts[index], &rows[first]);
            let [along, aside] = problem.motion(row, motion);
            if began < 0.0 {
                contact.leave(contact.asked + (row.free[0] + along).min(0.0));
            }
            contact.part_aside(aside);
        }
        for &(index, row) in &*closed {
            let row = &rows[row];
            let open = row.free[0] + problem.motion(row, motion)[0];
            let tie = &mut ties[index];
            let open = match row.law {
                ConeLaw::Unilateral => open.min(0.0),
                _ => open,
            };
            tie.leave(open, slop);
        }
        Ok(())
    }

    /// Gives every free rigid body two nodes, its centre of mass and its angle; returns what they resist by.
    fn lay_out(&mut self, blocks: &[Block]) -> BlockMatrix {
        let mut n_nodes = 0;
        self.first.clear();
        for block in blocks {
            let is_free = matches!(block, Block::Rigid(body) if !body.is_prescribed());
            self.first.push(is_free.then_some(n_nodes));
            n_nodes += if is_free { 2 } else { 0 };
        }
        let mut matrix = BlockMatrix::from_cells(n_nodes as usize, std::iter::empty());
        for (block, first) in blocks.iter().zip(&self.first) {
            if let (Block::Rigid(body), Some(first)) = (block, *first) {
                let own = body.effective_mass();
                matrix.assign_diagonal(first as usize, [own[0], own[1]]);
                matrix.assign_diagonal(first as usize + 1, [own[2], 1.0]);
            }
        }
        self.load.clear();
        self.load.resize(matrix.n_dofs(), 0.0);
        matrix
    }

    /// Overlaps part, by sliding no farther along each other than half of `most` (m) or of what is missing there; the rest comes no deeper.
    fn state_contacts(
        &mut self,
        blocks: &[Block],
        contacts: &[ActiveContact],
        mut most: f64,
        began: impl Fn(&ActiveContact) -> f64,
    ) {
        self.asked.clear();
        for (index, contact) in contacts.iter().enumerate() {
            if contact.is_hard && !contact.is_lost {
                let began = began(contact);
                most = most.max(contact.asked - began);
                self.asked.push((index, 0, began));
            }
        }
        for slot in 0..self.asked.len() {
            let (index, _, began) = self.asked[slot];
            self.asked[slot].1 = self.rows.len();
            let contact = &contacts[index];
            let kinematics = &contact.kinematics;
            let own = compliance(blocks, kinematics, kinematics, Response::Position);
            let [normal, tangent] = [kinematics.normal, kinematics.tangent()];
            let mobility = own.map_or(0.0, |own| normal.dot(&(own * normal)).max(0.0));
            let along = self.grip(blocks, kinematics, [normal, tangent]);
            let row = |entries, law, free, share| row(entries, law, free, (share, mobility));
            let missing = contact.asked - began;
            if began < 0.0 {
                let yielding = SOFTNESS[0];
                self.rows
                    .push(row(along, ConeLaw::Unilateral, -missing, yielding));
            }
            let ease = (most / missing).powi(2);
            if began < 0.0 && ease.is_finite() {
                let aside = self.grip(blocks, kinematics, [tangent, Vec2::zeros()]);
                let yielding = SOFTNESS[0] * ease;
                self.rows
                    .push(row(aside, ConeLaw::Bilateral, 0.0, yielding));
            }
            let room = began.max(0.0);
            self.rows.push(row(along, ConeLaw::Unilateral, room, 0.0));
        }
    }

    /// Joints between rigid bodies hold. What was apart when the step began is to close as far as the rest lets it, and comes no farther apart.
    fn state_joints(
        &mut self,
        blocks: &[Block],
        (ties, grips): (&[ActiveJoint], &[JointGrip]),
        is_open: impl Fn(&ActiveJoint) -> bool,
    ) {
        self.closed.clear();
        for (index, tie) in ties.iter().enumerate() {
            let law = match tie.kind {
                RowKind::Bilateral => ConeLaw::Bilateral,
                RowKind::Unilateral => ConeLaw::Unilateral,
                _ => continue,
            };
            if !(tie.is_hard && tie.is_movable) || tie.give > 0.0 {
                continue;
            }
            let is_closing = is_open(tie);
            let missing = missing(blocks, tie, grips);
            let (entries, mobility) = self.tie_grips(blocks, tie, grips, 1.0);
            let row = |entries, law, free, share| row(entries, law, free, (share, mobility));
            if !is_closing {
                self.rows.push(row(entries, law, missing, 0.0));
                continue;
            }
            self.closed.push((index, self.rows.len()));
            self.rows.push(row(entries, law, missing, SOFTNESS[0]));
            for (side, room) in [(-missing.signum(), 0.0), (missing.signum(), missing.abs())] {
                let (entries, _) = self.tie_grips(blocks, tie, grips, side);
                self.rows.push(row(entries, ConeLaw::Unilateral, room, 0.0));
            }
        }
    }

    /// Adds how a joint row moves with the bodies, `factor` times; returns the range of its entries, and its mobility (1/kg).
    fn tie_grips(
        &mut self,
        blocks: &[Block],
        tie: &ActiveJoint,
        grips: &[JointGrip],
        factor: f64,
    ) -> ((u32, u32), f64) {
        let first = self.entries.len() as u32;
        let is_turn = tie.row.measure.is_turn();
        let mut mobility = 0.0;
        for grip in &grips[tie.row.grips.0..tie.row.grips.1] {
            let wrench = unit_wrench(grip, factor * tie.direction, is_turn);
            self.entry(blocks, grip.block, [wrench, [0.0; 3]]);
            mobility += own_mobility(blocks, (grip, wrench));
        }
        ((first, self.entries.len() as u32), mobility)
    }

    /// Adds how a row moves along two directions with the bodies; returns the range of its entries.
    fn grip(
        &mut self,
        blocks: &[Block],
        kinematics: &Kinematics,
        directions: [Vec2; 2],
    ) -> (u32, u32) {
        let first = self.entries.len() as u32;
        for grip in kinematics.attachments() {
            let wrenches = directions.map(|along| {
                let along = grip.weight * along;
                [along.x, along.y, cross(grip.grip.lever, along)]
            });
            self.entry(blocks, grip.block, wrenches);
        }
        (first, self.entries.len() as u32)
    }

    /// Adds what the motion of a block contributes to a row along two directions, if it moves.
    fn entry(&mut self, blocks: &[Block], block: usize, wrenches: [[f64; 3]; 2]) {
        let (Block::Rigid(body), Some(node)) = (&blocks[block], self.first[block]) else {
            return;
        };
        let moves = body.moves_along();
        let [[nx, ny, turn_n], [tx, ty, turn_t]] =
            wrenches.map(|wrench| [0, 1, 2].map(|i| if moves[i] { wrench[i] } else { 0.0 }));
        self.entries.push(ConeEntry {
            node,
            normal: [nx, ny],
            tangent: [tx, ty],
        });
        self.entries.push(ConeEntry {
            node: node + 1,
            normal: [turn_n, 0.0],
            tangent: [turn_t, 0.0],
        });
    }
}

/// How far a joint row is from where it is asked to be where nothing moves (m or rad).
fn missing(blocks: &[Block], tie: &ActiveJoint, grips: &[JointGrip]) -> f64 {
    tie.gap + tie.goal - tie.asked[0] - tie.moved(blocks, grips)
}

/// The same as a way (m): of a turn, at the radius of gyration that its bodies have together.
fn missing_way(blocks: &[Block], tie: &ActiveJoint, grips: &[JointGrip]) -> f64 {
    let missing = missing(blocks, tie, grips).abs();
    if !tie.row.measure.is_turn() {
        return missing;
    }
    let sum = |wrench: [f64; 3]| {
        let grips = grips[tie.row.grips.0..tie.row.grips.1].iter();
        let own = grips.map(|grip| own_mobility(blocks, (grip, wrench)));
        own.sum::<f64>()
    };
    let gyration = (sum([1.0, 0.0, 0.0]) / sum([0.0, 0.0, 1.0])).sqrt();
    if gyration.is_finite() {
        missing * gyration
    } else {
        0.0
    }
}

/// A row that gives way by a share of its own mobility (1/kg), `free` where nothing moves (m or rad).
fn row(entries: (u32, u32), law: ConeLaw, free: f64, (share, mobility): (f64, f64)) -> ConeRow {
    ConeRow {
        entries,
        law,
        free: [free, 0.0],
        give: [share * mobility, 0.0],
        acted: [0.0; 2],
        scale: [mobility, 0.0],
        local: f64::INFINITY,
    }
}

/// What a unit multiplier moves a row by at one of its grips (1/kg).
fn own_mobility(blocks: &[Block], (grip, wrench): (&JointGrip, [f64; 3])) -> f64 {
    match &blocks[grip.block] {
        Block::Rigid(body) => body.mobility_between(wrench, wrench),
        Block::Flex(_) => 0.0,
    }
}

#[cfg(test)]
mod tests;
