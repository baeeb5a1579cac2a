//! The name of a pair of colliders, whichever comes first.

use crate::rapier::prelude::ColliderHandle;

/// Two colliders, in the order of their handles.
pub(super) type PairName = [ColliderHandle; 2];

/// The name of the pair of two colliders.
pub(super) fn pair_name(one: ColliderHandle, other: ColliderHandle) -> PairName {
    if one.into_raw_parts() <= other.into_raw_parts() {
        [one, other]
    } else {
        [other, one]
    }
}
