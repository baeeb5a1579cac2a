//! The joints of an island: rows that hold how bodies lie to each other, or drive it.
//!
//! [`Joints`] owns the rows, what they hold on to and what was found of them; whoever asks for their part of a problem hands in the blocks, and the
//! [problem](super::problem::RowProblem) where it goes.

mod active;
mod coupling;
mod held;
mod joined;
mod laden;
mod law;
mod mobility;
mod rates;
mod rows;
mod stretch;
mod twist;
mod yielding;

pub use self::active::ActiveJoint;
pub(super) use self::joined::JOINED;
pub(super) use self::law::{Finish, put_apart};
pub(super) use self::rows::add_wrench;

use self::joined::Joined;
use self::laden::Laden;
use self::twist::Twists;
use self::yielding::Yielding;
use super::active_contact::ActiveContact;
use crate::constraint::joint::{JointGrip, JointRow, When};
use crate::system::Block;

/// The joints of an island.
#[derive(Debug, Default)]
pub struct Joints {
    /// Their rows, as they were gathered.
    pub rows: Vec<JointRow>,
    /// What these hold on to.
    pub grips: Vec<JointGrip>,
    /// The rows at work; after a solve, what was found of them.
    pub ties: Vec<ActiveJoint>,
    /// The grips when the last iterate was found, and at the end of the step.
    pub(super) applied_grips: Vec<JointGrip>,
    pub(super) end_grips: Vec<JointGrip>,
    /// Blocks that move and the rows that hold them, ascending.
    holders: Vec<(usize, usize)>,
    /// Rows of the problem at hand, after those of contacts; by how much each gives way by itself, and the place of every row in the problem.
    pub(super) listed: Vec<usize>,
    pub(super) gives: Vec<f64>,
    slots: Vec<usize>,
    answer: Vec<f64>,
    twists: Twists,
    joined: Joined,
    laden: Laden,
    yielding: Yielding,
    /// Where in the step the forces of soft rows act.
    acting: When,
}

/// Which rows the forces act along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rows {
    /// Those of the position stage.
    Kept,
    /// Those of the end of the step.
    End,
}

/// The bodies and contacts that joints meet in a problem.
#[derive(Clone, Copy)]
pub(super) struct Among<'a> {
    pub blocks: &'a [Block],
    pub contacts: &'a [ActiveContact],
}
