//! Maps by the names that this crate and rapier give: with a hash for numbers, not one against chosen texts.

use foldhash::fast::FixedState;

/// A map whose order nothing may depend on.
pub type HashMap<K, V> = std::collections::HashMap<K, V, FixedState>;

/// A set whose order nothing may depend on.
pub type HashSet<K> = std::collections::HashSet<K, FixedState>;
