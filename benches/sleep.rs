//! What a settled pile costs while it sleeps.
//!
//! ```text
//! cargo bench --bench sleep
//! ```
//!
//! Fifty rigid boxes and twenty flexible blocks in towers, let settle from a centimetre above each other; beside it the same scene
//! with rigid blocks in place of the flexible ones, stepped by rapier alone. Both take turns in batches, so what disturbs the machine
//! disturbs them alike; the ratio is that of the medians.

use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use std::error::Error;
use std::time::Instant;

const N_TOWERS: usize = 10;

/// Rapier alone is one.
const MOST: f64 = 1.2;

/// Steps of a batch: a sleeping step is shorter than a clock can tell.
const BATCH: usize = 200;

/// Levels of a tower; flexible blocks are the fourth and the sixth. Four rigid boxes and more on one soft block rock for much longer.
const LEVELS: [bool; 7] = [false, false, false, true, false, true, false];

/// All must sleep within this time of the drop (s).
const PATIENCE: f64 = 5.0;

#[derive(Default)]
struct Pile {
    world: PhysicsWorld,
    flex_bodies: FlexBodySet,
    flex: FlexPipeline,
}

impl Pile {
    fn new(has_flexible: bool) -> Result<Self, Box<dyn Error>> {
        let mut pile = Self::default();
        let floor = ColliderBuilder::cuboid(50.0, 0.5).translation(Vector::new(0.0, -0.5));
        pile.world.insert_collider(floor, None);
        for tower in 0..N_TOWERS {
            for (level, is_flexible) in LEVELS.into_iter().enumerate() {
                let (x, y) = (1.5 * tower as f64, 0.01 + 0.31 * level as f64);
                pile.add(x, y, is_flexible, has_flexible)?;
            }
        }
        Ok(pile)
    }

    /// A block of 0.5 m × 0.3 m whose lower side is at `y`.
    fn add(
        &mut self,
        x: f64,
        y: f64,
        is_block: bool,
        has_flexible: bool,
    ) -> Result<(), Box<dyn Error>> {
        if is_block && has_flexible {
            let material = LinearElastic::plane_stress(1e7, 0.3)
                .density(1000.0)
                .rayleigh(1e-2);
            let block = FlexBodyBuilder::rectangle([0.5, 0.3], [5, 3])
                .small_strain()
                .material(material)
                .translation([x - 0.25, y]);
            self.flex_bodies.insert(block, &mut self.world)?;
            return Ok(());
        }
        let density = if is_block { 1000.0 } else { 500.0 };
        self.world.insert(
            RigidBodyBuilder::dynamic().translation(Vector::new(x as _, (y + 0.15) as _)),
            ColliderBuilder::cuboid(0.25, 0.15).density(density),
        );
        Ok(())
    }

    fn step(&mut self) -> Result<(), Box<dyn Error>> {
        if self.flex_bodies.is_empty() {
            self.world.step();
        } else {
            self.flex.step(&mut self.world, &mut self.flex_bodies)?;
        }
        Ok(())
    }

    fn is_asleep(&self) -> bool {
        self.world.bodies.iter().all(|(_, body)| body.is_sleeping())
    }

    /// Time until all sleep (s).
    fn settle(&mut self) -> Result<f64, Box<dyn Error>> {
        for step in 1..=1200 {
            self.step()?;
            if self.is_asleep() {
                return Ok(f64::from(step) / 60.0);
            }
        }
        Err("the pile does not sleep within 20 s".into())
    }

    /// Time of a step (s), averaged over a batch; that of rapier's own step of the same world if it `is_alone`.
    fn batch(&mut self, is_alone: bool) -> Result<f64, Box<dyn Error>> {
        let start = Instant::now();
        for _ in 0..BATCH {
            if is_alone {
                self.world.step();
            } else {
                self.step()?;
            }
        }
        Ok(start.elapsed().as_secs_f64() / BATCH as f64)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let is_measured = std::env::args().any(|argument| argument == "--bench");
    let n = if is_measured { 101 } else { 1 };
    let mut piles = [Pile::new(false)?, Pile::new(true)?];
    let asleep_after = [piles[0].settle()?, piles[1].settle()?];
    let mut times = [Vec::new(), Vec::new(), Vec::new()];
    for _ in 0..n {
        times[0].push(piles[0].batch(true)?);
        times[1].push(piles[1].batch(false)?);
        times[2].push(piles[1].batch(true)?);
    }
    let [alone, ours, bare] = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[n / 2]
    });
    let ratio = ours / alone;
    println!(
        "70 rigid bodies: asleep after {:.2} s, {:.3} us a step; 50 rigid and 20 flexible: after {:.2} s, {:.3} us, {ratio:.3} times; rapier's part of that {:.3} us",
        asleep_after[0],
        1e6 * alone,
        asleep_after[1],
        1e6 * ours,
        1e6 * bare
    );
    if asleep_after[1] > PATIENCE {
        return Err(format!("asleep after {} s, not {PATIENCE}", asleep_after[1]).into());
    }
    if is_measured && ratio > MOST {
        return Err(format!("{ratio:.3} times rapier alone, more than {MOST}").into());
    }
    Ok(())
}
