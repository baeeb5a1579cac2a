//! Flexible bodies laid exactly on and beside each other, as a user builds a wall.

mod common;

use common::*;
use foil2d::pipeline::Quality;

const WIDTH: f64 = 0.5;
const HEIGHT: f64 = 0.25;

/// Deepest boundary node of one body in another (m).
fn overlap(scene: &Scene, bodies: &[FlexBodyHandle]) -> f64 {
    let mut deepest = 0.0f64;
    for &one in bodies {
        for &other in bodies.iter().filter(|&&other| other != one) {
            let (one, outline) = (scene.body(one), scene.body(other));
            let nodes = one.mesh().boundary().nodes().iter();
            let depths = nodes.map(|&node| -from_outline(outline, one.position(node)));
            deepest = depths.fold(deepest, f64::max);
        }
    }
    deepest
}

/// Blocks in columns and rows on the ground, with gaps (m) between them.
fn wall([columns, rows]: [usize; 2], gap: f64) -> (Scene, Vec<FlexBodyHandle>) {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let places = (0..columns * rows).map(|k| [k % columns, k / columns]);
    let bodies = places.map(|[column, row]| {
        let block = FlexBodyBuilder::rectangle([WIDTH, HEIGHT], [4, 2])
            .material(elastic(1e6, 1000.0, 2e-3))
            .friction(0.5)
            .translation([column as f64 * (WIDTH + gap), row as f64 * (HEIGHT + gap)]);
        scene.flexible(block)
    });
    let bodies = bodies.collect();
    (scene, bodies)
}

#[test]
fn a_wall_laid_flush_settles_as_one_laid_with_a_hair_between() {
    for size in [[1, 2], [1, 4], [2, 1], [3, 3]] {
        // In binary fractions the faces of the first one are the same to the last digit.
        let ends = [0.0, 1e-7, 1e-5].map(|gap| {
            let (mut scene, bodies) = wall(size, gap);
            for step in 0..120 {
                let report = scene.step();
                let told = report.gap_violation();
                let there = overlap(&scene, &bodies);
                assert!(
                    there <= 1e-3 * HEIGHT && told <= 1e-3 * HEIGHT,
                    "{size:?}, {gap} m apart, step {step}: {there} m, {told} m told"
                );
            }
            let ends = bodies.iter().map(|&body| centre(scene.body(body)));
            (ends.collect::<Vec<_>>(), speed(&scene, &bodies))
        });
        for (found, still) in &ends {
            eprintln!("STILL {still:e}");
            assert!(*still < 1e-2, "{size:?}: {still} m/s");
            for (at, expected) in found.iter().zip(&ends[0].0) {
                let off = (at[0] - expected[0]).hypot(at[1] - expected[1]);
                eprintln!("OFF {size:?} {off:e}");
            }
        }
    }
}

/// Centre of the nodes of a body (m).
fn centre(body: &FlexBody) -> [f64; 2] {
    let n = body.n_nodes();
    let sum = (0..n).map(|node| body.position(node));
    let sum = sum.fold([0.0; 2], |sum, at| [sum[0] + at[0], sum[1] + at[1]]);
    sum.map(|sum| sum / n as f64)
}

/// Largest speed of a node (m/s).
fn speed(scene: &Scene, bodies: &[FlexBodyHandle]) -> f64 {
    let speeds = bodies.iter().flat_map(|&body| {
        let body = scene.body(body);
        (0..body.n_nodes()).map(|node| {
            let [x, y] = body.velocity(node);
            x.hypot(y)
        })
    });
    speeds.fold(0.0, f64::max)
}

/// A block that a pin keeps from being pushed out: its lower left corner stays on the upper side of a coarser block.
#[test]
fn what_is_pinned_where_it_is_flush_stays_on_the_surface_all_along() {
    for divisions in [[[2, 5], [4, 2]], [[4, 2], [2, 5]]] {
        let mut scene = Scene::new(1.0 / 60.0);
        scene.ground(0.5);
        let block = |level: usize, divisions: [usize; 2]| {
            FlexBodyBuilder::rectangle([0.75, 0.5], divisions)
                .material(elastic(5e5, 1500.0, 0.0))
                .friction(0.9)
                .translation([0.0, 0.5 * level as f64])
        };
        let lower = scene.flexible(block(0, divisions[0]));
        let upper = block(1, divisions[1]).pin_where(|[x, y]| x < 1e-9 && y < 1e-9, Pin::both());
        let upper = scene.flexible(upper);
        for step in 0..90 {
            let told = scene.step().gap_violation();
            let there = overlap(&scene, &[lower, upper]);
            assert!(
                there <= 2e-3 * 0.5,
                "{divisions:?}, step {step}: {there} m, {told} m told"
            );
        }
    }
}

/// What a user has put into each other by less than a tenth of a cell comes apart without a kick.
#[test]
fn blocks_that_overlap_a_little_come_apart() {
    for depth in [1e-4, 1e-3, 5e-3] {
        let (mut scene, bodies) = wall([1, 2], -depth);
        let weight = 1000.0 * WIDTH * HEIGHT * G;
        let report = scene.step();
        assert!(is_solved(report));
        let moved = speed(&scene, &bodies);
        // The overlap is left within the step.
        assert!(moved < 4.0 * depth * 60.0 + 0.2, "{depth} m: {moved} m/s");
        scene.steps(180);
        let there = overlap(&scene, &bodies);
        assert!(there <= 1e-4 * HEIGHT, "{depth} m: {there} m");
        let report = scene.step();
        let carried: f64 = report.contacts().iter().map(|c| c.force()[1].abs()).sum();
        assert!(
            (carried - 3.0 * weight).abs() < 0.05 * weight,
            "{depth} m: {carried} N of {weight} N"
        );
    }
}

/// Two blocks that no force moves, put into each other, with a free one on top: what cannot be parted stays as it was put, and does not keep
/// the step from being solved.
#[test]
fn pinned_blocks_that_overlap_are_left_alone() {
    let mut scene = Scene::new(1.0 / 60.0);
    let block = |x: f64| {
        FlexBodyBuilder::rectangle([1.0, 0.4], [5, 2])
            .material(elastic(1e7, 1000.0, 1e-3))
            .friction(0.5)
            .translation([x, 0.0])
    };
    let held = [-0.9, 0.0].map(|x| scene.flexible(block(x).pin_where(|_| true, Pin::both())));
    let free = scene.flexible(block(-0.5).translation([-0.45, 0.41]));
    let starts = held.map(|body| scene.body(body).positions().to_vec());
    for step in 0..120 {
        let report = scene.try_step().expect("nothing is wrong with it");
        assert!(is_solved(report), "step {step}: {:?}", report.quality());
    }
    for (body, start) in held.into_iter().zip(&starts) {
        assert_eq!(scene.body(body).positions(), start);
    }
    let height = scene.body(free).positions()[1];
    assert!((height - 0.4).abs() < 0.01, "it rests at {height} m");
}

/// Flexible blocks that were put into each other edge on edge, so that the corners of each lie on edges of the other, part by and by and keep still: what
/// comes near while they part is asked for no more than the rest. They flew apart with 0.1 to 2 J.
#[test]
fn flexible_blocks_that_overlap_edge_on_edge_part_at_rest() {
    for rate in [60.0, 240.0] {
        for depth in [1e-3, 3e-3, 5e-3] {
            let mut scene = Scene::in_free_space(1.0 / rate);
            let block = |x: f64| {
                FlexBodyBuilder::rectangle([0.8, 0.3], [8, 3])
                    .material(elastic(1e6, 100.0, 0.0))
                    .translation([x, 0.0])
            };
            let blocks = [0.0, 0.8 - depth].map(|x| scene.flexible(block(x)));
            scene.steps(rate as usize);
            let kinetic: f64 = blocks
                .map(|body| scene.body(body).energy().kinetic)
                .iter()
                .sum();
            assert!(kinetic < 0.02, "{depth} m, 1/{rate} s: {kinetic} J");
            let left = scene.report().gap_violation();
            assert!(left < 1e-6, "{depth} m, 1/{rate} s: {left} m");
        }
    }
}

/// A bar that reaches a tenth of a millimetre into a rigid box, or a ball, in free space: nothing does work on it.
#[test]
fn what_was_put_into_a_rigid_body_parts_without_energy() {
    for shape in [SharedShape::cuboid(2.0, 0.5), SharedShape::ball(0.5)] {
        for (rate, cells, is_large) in [
            (480.0, 1, true),
            (1920.0, 1, true),
            (1920.0, 3, true),
            (1920.0, 3, false),
        ] {
            let mut scene = Scene::in_free_space(1.0 / rate);
            scene.fixed(ColliderBuilder::new(shape.clone()).translation(vec2(0.5, -0.5)));
            let bar = FlexBodyBuilder::rectangle([1.0, 0.02], [40, cells])
                .material(elastic(1e7, 1000.0, 0.0))
                .translation([0.0, -1e-4]);
            let bar = scene.flexible(match is_large {
                true => bar.large_strain(),
                false => bar.small_strain(),
            });
            let mut most = 0.0f64;
            for step in 0..rate as usize {
                let report = scene.step();
                let quality = report.quality();
                assert_eq!(
                    quality,
                    Quality::Solved,
                    "step {step}, 1/{rate} s, {cells} cells"
                );
                let energy = scene.body(bar).energy();
                most = most.max(energy.kinetic + energy.elastic);
            }
            let told = scene.report().gap_violation();
            assert!(told < 1e-8, "{told} m left");
            // Pressed out at once, the last 4e-5 m would store .4 J in the first row of cells.
            assert!(most < 1e-4, "{most} J, 1/{rate} s, {cells} cells");
        }
    }
}
