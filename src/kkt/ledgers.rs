//! Whose energy is told together: blocks that press each other, directly or by others. What flies beside them lends them none, and owes them none.

use super::active_contact::ActiveContact;
use crate::system::Block;

/// For each block of an island the first one of its ledger, and reserves as they were.
#[derive(Debug, Default)]
pub struct Ledgers {
    leaders: Vec<usize>,
    /// Blocks by their ledgers, and contacts.
    blocks: Vec<usize>,
    contacts: Vec<usize>,
    /// Reserves of the blocks before the energy stage (J).
    pub(super) had: Vec<f64>,
}

/// The blocks whose energy is told together, and the contacts between these and with driven ones.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ledger<'a> {
    leaders: &'a [usize],
    leader: usize,
    pub blocks: &'a [usize],
    pub contacts: &'a [usize],
}

impl Ledgers {
    /// Puts all blocks into one ledger.
    pub(super) fn pool(&mut self, blocks: &[Block], contacts: &[ActiveContact]) {
        self.leaders.clear();
        self.leaders.resize(blocks.len(), 0);
        self.list(blocks, contacts);
    }

    /// Puts blocks into one ledger that press each other, and the pairs that did so in the step before, `pressed`: what is stored of their forces still
    /// acts. Driven ones hold none together.
    pub(super) fn part(
        &mut self,
        blocks: &[Block],
        contacts: &[ActiveContact],
        pressed: &[[usize; 2]],
    ) {
        self.leaders.clear();
        self.leaders.extend(0..blocks.len());
        for contact in contacts.iter().filter(|contact| presses(contact)) {
            self.join(moved_by(blocks, contact));
        }
        for pair in pressed {
            let moves = |block: &usize| !blocks[*block].is_prescribed();
            self.join(pair.iter().copied().filter(moves));
        }
        for block in 0..blocks.len() {
            self.leaders[block] = leader_of(&self.leaders, block);
        }
        self.list(blocks, contacts);
    }

    fn join(&mut self, blocks: impl Iterator<Item = usize>) {
        let mut first = None;
        for block in blocks {
            let own = leader_of(&self.leaders, block);
            let other = first.map_or(own, |first| leader_of(&self.leaders, first));
            self.leaders[own.max(other)] = own.min(other);
            first = Some(block);
        }
    }

    fn list(&mut self, blocks: &[Block], contacts: &[ActiveContact]) {
        let leaders = &self.leaders;
        self.blocks.clear();
        self.blocks.extend(0..blocks.len());
        (self.blocks).sort_unstable_by_key(|&block| (leaders[block], block));
        let of_contact = |contact: usize| moved_by(blocks, &contacts[contact]).next();
        let moves = (0..contacts.len()).filter(|&contact| of_contact(contact).is_some());
        self.contacts.clear();
        self.contacts.extend(moves);
        let leader = |contact: usize| of_contact(contact).map(|block| leaders[block]);
        (self.contacts).sort_unstable_by_key(|&contact| (leader(contact), contact));
    }

    /// The ledger that a block leads; none of a rigid body that touches nothing, and of what is driven.
    pub(super) fn led_by(
        &self,
        leader: usize,
        (blocks, contacts): (&[Block], &[ActiveContact]),
    ) -> Option<Ledger<'_>> {
        if self.leaders[leader] != leader {
            return None;
        }
        let of_contact = |contact: &usize| {
            let moved = moved_by(blocks, &contacts[*contact]).next();
            moved.map_or(0, |block| self.leaders[block])
        };
        let ledger = Ledger {
            leaders: &self.leaders,
            leader,
            blocks: run_of(&self.blocks, leader, |block| self.leaders[*block]),
            contacts: run_of(&self.contacts, leader, of_contact),
        };
        let mut own = ledger.blocks.iter();
        let has_flexible = own.any(|&block| matches!(blocks[block], Block::Flex(_)));
        (has_flexible || !ledger.contacts.is_empty()).then_some(ledger)
    }
}

/// The part of a list, sorted by leaders, that belongs to one.
fn run_of(list: &[usize], leader: usize, leader_of: impl Fn(&usize) -> usize) -> &[usize] {
    let begin = list.partition_point(|one| leader_of(one) < leader);
    let rest = &list[begin..];
    &rest[..rest.partition_point(|one| leader_of(one) == leader)]
}

impl Ledger<'_> {
    /// Whether a block is in it.
    pub fn has(self, block: usize) -> bool {
        self.leaders[block] == self.leader
    }
}

fn presses(contact: &ActiveContact) -> bool {
    let now = contact.is_closed() || contact.multiplier[0] > 0.0 || contact.impulse != [0.0; 2];
    now || contact.remembered.normal > 0.0
}

/// The blocks of a contact that its forces move.
fn moved_by<'a>(
    blocks: &'a [Block],
    contact: &'a ActiveContact,
) -> impl Iterator<Item = usize> + 'a {
    let attachments = contact.kinematics.attachments().iter();
    attachments
        .map(|attachment| attachment.block)
        .filter(|&block| !blocks[block].is_prescribed())
}

fn leader_of(leaders: &[usize], mut block: usize) -> usize {
    while leaders[block] != block {
        block = leaders[block];
    }
    block
}
