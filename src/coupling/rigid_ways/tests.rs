use super::super::outlines::Outline;
use super::*;
use crate::constraint::contact::{ContactKey, Kinematics, Owner};
use crate::constraint::geometry::Pose2;
use crate::math::{HashSet, Vec2, cross, perp, sin_cos};
use crate::path::samples::Random;
use crate::system::{Block, RigidBlock, RigidMotion};

const OWNERS: [Owner; 2] = [Owner::Collider(0), Owner::Collider(1)];

/// The rows of two bodies, the first of which moves; `None` where they overlap deeper than their roundings.
fn rows_of(
    outlines: [&Outline; 2],
    poses: [RigidMotion; 2],
) -> Option<Vec<(ContactKey, Kinematics)>> {
    let mut island = Island::default();
    let moved = RigidMotion {
        centre: poses[0].centre + Vec2::new(0.0, 1e-3),
        ..poses[0]
    };
    for (start, end) in poses.into_iter().zip([moved, poses[1]]) {
        let block = RigidBlock::prescribed(start, end);
        island.blocks.push(Block::Rigid(block));
    }
    let surfaces = [0, 1].map(|block| RigidSurface {
        block,
        outline: outlines[block],
        offset: Pose2::identity(),
    });
    let way = RigidWay {
        handles: [0, 1].map(|index| ColliderHandle::from_raw_parts(index, 0)),
        surfaces,
        names: Names {
            one: OWNERS[0],
            other: OWNERS[1],
        },
        law: ContactLaw::default(),
        reach: 0.1,
        turn: 0.0,
    };
    let is_apart = RigidCores::default().lead(&way, &mut island);
    is_apart.then(|| island.path.start_rows(&island.blocks))
}

fn rectangle([left, right]: [f64; 2], [low, high]: [f64; 2]) -> Piece {
    let corners = [[left, low], [right, low], [right, high], [left, high]];
    Piece::Convex {
        vertices: corners.map(Vec2::from).to_vec(),
        radius: 0.0,
        width: (right - left).min(high - low),
    }
}

/// A strip of 5,000 boxes lies on a long one. Every near pair has a name of its own, and none of them reaches into the bits above,
/// which tell the rows of the path and of meetings from each other.
#[test]
fn every_contact_of_a_body_of_many_parts_has_a_name_of_its_own() {
    const N: usize = 5_000;
    let side = 0.1;
    let boxes = (0..N).map(|part| {
        let left = side * part as f64;
        rectangle([left, left + 0.9 * side], [0.001, side])
    });
    let strip = Outline {
        pieces: boxes.collect(),
    };
    let long = side * N as f64;
    let table = Outline {
        pieces: vec![rectangle([-1.0, long + 1.0], [-1.0, 0.0])],
    };
    let rows = rows_of([&strip, &table], [RigidMotion::default(); 2]).unwrap_or_default();
    assert!(rows.len() >= 2 * N, "{} near pairs", rows.len());
    let names: HashSet<_> = rows.iter().map(|(key, _)| key).collect();
    assert_eq!(names.len(), rows.len(), "two contacts share a name");
    assert!(rows.iter().all(|(key, _)| key.part >> 30 == 0b10));
}

/// A box, or a polygon with corners on a circle.
fn random_polygon(random: &mut Random) -> Vec<Vec2> {
    let n = 3 + random.index(5);
    if n == 3 {
        let [x, y] = [0.2 + 0.8 * random.unit(), 0.2 + 0.8 * random.unit()];
        return [[-x, -y], [x, -y], [x, y], [-x, y]]
            .map(Vec2::from)
            .to_vec();
    }
    let n = n - 1;
    let corners = (0..n).map(|corner| {
        let share = (corner as f64 + 0.5 * random.unit()) / n as f64;
        let (sin, cos) = sin_cos(std::f64::consts::TAU * share);
        Vec2::new(cos, sin)
    });
    corners.collect()
}

/// Least thickness (m).
fn width_of(vertices: &[Vec2]) -> f64 {
    let n = vertices.len();
    let thickness = |edge: usize| {
        let normal = perp((vertices[(edge + 1) % n] - vertices[edge]).normalize());
        let heights = vertices
            .iter()
            .map(|vertex| normal.dot(&(vertex - vertices[edge])));
        heights.fold(0.0, f64::max)
    };
    (0..n).map(thickness).fold(f64::INFINITY, f64::min)
}

/// Outward normal of an edge and a point on it.
fn face_of(vertices: &[Vec2], edge: usize) -> (Vec2, Vec2) {
    let along = vertices[(edge + 1) % vertices.len()] - vertices[edge];
    (-perp(along.normalize()), vertices[edge])
}

/// Distance of two polygons, or how deep they are in each other, negative (m).
fn separation(polygons: [&[Vec2]; 2]) -> f64 {
    let [one, other] = polygons;
    let mut along_normals = f64::NEG_INFINITY;
    let mut nearest = f64::INFINITY;
    for (own, met) in [(one, other), (other, one)] {
        for edge in 0..own.len() {
            let (normal, on_face) = face_of(own, edge);
            let heights = met.iter().map(|vertex| normal.dot(&(vertex - on_face)));
            along_normals = along_normals.max(heights.fold(f64::INFINITY, f64::min));
            let along = own[(edge + 1) % own.len()] - on_face;
            for vertex in met {
                let share = along.dot(&(vertex - on_face)) / along.norm_squared();
                let foot = on_face + share.clamp(0.0, 1.0) * along;
                nearest = nearest.min((vertex - foot).norm());
            }
        }
    }
    if along_normals > 0.0 {
        nearest
    } else {
        along_normals
    }
}

/// A polygon as an outline.
fn outline_of(vertices: &[Vec2]) -> Outline {
    let piece = Piece::Convex {
        vertices: vertices.to_vec(),
        radius: 0.0,
        width: width_of(vertices),
    };
    Outline {
        pieces: vec![piece],
    }
}

fn placed(vertices: &[Vec2], pose: &RigidMotion) -> Vec<Vec2> {
    vertices.iter().map(|vertex| pose.point(*vertex)).collect()
}

/// Two polygons with poses at which the sharp ones are this far apart (m): the first comes from a random side.
fn random_pair(random: &mut Random, apart: f64) -> ([Vec<Vec2>; 2], [RigidMotion; 2]) {
    let polygons = [random_polygon(random), random_polygon(random)];
    let (sin, cos) = sin_cos(random.within(4.0));
    let angles = [random.within(4.0), random.within(4.0)];
    let poses_at = |far: f64| {
        [far, 0.0].map(|far| RigidMotion {
            centre: far * Vec2::new(cos, sin),
            angle: angles[usize::from(far == 0.0)],
            ..RigidMotion::default()
        })
    };
    let (mut low, mut high) = (1e-3, 4.0);
    for _ in 0..50 {
        let poses = poses_at(0.5 * (low + high));
        let sides = [0, 1].map(|side: usize| placed(&polygons[side], &poses[side]));
        if separation([&sides[0], &sides[1]]) < apart {
            low = 0.5 * (low + high);
        } else {
            high = 0.5 * (low + high);
        }
    }
    (polygons, poses_at(high))
}

/// Cores are drawn inwards by up to a fiftieth of their width, and the gaps of their rows are those of the sharp corners all the same.
///
/// ```text
///        \\   //                \\    //
///         \\ //  core            \\  //
///     _____V_____             ____\\//
///     -----------  core       ----.  \
///                                 |
///      face: exact            corner: along the line of the cores' corners
/// ```
///
/// Off a face the gap is the distance of the sharp corner, and its row acts there. Where cores meet with their corners, the gap is that of the
/// sharp corners along the line between those of the cores. All rows together never find bodies farther apart than they are, and nearer at most by
/// what the tips of corners may stand out of their roundings, `(sqrt(2) - 1) 0.02` of both widths.
#[test]
fn gaps_of_drawn_in_bodies_are_those_of_their_sharp_corners() {
    let mut random = Random::new(1);
    let [mut n_faces, mut n_corners, mut n_deep] = [0; 3];
    for _ in 0..4000 {
        let depth = 0.025 * random.within(1.0);
        let (polygons, poses) = random_pair(&mut random, depth);
        let outlines = [outline_of(&polygons[0]), outline_of(&polygons[1])];
        let Some(rows) = rows_of([&outlines[0], &outlines[1]], poses) else {
            n_deep += 1;
            continue;
        };
        let sides = [0, 1].map(|side: usize| placed(&polygons[side], &poses[side]));
        let mut least = f64::INFINITY;
        for (key, row) in &rows {
            let own = usize::from(key.contactor == OWNERS[1]);
            let corner = sides[own][key.point as usize];
            let met = &sides[1 - own];
            let name = (key.part & !(1 << 31)) as usize;
            let from = if name % 2 == 1 {
                let (normal, on_face) = face_of(met, name / 2);
                // A face beyond another one, seen from behind: not what is touched.
                if normal.dot(&row.normal) < 0.0 {
                    continue;
                }
                n_faces += 1;
                assert!((normal - row.normal).norm() < 1e-12);
                on_face
            } else {
                n_corners += 1;
                met[name / 2]
            };
            let gap = row.normal.dot(&(corner - from));
            assert!((row.gap - gap).abs() < 1e-12, "{} for {gap}", row.gap);
            let aside = cross(row.normal, row.position - corner);
            assert!(aside.abs() < 1e-12, "acts {aside} m beside the corner");
            least = least.min(row.gap);
        }
        let truth = separation([&sides[0], &sides[1]]);
        let tips =
            (2f64.sqrt() - 1.0) * 0.02 * polygons.iter().map(|own| width_of(own)).sum::<f64>();
        assert!(least <= truth + 1e-12, "{least} m for {truth} m");
        assert!(
            least >= truth - tips,
            "{least} m for {truth} m, tips {tips} m"
        );
    }
    assert!(n_faces > 1000 && n_corners > 50 && n_deep < 400);
}

/// The tip of a triangle stands out of its rounding by more than rows reach on a thin plate: it is listed where it touches all the same.
#[test]
fn the_tip_of_a_wide_triangle_is_near_a_thin_plate_where_it_touches_it() {
    let gap = 1e-4;
    let triangle = Outline {
        pieces: vec![Piece::Convex {
            vertices: [[0.0, 0.0], [0.6, 1.0], [-0.6, 1.0]]
                .map(Vec2::from)
                .to_vec(),
            radius: 0.0,
            width: 1.0,
        }],
    };
    let plate = Outline {
        pieces: vec![rectangle([-1.0, 1.0], [-0.05, 0.0])],
    };
    let above = RigidMotion {
        centre: Vec2::new(0.0, gap),
        ..RigidMotion::default()
    };
    let rows = rows_of([&triangle, &plate], [above, RigidMotion::default()]);
    let gaps: Vec<f64> = rows.into_iter().flatten().map(|row| row.1.gap).collect();
    assert!(
        gaps.iter().any(|found| (found - gap).abs() < 1e-12),
        "gaps of {gaps:?} m"
    );
}
