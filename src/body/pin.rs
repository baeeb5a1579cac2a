//! Pins: nodes whose displacement is given.

/// Which directions of a node are pinned, in the world's axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Pin {
    /// The x displacement is given.
    pub x: bool,
    /// The y displacement is given.
    pub y: bool,
}

impl Pin {
    /// Both directions.
    pub const fn both() -> Self {
        Self { x: true, y: true }
    }

    /// The x direction only: a roller that moves in y.
    pub const fn x() -> Self {
        Self { x: true, y: false }
    }

    /// The y direction only: a roller that moves in x.
    pub const fn y() -> Self {
        Self { x: false, y: true }
    }
}
