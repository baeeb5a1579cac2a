//! What is told of a path: its points, its limit points, and what it took to follow it.

/// Where the load factor turns round.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitPoint {
    /// The load factor there (-).
    pub factor: f64,
    /// Whether it is the largest near by, or the smallest.
    pub is_maximum: bool,
    /// Where the nodes are there (m).
    pub positions: Vec<f64>,
}

/// The point that an increment has reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// The load factor (-).
    pub factor: f64,
    /// Its rate along the path (-): negative while the load falls.
    pub rate: f64,
    /// Whether the body would stay there under dead loads and fixed places: the symmetric part of the tangent is definite. If that changes without
    /// a limit point, another path crosses.
    pub is_stable: bool,
    /// Limit points passed so far.
    pub n_limit_points: usize,
}

/// What a path has taken so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathReport {
    /// Increments.
    pub n_increments: usize,
    /// Increments that were halved.
    pub n_cutbacks: usize,
    /// Iterations, failed attempts included.
    pub n_iterations: usize,
    /// Factorizations.
    pub n_factorizations: usize,
    /// Points that ended above the tolerance, where residuals are rounding of the positions.
    pub n_at_rounding: usize,
    /// The largest residual left by the others, over the largest load or reaction (-).
    pub residual: f64,
}
