//! A small finite-element program for tests: structured meshes, banded Cholesky, no part of the library but elements.

use foil2d::fe::element::{Element, Quad4, Tri3, Tri6};
use foil2d::fe::material::Material;

/// Nodes and cells of one kind, numbered along the second direction first so that the band is narrow.
pub struct Grid {
    pub element: &'static dyn Element,
    pub nodes: Vec<[f64; 2]>,
    pub cells: Vec<Vec<usize>>,
    /// Nodes along the second direction.
    pub n_across: usize,
}

impl Grid {
    /// The unit square cut into `cells`, each a quadrilateral or two triangles, placed by `map`.
    ///
    /// The diagonals alternate, so that triangles have no preferred direction.
    pub fn new(
        element: &'static dyn Element,
        cells: [usize; 2],
        map: impl Fn([f64; 2]) -> [f64; 2],
    ) -> Self {
        let refine = if element.n_nodes() == 6 { 2 } else { 1 };
        let [nx, ny] = cells.map(|n| n * refine);
        let node = |i: usize, j: usize| i * (ny + 1) + j;
        let mut nodes = Vec::new();
        for i in 0..=nx {
            for j in 0..=ny {
                nodes.push(map([i as f64 / nx as f64, j as f64 / ny as f64]));
            }
        }
        let mut grid = Vec::new();
        for i in 0..cells[0] {
            for j in 0..cells[1] {
                let corner = |di: usize, dj: usize| [(i + di) * refine, (j + dj) * refine];
                let square = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                if element.n_corners() == 4 {
                    grid.push(square.map(|[i, j]| node(i, j)).to_vec());
                    continue;
                }
                let start = (i + j) % 2;
                for [a, b, c] in [[0, 1, 2], [0, 2, 3]].map(|t| t.map(|k| square[(k + start) % 4]))
                {
                    let mut cell: Vec<usize> = [a, b, c].map(|[i, j]| node(i, j)).to_vec();
                    if refine == 2 {
                        let middle = |p: [usize; 2], q: [usize; 2]| {
                            node((p[0] + q[0]) / 2, (p[1] + q[1]) / 2)
                        };
                        cell.extend([middle(a, b), middle(b, c), middle(c, a)]);
                    }
                    grid.push(cell);
                }
            }
        }
        // Side nodes belong in the middle of straight sides, whatever the map does between corners.
        let mut straight = nodes.clone();
        for cell in grid.iter().filter(|cell| cell.len() == 6) {
            for k in 0..3 {
                let (a, b) = (nodes[cell[k]], nodes[cell[(k + 1) % 3]]);
                straight[cell[3 + k]] = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            }
        }
        Self {
            element,
            nodes: straight,
            cells: grid,
            n_across: ny + 1,
        }
    }

    pub fn positions(&self, cell: &[usize]) -> Vec<[f64; 2]> {
        cell.iter().map(|&node| self.nodes[node]).collect()
    }

    /// The node nearest to a place.
    pub fn node_at(&self, [x, y]: [f64; 2]) -> usize {
        let distance = |&node: &usize| {
            let [a, b] = self.nodes[node];
            (a - x).hypot(b - y)
        };
        (0..self.nodes.len())
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .unwrap()
    }

    /// Consistent nodal forces of a constant force per volume.
    pub fn body_force(&self, thickness: f64, density: [f64; 2]) -> Vec<f64> {
        let mut total = vec![0.0; 2 * self.nodes.len()];
        for cell in &self.cells {
            let mut local = vec![0.0; 2 * cell.len()];
            let nodes = self.positions(cell);
            self.element
                .body_force(&nodes, thickness, density, &mut local)
                .unwrap();
            scatter(cell, &local, &mut total);
        }
        total
    }

    /// Displacements under `force` with the nodes where `fixed` is true held.
    pub fn solve(
        &self,
        material: &dyn Material,
        thickness: f64,
        force: &[f64],
        fixed: impl Fn([f64; 2]) -> bool,
    ) -> Vec<f64> {
        let reach = self.cells.iter().map(|cell| span(cell)).max().unwrap();
        let mut matrix = Banded::new(2 * self.nodes.len(), 2 * reach + 1);
        for cell in &self.cells {
            let n = 2 * cell.len();
            let mut k = vec![0.0; n * n];
            let nodes = self.positions(cell);
            self.element
                .stiffness(&nodes, material, thickness, &mut k)
                .unwrap();
            let dofs: Vec<usize> = cell
                .iter()
                .flat_map(|node| [2 * node, 2 * node + 1])
                .collect();
            for (row, &i) in dofs.iter().enumerate() {
                for (column, &j) in dofs.iter().enumerate().filter(|&(_, &j)| j <= i) {
                    matrix.add(i, j, k[row * n + column]);
                }
            }
        }
        let mut u = force.to_vec();
        for (node, _) in self.nodes.iter().enumerate().filter(|&(_, &x)| fixed(x)) {
            for dof in [2 * node, 2 * node + 1] {
                matrix.hold(dof);
                u[dof] = 0.0;
            }
        }
        matrix.solve_in_place(&mut u);
        u
    }
}

pub fn scatter(cell: &[usize], local: &[f64], total: &mut [f64]) {
    for (node, pair) in cell.iter().zip(local.chunks_exact(2)) {
        total[2 * node] += pair[0];
        total[2 * node + 1] += pair[1];
    }
}

pub fn gather(cell: &[usize], total: &[f64]) -> Vec<f64> {
    cell.iter()
        .flat_map(|node| [total[2 * node], total[2 * node + 1]])
        .collect()
}

fn span(cell: &[usize]) -> usize {
    cell.iter().max().unwrap() - cell.iter().min().unwrap()
}

/// The lower band of a symmetric matrix; row `i` holds columns `i - width ..= i`.
struct Banded {
    n: usize,
    width: usize,
    rows: Vec<f64>,
}

impl Banded {
    fn new(n: usize, width: usize) -> Self {
        Self {
            n,
            width,
            rows: vec![0.0; n * (width + 1)],
        }
    }

    fn at(&self, row: usize, column: usize) -> usize {
        row * (self.width + 1) + self.width + column - row
    }

    fn add(&mut self, row: usize, column: usize, value: f64) {
        let index = self.at(row, column);
        self.rows[index] += value;
    }

    /// Makes an equation `u = 0`.
    fn hold(&mut self, dof: usize) {
        for other in dof.saturating_sub(self.width)..self.n.min(dof + self.width + 1) {
            let index = self.at(dof.max(other), dof.min(other));
            self.rows[index] = f64::from(u8::from(other == dof));
        }
    }

    /// Cholesky, forward and backward substitution.
    fn solve_in_place(mut self, x: &mut [f64]) {
        for i in 0..self.n {
            let first = i.saturating_sub(self.width);
            for j in first..=i {
                let from = first.max(j.saturating_sub(self.width));
                let (a, b) = (self.at(i, from), self.at(j, from));
                let done: f64 = (0..j - from)
                    .map(|k| self.rows[a + k] * self.rows[b + k])
                    .sum();
                let (index, pivot) = (self.at(i, j), self.at(j, j));
                let left = self.rows[index] - done;
                self.rows[index] = if i == j {
                    left.sqrt()
                } else {
                    left / self.rows[pivot]
                };
            }
        }
        for i in 0..self.n {
            let first = i.saturating_sub(self.width);
            let done: f64 = (first..i).map(|j| self.rows[self.at(i, j)] * x[j]).sum();
            x[i] = (x[i] - done) / self.rows[self.at(i, i)];
        }
        for i in (0..self.n).rev() {
            x[i] /= self.rows[self.at(i, i)];
            for j in i.saturating_sub(self.width)..i {
                x[j] -= self.rows[self.at(i, j)] * x[i];
            }
        }
    }
}

/// Four Gauss points of `[0, 1]`: exact to degree 7.
pub const GAUSS_4: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Sixteen points of a reference cell, independent of the element's own rules: triangles as collapsed squares.
pub fn fine_rule(element: &dyn Element) -> Vec<([f64; 2], f64)> {
    let mut rule = Vec::new();
    for (s, ws) in GAUSS_4 {
        for (t, wt) in GAUSS_4 {
            rule.push(if element.n_corners() == 3 {
                ([s * (1.0 - t), t], ws * wt * (1.0 - t))
            } else {
                ([2.0 * s - 1.0, 2.0 * t - 1.0], 4.0 * ws * wt)
            });
        }
    }
    rule
}

pub const TRI3: &dyn Element = &Tri3;
pub const TRI6: &dyn Element = &Tri6;
pub const QUAD4: &dyn Element = &Quad4;
