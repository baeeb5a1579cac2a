//! What resists the motion of a multibody at once: springs, motors, limits, and contacts with what does not move.

use super::multibody::{Equations, Pace, Solved, Tree};
use super::reading::DOMINATED;
use super::sets::RapierSets;
use crate::math::{Vec2, from_rapier, judged::Judged, perp};
use crate::rapier::prelude::*;

/// Stiffness of what gives no way, in multiples of the mass that it holds over `c dt²`: as much as outweighs all that is felt.
fn held() -> f64 {
    1.0 / DOMINATED.get()
}

/// Share of the friction there may be below which a contact sticks.
const STICKS: Judged = Judged::new("coupling::STICKS", 0.99);

/// How a multibody will move, and what it answers to more forces.
#[derive(Clone, Debug)]
pub(super) struct Foreseen {
    pub motion: Solved,
    pub answers: Solved,
}

/// What is known when limits and contacts are looked at.
struct Holding<'a> {
    /// What resists but for the motors, and with them.
    bare: Solved,
    driven: Solved,
    /// How forces that go on acting move the coordinates.
    pressed: Vec<f64>,
    forces: &'a [(usize, [f64; 3])],
    moving: Equations,
    answering: Equations,
}

impl Holding<'_> {
    /// Holds a limit of a row that has it in the sense of `sign`.
    fn hold_limit(&mut self, row: &[f64], sign: f64, add: impl Fn(&mut Equations)) {
        let along: f64 = row.iter().zip(&self.pressed).map(|(g, x)| g * x).sum();
        self.hold(sign * along > 0.0, add);
    }

    /// Holds a row of a contact of a link, whose normal points to what it presses.
    fn hold_contact(&mut self, link: usize, normal: Vec2, add: impl Fn(&mut Equations)) {
        let own = self.forces.iter().filter(|(pushed, _)| *pushed == link);
        let along: f64 = own
            .map(|(_, [x, y, _])| normal.dot(&Vec2::new(*x, *y)))
            .sum();
        self.hold(along > 0.0, add);
    }

    fn hold(&mut self, is_pressed: bool, add: impl Fn(&mut Equations)) {
        add(&mut self.moving);
        if is_pressed {
            add(&mut self.answering);
        }
    }
}

impl Tree {
    /// The equations of motion, solved with everything that resists: for the motion under forces on links (N, N, N m) that go on acting, and for
    /// what other forces do.
    ///
    /// A limit or a contact holds against what pushes into it and gives way to what lifts from it. Forces are taken to go on as those given do: where
    /// these press, on the link itself, it holds, and elsewhere it does not. Too small a force is corrected in the next step, one that has to lift a
    /// wheel off what is taken to hold it throws the truck.
    pub fn solve(
        &self,
        multibody: &Multibody,
        sets: &RapierSets<'_>,
        pace: Pace,
        forces: &[(usize, [f64; 3])],
    ) -> Option<Foreseen> {
        let mut equations = self.equations(pace);
        let mut reactions = vec![0.0; self.free_dofs().count()];
        for &(link, force) in forces {
            let pulled = self.pull_back(link, force);
            let parts = reactions.iter_mut().zip(pulled);
            parts.for_each(|(sum, part)| *sum += part);
        }
        for (index, force) in reactions.iter().enumerate() {
            let mut row = vec![0.0; reactions.len()];
            row[index] = 1.0;
            equations.add_force(&row, *force);
        }
        self.add_springs(multibody, &mut equations);
        let bare = equations.solve()?;
        self.add_motors(multibody, &bare, &mut equations);
        let driven = equations.solve()?;
        let mut holding = Holding {
            pressed: driven.response(&reactions),
            forces,
            bare,
            driven,
            answering: equations.clone(),
            moving: equations,
        };
        self.add_limits(multibody, pace, &mut holding);
        self.add_contacts(sets, pace, &mut holding);
        Some(Foreseen {
            motion: holding.moving.solve()?,
            answers: holding.answering.solve()?,
        })
    }

    fn add_springs(&self, multibody: &Multibody, equations: &mut Equations) {
        for (index, dof) in self.dofs.iter().enumerate() {
            let link = multibody.link(dof.link);
            let (stiffness, rest) = link.map_or((0.0, 0.0), |link| link.joint().spring(dof.axis));
            if stiffness != 0.0
                && let Some(row) = self.row_of(index)
            {
                let shift = dof.value - f64::from(rest);
                equations.add_spring(&row, f64::from(stiffness), shift);
            }
        }
    }

    fn add_motors(&self, multibody: &Multibody, bare: &Solved, equations: &mut Equations) {
        for (index, dof) in self.dofs.iter().enumerate() {
            let joint = multibody.link(dof.link).map(MultibodyLink::joint);
            let motor = joint.and_then(|joint| {
                let is_on = joint.data.motor_axes.bits() >> dof.axis & 1 == 1;
                is_on.then(|| joint.data.motors[dof.axis])
            });
            let (Some(motor), Some(row)) = (motor, self.row_of(index)) else {
                continue;
            };
            let scale = match motor.model {
                MotorModel::ForceBased => 1.0,
                MotorModel::AccelerationBased => bare.weight(&row),
            };
            let stiffness = scale * f64::from(motor.stiffness);
            let damping = scale * f64::from(motor.damping);
            let (shift, goal) = (
                dof.value - f64::from(motor.target_pos),
                f64::from(motor.target_vel),
            );
            let (force, most) = (
                -stiffness * shift - damping * (dof.rate - goal),
                f64::from(motor.max_force),
            );
            if force.abs() < most {
                equations.add_spring(&row, stiffness, shift);
                equations.add_damper(&row, damping, goal);
            } else {
                equations.add_force(&row, force.clamp(-most, most));
            }
        }
    }

    /// Limits that the motion foreseen would pass.
    fn add_limits(&self, multibody: &Multibody, pace: Pace, holding: &mut Holding<'_>) {
        for (index, dof) in self.dofs.iter().enumerate() {
            let joint = multibody.link(dof.link).map(MultibodyLink::joint);
            let limits = joint.and_then(|joint| {
                let is_on = joint.data.limit_axes.bits() >> dof.axis & 1 == 1;
                is_on.then(|| joint.data.limits[dof.axis])
            });
            let (Some(limits), Some(row)) = (limits, self.row_of(index)) else {
                continue;
            };
            let Pace { dt, share } = pace;
            let end = dof.value + dt * (dof.rate + share * dt * holding.driven.along(&row));
            let (low, high) = (f64::from(limits.min), f64::from(limits.max));
            // What is past its limit already is held where it is.
            let (shift, sign) = if end < low {
                ((dof.value - low).max(0.0), -1.0)
            } else if end > high {
                ((dof.value - high).min(0.0), 1.0)
            } else {
                continue;
            };
            let held = pace.held(holding.bare.weight(&row));
            holding.hold_limit(&row, sign, |equations| {
                equations.add_spring(&row, held, shift)
            });
        }
    }

    /// Contacts that pressed in rapier's last step against what no contact moves, unless the motion foreseen opens them.
    fn add_contacts(&self, sets: &RapierSets<'_>, pace: Pace, holding: &mut Holding<'_>) {
        for (index, link) in self.links.iter().enumerate() {
            let Some(body) = sets.bodies.get(link.handle) else {
                continue;
            };
            for &collider in body.colliders() {
                for pair in sets.narrow_phase.contact_pairs_with(collider) {
                    self.add_contact(pair, (index, collider), sets, pace, holding);
                }
            }
        }
    }

    fn add_contact(
        &self,
        pair: &ContactPair,
        (index, own): (usize, ColliderHandle),
        sets: &RapierSets<'_>,
        pace: Pace,
        holding: &mut Holding<'_>,
    ) {
        let is_first = pair.collider1 == own;
        let other = if is_first {
            pair.collider2
        } else {
            pair.collider1
        };
        let (Some(own), Some(other)) = (sets.colliders.get(own), sets.colliders.get(other)) else {
            return;
        };
        let wall = other.parent().and_then(|parent| sets.bodies.get(parent));
        if wall.is_some_and(RigidBody::is_dynamic) {
            return;
        }
        let place = super::shapes::pose_of(own.position());
        for manifold in pair.manifolds() {
            // From the link to what it presses.
            let sign = if is_first { 1.0 } else { -1.0 };
            let normal = sign * from_rapier(manifold.data.normal);
            for point in manifold
                .points
                .iter()
                .filter(|point| point.data.impulse > 0.0)
            {
                let (local, shape) = if is_first {
                    (point.local_p1, manifold.subshape_pos1())
                } else {
                    (point.local_p2, manifold.subshape_pos2())
                };
                let local = shape.map_or(local, |shape| shape * local);
                let at = place.transform(from_rapier(local));
                let moves = wall.map_or(Vec2::zeros(), |wall| {
                    let lever = at - from_rapier(wall.center_of_mass());
                    from_rapier(wall.linvel()) + f64::from(wall.angvel()) * perp(lever)
                });
                let row = self.point_row(index, at, normal);
                let rate = holding.moving.rate(&row) - normal.dot(&moves);
                if rate + pace.dt * holding.driven.along(&row) < 0.0 {
                    continue;
                }
                let most = f64::from(manifold.data.friction) * f64::from(point.data.impulse);
                let sticks = f64::from(point.data.tangent_impulse[0].abs()) < STICKS * most;
                let directions = [(normal, true), (perp(normal), sticks)];
                for (along, _) in directions.into_iter().filter(|(_, is_held)| *is_held) {
                    let held_row = self.point_row(index, at, along);
                    let weight = holding.bare.weight(&held_row);
                    if weight.is_finite() {
                        let shift = -pace.dt * along.dot(&moves);
                        let held = pace.held(weight);
                        // Friction holds where the contact does.
                        holding.hold_contact(index, normal, |equations| {
                            equations.add_spring(&held_row, held, shift);
                        });
                    }
                }
            }
        }
    }
}

impl Pace {
    /// Stiffness that holds a mass.
    fn held(self, weight: f64) -> f64 {
        held() * weight / (self.share * self.dt * self.dt)
    }
}
