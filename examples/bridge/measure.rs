//! Checks that do not trust the library: overlaps from geometry alone, and beam theory.

use super::scene::{DECK, GRAVITY, SPAN, STEEL, Scene};
use foil2d::pipeline::Participant;
use foil2d::rapier::prelude::*;

/// A rigid shape where it is, in `f64`.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// Centre (m) and angle (rad).
    pub centre: [f64; 2],
    pub angle: f64,
    pub shape: Outline,
}

/// The shapes of this scene.
#[derive(Clone, Copy, Debug)]
pub enum Outline {
    /// Half extents (m).
    Box([f64; 2]),
    /// Radius (m).
    Disc(f64),
}

impl Placed {
    /// A collider of the scene.
    pub fn new(collider: &Collider) -> Self {
        let pose = collider.position();
        let (cos, sin) = (f64::from(pose.rotation.re), f64::from(pose.rotation.im));
        let shape = match (collider.shape().as_cuboid(), collider.shape().as_ball()) {
            (Some(cuboid), _) => Outline::Box([
                f64::from(cuboid.half_extents.x),
                f64::from(cuboid.half_extents.y),
            ]),
            (_, Some(ball)) => Outline::Disc(f64::from(ball.radius)),
            _ => panic!("the scene has boxes and discs only"),
        };
        Self {
            centre: [f64::from(pose.translation.x), f64::from(pose.translation.y)],
            angle: sin.atan2(cos),
            shape,
        }
    }

    /// Corners of a box, counter-clockwise; none of a disc.
    pub fn corners(&self) -> Vec<[f64; 2]> {
        let Outline::Box([a, b]) = self.shape else {
            return Vec::new();
        };
        let (sin, cos) = self.angle.sin_cos();
        let place = |[x, y]: [f64; 2]| {
            [
                self.centre[0] + cos * x - sin * y,
                self.centre[1] + sin * x + cos * y,
            ]
        };
        [[-a, -b], [a, -b], [a, b], [-a, b]].map(place).to_vec()
    }

    /// How deep a point lies inside (m), negative outside.
    fn depth(&self, point: [f64; 2]) -> f64 {
        let (dx, dy) = (point[0] - self.centre[0], point[1] - self.centre[1]);
        match self.shape {
            Outline::Disc(radius) => radius - dx.hypot(dy),
            Outline::Box([a, b]) => {
                let (sin, cos) = self.angle.sin_cos();
                let (x, y) = (cos * dx + sin * dy, cos * dy - sin * dx);
                (a - x.abs()).min(b - y.abs())
            }
        }
    }

    /// Overlap with another shape (m), negative if apart; a lower bound of the gap's size in that case.
    fn overlap(&self, other: &Self) -> f64 {
        match (self.shape, other.shape) {
            (Outline::Disc(one), Outline::Disc(two)) => {
                let (dx, dy) = (
                    self.centre[0] - other.centre[0],
                    self.centre[1] - other.centre[1],
                );
                one + two - dx.hypot(dy)
            }
            (Outline::Disc(radius), Outline::Box(_)) => radius - other.distance(self.centre),
            (Outline::Box(_), Outline::Disc(_)) => other.overlap(self),
            (Outline::Box(_), Outline::Box(_)) => {
                let of = |inner: &Self, outer: &Self| {
                    let corners = inner.corners().into_iter();
                    corners
                        .map(|corner| outer.depth(corner))
                        .fold(f64::MIN, f64::max)
                };
                of(self, other).max(of(other, self))
            }
        }
    }

    /// Distance of a point from a box (m), negative inside.
    fn distance(&self, point: [f64; 2]) -> f64 {
        let depth = self.depth(point);
        let Outline::Box([a, b]) = self.shape else {
            return -depth;
        };
        if depth > 0.0 {
            return -depth;
        }
        let (sin, cos) = self.angle.sin_cos();
        let (dx, dy) = (point[0] - self.centre[0], point[1] - self.centre[1]);
        let (x, y) = (cos * dx + sin * dy, cos * dy - sin * dx);
        (x.abs() - a).max(0.0).hypot((y.abs() - b).max(0.0))
    }
}

/// Largest overlap of any two bodies, from where rapier and the deck say they are (m).
pub fn largest_overlap(scene: &Scene) -> f64 {
    let rigid: Vec<(Option<RigidBodyHandle>, Placed)> = scene
        .world
        .colliders
        .iter()
        .filter(|(handle, _)| *handle != scene.deck().collider_handle())
        .map(|(_, collider)| (collider.parent(), Placed::new(collider)))
        .collect();
    let outline: Vec<[f64; 2]> = {
        let deck = scene.deck();
        let nodes = deck.mesh().boundary().nodes().iter();
        nodes.map(|&node| deck.position(node)).collect()
    };
    let mut worst = 0.0f64;
    for (index, (parent, shape)) in rigid.iter().enumerate() {
        worst = worst.max(overlap_with_outline(&outline, shape));
        for (other_parent, other) in &rigid[..index] {
            if parent != other_parent {
                worst = worst.max(shape.overlap(other));
            }
        }
    }
    worst
}

/// Overlap of a shape with a closed outline (m), negative if apart.
fn overlap_with_outline(outline: &[[f64; 2]], shape: &Placed) -> f64 {
    let nodes = outline.iter().map(|&node| shape.depth(node));
    let mut worst = nodes.fold(f64::MIN, f64::max);
    let signed = |point: [f64; 2]| {
        let (mut distance, mut is_inside) = (f64::MAX, false);
        for (index, &b) in outline.iter().enumerate() {
            let a = outline[(index + outline.len() - 1) % outline.len()];
            distance = distance.min(distance_to_segment(point, a, b));
            let crosses = (a[1] > point[1]) != (b[1] > point[1]);
            if crosses && point[0] < a[0] + (point[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) {
                is_inside = !is_inside;
            }
        }
        if is_inside { distance } else { -distance }
    };
    match shape.shape {
        Outline::Disc(radius) => worst = worst.max(radius + signed(shape.centre)),
        Outline::Box(_) => {
            for corner in shape.corners() {
                worst = worst.max(signed(corner));
            }
        }
    }
    worst
}

fn distance_to_segment([x, y]: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let along = ((x - a[0]) * dx + (y - a[1]) * dy) / (dx * dx + dy * dy);
    let along = along.clamp(0.0, 1.0);
    (x - a[0] - along * dx).hypot(y - a[1] - along * dy)
}

/// Mid-span deflection (m) and bending stress (Pa).
#[derive(Clone, Copy, Debug)]
pub struct Bending {
    pub deflection: f64,
    pub stress: f64,
}

/// Timoshenko's beam on two supports, under its weight and the forces that stand on it now.
///
/// With span L, overhang c, load per length w, a force P at the distance b from the nearer support:
/// `δ = 5wL⁴/384EI - wc²L²/16EI + wL²/8κGA + Σ P (b(3L² - 4b²)/48EI + b/2κGA)`,
/// `M = wL²/8 - wc²/2 + Σ P b/2`, `σ = M h/2I`.
pub fn beam_theory(scene: &Scene) -> Bending {
    let [young, poisson, density, _] = STEEL;
    let [length, depth, width] = DECK;
    let area = depth * width;
    let second_moment = width * depth.powi(3) / 12.0;
    let bending = young * second_moment;
    let shear = 5.0 / 6.0 * young / (2.0 * (1.0 + poisson)) * area;
    let weight = density * GRAVITY * area;
    let overhang = 0.5 * (length - SPAN);
    let mut deflection = 5.0 * weight * SPAN.powi(4) / (384.0 * bending)
        - weight * (overhang * SPAN).powi(2) / (16.0 * bending)
        + weight * SPAN * SPAN / (8.0 * shear);
    let mut moment = weight * SPAN * SPAN / 8.0 - weight * overhang * overhang / 2.0;
    for (x, force) in loads(scene) {
        let b = 0.5 * SPAN - x.abs();
        deflection +=
            force * (b * (3.0 * SPAN * SPAN - 4.0 * b * b) / (48.0 * bending) + b / (2.0 * shear));
        moment += force * b / 2.0;
    }
    Bending {
        deflection,
        stress: moment * depth / (2.0 * second_moment),
    }
}

/// Place (m) and downward force (N) of what presses on the top of the deck.
fn loads(scene: &Scene) -> Vec<(f64, f64)> {
    let deck = Participant::Flex(scene.deck);
    let contacts = scene.flex.report().contacts().iter();
    contacts
        .filter_map(|contact| {
            let sign = match (contact.contactor == deck, contact.target == deck) {
                (true, false) => -1.0,
                (false, true) => 1.0,
                _ => return None,
            };
            let [nx, ny] = contact.normal;
            let up = contact.normal_force * ny + contact.tangential_force * nx;
            // Bearings push up from below.
            (sign * up > 0.0).then_some((contact.position[0], sign * up))
        })
        .collect()
}

/// What the finite elements say: the axis at mid-span against the axis above the bearings, and the stress at the
/// lower edge.
pub fn finite_elements(scene: &Scene) -> Result<Bending, Box<dyn std::error::Error>> {
    let deck = scene.deck();
    let nearest = |x: f64, y: f64| {
        let rest = deck.model().rest_positions();
        let distance = |node: usize| (rest[2 * node] - x).hypot(rest[2 * node + 1] - y);
        (0..deck.n_nodes())
            .min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
            .expect("the deck has nodes")
    };
    let axis = |x: f64| deck.displacement(nearest(x, 0.5 * DECK[1]))[1];
    let supports = 0.5 * (axis(-0.5 * SPAN) + axis(0.5 * SPAN));
    Ok(Bending {
        deflection: supports - axis(0.0),
        stress: deck.stress()?[nearest(0.0, 0.0)].xx,
    })
}
