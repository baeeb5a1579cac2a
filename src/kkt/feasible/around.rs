//! Whether a step would lead around what a contact has slid off.

use super::{FeasiblePath, Way};
use crate::constraint::contact::ContactKey;
use crate::math::Vec2;
use crate::path::MotionKind;
use crate::system::Block;

impl FeasiblePath {
    /// Whether the straight way of two members from the beginning of the step to the blocks' iterate leads through one another: then the
    /// path has led around, where no motion of one step leads. Not asked while something of them is near.
    pub(in crate::kkt) fn leads_around(&mut self, way: usize, blocks: &[Block]) -> bool {
        if self.near.iter().any(|near| near.pair == way) {
            return false;
        }
        // The way of the pass may be gone in part yet.
        std::mem::swap(&mut self.motion, &mut self.question);
        self.scratch.clear();
        self.scratch.extend_from_slice(self.surfaces.points());
        let members = self.ways[way].members;
        for member in members {
            self.place_at_start(member, blocks);
        }
        self.motion.rest(&self.surfaces);
        for member in members {
            let start = match &blocks[self.carriers[member].block] {
                Block::Rigid(body) => (body.start().centre, body.start().angle),
                Block::Flex(_) => (Vec2::zeros(), 0.0),
            };
            self.aim(member, start, blocks);
        }
        if way >= self.first_own() {
            self.pairs[way].is_asleep = false;
            self.follow_shape(way - self.first_own());
        }
        let pair = &self.pairs[way..=way];
        let impact = self
            .search
            .time_of_impact(&self.surfaces, &self.motion, pair, &mut self.hits);
        for member in members {
            if self.surfaces.members()[member].kind != MotionKind::Still {
                let points = self.surfaces.members()[member].points.clone();
                let base = &self.scratch[points];
                self.surfaces.points_mut(member).copy_from_slice(base);
            }
        }
        std::mem::swap(&mut self.motion, &mut self.question);
        impact.t < 1.0
    }

    /// Adds the ways that stopped the base when it was moved last.
    pub(in crate::kkt) fn list_stopping(&self, ways: &mut Vec<usize>) {
        ways.extend(self.hits.iter().map(|hit| hit.pair));
        ways.sort_unstable();
        ways.dedup();
    }

    /// Adds the ways of contacts that are lost; returns whether there are any.
    pub(in crate::kkt) fn list_left(
        &self,
        lost: impl Iterator<Item = ContactKey>,
        left: &mut Vec<usize>,
    ) -> bool {
        let mut is_any = false;
        for key in lost {
            is_any = true;
            let owners = key.owners();
            let is_named = |way: &Way| {
                let [one, other] = way.owners;
                [one.min(other), one.max(other)] == owners
            };
            let named = (0..self.ways.len()).filter(|&way| is_named(&self.ways[way]));
            left.extend(named);
        }
        left.sort_unstable();
        left.dedup();
        is_any
    }
}
