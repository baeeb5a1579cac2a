//! Joint rows in the velocity and acceleration problems, and what joints do to the energy.

use super::island::{Island, KktError, SolveSettings};
use super::joint_law::{Finish, bounded};
use super::joint_rows::{ActiveJoint, add_wrench};
use super::joint_system::Rows;
use super::unresolved::share_of;
use crate::constraint::joint::{JointGrip, Spring, When, unit_wrench};
use crate::linalg::complementarity::{Problem, RowKind, Status};
use crate::math::{
    judged::{Judged, NEGLIGIBLE},
    rounding,
};
use crate::system::{Block, Point, Response};

/// Share of a soft row's velocity below which it is left to its multiplier.
const LEFT_ALONE: Judged = NEGLIGIBLE;

/// Distance from its bound (m or rad) within which a limit that pushed in the last step has pushed all along.
const STAYED: f64 = rounding::SINGLE;

impl Island {
    /// Gives the rigid blocks the velocities that go with the forces of the position stage.
    pub(super) fn kick_joints(&mut self, settings: &SolveSettings) {
        if self.ties.is_empty() {
            return;
        }
        self.twists.kick(&mut self.blocks, settings);
        self.aim_joints_at_end();
        for index in 0..self.ties.len() {
            let tie = &mut self.ties[index];
            if !tie.is_hard {
                continue;
            }
            let half = settings.b0 * (tie.multiplier - tie.closer) / settings.dt;
            let stayed = tie.row.last_multiplier() > 0.0 && tie.start - tie.goal <= STAYED;
            tie.kick = if tie.finish == Finish::Limit && !stayed {
                0.0
            } else {
                half
            };
            tie.impulse = if tie.finish == Finish::Spring {
                half
            } else {
                0.0
            };
            let tie = self.ties[index];
            self.push_rigid(&tie, Rows::Kept, tie.kick);
            self.push_rigid(&tie, Rows::End, tie.impulse);
        }
    }

    /// Measures the rows of the step's end.
    fn aim_joints_at_end(&mut self) {
        self.end_grips.clear();
        self.end_grips.extend_from_slice(&self.joint_grips);
        for index in 0..self.ties.len() {
            let tie = &mut self.ties[index];
            let grips = &mut self.end_grips[tie.row.grips.0..tie.row.grips.1];
            tie.end = tie.row.sign * tie.row.measure.aim(&self.blocks, grips, When::Now);
            if let (false, Finish::Hold { rate }) = (tie.is_hard, tie.finish) {
                let tie = self.ties[index];
                self.ties[index].share = self.unresolved_joint(&tie);
                self.ties[index].driven = rate - self.driven_rate(&tie);
            }
        }
    }

    /// How far the velocity stage holds a soft row: wholly between masses, through a massless node by the share that is
    /// shorter than the step.
    fn unresolved_joint(&self, tie: &ActiveJoint) -> f64 {
        if tie.has_mass {
            return 1.0;
        }
        let (grips, along) = (self.end_grips_of(tie), tie.end);
        let (mut rigid, mut actual) = (0.0, 0.0);
        for at in grips {
            rigid += at.weight.abs() * self.blocks[at.block].rigid_mobility(at.grip(), along);
            for from in grips.iter().filter(|from| from.block == at.block) {
                let compliance =
                    self.blocks[at.block].compliance(at.grip(), from.grip(), Response::Velocity);
                actual += at.weight * from.weight * along.dot(&(compliance * along));
            }
        }
        share_of(rigid, actual)
    }

    fn end_grips_of(&self, tie: &ActiveJoint) -> &[JointGrip] {
        &self.end_grips[tie.row.grips.0..tie.row.grips.1]
    }

    /// Gives the rigid blocks of a row an impulse along it.
    fn push_rigid(&mut self, tie: &ActiveJoint, which: Rows, impulse: f64) {
        if impulse == 0.0 {
            return;
        }
        let is_turn = tie.row.measure.is_turn();
        let (grips, direction) = match which {
            Rows::Kept => (&self.joint_grips, tie.direction),
            Rows::End => (&self.end_grips, tie.end),
        };
        for grip in &grips[tie.row.grips.0..tie.row.grips.1] {
            if let Block::Rigid(block) = &mut self.blocks[grip.block] {
                let wrench = unit_wrench(grip, direction, is_turn);
                block.add_impulse(wrench.map(|value| impulse * value));
            }
        }
    }

    /// `G'v'` of a row (m/s or rad/s).
    fn joint_rate(&self, tie: &ActiveJoint) -> f64 {
        self.along(tie, |block, grip| match block {
            Block::Rigid(block) => block.rates(),
            Block::Flex(flex) => match grip.point {
                Point::Node(node) => {
                    let velocity = flex.velocity(node);
                    [velocity.x, velocity.y, 0.0]
                }
                Point::Arm(_) => [0.0; 3],
            },
        })
    }

    /// `Σ w·f` over the grips of a row at the end; `f` of a flexible block has two components.
    pub(super) fn along(
        &self,
        tie: &ActiveJoint,
        value: impl Fn(&Block, &JointGrip) -> [f64; 3],
    ) -> f64 {
        let is_turn = tie.row.measure.is_turn();
        let mut sum = 0.0;
        for grip in self.end_grips_of(tie) {
            let wrench = unit_wrench(grip, tie.end, is_turn);
            let value = value(&self.blocks[grip.block], grip);
            sum += wrench.iter().zip(value).map(|(w, v)| w * v).sum::<f64>();
        }
        sum
    }

    /// Lists the joint rows of the velocity problem that take part, after those of the contacts.
    pub(super) fn list_joint_velocities(
        &mut self,
        settings: &SolveSettings,
        takes_part: impl Fn(&ActiveJoint) -> bool,
    ) {
        self.joint_rows.clear();
        self.joint_gives.clear();
        for index in 0..self.ties.len() {
            let tie = &self.ties[index];
            if !takes_part(tie) {
                continue;
            }
            let Some((free, kind, give)) = self.velocity_law(tie, settings) else {
                continue;
            };
            self.joint_rows.push(index);
            self.joint_gives.push(give);
            self.free.push(free);
            self.kinds.push(kind);
        }
    }

    /// Adds the joint rows listed to the Delassus matrix of the contacts' rows, softened by their shares.
    pub(super) fn expand_joints(&mut self, of: Response) {
        if self.joint_rows.is_empty() {
            return;
        }
        self.expand_delassus(of, Rows::End);
        let (n, first) = (self.kinds.len(), self.rows.len());
        for (slot, &row) in self.joint_rows.iter().enumerate() {
            let diagonal = (first + slot) * (n + 1);
            let share = self.ties[row].share;
            self.delassus[diagonal] = self.delassus[diagonal] / share + self.joint_gives[slot];
        }
    }

    /// Free velocity, law and give (m/s per N s) of a row that takes part in the velocity problem.
    fn velocity_law(
        &self,
        tie: &ActiveJoint,
        settings: &SolveSettings,
    ) -> Option<(f64, RowKind, f64)> {
        if !tie.is_movable || !tie.is_closed() || tie.share < LEFT_ALONE {
            return None;
        }
        let half = settings.b0 / settings.dt;
        match tie.finish {
            Finish::Hold { rate } => {
                let kind = match tie.kind {
                    RowKind::Box { high, .. } => bounded(half * high),
                    kind => kind,
                };
                Some((self.joint_rate(tie) - rate, kind, 0.0))
            }
            Finish::Limit => Some((self.joint_rate(tie), RowKind::Unilateral, 0.0)),
            Finish::Stiff(spring) => {
                let (offset, give) = stiff_law(&spring, tie.gap + tie.goal, settings.dt);
                let kind = bounded(0.5 * settings.dt * spring.most);
                Some((self.joint_rate(tie) + offset, kind, give))
            }
            Finish::Spring | Finish::Nothing => None,
        }
    }

    /// Gathers the joints' part of a solution as impulses on flexible blocks and wrenches on rigid ones; of accelerations only
    /// that of soft rows, as hard ones leave none.
    pub(super) fn gather_joint_rows(&mut self, of: Response) {
        let first = self.rows.len();
        for slot in 0..self.joint_rows.len() {
            let (index, value) = (self.joint_rows[slot], self.multipliers[first + slot]);
            let tie = self.ties[index];
            if value == 0.0 || (of == Response::Acceleration && tie.is_hard) {
                continue;
            }
            let is_turn = tie.row.measure.is_turn();
            for grip in &self.end_grips[tie.row.grips.0..tie.row.grips.1] {
                match (&mut self.blocks[grip.block], grip.point) {
                    (Block::Flex(block), Point::Node(node)) => {
                        let impulse = value * grip.weight * tie.end;
                        block.gather_impulse(of, node, impulse, grip.lever);
                    }
                    _ => add_wrench(
                        &mut self.wrenches[grip.block],
                        value,
                        unit_wrench(grip, tie.end, is_turn),
                    ),
                }
            }
        }
    }

    /// Notes the impulses of a solved velocity problem.
    pub(super) fn take_joint_impulses(&mut self) {
        let first = self.rows.len();
        for (slot, &row) in self.joint_rows.iter().enumerate() {
            self.ties[row].impulse += self.multipliers[first + slot];
        }
    }

    /// Adds the forces of soft joints to the wrenches of rigid blocks.
    pub(super) fn add_soft_joints(&mut self) {
        for tie in self.ties.iter().filter(|tie| !tie.is_hard) {
            for grip in &self.joint_grips[tie.row.grips.0..tie.row.grips.1] {
                if let Block::Rigid(_) = &self.blocks[grip.block] {
                    let wrench = unit_wrench(grip, tie.direction, tie.row.measure.is_turn());
                    add_wrench(&mut self.wrenches[grip.block], tie.multiplier, wrench);
                }
            }
        }
    }

    /// Whether some joint holds a flexible block, so that accelerations are settled.
    pub(super) fn has_soft_joints(&self) -> bool {
        self.ties.iter().any(|tie| !tie.is_hard)
    }

    /// Adds the mean forces of hard springs to the wrenches: in the acceleration problem they are known.
    pub(super) fn add_spring_forces(&mut self, dt: f64) {
        for tie in self.ties.iter().filter(|tie| tie.is_hard) {
            if !matches!(tie.finish, Finish::Spring | Finish::Stiff(_)) {
                continue;
            }
            let force = (tie.kick + tie.impulse) / dt;
            for grip in &self.end_grips[tie.row.grips.0..tie.row.grips.1] {
                let wrench = unit_wrench(grip, tie.end, tie.row.measure.is_turn());
                add_wrench(&mut self.wrenches[grip.block], force, wrench);
            }
        }
    }

    /// Lists the joint rows of the acceleration problem that take part, `G'a' = ` what turning asks for.
    pub(super) fn list_joint_accelerations(&mut self, takes_part: impl Fn(&ActiveJoint) -> bool) {
        self.joint_rows.clear();
        self.joint_gives.clear();
        for index in 0..self.ties.len() {
            let tie = &self.ties[index];
            if !takes_part(tie) {
                continue;
            }
            let holds = matches!(tie.finish, Finish::Hold { .. } | Finish::Limit);
            let holds = holds && tie.is_movable && tie.is_closed() && tie.share >= LEFT_ALONE;
            // A motor at its bound does not hold.
            if !holds || matches!(tie.status, Status::SlipPositive | Status::SlipNegative) {
                continue;
            }
            let acceleration = self.along(tie, |block, grip| self.total_acceleration(block, grip));
            self.joint_rows.push(index);
            self.joint_gives.push(0.0);
            self.free.push(acceleration);
            self.kinds.push(RowKind::Bilateral);
        }
    }

    /// Acceleration of a grip's block, the centripetal part of the grip included.
    fn total_acceleration(&self, block: &Block, grip: &JointGrip) -> [f64; 3] {
        let centripetal = -block.spin() * block.spin() * grip.lever;
        match block {
            Block::Rigid(rigid) => {
                let (under, turn) = block.acceleration_under(&self.wrenches, grip.block);
                let [x, y, own] = rigid.smooth_end;
                [
                    x + under.x + centripetal.x,
                    y + under.y + centripetal.y,
                    own + turn,
                ]
            }
            Block::Flex(_) => {
                let sum = block.smooth_acceleration(grip.grip()) + centripetal;
                [sum.x, sum.y, 0.0]
            }
        }
    }

    /// Finds what the joints answer to the impulses of contact rows, so that velocities stay those the joints allow.
    ///
    /// # Errors
    /// If a number is not finite.
    pub(super) fn hold_joints(&mut self, settings: &SolveSettings) -> Result<(), KktError> {
        self.joint_rows.clear();
        for index in 0..self.ties.len() {
            if self.velocity_law(&self.ties[index], settings).is_some() {
                self.joint_rows.push(index);
            }
        }
        if self.joint_rows.is_empty() {
            return Ok(());
        }
        let (first, n_joints) = (self.rows.len(), self.joint_rows.len());
        let n = first + n_joints;
        self.delassus.clear();
        self.delassus.resize(first * first, 0.0);
        self.expand_delassus(Response::Velocity, Rows::End);
        self.free.clear();
        self.kinds.clear();
        for slot in 0..n_joints {
            let line = &self.delassus[(first + slot) * n..(first + slot + 1) * n];
            let pairs = line.iter().zip(&self.multipliers);
            self.free.push(pairs.map(|(w, p)| w * p).sum());
            self.kinds.push(RowKind::Bilateral);
        }
        for slot in 0..n_joints {
            let source = (first + slot) * n + first;
            self.delassus
                .copy_within(source..source + n_joints, slot * n_joints);
        }
        self.delassus.truncate(n_joints * n_joints);
        self.joint_answer.clear();
        self.joint_answer.resize(n_joints, 0.0);
        self.statuses.clear();
        self.statuses.resize(n_joints, Status::Stick);
        let problem = Problem {
            delassus: &self.delassus,
            free: &self.free,
            rows: &self.kinds,
            acted: &[],
        };
        self.solver
            .solve_condensed(&problem, &mut self.joint_answer, &mut self.statuses)?;
        self.multipliers.extend_from_slice(&self.joint_answer);
        Ok(())
    }

    /// Lets the damping of rigid blocks in joints know the velocities that the joints have left; that of all, what contacts have left, where
    /// multipliers act wholly within the step.
    pub(super) fn settle_damping(&mut self, settings: &SolveSettings) {
        if settings.is_within {
            for block in &mut self.blocks {
                if let Block::Rigid(block) = block {
                    block.settle_damping();
                }
            }
            return;
        }
        if self.ties.is_empty() {
            return;
        }
        let mut last = None;
        for &(block, _) in &self.holders {
            if last.replace(block) != Some(block)
                && let Block::Rigid(block) = &mut self.blocks[block]
            {
                block.settle_damping();
            }
        }
    }
}

/// Offset (m/s) and give (m/s per N s) of a spring that acts with half a step's look-ahead:
/// `μ = -k (q' + dt/2 v - rest) - c (v - rate)`, `P = dt/2 μ`.
fn stiff_law(spring: &Spring, value: f64, dt: f64) -> (f64, f64) {
    let total = 0.5 * dt * spring.stiffness + spring.damping;
    let pull = spring.stiffness * (value - spring.rest) - spring.damping * spring.rate;
    (pull / total, 2.0 / (dt * total))
}
