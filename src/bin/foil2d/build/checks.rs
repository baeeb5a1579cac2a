//! Numbers that no world has are refused where they stand.

use super::super::at::{At, Pair};
use super::super::problem::Problem;
use super::super::scene::{Integrator, Rigid, RigidKind, RigidShape};
use super::super::source::Source;
use super::super::words::rounded;
use std::fmt::Debug;

/// Numbers beyond this are refused, as the library does.
const LARGEST: f64 = 1e18;

/// Lengths of steps (s), as the library takes them.
const SHORTEST: f64 = 1e-8;
const LONGEST: f64 = 1e4;

/// Steps of a run.
const MOST_STEPS: f64 = 1e9;

pub fn are_finite(numbers: &[f64]) -> bool {
    numbers.iter().all(|number| number.abs() <= LARGEST)
}

/// Refuses what is infinite, too large or no number.
pub fn check_number(source: &Source, key: &str, at: &At<f64>) -> Result<(), Problem> {
    check(source, key, at, are_finite(&[*at.get()]), FINITE)
}

pub fn check_pair(source: &Source, key: &str, at: &At<Pair<f64>>) -> Result<(), Problem> {
    check(source, key, at, are_finite(&at.get().0), FINITE)
}

/// Refuses what is not positive, as a length.
pub fn check_positive(source: &Source, key: &str, at: &At<f64>) -> Result<(), Problem> {
    let is_sound = *at.get() > 0.0 && *at.get() <= LARGEST;
    check(
        source,
        key,
        at,
        is_sound,
        "give a positive number up to 1e18",
    )
}

/// Refuses what is negative, as a coefficient.
pub fn check_not_negative(source: &Source, key: &str, at: &At<f64>) -> Result<(), Problem> {
    let is_sound = (0.0..=LARGEST).contains(at.get());
    check(
        source,
        key,
        at,
        is_sound,
        "give zero or a positive number up to 1e18",
    )
}

const FINITE: &str = "give finite numbers up to 1e18";

fn check<T: Debug>(
    source: &Source,
    key: &str,
    at: &At<T>,
    is_sound: bool,
    cure: &str,
) -> Result<(), Problem> {
    match is_sound {
        true => Ok(()),
        false => Err(source.problem(at, format!("`{key}` is {:?}: {cure}", at.get()))),
    }
}

/// Refuses a world that has no steps, or no end.
pub fn check_world(source: &Source) -> Result<(), Problem> {
    let (world, output) = (&source.scene.world, &source.scene.output);
    if !(SHORTEST..=LONGEST).contains(world.dt.get()) {
        return Err(source.problem(
            &world.dt,
            "`dt` is the length of a step: give seconds from 1e-8 to 1e4",
        ));
    }
    let n_steps = world.duration.get() / world.dt.get();
    if !(0.5..=MOST_STEPS).contains(&n_steps) {
        let at = match world.duration.byte() {
            Some(_) => &world.duration,
            None => &world.dt,
        };
        return Err(source.problem(
            at,
            format!(
                "a run of {:?} s in steps of {:?} s has {} steps: `duration` is to hold one `dt`, and a billion at most",
                world.duration.get(),
                world.dt.get(),
                rounded(n_steps)
            ),
        ));
    }
    check_pair(source, "gravity", &world.gravity)?;
    if !(0.0..=1.0).contains(world.decay.get()) {
        return Err(source.problem(&world.decay, "`decay` is to be from 0 to 1"));
    }
    if let Integrator::CentralDifference = world.integrator.get() {
        let mut large = source.scene.flexible.iter();
        if let Some(body) = large.find(|body| !body.small_strain.get()) {
            return Err(source.problem(
                &world.integrator,
                format!(
                    "`central_difference` is for bodies with `small_strain = true`, which `{}` has not",
                    body.name.get()
                ),
            ));
        }
        if !source.scene.attachment.is_empty() {
            return Err(source.problem(
                &world.integrator,
                "`central_difference` holds no `attachment`: take another integrator, or `pin`",
            ));
        }
    }
    match *output.every.get() {
        0 => Err(source.problem(&output.every, "`every` counts steps: give 1 or more")),
        _ => Ok(()),
    }
}

/// Refuses a rigid body that rapier cannot hold.
pub fn check_rigid(source: &Source, rigid: &Rigid) -> Result<(), Problem> {
    check_pair(source, "translation", &rigid.translation)?;
    check_number(source, "rotation", &rigid.rotation)?;
    check_pair(source, "linvel", &rigid.linvel)?;
    check_number(source, "angvel", &rigid.angvel)?;
    check_not_negative(source, "friction", &rigid.friction)?;
    check_not_negative(source, "restitution", &rigid.restitution)?;
    let is_dynamic = *rigid.kind.get() == RigidKind::Dynamic;
    if is_dynamic {
        check_positive(source, "density", &rigid.density)?;
    }
    let points_of = |at: &At<Vec<Pair<f64>>>| {
        let is_sound = at.get().iter().all(|point| are_finite(&point.0));
        check(source, "points", at, is_sound, FINITE)
    };
    match rigid.shape.get() {
        RigidShape::Ball { radius } => check_positive(source, "radius", radius),
        RigidShape::Cuboid { size } => {
            let is_sound = size.get().0.iter().all(|&one| one > 0.0 && one <= LARGEST);
            let cure = "give a positive width and height (m), up to 1e18";
            check(source, "size", size, is_sound, cure)
        }
        RigidShape::Capsule { from, to, radius } => {
            check_pair(source, "from", from)?;
            check_pair(source, "to", to)?;
            check_positive(source, "radius", radius)
        }
        RigidShape::Hull { points } => points_of(points),
        RigidShape::Polyline { points } => points_of(points).and(refuse_open(source, rigid)),
        RigidShape::Halfspace { normal } => {
            check_pair(source, "normal", normal).and(refuse_open(source, rigid))
        }
    }
}

fn refuse_open(source: &Source, rigid: &Rigid) -> Result<(), Problem> {
    match *rigid.kind.get() == RigidKind::Dynamic {
        true => Err(source.problem(
            &rigid.shape,
            "polylines and half-spaces have no mass: give `kind = \"fixed\"` or `\"kinematic\"`",
        )),
        false => Ok(()),
    }
}
