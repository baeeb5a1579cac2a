//! Motion relative to a rigid one that several blocks have in common.

use super::{Block, RigidBlock, RigidMotion, RigidRates};

/// Whether a block follows forces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// It does.
    Free,
    /// As far as something that rests holds it.
    Held,
    /// It moves as it is told, or by laws of its own.
    Led,
}

impl Block {
    /// Whether the block follows forces.
    pub fn hold(&self) -> Hold {
        match self {
            Self::Flex(block) => block.pinned_hold(),
            Self::Rigid(block) if block.is_prescribed() => Hold::Led,
            Self::Rigid(block) if block.moves_along() == [true; 3] => Hold::Free,
            // What is locked keeps the velocity that it has.
            Self::Rigid(block) if block.is_led() => Hold::Led,
            Self::Rigid(_) => Hold::Held,
        }
    }

    /// Whether the block moves as it is told, whatever pushes it.
    pub fn is_prescribed(&self) -> bool {
        matches!(self, Self::Rigid(block) if block.is_prescribed())
    }

    /// The motion of its frame at the end of the step.
    pub fn frame_motion(&self) -> RigidRates {
        match self {
            Self::Flex(block) => block.frame_motion(),
            Self::Rigid(block) => {
                let motion = block.current();
                RigidRates {
                    about: motion.centre,
                    velocity: motion.velocity,
                    spin: motion.spin,
                }
            }
        }
    }

    /// Kinetic energies of the motion at the end of the step, of the common part of it, and of the rest alone (J).
    pub fn energies_about(&mut self, common: &RigidRates) -> [f64; 3] {
        match self {
            Self::Flex(block) => block.energies_about(common),
            Self::Rigid(block) => rigid_energies(block, common),
        }
    }

    /// Multiplies what the block does beyond the common motion.
    pub fn scale_about(&mut self, common: &RigidRates, scale: f64) {
        match self {
            Self::Flex(block) => block.scale_about(common, scale),
            Self::Rigid(block) => {
                let (own, less) = (*block.current(), scale - 1.0);
                let shared = common.at(own.centre);
                block.add_velocity(
                    less * (own.velocity - shared),
                    less * (own.spin - common.spin),
                );
            }
        }
    }
}

fn rigid_energies(block: &RigidBlock, common: &RigidRates) -> [f64; 3] {
    let own = *block.current();
    let shared = RigidMotion {
        velocity: common.at(own.centre),
        spin: common.spin,
        ..own
    };
    let rest = RigidMotion {
        velocity: own.velocity - shared.velocity,
        spin: own.spin - shared.spin,
        ..own
    };
    [own, shared, rest].map(|motion| block.kinetic_energy(&motion))
}
