//! What is asked of the surface of a body: which part of which body a query has hit, what lies inside, what presses, how far it stays from others, and
//! how it meets them.

use super::contact_settings::ContactSettings;
use super::error::{FlexBodyError, check_held};
use super::flex_body::FlexBody;
use super::handle::FlexBodyHandle;
use super::set::FlexBodySet;
use crate::fe::model::Model;
use crate::math::{REAL_EPSILON, Vec2, judged::Judged, node_vec};
use crate::rapier::prelude::{
    ActiveCollisionTypes, ActiveEvents, ActiveHooks, ColliderHandle, InteractionGroups,
};

/// Offset between a flexible surface and what it touches, relative to its shortest edge at rest: far above rounding, far below what
/// the mesh resolves. Between two hundredths and a thousandth of an edge no result depends on it but by its own size.
pub(crate) const OFFSET: Judged = Judged::new("body::OFFSET", 1e-2);

/// Spacings of rapier's numbers, at the coordinates of the body, that an offset is never below: rapier holds poses in it.
const SPACINGS: f64 = 8.0;

/// The offset of a flexible body's surface, with the largest of its coordinates (m).
pub(crate) fn contact_offset(model: &Model, extent: f64) -> f64 {
    let spacing = SPACINGS * REAL_EPSILON * extent;
    (OFFSET * shortest_edge(model)).max(spacing)
}

/// Shortest boundary segment as the body was built (m).
fn shortest_edge(model: &Model) -> f64 {
    shortest_between(model, |node| node_vec(model.placed_positions(), node))
}

/// Shortest boundary segment with the nodes at these places (m).
fn shortest_between(model: &Model, place: impl Fn(usize) -> Vec2) -> f64 {
    let segments = model.mesh().boundary().segments().iter();
    let lengths = segments.map(|[a, b]| (place(*b) - place(*a)).norm_squared());
    lengths.fold(f64::INFINITY, f64::min).sqrt()
}

/// A point on the surface of a body, as its mesh knows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePick {
    /// Boundary segment, an index into [`Boundary::segments`](crate::fe::mesh::Boundary::segments) and into rapier's polyline.
    pub segment: usize,
    /// The segment's nodes.
    pub nodes: [usize; 2],
    /// Barycentric coordinates on it: the shares of both nodes, which add up to one (-).
    pub weights: [f64; 2],
    /// The nearer of both nodes.
    pub node: usize,
    /// The point of the deformed surface (m).
    pub position: [f64; 2],
    /// How far the point asked for is from it (m).
    pub distance: f64,
}

impl FlexBody {
    /// The point of the surface nearest to a point of the world (m), such as the one that a ray has hit.
    ///
    /// ```
    /// use foil2d::prelude::*;
    /// use foil2d::rapier::prelude::*;
    /// let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
    /// let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
    /// let block = FlexBodyBuilder::rectangle([1.0, 1.0], [2, 2]).material(rubber);
    /// let block = flex_bodies.insert(block, &mut world)?;
    /// FlexPipeline::new().step(&mut world, &mut flex_bodies)?;
    /// let ray = Ray::new(Vector::new(0.9, 5.0), Vector::new(0.0, -1.0));
    /// if let Some((collider, distance)) = world.cast_ray(&ray, 10.0, true, QueryFilter::default()) {
    ///     let at = ray.point_at(distance);
    ///     let hit = flex_bodies.pick(collider, [f64::from(at.x), f64::from(at.y)]);
    ///     let (body, pick) = hit.expect("the ray hits the block");
    ///     flex_bodies[body].set_nodal_force(pick.node, [0.0, 10.0])?;
    ///     assert_eq!((body, pick.node), (block, 8));
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn pick(&self, point: [f64; 2]) -> SurfacePick {
        let point = Vec2::from(point);
        let segments = self.mesh().boundary().segments();
        let mut nearest = self.pick_on(0, segments[0], point);
        for (segment, &nodes) in segments.iter().enumerate().skip(1) {
            let found = self.pick_on(segment, nodes, point);
            if found.distance < nearest.distance {
                nearest = found;
            }
        }
        nearest
    }

    fn pick_on(&self, segment: usize, nodes: [usize; 2], point: Vec2) -> SurfacePick {
        let [a, b] = nodes.map(|node| node_vec(self.positions(), node));
        let along = b - a;
        let share = (point - a).dot(&along) / along.norm_squared();
        let share = share.clamp(0.0, 1.0);
        let position = a + share * along;
        SurfacePick {
            segment,
            nodes,
            weights: [1.0 - share, share],
            node: if share <= 0.5 { nodes[0] } else { nodes[1] },
            position: position.into(),
            distance: (point - position).norm(),
        }
    }

    /// Whether a point of the world (m) lies inside the deformed body; on the surface, either.
    ///
    /// Rapier knows the surface only: its point queries do not tell.
    pub fn contains(&self, point: [f64; 2]) -> bool {
        let point = Vec2::from(point);
        let segments = self.mesh().boundary().segments();
        let crossed = segments.iter().filter(|nodes| {
            let [a, b] = nodes.map(|node| node_vec(self.positions(), node));
            let spans = (a.y > point.y) != (b.y > point.y);
            spans && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)
        });
        crossed.count() % 2 == 1
    }

    /// Pressure of contact at a node in the last step (Pa): the normal part of [`FlexBody::contact_force`] over the deformed surface that the
    /// node stands for ([`Boundary::node_shares`](crate::fe::mesh::Boundary::node_shares)), times the thickness. Zero inside.
    ///
    /// A uniform pressure on a smooth surface is met exactly, but for [quadratic surfaces on each other](crate::guide::limits). At a corner what presses
    /// on one side counts along the mean normal of both, over what the node stands for on both: half of it where they are as long as each other. What
    /// is attached to the node counts as contact.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn contact_pressure(&self, node: usize) -> f64 {
        let boundary = self.mesh().boundary();
        let Some(after) = boundary.nodes().iter().position(|&other| other == node) else {
            assert!(node < self.n_nodes(), "a node of the body");
            return 0.0;
        };
        let before = boundary.previous_segment(after);
        let part = |segment: usize, end: usize| {
            let [from, to] =
                boundary.segments()[segment].map(|node| node_vec(self.positions(), node));
            boundary.node_shares(segment)[end] * (to - from)
        };
        let along = part(before, 1) + part(after, 0);
        // The material is on the left of a segment.
        let inward = self.model.thickness() * Vec2::new(-along.y, along.x);
        let squared_area = inward.norm_squared();
        if squared_area > 0.0 {
            node_vec(&self.contact_force, node).dot(&inward) / squared_area
        } else {
            0.0
        }
    }

    /// Distance at which the surface closes with itself and with terrain that has no thickness (m): a hundredth of its shortest edge, more only where rapier's
    /// numbers hold no such distance. Other flexible bodies, and rigid ones with an inside, it touches; these are drawn inwards by as much for
    /// the path that keeps them apart.
    pub fn contact_offset(&self) -> f64 {
        let positions = self.positions();
        let extent = positions.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        contact_offset(self.model(), extent)
    }

    /// The shortest boundary edge of a body (m) so far from the origin that rapier's numbers hold twice its usual
    /// [`contact_offset`](Self::contact_offset) no more.
    pub(crate) fn edge_beside_rounding(&self) -> Option<f64> {
        // As it was drawn: places far away have lost its digits.
        let nodes = self.model().mesh().nodes();
        let edge = shortest_between(self.model(), |node| nodes[node].into());
        (self.contact_offset() > 2.0 * OFFSET.get() * edge).then_some(edge)
    }

    /// Sets how the surface meets others, from the next step on.
    ///
    /// Rapier's collider is given what differs from the settings before; what the user has set on the collider itself stays.
    ///
    /// # Errors
    /// If a coefficient or the skin is negative, or no finite number that rapier's precision holds; nothing is then changed.
    pub fn set_contact_settings(&mut self, settings: ContactSettings) -> Result<(), FlexBodyError> {
        let numbers = [
            settings.friction,
            settings.restitution,
            settings.contact_skin,
        ];
        check_held("the contact settings", &numbers)?;
        if let Some(&value) = numbers.iter().find(|&&value| value < 0.0) {
            return Err(FlexBodyError::Negative(value));
        }
        if settings.contact_force_event_threshold.is_nan() {
            return Err(FlexBodyError::NotFinite("the contact settings"));
        }
        self.change_contact(|contact| *contact = settings);
        Ok(())
    }

    /// Sets which colliders the body meets, from the next step on.
    pub fn set_collision_groups(&mut self, groups: InteractionGroups) {
        self.change_contact(|contact| contact.collision_groups = groups);
    }

    /// Sets which of the colliders it meets the body pushes, from the next step on.
    pub fn set_solver_groups(&mut self, groups: InteractionGroups) {
        self.change_contact(|contact| contact.solver_groups = groups);
    }

    /// Sets which types of rigid bodies the body meets, from the next step on.
    pub fn set_active_collision_types(&mut self, types: ActiveCollisionTypes) {
        self.change_contact(|contact| contact.active_collision_types = types);
    }

    /// Sets which of the user's hooks are asked about the body, from the next step on.
    pub fn set_active_hooks(&mut self, hooks: ActiveHooks) {
        self.change_contact(|contact| contact.active_hooks = hooks);
    }

    /// Sets which events are reported, from the next step on.
    pub fn set_active_events(&mut self, events: ActiveEvents) {
        self.change_contact(|contact| contact.active_events = events);
    }

    /// Makes the body a sensor, which touches nothing, or a solid one again, from the next step on.
    pub fn set_sensor(&mut self, is_sensor: bool) {
        self.change_contact(|contact| contact.is_sensor = is_sensor);
    }

    /// Changes settings; what rapier's collider must be told wakes the body.
    fn change_contact(&mut self, change: impl FnOnce(&mut ContactSettings)) {
        change(&mut self.contact);
        self.is_disturbed |= self.contact != self.carrier_contact;
    }

    /// The settings that rapier's collider was given last and those it should have, if they differ.
    pub(crate) fn take_new_contact(&mut self) -> Option<[ContactSettings; 2]> {
        let given = std::mem::replace(&mut self.carrier_contact, self.contact);
        (given != self.contact).then_some([given, self.contact])
    }

    /// Takes over solver groups that were set on rapier's collider.
    pub(crate) fn adopt_solver_groups(&mut self, groups: InteractionGroups) {
        self.contact.solver_groups = groups;
        self.carrier_contact.solver_groups = groups;
    }
}

impl FlexBodySet {
    /// The body whose surface a collider is.
    pub fn of_collider(&self, collider: ColliderHandle) -> Option<FlexBodyHandle> {
        self.iter()
            .find(|(_, body)| body.collider_handle() == collider)
            .map(|(handle, _)| handle)
    }

    /// What a query of rapier's has hit: the body of the collider, if it is one, and the place on its surface nearest to
    /// the point of the hit (m).
    ///
    /// The point decides and not the feature that rapier tells: a feature of a polyline may name the segment, the same
    /// segment seen from behind, or a vertex.
    pub fn pick(
        &self,
        collider: ColliderHandle,
        point: [f64; 2],
    ) -> Option<(FlexBodyHandle, SurfacePick)> {
        let handle = self.of_collider(collider)?;
        Some((handle, self.get(handle)?.pick(point)))
    }
}
