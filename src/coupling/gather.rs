//! Gathering: an island of blocks and candidates for every component of the claim.

use super::claim::Claims;
use super::gather_joints::JointGatherer;
use super::gather_pairs::PairGatherer;
use super::gather_settings::GatherSettings;
use super::masters::{Masters, cap_speed};
use super::memory::Memory;
use super::multibody::link_of;
use super::placed::Placed;
use super::pool::FlexPool;
use super::reading::{
    GatherError, is_representable_load, is_representable_motion, load_of, load_of_link,
};
use super::rigid_pairs::Agitation;
use super::seats::{OpenIsland, Seats};
use super::sets::RapierSets;
use super::under_way::UnderWay;
use crate::body::FlexBodySet;
use crate::kkt::{Island, KeptOn};
use crate::math::{Vec2, from_rapier};
use crate::rapier::prelude::*;
use crate::system::{FlexLoad, RigidBlock};

/// Builds islands.
#[derive(Debug, Default)]
pub(crate) struct Gatherer {
    /// Blocks of the flexible bodies, when they are in no island.
    pub pool: FlexPool,
    /// Who is which block of the island that was gathered last.
    pub seats: Seats,
    pairs: PairGatherer,
}

/// What an island is gathered from.
#[derive(Clone, Copy)]
pub(crate) struct Sources<'a, 'r> {
    /// What all of it has in common.
    pub settings: &'a GatherSettings,
    /// Rapier's world.
    pub sets: &'a RapierSets<'r>,
    /// Who takes part.
    pub claims: &'a Claims,
    /// Where the members are if the step has been begun.
    pub under_way: &'a UnderWay,
}

impl Gatherer {
    /// Drops what belongs to removed bodies and colliders.
    pub fn retain(&mut self, sets: &RapierSets<'_>, flex_bodies: &FlexBodySet) {
        self.pool.retain(flex_bodies);
        self.pairs.retain(sets.colliders);
    }

    /// Fills `island` with one component.
    ///
    /// # Errors
    /// If an effective matrix is not positive definite or a rigid body is not finite. The blocks taken are then lost and
    /// will be built anew.
    pub fn gather(
        &mut self,
        sources: Sources<'_, '_>,
        memory: &mut Memory,
        flex_bodies: &mut FlexBodySet,
        island: &mut Island,
    ) -> Result<(), GatherError> {
        let Sources {
            settings,
            sets,
            claims,
            under_way,
        } = sources;
        let component = settings.component;
        island.clear();
        self.seats.clear();
        self.pairs.clear();
        for flex in 0..claims.flex.len() {
            if claims.component_of_flex(flex) == component {
                self.add_flex(flex, sources, flex_bodies, island)?;
            }
        }
        for &handle in claims.rigid() {
            if claims.component_of_rigid(handle) == Some(component)
                && let Some(block) = claimed_block(handle, sources, &memory.masters)?
            {
                self.seats.add_claimed(handle, block, island);
            }
        }
        let mut open = OpenIsland {
            settings,
            sets,
            seats: &mut self.seats,
            island,
        };
        let agitation = Agitation::of(&open.island.blocks);
        for &pair in claims.pairs() {
            self.pairs
                .add(pair, claims, &agitation, memory, &mut open)?;
        }
        self.pairs.add_own(claims, &mut open)?;
        let last = if settings.span.is_first() {
            &memory.joints
        } else {
            &under_way.joints
        };
        let mut joints = JointGatherer { last, open };
        joints.add_all(claims, flex_bodies)?;
        let flexible =
            (0..claims.flex.len()).filter(|&flex| claims.component_of_flex(flex) == component);
        for flex in flexible {
            let body = flex_bodies.at_index(claims.flex[flex].index);
            for kept in body.map_or(&[][..], |(_, body)| body.kept_forces()) {
                let by = joints.open.seats.flex_block(flex);
                if let Some((by, on)) = by.zip(joints.open.block_of(kept.on)) {
                    let wrench = kept.wrench;
                    joints.open.island.kept_on.push(KeptOn { by, on, wrench });
                }
            }
        }
        Ok(())
    }

    fn add_flex(
        &mut self,
        flex: usize,
        sources: Sources<'_, '_>,
        flex_bodies: &mut FlexBodySet,
        island: &mut Island,
    ) -> Result<(), GatherError> {
        let Sources { settings, sets, .. } = sources;
        let index = sources.claims.flex[flex].index;
        let Some((handle, body)) = flex_bodies.at_index(index) else {
            return Ok(());
        };
        let is_explicit = settings.step.is_explicit();
        let may_press = || sources.claims.may_press(flex, sets, flex_bodies);
        let is_touched = body.changes_mass() && (is_explicit || may_press());
        let Some(body) = flex_bodies.at_index_mut(index) else {
            return Ok(());
        };
        let has_changed = body.set_touched(is_touched, is_explicit);
        let mut block = self.pool.take(index, body, &settings.step);
        let own: Vec2 = body.body_force().into();
        let gravity = body.gravity_scale() * from_rapier(sets.gravity) + own;
        let mut outcome = Ok(());
        if !body.is_started() {
            body.start_with(|state, force, prescribed, reaction| {
                outcome = block.start(
                    settings.step,
                    state,
                    &FlexLoad {
                        force,
                        gravity,
                        prescribed,
                        reaction,
                    },
                );
                outcome.is_ok()
            });
        } else if has_changed && is_touched {
            let force = body.nodal_forces().to_vec();
            outcome = block.lose_surface_mass(settings.step, body.state_mut(), &force);
        }
        let rest = body.model().placed_positions();
        let pins = sources
            .under_way
            .pins(index, settings.span, rest, body.prescribed());
        let forces = body.forces_over(settings.step.dt / settings.span.share());
        let load = FlexLoad {
            force: &forces,
            gravity,
            prescribed: pins.as_deref().unwrap_or(body.prescribed()),
            reaction: body.reactions(),
        };
        let outcome = outcome.and_then(|()| block.predict(settings.step, body.state(), &load));
        let reserve = body.energy_reserve();
        self.seats.add_flex((flex, index), (block, reserve), island);
        outcome.map_err(|source| GatherError::Factorization {
            body: handle,
            source,
        })
    }
}

/// The block of a claimed rigid body.
fn claimed_block(
    handle: RigidBodyHandle,
    sources: Sources<'_, '_>,
    masters: &Masters,
) -> Result<Option<RigidBlock>, GatherError> {
    let sets = sources.sets;
    let Some(body) = sets.bodies.get(handle) else {
        return Ok(None);
    };
    let link = link_of(handle, sets.multibody_joints);
    let load = match link {
        Some(link) => load_of_link(link, body, sets),
        None => load_of(body, from_rapier(sets.gravity)),
    };
    let step = &sources.settings.step;
    let (mut motion, acceleration) = match sources.under_way.rigid(handle) {
        Some(known) => known,
        None => {
            let own = (load.drive(), load.inverse_mass);
            let placed = Placed::of(handle, body, sets.multibody_joints);
            masters.motion(handle, (body, placed), own, step.is_within())
        }
    };
    if link.is_none() {
        cap_speed(&mut motion, body, sets.integration_parameters);
    }
    if !is_representable_motion(&motion) || !is_representable_load(&load) {
        return Err(GatherError::RigidBody(handle));
    }
    Ok(Some(RigidBlock::free(motion, acceleration, &load, step)))
}
