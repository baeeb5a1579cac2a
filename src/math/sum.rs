//! Sums that do not wait for themselves: a chain of additions costs the latency of each, four side by side a quarter of it.
//!
//! Their order is always the same.

/// The sum of a term over all entries of arrays of one length.
///
/// # Panics
/// If an array is shorter than the first.
#[inline]
pub fn sum_over<const N: usize>(arrays: [&[f64]; N], term: impl Fn([f64; N]) -> f64) -> f64 {
    let ones = |_: usize| 1.0;
    sum_weighted(arrays, ones, |_, values| term(values))
}

/// The sum of a term over all dofs of interleaved arrays of one length, each with the weight of its node.
///
/// # Panics
/// If an array is shorter than the first, or there are fewer weights than nodes.
#[inline]
pub fn sum_over_dofs<const N: usize>(
    weights: &[f64],
    arrays: [&[f64]; N],
    term: impl Fn(f64, [f64; N]) -> f64,
) -> f64 {
    let weights = &weights[..arrays[0].len() / 2];
    sum_weighted(arrays, |dof| weights[dof / 2], term)
}

#[inline]
fn sum_weighted<const N: usize>(
    arrays: [&[f64]; N],
    weight: impl Fn(usize) -> f64,
    term: impl Fn(f64, [f64; N]) -> f64,
) -> f64 {
    let n = arrays[0].len();
    let arrays = arrays.map(|array| &array[..n]);
    let fours = arrays.map(|array| array.as_chunks::<4>().0);
    let mut sums = [0.0; 4];
    for slot in 0..n / 4 {
        let four = fours.map(|four| four[slot]);
        for (lane, sum) in sums.iter_mut().enumerate() {
            *sum += term(weight(4 * slot + lane), four.map(|values| values[lane]));
        }
    }
    for (sum, k) in sums.iter_mut().zip(n - n % 4..n) {
        *sum += term(weight(k), arrays.map(|array| array[k]));
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

#[cfg(test)]
mod tests {
    use super::{sum_over, sum_over_dofs};

    #[test]
    fn every_term_counts_once_whatever_the_number() {
        let powers: Vec<f64> = (0..13).map(|k| f64::from(1u32 << k)).collect();
        for n in 0..13 {
            assert_eq!(
                sum_over([&powers[..n]], |[power]| power),
                f64::from((1u32 << n) - 1)
            );
        }
    }

    #[test]
    fn both_dofs_of_a_node_have_its_weight() {
        let (weights, ones) = ([1.0, 10.0, 100.0], [1.0; 6]);
        assert_eq!(
            sum_over_dofs(&weights, [&ones], |weight, [one]| weight * one),
            222.0
        );
    }
}
