//! Rigid bodies and their joints.

use super::super::at::{At, Pair};
use super::{half, thousand};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A rigid body, or a collider that nothing moves.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rigid {
    /// What others call it.
    #[serde(default)]
    pub name: Option<At<String>>,
    pub shape: At<RigidShape>,
    #[serde(default)]
    pub kind: At<RigidKind>,
    /// Where the origin of the shape is put (m).
    #[serde(default)]
    pub translation: At<Pair<f64>>,
    /// By how much it is turned about its origin before (rad).
    #[serde(default)]
    pub rotation: At<f64>,
    /// Velocity of the origin at the beginning (m/s); of a kinematic body for ever.
    #[serde(default)]
    pub linvel: At<Pair<f64>>,
    /// Angular velocity (rad/s).
    #[serde(default)]
    pub angvel: At<f64>,
    /// Density (kg/m³), of a body one metre thick.
    #[serde(default = "thousand")]
    pub density: At<f64>,
    /// Coefficient of friction (-).
    #[serde(default = "half")]
    pub friction: At<f64>,
    /// Coefficient of restitution (-).
    #[serde(default)]
    pub restitution: At<f64>,
}

/// How a rigid body moves.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RigidKind {
    /// As forces move it.
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
    /// A disc of this radius (m).
    Ball { radius: At<f64> },
    /// Of this width and height (m).
    Cuboid { size: At<Pair<f64>> },
    /// All that is within a radius (m) of a segment.
    Capsule {
        from: At<Pair<f64>>,
        to: At<Pair<f64>>,
        radius: At<f64>,
    },
    /// The convex hull of points (m).
    Hull { points: At<Vec<Pair<f64>>> },
    /// Segments from point to point (m).
    Polyline { points: At<Vec<Pair<f64>>> },
    /// All that is behind a line through the origin, whose normal points out.
    Halfspace { normal: At<Pair<f64>> },
}

/// A joint between rigid bodies.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    pub kind: JointKind,
    /// Both bodies by name.
    pub between: Pair<At<String>>,
    /// Where (m).
    pub at: At<Pair<f64>>,
    /// Whether the two may touch each other.
    #[serde(default)]
    pub contacts: bool,
}

/// What a joint leaves free.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "snake_case")]
pub enum JointKind {
    /// A turn about the point.
    Revolute,
    /// Nothing.
    Fixed,
    /// A way along an axis of the world.
    Prismatic { axis: At<Pair<f64>> },
}
