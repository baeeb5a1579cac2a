//! The position stage along a feasible path: from where the bodies are apart, towards where the forces would have them, as far as they
//! stay apart.
//!
//! A *pass* lists the near pairs at the base, solves one contact problem on their rows for new forces, finds where the bodies end under
//! them, and moves the base that way until the time of impact. It is over when the base is where the forces lead and the laws hold
//! there in truth. Whatever the forces are, the base is free of overlaps: what is not solved within the budget stops at the base.

use super::island::{ActiveContact, AtBase, Island, IslandSummary, SolveSettings};
use super::iterate::{ANGLE_TOLERANCE, ROWS_KEPT_FROM};
use super::joint_rows::ActiveJoint;
use super::position::PARTING_RATE;
use crate::constraint::contact::{Candidate, ContactMemory, Pair, Remembered};
use crate::constraint::joint::JointGrip;
use crate::math::exp;

/// Passes in a step. The scenes of the tests take one to four; what needs more is cut.
const MOST_PASSES: usize = 40;

/// Passes of a step that stop short of where the forces lead. Every one of them goes on with forces that do not know what comes after: bodies
/// that are stopped that often meet in ways that the step does not resolve.
const MOST_STOPS: usize = 6;

/// Share of the margin within which the laws hold where the contacts are many (-): a hundred-thousandth moves no force that counts.
const LARGE_TOLERANCE: f64 = 1e-5;

/// Pass from which the laws need only hold to [`CLOSE_ENOUGH`].
const EASED_FROM: usize = 20;

/// Share of the margin by which true gaps may miss what the law asks for (-).
const CLOSE_ENOUGH: f64 = 0.05;

/// Multiple of the tolerance within which the multipliers of the last step are right but for what happened since.
const NEAR: f64 = 1e5;

/// The state at the first impact of a step.
#[derive(Debug, Default)]
pub(super) struct Impact {
    is_known: bool,
    contacts: Vec<ActiveContact>,
    ties: Vec<ActiveJoint>,
    grips: Vec<JointGrip>,
}

/// How the near pairs of a base are listed.
#[derive(Clone, Copy)]
struct Listing<'a> {
    /// Multipliers of the last step, for the first list of a step.
    memory: Option<&'a ContactMemory>,
    /// Whether rows that are at work stay as they are.
    keeps_rows: bool,
    /// Overlap beyond which a contact parts by and by (m), and the share of it that stays for this step.
    slop: f64,
    kept: f64,
}

impl Island {
    /// Solves the positions along the path; returns whether the laws hold. If not, the base and the forces are those of the first impact.
    pub(super) fn follow_path(
        &mut self,
        settings: &SolveSettings,
        memory: &ContactMemory,
        tolerance: f64,
        summary: &mut IslandSummary,
    ) -> bool {
        self.path.rest(&self.blocks);
        self.path
            .list_pressed(&self.pressed_owners, &mut self.pressed_before);
        self.impact.is_known = false;
        self.left.clear();
        let is_solved = self.try_passes(settings, memory, tolerance, summary);
        if !is_solved && self.impact.is_known {
            self.return_to_impact();
        }
        is_solved
    }

    fn try_passes(
        &mut self,
        settings: &SolveSettings,
        memory: &ContactMemory,
        tolerance: f64,
        summary: &mut IslandSummary,
    ) -> bool {
        let kept = exp(-PARTING_RATE * settings.dt);
        let mut listing = Listing {
            memory: Some(memory),
            keeps_rows: false,
            slop: 1e7 * tolerance,
            kept,
        };
        self.list_near(&listing);
        listing.memory = None;
        let mut turned = self.correct();
        let (mut n_stopped, mut n_arrived) = (0, 0);
        for pass in 0..MOST_PASSES {
            summary.n_newton += 1;
            // Under the forces of the last step bodies may be anywhere: that way is gone only if they are nearly right.
            let is_guess = pass == 0 && !(self.contacts.is_empty() && self.ties.is_empty());
            let misleads = is_guess && self.measure(true) > NEAR * tolerance;
            let mut arrives = false;
            let mut error = 0.0;
            if self.leads_around() {
                return false;
            }
            if !misleads {
                arrives = self.path.advance(&self.blocks);
                n_stopped += usize::from(!arrives);
                n_arrived = if arrives { n_arrived + 1 } else { 0 };
                // Where the base has been stopped, geometry is not what the rows were measured in.
                listing.keeps_rows = n_arrived > ROWS_KEPT_FROM;
                self.list_near(&listing);
                error = self.measure(false);
            }
            let has_more = !misleads && self.add_violated(tolerance, kept, memory);
            let enough = self.enough(pass, tolerance);
            let is_close = error <= enough && turned <= ANGLE_TOLERANCE.max(enough);
            if std::env::var("DBG").is_ok() {
                if pass == 6 && !arrives { self.path.debug(); for c in &self.contacts { eprintln!("   row key {:?} base {:?} gap {:.3e} p {:?} n {:?} status {:?} allowance {:.2e}", self.candidates[c.candidate].key, c.base.map(|b| b.gap), c.kinematics.gap, c.multiplier, c.kinematics.normal, c.status, c.allowance); } }
                let w = self.contacts.iter().filter(|c| c.base.is_some()).max_by(|a, b| a.kinematics.gap.abs().total_cmp(&b.kinematics.gap.abs()));
                eprintln!("pass {pass} mis {misleads} arrives {arrives} part {:.3e} error {error:.2e} turned {turned:.1e} more {has_more} contacts {} hit {:?} lost {} worst {:?}", self.path.part, self.contacts.len(), self.path.first, self.contacts.iter().filter(|c| c.is_lost).count(), w.map(|w| (w.kinematics.gap, w.multiplier, w.kinematics.normal, w.slip, w.status)));
            }
            if arrives && is_close && !has_more {
                self.keep_applied_rows();
                return true;
            }
            if !(error + turned).is_finite() || n_stopped > MOST_STOPS {
                return false;
            }
            if !self.ties.is_empty() && pass > 0 && pass % 5 == 0 {
                self.restiffen_turns(settings);
            }
            self.note_left();
            self.turn_signed_rows(!misleads && !listing.keeps_rows);
            let solved = self.solve_multipliers(settings, true, tolerance, summary);
            if solved.is_err() {
                return false;
            }
            if n_stopped > 0 && !self.impact.is_known {
                self.keep_impact();
            }
            turned = self.correct();
        }
        false
    }

    /// How far the laws may be from holding at the end of a pass (m).
    fn enough(&self, pass: usize, tolerance: f64) -> f64 {
        if pass >= EASED_FROM {
            CLOSE_ENOUGH * self.path.least_margin()
        } else if self.is_large() {
            tolerance.max(LARGE_TOLERANCE * self.path.least_margin())
        } else {
            tolerance
        }
    }

    /// Keeps the base of the first impact of a step, and the forces that answer it.
    fn keep_impact(&mut self) {
        self.impact.is_known = true;
        self.impact.contacts.clone_from(&self.contacts);
        self.impact.ties.clone_from(&self.ties);
        self.impact.grips.clone_from(&self.joint_grips);
        self.path.keep_base();
    }

    /// Goes back to the first impact: what met there ends the step where it met, with the velocities of the forces that answer it.
    fn return_to_impact(&mut self) {
        self.contacts.clone_from(&self.impact.contacts);
        self.ties.clone_from(&self.impact.ties);
        self.joint_grips.clone_from(&self.impact.grips);
        self.path.return_to_kept();
        self.correct();
    }

    /// Notes what has slid off the other body of its contact within the step: its force is taken out by the next solve.
    fn note_left(&mut self) {
        let lost = self.contacts.iter().filter(|contact| contact.is_lost);
        let keys = lost.map(|contact| self.candidates[contact.candidate].key);
        self.path.list_left(keys, &mut self.left);
    }

    /// Whether something that has slid off ends, without that contact's force, behind what it met: it would have gone around within the
    /// step.
    fn leads_around(&mut self) -> bool {
        let left = std::mem::take(&mut self.left);
        let is_led = left
            .iter()
            .any(|way| self.path.leads_around(*way, &self.blocks));
        self.left = left;
        self.left.clear();
        is_led
    }

    /// Whether the contacts at hand are solved as a sparse problem.
    fn is_large(&self) -> bool {
        self.is_sparse(2 * self.contacts.len() + self.ties.len())
    }

    /// Lists the near pairs of the base as contacts, and keeps the signed ones. A contact that is near no more stays for one solve, which
    /// takes its force out.
    fn list_near(&mut self, listing: &Listing<'_>) {
        self.path.list_near();
        std::mem::swap(&mut self.contacts, &mut self.contacts_before);
        self.contacts.clear();
        self.slot_of.clear();
        self.slot_of.resize(self.candidates.len(), u32::MAX);
        for (slot, contact) in self.contacts_before.iter().enumerate() {
            self.slot_of[contact.candidate] = slot as u32;
            if contact.base.is_none() {
                self.contacts.push(*contact);
            }
        }
        for near in 0..self.path.near().len() {
            let near = self.path.near()[near];
            let key = self.path.key(&near);
            let law = self.path.law(&near);
            let kinematics = self.path.kinematics(&near);
            let candidates = &mut self.candidates;
            let candidate = *self.near_candidates.entry(key).or_insert_with(|| {
                let pair = Pair::Near {
                    blocks: self.path.blocks_of(&near),
                };
                candidates.push(Candidate { key, pair, law });
                candidates.len() - 1
            });
            let base = AtBase {
                gap: kinematics.gap,
                moved: self.path.moved(&kinematics, &self.blocks),
            };
            let known = self.slot_of.get_mut(candidate);
            let slot = known.map_or(u32::MAX, |slot| std::mem::replace(slot, u32::MAX));
            let mut contact = match self.contacts_before.get(slot as usize) {
                Some(&before) => ActiveContact {
                    applied: before.kinematics,
                    kinematics: if listing.keeps_rows {
                        before.kinematics
                    } else {
                        kinematics
                    },
                    ..before
                },
                None => {
                    let remembered = listing
                        .memory
                        .map_or(Remembered::default(), |memory| memory.recall(&key));
                    let friction = law.friction;
                    let mut contact = ActiveContact::new(
                        candidate,
                        kinematics,
                        remembered,
                        friction,
                        &self.blocks,
                    );
                    if listing.memory.is_some() && base.gap < -listing.slop {
                        contact.allowance = listing.kept * base.gap;
                    }
                    contact
                }
            };
            contact.base = Some(base);
            contact.is_lost = false;
            self.contacts.push(contact);
        }
        for contact in &self.contacts_before {
            let is_left = self.slot_of[contact.candidate] != u32::MAX;
            if is_left && contact.base.is_some() && contact.multiplier != [0.0; 2] {
                self.contacts.push(ActiveContact {
                    applied: contact.kinematics,
                    is_lost: true,
                    ..*contact
                });
            }
        }
    }

    /// Goes back to the rows that the forces of the iterate acted along, with the gaps of the base.
    fn keep_applied_rows(&mut self) {
        for contact in self.contacts.iter_mut().filter(|one| one.base.is_some()) {
            let gap = contact.kinematics.gap;
            contact.kinematics = contact.applied;
            contact.kinematics.gap = gap;
        }
    }

    /// Notes the rows that the forces of signed contacts and joints acted along; with `refreshes` they turn to the measured geometry.
    fn turn_signed_rows(&mut self, refreshes: bool) {
        for contact in self.contacts.iter_mut().filter(|one| one.base.is_none()) {
            contact.applied = contact.kinematics;
            if refreshes {
                let gap = contact.kinematics.gap;
                contact.kinematics = contact.measured;
                contact.kinematics.gap = gap;
                contact.known = None;
            }
        }
        if refreshes {
            self.refresh_joints();
        } else {
            self.keep_joints();
        }
    }
}
