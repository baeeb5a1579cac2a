//! What a block weighs in the balance of momentum of bodies that touch.

use super::Block;
use crate::math::Vec2;

/// Mass and momentum of a free block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// Mass (kg).
    pub mass: f64,
    /// Centre of mass (m).
    pub centre: Vec2,
    /// Its velocity (m/s).
    pub velocity: Vec2,
    /// Angular momentum about the centre (N m s).
    pub spin_momentum: f64,
    /// Inertia about the centre (kg m²).
    pub inertia: f64,
}

impl Block {
    /// The acceleration that applied forces give a free block everywhere alike (m/s²); `None` if something holds, damps or
    /// turns it.
    pub fn uniform_acceleration(&self) -> Option<Vec2> {
        match self {
            Self::Flex(block) => block.uniform_acceleration(),
            Self::Rigid(block) => {
                let [x, y, torque] = block.force();
                let mass = block.mass();
                let is_free = block.moves_freely() && torque == 0.0;
                is_free.then(|| Vec2::new(x / mass[0], y / mass[1]))
            }
        }
    }

    /// The acceleration that applied forces give the block as a whole where contacts and joints leave it alone (m/s²); zero if pins hold it.
    pub fn drive(&self) -> Vec2 {
        match self {
            Self::Flex(block) => block.drive(),
            Self::Rigid(block) => {
                let [x, y, _] = block.drive();
                Vec2::new(x, y)
            }
        }
    }

    /// Moments of a free block at the beginning of the step.
    pub fn start_moments(&self) -> Moments {
        match self {
            Self::Flex(block) => block.start_moments(),
            Self::Rigid(block) => {
                let ([mass, _, inertia], start) = (block.mass(), block.start());
                Moments {
                    mass,
                    centre: start.centre,
                    velocity: start.velocity,
                    spin_momentum: inertia * start.spin,
                    inertia,
                }
            }
        }
    }

    /// Moments of a free block at the end of the step.
    pub fn end_moments(&self) -> Moments {
        match self {
            Self::Flex(block) => block.end_moments(),
            Self::Rigid(block) => {
                let ([mass, _, inertia], end) = (block.mass(), block.current());
                Moments {
                    mass,
                    centre: end.centre,
                    velocity: end.velocity,
                    spin_momentum: inertia * end.spin,
                    inertia,
                }
            }
        }
    }

    /// Adds a rigid motion about the centre to the end velocity (m/s, rad/s).
    pub fn add_rigid_velocity(&mut self, velocity: Vec2, spin: f64) {
        match self {
            Self::Flex(block) => block.add_rigid_velocity(velocity, spin),
            Self::Rigid(block) => block.add_velocity(velocity, spin),
        }
    }
}
