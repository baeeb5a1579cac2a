//! B14, the flat punch: a rigid face on an elastic body, and the singular pressure under it.
//!
//! Source: Johnson, Contact Mechanics (1985), section 2.8.
//!
//! ```text
//!            |  P
//!         +--v--+   rigid, 2 a wide, no friction
//!   +-----+-----+-----+
//!   |      half-space       |    p = P / (pi sqrt(a² - x²)),   p(0) = 0.3183 P/a
//! ```
//!
//! Data: a = 0.1 m; block 8 × 4 m, E = 1e9, nu = 0.3, cells of a/16 under the punch, growing away from it.
//! Nodes give forces, so the load that the inner part `|x| < s` carries is compared: `2/pi asin(s/a)`.
//!
//! Excellent: 1 % of both with 64 cells across, and half the error with every refinement.

use super::Outcome;
use super::b9::spread;
use super::figure::Figure;
use super::scene::vector;
use super::sheet::Sheet;
use super::statics::{grid, press, still};
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use std::f64::consts::PI;

const HALF_WIDTH: f64 = 0.1;
const SIZE: f64 = 4.0;

/// `n_fine` even cells on `[0, fine]`, then `n - n_fine` growing ones up to `size`, at the fraction `s` of all.
pub fn graded([fine, size]: [f64; 2], [n_fine, n]: [usize; 2], s: f64) -> f64 {
    let k = s * n as f64;
    let h = fine / n_fine as f64;
    if k <= n_fine as f64 {
        return h * k;
    }
    let (rest, m) = (size - fine, (n - n_fine) as f64);
    // h (r^m - 1)/(r - 1) = rest, for the ratio r of neighbours.
    let (mut low, mut high) = (1.0 + 1e-9, 3.0f64);
    for _ in 0..80 {
        let r = 0.5 * (low + high);
        if h * (r.powf(m) - 1.0) / (r - 1.0) > rest {
            high = r
        } else {
            low = r
        }
    }
    fine + h * (low.powf(k - n_fine as f64) - 1.0) / (low - 1.0)
}

/// [`graded`] on both sides of zero, for `s` from 0 to 1.
pub fn graded_both(size: [f64; 2], n: [usize; 2], s: f64) -> f64 {
    let side = 2.0 * s - 1.0;
    // The middle node lies at zero exactly.
    if side.abs() < 1e-9 {
        0.0
    } else {
        side.signum() * graded(size, n, side.abs())
    }
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    let mut figure = Figure::new(
        "b14_pressure",
        "B14: pressure under a flat punch",
        ["x / a (-)", "p a / P (-)"],
    );
    let exact = (-99..100).map(|k| f64::from(k) / 100.0);
    figure = figure
        .exact(
            "exact",
            exact
                .map(|x| [x, 1.0 / (PI * (1.0 - x * x).sqrt())])
                .collect(),
        )
        .within([0.0, 2.0]);
    for n_fine in sheet.choose(vec![8, 16, 32], vec![8, 16]) {
        let profile = punch(n_fine, sheet)?;
        let load: f64 = profile.iter().map(|p| p[1]).sum();
        let inner: f64 = profile
            .iter()
            .filter(|p| p[0].abs() < 0.499 * HALF_WIDTH)
            .map(|p| p[1])
            .sum();
        let edge: f64 = profile
            .iter()
            .filter(|p| (p[0].abs() / HALF_WIDTH - 0.5).abs() < 1e-3)
            .map(|p| 0.5 * p[1])
            .sum();
        // Nodes beside the punch are unloaded, but the last loaded ones stand for half of the way to them.
        let pressures = spread(&profile).into_iter().filter(|p| p[1] > 0.0);
        let scaled: Vec<[f64; 2]> = pressures
            .map(|p| [p[0] / HALF_WIDTH, p[1] * HALF_WIDTH / load])
            .collect();
        let share = (inner + edge) / load;
        let middle = scaled.get(scaled.len() / 2).map_or(f64::NAN, |p| p[1]);
        // The edge node stands for a strip that reaches half a cell too far: an error of the first order.
        let tolerance = 0.3 / n_fine as f64;
        sheet.relative(
            format!("load within a/2, cells of a/{n_fine}, of the total (-)"),
            1.0 / 3.0,
            share,
            tolerance,
        );
        sheet.relative(
            format!("p(0) a/P, cells of a/{n_fine} (-)"),
            1.0 / PI,
            middle,
            tolerance,
        );
        figure = figure.dots(&format!("cells of a/{n_fine}"), scaled);
    }
    sheet.figure(figure);
    Ok(())
}

/// Places and forces of the nodes under the punch (m, N).
fn punch(
    n_fine: usize,
    sheet: &Sheet,
) -> Result<Vec<[f64; 2]>, Box<dyn std::error::Error + Send + Sync>> {
    // sqrt(E/rho) pi/2H
    let mut scene = still(390.0)?;
    let n = 2 * n_fine + 24;
    // Half as fine again to the right of the edge, where the stress is singular too.
    let mesh = grid([2 * n, n], CellKind::Quad4, |[s, t]| {
        let across = graded_both([2.0 * HALF_WIDTH, SIZE], [2 * n_fine, n], s);
        [
            across,
            -graded([2.0 * HALF_WIDTH, SIZE], [2 * n_fine, n], 1.0 - t),
        ]
    })?;
    let block = FlexBodyBuilder::mesh(mesh)
        .small_strain()
        .material(LinearElastic::plane_strain(1e9, 0.3).density(1000.0))
        .friction(0.0)
        .pin_where(|[_, y]| y < -SIZE * (1.0 - 1e-9), Pin::both());
    let block = scene.add(block)?;
    // The face ends a little outside its last node, so that the node and not the corner carries the edge.
    let half = (HALF_WIDTH * (1.0 + 1e-4)) as Real;
    let rigid = ColliderBuilder::cuboid(half, 0.5)
        .translation(vector(0.0, 0.5))
        .friction(0.0);
    scene.world.insert_collider(rigid, None);
    let bottom: Vec<usize> = (0..=2 * n).collect();
    press(&mut scene, sheet, block, &bottom, [0.0, 1e-3])?;
    let body = scene.body(block);
    let top = (n * (2 * n + 1)..(n + 1) * (2 * n + 1)).map(|node| {
        [
            body.mesh().nodes()[node][0],
            body.contact_force(node)[1].abs(),
        ]
    });
    Ok(top.collect())
}
