//! Bodies that are put across surfaces: whatever lies on the wrong side of a line, a face or a wall is led out, by one way for all of it.

use crate::common::{Dice, G, Outline, Scene, real, vec2};
use foil2d::pipeline::Quality;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

/// A ground along y = 0 from -3 m to 3 m.
#[derive(Clone, Copy, Debug)]
enum Made {
    Line,
    Heights,
    Triangles,
    /// One compound of flush boxes.
    Compound,
    /// Flush boxes, each a collider.
    Boxes,
}

impl Made {
    const ALL: [Self; 5] = [
        Self::Line,
        Self::Heights,
        Self::Triangles,
        Self::Compound,
        Self::Boxes,
    ];

    fn lay(self, scene: &mut Scene, n: u32) {
        let x = |at: u32| -3.0 + 6.0 * f64::from(at) / f64::from(n);
        let half = 3.0 / f64::from(n);
        match self {
            Self::Line => {
                let points = (0..=n).map(|at| vec2(x(at), 0.0));
                scene.fixed(ColliderBuilder::polyline(points.collect(), None));
            }
            Self::Heights => {
                let heights = vec![0.0; n as usize + 1];
                scene.fixed(ColliderBuilder::heightfield(heights, vec2(6.0, 1.0)));
            }
            Self::Triangles => {
                let points = (0..=n).flat_map(|at| [vec2(x(at), 0.0), vec2(x(at), -1.0)]);
                // Every other one the other way round.
                let cells = (1..=n).flat_map(|at| {
                    let k = 2 * at;
                    [[k - 2, k - 1, k], [k, k + 1, k - 1]]
                });
                let mesh = ColliderBuilder::trimesh(points.collect(), cells.collect());
                scene.fixed(mesh.expect("a mesh"));
            }
            Self::Compound => {
                let parts = (0..n).map(|at| {
                    let place = Pose::from_translation(vec2(x(at) + half, -0.5));
                    (place, SharedShape::cuboid(real(half), 0.5))
                });
                scene.fixed(ColliderBuilder::compound(parts.collect()));
            }
            Self::Boxes => {
                for at in 0..n {
                    let part = ColliderBuilder::cuboid(real(half), 0.5);
                    scene.fixed(part.translation(vec2(x(at) + half, -0.5)));
                }
            }
        }
    }
}

fn rubber() -> LinearElastic {
    LinearElastic::plane_stress(1e6, 0.3)
        .density(1000.0)
        .rayleigh(1e-2)
}

fn of_strain(body: FlexBodyBuilder, is_small: bool) -> FlexBodyBuilder {
    if is_small { body.small_strain() } else { body }
}

fn lowest(body: &FlexBody) -> f64 {
    let heights = body.positions().chunks_exact(2).map(|node| node[1]);
    heights.fold(f64::INFINITY, f64::min)
}

/// Blocks with up to two fifths of them in the ground, of whatever it is made: they stayed stretched across lines, in steps told as solved, or stood
/// in triangles and between flush boxes for good.
#[test]
fn what_is_put_into_the_ground_comes_out_of_it_whatever_it_is_made_of() {
    let mut dice = Dice(55);
    for made in Made::ALL {
        for is_small in [false, true] {
            for _ in 0..6 {
                let n = dice.pick(&[6, 15, 30, 60]);
                let (deep, x) = (dice.between(0.015, 0.12), dice.between(-1.5, 1.0));
                let case = format!("{made:?} of {n}, {deep:.3} m at {x:.3}, small {is_small}");
                let mut scene = Scene::new(1.0 / 60.0);
                made.lay(&mut scene, n);
                let block = FlexBodyBuilder::rectangle([0.5, 0.3], [5, 3])
                    .material(rubber())
                    .translation([x, -deep]);
                let block = scene.flexible(of_strain(block, is_small));
                for step in 0..90 {
                    scene.try_step().expect("a step");
                    let report = scene.report();
                    assert_ne!(report.quality(), Quality::Unfinished, "{case}: {step}");
                    let is_told = !report.insertion_notes().is_empty();
                    assert!(is_told || step > 0, "{case}: not told");
                    let (left, told) = (-lowest(scene.body(block)), report.gap_violation());
                    assert!(
                        left < 2e-3 || told > 0.5 * left,
                        "{case}: {left} m, told {told}"
                    );
                }
                let low = lowest(scene.body(block));
                assert!((-1e-4..2e-3).contains(&low), "{case}: {low} m");
                assert!(scene.body(block).energy().kinetic < 1e-3, "{case}");
            }
        }
    }
}

/// Half and more of a block beyond a line comes out on the other side: the line does not say which is free.
#[test]
fn what_lies_across_a_line_goes_where_most_of_it_is() {
    for (deep, is_above) in [(0.13, true), (0.17, false)] {
        let mut scene = Scene::in_free_space(1.0 / 60.0);
        Made::Line.lay(&mut scene, 15);
        let block = FlexBodyBuilder::rectangle([0.5, 0.3], [5, 3]).material(rubber());
        let block = scene.flexible(block.translation([0.13, -deep]));
        scene.steps(60);
        let heights = scene.body(block).positions().chunks_exact(2);
        let beyond = heights.filter(|node| (node[1] > 0.0) != is_above).count();
        assert_eq!(beyond, 0, "{deep} m");
    }
}

/// Corners of blocks that are put into others part, for whatever angle: they stayed hooked by their corners, edge across edge, told as solved.
#[test]
fn corners_of_blocks_do_not_stay_hooked() {
    let mut dice = Dice(7);
    for is_small in [false, true] {
        for case in 0..20 {
            let mut scene = Scene::in_free_space(1.0 / 60.0);
            let [one, other] = [[0.6, 0.5], [0.5, 0.5]].map(|size| {
                let block = FlexBodyBuilder::rectangle(size, [6, 5]).material(rubber());
                scene.flexible(of_strain(block, is_small))
            });
            let (angle, deep) = (dice.between(0.0, 6.0), dice.between(0.02, 0.15));
            let (sin, cos) = angle.sin_cos();
            let corners = [[-0.25, -0.25], [0.25, -0.25], [0.25, 0.25], [-0.25, 0.25]];
            let turned = corners.map(|[x, y]: [f64; 2]| [x * cos - y * sin, x * sin + y * cos]);
            let low =
                turned.into_iter().fold(
                    [0.0, 9.0],
                    |low: [f64; 2], corner| {
                        if corner[1] < low[1] { corner } else { low }
                    },
                );
            let at = [dice.between(0.0, 0.6) - low[0], 0.5 - deep - low[1]];
            let Scene { world, bodies, .. } = &mut scene;
            assert_eq!(bodies.set_position(other, at, angle, world), Ok(()));
            for _ in 0..120 {
                scene.try_step().expect("a step");
            }
            let [first, second] = [one, other].map(|body| Outline::of(scene.body(body)));
            let deepest = first.depth_in(&second).max(second.depth_in(&first));
            let text = format!("{case}, small {is_small}: turned by {angle:.3}, {deep:.3} m");
            assert!(deepest < 1e-3, "{text}: {deepest} m are left");
            assert_eq!(scene.report().quality(), Quality::Solved, "{text}");
        }
    }
}

/// Bodies put across the wall of an inflated tyre leave it, in or out, and all comes to rest, or rolls away: it moved for ever, by up to 49 kJ of no source.
#[test]
fn what_is_put_across_the_wall_of_a_tyre_gets_no_energy() {
    let mut dice = Dice(300);
    for shape in ["block", "strip", "disc"] {
        for case in 0..6 {
            let mut scene = Scene::new(1.0 / 60.0);
            scene.ground(0.5);
            let rubber = LinearElastic::plane_stress(2e6, 0.3)
                .density(1000.0)
                .rayleigh(3e-3);
            let tyre = FlexBodyBuilder::annulus(0.13, 0.22, 0.08)
                .translation([0.0, 0.22])
                .material(rubber)
                .inner_pressure(InnerPressure::isothermal(2e4));
            scene.flexible(tyre);
            scene.steps(60);
            let (at, away) = (dice.between(0.3, 2.8), dice.between(0.12, 0.3));
            let body = match shape {
                "block" => FlexBodyBuilder::rectangle([0.4, 0.3], [4, 3]),
                "strip" => FlexBodyBuilder::rectangle([0.8, 0.1], [12, 1]),
                _ => FlexBodyBuilder::disc(0.15, 0.08),
            };
            let body = scene.flexible(body.material(rubber).translation([5.0, 5.0]));
            let place = [away * at.cos(), 0.25 + away * at.sin()];
            let turn = dice.between(-1.5, 1.5);
            let Scene { world, bodies, .. } = &mut scene;
            assert_eq!(bodies.set_position(body, place, turn, world), Ok(()));
            let mut n_unfinished = 0;
            // All energy that bodies have, at most in each five seconds.
            let mut most = [f64::NEG_INFINITY; 4];
            for step in 0..1200 {
                let report = scene.try_step().expect("a step");
                n_unfinished += usize::from(report.quality() == Quality::Unfinished);
                let energies = scene.bodies.iter().map(|(_, body)| {
                    let energy = body.energy();
                    energy.kinetic + energy.elastic + body.mass() * G * body.centre_of_mass()[1]
                });
                most[step / 300] = most[step / 300].max(energies.sum());
            }
            let text = format!("{shape} {case} at {place:.3?}, turned by {turn:.3}");
            println!("{text}: {most:.2?} J");
            assert!(most.is_sorted_by(|a, b| b <= a), "{text}: {most:.2?} J");
            assert!(n_unfinished < 10, "{text}: {n_unfinished} steps");
        }
    }
}
