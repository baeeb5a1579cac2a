//! The scheme table: B1 and B2 by every way of stepping through an impact.
//!
//! A scheme is a member of Beta-2, what is done on impact, whether the nodes that meet the floor keep their inertia, and how the
//! laws of contact are enforced. To show another one, add a line to [`schemes`].
//!
//! Excellent: no overlap and no energy from stabilized contact; by central difference a plateau within 1 %, and with moved mass
//! .985 of the energy after ten periods.

use super::Outcome;
use super::bars::{CONTACT_TIME, Mass, Record, Scheme, drop_bar};
use super::figure::Figure;
use super::sheet::Sheet;
use super::{b1, b2};
use foil2d::integrator::IntegratorError;
use foil2d::prelude::*;
use std::fmt::Write;

use ImpactTreatment::{ImplicitForces, Plain, Projected, Stabilized};
use Mass::{Consistent, ConsistentRedistributed, Kept, Redistributed};

/// Every scheme of the table.
pub fn schemes() -> Result<Vec<Scheme>, IntegratorError> {
    let members = [
        ("trapezoidal", Beta2::trapezoidal()),
        ("linear acceleration", Beta2::linear_acceleration()),
        ("(1, 1/2)", Beta2::new(1.0, 0.5)?),
        ("damped(0.9)", Beta2::damped(0.9)?),
        ("damped(0.5)", Beta2::damped(0.5)?),
    ];
    let mut schemes = Vec::new();
    let mut add = |name, integrator: Beta2, impact, contact, masses: &[Mass]| {
        for &mass in masses {
            schemes.push(Scheme {
                name,
                integrator,
                impact,
                mass,
                contact,
            });
        }
    };
    let lagrange = ContactMethod::Lagrange;
    let all = [Redistributed, ConsistentRedistributed, Kept, Consistent];
    for (name, integrator) in members {
        // A massless node vibrates at an infinite frequency, and this dt is too long for the consistent mass: a
        // conditionally stable member can have neither.
        let masses = match name {
            "trapezoidal" => &all[..],
            _ if integrator.is_unconditionally_stable() => &[Redistributed, Kept, Consistent],
            _ => &[Kept],
        };
        for impact in [Stabilized, Plain] {
            add(name, integrator, impact, lagrange, masses);
        }
    }
    // Where the contact nodes have no mass, both are what plain (C.5) is.
    let (name, integrator) = ("trapezoidal", Beta2::trapezoidal());
    for impact in [Projected, ImplicitForces] {
        add(name, integrator, impact, lagrange, &[Kept, Consistent]);
    }
    let functions = ContactMethod::ConstraintFunction(ConstraintFunction::default());
    add(name, integrator, Stabilized, functions, &[Redistributed]);
    add(
        name,
        integrator,
        Plain,
        functions,
        &[Redistributed, Kept, Consistent],
    );
    let explicit = Beta2::central_difference();
    add(
        "central difference",
        explicit,
        Stabilized,
        lagrange,
        &[Redistributed, Kept],
    );
    Ok(schemes)
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    let n_periods = sheet.choose(10, 2);
    let mut table = heading(n_periods);
    let mut best = Figure::new(
        "schemes_energy",
        "B2: energy over the periods, by scheme",
        ["time (s)", "energy, of the initial (-)"],
    )
    .within([0.0, 2.0])
    .exact(
        "exact",
        vec![[0.0, 1.0], [n_periods as f64 * b2::PERIOD, 1.0]],
    );
    for scheme in schemes()? {
        let mut one = b1::drop(0.0);
        one.n_steps = sheet.n_steps(one.n_steps);
        let impact = drop_bar(&scheme, &one)?;
        let mut ten = b2::drop(n_periods, b2::COARSE);
        ten.n_steps = sheet.n_steps(ten.n_steps);
        let bounces = drop_bar(&scheme, &ten)?;
        let _ = writeln!(table, "{}", line(&scheme, &impact, &bounces));
        judge(sheet, &scheme, &impact, &bounces);
        if is_drawn(&scheme) {
            let sparse = bounces
                .curve(&bounces.energy)
                .into_iter()
                .step_by(20)
                .collect();
            best = best.line(&full_name(&scheme), sparse);
        }
    }
    table.push_str(CHOICE);
    sheet.note(table);
    sheet.figure(best);
    Ok(())
}

/// Whether the figure of energies shows a scheme: one line per way of treating impacts, and those with moved mass.
fn is_drawn(scheme: &Scheme) -> bool {
    let is_reference = scheme.name == "trapezoidal" && scheme.mass != Consistent;
    let is_lagrange = scheme.contact == ContactMethod::Lagrange;
    let is_told = is_reference || scheme.mass == Redistributed;
    is_lagrange && is_told && matches!(scheme.impact, Stabilized | Plain)
}

fn full_name(scheme: &Scheme) -> String {
    let impact = match scheme.impact {
        _ if scheme.integrator.is_explicit() => "forward",
        Stabilized => "stabilized",
        Plain => "plain",
        Projected => "projected",
        ImplicitForces => "implicit forces",
    };
    let mass = match scheme.mass {
        Redistributed => "moved mass",
        ConsistentRedistributed => "moved consistent mass",
        Kept => "lumped mass",
        Consistent => "consistent mass",
    };
    let functions = match scheme.contact {
        ContactMethod::Lagrange => "",
        ContactMethod::ConstraintFunction(_) => ", functions",
    };
    format!("{}, {impact}, {mass}{functions}", scheme.name)
}

fn heading(n_periods: usize) -> String {
    format!(
        "impact schemes, 100 cells. From B1: rms and peak of the pressure error away from the fronts and the\n\
         peak of the pressure, over 300 Pa; last contact less the exact one, in steps; rebound over v0;\n\
         energy. From B2: energy after {n_periods} periods, height after one period. Both: deepest overlap, most Newton\n\
         iterations of a step, steps in which they failed, pivots per step, time of a step. Functions: the constraint\n\
         functions of ADINA in the place of Lagrange multipliers.\n\n\
         {:<46} {:>8} {:>8} {:>6} {:>8} {:>8} {:>8} {:>9} {:>7} {:>8} {:>3} {:>4} {:>5} {:>5}\n",
        "scheme",
        "rms",
        "peak",
        "max p",
        "release",
        "rebound",
        "E/E0",
        "E/E0 end",
        "h(16/3)",
        "overlap",
        "N",
        "fail",
        "piv",
        "us",
    )
}

/// The pressure of the whole contact, fronts included, over 300 Pa.
fn highest(record: &Record) -> f64 {
    record.pressure.iter().fold(0.0, |a: f64, &b| a.max(b)) / b1::PLATEAU
}

fn line(scheme: &Scheme, impact: &Record, bounces: &Record) -> String {
    let [rms, peak] = impact
        .pressure_error(b1::SPAN, |_| b1::PLATEAU)
        .map(|e| e / b1::PLATEAU);
    let release = (impact.release(2.0) - b1::TOUCH - CONTACT_TIME) * b1::RATE;
    let steps = (impact.times.len() + bounces.times.len()).max(1) as f64;
    format!(
        "{:<46} {rms:>8.4} {peak:>8.4} {:>6.2} {release:>+8.1} {:>8.4} {:>8.4} {:>9.3e} {:>7.3} {:>8.0e} {:>3} {:>4} {:>5.2} {:>5.0}{}",
        full_name(scheme),
        highest(impact),
        impact.at(&impact.velocity, 1.45) / b1::SPEED,
        impact.at(&impact.energy, 1.45),
        bounces.energy.last().copied().unwrap_or(f64::NAN),
        bounces.at(&bounces.bottom, b2::PERIOD),
        impact.penetration.max(bounces.penetration),
        impact.n_newton.max(bounces.n_newton),
        impact.n_failed + bounces.n_failed,
        (impact.n_pivots + bounces.n_pivots) as f64 / steps,
        bounces.microseconds,
        bounces
            .times
            .last()
            .filter(|_| bounces.ended.is_some())
            .map_or(String::new(), |t| format!("  ended at {t:.1} s")),
    )
}

/// What every stabilized scheme promises, and what the plain one does.
fn judge(sheet: &mut Sheet, scheme: &Scheme, impact: &Record, bounces: &Record) {
    let name = full_name(scheme);
    let energy = impact.energy.iter().fold(0.0f64, |a, &b| a.max(b));
    if scheme.impact == Stabilized {
        let overlap = impact.penetration.max(bounces.penetration);
        sheet.absolute(format!("B1, B2 overlap (m): {name}"), 0.0, overlap, 1e-8);
    }
    if scheme.integrator.is_explicit() {
        let mean = impact.mean_pressure(b1::SPAN);
        sheet.relative(format!("B1 plateau (Pa): {name}"), b1::PLATEAU, mean, 1e-2);
        if scheme.mass == Redistributed {
            let last = bounces.energy.last().copied().unwrap_or(f64::NAN);
            sheet.at_least(format!("B2 energy at the end: {name}"), 0.985, last);
        }
    }
    // The energy of a vibration that linear acceleration integrates sways by (omega dt)² without any contact.
    if scheme.impact == Stabilized && scheme.integrator.is_unconditionally_stable() {
        sheet.at_most(format!("B1 largest energy: {name}"), 1.0 + 1e-9, energy);
    }
}

const CHOICE: &str = "
What to choose. Where steps are near the critical one anyway: central difference with the mass of the contact boundary moved
inwards. It keeps the energy of ten periods, and the closer the step to the critical one, the better the height (B2: 4.99 m at
.98 of it). Where longer steps resolve the impact: the trapezoidal rule with moved mass. One impact keeps its energy, and ten
periods all but a tenth; if it is known where the body will be hit, a consistent mass is the better one to move (B3 at .40 of the
critical step: exit at .998 of the exact velocity, .968 with lumped mass). Plain (C.5) does as well where the contact nodes have
no mass, but nothing holds its energy back. With mass on those nodes it must be avoided: multipliers alternate, grow and feed
energy into the bar; forces of the end of the step alone alternate without growing in one impact, but gain energy over ten periods
with a consistent mass. The constraint functions change none of this. For impacts shorter than the step: the default,
damped(0.9). It gives a smooth pressure, and takes the vibration that an impact leaves, so that bodies come to rest.
";
