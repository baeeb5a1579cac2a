//! What one small flexible body costs a world of a thousand rigid boxes that it does not touch.
//!
//! ```text
//! cargo bench --bench overhead
//! ```
//!
//! Two worlds hold the same boxes, in towers that stand: one is stepped by rapier alone, the other with a flexible block beside
//! them. Both take turns step by step, so what disturbs the machine disturbs them alike; the ratio is that of the medians.

use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use std::error::Error;
use std::time::Instant;

const N_BOXES: usize = 1000;

/// Rapier alone is one.
const MOST: f64 = 1.35;

fn boxes(can_sleep: bool) -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    let floor = ColliderBuilder::cuboid(500.0, 0.5).translation(Vector::new(0.0, -0.5));
    world.insert_collider(floor, None);
    for index in 0..N_BOXES {
        let (column, row) = ((index / 5) as f32, (index % 5) as f32);
        let at = Vector::new((1.5 * column - 150.0) as _, (0.5 + row) as _);
        let body = RigidBodyBuilder::dynamic()
            .translation(at)
            .can_sleep(can_sleep);
        world.insert(body, ColliderBuilder::cuboid(0.5, 0.5));
    }
    world
}

/// Median times of a step (s): rapier alone, and with a flexible block.
fn measure(can_sleep: bool, n: usize) -> Result<[f64; 2], Box<dyn Error>> {
    let (mut alone, mut beside) = (boxes(can_sleep), boxes(can_sleep));
    let mut flex_bodies = FlexBodySet::new();
    let block = FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4])
        .small_strain()
        .material(
            LinearElastic::plane_stress(1e6, 0.3)
                .density(1000.0)
                .rayleigh(1e-2),
        )
        .can_sleep(false)
        .translation([200.0, 0.01]);
    flex_bodies.insert(block, &mut beside)?;
    let mut flex = FlexPipeline::new();
    for _ in 0..n {
        alone.step();
        flex.step(&mut beside, &mut flex_bodies)?;
    }
    let mut times = [Vec::new(), Vec::new()];
    for _ in 0..n {
        let start = Instant::now();
        alone.step();
        let between = Instant::now();
        flex.step(&mut beside, &mut flex_bodies)?;
        times[0].push((between - start).as_secs_f64());
        times[1].push(between.elapsed().as_secs_f64());
    }
    Ok(times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[n / 2]
    }))
}

fn main() -> Result<(), Box<dyn Error>> {
    let is_measured = std::env::args().any(|argument| argument == "--bench");
    let n = if is_measured { 300 } else { 2 };
    for (can_sleep, state) in [(false, "awake"), (true, "asleep")] {
        let [alone, beside] = measure(can_sleep, n)?;
        let ratio = beside / alone;
        println!(
            "{N_BOXES} boxes {state}: {:.1} us alone, {:.1} us beside a flexible block, {ratio:.3} times",
            1e6 * alone,
            1e6 * beside
        );
        if is_measured && !can_sleep && ratio > MOST {
            return Err(format!("{ratio:.3} times rapier alone, more than {MOST}").into());
        }
    }
    Ok(())
}
