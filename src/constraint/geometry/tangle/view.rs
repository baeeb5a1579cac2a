//! What of an outline has gone astray across another: the pieces that the other cuts it into, but for the largest.

use super::crossings::Crossings;
use super::loops::Loops;
use super::{Stretch, Tangle};
use crate::math::{Vec2, cross, perp, rounding};
use std::cmp::Ordering;

/// An outline as another cuts it.
pub(super) struct View {
    /// Number of pieces that it is cut into.
    pub n_pieces: usize,
    /// What has to be parted.
    pub tangles: Vec<Tangle>,
}

/// Where what is astray goes on: from the crossing by which it leaves home to the one by which it comes back.
struct Excursion {
    way: Way,
    chord: Vec2,
}

/// Along an outline from one crossing to another: the edges that start on it, and what of edges it goes along.
#[derive(Default)]
struct Way {
    points: Vec<usize>,
    stretches: Vec<Stretch>,
}

impl View {
    /// The first outline as the second cuts it; `None` if nothing of it is left, or it does not come home.
    pub fn of(first: &Loops, second: &Loops, crossings: &Crossings) -> Option<Self> {
        let all = &crossings.all;
        let about = all.first()?.place;
        let mut cycle_of = vec![usize::MAX; all.len()];
        let mut areas = Vec::new();
        for begin in (0..all.len()).filter(|&crossing| !all[crossing].enters) {
            if cycle_of[begin] != usize::MAX {
                continue;
            }
            let mut area = 0.0;
            let mut at = begin;
            while cycle_of[at] == usize::MAX {
                let goes = crossings.next_on_first[at];
                let comes = crossings.before_on_second[goes];
                area += area_of(&forward(first, 0, crossings, [at, goes]).stretches, about);
                area -= area_of(
                    &forward(second, 1, crossings, [comes, goes]).stretches,
                    about,
                );
                [cycle_of[at], cycle_of[goes]] = [areas.len(); 2];
                at = comes;
            }
            areas.push(area);
        }
        let largest =
            (0..areas.len()).max_by(|&one, &other| areas[one].total_cmp(&areas[other]))?;
        let least = rounding::SINGLE * areas[largest];
        if areas[largest] <= 0.0 {
            return None;
        }
        // What runs the other way round is the rim of a hole.
        let is_home =
            |crossing: usize| cycle_of[crossing] == largest || areas[cycle_of[crossing]] < -least;
        let n_pieces = areas.iter().filter(|area| **area > least).count();
        let mut cluster_of = vec![usize::MAX; all.len()];
        let mut excursions = Vec::new();
        for goes in (0..all.len()).filter(|&name| all[name].enters && is_home(name)) {
            let mut excursion = Excursion {
                way: Way::default(),
                chord: Vec2::zeros(),
            };
            let mut at = goes;
            loop {
                let after = crossings.next_on_first[at];
                let mut way = forward(first, 0, crossings, [at, after]);
                excursion.way.points.append(&mut way.points);
                excursion.way.stretches.append(&mut way.stretches);
                at = after;
                if !all[at].enters && is_home(at) {
                    break;
                }
                if at == goes {
                    return None;
                }
            }
            excursion.chord = all[at].place - all[goes].place;
            [cluster_of[goes], cluster_of[at]] = [excursions.len(); 2];
            excursions.push(excursion);
        }
        let mut view = Self {
            n_pieces,
            tangles: Vec::new(),
        };
        // What the second has between crossings of home belongs to the excursions that end there.
        let mut head: Vec<usize> = (0..excursions.len()).collect();
        let find = |head: &[usize], mut at: usize| {
            while head[at] != at {
                at = head[at];
            }
            at
        };
        let homeward = |goes: usize| crossings.before_on_second[goes];
        let home: Vec<usize> = (0..all.len())
            .filter(|&name| all[name].enters && is_home(name))
            .collect();
        for &goes in &home {
            let pair = [cluster_of[goes], cluster_of[homeward(goes)]];
            if pair[1] == usize::MAX {
                return None;
            }
            let [one, other] = pair.map(|at| find(&head, at));
            head[one.max(other)] = one.min(other);
        }
        for cluster in (0..excursions.len()).filter(|&at| head[at] == at) {
            let of_cluster = |at: &usize| find(&head, *at) == cluster;
            let members: Vec<usize> = (0..excursions.len()).filter(of_cluster).collect();
            let sum: Vec2 = members.iter().map(|&at| excursions[at].chord).sum();
            let length: f64 = members.iter().map(|&at| excursions[at].chord.norm()).sum();
            let size = members
                .iter()
                .map(|&at| excursions[at].length())
                .sum::<f64>();
            let mut tangle = Tangle::default();
            for &goes in home.iter().filter(|goes| of_cluster(&cluster_of[**goes])) {
                let comes = homeward(goes);
                let mut way = forward(second, 1, crossings, [comes, goes]);
                tangle.within.append(&mut way.points);
                tangle.home.append(&mut way.stretches);
            }
            let spike = tangle.home.iter().map(Stretch::length).sum::<f64>();
            let along = if length > rounding::SHARE * (size + spike) {
                sum
            } else {
                // A line that ends in the first: out of the edge that it came through.
                let [from, to] = first.edge(excursions[cluster].way.stretches.first()?.edge);
                to - from
            };
            if along.norm() <= rounding::SHARE * length {
                return None;
            }
            tangle.normal = perp(along).normalize();
            for at in members {
                tangle.astray.append(&mut excursions[at].way.points);
                tangle.gone.append(&mut excursions[at].way.stretches);
            }
            view.tangles.push(tangle);
        }
        Some(view)
    }
}

impl Excursion {
    fn length(&self) -> f64 {
        self.way.stretches.iter().map(Stretch::length).sum()
    }
}

/// Twice the area between stretches and a point (m²), positive if they go round it counter-clockwise.
fn area_of(stretches: &[Stretch], about: Vec2) -> f64 {
    let areas = stretches.iter().map(|stretch| {
        let [from, to] = stretch.ends.map(|end| end - about);
        cross(from, to)
    });
    areas.sum()
}

/// The way along one of the outlines from one crossing to the next of it.
fn forward(loops: &Loops, of: usize, crossings: &Crossings, [from, to]: [usize; 2]) -> Way {
    let [from, to] = [from, to].map(|name| &crossings.all[name]);
    let mut way = Way::default();
    let (mut edge, mut begin) = (from.edges[of], from.place);
    // Both sides of a line are crossed in one place: what comes to it leaves it there.
    let is_same = edge == to.edges[of];
    let is_direct = match from.along[of].total_cmp(&to.along[of]) {
        Ordering::Less => is_same,
        Ordering::Equal => is_same && from.enters == (of == 0),
        Ordering::Greater => false,
    };
    let mut arrives = is_direct;
    while !arrives {
        let end = loops.edge(edge)[1];
        way.stretches.push(Stretch {
            edge,
            ends: [begin, end],
        });
        edge = loops.next(edge);
        way.points.push(edge);
        begin = end;
        arrives = edge == to.edges[of];
    }
    way.stretches.push(Stretch {
        edge,
        ends: [begin, to.place],
    });
    way
}
