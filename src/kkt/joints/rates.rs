//! Joint rows in the velocity and acceleration problems, and what joints do to the energy.

use super::law::bounded;
use super::{ActiveJoint, Among, Finish, Joints, Rows};
use crate::constraint::joint::{JointGrip, Spring, When, unit_wrench};
use crate::kkt::problem::RowProblem;
use crate::kkt::settings::{KktError, SolveSettings};
use crate::kkt::unresolved::share_of;
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

impl Joints {
    /// Gives the rigid blocks the velocities that go with the forces of the position stage.
    pub(in crate::kkt) fn kick(&mut self, blocks: &mut [Block], settings: &SolveSettings) {
        if self.ties.is_empty() {
            return;
        }
        self.twists.kick(blocks, settings);
        self.aim_at_end(blocks);
        for index in 0..self.ties.len() {
            let tie = &mut self.ties[index];
            if !tie.is_hard {
                continue;
            }
            let half = settings.b0 * tie.felt() / settings.dt;
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
            self.push_rigid(blocks, &tie, (Rows::Kept, tie.kick));
            self.push_rigid(blocks, &tie, (Rows::End, tie.impulse));
        }
    }

    /// Measures the rows of the step's end.
    fn aim_at_end(&mut self, blocks: &[Block]) {
        self.end_grips.clear();
        self.end_grips.extend_from_slice(&self.grips);
        for index in 0..self.ties.len() {
            let tie = &mut self.ties[index];
            let grips = &mut self.end_grips[tie.row.grips.0..tie.row.grips.1];
            tie.end = tie.row.sign * tie.row.measure.aim(blocks, grips, When::Now);
            if let (false, Finish::Hold { rate }) = (tie.is_hard, tie.finish) {
                let tie = self.ties[index];
                self.ties[index].share = self.unresolved_share(blocks, &tie);
                self.ties[index].driven = rate - self.driven_rate(blocks, &tie);
                let moves =
                    |block: &Block| !matches!(block, Block::Rigid(block) if block.is_prescribed());
                let grips = &self.grips[tie.row.grips.0..tie.row.grips.1];
                let began = tie.row.measure.start_rate(blocks, grips, moves);
                self.ties[index].began = tie.row.sign * began;
            }
        }
    }

    /// How far the velocity stage holds a soft row: wholly between masses, through a massless node by the share that is
    /// shorter than the step.
    fn unresolved_share(&self, blocks: &[Block], tie: &ActiveJoint) -> f64 {
        if tie.has_mass {
            return 1.0;
        }
        let (grips, along) = (self.end_grips_of(tie), tie.end);
        let (mut rigid, mut actual) = (0.0, 0.0);
        for at in grips {
            rigid += at.weight.abs() * blocks[at.block].rigid_mobility(at.grip(), along);
            for from in grips.iter().filter(|from| from.block == at.block) {
                let compliance =
                    blocks[at.block].compliance(at.grip(), from.grip(), Response::Velocity);
                actual += at.weight * from.weight * along.dot(&(compliance * along));
            }
        }
        share_of(rigid, actual)
    }

    fn end_grips_of(&self, tie: &ActiveJoint) -> &[JointGrip] {
        &self.end_grips[tie.row.grips.0..tie.row.grips.1]
    }

    /// Gives the rigid blocks of a row an impulse along it.
    fn push_rigid(&self, blocks: &mut [Block], tie: &ActiveJoint, (which, impulse): (Rows, f64)) {
        if impulse == 0.0 {
            return;
        }
        let is_turn = tie.row.measure.is_turn();
        let (grips, direction) = match which {
            Rows::Kept => (&self.grips, tie.direction),
            Rows::End => (&self.end_grips, tie.end),
        };
        for grip in &grips[tie.row.grips.0..tie.row.grips.1] {
            if let Block::Rigid(block) = &mut blocks[grip.block] {
                let wrench = unit_wrench(grip, direction, is_turn);
                block.add_impulse(wrench.map(|value| impulse * value));
            }
        }
    }

    /// `G'v'` of a row (m/s or rad/s).
    fn rate(&self, blocks: &[Block], tie: &ActiveJoint) -> f64 {
        self.along(blocks, tie, |block, grip| match block {
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

    /// Part of `G'v'` of a row that is driven from outside (m/s or rad/s).
    fn driven_rate(&self, blocks: &[Block], tie: &ActiveJoint) -> f64 {
        self.along(blocks, tie, |block, _| match block {
            Block::Rigid(block) if block.is_prescribed() => block.rates(),
            _ => [0.0; 3],
        })
    }

    /// `Σ w·f` over the grips of a row at the end; `f` of a flexible block has two components.
    pub(in crate::kkt) fn along(
        &self,
        blocks: &[Block],
        tie: &ActiveJoint,
        value: impl Fn(&Block, &JointGrip) -> [f64; 3],
    ) -> f64 {
        let is_turn = tie.row.measure.is_turn();
        let mut sum = 0.0;
        for grip in self.end_grips_of(tie) {
            let wrench = unit_wrench(grip, tie.end, is_turn);
            let value = value(&blocks[grip.block], grip);
            sum += wrench.iter().zip(value).map(|(w, v)| w * v).sum::<f64>();
        }
        sum
    }

    /// Lists the joint rows of the velocity problem that take part, after those of the contacts.
    pub(in crate::kkt) fn list_velocities(
        &mut self,
        problem: &mut RowProblem,
        (blocks, settings): (&[Block], &SolveSettings),
        takes_part: impl Fn(&ActiveJoint) -> bool,
    ) {
        self.list(problem, |joints, tie| {
            let law = || joints.velocity_law(blocks, tie, settings);
            takes_part(tie).then(law).flatten()
        });
    }

    /// Adds the joint rows listed to the Delassus matrix of the contacts' rows, softened by their shares.
    pub(in crate::kkt) fn expand_softened(
        &mut self,
        problem: &mut RowProblem,
        among: Among<'_>,
        of: Response,
    ) {
        if self.listed.is_empty() {
            return;
        }
        self.expand(problem, among, (of, Rows::End));
        let (n, first) = (problem.kinds.len(), problem.rows.len());
        for (slot, &row) in self.listed.iter().enumerate() {
            let diagonal = (first + slot) * (n + 1);
            let share = self.ties[row].share;
            problem.delassus[diagonal] = problem.delassus[diagonal] / share + self.gives[slot];
        }
    }

    /// Free velocity, law and give (m/s per N s) of a row that takes part in the velocity problem.
    fn velocity_law(
        &self,
        blocks: &[Block],
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
                Some((self.rate(blocks, tie) - rate, kind, 0.0))
            }
            Finish::Limit => Some((self.rate(blocks, tie), RowKind::Unilateral, 0.0)),
            Finish::Stiff(spring) => {
                let (offset, give) = stiff_law(&spring, tie.gap + tie.goal, settings.dt);
                let kind = bounded(0.5 * settings.dt * spring.most);
                Some((self.rate(blocks, tie) + offset, kind, give))
            }
            Finish::Spring | Finish::Nothing => None,
        }
    }

    /// Notes the impulses of a solved velocity problem.
    pub(in crate::kkt) fn take_impulses(&mut self, problem: &RowProblem) {
        for (&row, impulse) in self.listed.iter().zip(problem.of_joints()) {
            self.ties[row].impulse += impulse;
        }
    }

    /// Notes the forces of a solved acceleration problem; `late` of their time is in the next step (s).
    pub(in crate::kkt) fn take_accelerations(&mut self, problem: &RowProblem, late: f64) {
        for (&row, force) in self.listed.iter().zip(problem.of_joints()) {
            self.ties[row].settle(*force, late);
        }
    }

    /// Whether some joint holds a flexible block, so that accelerations are settled.
    pub(in crate::kkt) fn has_soft(&self) -> bool {
        self.ties.iter().any(|tie| !tie.is_hard)
    }

    /// Lists the joint rows of the acceleration problem that take part, `G'a' = ` what turning asks for.
    pub(in crate::kkt) fn list_accelerations(
        &mut self,
        problem: &mut RowProblem,
        (blocks, wrenches): (&[Block], &[[f64; 3]]),
        takes_part: impl Fn(&ActiveJoint) -> bool,
    ) {
        self.list(problem, |joints, tie| {
            let holds = matches!(tie.finish, Finish::Hold { .. } | Finish::Limit);
            let holds = holds && tie.is_movable && tie.is_closed() && tie.share >= LEFT_ALONE;
            // A motor at its bound does not hold.
            let gives_in = matches!(tie.status, Status::SlipPositive | Status::SlipNegative);
            let law = || {
                let acceleration = joints.along(blocks, tie, |block, grip| {
                    total_acceleration(block, grip, wrenches)
                });
                (acceleration, RowKind::Bilateral, 0.0)
            };
            (takes_part(tie) && holds && !gives_in).then(law)
        });
    }

    /// Finds what the joints answer to the impulses of contact rows, so that velocities stay those the joints allow.
    ///
    /// # Errors
    /// If a number is not finite.
    pub(in crate::kkt) fn answer_contacts(
        &mut self,
        problem: &mut RowProblem,
        among: Among<'_>,
        settings: &SolveSettings,
    ) -> Result<(), KktError> {
        self.listed.clear();
        for index in 0..self.ties.len() {
            if self
                .velocity_law(among.blocks, &self.ties[index], settings)
                .is_some()
            {
                self.listed.push(index);
            }
        }
        if self.listed.is_empty() {
            return Ok(());
        }
        let (first, n_joints) = (problem.rows.len(), self.listed.len());
        let n = first + n_joints;
        problem.delassus.clear();
        problem.delassus.resize(first * first, 0.0);
        self.expand(problem, among, (Response::Velocity, Rows::End));
        problem.free.clear();
        problem.kinds.clear();
        for slot in 0..n_joints {
            let line = &problem.delassus[(first + slot) * n..(first + slot + 1) * n];
            let pairs = line.iter().zip(&problem.multipliers);
            problem.free.push(pairs.map(|(w, p)| w * p).sum());
            problem.kinds.push(RowKind::Bilateral);
        }
        for slot in 0..n_joints {
            let source = (first + slot) * n + first;
            problem
                .delassus
                .copy_within(source..source + n_joints, slot * n_joints);
        }
        problem.delassus.truncate(n_joints * n_joints);
        self.answer.clear();
        self.answer.resize(n_joints, 0.0);
        problem.statuses.clear();
        problem.statuses.resize(n_joints, Status::Stick);
        let rows = Problem {
            delassus: &problem.delassus,
            free: &problem.free,
            rows: &problem.kinds,
            acted: &[],
        };
        problem
            .solver
            .solve_condensed(&rows, &mut self.answer, &mut problem.statuses)?;
        problem.multipliers.extend_from_slice(&self.answer);
        Ok(())
    }

    /// Lets the damping of rigid blocks in joints know the velocities that the joints have left; that of all, what contacts have left, where
    /// multipliers act wholly within the step.
    pub(in crate::kkt) fn settle_damping(&self, blocks: &mut [Block], settings: &SolveSettings) {
        if settings.is_within {
            for block in blocks {
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
                && let Block::Rigid(block) = &mut blocks[block]
            {
                block.settle_damping();
            }
        }
    }
}

/// Acceleration of a grip's block, the centripetal part of the grip included.
fn total_acceleration(block: &Block, grip: &JointGrip, wrenches: &[[f64; 3]]) -> [f64; 3] {
    let centripetal = -block.spin() * block.spin() * grip.lever;
    match block {
        Block::Rigid(rigid) => {
            let (under, turn) = block.acceleration_under(wrenches[grip.block]);
            let [x, y, own] = rigid.smooth_end;
            [
                x + under.x + centripetal.x,
                y + under.y + centripetal.y,
                own + turn,
            ]
        }
        Block::Flex(_) => {
            let sum = block.smooth_acceleration(grip.grip(), 1.0) + centripetal;
            [sum.x, sum.y, 0.0]
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
