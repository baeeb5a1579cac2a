//! What a step tells about itself.

use super::entries::{ConeExcess, ContactReport, EnergyReport, JointReport, Opened, StageTimes};
use super::notes::InsertionNote;
use super::overbent::Overbent;
use super::participant::Participant;
use super::quality::{Quality, Unsolved};
use crate::body::FlexBodyHandle;
use crate::rapier::prelude::{ColliderHandle, RigidBodyHandle};

/// The outcome of the last step.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct StepReport {
    pub(super) contacts: Vec<ContactReport>,
    /// Contacts of the step before, of which those of sleepers are kept.
    pub(super) contacts_before: Vec<ContactReport>,
    /// What the step has given at contacts that are open at its end.
    pub(super) opened: Vec<Opened>,
    pub(super) joints: Vec<JointReport>,
    /// Joints of the step before, likewise.
    pub(super) joints_before: Vec<JointReport>,
    pub(super) energy: EnergyReport,
    pub(super) momentum: [f64; 2],
    pub(super) angular_momentum: f64,
    pub(super) quality: Quality,
    pub(super) unsolved: Vec<Unsolved>,
    /// Told anew of every step.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub(super) overbent: Vec<Overbent>,
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub(super) self_crossing: Vec<FlexBodyHandle>,
    pub(super) gap_violation: f64,
    pub(super) slip_violation: f64,
    pub(super) joint_violation: f64,
    pub(super) complementarity_residual: f64,
    pub(super) cone: ConeExcess,
    pub(super) solver_residual: f64,
    pub(super) energy_limited: f64,
    pub(super) n_islands: usize,
    pub(super) n_claimed: usize,
    pub(super) n_asleep: usize,
    pub(super) is_detected: bool,
    pub(super) n_newton: usize,
    pub(super) n_parts: usize,
    pub(super) n_failed: usize,
    pub(super) n_substituted: usize,
    pub(super) n_jammed: usize,
    pub(super) n_pivots: usize,
    /// What was spent is no state.
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub(super) n_solves: usize,
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub(super) n_tried: usize,
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub(super) n_factorizations: u64,
    #[cfg_attr(feature = "serde-serialize", serde(skip))]
    pub(super) times: StageTimes,
    pub(super) quarantined_flex_bodies: Vec<FlexBodyHandle>,
    pub(super) quarantined_bodies: Vec<RigidBodyHandle>,
    pub(super) quarantined_colliders: Vec<ColliderHandle>,
    pub(super) insertion_notes: Vec<InsertionNote>,
}

impl StepReport {
    /// Closed contacts; of a step that was taken in parts also those that have opened in it, with what they gave.
    pub fn contacts(&self) -> &[ContactReport] {
        &self.contacts
    }

    /// Reactions of joints between claimed bodies, and of attachments; of joints whose bodies sleep, those they fell asleep with.
    pub fn joints(&self) -> &[JointReport] {
        &self.joints
    }

    /// Energy balance.
    pub fn energy(&self) -> &EnergyReport {
        &self.energy
    }

    /// Linear momentum of all flexible and claimed rigid bodies (N s).
    pub fn momentum(&self) -> [f64; 2] {
        self.momentum
    }

    /// Their angular momentum about the origin (N m s).
    pub fn angular_momentum(&self) -> f64 {
        self.angular_momentum
    }

    /// How well the step was solved, that of its worst island: look here first. Whether small strains still describe what was solved is told
    /// by [`Self::overbent`].
    pub fn quality(&self) -> Quality {
        self.quality
    }

    /// The islands that were not solved in one piece, with their bodies.
    pub fn unsolved(&self) -> &[Unsolved] {
        &self.unsolved
    }

    /// Flexible bodies of the step that are bent or stretched beyond what small strains describe: by a hundredth of their lengths. Their
    /// motion is solved, but is that of another body.
    pub fn overbent(&self) -> &[Overbent] {
        &self.overbent
    }

    /// Flexible bodies of large strain whose surfaces crossed themselves where the step began: nothing keeps these out of themselves before they are apart again.
    pub fn self_crossing(&self) -> &[FlexBodyHandle] {
        &self.self_crossing
    }

    /// Largest overlap at the contacts that the step was solved with (m), measured where it ended, in `f64`, or of what rapier's own step has left in
    /// a flexible body; what was put into each other and is not asked to part in this step is left out. Between flexible bodies the contactor's nodes are kept out, not the target's.
    pub fn gap_violation(&self) -> f64 {
        self.gap_violation
    }

    /// Largest slip of the step (m) that friction wedged against itself gave way by: no forces within its law hold such a contact.
    pub fn slip_violation(&self) -> f64 {
        self.slip_violation
    }

    /// Largest distance from where they should be that joints and attachments were left at as they contradict each other (m, or rad of what keeps an angle):
    /// as of a body that is welded to two places which are farther apart than it is long; or that joints of rigid bodies yield by, if that is more than 1e-4 of rapier's length unit (or
    /// rad). What was only put there closes over some steps and does not count. Of an island whose step is not finished all count that are open by more than that.
    pub fn joint_violation(&self) -> f64 {
        self.joint_violation
    }

    /// Largest `|gap|` of a contact that carries a force (m): complementarity.
    pub fn complementarity_residual(&self) -> f64 {
        self.complementarity_residual
    }

    /// Largest excess of a tangential over the admissible force, relative to the largest normal force of the step (-), over the multipliers
    /// of all closed contacts; zero where nothing presses.
    pub fn cone_residual(&self) -> f64 {
        self.cone.residual()
    }

    /// Largest natural-map residual of the complementarity problems (-).
    pub fn solver_residual(&self) -> f64 {
        self.solver_residual
    }

    /// Energy the impact treatment took out of this step (J).
    pub fn energy_limited(&self) -> f64 {
        self.energy_limited
    }

    /// Times that the step was solved: once, and again where a member was thrown beyond where it was looked for, at something that was not in
    /// the problem there; zero where all sleep.
    pub fn n_solves(&self) -> usize {
        self.n_solves
    }

    /// Islands solved.
    pub fn n_islands(&self) -> usize {
        self.n_islands
    }

    /// Whether rapier took a step without length first, to find what may touch; a flexible body far from all others asks for none.
    pub fn is_detected(&self) -> bool {
        self.is_detected
    }

    /// Rigid bodies claimed.
    pub fn n_claimed(&self) -> usize {
        self.n_claimed
    }

    /// Flexible bodies that slept through the step. Their contacts are those they fell asleep with; energies and momentum are those of
    /// what was awake.
    pub fn n_asleep(&self) -> usize {
        self.n_asleep
    }

    /// Most Newton iterations of an island.
    pub fn n_newton(&self) -> usize {
        self.n_newton
    }

    /// Most parts that the step of an island was taken in, zero where there is none: an island that is not solved in one piece is cut in halves, up to
    /// [`FlexParameters::max_cutbacks`](super::FlexParameters::max_cutbacks) times.
    pub fn n_parts(&self) -> usize {
        self.n_parts
    }

    /// Parts of all islands that were tried, with those that had to be cut and those of a step that was begun again: one for each island where
    /// nothing is cut and the step is solved once, else a measure of what it has cost.
    pub fn n_tried(&self) -> usize {
        self.n_tried
    }

    /// Islands in which the iterations of the [constraint functions](crate::kkt::ContactMethod::ConstraintFunction) did not converge:
    /// they were tried again from large `ε` to small.
    pub fn n_failed(&self) -> usize {
        self.n_failed
    }

    /// Islands in which that failed too, so that Lagrange multipliers solved the step.
    pub fn n_substituted(&self) -> usize {
        self.n_substituted
    }

    /// Islands among the [unsolved](Self::unsolved) whose step was cut.
    pub fn n_cut(&self) -> usize {
        self.count_of(Quality::Cut)
    }

    /// Islands among the [unsolved](Self::unsolved) whose step is unfinished.
    pub fn n_unfinished(&self) -> usize {
        self.count_of(Quality::Unfinished)
    }

    /// The name that [`n_cut`](Self::n_cut) had.
    #[deprecated(note = "no step is linearised any more: ask `n_cut`")]
    pub fn n_linearized(&self) -> usize {
        self.n_cut()
    }

    /// The name that [`n_unfinished`](Self::n_unfinished) had.
    #[deprecated(note = "no island is held any more: ask `n_unfinished`")]
    pub fn n_held(&self) -> usize {
        self.n_unfinished()
    }

    fn count_of(&self, quality: Quality) -> usize {
        let unsolved = self.unsolved.iter();
        unsolved.filter(|one| one.quality == quality).count()
    }

    /// Parts of islands in which driven bodies press others that cannot get out: impulses gave way by a thousandth there, and what is driven goes
    /// into what it presses. The overlap is told as ever, see [`Self::gap_violation`].
    pub fn n_jammed(&self) -> usize {
        self.n_jammed
    }

    /// Pivots of the complementarity solver and factorizations of sparse contact problems, in all stages, summed over the islands.
    pub fn n_pivots(&self) -> usize {
        self.n_pivots
    }

    /// Numeric factorizations in this step.
    pub fn n_factorizations(&self) -> u64 {
        self.n_factorizations
    }

    /// Time per stage.
    pub fn times(&self) -> &StageTimes {
        &self.times
    }

    /// Flexible bodies that left the world in this step because their motion would not have been finite: mend them and call
    /// [`FlexBodySet::reinstate`](crate::body::FlexBodySet::reinstate), or remove them.
    pub fn quarantined_flex_bodies(&self) -> &[FlexBodyHandle] {
        &self.quarantined_flex_bodies
    }

    /// Rigid bodies that rapier disabled because their motion was not finite, in either of its two steps; its own list
    /// tells of the second only.
    pub fn quarantined_bodies(&self) -> &[RigidBodyHandle] {
        &self.quarantined_bodies
    }

    /// Colliders that rapier disabled because their shape or pose was not finite.
    pub fn quarantined_colliders(&self) -> &[ColliderHandle] {
        &self.quarantined_colliders
    }

    /// What is likely a mistake in the description of bodies that took their first step in this one: pins that choose no node, bodies put
    /// into each other.
    pub fn insertion_notes(&self) -> &[InsertionNote] {
        &self.insertion_notes
    }

    /// The contacts of a participant: those in which it has the contactor or the target, once where it meets itself.
    pub fn contacts_of(&self, participant: Participant) -> impl Iterator<Item = &ContactReport> {
        let all = self.contacts.iter();
        all.filter(move |contact| [contact.contactor, contact.target].contains(&participant))
    }

    /// Sum of the contact forces on a participant (N), as they act: those of [`ContactReport::force`] and [`ContactReport::midway`], and what the
    /// step has given or taken back at contacts that have opened. Its sum over time is the momentum given.
    pub fn force_on(&self, participant: Participant) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for contact in &self.contacts {
            // What a body does to itself sums to nothing.
            let [as_point, as_target] =
                [contact.contactor, contact.target].map(|one| one == participant);
            let sign = f64::from(as_point) - f64::from(as_target);
            let (force, midway) = (contact.force(), contact.midway);
            sum[0] += sign * (force[0] + midway[0]);
            sum[1] += sign * (force[1] + midway[1]);
        }
        for opened in &self.opened {
            let [as_point, as_target] = opened.between.map(|one| one == participant);
            let sign = f64::from(as_point) - f64::from(as_target);
            sum[0] += sign * opened.force[0];
            sum[1] += sign * opened.force[1];
        }
        sum
    }
}
