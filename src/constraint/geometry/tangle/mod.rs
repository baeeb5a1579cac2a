//! Tangles: where two outlines have been put across each other, what of one has gone astray, and which way leads it out.
//!
//! Two closed outlines cut each other into pieces (Weiler and Atherton, *Hidden surface removal using polygon area sorting*, 1977). The largest
//! piece of one is where it belongs; the rest, which lies in the other or beyond it, has gone astray between the crossings `p` by which it
//! leaves and `q` by which it comes back. A pressure on what is astray has the resultant `perp(q - p)`, whatever lies between: along that
//! direction, one for all, it leaves, as far as the other's surface between the same crossings (after the global intersection analysis of
//! Baraff, Witkin and Kass, *Untangling cloth*, 2003). A line without thickness is an outline that is gone along both ways.
//!
//! ```text
//!               +------------------+
//!               |        A         |                 what is astray of A: the corner between p and q
//!       +-------p------+           |                 its way out: perp(q - p), up and to the right,
//!       |       |      |           |                 as far as B between q and p
//!       |       +------q-----------+
//!       |    B         |
//!       +--------------+
//! ```

mod crossings;
mod loops;
mod view;

use crate::math::{Vec2, cross};
use crossings::Crossings;
pub use loops::Loops;
use view::View;

/// A stretch of an edge.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    edge: usize,
    /// Where it begins and ends (m).
    ends: [Vec2; 2],
}

impl Stretch {
    fn length(&self) -> f64 {
        (self.ends[1] - self.ends[0]).norm()
    }
}

/// What of an outline is on the wrong side of another, and what it is to be led past.
#[derive(Clone, Debug, Default)]
pub struct Tangle {
    /// Whether the first of both is astray; the second otherwise.
    is_of_first: bool,
    /// Unit direction in which what is astray leaves.
    normal: Vec2,
    /// What is astray, by the edges that start there.
    astray: Vec<usize>,
    /// Points of the other that lie between, by the edges that start there.
    within: Vec<usize>,
    /// The surface that is astray.
    gone: Vec<Stretch>,
    /// The other's surface, behind which it belongs.
    home: Vec<Stretch>,
}

/// The way of one point out of a tangle.
#[derive(Clone, Copy, Debug)]
pub struct WayOut {
    /// Whether it is a point of the first outline.
    pub is_of_first: bool,
    /// The edge that starts at the point.
    pub edge: usize,
    /// Unit direction in which it leaves.
    pub normal: Vec2,
    /// Where it ends, on the other outline.
    pub exit: Exit,
}

impl Tangle {
    /// The ways out of all points that have gone astray in it, and of those of the other that lie between.
    pub fn ways_out<'a>(
        &'a self,
        first: &'a Loops,
        second: &'a Loops,
    ) -> impl Iterator<Item = WayOut> + 'a {
        let [own, other] = match self.is_of_first {
            true => [first, second],
            false => [second, first],
        };
        let gone = self.astray.iter().filter_map(|&edge| {
            Some(WayOut {
                is_of_first: self.is_of_first,
                edge,
                normal: self.normal,
                exit: exit(own.start(edge), self.normal, &self.home)?,
            })
        });
        let within = self.within.iter().filter_map(|&edge| {
            Some(WayOut {
                is_of_first: !self.is_of_first,
                edge,
                normal: -self.normal,
                exit: exit(other.start(edge), -self.normal, &self.gone)?,
            })
        });
        gone.chain(within)
    }
}

/// Where a way out ends.
#[derive(Clone, Copy, Debug)]
pub struct Exit {
    /// The edge that is passed last.
    pub edge: usize,
    /// Where it is passed (m).
    pub place: Vec2,
    /// How far that is (m).
    pub distance: f64,
}

/// The tangles of two outlines; `None` if they do not cross, or no way leads out, as for what is wholly in the other.
pub fn tangles(first: &Loops, second: &Loops) -> Option<Vec<Tangle>> {
    let crossings = Crossings::of(first, second)?;
    let ours = View::of(first, second, &crossings);
    let theirs = View::of(second, first, &crossings.seen_by_second());
    let n_pieces = |view: &Option<View>| view.as_ref().map_or(0, |view| view.n_pieces);
    // What goes through the other is cut by it. Where both are, the shorter one leaves: in every step the same, or they would be led to and fro.
    let is_of_first = match [&ours, &theirs].map(|view| n_pieces(view) > 1) {
        [true, true] => first.length() <= second.length(),
        [false, true] => false,
        _ => ours.is_some(),
    };
    let mut found = if is_of_first { ours } else { theirs }?.tangles;
    for tangle in &mut found {
        tangle.is_of_first = is_of_first;
    }
    Some(found)
}

/// How far a point goes in a direction until it has passed some stretches: beside them, until it is level with the nearest end.
fn exit(point: Vec2, direction: Vec2, stretches: &[Stretch]) -> Option<Exit> {
    let mut farthest: Option<Exit> = None;
    let mut beside: Option<(f64, Exit)> = None;
    for stretch in stretches {
        let aside = stretch.ends.map(|end| cross(direction, end - point));
        let exit_at = |place: Vec2| Exit {
            edge: stretch.edge,
            place,
            distance: direction.dot(&(place - point)),
        };
        for (end, aside) in stretch.ends.iter().zip(aside) {
            if beside.is_none_or(|(least, _)| aside.abs() < least) {
                beside = Some((aside.abs(), exit_at(*end)));
            }
        }
        if (aside[0] < 0.0) != (aside[1] < 0.0) {
            let share = aside[0] / (aside[0] - aside[1]);
            let found = exit_at(stretch.ends[0] + share * (stretch.ends[1] - stretch.ends[0]));
            if farthest.is_none_or(|exit| found.distance > exit.distance) {
                farthest = Some(found);
            }
        }
    }
    farthest.or(beside.map(|(_, exit)| exit))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some<T>(found: Option<T>) -> T {
        let Some(found) = found else {
            panic!("there is one");
        };
        found
    }

    /// A rectangle with these lower and upper corners, each side of so many edges.
    fn block(low: [f64; 2], high: [f64; 2], n: usize) -> Loops {
        let corners = [low, [high[0], low[1]], high, [low[0], high[1]]].map(Vec2::from);
        let sides = (0..4).flat_map(|side| {
            let (from, to) = (corners[side], corners[(side + 1) % 4]);
            (0..n).map(move |at| from + at as f64 / n as f64 * (to - from))
        });
        let points: Vec<Vec2> = sides.collect();
        Loops::polygon(&points)
    }

    fn line(points: &[[f64; 2]]) -> Loops {
        let points: Vec<Vec2> = points.iter().copied().map(Vec2::from).collect();
        let edges: Vec<[u32; 2]> = (1..points.len() as u32).map(|end| [end - 1, end]).collect();
        some(Loops::lines(&points, &edges))
    }

    /// How far the points that are astray, and those between, have to go.
    fn depths(tangle: &Tangle, [first, second]: [&Loops; 2]) -> [Vec<f64>; 2] {
        [true, false].map(|is_astray| {
            let ways = tangle.ways_out(first, second);
            let ways = ways.filter(|way| (way.is_of_first == tangle.is_of_first) == is_astray);
            ways.map(|way| way.exit.distance).collect()
        })
    }

    fn close(one: Vec2, other: [f64; 2]) -> bool {
        (one - Vec2::from(other)).norm() < 1e-6
    }

    #[test]
    fn what_is_apart_or_within_has_no_tangles() {
        let one = block([0.0, 0.0], [1.0, 1.0], 3);
        assert!(tangles(&one, &block([1.1, 0.0], [2.0, 1.0], 2)).is_none());
        assert!(tangles(&one, &block([0.2, 0.2], [0.4, 0.4], 2)).is_none());
    }

    #[test]
    fn a_corner_leaves_a_corner_across_the_line_between_their_crossings() {
        let (one, other) = (
            block([0.0, 0.0], [1.0, 1.0], 4),
            block([-1.0, -1.0], [0.1, 0.1], 2),
        );
        for (first, second, sign) in [(&one, &other, 1.0), (&other, &one, -1.0)] {
            let found = some(tangles(first, second));
            assert_eq!(found.len(), 1);
            let half = sign * 0.5f64.sqrt();
            assert!(found[0].is_of_first && close(found[0].normal, [half; 2]));
            // Corner to corner is 0.1 √2 m.
            for depths in depths(&found[0], [first, second]) {
                assert_eq!(depths.len(), 1);
                assert!((depths[0] - 0.02f64.sqrt()).abs() < 1e-6, "{depths:?}");
            }
        }
    }

    #[test]
    fn what_lies_in_the_ground_leaves_it_upwards() {
        let ground = block([-9.0, -1.0], [9.0, 0.0], 1);
        let body = block([0.0, -0.14], [0.5, 0.16], 5);
        let found = some(tangles(&body, &ground));
        assert_eq!(found.len(), 1);
        assert!(found[0].is_of_first && close(found[0].normal, [0.0, 1.0]));
        let [gone, within] = depths(&found[0], [&body, &ground]);
        assert!(within.is_empty() && gone.len() == 10);
        let deepest = gone.iter().copied().fold(0.0, f64::max);
        assert!((deepest - 0.14).abs() < 1e-9);
    }

    /// Whatever of a body lies beyond a line is the lesser part of it.
    #[test]
    fn what_lies_across_a_line_leaves_to_the_side_of_its_larger_part() {
        let ground = line(&[[-2.0, 0.0], [-0.1, 0.0], [0.2, 0.0], [2.0, 0.0]]);
        for (low, normal, n_astray, deepest) in [(-0.1, 1.0, 6, 0.1), (-0.2, -1.0, 6, 0.1)] {
            let body = block([0.0, low], [0.5, low + 0.3], 5);
            let found = some(tangles(&body, &ground));
            assert_eq!(found.len(), 1, "{low}");
            assert!(found[0].is_of_first && close(found[0].normal, [0.0, normal]));
            let [gone, within] = depths(&found[0], [&body, &ground]);
            assert!(gone.len() >= n_astray && within.len() == 1);
            let far = gone.iter().copied().fold(0.0, f64::max);
            assert!((far - deepest).abs() < 1e-9, "{far}");
            assert!((within[0] - deepest).abs() < 1e-9, "{within:?}");
        }
    }

    #[test]
    fn the_end_of_a_line_leaves_by_the_edge_that_it_came_through() {
        let wire = line(&[[-1.0, 0.1], [0.2, 0.15]]);
        let body = block([0.0, 0.0], [1.0, 1.0], 3);
        let found = some(tangles(&body, &wire));
        assert_eq!(found.len(), 1);
        assert!(close(found[0].normal, [1.0, 0.0]));
        let [gone, within] = depths(&found[0], [&body, &wire]);
        assert!(gone.is_empty() && within.len() == 1);
        assert!((within[0] - 0.2).abs() < 1e-9);
    }

    /// A rod through the wall of a ring leaves it by the way that it came, with all that is beyond.
    #[test]
    fn what_goes_through_a_wall_is_drawn_back() {
        let n = 48;
        let around = |radius: f64, turns: f64| {
            move |at: usize| {
                let angle = turns * std::f64::consts::TAU * at as f64 / n as f64;
                radius * Vec2::new(angle.cos(), angle.sin())
            }
        };
        let outer = (0..n).map(around(1.0, 1.0));
        let points: Vec<Vec2> = outer.chain((0..n).map(around(0.8, -1.0))).collect();
        let next = |at: usize| (at / n) * n + (at + 1) % n;
        let ring = Loops::new(points, (0..2 * n).map(next).collect(), vec![0; 2 * n]);
        let rod = block([0.7, -0.05], [2.0, 0.05], 13);
        for swapped in [false, true] {
            let both = if swapped {
                [&rod, &ring]
            } else {
                [&ring, &rod]
            };
            let found = some(tangles(both[0], both[1]));
            assert_eq!(found.len(), 1);
            assert!(found[0].is_of_first == swapped && close(found[0].normal, [1.0, 0.0]));
            let [gone, _] = depths(&found[0], both);
            let far = gone.iter().copied().fold(0.0, f64::max);
            assert!((far - 0.3).abs() < 0.01, "{far}");
        }
    }

    /// A ring that has sunk in so far that the ground goes through its hole.
    #[test]
    fn a_ring_across_a_line_leaves_as_one() {
        let n = 60;
        let around = |radius: f64, turns: f64| {
            move |at: usize| {
                let angle = turns * std::f64::consts::TAU * (at as f64 + 0.3) / n as f64;
                Vec2::new(radius * angle.cos(), radius * angle.sin() + 0.5)
            }
        };
        let outer = (0..n).map(around(1.0, 1.0));
        let points: Vec<Vec2> = outer.chain((0..n).map(around(0.8, -1.0))).collect();
        let next = |at: usize| (at / n) * n + (at + 1) % n;
        let ring = Loops::new(points, (0..2 * n).map(next).collect(), vec![0; 2 * n]);
        let ground = line(&[[-5.0, 0.0], [5.0, 0.0]]);
        let found = some(tangles(&ring, &ground));
        assert_eq!(found.len(), 1);
        assert!(close(found[0].normal, [0.0, 1.0]));
        let [gone, _] = depths(&found[0], [&ring, &ground]);
        let far = gone.iter().copied().fold(0.0, f64::max);
        assert!((far - 0.5).abs() < 0.01, "{far}");
    }

    #[test]
    fn what_leans_in_twice_leaves_twice() {
        let ground = Loops::polygon(
            &[
                [-3.0, -1.0],
                [3.0, -1.0],
                [3.0, 1.0],
                [1.0, 0.0],
                [-1.0, 0.0],
                [-3.0, 1.0],
            ]
            .map(Vec2::from),
        );
        let body = block([-2.0, 0.3], [2.0, 1.5], 8);
        let found = some(tangles(&body, &ground));
        assert_eq!(found.len(), 2);
        for tangle in &found {
            let slope = 0.2f64.sqrt();
            assert!(close(
                Vec2::new(tangle.normal.x.abs(), tangle.normal.y),
                [slope, 2.0 * slope]
            ));
        }
    }
}
