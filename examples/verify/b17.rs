//! B17, the incline: a block slides with what friction leaves, or sticks for ever.
//!
//! ```text
//!        __          s = g (sin a - mu cos a) t²/2    if mu < tan a
//!      _/ /-_        sticks                           if mu > tan a
//!     /__/   '-_     on the flat it stops after v0²/(2 mu g), in v0/(mu g)
//!  a (            '-_
//! ```
//!
//! Data: flexible block 1 × 0.5 m, E = 1e8 Pa, on a rigid floor; gravity is turned instead of the floor. A slide is measured
//! from a start already pressed, since a block let go unstrained presses with twice its weight in its first step.
//!
//! Excellent: acceleration, friction and creep to 1e-6 or better, over 100,000 steps of sticking.

use super::Outcome;
use super::scene::{G, Scene};
use super::sheet::Sheet;
use foil2d::prelude::*;
use std::error::Error;

/// A block at rest on the flat floor, pressed by the gravity across an incline of `angle`.
fn block(
    angle: f64,
    mu: f64,
    rate: f64,
    x: f64,
) -> Result<(Scene, FlexBodyHandle), Box<dyn Error + Send + Sync>> {
    let mut scene = Scene::new(1.0 / rate, Beta2::default()).with_gravity(0.0, -G * angle.cos());
    scene.ground(mu);
    let builder = FlexBodyBuilder::rectangle([1.0, 0.5], [4, 2])
        .small_strain()
        .material(
            LinearElastic::plane_stress(1e8, 0.3)
                .density(1000.0)
                .rayleigh(1e-3),
        )
        .friction(mu)
        .translation([x, 0.0]);
    let body = scene.add(builder)?;
    Ok((scene, body))
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    slide(sheet)?;
    stop(sheet)?;
    stick(sheet)
}

fn slide(sheet: &mut Sheet) -> Outcome {
    for rate in [60.0, 1000.0] {
        let (angle, mu) = (0.5f64, 0.3);
        let (mut scene, body) = block(angle, mu, rate, -45.0)?;
        scene.steps(sheet.n_steps(rate as usize))?;
        scene.world.gravity = super::scene::vector(G * angle.sin(), -G * angle.cos());
        // The block leans into the slide first.
        scene.steps(sheet.n_steps(rate as usize))?;
        let n = sheet.n_steps(rate as usize);
        let start = scene.body(body).linvel()[0];
        scene.steps(n)?;
        let gained = scene.body(body).linvel()[0] - start;
        let exact = G * (angle.sin() - mu * angle.cos());
        let found = gained / (n as f64 * scene.dt());
        sheet.relative(
            format!("acceleration of the slide, {rate} Hz (m/s²)"),
            exact,
            found,
            1e-6,
        );
    }
    Ok(())
}

fn stop(sheet: &mut Sheet) -> Outcome {
    let (mu, rate) = (0.4, 1000.0);
    let (mut scene, body) = block(0.0, mu, rate, 0.0)?;
    scene.steps(sheet.n_steps(1000))?;
    let n_nodes = scene.body(body).n_nodes();
    scene.bodies[body].set_velocities(&[3.0, 0.0].repeat(n_nodes))?;
    // Friction sets in within a step and makes the block lean back: the law is asked from a tenth of a second on.
    scene.steps(sheet.n_steps(100))?;
    let (start, speed) = (
        scene.body(body).centre_of_mass()[0],
        scene.body(body).linvel()[0],
    );
    let (mut time, mut before) = (f64::NAN, speed);
    for step in 0..sheet.n_steps(1400) {
        scene.step()?;
        let now = scene.body(body).linvel()[0];
        // Friction acts until the velocity is zero, within this step.
        if time.is_nan() && now < mu * G * scene.dt() {
            time = (f64::from(u32::try_from(step)?) + before / (mu * G * scene.dt())) * scene.dt();
        }
        before = now;
    }
    let way = scene.body(body).centre_of_mass()[0] - start;
    // The last step ends with the block at rest: its way is known to mu g dt²/2 = 2e-6 m. The lean is given back:
    // mu rho g h²/2G = 1e-5 m.
    sheet.relative(
        "time of the stop, from its speed (s)",
        speed / mu / G,
        time,
        1e-3,
    );
    sheet.relative(
        "distance of the stop, from its speed (m)",
        speed * speed / 2.0 / mu / G,
        way,
        2e-5,
    );
    Ok(())
}

fn stick(sheet: &mut Sheet) -> Outcome {
    let (angle, mu, rate) = (0.4f64, 0.5, 60.0);
    let (mut scene, body) = block(angle, mu, rate, 0.0)?;
    scene.world.gravity = super::scene::vector(G * angle.sin(), -G * angle.cos());
    scene.steps(sheet.n_steps(3000))?;
    let start = scene.body(body).centre_of_mass();
    let n = sheet.choose(100_000, 10_000);
    scene.steps(sheet.n_steps(n))?;
    let end = scene.body(body).centre_of_mass();
    let creep = (end[0] - start[0]).hypot(end[1] - start[1]);
    sheet.absolute(
        format!("creep in {n} steps of sticking (m)"),
        0.0,
        creep,
        1e-9,
    );
    let [fx, fy] = scene.force_on(body);
    let gravity = scene.world.gravity;
    let tangent = f64::from(gravity.x) / f64::from(-gravity.y);
    sheet.relative(
        "friction over pressure, sticking (-)",
        tangent,
        -fx / fy,
        1e-6,
    );
    Ok(())
}
