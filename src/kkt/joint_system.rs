//! Joint rows in the Delassus matrix: they follow those of the contacts.

use super::island::{Island, SolveSettings};
use super::joint_rows::pair_mobility;
use crate::constraint::contact::Kinematics;
use crate::constraint::joint::{JointGrip, unit_wrench};
use crate::math::{Vec2, cross};
use crate::system::{Block, Response};

/// Which rows the forces act along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rows {
    /// Those of the position stage.
    Kept,
    /// Those of the end of the step.
    End,
}

impl Island {
    /// Appends all movable joint rows to the position problem, gaps divided by `b0` and without the multipliers they were
    /// measured under.
    pub(super) fn add_joint_positions(&mut self, settings: &SolveSettings, has_new_rows: bool) {
        self.list_joint_positions(settings);
        if self.joint_rows.is_empty() {
            return;
        }
        self.expand_delassus(Response::Position, Rows::Kept);
        self.take_out_joints(has_new_rows);
        let (n, first) = (self.kinds.len(), self.rows.len());
        for (slot, give) in self.joint_gives.iter().enumerate() {
            let diagonal = (first + slot) * (n + 1);
            self.delassus[diagonal] += give;
        }
    }

    /// Lists all movable joint rows after those of the contacts, gaps divided by `b0`.
    pub(super) fn list_joint_positions(&mut self, settings: &SolveSettings) {
        self.joint_rows.clear();
        self.joint_gives.clear();
        let movable = (0..self.ties.len()).filter(|&row| self.ties[row].is_movable);
        self.joint_rows.extend(movable);
        let b0 = settings.b0;
        for &row in &self.joint_rows {
            let tie = &self.ties[row];
            self.kinds.push(tie.kind);
            self.free.push(tie.gap / b0);
            self.multipliers.push(tie.multiplier);
            self.statuses.push(tie.status);
            self.joint_gives.push((tie.give + tie.yielding) / b0);
        }
    }

    /// `G A⁻¹ Gᵀ` of one joint row (1/kg).
    pub(super) fn joint_mobility(&self, row: usize, of: Response, which: Rows) -> f64 {
        let own = self.grips_of(row, which);
        let mut sum = 0.0;
        for at in own.0 {
            for from in own.0.iter().filter(|from| from.block == at.block) {
                let (along, turns) = (own.1, own.2);
                sum += pair_mobility(&self.blocks, (at, along, turns), (from, along, turns), of);
            }
        }
        sum
    }

    /// Takes over the joints' part of a solution of the position problem.
    pub(super) fn take_joint_multipliers(&mut self) {
        let first = self.rows.len();
        for (slot, &row) in self.joint_rows.iter().enumerate() {
            self.ties[row].multiplier = self.multipliers[first + slot];
            self.ties[row].status = self.statuses[first + slot];
        }
    }

    /// Makes room in `W` for the rows of [`Self::joint_rows`](Island) and fills it.
    pub(super) fn expand_delassus(&mut self, of: Response, which: Rows) {
        let (old, n) = (self.rows.len(), self.rows.len() + self.joint_rows.len());
        self.delassus.resize(n * n, 0.0);
        for row in (0..old).rev() {
            self.delassus
                .copy_within(row * old..(row + 1) * old, row * n);
        }
        for row in 0..n {
            let first = if row < old { old } else { 0 };
            self.delassus[row * n + first..(row + 1) * n].fill(0.0);
        }
        self.joint_slot.clear();
        self.joint_slot.resize(self.ties.len(), usize::MAX);
        for (slot, &row) in self.joint_rows.iter().enumerate() {
            self.joint_slot[row] = old + slot;
        }
        self.couple_joints(of, which);
        self.couple_contacts(of, which);
    }

    fn grips_of(&self, row: usize, which: Rows) -> (&[JointGrip], Vec2, bool) {
        let tie = &self.ties[row];
        let (first, last) = tie.row.grips;
        let is_turn = tie.row.measure.is_turn();
        match which {
            Rows::Kept => (&self.joint_grips[first..last], tie.direction, is_turn),
            Rows::End => (&self.end_grips[first..last], tie.end, is_turn),
        }
    }

    /// Joint rows among each other, block by block.
    fn couple_joints(&mut self, of: Response, which: Rows) {
        let n = self.rows.len() + self.joint_rows.len();
        let mut first = 0;
        while first < self.holders.len() {
            let block = self.holders[first].0;
            let last = first + same_block(&self.holders[first..]);
            for i in first..last {
                for j in first..=i {
                    let (one, other) = (self.holders[i].1, self.holders[j].1);
                    let (at, from) = (self.joint_slot[one], self.joint_slot[other]);
                    if at == usize::MAX || from == usize::MAX {
                        continue;
                    }
                    let value = self.mobility_on(
                        block,
                        self.grips_of(one, which),
                        self.grips_of(other, which),
                        of,
                    );
                    self.delassus[at * n + from] += value;
                    if at != from {
                        self.delassus[from * n + at] += value;
                    }
                }
            }
            first = last;
        }
        self.couple_joints_across(of, which);
    }

    /// Joint rows that hold different links of one multibody.
    fn couple_joints_across(&mut self, of: Response, which: Rows) {
        if !self.blocks.iter().any(Block::answers_with_others) {
            return;
        }
        let n = self.rows.len() + self.joint_rows.len();
        for i in 0..self.holders.len() {
            for j in 0..self.holders.len() {
                let ((block, one), (other, source)) = (self.holders[i], self.holders[j]);
                let (at, from) = (self.joint_slot[one], self.joint_slot[source]);
                if block == other || at == usize::MAX || from == usize::MAX {
                    continue;
                }
                let (own, others) = (self.grips_of(one, which), self.grips_of(source, which));
                self.delassus[at * n + from] +=
                    self.mobility_across((block, own), (other, others), of);
            }
        }
    }

    /// What of the mobility between two rows goes from one link of a multibody to another (1/kg).
    fn mobility_across(
        &self,
        (block, (grips, along, turns)): (usize, (&[JointGrip], Vec2, bool)),
        (other, (sources, push, is_turned)): (usize, (&[JointGrip], Vec2, bool)),
        of: Response,
    ) -> f64 {
        let mut sum = 0.0;
        for at in grips.iter().filter(|grip| grip.block == block) {
            for from in sources.iter().filter(|grip| grip.block == other) {
                let wrenches = [
                    unit_wrench(at, along, turns),
                    unit_wrench(from, push, is_turned),
                ];
                let moved =
                    self.blocks[block].mobility_across(wrenches[0], (other, wrenches[1]), of);
                sum += moved.unwrap_or(0.0);
            }
        }
        sum
    }

    fn mobility_on(
        &self,
        block: usize,
        (one, along, turns): (&[JointGrip], Vec2, bool),
        (other, push, is_turned): (&[JointGrip], Vec2, bool),
        of: Response,
    ) -> f64 {
        let mut sum = 0.0;
        for at in one.iter().filter(|grip| grip.block == block) {
            for from in other.iter().filter(|grip| grip.block == block) {
                sum += pair_mobility(
                    &self.blocks,
                    (at, along, turns),
                    (from, push, is_turned),
                    of,
                );
            }
        }
        sum
    }

    /// Joint rows with the rows of contacts.
    fn couple_contacts(&mut self, of: Response, which: Rows) {
        let n = self.rows.len() + self.joint_rows.len();
        for c in 0..self.rows.len() {
            let direction = self.rows[c];
            let kinematics = self.contacts[direction.contact].kinematics;
            for holder in 0..self.holders.len() {
                let (block, row) = self.holders[holder];
                let slot = self.joint_slot[row];
                if slot == usize::MAX {
                    continue;
                }
                let moved = self.carried(&kinematics, block, self.grips_of(row, which), of);
                let value = direction.direction.dot(&moved);
                self.delassus[c * n + slot] += value;
                self.delassus[slot * n + c] += value;
            }
        }
    }

    /// Relative motion at a contact per unit multiplier of a joint row, through one block (1/kg).
    fn carried(
        &self,
        kinematics: &Kinematics,
        block: usize,
        (grips, push, is_turn): (&[JointGrip], Vec2, bool),
        of: Response,
    ) -> Vec2 {
        let mut sum = Vec2::zeros();
        for a in kinematics.attachments().iter().filter(|a| a.block != block) {
            for from in grips.iter().filter(|grip| grip.block == block) {
                let pushed = unit_wrench(from, push, is_turn);
                let along = |axis: Vec2| {
                    let own = [axis.x, axis.y, cross(a.grip.lever, axis)];
                    self.blocks[a.block].mobility_across(own, (block, pushed), of)
                };
                if let (Some(x), Some(y)) = (along(Vec2::x()), along(Vec2::y())) {
                    sum += a.weight * Vec2::new(x, y);
                }
            }
        }
        for a in kinematics.attachments().iter().filter(|a| a.block == block) {
            for from in grips.iter().filter(|grip| grip.block == block) {
                sum += a.weight
                    * match &self.blocks[block] {
                        Block::Rigid(rigid) => {
                            rigid.respond(a.grip.lever, unit_wrench(from, push, is_turn), of)
                        }
                        Block::Flex(_) => {
                            let compliance = self.blocks[block].compliance(a.grip, from.grip(), of);
                            from.weight * compliance * push
                        }
                    };
            }
        }
        sum
    }

    /// `b -= W p` between joints, and between joints and contacts, along the rows that the multipliers acted along.
    fn take_out_joints(&mut self, has_new_rows: bool) {
        let n_contact_rows = self.rows.len();
        let n = self.kinds.len();
        if !has_new_rows {
            for row in 0..n {
                let line = &self.delassus[row * n..(row + 1) * n];
                let columns = if row < n_contact_rows {
                    n_contact_rows..n
                } else {
                    0..n
                };
                let response: f64 = columns.map(|at| line[at] * self.multipliers[at]).sum();
                self.free[row] -= response;
            }
            return;
        }
        for holder in 0..self.holders.len() {
            let (block, row) = self.holders[holder];
            let tie = self.ties[row];
            if tie.multiplier == 0.0 {
                continue;
            }
            let (first, last) = tie.row.grips;
            let is_turn = tie.row.measure.is_turn();
            let applied = (&self.applied_grips[first..last], tie.applied, is_turn);
            for c in 0..n_contact_rows {
                let direction = self.rows[c];
                let kinematics = &self.contacts[direction.contact].kinematics;
                let moved = self.carried(kinematics, block, applied, Response::Position);
                self.free[c] -= tie.multiplier * direction.direction.dot(&moved);
            }
            let start = self.holders.partition_point(|(other, _)| *other < block);
            for &(_, other) in &self.holders[start..start + same_block(&self.holders[start..])] {
                let own = self.grips_of(other, Rows::Kept);
                let value = self.mobility_on(block, own, applied, Response::Position);
                self.free[self.joint_slot[other]] -= tie.multiplier * value;
            }
        }
        self.take_out_contacts();
    }

    /// What the contacts' multipliers did to the joint rows, along the rows they acted along.
    fn take_out_contacts(&mut self) {
        for contact in self
            .contacts
            .iter()
            .filter(|contact| contact.multiplier[0] > 0.0)
        {
            let applied = &contact.applied;
            let [normal, tangent] = contact.multiplier;
            let force = normal * applied.normal + tangent * applied.tangent();
            for &(block, row) in &self.holders {
                let own = self.grips_of(row, Rows::Kept);
                let moved = self.carried(applied, block, own, Response::Position);
                self.free[self.joint_slot[row]] -= force.dot(&moved);
            }
        }
    }
}

/// How many entries from the first on hold the same block.
fn same_block(holders: &[(usize, usize)]) -> usize {
    let Some(&(block, _)) = holders.first() else {
        return 0;
    };
    holders
        .iter()
        .take_while(|(other, _)| *other == block)
        .count()
}
