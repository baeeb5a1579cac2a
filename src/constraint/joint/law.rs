//! Joint laws: what a row's multiplier does about the number `q` that the row measures.

/// How a row is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointLaw {
    /// `q' = goal` at the end of the step, whatever it takes; the goal moves at `rate`.
    Rigid {
        /// Goal at the end of the step (m or rad).
        goal: f64,
        /// Its velocity (m/s or rad/s).
        rate: f64,
    },
    /// `q' >= bound`, by pushing only.
    Limit {
        /// The least value (m or rad).
        bound: f64,
    },
    /// A spring and a damper.
    Spring(Spring),
    /// `dq/dt = rate`, with at most so much force: a motor without slip.
    Drive {
        /// Velocity (m/s or rad/s).
        rate: f64,
        /// Largest force or torque (N or N m).
        most: f64,
    },
}

/// `p = -k (q - rest) - c (dq/dt - rate)`, `|p| <= most`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// `k` (N/m or N m/rad), per unit of the row's own mass if `is_relative` (1/s²).
    pub stiffness: f64,
    /// `c` (N s/m or N m s/rad), per unit of the row's own mass if `is_relative` (1/s).
    pub damping: f64,
    /// Value at which the spring is at rest (m or rad).
    pub rest: f64,
    /// Velocity at which the damper is at rest (m/s or rad/s).
    pub rate: f64,
    /// Largest force or torque, infinite if there is none (N or N m).
    pub most: f64,
    /// Whether both coefficients count per mass that the row moves, `1 / (G M⁻¹ Gᵀ)`.
    pub is_relative: bool,
}

impl Spring {
    /// The coefficients as forces, for a row of mobility `G M⁻¹ Gᵀ` (1/kg).
    pub fn absolute(&self, mobility: f64) -> Self {
        if !self.is_relative {
            return *self;
        }
        let mass = if mobility > 0.0 { 1.0 / mobility } else { 0.0 };
        Self {
            stiffness: mass * self.stiffness,
            damping: mass * self.damping,
            is_relative: false,
            ..*self
        }
    }
}
