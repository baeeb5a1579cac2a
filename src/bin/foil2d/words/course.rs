//! What a run was like.

use super::super::names::Names;
use foil2d::doctor::CourseReport;
use std::fmt::Write as _;

/// What a run was like, line by line.
///
/// - `first`, `last`: energy of all bodies after the first step and after the last (J).
pub fn of_course(course: &CourseReport, [first, last]: [f64; 2], names: &Names) -> String {
    let mut told = format!(
        "{} steps, {} cut, {} unfinished; overlaps up to {:.2e} m, joints open up to {:.2e} m\n\
         energy {first:.4e} J after the first step, {last:.4e} J at the end; {:.4e} J dissipated by flexible bodies and what they touched\n",
        course.n_steps,
        course.n_cut,
        course.n_unfinished,
        course.gap_violation,
        course.joint_violation,
        course.dissipated
    );
    if course.has_gained() {
        let _ = writeln!(
            told,
            "{:.4e} J were gained that no load brought, where there were {:.4e} J at most: shorten `dt`",
            course.gained, course.most_energy
        );
    }
    if let Some((body, turn)) = course.turn.filter(|(_, turn)| *turn > 1e-3) {
        let body = names.of_flexible(body);
        let _ = writeln!(told, "{body} turned farthest, by {turn:.3} rad");
    }
    if let Some((body, strain)) = course.neglected_strain {
        let body = names.of_flexible(body);
        let _ = writeln!(
            told,
            "{body} was bent beyond small strains, by {strain:.3}: leave `small_strain` out"
        );
    }
    if let Some(unsolved) = &course.unfinished {
        let bodies = names.of_participants(&unsolved.bodies);
        let _ = writeln!(
            told,
            "steps of {bodies} were not finished: shorten `dt`, or look at what holds them"
        );
    }
    for &body in &course.quarantined {
        let body = names.of_flexible(body);
        let _ = writeln!(
            told,
            "{body} left the world, as it would have moved farther than can be computed"
        );
    }
    told
}
