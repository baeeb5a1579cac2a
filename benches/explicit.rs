//! Cost of an explicit step over the size of the mesh: `cargo bench --bench explicit` prints times and the exponent, which
//! is one where the cost is linear.

use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let mut measured = Vec::new();
    for side in [22usize, 70, 223] {
        let (n_dofs, time) = step(side)?;
        println!("{n_dofs:>7} dofs  {:>9.2} us a step", 1e6 * time);
        measured.push((n_dofs as f64, time));
    }
    let [(small, fast), .., (large, slow)] = measured[..] else {
        return Ok(());
    };
    println!("exponent {:.3}", (slow / fast).ln() / (large / small).ln());
    Ok(())
}

/// Dofs of a resting block of `side × side` cells, and the mean time of its steps (s).
fn step(side: usize) -> Result<(usize, f64), Box<dyn Error>> {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = 1e-5;
    world.insert_collider(
        ColliderBuilder::cuboid(50.0, 0.5).translation(Vector::new(0.0, -0.5)),
        None,
    );
    let mut bodies = FlexBodySet::new();
    let body = bodies.insert(
        FlexBodyBuilder::rectangle([1.0, 1.0], [side, side])
            .small_strain()
            .material(LinearElastic::plane_stress(1e6, 0.3).density(1000.0)),
        &mut world,
    )?;
    let mut flex = FlexPipeline::new().with_integrator(Beta2::central_difference());
    let n_steps = 4_000_000 / (side * side);
    for _ in 0..20 {
        flex.step(&mut world, &mut bodies)?;
    }
    let start = Instant::now();
    for _ in 0..n_steps {
        flex.step(&mut world, &mut bodies)?;
    }
    let time = start.elapsed().as_secs_f64() / n_steps as f64;
    Ok((2 * bodies[body].n_nodes(), time))
}
