//! What many bodies cost, in work that is the same on every machine; `cargo bench --bench growth` times the same scenes.

use crate::common::*;

/// Half a side of a box (m).
const HALF: f64 = 0.15;

fn boxes(scene: &mut Scene, n: usize, n_columns: usize, pitch: f64, left: f64) {
    for k in 0..n {
        let (column, row) = ((k % n_columns) as f64, (k / n_columns) as f64);
        let at = vec2(left + pitch * column, 0.151 + 0.301 * row);
        scene.rigid(
            RigidBodyBuilder::dynamic().translation(at),
            ColliderBuilder::cuboid(real(HALF), real(HALF))
                .density(500.0)
                .friction(0.5),
        );
    }
}

/// Boxes in twenty columns on a flexible slab held at both ends.
fn slab(n: usize) -> Onlooker {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.flexible(
        FlexBodyBuilder::rectangle([8.0, 0.4], [64, 4])
            .material(elastic(1e8, 1000.0, 2e-3))
            .translation([-4.0, -0.4])
            .pin_where(|[x, _]| (x - 4.0).abs() > 4.0 - 1e-9, Pin::both())
            .friction(0.5),
    );
    boxes(&mut scene, n, 20, 0.36, -3.6);
    let mut onlooker = Onlooker::default();
    onlooker.watch(&mut scene, 120, |_| ());
    onlooker
}

#[test]
fn boxes_at_rest_on_a_slab_cost_in_proportion_to_their_number() {
    let mut findings = Findings::default();
    let [few, _, many] = [20, 40, 80].map(|n| {
        let onlooker = slab(n);
        let name = format!("{n} boxes");
        onlooker.check(&mut findings, &name);
        let [worst, rest] = [0, 60].map(|first| onlooker.most_from(first));
        let mean = onlooker.mean_pivots_from(60);
        println!("{name}: worst {worst:?}, at rest {rest:?}, in the mean {mean:.1} pivots");
        // A body of large strain is factored once in a step.
        findings.check(rest.n_factorizations <= 1, || {
            format!("{name}: the slab is factored at rest")
        });
        // Every contact comes in or goes out some times at the most: a box has four.
        findings.check(worst.n_pivots < 20 * 4 * n, || {
            format!("{name}: {worst:?} in a step")
        });
        mean
    });
    // Four times the boxes: 4 in proportion; twice what is due for a longer chain of forces.
    findings.check(many < 8.0 * few, || {
        format!("80 boxes take {many:.1} pivots, 20 boxes {few:.1}")
    });
    findings.report();
}

/// Sixty boxes in six rows on fixed ground, and a soft block that falls on them.
fn pile() -> (Scene, Onlooker) {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    boxes(&mut scene, 60, 10, 0.31, -1.5);
    scene.flexible(
        FlexBodyBuilder::rectangle([0.3, 0.3], [4, 4])
            .material(elastic(1e6, 500.0, 2e-3))
            .translation([0.0, 0.302 * 6.0 + 0.3]),
    );
    let mut onlooker = Onlooker::default();
    onlooker.watch(&mut scene, 200, |_| ());
    (scene, onlooker)
}

#[test]
fn a_soft_block_comes_to_rest_on_a_pile_of_sixty_boxes() {
    let mut findings = Findings::default();
    let (scene, touched) = pile();
    touched.check(&mut findings, "pile");
    // A block of four contacts, some times over, not of the 240 of the pile.
    let rest = touched.most_from(100);
    findings.check(rest.n_factorizations <= 1 && rest.n_pivots < 100, || {
        format!("{rest:?} in a step at rest")
    });
    let (_, block) = scene.bodies.iter().next().expect("the block is there");
    let share = block.total_contact_force()[1] / (block.mass() * G);
    // It came to rest: fallen 0.3 m, it is damped within tenths of a second.
    findings.check((share - 1.0).abs() < 0.01, || {
        format!("the pile carries {share:.4} of the block's weight")
    });
    findings.report();
}

#[test]
fn bodies_that_do_not_touch_cost_in_proportion_to_their_number() {
    let mut scenes = [40, 160].map(|n| {
        let mut scene = Scene::new(1.0 / 60.0);
        scene.fixed(ColliderBuilder::cuboid(500.0, 0.5).translation(vec2(0.0, -0.5)));
        for i in 0..n {
            scene.flexible(
                FlexBodyBuilder::rectangle([0.4, 0.4], [3, 3])
                    .small_strain()
                    .material(elastic(1e6, 500.0, 2e-3))
                    .can_sleep(false)
                    .translation([f64::from(i) - 0.5 * f64::from(n), 0.0]),
            );
        }
        scene
    });
    for step in 0..60 {
        let [few, many] = scenes.each_mut().map(|scene| {
            let report = scene.step();
            [
                report.n_islands() as u64,
                report.n_factorizations(),
                report.n_pivots() as u64,
            ]
        });
        let due = few.map(|count| 4 * count);
        let is_due = many[0] == due[0] && many[1] == due[1] && many[2] <= due[2];
        assert!(
            is_due,
            "step {step}: {many:?} islands, factorizations and pivots, not {due:?}"
        );
    }
}
