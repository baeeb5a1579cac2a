//! B49, shallow ironing: a stiff block with a round bottom is pressed into a foundation and drawn along it.
//!
//! Source: Fischer and Wriggers (2006).
//!
//! ```text
//!   +----+  →  10 in t 1..2
//!   |    |                        block 1.2 wide, sides .9, bottom arc of sagitta .3, at x = .2 .. 1.4,
//!    '--'  ↓ 1 in t 0..1          .2 above; E = 6896 and nu = .32, mu = .3
//!  +---------------------------+
//!  |  12 x 4, E = 689.6        |  neo-Hookean, plane strain, in N and mm
//!  +===========================+
//! ```
//!
//! No exact answer: six codes have V(1) of 268 to 332 N/mm, V(1.5) of 337 to 421, and H/V of .30 to .53 while it slides. Below `μ` = .3 it cannot be where the block ploughs, and what is above comes
//! of the bow wave that it pushes.
//!
//! Excellent: inside the bracket, H/V of .30 to .36 in the middle of the way.

use super::Outcome;
use super::figure::Figure;
use super::scene::Scene;
use super::sheet::Sheet;
use super::statics::grid;
use foil2d::prelude::*;

pub fn run(sheet: &mut Sheet) -> Outcome {
    let (n, dt) = sheet.choose((40, 0.005), (24, 0.01));
    let mut scene = Scene::new(dt, Beta2::damped(0.0)?);
    let material = |young: f64| LinearElastic::plane_strain(young, 0.32).density(1e-3);
    let foundation = grid([n, n / 4], CellKind::Tri6, |[s, t]| {
        [12.0 * s, 4.0 * t - 4.0]
    })?;
    let foundation = FlexBodyBuilder::mesh(foundation)
        .material(material(689.6))
        .friction(0.3)
        .pin_where(|[_, y]| y == -4.0, Pin::both());
    // An arc of chord 1.2 and sagitta .3 has the radius .75.
    let block = grid([6, 6], CellKind::Tri6, |[s, t]| {
        let x = 1.2 * s - 0.6;
        let bottom = 0.75 - (0.75 * 0.75 - x * x).sqrt();
        [x + 0.8, 0.2 + bottom + t * (1.2 - bottom)]
    })?;
    let is_top = |[_, y]: [f64; 2]| y > 1.4 - 1e-9;
    let block = FlexBodyBuilder::mesh(block)
        .material(material(6896.0))
        .friction(0.3)
        .pin_where(is_top, Pin::both());
    let foundation = scene.add(foundation)?;
    let block = scene.add(block)?;
    let nodes = scene.body(block).mesh().nodes();
    let top: Vec<usize> = (0..nodes.len())
        .filter(|&node| is_top(nodes[node]))
        .collect();
    let n_steps = sheet.n_steps((2.0 / dt) as usize);
    let mut curves = [Vec::new(), Vec::new()];
    for step in 1..=n_steps {
        let t = step as f64 * dt;
        let displacement = [10.0 * (t - 1.0).max(0.0), -t.min(1.0)];
        for &node in &top {
            scene.bodies[block].set_pin_displacement(node, displacement)?;
        }
        scene.step()?;
        let [x, y] = scene.force_on(foundation);
        curves[0].push([t, x]);
        curves[1].push([t, -y]);
    }
    let [along, across] = &curves;
    let mean = |curve: &[[f64; 2]], from: f64, to: f64| {
        let chosen: Vec<f64> = curve
            .iter()
            .filter(|p| (from..to).contains(&p[0]))
            .map(|p| p[1])
            .collect();
        chosen.iter().sum::<f64>() / chosen.len().max(1) as f64
    };
    let bracket = |sheet: &mut Sheet, name: &str, [low, high]: [f64; 2], found: f64| {
        sheet.absolute(name, 0.5 * (low + high), found, 0.5 * (high - low));
    };
    let pressed = mean(across, 1.0 - 1.5 * dt, 1.0 + 0.5 * dt);
    bracket(
        sheet,
        "V(1), of a bracket 268 to 332 (N/mm)",
        [268.0, 332.0],
        pressed,
    );
    let sliding = mean(across, 1.45, 1.55);
    bracket(
        sheet,
        "V(1.5), of a bracket 337 to 421 (N/mm)",
        [337.0, 421.0],
        sliding,
    );
    let ratio = mean(along, 1.3, 1.7) / mean(across, 1.3, 1.7);
    bracket(
        sheet,
        "H/V for t of 1.3 to 1.7, of a bracket .30 to .36 (-)",
        [0.30, 0.36],
        ratio,
    );
    sheet.figure(
        Figure::new(
            "b49_ironing",
            "B49: shallow ironing",
            ["time (-)", "force (N/mm)"],
        )
        .line("across", curves[1].clone())
        .line("along", curves[0].clone()),
    );
    Ok(())
}
