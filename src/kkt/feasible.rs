//! The feasible path of an island: which surfaces are kept apart, where they are at the base of the path, and what of it the rows need.

mod around;
mod kept;
mod meetings;
mod members;
mod own;
mod retreat;
mod rows;
mod straight;
mod turn;

pub(super) use self::kept::KeptBase;
use self::meetings::Meeting;
pub(crate) use self::members::Way;
use self::members::{BlockBase, Carrier, SurfacePoint};
use self::own::OwnWay;
use self::retreat::LastWay;
use self::straight::straight_part;
pub(super) use self::turn::{points_of, turn};
use crate::constraint::contact::{ContactLaw, ContactMemory};
use crate::math::{Vec2, rotation};
use crate::path::{Hit, MemberPair, Motion, MotionKind, NearPair, Path, Surfaces};
use crate::system::{Block, FlexBlock, Point};

/// Surfaces that are led along a feasible path, with their buffers.
#[derive(Debug, Default)]
pub struct FeasiblePath {
    surfaces: Surfaces,
    /// The way of the last pass, from the base before it.
    motion: Motion,
    /// What else is asked about, kept out of that way.
    question: Motion,
    search: Path,
    pairs: Vec<MemberPair>,
    ways: Vec<Way>,
    /// Laws by the places about which they hold (m).
    laws: Vec<(Vec2, ContactLaw)>,
    carriers: Vec<Carrier>,
    points: Vec<SurfacePoint>,
    near: Vec<NearPair>,
    hits: Vec<Hit>,
    base: Vec<BlockBase>,
    /// Nodes of the flexible blocks at the base, interleaved (m).
    nodes: Vec<f64>,
    scratch: Vec<Vec2>,
    edges: Vec<[u32; 2]>,
    /// How far the sharpest corner stands out of its rounding (m).
    farthest_tip: f64,
    /// Vertices at which forces have slid off within the step.
    meetings: Vec<Meeting>,
    last_way: LastWay,
    /// Surfaces that are kept apart from themselves, whose ways are the last ones, and the placements that these are compared with.
    own: Vec<OwnWay>,
    references: Vec<Vec2>,
    /// Number of points, the first ones, of surfaces that meet others, once these have been added.
    n_shared: Option<usize>,
    /// Whether there is a path to follow: ways of surfaces with themselves alone ask for one where they are near.
    is_led: bool,
}

impl FeasiblePath {
    pub(super) fn clear(&mut self) {
        self.surfaces.truncate(0);
        self.pairs.clear();
        self.ways.clear();
        self.laws.clear();
        self.carriers.clear();
        self.points.clear();
        self.near.clear();
        self.farthest_tip = 0.0;
        self.own.clear();
        self.references.clear();
        self.n_shared = None;
        self.is_led = false;
        self.base.clear();
        self.nodes.clear();
    }

    /// Whether there is no path to follow: no surfaces are kept apart, or only from themselves, where they are not near.
    pub(super) fn is_empty(&self) -> bool {
        !self.is_led
    }

    /// Number of ways so far.
    pub(crate) fn n_ways(&self) -> usize {
        self.ways.len()
    }

    /// Lets the ways from the `first` on have the nearest of these laws.
    pub(crate) fn place_laws(&mut self, first: usize, laws: &[(Vec2, ContactLaw)]) {
        let begin = self.laws.len() as u32;
        self.laws.extend_from_slice(laws);
        for way in &mut self.ways[first..] {
            way.places = (begin, self.laws.len() as u32);
        }
    }

    /// Forgets all ways from the `first` on.
    pub(crate) fn truncate(&mut self, first: usize) {
        self.ways.truncate(first);
        self.pairs.truncate(first);
        self.is_led = !self.ways.is_empty();
    }

    /// Adds the surface of a flexible block.
    ///
    /// - `round`: by how much it is drawn inwards and rounded (m).
    /// - `corners`: from where its boundary nodes are then to these, in body axes (m); empty if it stays where it is.
    pub(crate) fn flex_member(
        &mut self,
        block: usize,
        body: &FlexBlock,
        round: f64,
        corners: &[Vec2],
    ) -> usize {
        let boundary = body.model().mesh().boundary();
        self.scratch.clear();
        self.edges.clear();
        let first = self.points.len();
        let axes = rotation(body.start_frame().angle);
        for (slot, &node) in boundary.nodes().iter().enumerate() {
            let point = SurfacePoint {
                point: Point::Node(node),
                name: node as u32,
                corner: corners.get(slot).copied().unwrap_or_default(),
                round,
            };
            self.scratch
                .push(point.beside(body.start_position(node), &axes));
            self.points.push(point);
            self.farthest_tip = self.farthest_tip.max(point.corner.norm() - round);
        }
        // Segment k starts at boundary node k.
        for segment in 0..boundary.segments().len() {
            self.edges
                .push([segment as u32, boundary.next_segment(segment) as u32]);
        }
        debug_assert_eq!(first + self.scratch.len(), self.points.len());
        self.carriers.push(Carrier {
            block,
            is_flex: true,
            depth: round,
        });
        let edges = self.edges.iter().copied();
        self.surfaces
            .add(MotionKind::Flexible, true, &self.scratch, edges)
    }

    /// Adds a piece of a rigid block.
    ///
    /// - `name`: what its points' names are counted from.
    /// - `round`, `depth`: radius by which the corners of its core are rounded, and how deep that is under the surface (m).
    /// - `points`: names, arms from the centre of mass, and ways to the sharp corners that they stand for, in body axes (m).
    /// - `edges`: their ends among the points.
    pub(crate) fn rigid_member(
        &mut self,
        block: usize,
        blocks: &[Block],
        name: u32,
        [round, depth]: [f64; 2],
        points: &[(u32, Vec2, Vec2)],
        edges: &[[u32; 2]],
    ) -> usize {
        let mut kind = MotionKind::Still;
        self.scratch.clear();
        if let Block::Rigid(body) = &blocks[block] {
            let start = *body.start();
            if !body.is_prescribed() || body.drift() != start {
                kind = MotionKind::Rigid;
            }
            for &(own, arm, corner) in points {
                self.scratch.push(start.point(arm));
                self.farthest_tip = self.farthest_tip.max(corner.norm() - round);
                self.points.push(SurfacePoint {
                    point: Point::Arm(arm),
                    name: name + own,
                    corner,
                    round,
                });
            }
        }
        self.carriers.push(Carrier {
            block,
            is_flex: false,
            depth,
        });
        let is_solid = edges.len() > 2 && edges.len() == points.len();
        let edges = edges.iter().copied();
        self.surfaces.add(kind, is_solid, &self.scratch, edges)
    }

    /// Keeps two members apart; returns whether they are to begin with. If not, nothing is added.
    pub(crate) fn add_way(&mut self, way: Way) -> bool {
        self.add_apart(way, false)
    }

    /// The same for members that begin with all the room that the path may use up.
    pub(crate) fn add_roomy_way(&mut self, way: Way) -> bool {
        self.add_apart(way, true)
    }

    fn add_apart(&mut self, way: Way, needs_room: bool) -> bool {
        let [one, other] = way.members;
        let Some(least) = self.search.apart(&self.surfaces, way.members, way.closing) else {
            return false;
        };
        let pair = MemberPair {
            one,
            other,
            name: self.pairs.len() as u64,
            closing: way.closing,
            margin: way.margin,
            least,
            is_asleep: false,
        };
        if needs_room && !pair.has_room() {
            return false;
        }
        self.pairs.push(pair);
        self.ways.push(way);
        self.is_led = true;
        true
    }

    /// Lists the blocks of the ways between owners that pressed each other in the last step: their forces still act from the stored
    /// accelerations.
    pub(super) fn list_pressed(&self, memory: &ContactMemory, blocks: &mut Vec<[usize; 2]>) {
        for way in &self.ways {
            if memory.has_pressed(way.owners) {
                blocks.push(way.members.map(|member| self.carriers[member].block));
            }
        }
    }

    /// Margin of the way of a near pair (m).
    pub(super) fn margin(&self, near: &NearPair) -> f64 {
        self.ways[near.pair].margin
    }

    /// Puts the base where the step begins.
    pub(super) fn rest(&mut self, blocks: &[Block]) {
        for member in 0..self.carriers.len() {
            self.place_at_start(member, blocks);
        }
        self.base.clear();
        self.nodes.clear();
        self.meetings.clear();
        for block in blocks {
            self.base.push(match block {
                Block::Flex(body) => {
                    let first = self.nodes.len();
                    self.nodes.extend_from_slice(body.start_positions());
                    let frame = body.start_frame();
                    BlockBase::new(frame.centre, frame.angle, Some(first))
                }
                Block::Rigid(body) => BlockBase::new(body.start().centre, body.start().angle, None),
            });
        }
        self.forget_own();
        let n_points = self.surfaces.points().len();
        self.last_way
            .forget([n_points, self.base.len(), self.nodes.len()]);
    }

    /// Moves the base towards the blocks' iterate, as far as the surfaces stay apart; returns whether it arrives.
    pub(super) fn advance(&mut self, blocks: &[Block]) -> bool {
        self.motion.rest(&self.surfaces);
        for member in 0..self.carriers.len() {
            let base = self.base[self.carriers[member].block];
            self.aim(member, (base.centre, base.angle()), blocks);
        }
        let own = self.wake_on_way();
        let impact =
            self.search
                .time_of_impact(&self.surfaces, &self.motion, &self.pairs, &mut self.hits);
        let part = impact.t.min(own).min(straight_part(self, blocks));
        self.look_back(part);
        self.go(part, blocks);
        part >= 1.0
    }

    /// Nodes of a flexible block at the base, interleaved (m).
    pub(super) fn base_of(&self, block: usize, n_dofs: usize) -> Option<&[f64]> {
        let first = self.base.get(block)?.nodes?;
        self.nodes.get(first..first + n_dofs)
    }

    /// Puts the points of a member where the step begins.
    fn place_at_start(&mut self, member: usize, blocks: &[Block]) {
        let own = &self.surfaces.members()[member];
        if own.kind == MotionKind::Still {
            return;
        }
        let points = own.points.clone();
        let block = &blocks[self.carriers[member].block];
        let angle = match block {
            Block::Flex(body) => body.start_frame().angle,
            Block::Rigid(body) => body.start().angle,
        };
        let axes = rotation(angle);
        let places = self.surfaces.points_mut(member).iter_mut();
        for (place, own) in places.zip(&self.points[points]) {
            *place = match own.point {
                Point::Node(_) => own.beside(block.start_position(own.point), &axes),
                Point::Arm(_) => block.start_position(own.point),
            };
        }
    }

    /// Moves a member to where its block's iterate is; a rigid one from this centre and angle.
    fn aim(&mut self, member: usize, (centre, angle): (Vec2, f64), blocks: &[Block]) {
        let carrier = self.carriers[member];
        match (&blocks[carrier.block], self.surfaces.members()[member].kind) {
            (Block::Flex(body), _) => {
                let first = self.surfaces.members()[member].points.start;
                let axes = rotation(body.angle());
                let ends = self.motion.ends_mut(&self.surfaces, member);
                for (slot, end) in ends.iter_mut().enumerate() {
                    let own = &self.points[first + slot];
                    if let Point::Node(node) = own.point {
                        *end = own.beside(body.position(node), &axes);
                    }
                }
            }
            (Block::Rigid(body), MotionKind::Rigid) => {
                let end = body.current();
                let (shift, turn) = (end.centre - centre, end.angle - angle);
                self.motion
                    .move_rigid(&self.surfaces, member, centre, shift, turn);
            }
            _ => {}
        }
    }

    fn go(&mut self, part: f64, blocks: &[Block]) {
        self.surfaces.advance(&self.motion, part);
        for (base, block) in self.base.iter_mut().zip(blocks) {
            let (centre, angle) = (block.centre(), angle_of(block));
            if part >= 1.0 {
                base.place(centre, angle);
            } else {
                base.place(
                    base.centre + part * (centre - base.centre),
                    base.angle() + part * (angle - base.angle()),
                );
            }
            if let (Some(first), Block::Flex(body)) = (base.nodes, block) {
                let ends = body.positions();
                let nodes = &mut self.nodes[first..first + ends.len()];
                if part >= 1.0 {
                    nodes.copy_from_slice(ends);
                } else {
                    for (node, end) in nodes.iter_mut().zip(ends) {
                        *node += part * (end - *node);
                    }
                }
            }
        }
        // Points of rigid members stay on their bodies to the last digit.
        for (member, carrier) in self.carriers.iter().enumerate() {
            let own = &self.surfaces.members()[member];
            if own.kind != MotionKind::Rigid {
                continue;
            }
            let (points, base) = (own.points.clone(), self.base[carrier.block]);
            let placed = self.surfaces.points_mut(member).iter_mut();
            for (place, own) in placed.zip(&self.points[points]) {
                if let Point::Arm(arm) = own.point {
                    *place = base.point(arm);
                }
            }
        }
    }
}

fn angle_of(block: &Block) -> f64 {
    match block {
        Block::Flex(body) => body.angle(),
        Block::Rigid(body) => body.current().angle,
    }
}
