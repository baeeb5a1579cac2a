//! The step of an island, on one page: its stages, in order.

use super::follow::joint_violation;
use super::gentle::GAINED;
use super::island::Island;
use super::settings::{KktError, SolveSettings};
use super::summary::IslandSummary;
use super::work::{end_energy, load_energy, start_energy};
use super::{closing, energy, gentle, momentum, position, together};
use crate::constraint::contact::ContactMemory;
use crate::system::Block;

impl Island {
    /// Solves the step for predicted blocks: positions, velocities and contact forces at its end.
    ///
    /// # Errors
    /// If a number is not finite.
    pub fn solve(
        &mut self,
        settings: &SolveSettings,
        memory: &ContactMemory,
    ) -> Result<IslandSummary, KktError> {
        self.problem.n_pivots = 0;
        self.problem.impulse_give = 0.0;
        let summary = solve_stages(self, settings, memory)?;
        Ok(IslandSummary {
            n_pivots: self.problem.n_pivots,
            is_jammed: self.problem.impulse_give > 0.0,
            ..summary
        })
    }
}

fn solve_stages(
    island: &mut Island,
    settings: &SolveSettings,
    memory: &ContactMemory,
) -> Result<IslandSummary, KktError> {
    let mut summary = IslandSummary::default();
    island.problem.solver.set_first(settings.solver);
    if gives_up(island, settings) {
        summary.is_stopped = true;
        return Ok(summary);
    }
    position::solve_positions(island, settings, memory, &mut summary);
    if settings.may_be_cut && summary.is_unsolved() {
        return Ok(summary);
    }
    let before = start_energy(&island.blocks);
    let treatment = settings.treatment();
    summary.start_energy = before;
    let mut contacts = island.contacts.iter();
    let parts = contacts.any(|contact| contact.allowance < 0.0);
    let closes = closing::closes(island);
    summary.load_energy = load_energy(&island.blocks);
    summary.is_parting = parts || closes;
    summary.parting_energy = match (parts, closes) {
        (_, true) => f64::INFINITY,
        (true, false) => gentle::parting_energy(island),
        (false, false) => 0.0,
    };
    let finished = treatment.finish(island, settings, &mut summary);
    let is_unsolved = summary.is_unsolved();
    if finished.is_err() && is_unsolved && !island.path.is_empty() {
        // Forces that are no numbers count no more than those that are too large.
        gentle::end_gently(island, settings, memory, &mut summary)?;
    } else {
        finished?;
    }
    island.joints.settle_damping(&mut island.blocks, settings);
    let joint_work = island.joint_work(settings);
    summary.end_energy = end_energy(&island.blocks);
    let stretched = closing::stretched_by_closing(island, &summary);
    summary.work = island.actual_work(settings) + joint_work.all + stretched;
    (summary.idle_work, summary.stopped) = (joint_work.idle, joint_work.stopped);
    let joints_feed = joint_work.idle > GAINED * summary.brought();
    let is_thrown =
        gentle::is_flung(island) || !summary.is_unsolved() && gentle::is_thrown(island, &summary);
    if (is_thrown || joints_feed) && settings.may_be_cut {
        summary.is_stopped = true;
        return Ok(summary);
    }
    let has_path = !island.path.is_empty();
    if has_path && (is_thrown || gentle::has_gained(island, settings, &summary)) {
        gentle::end_gently(island, settings, memory, &mut summary)?;
    }
    if is_thrown && !has_path || gentle::has_gained(island, settings, &summary) {
        together::end_together(island, (settings.dt, settings.length_unit), &mut summary);
        together::measure_ended(island, settings, &mut summary);
    }
    if treatment.limits_energy() {
        let had = island.reserve();
        limit_energy(island, settings, &mut summary);
        if has_path && gentle::is_fed(island, &summary, had) {
            if settings.may_be_cut {
                summary.is_stopped = true;
                return Ok(summary);
            }
            island.reserves.clone_from(&island.ledgers.had);
            (summary.limited, summary.calmed, summary.added) = (0.0, 0.0, 0.0);
            gentle::end_gently(island, settings, memory, &mut summary)?;
            if gentle::has_gained(island, settings, &summary) {
                together::end_together(island, (settings.dt, settings.length_unit), &mut summary);
                together::measure_ended(island, settings, &mut summary);
            }
            limit_energy(island, settings, &mut summary);
        }
    }
    if summary.is_unsolved() && !island.joints.ties.is_empty() {
        island.joints.measure(&island.blocks);
        summary.joint_violation = joint_violation(island, settings.length_unit, true);
    }
    momentum::count_late_forces(island, settings, memory);
    momentum::publish_forces(island, settings.dt);
    Ok(summary)
}

/// Takes what contact would add; what a step that is unsolved has lost is lost.
fn limit_energy(island: &mut Island, settings: &SolveSettings, summary: &mut IslandSummary) {
    island.ledgers.had.clone_from(&island.reserves);
    energy::limit_energy(island, settings, summary);
    if summary.is_unsolved() {
        for (reserve, had) in island.reserves.iter_mut().zip(&island.ledgers.had) {
            *reserve = reserve.min(had.max(0.0));
        }
    }
}

/// Whether the step is too long for one of its blocks, and may be cut.
fn gives_up(island: &mut Island, settings: &SolveSettings) -> bool {
    let mut is_ambiguous = false;
    for block in &mut island.blocks {
        if let Block::Flex(block) = block {
            block.let_give_up(settings.may_be_cut);
            is_ambiguous |= block.is_ambiguous();
        }
    }
    settings.may_be_cut && is_ambiguous
}
