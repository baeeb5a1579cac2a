//! The diagonal block of a panel: `B = L Lᵀ`, kept as `L⁻¹`.
//!
//! Blocks have 2 to 8 dofs. A solve with `L⁻¹` is a product, without a chain of divisions; at this
//! size the inverse costs no digits that show in the residual (`tests/cholesky.rs` holds that on a
//! slender beam).

use std::cmp::Ordering;

/// A pivot must exceed this part of its diagonal entry: below it, cancellation has left no digit to
/// trust.
const PIVOT_TOLERANCE: f64 = 64.0 * f64::EPSILON;

/// The inverse of the factor of a symmetric diagonal block; or the column whose pivot fails, and it.
///
/// With `B = U D Uᵀ` and `U` unit lower triangular, elimination by rows turns `[B | 1]` into
/// `[D Uᵀ | U⁻¹]`, and the inverse factor is `D^(-1/2) U⁻¹`. Square roots thus stay out of the
/// chain from pivot to pivot.
#[inline(always)]
pub(super) fn invert_factor<const K: usize, const N: usize>(
    mut block: [[f64; N]; K],
    diagonal: &[f64; K],
) -> Result<[[f64; N]; K], (usize, f64)> {
    let mut pivots = [0.0; K];
    eliminate_column::<K, N, 0>(&mut block, &mut pivots);
    eliminate_column::<K, N, 1>(&mut block, &mut pivots);
    if K > 2 {
        eliminate_column::<K, N, 2>(&mut block, &mut pivots);
        eliminate_column::<K, N, 3>(&mut block, &mut pivots);
    }
    if K > 4 {
        eliminate_column::<K, N, 4>(&mut block, &mut pivots);
        eliminate_column::<K, N, 5>(&mut block, &mut pivots);
    }
    if K > 6 {
        eliminate_column::<K, N, 6>(&mut block, &mut pivots);
        eliminate_column::<K, N, 7>(&mut block, &mut pivots);
    }
    for j in 0..K {
        let is_positive = pivots[j] > PIVOT_TOLERANCE * diagonal[j];
        if !is_positive {
            return Err((j, pivots[j]));
        }
        let scale = 1.0 / pivots[j].sqrt();
        for (l, value) in block[j].iter_mut().enumerate() {
            *value = match l.cmp(&j) {
                Ordering::Less => *value * scale,
                Ordering::Equal => scale,
                Ordering::Greater => 0.0,
            };
        }
    }
    Ok(block)
}

/// One column of the elimination; `J` is a constant so that the rows stay in registers.
///
/// The zeros that elimination makes below the pivot are not kept: their places take the entries
/// that it makes of the unit matrix beside the block.
#[inline(always)]
fn eliminate_column<const K: usize, const N: usize, const J: usize>(
    block: &mut [[f64; N]; K],
    pivots: &mut [f64; K],
) {
    let row = block[J];
    pivots[J] = row[J];
    let reciprocal = 1.0 / row[J];
    for i in J + 1..K {
        let multiplier = row[i] * reciprocal;
        for l in 0..N {
            let (old, factor) = if l == J {
                (0.0, 1.0)
            } else {
                (block[i][l], row[l])
            };
            block[i][l] = old - multiplier * factor;
        }
    }
}
