//! Scenes as they are written: in TOML, SI units throughout.

use super::at::At;
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A scene of flexible and rigid bodies.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "A foil2d scene")]
pub struct SceneFile {
    #[serde(default = "World::unsaid")]
    pub world: At<World>,
    /// Materials by name.
    #[serde(default)]
    pub materials: BTreeMap<String, At<MaterialSpec>>,
    /// Flexible bodies.
    #[serde(default)]
    pub flexible: Vec<Flexible>,
    /// Rigid bodies, and colliders that nothing moves.
    #[serde(default)]
    pub rigid: Vec<Rigid>,
    /// Joints between rigid bodies.
    #[serde(default)]
    pub joint: Vec<Joint>,
    /// What holds flexible bodies to others or to the world.
    #[serde(default)]
    pub attachment: Vec<Attach>,
    #[serde(default)]
    pub output: Output,
}

/// The world and its steps.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct World {
    /// Gravity (m/s²).
    pub gravity: [f64; 2],
    /// Length of a step (s).
    pub dt: f64,
    /// Length of the run (s).
    pub duration: f64,
    pub integrator: Integrator,
    /// Decay of the `damped` integrator: 1 keeps what the step resolves, 0 damps most (-).
    pub decay: f64,
    /// Whether a step that is not solved ends the run.
    pub refuse_unsolved: bool,
}

impl World {
    fn unsaid() -> At<Self> {
        At::unsaid(Self::default())
    }
}

impl Default for World {
    fn default() -> Self {
        Self {
            gravity: [0.0, -9.81],
            dt: 1.0 / 60.0,
            duration: 5.0,
            integrator: Integrator::Damped,
            decay: 0.9,
            refuse_unsolved: false,
        }
    }
}

/// A member of the Beta-2 family.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// Damps what the step does not resolve.
    #[default]
    Damped,
    /// Keeps energy.
    Trapezoidal,
    /// Explicit: bodies of small strain, and short steps.
    CentralDifference,
}

/// What a body is made of.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaterialSpec {
    /// Young's modulus (Pa).
    pub young: f64,
    /// Poisson's ratio (-).
    pub poisson: f64,
    /// Density (kg/m³).
    pub density: f64,
    /// Stiffness damping (s): twice the damping ratio over the frequency in rad/s.
    #[serde(default)]
    pub rayleigh: f64,
    /// Mass damping (1/s).
    #[serde(default)]
    pub drag: f64,
    #[serde(default)]
    pub law: Law,
}

/// A constitutive law.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Law {
    /// Hooke's in plane stress; neo-Hookean when it is stretched far.
    #[default]
    PlaneStress,
    /// Hooke's in plane strain; neo-Hookean when it is stretched far.
    PlaneStrain,
    /// Stiff, and bends far; plane strain.
    Corotated,
    /// Soft, and may be crushed; plane strain.
    StableNeoHookean,
    /// Never turns inside out; plane strain.
    NeoHookean,
}

/// A flexible body.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Flexible {
    /// What others call it.
    pub name: At<String>,
    pub shape: Shape,
    /// A material by its name.
    pub material: At<String>,
    /// Materials of regions of the mesh, by the regions' names: physical surfaces of a `.msh`.
    #[serde(default)]
    pub regions: BTreeMap<String, At<String>>,
    /// Where the origin of the shape is put (m).
    #[serde(default)]
    pub translation: [f64; 2],
    /// By how much it is turned about its origin before (rad).
    #[serde(default)]
    pub rotation: f64,
    #[serde(default)]
    pub linvel: [f64; 2],
    #[serde(default)]
    pub angvel: f64,
    /// Thickness out of the plane (m).
    #[serde(default = "one")]
    pub thickness: f64,
    /// Whether it is a body of small strains: stiff, fast to compute.
    #[serde(default)]
    pub small_strain: bool,
    #[serde(default = "half")]
    pub friction: f64,
    #[serde(default)]
    pub restitution: f64,
    /// Nodes that are held.
    #[serde(default)]
    pub pin: Vec<PinSpec>,
    /// Forces on nodes.
    #[serde(default)]
    pub force: Vec<ForceSpec>,
}

/// The outline or mesh of a flexible body.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum Shape {
    /// From the origin to `size` (m), in `cells` along x and y.
    Rectangle { size: [f64; 2], cells: [usize; 2] },
    /// About the origin, in cells of about `edge` (m).
    Disc { radius: f64, edge: f64 },
    /// About the origin, in cells of about `edge` (m).
    Annulus { inner: f64, outer: f64, edge: f64 },
    /// Any polygon with holes, in cells of about `edge` (m).
    Polygon {
        outline: Vec<[f64; 2]>,
        #[serde(default)]
        holes: Vec<Vec<[f64; 2]>>,
        edge: f64,
    },
    /// A mesh of gmsh; its physical curves and points are groups of nodes, its physical surfaces regions.
    Msh { file: At<PathBuf> },
    /// An outline of an SVG or JSON file, in cells of about `edge` (m).
    Outline {
        file: At<PathBuf>,
        edge: f64,
        /// Metres to a unit of the file.
        #[serde(default = "one")]
        scale: f64,
        /// Which outline, by the name of its layer or element; the first without.
        #[serde(default)]
        name: Option<At<String>>,
    },
}

/// Some nodes of a body: those of a group, or those in a box of mesh coordinates.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum Nodes {
    /// A group of nodes of the mesh, by its name.
    Group(At<String>),
    /// From the lower left to the upper right corner (m), both included; `inf` and `-inf` are bounds too.
    Box(At<[[f64; 2]; 2]>),
    /// The node nearest to a point (m).
    Near(At<[f64; 2]>),
}

/// Nodes that are held.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PinSpec {
    pub nodes: Nodes,
    #[serde(default = "yes")]
    pub x: bool,
    #[serde(default = "yes")]
    pub y: bool,
}

/// A force shared by nodes.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ForceSpec {
    pub nodes: Nodes,
    /// All of it (N), in equal parts.
    pub force: [f64; 2],
}

/// A rigid body, or a collider that nothing moves.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rigid {
    /// What others call it.
    #[serde(default)]
    pub name: Option<At<String>>,
    pub shape: At<RigidShape>,
    #[serde(default)]
    pub kind: RigidKind,
    #[serde(default)]
    pub translation: [f64; 2],
    #[serde(default)]
    pub rotation: f64,
    #[serde(default)]
    pub linvel: [f64; 2],
    #[serde(default)]
    pub angvel: f64,
    /// Density (kg/m³).
    #[serde(default = "thousand")]
    pub density: f64,
    #[serde(default = "half")]
    pub friction: f64,
    #[serde(default)]
    pub restitution: f64,
}

/// How a rigid body moves.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum RigidKind {
    #[default]
    Dynamic,
    /// Not at all.
    Fixed,
    /// With the velocity it is given.
    Kinematic,
}

/// The shape of a rigid body, about its origin.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum RigidShape {
    Ball {
        radius: f64,
    },
    /// Of this width and height (m).
    Cuboid {
        size: [f64; 2],
    },
    /// A segment with a radius.
    Capsule {
        from: [f64; 2],
        to: [f64; 2],
        radius: f64,
    },
    /// The convex hull of points.
    Hull {
        points: At<Vec<[f64; 2]>>,
    },
    /// Segments from point to point.
    Polyline {
        points: At<Vec<[f64; 2]>>,
    },
    /// All that is behind a line through the origin, whose normal points out.
    Halfspace {
        normal: At<[f64; 2]>,
    },
}

/// A joint between rigid bodies.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    pub kind: JointKind,
    /// Both bodies by name.
    pub between: [At<String>; 2],
    /// Where (m).
    pub at: At<[f64; 2]>,
    /// Whether the two may touch each other.
    #[serde(default)]
    pub contacts: bool,
}

#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum JointKind {
    Revolute,
    Fixed,
    /// Along an axis of the world.
    Prismatic {
        axis: [f64; 2],
    },
}

/// What holds nodes of a flexible body.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Attach {
    pub kind: AttachKind,
    /// The flexible body by name.
    pub body: At<String>,
    pub nodes: Nodes,
    /// A rigid or flexible body by name; the world without.
    #[serde(default)]
    pub to: Option<At<String>>,
}

#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum AttachKind {
    /// Holds the mean of the nodes.
    Pin,
    /// Holds each of the nodes.
    Weld,
    /// Pulls the mean of the nodes (N/m, N s/m).
    Spring { stiffness: f64, damping: f64 },
}

/// What is written.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// The folder, beside the scene.
    pub folder: PathBuf,
    /// Steps from one frame of `vtu` and `replay` to the next.
    pub every: usize,
    /// Files for ParaView.
    pub vtu: bool,
    /// One page to play the run in a browser.
    pub replay: bool,
    /// A picture of the last step.
    pub still: bool,
    /// Histories, columns of a table `history.csv` beside energies.
    pub history: Vec<HistorySpec>,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            folder: PathBuf::from("out"),
            every: 1,
            vtu: false,
            replay: true,
            still: true,
            history: Vec::new(),
        }
    }
}

/// A column, or two, of the table of histories.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HistorySpec {
    /// The flexible body by name.
    pub body: At<String>,
    pub what: Quantity,
    /// The node nearest to this point of the mesh (m), for quantities of nodes; all of the body without.
    #[serde(default)]
    pub near: Option<[f64; 2]>,
}

/// What a history tells.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Of a node or the centre of mass (m).
    Position,
    /// Of a node or the centre of mass (m/s).
    Velocity,
    /// On a node or all of the body (N).
    ContactForce,
    /// At a node or all of the body (N).
    Reaction,
    /// At a node, or the largest (Pa).
    VonMises,
}

fn one() -> f64 {
    1.0
}

fn half() -> f64 {
    0.5
}

fn thousand() -> f64 {
    1000.0
}

fn yes() -> bool {
    true
}
