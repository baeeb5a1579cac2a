//! Going part of the way: where passes would take turns between two places, the place between them.
//!
//! A pass leads from the base `b` to the end `T(b)` of the forces found there. Where the rows turn with the base, `T(b) - b` may change its
//! sign from pass to pass and not get smaller. What two passes tell of it gives the share of the way after which it would vanish
//! (Aitken's relaxation, as in the coupling of fluids and structures: Küttler and Wall 2008), block by block, since what takes turns here knows
//! nothing of what does there:
//!
//! ```text
//! ω = -ω₀ r₀·(r - r₀) / |r - r₀|²,     r = T(b) - b
//! ```

use super::{BlockBase, Carrier, FeasiblePath};
use crate::math::Vec2;
use crate::path::{MotionKind, Surfaces};
use crate::system::Block;

/// Share of the way from which going all of it costs no more passes.
const WHOLE: f64 = 0.8;

/// Ways shorter than this share of the longest one are rounding beside it.
const SHORT: f64 = 1e-3;

/// What two passes tell of one block.
#[derive(Clone, Copy, Debug)]
struct Share {
    /// Share of the way gone in the last pass.
    gone: f64,
    /// Share after which the way would vanish.
    wanted: f64,
}

/// The way of the last pass, and the base before it.
#[derive(Debug, Default)]
pub(super) struct LastWay {
    /// From the points to the end of the forces, in this pass and in the one before (m).
    now: Vec<Vec2>,
    before: Vec<Vec2>,
    /// Of every block.
    shares: Vec<Share>,
    /// `-r₀·(r - r₀)`, `|r - r₀|²` and `|r|²` of every block (m²).
    sums: Vec<[f64; 3]>,
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
        self.shares.clear();
        let whole = Share {
            gone: 1.0,
            wanted: 1.0,
        };
        self.shares.resize(n_blocks, whole);
        self.sums.reserve(n_blocks);
        self.points.clear();
        self.base.clear();
        self.nodes.clear();
        self.points.reserve(n_points);
        self.base.reserve(n_blocks);
        self.nodes.reserve(n_coordinates);
    }

    /// Whether less of the way is to be gone than was.
    fn goes_back(&self) -> bool {
        self.shares.iter().any(|share| share.wanted < share.gone)
    }

    /// Sums up what the passes tell, block by block.
    fn compare(&mut self, surfaces: &Surfaces, carriers: &[Carrier]) {
        self.sums.clear();
        self.sums.resize(self.shares.len(), [0.0; 3]);
        for (member, carrier) in surfaces.members().iter().zip(carriers) {
            let sums = &mut self.sums[carrier.block];
            for point in member.points.clone() {
                let (now, before) = (self.now[point], self.before[point]);
                let change = now - before;
                sums[0] -= before.dot(&change);
                sums[1] += change.norm_squared();
                sums[2] += now.norm_squared();
            }
        }
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
        if last.before.len() == last.now.len() {
            last.compare(&self.surfaces, &self.carriers);
            let longest = last
                .sums
                .iter()
                .fold(0.0, |most, sums| f64::max(most, sums[2]));
            for (share, &[along, square, own]) in last.shares.iter_mut().zip(&last.sums) {
                // What was gone last limits what one look back may tell.
                let most = (2.0 * share.wanted).min(1.0);
                let told = share.gone * along / square;
                share.wanted = if told.is_finite() && told > 0.0 && own > SHORT * SHORT * longest {
                    told.clamp(0.25 * share.wanted, most)
                } else {
                    most
                };
                if share.wanted > WHOLE {
                    share.wanted = 1.0;
                }
            }
        }
        last.shares.iter_mut().for_each(|share| share.gone = part);
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
        if !self.last_way.goes_back() {
            return false;
        }
        self.base.clone_from(&self.last_way.base);
        self.nodes.clone_from(&self.last_way.nodes);
        self.surfaces.set_points(&self.last_way.points);
        self.motion.rest(&self.surfaces);
        for member in 0..self.carriers.len() {
            self.aim_at_share(member, blocks);
        }
        let impact =
            self.search
                .time_of_impact(&self.surfaces, &self.motion, &self.pairs, &mut self.hits);
        let part = impact.t.min(1.0);
        let shares = self.last_way.shares.iter_mut();
        shares.for_each(|share| share.gone = part * share.wanted.min(share.gone));
        self.surfaces.advance(&self.motion, part);
        for block in 0..blocks.len() {
            self.go_with(block, self.last_way.shares[block].gone, blocks);
        }
        self.keep_on_bodies();
        true
    }

    /// Moves a member as much of the way as its block is to go.
    fn aim_at_share(&mut self, member: usize, blocks: &[Block]) {
        let block = self.carriers[member].block;
        let Share { gone, wanted } = self.last_way.shares[block];
        let (share, base) = (wanted.min(gone), self.base[block]);
        match self.surfaces.members()[member].kind {
            MotionKind::Rigid => {
                let (shift, turn) = (
                    blocks[block].centre() - base.centre,
                    super::angle_of(&blocks[block]) - base.angle,
                );
                self.motion.move_rigid(
                    &self.surfaces,
                    member,
                    base.centre,
                    share * shift,
                    share * turn,
                );
            }
            MotionKind::Flexible => {
                self.aim(member, (base.centre, base.angle), blocks);
                let first = self.surfaces.members()[member].points.start;
                let ends = self.motion.ends_mut(&self.surfaces, member);
                for (end, from) in ends.iter_mut().zip(&self.surfaces.points()[first..]) {
                    *end = from + share * (*end - from);
                }
            }
            MotionKind::Still => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrator::Weights;
    use crate::math::sin_cos;
    use crate::system::{RigidBlock, RigidLoad, RigidMotion};

    /// Bodies of one point each, far from each other: their centres are the unknowns.
    const N_BODIES: usize = 3;

    fn scene() -> (FeasiblePath, Vec<Block>) {
        let load = RigidLoad {
            inverse_mass: [1.0; 3],
            force: [0.0; 3],
            damping: [0.0; 3],
        };
        let weights = Weights { b0: 1.0, b1: 1.0 };
        let rest = RigidMotion::default();
        let body = || Block::Rigid(RigidBlock::free(rest, None, &load, weights, 1.0));
        let blocks: Vec<Block> = std::iter::repeat_with(body).take(N_BODIES).collect();
        let mut path = FeasiblePath::default();
        let none = Vec2::zeros();
        for block in 0..N_BODIES {
            path.rigid_member(block, &blocks, 0, 0.0, &[(0, none, none)], &[]);
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

    #[test]
    fn blocks_that_take_turns_by_themselves_do_not_hold_each_other_up() {
        // `A` is diagonal: each body multiplies what is missing by a factor of its own.
        let factors = [-1.2, -6.0, 0.1];
        let (mut path, mut blocks) = scene();
        let mut n = 0;
        while distance(&path) > 1e-9 {
            let bodies = blocks.iter_mut().zip(&path.base).zip(factors);
            for ((block, base), factor) in bodies {
                let goal = Vec2::new(1.0, 1.0);
                if let Block::Rigid(body) = block {
                    body.stop_at(goal + factor * (base.centre - goal), 0.0);
                }
            }
            assert!(path.advance(&blocks), "nothing stands in the way");
            path.retreat(&blocks);
            n += 1;
            // The third alone takes nine passes, 2^½ 10^-n < 1e-9; one share for all of them some hundred.
            assert!(n <= 12, "{} m off after {n} passes", distance(&path));
        }
    }
}
