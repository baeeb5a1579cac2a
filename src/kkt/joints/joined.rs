//! Contacts between bodies that a joint holds: both may hold the same motion.

use super::ActiveJoint;
use crate::constraint::joint::JointGrip;
use crate::kkt::active_contact::ActiveContact;
use crate::math::judged::{Judged, NEGLIGIBLE};

/// Share of its own mobility by which a contact between bodies that a joint holds gives way to its impulse (-).
///
/// Boxes that are hinged at the middle of faces that touch press at both ends of these while the hinge pulls, with forces of any size that change nothing as
/// long as levers stay what they are. They turn within the step, and such forces did work: energy grew by 10⁵. What approaches with `v` so goes on with
/// a thousandth of that, and rounding, of 10⁻⁹ `v`, ends in a millionth of the impulse that stops it.
pub(in crate::kkt) const JOINED: Judged = NEGLIGIBLE;

/// Pairs of blocks that joints hold, in order.
#[derive(Clone, Debug, Default)]
pub(super) struct Joined(Vec<[usize; 2]>);

impl Joined {
    /// Whether a contact is between blocks that a joint holds.
    pub fn has(&self, contact: &ActiveContact) -> bool {
        let [one, .., other] = contact.kinematics.attachments() else {
            return false;
        };
        let pair = [one.block.min(other.block), one.block.max(other.block)];
        self.0.binary_search(&pair).is_ok()
    }

    /// Lists the pairs anew.
    pub fn list(&mut self, ties: &[ActiveJoint], grips: &[JointGrip]) {
        self.0.clear();
        for tie in ties {
            let grips = &grips[tie.row.grips.0..tie.row.grips.1];
            for (at, one) in grips.iter().enumerate() {
                let others = grips[..at].iter().map(|grip| grip.block);
                let others = others.filter(|&other| other != one.block);
                let pairs = others.map(|other| [other.min(one.block), other.max(one.block)]);
                self.0.extend(pairs);
            }
        }
        self.0.sort_unstable();
        self.0.dedup();
    }
}
