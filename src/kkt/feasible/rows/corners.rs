//! How what is round meets a sharp corner.

use crate::math::{Vec2, cross, perp};

/// A vertex of a core, as the path has it.
pub(super) struct CoreVertex {
    /// Where it is (m).
    pub place: Vec2,
    /// From it to the sharp corner that it stands for (m).
    pub corner: Vec2,
    /// Radius by which the core is rounded there, zero of what is round itself (m).
    pub round: f64,
}

/// How what is round meets a sharp corner.
pub(super) struct Around {
    /// Gap beyond the distance at which they close (m).
    pub gap: f64,
    /// Normal from the target to the point.
    pub normal: Vec2,
    /// Where they touch, on the target's surface (m).
    pub position: Vec2,
}

impl Around {
    /// The point's vertex and the target's, of which one is that of something round and the other one stands for a sharp corner; `None` of others.
    ///
    /// What is round touches the corner along the line to its centre, which is not the one to the core's vertex; beside the corner it touches the faces,
    /// whose normals are those on which the corner stands out by the rounding.
    ///
    /// - `depth`: how deep the target's core is under its surface (m).
    /// - `closing`: distance of the cores at which the pair closes (m).
    pub fn between(ends: [CoreVertex; 2], depth: f64, closing: f64) -> Option<Self> {
        let is_first = match [0, 1].map(|end| ends[end].round > 0.0) {
            [true, false] => true,
            [false, true] => false,
            _ => return None,
        };
        let [point, target] = ends;
        let (sharp, centre) = match is_first {
            true => (point, target.place),
            false => (target, point.place),
        };
        let outward = sharp.corner / sharp.corner.norm();
        let away = centre - (sharp.place + sharp.corner);
        let cos = (sharp.round / sharp.corner.norm()).min(1.0);
        let along = outward.dot(&away);
        if along.is_nan() || along <= 0.0 {
            return None;
        }
        let normal = if along >= cos * away.norm() {
            away.normalize()
        } else {
            let side = cross(outward, away).signum();
            cos * outward + side * (1.0 - cos * cos).sqrt() * perp(outward)
        };
        let span = normal.dot(&away);
        let of_round = if is_first { depth } else { span };
        Some(Self {
            gap: span + sharp.round - closing,
            normal: if is_first { -normal } else { normal },
            position: centre - of_round * normal,
        })
    }
}
