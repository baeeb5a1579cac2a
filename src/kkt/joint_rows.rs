//! Joint rows in the position stage: their laws at this step length, their gaps and their forces.
//!
//! *Hard* rows, between rigid blocks only, follow RATTLE (Andersen 1983): the force `λ` of the position stage acts along the rows
//! of the step's beginning and gives the velocity `dt/2 M⁻¹G₀ᵀλ`; the velocity stage adds `dt/2 M⁻¹G'ᵀμ` along those of the end,
//! with `G'v' = 0`. That is second order, symmetric, keeps momentum and angular momentum exactly and energy within a band, and
//! leaves no force in the stored accelerations. As the position stage moves by `b0 M⁻¹G₀ᵀp`, `λ = 2 b0 p / dt²`.
//!
//! *Soft* rows, with a flexible block, act as (C.5) says, along rows that follow the iterates as those of contacts do.

use super::active_contact::ActiveContact;
use super::island::{Island, SolveSettings};
use super::joint_held::JointHold;
use super::joint_law::{Finish, resolve};
use crate::constraint::contact::Kinematics;
use crate::constraint::joint::{JointGrip, JointRow, RememberedJoint, When, unit_wrench};
use crate::linalg::complementarity::{RowKind, Status};
use crate::math::{Vec2, perp, rounding};
use crate::system::{Block, Point, Response};

/// Mobility of a row, relative to that across it, up to which nothing moves it (-): the square of a lever's rounding. Forces of any size would
/// answer a row that points at the axis of what can only turn.
const SINGULAR: f64 = rounding::SQUARE;

/// A joint row at work.
#[derive(Clone, Copy, Debug)]
pub struct ActiveJoint {
    /// The row.
    pub row: JointRow,
    /// Whether only rigid blocks take part.
    pub is_hard: bool,
    /// Whether all nodes of flexible blocks that take part have mass.
    pub(super) has_mass: bool,
    /// Share of the velocity that the row keeps when others give impulses, 0 to 1 (-).
    pub(super) share: f64,
    pub(super) finish: Finish,
    /// Measured number at the beginning, and where it is to be (m or rad).
    pub(super) start: f64,
    pub(super) goal: f64,
    /// How far a unit multiplier lets the row give way (m/N or rad/(N m)).
    pub(super) give: f64,
    /// The same where rows contradict each other (m/N or rad/(N m)).
    pub(super) yielding: f64,
    pub(super) kind: RowKind,
    /// Distance from the goal at the last iterate (m or rad).
    pub(super) gap: f64,
    /// Directions of the forces: now, when the last iterate was found, and at the end of the step.
    pub(super) direction: Vec2,
    pub(super) applied: Vec2,
    pub(super) end: Vec2,
    /// Multiplier of the position stage (N or N m).
    pub multiplier: f64,
    pub(super) status: Status,
    /// How far the step brings ends that were put apart nearer to each other (m or rad), and the part of the multiplier that does so.
    pub(super) closing: f64,
    pub(super) closer: f64,
    /// Goal and closing before it was asked whether the bodies can come that near (m or rad).
    pub(super) asked: [f64; 2],
    /// Impulses along the rows of the beginning and of the end (N s or N m s).
    pub(super) kick: f64,
    pub(super) impulse: f64,
    /// Rate at which it is driven from outside when the step ends (m/s or rad/s).
    pub(super) driven: f64,
    /// Whether something can move the row at all.
    pub(super) is_movable: bool,
    /// Where the row is to be in the end (m or rad).
    pub(super) target: f64,
    /// Gap after the pass before (m or rad), how often it has been the same, and whether it is left open as other rows contradict it.
    pub(super) seen: f64,
    pub(super) n_same: usize,
    pub(super) is_left: bool,
    /// Whether it is left open by more than what counts, as the bodies cannot come that near.
    pub(super) is_out_of_reach: bool,
}

impl ActiveJoint {
    /// What the row leaves for the next step.
    pub fn left_behind(&self) -> RememberedJoint {
        RememberedJoint {
            multiplier: self.multiplier - self.closer,
            driven: self.driven,
            closes: self.closing != 0.0 && self.goal != self.target,
        }
    }

    /// Mean force or torque over the step, along `+∂q/∂x` (N or N m).
    pub fn force(&self, dt: f64) -> f64 {
        let impulse = (self.kick + self.impulse) / dt;
        let steady = if self.is_hard {
            0.0
        } else {
            self.multiplier - self.closer
        };
        self.row.sign * (steady + impulse)
    }

    /// Whether a row of rigid bodies that is not driven is farther than this from where it is to hold (m or rad): when the step began, or now if rows
    /// may contradict each other.
    pub(super) fn is_open(&self, slop: f64, contradicts: bool) -> bool {
        let is_driven = matches!(self.finish, Finish::Hold { rate } if rate != 0.0);
        if !self.is_hard || self.give > 0.0 || is_driven {
            return false;
        }
        let began = self.off(self.start - self.asked[0]);
        self.asked[1] != 0.0 || began > slop || contradicts && self.error() > slop
    }

    /// How far the row is from holding where it is this far from where it is to be (m or rad).
    fn off(&self, from: f64) -> f64 {
        match self.kind {
            RowKind::Unilateral => (-from).max(0.0),
            RowKind::Bilateral => from.abs(),
            _ => 0.0,
        }
    }

    /// Whether its ends move against each other in the step, drawn together or left elsewhere than where they are to be.
    pub(super) fn moves_apart(&self) -> bool {
        self.closing != 0.0 || self.is_hard && self.goal != self.target
    }

    /// Leaves the row open by this beyond what was asked of it. It is told if that is more than `slop` (m or rad) and the row does not come half as near
    /// as asked: what closes in its time is no more than late.
    pub(super) fn leave(&mut self, open: f64, slop: f64) {
        let [goal, closing] = self.asked;
        let [began, asked, ends] =
            [self.start, goal, goal + open].map(|place| self.off(place - self.target));
        self.is_out_of_reach = ends > asked + slop && ends > 0.5 * (began + asked);
        self.gap += self.goal - (goal + open);
        self.goal = goal + open;
        self.closing = (closing + open).clamp(closing.min(0.0), closing.max(0.0));
    }

    /// How far the row has moved since the step began, linear in the dofs of the blocks (m or rad).
    pub(super) fn moved(&self, blocks: &[Block], grips: &[JointGrip]) -> f64 {
        let is_turn = self.row.measure.is_turn();
        let grips = grips[self.row.grips.0..self.row.grips.1].iter();
        let moved = grips.map(|grip| match &blocks[grip.block] {
            Block::Rigid(block) => {
                let wrench = unit_wrench(grip, self.direction, is_turn);
                let moved = block.moved();
                wrench.iter().zip(moved).map(|(w, x)| w * x).sum::<f64>()
            }
            block => grip.weight * self.direction.dot(&block.displacement(grip.grip())),
        });
        moved.sum()
    }

    /// How far the law is from holding (m or rad).
    pub(super) fn error(&self) -> f64 {
        if !self.is_movable {
            return 0.0;
        }
        let off = self.gap + (self.give + self.yielding) * self.multiplier;
        match (self.kind, self.status) {
            (RowKind::Unilateral, Status::Open) | (_, Status::SlipNegative) => (-off).max(0.0),
            (_, Status::SlipPositive) => off.max(0.0),
            _ => off.abs(),
        }
    }

    /// Share of the row's motion that a problem holds (-).
    pub(super) fn share_of(&self, of: Response) -> f64 {
        match of {
            Response::Position => 1.0,
            Response::Velocity | Response::Acceleration | Response::ByMass => self.share,
        }
    }

    /// Whether the row holds its velocity in this step.
    pub(super) fn is_closed(&self) -> bool {
        !matches!(self.kind, RowKind::Unilateral) || self.multiplier > 0.0
    }
}

impl Island {
    /// Puts every joint row to work, with the multipliers of the last step.
    pub(super) fn open_joints(&mut self, settings: &SolveSettings) {
        if !self.ties.is_empty() {
            self.twists.relax(&mut self.blocks);
        }
        self.ties.clear();
        self.joined.list(&[], &[]);
        if self.joints.is_empty() {
            return;
        }
        for slot in 0..self.joints.len() {
            let row = self.joints[slot];
            let is_hard = self.prepare_joint(&row);
            let when = if is_hard { When::Start } else { When::Now };
            let grips = &mut self.joint_grips[row.grips.0..row.grips.1];
            let direction = row.sign * row.measure.aim(&self.blocks, grips, when);
            let is_massless = |grip: &JointGrip| self.blocks[grip.block].is_massless(grip.point);
            let has_mass = !grips.iter().any(is_massless);
            let start = row.sign * row.measure.value(&self.blocks, grips, When::Start);
            let view = (&*grips, direction, row.measure.is_turn());
            let mobility = own_mobility(&self.blocks, view);
            let across = own_mobility(&self.blocks, (grips, perp(direction), view.2));
            let resolved = resolve(&row, is_hard, (start, mobility), settings);
            let status = match resolved.kind {
                RowKind::Unilateral if row.last_multiplier() <= 0.0 => Status::Open,
                _ => Status::Stick,
            };
            self.ties.push(ActiveJoint {
                row,
                is_hard,
                has_mass,
                share: 1.0,
                finish: resolved.finish,
                start,
                goal: resolved.goal,
                target: resolved.target,
                give: resolved.give,
                yielding: 0.0,
                kind: resolved.kind,
                gap: start - resolved.goal,
                direction,
                applied: direction,
                end: direction,
                multiplier: row.last_multiplier(),
                status,
                closing: resolved.closing,
                closer: 0.0,
                asked: [resolved.goal, resolved.closing],
                kick: 0.0,
                impulse: 0.0,
                driven: 0.0,
                is_movable: mobility > SINGULAR * across,
                seen: f64::INFINITY,
                n_same: 0,
                is_left: false,
                is_out_of_reach: false,
            });
        }
        self.applied_grips.clear();
        self.applied_grips.extend_from_slice(&self.joint_grips);
        self.list_holders();
        self.joined.list(&self.ties, &self.joint_grips);
        let joints = (&self.ties[..], &self.joint_grips[..]);
        let last = |tie: &ActiveJoint| tie.row.last_multiplier();
        self.twists
            .stiffen(&mut self.blocks, joints, settings, last);
    }

    /// Gives the blocks the stiffness of the forces of this iterate, where those of the last step were far off, as in an impact.
    pub(super) fn restiffen_turns(&mut self, settings: &SolveSettings) {
        self.twists.relax(&mut self.blocks);
        let joints = (&self.ties[..], &self.joint_grips[..]);
        let now = |tie: &ActiveJoint| tie.multiplier;
        self.twists.stiffen(&mut self.blocks, joints, settings, now);
    }

    fn joint_hold(&self) -> JointHold<'_> {
        JointHold {
            blocks: &self.blocks,
            ties: &self.ties,
            grips: &self.joint_grips,
        }
    }

    /// Whether joints leave the two rigid bodies of a contact no motion against each other.
    pub(super) fn is_held_by_joints(&self, row: &Kinematics) -> bool {
        self.joint_hold().holds(row)
    }

    /// Whether a contact is between blocks that a joint holds.
    pub(super) fn is_joined(&self, contact: &ActiveContact) -> bool {
        self.joined.has(contact)
    }

    /// Makes the compliances of all rows' nodes known again, which bodies of large strain forget with their factors.
    pub(super) fn prepare_joints(&mut self) {
        for slot in 0..self.ties.len() {
            let row = self.ties[slot].row;
            self.prepare_joint(&row);
        }
    }

    /// Makes the compliances of a row's nodes known; returns whether there are none.
    fn prepare_joint(&mut self, row: &JointRow) -> bool {
        let mut is_hard = true;
        for grip in &self.joint_grips[row.grips.0..row.grips.1] {
            if let (Block::Flex(block), Point::Node(node)) =
                (&mut self.blocks[grip.block], grip.point)
            {
                block.prepare_compliance(node);
                block.prepare_inertia(node);
                is_hard = false;
            }
        }
        is_hard
    }

    /// Lists which rows hold which block, so that only rows that couple are ever combined.
    pub(super) fn list_holders(&mut self) {
        self.holders.clear();
        for (index, tie) in self.ties.iter().enumerate() {
            for grip in &self.joint_grips[tie.row.grips.0..tie.row.grips.1] {
                let moves = !matches!(&self.blocks[grip.block], Block::Rigid(block) if block.is_prescribed());
                if moves && tie.is_movable {
                    self.holders.push((grip.block, index));
                }
            }
        }
        self.holders.sort_unstable();
        self.holders.dedup();
    }

    /// Adds the forces of the joints to the stage forces and wrenches.
    pub(super) fn spread_joints(&mut self) {
        for tie in &self.ties {
            let p = tie.multiplier;
            if p == 0.0 {
                continue;
            }
            let is_turn = tie.row.measure.is_turn();
            for grip in &self.joint_grips[tie.row.grips.0..tie.row.grips.1] {
                match (&mut self.blocks[grip.block], grip.point) {
                    (Block::Flex(block), Point::Node(node)) => {
                        let force = p * grip.weight * tie.direction;
                        block.add_stage_force(node, force, grip.lever, false);
                    }
                    _ => add_wrench(
                        &mut self.wrenches[grip.block],
                        p,
                        unit_wrench(grip, tie.direction, is_turn),
                    ),
                }
            }
        }
    }

    /// Measures all joint rows where the blocks are now; returns how far the laws are from holding (m or rad).
    pub(super) fn measure_joints(&mut self) -> f64 {
        let mut error = 0.0f64;
        for tie in &mut self.ties {
            let grips = &self.joint_grips[tie.row.grips.0..tie.row.grips.1];
            let value = tie.row.measure.value(&self.blocks, grips, When::Now);
            tie.gap = tie.row.sign * value - tie.goal;
            error = error.max(tie.error());
        }
        error
    }

    /// Extrapolates all joint rows from the beginning of the step, along the rows that they have; returns how far the laws are from holding
    /// there (m or rad).
    pub(super) fn extrapolate_joints(&mut self) -> f64 {
        let mut error = 0.0f64;
        for tie in &mut self.ties {
            tie.gap = tie.start + tie.moved(&self.blocks, &self.joint_grips) - tie.goal;
            error = error.max(tie.error());
        }
        error
    }

    /// Notes that the forces of soft joints acted along the rows that they have.
    pub(super) fn keep_joints(&mut self) {
        self.applied_grips.clear();
        self.applied_grips.extend_from_slice(&self.joint_grips);
        for tie in &mut self.ties {
            tie.applied = tie.direction;
        }
    }

    /// Makes the present geometry the rows that the forces of soft joints act along.
    pub(super) fn refresh_joints(&mut self) {
        for tie in &mut self.ties {
            if tie.is_hard {
                continue;
            }
            let (first, last) = tie.row.grips;
            self.applied_grips[first..last].copy_from_slice(&self.joint_grips[first..last]);
            tie.applied = tie.direction;
            let grips = &mut self.joint_grips[first..last];
            tie.direction = tie.row.sign * tie.row.measure.aim(&self.blocks, grips, When::Now);
        }
    }
}

/// Adds a multiple of a wrench.
pub(super) fn add_wrench(sum: &mut [f64; 3], factor: f64, wrench: [f64; 3]) {
    for (sum, value) in sum.iter_mut().zip(wrench) {
        *sum += factor * value;
    }
}

/// `G A⁻¹ Gᵀ` of one row (1/kg).
fn own_mobility(blocks: &[Block], (grips, direction, is_turn): (&[JointGrip], Vec2, bool)) -> f64 {
    let mut sum = 0.0;
    for at in grips {
        for from in grips.iter().filter(|from| from.block == at.block) {
            sum += pair_mobility(
                blocks,
                (at, direction, is_turn),
                (from, direction, is_turn),
                Response::Position,
            );
        }
    }
    sum
}

/// How a grip of one row moves by a unit multiplier at a grip of another, on the same block (1/kg).
pub(super) fn pair_mobility(
    blocks: &[Block],
    (at, along, turns): (&JointGrip, Vec2, bool),
    (from, push, is_turned): (&JointGrip, Vec2, bool),
    of: Response,
) -> f64 {
    match &blocks[at.block] {
        Block::Rigid(block) => block.mobility_between(
            unit_wrench(at, along, turns),
            unit_wrench(from, push, is_turned),
            of,
        ),
        Block::Flex(_) => {
            let compliance = blocks[at.block].compliance(at.grip(), from.grip(), of);
            at.weight * from.weight * along.dot(&(compliance * push))
        }
    }
}
