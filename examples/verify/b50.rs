//! B50, the contact patch test between bodies of large strain, and Taylor's with a Poisson's ratio.
//!
//! Source: Taylor and Papadopoulos (1991).
//!
//! ```text
//!       p v v v v v v v
//!         +-+-+-+-+-+-+
//!         | 7 x 7     |       pressed by a dead load p on all of the upper sides;
//!    p v  +-+-+-+-+-+-+  v p  below it glides, and so does the interface
//!   +---+--+--+--+--+--+---+
//!   |      5 below         |
//!   +---+--+--+--+--+--+---+
//!   ========================
//! ```
//!
//! Exact: the nominal stress is `-p` everywhere. Both blocks grow sideways by the same, so that corners stay where they stand. At large strains the heights follow from the law
//! (neo-Hookean, `ν = 0`: `p = μ (1/λ - λ)` at .95 of the height); with Hooke's law, plane strain, `ν = .4`, `E = 1000` and `p = 10` the height falls by `p (1 - ν²)/E`.
//!
//! Nodes of both surfaces are held on the edges of the other, see B9.
//!
//! Excellent: 1e-10 of p. Bodies of small strain have that (nodal pressures of meshes that do not match 3e-10); steps of large strain end where 1e-8 of the forces are out of
//! balance, which leaves 4e-10 of the mean and 2e-6 of the nodal pressures.

use super::Outcome;
use super::b9::spread;
use super::scene::Scene;
use super::sheet::Sheet;
use super::statics::{SETTLE, grid, loaded, still, traction};
use foil2d::prelude::*;

pub fn run(sheet: &mut Sheet) -> Outcome {
    let large = LinearElastic::plane_stress(2e6, 0.0).density(1000.0);
    let stretch: f64 = 0.95;
    let pressed = Test {
        name: "large strain",
        is_small: false,
        pressure: 1e6 * (1.0 / stretch - stretch),
        slowest: 35.0,
        sink: 1.0 - stretch,
    };
    let taylor = Test {
        name: "Taylor",
        is_small: true,
        pressure: 10.0,
        slowest: 25.0,
        sink: 10.0 * (1.0 - 0.16) / 1000.0,
    };
    let soft = LinearElastic::plane_strain(1000.0, 0.4).density(1.0);
    for [n_lower, n_upper] in [[5, 7], [7, 5], [5, 5]] {
        patch(sheet, large, &pressed, [n_lower, n_upper])?;
        patch(sheet, soft, &taylor, [n_lower, n_upper])?;
    }
    Ok(())
}

struct Test {
    name: &'static str,
    is_small: bool,
    /// On all that is free above (Pa).
    pressure: f64,
    slowest: f64,
    /// Of a block of 1 m (m).
    sink: f64,
}

fn patch(
    sheet: &mut Sheet,
    material: LinearElastic,
    test: &Test,
    [n_lower, n_upper]: [usize; 2],
) -> Outcome {
    let mut scene: Scene = still(test.slowest)?;
    let cell = 1.0 / n_lower as f64;
    let wide = 1.0 + 2.0 * cell;
    let lower = grid([n_lower + 2, n_lower], CellKind::Quad4, |[s, t]| {
        [s * wide, t]
    })?;
    let upper = grid([n_upper, n_upper], CellKind::Quad4, |[s, t]| [s, t + 1.0])?;
    let down = [0.0, -test.pressure];
    let beside = traction(&lower, CellKind::Quad4, down, |[x, y]| {
        y == 1.0 && x > 1.0 - 1e-6
    });
    let above = traction(&upper, CellKind::Quad4, down, |[_, y]| y == 2.0);
    let block = |builder: FlexBodyBuilder| {
        let builder = if test.is_small {
            builder.small_strain()
        } else {
            builder
        };
        builder.material(material).friction(0.0)
    };
    let lower = block(FlexBodyBuilder::mesh(lower))
        .pin_where(|[_, y]| y == 0.0, Pin::y())
        .pin_where(|[x, _]| x == 0.0, Pin::x());
    let upper = block(FlexBodyBuilder::mesh(upper)).pin_where(|[x, _]| x == 0.0, Pin::x());
    scene.add(loaded(lower, beside))?;
    let upper = scene.add(loaded(upper, above))?;
    scene.steps(sheet.n_steps(3 * SETTLE))?;
    let force = scene.force_on(upper)[1];
    let of = format!("{}, {n_lower} below {n_upper}", test.name);
    let mean = format!("{of}: mean pressure over p (-)");
    if test.is_small {
        sheet.absolute(mean, 1.0, force / test.pressure, 1e-10);
    } else {
        // A step ends where 1e-8 of its forces are out of balance.
        sheet.absolute(mean, 1.0, force / test.pressure, 1e-8);
    }
    let contacts = scene.flex.report().contacts();
    let mut at: Vec<[f64; 2]> = contacts
        .iter()
        .map(|c| [c.position[0], c.normal_force])
        .collect();
    at.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let grown = scene.body(upper).position(n_upper)[0] - scene.body(upper).position(0)[0];
    let worst = spread(&at).iter().fold(0.0f64, |worst, p| {
        worst.max((p[1] * grown / test.pressure - 1.0).abs())
    });
    sheet.tell(
        format!("{of}: 1 + largest error of a nodal pressure (-)"),
        1.0,
        1.0 + worst,
    );
    let top = scene.body(upper).position(n_upper * (n_upper + 1))[1];
    sheet.relative(
        format!("{of}: height of both (m)"),
        2.0 - 2.0 * test.sink,
        top,
        if test.is_small { 1e-9 } else { 1e-8 },
    );
    Ok(())
}
