use super::{MotionKind, Surfaces};
use crate::math::Vec2;

#[test]
fn every_point_knows_its_edges_and_a_lone_point_has_one_of_length_zero() {
    let points: Vec<Vec2> = (0..5).map(|k| Vec2::new(f64::from(k), 0.0)).collect();
    let mut surfaces = Surfaces::new();
    surfaces.add_chain(MotionKind::Still, false, &points[..1], false);
    // Three edges meet in point 1; point 4 has none.
    surfaces.add(MotionKind::Rigid, false, &points, [[0, 1], [1, 2], [1, 3]]);
    assert_eq!(surfaces.edges(), [[0, 0], [1, 2], [2, 3], [2, 4], [5, 5]]);
    assert_eq!(surfaces.edges_at(0), [0]);
    assert_eq!(surfaces.edges_at(1), [1]);
    assert_eq!(surfaces.edges_at(2), [1, 2, 3]);
    assert_eq!(surfaces.edges_at(5), [4]);
    assert_eq!(surfaces.parts(1), [1, 5]);
}

#[test]
fn what_is_added_after_truncation_stands_where_the_first_time() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec2::new(x, y));
    let mut surfaces = Surfaces::new();
    let terrain: Vec<Vec2> = (0..100).map(|k| Vec2::new(f64::from(k), 0.0)).collect();
    surfaces.add_chain(MotionKind::Still, false, &terrain, false);
    surfaces.add_chain(MotionKind::Flexible, true, &square, true);
    let once = surfaces.clone();
    surfaces.truncate(1);
    surfaces.add_chain(MotionKind::Flexible, true, &square, true);
    assert_eq!(surfaces.edges(), once.edges());
    assert_eq!(surfaces.points(), once.points());
    assert_eq!(surfaces.n_moving_boxes, once.n_moving_boxes);
    assert_eq!(surfaces.members()[1].boxes, once.members()[1].boxes);
    for point in 0..surfaces.points().len() {
        assert_eq!(surfaces.edges_at(point), once.edges_at(point));
    }
}
