use super::{Extent, Search};
use crate::path::samples::Random;
use crate::path::{MotionKind, Surfaces};

#[test]
fn the_search_finds_the_same_boxes_as_all_against_all() {
    let mut random = Random::new(3);
    for (n, m) in [(3, 4), (20, 7), (90, 140)] {
        let mut surfaces = Surfaces::new();
        let one = random.chain(n, 0.3);
        let other = random.chain(m, 0.3);
        surfaces.add_chain(MotionKind::Still, false, &one, false);
        surfaces.add_chain(MotionKind::Flexible, false, &other, true);
        let extent = Extent::of(&surfaces);
        let mut search = Search::default();
        search.refresh(extent);
        let mut found = Vec::new();
        search.points_and_edges(extent, [0, 1], 0.05, |point, edge| {
            found.push((point, edge))
        });
        let mut all = Vec::new();
        for point in surfaces.members()[0].points.clone() {
            for edge in surfaces.members()[1].edges.clone() {
                let grown = extent.bound_point(point).grown(0.05);
                if grown.meets(&extent.bound_edge(edge)) {
                    all.push((point, edge));
                }
            }
        }
        found.sort_unstable();
        assert_eq!(found, all);
    }
}
