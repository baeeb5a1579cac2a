//! ADINA beside Lagrange: the constraint functions `w(g, λ) = 0`, `v(u̇, τ) = 0` where the source calls them good, and
//! where it says that they behave badly.
//!
//! Source: section C.5, "The stability and accuracy of this method are good for slow static and transient problems. However, the
//! method behaves badly when the inertial forces are relatively big."
//!
//! ```text
//!   slow                              fast
//!       F(t) -> +-------+                .-'-.   v0 = c/32,000 to c/3.2
//!               | block |               (     )  and v0/2 along the floor
//!   ============+=======+==== mu        `-._.-'
//!                                     ============ mu = 0.3
//! ```
//!
//! Data: E = 1 MPa, rho = 1000 kg/m³ (c = 32 m/s), nu = 0.3, mu = 0.3. The block, 1 × 0.5 m, stands by its weight; its upper edge is pulled
//! along until it slides (240 steps a second). The disc, R = 0.5 m with edges of R/8, comes in at an angle (1000 steps a second).
//!
//! Two things change when impacts become fast, and they are shown apart: the constraint functions, and (C.5) as printed,
//! without a treatment of impacts and with mass on the nodes that touch, as the program solves it. *As printed* are fixed
//! scales of 1 m and 1 N, full Newton steps and 15 iterations at the most.
//!
//! Excellent: the slow case within 0.1 % of Lagrange multipliers. The fast one is told.

use super::Outcome;
use super::figure::Figure;
use super::scene::{G, Scene};
use super::sheet::Sheet;
use foil2d::prelude::*;
use std::error::Error;
use std::fmt::Write;

const FRICTION: f64 = 0.3;
/// Greatest pull over the limit of friction (-).
const MOST_PULL: f64 = 1.1;
/// Wave speed sqrt(E/rho) (m/s).
const WAVES: f64 = 31.6;
const SPEEDS: [f64; 7] = [1e-3, 1e-2, 0.1, 1.0, 3.0, 6.0, 10.0];

fn material() -> LinearElastic {
    LinearElastic::plane_stress(1e6, 0.3).density(1000.0)
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    slow(sheet)?;
    fast(sheet)
}

/// Way and friction force of the dragged block, step by step.
fn drag(
    contact: ContactMethod,
    sheet: &Sheet,
) -> Result<Vec<[f64; 3]>, Box<dyn Error + Send + Sync>> {
    let mut scene = Scene::new(1.0 / 240.0, Beta2::default())
        .with_gravity(0.0, -G)
        .with_contact(contact);
    scene.ground(FRICTION);
    let block = FlexBodyBuilder::rectangle([1.0, 0.5], [8, 4])
        .small_strain()
        .material(material().rayleigh(2e-3))
        .friction(FRICTION);
    let block = scene.add(block)?;
    let nodes = scene.body(block).mesh().nodes();
    let top: Vec<usize> = (0..nodes.len()).filter(|&n| nodes[n][1] > 0.249).collect();
    let start = scene.body(block).position(top[0])[0];
    let weight = G * scene.body(block).mass();
    let mut seen = Vec::new();
    for step in 1..=sheet.n_steps(720) {
        // Standing for a second, then a pull that grows beyond the limit of friction in two.
        let share = (step as f64 / 240.0 - 1.0).max(0.0) / 2.0;
        let pull = MOST_PULL * FRICTION * weight * share / top.len() as f64;
        for &node in &top {
            scene.bodies[block].set_nodal_force(node, [pull, 0.0])?;
        }
        scene.step()?;
        let body = scene.body(block);
        let way = body.position(top[0])[0] - start;
        let time = step as f64 * scene.dt();
        seen.push([time, way, -body.total_contact_force()[0]]);
    }
    Ok(seen)
}

fn slow(sheet: &mut Sheet) -> Outcome {
    let lagrange = drag(ContactMethod::Lagrange, sheet)?;
    let own = ConstraintFunction::default();
    let functions = drag(ContactMethod::ConstraintFunction(own), sheet)?;
    let wide = ConstraintFunction::new(1e-12, 1e-3)?;
    let wide = drag(ContactMethod::ConstraintFunction(wide), sheet)?;
    for (axis, name) in [(1, "way of the upper corner"), (2, "friction force")] {
        let largest = lagrange.iter().fold(0.0f64, |a, l| a.max(l[axis].abs()));
        let error = |other: &[[f64; 3]]| {
            let pairs = lagrange.iter().zip(other);
            pairs.fold(0.0f64, |a, (l, o)| a.max((l[axis] - o[axis]).abs())) / largest
        };
        let quantity = format!("slow: largest difference of the {name} (-)");
        sheet.absolute(quantity, 0.0, error(&functions), 1e-3);
        let quantity = format!("slow, eps_T = 1e-3: 1 + that of the {name} (-)");
        sheet.tell(quantity, 1.0, 1.0 + error(&wide));
    }
    let axes = [
        "pull on the upper edge, of the limit of friction (-)",
        "way of the upper corner (mm)",
    ];
    let curve = |seen: &[[f64; 3]], every: usize| {
        let late = seen.iter().skip(240).step_by(every);
        late.map(|[t, way, _]| [MOST_PULL * (t - 1.0) / 2.0, 1e3 * way])
            .collect()
    };
    sheet.figure(
        Figure::new(
            "adina_slow",
            "ADINA beside Lagrange: a block dragged until it slides",
            axes,
        )
        .exact("Lagrange multipliers", curve(&lagrange, 1))
        .dots("constraint functions", curve(&functions, 12)),
    );
    Ok(())
}

/// A way to step through the fast impacts.
struct Way {
    name: &'static str,
    contact: ContactMethod,
    impact: ImpactTreatment,
    inertia: ContactInertia,
}

impl Way {
    /// Whether the figure of forces shows it: the others lie on these.
    fn is_drawn(&self) -> bool {
        let is_plain = self.impact == ImpactTreatment::Plain;
        let is_lagrange = self.contact == ContactMethod::Lagrange;
        !is_plain || !is_lagrange && !self.name.contains("printed")
    }
}

fn ways() -> Result<[Way; 5], Box<dyn Error + Send + Sync>> {
    let own = ContactMethod::ConstraintFunction(ConstraintFunction::default());
    let printed = ConstraintFunction::new(1e-12, 1e-3)?
        .with_scale(1.0, 1.0)
        .with_max_iterations(15)
        .without_line_search()
        .without_continuation();
    let way = |name, contact, impact, inertia| Way {
        name,
        contact,
        impact,
        inertia,
    };
    let lagrange = ContactMethod::Lagrange;
    let (treated, plain) = (ImpactTreatment::Stabilized, ImpactTreatment::Plain);
    let (moved, kept) = (ContactInertia::Redistributed, ContactInertia::Kept);
    Ok([
        way("Lagrange, plain, kept mass", lagrange, plain, kept.clone()),
        way("functions, plain, kept mass", own, plain, kept.clone()),
        way(
            "Lagrange, stabilized, moved mass",
            lagrange,
            treated,
            moved.clone(),
        ),
        way("functions, stabilized, moved mass", own, treated, moved),
        way(
            "functions as printed, plain, kept mass",
            ContactMethod::ConstraintFunction(printed),
            plain,
            kept,
        ),
    ])
}

/// What the impact of a disc showed.
#[derive(Default)]
struct Impact {
    n_steps: usize,
    sum: usize,
    most: usize,
    failed: usize,
    substituted: usize,
    overlap: f64,
    energy: f64,
    exit: [f64; 2],
    force: Vec<[f64; 2]>,
}

fn drop_disc(way: &Way, speed: f64, sheet: &Sheet) -> Result<Impact, Box<dyn Error + Send + Sync>> {
    let dt = 1e-3;
    let mut scene = Scene::new(dt, Beta2::trapezoidal())
        .with_impact(way.impact)
        .with_contact(way.contact);
    scene.ground(FRICTION);
    let disc = FlexBodyBuilder::disc(0.5, 0.0625)
        .small_strain()
        .material(material())
        .contact_inertia(way.inertia.clone())
        .friction(FRICTION)
        .translation([0.0, 0.5 + 10.3 * speed * dt])
        .linvel([0.5 * speed, -speed]);
    let disc = scene.add(disc)?;
    let mut impact = Impact::default();
    let at_start = scene.body(disc).energy().kinetic;
    for step in 1..=sheet.n_steps(sheet.choose(400, 200)) {
        let report = scene.step()?;
        impact.n_steps += 1;
        impact.sum += report.n_newton();
        impact.most = impact.most.max(report.n_newton());
        impact.failed += report.n_failed();
        impact.substituted += report.n_substituted();
        impact.overlap = impact.overlap.max(report.gap_violation());
        let force = scene.body(disc).total_contact_force()[1];
        // The disc is away after an eighth of a second.
        if step > 150 {
            continue;
        }
        impact.force.push([
            1e3 * step as f64 * scene.dt(),
            force / (speed * 1000.0 * WAVES),
        ]);
    }
    let body = scene.body(disc);
    let energy = body.energy();
    impact.energy = (energy.kinetic + energy.elastic) / at_start;
    impact.exit = body.linvel().map(|v| v / speed);
    Ok(impact)
}

fn fast(sheet: &mut Sheet) -> Outcome {
    let mut table = format!(
        "impacts of a disc, 1000 steps a second; c = {WAVES} m/s. Newton iterations per step, mean and most; steps in which they\n\
         failed, and that Lagrange multipliers took over; deepest overlap; energy after over before; exit velocity across and along\n\
         the floor over v0.\n\n{:<40} {:>6} {:>6} {:>4} {:>5} {:>5} {:>8} {:>8} {:>8} {:>8}\n",
        "way", "v0/c", "mean", "most", "fail", "subst", "overlap", "E/E0", "v_n/v0", "v_t/v0",
    );
    let mut energies = Figure::new(
        "adina_energy",
        "energy after the impact of a disc, by speed",
        ["v0 / c (-)", "energy after over before (-)"],
    )
    .log();
    let mut iterations = Figure::new(
        "adina_iterations",
        "most Newton iterations of a step in the impact of a disc, by speed",
        ["v0 / c (-)", "iterations (-)"],
    )
    .log_level();
    let mut forces = Figure::new(
        "adina_force",
        format!("force under the disc at v0 = {:.3} c", FIGURED / WAVES),
        [
            "time (ms)",
            "force per thickness, of rho c v0 times 1 m (-)",
        ],
    );
    for way in ways()? {
        let (mut energy, mut most) = (Vec::new(), Vec::new());
        for speed in SPEEDS {
            let impact = drop_disc(&way, speed, sheet)?;
            let _ = writeln!(
                table,
                "{:<40} {:>6.0e} {:>6.2} {:>4} {:>5} {:>5} {:>8.0e} {:>8.4} {:>8.4} {:>8.4}",
                way.name,
                speed / WAVES,
                impact.sum as f64 / impact.n_steps.max(1) as f64,
                impact.most,
                impact.failed,
                impact.substituted,
                impact.overlap,
                impact.energy,
                impact.exit[1],
                impact.exit[0],
            );
            energy.push([speed / WAVES, impact.energy]);
            most.push([speed / WAVES, impact.most as f64]);
            if speed == FIGURED && way.is_drawn() {
                forces = forces.line(way.name, impact.force.clone());
            }
            if speed == SPEEDS[SPEEDS.len() - 1] {
                tell_fastest(sheet, way.name, &impact);
            }
        }
        energies = energies.line(way.name, energy);
        iterations = iterations.line(way.name, most);
    }
    table.push_str(FINDING);
    sheet.note(table);
    sheet.figure(energies);
    sheet.figure(iterations);
    sheet.figure(forces);
    Ok(())
}

/// The speed of which the forces are drawn (m/s).
const FIGURED: f64 = 1.0;

fn tell_fastest(sheet: &mut Sheet, name: &str, impact: &Impact) {
    sheet.tell(
        format!("c/3.2, energy over before: {name}"),
        1.0,
        impact.energy,
    );
    let steps = impact.n_steps as f64;
    sheet.tell(
        format!("c/3.2, iterations a step: {name}"),
        1.0,
        impact.sum as f64 / steps,
    );
    sheet.tell(
        format!("c/3.2, 1 + failed steps: {name}"),
        1.0,
        1.0 + impact.failed as f64,
    );
}

const FINDING: &str = "
What comes out. The constraint functions hold at any speed: with impacts treated and mass moved off the nodes that touch they
give what Lagrange multipliers give, for an iteration or two more. What behaves badly when inertial forces are big is (C.5) with
mass on those nodes, by either method: from v0 = c/300 on the disc gains energy, at c/3.2 it leaves with some seventy times of
it, and iterations double. Scales of 1 m and 1 N add their part: friction that ought to stick slips in slow impacts, fast ones take
twice the iterations, and steps fail.
";
