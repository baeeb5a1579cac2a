//! Carriers: how a flexible body exists in rapier.
//!
//! A dynamic rigid body with all axes locked holds one closed polyline, the body's surface in world coordinates, whose
//! vertices are rewritten in place after every step. Its solver groups are empty, so rapier lists its contacts and
//! pushes nothing.

use crate::body::{
    BuildError, ContactSettings, FlexBody, FlexBodyBuilder, FlexBodyError, FlexBodyHandle,
    FlexBodySet, rest_way,
};
use crate::math::{node_vec, rounding, to_rapier};
use crate::rapier::parry::bounding_volume::Aabb;
use crate::rapier::parry::shape::{Polyline, PolylineFlags};
use crate::rapier::prelude::*;

impl FlexBodySet {
    /// Builds a body and inserts it into the set and the world.
    ///
    /// Bodies that are put into others part from them by and by; the report of the first step lists them:
    /// [`StepReport::insertion_notes`](crate::pipeline::StepReport::insertion_notes).
    ///
    /// # Errors
    /// If the description is wrong; the set and the world are then unchanged.
    pub fn insert(
        &mut self,
        builder: FlexBodyBuilder,
        world: &mut PhysicsWorld,
    ) -> Result<FlexBodyHandle, BuildError> {
        self.insert_with_sets(builder, &mut world.bodies, &mut world.colliders)
    }

    /// [`FlexBodySet::insert`] for programs that keep rapier's sets apart.
    ///
    /// # Errors
    /// If the description is wrong; all sets are then unchanged.
    pub fn insert_with_sets(
        &mut self,
        builder: FlexBodyBuilder,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
    ) -> Result<FlexBodyHandle, BuildError> {
        let can_sleep = builder.can_sleep;
        let mut body = builder.build()?;
        let carrier = bodies.insert(
            RigidBodyBuilder::dynamic()
                .locked_axes(LockedAxes::TRANSLATION_LOCKED | LockedAxes::ROTATION_LOCKED)
                .gravity_scale(0.0)
                .can_sleep(can_sleep)
                .user_data(body.user_data),
        );
        let contact = *body.contact_settings();
        let collider = ColliderBuilder::new(SharedShape::new(surface(&body)))
            .density(0.0)
            .user_data(body.user_data)
            .friction(contact.friction as Real)
            .friction_combine_rule(contact.friction_combine_rule)
            .restitution(contact.restitution as Real)
            .restitution_combine_rule(contact.restitution_combine_rule)
            .collision_groups(contact.collision_groups)
            .solver_groups(InteractionGroups::none())
            .active_collision_types(contact.active_collision_types)
            .active_hooks(contact.active_hooks)
            .active_events(contact.active_events)
            .contact_force_event_threshold(contact.contact_force_event_threshold as Real)
            .contact_skin(contact.contact_skin as Real)
            .sensor(contact.is_sensor);
        let collider = colliders.insert_with_parent(collider, carrier, bodies);
        body.bind(carrier, collider);
        Ok(self.insert_body(body))
    }

    /// Puts a body elsewhere, as it is deformed: its [centre of mass](crate::body::FlexBody::centre_of_mass) (m) and its
    /// [angle](crate::body::FlexBody::angle) (rad). Linear and angular velocity stay, vibrations turn along. The next step wakes it and what
    /// rested on it, and tells what it was put into, as for a body just inserted. Attachments stay, and pull, over any distance.
    /// Queries find it there at once.
    /// [`FlexBodyBuilder::translation`] is where the origin of the mesh is put, which is no centre of mass but for a disc's.
    ///
    /// ```
    /// use foil2d::prelude::*;
    /// use foil2d::rapier::prelude::*;
    /// let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
    /// let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
    /// let block = flex_bodies.insert(FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(rubber), &mut world)?;
    /// flex_bodies.set_position(block, [3.0, 2.0], 0.5, &mut world)?;
    /// let [x, y] = flex_bodies[block].centre_of_mass();
    /// assert!((x - 3.0).abs() < 1e-12 && (y - 2.0).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the handle is stale or foreign, the body is pinned, the world does not hold its carrier, or rapier's precision cannot hold where it
    /// would be. Nothing is then changed.
    pub fn set_position(
        &mut self,
        handle: FlexBodyHandle,
        centre_of_mass: [f64; 2],
        angle: f64,
        world: &mut PhysicsWorld,
    ) -> Result<(), FlexBodyError> {
        let (bodies, colliders) = (&world.bodies, &mut world.colliders);
        self.set_position_with_sets(handle, centre_of_mass, angle, bodies, colliders)?;
        let surface = self.try_get(handle)?.collider_handle();
        // What is out of the world is found nowhere.
        let surface_in_world = (world.colliders.get(surface)).filter(|one| one.is_enabled());
        if let Some(collider) = surface_in_world {
            let aabb = collider.compute_aabb();
            (world.broad_phase).set_aabb(&world.integration_parameters, surface, aabb);
        }
        Ok(())
    }

    /// [`FlexBodySet::set_position`] for programs that keep rapier's sets apart. Queries find the body there after the next step.
    ///
    /// # Errors
    /// As [`FlexBodySet::set_position`].
    pub fn set_position_with_sets(
        &mut self,
        handle: FlexBodyHandle,
        centre_of_mass: [f64; 2],
        angle: f64,
        bodies: &RigidBodySet,
        colliders: &mut ColliderSet,
    ) -> Result<(), FlexBodyError> {
        let body = self.try_get_mut(handle)?;
        if body.fixed_dofs().contains(&true) {
            return Err(FlexBodyError::Pinned(handle));
        }
        if !is_carried(body, bodies, colliders) {
            return Err(FlexBodyError::NoCarrier(handle));
        }
        body.place(centre_of_mass.into(), angle)?;
        if let Some(collider) = colliders.get_mut(body.collider_handle()) {
            place_vertices(body, collider);
        }
        Ok(())
    }

    /// Removes a body from the set and its carrier from the world.
    ///
    /// # Errors
    /// If the handle is stale or foreign, or if the world does not hold the carrier; nothing is then changed.
    pub fn remove(
        &mut self,
        handle: FlexBodyHandle,
        world: &mut PhysicsWorld,
    ) -> Result<FlexBody, FlexBodyError> {
        self.remove_with_sets(
            handle,
            &mut world.islands,
            &mut world.bodies,
            &mut world.colliders,
            &mut world.impulse_joints,
            &mut world.multibody_joints,
            &mut world.soft_bodies,
        )
    }

    /// [`FlexBodySet::remove`] for programs that keep rapier's sets apart.
    ///
    /// # Errors
    /// As [`FlexBodySet::remove`].
    #[expect(clippy::too_many_arguments, reason = "they are rapier's")]
    pub fn remove_with_sets(
        &mut self,
        handle: FlexBodyHandle,
        islands: &mut IslandManager,
        bodies: &mut RigidBodySet,
        colliders: &mut ColliderSet,
        impulse_joints: &mut ImpulseJointSet,
        multibody_joints: &mut MultibodyJointSet,
        soft_bodies: &mut SoftBodySet,
    ) -> Result<FlexBody, FlexBodyError> {
        if !is_carried(self.try_get(handle)?, bodies, colliders) {
            return Err(FlexBodyError::NoCarrier(handle));
        }
        let body = self.take_body(handle)?;
        bodies.remove(
            body.rigid_body_handle(),
            islands,
            colliders,
            impulse_joints,
            multibody_joints,
            soft_bodies,
            true,
        );
        Ok(body)
    }

    /// Removes a body whose carrier is gone from the world already, or kept elsewhere.
    ///
    /// # Errors
    /// If the handle is stale or foreign.
    pub fn forget(&mut self, handle: FlexBodyHandle) -> Result<FlexBody, FlexBodyError> {
        self.take_body(handle)
    }
}

/// Whether these sets hold the carrier of a body, with its surface where the body is: other worlds have equal handles,
/// and the user may have moved the carrier or given it another shape.
pub(crate) fn is_carried(body: &FlexBody, bodies: &RigidBodySet, colliders: &ColliderSet) -> bool {
    let (Some(carrier), Some(collider)) = (
        bodies.get(body.rigid_body_handle()),
        colliders.get(body.collider_handle()),
    ) else {
        return false;
    };
    let is_at_origin = *carrier.position() == Pose::IDENTITY
        && collider.position_wrt_parent() == Some(&Pose::IDENTITY);
    let surface = collider.shape().as_polyline();
    is_at_origin
        && collider.parent() == Some(body.rigid_body_handle())
        && surface.is_some_and(|polyline| {
            let vertices = polyline.vertices();
            vertices.len() == body.mesh().boundary().nodes().len()
                && is_placed(body, vertices, true)
        })
}

/// How far the surface in rapier may lag behind a body at rest, besides what counts as rest, over the size of the coordinates: every write
/// wakes what touches it, and a body at rest still moves by rounding.
const LAG: f64 = if size_of::<Real>() == 4 {
    1e-7
} else {
    rounding::SHARE
};

/// Whether these vertices are where the nodes are, but for a `share` of their coordinates.
/// Whether the vertices are where the nodes are, or so near to them that a body at rest may have moved by it.
fn is_placed(body: &FlexBody, vertices: &[Vector], may_lag: bool) -> bool {
    let (nodes, positions) = (body.mesh().boundary().nodes(), body.positions());
    let mut pairs = nodes.iter().zip(vertices);
    // What was written last is what is asked for most.
    let is_same = pairs.all(|(&node, old)| to_rapier(node_vec(positions, node)) == *old);
    if is_same || !may_lag {
        return is_same;
    }
    let aabb = Aabb::from_points(vertices.iter().copied());
    let reach = f64::from(aabb.mins.abs().max(aabb.maxs.abs()).max_element());
    let way = rest_way(f64::from(aabb.extents().max_element()));
    let lag = (LAG * reach + way) as Real;
    nodes.iter().zip(vertices).all(|(&node, old)| {
        let off = to_rapier(node_vec(positions, node)) - *old;
        off.x.abs() <= lag && off.y.abs() <= lag
    })
}

/// Gives carriers the settings that were changed since the last step, and takes over solver groups set on them: rapier
/// itself must never push a surface.
pub(crate) fn sync_settings(flex_bodies: &mut FlexBodySet, colliders: &mut ColliderSet) {
    for (_, body) in flex_bodies.iter_mut() {
        let handle = body.collider_handle();
        let settings = body.take_new_contact();
        let groups = colliders.get(handle).map(Collider::solver_groups);
        let has_groups = groups.is_some_and(|groups| groups != InteractionGroups::none());
        if settings.is_none() && !has_groups {
            continue;
        }
        body.wake_up();
        let Some(collider) = colliders.get_mut(handle) else {
            continue;
        };
        if let Some(groups) = groups.filter(|_| has_groups) {
            body.adopt_solver_groups(groups);
            collider.set_solver_groups(InteractionGroups::none());
        }
        if let Some([given, wanted]) = settings {
            write_settings(&given, &wanted, collider);
        }
    }
}

/// Writes what differs, so that settings made on the collider itself stay.
fn write_settings(given: &ContactSettings, wanted: &ContactSettings, collider: &mut Collider) {
    let ContactSettings {
        friction,
        friction_combine_rule,
        restitution,
        restitution_combine_rule,
        collision_groups,
        solver_groups: _,
        active_collision_types,
        active_hooks,
        active_events,
        contact_force_event_threshold,
        contact_skin,
        is_sensor,
    } = *wanted;
    if given.friction != friction {
        collider.set_friction(friction as Real);
    }
    if given.friction_combine_rule != friction_combine_rule {
        collider.set_friction_combine_rule(friction_combine_rule);
    }
    if given.restitution != restitution {
        collider.set_restitution(restitution as Real);
    }
    if given.restitution_combine_rule != restitution_combine_rule {
        collider.set_restitution_combine_rule(restitution_combine_rule);
    }
    if given.collision_groups != collision_groups {
        collider.set_collision_groups(collision_groups);
    }
    if given.active_collision_types != active_collision_types {
        collider.set_active_collision_types(active_collision_types);
    }
    if given.active_hooks != active_hooks {
        collider.set_active_hooks(active_hooks);
    }
    if given.active_events != active_events {
        collider.set_active_events(active_events);
    }
    if given.contact_force_event_threshold != contact_force_event_threshold {
        collider.set_contact_force_event_threshold(contact_force_event_threshold as Real);
    }
    if given.contact_skin != contact_skin {
        collider.set_contact_skin(contact_skin as Real);
    }
    if given.is_sensor != is_sensor {
        collider.set_sensor(is_sensor);
    }
}

/// The surface of a body as a closed polyline, material on the left.
fn surface(body: &FlexBody) -> Polyline {
    let boundary = body.mesh().boundary();
    let mut slot = vec![0u32; body.n_nodes()];
    for (index, &node) in boundary.nodes().iter().enumerate() {
        slot[node] = index as u32;
    }
    let vertices = boundary
        .nodes()
        .iter()
        .map(|&node| to_rapier(node_vec(body.positions(), node)))
        .collect();
    let segments = boundary
        .segments()
        .iter()
        .map(|&[a, b]| [slot[a], slot[b]])
        .collect();
    Polyline::with_flags(vertices, Some(segments), PolylineFlags::DEFORMABLE)
}

/// Writes the committed positions over the surface in rapier, if they changed, and tells the broad phase, so that queries see them
/// at once.
pub(crate) fn write_surface(
    body: &FlexBody,
    rests: bool,
    colliders: &mut ColliderSet,
    broad_phase: &mut BroadPhaseBvh,
    parameters: &IntegrationParameters,
) {
    let handle = body.collider_handle();
    let current = colliders
        .get(handle)
        .and_then(|collider| collider.shape().as_polyline());
    if current.is_none_or(|polyline| is_placed(body, polyline.vertices(), rests)) {
        return;
    }
    let Some(collider) = colliders.get_mut(handle) else {
        return;
    };
    place_vertices(body, collider);
    let aabb = collider.compute_aabb();
    broad_phase.set_aabb(parameters, handle, aabb);
}

/// Puts the vertices of a surface where the nodes are.
fn place_vertices(body: &FlexBody, collider: &mut Collider) {
    let nodes = body.mesh().boundary().nodes();
    let Some(polyline) = collider.shape_mut().as_polyline_mut() else {
        return;
    };
    polyline.update_vertices(|vertices| {
        for (vertex, &node) in vertices.iter_mut().zip(nodes) {
            *vertex = to_rapier(node_vec(body.positions(), node));
        }
    });
}
