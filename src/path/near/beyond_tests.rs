use super::tests::PAIR;
use super::{Target, add_beyond};
use crate::math::Vec2;
use crate::path::samples::Random;
use crate::path::{MotionKind, Path, Surfaces};

/// Over a ridge there is nothing beyond the edge that a point is over; in a valley the line of the other one is.
#[test]
fn lines_go_on_beyond_valleys_only() {
    let mut random = Random::new(12);
    let mut n_added = 0;
    for _ in 0..2_000 {
        let slopes = [0, 1].map(|_| random.within(1.0));
        let chain =
            [-1.0, 0.0, 1.0].map(|x: f64| Vec2::new(x, x.abs() * slopes[usize::from(x > 0.0)]));
        let ball = Vec2::new(random.within(0.5), 0.5 * random.unit());
        let mut surfaces = Surfaces::new();
        surfaces.add_chain(MotionKind::Rigid, false, &[ball], false);
        surfaces.add_chain(MotionKind::Still, false, &chain, false);
        if ball.y <= ball.x.abs() * slopes[usize::from(ball.x > 0.0)] {
            continue;
        }
        let (mut listed, mut added) = (Vec::new(), Vec::new());
        Path::new().near(&surfaces, &[PAIR], 1.0, &mut listed);
        for row in &listed {
            add_beyond(&surfaces, &[PAIR], row, &mut added);
        }
        let is_valley = slopes[0] + slopes[1] > 0.0;
        assert!(is_valley || added.is_empty(), "{slopes:?} {ball}");
        for row in &added {
            let Target::Edge(edge) = row.target else {
                panic!("no edge");
            };
            let [from, to] = surfaces.ends(edge);
            let on_line = from + row.xi * (to - from);
            assert!((on_line + row.distance * row.normal - ball).norm() < 1e-12);
            assert!(row.normal.y > 0.0 && !(0.0..=1.0).contains(&row.xi));
            assert!(listed.iter().all(|one| one.target != row.target));
        }
        n_added += added.len();
    }
    assert!(n_added > 200, "{n_added}");
}
