//! What the passes along a feasible path go by, and the places on the way that may end the step.

use super::active_contact::ActiveContact;
use super::feasible::KeptBase;
use super::joints::ActiveJoint;
use super::parting::Parting;
use crate::constraint::contact::Kinematics;
use crate::constraint::joint::JointGrip;

/// A state on the way, with the forces that belong to it.
#[derive(Debug, Default)]
pub(super) struct Waypoint {
    pub is_known: bool,
    pub contacts: Vec<ActiveContact>,
    pub ties: Vec<ActiveJoint>,
    pub grips: Vec<JointGrip>,
    pub base: KeptBase,
    /// How far the laws are from holding, relative to the margins (-).
    pub error: f64,
}

/// An impact of rigid bodies within the step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    /// Index of the contact.
    pub contact: usize,
    /// Its row where the bodies met, or that of the end of the step meanwhile.
    pub other: Kinematics,
    /// For how long the impulse moves the bodies (s).
    pub since: f64,
}

/// What passes go by, with their buffers.
#[derive(Debug, Default)]
pub(super) struct Passes {
    /// Contacts of the list before, and the place of every candidate among them.
    pub contacts_before: Vec<ActiveContact>,
    pub slot_of: Vec<u32>,
    /// Contacts that pressed in the last step, and their candidates in ascending order.
    pub parted: Vec<ActiveContact>,
    pub pressed: Vec<usize>,
    /// Candidates of the contacts at hand in ascending order, while what has parted is looked for.
    pub listed: Vec<usize>,
    /// Contacts that are new in the last list of near pairs.
    pub fresh: Vec<usize>,
    /// Contacts of the last list that have taken over the force of another one.
    pub handed_over: Vec<usize>,
    /// Contacts that may take over the force of one, and how far their normals point its way.
    pub successors: Vec<(usize, f64)>,
    /// The first impact of a step, the best place that the whole of the step has reached, and the best with contacts that slid off.
    pub impact: Waypoint,
    pub arrival: Waypoint,
    pub departure: Waypoint,
    /// Forces before the solve at hand.
    pub before_solve: Waypoint,
    /// Share of its own mobility that every contact gives way by to the change of its force (-).
    pub softness: f64,
    /// What the laws may miss at the very most: the least margin of the ways (m).
    pub margin: f64,
    /// What joints may miss besides where contacts press what they hold (m or rad): what would count as put apart in the next step.
    pub slack: f64,
    /// What the laws missed under the multipliers of the last step (m).
    pub guessed: f64,
    /// Rounding of positions in rapier's numbers (m).
    pub rounding: f64,
    /// Impacts of rigid bodies within the step, and the blocks that may go on from there.
    pub hits: Vec<Hit>,
    pub carried: Vec<bool>,
    pub touching: KeptBase,
    /// Ways that a contact has slid off from.
    pub left: Vec<usize>,
    /// How far apart overlaps and open joints may be asked to go.
    pub parting: Parting,
}
