//! Contacts between bodies that a joint holds: both may hold the same motion.

use super::island::{ActiveContact, Island};

/// Share of its own mobility by which a contact between bodies that a joint holds gives way to its impulse (-).
///
/// Boxes that are hinged at the middle of faces that touch press at both ends of these while the hinge pulls, with forces of any size that change nothing as
/// long as levers stay what they are. They turn within the step, and such forces did work: energy grew by 10⁵. What approaches with `v` so goes on with
/// a thousandth of that, and rounding, of 10⁻⁹ `v`, ends in a millionth of the impulse that stops it.
pub(super) const JOINED: f64 = 1e-3;

impl Island {
    /// Whether a contact is between blocks that a joint holds.
    pub(super) fn is_joined(&self, contact: &ActiveContact) -> bool {
        let [one, .., other] = contact.kinematics.attachments() else {
            return false;
        };
        let pair = [one.block.min(other.block), one.block.max(other.block)];
        self.joined.binary_search(&pair).is_ok()
    }

    /// Lists the pairs of blocks that joints hold.
    pub(super) fn list_joined(&mut self) {
        for tie in &self.ties {
            let grips = &self.joint_grips[tie.row.grips.0..tie.row.grips.1];
            for (at, one) in grips.iter().enumerate() {
                let others = grips[..at].iter().map(|grip| grip.block);
                let others = others.filter(|&other| other != one.block);
                self.joined
                    .extend(others.map(|other| [other.min(one.block), other.max(one.block)]));
            }
        }
        self.joined.sort_unstable();
        self.joined.dedup();
    }
}
