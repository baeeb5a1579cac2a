//! The unknowns and loads of a sparse problem: how blocks are laid out in it.

use super::{Kept, Sparse};
use crate::constraint::joint::{JointGrip, unit_wrench};
use crate::fe::model::Model;
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cone::ConeEntry;
use crate::math::{Vec2, cross};
use crate::system::{Block, Point};
use std::sync::Arc;

/// What stands behind a block's nodes, to tell when the pattern changes.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    None,
    Rigid,
    /// With the fingerprint of the matrix's pattern, which a gas that is let in changes.
    Flex(Arc<Model>, u64),
}

impl Shape {
    pub(in crate::kkt) fn of(block: &Block) -> Self {
        match block {
            Block::Flex(block) => {
                Self::Flex(Arc::clone(block.model()), block.effective().fingerprint())
            }
            Block::Rigid(block) if block.is_prescribed() => Self::None,
            Block::Rigid(_) => Self::Rigid,
        }
    }

    pub(in crate::kkt) fn is_that_of(&self, block: &Block) -> bool {
        match (self, block) {
            (Self::Flex(model, pattern), Block::Flex(block)) => {
                Arc::ptr_eq(model, block.model()) && *pattern == block.effective().fingerprint()
            }
            (Self::None, Block::Rigid(block)) => block.is_prescribed(),
            (Self::Rigid, Block::Rigid(block)) => !block.is_prescribed(),
            _ => false,
        }
    }
}

impl Kept {
    /// Whether it is what is kept of these blocks.
    fn is_of(&self, blocks: &[Block]) -> bool {
        let mut pairs = self.shapes.iter().zip(blocks);
        self.shapes.len() == blocks.len() && pairs.all(|(shape, block)| shape.is_that_of(block))
    }

    pub(super) fn lay_out(blocks: &[Block]) -> Self {
        let mut first = Vec::with_capacity(blocks.len());
        let mut n_nodes = 0;
        let mut pairs: Vec<[usize; 2]> = Vec::new();
        for block in blocks {
            first.push(n_nodes);
            match block {
                Block::Flex(block) => {
                    let part = block.effective();
                    for node in 0..part.n_nodes() {
                        let later = part
                            .neighbours(node)
                            .iter()
                            .filter(|&&other| other as usize >= node);
                        pairs
                            .extend(later.map(|&other| [n_nodes + node, n_nodes + other as usize]));
                    }
                    n_nodes += part.n_nodes();
                }
                Block::Rigid(block) if !block.is_prescribed() => n_nodes += 2,
                Block::Rigid(_) => {}
            }
        }
        let cells = pairs.iter().map(|pair| &pair[..]);
        Self {
            shapes: blocks.iter().map(Shape::of).collect(),
            matrix: BlockMatrix::from_cells(n_nodes, cells),
            first,
            solvers: Default::default(),
            is_in_use: true,
            #[cfg(feature = "serde-serialize")]
            restored: None,
        }
    }
}

impl Sparse {
    pub(in crate::kkt) fn n_nodes(&self) -> usize {
        let kept = self.kept.get(self.at);
        kept.map_or(0, |kept| kept.matrix.n_nodes())
    }

    pub(in crate::kkt) fn forget_unused(&mut self) {
        self.kept.retain(|kept| kept.is_in_use);
        for kept in &mut self.kept {
            kept.is_in_use = false;
        }
    }

    pub(in crate::kkt) fn scratch_begin(&mut self) {
        self.load.fill(0.0);
    }

    /// Writes the bodies' matrices, in a new pattern if the bodies are others than those of every island that is known.
    pub(in crate::kkt) fn fill_matrix(&mut self, blocks: &[Block]) {
        let known = self.kept.iter().position(|kept| kept.is_of(blocks));
        self.at = known.unwrap_or_else(|| {
            self.kept.push(Kept::lay_out(blocks));
            self.kept.len() - 1
        });
        #[cfg(feature = "serde-serialize")]
        self.kept[self.at].make_again(blocks);
        let Kept {
            matrix,
            first,
            is_in_use,
            ..
        } = &mut self.kept[self.at];
        *is_in_use = true;
        for (block, &first) in blocks.iter().zip(&*first) {
            match block {
                Block::Flex(block) => matrix.assign_part(first, block.effective()),
                Block::Rigid(block) if !block.is_prescribed() => {
                    let own = block.effective_mass();
                    matrix.assign_diagonal(first, [own[0], own[1]]);
                    matrix.assign_diagonal(first + 1, [own[2], 1.0]);
                }
                Block::Rigid(_) => {}
            }
        }
    }

    /// Adds what a point of a block contributes to a row along two directions.
    pub(in crate::kkt) fn grip(
        &mut self,
        blocks: &[Block],
        block: usize,
        (point, lever): (Point, Vec2),
        [normal, tangent]: [Vec2; 2],
    ) {
        let first = self.kept[self.at].first[block] as u32;
        match (&blocks[block], point) {
            (Block::Flex(body), Point::Node(node)) => {
                let [normal, tangent] = [normal, tangent].map(|v| body.local_row(node, v));
                self.entries.push(ConeEntry {
                    node: first + node as u32,
                    normal,
                    tangent,
                });
            }
            (Block::Rigid(body), _) => {
                let wrenches = [normal, tangent].map(|v| [v.x, v.y, cross(lever, v)]);
                self.wrench(body.moves_along(), first, wrenches);
            }
            _ => {}
        }
    }

    pub(in crate::kkt) fn wrench(&mut self, moves: [bool; 3], first: u32, wrenches: [[f64; 3]; 2]) {
        let [normal, tangent] = wrenches.map(|wrench| {
            std::array::from_fn::<f64, 3, _>(|i| if moves[i] { wrench[i] } else { 0.0 })
        });
        if moves == [false; 3] {
            return;
        }
        self.entries.push(ConeEntry {
            node: first,
            normal: [normal[0], normal[1]],
            tangent: [tangent[0], tangent[1]],
        });
        self.entries.push(ConeEntry {
            node: first + 1,
            normal: [normal[2], 0.0],
            tangent: [tangent[2], 0.0],
        });
    }

    pub(in crate::kkt) fn joint_grip(
        &mut self,
        blocks: &[Block],
        grip: &JointGrip,
        direction: Vec2,
        is_turn: bool,
    ) {
        match &blocks[grip.block] {
            Block::Flex(_) => {
                let along = grip.weight * direction;
                self.grip(
                    blocks,
                    grip.block,
                    (grip.point, grip.lever),
                    [along, Vec2::zeros()],
                );
            }
            Block::Rigid(body) => {
                let wrench = unit_wrench(grip, direction, is_turn);
                let first = self.kept[self.at].first[grip.block] as u32;
                self.wrench(body.moves_along(), first, [wrench, [0.0; 3]]);
            }
        }
    }

    /// What a unit multiplier moves the grips of one flexible block by if all else of it was held, `Σ w²/A_ii`: the least of the blocks (1/kg), infinite
    /// without any.
    pub(in crate::kkt) fn local_mobility(&self, blocks: &[Block], grips: &[JointGrip]) -> f64 {
        let Kept { matrix, first, .. } = &self.kept[self.at];
        let moved = |grip: &JointGrip| match (&blocks[grip.block], grip.point) {
            (Block::Flex(_), Point::Node(node)) => {
                let node = first[grip.block] + node;
                let own = matrix.block(node, node)?;
                Some(grip.weight * grip.weight / own[0].max(own[3]))
            }
            _ => None,
        };
        let of_block = |block: usize| {
            let own = grips.iter().filter(|grip| grip.block == block);
            own.filter_map(moved).sum::<f64>()
        };
        let least = grips.iter().map(|grip| of_block(grip.block));
        let known = least.filter(|moved| *moved > 0.0);
        known.fold(f64::INFINITY, f64::min)
    }

    pub(in crate::kkt) fn push_load(
        &mut self,
        blocks: &[Block],
        block: usize,
        (point, lever): (Point, Vec2),
        force: Vec2,
    ) {
        match (&blocks[block], point) {
            (Block::Flex(body), Point::Node(node)) => {
                let at = 2 * (self.kept[self.at].first[block] + node);
                let local = body.local_row(node, force);
                self.load[at] += local[0];
                self.load[at + 1] += local[1];
            }
            (Block::Rigid(_), _) => {
                self.push_wrench(blocks, block, [force.x, force.y, cross(lever, force)]);
            }
            _ => {}
        }
    }

    pub(in crate::kkt) fn push_wrench(&mut self, blocks: &[Block], block: usize, wrench: [f64; 3]) {
        let Block::Rigid(body) = &blocks[block] else {
            return;
        };
        let at = 2 * self.kept[self.at].first[block];
        for (i, moves) in body.moves_along().into_iter().enumerate() {
            if moves {
                self.load[at + i] += wrench[i];
            }
        }
    }
}
