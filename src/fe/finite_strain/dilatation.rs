//! Areas of eight-node cells, smoothed so that material that all but keeps its volume does not lock.
//!
//! Nine points ask for nine areas, and eight nodes have six motions a cell that change none; what a law stores in a change of volume, `U(J)`
//! ([`Volumetric`]), is taken from the best linear fit to `J` in the cell instead (Simo, Taylor, Pister 1985, with the pressure and the area
//! eliminated within the cell; linear fits of volumes: Elguedj, Bazilevs, Calo, Hughes 2008):
//!
//! ```text
//! E = Σ w [W(F) - U(J) + U(J̄)],    J̄ = Π J,    Π f = Σ_m φ_m Σ_h w_h φ_m(h) f(h),    Σ_h w_h φ_m φ_n = δ_mn
//! ```
//!
//! with `φ` the functions `1, X, Y` of the rest placement made orthonormal. As `Π` is the same at both ends of a step, `J̄` is quadratic in the positions
//! as `J` is, and its change is `Π (cof F½ : ΔF)` exactly: with `b̄ = ΔU/ΔJ̄` and `b = ΔU/ΔJ` the stress
//!
//! ```text
//! P += (Π b̄ - b) cof F½
//! ```
//!
//! does the work by which `U(J̄) - U(J)` rises, and `P F½ᵀ` is symmetric: energy and angular momentum are conserved as without it. Constant and linear
//! fields of `J` are not changed.
//!
//! The decay of vibrations resists a change of volume by the same modulus, and would hold at the points what the law lets go: its part
//! `χ/2 λ (J' - J)` is smoothed likewise. What flows is told by `Fe = F Fp⁻¹` and `J = k det Fe`, `k = 1/det Fp⁻¹` in the plane.

mod kernels;

use super::cells::CellGroup;
use super::deformed::Deformed;
use super::linearization::Linearization;
use super::point::{Form, cofactor, growth, moduli_of_pair};
use crate::fe::element::{Element, ElementError, LinearFit, MAX_POINTS};
use crate::fe::material::hyperelastic::{BesideRest, ElasticConstants, Volumetric};

/// Functions that a fit is made of.
const N_MODES: usize = 3;

/// Smoothed areas of the cells of a group.
#[derive(Clone, Debug)]
pub(super) struct Dilatation {
    law: Volumetric,
    /// Lamé's `λ` at rest (Pa), by which the decay resists a change of volume.
    lambda: f64,
    /// `φ` at the points (m^-3/2), shape `(n_cells, n_points)`.
    modes: Vec<[f64; N_MODES]>,
}

impl Dilatation {
    pub fn new(law: Volumetric, lambda: f64) -> Self {
        Self {
            law,
            lambda,
            modes: Vec::new(),
        }
    }

    /// Adds a cell of nodes at rest there (m).
    pub fn add_cell(
        &mut self,
        element: &dyn Element,
        nodes: &[[f64; 2]],
        thickness: f64,
    ) -> Result<(), ElementError> {
        let fit = LinearFit::of(element, nodes, thickness)?;
        let points = element.quadrature().iter();
        self.modes
            .extend(points.map(|point| fit.modes(element, nodes, point.at)));
        Ok(())
    }
}

/// A cell with smoothed areas between two states.
pub(super) struct Cell<'a> {
    of: &'a Dilatation,
    modes: &'a [[f64; N_MODES]],
    volumes: &'a [f64],
    /// Elastic gradients at the points of both ends.
    ends: [[[f64; 4]; MAX_POINTS]; 2],
    /// `k` of the points (-).
    scales: [f64; MAX_POINTS],
}

/// What smoothing changes in the answer of a point.
#[derive(Clone, Copy, Default)]
pub(super) struct Shift {
    /// Added to the `b` of the law, by the elastic gradient (Pa).
    pub slope: f64,
    /// The same of the decay (Pa).
    pub decay: f64,
    /// Taken from its second derivatives by `J` (Pa).
    pub fall: f64,
    /// `Π b̄ - b`, by the whole gradient: a pressure, tension positive (Pa).
    pub pressure: f64,
}

/// What smoothing changes at the points of a group, for matrices that take each point by itself.
#[derive(Clone, Copy)]
pub(super) struct Smoothing<'a> {
    of: Option<&'a Dilatation>,
    group: &'a CellGroup,
    form: Form,
    start: &'a Deformed,
    end: &'a Deformed,
}

impl<'a> Smoothing<'a> {
    /// That of a group between two states; nothing of one without smoothed areas.
    pub fn of(
        group: &'a CellGroup,
        form: Form,
        (start, end): (&'a Deformed, &'a Deformed),
    ) -> Self {
        Self {
            of: group.dilatation.as_ref(),
            group,
            form,
            start,
            end,
        }
    }

    /// Nothing, where all of it is added for itself.
    pub fn unless(self, is_added: bool) -> Self {
        let of = self.of.filter(|_| !is_added);
        Self { of, ..self }
    }

    /// At the points of a cell.
    pub fn shifts(&self, place: usize) -> [Shift; MAX_POINTS] {
        let shifts = self.of.and_then(|of| {
            let (cell, _) = of.cell_between(self.group, place, (self.start, self.end));
            let slopes = cell.smooth_slopes(self.form).ok()?;
            Some(cell.shifts(self.form, &slopes))
        });
        shifts.unwrap_or_default()
    }

    /// The moduli of a pair and its derivatives (Pa) at a point that smoothing shifts, without what its own area is no longer asked for.
    pub fn moduli(
        &self,
        shift: Shift,
        constants: ElasticConstants,
        (form, kind): (Form, Linearization),
        ([a, b], [tt, tj, jj]): ([f64; 2], [f64; 3]),
        ends: [[f64; 4]; 2],
    ) -> [[f64; 4]; 4] {
        let pair = [a, b + shift.slope];
        let second = [tt, tj, jj - shift.fall];
        let mut moduli = moduli_of_pair(constants, (form, kind), (pair, second), ends);
        if let (Some(of), Form::EnergyMomentum { decay }) = (self.of, form) {
            let across = cofactor(form.gradient_of(ends[0], ends[1]));
            for (row, own) in moduli.iter_mut().zip(across) {
                for (entry, other) in row.iter_mut().zip(across) {
                    *entry -= 0.5 * decay * of.lambda * own * other;
                }
            }
        }
        moduli
    }
}

impl Cell<'_> {
    /// `J - 1` of a point at one end.
    fn area(&self, end: usize, point: usize) -> f64 {
        let (gradient, k) = (self.ends[end][point], self.scales[point]);
        match k == 1.0 {
            true => BesideRest::of(gradient).j(),
            false => {
                let [xx, xy, yx, yy] = gradient;
                k * (xx * yy - xy * yx) - 1.0
            }
        }
    }

    fn n_points(&self) -> usize {
        self.modes.len()
    }

    /// `Π f` at the points.
    fn smoothed(&self, f: impl Fn(usize) -> f64) -> [f64; MAX_POINTS] {
        let mut amplitudes = [0.0; N_MODES];
        for (point, (modes, volume)) in self.modes.iter().zip(self.volumes).enumerate() {
            let own = volume * f(point);
            for (amplitude, mode) in amplitudes.iter_mut().zip(modes) {
                *amplitude += own * mode;
            }
        }
        let mut smooth = [0.0; MAX_POINTS];
        for (smooth, modes) in smooth.iter_mut().zip(self.modes) {
            *smooth = modes.iter().zip(amplitudes).map(|(m, a)| m * a).sum();
        }
        smooth
    }

    /// `J̄ - 1` at the points of one end; `Err` with the first `J̄` at which `U` has no energy.
    fn areas(&self, end: usize) -> Result<[f64; MAX_POINTS], f64> {
        let areas = self.smoothed(|point| self.area(end, point));
        let refused = areas[..self.n_points()]
            .iter()
            .find(|area| !self.of.law.admits(**area));
        refused.map_or(Ok(areas), |area| Err(1.0 + area))
    }

    /// Energy beyond that of the points (J); not a number where there is none.
    fn energy(&self) -> f64 {
        let Ok(areas) = self.areas(1) else {
            return f64::NAN;
        };
        let law = self.of.law;
        let own = self.volumes.iter().enumerate();
        own.map(|(point, volume)| {
            volume * (law.energy(areas[point]) - law.energy(self.area(1, point)))
        })
        .sum()
    }

    /// `[b, ∂b/∂J']` of `U` from one area to another, of a form; of an equilibrium the second derivative.
    fn slopes(&self, form: Form, from: f64, to: f64) -> [f64; 2] {
        match form {
            Form::Equilibrium => self.of.law.slopes(to),
            Form::EnergyMomentum { .. } => self.of.law.conserving(from, to),
        }
    }

    /// `b̄` and its derivative at the points, or `J̄` where there is none.
    fn smooth_slopes(&self, form: Form) -> Result<[[f64; 2]; MAX_POINTS], f64> {
        let [start, end] = [self.areas(0)?, self.areas(1)?];
        let mut found = [[0.0; 2]; MAX_POINTS];
        let points = found.iter_mut().zip(start.iter().zip(&end));
        for (found, (start, end)) in points.take(self.n_points()) {
            *found = self.slopes(form, *start, *end);
        }
        Ok(found)
    }

    /// `Σ w k φ_m φ_n` of the second derivatives `k` of `U` at the smoothed areas; of those above zero alone for what is to be definite.
    fn answers(
        &self,
        slopes: &[[f64; 2]; MAX_POINTS],
        kind: Linearization,
    ) -> [[f64; N_MODES]; N_MODES] {
        let least = match kind {
            Linearization::Consistent => f64::NEG_INFINITY,
            _ => 0.0,
        };
        let mut answers = [[0.0; N_MODES]; N_MODES];
        for ((modes, volume), [_, rise]) in self.modes.iter().zip(self.volumes).zip(slopes) {
            let weight = volume * rise.max(least);
            for (row, own) in answers.iter_mut().zip(modes) {
                for (entry, other) in row.iter_mut().zip(modes) {
                    *entry += weight * own * other;
                }
            }
        }
        answers
    }

    /// What the decay resists a change of volume by, `χ/2 λ` (Pa).
    fn decay(&self, form: Form) -> f64 {
        0.5 * form.decays().unwrap_or(0.0) * self.of.lambda
    }

    /// What smoothing changes at the points.
    fn shifts(&self, form: Form, slopes: &[[f64; 2]; MAX_POINTS]) -> [Shift; MAX_POINTS] {
        let pressures = self.smoothed(|point| slopes[point][0]);
        let growth = |point: usize| growth([0, 1].map(|end| self.ends[end][point]));
        let decay = self.decay(form);
        let growths = match decay > 0.0 {
            true => self.smoothed(growth),
            false => [0.0; MAX_POINTS],
        };
        let second = match form {
            Form::Equilibrium => 1.0,
            Form::EnergyMomentum { .. } => 2.0,
        };
        let mut shifts = [Shift::default(); MAX_POINTS];
        for (point, shift) in shifts.iter_mut().enumerate().take(self.n_points()) {
            let k = self.scales[point];
            let [own, rise] = self.slopes(form, self.area(0, point), self.area(1, point));
            let pressure = pressures[point] - own;
            let along = match decay > 0.0 {
                true => decay * (growths[point] - growth(point)),
                false => 0.0,
            };
            *shift = Shift {
                slope: k * pressure,
                decay: along,
                fall: second * k * k * rise,
                pressure,
            };
        }
        shifts
    }
}
