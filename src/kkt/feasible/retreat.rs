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
        let n_followed = self.n_followed();
        let last = &mut self.last_way;
        std::mem::swap(&mut last.now, &mut last.before);
        last.now.clear();
        let points = &self.surfaces.points()[..n_followed];
        let ways = self.motion.ends().iter().zip(points);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::Weights;
    use crate::math::sin_cos;
    use crate::system::{RigidBlock, RigidLoad, RigidMotion, Step};

    /// Bodies of one point each, far from each other: their centres are the unknowns.
    const N_BODIES: usize = 3;

    fn scene() -> (FeasiblePath, Vec<Block>) {
        let load = RigidLoad {
            inverse_mass: [1.0; 3],
            force: [0.0; 3],
            damping: [0.0; 3],
        };
        let step = Step {
            dt: 1.0,
            weights: Weights { b0: 1.0, b1: 1.0 },
            ..Step::default()
        };
        let rest = RigidMotion::default();
        let body = || Block::Rigid(RigidBlock::free(rest, None, &load, &step));
        let blocks: Vec<Block> = std::iter::repeat_with(body).take(N_BODIES).collect();
        let mut path = FeasiblePath::default();
        let none = Vec2::zeros();
        for block in 0..N_BODIES {
            path.rigid_member(block, &blocks, 0, [0.0; 2], &[(0, none, none)], &[]);
        }
        path.rest(&blocks);
        (path, blocks)
    }

    /// `T(x) = x* + A (x - x*)` with given eigenvalues along axes that are turned against those of the unknowns, and `x*` at (1, ..., 1).
    fn ends_of(base: &[BlockBase], eigenvalues: &[f64; 2 * N_BODIES]) -> [Vec2; N_BODIES] {
        let mut off: Vec<f64> = base
            .iter()
            .flat_map(|base| [base.centre.x, base.centre.y])
            .collect();
        off.iter_mut().for_each(|x| *x -= 1.0);
        let turns = (0..off.len() - 1).map(|k| (k, sin_cos(0.4 + 0.3 * k as f64)));
        for (k, (sin, cos)) in turns.clone() {
            (off[k], off[k + 1]) = (
                cos * off[k] + sin * off[k + 1],
                cos * off[k + 1] - sin * off[k],
            );
        }
        off.iter_mut()
            .zip(eigenvalues)
            .for_each(|(x, eigenvalue)| *x *= eigenvalue);
        for (k, (sin, cos)) in turns.rev() {
            (off[k], off[k + 1]) = (
                cos * off[k] - sin * off[k + 1],
                cos * off[k + 1] + sin * off[k],
            );
        }
        std::array::from_fn(|body| Vec2::new(1.0 + off[2 * body], 1.0 + off[2 * body + 1]))
    }

    fn distance(path: &FeasiblePath) -> f64 {
        let off = |base: &BlockBase| (base.centre - Vec2::new(1.0, 1.0)).norm_squared();
        path.base.iter().map(off).sum::<f64>().sqrt()
    }

    /// Passes until the base is nearer than `goal` to where it leads, and how often one went back.
    fn passes(eigenvalues: [f64; 2 * N_BODIES], goal: f64, most: usize) -> (usize, usize) {
        let (mut path, mut blocks) = scene();
        let mut n_back = 0;
        for pass in 0..most {
            if distance(&path) < goal {
                return (pass, n_back);
            }
            let ends = ends_of(&path.base, &eigenvalues);
            for (block, end) in blocks.iter_mut().zip(ends) {
                if let Block::Rigid(body) = block {
                    body.stop_at(end, 0.0);
                }
            }
            assert!(path.advance(&blocks), "nothing stands in the way");
            n_back += usize::from(path.retreat(&blocks));
            let places = path.surfaces.points().iter().zip(&path.base);
            for (point, base) in places {
                assert_eq!(*point, base.centre, "surface and base part");
            }
        }
        (most, n_back)
    }

    #[test]
    fn passes_that_turn_to_and_fro_and_grow_come_to_rest() {
        // Going all of the way multiplies what is missing by -1.5 in every pass.
        let (n, n_back) = passes([-1.5, -1.2, -0.9, -0.5, 0.1, 0.3], 1e-9, 60);
        assert!(n < 60 && n_back > 0, "{n} passes, {n_back} back");
        // Between two places for ever.
        let (n, _) = passes([-1.0; 6], 1e-9, 60);
        assert!(n <= 3, "{n} passes");
        // More than one look back may tell: from a quarter of the way to a tenth.
        let (n, _) = passes([-9.0; 6], 1e-9, 60);
        assert!(n <= 4, "{n} passes");
    }

    #[test]
    fn passes_that_come_nearer_by_themselves_go_all_of_the_way() {
        let (n, n_back) = passes([0.5; 6], 1e-9, 60);
        assert_eq!(n_back, 0);
        // sqrt(6) 2^-n < 1e-9
        assert_eq!(n, 32);
    }
}
