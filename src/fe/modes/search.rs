//! The shift of the operator, and searches until nothing is missed.

use super::krylov::{BLOCK, Basis, Estimate, Search};
use super::pencil::Pencil;
use super::rigid::rigid_motions;
use super::{Mode, Modes, ModesError};
use crate::math::rounding;

/// The first shift over the highest `ω²` (-).
const FIRST_SHIFT: f64 = 1e-7;

/// The least over the highest `ω²`, with four digits to spare (-).
const LEAST_SHIFT: f64 = rounding::SUM;

/// Shifts that are tried to come near the lowest `ω²` above 0.
const MOST_SHIFTS: usize = 8;

/// Blocks that tell the size of the lowest `ω²`.
const ROUGH_BLOCKS: usize = 4;

/// Rounding of `φ·K φ` over that of one of its terms (-): what is below this is zero.
const ROUNDINGS: f64 = 8.0;

/// See [`lowest_modes`](super::lowest_modes).
pub(super) fn lowest(
    mut pencil: Pencil<'_>,
    positions: &[f64],
    n_modes: usize,
    tolerance: f64,
) -> Result<Modes, ModesError> {
    if !(1e-14..=0.1).contains(&tolerance) {
        return Err(ModesError::Tolerance(tolerance));
    }
    let available = (0..pencil.n_dofs())
        .filter(|&dof| pencil.is_massive(dof))
        .count();
    if n_modes > available {
        return Err(ModesError::TooMany {
            asked: n_modes,
            available,
        });
    }
    let rigid = rigid_motions(&pencil, positions);
    let mut found: Vec<Found> = Vec::new();
    let n_elastic = n_modes.saturating_sub(rigid.len());
    let mut shift = 0.0;
    if n_elastic > 0 {
        shift = choose_shift(&mut pencil, &rigid)?;
        found = search_all(&mut pencil, &rigid, n_elastic, tolerance)?;
    }
    let rigid = rigid.vectors.into_iter().map(|shape| Mode {
        square: 0.0,
        error: 0.0,
        shape: with_sign(shape),
    });
    let largest = found.first().map_or(0.0, |found| found.estimate.theta);
    let elastic = found
        .into_iter()
        .map(|found| found.into_mode(&pencil, shift, largest));
    let mut modes: Vec<Mode> = rigid.chain(elastic).collect();
    modes.sort_by(|a, b| a.square.total_cmp(&b.square));
    modes.truncate(n_modes);
    Ok(Modes {
        n_rigid: modes.iter().filter(|mode| mode.square == 0.0).count(),
        modes,
        n_solves: pencil.n_solves,
        n_factorizations: pencil.n_factorizations,
    })
}

/// Factorizes `K + s M` with `s` near the lowest `ω²` above 0, or above the size of the lowest if that is below 0.
fn choose_shift(pencil: &mut Pencil<'_>, rigid: &Basis) -> Result<f64, ModesError> {
    let highest = pencil.largest_ratio();
    let nothing = Basis::default();
    let mut shift = factorize(pencil, FIRST_SHIFT * highest, highest)?;
    for _ in 0..MOST_SHIFTS {
        let mut search = Search::new(pencil, [rigid, &nothing], 0);
        for _ in 0..ROUGH_BLOCKS {
            if !search.is_exhausted() {
                search.extend(pencil);
            }
        }
        let least = LEAST_SHIFT * highest;
        let squares = search.look().into_iter();
        let mut squares = squares.map(|estimate| 1.0 / estimate.theta - shift);
        // Motions that nothing resists are found with any shift. Others from above, as θ is from below.
        let Some(square) = squares.find(|square| square.abs() > least) else {
            break;
        };
        let better = (-2.0 * square).max(square);
        let is_near = better > 0.1 * shift && better < 10.0 * shift;
        if is_near {
            break;
        }
        shift = factorize(pencil, better, highest)?;
    }
    Ok(shift)
}

/// Factorizes with a shift, or the first larger one with which it can be done.
fn factorize(pencil: &mut Pencil<'_>, first: f64, highest: f64) -> Result<f64, ModesError> {
    let mut shift = first;
    loop {
        match pencil.factorize(shift) {
            Ok(()) => return Ok(shift),
            // Beyond the highest ω² more mass does not help.
            Err(error) if shift > 10.0 * highest => return Err(error.into()),
            Err(_) => shift *= 4.0,
        }
    }
}

/// An eigenvector with what is known of its eigenvalue.
struct Found {
    estimate: Estimate,
    shape: Vec<f64>,
}

impl Found {
    fn into_mode(self, pencil: &Pencil<'_>, shift: f64, largest: f64) -> Mode {
        let [energy, terms] = pencil.stiffness_of(&self.shape);
        let rounding = ROUNDINGS * f64::EPSILON * terms;
        let square = if energy.abs() <= rounding {
            0.0
        } else {
            energy
        };
        // |δθ| <= ρ, so that |δ(ω² + s)| <= (ω² + s) ρ/(θ - ρ).
        let theta = self.estimate.theta;
        let rho = self.estimate.rho + ROUNDINGS * f64::EPSILON * largest;
        Mode {
            square,
            error: (square + shift) * rho / (theta - rho).max(0.0) + rounding,
            shape: with_sign(self.shape),
        }
    }
}

/// Searches until one from another start finds nothing that was missed.
fn search_all(
    pencil: &mut Pencil<'_>,
    rigid: &Basis,
    n_modes: usize,
    tolerance: f64,
) -> Result<Vec<Found>, ModesError> {
    let most_vectors = 40 * BLOCK + 12 * n_modes;
    let mut found: Vec<Found> = Vec::new();
    let mut known = Basis::default();
    for seed in 1.. {
        let mut search = Search::new(pencil, [rigid, &known], seed);
        let new = loop {
            let is_full = search.n_vectors() >= most_vectors;
            if search.n_vectors() > 0 && (search.is_time_to_look() || is_full) {
                let estimates = search.look();
                if let Some(new) = settled(&found, &estimates, n_modes, tolerance) {
                    break new;
                }
                if search.is_exhausted() {
                    break estimates;
                }
            }
            if search.is_exhausted() {
                break Vec::new();
            }
            if is_full {
                return Err(ModesError::NotConverged {
                    n_found: rigid.len() + found.len(),
                    asked: rigid.len() + n_modes,
                    n_solves: pencil.n_solves,
                });
            }
            search.extend(pencil);
        };
        let new: Vec<Found> = new
            .into_iter()
            .map(|estimate| Found {
                estimate,
                shape: search.vector(estimate),
            })
            .collect();
        if new.is_empty() {
            break;
        }
        for new in &new {
            known.add(pencil, new.shape.clone());
        }
        found.extend(new);
        found.sort_by(|a, b| b.estimate.theta.total_cmp(&a.estimate.theta));
    }
    found.truncate(n_modes);
    Ok(found)
}

/// The estimates that belong to the lowest modes, once they are known to the tolerance and no other can come before them.
fn settled(
    found: &[Found],
    estimates: &[Estimate],
    n_modes: usize,
    tolerance: f64,
) -> Option<Vec<Estimate>> {
    let as_large = match found.get(n_modes - 1) {
        // What is as large as the last one, to what is known of both, may be left out.
        Some(last) => last.estimate.theta * (1.0 + 10.0 * tolerance),
        None => {
            let all = found.iter().map(|found| found.estimate.theta);
            let mut all: Vec<f64> = all
                .chain(estimates.iter().map(|estimate| estimate.theta))
                .collect();
            all.sort_by(|a, b| b.total_cmp(a));
            *all.get(n_modes - 1)?
        }
    };
    let is_wanted = |estimate: &&Estimate| estimate.theta + estimate.rho >= as_large;
    let wanted: Vec<Estimate> = estimates.iter().filter(is_wanted).copied().collect();
    let is_known = |estimate: &Estimate| estimate.rho <= tolerance * estimate.theta;
    wanted.iter().all(is_known).then_some(wanted)
}

/// Turns a shape so that its largest entry is positive; of nearly equal ones the first counts.
fn with_sign(mut shape: Vec<f64>) -> Vec<f64> {
    let largest = shape.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    let decisive = shape.iter().find(|x| x.abs() >= 0.999_999 * largest);
    if decisive.is_some_and(|x| *x < 0.0) {
        shape.iter_mut().for_each(|x| *x = -*x);
    }
    shape
}
