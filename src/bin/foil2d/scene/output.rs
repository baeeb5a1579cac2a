//! What a run writes.

use super::super::at::{At, Pair};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// What is written.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// The folder, beside the scene.
    pub folder: At<PathBuf>,
    /// Steps from one frame of `vtu` and `replay` to the next. Without it `vtu` has all, and `replay` 30 to a second, or 300 of a shorter run.
    pub every: At<usize>,
    /// Files for ParaView.
    pub vtu: bool,
    /// One page to play the run in a browser.
    pub replay: bool,
    /// A picture of the last step, as SVG.
    pub still: bool,
    /// The same picture as PNG, 1920 pixels wide.
    pub png: bool,
    /// Histories, columns of a table `history.csv` beside energies.
    pub history: Vec<HistorySpec>,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            folder: At::unsaid(PathBuf::from("out")),
            every: At::unsaid(1),
            vtu: false,
            replay: true,
            still: true,
            png: true,
            history: Vec::new(),
        }
    }
}

/// A column, or two, of the table of histories.
#[derive(Clone, Debug, Deserialize, JsonSchema, Serialize)]
#[serde(deny_unknown_fields)]
pub struct HistorySpec {
    /// A flexible or rigid body by name.
    pub body: At<String>,
    pub what: At<Quantity>,
    /// The node of a flexible body nearest to this point of its shape (m), for quantities of nodes; all of the body without.
    #[serde(default)]
    pub near: Option<At<Pair<f64>>>,
    /// What the names of its columns begin with; that of the body without.
    #[serde(default)]
    pub name: Option<At<String>>,
}

/// What a history tells.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Of a node or the centre of mass of a flexible body, of the origin of a rigid one (m).
    Position,
    /// Of a node or the centre of mass (m/s).
    Velocity,
    /// How far the body has turned since the beginning (rad).
    Angle,
    /// Of a body (rad/s).
    AngularVelocity,
    /// On a node or all of the body (N).
    ContactForce,
    /// At a node or all of a flexible body (N).
    Reaction,
    /// At a node, or the largest of a flexible body (Pa).
    VonMises,
}
