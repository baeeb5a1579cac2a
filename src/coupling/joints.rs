//! Rapier's impulse joints as joint rows.
//!
//! Locked axes become bilateral rows, limits one row a side, motors and soft axes springs, coupled axes (ropes, springs) rows of
//! the distance. Softness is natural frequency and damping ratio per mass that the row moves; where it vibrates much faster than
//! steps follow each other, as by default, the axis is rigid. A joint to a fixed or kinematic body holds on to its prescribed motion.

use super::placed::local_centre;
use crate::constraint::joint::{
    JointGrip, JointKey, JointLaw, JointMemory, JointOwner, JointRow, Measure, Spring,
};
use crate::kkt::Island;
use crate::math::{Vec2, atan2, from_rapier, judged::Judged, rounding, sin_cos, wrap_angle};
use crate::rapier::math::Real;
use crate::rapier::prelude::*;
use crate::system::{Block, Point, RigidMotion};

/// Oscillations per step (-) from which a soft axis is rigid: no step of any length resolves them.
const RIGID_FROM: Judged = Judged::new("coupling::RIGID_FROM", 10.0);

/// A force no joint needs: from here on there is no bound (N).
const UNBOUNDED: f64 = 1e30;

/// Range of a limit (m or rad) that leaves no motion.
const NO_RANGE: f64 = rounding::SHARE;

/// Rows of a joint by what they stand for, so that impulses find back; see [`JointKey::row`].
pub(super) mod slot {
    /// A locked axis.
    pub const LOCKED: u32 = 0;
    /// The lower bound of an axis.
    pub const LOWER: u32 = 4;
    /// The upper one.
    pub const UPPER: u32 = 8;
    /// A motor.
    pub const MOTOR: u32 = 12;
    /// Spring and damper of a multibody's coordinate.
    pub const SPRING: u32 = 16;
    /// Friction of a multibody's coordinate.
    pub const FRICTION: u32 = 20;
    /// The first coupling of two coordinates of a multibody.
    pub const COUPLING: u32 = 24;
}

/// Index of the angular axis in rapier's masks and arrays.
pub(super) const ANGULAR: usize = 2;

/// The name of a joint in row keys.
pub(super) fn owner_of(handle: ImpulseJointHandle) -> JointOwner {
    let (index, generation) = handle.0.into_raw_parts();
    JointOwner::Impulse(index, generation)
}

/// Whether rapier holds a joint's locked axes by springs so stiff that they are rows (C.5) at this step length (s).
pub(super) fn is_rigid(joint: &GenericJoint, dt: f64) -> bool {
    f64::from(joint.softness.natural_frequency) * dt >= RIGID_FROM
}

/// One side of a joint: its block, and its frame about the block's centre in body axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    block: usize,
    arm: Vec2,
    angle: f64,
}

impl Side {
    pub fn new(block: usize, body: &RigidBody, frame: &Pose) -> Self {
        Self {
            block,
            arm: from_rapier(frame.translation) - local_centre(body),
            angle: atan2(f64::from(frame.rotation.im), f64::from(frame.rotation.re)),
        }
    }

    /// The block.
    pub fn block(&self) -> usize {
        self.block
    }

    /// The frame's origin about the block's centre (m).
    pub fn arm(&self) -> Vec2 {
        self.arm
    }
}

/// Writes the rows of one joint.
pub(super) struct RowWriter<'a> {
    pub island: &'a mut Island,
    pub memory: &'a JointMemory,
    pub owner: JointOwner,
    pub sides: [Side; 2],
    pub dt: f64,
    /// The angle that the joint of a multibody counted where the step began (rad), by turns too: its axes are rigid, its limits of any width. `None` of an
    /// impulse joint.
    pub counted: Option<f64>,
}

/// What a row measures, before it has grips.
#[derive(Clone, Copy, Debug)]
enum Axis {
    /// World axis.
    World(usize),
    /// Axis of the first frame.
    Frame(usize),
    Distance,
    Turn,
}

impl RowWriter<'_> {
    /// Writes all rows.
    pub fn write(&mut self, data: &GenericJoint) {
        let bits = |mask: JointAxesMask| mask.bits();
        let locked = bits(data.locked_axes);
        let coupled = bits(data.coupled_axes) & bits(JointAxesMask::LIN_AXES);
        let limited = bits(data.limit_axes) & !locked;
        let driven = bits(data.motor_axes) & !locked;
        let has = |mask: u8, axis: usize| mask & (1 << axis) != 0;
        for axis in 0..=ANGULAR {
            let measured = measured_by(axis, data);
            if has(locked, axis) {
                self.lock(axis, measured, data);
            }
            if has(coupled, axis) {
                continue;
            }
            if has(limited, axis) {
                self.limit(axis, measured, &data.limits[axis]);
            }
            if has(driven, axis) {
                self.drive(axis, measured, &data.motors[axis]);
            }
        }
        if coupled != 0 {
            let first = coupled.trailing_zeros() as usize;
            let both = coupled == bits(JointAxesMask::LIN_AXES);
            let measured = if both {
                Axis::Distance
            } else {
                Axis::Frame(first)
            };
            if has(limited, first) {
                // Rapier bounds a distance from above only.
                let bound = f64::from(data.limits[first].max);
                self.push(
                    slot::UPPER,
                    first,
                    measured,
                    -1.0,
                    JointLaw::Limit { bound },
                );
            }
            if driven & coupled != 0 {
                self.drive(first, measured, &data.motors[first]);
            }
        }
    }

    /// Writes one more row along an axis of the joint.
    pub fn add(&mut self, kind: u32, axis: usize, law: JointLaw, data: &GenericJoint) {
        self.push(kind, axis, measured_by(axis, data), 1.0, law);
    }

    fn lock(&mut self, axis: usize, measured: Axis, data: &GenericJoint) {
        let law = if self.counted.is_some() || is_rigid(data, self.dt) {
            JointLaw::Rigid {
                goal: 0.0,
                rate: 0.0,
            }
        } else {
            let frequency = f64::from(data.softness.natural_frequency);
            let ratio = f64::from(data.softness.damping_ratio);
            let angular = std::f64::consts::TAU * frequency;
            JointLaw::Spring(Spring {
                stiffness: angular * angular,
                damping: 2.0 * ratio * angular,
                rest: 0.0,
                rate: 0.0,
                most: f64::INFINITY,
                is_relative: true,
            })
        };
        self.push(slot::LOCKED, axis, measured, 1.0, law);
    }

    fn limit(&mut self, axis: usize, measured: Axis, limits: &JointLimits<Real>) {
        let (mut low, mut high) = (f64::from(limits.min), f64::from(limits.max));
        if axis == ANGULAR && self.counted.is_none() {
            let half = 0.5 * (high - low);
            // No angle tells a range wider than a turn from none.
            if half.is_nan() || half >= std::f64::consts::PI {
                return;
            }
            // Measured about the middle of the range.
            let middle = 0.5 * (low + high);
            let off = wrap_angle(self.turn() - middle);
            low = self.turn() - off - half;
            high = low + 2.0 * half;
        }
        if high - low <= NO_RANGE {
            let goal = 0.5 * (low + high);
            let law = JointLaw::Rigid { goal, rate: 0.0 };
            self.push(slot::LOWER, axis, measured, 1.0, law);
            return;
        }
        if low > -UNBOUNDED {
            self.push(
                slot::LOWER,
                axis,
                measured,
                1.0,
                JointLaw::Limit { bound: low },
            );
        }
        if high < UNBOUNDED {
            self.push(
                slot::UPPER,
                axis,
                measured,
                -1.0,
                JointLaw::Limit { bound: high },
            );
        }
    }

    fn drive(&mut self, axis: usize, measured: Axis, motor: &JointMotor) {
        let most = f64::from(motor.max_force);
        let most = if most < UNBOUNDED {
            most
        } else {
            f64::INFINITY
        };
        let (stiffness, damping) = (f64::from(motor.stiffness), f64::from(motor.damping));
        let rate = f64::from(motor.target_vel);
        let mut rest = f64::from(motor.target_pos);
        if axis == ANGULAR && self.counted.is_none() {
            rest = self.turn() - wrap_angle(self.turn() - rest);
        }
        let law = if stiffness == 0.0 && damping == 0.0 {
            JointLaw::Drive { rate, most }
        } else {
            JointLaw::Spring(Spring {
                stiffness,
                damping,
                rest,
                rate,
                most,
                is_relative: motor.model == MotorModel::AccelerationBased,
            })
        };
        self.push(slot::MOTOR, axis, measured, 1.0, law);
    }

    /// Angle of the second frame from the first at the beginning of the step, in (-π, π] where no turns are counted (rad).
    fn turn(&self) -> f64 {
        let [first, second] = self.sides;
        let angle = |side: Side| self.motion(side.block).angle + side.angle;
        let shown = angle(second) - angle(first);
        match self.counted {
            None => wrap_angle(shown),
            Some(counted) => counted + wrap_angle(shown - counted),
        }
    }

    /// By how much the turn is more than what the angles of the bodies make (rad).
    pub fn offset(&self) -> f64 {
        let [first, second] = self.sides;
        self.turn() - (self.motion(second.block).angle - self.motion(first.block).angle)
    }

    fn motion(&self, block: usize) -> RigidMotion {
        match &self.island.blocks[block] {
            Block::Rigid(block) => *block.start(),
            Block::Flex(_) => RigidMotion::default(),
        }
    }

    fn push(&mut self, kind: u32, axis: usize, measured: Axis, sign: f64, law: JointLaw) {
        let [first, second] = self.sides;
        let unit = |axis: usize| {
            let (sin, cos) = sin_cos(first.angle);
            if axis == 0 {
                Vec2::new(cos, sin)
            } else {
                Vec2::new(-sin, cos)
            }
        };
        let measure = match measured {
            Axis::World(0) => Measure::Along(Vec2::x()),
            Axis::World(_) => Measure::Along(Vec2::y()),
            Axis::Frame(axis) => Measure::Axis(unit(axis)),
            Axis::Distance => Measure::Distance,
            Axis::Turn => Measure::Turn(self.offset()),
        };
        let start = self.island.joints.grips.len();
        for (side, weight) in [(first, -1.0), (second, 1.0)] {
            let grip = JointGrip::new(side.block, Point::Arm(side.arm), weight);
            self.island.joints.grips.push(grip);
        }
        let key = JointKey {
            owner: self.owner,
            row: kind + axis as u32,
        };
        self.island.joints.rows.push(JointRow {
            key,
            measure,
            sign,
            grips: (start, start + 2),
            law,
            remembered: self.memory.recall(&key),
        });
    }
}

/// What the number along an axis of a joint is.
fn measured_by(axis: usize, data: &GenericJoint) -> Axis {
    match axis {
        ANGULAR => Axis::Turn,
        _ if data.locked_axes.contains(JointAxesMask::LIN_AXES) => Axis::World(axis),
        _ => Axis::Frame(axis),
    }
}

/// Whether all numbers of a joint that take part are finite.
pub(super) fn is_representable_joint(data: &GenericJoint) -> bool {
    let frames = [data.local_frame1, data.local_frame2];
    let frames = frames.iter().flat_map(|frame| {
        let (at, turn) = (frame.translation, frame.rotation);
        [at.x, at.y, turn.re, turn.im]
    });
    let softness = [data.softness.natural_frequency, data.softness.damping_ratio];
    let axes = 0..=ANGULAR;
    let motors = axes
        .filter(|axis| data.motor_axes.bits() & (1 << axis) != 0)
        .flat_map(|axis| {
            let motor = &data.motors[axis];
            [
                motor.target_pos,
                motor.target_vel,
                motor.stiffness,
                motor.damping,
            ]
        });
    frames
        .chain(softness)
        .chain(motors)
        .all(|value| value.is_finite())
}
