//! Who is solved in one system: the members of a claim and the components they form.
//!
//! A member is a flexible body, by its slot in the roster, or a claimed rigid one: these are counted on from the flexible bodies, in the
//! order in which they were reached. What touches or is joined is united.

use crate::math::HashMap;
use crate::rapier::prelude::*;

/// Members and their components.
#[derive(Debug, Default)]
pub(super) struct Members {
    n_flex: usize,
    /// Claimed rigid bodies, in the order they were reached.
    rigid: Vec<RigidBodyHandle>,
    /// Where they are in that order.
    place_of: HashMap<RigidBodyHandle, usize>,
    /// A member of the same component with a smaller or the same number; the root itself once the walk has ended.
    parent: Vec<usize>,
}

impl Members {
    /// Begins with flexible bodies, each alone.
    pub fn begin(&mut self, n_flex: usize) {
        self.n_flex = n_flex;
        self.rigid.clear();
        self.place_of.clear();
        self.parent.clear();
        self.parent.extend(0..n_flex);
    }

    /// Claimed rigid bodies, in the order they were reached.
    pub fn rigid(&self) -> &[RigidBodyHandle] {
        &self.rigid
    }

    /// Whether a rigid body was claimed.
    pub fn has(&self, handle: RigidBodyHandle) -> bool {
        self.place_of.contains_key(&handle)
    }

    /// The member that a rigid body is, claimed now if it was not.
    pub fn claim(&mut self, handle: RigidBodyHandle) -> usize {
        if let Some(&place) = self.place_of.get(&handle) {
            return self.n_flex + place;
        }
        let place = self.rigid.len();
        self.rigid.push(handle);
        self.place_of.insert(handle, place);
        self.parent.push(self.n_flex + place);
        self.n_flex + place
    }

    /// Makes the components of two members one.
    pub fn unite(&mut self, one: usize, other: usize) {
        let (one, other) = (self.root(one), self.root(other));
        // The smaller number stays the root, so that components do not depend on the order of unions.
        self.parent[one.max(other)] = one.min(other);
    }

    /// Ends the walk: from here on components are looked up.
    pub fn settle(&mut self) {
        for member in 0..self.parent.len() {
            // Parents have smaller numbers, and are roots by now.
            self.parent[member] = self.parent[self.parent[member]];
        }
    }

    /// Component of a flexible body, after [`Members::settle`].
    pub fn component_of_flex(&self, flex: usize) -> usize {
        self.parent[flex]
    }

    /// Component of a rigid body, after [`Members::settle`]; `None` if it was not claimed.
    pub fn component_of_rigid(&self, handle: RigidBodyHandle) -> Option<usize> {
        let place = *self.place_of.get(&handle)?;
        Some(self.parent[self.n_flex + place])
    }

    fn root(&mut self, mut member: usize) -> usize {
        while self.parent[member] != member {
            self.parent[member] = self.parent[self.parent[member]];
            member = self.parent[member];
        }
        member
    }
}

/// What a snapshot writes: that of the last step, who was claimed is asked of in a step without a claim.
#[cfg(feature = "serde-serialize")]
impl Members {
    /// Claimed rigid bodies with their places.
    pub fn places(&self) -> &HashMap<RigidBodyHandle, usize> {
        &self.place_of
    }

    /// Members of which no more is known than which rigid bodies they were.
    pub fn remembered(places: Vec<(RigidBodyHandle, usize)>) -> Self {
        Self {
            place_of: places.into_iter().collect(),
            ..Self::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(index: u32) -> RigidBodyHandle {
        RigidBodyHandle::from_raw_parts(index, 0)
    }

    /// The unions of a walk, whatever their order, give the same components, each named by its smallest member.
    #[test]
    fn components_do_not_depend_on_the_order_of_unions() {
        let unions = [(4, 3), (3, 0), (5, 2), (6, 5)];
        let components = |order: &[usize]| {
            let mut members = Members::default();
            members.begin(3);
            let rigid = [0, 1, 2, 3].map(|index| members.claim(body(index)));
            assert_eq!(rigid, [3, 4, 5, 6]);
            for &slot in order {
                members.unite(unions[slot].0, unions[slot].1);
            }
            members.settle();
            let flex = [0, 1, 2].map(|flex| Some(members.component_of_flex(flex)));
            let rigid = [0, 1, 2, 3].map(|index| members.component_of_rigid(body(index)));
            (flex, rigid)
        };
        let expected = (
            [Some(0), Some(1), Some(2)],
            [Some(0), Some(0), Some(2), Some(2)],
        );
        assert_eq!(components(&[0, 1, 2, 3]), expected);
        assert_eq!(components(&[3, 1, 2, 0]), expected);
        assert_eq!(components(&[2, 0, 3, 1]), expected);
    }

    #[test]
    fn a_body_is_claimed_once_and_forgotten_in_the_next_step() {
        let mut members = Members::default();
        members.begin(1);
        assert_eq!(members.claim(body(7)), members.claim(body(7)));
        assert_eq!(members.rigid(), [body(7)]);
        members.begin(1);
        assert!(!members.has(body(7)) && members.rigid().is_empty());
        assert_eq!(members.component_of_rigid(body(7)), None);
    }
}
