//! Parts of a step that are known to need a cut.
//!
//! A step is begun again where its members leave the boxes they were looked for in, with more of what is around. What could not be solved
//! in one piece before is not tried in one piece then: it would cost as much, and nearly always fail as it did. A part that would not is taken in
//! halves all the same, and told so.

use crate::coupling::Span;

/// What had to be cut since a step began, by the first flexible body of its island.
#[derive(Clone, Debug, Default)]
pub(super) struct KnownCuts {
    parts: Vec<(u32, Span)>,
}

impl KnownCuts {
    /// Begins a step.
    pub fn begin_step(&mut self) {
        self.parts.clear();
    }

    /// Notes a part that has to be cut.
    pub fn note(&mut self, island: u32, part: Span) {
        if !self.has(island, part) {
            self.parts.push((island, part));
        }
    }

    /// Whether a part had to be cut before.
    pub fn has(&self, island: u32, part: Span) -> bool {
        self.parts.contains(&(island, part))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cuts_are_known_by_island_and_part_until_the_next_step() {
        let [first, second] = Span::WHOLE.halves();
        let mut cuts = KnownCuts::default();
        cuts.note(3, Span::WHOLE);
        cuts.note(3, first);
        cuts.note(3, first);
        assert_eq!(cuts.parts.len(), 2);
        assert!(cuts.has(3, Span::WHOLE) && cuts.has(3, first));
        assert!(!cuts.has(3, second) && !cuts.has(4, Span::WHOLE));
        cuts.begin_step();
        assert!(!cuts.has(3, Span::WHOLE));
    }
}
