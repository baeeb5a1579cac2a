//! Equilibrium by time steps much longer than the motion, with a member of Beta-2 that forgets it.
//!
//! `damped(0)` has `β0 = 2`, `β1 = 3/2`, and multiplies a vibration of frequency `ω` by `1/sqrt(1 + (ω dt)²)` per step: at
//! `ω dt = 20` fifteen steps leave 1e-20 of it. What remains is `K u = f`, with contact.

use super::Outcome;
use super::scene::Scene;
use super::sheet::Sheet;
use foil2d::body::BuildError;
use foil2d::integrator::IntegratorError;
use foil2d::prelude::*;

/// Steps until the motion is forgotten.
pub const SETTLE: usize = 15;

/// An empty world whose step is this much longer than the slowest vibration's `1/ω`.
pub fn still(slowest: f64) -> Result<Scene, IntegratorError> {
    Ok(Scene::new(20.0 / slowest, Beta2::damped(0.0)?))
}

/// Prescribes the displacement of nodes in ten equal parts, and settles.
pub fn press(
    scene: &mut Scene,
    sheet: &Sheet,
    body: FlexBodyHandle,
    nodes: &[usize],
    [from, to]: [f64; 2],
) -> Outcome {
    for part in 1..=10 {
        let displacement = from + (to - from) * f64::from(part) / 10.0;
        for &node in nodes {
            scene.bodies[body].set_pin_displacement(node, [0.0, displacement])?;
        }
        scene.steps(sheet.n_steps(3))?;
    }
    scene.steps(sheet.n_steps(SETTLE))?;
    Ok(())
}

/// A grid of `n[0] x n[1]` cells over the unit square, placed by `map`; node `j (n[0] + 1) + i` is corner `(i, j)`.
///
/// Triangles halve the quadrilaterals by diagonals that alternate.
pub fn grid(
    n: [usize; 2],
    kind: CellKind,
    map: impl Fn([f64; 2]) -> [f64; 2],
) -> Result<Mesh, BuildError> {
    let row = n[0] + 1;
    let place = |k: usize| {
        map([
            (k % row) as f64 / n[0] as f64,
            (k / row) as f64 / n[1] as f64,
        ])
    };
    let nodes: Vec<[f64; 2]> = (0..row * (n[1] + 1)).map(place).collect();
    let quads = (0..n[0] * n[1]).map(|cell| {
        let (i, j) = (cell % n[0], cell / n[0]);
        let corner = j * row + i;
        (
            [corner, corner + 1, corner + row + 1, corner + row],
            (i + j) % 2,
        )
    });
    if kind == CellKind::Quad4 {
        let cells: Vec<[usize; 4]> = quads.map(|(quad, _)| quad).collect();
        return Ok(Mesh::from_cells(nodes, kind, &cells)?);
    }
    let halves = quads.flat_map(|([a, b, c, d], odd)| match odd {
        0 => [[a, b, c], [a, c, d]],
        _ => [[a, b, d], [b, c, d]],
    });
    let cells: Vec<[usize; 3]> = halves.collect();
    let mesh = Mesh::from_cells(nodes, CellKind::Tri3, &cells)?;
    Ok(if kind == CellKind::Tri6 {
        mesh.to_tri6()?
    } else {
        mesh
    })
}

/// Nodal forces of a uniform traction along the straight boundary sides whose nodes are all `chosen`.
///
/// - `traction`: force per length (N/m).
pub fn traction(
    mesh: &Mesh,
    kind: CellKind,
    traction: [f64; 2],
    chosen: impl Fn([f64; 2]) -> bool,
) -> Vec<(usize, [f64; 2])> {
    let at = |node: usize| mesh.nodes()[node];
    let mut forces = Vec::new();
    let nodes = mesh.boundary().nodes();
    // On six-node triangles every second boundary node is a midside one, and the loop starts with a corner.
    let (stride, shares): (usize, &[f64]) = match kind {
        CellKind::Tri6 => (2, &[1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0]),
        _ => (1, &[0.5, 0.5]),
    };
    for start in (0..nodes.len()).step_by(stride) {
        let side: Vec<usize> = (0..=stride)
            .map(|k| nodes[(start + k) % nodes.len()])
            .collect();
        if side.iter().all(|&node| chosen(at(node))) {
            let [a, b] = [at(side[0]), at(side[stride])];
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            let pull = |share: f64| traction.map(|t| t * share * length);
            forces.extend(
                side.iter()
                    .zip(shares)
                    .map(|(&node, &share)| (node, pull(share))),
            );
        }
    }
    forces
}

/// Adds nodal forces to a description.
pub fn loaded(builder: FlexBodyBuilder, forces: Vec<(usize, [f64; 2])>) -> FlexBodyBuilder {
    forces.into_iter().fold(builder, |builder, (node, force)| {
        builder.nodal_force(node, force)
    })
}
