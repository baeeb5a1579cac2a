//! The best linear fit to a field in a cell: `Π f = Σ_m φ_m Σ_h w_h φ_m(h) f(h)`, `Σ_h w_h φ_m φ_n = δ_mn`.

use super::kinematics::physical_gradient;
use super::{Element, ElementError, MAX_NODES};

/// The functions `1, X, Y` of the undeformed cell, made orthonormal over its quadrature points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinearFit {
    /// The node that places are told from (m).
    origin: [f64; 2],
    /// What of `1, X, Y` is in each function.
    shares: [[f64; 3]; 3],
}

impl LinearFit {
    /// That of a cell of nodes at rest there (m), weighed by area and `thickness` (m).
    ///
    /// # Errors
    /// [`ElementError::NonPositiveJacobian`] at the first quadrature point where the cell is inverted.
    pub fn of<E: Element + ?Sized>(
        element: &E,
        nodes: &[[f64; 2]],
        thickness: f64,
    ) -> Result<Self, ElementError> {
        let mut fit = Self {
            origin: nodes[0],
            shares: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        };
        // Σ w of the products of 1, X and Y.
        let mut moments = [[0.0; 3]; 3];
        for point in element.quadrature() {
            let mut gradient = [[0.0; 2]; MAX_NODES];
            let gradient = &mut gradient[..nodes.len()];
            let volume =
                physical_gradient(element, nodes, point.at, gradient)? * point.weight * thickness;
            let [x, y] = fit.place(element, nodes, point.at);
            let own = [1.0, x, y];
            for (row, one) in moments.iter_mut().zip(own) {
                for (entry, other) in row.iter_mut().zip(own) {
                    *entry += volume * one * other;
                }
            }
        }
        let product = |a: [f64; 3], b: [f64; 3]| {
            let rows = moments.iter().zip(a);
            rows.map(|(row, a)| a * (row[0] * b[0] + row[1] * b[1] + row[2] * b[2]))
                .sum::<f64>()
        };
        for mode in 0..3 {
            let mut own = fit.shares[mode];
            // Twice: what rounding leaves of the others the first time.
            for _ in 0..2 {
                for other in 0..mode {
                    let other = fit.shares[other];
                    let along = product(other, own);
                    own = [0, 1, 2].map(|k| own[k] - along * other[k]);
                }
            }
            let length = product(own, own).sqrt();
            fit.shares[mode] = own.map(|share| share / length);
        }
        Ok(fit)
    }

    fn place<E: Element + ?Sized>(
        &self,
        element: &E,
        nodes: &[[f64; 2]],
        at: [f64; 2],
    ) -> [f64; 2] {
        let mut shape = [0.0; MAX_NODES];
        element.shape(at, &mut shape[..nodes.len()]);
        let pairs = shape.iter().zip(nodes);
        pairs.fold([0.0; 2], |[x, y], (share, node)| {
            let [from_x, from_y] = self.origin;
            [
                x + share * (node[0] - from_x),
                y + share * (node[1] - from_y),
            ]
        })
    }

    /// The functions (m^-3/2) at natural coordinates.
    pub fn modes<E: Element + ?Sized>(
        &self,
        element: &E,
        nodes: &[[f64; 2]],
        at: [f64; 2],
    ) -> [f64; 3] {
        let [x, y] = self.place(element, nodes, at);
        self.shares
            .map(|[one, by_x, by_y]| one + by_x * x + by_y * y)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Quad8;
    use super::*;

    /// A curved cell: its functions are orthonormal, so that constant and linear fields are their own fit.
    #[test]
    fn linear_fields_are_their_own_fit() -> Result<(), ElementError> {
        let nodes = [
            [100.0, 50.0],
            [102.0, 50.2],
            [101.9, 51.5],
            [99.8, 51.0],
            [101.0, 49.9],
            [102.2, 50.9],
            [100.9, 51.4],
            [99.8, 50.5],
        ];
        let fit = LinearFit::of(&Quad8, &nodes, 0.1)?;
        let field = |[x, y]: [f64; 2]| 3.0 + 0.7 * (x - 100.0) - 0.4 * (y - 50.0);
        let (mut sums, mut products) = ([0.0; 3], [[0.0; 3]; 3]);
        for point in Quad8.quadrature() {
            let mut gradient = [[0.0; 2]; 8];
            let area = physical_gradient(&Quad8, &nodes, point.at, &mut gradient)?;
            let volume = 0.1 * area * point.weight;
            let modes = fit.modes(&Quad8, &nodes, point.at);
            let [x, y] = fit.place(&Quad8, &nodes, point.at);
            for (k, mode) in modes.iter().enumerate() {
                sums[k] += volume * mode * field([x + 100.0, y + 50.0]);
                for (l, other) in modes.iter().enumerate() {
                    products[k][l] += volume * mode * other;
                }
            }
        }
        for (k, row) in products.iter().enumerate() {
            for (l, product) in row.iter().enumerate() {
                let due = if k == l { 1.0 } else { 0.0 };
                assert!((product - due).abs() < 1e-13, "{k} {l}: {product}");
            }
        }
        for at in [[0.3, -0.7], [-1.0, 1.0]] {
            let [x, y] = fit.place(&Quad8, &nodes, at);
            let modes = fit.modes(&Quad8, &nodes, at);
            let found: f64 = modes.iter().zip(sums).map(|(mode, sum)| mode * sum).sum();
            assert!((found - field([x + 100.0, y + 50.0])).abs() < 1e-12);
        }
        Ok(())
    }
}
