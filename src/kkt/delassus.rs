//! The Delassus matrix `W = G A⁻¹ Gᵀ` (1/kg), gathered from the compliances of the blocks.

use crate::constraint::contact::{Attachment, Kinematics};
use crate::math::{Mat2, Vec2};
use crate::system::{Block, Response};

/// One row of `G`: a contact and a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RowDirection {
    /// Index of the contact.
    pub contact: usize,
    /// 0 along its normal, 1 along its tangent.
    pub axis: usize,
    /// Unit vector along which the relative motion is measured.
    pub direction: Vec2,
}

/// Writes `W` for `rows`, row-major, shape `(n, n)`, as positions or velocities respond; `kinematics` yields the geometry
/// of a contact.
///
/// Rows of the same contact are neighbours, so the 2×2 compliance between two contacts is computed once.
pub(super) fn assemble<'a>(
    blocks: &[Block],
    rows: &[RowDirection],
    of: Response,
    kinematics: impl Fn(usize) -> &'a Kinematics,
    delassus: &mut Vec<f64>,
) {
    let n = rows.len();
    delassus.clear();
    delassus.resize(n * n, 0.0);
    let mut first = 0;
    while first < n {
        let last = end_of_contact(rows, first);
        let own = kinematics(rows[first].contact);
        let mut other = 0;
        while other <= first {
            let other_last = end_of_contact(rows, other);
            let between = compliance(blocks, own, kinematics(rows[other].contact), of);
            if let Some(between) = between {
                for i in first..last {
                    for j in other..other_last {
                        let value = rows[i].direction.dot(&(between * rows[j].direction));
                        delassus[i * n + j] = value;
                        delassus[j * n + i] = value;
                    }
                }
            }
            other = other_last;
        }
        first = last;
    }
}

fn end_of_contact(rows: &[RowDirection], first: usize) -> usize {
    let contact = rows[first].contact;
    first
        + rows[first..]
            .iter()
            .take_while(|row| row.contact == contact)
            .count()
}

/// `Σ w_a w_b (A⁻¹)_ab` over the grips that two contacts have on common blocks; `None` if there is none.
pub(super) fn compliance(
    blocks: &[Block],
    one: &Kinematics,
    other: &Kinematics,
    of: Response,
) -> Option<Mat2> {
    let mut sum: Option<Mat2> = None;
    // Through nodes without mass, an explicit step moves those nodes at once and masses only in the next step.
    let is_quasi_static = one.is_quasi_static() || other.is_quasi_static();
    let both = one.is_quasi_static() && other.is_quasi_static();
    let moves = |a: &Attachment| both && blocks[a.block].is_massless(a.grip.point);
    for a in one.attachments() {
        for b in other.attachments() {
            if is_quasi_static && !(moves(a) && moves(b)) {
                continue;
            }
            if a.block == b.block {
                let between = blocks[a.block].compliance(a.grip, b.grip, of);
                let term = a.weight * b.weight * between;
                sum = Some(sum.map_or(term, |sum| sum + term));
            }
        }
    }
    sum
}
