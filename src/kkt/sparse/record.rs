//! What a snapshot writes of sparse problems: what their solvers go on from.

use super::layout::Shape;
use super::{Kept, Sparse};
use crate::fe::model::Model;
use crate::linalg::block_matrix::BlockMatrix;
use crate::linalg::cone::{ConeRecord, ConeSolver};
use crate::system::Block;
use serde::{Deserialize, Serialize};
use std::iter;
use std::sync::Arc;

/// What stands behind a block's nodes.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
enum ShapeRecord {
    None,
    Rigid,
    /// The model of the flexible body at this index of its set, and the fingerprint of its pattern.
    Flex(u32, u64),
}

/// What is kept of an island.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct KeptRecord {
    shapes: Vec<ShapeRecord>,
    solvers: [ConeRecord; 4],
}

/// What the solvers of an island go on from when it is asked for.
#[derive(Debug)]
pub(super) struct Restored {
    solvers: [ConeRecord; 4],
}

impl Sparse {
    /// What the next step may go on from.
    ///
    /// - `index_of`: the index of the flexible body of a model; what is kept of bodies that are gone serves no more.
    pub(in crate::kkt) fn record(
        &self,
        index_of: impl Fn(&Arc<Model>) -> Option<u32>,
    ) -> Vec<KeptRecord> {
        let in_use = self.kept.iter().filter(|kept| kept.is_in_use);
        let records = in_use.map(|kept| {
            let shapes = kept.shapes.iter().map(|shape| match shape {
                Shape::None => Some(ShapeRecord::None),
                Shape::Rigid => Some(ShapeRecord::Rigid),
                Shape::Flex(model, pattern) => {
                    index_of(model).map(|index| ShapeRecord::Flex(index, *pattern))
                }
            });
            let solvers = match &kept.restored {
                Some(restored) => restored.solvers.clone(),
                None => kept.solvers.each_ref().map(ConeSolver::record),
            };
            let shapes = shapes.collect::<Option<_>>()?;
            Some(KeptRecord { shapes, solvers })
        });
        records.flatten().collect()
    }

    /// Keeps what was recorded, `None` if a body of it does not exist.
    ///
    /// - `model_of`: the model of the flexible body at an index.
    pub(in crate::kkt) fn restore(
        &mut self,
        records: Vec<KeptRecord>,
        model_of: impl Fn(u32) -> Option<Arc<Model>>,
    ) -> Option<()> {
        for KeptRecord { shapes, solvers } in records {
            let shapes = shapes.into_iter().map(|shape| match shape {
                ShapeRecord::None => Some(Shape::None),
                ShapeRecord::Rigid => Some(Shape::Rigid),
                ShapeRecord::Flex(index, pattern) => {
                    model_of(index).map(|model| Shape::Flex(model, pattern))
                }
            });
            self.kept.push(Kept {
                shapes: shapes.collect::<Option<_>>()?,
                matrix: BlockMatrix::from_cells(0, iter::empty()),
                first: Vec::new(),
                solvers: Default::default(),
                is_in_use: true,
                restored: Some(Restored { solvers }),
            });
        }
        Some(())
    }
}

impl Kept {
    /// Makes again what was restored, now that the blocks are there.
    pub(super) fn make_again(&mut self, blocks: &[Block]) {
        let Some(Restored { solvers }) = self.restored.take() else {
            return;
        };
        *self = Self::lay_out(blocks);
        for (solver, record) in self.solvers.iter_mut().zip(&solvers) {
            // What fits no matrix of these bodies was not written by a snapshot.
            *solver = ConeSolver::remembered(record, &self.matrix).unwrap_or_default();
        }
    }
}
