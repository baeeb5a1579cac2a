//! Contact geometry: signed distances and contacts of rounded convex parts against independent minimisations, and the
//! situations that make contact solvers jump, tunnel or divide by zero.

use foil2d::constraint::geometry::{
    ConvexPart, FaceOrVertex, Feature, PairContacts, PairReference, Pose2, SegmentRegion,
    polygon_pair, segment_query, separation,
};
use foil2d::math::{Vec2, cross, perp};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn v(x: f64, y: f64) -> Vec2 {
    Vec2::new(x, y)
}

/// A box of half extents `hx`, `hy` about the origin: faces bottom, right, top, left.
fn cuboid(hx: f64, hy: f64, radius: f64) -> ConvexPart {
    ConvexPart::polygon(vec![v(-hx, -hy), v(hx, -hy), v(hx, hy), v(-hx, hy)], radius)
}

fn at(x: f64, y: f64, angle: f64) -> Pose2 {
    Pose2::new(v(x, y), angle)
}

fn mirrored(part: &ConvexPart) -> ConvexPart {
    let vertices = part.vertices().iter().rev().map(|p| v(-p.x, p.y));
    ConvexPart::new(vertices.collect(), part.radius())
}

fn moved(part: &ConvexPart, pose: &Pose2) -> ConvexPart {
    let vertices = part.vertices().iter().map(|p| pose.transform(*p));
    ConvexPart::new(vertices.collect(), part.radius())
}

prop_compose! {
    /// Vertices on an ellipse, at random angles, somewhere near the origin.
    fn polygon_vertices()(
        gaps in prop::collection::vec(0.2..1.0, 3..9),
        axes in (0.3..1.5, 0.3..1.5),
        shift in (-1.0..1.0, -1.0..1.0),
        turn in 0.0..TAU,
    ) -> Vec<Vec2> {
        let sum: f64 = gaps.iter().sum();
        let mut angle = turn;
        gaps.iter().map(|gap| {
            angle += gap / sum * TAU;
            v(axes.0 * angle.cos() + shift.0, axes.1 * angle.sin() + shift.1)
        }).collect()
    }
}

/// Balls, capsules, segments and rounded polygons.
fn parts() -> impl Strategy<Value = ConvexPart> {
    let vertices = (polygon_vertices(), 0_usize..6).prop_map(|(mut vertices, kind)| {
        vertices.truncate(if kind < 2 { kind + 1 } else { usize::MAX });
        vertices
    });
    let radius = prop_oneof![Just(0.0), 0.0..0.4];
    (vertices, radius).prop_map(|(vertices, radius)| ConvexPart::new(vertices, radius))
}

fn points(reach: f64) -> impl Strategy<Value = Vec2> {
    (-reach..reach, -reach..reach).prop_map(|(x, y)| v(x, y))
}

fn poses() -> impl Strategy<Value = Pose2> {
    (points(2.0), 0.0..TAU).prop_map(|(translation, angle)| Pose2::new(translation, angle))
}

/// Smallest value of a unimodal function on an interval, by trisection.
fn minimum(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..100 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if f(a) < f(b) { high = b } else { low = a }
    }
    f(0.5 * (low + high))
}

/// Signed distance of a point by searching the boundary of the core, with the sign from a ray's crossings.
fn searched_distance(part: &ConvexPart, point: Vec2) -> f64 {
    let vertices = part.vertices();
    let n = vertices.len();
    let edges = || (0..n).map(|i| (vertices[i], vertices[(i + 1) % n]));
    let distance = edges()
        .map(|(a, b)| minimum(|t| (a + t * (b - a) - point).norm(), 0.0, 1.0))
        .fold(f64::INFINITY, f64::min);
    let crossings = edges().filter(|(a, b)| {
        (a.y > point.y) != (b.y > point.y)
            && a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x) > point.x
    });
    let is_inside = n > 2 && crossings.count() % 2 == 1;
    (if is_inside { -distance } else { distance }) - part.radius()
}

/// Signed distance of two parts, `max over directions u of min u·b - max u·a`, by searching all directions: the gap of
/// separate parts and minus the least shift that separates overlapping ones.
fn searched_pair_distance(a: &ConvexPart, pose_a: &Pose2, b: &ConvexPart, pose_b: &Pose2) -> f64 {
    let gap = |angle: f64| {
        let u = v(angle.cos(), angle.sin());
        let along = |part: &ConvexPart, pose: &Pose2| -> Vec<f64> {
            let heights = part.vertices().iter().map(|p| u.dot(&pose.transform(*p)));
            heights.collect()
        };
        let low = along(b, pose_b).into_iter().fold(f64::INFINITY, f64::min);
        let high = along(a, pose_a)
            .into_iter()
            .fold(f64::NEG_INFINITY, f64::max);
        low - high - a.radius() - b.radius()
    };
    let n = 1440;
    let step = TAU / n as f64;
    let samples: Vec<f64> = (0..n).map(|i| gap(i as f64 * step)).collect();
    (0..n)
        .filter(|i| samples[*i] >= samples[(i + 1) % n].max(samples[(i + n - 1) % n]))
        .map(|i| i as f64 * step)
        .map(|angle| -minimum(|x| -gap(x), angle - step, angle + step))
        .fold(f64::NEG_INFINITY, f64::max)
}

/// World position of the contact point and of the feature's first core point.
fn world_points(contacts: &PairContacts, i: usize, poses: [&Pose2; 2]) -> (Vec2, Vec2) {
    let contact = contacts.as_slice()[i];
    let [target, source] = if contact.point_on_b {
        poses
    } else {
        [poses[1], poses[0]]
    };
    let face = match contact.face {
        FaceOrVertex::Face([start, _]) => start,
        FaceOrVertex::Vertex(vertex) => vertex,
    };
    (source.transform(contact.point), target.transform(face))
}

fn nearest(contacts: &PairContacts) -> f64 {
    contacts
        .iter()
        .map(|contact| contact.distance)
        .fold(f64::INFINITY, f64::min)
}

/// The normal of a contact from `a` to `b`.
fn from_a_to_b(contacts: &PairContacts, i: usize) -> Vec2 {
    let contact = contacts.as_slice()[i];
    if contact.point_on_b {
        contact.normal
    } else {
        -contact.normal
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..Default::default() })]

    // Trisection finds the place to the square root of the rounding (1e-8), which is what it costs near distance 0.
    #[test]
    fn the_distance_is_the_smallest_over_the_surface(part in parts(), point in points(3.0)) {
        let found = separation(&part, point, None, None);
        prop_assert!((found.distance - searched_distance(&part, point)).abs() < 1e-7);
        prop_assert!((found.normal.norm() - 1.0).abs() < 1e-12);
        let surface = found.foot + part.radius() * found.normal;
        prop_assert!((surface + found.distance * found.normal - point).norm() < 1e-12);
    }

    // Central differences with h = 1e-6: truncation h^2/(6 d^2), below 2e-9 at d > 0.01; rounding 1e-16/h = 1e-10.
    #[test]
    fn the_gradient_of_the_distance_is_the_normal(part in parts(), point in points(3.0)) {
        let h = 1e-6;
        let found = separation(&part, point, None, None);
        let around = [v(h, 0.0), v(-h, 0.0), v(0.0, h), v(0.0, -h)]
            .map(|shift| separation(&part, point + shift, None, None));
        let is_smooth = around.iter().all(|other| other.feature == found.feature);
        prop_assume!(is_smooth && (found.distance + part.radius()).abs() > 0.01);
        let slope = v(around[0].distance - around[1].distance, around[2].distance - around[3].distance);
        prop_assert!((slope / (2.0 * h) - found.normal).norm() < 1e-7);
    }

    #[test]
    fn the_distance_moves_and_mirrors_with_the_part(part in parts(), point in points(3.0), pose in poses()) {
        let found = separation(&part, point, None, None);
        let turned = separation(&moved(&part, &pose), pose.transform(point), None, None);
        prop_assert!((turned.distance - found.distance).abs() < 1e-12);
        let mirror = separation(&mirrored(&part), v(-point.x, point.y), None, None);
        prop_assert!((mirror.distance - found.distance).abs() < 1e-12);
        // Inside, two faces may be equally near; a point this close to a tie has no definite normal.
        if found.distance + part.radius() > 1e-3 {
            prop_assert!((turned.normal - pose.rotate(found.normal)).norm() < 1e-9);
            prop_assert!((mirror.normal - v(-found.normal.x, found.normal.y)).norm() < 1e-9);
        }
    }

    // Whatever path a point takes from outside in one step, it is not reported outside if it crossed the core.
    #[test]
    fn no_straight_path_through_the_core_ends_outside(
        vertices in polygon_vertices(), start in points(4.0), inner in (0.2..0.8, 0.2..0.8), beyond in 1.0..3.0,
    ) {
        let part = ConvexPart::polygon(vertices, 0.0);
        prop_assume!(separation(&part, start, None, None).distance > 1e-6);
        let corners = part.vertices();
        let on_edge = corners[0] + inner.0 * (corners[1] - corners[0]);
        let through = on_edge + inner.1 * (corners[2] - on_edge);
        prop_assume!(separation(&part, through, None, None).distance < -0.01);
        let end = start + beyond * (through - start);
        let found = separation(&part, end, None, Some(start));
        prop_assert!(found.distance < 0.0, "{found:?}");
        prop_assert!(found.normal.dot(&(end - start)) < 0.0, "pushed onward: {found:?}");
    }

    // The search over directions resolves to the square of its angle error; kinks and close ties cost up to 1e-6.
    #[test]
    fn the_nearest_contact_is_the_distance_of_the_pair(
        a in parts(), b in parts(), pose_a in poses(), pose_b in poses(),
    ) {
        let contacts = polygon_pair(&a, &pose_a, &b, &pose_b, 20.0, None);
        let expected = searched_pair_distance(&a, &pose_a, &b, &pose_b);
        prop_assert!(!contacts.is_empty());
        prop_assert!((nearest(&contacts) - expected).abs() < 1e-6, "{expected} {contacts:?}");
        for (i, contact) in contacts.iter().enumerate() {
            let (point, face) = world_points(&contacts, i, [&pose_a, &pose_b]);
            let distance = contact.normal.dot(&(point - face)) - a.radius() - b.radius();
            prop_assert!((distance - contact.distance).abs() < 1e-12);
            prop_assert!((contact.normal.norm() - 1.0).abs() < 1e-12);
        }
    }

    // Aligned, coincident and touching features everywhere: ties must cost contacts nothing.
    #[test]
    fn aligned_parts_on_a_lattice_have_the_distance_of_the_pair(
        kinds in (0_usize..5, 0_usize..5), cells in (-4_i32..5, -4_i32..5), turns in (0_i32..8, 0_i32..8),
        radius in prop_oneof![Just(0.0), Just(0.25)],
    ) {
        let part = |kind: usize| match kind {
            0 => ConvexPart::ball(v(0.0, 0.0), 0.5),
            1 => ConvexPart::segment(v(-0.5, 0.0), v(0.5, 0.0)),
            2 => ConvexPart::capsule(v(-1.0, 0.0), v(1.0, 0.0), radius),
            3 => cuboid(0.5, 0.5, radius),
            _ => ConvexPart::polygon(vec![v(-0.5, -0.5), v(1.0, -0.5), v(-0.5, 1.0)], radius),
        };
        let (a, b) = (part(kinds.0), part(kinds.1));
        let pose_a = at(0.0, 0.0, turns.0 as f64 * PI / 4.0);
        let pose_b = at(0.5 * cells.0 as f64, 0.5 * cells.1 as f64, turns.1 as f64 * PI / 4.0);
        let contacts = polygon_pair(&a, &pose_a, &b, &pose_b, 20.0, None);
        let expected = searched_pair_distance(&a, &pose_a, &b, &pose_b);
        prop_assert!((nearest(&contacts) - expected).abs() < 1e-6, "{expected} {contacts:?}");
    }

    #[test]
    fn a_shift_by_the_distance_along_the_normal_brings_the_parts_to_touch(
        a in parts(), b in parts(), pose_a in poses(), pose_b in poses(),
    ) {
        let contacts = polygon_pair(&a, &pose_a, &b, &pose_b, 20.0, None);
        let first = (0..contacts.len())
            .min_by(|i, j| contacts.as_slice()[*i].distance.total_cmp(&contacts.as_slice()[*j].distance));
        let normal = from_a_to_b(&contacts, first.unwrap());
        let touching = Pose2 { translation: pose_b.translation - nearest(&contacts) * normal, ..pose_b };
        let after = polygon_pair(&a, &pose_a, &b, &touching, 20.0, None);
        prop_assert!(nearest(&after).abs() < 1e-9, "{contacts:?} {after:?}");
    }

    #[test]
    fn swapping_the_parts_or_mirroring_the_scene_mirrors_the_contacts(
        a in parts(), b in parts(), pose_a in poses(), pose_b in poses(),
    ) {
        let contacts = polygon_pair(&a, &pose_a, &b, &pose_b, 20.0, None);
        // Overlapping cores may have several faces equally deep: then any of them will do.
        prop_assume!(nearest(&contacts) + a.radius() + b.radius() > 1e-6);
        let swapped = polygon_pair(&b, &pose_b, &a, &pose_a, 20.0, None);
        prop_assert!(agree(&contacts, &swapped, |normal| -normal), "{contacts:?} {swapped:?}");
        let mirror = |p: &Pose2| Pose2 {
            translation: v(-p.translation.x, p.translation.y), cos: p.cos, sin: -p.sin,
        };
        let mirrored = polygon_pair(
            &mirrored(&a), &mirror(&pose_a), &mirrored(&b), &mirror(&pose_b), 20.0, None,
        );
        let flip = |normal: Vec2| v(-normal.x, normal.y);
        prop_assert!(agree(&contacts, &mirrored, flip), "{contacts:?} {mirrored:?}");
    }

    #[test]
    fn the_pair_moves_with_its_poses(
        a in parts(), b in parts(), pose_a in poses(), pose_b in poses(), scene in poses(),
    ) {
        let moved = |pose: &Pose2| Pose2 {
            translation: scene.transform(pose.translation),
            cos: scene.cos * pose.cos - scene.sin * pose.sin,
            sin: scene.sin * pose.cos + scene.cos * pose.sin,
        };
        let contacts = polygon_pair(&a, &pose_a, &b, &pose_b, 20.0, None);
        prop_assume!(nearest(&contacts) + a.radius() + b.radius() > 1e-6);
        let other = polygon_pair(&a, &moved(&pose_a), &b, &moved(&pose_b), 20.0, None);
        prop_assert!(agree(&contacts, &other, |normal| scene.rotate(normal)));
    }

    #[test]
    fn a_part_fits_its_bounds(part in parts(), pose in poses(), direction in 0.0..TAU) {
        let u = v(direction.cos(), direction.sin());
        let [min, max] = part.aabb(&pose);
        for vertex in part.vertices() {
            let surface = vertex + part.radius() * u;
            prop_assert!(surface.norm() <= part.bounding_radius() + 1e-12);
            let world = pose.transform(surface);
            prop_assert!((0..2).all(|i| world[i] >= min[i] - 1e-12 && world[i] <= max[i] + 1e-12));
        }
    }

    #[test]
    fn a_boundary_segment_measures_as_the_part_does(
        a in points(2.0), b in points(2.0), point in points(2.0),
    ) {
        prop_assume!((b - a).norm() > 0.1);
        let query = segment_query(point, a, b);
        let foot = a + query.xi * (b - a);
        let expected = searched_distance(&ConvexPart::segment(a, b), point);
        prop_assert!(((point - foot).norm() - expected).abs() < 1e-7);
        prop_assert!(cross(b - a, query.normal) < 0.0, "outward is to the right");
        match query.region {
            SegmentRegion::Interior => {
                prop_assert_eq!(query.xi, query.xi_unclamped);
                prop_assert!((foot + query.gap * query.normal - point).norm() < 1e-12);
            }
            SegmentRegion::Vertex { end, distance, direction } => {
                prop_assert_eq!(query.xi, end as f64);
                prop_assert!((foot + distance * direction - point).norm() < 1e-12);
            }
        }
    }
}

/// Whether two pairs have the same contacts, up to a map of the normals from a to b, in any order.
fn agree(one: &PairContacts, two: &PairContacts, map: impl Fn(Vec2) -> Vec2) -> bool {
    let is_same = |i: usize, j: usize| {
        (map(from_a_to_b(one, i)) - from_a_to_b(two, j)).norm() < 1e-6
            && (one.as_slice()[i].distance - two.as_slice()[j].distance).abs() < 1e-9
    };
    one.len() == two.len() && (0..one.len()).all(|i| (0..two.len()).any(|j| is_same(i, j)))
}

// ------------------------------------------------------------------------------------------------ point against part

#[test]
fn distance_and_normal_are_continuous_around_a_rounded_triangle() {
    let part = ConvexPart::polygon(vec![v(0.0, 0.0), v(2.0, 0.0), v(0.5, 1.0)], 0.1);
    let n = 20_000;
    let path = |i: usize| {
        let angle = TAU * i as f64 / n as f64;
        v(0.8, 0.35) + 1.8 * v(angle.cos(), angle.sin())
    };
    let mut last = separation(&part, path(0), None, None);
    let mut n_changes = 0;
    for i in 1..=n {
        let found = separation(&part, path(i), Some(last.feature), Some(path(i - 1)));
        let step = (path(i) - path(i - 1)).norm();
        // The distance has slope 1, and the normal turns by at most the step over the distance from the core.
        assert!((found.distance - last.distance).abs() <= step * (1.0 + 1e-9));
        let turn = (found.normal - last.normal).norm();
        assert!(
            turn <= step / (found.distance + 0.1) * 1.001,
            "jump of the normal at {i}"
        );
        n_changes += usize::from(found.feature != last.feature);
        last = found;
    }
    assert_eq!(
        n_changes, 6,
        "three faces and three vertices, each entered once"
    );
}

#[test]
fn a_point_inside_is_measured_to_the_face_it_came_in_by() {
    let part = cuboid(0.5, 0.5, 0.0);
    let (start, point) = (v(0.49, 0.501), v(0.495, 0.45));
    let nearest = separation(&part, point, None, None);
    assert_eq!(
        nearest.feature,
        Feature::Face(1),
        "the right face is nearer"
    );
    let found = separation(&part, point, None, Some(start));
    assert_eq!(
        found.feature,
        Feature::Face(2),
        "but the point came through the top"
    );
    assert!((found.distance + 0.05).abs() < 1e-15);
    // Resting with a little penetration counts as outside of the top only.
    let resting = separation(&part, point, None, Some(v(0.49, 0.4999)));
    assert_eq!(resting.feature, Feature::Face(2));
}

#[test]
fn a_point_deep_inside_leaves_by_its_reference_face() {
    let plate = cuboid(1.0, 0.05, 0.0);
    let (start, point) = (v(0.3, -0.01), v(0.3, -0.02));
    let found = separation(&plate, point, Some(Feature::Face(2)), Some(start));
    assert_eq!(found.feature, Feature::Face(2));
    assert!((found.distance + 0.07).abs() < 1e-15);
    let through = separation(&plate, v(0.3, -0.06), Some(Feature::Face(2)), Some(start));
    assert!(
        (through.distance + 0.11).abs() < 1e-15,
        "still behind the top once it has left below"
    );
}

#[test]
fn a_point_that_crossed_a_thin_part_is_behind_its_entry_face() {
    let (above, below) = (v(0.3, 0.7), v(0.4, -0.6));
    let plate = cuboid(1.0, 0.01, 0.02);
    let found = separation(&plate, below, None, Some(above));
    assert_eq!(
        (found.feature, found.normal),
        (Feature::Face(2), v(0.0, 1.0))
    );
    assert!((found.distance + 0.63).abs() < 1e-15);
    for radius in [0.0, 0.02] {
        let rod = ConvexPart::capsule(v(-1.0, 0.0), v(1.0, 0.0), radius);
        let down = separation(&rod, below, None, Some(above));
        assert_eq!((down.feature, down.normal), (Feature::Face(0), v(0.0, 1.0)));
        assert!((down.distance + 0.6 + radius).abs() < 1e-15);
        let up = separation(&rod, above, Some(Feature::Face(0)), Some(below));
        assert_eq!((up.feature, up.normal), (Feature::Face(1), v(0.0, -1.0)));
        // Around the end there is nothing in the way.
        let around = separation(
            &rod,
            v(0.95, -0.1),
            Some(Feature::Face(0)),
            Some(v(1.2, 0.1)),
        );
        assert_eq!(
            (around.feature, around.normal),
            (Feature::Face(1), v(0.0, -1.0))
        );
        assert!((around.distance - 0.1 + radius).abs() < 1e-15);
    }
}

#[test]
fn a_point_that_slides_past_a_corner_is_not_held() {
    let part = cuboid(0.5, 0.5, 0.0);
    // The chord cuts the corner by less than the rounding that contacts live with.
    let (start, point) = (v(0.4999, 0.5 - 1e-7), v(0.5001, 0.49995));
    let found = separation(&part, point, Some(Feature::Face(2)), Some(start));
    assert!(found.distance > 0.0 && found.normal.x > 0.99, "{found:?}");
}

#[test]
fn ties_at_a_corner_follow_the_reference_then_the_approach() {
    let part = cuboid(0.5, 0.5, 0.0);
    let corner = v(0.5, 0.5);
    for face in [1, 2] {
        let found = separation(&part, corner, Some(Feature::Face(face)), None);
        assert_eq!((found.feature, found.distance), (Feature::Face(face), 0.0));
        let inside = separation(
            &part,
            v(0.45, 0.45 + 1e-12),
            Some(Feature::Face(face)),
            None,
        );
        assert_eq!(inside.feature, Feature::Face(face));
    }
    let from_above = separation(&part, corner, None, Some(v(0.5, 0.6)));
    assert_eq!(from_above.feature, Feature::Face(2));
    let from_right = separation(&part, corner, None, Some(v(0.6, 0.5)));
    assert_eq!(from_right.feature, Feature::Face(1));
    let vertex = separation(&part, corner, Some(Feature::Vertex(2)), Some(v(0.6, 0.7)));
    assert_eq!(vertex.feature, Feature::Vertex(2));
    assert!(
        (vertex.normal - v(1.0, 2.0).normalize()).norm() < 1e-12,
        "towards the start"
    );
    // Outside, on the border between a face and a vertex, both are right and the last one stays.
    let border = v(0.5 + 1e-11, 0.7);
    for feature in [Feature::Face(2), Feature::Vertex(2)] {
        let found = separation(&part, border, Some(feature), None);
        assert_eq!(found.feature, feature);
        assert!((found.distance - 0.2).abs() < 1e-12 && (found.normal - v(0.0, 1.0)).norm() < 1e-9);
    }
}

#[test]
fn a_point_on_a_thin_segment_keeps_its_side() {
    let segment = ConvexPart::segment(v(-1.0, 0.0), v(1.0, 0.0));
    let on_it = v(0.2, 0.0);
    let left = separation(&segment, on_it, None, None);
    assert_eq!(
        (left.feature, left.normal),
        (Feature::Face(0), v(0.0, 1.0)),
        "left if undecided"
    );
    let referred = separation(&segment, on_it, Some(Feature::Face(1)), None);
    assert_eq!(referred.normal, v(0.0, -1.0));
    let started = separation(&segment, on_it, Some(Feature::Face(0)), Some(v(0.0, -0.5)));
    assert_eq!(
        started.normal,
        v(0.0, -1.0),
        "the start outranks the reference"
    );
    // A resting point whose start lies behind by rounding stays on its side.
    let resting = separation(
        &segment,
        v(0.2, -1e-6),
        Some(Feature::Face(0)),
        Some(v(0.2, -1e-9)),
    );
    assert_eq!((resting.normal, resting.distance), (v(0.0, 1.0), -1e-6));
}

#[test]
fn behind_a_one_sided_segment_is_inside() {
    let ground = ConvexPart::one_sided_segment(v(-1.0, 0.0), v(1.0, 0.0));
    assert!(!ground.is_two_sided());
    let below = separation(&ground, v(0.5, -0.3), None, Some(v(0.5, -0.4)));
    assert_eq!((below.normal, below.distance), (v(0.0, 1.0), -0.3));
    let pose = Pose2::identity();
    let boxed = cuboid(0.1, 0.1, 0.0);
    let sunk = polygon_pair(&ground, &pose, &boxed, &at(0.2, -0.15, 0.0), 0.01, None);
    assert_eq!(sunk.len(), 2);
    for (i, contact) in sunk.iter().enumerate() {
        assert_eq!(from_a_to_b(&sunk, i), v(0.0, 1.0));
        assert!(contact.distance < -0.04);
    }
    let beside = polygon_pair(&ground, &pose, &boxed, &at(1.2, -0.15, 0.0), 1.0, None);
    assert!(
        beside.is_empty(),
        "below and beyond its end there is nothing"
    );
    let above = polygon_pair(&boxed, &at(0.2, 0.15, 0.0), &ground, &pose, 0.1, None);
    assert_eq!(above.len(), 2);
    assert_eq!(from_a_to_b(&above, 0), v(0.0, -1.0));
}

#[test]
fn a_half_space_is_a_plane() {
    let plane = ConvexPart::half_space(v(3.0, 4.0));
    let found = separation(&plane, v(1.0, 1.0), None, None);
    assert!((found.distance - 1.4).abs() < 1e-15);
    assert_eq!(found.normal, v(0.6, 0.8));
    assert!(found.foot.dot(&found.normal).abs() < 1e-15);
    assert_eq!(plane.bounding_radius(), f64::INFINITY);
}

#[test]
fn coincident_points_never_give_a_nan() {
    let shapes = [
        ConvexPart::ball(v(0.3, 0.2), 0.0),
        ConvexPart::ball(v(0.3, 0.2), 0.5),
        ConvexPart::segment(v(0.0, 0.0), v(1.0, 0.0)),
        ConvexPart::one_sided_segment(v(0.0, 0.0), v(1.0, 0.0)),
        ConvexPart::capsule(v(0.0, 0.0), v(0.0, 1.0), 0.2),
        cuboid(0.5, 0.5, 0.0),
        cuboid(0.5, 0.5, 0.1),
        ConvexPart::half_space(v(0.0, 1.0)),
    ];
    let tiny = [
        v(0.0, 0.0),
        v(1e-300, 1e-300),
        v(-1e-16, 1e-16),
        v(0.0, -1e-13),
    ];
    for part in &shapes {
        let middles = (0..part.normals().len()).map(|i| 0.5 * (part.face(i)[0] + part.face(i)[1]));
        let spots: Vec<Vec2> = part.vertices().iter().copied().chain(middles).collect();
        for (spot, shift) in spots
            .iter()
            .flat_map(|spot| tiny.map(|shift| (*spot, shift)))
        {
            let references = [
                None,
                Some(Feature::Face(0)),
                Some(Feature::Vertex(1)),
                Some(Feature::Face(99)),
            ];
            for reference in references {
                for start in [
                    None,
                    Some(spot),
                    Some(spot + shift),
                    Some(1.2 * spot + v(1e-3, 2e-3)),
                ] {
                    let found = separation(part, spot + shift, reference, start);
                    assert!(
                        (found.normal.norm() - 1.0).abs() < 1e-12,
                        "{part:?} {found:?}"
                    );
                    let depth = found.distance + part.radius();
                    assert!(
                        depth.abs() < 1e-12 && found.foot.norm().is_finite(),
                        "{found:?}"
                    );
                    let foot_to_point = spot + shift - found.foot;
                    assert!(foot_to_point.norm() < 1e-12);
                }
            }
        }
        for other in &shapes {
            for shift in tiny {
                let pose = Pose2::new(shift, 0.0);
                for contact in &polygon_pair(part, &Pose2::identity(), other, &pose, 1.0, None) {
                    assert!(
                        (contact.normal.norm() - 1.0).abs() < 1e-12,
                        "{part:?} {other:?}"
                    );
                    assert!(contact.distance.is_finite() && contact.point.norm().is_finite());
                }
            }
        }
    }
    let query = segment_query(v(0.0, 0.0), v(0.0, 0.0), v(0.0, 0.0));
    assert!(query.normal.norm() == 1.0 && query.gap == 0.0);
}

#[test]
fn a_polygon_without_area_or_with_a_dent_becomes_a_sound_part() {
    let line = ConvexPart::polygon(vec![v(0.0, 0.0), v(2.0, 0.0), v(1.0, 0.0)], 0.1);
    assert_eq!(line.vertices(), [v(0.0, 0.0), v(2.0, 0.0)]);
    let spot = ConvexPart::capsule(v(1.0, 1.0), v(1.0, 1.0), 0.1);
    assert_eq!(spot.vertices().len(), 1);
    let dented = vec![
        v(0.0, 0.0),
        v(0.5, 1e-8),
        v(1.0, 0.0),
        v(1.0, 1.0),
        v(1.0, 1.0),
    ];
    assert_eq!(ConvexPart::polygon(dented, 0.0).vertices().len(), 3);
    let clockwise = ConvexPart::polygon(vec![v(0.0, 0.0), v(0.0, 1.0), v(1.0, 0.0)], 0.0);
    assert!(separation(&clockwise, v(0.2, 0.2), None, None).distance < 0.0);
}

// ------------------------------------------------------------------------------------------------- part against part

#[test]
fn equal_boxes_stacked_exactly_touch_on_their_horizontal_faces_only() {
    let part = cuboid(0.5, 0.5, 0.0);
    for angle in [0.0, 0.3, FRAC_PI_2, 2.0] {
        for (gap, slip) in [
            (0.0, 0.0),
            (1e-9, 0.0),
            (-1e-9, 1e-12),
            (1e-3, -1e-12),
            (-1e-3, 0.0),
        ] {
            let up = v(-f64::sin(angle), f64::cos(angle));
            let above = Pose2::new((1.0 + gap) * up - slip * perp(up), angle);
            let below = at(0.0, 0.0, angle);
            let contacts = polygon_pair(&part, &below, &part, &above, 0.01, None);
            assert_eq!(contacts.len(), 2, "angle {angle}, gap {gap}");
            for (i, contact) in contacts.iter().enumerate() {
                assert!((from_a_to_b(&contacts, i) - up).norm() < 1e-12);
                assert!((contact.distance - gap).abs() < 1e-14);
            }
            let [one, two] = [0, 1].map(|i| world_points(&contacts, i, [&below, &above]).0);
            assert!(
                ((one - two).norm() - 1.0).abs() < 1e-9,
                "the contacts span the whole face"
            );
            assert_ne!(contacts.as_slice()[0].id, contacts.as_slice()[1].id);
        }
    }
}

#[test]
fn a_box_that_overhangs_is_supported_from_its_end_to_the_edge_below() {
    // A box of width 1 over the right end (x = 2) of a box of width 4: contacts at x = 1.7 and x = 2.
    let (small, big) = (cuboid(0.5, 0.5, 0.0), cuboid(2.0, 0.25, 0.0));
    let (above, below) = (at(2.2, 0.749, 0.0), Pose2::identity());
    for is_swapped in [false, true] {
        let contacts = if is_swapped {
            polygon_pair(&small, &above, &big, &below, 0.01, None)
        } else {
            polygon_pair(&big, &below, &small, &above, 0.01, None)
        };
        let poses = if is_swapped {
            [&above, &below]
        } else {
            [&below, &above]
        };
        let mut places = [0, 1].map(|i| world_points(&contacts, i, poses).0.x);
        places.sort_by(f64::total_cmp);
        assert_eq!(contacts.len(), 2);
        assert!((places[0] - 1.7).abs() < 1e-12 && (places[1] - 2.0).abs() < 1e-12);
        for (i, contact) in contacts.iter().enumerate() {
            let up = if is_swapped { -1.0 } else { 1.0 };
            assert!((from_a_to_b(&contacts, i) - v(0.0, up)).norm() < 1e-12);
            assert!((contact.distance + 0.001).abs() < 1e-12);
        }
    }
}

#[test]
fn a_tilted_box_stands_on_its_corner() {
    let (ground, part) = (cuboid(5.0, 0.5, 0.0), cuboid(0.5, 0.5, 0.0));
    for angle in [0.2, PI / 4.0, 1.0] {
        // Height of the centre over the lowest corner.
        let reach = 0.5 * (f64::cos(angle) + f64::sin(angle));
        let pose = at(1.0, 0.5 + reach + 0.001, angle);
        let contacts = polygon_pair(&ground, &Pose2::identity(), &part, &pose, 0.05, None);
        assert_eq!(contacts.len(), 1, "the other corner is beyond the margin");
        let contact = contacts.as_slice()[0];
        assert!(contact.point_on_b && (contact.distance - 0.001).abs() < 1e-14);
        assert_eq!(contact.point, v(-0.5, -0.5));
    }
}

#[test]
fn balls_and_capsules_touch_along_their_centre_lines() {
    let origin = Pose2::identity();
    let (ball, small) = (
        ConvexPart::ball(v(0.0, 0.0), 0.5),
        ConvexPart::ball(v(0.0, 0.0), 0.1),
    );
    let capsule = ConvexPart::capsule(v(-1.0, 0.0), v(1.0, 0.0), 0.2);
    let pair = polygon_pair(&ball, &origin, &small, &at(0.6, 0.8, 0.7), 1.0, None);
    assert_eq!(pair.len(), 1);
    assert!((pair.as_slice()[0].distance - 0.4).abs() < 1e-15);
    assert!((from_a_to_b(&pair, 0) - v(0.6, 0.8)).norm() < 1e-15);

    let side = polygon_pair(&ball, &at(0.3, 1.0, 0.0), &capsule, &origin, 1.0, None);
    assert_eq!(side.len(), 1);
    assert!(!side.as_slice()[0].point_on_b, "the ball carries the point");
    assert!((side.as_slice()[0].distance - 0.3).abs() < 1e-15);
    let cap = polygon_pair(&ball, &at(1.6, 0.8, 0.0), &capsule, &origin, 1.0, None);
    assert!((cap.as_slice()[0].distance - 0.3).abs() < 1e-15);
    assert!((from_a_to_b(&cap, 0) - v(-0.6, -0.8)).norm() < 1e-15);

    // Parallel capsules, one half a length along: contacts at the end of each.
    let parallel = polygon_pair(&capsule, &origin, &capsule, &at(1.0, 0.41, 0.0), 0.1, None);
    assert_eq!(parallel.len(), 2);
    for (i, place) in [1.0, 0.0].iter().enumerate() {
        assert!((parallel.as_slice()[i].distance - 0.01).abs() < 1e-15);
        assert_eq!(from_a_to_b(&parallel, i), v(0.0, 1.0));
        assert!(
            (world_points(&parallel, i, [&origin, &at(1.0, 0.41, 0.0)])
                .0
                .x
                - place)
                .abs()
                < 1e-15
        );
    }
    let across = polygon_pair(
        &capsule,
        &origin,
        &capsule,
        &at(0.0, 1.41, FRAC_PI_2),
        0.1,
        None,
    );
    assert_eq!(across.len(), 1);
    assert!((across.as_slice()[0].distance - 0.01).abs() < 1e-15);
    // In line, the gap is between the caps.
    let in_line = polygon_pair(&capsule, &origin, &capsule, &at(2.5, 0.0, PI), 0.2, None);
    assert_eq!(in_line.len(), 1);
    assert!((in_line.as_slice()[0].distance - 0.1).abs() < 1e-12);
}

#[test]
fn a_half_space_carries_the_two_lowest_vertices() {
    let plane = ConvexPart::half_space(v(0.0, 1.0));
    let ground = at(3.0, 1.0, 0.0);
    let part = cuboid(0.5, 0.25, 0.05);
    for is_swapped in [false, true] {
        let pose = at(0.0, 1.31, 0.0);
        let contacts = if is_swapped {
            polygon_pair(&part, &pose, &plane, &ground, 0.1, None)
        } else {
            polygon_pair(&plane, &ground, &part, &pose, 0.1, None)
        };
        assert_eq!(contacts.len(), 2);
        for contact in &contacts {
            assert_eq!(contact.point_on_b, !is_swapped);
            assert_eq!(contact.normal, v(0.0, 1.0));
            assert_eq!(contact.point.y, -0.25);
            assert!((contact.distance - 0.01).abs() < 1e-14);
        }
    }
    let ball = ConvexPart::ball(v(0.0, 0.0), 0.3);
    assert_eq!(
        polygon_pair(&plane, &ground, &ball, &at(0.0, 1.2, 0.0), 0.1, None).len(),
        1
    );
    assert!(polygon_pair(&plane, &ground, &plane, &ground, 1.0, None).is_empty());
    let tilted = polygon_pair(&plane, &ground, &part, &at(0.0, 1.53, 0.5), 0.05, None);
    assert_eq!(tilted.len(), 1);
}

#[test]
fn a_reference_face_stays_while_another_is_hardly_better() {
    let part = cuboid(0.5, 0.5, 0.0);
    let origin = Pose2::identity();
    // Corner over corner: the top and the right face are almost equally deep.
    let top = Some(PairReference {
        on_b: false,
        face: 2,
    });
    for slip in [-1e-5, 1e-5] {
        let pose = at(0.9 + slip, 0.9, 0.0);
        let kept = polygon_pair(&part, &origin, &part, &pose, 0.01, top);
        assert_eq!(kept.reference, top);
        assert_eq!(from_a_to_b(&kept, 0), v(0.0, 1.0));
    }
    let clearly = polygon_pair(&part, &origin, &part, &at(0.95, 0.9, 0.0), 0.01, top);
    assert_eq!(
        from_a_to_b(&clearly, 0),
        v(1.0, 0.0),
        "a face that is clearly better replaces it"
    );
    let unknown = Some(PairReference {
        on_b: true,
        face: 77,
    });
    assert_eq!(
        polygon_pair(&part, &origin, &part, &at(0.0, 1.0, 0.0), 0.01, unknown).len(),
        2
    );
}

#[test]
fn a_box_pressed_through_a_thin_part_is_still_pushed_back() {
    let part = cuboid(0.5, 0.5, 0.0);
    let thin = [
        cuboid(2.0, 0.01, 0.0),
        ConvexPart::segment(v(-2.0, 0.0), v(2.0, 0.0)),
    ];
    for plate in &thin {
        let origin = Pose2::identity();
        let mut reference = None;
        for step in 0..10 {
            let height = 0.5 - 0.1 * step as f64;
            let contacts = polygon_pair(
                plate,
                &origin,
                &part,
                &at(0.1, height, 0.0),
                0.02,
                reference,
            );
            assert!(
                (from_a_to_b(&contacts, 0) - v(0.0, 1.0)).norm() < 1e-12,
                "step {step}"
            );
            reference = contacts.reference;
        }
    }
}

#[test]
fn contacts_keep_their_names_while_a_box_slides_over_an_end() {
    let (part, table) = (cuboid(0.5, 0.5, 0.0), cuboid(2.0, 0.5, 0.0));
    let mut last: Option<PairContacts> = None;
    for step in 0..=100 {
        let pose = at(1.0 + 0.01 * step as f64, 1.0 + 1e-6, 1e-7);
        let reference = last.and_then(|last| last.reference);
        let contacts = polygon_pair(&table, &Pose2::identity(), &part, &pose, 0.01, reference);
        assert_eq!(contacts.len(), 2);
        if let Some(last) = last {
            let ids = |contacts: &PairContacts| [0, 1].map(|i| contacts.as_slice()[i].id);
            assert_eq!(ids(&contacts), ids(&last), "step {step}");
        }
        last = Some(contacts);
    }
}
