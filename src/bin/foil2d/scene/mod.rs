//! Scenes as they are written: in TOML, SI units throughout.
//!
//! Keys that both kinds of bodies have are written down at both: what serde flattens neither refuses unknown keys nor knows where its values stand.

mod flexible;
mod output;
mod rigid;

pub use flexible::{Attach, AttachKind, Flexible, Law, MaterialSpec, Nodes, Shape};
pub use output::{HistorySpec, Output, Quantity};
pub use rigid::{Joint, JointKind, Rigid, RigidKind, RigidShape};

use super::at::{At, Pair};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A scene of flexible and rigid bodies. Lengths are in metres, masses in kilograms, times in seconds, angles in radians.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "A foil2d scene")]
pub struct SceneFile {
    #[serde(default)]
    pub world: World,
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
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct World {
    /// Gravity (m/s²).
    pub gravity: At<Pair<f64>>,
    /// Length of a step (s).
    pub dt: At<f64>,
    /// Length of the run (s).
    pub duration: At<f64>,
    pub integrator: At<Integrator>,
    /// Decay of the `damped` integrator: 1 keeps what the step resolves, 0 damps most (-).
    pub decay: At<f64>,
    /// Whether a step that is not solved ends the run.
    pub refuse_unsolved: bool,
    /// Most nodes of all flexible bodies together: a scene of more is refused before it takes all memory.
    pub most_nodes: usize,
}

impl Default for World {
    fn default() -> Self {
        Self {
            gravity: At::unsaid(Pair([0.0, -9.81])),
            dt: At::unsaid(1.0 / 60.0),
            duration: At::unsaid(5.0),
            integrator: At::default(),
            decay: At::unsaid(0.9),
            refuse_unsolved: false,
            most_nodes: MOST_NODES,
        }
    }
}

/// Nodes of all bodies, unless a scene says otherwise.
pub const MOST_NODES: usize = 100_000;

/// A member of the Beta-2 family.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// Damps what the step does not resolve.
    #[default]
    Damped,
    /// Keeps energy.
    Trapezoidal,
    /// Explicit: bodies with `small_strain = true`, and short steps.
    CentralDifference,
}

fn one() -> At<f64> {
    At::unsaid(1.0)
}

fn half() -> At<f64> {
    At::unsaid(0.5)
}

fn thousand() -> At<f64> {
    At::unsaid(1000.0)
}

fn yes() -> bool {
    true
}
