//! Going part of the way: where passes would take turns between two places, the place between them.
//!
//! A pass leads from the base `b` to the end `T(b)` of the forces found there. Where the rows turn with the base, `T(b) - b` may change its
//! sign from pass to pass and not get smaller. What two passes tell of it gives the share of the way after which it would vanish
//! (Aitken's relaxation, as in the coupling of fluids and structures: Küttler and Wall 2008):
//!
//! ```text
//! ω = -ω₀ r₀·(r - r₀) / |r - r₀|²,     r = T(b) - b
//! ```

use super::{BlockBase, FeasiblePath};
use crate::math::Vec2;
use crate::system::Block;

/// Share of the way from which going all of it costs no more passes.
const WHOLE: f64 = 0.8;

/// The way of the last pass, and the base before it.
#[derive(Debug, Default)]
pub(super) struct LastWay {
    /// From the points to the end of the forces, in this pass and in the one before (m).
    now: Vec<Vec2>,
    before: Vec<Vec2>,
    /// Share of the way gone.
    part: f64,
    /// Share after which the way would vanish.
    wanted: f64,
    /// The base before the last pass, if it is to be gone back to.
    points: Vec<Vec2>,
    base: Vec<BlockBase>,
    nodes: Vec<f64>,
}

impl LastWay {
    /// Forgets what the passes of another step told, with room for a base of so many points, blocks and coordinates of nodes.
    pub fn forget(&mut self, [n_points, n_blocks, n_coordinates]: [usize; 3]) {
        self.now.clear();
        self.before.clear();
        (self.part, self.wanted) = (1.0, 1.0);
        self.points.clear();
        self.base.clear();
        self.nodes.clear();
        self.points.reserve(n_points);
        self.base.reserve(n_blocks);
        self.nodes.reserve(n_coordinates);
    }

    /// Whether less of the way is to be gone than was.
    fn goes_back(&self) -> bool {
        self.wanted < self.part
    }
}

impl FeasiblePath {
    /// Notes the way of a pass before a part of it is gone.
    pub(super) fn look_back(&mut self, part: f64) {
        let last = &mut self.last_way;
        std::mem::swap(&mut last.now, &mut last.before);
        last.now.clear();
        let ways = self.motion.ends().iter().zip(self.surfaces.points());
        last.now.extend(ways.map(|(end, point)| end - point));
        let (mut along, mut square) = (0.0, 0.0);
        if last.before.len() == last.now.len() {
            for (now, before) in last.now.iter().zip(&last.before) {
                let change = now - before;
                along -= before.dot(&change);
                square += change.norm_squared();
            }
        }
        let share = last.part * along / square;
        // What was gone last limits what one look back may tell.
        let most = (2.0 * last.wanted).min(1.0);
        last.wanted = if share.is_finite() && share > 0.0 {
            share.clamp(0.25 * last.wanted, most)
        } else {
            most
        };
        if last.wanted > WHOLE {
            last.wanted = 1.0;
        }
        last.part = part;
        // The base is needed only where a part of the way is gone anew: never in the first pass.
        if last.goes_back() {
            last.points.clear();
            last.points.extend_from_slice(self.surfaces.points());
            last.base.clone_from(&self.base);
            last.nodes.clone_from(&self.nodes);
        }
    }

    /// Goes back to where the way of the last pass is expected to vanish, if that is before the base; returns whether it was.
    pub(in crate::kkt) fn retreat(&mut self, blocks: &[Block]) -> bool {
        let last = &mut self.last_way;
        if !last.goes_back() {
            return false;
        }
        let share = last.wanted;
        last.part = share;
        self.base.clone_from(&last.base);
        self.nodes.clone_from(&last.nodes);
        self.surfaces.set_points(&last.points);
        self.go(share, blocks);
        true
    }
}
