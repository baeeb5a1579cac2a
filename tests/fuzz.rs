//! Random operations between steps: whatever comes, goes, is moved, joined, switched off or spoiled, the world goes on.

#[path = "fuzz/chance.rs"]
mod chance;
#[path = "fuzz/checks.rs"]
mod checks;
mod common;
#[path = "fuzz/flexible.rs"]
mod flexible;
#[path = "fuzz/hooks.rs"]
mod hooks;
#[path = "fuzz/joints.rs"]
mod joints;
#[path = "fuzz/play.rs"]
mod play;
#[path = "fuzz/rigid.rs"]
mod rigid;

use common::*;
use play::{Outcome, Play};

/// Operations per world, each followed by a step.
const N_OPERATIONS: usize = 1000;

/// Plays one seed through, empties the world, and looks for traces in it.
fn play(seed: u64) -> Outcome<()> {
    let mut play = Play::new(seed);
    for _ in 0..N_OPERATIONS {
        play.operate()?;
        play.step();
    }
    println!("{}", play.summary());
    // Bodies that are teleported into each other, reshaped and reweighed jam: a quarter of the steps of the worst world find no end.
    assert!(
        play.n_unfinished_untied <= play.n_steps_untied / 4,
        "{}",
        play.summary()
    );
    play.remove_all()?;
    // What comes next finds a world without traces of what was there.
    let scene = &mut play.scene;
    scene.world.gravity = vec2(0.0, -G);
    scene.world.integration_parameters.dt = real(1.0 / 60.0);
    let block = scene.flexible(soft_block(2e-2).translation([-0.5, 0.001]));
    scene.steps(120);
    let body = scene.body(block);
    let ratio = body.total_contact_force()[1] / (G * body.mass());
    assert!((ratio - 1.0).abs() < 1e-3, "{ratio} of the weight");
    Ok(())
}

/// One test per world, so that they run beside each other.
macro_rules! worlds {
    ($($(#[$how:meta])* $name:ident: $seed:expr,)*) => {$(
        #[test]
        $(#[$how])*
        fn $name() -> Outcome<()> {
            play($seed)
        }
    )*};
}

// Every one says: a thousand random operations between steps never panic, stay finite and leak nothing.
worlds! {
    a_thousand_operations_leave_a_sound_world_0: 0x2545_f491_4f6c_dd1d,
    a_thousand_operations_leave_a_sound_world_1: 0xda94_2042_e4dd_58b5,
    a_thousand_operations_leave_a_sound_world_2: 0xbf58_476d_1ce4_e5b9,
    a_thousand_operations_leave_a_sound_world_3: 0x94d0_49bb_1331_11eb,
    a_thousand_operations_leave_a_sound_world_4: 0xd1b5_4a32_d192_ed03,
    a_thousand_operations_leave_a_sound_world_5: 0x0000_0000_0000_0012,
    a_thousand_operations_leave_a_sound_world_6: 0xaef1_7502_108e_f2d9,
    a_thousand_operations_leave_a_sound_world_7: 0xf135_7aea_2e62_a9c5,
    a_thousand_operations_leave_a_sound_world_8: 0x5851_f42d_4c95_7f2d,
    a_thousand_operations_leave_a_sound_world_9: 0x1405_7b7e_f767_814f,
    a_thousand_operations_leave_a_sound_world_10: 0x80,
    a_thousand_operations_leave_a_sound_world_11: 0x98,
}

/// More worlds than one waits for every day: `FUZZ_SEEDS=100..200 cargo nextest run --release --test fuzz --run-ignored only`.
#[test]
#[ignore = "takes minutes"]
fn many_more_worlds_stay_sound() -> Outcome<()> {
    let range = std::env::var("FUZZ_SEEDS").unwrap_or_else(|_| "1..50".into());
    let (first, last) = range
        .split_once("..")
        .ok_or("`FUZZ_SEEDS` is first..last")?;
    let (first, last): (u64, u64) = (first.parse()?, last.parse()?);
    let mut wrong = Findings::default();
    for seed in first..last {
        let outcome = std::panic::catch_unwind(|| play(seed).map_err(|error| error.to_string()));
        wrong.check(matches!(outcome, Ok(Ok(()))), || format!("seed {seed}"));
    }
    wrong.report();
    Ok(())
}
