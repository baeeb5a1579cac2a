//! Rigid bodies.

use super::super::problem::Problem;
use super::super::scene::{Rigid, RigidKind, RigidShape};
use super::super::source::Source;
use super::checks::check_rigid;
use super::{Built, vector};
use foil2d::math::hypot;
use foil2d::rapier::math::Real;
use foil2d::rapier::prelude::*;

pub fn insert(built: &mut Built, source: &Source, rigid: &Rigid) -> Result<(), Problem> {
    check_rigid(source, rigid)?;
    if let Some(name) = &rigid.name {
        built.names.refuse_taken(source, name)?;
    }
    let body = match rigid.kind.get() {
        RigidKind::Dynamic => RigidBodyBuilder::dynamic(),
        RigidKind::Fixed => RigidBodyBuilder::fixed(),
        RigidKind::Kinematic => RigidBodyBuilder::kinematic_velocity_based(),
    };
    let body = body
        .translation(vector(rigid.translation.get().0))
        .rotation(*rigid.rotation.get() as Real)
        .linvel(vector(rigid.linvel.get().0))
        .angvel(*rigid.angvel.get() as Real);
    let shape = collider(source, rigid.shape.get())?
        .density(*rigid.density.get() as Real)
        .friction(*rigid.friction.get() as Real)
        .restitution(*rigid.restitution.get() as Real);
    let (body, collider) = built.world.insert(body, shape);
    built.names.add_rigid(rigid.name.as_ref(), body, collider);
    Ok(())
}

/// Whether points, as rapier holds them, span an area: one of them is off the line through the two that are farthest from each other.
fn has_inside(points: &[Vector]) -> bool {
    let Some(&first) = points.first() else {
        return false;
    };
    let farthest = |from: Vector| {
        let away = |at: &&Vector| (**at - from).length();
        let found = points.iter().max_by(|a, b| away(a).total_cmp(&away(b)));
        found.map_or(from, |&at| at)
    };
    let start = farthest(first);
    let along = farthest(start) - start;
    let off = points.iter().map(|&at| along.perp_dot(at - start).abs());
    let largest = off.fold(0.0, Real::max);
    let rounding = 64.0 * Real::EPSILON * along.length() * along.length();
    largest > rounding && largest.is_finite()
}

/// The collider of a rigid body.
fn collider(source: &Source, shape: &RigidShape) -> Result<ColliderBuilder, Problem> {
    Ok(match shape {
        RigidShape::Ball { radius } => ColliderBuilder::ball(*radius.get() as Real),
        RigidShape::Cuboid { size } => {
            let [width, height] = size.get().0;
            ColliderBuilder::cuboid(0.5 * width as Real, 0.5 * height as Real)
        }
        RigidShape::Capsule { from, to, radius } => {
            let [from, to] = [from, to].map(|end| vector(end.get().0));
            ColliderBuilder::capsule_from_endpoints(from, to, *radius.get() as Real)
        }
        RigidShape::Hull { points } => {
            let all: Vec<Vector> = points.get().iter().map(|at| vector(at.0)).collect();
            // Parry 0.31 panics where there is none.
            let hull = has_inside(&all).then(|| ColliderBuilder::convex_hull(&all));
            hull.flatten().ok_or_else(|| {
                source.problem(
                    points,
                    "the points have no convex hull: give three or more that are not on a line",
                )
            })?
        }
        RigidShape::Polyline { points } => {
            let all: Vec<Vector> = points.get().iter().map(|at| vector(at.0)).collect();
            if all.len() < 2 {
                return Err(source.problem(points, "a polyline has two points or more"));
            }
            ColliderBuilder::polyline(all, None)
        }
        RigidShape::Halfspace { normal } => {
            let [x, y] = normal.get().0;
            let length = hypot(x, y);
            if length == 0.0 {
                return Err(source.problem(
                    normal,
                    "the normal has no direction: give one such as [0.0, 1.0]",
                ));
            }
            ColliderBuilder::new(SharedShape::halfspace(vector([x / length, y / length])))
        }
    })
}
