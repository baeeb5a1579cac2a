//! Which problems are solved as sparse ones: where operations say so, and where forces of any size may hold the same motion.
//!
//! The dense solver begins with nothing and takes the first forces that its rows agree on. Of a joint and a contact that hold one motion it takes what
//! rounding leaves; a box that is wedged between two walls by friction it may let go, as without pressure there is no friction either: its velocity grew to
//! 5 m/s where its position stood still. The sparse one goes on from the forces at hand.

use crate::kkt::active_contact::ActiveContact;
use crate::kkt::joined::Joined;
use crate::system::Block;

/// Scalar rows up to which the dense problem is always the quicker one.
const ALWAYS_DENSE: usize = 24;

/// Operations that the dense problem may take more often than the sparse one takes for a factor (-): its laws hold to rounding, and not to a
/// thousandth of the margin.
const WORTH: f64 = 4.0;

/// What of an island decides.
pub(super) struct Choice<'a> {
    pub blocks: &'a [Block],
    pub contacts: &'a [ActiveContact],
    pub joined: &'a Joined,
}

impl Choice<'_> {
    /// Whether so many scalar rows are better solved as a sparse problem.
    pub fn is_sparse(&self, n_rows: usize) -> bool {
        let mut operations = 0.0;
        for block in self.blocks {
            match block {
                Block::Flex(block) if block.is_explicit() => return false,
                Block::Flex(block) => operations += block.factor_operations(),
                // Links answer together, by no matrix of their own.
                Block::Rigid(block) if block.link_response().is_some() => return false,
                Block::Rigid(_) => operations += 64.0,
            }
        }
        let n = n_rows as f64;
        let is_worth = n_rows > ALWAYS_DENSE && n * n * n / 3.0 > WORTH * operations;
        let is_joined = |contact| self.joined.has(contact);
        is_worth || self.contacts.iter().any(is_joined) || self.wedges()
    }

    /// Whether contacts that part press a rigid body from opposite sides.
    fn wedges(&self) -> bool {
        let parts = |contact: &&ActiveContact| contact.is_parting();
        let parting = || self.contacts.iter().filter(parts);
        parting().enumerate().any(|(at, contact)| {
            let others = parting().take(at);
            others.into_iter().any(|other| self.face(contact, other))
        })
    }

    /// Whether two contacts press a rigid body that is free to move from opposite sides.
    fn face(&self, one: &ActiveContact, other: &ActiveContact) -> bool {
        let [one, other] = [one, other].map(|contact| &contact.kinematics);
        let along = one.normal.dot(&other.normal);
        one.attachments().iter().any(|a| {
            let is_free =
                matches!(&self.blocks[a.block], Block::Rigid(body) if !body.is_prescribed());
            let own = other.attachments().iter().filter(|b| b.block == a.block);
            is_free && own.into_iter().any(|b| a.weight * b.weight * along < 0.0)
        })
    }
}
