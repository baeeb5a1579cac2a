//! Whole numbers over time, in few bits: what is expected of a value is subtracted, and the residual goes through an adaptive binary range coder (G. N. N. Martin
//! 1979, in the form that LZMA has: probabilities of eleven bits that move by a 32nd, a range of 32 bits).
//!
//! A track has channels, each with the same number of values in every frame. Frame by frame and channel by channel a block is written: three bits of even odds
//! that say what is expected, and the residuals.
//!
//! | bit | set: | clear: |
//! |---|---|---|
//! | 2 | `2 v' - v''` is expected of a value, with `v'` and `v''` those of the two frames before | `v'` |
//! | 1 | `2 d' - d''` is added, with `d'` and `d''` what the two values before in the frame differed by, zero before the first: bodies turn | see below |
//! | 0, if bit 1 is clear | `d'` is added: bodies move | nothing is added |
//!
//! Before the first frame all values are zero, and before the second they are what they are in the first. A residual `r` of `n` bits (`n = 0` for zero) is
//! written as `n` ones and a zero (no zero behind 32), its sign, and the bits of `|r|` below the highest. The i-th of the ones and zeros has a probability of its own for
//! each channel and for each sum, at most 15, of the `n` of the value before in the frame and of the same value in the frame before; the bit below the
//! highest has one for each channel and n; all others are of even odds. Probabilities begin even.

/// Bits of a probability, and by which part it moves.
const PROBABILITY_BITS: u32 = 11;
const RATE: u32 = 5;
const EVEN: u16 = 1 << (PROBABILITY_BITS - 1);

/// Sums of neighbours' lengths that are told apart, and bits of a residual.
const N_SUMS: usize = 16;
const MOST_BITS: usize = 32;

/// The range coder: `low` and `range` of the code, and bytes that a carry may still change.
struct Coder {
    bytes: Vec<u8>,
    low: u64,
    range: u32,
    cache: u8,
    n_pending: usize,
}

impl Coder {
    fn new() -> Self {
        Self {
            bytes: Vec::new(),
            low: 0,
            range: u32::MAX,
            cache: 0,
            n_pending: 1,
        }
    }

    fn push(&mut self, bit: bool, probability: &mut u16) {
        let bound = (self.range >> PROBABILITY_BITS) * u32::from(*probability);
        if bit {
            self.low += u64::from(bound);
            self.range -= bound;
            *probability -= *probability >> RATE;
        } else {
            self.range = bound;
            *probability += ((1 << PROBABILITY_BITS) - *probability) >> RATE;
        }
        self.normalize();
    }

    fn push_even(&mut self, bit: bool) {
        self.range >>= 1;
        if bit {
            self.low += u64::from(self.range);
        }
        self.normalize();
    }

    fn normalize(&mut self) {
        while self.range < 1 << 24 {
            self.range <<= 8;
            self.shift();
        }
    }

    fn shift(&mut self) {
        let carry = (self.low >> 32) as u8;
        if self.low < 0xff00_0000 || carry != 0 {
            let mut byte = self.cache;
            for _ in 0..self.n_pending {
                self.bytes.push(byte.wrapping_add(carry));
                byte = 0xff;
            }
            self.n_pending = 0;
            self.cache = (self.low >> 24) as u8;
        }
        self.n_pending += 1;
        self.low = (self.low & 0x00ff_ffff) << 8;
    }

    fn finish(mut self) -> Vec<u8> {
        for _ in 0..5 {
            self.shift();
        }
        self.bytes
    }
}

/// Probabilities of one channel, and how long its residuals were in the frame before.
struct Model {
    lengths: Vec<[u16; MOST_BITS]>,
    second_bits: [u16; MOST_BITS + 1],
    before: Vec<usize>,
}

impl Model {
    fn new(n_values: usize) -> Self {
        Self {
            lengths: vec![[EVEN; MOST_BITS]; N_SUMS],
            second_bits: [EVEN; MOST_BITS + 1],
            before: vec![0; n_values],
        }
    }

    fn push(&mut self, coder: &mut Coder, residuals: &[i32]) {
        let mut left = 0;
        for (residual, before) in residuals.iter().zip(&mut self.before) {
            let size = residual.unsigned_abs();
            let length = (u32::BITS - size.leading_zeros()) as usize;
            let lengths = &mut self.lengths[(left + *before).min(N_SUMS - 1)];
            for probability in &mut lengths[..length] {
                coder.push(true, probability);
            }
            if let Some(probability) = lengths.get_mut(length) {
                coder.push(false, probability);
            }
            if length > 0 {
                coder.push_even(*residual < 0);
            }
            for bit in (0..length.saturating_sub(1)).rev() {
                let is_set = (size >> bit) & 1 == 1;
                if bit + 2 == length {
                    coder.push(is_set, &mut self.second_bits[length]);
                } else {
                    coder.push_even(is_set);
                }
            }
            (left, *before) = (length, length);
        }
    }
}

/// Residuals of one way to foresee.
fn residuals(mode: u32, [now, before, earlier]: [&[i32]; 3], found: &mut Vec<i32>) {
    found.clear();
    let [mut last, mut last_but_one] = [0i32; 2];
    for index in 0..now.len() {
        let expected = if mode & 4 == 0 {
            before[index]
        } else {
            before[index].wrapping_mul(2).wrapping_sub(earlier[index])
        };
        let change = now[index].wrapping_sub(expected);
        let shared = match mode & 3 {
            0 => 0,
            1 => last,
            _ => last.wrapping_mul(2).wrapping_sub(last_but_one),
        };
        found.push(change.wrapping_sub(shared));
        (last_but_one, last) = (last, change);
    }
}

/// Bits of all residuals, about.
fn cost(residuals: &[i32]) -> u32 {
    let length = |residual: &i32| 2 * (u32::BITS - residual.unsigned_abs().leading_zeros());
    residuals.iter().map(length).sum()
}

/// Writes channels of `n_values` in each frame; each channel has all its frames one after the other.
pub(super) fn encode(channels: &[Vec<i32>], n_values: usize) -> Vec<u8> {
    let n_frames = channels.first().map_or(0, |channel| {
        channel.len().checked_div(n_values).unwrap_or(0)
    });
    let mut coder = Coder::new();
    let mut models: Vec<Model> = channels.iter().map(|_| Model::new(n_values)).collect();
    let zeros = vec![0; n_values];
    let (mut tried, mut best) = (Vec::new(), Vec::new());
    for frame in 0..n_frames {
        for (channel, model) in channels.iter().zip(&mut models) {
            let at = |back: usize| match frame.checked_sub(back) {
                Some(frame) => &channel[frame * n_values..(frame + 1) * n_values],
                None if frame == 0 => &zeros[..],
                None => &channel[..n_values],
            };
            let values = [at(0), at(1), at(2)];
            let (mut chosen, mut least) = (0, u32::MAX);
            for mode in [0, 1, 2, 4, 5, 6] {
                residuals(mode, values, &mut tried);
                let cost = cost(&tried);
                if cost < least {
                    (chosen, least) = (mode, cost);
                    std::mem::swap(&mut tried, &mut best);
                }
            }
            for bit in [4, 2, 1] {
                coder.push_even(chosen & bit != 0);
            }
            model.push(&mut coder, &best);
        }
    }
    coder.finish()
}

#[cfg(test)]
mod tests {
    use super::encode;

    /// What stands still, or moves evenly and as a whole, is foreseen: some hundredths of a bit for a value.
    #[test]
    fn what_is_foreseen_takes_next_to_nothing() {
        let still = encode(&[vec![7; 100_000]], 100);
        assert!(still.len() < 1000, "{}", still.len());
        let moving: Vec<i32> = (0..100_000).map(|at| 31 * (at / 100) + at % 100).collect();
        let moving = encode(&[moving], 100);
        assert!(moving.len() < 1000, "{}", moving.len());
    }

    /// Numbers of eight bits without any order take eight bits, and two more for not knowing.
    #[test]
    fn noise_takes_what_it_has() {
        let mut state = 1u64;
        let noise = (0..20_000).map(|_| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 56) as i32
        });
        let n_bytes = encode(&[noise.collect()], 100).len();
        assert!((20_000..25_500).contains(&n_bytes), "{n_bytes}");
    }
}
