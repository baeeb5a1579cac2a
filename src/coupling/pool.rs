//! The pool: the rebuildable half of every flexible body (factors, compliances, scratch), kept from step to step.

use crate::body::{FlexBody, FlexBodySet};
use crate::fe::model::Model;
use crate::kkt::Island;
#[cfg(feature = "serde-serialize")]
use crate::system::ExplicitRecord;
use crate::system::{Block, FlexBlock, Step};
use std::sync::Arc;

/// Blocks of flexible bodies that are in no island.
#[derive(Debug, Default)]
pub(crate) struct FlexPool {
    /// Those of each slot of the flexible set.
    blocks: Vec<Kept>,
}

/// The blocks of a body, one for each of its models.
#[derive(Debug, Default)]
struct Kept {
    /// That of its last step.
    last: Option<Box<FlexBlock>>,
    other: Option<Box<FlexBlock>>,
}

impl Kept {
    fn iter(&self) -> impl Iterator<Item = &FlexBlock> {
        self.last.iter().chain(&self.other).map(Box::as_ref)
    }

    /// Drops what does not fit.
    fn retain(&mut self, fits: impl Fn(&FlexBlock) -> bool) {
        for block in [&mut self.last, &mut self.other] {
            if !block.as_deref().is_some_and(&fits) {
                *block = None;
            }
        }
    }

    /// Takes the one of a model out.
    fn take(&mut self, model: &Arc<Model>) -> Option<Box<FlexBlock>> {
        let mut both = [&mut self.last, &mut self.other].into_iter();
        let is_of = |block: &FlexBlock| Arc::ptr_eq(block.model(), model);
        both.find_map(|block| match block.as_deref().is_some_and(is_of) {
            true => block.take(),
            false => None,
        })
    }

    /// Puts the one of the last step back.
    fn put(&mut self, block: Box<FlexBlock>) {
        if let Some(before) = self.last.replace(block) {
            self.other = Some(before);
        }
    }
}

impl FlexPool {
    /// The number of numeric factorizations so far.
    pub fn n_factorizations(&self) -> u64 {
        let blocks = self.blocks.iter().flat_map(Kept::iter);
        blocks.map(|block| block.n_factorizations()).sum()
    }

    /// The block of a body, if it took part in a step.
    pub fn block(&self, index: u32) -> Option<&FlexBlock> {
        self.blocks.get(index as usize)?.last.as_deref()
    }

    /// Drops what belongs to removed bodies.
    pub fn retain(&mut self, flex_bodies: &FlexBodySet) {
        for (index, slot) in self.blocks.iter_mut().enumerate() {
            let found = flex_bodies.at_index(index as u32);
            slot.retain(|block| found.is_some_and(|(_, body)| body.has_model(block.model())));
        }
    }

    /// Takes the block of a body out, made anew if there is none, or not for such a step.
    pub fn take(&mut self, index: u32, body: &FlexBody, step: &Step) -> Box<FlexBlock> {
        let is_explicit = step.is_explicit();
        let kept = self.slot(index);
        // What steps of the other kind have left is of the past.
        kept.retain(|block| block.is_explicit() == is_explicit);
        if let Some(mut block) = kept.take(body.model())
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
                self.slot(*index).put(block);
            }
        }
        island.flex_index.clear();
    }

    fn slot(&mut self, index: u32) -> &mut Kept {
        let slot = index as usize;
        if self.blocks.len() <= slot {
            self.blocks.resize_with(slot + 1, Kept::default);
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
            let record = block.last.as_ref()?.explicit_record()?;
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
            pool.slot(index).put(Box::new(block));
        }
        Some(pool)
    }
}
