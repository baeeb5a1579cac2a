//! Motion relative to a rigid one that several blocks have in common.

use super::{Block, FlexBlock, RigidBlock, RigidMotion, RigidRates};
use crate::body::Frame;
use crate::math::{add_node_vec, node_vec};

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
            Self::Flex(block) => hold_of_pins(block),
            Self::Rigid(block) if block.is_driven() => Hold::Led,
            Self::Rigid(block) if block.moves_along().iter().all(|moves| *moves) => Hold::Free,
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
            Self::Flex(block) => RigidRates {
                about: block.frame.centre,
                velocity: block.frame.velocity,
                spin: block.frame.spin,
            },
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
            Self::Flex(block) => flexible_energies(block, common),
            Self::Rigid(block) => rigid_energies(block, common),
        }
    }

    /// Multiplies what the block does beyond the common motion.
    pub fn scale_about(&mut self, common: &RigidRates, scale: f64) {
        match self {
            Self::Flex(block) => scale_flexible(block, common, scale),
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

fn hold_of_pins(block: &FlexBlock) -> Hold {
    let is_moved = |dof: &usize| block.position[*dof] != block.start_position[*dof];
    if block.is_explicit() || block.fixed_dofs.iter().any(is_moved) {
        return Hold::Led;
    }
    match block.fixed_dofs.is_empty() {
        true => Hold::Free,
        false => Hold::Held,
    }
}

fn flexible_energies(block: &mut FlexBlock, common: &RigidRates) -> [f64; 3] {
    let mass = block.model.mass();
    let whole = 0.5 * mass.inner(&block.velocity, &block.velocity);
    for node in 0..block.model.n_nodes() {
        let shared = common.at(node_vec(&block.position, node));
        block.local[2 * node] = shared.x;
        block.local[2 * node + 1] = shared.y;
    }
    let shared = 0.5 * mass.inner(&block.local, &block.local);
    for (own, velocity) in block.local.iter_mut().zip(&block.velocity) {
        *own = velocity - *own;
    }
    [whole, shared, 0.5 * mass.inner(&block.local, &block.local)]
}

fn scale_flexible(block: &mut FlexBlock, common: &RigidRates, scale: f64) {
    let less = scale - 1.0;
    for node in 0..block.model.n_nodes() {
        let place = node_vec(&block.position, node);
        let change = less * (node_vec(&block.velocity, node) - common.at(place));
        add_node_vec(&mut block.velocity, node, change);
        if let Some(large) = &mut block.large {
            add_node_vec(&mut large.resolved, node, change);
        }
    }
    if block.kind == Frame::Free {
        block.frame.velocity += less * (block.frame.velocity - common.at(block.frame.centre));
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
