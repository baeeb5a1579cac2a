//! Moments of nodal masses, and the polynomial that restores them: `sum_i m_i p(x_i) q(x_i) = target_q`.

use crate::math::{atan2, rounding, sin_cos};

/// A term of p that differs from the terms before it by less than this part of itself is left out.
const DEPENDENT: f64 = 1e-7;
const N_TERMS: usize = 6;

/// Coordinates along the principal axes through the centre of mass, in units of the gyration radii.
///
/// A body of any size and slenderness then has moments of size one, and no digit is lost between them.
pub struct Frame {
    centre: [f64; 2],
    axis: [f64; 2],
    radii: [f64; 2],
}

impl Frame {
    pub fn new(nodes: &[[f64; 2]], mass: &[f64]) -> Self {
        let total: f64 = mass.iter().sum();
        let mean = |value: &dyn Fn([f64; 2]) -> f64| {
            nodes
                .iter()
                .zip(mass)
                .map(|(&x, m)| m * value(x))
                .sum::<f64>()
                / total
        };
        let centre = [mean(&|x| x[0]), mean(&|x| x[1])];
        let xx = mean(&|x| (x[0] - centre[0]).powi(2));
        let yy = mean(&|x| (x[1] - centre[1]).powi(2));
        let xy = mean(&|x| (x[0] - centre[0]) * (x[1] - centre[1]));
        let (sin, cos) = sin_cos(0.5 * atan2(2.0 * xy, xx - yy));
        let mut frame = Self {
            centre,
            axis: [cos, sin],
            radii: [1.0; 2],
        };
        let radius = |i: usize| mean(&|x| frame.coordinates(x)[i].powi(2)).sqrt();
        let (long, short) = (radius(0), radius(1));
        let long = if long > 0.0 { long } else { 1.0 };
        // Nodes in a row have no width: what is left is rounding, and must not be blown up to size one.
        let short = if short > rounding::SHARE * long {
            short
        } else {
            long
        };
        frame.radii = [long, short];
        frame
    }

    /// Square of the shorter over the longer gyration radius (-).
    pub fn flatness(&self) -> f64 {
        (self.radii[1] / self.radii[0]).powi(2)
    }

    pub fn coordinates(&self, x: [f64; 2]) -> [f64; 2] {
        let [dx, dy] = [x[0] - self.centre[0], x[1] - self.centre[1]];
        let [cos, sin] = self.axis;
        [
            (cos * dx + sin * dy) / self.radii[0],
            (cos * dy - sin * dx) / self.radii[1],
        ]
    }

    /// The terms of p in the order of their importance: 1, X, Y, polar, Y^2, X Y.
    fn terms(&self, x: [f64; 2]) -> [f64; N_TERMS] {
        let [along, across] = self.coordinates(x);
        let flatness = self.flatness();
        let polar = (along * along + flatness * across * across) / (1.0 + flatness);
        [1.0, along, across, polar, across * across, along * across]
    }

    /// The moments (kg) of nodal masses for each of the terms.
    pub fn moments(&self, nodes: &[[f64; 2]], mass: &[f64]) -> [f64; N_TERMS] {
        let mut moments = [0.0; N_TERMS];
        for (&x, mass) in nodes.iter().zip(mass) {
            for (moment, term) in moments.iter_mut().zip(self.terms(x)) {
                *moment += mass * term;
            }
        }
        moments
    }

    /// Gram–Schmidt, twice, in the inner product of the masses times their weights; dependent terms become zero.
    pub fn basis(&self, nodes: &[[f64; 2]], mass: &[f64], weight: &[f64]) -> Basis {
        let mass: Vec<f64> = mass.iter().zip(weight).map(|(m, w)| m * w).collect();
        let mut terms: Vec<[f64; N_TERMS]> = nodes.iter().map(|&x| self.terms(x)).collect();
        let inner = |terms: &[[f64; N_TERMS]], a: usize, b: usize| -> f64 {
            terms
                .iter()
                .zip(&mass)
                .map(|(row, m)| m * row[a] * row[b])
                .sum()
        };
        let mut triangle = [[0.0; N_TERMS]; N_TERMS];
        for term in 0..N_TERMS {
            let before = inner(&terms, term, term).sqrt();
            for _ in 0..2 {
                for earlier in 0..term {
                    let part = inner(&terms, earlier, term);
                    triangle[term][earlier] += part;
                    terms
                        .iter_mut()
                        .for_each(|row| row[term] -= part * row[earlier]);
                }
            }
            let left = inner(&terms, term, term).sqrt();
            // The second bound is for terms that vanish on all massive nodes, such as Y on a row of them.
            let size = mass.iter().sum::<f64>().sqrt();
            let independent = left > DEPENDENT * before && left > rounding::SUM * size;
            let scale = if independent { 1.0 / left } else { 0.0 };
            triangle[term][term] = if independent { left } else { 0.0 };
            terms.iter_mut().for_each(|row| row[term] *= scale);
        }
        Basis {
            terms,
            triangle,
            weight: weight.to_vec(),
        }
    }
}

/// Orthonormal polynomials at the nodes, and the triangle `T` with `terms = T orthonormal`.
pub struct Basis {
    terms: Vec<[f64; N_TERMS]>,
    triangle: [[f64; N_TERMS]; N_TERMS],
    weight: Vec<f64>,
}

impl Basis {
    /// Writes the `p = 1 + w q` of least change (in the norm of the masses over the weights) that meets the first `n_terms`
    /// conditions it can.
    ///
    /// With `q = sum c_k e_k`, the moment of term j changes by `sum_k T_jk c_k`: forward substitution, where a zero on the
    /// diagonal is a condition already decided by the ones before it.
    ///
    /// - `change`: by how much the moments have to change (kg).
    pub fn fit(&self, factor: &mut [f64], mass: &[f64], change: &[f64; N_TERMS], n_terms: usize) {
        let mut coefficients = [0.0; N_TERMS];
        for row in 0..N_TERMS {
            let triangle = &self.triangle[row];
            let known: f64 = (0..row).map(|k| triangle[k] * coefficients[k]).sum();
            if triangle[row] > 0.0 && row < n_terms {
                coefficients[row] = (change[row] - known) / triangle[row];
            }
        }
        let places = self.terms.iter().zip(&self.weight);
        for ((factor, (terms, weight)), mass) in factor.iter_mut().zip(places).zip(mass) {
            let value: f64 = terms.iter().zip(&coefficients).map(|(e, c)| e * c).sum();
            *factor = if *mass > 0.0 {
                1.0 + weight * value
            } else {
                1.0
            };
        }
    }
}
