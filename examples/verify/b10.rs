//! B10, Hertz's line contact: a steel cylinder on an aluminium block.
//!
//! Source: Hertz (1882); NAFEMS contact benchmark 1 (Konter 2006) with the same data.
//!
//! ```text
//!       .-'''-.        R = 50 mm, E = 210 GPa, nu = 0.3, held on a core of 5 mm
//!      /  (o)  \\
//!       '-._.-'
//!   +-----------+      E = 70 GPa, nu = 0.3, 800 × 400 mm, as good as a half-space
//!   |           |
//! ```
//!
//! Exact: `1/E* = Σ (1 - nu²)/E`, `a = sqrt(4 F R/pi E*)`, `p0 = 2 F/(pi a)`; at 35 kN/mm a = 6.215 mm, p0 = 3585.4 MPa.
//! The core is pressed down, and a and p0 are compared at the force that results.
//!
//! Both follow from one fit of the ellipse to the nodal pressures: the last node under pressure tells a to a cell only.
//!
//! Excellent: 2 % with ten nodes or more across the contact, converging; half-spaces alone cost 1 %,
//! and as much again comes from strains of 5 % and a contact an eighth as wide as the radius.

use super::Outcome;
use super::b9::spread;
use super::b14::{graded, graded_both};
use super::figure::Figure;
use super::sheet::Sheet;
use super::statics::{grid, press, still};
use foil2d::prelude::*;
use std::error::Error;
use std::f64::consts::{FRAC_PI_2, PI};

const RADIUS: f64 = 0.05;
const CORE: f64 = 0.005;
const SIZE: f64 = 0.4;
const NU: f64 = 0.3;
const YOUNG: [f64; 2] = [210e9, 70e9];

/// What one mesh gave: force (N/m), and place and pressure of the contactor nodes (m, Pa).
struct Contact {
    force: f64,
    pressures: Vec<[f64; 2]>,
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    let compliance: f64 = YOUNG.iter().map(|e| (1.0 - NU * NU) / e).sum();
    let mut figure = Figure::new(
        "b10_pressure",
        "B10: Hertz pressure",
        ["x / a (-)", "p / p0 (-)"],
    );
    let exact = (-100..=100)
        .map(|k| f64::from(k) / 100.0)
        .map(|x| [x, (1.0 - x * x).sqrt()]);
    figure = figure.exact("exact", exact.collect());
    let mut last = None::<f64>;
    for n in sheet.choose(vec![8, 12, 24], vec![8, 12]) {
        let contact = cylinder(n, sheet)?;
        let a = (4.0 * contact.force * RADIUS * compliance / PI).sqrt();
        let p0 = 2.0 * contact.force / (PI * a);
        let across = contact.pressures.len();
        let [found, width] = fitted(&contact.pressures, a);
        if across >= 10 {
            sheet.relative(
                format!("largest pressure p0, {across} nodes across (Pa)"),
                p0,
                found,
                2e-2,
            );
            sheet.relative(
                format!("half-width a, {across} nodes across (m)"),
                a,
                width,
                2e-2,
            );
        } else {
            sheet.tell(
                format!("largest pressure p0, {across} nodes across (Pa)"),
                p0,
                found,
            );
            sheet.tell(format!("half-width a, {across} nodes across (m)"), a, width);
        }
        if n == 12 {
            sheet.tell(
                "force, told for the data's 35 kN/mm (N/m)",
                35e6,
                contact.force,
            );
        }
        if let Some(last) = last {
            sheet.relative(
                format!("p0 of half-spaces and ours, {across} nodes against fewer (-)"),
                last,
                found / p0,
                5e-3,
            );
        }
        last = Some(found / p0);
        let scaled = contact.pressures.iter().map(|p| [p[0] / a, p[1] / p0]);
        figure = figure.dots(&format!("{across} nodes across"), scaled.collect());
    }
    sheet.figure(figure);
    Ok(())
}

/// Presses the cylinder on the block; `n` cells on 7 mm of the contact.
fn cylinder(n: usize, sheet: &Sheet) -> Result<Contact, Box<dyn Error + Send + Sync>> {
    // Longest waves: sqrt(E/rho) pi/2H = 8e4 /s.
    let mut scene = still(8e4)?;
    let fine = 0.0075;
    let m = n + 18;
    // The cylinder's lower half: around from the left, outwards and downwards from the surface to the core.
    let half = grid([2 * m, m], CellKind::Quad4, |[s, t]| {
        let depth = graded([fine, RADIUS - CORE], [n, m], t);
        let (sin, cos) = graded_both([fine / RADIUS, FRAC_PI_2], [n, m], s).sin_cos();
        [(RADIUS - depth) * sin, RADIUS - (RADIUS - depth) * cos]
    })?;
    let material = |young| LinearElastic::plane_strain(young, NU).density(2700.0);
    let is_core = |[x, y]: [f64; 2]| x.hypot(y - RADIUS) < CORE * (1.0 + 1e-9);
    let cylinder = FlexBodyBuilder::mesh(half)
        .small_strain()
        .material(material(YOUNG[0]))
        .friction(0.0)
        .pin_where(is_core, Pin::both());
    // Nodes lie on nodes until they move: what meshes that do not match add is the matter of B9.
    let k = n;
    let (size, cells) = ([fine, SIZE], [k, k + 18]);
    let block = grid([2 * (k + 18), k + 18], CellKind::Quad4, |[s, t]| {
        [graded_both(size, cells, s), -graded(size, cells, 1.0 - t)]
    })?;
    let block = FlexBodyBuilder::mesh(block)
        .small_strain()
        .material(material(YOUNG[1]))
        .friction(0.0)
        .pin_where(|[_, y]| y < -SIZE * (1.0 - 1e-9), Pin::both());
    let cylinder = scene.add(cylinder)?;
    let block = scene.add(block)?;
    let nodes = scene.body(cylinder).mesh().nodes();
    let core: Vec<usize> = (0..nodes.len())
        .filter(|&node| is_core(nodes[node]))
        .collect();
    press(&mut scene, sheet, cylinder, &core, [0.0, -PRESSED])?;
    let force = scene.force_on(cylinder)[1];
    let body = scene.body(if n_contacts(&scene, cylinder) {
        cylinder
    } else {
        block
    });
    // The surface near the contact, unloaded nodes included: the last loaded ones stand for the ways to them, too.
    let surface = body.mesh().boundary().nodes().iter();
    let near = surface.filter(|&&node| body.mesh().nodes()[node][1].abs() < 0.3 * CORE);
    let mut forces: Vec<[f64; 2]> = near
        .map(|&node| [body.position(node)[0], body.contact_force(node)[1].abs()])
        .collect();
    forces.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let pressures = spread(&forces).into_iter().filter(|p| p[1] > 0.0);
    Ok(Contact {
        force,
        pressures: pressures.collect(),
    })
}

/// Fits `p² = p0² (1 - x²/a²)`, a straight line over x², to all nodes but those at the edge, by least squares: `[p0, a]`.
pub fn fitted(pressures: &[[f64; 2]], a: f64) -> [f64; 2] {
    let inner: Vec<[f64; 2]> = pressures
        .iter()
        .filter(|p| p[0].abs() <= 0.85 * a)
        .map(|[x, p]| [x * x, p * p])
        .collect();
    let n = inner.len() as f64;
    let mean = [0, 1].map(|axis| inner.iter().map(|point| point[axis]).sum::<f64>() / n);
    let (over, under) = inner.iter().fold((0.0, 0.0), |(over, under), [x, p]| {
        (
            over + (x - mean[0]) * (p - mean[1]),
            under + (x - mean[0]) * (x - mean[0]),
        )
    });
    let slope = over / under;
    let at_zero = mean[1] - slope * mean[0];
    [at_zero.sqrt(), (-at_zero / slope).sqrt()]
}

/// How far the core goes down for about 35 kN/mm (m), by trial.
const PRESSED: f64 = 1.775e-3;

/// Whether the cylinder's nodes are the contactors.
fn n_contacts(scene: &super::scene::Scene, body: FlexBodyHandle) -> bool {
    let contacts = scene.flex.report().contacts();
    let own = foil2d::pipeline::Participant::Flex(body);
    contacts.iter().any(|contact| contact.contactor == own)
}
