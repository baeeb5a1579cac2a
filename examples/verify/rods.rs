//! Strips of h/L = 1/100 and ν = 0 that stand for rods, and their equilibria along paths.
//!
//! A strip differs from a rod that neither stretches nor shears by some (h/L)² and P/EA, both 1e-4 and less here.

use super::sheet::Sheet;
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainError, FiniteStrainModel};
use foil2d::fe::material::hyperelastic::Corotated;
use foil2d::fe::mesh::{CellKind, generate};
use foil2d::large::{LargeError, PathCase, PathSettings, PathStepper};
use std::error::Error;
use std::sync::Arc;

pub const HEIGHT: f64 = 0.01;
pub const YOUNG: f64 = 1.2e7;
/// `E h³/12` of a strip 1 m thick (N m²).
pub const BENDING: f64 = YOUNG * HEIGHT * HEIGHT * HEIGHT / 12.0;

/// What a relative error of the strip that is judged may be.
pub const BAR: f64 = 5e-4;

/// Elements along the rod, and how many across.
pub const MESHES: [(CellKind, &str, [usize; 2]); 3] = [
    (CellKind::Tri6, "T6, 50 x 1", [50, 1]),
    (CellKind::Quad4, "Q4, 50 x 1", [50, 1]),
    (CellKind::Tri3, "T3, 50 x 1", [50, 1]),
];

/// A strip from (0, 0) to (1, 0), its middle line on y = 0.
pub struct Strip {
    pub model: Arc<FiniteStrainModel>,
    pub rest: Vec<f64>,
}

impl Strip {
    /// A strip whose middle line is `y = rise(x)` (m).
    ///
    /// # Errors
    /// If there is no such body.
    pub fn new(
        kind: CellKind,
        divisions: [usize; 2],
        rise: impl Fn(f64) -> f64,
    ) -> Result<Self, Box<dyn Error + Send + Sync>> {
        let mesh = generate::rectangle([1.0, HEIGHT], divisions, kind)?;
        let law = Corotated::plane_strain(YOUNG, 0.0);
        let mut description = FiniteStrainDescription::new(mesh, law, 1000.0);
        for p in description.rest_positions.chunks_exact_mut(2) {
            p[1] += rise(p[0]) - 0.5 * HEIGHT;
        }
        Ok(Self::of(description)?)
    }

    fn of(description: FiniteStrainDescription) -> Result<Self, FiniteStrainError> {
        let model = FiniteStrainModel::assemble(description)?;
        Ok(Self {
            rest: model.rest_positions().to_vec(),
            model: Arc::new(model),
        })
    }

    /// The node at a place, and with an even number of rows of linear cells none in the middle of an end.
    pub fn node(&self, x: f64, y: f64) -> Option<usize> {
        let near = |p: &[f64]| (p[0] - x).hypot(p[1] - y) < 1e-9;
        self.rest.chunks_exact(2).position(near)
    }

    /// The corners at the end, lower and upper.
    pub fn end(&self) -> [usize; 2] {
        let half = 0.5 * HEIGHT;
        [-half, half].map(|y| self.node(1.0, y).unwrap_or(0))
    }

    /// The mean place of the end's corners, and by how much the end has turned (m, m, rad).
    pub fn tip(&self, x: &[f64]) -> [f64; 3] {
        let [low, high] = self.end();
        let mean = [0, 1].map(|k| 0.5 * (x[2 * low + k] + x[2 * high + k]));
        let across = [0, 1].map(|k| x[2 * high + k] - x[2 * low + k]);
        [mean[0], mean[1], (-across[0]).atan2(across[1])]
    }

    /// Which dofs a clamp at x = 0 holds.
    pub fn clamped(&self) -> Vec<bool> {
        let nodes = self.rest.chunks_exact(2);
        nodes.flat_map(|p| [p[0] == 0.0; 2]).collect()
    }

    /// A dead load on the end (N), shared by its corners.
    pub fn load(&self, force: [f64; 2]) -> Vec<f64> {
        let mut load = vec![0.0; self.rest.len()];
        for node in self.end() {
            for axis in 0..2 {
                load[2 * node + axis] = 0.5 * force[axis];
            }
        }
        load
    }

    /// # Errors
    /// If the case is none.
    pub fn path(&self, case: PathCase) -> Result<PathStepper, LargeError> {
        let settings = PathSettings {
            tolerance: 1e-9,
            longest: 0.3,
            ..PathSettings::default()
        };
        PathStepper::new(Arc::clone(&self.model), case, &self.rest, settings)
    }

    /// The middle line, for pictures (m).
    pub fn line(&self, x: &[f64]) -> Vec<[f64; 2]> {
        let mut ends: Vec<(f64, [f64; 2])> = Vec::new();
        let half = 0.5 * HEIGHT;
        for (node, p) in self.rest.chunks_exact(2).enumerate() {
            if (p[1] + half).abs() < 1e-9
                && let Some(other) = self.node(p[0], half)
            {
                let mean = [0, 1].map(|k| 0.5 * (x[2 * node + k] + x[2 * other + k]));
                ends.push((p[0], mean));
            }
        }
        ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        ends.into_iter().map(|(_, mean)| mean).collect()
    }
}

/// Judges the first mesh and tells of the others.
pub fn put(sheet: &mut Sheet, mesh: usize, quantity: &str, expected: f64, found: f64) {
    let name = format!("{quantity}, {}", MESHES[mesh].1);
    if mesh == 0 {
        sheet.relative(name, expected, found, BAR);
    } else {
        sheet.tell(name, expected, found);
    }
}

/// The meshes to run: all, or where the book is cut short the judged one.
pub fn meshes(sheet: &Sheet) -> usize {
    match sheet.size {
        super::sheet::Size::Steps(_) => 1,
        _ => MESHES.len(),
    }
}
