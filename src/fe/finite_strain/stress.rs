//! Deformation and Cauchy's stress at the quadrature points of the elements.

use super::hourglass::{PATTERN, Shape};
use super::model::FiniteStrainModel;
use super::solid::Solid;
use crate::fe::material::Plane;
use crate::fe::material::hyperelastic::Invariants;
use crate::fe::model::{element_of, placed_nodes};
use crate::fe::recovery::{PointState, Stress, Stretch};
use crate::math::exp;

impl FiniteStrainModel {
    /// Cauchy's stress (Pa) at the quadrature points of a cell at `positions` (m), in the world's axes.
    ///
    /// `σ = P Fᵀ/(J z)`, `z` the stretch of the thickness; of a point that is turned inside out it is that of the area it covers, `|J|`.
    ///
    /// # Panics
    /// If there is not one entry per dof, or no such cell.
    pub fn cell_stress(&self, cell: usize, positions: &[f64]) -> Vec<Stress> {
        let states = self.cell_states(cell, positions).into_iter();
        states.map(|state| state.stress).collect()
    }

    /// Deformation and Cauchy's stress at the quadrature points of a cell at `positions` (m), in the world's axes.
    ///
    /// # Panics
    /// If there is not one entry per dof, or no such cell.
    pub fn cell_states(&self, cell: usize, positions: &[f64]) -> Vec<PointState> {
        self.assert_length(positions);
        for group in &self.groups {
            if let Ok(place) = group.cells.binary_search(&cell) {
                let solid = &group.solid;
                let gradients = match group.hourglass.is_empty() {
                    true => group.gradients_of(place, positions),
                    false => self.bent(cell, solid, &group.shape(place, positions)),
                };
                let pressures = group.smoothed_pressures(place, &gradients);
                return gradients
                    .into_iter()
                    .zip(pressures)
                    .map(|(at, pressure)| state_of(solid, at, pressure))
                    .collect();
            }
        }
        panic!("there is no cell {cell}")
    }

    /// `F` at the quadrature points of a cell with hourglass modes: the mean one, after the strains that the element with inner modes has
    /// when it is bent by as much.
    fn bent(&self, cell: usize, solid: &Solid, shape: &Shape) -> Vec<[f64; 4]> {
        let description = &self.description;
        let [xx, xy, yx, yy] = shape.gradient;
        let cells = description.mesh.cells().nth(cell);
        let found = cells.and_then(|cell| {
            let element = element_of(&description.elements, 0, &cell).ok()?;
            let corners = placed_nodes(&description.rest_positions, &cell);
            let area = xx * yy - xy * yx;
            let [x, y] = shape.amplitude;
            let own = [(yy * x - xy * y) / area, (xx * y - yx * x) / area];
            let bent: Vec<f64> = PATTERN
                .iter()
                .flat_map(|sign| own.map(|amplitude| sign * amplitude))
                .collect();
            let at_rest = solid.law.constants().linear(solid.density);
            let mut strains = vec![[0.0; 3]; element.quadrature().len()];
            let corners = &corners[..cell.nodes.len()];
            let outcome = element.point_strains(corners, &at_rest, &bent, &mut strains);
            outcome.ok().map(|()| strains)
        });
        let strains = found.unwrap_or_default().into_iter();
        strains
            .map(|[along, across, shear]| {
                let [a, b, c] = [1.0 + along, 0.5 * shear, 1.0 + across];
                // The volume is that of the strains: what their squares bring is none, and stiff to volumes it would be a large pressure.
                let (volume, kept) = (a * c - b * b, exp(along + across));
                let scale = if volume > 0.0 {
                    (kept / volume).sqrt()
                } else {
                    1.0
                };
                let [a, b, c] = [a, b, c].map(|part| scale * part);
                [
                    xx * a + xy * b,
                    xx * b + xy * c,
                    yx * a + yy * b,
                    yx * b + yy * c,
                ]
            })
            .collect()
    }
}

/// A point of a gradient, with this much more of a pressure (Pa), tension positive.
fn state_of(solid: &Solid, gradient: [f64; 4], pressure: f64) -> PointState {
    let law = solid.law.as_ref();
    let [xx, xy, yx, yy] = gradient;
    let at = Invariants::of(gradient);
    let [by_t, by_j] = law.gradient(at);
    let thickness = law.thickness_stretch(at);
    let volume = (at.j.abs() * thickness).max(f64::MIN_POSITIVE);
    // P Fᵀ = 2 W_t F Fᵀ + W_J J I.
    let spherical = by_j * at.j;
    let stress = Stress {
        xx: (2.0 * by_t * (xx * xx + xy * xy) + spherical) / volume,
        yy: (2.0 * by_t * (yx * yx + yy * yy) + spherical) / volume,
        xy: 2.0 * by_t * (xx * yx + xy * yy) / volume,
        zz: match solid.plane {
            // With the pressure, none.
            Plane::Stress => -pressure,
            Plane::Strain => law.out_of_plane_stress(at),
        },
    };
    PointState {
        gradient,
        stretch: Stretch::of_gradient(gradient, thickness),
        stress: stress.under(pressure),
    }
}
