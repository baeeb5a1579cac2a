//! Plane geometry of the judge: where things are, by sums of its own.

use super::*;

/// A point, or a vector (m).
pub type Point = [f64; 2];

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn distance_to_segment(p: Point, [a, b]: [Point; 2]) -> f64 {
    let (along, to) = (minus(b, a), minus(p, a));
    let square = along[0] * along[0] + along[1] * along[1];
    let part = ((to[0] * along[0] + to[1] * along[1]) / square).clamp(0.0, 1.0);
    (to[0] - part * along[0]).hypot(to[1] - part * along[1])
}

fn sides(corners: &[Point]) -> impl Iterator<Item = [Point; 2]> {
    let n = corners.len();
    (0..n).map(move |i| [corners[i], corners[(i + 1) % n]])
}

/// A box that holds points: lowest x and y, highest x and y (m).
#[derive(Clone, Copy, Debug)]
pub struct Bounds([f64; 4]);

impl Bounds {
    fn of(points: impl IntoIterator<Item = Point>, margin: f64) -> Self {
        let none = [f64::MAX, f64::MAX, f64::MIN, f64::MIN];
        let [left, low, right, high] = points.into_iter().fold(none, |[l, b, r, t], [x, y]| {
            [l.min(x), b.min(y), r.max(x), t.max(y)]
        });
        Self([left - margin, low - margin, right + margin, high + margin])
    }

    fn meets(&self, other: &Self) -> bool {
        let (own, other) = (self.0, other.0);
        own[0] <= other[2] && other[0] <= own[2] && own[1] <= other[3] && other[1] <= own[3]
    }

    fn holds(&self, [x, y]: Point) -> bool {
        self.meets(&Self([x, y, x, y]))
    }
}

/// The surface of a flexible body: closed loops of straight edges.
pub struct Outline {
    loops: Vec<Vec<Point>>,
    bounds: Bounds,
}

impl Outline {
    pub fn of(body: &FlexBody) -> Self {
        let boundary = body.mesh().boundary();
        let places = |nodes: &[usize]| nodes.iter().map(|&node| body.position(node)).collect();
        let loops = boundary.loops().iter().map(|around| places(around.nodes()));
        let loops: Vec<Vec<Point>> = loops.collect();
        let bounds = Bounds::of(loops.iter().flatten().copied(), 0.0);
        Self { loops, bounds }
    }

    pub fn nodes(&self) -> impl Iterator<Item = Point> {
        self.loops.iter().flatten().copied()
    }

    fn sides(&self) -> impl Iterator<Item = [Point; 2]> {
        self.loops.iter().flat_map(|around| sides(around))
    }

    fn holds(&self, [x, y]: Point) -> bool {
        let is_crossed = |&[a, b]: &[Point; 2]| {
            (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        };
        self.sides().filter(is_crossed).count() % 2 == 1
    }

    fn distance(&self, p: Point) -> f64 {
        let distances = self.sides().map(|side| distance_to_segment(p, side));
        distances.fold(f64::MAX, f64::min)
    }

    /// How deep the deepest node of either is in the other (m).
    pub fn depth_in(&self, other: &Self) -> f64 {
        if !self.bounds.meets(&other.bounds) {
            return 0.0;
        }
        let deepest = |nodes: &Self, around: &Self| {
            let inside = nodes.nodes().filter(|&node| around.bounds.holds(node));
            let inside = inside.filter(|&node| around.holds(node));
            inside.map(|node| around.distance(node)).fold(0.0, f64::max)
        };
        deepest(self, other).max(deepest(other, self))
    }
}

/// What a rigid collider is, in the world.
pub enum Figure {
    /// Convex corners, counter-clockwise, grown by a radius.
    Convex {
        corners: Vec<Point>,
        radius: f64,
        bounds: Bounds,
    },
    /// Segments that run on beside each other, the solid ground below them.
    Ground(Vec<[Point; 2]>),
}

impl Figure {
    /// # Panics
    /// If the shape is none of those that the scenes are made of.
    pub fn of(collider: &Collider) -> Self {
        let pose = collider.position();
        let place = |at: Vector| {
            let (at, turn) = ([at.x, at.y].map(f64::from), pose.rotation);
            let [cos, sin] = [turn.re, turn.im].map(f64::from);
            let offset = [pose.translation.x, pose.translation.y].map(f64::from);
            [
                offset[0] + cos * at[0] - sin * at[1],
                offset[1] + sin * at[0] + cos * at[1],
            ]
        };
        let shape = collider.shape();
        let convex = |corners: Vec<Vector>, radius: Real| {
            let corners: Vec<Point> = corners.into_iter().map(place).collect();
            let radius = f64::from(radius);
            let bounds = Bounds::of(corners.iter().copied(), radius);
            Self::Convex {
                corners,
                radius,
                bounds,
            }
        };
        if let Some(ball) = shape.as_ball() {
            return convex(vec![Vector::ZERO], ball.radius);
        }
        if let Some(cuboid) = shape.as_cuboid() {
            let Vector { x, y } = cuboid.half_extents;
            let corners = [(-x, -y), (x, -y), (x, y), (-x, y)];
            return convex(corners.map(|(x, y)| Vector::new(x, y)).to_vec(), 0.0);
        }
        if let Some(polygon) = shape.as_convex_polygon() {
            return convex(polygon.points().to_vec(), 0.0);
        }
        let segments: Vec<_> = if let Some(polyline) = shape.as_polyline() {
            polyline.segments().collect()
        } else if let Some(heights) = shape.as_heightfield() {
            heights.segments().collect()
        } else {
            panic!("the judge does not know a {:?}", shape.shape_type());
        };
        let segments = segments.into_iter().map(|segment| {
            let [a, b] = [place(segment.a), place(segment.b)];
            if a[0] < b[0] { [a, b] } else { [b, a] }
        });
        Self::Ground(segments.collect())
    }

    /// Depth of a point below the surface, negative outside a convex figure (m).
    fn depth(&self, p: Point) -> f64 {
        match self {
            Self::Convex {
                corners, radius, ..
            } => match corners[..] {
                [centre] => radius - (p[0] - centre[0]).hypot(p[1] - centre[1]),
                _ => {
                    let depths = sides(corners).map(|[a, b]| {
                        let along = minus(b, a);
                        cross(along, minus(p, a)) / along[0].hypot(along[1])
                    });
                    radius + depths.fold(f64::MAX, f64::min)
                }
            },
            Self::Ground(segments) => {
                let is_below = |&&[a, b]: &&[Point; 2]| {
                    let part = (p[0] - a[0]) / (b[0] - a[0]);
                    (0.0..=1.0).contains(&part) && p[1] < a[1] + part * (b[1] - a[1])
                };
                if segments.iter().any(|segment| is_below(&segment)) {
                    let all = segments
                        .iter()
                        .map(|&segment| distance_to_segment(p, segment));
                    all.fold(f64::MAX, f64::min)
                } else {
                    0.0
                }
            }
        }
    }

    /// How deep a flexible body's nodes are in this figure, or its corners in the body (m).
    pub fn depth_of_outline(&self, outline: &Outline) -> f64 {
        let deepest = |corner: Point, radius: f64| {
            let distance = outline.distance(corner);
            if outline.holds(corner) {
                distance + radius
            } else {
                radius - distance
            }
        };
        let nodes = outline.nodes().map(|node| self.depth(node));
        match self {
            Self::Convex {
                corners,
                radius,
                bounds,
            } => {
                if !bounds.meets(&outline.bounds) {
                    return 0.0;
                }
                let corners = corners.iter().map(|&corner| deepest(corner, *radius));
                nodes.chain(corners).fold(0.0, f64::max)
            }
            Self::Ground(segments) => {
                let near = segments.iter().flatten();
                let near = near.filter(|&&corner| outline.bounds.holds(corner));
                let corners = near.map(|&corner| deepest(corner, 0.0));
                nodes.chain(corners).fold(0.0, f64::max)
            }
        }
    }

    /// How deep the corners of a convex figure are below this ground (m).
    pub fn depth_of_figure(&self, other: &Self) -> f64 {
        let (
            Self::Ground(segments),
            Self::Convex {
                corners, radius, ..
            },
        ) = (self, other)
        else {
            return 0.0;
        };
        let depths = corners.iter().map(|&corner| {
            let depth = self.depth(corner);
            let distance = segments
                .iter()
                .map(|&side| distance_to_segment(corner, side));
            if depth > 0.0 {
                depth + radius
            } else {
                radius - distance.fold(f64::MAX, f64::min)
            }
        });
        depths.fold(0.0, f64::max)
    }

    /// Smallest width of a convex figure (m).
    pub fn thickness(&self) -> f64 {
        let Self::Convex {
            corners, radius, ..
        } = self
        else {
            return f64::MAX;
        };
        let widths = sides(corners).map(|[a, b]| {
            let along = minus(b, a);
            let heights = corners.iter().map(|&corner| {
                cross(along, minus(corner, a)) / along[0].hypot(along[1]).max(f64::MIN_POSITIVE)
            });
            heights.fold(0.0, f64::max)
        });
        let width = widths.fold(f64::MAX, f64::min);
        2.0 * radius + if corners.len() < 3 { 0.0 } else { width }
    }
}

/// Signed distance of a point from the outline of a flexible body, negative inside (m).
pub fn from_outline(body: &FlexBody, point: [f64; 2]) -> f64 {
    let (mut nearest, mut is_inside) = (f64::INFINITY, false);
    for &[a, b] in body.mesh().boundary().segments() {
        let ([x0, y0], [x1, y1]) = (body.position(a), body.position(b));
        let (along, off) = ([x1 - x0, y1 - y0], [point[0] - x0, point[1] - y0]);
        let length = along[0].hypot(along[1]);
        let share = ((off[0] * along[0] + off[1] * along[1]) / length.powi(2)).clamp(0.0, 1.0);
        nearest = nearest.min((off[0] - share * along[0]).hypot(off[1] - share * along[1]));
        if (y0 > point[1]) != (y1 > point[1]) && off[0] < along[0] * off[1] / along[1] {
            is_inside = !is_inside;
        }
    }
    if is_inside { -nearest } else { nearest }
}
