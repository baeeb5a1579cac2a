//! What is asked of a solve, and what it tells.

/// What is good enough, and how much work it may take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConeSettings {
    /// The natural-map residual to reach, relative to the largest force (-).
    pub tolerance: f64,
    /// The error of `w` that is good enough whatever the forces are, and the gap that dilation may leave under a sliding contact, in
    /// the unit of `w`.
    pub gap_tolerance: f64,
    /// The part of its slip that sigma may miss (-), which leaves a gap of `mu` times that slip.
    pub slip_tolerance: f64,
    /// Factorizations of `H` in one call.
    pub max_factorizations: usize,
}

impl Default for ConeSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-9,
            gap_tolerance: 0.0,
            slip_tolerance: 1e-3,
            max_factorizations: 100,
        }
    }
}

/// What a solve did and how good the answer is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ConeOutcome {
    /// The natural map of all rows with the slips handed back, in square roots of energy (`sqrt(W_ii) P`), relative to the largest force (-).
    pub residual: f64,
    /// The gap that dilation leaves, `max mu |sigma - |w_t||`, or the overlap that it hides where no force acts, in the unit of `w`.
    pub dilation: f64,
    /// Factorizations of `H`.
    pub n_factorizations: usize,
    /// Analyses of a new pattern.
    pub n_analyses: usize,
    /// Whether both are within the settings.
    pub is_solved: bool,
    /// Whether the interior point was asked.
    pub used_interior_point: bool,
}
