use crate::body::FlexBodyBuilder;
use crate::fe::material::LinearElastic;
use crate::integrator::Beta2;
use crate::math::{Vec2, node_vec, perp, rotation};
use crate::system::samples::{body_of, predicted};
use crate::system::{FlexBlock, Response};

const DT: f64 = 1.0 / 60.0;

/// How the bar lies (rad).
const TURN: f64 = 0.3;

/// A bar of 4 kg on its way, one cell thick, with compliances known from the middles of its ends.
fn bar() -> FlexBlock {
    let material = LinearElastic::plane_stress(1e9, 0.3).density(20.0);
    let bar = FlexBodyBuilder::rectangle([1.0, 0.2], [4, 2])
        .small_strain()
        .material(material)
        .rotation(TURN)
        .angvel(0.05);
    let mut block = predicted(&body_of(bar), DT);
    for node in ends(&block) {
        block.prepare_compliance(node);
    }
    block
}

/// The middles of the ends.
fn ends(block: &FlexBlock) -> [usize; 2] {
    let (positions, back) = (block.model().rest_positions(), rotation(-TURN));
    [0.0, 1.0].map(|x| {
        let middle = Vec2::new(x, 0.1);
        let mut nodes = 0..block.model().n_nodes();
        let found = nodes.find(|&node| (back * node_vec(positions, node) - middle).norm() < 1e-9);
        match found {
            Some(node) => node,
            None => panic!("no node in the middle of the end"),
        }
    })
}

/// Solves with these forces at the ends, at the levers of each iterate, until these stay; returns how often that took.
///
/// - `is_told`: whether the block knows how much they stretch it.
fn settle(block: &mut FlexBlock, forces: [Vec2; 2], is_told: bool) -> usize {
    let ends = ends(block);
    let mut before = ends.map(|node| block.position(node));
    for pass in 1..200 {
        block.clear_contact_force();
        for (node, force) in ends.into_iter().zip(forces) {
            let lever = block.position(node) - block.centre();
            block.add_contact_force(node, force, lever);
            if is_told {
                block.stretch_by(lever.dot(&force));
            }
        }
        block.solve();
        let now = ends.map(|node| block.position(node));
        let moved = now
            .iter()
            .zip(&before)
            .map(|(now, before)| (now - before).norm());
        if moved.fold(0.0, f64::max) < 1e-13 {
            return pass;
        }
        before = now;
    }
    panic!("the levers go on moving under {forces:?}");
}

/// Forces that pull at the ends turn a bar back by their levers, in what it answers as in where it ends: differences of places that were settled
/// give the compliance. Its turn about the pull, `ω dt` of 0.3 to 30, is settled at once.
#[test]
fn what_pulls_at_a_bar_turns_it_back_in_its_answer() {
    for pull in [0.0, 1e2, 1e4, 1e6] {
        let mut block = bar();
        let along = rotation(TURN) * Vec2::x();
        let forces = [-pull * along, pull * along];
        settle(&mut block, forces, true);
        let [left, right] = ends(&block);
        let levers = [left, right].map(|node| block.position(node) - block.centre());
        let step = 1e-2 + 1e-6 * pull;
        let more = step * perp(along);
        let b0 = Beta2::default().weights(DT).b0;
        let expected = [(left, levers[0]), (right, levers[1])].map(|at| {
            let known = block.compliance(at, (right, levers[1]), Response::Position);
            b0 * (known * more)
        });
        let before = [left, right].map(|node| block.position(node));
        let n_passes = settle(&mut block, [forces[0], forces[1] + more], true);
        let after = [left, right].map(|node| block.position(node));
        for k in 0..2 {
            let found = after[k] - before[k];
            let off = (found - expected[k]).norm() / expected[1].norm();
            assert!(
                off < 2e-3,
                "{pull} N, end {k}: {found:?}, not {:?}",
                expected[k]
            );
        }
        assert!(n_passes <= 12, "{pull} N: {n_passes} passes");
    }
}

/// Where iterates end does not depend on it, where they end without it too.
#[test]
fn a_bar_that_is_pulled_aslant_ends_where_its_forces_balance() {
    for pull in [1.0, 30.0, 300.0] {
        let forces = [Vec2::new(-pull, 0.3 * pull), Vec2::new(pull, -0.1 * pull)];
        let ended = [false, true].map(|is_told| {
            let mut block = bar();
            let n_passes = settle(&mut block, forces, is_told);
            (ends(&block).map(|node| block.position(node)), n_passes)
        });
        let [plain, told] = ended;
        for (one, other) in plain.0.iter().zip(&told.0) {
            assert!((one - other).norm() < 1e-11, "{pull} N: {ended:?}");
        }
        assert!(told.1 <= plain.1, "{pull} N: {ended:?}");
    }
}
