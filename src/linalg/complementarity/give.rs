//! Rows that give way in proportion to their multipliers: by how much, and by steps that give way to less and less.
//!
//! `W + diag(g_i W_ii)` is positive definite: such rows have multipliers where others have none, and no more than `b_i / (g_i W_ii)` of them. A few
//! proximal steps, each of which gives way to the change of the multipliers only, make it the answer itself where there is one. (Rockafellar 1976;
//! Carpentier, Le Lidec and Montaut 2024 for contact.)

use crate::math::rounding;

/// What must be left of a bilateral row's mobility once the others hold, where all bodies are alike (-), or they depend on each other: what single
/// precision knows of the places they are made of moves them by its square.
pub(crate) const INDEPENDENT: f64 = rounding::SINGLE;

/// How often rows are solved that give way, see [`give`].
pub(super) const ROUNDS: usize = 3;

/// Share of its mobility by which a row gives way to the change of its force where rows depend on each other (-), half way in
/// digits between the share with which it depends on them and the whole: what moves is found to within the cube of that, and what is contradicted ends in
/// few forces.
///
/// - `least`: what must be left of the row's mobility.
pub(crate) fn give(least: f64) -> f64 {
    least.max(rounding::SOLVED).sqrt()
}

/// Writes the free velocities of rows that give way to what their multipliers change from the given ones: `b - (W' - W)_ii p_i`.
///
/// - `delassus`: `W` and `W'`.
pub(super) fn approach(
    delassus: [&[f64]; 2],
    free: &[f64],
    multipliers: &[f64],
    approached: &mut Vec<f64>,
) {
    let n = free.len();
    let [rigid, giving] = delassus;
    let gives = |row: usize| giving[row * (n + 1)] - rigid[row * (n + 1)];
    let rows = free.iter().zip(multipliers).enumerate();
    approached.clear();
    approached.extend(rows.map(|(row, (b, p))| b - gives(row) * p));
}
