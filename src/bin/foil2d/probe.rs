//! Histories: what is read of a body in every step.

use super::build::{Built, nearest};
use super::names::no_such;
use super::problem::Problem;
use super::scene::{HistorySpec, Quantity};
use super::source::Source;
use foil2d::pipeline::Participant;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use std::f64::consts::{PI, TAU};

/// One column, or two, of the table of histories.
pub struct Probe {
    what: Quantity,
    of: Probed,
}

enum Probed {
    /// A flexible body, or a node of it.
    Flex(FlexBodyHandle, Option<usize>),
    Rigid {
        body: RigidBodyHandle,
        collider: ColliderHandle,
        /// Its angle in the last step, within a turn, and how far it has turned since the beginning (rad).
        angle: f64,
        turn: f64,
    },
}

/// What a scene asks for, and the names of the columns behind those there are.
///
/// # Errors
/// If there is no such body, or it has no such quantity, or two columns have one name.
pub fn probes(
    source: &Source,
    built: &Built,
    columns: &mut Vec<String>,
) -> Result<Vec<Probe>, Problem> {
    let mut probes = Vec::new();
    for spec in &source.scene.output.history {
        let what = *spec.what.get();
        let of = probed(source, built, spec)?;
        let at = spec.name.as_ref().unwrap_or(&spec.body);
        for quantity in names_of(what) {
            let column = format!("{}_{quantity}", at.get());
            if columns.contains(&column) {
                let what = format!(
                    "there is a column `{column}` already: give one of them a `name`, which its columns begin with"
                );
                return Err(source.problem(at, what));
            }
            columns.push(column);
        }
        probes.push(Probe { what, of });
    }
    Ok(probes)
}

fn probed(source: &Source, built: &Built, spec: &HistorySpec) -> Result<Probed, Problem> {
    let (names, name) = (&built.names, spec.body.get());
    let what = *spec.what.get();
    if let Some(near) = &spec.near
        && !near.get().0.iter().all(|x| x.is_finite())
    {
        return Err(source.problem(near, "give the place of a node by finite numbers (m)"));
    }
    if let Some(&body) = names.flexible.get(name) {
        let is_of_all = matches!(what, Quantity::Angle | Quantity::AngularVelocity);
        return match &spec.near {
            Some(near) if is_of_all => {
                Err(source.problem(near, "a body turns as a whole: leave `near` out"))
            }
            near => {
                let mesh = built.flex_bodies[body].mesh();
                let node = near.as_ref().map(|near| nearest(mesh, near.get().0));
                Ok(Probed::Flex(body, node))
            }
        };
    }
    let Some(rigid) = names.rigid_if_named(name) else {
        return Err(source.problem(&spec.body, no_such("body", name, names.all())));
    };
    if let Some(near) = &spec.near {
        return Err(source.problem(near, "a rigid body has no nodes: leave `near` out"));
    }
    if matches!(what, Quantity::Reaction | Quantity::VonMises) {
        let what = "a rigid body has no stresses and no pins: `position`, `velocity`, `angle`, `angular_velocity` and `contact_force` are told of it";
        return Err(source.problem(&spec.what, what));
    }
    let body = rigid.body;
    Ok(Probed::Rigid {
        body,
        collider: rigid.collider,
        angle: built.world.bodies.get(body).map_or(0.0, angle_of),
        turn: 0.0,
    })
}

fn angle_of(body: &RigidBody) -> f64 {
    f64::from(body.rotation().angle())
}

impl Probe {
    /// Appends what it reads to a row.
    pub fn read(&mut self, built: &Built, row: &mut Vec<f64>) -> Result<(), Problem> {
        match &mut self.of {
            Probed::Flex(body, node) => {
                let body = &built.flex_bodies[*body];
                read_flexible(body, self.what, *node, row)
            }
            Probed::Rigid {
                body,
                collider,
                angle,
                turn,
            } => {
                let Some(body) = built.world.bodies.get(*body) else {
                    row.extend(names_of(self.what).iter().map(|_| f64::NAN));
                    return Ok(());
                };
                let pair = |v: Vector| [f64::from(v.x), f64::from(v.y)];
                match self.what {
                    Quantity::Position => row.extend(pair(body.translation())),
                    Quantity::Velocity => row.extend(pair(body.linvel())),
                    Quantity::AngularVelocity => row.push(f64::from(body.angvel())),
                    Quantity::Angle => {
                        // Rapier's angle is within a turn: the step is the shorter way round.
                        let new = angle_of(body);
                        *turn += (new - *angle + PI).rem_euclid(TAU) - PI;
                        *angle = new;
                        row.push(*turn);
                    }
                    _ => row.extend(built.flex.report().force_on(Participant::Rigid(*collider))),
                }
                Ok(())
            }
        }
    }
}

fn read_flexible(
    body: &FlexBody,
    what: Quantity,
    node: Option<usize>,
    row: &mut Vec<f64>,
) -> Result<(), Problem> {
    match (what, node) {
        (Quantity::Position, Some(node)) => row.extend(body.position(node)),
        (Quantity::Position, None) => row.extend(body.centre_of_mass()),
        (Quantity::Velocity, Some(node)) => row.extend(body.velocity(node)),
        (Quantity::Velocity, None) => row.extend(body.linvel()),
        (Quantity::Angle, _) => row.push(body.angle()),
        (Quantity::AngularVelocity, _) => row.push(body.angvel()),
        (Quantity::ContactForce, Some(node)) => row.extend(body.contact_force(node)),
        (Quantity::ContactForce, None) => row.extend(body.total_contact_force()),
        (Quantity::Reaction, Some(node)) => row.extend(body.reaction(node)),
        (Quantity::Reaction, None) => row.extend(body.total_reaction()),
        (Quantity::VonMises, node) => {
            let stresses = body.von_mises().map_err(Problem::plain)?;
            let largest = || stresses.iter().copied().fold(0.0, f64::max);
            row.push(node.map_or_else(largest, |node| stresses[node]));
        }
    }
    Ok(())
}

fn names_of(what: Quantity) -> &'static [&'static str] {
    match what {
        Quantity::Position => &["x_m", "y_m"],
        Quantity::Velocity => &["vx_m_per_s", "vy_m_per_s"],
        Quantity::Angle => &["angle_rad"],
        Quantity::AngularVelocity => &["angvel_rad_per_s"],
        Quantity::ContactForce => &["contact_x_N", "contact_y_N"],
        Quantity::Reaction => &["reaction_x_N", "reaction_y_N"],
        Quantity::VonMises => &["von_mises_Pa"],
    }
}
