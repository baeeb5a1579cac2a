//! When a surface is asked against itself, and what its rows hold on to.

use super::*;
use crate::body::{FlexBody, FlexBodyBuilder};
use crate::constraint::contact::{ContactLaw, Owner};
use crate::fe::material::LinearElastic;
use crate::fe::mesh::CellKind;
use crate::integrator::Beta2;
use crate::math::{cos, rotation, set_node_vec, sin};
use crate::path::{clearance, samples::Random};
use crate::system::{FlexLoad, Step};
use std::sync::Arc;

/// A strip of 12 cells of 1 m.
fn strip() -> FlexBody {
    let nodes = (0..26).map(|k| [f64::from(k / 2), f64::from(k % 2)]);
    let cells: Vec<[usize; 4]> = (0..12).map(|k| [0, 2, 3, 1].map(|n| 2 * k + n)).collect();
    let material = LinearElastic::plane_stress(1e6, 0.3).density(1e3);
    let built = FlexBodyBuilder::cells(nodes.collect(), CellKind::Quad4, &cells)
        .small_strain()
        .material(material)
        .build();
    let Ok(body) = built else {
        panic!("a plain strip")
    };
    body
}

/// The path of a body alone whose nodes are somewhere, whether its surface is apart from itself, and its blocks.
fn scene(body: &FlexBody, place: impl Fn([f64; 2]) -> Vec2) -> (FeasiblePath, bool, Vec<Block>) {
    let mut block = FlexBlock::new(
        Arc::clone(body.model()),
        body.fixed_dofs().to_vec(),
        body.frame(),
    );
    let mut state = body.state().clone();
    for (node, at) in body.mesh().nodes().iter().enumerate() {
        set_node_vec(&mut state.position, node, place(*at));
    }
    let load = FlexLoad {
        force: body.nodal_forces(),
        gravity: Vec2::zeros(),
        prescribed: body.prescribed(),
        reaction: body.reactions(),
    };
    let step = Step::new(&Beta2::default(), 1e-2);
    assert!(block.predict(step, &state, &load).is_ok());
    let mut path = FeasiblePath::default();
    path.begin_own();
    let member = path.flex_member(0, &block, 0.0, &[]);
    let way = Way {
        members: [member; 2],
        owners: [Owner::Flex(0); 2],
        law: ContactLaw::default(),
        places: (0, 0),
        closing: 0.01,
        margin: 0.01,
        reach: 0.1,
    };
    let is_apart = path.add_own_way(way, &block, block.clearance());
    (path, is_apart, vec![Block::Flex(Box::new(block))])
}

/// A strip bent to an arc of this radius about a point above its middle.
fn bent(radius: f64) -> impl Fn([f64; 2]) -> Vec2 {
    move |[x, y]: [f64; 2]| {
        let arm = Vec2::new(0.0, y - radius);
        rotation((x - 6.0) / radius) * arm
    }
}

#[test]
fn what_lies_nearly_as_at_rest_is_not_asked_wherever_it_is() {
    let body = strip();
    let mut random = Random::new(3);
    for turn in 0..8 {
        let turn = rotation(f64::from(turn));
        let away = random.point(50.0);
        let shake = |at: [f64; 2]| Vec2::new(0.4 * sin(5.0 * at[1]), 0.4 * sin(at[0]));
        let place = |at: [f64; 2]| away + turn * (Vec2::from(at) + shake(at));
        let (mut path, is_apart, blocks) = scene(&body, place);
        assert!(is_apart && path.is_empty());
        path.rest(&blocks);
        path.list_near();
        assert!(path.pairs[0].is_asleep && path.near().is_empty());
        path.motion.rest(&path.surfaces);
        assert_eq!(path.wake_on_way(), 1.0);
        assert!(path.pairs[0].is_asleep && !path.has_met_itself(&blocks));
    }
}

#[test]
fn what_is_bent_far_is_compared_with_itself() {
    // A hoop whose ends are 12 - 2π 1.7 apart, measured at its inner side: ten times as far from rest as it is from itself.
    let (mut path, is_apart, blocks) = scene(&strip(), bent(2.0));
    assert!(is_apart && path.is_empty());
    path.rest(&blocks);
    path.list_near();
    assert!(path.pairs[0].is_asleep && path.own[0].clearance > 0.11);
}

#[test]
fn ends_that_come_near_have_rows_on_one_block() {
    // The outer corners of the ends are .05 apart, the inner ones half as far.
    let radius = (12.0 + 0.05) / std::f64::consts::TAU;
    let (mut path, is_apart, blocks) = scene(&strip(), bent(radius));
    assert!(is_apart && !path.is_empty());
    let rows = path.start_rows(&blocks);
    assert!(rows.len() >= 2, "{rows:?}");
    for (key, row) in rows {
        assert!(row.is_own() && key.owners() == [Owner::Flex(0); 2]);
        let weights: f64 = row.attachments().iter().map(|grip| grip.weight).sum();
        assert!(weights.abs() < 1e-15, "{row:?}");
        assert!((0.01..0.05).contains(&row.gap), "{row:?}");
    }
    assert_eq!(path.least_margin(), 0.01);
}

#[test]
fn what_crosses_itself_has_no_way() {
    let (path, is_apart, _) = scene(&strip(), bent(1.8));
    assert!(!is_apart && path.is_empty() && path.pairs.is_empty());
}

/// The bound by the fit, and its turn: random shapes are nowhere nearer to themselves than it says.
#[test]
fn a_surface_is_no_nearer_to_itself_than_its_fit_tells() {
    let mut random = Random::new(9);
    let ring: Vec<Vec2> = (0..24)
        .map(|k| {
            let along = f64::from(k) * std::f64::consts::TAU / 24.0;
            (2.0 + cos(3.0 * along)) * (rotation(along) * Vec2::new(1.0, 0.0))
        })
        .collect();
    let edges: Vec<[u32; 2]> = (0..24).map(|k| [k, (k + 1) % 24]).collect();
    let at_rest = clearance(&ring, &edges);
    let mut reference = ring.clone();
    centre(&mut reference);
    for _ in 0..500 {
        let (turn, away) = (rotation(6.0 * random.unit()), random.point(10.0));
        let shaken = |point: &Vec2| away + turn * (point + random.point(0.06));
        let now: Vec<Vec2> = ring.iter().map(shaken).collect();
        let fit = Fit::of(&reference, &now);
        assert!(fit.off < 0.2, "{}", fit.off);
        assert!(clearance(&now, &edges) >= at_rest - 2.0 * fit.off - 1e-14);
        let back = Vec2::new(fit.turn.x, -fit.turn.y);
        let expected = turn * Vec2::new(1.0, 0.0);
        assert!((turned(expected, back) - Vec2::new(1.0, 0.0)).norm() < 0.1);
    }
}

#[test]
fn a_question_about_the_step_leaves_the_way_of_the_pass() {
    let (mut path, _, blocks) = scene(&strip(), bent(2.0));
    path.rest(&blocks);
    path.motion.rest(&path.surfaces);
    let shift = Vec2::new(0.1, 0.2);
    for end in path.motion.ends_mut(&path.surfaces, 0) {
        *end += shift;
    }
    let (points, ends) = (path.surfaces.points().to_vec(), path.motion.ends().to_vec());
    assert!(!path.leads_around(0, &blocks));
    assert_eq!(path.surfaces.points(), points);
    assert_eq!(
        path.motion.ends(),
        ends,
        "gone in part once more, it would lead elsewhere"
    );
}
