//! Landing links: rapier's full step moves the coordinates of claimed multibodies to where their links were solved to be.
//!
//! A coordinate that only the user moves goes on at its rate, whatever acts. For the step all are such, and motors, limits, friction and couplings are
//! taken out, for rapier solves them in coordinates that move freely. Afterwards all is given back, and the rates are those of the links' velocities.

use super::hand_back::{LANDED, put};
use super::landing::Landing;
use super::multibody::{ANGULAR, free_axes};
use super::placed::pose_after;
use super::sets::RapierSets;
use super::shapes::pose_of;
use crate::math::{HashMap, HashSet, Vec2, atan2, from_rapier, perp, wrap_angle};
use crate::rapier::math::Real;
use crate::rapier::prelude::*;
use crate::system::RigidMotion;

/// What is lent of the multibodies of a step.
#[derive(Debug, Default)]
pub(super) struct LentMultibodies {
    all: Vec<Lent>,
}

/// What is lent of a multibody: all of it by links, for rapier may give its root other coordinates.
#[derive(Debug)]
struct Lent {
    index: MultibodyIndex,
    links: Vec<LentLink>,
    couplings: Vec<MultibodyDofCoupling>,
}

/// What is lent of a link's joint.
#[derive(Debug)]
struct LentLink {
    kinematic: bool,
    motors: JointAxesMask,
    limits: JointAxesMask,
    /// Friction of its free axes, and the rates at which the user moves them.
    frictions: [Real; 3],
    rates: [Real; 3],
}

/// Where the links of the landings end.
type Ends = HashMap<RigidBodyHandle, RigidMotion>;

impl LentMultibodies {
    /// Lets the multibodies of claimed links move to where these end.
    pub fn lead(&mut self, landings: &[Landing], sets: &mut RapierSets<'_>) {
        let ends = ends_of(landings, sets.multibody_joints);
        let mut known = HashSet::default();
        for landing in landings {
            let link = sets.multibody_joints.rigid_body_link(landing.handle);
            let index = link.map(|link| link.multibody);
            let Some(index) = index.filter(|index| known.insert(*index)) else {
                continue;
            };
            if let Some(multibody) = sets.multibody_joints.get_multibody_mut_internal(index) {
                // As rapier does when its step begins: then the coordinates are those it will have.
                multibody.forward_kinematics(sets.bodies, true);
                let dt = sets.integration_parameters.dt;
                let ways = ways_to(multibody, &ends, sets.bodies);
                self.all.push(lend(index, multibody));
                let mut rates = multibody.generalized_velocity_mut();
                for (rate, way) in rates.iter_mut().zip(ways) {
                    *rate = way / dt;
                }
            }
        }
    }

    /// Puts everything back, to the last bit.
    pub fn give_back(&mut self, joints: &mut MultibodyJointSet) {
        for lent in self.all.drain(..) {
            let Some(multibody) = joints.get_multibody_mut_internal(lent.index) else {
                continue;
            };
            for (id, one) in lent.links.iter().enumerate() {
                let Some(link) = multibody.link_mut(id) else {
                    continue;
                };
                link.joint.kinematic = one.kinematic;
                link.joint.data.motor_axes = one.motors;
                link.joint.data.limit_axes = one.limits;
                let axes: Vec<_> = free_axes(link).collect();
                for (axis, place) in axes {
                    multibody.frictions_mut()[place] = one.frictions[axis];
                    if one.kinematic {
                        multibody.generalized_velocity_mut()[place] = one.rates[axis];
                    }
                }
            }
            for coupling in lent.couplings {
                multibody.add_dof_coupling(coupling);
            }
        }
    }

    /// Puts the coordinates where the links end, and the links' bodies where their coordinates are, as far as rapier's step has not.
    ///
    /// Rapier 0.36 moves a multibody of which a kinematic root is awake twice. Its continuous collision detection stops bodies and not their coordinates,
    /// which count in the next step.
    pub fn place(&self, landings: &[Landing], sets: &mut RapierSets<'_>) {
        if self.all.is_empty() {
            return;
        }
        let ends = ends_of(landings, sets.multibody_joints);
        for lent in &self.all {
            let Some(multibody) = sets.multibody_joints.get_multibody_mut_internal(lent.index)
            else {
                continue;
            };
            let is_asleep = |link: &MultibodyLink| {
                let body = sets.bodies.get(link.rigid_body_handle());
                body.is_some_and(|body| body.is_dynamic() && body.is_sleeping())
            };
            // What rapier has just put to sleep stays where it is.
            if multibody.links().any(is_asleep) {
                continue;
            }
            let ways = ways_to(multibody, &ends, sets.bodies);
            let sizes = multibody.links().flat_map(|link| {
                let [x, y, angle] = <[Real; 3]>::from(link.joint().coords());
                let at = link.local_to_world().translation;
                [x, y, angle, at.x, at.y]
            });
            let size = sizes.fold(1.0, |size: Real, x| size.max(x.abs()));
            let rounding = LANDED as Real * Real::EPSILON * size;
            if ways.iter().any(|way| way.abs() > rounding) {
                multibody.apply_displacements(&ways);
                multibody.forward_kinematics(sets.bodies, false);
            }
            let poses: Vec<_> = multibody
                .links()
                .map(|link| (link.rigid_body_handle(), *link.local_to_world()))
                .collect();
            for (handle, pose) in poses {
                let body = sets.bodies.get(handle);
                let is_elsewhere =
                    |body: &&RigidBody| body.is_dynamic() && *body.position() != pose;
                if body.filter(is_elsewhere).is_some() {
                    put(handle, pose, sets);
                }
            }
        }
    }

    /// Gives the coordinates the rates that go with the velocities of the bodies.
    pub fn land(&self, sets: &mut RapierSets<'_>) {
        for lent in &self.all {
            let joints = &mut *sets.multibody_joints;
            if let Some(multibody) = joints.get_multibody_mut_internal(lent.index) {
                let rates = rates_of(multibody, sets.bodies);
                let mut known = multibody.generalized_velocity_mut();
                known
                    .iter_mut()
                    .zip(rates)
                    .for_each(|(known, rate)| *known = rate);
            }
        }
    }
}

fn ends_of(landings: &[Landing], joints: &MultibodyJointSet) -> Ends {
    let links = landings
        .iter()
        .filter(|landing| joints.rigid_body_link(landing.handle).is_some());
    links
        .map(|landing| (landing.handle, landing.motion))
        .collect()
}

fn lend(index: MultibodyIndex, multibody: &mut Multibody) -> Lent {
    let mut links = Vec::with_capacity(multibody.num_links());
    for id in 0..multibody.num_links() {
        let Some(link) = multibody.link(id) else {
            continue;
        };
        let mut one = LentLink {
            kinematic: link.joint().kinematic,
            motors: link.joint().data.motor_axes,
            limits: link.joint().data.limit_axes,
            frictions: [0.0; 3],
            rates: [0.0; 3],
        };
        let axes: Vec<_> = free_axes(link).collect();
        for (axis, place) in axes {
            one.frictions[axis] = std::mem::take(&mut multibody.frictions_mut()[place]);
            one.rates[axis] = multibody.generalized_velocity()[place];
        }
        links.push(one);
        if let Some(link) = multibody.link_mut(id) {
            link.joint.kinematic = true;
            link.joint.data.motor_axes = JointAxesMask::empty();
            link.joint.data.limit_axes = JointAxesMask::empty();
        }
    }
    let couplings = multibody.couplings().to_vec();
    multibody.clear_dof_couplings();
    Lent {
        index,
        links,
        couplings,
    }
}

/// How far each coordinate has to go for the links to be where they end (m or rad).
fn ways_to(multibody: &Multibody, ends: &Ends, bodies: &RigidBodySet) -> Vec<Real> {
    let mut ways = vec![0.0; multibody.ndofs()];
    let end_of = |link: &MultibodyLink| {
        let handle = link.rigid_body_handle();
        let body = bodies.get(handle);
        match (ends.get(&handle), body) {
            (Some(end), Some(body)) => pose_after(body, end),
            // What was not solved for is where rapier takes it to be.
            _ => pose_of(link.local_to_world()),
        }
    };
    for link in multibody.links() {
        let joint = link.joint();
        let parent = link.parent_id().and_then(|parent| multibody.link(parent));
        let [first, second] = [joint.data.local_frame1, joint.data.local_frame2];
        let own = end_of(link).place(&pose_of(&second));
        let base = parent.map(|parent| end_of(parent).place(&pose_of(&first)));
        let relative = base.map_or(own, |base| own.relative_to(&base));
        let coordinates = joint.coords();
        for (axis, place) in free_axes(link) {
            let known = f64::from(coordinates[axis]);
            ways[place] = match axis {
                ANGULAR => wrap_angle(atan2(relative.sin, relative.cos) - known),
                axis => relative.translation[axis] - known,
            } as Real;
        }
    }
    ways
}

/// The rates of the coordinates that give the links the velocities which their bodies have.
fn rates_of(multibody: &Multibody, bodies: &RigidBodySet) -> Vec<Real> {
    let mut rates = vec![0.0; multibody.ndofs()];
    for link in multibody.links() {
        let Some(body) = bodies.get(link.rigid_body_handle()) else {
            continue;
        };
        let (mut velocity, mut spin) = (from_rapier(body.linvel()), f64::from(body.angvel()));
        let mut axes = [Vec2::x(), Vec2::y()];
        let parent = link.parent_id().and_then(|parent| multibody.link(parent));
        if let Some(parent) = parent {
            let data = &link.joint().data;
            let at = pose_of(link.local_to_world())
                .transform(from_rapier(data.local_frame2.translation));
            velocity += spin * perp(at - from_rapier(body.center_of_mass()));
            let other = bodies.get(parent.rigid_body_handle());
            // Rapier's links hang on to what stands still where their root is not dynamic.
            if let Some(other) = other.filter(|other| other.is_dynamic()) {
                let lever = at - from_rapier(other.center_of_mass());
                velocity -= from_rapier(other.linvel()) + f64::from(other.angvel()) * perp(lever);
                spin -= f64::from(other.angvel());
            }
            let frame = pose_of(parent.local_to_world()).place(&pose_of(&data.local_frame1));
            axes = axes.map(|axis| frame.rotate(axis));
        }
        for (axis, place) in free_axes(link) {
            rates[place] = match axis {
                ANGULAR => spin,
                axis => axes[axis].dot(&velocity),
            } as Real;
        }
    }
    rates
}
