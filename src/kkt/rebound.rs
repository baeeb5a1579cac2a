//! What the impact law asks of a contact.

use super::island::{Island, SolveSettings};
use crate::math::Vec2;

/// The velocity along its normal that the impact law asks of a contact at the end of the step (m/s): `e` times the one at which the bodies met,
///
/// ```text
/// v² = v₀² + 2 a s
/// ```
///
/// with the way `s` that they have come together since the step began and the acceleration `a` that loads give to what nothing held. What falls to the
/// ground at the very end of a step has all of the step's speed by then, and rises to where it came from.
pub(super) fn rebound(island: &Island, index: usize, settings: &SolveSettings) -> f64 {
    let contact = &island.contacts[index];
    let law = island.candidates[contact.candidate].law;
    let [approach, _] = contact.approach(&island.blocks);
    if law.restitution <= 0.0 || approach >= 0.0 {
        return 0.0;
    }
    let row = &contact.kinematics;
    let way = row.relative(&island.blocks, |block, grip| block.displacement(grip));
    let loose = row
        .attachments()
        .iter()
        .filter(|a| !is_held(island, a.block));
    let drive: Vec2 = loose
        .map(|a| a.weight * island.blocks[a.block].drive())
        .sum();
    let [way, faster] = [way, drive].map(|along| row.normal.dot(&along));
    let square = approach * approach + 2.0 * faster * way.min(0.0);
    law.rebound(-square.max(0.0).sqrt(), settings.restitution_threshold)
}

/// Whether a block was pressed when the step began, or hangs at something.
fn is_held(island: &Island, block: usize) -> bool {
    let grips = &island.joints.grips;
    let mut pressed = island.pressed_before.iter().flatten();
    pressed.any(|one| *one == block) || grips.iter().any(|grip| grip.block == block)
}
