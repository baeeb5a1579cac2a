//! One search by block Lanczos: `B V = V T + Q R Eᵀ` with `B = (K + s M)⁻¹ M`, all vectors orthonormal in `M`.
//!
//! The eigenvalues `θ` of `T` rise towards the largest of `B`, `θ = 1/(ω² + s)`, and `ρ = |R y|`, with `y` the entries of an eigenvector in
//! the last block, bounds the distance of `θ` to an eigenvalue of `B`.

use super::pencil::Pencil;
use crate::math::rounding;
use nalgebra::{DMatrix, SymmetricEigen};

/// Vectors that go through the solver at once.
pub(super) const BLOCK: usize = 4;

/// Blocks between two looks at the eigenvalues of `T`, which cost the cube of its size.
const BETWEEN_LOOKS: usize = 2;

/// What is left of a vector, when its parts along others are taken off twice, is its own above this share (-).
const OWN: f64 = rounding::SOLVED;

/// Vectors orthonormal in `M`, with `M` times each.
#[derive(Clone, Debug, Default)]
pub(super) struct Basis {
    pub(super) vectors: Vec<Vec<f64>>,
    images: Vec<Vec<f64>>,
}

impl Basis {
    /// Takes the parts along the basis off `x`; returns them.
    fn take_off(&self, x: &mut [f64]) -> Vec<f64> {
        let mut parts = vec![0.0; self.vectors.len()];
        for ((part, vector), image) in parts.iter_mut().zip(&self.vectors).zip(&self.images) {
            *part = dot(image, x);
            for (x, v) in x.iter_mut().zip(vector) {
                *x -= *part * v;
            }
        }
        parts
    }

    /// Adds what is a vector's own, normalized; nothing if there is none.
    pub(super) fn add(&mut self, pencil: &Pencil<'_>, mut x: Vec<f64>) {
        let before = dot(&x, &pencil.mass_times(&x)).max(0.0).sqrt();
        self.take_off(&mut x);
        self.take_off(&mut x);
        let mut image = pencil.mass_times(&x);
        let length = dot(&x, &image).max(0.0).sqrt();
        if length > OWN * before && length > 0.0 {
            x.iter_mut().for_each(|x| *x /= length);
            image.iter_mut().for_each(|x| *x /= length);
            self.vectors.push(x);
            self.images.push(image);
        }
    }

    pub(super) fn len(&self) -> usize {
        self.vectors.len()
    }
}

/// An eigenvalue of `B` as it is known so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Estimate {
    /// `θ = 1/(ω² + s)` (s²/rad²).
    pub(super) theta: f64,
    /// Distance to the nearest eigenvalue of `B` at most.
    pub(super) rho: f64,
    /// Which eigenvector of `T` it has.
    column: usize,
}

/// One search, orthogonal to what is known.
pub(super) struct Search<'k> {
    known: [&'k Basis; 2],
    basis: Basis,
    /// Columns of `T`, each as long as the basis was.
    columns: Vec<Vec<f64>>,
    /// First vector of the last block.
    last: usize,
    /// The next block, and `R` by columns of the last.
    next: Vec<Vec<f64>>,
    remainder: Vec<Vec<f64>>,
    coefficients: DMatrix<f64>,
    n_looked: usize,
}

impl<'k> Search<'k> {
    /// A search from a random block; each `seed` gives another, the same in every run.
    pub(super) fn new(pencil: &mut Pencil<'_>, known: [&'k Basis; 2], seed: u64) -> Self {
        let mut search = Self {
            known,
            basis: Basis::default(),
            columns: Vec::new(),
            last: 0,
            next: Vec::new(),
            remainder: Vec::new(),
            coefficients: DMatrix::zeros(0, 0),
            n_looked: 0,
        };
        let mut random = Random::new(seed);
        let starts = (0..BLOCK).map(|_| random.vector(pencil));
        let starts: Vec<Vec<f64>> = starts.collect();
        // Only what the operator returns moves nodes without mass as the others move them.
        let images = search.apply(pencil, &starts);
        search.accept(pencil, images);
        search
    }

    /// Whether there is nothing left to add.
    pub(super) fn is_exhausted(&self) -> bool {
        self.next.is_empty()
    }

    pub(super) fn n_vectors(&self) -> usize {
        self.basis.len()
    }

    /// Whether it is time to look at the estimates.
    pub(super) fn is_time_to_look(&self) -> bool {
        let grown = self.basis.len() - self.n_looked;
        self.is_exhausted() || grown >= (BETWEEN_LOOKS * BLOCK).max(self.basis.len() / 8)
    }

    /// Adds a block.
    pub(super) fn extend(&mut self, pencil: &mut Pencil<'_>) {
        self.last = self.basis.len();
        for vector in std::mem::take(&mut self.next) {
            let image = pencil.mass_times(&vector);
            self.basis.vectors.push(vector);
            self.basis.images.push(image);
        }
        let block = self.basis.vectors[self.last..].to_vec();
        let images = self.apply(pencil, &block);
        self.accept(pencil, images);
    }

    /// `B` times vectors.
    fn apply(&self, pencil: &mut Pencil<'_>, block: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let products = block.iter().map(|vector| pencil.mass_times(vector));
        let mut columns: Vec<f64> = products.flatten().collect();
        pencil.solve(&mut columns);
        let n_dofs = pencil.n_dofs();
        columns.chunks_exact(n_dofs).map(<[f64]>::to_vec).collect()
    }

    /// Takes images apart: along the basis, which gives columns of `T`, and what is new, the next block.
    fn accept(&mut self, pencil: &Pencil<'_>, images: Vec<Vec<f64>>) {
        let mut new = Basis::default();
        self.remainder.clear();
        for mut image in images {
            let before = dot(&image, &pencil.mass_times(&image)).max(0.0).sqrt();
            let mut column = vec![0.0; self.basis.len()];
            let mut beside = vec![0.0; new.len()];
            for _ in 0..2 {
                for known in self.known {
                    known.take_off(&mut image);
                }
                add(&mut column, &self.basis.take_off(&mut image));
                add(&mut beside, &new.take_off(&mut image));
            }
            let length = dot(&image, &pencil.mass_times(&image)).max(0.0).sqrt();
            if length > OWN * before {
                image.iter_mut().for_each(|x| *x /= length);
                new.images.push(pencil.mass_times(&image));
                new.vectors.push(image);
                beside.push(length);
            }
            self.remainder.push(beside);
            if !self.basis.vectors.is_empty() {
                self.columns.push(column);
            }
        }
        self.next = new.vectors;
    }

    /// What is known of the eigenvalues, the largest `θ` first.
    pub(super) fn look(&mut self) -> Vec<Estimate> {
        let size = self.columns.len();
        self.n_looked = size;
        let entry = |i: usize, j: usize| self.columns[j].get(i).copied();
        // `T` is symmetric; above a column's end are entries of later columns.
        let matrix = DMatrix::from_fn(size, size, |i, j| match (entry(i, j), entry(j, i)) {
            (Some(a), Some(b)) => 0.5 * (a + b),
            (Some(a), None) | (None, Some(a)) => a,
            (None, None) => 0.0,
        });
        let eigen = SymmetricEigen::new(matrix);
        self.coefficients = eigen.eigenvectors;
        let mut estimates: Vec<Estimate> = (0..size)
            .map(|column| Estimate {
                theta: eigen.eigenvalues[column],
                rho: self.left_of(column),
                column,
            })
            .collect();
        estimates.sort_by(|a, b| b.theta.total_cmp(&a.theta));
        estimates
    }

    /// `|R y|` of an eigenvector of `T`.
    fn left_of(&self, column: usize) -> f64 {
        let mut left = vec![0.0; self.next.len()];
        for (k, remainder) in self.remainder.iter().enumerate() {
            let share = self.coefficients[(self.last + k, column)];
            for (left, part) in left.iter_mut().zip(remainder) {
                *left += share * part;
            }
        }
        dot(&left, &left).sqrt()
    }

    /// The vector of an estimate of the last look.
    pub(super) fn vector(&self, estimate: Estimate) -> Vec<f64> {
        let mut vector = vec![0.0; self.basis.vectors[0].len()];
        let looked = &self.basis.vectors[..self.coefficients.nrows()];
        for (k, basis) in looked.iter().enumerate() {
            let share = self.coefficients[(k, estimate.column)];
            for (sum, x) in vector.iter_mut().zip(basis) {
                *sum += share * x;
            }
        }
        vector
    }
}

/// Random numbers, the same in every run (xorshift).
struct Random(u64);

impl Random {
    fn new(seed: u64) -> Self {
        Self(0x9E37_79B9_7F4A_7C15 ^ seed.wrapping_mul(0xD134_2543_DE82_EF95))
    }

    /// Numbers in [-1/2, 1/2] at dofs that are free and carry mass.
    fn vector(&mut self, pencil: &Pencil<'_>) -> Vec<f64> {
        (0..pencil.n_dofs())
            .map(|dof| {
                self.0 ^= self.0 << 13;
                self.0 ^= self.0 >> 7;
                self.0 ^= self.0 << 17;
                match pencil.is_massive(dof) {
                    true => (self.0 >> 11) as f64 / (1u64 << 53) as f64 - 0.5,
                    false => 0.0,
                }
            })
            .collect()
    }
}

fn add(sums: &mut [f64], parts: &[f64]) {
    for (sum, part) in sums.iter_mut().zip(parts) {
        *sum += part;
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
