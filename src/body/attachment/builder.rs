//! Describing an attachment.

use super::{AttachmentKind, AttachmentTarget};
use crate::body::FlexBodyHandle;
use crate::math::Vec2;
use crate::rapier::prelude::RigidBodyHandle;

/// A condition on where a node is in the mesh's own coordinates (m).
type Region = Box<dyn Fn([f64; 2]) -> bool>;

/// Which nodes are held: those that are named, and those of the boundary that lie in a region.
#[derive(Default)]
pub(crate) struct Choice {
    pub nodes: Vec<usize>,
    pub regions: Vec<Region>,
}

/// What a builder has been told.
pub(crate) struct Plan {
    pub body: FlexBodyHandle,
    pub choice: Choice,
    pub kind: AttachmentKind,
    pub has_rest_length: bool,
    pub target: Option<AttachmentTarget>,
    pub point: Option<Vec2>,
    pub contacts_enabled: bool,
}

/// Describes an attachment for [`FlexBodySet::attach`](crate::body::FlexBodySet::attach): how, which nodes, to what.
///
/// ```
/// use foil2d::prelude::*;
/// use foil2d::rapier::prelude::*;
/// let mut world = PhysicsWorld::new();
/// let mut flex_bodies = FlexBodySet::new();
/// let beam = flex_bodies.insert(
///     FlexBodyBuilder::rectangle([2.0, 0.2], [20, 2])
///         .material(LinearElastic::plane_stress(1e8, 0.3).density(1000.0).rayleigh(1e-2)),
///     &mut world,
/// )?;
/// let wall = world.insert_body(RigidBodyBuilder::fixed());
/// // The left end cannot move or turn.
/// let weld = AttachmentBuilder::weld(beam).where_(|[x, _]| x < 1e-9).to_rigid_body(wall);
/// let weld = flex_bodies.attach(weld, &world.bodies)?;
/// let mut flex = FlexPipeline::new();
/// for _ in 0..600 {
///     flex.step(&mut world, &mut flex_bodies)?;
/// }
/// let weight = 9.81 * flex_bodies[beam].mass();
/// assert!((flex_bodies.attachment(weld)?.force()[1] / weight - 1.0).abs() < 1e-2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use = "an attachment is made by `FlexBodySet::attach`"]
pub struct AttachmentBuilder(pub(crate) Plan);

impl AttachmentBuilder {
    fn new(body: FlexBodyHandle, kind: AttachmentKind) -> Self {
        Self(Plan {
            body,
            choice: Choice::default(),
            kind,
            has_rest_length: false,
            target: None,
            point: None,
            contacts_enabled: matches!(kind, AttachmentKind::Spring { .. }),
        })
    }

    /// Holds the mean of some nodes at a point.
    pub fn pin(body: FlexBodyHandle) -> Self {
        Self::new(body, AttachmentKind::Pin)
    }

    /// Holds every one of some nodes, so that the body keeps its direction there.
    pub fn weld(body: FlexBodyHandle) -> Self {
        Self::new(body, AttachmentKind::Weld)
    }

    /// Pulls the mean of some nodes towards a point, with this stiffness (N/m) and damping (N s/m) along the connection; with a
    /// length at rest of zero in every direction.
    pub fn spring_damper(body: FlexBodyHandle, stiffness: f64, damping: f64) -> Self {
        let kind = AttachmentKind::Spring {
            stiffness,
            damping,
            rest_length: 0.0,
        };
        Self::new(body, kind)
    }

    /// Length of the spring at rest (m); without it, the length it has when it is attached. Pins and welds have none and are refused with it.
    pub fn rest_length(mut self, length: f64) -> Self {
        if let AttachmentKind::Spring { rest_length, .. } = &mut self.0.kind {
            *rest_length = length;
        }
        self.0.has_rest_length = true;
        self
    }

    /// Holds one node, beside those chosen before.
    pub fn node(self, node: usize) -> Self {
        self.nodes([node])
    }

    /// Holds these nodes, beside those chosen before.
    pub fn nodes(mut self, nodes: impl IntoIterator<Item = usize>) -> Self {
        self.0.choice.nodes.extend(nodes);
        self
    }

    /// Holds the nodes of the boundary whose position in the mesh's own coordinates (m), those before the builder's translation and rotation, fulfils a
    /// condition, an edge or a region, beside those chosen before.
    pub fn where_(mut self, choose: impl Fn([f64; 2]) -> bool + 'static) -> Self {
        self.0.choice.regions.push(Box::new(choose));
        self
    }

    /// Attaches to the world.
    pub fn to_world(mut self) -> Self {
        self.0.target = Some(AttachmentTarget::World);
        self
    }

    /// Attaches to a rigid body of any type. A dynamic one is solved together with the flexible body from then on.
    pub fn to_rigid_body(mut self, body: RigidBodyHandle) -> Self {
        self.0.target = Some(AttachmentTarget::RigidBody(body));
        self
    }

    /// Attaches to the surface of another flexible body, where it is nearest. Pins and welds ask that it be no farther than half the
    /// smaller body's size.
    pub fn to_flexible(mut self, body: FlexBodyHandle) -> Self {
        self.0.target = Some(AttachmentTarget::Flexible(body));
        self
    }

    /// The point held or pulled towards: of the world, of the rigid body in its own coordinates, or in the world near the surface of
    /// the flexible one (m). Without it, where the nodes' mean is. Nodes that are elsewhere are pulled there at once, with all the force that this takes: a
    /// point of the world that was meant for a rigid body's own coordinates throws both.
    pub fn at_point(mut self, point: [f64; 2]) -> Self {
        self.0.point = Some(point.into());
        self
    }

    /// Whether both bodies may touch each other: springs let them, pins and welds do not unless told so.
    pub fn contacts_enabled(mut self, enabled: bool) -> Self {
        self.0.contacts_enabled = enabled;
        self
    }
}
