//! The slips `sigma = |w_t|` as a fixed point, `sigma ← F(sigma)`, reached faster by Anderson's combination of past changes.
//!
//! Plain steps shrink the error by a factor that nears one, or passes it, where contacts wedge each other. On fixed pieces of the
//! laws the map is affine, and a few past changes foresee where it leads.

/// Past changes that are combined.
const DEPTH: usize = 5;
/// Squared sine of the angle under which a change counts as a combination of the others.
const INDEPENDENT: f64 = 1e-10;

/// Buffers of the iteration.
#[derive(Debug, Clone, Default)]
pub(super) struct SlipIteration {
    /// Changes of the defect `F(sigma) - sigma`, and of `F(sigma)` beside it.
    changes: [(Vec<f64>, Vec<f64>); DEPTH],
    n_changes: usize,
    last: (Vec<f64>, Vec<f64>),
    has_last: bool,
    defect: Vec<f64>,
}

impl SlipIteration {
    /// Forgets the past, which tells nothing about other pieces of the laws.
    pub fn forget(&mut self) {
        self.n_changes = 0;
        self.has_last = false;
    }

    /// Replaces `slip` by the next guess.
    ///
    /// - `found`: `F(slip)`.
    /// - `weights`: what makes slips comparable.
    pub fn advance(&mut self, slip: &mut [f64], found: &[f64], weights: &[f64]) {
        self.defect.clear();
        self.defect.extend(
            found
                .iter()
                .zip(&*slip)
                .zip(weights)
                .map(|((found, slip), weight)| weight * (found - slip)),
        );
        if self.has_last {
            self.n_changes = (self.n_changes + 1).min(DEPTH);
            self.changes.rotate_right(1);
            let (defect, value) = &mut self.changes[0];
            subtract(&self.defect, &self.last.0, defect);
            subtract(found, &self.last.1, value);
        }
        self.last.0.clone_from(&self.defect);
        self.last.1.clear();
        self.last.1.extend_from_slice(found);
        self.has_last = true;
        slip.copy_from_slice(found);
        self.correct(slip);
        slip.iter_mut().for_each(|slip| *slip = slip.max(0.0));
    }

    /// Takes the part of the defect off that the past explains.
    fn correct(&mut self, slip: &mut [f64]) {
        let n = self.n_changes;
        // Gram's matrix beside the right-hand side, solved by elimination: five numbers a side
        let mut gram = [[0.0; DEPTH + 1]; DEPTH];
        for (i, row) in gram.iter_mut().enumerate().take(n) {
            for (j, entry) in row.iter_mut().enumerate().take(n) {
                *entry = dot(&self.changes[i].0, &self.changes[j].0);
            }
            row[DEPTH] = dot(&self.changes[i].0, &self.defect);
        }
        let diagonal: [f64; DEPTH] = std::array::from_fn(|i| gram[i][i]);
        for pivot in 0..n {
            if gram[pivot][pivot] <= INDEPENDENT * diagonal[pivot] {
                for row in &mut gram {
                    row[pivot] = 0.0;
                }
                gram[pivot] = [0.0; DEPTH + 1];
                continue;
            }
            let pivot_row = gram[pivot];
            for (_, row) in gram
                .iter_mut()
                .enumerate()
                .take(n)
                .filter(|(i, _)| *i != pivot)
            {
                let factor = row[pivot] / pivot_row[pivot];
                row.iter_mut()
                    .zip(pivot_row)
                    .for_each(|(entry, above)| *entry -= factor * above);
            }
        }
        for (row, pivot) in gram.iter().zip(0..n) {
            if row[pivot] > 0.0 {
                let share = row[DEPTH] / row[pivot];
                slip.iter_mut()
                    .zip(&self.changes[pivot].1)
                    .for_each(|(slip, change)| *slip -= share * change);
            }
        }
    }
}

fn subtract(a: &[f64], b: &[f64], out: &mut Vec<f64>) {
    out.clear();
    out.extend(a.iter().zip(b).map(|(a, b)| a - b));
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
