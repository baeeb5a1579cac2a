//! B48, Cattaneo and Mindlin: two cylinders pressed together and then sheared, by less than what slides.
//!
//! Source: Cattaneo (1938), Mindlin (1949); data of Wriggers, Computational Contact Mechanics (2006), p = .625, q = .05851 on 16.
//!
//! ```text
//!      =======   F, then Q →       R = 8, E = 200, nu = .3, mu = .2
//!      (     )
//!       '-.-'                     sticks within |x| < c, slips up to a
//!       .-'-.
//!      (     )                    halves, held at their flat sides
//!      =======
//! ```
//!
//! Exact: with `1/E* = 2 (1 - ν²)/E` and `1/R* = 2/R`, `a = sqrt(4 F R*/πE*)`, `p0 = 2F/πa`, `c = a sqrt(1 - Q/μF)`; F = 10 and Q = .936 give a = .680778, p0 = 9.351351, c = .496511.
//! The flat sides are held and moved, and a, p0 and c are compared at the forces that result.
//!
//! Where it sticks `q = μ p0 (√(1 - x²/a²) - c/a √(1 - x²/c²))`, so every node there tells c by its ratio `r = q/μp`: `c² = x² + (1 - r)² (a² - x²)`.
//!
//! Excellent: a and p0 1 %, c/a 2 %.

use super::Outcome;
use super::b9::spread;
use super::b10::fitted;
use super::b14::{graded, graded_both};
use super::figure::Figure;
use super::sheet::Sheet;
use super::statics::{SETTLE, grid, still};
use foil2d::fe::mesh::Mesh;
use foil2d::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

const RADIUS: f64 = 8.0;
const CORE: f64 = 0.8;
const FRICTION: f64 = 0.2;
/// How far the upper side goes down, and then sideways, for about the data's F and Q.
const WAYS: [f64; 2] = [0.183, 0.03];

pub fn run(sheet: &mut Sheet) -> Outcome {
    let n = sheet.choose(20, 14);
    sheared(sheet, [n, n], "matching")?;
    sheared(sheet, [n, n + 3], "not matching")
}

/// Cells on the unit of the surface next to the contact, above and below.
fn sheared(sheet: &mut Sheet, [n, n_lower]: [usize; 2], of: &str) -> Outcome {
    let mut scene = still(2.0)?;
    let half = |sign: f64, n: usize| -> Result<Mesh, foil2d::body::BuildError> {
        let m = n + 14;
        let fine = 1.0;
        grid([2 * m, m], CellKind::Quad4, |[s, t]| {
            let depth = graded([fine, RADIUS - CORE], [n, m], t);
            let (sin, cos) = graded_both([fine / RADIUS, FRAC_PI_2], [n, m], s).sin_cos();
            let radius = RADIUS - depth;
            [sign * radius * sin, sign * (RADIUS - radius * cos)]
        })
    };
    let is_side = |[x, y]: [f64; 2]| {
        let above = (y.abs() - RADIUS).abs();
        above < 1e-9 || x.hypot(above) < CORE * (1.0 + 1e-9)
    };
    let body = |mesh: Mesh| {
        FlexBodyBuilder::mesh(mesh)
            .small_strain()
            .material(LinearElastic::plane_strain(200.0, 0.3).density(1.0))
            .friction(FRICTION)
            .pin_where(is_side, Pin::both())
    };
    let upper = scene.add(body(half(1.0, n)?))?;
    scene.add(body(half(-1.0, n_lower)?))?;
    let nodes = scene.body(upper).mesh().nodes();
    let held: Vec<usize> = (0..nodes.len())
        .filter(|&node| is_side(nodes[node]))
        .collect();
    for axis in [1, 0] {
        for part in 1..=10 {
            let share = f64::from(part) / 10.0;
            let displacement = match axis {
                1 => [0.0, -WAYS[0] * share],
                _ => [WAYS[1] * share, -WAYS[0]],
            };
            for &node in &held {
                scene.bodies[upper].set_pin_displacement(node, displacement)?;
            }
            scene.steps(sheet.n_steps(3))?;
        }
        scene.steps(sheet.n_steps(SETTLE))?;
    }
    let [shear, force] = scene.force_on(upper);
    let shear = -shear;
    let compliance = 2.0 * (1.0 - 0.09) / 200.0;
    let a = (4.0 * force * 0.5 * RADIUS * compliance / PI).sqrt();
    let p0 = 2.0 * force / (PI * a);
    let c = a * (1.0 - shear / (FRICTION * force)).sqrt();
    sheet.tell(format!("{of}: force, told for the data's 10"), 10.0, force);
    sheet.tell(
        format!("{of}: shear, told for the data's .936"),
        0.936,
        shear,
    );
    let body = scene.body(upper);
    let surface = body.mesh().boundary().nodes().iter();
    let near = surface.filter(|&&node| body.mesh().nodes()[node][1].abs() < 0.3 * CORE);
    let mut forces: Vec<[f64; 3]> = near
        .map(|&node| {
            let [along, across] = body.contact_force(node);
            // Where it was: the pressed surface is shorter by (1 + ν) (1 - 2ν) p/E, 2 %, which half-spaces of small strains do not know.
            [body.mesh().nodes()[node][0], across, -along]
        })
        .collect();
    forces.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let profile = |k: usize| {
        let pairs: Vec<[f64; 2]> = forces.iter().map(|f| [f[0], f[k]]).collect();
        spread(&pairs)
    };
    let (pressures, shears) = (profile(1), profile(2));
    let loaded: Vec<[f64; 2]> = pressures.iter().copied().filter(|p| p[1] > 0.0).collect();
    // The middle moves along with the shear.
    let middle =
        loaded.iter().map(|p| p[0] * p[1]).sum::<f64>() / loaded.iter().map(|p| p[1]).sum::<f64>();
    let centred: Vec<[f64; 2]> = loaded.iter().map(|p| [p[0] - middle, p[1]]).collect();
    let [found, width] = fitted(&centred, a);
    sheet.relative(format!("{of}: half-width a"), a, width, 1e-2);
    sheet.relative(format!("{of}: largest pressure p0"), p0, found, 1e-2);
    let pairs = pressures.iter().zip(&shears);
    let inner = pairs
        .clone()
        .filter(|(p, _)| (p[0] - middle).abs() < 0.8 * c);
    let squares: Vec<f64> = inner
        .map(|(p, q)| {
            let (x, r) = (p[0] - middle, q[1] / (FRICTION * p[1]));
            x * x + (1.0 - r) * (1.0 - r) * (a * a - x * x)
        })
        .collect();
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    sheet.relative(format!("{of}: c/a"), c / a, mean.sqrt() / a, 2e-2);
    let slipping = pairs.filter(|(p, _)| (1.1 * c..0.95 * a).contains(&(p[0] - middle).abs()));
    let worst = slipping
        .map(|(p, q)| (q[1] / (FRICTION * p[1]) - 1.0).abs())
        .fold(0.0, f64::max);
    // Level and upright parts of forces on surfaces that lean by up to a/R.
    sheet.at_most(format!("{of}: |q|/μp - 1 where it slips (-)"), 2e-2, worst);
    let smooth = pressures.iter().filter(|p| (p[0] - middle).abs() < 0.8 * a);
    let rough = smooth
        .map(|p| {
            let x = (p[0] - middle) / a;
            (p[1] / p0 - (1.0 - x * x).sqrt()).abs()
        })
        .fold(0.0, f64::max);
    sheet.at_most(
        format!("{of}: largest error of a nodal pressure over p0 within .8 a (-)"),
        1e-2,
        rough,
    );
    let curve = |of: &dyn Fn(f64) -> f64| {
        (-100..=100)
            .map(|k| f64::from(k) / 100.0)
            .map(|x| [x, of(x)])
            .collect()
    };
    let root = |x: f64| (1.0 - x * x).max(0.0).sqrt();
    let scaled = |points: &[[f64; 2]], by: f64| {
        points
            .iter()
            .map(|p| [(p[0] - middle) / a, p[1] / by])
            .collect()
    };
    sheet.figure(
        Figure::new(
            if n == n_lower {
                "b48_matching"
            } else {
                "b48_not_matching"
            },
            format!("B48: tractions, meshes {of}"),
            ["x/a (-)", "p/p0, q/μp0 (-)"],
        )
        .exact("pressure", curve(&root))
        .exact(
            "shear",
            curve(&|x| root(x) - c / a * root((x * a / c).clamp(-1.0, 1.0))),
        )
        .dots("pressures of nodes", scaled(&pressures, p0))
        .dots("shears of nodes", scaled(&shears, FRICTION * p0)),
    );
    Ok(())
}
