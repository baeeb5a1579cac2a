//! Joint rows in the Delassus matrix: they follow those of the contacts.

use super::mobility::pair_mobility;
use super::{Among, Joints, Rows};
use crate::constraint::contact::Kinematics;
use crate::constraint::joint::{JointGrip, unit_wrench};
use crate::kkt::problem::RowProblem;
use crate::kkt::settings::SolveSettings;
use crate::linalg::complementarity::INDEPENDENT;
use crate::math::Vec2;
use crate::system::{Block, Response};

/// What a row holds on to, its direction, and whether that is an axis of turning.
type Side<'a> = (&'a [JointGrip], Vec2, bool);

impl Joints {
    /// Appends all movable joint rows to the position problem, gaps divided by `b0` and without the multipliers they were
    /// measured under.
    ///
    /// - `has_new_rows`: whether rows have turned since the multipliers acted.
    pub(in crate::kkt) fn add_positions(
        &mut self,
        problem: &mut RowProblem,
        among: Among<'_>,
        (settings, has_new_rows): (&SolveSettings, bool),
    ) {
        self.list_positions(problem, settings);
        if self.listed.is_empty() {
            return;
        }
        self.expand(problem, among, (Response::Position, Rows::Kept));
        self.take_out(problem, among, has_new_rows);
        let (n, first) = (problem.kinds.len(), problem.rows.len());
        for (slot, give) in self.gives.iter().enumerate() {
            let diagonal = (first + slot) * (n + 1);
            problem.delassus[diagonal] += give;
        }
    }

    /// Lists all movable joint rows after those of the contacts, gaps divided by `b0`.
    pub(in crate::kkt) fn list_positions(
        &mut self,
        problem: &mut RowProblem,
        settings: &SolveSettings,
    ) {
        self.listed.clear();
        self.gives.clear();
        let movable = (0..self.ties.len()).filter(|&row| self.ties[row].is_movable);
        self.listed.extend(movable);
        let b0 = settings.b0;
        for &row in &self.listed {
            let tie = &self.ties[row];
            problem.kinds.push(tie.kind);
            problem.free.push(tie.gap / b0);
            problem.multipliers.push(tie.multiplier);
            problem.statuses.push(tie.status);
            self.gives.push((tie.give + tie.yielding) / b0);
        }
    }

    /// `G A⁻¹ Gᵀ` of one joint row (1/kg).
    pub(in crate::kkt) fn mobility(
        &self,
        blocks: &[Block],
        row: usize,
        (of, which): (Response, Rows),
    ) -> f64 {
        let own = self.grips_of(row, which);
        let mut sum = 0.0;
        for at in own.0 {
            for from in own.0.iter().filter(|from| from.block == at.block) {
                let (along, turns) = (own.1, own.2);
                sum += pair_mobility(blocks, (at, along, turns), (from, along, turns), of);
            }
        }
        sum
    }

    /// Takes over the joints' part of a solution of the position problem.
    pub(in crate::kkt) fn take_multipliers(&mut self, problem: &RowProblem) {
        let first = problem.rows.len();
        for (slot, &row) in self.listed.iter().enumerate() {
            self.ties[row].multiplier = problem.multipliers[first + slot];
            self.ties[row].status = problem.statuses[first + slot];
        }
    }

    /// Makes room in `W` for the rows of [`Self::joint_rows`](Island) and fills it.
    pub(in crate::kkt) fn expand(
        &mut self,
        problem: &mut RowProblem,
        among: Among<'_>,
        how: (Response, Rows),
    ) {
        let (old, n) = (problem.rows.len(), problem.rows.len() + self.listed.len());
        problem.delassus.resize(n * n, 0.0);
        for row in (0..old).rev() {
            problem
                .delassus
                .copy_within(row * old..(row + 1) * old, row * n);
        }
        for row in 0..n {
            let first = if row < old { old } else { 0 };
            problem.delassus[row * n + first..(row + 1) * n].fill(0.0);
        }
        self.slots.clear();
        self.slots.resize(self.ties.len(), usize::MAX);
        for (slot, &row) in self.listed.iter().enumerate() {
            self.slots[row] = old + slot;
        }
        self.couple_joints(problem, among.blocks, how);
        self.couple_contacts(problem, among, how);
    }

    /// Tells the solver how much of a joint row's mobility others must leave: less where the lightest body that joints hold is lighter than the
    /// heaviest one, and anything on what is attached to flexible bodies, whose places are known in double precision and which may be stiff.
    pub(in crate::kkt) fn tell_independence(&self, problem: &mut RowProblem, blocks: &[Block]) {
        let (mut least, mut most) = (f64::INFINITY, 0.0f64);
        for grip in &self.grips {
            let mass = match &blocks[grip.block] {
                Block::Flex(block) => block.mass(),
                Block::Rigid(block) if block.is_prescribed() => continue,
                Block::Rigid(block) => block.mass()[0].max(block.mass()[1]),
            };
            if mass > 0.0 {
                (least, most) = (least.min(mass), most.max(mass));
            }
        }
        let lightness = least / most;
        let of_rigid = INDEPENDENT * if lightness <= 1.0 { lightness } else { 1.0 };
        let of_contacts = problem.rows.iter().map(|_| 0.0);
        let is_rigid = |&row: &usize| self.ties.get(row).is_some_and(|tie| tie.is_hard);
        let of_joints = self
            .listed
            .iter()
            .map(|row| if is_rigid(row) { of_rigid } else { 0.0 });
        problem
            .solver
            .set_independence(of_contacts.chain(of_joints));
    }

    fn grips_of(&self, row: usize, which: Rows) -> Side<'_> {
        let tie = &self.ties[row];
        let (first, last) = tie.row.grips;
        let is_turn = tie.row.measure.is_turn();
        match which {
            Rows::Kept => (&self.grips[first..last], tie.direction, is_turn),
            Rows::End => (&self.end_grips[first..last], tie.end, is_turn),
        }
    }

    /// Joint rows among each other, block by block.
    fn couple_joints(
        &self,
        problem: &mut RowProblem,
        blocks: &[Block],
        (of, which): (Response, Rows),
    ) {
        let n = problem.rows.len() + self.listed.len();
        let mut first = 0;
        while first < self.holders.len() {
            let block = self.holders[first].0;
            let last = first + same_block(&self.holders[first..]);
            for i in first..last {
                for j in first..=i {
                    let (one, other) = (self.holders[i].1, self.holders[j].1);
                    let (at, from) = (self.slots[one], self.slots[other]);
                    if at == usize::MAX || from == usize::MAX {
                        continue;
                    }
                    let value = mobility_on(
                        blocks,
                        block,
                        (self.grips_of(one, which), self.grips_of(other, which)),
                        of,
                    );
                    problem.delassus[at * n + from] += value;
                    if at != from {
                        problem.delassus[from * n + at] += value;
                    }
                }
            }
            first = last;
        }
    }

    /// Joint rows with the rows of contacts.
    fn couple_contacts(
        &self,
        problem: &mut RowProblem,
        Among { blocks, contacts }: Among<'_>,
        (of, which): (Response, Rows),
    ) {
        let n = problem.rows.len() + self.listed.len();
        for c in 0..problem.rows.len() {
            let direction = problem.rows[c];
            let kinematics = contacts[direction.contact].kinematics;
            for holder in 0..self.holders.len() {
                let (block, row) = self.holders[holder];
                let slot = self.slots[row];
                if slot == usize::MAX {
                    continue;
                }
                let moved = carried(blocks, &kinematics, (block, self.grips_of(row, which)), of);
                let value = direction.direction.dot(&moved);
                problem.delassus[c * n + slot] += value;
                problem.delassus[slot * n + c] += value;
            }
        }
    }

    /// `b -= W p` between joints, and between joints and contacts, along the rows that the multipliers acted along.
    fn take_out(&self, problem: &mut RowProblem, among: Among<'_>, has_new_rows: bool) {
        let Among { blocks, contacts } = among;
        let n_contact_rows = problem.rows.len();
        let n = problem.kinds.len();
        if !has_new_rows {
            for row in 0..n {
                let line = &problem.delassus[row * n..(row + 1) * n];
                let columns = if row < n_contact_rows {
                    n_contact_rows..n
                } else {
                    0..n
                };
                let response: f64 = columns.map(|at| line[at] * problem.multipliers[at]).sum();
                problem.free[row] -= response;
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
                let direction = problem.rows[c];
                let kinematics = &contacts[direction.contact].kinematics;
                let moved = carried(blocks, kinematics, (block, applied), Response::Position);
                problem.free[c] -= tie.multiplier * direction.direction.dot(&moved);
            }
            let start = self.holders.partition_point(|(other, _)| *other < block);
            for &(_, other) in &self.holders[start..start + same_block(&self.holders[start..])] {
                let own = self.grips_of(other, Rows::Kept);
                let value = mobility_on(blocks, block, (own, applied), Response::Position);
                problem.free[self.slots[other]] -= tie.multiplier * value;
            }
        }
        self.take_out_contacts(problem, among);
    }

    /// What the contacts' multipliers did to the joint rows, along the rows they acted along.
    fn take_out_contacts(&self, problem: &mut RowProblem, Among { blocks, contacts }: Among<'_>) {
        for contact in contacts
            .iter()
            .filter(|contact| contact.multiplier[0] > 0.0)
        {
            let applied = &contact.applied;
            let [normal, tangent] = contact.multiplier;
            let force = normal * applied.normal + tangent * applied.tangent();
            for &(block, row) in &self.holders {
                let own = self.grips_of(row, Rows::Kept);
                let moved = carried(blocks, applied, (block, own), Response::Position);
                problem.free[self.slots[row]] -= force.dot(&moved);
            }
        }
    }
}

/// Mobility between two rows through one block (1/kg).
fn mobility_on(
    blocks: &[Block],
    block: usize,
    ((one, along, turns), (other, push, is_turned)): (Side<'_>, Side<'_>),
    of: Response,
) -> f64 {
    let mut sum = 0.0;
    for at in one.iter().filter(|grip| grip.block == block) {
        for from in other.iter().filter(|grip| grip.block == block) {
            sum += pair_mobility(blocks, (at, along, turns), (from, push, is_turned), of);
        }
    }
    sum
}

/// Relative motion at a contact per unit multiplier of a joint row, through one block (1/kg).
fn carried(
    blocks: &[Block],
    kinematics: &Kinematics,
    (block, (grips, push, is_turn)): (usize, Side<'_>),
    of: Response,
) -> Vec2 {
    let mut sum = Vec2::zeros();
    for a in kinematics.attachments().iter().filter(|a| a.block == block) {
        for from in grips.iter().filter(|grip| grip.block == block) {
            sum += a.weight
                * match &blocks[block] {
                    Block::Rigid(rigid) => {
                        rigid.respond(a.grip.lever, unit_wrench(from, push, is_turn))
                    }
                    Block::Flex(_) => {
                        let compliance = blocks[block].compliance(a.grip, from.grip(), of);
                        from.weight * compliance * push
                    }
                };
        }
    }
    sum
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
