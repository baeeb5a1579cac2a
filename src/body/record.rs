//! What a snapshot writes of flexible bodies: their state, and the descriptions of their models.

use super::attachment::Attachments;
use super::contact_settings::ContactSettings;
use super::flex_body::FlexBody;
use super::frame::{Arms, Frame, frame_of};
use super::handle::FlexBodyHandle;
use super::kept_force::KeptForce;
use super::set::{FlexBodySet, Slot};
use super::state::FlexState;
use super::stillness::Stillness;
use super::{Anchor, Attachment, AttachmentKind, AttachmentTarget};
use crate::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel, InnerPressure};
use crate::fe::material::hyperelastic::PlasticState;
use crate::fe::model_record::{ModelRecord, ModelRecordError};
use crate::fe::record::KnownLaws;
use crate::math::Vec2;
use crate::rapier::prelude::{ColliderHandle, RigidBodyHandle};
use serde::{Deserialize, Serialize};
use std::sync::{Arc, OnceLock};

/// A flexible body as a snapshot writes it.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct BodyRecord {
    model: ModelRecord,
    /// Which nodes have no mass in the other model, if there is one.
    other_massless: Option<Vec<bool>>,
    is_fixed: Vec<bool>,
    prescribed: Vec<f64>,
    nodal_force: Vec<f64>,
    nodal_impulse: Vec<f64>,
    body_force: Vec2,
    gravity_scale: f64,
    contact: ContactSettings,
    carrier_contact: ContactSettings,
    user_data: u128,
    state: FlexState,
    is_started: bool,
    contact_force: Vec<f64>,
    reaction: Vec<f64>,
    energy_reserve: f64,
    kept_forces: Vec<KeptForce>,
    n_unfinished: u32,
    stillness: Stillness,
    carrier: RigidBodyHandle,
    collider: ColliderHandle,
    is_disturbed: bool,
    is_quarantined: bool,
    is_new: bool,
    n_idle_pins: usize,
    is_large: bool,
    pressures: Vec<InnerPressure>,
}

impl BodyRecord {
    fn of(body: &FlexBody) -> Result<Self, ModelRecordError> {
        Ok(Self {
            model: ModelRecord::of(body.model())?,
            other_massless: body.other_model.as_ref().map(|other| {
                let nodes = 0..other.n_nodes();
                nodes.map(|node| other.is_massless(node)).collect()
            }),
            is_fixed: body.is_fixed.clone(),
            prescribed: body.prescribed.clone(),
            nodal_force: body.nodal_force.clone(),
            nodal_impulse: body.nodal_impulse.clone(),
            body_force: body.body_force,
            gravity_scale: body.gravity_scale,
            contact: body.contact,
            carrier_contact: body.carrier_contact,
            user_data: body.user_data,
            state: body.state.clone(),
            is_started: body.is_started,
            contact_force: body.contact_force.clone(),
            reaction: body.reaction.clone(),
            energy_reserve: body.energy_reserve,
            kept_forces: body.kept_forces.clone(),
            n_unfinished: body.n_unfinished,
            stillness: body.stillness.clone(),
            carrier: body.carrier,
            collider: body.collider,
            is_disturbed: body.is_disturbed,
            is_quarantined: body.is_quarantined,
            is_new: body.is_new,
            n_idle_pins: body.n_idle_pins,
            is_large: body.large.is_some(),
            pressures: body
                .large
                .as_ref()
                .map_or_else(Vec::new, |large| large.pressures().to_vec()),
        })
    }

    fn build(self, laws: &KnownLaws) -> Result<FlexBody, ModelRecordError> {
        let model = Arc::new(self.model.build(laws)?);
        let other = match self.other_massless {
            Some(massless) if massless.len() != model.n_nodes() => {
                return Err(ModelRecordError::Length("masses"));
            }
            Some(massless) => Some(model.remade(|of| of.massless = massless)?),
            None => None,
        };
        let state = &self.state;
        let nodal = [
            &self.prescribed,
            &self.nodal_force,
            &self.nodal_impulse,
            &self.contact_force,
            &self.reaction,
            &state.position,
            &state.velocity,
            &state.displacement,
            &state.rate,
            &state.acceleration,
        ];
        let n_dofs = model.n_dofs();
        if self.is_fixed.len() != n_dofs || nodal.iter().any(|values| values.len() != n_dofs) {
            return Err(ModelRecordError::Length("nodal values"));
        }
        let large = match self.is_large {
            true => {
                let mut description = FiniteStrainDescription::of_model(&model);
                if let Some(description) = &mut description {
                    description.pressures = self.pressures;
                }
                let found = description.and_then(|one| FiniteStrainModel::assemble(one).ok());
                Some(Arc::new(found.ok_or(ModelRecordError::Differs)?))
            }
            false => None,
        };
        if !(state.pin_push.is_empty() || state.pin_push.len() == n_dofs) {
            return Err(ModelRecordError::Length("nodal values"));
        }
        let n_flowing = large.as_ref().map_or(0, |large| large.virgin().len());
        if state.flowed.len() != n_flowing || !state.flowed.iter().all(PlasticState::is_sound) {
            return Err(ModelRecordError::Length("plastic strains"));
        }
        let linearized = &state.linearized.position;
        if !linearized.is_empty() && linearized.len() != n_dofs {
            return Err(ModelRecordError::Length("the positions of the tangent"));
        }
        let is_large = large.is_some();
        let frame: Option<Frame> = frame_of(model.placed_positions(), &self.is_fixed, is_large);
        let frame = frame.ok_or(ModelRecordError::Length("pins"))?;
        Ok(FlexBody {
            arms: Arms::new(&model, frame),
            model,
            other_model: other.map(Arc::new),
            large,
            frame,
            is_fixed: self.is_fixed,
            prescribed: self.prescribed,
            nodal_force: self.nodal_force,
            nodal_impulse: self.nodal_impulse,
            body_force: self.body_force,
            gravity_scale: self.gravity_scale,
            contact: self.contact,
            carrier_contact: self.carrier_contact,
            user_data: self.user_data,
            state: self.state,
            is_started: self.is_started,
            contact_force: self.contact_force,
            reaction: self.reaction,
            energy_reserve: self.energy_reserve,
            kept_forces: self.kept_forces,
            n_unfinished: self.n_unfinished,
            stillness: self.stillness,
            frequency: OnceLock::new(),
            carrier: self.carrier,
            collider: self.collider,
            is_disturbed: self.is_disturbed,
            is_quarantined: self.is_quarantined,
            is_new: self.is_new,
            n_idle_pins: self.n_idle_pins,
        })
    }
}

/// A set as a snapshot writes it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct SetRecord {
    id: u32,
    slots: Vec<(u32, Option<BodyRecord>)>,
    vacant: Vec<u32>,
    attachments: Attachments,
}

/// Why a set cannot be saved or restored.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SetRecordError {
    /// One of its bodies cannot.
    Body(FlexBodyHandle, ModelRecordError),
    /// Slots or attachments contradict each other.
    Slots(&'static str),
}

impl SetRecord {
    /// The record of a set.
    ///
    /// # Errors
    /// If a law of a body has no name.
    pub fn of(set: &FlexBodySet) -> Result<Self, SetRecordError> {
        let mut slots = Vec::new();
        for (index, slot) in set.slots.iter().enumerate() {
            let handle = handle(set.id, index, slot.generation);
            let body = slot.body.as_ref().map(BodyRecord::of).transpose();
            let body = body.map_err(|error| SetRecordError::Body(handle, error))?;
            slots.push((slot.generation, body));
        }
        Ok(Self {
            id: set.id,
            slots,
            vacant: set.vacant.clone(),
            attachments: set.attachments().clone(),
        })
    }

    /// The set again, under the number it had, so that its handles are valid.
    ///
    /// # Errors
    /// If a law is not known, or the data is damaged.
    pub fn build(self, laws: &KnownLaws) -> Result<FlexBodySet, SetRecordError> {
        let mut slots = Vec::new();
        for (index, (generation, body)) in self.slots.into_iter().enumerate() {
            let handle = handle(self.id, index, generation);
            let body = body.map(|body| body.build(laws)).transpose();
            let body = body.map_err(|error| SetRecordError::Body(handle, error))?;
            slots.push(Slot { generation, body });
        }
        let empty = |slot: &Slot| slot.body.is_none();
        let is_empty = |&index: &u32| slots.get(index as usize).is_some_and(empty);
        let mut vacant = self.vacant.clone();
        vacant.sort_unstable();
        vacant.dedup();
        let n_empty = slots.iter().filter(|slot| empty(slot)).count();
        if vacant.len() != self.vacant.len()
            || vacant.len() != n_empty
            || !vacant.iter().all(is_empty)
        {
            return Err(SetRecordError::Slots("vacant slots"));
        }
        let set = FlexBodySet::from_parts(self.id, slots, self.vacant, self.attachments);
        let holds = |attachment| is_sound(attachment, &set);
        if !set.attachments().iter().all(|(_, one)| holds(one)) {
            return Err(SetRecordError::Slots("attachments"));
        }
        Ok(set)
    }
}

fn handle(set: u32, index: usize, generation: u32) -> FlexBodyHandle {
    FlexBodyHandle {
        set,
        index: index as u32,
        generation,
    }
}

/// Whether the nodes of an attachment exist.
fn is_sound(attachment: &Attachment, set: &FlexBodySet) -> bool {
    let n_anchors = match attachment.kind {
        AttachmentKind::Weld => attachment.nodes.len(),
        AttachmentKind::Pin | AttachmentKind::Spring { .. } => 1,
    };
    let n_nodes = |handle| set.get(handle).map(FlexBody::n_nodes);
    let Some(own) = n_nodes(attachment.body) else {
        return false;
    };
    let other = match attachment.target {
        AttachmentTarget::Flexible(other) => n_nodes(other),
        AttachmentTarget::World | AttachmentTarget::RigidBody(_) => None,
    };
    let fits = |anchor: &Anchor| match (anchor, other) {
        (Anchor::Point(_), None) => true,
        (Anchor::Surface(nodes, _), Some(n_nodes)) => nodes.iter().all(|&node| node < n_nodes),
        _ => false,
    };
    attachment.anchors.len() == n_anchors
        && !attachment.nodes.is_empty()
        && attachment.nodes.iter().all(|&node| node < own)
        && attachment.anchors.iter().all(fits)
}
