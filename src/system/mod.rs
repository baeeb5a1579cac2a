//! Blocks: the bodies of an island as the contact solver sees them.
//!
//! A block predicts its free motion, answers how far a force moves it (its compliance) and corrects itself for
//! the multipliers. [`FlexBlock`] has two dofs a node, [`RigidBlock`] three.

mod common_motion;
mod flex;
mod moments;
mod pin_rates;
mod rigid_block;
mod rigid_load;
mod rigid_motion;
mod rigid_way;
#[cfg(test)]
pub(crate) mod samples;
mod step;

pub use common_motion::Hold;
#[cfg(feature = "serde-serialize")]
pub(crate) use flex::ExplicitRecord;
pub use flex::{Balance, FlexBlock};
pub use moments::Moments;
pub use pin_rates::RigidRates;
pub use rigid_block::RigidBlock;
pub use rigid_load::RigidLoad;
pub use rigid_motion::RigidMotion;
pub use rigid_way::RigidWay;
pub use step::{FlexLoad, Response, Step};

use crate::math::{Mat2, Vec2, perp};

/// A material point of a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Point {
    /// A node of a flexible block.
    Node(usize),
    /// A point of a rigid block: its arm from the centre of mass, in body axes (m).
    Arm(Vec2),
}

/// Where a constraint row holds on to a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// The point that is held.
    pub point: Point,
    /// Lever of the force from the block's centre, in world axes, where the row was measured (m).
    ///
    /// It stays what it is while a step iterates: forces whose levers followed every iterate would need their own
    /// stiffness in the system to converge under heavy loads.
    pub lever: Vec2,
}

/// A member of an island.
#[expect(
    clippy::large_enum_variant,
    reason = "rigid blocks are made anew every step and must not allocate"
)]
#[derive(Debug)]
pub enum Block {
    /// A flexible body.
    Flex(Box<FlexBlock>),
    /// A rigid body, free or prescribed.
    Rigid(RigidBlock),
}

impl Block {
    /// Position of a point at the beginning of the step (m).
    pub fn start_position(&self, point: Point) -> Vec2 {
        match (self, point) {
            (Self::Flex(block), Point::Node(node)) => block.start_position(node),
            (Self::Rigid(block), Point::Arm(arm)) => block.start().point(arm),
            _ => mismatch(),
        }
    }

    /// Position of a point at the current iterate of the end of the step (m).
    pub fn position(&self, point: Point) -> Vec2 {
        match (self, point) {
            (Self::Flex(block), Point::Node(node)) => block.position(node),
            (Self::Rigid(block), Point::Arm(arm)) => block.current().point(arm),
            _ => mismatch(),
        }
    }

    /// Displacement of a grip from the beginning of the step to the current iterate (m); for rigid blocks linear in their
    /// dofs, along the lever.
    pub fn displacement(&self, grip: Grip) -> Vec2 {
        match (self, grip.point) {
            (Self::Flex(block), Point::Node(node)) => {
                block.position(node) - block.start_position(node)
            }
            (Self::Rigid(block), Point::Arm(_)) => block.displacement(grip.lever),
            _ => mismatch(),
        }
    }

    /// Velocity of a grip at the current iterate (m/s).
    pub fn velocity(&self, grip: Grip) -> Vec2 {
        match (self, grip.point) {
            (Self::Flex(block), Point::Node(node)) => block.velocity(node),
            (Self::Rigid(block), Point::Arm(_)) => block.velocity(grip.lever),
            _ => mismatch(),
        }
    }

    /// Velocity of a grip at the beginning of the step (m/s).
    pub fn start_velocity(&self, grip: Grip) -> Vec2 {
        match (self, grip.point) {
            (Self::Flex(block), Point::Node(node)) => block.start_velocity(node),
            (Self::Rigid(block), Point::Arm(arm)) => block.start().point_velocity(arm),
            _ => mismatch(),
        }
    }

    /// The same velocity, turned on to where the block is at the iterate (m/s): what meets there came at it, if nothing has changed it since.
    ///
    /// The point that touches in the end was elsewhere as the step began, and a spin led it towards what it had not come to: for as much of a turn
    /// as the step has, that is as much of the spin.
    pub fn approaching_velocity(&self, grip: Grip) -> Vec2 {
        match (self, grip.point) {
            (Self::Flex(block), Point::Node(node)) => block.approaching_velocity(node),
            (Self::Rigid(block), Point::Arm(_)) => {
                // What is moved as it must has the velocity of the way that it goes.
                let moves = match block.is_prescribed() {
                    true => block.current(),
                    false => block.start(),
                };
                moves.velocity + moves.spin * perp(grip.lever)
            }
            _ => mismatch(),
        }
    }

    /// Acceleration of `at` per unit force at `from`, `A⁻¹` between two grips of this block (1/kg).
    ///
    /// A flexible block must have been [prepared](FlexBlock::prepare_compliance) for both nodes.
    pub fn compliance(&self, at: Grip, from: Grip, of: Response) -> Mat2 {
        match (self, at.point, from.point) {
            (Self::Flex(block), Point::Node(node), Point::Node(source)) => {
                block.compliance((node, at.lever), (source, from.lever), of)
            }
            (Self::Rigid(block), Point::Arm(_), Point::Arm(_)) => {
                block.compliance(at.lever, from.lever)
            }
            _ => mismatch(),
        }
    }

    /// Acceleration and that of the turn which a wrench gives to a rigid block (m/s², rad/s²).
    pub fn acceleration_under(&self, wrench: [f64; 3]) -> (Vec2, f64) {
        let Self::Rigid(block) = self else {
            return (Vec2::zeros(), 0.0);
        };
        let [x, y, turn] = block.answer(wrench);
        (Vec2::new(x, y), turn)
    }

    /// What of [`Block::compliance`] of velocities the springs between a surface without mass and the masses give (1/kg).
    pub fn spring_compliance(&self, at: Grip, from: Grip) -> Mat2 {
        match (self, at.point, from.point) {
            (Self::Flex(block), Point::Node(node), Point::Node(source)) => {
                block.spring_compliance(node, source)
            }
            _ => Mat2::zeros(),
        }
    }

    /// Centre of the block at the current iterate: of mass, or what its frame turns about (m).
    pub fn centre(&self) -> Vec2 {
        match self {
            Self::Flex(block) => block.centre(),
            Self::Rigid(block) => block.current().centre,
        }
    }

    /// Angular velocity of the block, or of its frame, at the current iterate (rad/s).
    pub fn spin(&self) -> f64 {
        match self {
            Self::Flex(block) => block.spin(),
            Self::Rigid(block) => block.current().spin,
        }
    }

    /// Mobility `n·M⁻¹·n` of the block at a grip if it were rigid (1/kg).
    pub fn rigid_mobility(&self, grip: Grip, direction: Vec2) -> f64 {
        match (self, grip.point) {
            (Self::Flex(block), Point::Node(node)) => block.rigid_mobility(node, direction),
            (Self::Rigid(block), Point::Arm(_)) => block.rigid_mobility(grip.lever, direction),
            _ => mismatch(),
        }
    }

    /// Sum of the forces of the loads on a block that moves freely (N).
    pub fn resultant(&self) -> Vec2 {
        match self {
            Self::Flex(block) => block.resultant(),
            Self::Rigid(block) => {
                let [x, y, _] = block.force();
                Vec2::new(x, y)
            }
        }
    }

    /// Acceleration of a grip at the end of the step, without hard contact forces, of flexible blocks of small strain with this `share` of its
    /// vibration (m/s²).
    pub fn smooth_acceleration(&self, grip: Grip, share: f64) -> Vec2 {
        match (self, grip.point) {
            (Self::Flex(block), Point::Node(node)) => block.end_acceleration(node, share),
            (Self::Rigid(block), Point::Arm(_)) => block.smooth_acceleration(grip.lever),
            _ => mismatch(),
        }
    }

    /// Whether the block is a flexible one that steps by central difference.
    pub fn is_explicit(&self) -> bool {
        matches!(self, Self::Flex(block) if block.is_explicit())
    }

    /// `dt²/8 a·M a` of an explicit block, with its smooth accelerations at the beginning and at the end of the step (J).
    pub fn swing(&self) -> [f64; 2] {
        match self {
            Self::Flex(block) => block.swing(),
            Self::Rigid(block) => block.swing(),
        }
    }

    /// Whether a point carries no inertia, so that contact there is a quasi-static spring.
    pub fn is_massless(&self, point: Point) -> bool {
        match (self, point) {
            (Self::Flex(block), Point::Node(node)) => block.is_massless(node),
            _ => false,
        }
    }
}

/// A point of the wrong kind is a programming error inside this crate.
#[cold]
fn mismatch() -> ! {
    panic!("a node grips only flexible blocks, an arm only rigid ones")
}
