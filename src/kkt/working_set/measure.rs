//! How far the laws of a contact are from holding, measured at an iterate.

use super::{LET_GO, moved, slip};
use crate::constraint::contact::{Candidate, Kinematics, Remembered, Scene};
use crate::kkt::island::{ActiveContact, AtBase};
use crate::linalg::complementarity::Status;
use crate::math::{Vec2, rounding};
use crate::system::Block;

impl ActiveContact {
    /// Where the step began with an overlap beyond `slop`, leaves the share `kept` of it for now.
    pub(super) fn allow_overlap(
        &mut self,
        kept: f64,
        slop: f64,
        candidate: &Candidate,
        scene: &Scene<'_>,
    ) {
        if candidate.began_outside(scene, &self.kinematics, slop) {
            return;
        }
        let (began, is_clear) = match candidate.start_gap(scene) {
            Some(began) => (began, true),
            None => self.estimated_start(slop, scene.blocks),
        };
        // What mostly came within the step is an impact, where a turn blurs its beginning.
        let is_overlap = began < -slop && (is_clear || began < 0.5 * self.kinematics.gap);
        if is_overlap {
            (self.allowance, self.asked) = (kept * began, kept * began);
            self.kinematics.gap -= self.allowance;
            self.measured.gap = self.kinematics.gap;
            self.known = self.known.map(|(gap, at)| (gap - self.allowance, at));
        }
    }

    /// The gap that the step began with as its motion tells (m), and whether a turn does not blur it.
    fn estimated_start(&self, slop: f64, blocks: &[Block]) -> (f64, bool) {
        let Kinematics { gap, normal, .. } = self.kinematics;
        // Along the levers, and as the points really moved: a turning body may have come by either.
        let travelled = self.kinematics.relative(blocks, |block, grip| {
            block.position(grip.point) - block.start_position(grip.point)
        });
        let [linear, travelled] =
            [moved(&self.kinematics, blocks), travelled].map(|path| normal.dot(&path));
        let is_clear = (linear - travelled).abs() <= slop;
        (gap - linear.min(travelled), is_clear)
    }

    pub(in crate::kkt) fn new(
        candidate: usize,
        kinematics: Kinematics,
        remembered: Remembered,
        friction: f64,
        blocks: &[Block],
    ) -> Self {
        let limit = friction * remembered.normal * (1.0 - rounding::SHARE);
        let tangential = if remembered.normal <= 0.0 {
            Status::Open
        } else if remembered.tangent >= limit {
            Status::SlipPositive
        } else if remembered.tangent <= -limit {
            Status::SlipNegative
        } else {
            Status::Stick
        };
        let normal = if remembered.normal > 0.0 {
            Status::Stick
        } else {
            Status::Open
        };
        Self {
            candidate,
            is_hard: kinematics.is_rigid(blocks),
            is_settled: kinematics.is_explicit(blocks),
            is_massless: kinematics.is_massless(blocks),
            kinematics,
            measured: kinematics,
            applied: kinematics,
            // Without friction there is no row that would take back what friction was.
            multiplier: [
                remembered.normal,
                if friction > 0.0 {
                    remembered.tangent
                } else {
                    0.0
                },
            ],
            impulse: [0.0; 2],
            midway: [0.0; 2],
            since_midway: Vec2::zeros(),
            late: [0.0; 2],
            settled: [0.0; 2],
            parting: [0.0; 2],
            rebound: None,
            status: [normal, tangential],
            allowance: 0.0,
            asked: 0.0,
            aside: 0.0,
            known: Some((kinematics.gap, moved(&kinematics, blocks))),
            apart: 0.0,
            losses: 0,
            is_lost: false,
            slip: 0.0,
            slip_before: 0.0,
            unresolved: 0.0,
            rigid: 0.0,
            yielding: [0.0; 2],
            mobility: None,
            remembered,
            base: None,
        }
    }

    /// Follows gap and slip from the base, from where the points have moved `onward`; returns how far the laws are from holding (m).
    pub(super) fn measure_from(&mut self, base: AtBase, onward: Vec2, friction: f64) -> f64 {
        let Kinematics { normal, .. } = self.kinematics;
        let gap = base.gap + normal.dot(&onward) - self.allowance;
        self.kinematics.gap = gap;
        let moved = self
            .kinematics
            .tangent()
            .dot(&(base.moved + onward - base.carried));
        self.slip = moved + self.slip_before - self.aside;
        self.violation(friction)
    }

    /// How far the laws were from holding at the last measurement (m).
    fn violation(&self, friction: f64) -> f64 {
        // The force of what is lost is still in the iterate: far from holding, but a number.
        if self.is_lost || self.slides_off() {
            return f64::MAX;
        }
        let [gap, slip] = self.rest();
        self.law_error(gap, slip, friction)
    }

    /// The same, but by no more than the force that is too much, or missing, moves the contact where that is known (m).
    pub(in crate::kkt) fn shortfall(&self, friction: f64) -> f64 {
        let violation = self.violation(friction);
        let Some(mobility) = self.mobility else {
            return violation;
        };
        let [normal, tangential] = self.multiplier;
        if self.is_lost || self.slides_off() {
            return f64::max(mobility[0] * normal, mobility[1] * tangential.abs());
        }
        let [gap, slip] = self.rest();
        let missing = friction * normal + slip.signum() * tangential;
        let moved = f64::max(mobility[0] * normal, mobility[1] * missing);
        violation.min(moved).max(-gap)
    }

    /// Whether it stands for vertices that are held together no longer.
    fn slides_off(&self) -> bool {
        let is_meeting = self.base.is_some_and(|base| base.is_meeting);
        is_meeting && self.status[1] != Status::Stick
    }

    /// Gap and slip (m). What gives way rests nearer by that much: so was it solved.
    fn rest(&self) -> [f64; 2] {
        let yielded = [0, 1].map(|k| self.yielding[k] * self.multiplier[k]);
        [self.kinematics.gap + yielded[0], self.slip + yielded[1]]
    }

    /// How far Signorini's and Coulomb's laws are from holding (m).
    fn law_error(&self, gap: f64, slip: f64, friction: f64) -> f64 {
        if self.multiplier[0] <= 0.0 {
            return -gap;
        }
        let slip = if friction > 0.0 {
            match self.status[1] {
                Status::SlipPositive => slip,
                Status::SlipNegative => -slip,
                Status::Stick | Status::Open => slip.abs(),
            }
        } else {
            0.0
        };
        gap.abs().max(slip)
    }

    /// Measures gap and slip; returns how far the laws are from holding (m).
    pub(super) fn measure(
        &mut self,
        candidate: &Candidate,
        scene: &Scene<'_>,
        extrapolates: bool,
    ) -> f64 {
        let at = moved(&self.kinematics, scene.blocks);
        let is_asked = !(extrapolates && self.known.is_some());
        let gap = if is_asked {
            self.true_gap(candidate, scene, at)
        } else {
            self.extrapolated(at)
        };
        self.kinematics.gap = gap;
        self.known = Some((gap, at));
        let mut error = if self.is_lost { 0.0 } else { -gap };
        if self.multiplier[0] <= 0.0 {
            return error;
        }
        if is_asked {
            error = error.max(self.apart);
        }
        let carried = candidate.law.carried.dot(&self.kinematics.tangent());
        self.slip = slip(&self.kinematics, scene.blocks) - self.aside - carried;
        let [gap, slip] = self.rest();
        error.max(self.law_error(gap, slip, candidate.law.friction))
    }

    /// The gap beyond the allowance where the blocks are, with the points moved to `at` (m).
    fn true_gap(&mut self, candidate: &Candidate, scene: &Scene<'_>, at: Vec2) -> f64 {
        let Some(found) = candidate.evaluate(scene, &self.remembered) else {
            self.note_loss(candidate.distance(scene));
            return if self.is_lost {
                self.extrapolated(at)
            } else {
                self.apart
            };
        };
        self.measured = found;
        (self.is_lost, self.apart) = (false, 0.0);
        found.gap - self.allowance
    }

    /// The gap that follows the row from where it was measured last, to where the points have moved `at` (m).
    fn extrapolated(&self, at: Vec2) -> f64 {
        match self.known {
            Some((gap, from)) => gap + self.kinematics.normal.dot(&(at - from)),
            None => self.kinematics.gap,
        }
    }

    /// Notes that geometry has no gap, with bodies this far `apart` (m). The contact is let go, as the neighbour that it slid to
    /// takes over; one that comes and goes presses on the edge between both, as far as bodies touch.
    fn note_loss(&mut self, apart: f64) {
        if self.apart == 0.0 {
            self.losses = self.losses.saturating_add(1);
        }
        self.is_lost = self.losses <= LET_GO;
        self.apart = apart;
    }
}

#[cfg(test)]
mod tests {
    use super::super::gap_violation;
    use super::*;
    use crate::constraint::contact::Remembered;
    use crate::kkt::Island;
    use crate::path::{NearPair, Target};

    /// A step that is stopped ends at the base: the overlap there is told, not where forces would have led.
    #[test]
    fn a_stopped_step_tells_the_overlap_of_its_base() {
        let row = Kinematics::with_levers(-5.0, Vec2::new(0.0, 1.0), Vec2::zeros(), &[]);
        let mut contact = ActiveContact::new(0, row, Remembered::default(), 0.5, &[]);
        contact.base = Some(AtBase {
            gap: -0.1,
            moved: Vec2::zeros(),
            carried: Vec2::zeros(),
            near: NearPair {
                pair: 0,
                point: 0,
                target: Target::Vertex(0),
                xi: 0.0,
                normal: Vec2::new(0.0, 1.0),
                distance: 0.0,
                key: 0,
            },
            is_meeting: false,
        });
        let mut island = Island::default();
        island.contacts.push(contact);
        assert_eq!(gap_violation(&island, true), 0.1);
        assert_eq!(gap_violation(&island, false), 5.0);
        // A signed row has no base: it is measured where the blocks are.
        island.contacts[0].base = None;
        assert_eq!(gap_violation(&island, true), 5.0);
    }

    #[test]
    fn what_gives_way_to_its_force_holds_to_its_law_where_it_rests() {
        let row = Kinematics::with_levers(-3e-8, Vec2::new(0.0, 1.0), Vec2::zeros(), &[]);
        let remembered = Remembered {
            normal: 2.0,
            ..Remembered::default()
        };
        let mut contact = ActiveContact::new(0, row, remembered, 0.0, &[]);
        assert!(contact.shortfall(0.0) >= 3e-8);
        contact.yielding = [1.5e-8, 0.0];
        assert!(contact.shortfall(0.0) < 1e-20);
    }

    /// A thousandth of what the force alone would move it, against the force.
    #[test]
    fn what_sticks_and_gives_way_to_its_friction_holds_to_its_law_there_and_nowhere_else() {
        let row = Kinematics::with_levers(0.0, Vec2::new(0.0, 1.0), Vec2::zeros(), &[]);
        let remembered = Remembered {
            normal: 2.0,
            ..Remembered::default()
        };
        let mut contact = ActiveContact::new(0, row, remembered, 0.5, &[]);
        contact.multiplier = [2.0, -0.5];
        contact.status = [Status::Stick; 2];
        contact.slip = 4e-6;
        assert!((contact.shortfall(0.5) - 4e-6).abs() < 1e-18);
        contact.yielding = [0.0, 8e-6];
        assert!(contact.shortfall(0.5) < 1e-18);
        contact.slip = -4e-6;
        assert!((contact.shortfall(0.5) - 8e-6).abs() < 1e-18);
    }

    /// A force of a millionth of a newton that is left where the bodies are 2 mm apart, and slide, moves them by nothing.
    #[test]
    fn what_is_wrong_counts_by_the_motion_that_its_force_makes() {
        let row = Kinematics::with_levers(2e-3, Vec2::new(0.0, 1.0), Vec2::zeros(), &[]);
        let remembered = Remembered {
            normal: 1e-6,
            ..Remembered::default()
        };
        let mut contact = ActiveContact::new(0, row, remembered, 0.5, &[]);
        contact.status = [Status::Stick; 2];
        contact.slip = 1e-3;
        assert_eq!(contact.shortfall(0.5), 2e-3);
        contact.mobility = Some([1e-4; 2]);
        assert!(contact.shortfall(0.5) <= 1e-10);
        contact.is_lost = true;
        assert!(contact.shortfall(0.5) <= 1e-10);
        (contact.is_lost, contact.kinematics.gap) = (false, -3e-5);
        assert_eq!(contact.shortfall(0.5), 3e-5);
        assert_eq!(contact.violation(0.5), 1e-3);
    }
}
