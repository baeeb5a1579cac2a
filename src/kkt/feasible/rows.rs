//! What the rows of contact need of the path: the near pairs at the base, their names, levers and motions.

mod corners;

use super::{Carrier, FeasiblePath};
use crate::constraint::contact::{ContactKey, ContactLaw, Kinematics};
use crate::math::{Vec2, cross, node_vec, perp};
use crate::path::{NearPair, Target, add_beyond};
use crate::system::{Block, Grip, Point};
use corners::{Around, CoreVertex};

/// Marks the names of near pairs in contact keys.
///
/// Names of points are counted through a body or a collider: with the bit that tells edges from vertices they stay below this mark and that of
/// meetings until one has 2^29 points.
const PATH_NAMES: u32 = 1 << 31;

impl FeasiblePath {
    /// Lists what is near at the base, a sharp corner from its tip on.
    pub(in crate::kkt) fn list_near(&mut self) {
        let reaches = self.ways.iter().map(|way| way.reach);
        let farthest = reaches.fold(0.0, f64::max) + 2.0 * self.farthest_tip;
        self.wake_at_base();
        let mut near = std::mem::take(&mut self.near);
        self.search
            .near(&self.surfaces, &self.pairs, farthest, &mut near);
        self.add_beyond(&mut near);
        near.retain(|near| {
            let way = &self.ways[near.pair];
            near.distance - self.corner(near).max(0.0) <= way.closing + way.reach
        });
        self.near = near;
        self.note_own();
    }

    /// Adds the edges beyond a notch that sharp corners touch, where the vertices of cores that stand for them are beyond.
    fn add_beyond(&self, near: &mut Vec<NearPair>) {
        let n = near.len();
        for index in 0..n {
            let row = near[index];
            if self.points[row.point].corner != Vec2::zeros() {
                let first = near.len();
                add_beyond(&self.surfaces, &self.pairs, &row, near);
                let mut end = first;
                for at in first..near.len() {
                    if self.touches_edge(&near[at]) {
                        near[end] = near[at];
                        end += 1;
                    }
                }
                near.truncate(end);
            }
        }
        if near.len() > n {
            near.sort_unstable_by_key(|row| (row.pair, row.point, row.target));
            near.dedup_by_key(|row| (row.pair, row.point, row.target));
        }
    }

    /// Whether the sharp corner of a near pair's point has its foot inside the edge.
    fn touches_edge(&self, near: &NearPair) -> bool {
        let Target::Edge(edge) = near.target else {
            return false;
        };
        let [from, to] = self.surfaces.ends(edge);
        let along = to - from;
        let xi = near.xi + self.aside(near).dot(&along) / along.norm_squared();
        (0.0..=1.0).contains(&xi)
    }

    /// Whether no near pair of these blocks overlaps at the base.
    pub(in crate::kkt) fn are_apart(&self, blocks: &[bool]) -> bool {
        self.near.iter().all(|near| {
            let is_one = self.blocks_of(near).iter().any(|&block| blocks[block]);
            !is_one || self.kinematics(near).gap >= 0.0
        })
    }

    /// What is near at the base.
    pub(in crate::kkt) fn near(&self) -> &[NearPair] {
        &self.near
    }

    /// The law of a near pair.
    pub(in crate::kkt) fn law(&self, near: &NearPair) -> ContactLaw {
        let way = &self.ways[near.pair];
        let place = self.surfaces.points()[near.point];
        let (begin, end) = way.places;
        let placed = self.laws[begin as usize..end as usize].iter();
        let away = |(other, _): &(Vec2, ContactLaw)| (other - place).norm_squared();
        let nearest = placed.min_by(|one, other| away(one).total_cmp(&away(other)));
        let law = nearest.map_or(way.law, |(_, law)| *law);
        if law.carried != Vec2::zeros() && self.members_of(near)[0] != way.members[0] {
            return ContactLaw {
                carried: -law.carried,
                ..law
            };
        }
        law
    }

    /// Members of the point and of the target.
    pub(super) fn members_of(&self, near: &NearPair) -> [usize; 2] {
        let [one, other] = self.ways[near.pair].members;
        let owns = self.surfaces.members()[one].points.contains(&near.point);
        if owns { [one, other] } else { [other, one] }
    }

    /// Blocks of the point and of the target.
    pub(in crate::kkt) fn blocks_of(&self, near: &NearPair) -> [usize; 2] {
        self.members_of(near)
            .map(|member| self.carriers[member].block)
    }

    /// The name of a near pair.
    pub(in crate::kkt) fn key(&self, near: &NearPair) -> ContactKey {
        let way = &self.ways[near.pair];
        let is_first = self.members_of(near)[0] == way.members[0];
        let [contactor, target] = if is_first {
            way.owners
        } else {
            [way.owners[1], way.owners[0]]
        };
        let part = match near.target {
            Target::Edge(edge) => {
                let [from, _] = self.surfaces.edges()[edge];
                2 * self.points[from as usize].name + 1
            }
            Target::Vertex(vertex) => 2 * self.points[vertex].name,
        };
        ContactKey {
            contactor,
            point: self.points[near.point].name,
            target,
            part: PATH_NAMES | part,
        }
    }

    /// Names and rows of all that is near where the step begins.
    #[cfg(test)]
    pub(crate) fn start_rows(&mut self, blocks: &[Block]) -> Vec<(ContactKey, Kinematics)> {
        self.rest(blocks);
        self.list_near();
        let rows = self.near.iter();
        rows.map(|near| (self.key(near), self.kinematics(near)))
            .collect()
    }

    /// The row of a near pair at the base.
    pub(in crate::kkt) fn kinematics(&self, near: &NearPair) -> Kinematics {
        self.row(near, |at| self.surfaces.points()[at])
    }

    /// The row of a near pair of rigid bodies as if these, the point's and the target's, had their centres (m) and angles (rad) elsewhere.
    pub(in crate::kkt) fn kinematics_at(
        &mut self,
        near: &NearPair,
        places: [(Vec2, f64); 2],
    ) -> Kinematics {
        let blocks = self.blocks_of(near);
        let kept = blocks.map(|block| self.base[block]);
        for (block, (centre, angle)) in blocks.into_iter().zip(places) {
            self.base[block].place(centre, angle);
        }
        let place = |at: usize| {
            let base = &self.base[blocks[usize::from(at != near.point)]];
            match self.points[at].point {
                Point::Arm(arm) => base.point(arm),
                Point::Node(_) => base.centre,
            }
        };
        let row = self.row(&self.seen(near, place), place);
        for (block, base) in blocks.into_iter().zip(kept) {
            self.base[block] = base;
        }
        row
    }

    /// A near pair with its points elsewhere (m).
    fn seen(&self, near: &NearPair, place: impl Fn(usize) -> Vec2) -> NearPair {
        let point = place(near.point);
        match near.target {
            Target::Vertex(vertex) => {
                let away = point - place(vertex);
                let normal = away.try_normalize(0.0).unwrap_or(near.normal);
                let distance = away.norm();
                NearPair {
                    normal,
                    distance,
                    ..*near
                }
            }
            Target::Edge(edge) => {
                let [from, to] = self.surfaces.ends(edge);
                let side = cross(to - from, near.normal).signum();
                let [from, to] = self.surfaces.edges()[edge].map(|end| place(end as usize));
                let (along, away) = (to - from, point - from);
                let normal = side * perp(along) / along.norm();
                let xi = along.dot(&away) / along.norm_squared();
                NearPair {
                    normal,
                    distance: normal.dot(&away),
                    xi: xi.clamp(0.0, 1.0),
                    ..*near
                }
            }
        }
    }

    /// The row of a near pair whose points are here (m), with the base that they belong to.
    fn row(&self, near: &NearPair, place: impl Fn(usize) -> Vec2) -> Kinematics {
        let way = &self.ways[near.pair];
        let [own, met] = self.members_of(near).map(|member| self.carriers[member]);
        let point = place(near.point);
        let around = self.around_corner(near, &place);
        // Forces act on the surface of a flexible body: at the point's own, or where the target's is met.
        let position = if own.is_flex {
            self.at_base(own.block, self.points[near.point].point)
        } else if let Some(around) = &around {
            around.position
        } else {
            point - (near.distance - self.depth(near)) * near.normal + self.aside(near)
        };
        let lever = |carrier: Carrier| position - self.base[carrier.block].centre;
        let held = |carrier: Carrier, at: usize| {
            if carrier.is_flex {
                self.points[at].point
            } else {
                Point::Arm(self.base[carrier.block].arm(position))
            }
        };
        let first = (own.block, held(own, near.point), 1.0, lever(own));
        let (gap, normal) = match &around {
            Some(around) => (around.gap, around.normal),
            None => (near.distance - way.closing - self.corner(near), near.normal),
        };
        let target = |at: usize, weight: f64| (met.block, held(met, at), weight, lever(met));
        let row = |grips: &[_]| Kinematics::with_levers(gap, normal, position, grips);
        match near.target {
            Target::Edge(edge) if met.is_flex => {
                let [from, to] = self.surfaces.edges()[edge].map(|end| end as usize);
                let [start, end] =
                    [from, to].map(|end| self.at_base(met.block, self.points[end].point));
                let along = end - start;
                let foot = (position - start).dot(&along) / along.norm_squared();
                let xi = if foot.is_finite() { foot } else { near.xi }.clamp(0.0, 1.0);
                row(&[first, target(from, xi - 1.0), target(to, -xi)])
            }
            Target::Edge(edge) => {
                let [from, _] = self.surfaces.edges()[edge];
                row(&[first, target(from as usize, -1.0)])
            }
            Target::Vertex(vertex) => row(&[first, target(vertex, -1.0)]),
        }
    }

    /// Where a near pair of this gap (m) is, on its row at the base, with the blocks where they are now (m).
    pub(in crate::kkt) fn place(&self, near: &NearPair, gap: f64, blocks: &[Block]) -> Vec2 {
        let members = self.members_of(near).map(|member| self.carriers[member]);
        let own = members[0];
        let point = blocks[own.block].position(self.points[near.point].point);
        if own.is_flex {
            return point;
        }
        let now = |at: usize| {
            let side = usize::from(at != near.point);
            blocks[members[side].block].position(self.points[at].point)
        };
        if let Some(around) = self.around_corner(near, now) {
            return around.position;
        }
        let distance = gap + self.ways[near.pair].closing + self.corner(near);
        point - (distance - self.depth(near)) * near.normal + self.aside(near)
    }

    /// What is round and a sharp corner of rigid bodies, whose cores' vertices are near at these places (m); `None` of other pairs.
    fn around_corner(&self, near: &NearPair, place: impl Fn(usize) -> Vec2) -> Option<Around> {
        let Target::Vertex(vertex) = near.target else {
            return None;
        };
        let members = self.members_of(near).map(|member| self.carriers[member]);
        if members.iter().any(|member| member.is_flex) {
            return None;
        }
        let closing = self.ways[near.pair].closing;
        let ends = [(near.point, members[0]), (vertex, members[1])].map(|(vertex, member)| {
            let point = &self.points[vertex];
            CoreVertex {
                place: place(vertex),
                corner: self.base[member.block].axes() * point.corner,
                round: point.round,
            }
        });
        Around::between(ends, members[1].depth, closing)
    }

    /// How deep the target's core is under the surface that the point meets (m).
    fn depth(&self, near: &NearPair) -> f64 {
        self.carriers[self.members_of(near)[1]].depth
    }

    /// How much farther than their faces sharp corners reach along the normal (m), where the vertices of cores stand for them.
    fn corner(&self, near: &NearPair) -> f64 {
        let of_target = match near.target {
            Target::Edge(_) => 0.0,
            Target::Vertex(vertex) => self.sharpness(vertex, 1, near),
        };
        self.sharpness(near.point, 0, near) + of_target
    }

    /// From where the core of the point is nearest, along the surface to the sharp corner that touches (m).
    fn aside(&self, near: &NearPair) -> Vec2 {
        let [own, met] = self
            .members_of(near)
            .map(|member| self.carriers[member].block);
        let corner = |vertex: usize, block: usize| {
            let corner = self.base[block].axes() * self.points[vertex].corner;
            corner - corner.dot(&near.normal) * near.normal
        };
        match near.target {
            Target::Vertex(vertex) if self.points[near.point].round == 0.0 => corner(vertex, met),
            _ => corner(near.point, own),
        }
    }

    /// How much farther than its faces the corner of a vertex reaches towards the other member (m), the point's (0) or the target's (1);
    /// negative where another corner of it reaches farther.
    fn sharpness(&self, vertex: usize, side: usize, near: &NearPair) -> f64 {
        let block = self.carriers[self.members_of(near)[side]].block;
        let own = &self.points[vertex];
        let towards = if side == 0 { -near.normal } else { near.normal };
        let corner = self.base[block].axes() * own.corner;
        towards.dot(&corner) - own.round
    }

    /// Position of a point of a block at the base (m).
    fn at_base(&self, block: usize, point: Point) -> Vec2 {
        let base = &self.base[block];
        match (point, base.nodes) {
            (Point::Node(node), Some(first)) => node_vec(&self.nodes[first..], node),
            (Point::Arm(arm), _) => base.point(arm),
            (Point::Node(_), None) => base.centre,
        }
    }

    /// Motion of the material at a row from the beginning of the step to the base, the point's against the target's (m); linear in the
    /// dofs of rigid blocks, so that what rolls without slip does so by any angle.
    pub(in crate::kkt) fn moved(&self, row: &Kinematics, blocks: &[Block]) -> Vec2 {
        let grips = row.attachments().iter();
        grips
            .map(|a| a.weight * self.moved_of(a.block, a.grip, &blocks[a.block]))
            .sum()
    }

    fn moved_of(&self, block: usize, grip: Grip, own: &Block) -> Vec2 {
        let base = &self.base[block];
        match own {
            Block::Flex(_) => self.at_base(block, grip.point) - own.start_position(grip.point),
            Block::Rigid(body) => {
                let start = body.start();
                base.centre - start.centre + (base.angle() - start.angle) * perp(grip.lever)
            }
        }
    }

    /// Motion at a row from the base to the blocks' iterate, linear in the dofs of rigid blocks (m).
    pub(in crate::kkt) fn onward(&self, row: &Kinematics, blocks: &[Block]) -> Vec2 {
        let grips = row.attachments().iter();
        grips
            .map(|a| a.weight * self.onward_of(a.block, a.grip, &blocks[a.block]))
            .sum()
    }

    fn onward_of(&self, block: usize, grip: Grip, iterate: &Block) -> Vec2 {
        let base = &self.base[block];
        match (iterate, grip.point) {
            (Block::Flex(body), Point::Node(node)) => {
                body.position(node) - self.at_base(block, grip.point)
            }
            (Block::Rigid(body), _) => {
                let end = body.current();
                end.centre - base.centre + (end.angle - base.angle()) * perp(grip.lever)
            }
            _ => Vec2::zeros(),
        }
    }
}

#[cfg(test)]
mod tests;
