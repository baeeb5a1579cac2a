//! The time of impact: how much of a motion is safe, and which pairs stop it.

use super::advance::{Candidate, Ways};
use super::distance::foot_on;
use super::motion::Motion;
use super::search::Extent;
use super::surfaces::MotionKind;
use super::{MemberPair, Path, Surfaces};

/// Height over the floor at which an approach counts as arrived, as a share of the margin, or of the pair's own height over
/// the floor now if that is less: who slides at that height is never mistaken for one who arrives. Where the direction stays
/// one advance goes to the floor itself, otherwise it leaves a part, so a smaller share costs advances and gains no way.
const ARRIVED: f64 = 0.02;

/// A member pair that comes to its floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Which of the member pairs.
    pub pair: usize,
    /// The point.
    pub point: usize,
    /// The edge it comes near to.
    pub edge: usize,
    /// Up to where the pair's motion is safe, in [0, 1).
    pub t: f64,
}

/// How much of a motion is safe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Toi {
    /// Up to where all pairs keep their floor, in [0, 1].
    pub t: f64,
    /// The pair that stops it first, if any does.
    pub first: Option<Hit>,
    /// How many points were stopped where the advances ran out; safe, but farther might have been.
    pub n_exhausted: usize,
    /// Advances in all, a measure of work.
    pub n_advances: usize,
}

impl Path {
    /// Finds how much of a motion keeps every pair at its floor or above, all the way.
    ///
    /// The floor of a pair follows from its distance now, so that a point that slides over the joints of a chain below
    /// `closing` is not stopped by the edges ahead; only where some point is at the guard, each has its own.
    ///
    /// - `hits`: overwritten with the first hit of each pair that has one, in the order of the pairs.
    pub fn time_of_impact(
        &mut self,
        surfaces: &Surfaces,
        motion: &Motion,
        pairs: &[MemberPair],
        hits: &mut Vec<Hit>,
    ) -> Toi {
        hits.clear();
        let mut toi = Toi {
            t: 1.0,
            first: None,
            n_exhausted: 0,
            n_advances: 0,
        };
        let extent = Extent::swept(surfaces, motion);
        self.search.refresh(extent);
        for (index, pair) in pairs.iter().enumerate() {
            let is_still = |member: usize| surfaces.members()[member].kind == MotionKind::Still;
            if pair.is_asleep || is_still(pair.one) && is_still(pair.other) {
                continue;
            }
            let least = self.list_candidates(extent, surfaces, pair);
            if let Some(hit) = self.first_hit((surfaces, motion), (index, pair), least, &mut toi) {
                hits.push(hit);
                if hit.t < toi.t {
                    (toi.t, toi.first) = (hit.t, Some(hit));
                }
            }
        }
        toi
    }

    /// Lists who may come to the floor and returns the least distance among them (m).
    fn list_candidates(&mut self, extent: Extent, surfaces: &Surfaces, pair: &MemberPair) -> f64 {
        let candidates = &mut self.candidates;
        candidates.clear();
        let mut least = f64::INFINITY;
        let own = pair.one == pair.other;
        for members in [[pair.one, pair.other], [pair.other, pair.one]]
            .into_iter()
            .take(2 - usize::from(own))
        {
            self.search
                .points_and_edges(extent, members, pair.highest_floor(), |point, edge| {
                    if own && surfaces.edges()[edge].contains(&(point as u32)) {
                        return;
                    }
                    let foot = foot_on(surfaces.points()[point], surfaces.ends(edge));
                    least = least.min(foot.distance);
                    let (distance, normal) = (foot.distance, foot.normal);
                    candidates.push(Candidate {
                        point,
                        edge,
                        members,
                        distance,
                        normal,
                    });
                });
        }
        least
    }

    fn first_hit(
        &self,
        (surfaces, motion): (&Surfaces, &Motion),
        (index, pair): (usize, &MemberPair),
        least: f64,
        toi: &mut Toi,
    ) -> Option<Hit> {
        let mut hit: Option<Hit> = None;
        for candidate in &self.candidates {
            let until = hit.map_or(1.0, |hit| hit.t);
            let from = if least > pair.guard() {
                least
            } else {
                candidate.distance
            };
            let floor = pair.floor(from);
            let arrived = floor + ARRIVED * (from - floor).min(pair.margin);
            let ways = Ways::of((surfaces, motion), candidate, (floor, arrived));
            let advanced = ways.advance(candidate, until);
            toi.n_advances += advanced.advances;
            toi.n_exhausted += usize::from(advanced.exhausted);
            if let Some(t) = advanced.stop {
                hit = Some(Hit {
                    pair: index,
                    point: candidate.point,
                    edge: candidate.edge,
                    t,
                });
            }
        }
        hit
    }
}

#[cfg(test)]
mod tests;
