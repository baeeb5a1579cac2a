//! The cell under test: distorted, and numbered from its reference cell by symmetry alone.

use crate::fe::element::Element;
use crate::fe::material::LinearElastic;

/// The thickness (m) of every specimen; not 1, so that a forgotten factor shows.
pub const THICKNESS: f64 = 0.3;
/// The density (kg/m^3) of every specimen.
pub const DENSITY: f64 = 7.0;

const TRIANGLE: [[f64; 2]; 3] = [[0.1, -0.2], [1.3, 0.1], [0.4, 0.9]];
const QUADRILATERAL: [[f64; 2]; 4] = [[-0.1, 0.1], [1.2, -0.1], [0.9, 1.0], [0.2, 0.8]];

/// An element, and one cell of it.
pub struct Specimen<'a> {
    pub element: &'a dyn Element,
    pub nodes: Vec<[f64; 2]>,
    pub material: LinearElastic,
}

impl<'a> Specimen<'a> {
    /// A distorted cell with straight sides and evenly spaced side nodes.
    pub fn straight(element: &'a dyn Element) -> Self {
        let reference = element.reference_nodes();
        // The frame in which the reference cell is the unit triangle or the unit square.
        let last = reference[element.n_corners() - 1];
        let unit = Frame::new(reference[0], reference[1], last);
        let nodes = reference
            .iter()
            .map(|&at| place(unit.coordinates(at), element.n_corners()))
            .collect();
        Self {
            element,
            nodes,
            material: LinearElastic::plane_stress(50.0, 0.3).density(DENSITY),
        }
    }

    /// The same cell with its other nodes moved off their straight lines by up to 3 % of its size.
    pub fn curved(&self) -> Self {
        let n_corners = self.element.n_corners();
        let mut nodes = self.nodes.clone();
        for (index, node) in nodes.iter_mut().enumerate().skip(n_corners) {
            let phase = 1.0 + 2.0 * index as f64;
            node[0] += 0.03 * phase.sin();
            node[1] += 0.03 * phase.cos();
        }
        self.with_nodes(nodes)
    }

    /// The same element and material on other positions.
    pub fn with_nodes(&self, nodes: Vec<[f64; 2]>) -> Self {
        Self {
            element: self.element,
            nodes,
            material: self.material,
        }
    }

    /// For each new node the old one at its place, when corner 0 is renamed to the old corner 1 and so on round.
    pub fn cyclic_numbering(&self) -> Vec<usize> {
        let n_corners = self.element.n_corners();
        self.numbering([1, 2, 3 % n_corners])
    }

    /// For each new node the old one at its place, when the cell is run round the other way from corner 0.
    pub fn mirrored_numbering(&self) -> Vec<usize> {
        let n_corners = self.element.n_corners();
        self.numbering([0, n_corners - 1, n_corners - 2])
    }

    /// The numbering by the affine symmetry of the reference cell that sends corners 0, 1, 2 to `images`.
    fn numbering(&self, images: [usize; 3]) -> Vec<usize> {
        let reference = self.element.reference_nodes();
        let [from, along, across] = images.map(|corner| reference[corner]);
        let frame = Frame::new(reference[0], reference[1], reference[2]);
        let nearest = |at: [f64; 2]| {
            let distance =
                |index: &usize| (reference[*index][0] - at[0]).hypot(reference[*index][1] - at[1]);
            (0..reference.len())
                .min_by(|a, b| distance(a).total_cmp(&distance(b)))
                .unwrap_or(0)
        };
        reference
            .iter()
            .map(|&at| {
                let [s, t] = frame.coordinates(at);
                nearest(
                    [0, 1].map(|i| from[i] + s * (along[i] - from[i]) + t * (across[i] - from[i])),
                )
            })
            .collect()
    }
}

/// Affine coordinates in which `origin`, `first`, `second` are (0,0), (1,0), (0,1).
struct Frame {
    origin: [f64; 2],
    along: [f64; 2],
    across: [f64; 2],
}

impl Frame {
    fn new(origin: [f64; 2], first: [f64; 2], second: [f64; 2]) -> Self {
        Self {
            origin,
            along: [first[0] - origin[0], first[1] - origin[1]],
            across: [second[0] - origin[0], second[1] - origin[1]],
        }
    }

    fn coordinates(&self, at: [f64; 2]) -> [f64; 2] {
        let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
        let from_origin = [at[0] - self.origin[0], at[1] - self.origin[1]];
        let area = cross(self.along, self.across);
        [
            cross(from_origin, self.across) / area,
            cross(self.along, from_origin) / area,
        ]
    }
}

/// Maps the unit triangle affinely, or the unit square bilinearly, on the specimen's corners.
fn place([s, t]: [f64; 2], n_corners: usize) -> [f64; 2] {
    if n_corners == 3 {
        let [a, b, c] = TRIANGLE;
        return [0, 1].map(|i| a[i] + s * (b[i] - a[i]) + t * (c[i] - a[i]));
    }
    let [a, b, c, d] = QUADRILATERAL;
    [0, 1].map(|i| (1.0 - t) * ((1.0 - s) * a[i] + s * b[i]) + t * (s * c[i] + (1.0 - s) * d[i]))
}
