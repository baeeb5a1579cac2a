//! A thousand random shots.

use crate::range::{Range, Shot};

#[test]
fn a_thousand_random_shots_never_pass_through_what_they_hit() {
    let (mut tunnelled, mut errors, mut bad, mut held, mut linear) = (0, 0, 0, 0, 0);
    let (mut nheld, mut nlin) = (0, 0);
    let from: u64 = std::env::var("FROM").map_or(0, |v| v.parse().unwrap());
    let to: u64 = std::env::var("TO").map_or(1000, |v| v.parse().unwrap());
    for seed in from..to {
        let shot = Shot::random(seed);
        let start = std::time::Instant::now();
        let outcome = Range::new(shot).run();
        let took = start.elapsed().as_secs_f64();
        tunnelled += i32::from(outcome.tunnelled.is_some());
        errors += i32::from(outcome.error.is_some());
        bad += i32::from(outcome.not_finite);
        held += i32::from(outcome.n_held > 0);
        linear += i32::from(outcome.n_linearized > 0);
        nheld += outcome.n_held;
        nlin += outcome.n_linearized;
        if outcome.tunnelled.is_some() || outcome.error.is_some() || outcome.not_finite || took > 0.5 {
            println!("{took:.2}s {outcome:?}\n   {shot:?}");
        } else if outcome.n_held > 0 {
            println!("held {} {seed} {:?} {:?} v {} dt 1/{}", outcome.n_held, shot.target, shot.projectile, shot.speed, 1.0/shot.dt);
        }
    }
    println!("tunnelled {tunnelled} errors {errors} not finite {bad} held {held} ({nheld}) linear {linear} ({nlin})");
}
