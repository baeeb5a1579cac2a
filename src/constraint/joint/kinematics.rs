//! Joint kinematics: one number of a relative position, and the row of `G` that changes it.

use crate::math::{Vec2, cross, rotation, rounding};
use crate::system::{Block, Grip, Point};

/// What a row measures of the separation `d = Σ w_i x_i` of its grips, the weights of which add up to zero, or of angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Measure {
    /// `d` along a direction fixed in the world (m).
    Along(Vec2),
    /// `d` along an axis that turns with the first grip's rigid block, given at angle zero (m).
    ///
    /// All forces act at the last grip's point, so that they have no couple.
    Axis(Vec2),
    /// The length of `d` (m).
    Distance,
    /// `Σ w_i θ_i` and an offset (rad).
    Turn(f64),
}

/// When a row is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum When {
    /// At the beginning of the step.
    Start,
    /// At the current iterate of its end.
    #[default]
    Now,
    /// The mean of both: what acts there over the whole step exchanges angular momentum and, as the measured number changes by `G·(x' - x)`, no
    /// energy. A flexible body knows its own middle; it is grasped where it is now.
    Halfway,
}

/// One grip of a joint row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointGrip {
    /// Index of the block in the island.
    pub block: usize,
    /// Node or arm.
    pub point: Point,
    /// Weight in `d` or in the turn (-).
    pub weight: f64,
    /// Lever of the force from the block's centre (m).
    pub lever: Vec2,
}

impl JointGrip {
    /// A grip whose lever has not been measured yet.
    pub fn new(block: usize, point: Point, weight: f64) -> Self {
        Self {
            block,
            point,
            weight,
            lever: Vec2::zeros(),
        }
    }

    /// The grip as a force acts on it.
    pub fn grip(&self) -> Grip {
        Grip {
            point: self.point,
            lever: self.lever,
        }
    }

    fn position(&self, blocks: &[Block], when: When) -> Vec2 {
        let block = &blocks[self.block];
        match when {
            When::Start => block.start_position(self.point),
            When::Now => block.position(self.point),
            When::Halfway => 0.5 * (block.start_position(self.point) + block.position(self.point)),
        }
    }

    fn angle(&self, blocks: &[Block], when: When) -> f64 {
        match (&blocks[self.block], when) {
            (Block::Rigid(block), When::Start) => block.start().angle,
            (Block::Rigid(block), When::Now) => block.current().angle,
            (Block::Rigid(block), When::Halfway) => {
                0.5 * (block.start().angle + block.current().angle)
            }
            (Block::Flex(_), _) => 0.0,
        }
    }

    fn centre(&self, blocks: &[Block], when: When) -> Vec2 {
        match (&blocks[self.block], when) {
            (Block::Rigid(block), When::Start) => block.start().centre,
            (Block::Rigid(block), When::Halfway) => {
                0.5 * (block.start().centre + block.current().centre)
            }
            (block, _) => block.centre(),
        }
    }
}

/// Distance (m) below which a length has no direction.
const NO_LENGTH: f64 = rounding::SHARE;

impl Measure {
    /// Whether a couple holds the row instead of forces.
    pub fn is_turn(&self) -> bool {
        matches!(self, Self::Turn(_))
    }

    /// The measured number.
    pub fn value(&self, blocks: &[Block], grips: &[JointGrip], when: When) -> f64 {
        match *self {
            Self::Along(direction) => direction.dot(&separation(blocks, grips, when)),
            Self::Axis(axis) => {
                let axis = turned(axis, blocks, grips, when);
                axis.dot(&separation(blocks, grips, when))
            }
            Self::Distance => separation(blocks, grips, when).norm(),
            Self::Turn(offset) => {
                let turns = grips
                    .iter()
                    .map(|grip| grip.weight * grip.angle(blocks, when));
                offset + turns.sum::<f64>()
            }
        }
    }

    /// The direction of the row's forces: of length one but for a distance over the whole step, whose change it gives,
    /// `|d'| - |d| = (d' + d)·(d' - d) / (|d'| + |d|)`. A turn has `[1, 0]`, of which only the sign counts.
    pub fn direction(&self, blocks: &[Block], grips: &[JointGrip], when: When) -> Vec2 {
        match *self {
            Self::Along(direction) => direction,
            Self::Axis(axis) => turned(axis, blocks, grips, when),
            Self::Distance => {
                let apart = separation(blocks, grips, when);
                let length = match when {
                    When::Start | When::Now => apart.norm(),
                    When::Halfway => {
                        let ends = [When::Start, When::Now];
                        let lengths = ends.map(|end| separation(blocks, grips, end).norm());
                        0.5 * (lengths[0] + lengths[1])
                    }
                };
                if length > NO_LENGTH {
                    apart / length
                } else {
                    Vec2::zeros()
                }
            }
            Self::Turn(_) => Vec2::new(1.0, 0.0),
        }
    }

    /// Rate of the measured number at the beginning of the step by the blocks that count (m/s or rad/s).
    pub fn start_rate(
        &self,
        blocks: &[Block],
        grips: &[JointGrip],
        counts: impl Fn(&Block) -> bool,
    ) -> f64 {
        let when = When::Start;
        let direction = self.direction(blocks, grips, when);
        let common = match self {
            Self::Axis(_) => grips.last().map(|last| last.position(blocks, when)),
            _ => None,
        };
        let counted = grips.iter().filter(|grip| counts(&blocks[grip.block]));
        let rates = counted.map(|grip| match &blocks[grip.block] {
            Block::Rigid(block) => {
                let start = block.start();
                let point = common.unwrap_or_else(|| grip.position(blocks, when));
                let lever = point - start.centre;
                let wrench = unit_wrench(&JointGrip { lever, ..*grip }, direction, self.is_turn());
                let along = wrench[0] * start.velocity.x + wrench[1] * start.velocity.y;
                along + wrench[2] * start.spin
            }
            block => grip.weight * direction.dot(&block.start_velocity(grip.grip())),
        });
        rates.sum()
    }

    /// The direction of the row's forces; its levers are written to the grips.
    pub fn aim(&self, blocks: &[Block], grips: &mut [JointGrip], when: When) -> Vec2 {
        let direction = self.direction(blocks, grips, when);
        let common = match self {
            Self::Axis(_) => grips.last().map(|last| last.position(blocks, when)),
            _ => None,
        };
        if !self.is_turn() {
            for grip in grips {
                let when = match &blocks[grip.block] {
                    Block::Rigid(_) => when,
                    Block::Flex(_) => When::Now,
                };
                let point = common.unwrap_or_else(|| grip.position(blocks, when));
                grip.lever = point - grip.centre(blocks, when);
            }
        }
        direction
    }
}

/// `d = Σ w x` (m).
fn separation(blocks: &[Block], grips: &[JointGrip], when: When) -> Vec2 {
    let terms = grips
        .iter()
        .map(|grip| grip.weight * grip.position(blocks, when));
    terms.sum()
}

fn turned(axis: Vec2, blocks: &[Block], grips: &[JointGrip], when: When) -> Vec2 {
    let angle = grips.first().map_or(0.0, |first| first.angle(blocks, when));
    rotation(angle) * axis
}

/// The force and couple on a rigid block of a unit multiplier at a grip (-, -, m or -).
pub(crate) fn unit_wrench(grip: &JointGrip, direction: Vec2, is_turn: bool) -> [f64; 3] {
    if is_turn {
        return [0.0, 0.0, grip.weight * direction.x];
    }
    let force = grip.weight * direction;
    [force.x, force.y, cross(grip.lever, force)]
}
