//! The pool: the rebuildable half of every flexible body (factors, compliances, scratch), kept from step to step.

use crate::body::{FlexBody, FlexBodySet};
use crate::kkt::Island;
#[cfg(feature = "serde-serialize")]
use crate::system::ExplicitRecord;
use crate::system::{Block, FlexBlock, Step};
use std::sync::Arc;

/// Blocks of flexible bodies that are in no island.
#[derive(Debug, Default)]
pub(crate) struct FlexPool {
    /// One per slot of the flexible set.
    blocks: Vec<Option<Box<FlexBlock>>>,
}

impl FlexPool {
    /// The number of numeric factorizations so far.
    pub fn n_factorizations(&self) -> u64 {
        let blocks = self.blocks.iter().flatten();
        blocks.map(|block| block.n_factorizations()).sum()
    }

    /// The block of a body, if it took part in a step.
    pub fn block(&self, index: u32) -> Option<&FlexBlock> {
        self.blocks.get(index as usize)?.as_deref()
    }

    /// Drops what belongs to removed bodies.
    pub fn retain(&mut self, flex_bodies: &FlexBodySet) {
        for (index, slot) in self.blocks.iter_mut().enumerate() {
            let found = flex_bodies.at_index(index as u32);
            let fits = |block: &FlexBlock| {
                found.is_some_and(|(_, body)| Arc::ptr_eq(block.model(), body.model()))
            };
            if !slot.as_deref().is_some_and(fits) {
                *slot = None;
            }
        }
    }

    /// Takes the block of a body out, made anew if there is none, or not for such a step.
    pub fn take(&mut self, index: u32, body: &FlexBody, step: &Step) -> Box<FlexBlock> {
        let kept = self.slot(index).take();
        let is_explicit = step.is_explicit();
        let fits = |block: &FlexBlock| {
            Arc::ptr_eq(block.model(), body.model()) && block.is_explicit() == is_explicit
        };
        if let Some(mut block) = kept.filter(|block| fits(block))
            && block.take_large(body.large())
        {
            return block;
        }
        let (model, fixed) = (Arc::clone(body.model()), body.fixed_dofs().to_vec());
        Box::new(match body.large() {
            Some(large) => FlexBlock::large(model, Arc::clone(large), fixed, body.frame()),
            None if is_explicit => FlexBlock::explicit(model, fixed, body.frame()),
            None => FlexBlock::new(model, fixed, body.frame()),
        })
    }

    /// Puts the blocks of a solved island back.
    pub fn put_back(&mut self, island: &mut Island) {
        for (block, index) in island.blocks.drain(..).zip(&island.flex_index) {
            if let (Block::Flex(block), Some(index)) = (block, index) {
                *self.slot(*index) = Some(block);
            }
        }
        island.flex_index.clear();
    }

    fn slot(&mut self, index: u32) -> &mut Option<Box<FlexBlock>> {
        let slot = index as usize;
        if self.blocks.len() <= slot {
            self.blocks.resize_with(slot + 1, || None);
        }
        &mut self.blocks[slot]
    }
}

/// What a snapshot writes: what explicit bodies have beside their state.
#[cfg(feature = "serde-serialize")]
impl FlexPool {
    /// Records of the explicit bodies, by their slots.
    pub fn explicit_records(&self) -> Vec<(u32, ExplicitRecord)> {
        let blocks = self.blocks.iter().enumerate();
        let records = blocks.filter_map(|(index, block)| {
            let record = block.as_ref()?.explicit_record()?;
            Some((index as u32, record))
        });
        records.collect()
    }

    /// The blocks again, `None` if a record does not fit its body.
    pub fn remembered(
        records: Vec<(u32, ExplicitRecord)>,
        flex_bodies: &FlexBodySet,
    ) -> Option<Self> {
        let mut pool = Self::default();
        for (index, record) in records {
            let (_, body) = flex_bodies.at_index(index)?;
            let (model, fixed) = (Arc::clone(body.model()), body.fixed_dofs().to_vec());
            let mut block = FlexBlock::explicit(model, fixed, body.frame());
            if !block.recall(record) {
                return None;
            }
            *pool.slot(index) = Some(Box::new(block));
        }
        Some(pool)
    }
}
