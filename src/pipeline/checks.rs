//! What is refused before a step and what is refused of its result.

use super::error::StepError;
use super::settings::FlexParameters;
use crate::body::{FlexBody, FlexBodyError, FlexBodyHandle, FlexBodySet};
use crate::coupling::{RapierSets, Seats, is_carried, is_out, is_representable_motion, rounding};
use crate::fe::model::MassMatrix;
use crate::integrator::IntegratorError;
use crate::kkt::{Island, KktError};
use crate::math::{are_held, from_rapier, is_held};
use crate::rapier::prelude::{ColliderHandle, RigidBody, Vector};
use crate::system::{Block, Step};

/// Shortest step (s), but for what single precision makes of 1e-8. Contact forces change velocities within a step, so accelerations grow as its inverse and the
/// weights as its square: below this, sums of both keep no digits.
pub(super) const SHORTEST: f64 = 1e-8 * (1.0 - 1e-7);

/// Longest step (s): nothing a step resolves takes longer, and predictors grow as its square.
const LONGEST: f64 = 1e4;

/// Refuses colliders that rapier cannot step, before anything is touched: margins that it cannot grow a box by. It panics, at the first collider it looks at, near or far. Only what was
/// `marked` since rapier's last step need be asked: that step has looked at all others.
pub(super) fn check_colliders(
    sets: &RapierSets<'_>,
    marked: &[ColliderHandle],
) -> Result<(), StepError> {
    let is_margin = |value: f64| value >= 0.0 && is_held(value);
    let prediction = f64::from(sets.integration_parameters.prediction_distance());
    if !is_margin(prediction) {
        return Err(StepError::Prediction(prediction));
    }
    for &handle in marked {
        let collider = sets.colliders.get(handle);
        let Some(collider) = collider.filter(|collider| collider.is_enabled()) else {
            continue;
        };
        let skin = f64::from(collider.contact_skin());
        if !(is_margin(skin) && is_margin(rounding(collider.shape()))) {
            return Err(StepError::Margin(handle));
        }
    }
    Ok(())
}

/// Refuses a step length or gravity that nothing can be stepped with, before anything is touched.
pub(super) fn check_step(
    parameters: &FlexParameters,
    sets: &RapierSets<'_>,
) -> Result<Step, StepError> {
    parameters.check()?;
    let dt = f64::from(sets.integration_parameters.dt);
    if dt != 0.0 && !(SHORTEST..=LONGEST).contains(&dt) {
        return Err(StepError::StepLength(dt));
    }
    let gravity = from_rapier(sets.gravity);
    if !is_held(gravity.x) || !is_held(gravity.y) {
        return Err(StepError::Gravity(gravity.into()));
    }
    Ok(Step::new(&parameters.integrator, dt))
}

/// Refuses bodies that are awake and cannot be stepped, before anything is touched.
pub(super) fn check_bodies(
    parameters: &FlexParameters,
    dt: f64,
    sets: &RapierSets<'_>,
    flex_bodies: &FlexBodySet,
) -> Result<(), StepError> {
    for (handle, body) in flex_bodies.iter() {
        if is_out(body, sets.bodies) || body.is_sleeping(sets.bodies) {
            continue;
        }
        if !is_carried(body, sets.bodies, sets.colliders) {
            return Err(FlexBodyError::NoCarrier(handle).into());
        }
        let carrier = sets.bodies.get(body.rigid_body_handle());
        let is_still = |carrier: &RigidBody| {
            let driven = [carrier.linvel(), carrier.user_force()];
            let turned = [carrier.angvel(), carrier.user_torque()];
            driven == [Vector::ZERO; 2] && turned == [0.0; 2]
        };
        if !carrier.is_none_or(is_still) {
            return Err(FlexBodyError::CarrierDriven(handle).into());
        }
        let is_own = |carrier: &RigidBody| carrier.is_dynamic() && carrier.colliders().len() == 1;
        if !carrier.is_none_or(is_own) {
            return Err(FlexBodyError::CarrierChanged(handle).into());
        }
        check_integrator(parameters, dt, body).map_err(|source| StepError::Integrator {
            body: handle,
            source,
        })?;
    }
    if parameters.integrator.is_explicit()
        && let Some((handle, _)) = flex_bodies.iter_attachments().next()
    {
        return Err(StepError::ExplicitAttachment(handle));
    }
    Ok(())
}

/// Refuses an integrator that a body's mass or mesh does not allow at this step length.
fn check_integrator(
    parameters: &FlexParameters,
    dt: f64,
    body: &FlexBody,
) -> Result<(), IntegratorError> {
    let integrator = parameters.integrator;
    let is_explicit = integrator.is_explicit();
    if is_explicit && body.large().is_some() {
        return Err(IntegratorError::LargeStrain);
    }
    if body.large().is_some() {
        // Their steps conserve or lose energy, whatever the member.
        return Ok(());
    }
    if is_explicit && !matches!(body.model().mass(), MassMatrix::Lumped(_)) {
        return Err(IntegratorError::ConsistentMass);
    }
    if parameters.insists || integrator.is_unconditionally_stable() {
        return Ok(());
    }
    if is_explicit {
        let (critical, frequency) = (body.critical_step(&integrator), body.explicit_frequency());
        let unstable = IntegratorError::Unstable {
            dt,
            critical,
            frequency,
        };
        return if dt > critical { Err(unstable) } else { Ok(()) };
    }
    integrator.check_step(dt, body.touched_model().largest_frequency())
}

/// Refuses a solved island whose motion rapier cannot represent.
pub(super) fn check_finite(
    island: &Island,
    seats: &Seats,
    flex_bodies: &FlexBodySet,
) -> Result<(), StepError> {
    for (block, index) in island.blocks.iter().zip(&island.flex_index) {
        if let (Block::Flex(block), Some(index)) = (block, index) {
            // Beside a load beyond all measure any end of a body of large strain is one.
            let is_found = !(block.is_large() && block.is_overloaded());
            let is_finite = is_found && are_held(block.positions()) && are_held(block.velocities());
            if let (false, Some((handle, _))) = (is_finite, flex_bodies.at_index(*index)) {
                return Err(StepError::NotFinite(
                    overloaded(island, flex_bodies).unwrap_or(handle),
                ));
            }
        }
    }
    for &(block, handle) in seats.claimed() {
        if let Block::Rigid(block) = &island.blocks[block]
            && !(is_representable_motion(block.current())
                && block.smooth_end.into_iter().all(f64::is_finite))
        {
            return Err(StepError::RigidBody(handle));
        }
    }
    Ok(())
}

/// The body of the island whose loads alone send it beyond what numbers can represent: what touches it suffers, but is not to blame.
fn overloaded(island: &Island, flex_bodies: &FlexBodySet) -> Option<FlexBodyHandle> {
    let mut members = island.blocks.iter().zip(&island.flex_index);
    members.find_map(|(block, index)| match (block, index) {
        (Block::Flex(block), Some(index)) if block.is_overloaded() => {
            flex_bodies.at_index(*index).map(|(handle, _)| handle)
        }
        _ => None,
    })
}

/// The error with the handles of the bodies whose blocks it names, or whose loads it comes from.
pub(super) fn name_bodies(
    error: KktError,
    island: &Island,
    seats: &Seats,
    flex_bodies: &FlexBodySet,
) -> StepError {
    if let (KktError::Contact(_), Some(body)) = (&error, overloaded(island, flex_bodies)) {
        return StepError::NotFinite(body);
    }
    let KktError::LightPartner {
        block,
        dt,
        critical,
    } = error
    else {
        return error.into();
    };
    let found = seats.claimed().iter().find(|found| found.0 == block);
    match found {
        Some(&(_, body)) => StepError::LightPartner { body, dt, critical },
        None => error.into(),
    }
}
