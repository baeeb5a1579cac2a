//! Generational handles.

/// Names a flexible body of one set; stays invalid for ever once the body is removed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct FlexBodyHandle {
    pub(super) set: u32,
    pub(super) index: u32,
    pub(super) generation: u32,
}

impl FlexBodyHandle {
    /// Names no flexible body of any set, for what is to be filled in later, as rapier's handles have it.
    pub fn invalid() -> Self {
        Self {
            set: u32::MAX,
            index: u32::MAX,
            generation: u32::MAX,
        }
    }

    /// Position in the set and generation, for display and logs.
    pub fn into_raw_parts(self) -> (u32, u32) {
        (self.index, self.generation)
    }
}

impl Default for FlexBodyHandle {
    /// The [invalid](Self::invalid) one.
    fn default() -> Self {
        Self::invalid()
    }
}
