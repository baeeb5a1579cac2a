//! Multipliers of the working set: rows of `G`, the Delassus matrix and one complementarity problem `w = W p + b`.

use super::delassus::{RowDirection, assemble, compliance};
use super::island::{Island, KktError, SolveSettings};
use super::joint_system::Rows;
use super::position::slip;
use super::sparse::Asked;
use super::summary::IslandSummary;
use crate::constraint::contact::Kinematics;
use crate::linalg::complementarity::{INDEPENDENT, Problem, RowKind};
use crate::math::{Vec2, rounding};
use crate::system::{Block, Point, Response};

/// Multiple of the tolerance by which redundant rows may contradict each other.
const AVERAGED: f64 = 10.0;

impl Island {
    /// One complementarity problem on the working set.
    pub(super) fn solve_multipliers(
        &mut self,
        settings: &SolveSettings,
        has_new_rows: bool,
        tolerance: f64,
        summary: &mut IslandSummary,
    ) -> Result<(), KktError> {
        if self.contacts.is_empty() && self.ties.is_empty() {
            return Ok(());
        }
        for contact in &self.contacts {
            prepare(&mut self.blocks, &contact.kinematics);
            if has_new_rows {
                prepare(&mut self.blocks, &contact.applied);
            }
        }
        self.prepare_joints();
        self.position_rows(settings.b0);
        let n_ties = self.ties.iter().filter(|tie| tie.is_movable).count();
        if self.is_sparse(self.rows.len() + n_ties) {
            self.list_joint_positions(settings);
            let asked = Asked {
                of: Response::Position,
                which: Rows::Kept,
                unit: settings.b0,
                give: 0.0,
            };
            let outcome = self.solve_sparse(asked)?;
            summary.residual = outcome.residual;
            self.read_multipliers();
            return Ok(());
        }
        let contacts = &self.contacts;
        let kinematics = |index: usize| &contacts[index].kinematics;
        assemble(
            &self.blocks,
            &self.rows,
            Response::Position,
            kinematics,
            &mut self.delassus,
        );
        self.take_out_multipliers(has_new_rows);
        self.yield_to_changes();
        self.add_joint_positions(settings, has_new_rows);
        self.let_go();
        let redundancy = self.redundancy_tolerance(tolerance / settings.b0);
        self.solver.set_redundancy_tolerance(redundancy);
        let has_joints = self.kinds.len() > self.rows.len();
        self.tell_independence();
        let problem = Problem {
            delassus: &self.delassus,
            free: &self.free,
            rows: &self.kinds,
            acted: &[],
        };
        let outcome = (if has_joints {
            self.solver
                .solve_condensed(&problem, &mut self.multipliers, &mut self.statuses)
        } else {
            self.solver
                .solve(&problem, &mut self.multipliers, &mut self.statuses)
        })?;
        self.n_pivots += outcome.n_pivots;
        summary.residual = outcome.residual;
        self.read_multipliers();
        Ok(())
    }

    /// Takes over a solution of the position problem.
    fn read_multipliers(&mut self) {
        for (row, direction) in self.rows.iter().enumerate() {
            let contact = &mut self.contacts[direction.contact];
            let which = usize::from(matches!(self.kinds[row], RowKind::Friction { .. }));
            contact.multiplier[which] = self.multipliers[row];
            contact.status[which] = self.statuses[row];
        }
        self.take_joint_multipliers();
    }

    /// Rows of the working set, with gaps and slips divided by `b0` and the multipliers that they were measured under.
    pub(super) fn position_rows(&mut self, b0: f64) {
        self.rows.clear();
        self.kinds.clear();
        self.free.clear();
        self.multipliers.clear();
        self.statuses.clear();
        for (index, contact) in self.contacts.iter().enumerate() {
            let kinematics = &contact.kinematics;
            let normal_row = self.rows.len();
            self.rows.push(RowDirection {
                contact: index,
                direction: kinematics.normal,
            });
            self.kinds.push(RowKind::Unilateral);
            self.free.push(kinematics.gap / b0);
            self.multipliers.push(contact.multiplier[0]);
            self.statuses.push(contact.status[0]);
            let coefficient = self.candidates[contact.candidate].law.friction;
            if coefficient > 0.0 {
                self.rows.push(RowDirection {
                    contact: index,
                    direction: kinematics.tangent(),
                });
                self.kinds.push(RowKind::Friction {
                    normal: normal_row,
                    coefficient,
                });
                let slip = match contact.base {
                    Some(_) => contact.slip,
                    None => slip(kinematics, &self.blocks) - contact.aside,
                };
                self.free.push(slip / b0);
                self.multipliers.push(contact.multiplier[1]);
                self.statuses.push(contact.status[1]);
            }
        }
    }

    /// Lets every contact give way by the island's softness, along its normal to the change of its own multipliers, and along its tangent to
    /// all of them: friction that holds against itself slips a little, or its forces grow from pass to pass.
    fn yield_to_changes(&mut self) {
        if self.softness == 0.0 {
            return;
        }
        let n = self.rows.len();
        for row in 0..n {
            let give = self.softness * self.delassus[row * (n + 1)];
            self.delassus[row * (n + 1)] += give;
            if !matches!(self.kinds[row], RowKind::Friction { .. }) {
                self.free[row] -= give * self.multipliers[row];
            }
        }
    }

    /// Takes contacts that geometry has lost out of the problem: what would answer to them is open.
    fn let_go(&mut self) {
        let n = self.kinds.len();
        for (row, direction) in self.rows.iter().enumerate() {
            if !self.contacts[direction.contact].is_lost {
                continue;
            }
            let own = self.delassus[row * n + row];
            for other in 0..n {
                self.delassus[row * n + other] = 0.0;
                self.delassus[other * n + row] = 0.0;
            }
            self.delassus[row * n + row] = own;
            self.free[row] = match self.kinds[row] {
                RowKind::Friction { .. } => 0.0,
                _ => own * self.multipliers[row].abs(),
            };
        }
    }

    /// Tells the solver how much of a joint row's mobility others must leave: less where the lightest body that joints hold is lighter than the
    /// heaviest one, and anything on what is attached to flexible bodies, whose places are known in double precision and which may be stiff.
    pub(super) fn tell_independence(&mut self) {
        let (mut least, mut most) = (f64::INFINITY, 0.0f64);
        for grip in &self.joint_grips {
            let mass = match &self.blocks[grip.block] {
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
        let of_contacts = self.rows.iter().map(|_| 0.0);
        let is_rigid = |&row: &usize| self.ties.get(row).is_some_and(|tie| tie.is_hard);
        let of_joints = self
            .joint_rows
            .iter()
            .map(|row| if is_rigid(row) { of_rigid } else { 0.0 });
        self.solver.set_independence(of_contacts.chain(of_joints));
    }

    /// The natural-map residual of rows that move by `velocity` beyond what they may (m/s²): redundant rows that contradict
    /// each other by less are averaged.
    fn redundancy_tolerance(&self, velocity: f64) -> f64 {
        let n = self.kinds.len();
        let (mut largest, mut scale) = (0.0f64, 0.0f64);
        for (row, free) in self.free.iter().enumerate() {
            let own = self.delassus[row * n + row];
            if own > 0.0 {
                largest = largest.max(own);
                let load = free.abs().max(own * self.multipliers[row].abs());
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
    pub(super) fn take_out_multipliers(&mut self, has_new_rows: bool) {
        let n = self.rows.len();
        if n == 0 {
            return;
        }
        if !has_new_rows {
            for (free, row) in self.free.iter_mut().zip(self.delassus.chunks_exact(n)) {
                let response: f64 = row.iter().zip(&self.multipliers).map(|(w, p)| w * p).sum();
                *free -= response;
            }
            return;
        }
        let mut row = 0;
        while row < n {
            let contact = &self.contacts[self.rows[row].contact];
            let mut response = Vec2::zeros();
            for other in self
                .contacts
                .iter()
                .filter(|other| other.multiplier[0] > 0.0)
            {
                let applied = &other.applied;
                let found = compliance(
                    &self.blocks,
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
            while row < n && self.rows[row].contact == self.rows[first].contact {
                self.free[row] -= self.rows[row].direction.dot(&response);
                row += 1;
            }
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
