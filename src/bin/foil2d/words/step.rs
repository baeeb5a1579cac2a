//! Why a step was not taken.

use super::super::names::Names;
use foil2d::body::FlexBodyError;
use foil2d::integrator::IntegratorError;
use foil2d::pipeline::StepError;

/// Why a step was not taken.
pub fn of_step(error: &StepError, names: &Names) -> String {
    match error {
        StepError::Body(error) => of_body(error, names),
        StepError::Integrator { body, source } => {
            let body = names.of_flexible(*body);
            match source {
                IntegratorError::Unstable { dt, critical, .. } => format!(
                    "{body}: the step of {dt:.3e} s is longer than the critical one of `central_difference` on this mesh, {critical:.3e} s: shorten `dt`, take larger cells, or another `integrator`"
                ),
                _ => format!(
                    "{body}: `central_difference` is for bodies with `small_strain = true`: take another `integrator`"
                ),
            }
        }
        StepError::Factorization { body, .. } => format!(
            "{}: its masses and stiffness cannot be told from rounding in a step of this length: shorten `dt`, or take larger cells",
            names.of_flexible(*body)
        ),
        StepError::LightPartner { body, dt, critical } => format!(
            "{} is so light that it vibrates faster than the step of {dt:.3e} s resolves: shorten `dt` below {critical:.3e} s, make it heavier, or take another `integrator`",
            names.of_rigid(*body)
        ),
        StepError::Unsolved {
            bodies, overlap, ..
        } => format!(
            "the contacts of {} are not solved (overlap {overlap:.2e} m): shorten `dt`, or leave `refuse_unsolved` out to go on all the same",
            names.of_participants(bodies)
        ),
        StepError::NotFinite(body) => format!(
            "{} would move farther than can be computed: look at its forces and velocities",
            names.of_flexible(*body)
        ),
        StepError::RigidBody(body) => format!(
            "{} touches a flexible body, and its motion, mass or force is not finite: look at its size, density and velocity",
            names.of_rigid(*body)
        ),
        StepError::Joint(joint) => format!(
            "{} is not finite: look at its place",
            names.of_joint(*joint)
        ),
        StepError::ExplicitAttachment(attachment) => format!(
            "{} cannot be held by `central_difference`: take another `integrator`, or `pin`",
            names.of_attachment(*attachment)
        ),
        StepError::Coefficient(collider) => format!(
            "{}: its friction or restitution is not finite",
            names.of_collider(*collider)
        ),
        StepError::Shape {
            collider,
            fault,
            cure,
        } => {
            format!("{} has {fault}: {cure}", names.of_collider(*collider))
        }
        StepError::Margin(collider) => {
            format!(
                "{} is too large to be computed with",
                names.of_collider(*collider)
            )
        }
        error => error.to_string(),
    }
}

fn of_body(error: &FlexBodyError, names: &Names) -> String {
    match error {
        FlexBodyError::Stale(body)
        | FlexBodyError::Foreign(body)
        | FlexBodyError::Pinned(body)
        | FlexBodyError::Quarantined(body)
        | FlexBodyError::NoCarrier(body) => {
            format!("{} is not in the world any more", names.of_flexible(*body))
        }
        error => error.to_string(),
    }
}
