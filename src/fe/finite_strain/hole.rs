//! Holes of a body under pressure: `f = -t p ∂A/∂x` in the area `A` that a closed loop of the boundary encloses.
//!
//! The area is a sum of cross products over the sides of the loop, exact for straight ones and for parabolas through a node in the middle,
//!
//! ```text
//! straight  1/2 x_a × x_b        curved  2/3 (x_a × x_m + x_m × x_b) - 1/6 x_a × x_b
//! ```
//!
//! quadratic in the positions: over a step `∂A/∂x` in the middle does the work `ΔA`, has neither a resultant nor a couple about the middles, and with the
//! mean pressure conserves the energy of a gas. The derivative is symmetric but for the second factor of `p' ∂A/∂x ∂A/∂xᵀ`, which is taken from the middle
//! too. As `p' < 0` that part is positive semidefinite; it couples all nodes of the loop, and so does the matrix of a body with gas in it. Without
//! it Newton's iterations do not converge wherever a gas is stiffer than what holds it.

use super::FiniteStrainDescription;
use super::linearization::Linearization;
use super::point::Form;
use super::pressure::{InnerPressure, PressureError};
use crate::fe::mesh::Mesh;
use crate::linalg::block_matrix::BlockMatrix;

/// Two nodes of a loop, by their places in it, and what their cross product counts for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Term {
    from: usize,
    to: usize,
    weight: f64,
}

/// A hole under pressure.
#[derive(Clone, Debug)]
pub(super) struct Hole {
    pub(super) nodes: Vec<usize>,
    terms: Vec<Term>,
    /// Of each node those that its slope is made of, and with what weight (-).
    beside: Vec<[(usize, f64); 4]>,
    pub(super) pressure: InnerPressure,
    /// At rest (m²).
    pub(super) area: f64,
    pub(super) thickness: f64,
    /// Where its positions begin among those of all holes, two numbers a node.
    first: usize,
    /// Places in the matrix of the blocks of each term and of their transposed ones.
    places: Vec<[u32; 2]>,
    /// Places of all pairs of nodes, where a gas couples them.
    all_places: Vec<u32>,
}

impl Hole {
    /// All holes of a mesh, if there is a pressure in one.
    pub(super) fn all(description: &FiniteStrainDescription) -> Result<Vec<Self>, PressureError> {
        let FiniteStrainDescription {
            mesh, pressures, ..
        } = description;
        if pressures.is_empty() {
            return Ok(Vec::new());
        }
        let (found, n_holes) = (pressures.len(), n_holes(mesh));
        if found != n_holes {
            return Err(PressureError::Length { found, n_holes });
        }
        let mut holes: Vec<Self> = Vec::new();
        for (place, pressure) in pressures.iter().enumerate() {
            pressure.validate()?;
            let first = holes.last().map_or(0, |last| last.positions().end);
            let nodes = loop_of(mesh, place);
            let terms = terms_of(mesh, &nodes);
            let mut hole = Self {
                beside: beside(&terms, nodes.len()),
                terms,
                nodes,
                pressure: *pressure,
                area: 0.0,
                thickness: description.thickness,
                first,
                places: Vec::new(),
                all_places: Vec::new(),
            };
            hole.area = hole.area_at(&description.rest_positions);
            holes.push(hole);
        }
        Ok(holes)
    }

    /// The nodes that are coupled with each other beyond their cells.
    pub(super) fn coupled(&self) -> Option<&[usize]> {
        self.pressure.is_gas().then_some(&self.nodes)
    }

    /// Notes where its blocks are in the matrix.
    pub(super) fn place(&mut self, pattern: &BlockMatrix) {
        // The pattern was built from these nodes; numbers of blocks fit into 32 bits.
        let place = |a: usize, b: usize| pattern.place(self.nodes[a], self.nodes[b]);
        let pair = |a: usize, b: usize| Some([place(a, b)? as u32, place(b, a)? as u32]);
        let terms = self.terms.iter();
        self.places = terms.filter_map(|term| pair(term.from, term.to)).collect();
        if self.pressure.is_gas() {
            let n = self.nodes.len();
            let pairs = (0..n).flat_map(|a| (0..n).map(move |b| (a, b)));
            self.all_places = pairs
                .filter_map(|(a, b)| place(a, b).map(|place| place as u32))
                .collect();
        }
    }

    /// Its positions among those of all holes.
    pub(super) fn positions(&self) -> std::ops::Range<usize> {
        self.first..self.first + 2 * self.nodes.len()
    }

    /// Writes the positions of the nodes relative to the first one (m): no digits are lost far from the origin.
    pub(super) fn gather_into(&self, positions: &[f64], out: &mut [f64]) {
        for (place, out) in out.as_chunks_mut::<2>().0.iter_mut().enumerate() {
            *out = relative(&self.nodes, place, positions);
        }
    }

    fn area_of(&self, at: &[f64]) -> f64 {
        let at = at.as_chunks::<2>().0;
        area(&self.terms, |place| at[place])
    }

    /// Area at the positions of all nodes (m²).
    fn area_at(&self, positions: &[f64]) -> f64 {
        area(&self.terms, |place| relative(&self.nodes, place, positions))
    }

    /// `∂A/∂x` of one node (m), by the positions of those around it.
    fn slope(&self, place: usize, at: impl Fn(usize) -> [f64; 2]) -> [f64; 2] {
        let mut slope = [0.0; 2];
        for (other, weight) in self.beside[place] {
            let [x, y] = at(other);
            slope[0] += weight * y;
            slope[1] -= weight * x;
        }
        slope
    }

    /// Work of a constant pressure on the way from one placement of all nodes to another (J).
    pub(super) fn work(&self, from: &[f64], to: &[f64]) -> f64 {
        let at = |positions| move |place| relative(&self.nodes, place, positions);
        let growth = self.growth(at(from), at(to));
        self.thickness * self.pressure.at(1.0) * growth
    }

    /// `A' - A` from the differences of the positions (m²).
    fn growth(&self, start: impl Fn(usize) -> [f64; 2], end: impl Fn(usize) -> [f64; 2]) -> f64 {
        let products = self.terms.iter().map(|term| {
            let [a, b] = [term.from, term.to].map(|place| {
                let (from, to) = (start(place), end(place));
                let middle = [0, 1].map(|axis| 0.5 * (from[axis] + to[axis]));
                (middle, [to[0] - from[0], to[1] - from[1]])
            });
            term.weight * (product(a.0, b.1) + product(a.1, b.0))
        });
        products.sum()
    }

    /// Pressure above that outside between both ends (Pa) and its slope by the area of the end (Pa/m²).
    fn pressure_between(&self, form: Form, start: &[f64], end: &[f64]) -> [f64; 2] {
        let [pressure, slope] = match form {
            Form::Equilibrium => self.pressure.slope(self.area_of(end) / self.area),
            Form::EnergyMomentum { .. } => {
                let ratio = self.area_of(start) / self.area;
                let ends = [start, end].map(|one| one.as_chunks::<2>().0);
                let [from, to] = ends.map(|one| move |place: usize| one[place]);
                let change = self.growth(from, to) / self.area;
                self.pressure.mean(ratio, change)
            }
        };
        [pressure, slope / self.area]
    }

    /// Subtracts the internal force, `-t p ∂A/∂x`; what is not a number where nothing is left of a gas.
    pub(super) fn subtract_force(
        &self,
        form: Form,
        [start, end]: [&[f64]; 2],
        residual: &mut [f64],
    ) {
        let [pressure, _] = self.pressure_between(form, start, end);
        let force = self.thickness * pressure;
        let at = between(form.share_of_end(), start, end);
        for (place, node) in self.nodes.iter().enumerate() {
            let [x, y] = self.slope(place, &at);
            residual[2 * node] += force * x;
            residual[2 * node + 1] += force * y;
        }
    }

    /// Adds the derivative of the internal force by the positions at the end.
    pub(super) fn add_tangent(
        &self,
        (form, kind): (Form, Linearization),
        [start, end]: [&[f64]; 2],
        matrix: &mut BlockMatrix,
    ) {
        let [pressure, slope] = self.pressure_between(form, start, end);
        if kind == Linearization::Consistent {
            // What the pressure makes of the change of the sides has no definite sign.
            let factor = -self.thickness * pressure * form.share_of_end();
            for (term, [place, transposed]) in self.terms.iter().zip(&self.places) {
                let entry = factor * term.weight;
                matrix.add_block_at(*place as usize, [0.0, entry, -entry, 0.0]);
                matrix.add_block_at(*transposed as usize, [0.0, -entry, entry, 0.0]);
            }
        }
        let mut stiffness = -self.thickness * slope;
        if stiffness <= 0.0 || stiffness.is_nan() {
            return;
        }
        // What knows of no turn is the slope of an area that is there.
        let share = match kind {
            Linearization::Impulsive { .. } => 1.0,
            _ => form.share_of_end(),
        };
        let at = between(share, start, end);
        let n = self.nodes.len();
        if let Linearization::Impulsive { most } = kind {
            let squares = (0..n).map(|place| {
                let [x, y] = self.slope(place, &at);
                x * x + y * y
            });
            stiffness = stiffness.min(most / squares.fold(0.0, f64::max));
        }
        for (row, places) in self.all_places.chunks_exact(n).enumerate() {
            let [x, y] = self.slope(row, &at);
            for (column, place) in places.iter().enumerate() {
                let [u, v] = self.slope(column, &at);
                // The products commute to the last digit, which keeps the matrix symmetric.
                let block = [x * u, x * v, y * u, y * v];
                matrix.add_block_at(*place as usize, block.map(|entry| stiffness * entry));
            }
        }
    }

    /// Energy of its gas (J).
    pub(super) fn energy(&self, positions: &[f64]) -> f64 {
        let area = self.area_at(positions);
        self.thickness * self.area * self.pressure.energy(area / self.area)
    }
}

fn product([a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    a * d - b * c
}

pub(super) fn area(terms: &[Term], at: impl Fn(usize) -> [f64; 2]) -> f64 {
    let products = terms.iter();
    products
        .map(|term| term.weight * product(at(term.from), at(term.to)))
        .sum()
}

/// Position of a node of a loop relative to the first one (m).
pub(super) fn relative(nodes: &[usize], place: usize, positions: &[f64]) -> [f64; 2] {
    let (node, origin) = (nodes[place], nodes[0]);
    [0, 1].map(|axis| positions[2 * node + axis] - positions[2 * origin + axis])
}

/// Positions on the way from `start` to `end`, a share of it gone.
fn between(share: f64, start: &[f64], end: &[f64]) -> impl Fn(usize) -> [f64; 2] {
    let (start, end) = (start.as_chunks::<2>().0, end.as_chunks::<2>().0);
    move |place| {
        let (from, to) = (start[place], end[place]);
        [0, 1].map(|axis| share * to[axis] + (1.0 - share) * from[axis])
    }
}

/// What the slope at each node is made of: `w x_a × x_b` has the slopes `w (y_b, -x_b)` and `-w (y_a, -x_a)`.
fn beside(terms: &[Term], n: usize) -> Vec<[(usize, f64); 4]> {
    let mut found = vec![Vec::new(); n];
    for term in terms {
        found[term.from].push((term.to, term.weight));
        found[term.to].push((term.from, -term.weight));
    }
    let rows = found.into_iter().enumerate();
    // At most the two nodes of the side before and the two of the side after.
    rows.map(|(place, list)| std::array::from_fn(|k| list.get(k).copied().unwrap_or((place, 0.0))))
        .collect()
}

/// Number of holes of a mesh.
pub(super) fn n_holes(mesh: &Mesh) -> usize {
    mesh.boundary().loops().len().saturating_sub(1)
}

/// The nodes around a hole, counter-clockwise.
pub(super) fn loop_of(mesh: &Mesh, hole: usize) -> Vec<usize> {
    let around = &mesh.boundary().loops()[hole + 1];
    // The first one is a corner, and stays it.
    let mut nodes = around.nodes().to_vec();
    nodes[1..].reverse();
    nodes
}

/// The sum that is the area within a loop.
pub(super) fn terms_of(mesh: &Mesh, nodes: &[usize]) -> Vec<Term> {
    let mut is_midside = vec![false; mesh.n_nodes()];
    for cell in mesh.cells() {
        for &node in &cell.nodes[cell.kind.n_corners()..] {
            is_midside[node] = true;
        }
    }
    let n = nodes.len();
    let mut terms = Vec::new();
    let mut from = 0;
    while from < n {
        let mut push = |from: usize, to: usize, weight: f64| {
            terms.push(Term {
                from: from % n,
                to: to % n,
                weight,
            });
        };
        if is_midside[nodes[(from + 1) % n]] {
            push(from, from + 1, 2.0 / 3.0);
            push(from + 1, from + 2, 2.0 / 3.0);
            push(from, from + 2, -1.0 / 6.0);
            from += 2;
        } else {
            push(from, from + 1, 0.5);
            from += 1;
        }
    }
    terms
}
