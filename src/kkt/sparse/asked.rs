//! What is asked of a sparse solve.

use crate::kkt::joints::Rows;
use crate::system::Response;

/// What is asked of a sparse solve.
#[derive(Clone, Copy, Debug)]
pub(in crate::kkt) struct Asked {
    /// What responds.
    pub of: Response,
    /// Which rows of joints the forces act along.
    pub which: Rows,
    /// What the slip of the step is divided by to be of the unit of `free`: `b0` for positions (s²), the step for velocities (s).
    pub unit: f64,
    /// Share of its mobility by which every row gives way beside what it does by itself (-).
    pub give: f64,
}
