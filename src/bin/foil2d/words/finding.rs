//! What the doctor finds.

use super::super::names::Names;
use super::meshes::rounded;
use foil2d::doctor::Finding;
use foil2d::pipeline::InsertionNote;

/// What is likely a mistake, and what to do.
pub fn of_finding(finding: &Finding, names: &Names) -> String {
    let body = names.of_flexible(finding.body());
    match finding {
        Finding::Sliver { angle, .. } => format!(
            "{body} has a cell with an angle of {angle:.2} degrees, which is stiff and badly conditioned: mesh it anew, or take a point of the outline away"
        ),
        Finding::Locking { ratio, .. } => format!(
            "{body} resists a change of area {ratio:.0} times as much as shear, and its three-node triangles lock: mesh it with triangles of six nodes or quadrilaterals, or take a smaller `poisson`"
        ),
        Finding::FewCells {
            across,
            slenderness,
            ..
        } => format!(
            "{body} is {slenderness:.0} times as long as thick and has {across} three-node triangle(s) across, which are much too stiff in bending: mesh it with triangles of six nodes or quadrilaterals"
        ),
        Finding::Unexamined { .. } => format!(
            "the lowest vibrations of {body} cannot be computed, so that its damping and sag were not looked at: check its material and the shape of its cells"
        ),
        Finding::Overdamped {
            frequency,
            ratio,
            time,
            ..
        } => format!(
            "{body} creeps to where a load takes it in {time:.2} s, as its lowest vibration, of {frequency:.3} rad/s, is damped with a ratio of {ratio:.1}: `rayleigh = {:.3e}` gives a ratio of 0.1",
            0.2 / frequency
        ),
        Finding::Crushed { ratio, .. } => format!(
            "the weight of {body} is {} times what its shear stiffness carries: it collapses; check its size, `young` and `density`",
            rounded(*ratio)
        ),
        Finding::Sagging { sag, size, .. } => format!(
            "{body} of small strain sags by about {sag:.3} m of {size:.3} m, beyond what small strains describe: leave `small_strain` out, or take a stiffer material"
        ),
        Finding::Unstable { critical, dt, .. } => format!(
            "the explicit step of {dt:.3e} s is longer than the critical step of {body}, {critical:.3e} s, and will be refused: shorten `dt`, or take another `integrator`"
        ),
        Finding::Fast { sizes, .. } => format!(
            "{body} moves by {sizes:.1} times its size in a step: nothing is passed through, but an impact is one step; shorten `dt`"
        ),
        Finding::FarAway { distance, edge, .. } => format!(
            "{body} is {distance:.3e} m from the origin, where numbers are coarse beside its shortest edge of {edge:.3e} m: move the scene nearer"
        ),
        Finding::Density { density, .. } => format!(
            "{body} has a density of {density:.3e} kg/m³, that of no solid: check its units"
        ),
        Finding::Insertion(InsertionNote::Overlap { with, .. }) => format!(
            "{body} and {} are put into each other, and part by and by: put them apart",
            names.of_participant(*with)
        ),
        Finding::Insertion(InsertionNote::NothingPinned { .. }) => {
            format!("a `pin` of {body} holds no node")
        }
        Finding::NotMet { with, .. } => format!(
            "{body} goes through {}, whose shape is of voxels or your own",
            names.of_participant(*with)
        ),
        Finding::MassRatio { with, ratio, .. } => format!(
            "the masses of {body} and {} are {ratio:.1e} apart: steps hold, but the lighter one follows the heavier as if it had no mass",
            names.of_participant(*with)
        ),
    }
}
