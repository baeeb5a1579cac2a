//! `H = A + Gᵀ S G` in one sparse factor, and the factor of `A` alone.

use super::analysis::{Analysis, covers, place};
use super::correction::{Correction, FactorRows};
use super::problem::{ConeEntry, ConeProblem};
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cholesky::{CholeskyError, Selection};

/// Difference of weights, relative to the larger one of its row, up to which they count as the same (-): a Newton step with the factor of the
/// ones leaves no more than this share of an imbalance under the others.
const ALIKE: f64 = 1e-2;

/// Rows whose weights may differ from those of the factor at hand where it is corrected instead of made anew.
const MOST_CHANGED: usize = 12;

/// Substitutions that count as one factorization.
const PER_FACTORIZATION: usize = 32;

pub(super) fn are_alike(kept: &[f64; 3], asked: &[f64; 3]) -> bool {
    let most = ALIKE * asked[0].abs().max(asked[2].abs());
    (0..3).all(|k| (kept[k] - asked[k]).abs() <= most)
}

/// How the factor at hand fits the weights asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fit {
    /// It is the factor of the same numbers.
    Exact,
    /// The weights are nearly the same, but they, the matrix or the geometry have moved since.
    Near,
    /// It belongs to other weights.
    None,
}

/// Both factors, with an exact record of the numbers they were made of.
#[derive(Debug, Clone, Default)]
pub(super) struct System {
    pub analysis: Option<Box<Analysis>>,
    has_bodies: bool,
    /// The place in `hull` of every pair of entries of every row, row after row.
    row_places: Vec<u32>,
    /// The part of the factor that rows change.
    selection: Selection,
    /// Whether `hull` and the factor hold nothing but `base` outside that part.
    is_only_touched: bool,
    nodes: Vec<u32>,
    pub spans: Vec<(u32, u32)>,
    pub has_factor: bool,
    /// Whether it was made of the problem at hand.
    is_own: bool,
    pub weights: Vec<[f64; 3]>,
    pub entries: Vec<ConeEntry>,
    pub values: Vec<[f64; 4]>,
    pub correction: Correction,
    right: Vec<f64>,
    pub n_factorizations: usize,
    pub n_analyses: usize,
    /// Factors made or corrected for the problem at hand.
    pub n_changes: usize,
}

impl System {
    /// Makes the pattern cover the rows and the factor of `A` fit its values.
    ///
    /// - `other`: whose pattern is taken over if it covers the rows and the one at hand does not.
    pub fn prepare(
        &mut self,
        problem: &ConeProblem,
        other: Option<&Self>,
    ) -> Result<(), CholeskyError> {
        self.is_own = false;
        (self.n_changes, self.correction.n_substitutions) = (0, 0);
        let has_pattern = self
            .analysis
            .as_ref()
            .is_some_and(|analysis| analysis.matrix.has_pattern_of(problem.matrix));
        if !has_pattern || !self.place_rows(problem) {
            if !other.is_some_and(|other| self.adopt(problem, other)) {
                self.analyze(problem, has_pattern);
            }
            self.place_rows(problem);
        }
        let Some(analysis) = &mut self.analysis else {
            return Ok(());
        };
        if !self.has_bodies || analysis.matrix.blocks() != problem.matrix.blocks() {
            self.has_bodies = false;
            self.is_only_touched = false;
            analysis
                .matrix
                .blocks_mut()
                .copy_from_slice(problem.matrix.blocks());
            for (&place, block) in analysis.matrix_places.iter().zip(problem.matrix.blocks()) {
                analysis.base[place as usize] = *block;
            }
            analysis.bodies.refactorize(problem.matrix)?;
            self.has_bodies = true;
        }
        Ok(())
    }

    /// Takes over what another system knows, if its pattern covers the rows: an analysis costs as much as ten factorizations. Returns whether it
    /// does.
    fn adopt(&mut self, problem: &ConeProblem, other: &Self) -> bool {
        let Some(theirs) = &other.analysis else {
            return false;
        };
        if !theirs.matrix.has_pattern_of(problem.matrix) || !covers(&theirs.hull, problem) {
            return false;
        }
        self.analysis = Some(theirs.clone());
        self.has_bodies = other.has_bodies;
        self.has_factor = false;
        self.is_only_touched = false;
        self.spans.clear();
        true
    }

    /// Couples all nodes of each row, beside those that `A` couples.
    fn analyze(&mut self, problem: &ConeProblem, has_pattern: bool) {
        let rows = problem.rows.iter().map(|row| {
            let entries = problem.entries_of(row).iter();
            entries.map(|entry| entry.node as usize)
        });
        self.couple(problem.matrix, rows, has_pattern);
    }

    /// Makes the pattern that couples the nodes of each cell, beside those that `A` couples.
    ///
    /// - `has_pattern`: whether the pattern of `A` is the one known.
    pub fn couple<Nodes: Iterator<Item = usize>>(
        &mut self,
        matrix: &BlockMatrix,
        cells: impl Iterator<Item = Nodes>,
        has_pattern: bool,
    ) {
        self.spans.clear();
        self.has_factor = false;
        self.is_only_touched = false;
        self.n_analyses += 1;
        match &mut self.analysis {
            Some(analysis) if has_pattern => analysis.couple(matrix, cells),
            slot => {
                self.has_bodies = false;
                *slot = Some(Box::new(Analysis::new(matrix, cells)));
            }
        }
    }

    /// Finds the blocks of every row; false if the pattern lacks one.
    fn place_rows(&mut self, problem: &ConeProblem) -> bool {
        let Some(analysis) = &self.analysis else {
            return false;
        };
        let spans = problem.rows.iter().map(|row| row.entries);
        let nodes = problem.entries.iter().map(|entry| entry.node);
        if spans.clone().eq(self.spans.iter().copied())
            && nodes.clone().eq(self.nodes.iter().copied())
        {
            return true;
        }
        // weights are kept row by row: a factor belongs to the rows it was made of
        self.has_factor = false;
        self.is_only_touched = false;
        self.spans.clear();
        self.row_places.clear();
        for row in problem.rows {
            let entries = problem.entries_of(row);
            for first in entries {
                for second in entries {
                    match place(&analysis.hull, first.node, second.node) {
                        Some(place) => self.row_places.push(place),
                        None => return false,
                    }
                }
            }
        }
        let touched_nodes = nodes.clone().map(|node| node as usize);
        analysis
            .factor
            .select_into(touched_nodes, &mut self.selection);
        self.spans.extend(spans);
        self.nodes.clear();
        self.nodes.extend(nodes);
        true
    }

    /// Compares the factor at hand with the one asked for; the problem is that of the last [`prepare`](Self::prepare).
    pub fn fit(&self, problem: &ConeProblem, weights: &[[f64; 3]]) -> Fit {
        if !self.has_factor || self.weights.len() != weights.len() {
            return Fit::None;
        }
        if self.weights != weights {
            let are_near = self.n_changed(weights) == 0;
            return if are_near { Fit::Near } else { Fit::None };
        }
        if self.is_own {
            return Fit::Exact;
        }
        let is_same = |(row, weight): (&super::problem::ConeRow, &[f64; 3])| {
            let span = row.entries.0 as usize..row.entries.1 as usize;
            *weight == [0.0; 3] || self.entries[span.clone()] == problem.entries[span]
        };
        if self.values == problem.matrix.blocks() && problem.rows.iter().zip(weights).all(is_same) {
            Fit::Exact
        } else {
            Fit::Near
        }
    }

    /// Makes the factor of `A + Gᵀ S G`.
    ///
    /// - `weights`: `S` of each row, `[nn, nt, tt]`.
    pub fn factorize(
        &mut self,
        problem: &ConeProblem,
        weights: &[[f64; 3]],
    ) -> Result<(), CholeskyError> {
        let Some(analysis) = &mut self.analysis else {
            return Ok(());
        };
        self.has_factor = false;
        let Analysis {
            hull, base, factor, ..
        } = &mut **analysis;
        let blocks = hull.blocks_mut();
        if self.is_only_touched {
            for &place in &self.row_places {
                blocks[place as usize] = base[place as usize];
            }
        } else {
            blocks.copy_from_slice(base);
        }
        let mut places = self.row_places.iter();
        for (row, &[nn, nt, tt]) in problem.rows.iter().zip(weights) {
            let entries = problem.entries_of(row);
            if nn == 0.0 && tt == 0.0 {
                if !entries.is_empty() {
                    places.nth(entries.len() * entries.len() - 1);
                }
                continue;
            }
            for first in entries {
                let normal = [0, 1].map(|k| nn * first.normal[k] + nt * first.tangent[k]);
                let tangent = [0, 1].map(|k| nt * first.normal[k] + tt * first.tangent[k]);
                for (second, &place) in entries.iter().zip(&mut places) {
                    let block = &mut blocks[place as usize];
                    for (k, value) in block.iter_mut().enumerate() {
                        *value += normal[k / 2] * second.normal[k % 2]
                            + tangent[k / 2] * second.tangent[k % 2];
                    }
                }
            }
        }
        self.n_factorizations += 1;
        self.n_changes += 1;
        self.correction.forget();
        if std::mem::replace(&mut self.is_only_touched, false) {
            factor.factorize_part(&self.selection, hull)?;
        } else {
            factor.factorize(hull)?;
        }
        self.is_only_touched = true;
        self.weights.clear();
        self.weights.extend_from_slice(weights);
        if !self.is_own {
            self.entries.clear();
            self.entries.extend_from_slice(problem.entries);
            self.values.clear();
            self.values.extend_from_slice(problem.matrix.blocks());
        }
        (self.has_factor, self.is_own) = (true, true);
        Ok(())
    }

    /// Replaces `x` by `H⁻¹ x` for weights that differ from those of the factor at hand in few rows; false, with `x` as it was, where more
    /// differ, or as good as nothing is left of some direction.
    ///
    /// The geometry stays that of the factor.
    pub fn solve_changed(&mut self, weights: &[[f64; 3]], x: &mut [f64]) -> bool {
        if !self.serves(weights) {
            return false;
        }
        let Some(analysis) = &mut self.analysis else {
            return false;
        };
        let rows = self.weights.iter().zip(weights).enumerate();
        let is_new = self.correction.list_changed(
            rows.filter(|(_, (kept, asked))| !are_alike(kept, asked))
                .map(|(row, (kept, asked))| (row, [0, 1, 2].map(|k| asked[k] - kept[k]))),
        );
        let rows = FactorRows {
            spans: &self.spans,
            entries: &self.entries,
        };
        self.right.clear();
        self.right.extend_from_slice(x);
        analysis.factor.solve_in_place(x);
        let is_solved = self.correction.apply(rows, &mut analysis.factor, x);
        if is_solved {
            self.n_changes += usize::from(is_new);
        } else {
            x.copy_from_slice(&self.right);
        }
        is_solved
    }

    /// Whether the factor at hand can be taken, or corrected, for these weights.
    pub fn serves(&self, weights: &[[f64; 3]]) -> bool {
        self.has_factor
            && self.weights.len() == weights.len()
            && self.n_changed(weights) <= MOST_CHANGED
    }

    /// What has been done, in factorizations.
    pub fn spent(&self) -> usize {
        self.n_factorizations
            + (self.correction.n_substitutions + self.n_changes) / PER_FACTORIZATION
    }

    /// Rows whose weights are not those of the factor at hand.
    fn n_changed(&self, weights: &[[f64; 3]]) -> usize {
        let differs = |(kept, asked): &(&[f64; 3], &[f64; 3])| !are_alike(kept, asked);
        self.weights.iter().zip(weights).filter(differs).count()
    }

    /// Replaces `x` by `H⁻¹ x`, with the last factor made.
    pub fn solve(&mut self, x: &mut [f64]) {
        if let Some(analysis) = &mut self.analysis {
            analysis.factor.solve_in_place(x);
        }
    }

    /// Replaces `x` by `A⁻¹ x`.
    pub fn solve_bodies(&mut self, x: &mut [f64]) {
        if let Some(analysis) = &mut self.analysis {
            analysis.bodies.solve_in_place(x);
        }
    }
}
