//! Flexible bodies: what they are made of, their shapes, and what holds them.

use super::super::at::{At, Pair};
use super::{half, one, yes};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// What a body is made of.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaterialSpec {
    /// Young's modulus (Pa).
    pub young: At<f64>,
    /// Poisson's ratio (-).
    pub poisson: At<f64>,
    /// Density (kg/m³).
    pub density: At<f64>,
    /// Stiffness damping (s): twice the damping ratio over the frequency in rad/s.
    #[serde(default)]
    pub rayleigh: At<f64>,
    /// Mass damping (1/s).
    #[serde(default)]
    pub drag: At<f64>,
    #[serde(default)]
    pub law: Law,
}

/// A constitutive law.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, Serialize)]
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
    pub shape: At<Shape>,
    /// A material by its name.
    pub material: At<String>,
    /// Materials of regions of the mesh, by the regions' names: physical surfaces of a `.msh`.
    #[serde(default)]
    pub regions: BTreeMap<String, At<String>>,
    /// Where the origin of the shape is put (m).
    #[serde(default)]
    pub translation: At<Pair<f64>>,
    /// By how much it is turned about its origin before (rad).
    #[serde(default)]
    pub rotation: At<f64>,
    /// Velocity of the centre of mass at the beginning (m/s).
    #[serde(default)]
    pub linvel: At<Pair<f64>>,
    /// Angular velocity at the beginning (rad/s).
    #[serde(default)]
    pub angvel: At<f64>,
    /// Thickness out of the plane (m).
    #[serde(default = "one")]
    pub thickness: At<f64>,
    /// Whether it is a body of small strains: stiff, fast to compute.
    #[serde(default)]
    pub small_strain: At<bool>,
    /// Coefficient of friction (-).
    #[serde(default = "half")]
    pub friction: At<f64>,
    /// Coefficient of restitution (-): of impacts shorter than a step, beside what the body's elasticity gives back.
    #[serde(default)]
    pub restitution: At<f64>,
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
    Rectangle {
        size: At<Pair<f64>>,
        cells: At<Pair<usize>>,
    },
    /// About the origin, in cells of about `edge` (m).
    Disc { radius: At<f64>, edge: At<f64> },
    /// About the origin, in cells of about `edge` (m).
    Annulus {
        inner: At<f64>,
        outer: At<f64>,
        edge: At<f64>,
    },
    /// Any polygon with holes, in cells of about `edge` (m).
    Polygon {
        outline: At<Vec<Pair<f64>>>,
        #[serde(default)]
        holes: Vec<At<Vec<Pair<f64>>>>,
        edge: At<f64>,
    },
    /// A mesh of gmsh; its physical curves and points are groups of nodes, its physical surfaces regions.
    Msh { file: At<PathBuf> },
    /// An outline of an SVG or JSON file, in cells of about `edge` (m).
    Outline {
        file: At<PathBuf>,
        edge: At<f64>,
        /// Metres to a unit of the file.
        #[serde(default = "one")]
        scale: At<f64>,
        /// Which outline: the id of an SVG's shape, or of its group (layer), or the name of a feature of JSON. All of the file without.
        #[serde(default)]
        name: Option<At<String>>,
        /// Which of the outlines of that name, counted from 1; needed where there are several.
        #[serde(default)]
        part: Option<At<usize>>,
    },
}

/// Some nodes of a body. Coordinates are those of its shape, before `rotation` and `translation`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum Nodes {
    /// A group of nodes of the mesh, by its name.
    Group(At<String>),
    /// From the lower left to the upper right corner (m), both included; `inf` and `-inf` are bounds too.
    Box(At<Pair<Pair<f64>>>),
    /// The node nearest to a point (m).
    Near(At<Pair<f64>>),
}

/// Nodes that are held.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PinSpec {
    pub nodes: At<Nodes>,
    /// Whether they are held along x.
    #[serde(default = "yes")]
    pub x: bool,
    /// Whether they are held along y.
    #[serde(default = "yes")]
    pub y: bool,
}

/// A force shared by nodes.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ForceSpec {
    pub nodes: Nodes,
    /// All of it (N), in equal parts.
    pub force: At<Pair<f64>>,
}

/// What holds nodes of a flexible body.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Attach {
    pub kind: At<AttachKind>,
    /// The flexible body by name.
    pub body: At<String>,
    /// Nodes of its boundary.
    pub nodes: At<Nodes>,
    /// A rigid or flexible body by name; the world without.
    #[serde(default)]
    pub to: Option<At<String>>,
}

/// How nodes are held.
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
