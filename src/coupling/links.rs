//! Links of multibodies: solved with as bodies that answer forces by the inverse mass of their multibody, moved by rapier.
//!
//! The coupling is staggered. The flexible stage foresees where a link goes, finds the forces, and leaves the motion to rapier's full
//! step, which is told of them as one force for this step: so momentum is kept, and rapier sees to joints, limits, motors and whatever
//! else the links touch. As every block, a link stores the force at the end of a step, of which `dt - b1` acts in the next: that too is
//! handed on, even if nothing touches the link any more. Links of one multibody answer each other in the next step only. Where `k` that
//! feel each other (unlike the fingers of a fixed hand) are met at once, each answers with `k` times its inverse mass, which is never less
//! than they do together (mass splitting): too small a force is corrected in the next step, too large a one would throw the lighter
//! side away. Forces that last are known for all links, so at rest nothing is scaled.

use super::filter::is_free_body;
use super::gather_settings::GatherSettings;
use super::multibody::{Pace, Tree};
use super::multibody_rows::Foreseen;
use super::reading::{GatherError, is_representable_motion, prescribed_block};
use super::sets::RapierSets;
use super::under_way::Span;
use crate::kkt::Island;
use crate::math::{HashMap, Vec2};
use crate::rapier::prelude::*;
use crate::system::{Block, LinkResponse, RigidBlock, RigidMotion, Step};
use nalgebra::Vector3;

/// Whether a body is a link that forces move.
pub(super) fn is_moving_link(sets: &RapierSets<'_>, handle: RigidBodyHandle) -> bool {
    is_free_body(sets, handle) && sets.multibody_joints.rigid_body_link(handle).is_some()
}

/// A block that stands for a link.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinkBlock {
    /// Its index in the island.
    pub block: usize,
    /// The link.
    pub handle: RigidBodyHandle,
}

/// What the flexible stage does to a link in a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Push {
    /// The link.
    pub handle: RigidBodyHandle,
    /// Impulse of this step's forces (N s, N s, N m s).
    pub impulse: [f64; 3],
    /// Forces that act on in the first part of the next step (N, N, N m).
    pub lasting: [f64; 3],
}

/// What is known of the forces on a link when a step begins.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub(super) struct KnownForces {
    /// Those of the last step's end, which act for a part of this (N, N, N m).
    pub lasting: [f64; 3],
    /// The mean of the last step, as which forces are expected to go on (N, N, N m).
    pub mean: [f64; 3],
}

/// The links of a solved island as they were pushed.
pub(super) fn pushes_of<'a>(
    links: &'a [LinkBlock],
    island: &'a Island,
) -> impl Iterator<Item = Push> + 'a {
    links
        .iter()
        .filter_map(|&LinkBlock { block, handle }| match &island.blocks[block] {
            Block::Rigid(block) => block.link_response().map(|response| Push {
                handle,
                impulse: response.impulse(),
                lasting: response.lasting(),
            }),
            Block::Flex(_) => None,
        })
}

/// Forces on links at the end of the last step, which have a part of themselves left to do in this one.
#[derive(Debug, Default)]
pub(crate) struct LinkMemory {
    pub(super) last: HashMap<RigidBodyHandle, KnownForces>,
}

impl LinkMemory {
    /// Whether nothing is left to do.
    pub fn is_empty(&self) -> bool {
        self.last.is_empty()
    }

    /// The force that acts on a link in the first part of the step (N, N, N m).
    pub fn lasting(&self, handle: RigidBodyHandle) -> [f64; 3] {
        self.known(handle).lasting
    }

    fn known(&self, handle: RigidBodyHandle) -> KnownForces {
        self.last.get(&handle).copied().unwrap_or_default()
    }

    /// Adds the links that nothing touches any more: they still get what the last forces have left.
    pub fn add_left_ones(&self, pushes: &mut Vec<Push>, sets: &RapierSets<'_>) {
        let is_met = |handle: &RigidBodyHandle| {
            let mut pushes = pushes.iter();
            pushes.any(|push| push.handle == *handle)
        };
        let is_awake = |handle| {
            let body = sets.bodies.get(handle);
            body.is_some_and(|body| !body.is_sleeping())
        };
        let left = self.last.keys().filter(|handle| !is_met(handle));
        let mut left: Vec<RigidBodyHandle> = left
            .copied()
            .filter(|&handle| is_moving_link(sets, handle) && is_awake(handle))
            .collect();
        left.sort_unstable_by_key(|handle| handle.into_raw_parts());
        pushes.extend(left.into_iter().map(|handle| Push {
            handle,
            impulse: [0.0; 3],
            lasting: [0.0; 3],
        }));
    }

    /// Keeps what a step that has been taken leaves to the next.
    pub fn keep(&mut self, pushes: &[Push], step: Step, sets: &RapierSets<'_>) {
        // What sleeps is not stepped, and waits.
        let sleeps = |handle| sets.bodies.get(handle).is_some_and(RigidBody::is_sleeping);
        let is_pushed = |handle| pushes.iter().any(|push| push.handle == handle);
        self.last
            .retain(|handle, _| sleeps(*handle) || is_pushed(*handle));
        for push in pushes {
            let before = self.last.remove(&push.handle).unwrap_or_default().lasting;
            let known = KnownForces {
                lasting: push.lasting,
                mean: [0, 1, 2].map(|i| (push.impulse[i] + step.late * before[i]) / step.dt),
            };
            if known != KnownForces::default() {
                self.last.insert(push.handle, known);
            }
        }
    }
}

/// A block that moves as rapier says: given its motion, or for a link answering forces.
pub(super) fn foreign_block(
    handle: RigidBodyHandle,
    settings: &GatherSettings,
    sets: &RapierSets<'_>,
) -> Option<RigidBlock> {
    let Step { dt, weights, .. } = settings.step;
    let block = prescribed_block(sets.bodies.get(handle)?, dt, settings.span);
    if is_moving_link(sets, handle) {
        let start = link_motion(handle, *block.start(), sets);
        Some(RigidBlock::link(start, weights, dt))
    } else {
        Some(block)
    }
}

/// Finds how the links of an island answer forces, all of them being known.
///
/// # Errors
/// If the motion foreseen is not finite.
pub(super) fn foresee_links(
    links: &[LinkBlock],
    step: Step,
    memory: &LinkMemory,
    sets: &RapierSets<'_>,
    island: &mut Island,
) -> Result<(), GatherError> {
    for slot in 0..links.len() {
        let index = multibody_of(links[slot].handle, sets);
        let is_first = !links[..slot]
            .iter()
            .any(|link| multibody_of(link.handle, sets) == index);
        if let Some(index) = index.filter(|_| is_first) {
            let members: Vec<LinkBlock> = links[slot..]
                .iter()
                .copied()
                .filter(|link| multibody_of(link.handle, sets) == Some(index))
                .collect();
            let foreseen = foresee(index, &members, step, memory, sets, island);
            if foreseen.is_none() {
                prescribe(&members, step.dt, sets, island);
            }
        }
    }
    for link in links {
        if let Block::Rigid(block) = &island.blocks[link.block]
            && !(is_representable_motion(&block.drift())
                && block.smooth_end.into_iter().all(f64::is_finite))
        {
            return Err(GatherError::RigidBody(link.handle));
        }
    }
    Ok(())
}

/// A link's motion with the velocity that its joints have: rapier's copy in the body is one substep old.
fn link_motion(handle: RigidBodyHandle, motion: RigidMotion, sets: &RapierSets<'_>) -> RigidMotion {
    let link = sets.multibody_joints.rigid_body_link(handle);
    let multibody =
        link.and_then(|link| Some((link, sets.multibody_joints.get_multibody(link.multibody)?)));
    let Some((link, multibody)) = multibody else {
        return motion;
    };
    let (jacobian, rates) = (
        multibody.body_jacobian(link.id),
        multibody.generalized_velocity(),
    );
    if jacobian.ncols() != rates.len() {
        // Nothing has been stepped yet.
        return motion;
    }
    let along = |axis: usize| {
        let row = jacobian.row(axis);
        let terms = row.iter().zip(rates.iter());
        terms.map(|(j, v)| f64::from(*j) * f64::from(*v)).sum()
    };
    RigidMotion {
        velocity: Vec2::new(along(0), along(1)),
        spin: along(2),
        ..motion
    }
}

fn multibody_of(handle: RigidBodyHandle, sets: &RapierSets<'_>) -> Option<MultibodyIndex> {
    let link = sets.multibody_joints.rigid_body_link(handle);
    link.map(|link| link.multibody)
}

/// Sets the free motion and the answer of one multibody's links; `None` if it has no equations of motion.
fn foresee(
    index: MultibodyIndex,
    members: &[LinkBlock],
    step: Step,
    memory: &LinkMemory,
    sets: &RapierSets<'_>,
    island: &mut Island,
) -> Option<()> {
    let multibody = sets.multibody_joints.get_multibody(index)?;
    let tree = Tree::read(multibody, sets)?;
    let bodies = sets.islands.active_bodies();
    let additional = bodies.filter_map(|handle| sets.bodies.get(handle));
    let additional = additional.map(RigidBody::additional_solver_iterations);
    let pace = Pace::new(
        step.dt,
        sets.integration_parameters,
        additional.max().unwrap_or(0),
    );
    let place = |handle| tree.links.iter().position(|link| link.handle == handle);
    let mut expected = Vec::with_capacity(members.len());
    for member in members {
        expected.push((place(member.handle)?, memory.known(member.handle).mean));
    }
    let Foreseen { motion, answers } = tree.solve(multibody, sets, pace, &expected)?;
    for member in members {
        let link = place(member.handle)?;
        // Without what is expected of the links, whose forces are to be found.
        let mut acceleration = Vector3::from(motion.acceleration(&tree, link));
        let mut late = Vector3::zeros();
        let mut responses = Vec::with_capacity(members.len());
        for other in members {
            let answer = answers.answer(&tree, link, place(other.handle)?);
            let known = memory.known(other.handle);
            acceleration -= answer.velocity * Vector3::from(known.mean);
            late += answer.velocity * Vector3::from(known.lasting);
            responses.push((other.block, answer));
        }
        let (velocity, spin) = tree.velocity(link);
        let start = Vector3::new(velocity.x, velocity.y, spin);
        let gained = step.dt * acceleration + step.late * late;
        let moved = step.dt * (start + pace.share * gained);
        let Block::Rigid(block) = &mut island.blocks[member.block] else {
            continue;
        };
        let start = block.start();
        let free = RigidMotion {
            centre: start.centre + Vec2::new(moved.x, moved.y),
            angle: start.angle + moved.z,
            velocity: velocity + Vec2::new(gained.x, gained.y),
            spin: spin + gained.z,
        };
        let response = LinkResponse::new(member.block, &responses, position_scale(step));
        block.set_link_response(free, acceleration.into(), response);
    }
    Some(())
}

/// What positions answer to a multiplier, over `b0` and their answer to a steady force (-).
fn position_scale(step: Step) -> f64 {
    match step.is_explicit() {
        true => 1.0,
        false => step.dt * step.weights.b1 / step.weights.b0,
    }
}

/// Lets links move as their velocities say.
fn prescribe(members: &[LinkBlock], dt: f64, sets: &RapierSets<'_>, island: &mut Island) {
    for member in members {
        if let Some(body) = sets.bodies.get(member.handle) {
            island.blocks[member.block] = Block::Rigid(prescribed_block(body, dt, Span::WHOLE));
        }
    }
}

#[cfg(test)]
mod tests;
