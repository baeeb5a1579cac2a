//! A multibody as the flexible stage foresees it: `M̃ Δv = dt (Q - C) + Jᵀ P` in its joint coordinates.
//!
//! `Q` are the user's forces, gravity, joint springs, motors and damping; `C` the terms of velocity products. What resists at once
//! is implicit: a row `g` of stiffness `k` (a spring, a motor, a limit or a contact with what does not move) adds `c dt² k g gᵀ` to the
//! mass, because rapier, which integrates in `n` substeps, moves `c dt Δv` with `c = (n + 1) / 2n` where forces are steady.
//! All is reckoned anew, in `f64`, from poses and joint velocities: rapier's own matrices are those of its last substep.

mod equations;

pub(super) use self::equations::{Equations, Pace, Solved};
use super::reading::link_weight_of;
use super::sets::RapierSets;
use super::shapes::pose_of;
use crate::math::{Vec2, cross, from_rapier, perp};
use crate::rapier::prelude::*;

/// A link and what acts on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    pub handle: RigidBodyHandle,
    parent: Option<usize>,
    pub centre: Vec2,
    velocity: Vec2,
    spin: f64,
    /// Acceleration of the centre with steady joint velocities (m/s²).
    steady: Vec2,
    /// Mass along both axes and inertia; rapier leaves out what the body's own locks hold (kg, kg, kg m²).
    inertias: [f64; 3],
    force: [f64; 3],
}

/// One joint coordinate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dof {
    /// The link that it moves against its parent, and the axis of its joint.
    pub link: usize,
    pub axis: usize,
    motion: Motion,
    /// Its value and rate (m or rad, and per second).
    pub value: f64,
    pub rate: f64,
    damping: f64,
    armature: f64,
    /// Whether the user alone says how it moves.
    is_driven: bool,
}

/// How a coordinate moves its link and all beyond.
#[derive(Clone, Copy, Debug)]
enum Motion {
    Slide(Vec2),
    TurnAbout(Vec2),
}

/// A multibody before its equations are set up.
#[derive(Clone, Debug, Default)]
pub(super) struct Tree {
    pub links: Vec<Link>,
    pub dofs: Vec<Dof>,
}

impl Tree {
    /// Reads a multibody; `None` if its bodies are not all there.
    pub fn read(multibody: &Multibody, sets: &RapierSets<'_>) -> Option<Self> {
        let mut tree = Self::default();
        for link in multibody.links() {
            let handle = link.rigid_body_handle();
            let body = sets.bodies.get(handle)?;
            let parent = link.parent_id().filter(|_| !link.is_root());
            tree.add_dofs(multibody, link, parent, sets)?;
            let is_free = body.is_dynamic();
            let (inertias, force) = if is_free {
                link_weight_of(body, from_rapier(sets.gravity))
            } else {
                <([f64; 3], [f64; 3])>::default()
            };
            tree.links.push(Link {
                handle,
                parent,
                centre: from_rapier(body.center_of_mass()),
                velocity: Vec2::zeros(),
                spin: 0.0,
                steady: Vec2::zeros(),
                inertias,
                force,
            });
        }
        tree.find_velocities(sets);
        Some(tree)
    }

    fn add_dofs(
        &mut self,
        multibody: &Multibody,
        link: &MultibodyLink,
        parent: Option<usize>,
        sets: &RapierSets<'_>,
    ) -> Option<()> {
        let (joint, own) = (link.joint(), self.links.len());
        let body = sets.bodies.get(link.rigid_body_handle())?;
        if parent.is_none() && !body.is_dynamic() {
            return Some(());
        }
        let frame = match parent {
            Some(parent) => {
                let above = sets.bodies.get(self.links[parent].handle)?;
                pose_of(&(*above.position() * joint.data.local_frame1))
            }
            None => pose_of(&Pose::IDENTITY),
        };
        // A root turns about its centre of mass, every other link about the joint.
        let pivot = match parent {
            Some(_) => pose_of(&(*body.position() * joint.data.local_frame2)).translation,
            None => from_rapier(body.center_of_mass()),
        };
        let axes = [Vec2::x(), Vec2::y()].map(|axis| Motion::Slide(frame.rotate(axis)));
        let motions = [axes[0], axes[1], Motion::TurnAbout(pivot)];
        let mut index = link.assembly_id();
        for (axis, motion) in motions.into_iter().enumerate() {
            if joint.data.locked_axes.bits() >> axis & 1 == 1 {
                continue;
            }
            let entry = |vector: &nalgebra::DVector<crate::rapier::math::Real>| {
                vector.get(index).copied().map_or(0.0, f64::from)
            };
            let rates = multibody.generalized_velocity();
            self.dofs.push(Dof {
                link: own,
                axis,
                motion,
                value: f64::from(joint.coords()[axis]),
                rate: rates.get(index).copied().map_or(0.0, f64::from),
                damping: entry(multibody.damping()),
                armature: entry(multibody.armature()),
                is_driven: joint.kinematic,
            });
            index += 1;
        }
        Some(())
    }

    /// Velocities of the links, and their accelerations while joint velocities are steady.
    fn find_velocities(&mut self, sets: &RapierSets<'_>) {
        for index in 0..self.links.len() {
            let (mut velocity, mut spin) = (Vec2::zeros(), 0.0);
            for dof in &self.dofs {
                if let Some([x, y, turn]) = self.column(dof, index) {
                    velocity += dof.rate * Vec2::new(x, y);
                    spin += dof.rate * turn;
                }
            }
            let link = &mut self.links[index];
            (link.velocity, link.spin) = (velocity, spin);
            let body = sets.bodies.get(link.handle);
            if link.parent.is_none()
                && let Some(body) = body.filter(|body| !body.is_dynamic())
            {
                (link.velocity, link.spin) = (from_rapier(body.linvel()), f64::from(body.angvel()));
            }
        }
        for index in 0..self.links.len() {
            let Some(parent) = self.links[index].parent else {
                continue;
            };
            let (own, above) = (self.links[index], self.links[parent]);
            let turns =
                |dof: &&Dof| dof.link == index && matches!(dof.motion, Motion::TurnAbout(_));
            // Where the joint turns, or for rails anywhere: there both turn alike.
            let pivot = match self.dofs.iter().find(turns).map(|dof| dof.motion) {
                Some(Motion::TurnAbout(pivot)) => pivot,
                _ => own.centre,
            };
            let sliding: Vec2 = self.sliding(index);
            self.links[index].steady = above.steady + 2.0 * above.spin * perp(sliding)
                - above.spin * above.spin * (pivot - above.centre)
                - own.spin * own.spin * (own.centre - pivot);
        }
    }

    /// Velocity of a link along its own rails (m/s).
    fn sliding(&self, link: usize) -> Vec2 {
        let own = self.dofs.iter().filter(|dof| dof.link == link);
        own.map(|dof| match dof.motion {
            Motion::Slide(axis) => dof.rate * axis,
            Motion::TurnAbout(_) => Vec2::zeros(),
        })
        .sum()
    }

    /// How a link's centre and angle move with a coordinate, `None` if they do not.
    fn column(&self, dof: &Dof, link: usize) -> Option<[f64; 3]> {
        let mut at = Some(link);
        while at.is_some_and(|at| at != dof.link) {
            at = self.links[at?].parent;
        }
        at?;
        Some(match dof.motion {
            Motion::Slide(axis) => [axis.x, axis.y, 0.0],
            Motion::TurnAbout(pivot) => {
                let lever = perp(self.links[link].centre - pivot);
                [lever.x, lever.y, 1.0]
            }
        })
    }

    /// `Jᵀ f` of a wrench on a link, for every coordinate that moves freely.
    pub fn pull_back(&self, link: usize, [x, y, turn]: [f64; 3]) -> Vec<f64> {
        let part = |dof: &Dof| {
            let column = self.column(dof, link).unwrap_or_default();
            column[0] * x + column[1] * y + column[2] * turn
        };
        self.free_dofs().map(part).collect()
    }

    pub fn free_dofs(&self) -> impl Iterator<Item = &Dof> {
        self.dofs.iter().filter(|dof| !dof.is_driven)
    }

    /// The row that measures one coordinate, `None` if the user drives it.
    pub fn row_of(&self, index: usize) -> Option<Vec<f64>> {
        let mut row = vec![0.0; self.free_dofs().count()];
        let before = self.dofs[..index]
            .iter()
            .filter(|dof| !dof.is_driven)
            .count();
        (!self.dofs[index].is_driven).then(|| {
            row[before] = 1.0;
            row
        })
    }

    /// Sets up the equations of motion without any row.
    pub fn equations(&self, pace: Pace) -> Equations {
        let n = self.free_dofs().count();
        let mut equations = Equations {
            mass: vec![0.0; n * n],
            force: vec![0.0; n],
            rates: self.free_dofs().map(|dof| dof.rate).collect(),
            pace,
        };
        for index in 0..self.links.len() {
            let link = self.links[index];
            let columns: Vec<Option<[f64; 3]>> = self
                .free_dofs()
                .map(|dof| self.column(dof, index))
                .collect();
            let inertias = link.inertias;
            let acting = [
                link.force[0] - inertias[0] * link.steady.x,
                link.force[1] - inertias[1] * link.steady.y,
                link.force[2],
            ];
            for (a, one) in columns.iter().enumerate() {
                let Some(one) = one else {
                    continue;
                };
                equations.force[a] += (0..3).map(|i| one[i] * acting[i]).sum::<f64>();
                for (b, other) in columns.iter().enumerate() {
                    if let Some(other) = other {
                        let term: f64 = (0..3).map(|i| one[i] * inertias[i] * other[i]).sum();
                        equations.mass[a * n + b] += term;
                    }
                }
            }
        }
        for (index, dof) in self.free_dofs().enumerate() {
            equations.mass[index * n + index] += dof.armature + pace.dt * dof.damping;
            equations.force[index] -= dof.damping * dof.rate;
        }
        equations
    }

    /// Acceleration of a link under generalized ones (m/s², rad/s²).
    fn acceleration(&self, link: usize, generalized: &[f64]) -> [f64; 3] {
        let steady = self.links[link].steady;
        let mut sum = [steady.x, steady.y, 0.0];
        for (dof, acceleration) in self.free_dofs().zip(generalized) {
            let column = self.column(dof, link).unwrap_or_default();
            for (sum, part) in sum.iter_mut().zip(column) {
                *sum += acceleration * part;
            }
        }
        sum
    }

    /// Velocity of a link's centre and its spin (m/s, rad/s).
    pub fn velocity(&self, link: usize) -> (Vec2, f64) {
        (self.links[link].velocity, self.links[link].spin)
    }

    /// The row of a point's velocity along a direction.
    pub fn point_row(&self, link: usize, point: Vec2, along: Vec2) -> Vec<f64> {
        let lever = point - self.links[link].centre;
        self.pull_back(link, [along.x, along.y, cross(lever, along)])
    }
}
