//! Which points and edges of two members may come near each other: boxes of members, of chunks, of single ones, and a sweep
//! where many are left.

use super::bounds::Bounds;
use super::motion::Motion;
use super::surfaces::{CHUNK, MotionKind, Surfaces};
use crate::math::Vec2;
use std::ops::Range;

/// Up to how many pairs of boxes are asked one by one; sorting two short lists for the sweep costs as much.
const FEW: usize = 256;

/// Surfaces where they are, or all the way of a motion.
#[derive(Clone, Copy)]
pub(super) struct Extent<'a> {
    surfaces: &'a Surfaces,
    motion: Option<&'a Motion>,
}

impl<'a> Extent<'a> {
    pub fn of(surfaces: &'a Surfaces) -> Self {
        Self {
            surfaces,
            motion: None,
        }
    }

    pub fn swept(surfaces: &'a Surfaces, motion: &'a Motion) -> Self {
        Self {
            surfaces,
            motion: Some(motion),
        }
    }

    /// By how much the boxes of a member exceed starts and ends (m).
    #[inline]
    fn bulge(&self, member: usize) -> f64 {
        self.motion.map_or(0.0, |motion| motion.bulge(member))
    }

    #[inline]
    fn bound_point(&self, point: usize) -> Bounds {
        let here = self.surfaces.points()[point];
        Bounds::of([
            here,
            self.motion.map_or(here, |motion| motion.ends()[point]),
        ])
    }

    #[inline]
    fn bound_edge(&self, edge: usize) -> Bounds {
        let ends = self.surfaces.edges()[edge].map(|end| end as usize);
        let mut bounds = Bounds::of(ends.map(|end| self.surfaces.points()[end]));
        if let Some(motion) = self.motion {
            bounds.join(&Bounds::of(ends.map(|end| motion.ends()[end])));
        }
        bounds
    }

    /// The boxes of a member: the whole, chunks of points, chunks of edges.
    pub fn bound_member(&self, member: usize, boxes: &mut [Bounds]) {
        let bulge = self.bulge(member);
        let member = &self.surfaces.members()[member];
        let (whole, chunks) = boxes.split_at_mut(1);
        let (of_points, of_edges) = chunks.split_at_mut(member.n_point_boxes());
        whole[0] = Bounds::EMPTY;
        for (chunk, bounds) in of_points.iter_mut().enumerate() {
            *bounds = Bounds::EMPTY;
            for point in part(&member.points, chunk) {
                bounds.join(&self.bound_point(point));
            }
            *bounds = bounds.grown(bulge);
            whole[0].join(bounds);
        }
        for (chunk, bounds) in of_edges.iter_mut().enumerate() {
            *bounds = Bounds::EMPTY;
            for edge in part(&member.edges, chunk) {
                bounds.join(&self.bound_edge(edge));
            }
            *bounds = bounds.grown(bulge);
        }
    }
}

fn part(range: &Range<usize>, chunk: usize) -> Range<usize> {
    let from = range.start + chunk * CHUNK;
    from..(from + CHUNK).min(range.end)
}

/// Points or edges.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sort {
    Points,
    Edges,
}

#[derive(Clone, Copy, Debug)]
struct Item {
    bounds: Bounds,
    index: u32,
}

/// Boxes of the moving members and the lists of a sweep.
#[derive(Clone, Debug, Default)]
pub(super) struct Search {
    boxes: Vec<Bounds>,
    left: Vec<Item>,
    right: Vec<Item>,
}

impl Search {
    /// Makes the boxes of all moving members.
    pub fn refresh(&mut self, extent: Extent) {
        self.boxes.clear();
        self.boxes
            .resize(extent.surfaces.n_moving_boxes, Bounds::EMPTY);
        for (index, member) in extent.surfaces.members().iter().enumerate() {
            if member.kind != MotionKind::Still {
                extent.bound_member(index, &mut self.boxes[member.boxes.clone()]);
            }
        }
    }

    /// Makes the boxes of two members; those of others are not to be asked.
    pub fn refresh_members(&mut self, extent: Extent, members: [usize; 2]) {
        self.boxes
            .resize(extent.surfaces.n_moving_boxes, Bounds::EMPTY);
        for index in members {
            let member = &extent.surfaces.members()[index];
            if member.kind != MotionKind::Still {
                extent.bound_member(index, &mut self.boxes[member.boxes.clone()]);
            }
        }
    }

    fn boxes<'a>(&'a self, surfaces: &'a Surfaces, member: usize) -> &'a [Bounds] {
        let member = &surfaces.members()[member];
        let all = if member.kind == MotionKind::Still {
            &surfaces.still_boxes
        } else {
            &self.boxes
        };
        &all[member.boxes.clone()]
    }

    /// Whether the box of a member contains a point.
    pub fn contains(&self, surfaces: &Surfaces, member: usize, point: Vec2) -> bool {
        self.boxes(surfaces, member)[0].contains(point)
    }

    /// Tells every point of one member and edge of another whose boxes are within `reach` (m) of each other.
    pub fn points_and_edges(
        &mut self,
        extent: Extent,
        [points_of, edges_of]: [usize; 2],
        reach: f64,
        found: impl FnMut(usize, usize),
    ) {
        self.meet(
            extent,
            [(points_of, Sort::Points), (edges_of, Sort::Edges)],
            reach,
            found,
        );
    }

    /// Tells every edge of one member and edge of another whose boxes are within `reach` (m) of each other.
    pub fn edges_and_edges(
        &mut self,
        extent: Extent,
        [one, other]: [usize; 2],
        reach: f64,
        found: impl FnMut(usize, usize),
    ) {
        self.meet(
            extent,
            [(one, Sort::Edges), (other, Sort::Edges)],
            reach,
            found,
        );
    }

    fn meet(
        &mut self,
        extent: Extent,
        [one, other]: [(usize, Sort); 2],
        reach: f64,
        mut found: impl FnMut(usize, usize),
    ) {
        let window = self.boxes(extent.surfaces, other.0)[0].grown(reach);
        if !self.boxes(extent.surfaces, one.0)[0].meets(&window) {
            return;
        }
        let (mut left, mut right) = (
            std::mem::take(&mut self.left),
            std::mem::take(&mut self.right),
        );
        let window = self.collect(extent, one, (window, reach), &mut left);
        if !left.is_empty() {
            self.collect(extent, other, (window, 0.0), &mut right);
            if left.len() * right.len() <= FEW {
                one_by_one(&left, &right, &mut found);
            } else {
                sweep(&mut left, &mut right, &mut found);
            }
        }
        (self.left, self.right) = (left, right);
    }

    /// Lists what meets a window, each with its box grown by `reach` (m), and returns the box of them all. The window has
    /// `reach` in it already.
    fn collect(
        &self,
        extent: Extent,
        (member, sort): (usize, Sort),
        (window, reach): (Bounds, f64),
        items: &mut Vec<Item>,
    ) -> Bounds {
        items.clear();
        let bulge = extent.bulge(member);
        let boxes = &self.boxes(extent.surfaces, member)[1..];
        let member = &extent.surfaces.members()[member];
        let (range, boxes) = match sort {
            Sort::Points => (&member.points, &boxes[..member.n_point_boxes()]),
            Sort::Edges => (&member.edges, &boxes[member.n_point_boxes()..]),
        };
        let mut all = Bounds::EMPTY;
        for (chunk, bounds) in boxes.iter().enumerate() {
            if !bounds.meets(&window) {
                continue;
            }
            for index in part(range, chunk) {
                let bounds = match sort {
                    Sort::Points => extent.bound_point(index),
                    Sort::Edges => extent.bound_edge(index),
                };
                let bounds = bounds.grown(bulge);
                if bounds.meets(&window) {
                    let bounds = bounds.grown(reach);
                    all.join(&bounds);
                    items.push(Item {
                        bounds,
                        index: index as u32,
                    });
                }
            }
        }
        all
    }
}

fn one_by_one(left: &[Item], right: &[Item], found: &mut impl FnMut(usize, usize)) {
    for one in left {
        for other in right {
            if one.bounds.meets(&other.bounds) {
                found(one.index as usize, other.index as usize);
            }
        }
    }
}

/// Sorts both lists along the longer side of the first one's box; each pair of boxes that meet is told when the second of
/// them begins.
fn sweep(left: &mut [Item], right: &mut [Item], found: &mut impl FnMut(usize, usize)) {
    let mut all = Bounds::EMPTY;
    left.iter().for_each(|item| all.join(&item.bounds));
    let axis = usize::from(all.high.y - all.low.y > all.high.x - all.low.x);
    let low = |item: &Item| item.bounds.low[axis];
    for items in [&mut *left, &mut *right] {
        items.sort_unstable_by(|a, b| low(a).total_cmp(&low(b)).then(a.index.cmp(&b.index)));
    }
    let (mut i, mut j) = (0, 0);
    while i < left.len() && j < right.len() {
        let left_begins = low(&left[i]) <= low(&right[j]);
        let (first, rest) = if left_begins {
            (left[i], &right[j..])
        } else {
            (right[j], &left[i..])
        };
        for second in rest
            .iter()
            .take_while(|item| low(item) <= first.bounds.high[axis])
        {
            if first.bounds.meets(&second.bounds) {
                let (one, other) = if left_begins {
                    (&first, second)
                } else {
                    (second, &first)
                };
                found(one.index as usize, other.index as usize);
            }
        }
        if left_begins {
            i += 1;
        } else {
            j += 1;
        }
    }
}

#[cfg(test)]
mod tests;
