//! What a solve tells about itself.

/// Work and residuals of one solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct IslandSummary {
    /// Newton iterations.
    pub n_newton: usize,
    /// Pivots (active-set iterations) of the complementarity solver and factorizations of sparse contact problems, in all stages.
    pub n_pivots: usize,
    /// Natural-map residual of the last complementarity solve.
    pub residual: f64,
    /// Whether the iterations of the constraint functions failed.
    pub has_failed: bool,
    /// Whether Lagrange multipliers then solved the step.
    pub is_substituted: bool,
    /// Whether the step ended where gaps miss the laws by up to the margin of the path.
    pub is_cut: bool,
    /// Whether the step was stopped at a state on its feasible path.
    pub is_stopped: bool,
    /// Kinetic energy that the loads would give to the members at rest if nothing held them (J).
    pub load_energy: f64,
    /// Whether rows gave way to impulses that jammed.
    pub is_jammed: bool,
    /// Whether bodies that began in each other were pressed apart.
    pub is_parting: bool,
    /// Kinetic energy that this may have brought at most (J): without a bound where joints close whose ends were put apart.
    pub parting_energy: f64,
    /// Largest overlap left at a candidate (m).
    pub gap_violation: f64,
    /// Largest slip that friction wedged against itself has given way by (m).
    pub slip_violation: f64,
    /// What joints and attachments were left open by as they contradict each other, at most (m or rad).
    pub joint_violation: f64,
    /// Energy at the beginning: kinetic, elastic (J).
    pub start_energy: [f64; 2],
    /// Energy at the end: kinetic, elastic with what plastic flow has dissipated (J).
    pub end_energy: [f64; 2],
    /// Work of applied forces, of prescribed bodies and of joints (J).
    pub work: f64,
    /// Work of joints that only hold (J): of long steps, as in truth they do none.
    pub idle_work: f64,
    /// What joints have stopped of the motion of what they hold, which is in their work, but turns into heat (J).
    pub stopped: f64,
    /// Energy taken out by the energy stage (J).
    pub limited: f64,
    /// What of it was taken from all joined motion, as a step far too long leaves no other place to take it from (J).
    pub calmed: f64,
    /// What contact has added and could not take back of the energy that what presses each other had and was brought, of the one that has gained most (-).
    pub added: f64,
    /// `dt²/8 a·M a` at the end of an explicit step (J).
    pub swing: f64,
    /// Kinetic energy of the half step of forward contacts that belongs to this instant and is not in the velocities (J).
    pub pending: f64,
}

impl IslandSummary {
    /// Of a part that has to be cut.
    pub fn stopped() -> Self {
        Self {
            is_stopped: true,
            ..Self::default()
        }
    }

    /// Whether the step ended short of its laws.
    pub fn is_unsolved(&self) -> bool {
        self.is_cut || self.is_stopped
    }

    /// Kinetic and elastic energy that there was, with what loads and driven bodies have added or taken, or might have (J).
    pub fn brought(&self) -> f64 {
        self.start_energy[0] + self.start_energy[1] + self.work.abs() + self.load_energy
    }

    /// The most energy that a step with overlaps may add (J): as much as there was and was brought, but by joints that only hold, and what parting may
    /// bring.
    pub fn most_of_parting(&self) -> f64 {
        let worked = (self.work - self.idle_work).abs();
        self.start_energy[0]
            + self.start_energy[1]
            + worked
            + self.load_energy
            + self.parting_energy
    }
}
