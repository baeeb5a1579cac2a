//! Problems to solve, and a repeatable source of numbers.

use foil2d::linalg::complementarity::{Outcome, Problem, RowKind, Solver, Status};

/// SplitMix64: the same numbers on every machine.
pub struct Numbers(pub u64);

impl Numbers {
    /// The next number in `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// The next number in `[-1, 1)`.
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }
}

/// A problem that owns its data.
#[derive(Clone)]
pub struct Case {
    pub delassus: Vec<f64>,
    pub free: Vec<f64>,
    pub rows: Vec<RowKind>,
}

impl Case {
    /// `W = G M⁻¹ Gᵀ`, `b = G v`: solvable whatever the rank, because the bodies could stand still.
    ///
    /// - `jacobian`: `G`, one line per row; `inverse_mass`: the diagonal of `M⁻¹`; `velocity`: `v`.
    pub fn from_bodies(
        jacobian: &[Vec<f64>],
        inverse_mass: &[f64],
        velocity: &[f64],
        rows: Vec<RowKind>,
    ) -> Self {
        let n = rows.len();
        let mut delassus = vec![0.0; n * n];
        for row in 0..n {
            for column in 0..=row {
                let pairs = jacobian[row].iter().zip(&jacobian[column]);
                let entry = pairs.zip(inverse_mass).map(|((a, b), m)| a * b * m).sum();
                delassus[row * n + column] = entry;
                delassus[column * n + row] = entry;
            }
        }
        let free = jacobian
            .iter()
            .map(|line| line.iter().zip(velocity).map(|(g, v)| g * v).sum())
            .collect();
        Self {
            delassus,
            free,
            rows,
        }
    }

    pub fn problem(&self) -> Problem<'_> {
        Problem {
            delassus: &self.delassus,
            free: &self.free,
            rows: &self.rows,
            acted: &[],
        }
    }

    /// Solves without a warm start.
    pub fn solve(&self) -> (Vec<f64>, Vec<Status>, Outcome) {
        let n = self.rows.len();
        let (mut multipliers, mut status) = (vec![0.0; n], vec![Status::Open; n]);
        let outcome = Solver::new()
            .solve(&self.problem(), &mut multipliers, &mut status)
            .expect("the data of the case is finite");
        (multipliers, status, outcome)
    }

    /// `w = W p + b`.
    pub fn velocities(&self, multipliers: &[f64]) -> Vec<f64> {
        let lines = self.delassus.chunks_exact(self.rows.len());
        let products = lines.map(|line| {
            line.iter()
                .zip(multipliers)
                .map(|(w, p)| w * p)
                .sum::<f64>()
        });
        products
            .zip(&self.free)
            .map(|(product, b)| product + b)
            .collect()
    }
}

/// `n_contacts` frictional contacts with random directions, arms and coefficients between `n_bodies`
/// rigid bodies (masses over four decades) and the ground. Rows alternate normal, tangent.
pub fn random_contacts(
    seed: u64,
    n_bodies: usize,
    n_contacts: usize,
    largest_coefficient: f64,
) -> Case {
    let mut numbers = Numbers(seed);
    let inverse_mass: Vec<f64> = (0..n_bodies)
        .flat_map(|_| {
            let mass = 10.0_f64.powf(2.0 * numbers.signed());
            [1.0 / mass, 1.0 / mass, 6.0 / mass]
        })
        .collect();
    let mut jacobian = vec![vec![0.0; 3 * n_bodies]; 2 * n_contacts];
    let mut rows = Vec::new();
    for contact in 0..n_contacts {
        let first = (numbers.unit() * n_bodies as f64) as usize;
        let second = (numbers.unit() * (n_bodies + 1) as f64) as usize;
        let (sin, cos) = (numbers.unit() * std::f64::consts::TAU).sin_cos();
        for (body, side) in [(first, 1.0), (second, -1.0)] {
            // the body number n_bodies is the ground
            if body == n_bodies || (body == first && side < 0.0) {
                continue;
            }
            let (arm_x, arm_y) = (numbers.signed(), numbers.signed());
            for (row, x, y) in [(2 * contact, cos, sin), (2 * contact + 1, -sin, cos)] {
                jacobian[row][3 * body] = side * x;
                jacobian[row][3 * body + 1] = side * y;
                jacobian[row][3 * body + 2] = side * (arm_x * y - arm_y * x);
            }
        }
        let coefficient = largest_coefficient * numbers.unit();
        rows.push(RowKind::Unilateral);
        rows.push(RowKind::Friction {
            normal: 2 * contact,
            coefficient,
        });
    }
    let velocity: Vec<f64> = (0..3 * n_bodies).map(|_| numbers.signed()).collect();
    Case::from_bodies(&jacobian, &inverse_mass, &velocity, rows)
}

/// Fails unless the two vectors agree to `tolerance`, absolutely.
pub fn assert_close(left: &[f64], right: &[f64], tolerance: f64) {
    assert_eq!(left.len(), right.len());
    for (index, (a, b)) in left.iter().zip(right).enumerate() {
        assert!(
            (a - b).abs() <= tolerance,
            "entry {index}: {a} and {b} differ by {}",
            (a - b).abs()
        );
    }
}
