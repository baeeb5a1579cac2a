//! Scenes that are run as they say.

use super::{BEAM, STEEL, column, complaint, folder, last_row, told};
use std::path::Path;

#[test]
fn a_scene_is_run_as_it_says() {
    let folder = folder("run");
    let scene = format!(
        "[world]\nduration = 10.0\n\n{STEEL}{BEAM}\n[output]\nfolder = \"results\"\nvtu = true\nevery = 100\n\
         [[output.history]]\nbody = \"beam\"\nwhat = \"position\"\nnear = [1.0, 0.0]\n\
         [[output.history]]\nbody = \"beam\"\nwhat = \"reaction\"\n"
    );
    std::fs::write(folder.join("scene.toml"), scene).expect("a scene");
    let told = told(&["run", "scene.toml", "--quiet"], &folder);
    assert!(told.contains("600 steps, 0 cut, 0 unfinished"), "{told}");
    let row = last_row(&folder.join("results"));
    let load = 7800.0 * 9.81 * 0.02 * 0.05;
    let sag = load / (8.0 * 2.1e11 * 0.05 * 0.02_f64.powi(3) / 12.0);
    let tip = column(&row, "beam_y_m");
    assert!((-tip / sag - 1.0).abs() < 0.01, "{tip} m, {sag} m");
    let reaction = column(&row, "beam_reaction_y_N");
    assert!(
        (reaction / load - 1.0).abs() < 1e-3,
        "{reaction} N of {load} N"
    );
    assert!(folder.join("results/scene.pvd").exists(), "{told}");
    assert!(folder.join("results/still.svg").exists());
    // Elsewhere, and shorter.
    self::told(
        &[
            "run",
            "scene.toml",
            "--quiet",
            "--out",
            "else",
            "--steps",
            "3",
        ],
        &folder,
    );
    assert!(folder.join("else/history.csv").exists());
}

#[test]
fn bodies_meet_and_are_joined_as_a_scene_says() {
    let folder = folder("joined");
    let mesh =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/msh/strip_mixed_22_ascii.msh");
    let scene = format!(
        r#"
[world]
duration = 4.0
[materials.rubber]
young = 2e6
poisson = 0.4
density = 1000.0
rayleigh = 2e-2
[materials.heavy]
young = 2e6
poisson = 0.4
density = 3000.0
rayleigh = 2e-2
[[rigid]]
name = "floor"
kind = "fixed"
shape.halfspace.normal = [0.0, 1.0]
[[rigid]]
name = "post"
kind = "fixed"
shape.cuboid.size = [0.1, 0.1]
translation = [-3.0, 2.0]
[[rigid]]
name = "arm"
shape.cuboid.size = [1.0, 0.1]
translation = [-2.5, 2.0]
[[joint]]
kind = "revolute"
between = ["post", "arm"]
at = [-3.0, 2.0]
[[flexible]]
name = "strip"
material = "rubber"
regions = {{ right = "heavy" }}
shape.msh.file = {mesh:?}
translation = [0.0, 0.2]
[[flexible]]
name = "held"
material = "rubber"
shape.rectangle = {{ size = [0.4, 0.2], cells = [4, 2] }}
translation = [5.0, 3.0]
[[attachment]]
kind = "weld"
body = "held"
nodes.box = [[0.0, 0.2], [0.4, 0.2]]
[[output.history]]
body = "strip"
what = "contact_force"
[[output.history]]
body = "held"
what = "position"
"#
    );
    std::fs::write(folder.join("scene.toml"), scene).expect("a scene");
    let told = told(&["run", "scene.toml", "--quiet"], &folder);
    assert!(told.contains(" 0 unfinished"), "{told}");
    let row = last_row(&folder.join("out"));
    // Half of the strip is three times as heavy.
    let weight = 9.81 * (0.5 * 1000.0 + 0.5 * 3000.0);
    let found = column(&row, "strip_contact_y_N");
    assert!(
        (found / weight - 1.0).abs() < 1e-2,
        "{found} N of {weight} N"
    );
    assert!((column(&row, "held_y_m") - 3.1).abs() < 0.01);
}

/// A pendulum whose bob and post overlap at their joint swings: jointed bodies do not touch unless they are told to.
#[test]
fn a_pendulum_swings_about_its_joint() {
    let folder = folder("pendulum");
    let scene = format!(
        "[world]\nduration = 0.4\n{STEEL}\n[[rigid]]\nname = \"post\"\nkind = \"fixed\"\nshape.ball.radius = 0.05\n\
         [[rigid]]\nname = \"arm\"\nshape.cuboid.size = [0.1, 0.1]\ntranslation = [-0.1, 0.0]\n\
         [[joint]]\nkind = \"revolute\"\nbetween = [\"post\", \"arm\"]\nat = [0.0, 0.0]\n\
         [[flexible]]\nname = \"bar\"\nmaterial = \"steel\"\nsmall_strain = true\nshape.rectangle = {{ size = [1.0, 0.1], cells = [10, 1] }}\ntranslation = [-1.15, -0.05]\n\
         [[attachment]]\nkind = \"weld\"\nbody = \"bar\"\nnodes.box = [[1.0, 0.0], [1.0, 0.1]]\nto = \"arm\"\n\
         [[output.history]]\nbody = \"bar\"\nwhat = \"position\"\n"
    );
    std::fs::write(folder.join("scene.toml"), scene).expect("a scene");
    let told = told(&["run", "scene.toml", "--quiet"], &folder);
    assert!(told.contains(" 0 unfinished"), "{told}");
    let [x, y] = ["bar_x_m", "bar_y_m"].map(|name| column(&last_row(&folder.join("out")), name));
    assert!(y < -0.3, "it has swung down: {x}, {y}");
    assert!(
        (x.hypot(y) - 0.65).abs() < 0.01,
        "about its joint: {x}, {y}"
    );
}

#[test]
fn the_doctor_calls_bodies_by_the_names_of_the_scene() {
    let folder = folder("doctor");
    let soft = "[materials.steel]\nyoung = 1e6\npoisson = 0.3\ndensity = 1000.0\n";
    let scene = format!("{soft}{BEAM}small_strain = true\n");
    std::fs::write(folder.join("scene.toml"), scene).expect("a scene");
    let found = told(&["doctor", "scene.toml"], &folder);
    assert!(found.starts_with("`beam` of small strain sags"), "{found}");
}

/// A wheel that rolls and a box that falls freely, beside what their equations say.
#[test]
fn histories_tell_of_rigid_bodies() {
    let folder = folder("rigid");
    let scene = "[world]\ndt = 0.005\nduration = 1.0\n\
         [[rigid]]\nname = \"ground\"\nkind = \"fixed\"\nshape.halfspace.normal = [0.0, 1.0]\n\
         [[rigid]]\nname = \"spun\"\nkind = \"kinematic\"\nshape.ball.radius = 0.1\ntranslation = [5.0, 3.0]\nrotation = 1.0\nangvel = 10.0\n\
         [[rigid]]\nname = \"thrown\"\nshape.cuboid.size = [0.2, 0.2]\ntranslation = [0.0, 50.0]\nlinvel = [3.0, 0.0]\n\
         [output]\nreplay = false\n\
         [[output.history]]\nbody = \"spun\"\nwhat = \"angle\"\n\
         [[output.history]]\nbody = \"spun\"\nwhat = \"angular_velocity\"\n\
         [[output.history]]\nbody = \"thrown\"\nwhat = \"position\"\n\
         [[output.history]]\nbody = \"thrown\"\nwhat = \"velocity\"\n";
    std::fs::write(folder.join("scene.toml"), scene).expect("a scene");
    told(&["run", "scene.toml", "--quiet"], &folder);
    let row = last_row(&folder.join("out"));
    // More than a turn, from where it began.
    assert!(
        (column(&row, "spun_angle_rad") - 10.0).abs() < 1e-3,
        "{row:?}"
    );
    assert!((column(&row, "spun_angvel_rad_per_s") - 10.0).abs() < 1e-6);
    assert!((column(&row, "thrown_x_m") - 3.0).abs() < 1e-4);
    // Rapier's steps are of first order: g dt t/2 beside the fall.
    let fall = 50.0 - column(&row, "thrown_y_m");
    assert!((fall - 0.5 * 9.81).abs() < 0.5 * 9.81 * 0.006, "{fall}");
    assert!((column(&row, "thrown_vy_m_per_s") + 9.81).abs() < 1e-3);
}

/// The forces of a block on a plate that carries it, told of both.
#[test]
fn histories_tell_what_presses_a_rigid_body() {
    let folder = folder("pressed");
    let scene = format!(
        "[world]\nduration = 2.0\n{STEEL}[materials.rubber]\nyoung = 1e6\npoisson = 0.3\ndensity = 1000.0\nrayleigh = 1e-2\n\
         [[rigid]]\nname = \"table\"\nkind = \"fixed\"\nshape.cuboid.size = [4.0, 1.0]\ntranslation = [0.0, -0.5]\n\
         [[flexible]]\nname = \"block\"\nmaterial = \"rubber\"\nshape.rectangle = {{ size = [0.4, 0.2], cells = [4, 2] }}\nthickness = 0.5\n\
         [[output.history]]\nbody = \"table\"\nwhat = \"contact_force\"\n\
         [[output.history]]\nbody = \"block\"\nwhat = \"angle\"\n"
    );
    std::fs::write(folder.join("scene.toml"), scene).expect("a scene");
    told(&["run", "scene.toml", "--quiet"], &folder);
    let row = last_row(&folder.join("out"));
    let weight = 9.81 * 1000.0 * 0.4 * 0.2 * 0.5;
    let found = column(&row, "table_contact_y_N");
    assert!(
        (found / weight + 1.0).abs() < 1e-2,
        "{found} N of {weight} N"
    );
    assert!(column(&row, "block_angle_rad").abs() < 1e-3);
}

/// Whoever reads nothing but `--help` gets a scene that runs, and every key of it is described.
#[test]
fn the_example_is_sound_and_described() {
    let folder = folder("example");
    let example = told(&["example"], &folder);
    std::fs::write(folder.join("scene.toml"), &example).expect("a scene");
    let sound = told(&["doctor", "scene.toml"], &folder);
    assert_eq!(sound, "nothing is likely a mistake\n");
    let ran = told(&["run", "scene.toml", "--quiet"], &folder);
    assert!(ran.contains(" 0 unfinished"), "{ran}");
    let row = last_row(&folder.join("out"));
    // The board swings back to its own sag under its weight once the ring has gone.
    let sag = 7800.0 * 9.81 * 0.02 * 2.0_f64.powi(4) / (8.0 * 2.1e11 * 0.02_f64.powi(3) / 12.0);
    let tip = column(&row, "tip_y_m");
    assert!(tip.abs() < 3.0 * sag, "{tip} m, {sag} m");
    let schema = told(&["schema"], &folder);
    for key in ["shape", "near", "thickness", "linvel", "every"] {
        assert!(schema.contains(&format!("\"{key}\"")), "{key}");
    }
    let schema: serde_json::Value = serde_json::from_str(&schema).expect("JSON");
    let defaults = &schema["$defs"]["Flexible"]["properties"];
    assert_eq!(defaults["friction"]["default"], 0.5);
    assert_eq!(
        schema["$defs"]["World"]["properties"]["most_nodes"]["default"],
        100_000
    );
}

/// A foam that grows thicker as it is drawn has no law for large strains in plane stress: whoever has not asked for small ones is told.
#[test]
fn what_has_no_law_for_large_strains_is_asked_to_be_a_body_of_small_ones() {
    let folder = folder("auxetic");
    let foam = STEEL.replace("0.3", "-0.9");
    let scene = format!("[world]\nduration = 0.1\n{foam}{BEAM}");
    std::fs::write(folder.join("scene.toml"), &scene).expect("a scene");
    let refused = complaint(&["run", "scene.toml", "--quiet"], &folder);
    assert!(refused.contains("`small_strain = true`"), "{refused}");
    let scene = format!("{scene}small_strain = true\n");
    std::fs::write(folder.join("scene.toml"), scene).expect("a scene");
    let ran = told(&["run", "scene.toml", "--quiet"], &folder);
    assert!(ran.contains("6 steps, 0 cut, 0 unfinished"), "{ran}");
}

/// What sleeps has energy, and so has what rapier moves alone.
#[test]
fn energies_are_those_of_all_bodies() {
    let folder = folder("energies");
    let scene = format!(
        "[world]\nduration = 3.0\ngravity = [0.0, 0.0]\n{STEEL}{BEAM}\
         force = [{{ nodes.box = [[1.0, -inf], [inf, inf]], force = [0.0, -10.0] }}]\n\
         [[rigid]]\nname = \"ball\"\nshape.ball.radius = 0.1\ndensity = 1000.0\ntranslation = [0.0, 9.0]\nlinvel = [2.0, 0.0]\n"
    );
    let scene = scene.replace("rayleigh = 1e-3", "rayleigh = 1e-2");
    std::fs::write(folder.join("scene.toml"), scene).expect("a scene");
    let told = told(&["run", "scene.toml", "--quiet"], &folder);
    let row = last_row(&folder.join("out"));
    let stiffness = 3.0 * 2.1e11 * 0.05 * 0.02_f64.powi(3) / 12.0;
    let stored = 0.5 * 100.0 / stiffness;
    let elastic = column(&row, "elastic_J");
    assert!(
        (elastic / stored - 1.0).abs() < 0.01,
        "{elastic} J, {stored} J"
    );
    let mass = 1000.0 * std::f64::consts::PI * 0.01;
    let kinetic = column(&row, "kinetic_J");
    assert!((kinetic / (2.0 * mass) - 1.0).abs() < 1e-3, "{kinetic} J");
    assert!(told.contains("6.2834e1 J at the end"), "{told}");
}

/// A ground far larger than the picture costs the PNG, and nothing else.
#[test]
fn what_cannot_be_painted_is_told_and_the_rest_is_written() {
    let folder = folder("tiny");
    let scene = "[world]\nduration = 0.02\n[materials.m]\nyoung = 1e6\npoisson = 0.3\ndensity = 1000.0\n\
        [[flexible]]\nname = \"disc\"\nmaterial = \"m\"\nshape.disc = { radius = 0.005, edge = 0.00125 }\ntranslation = [0.0, 0.0051]\n\
        [[rigid]]\nkind = \"fixed\"\nshape.halfspace.normal = [0.0, 1.0]\n";
    std::fs::write(folder.join("scene.toml"), scene).expect("a scene");
    let output = super::foil2d(&["run", "scene.toml"], &folder);
    let [told, notes] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    assert!(output.status.success(), "{notes}");
    assert!(
        told.contains("replay.html") && told.contains("history.csv"),
        "{told}"
    );
    let is_painted = folder.join("out/still.png").exists();
    assert_eq!(is_painted, told.contains("still.png"), "{told}");
    assert_ne!(
        is_painted,
        notes.contains("still.png is left out"),
        "{notes}"
    );
}

/// An axis is a direction, however short.
#[test]
fn a_slide_along_a_tiny_axis_holds() {
    let folder = folder("slide");
    let scene = "[world]\nduration = 0.5\n\
        [[rigid]]\nname = \"post\"\nkind = \"fixed\"\nshape.ball.radius = 0.1\n\
        [[rigid]]\nname = \"cart\"\nshape.ball.radius = 0.1\ntranslation = [1.0, 0.0]\n\
        [[joint]]\nkind.prismatic.axis = [1e-300, 0.0]\nbetween = [\"post\", \"cart\"]\nat = [0.0, 0.0]\n\
        [[output.history]]\nbody = \"cart\"\nwhat = \"position\"\n";
    std::fs::write(folder.join("scene.toml"), scene).expect("a scene");
    told(&["run", "scene.toml", "--quiet"], &folder);
    let height = column(&last_row(&folder.join("out")), "cart_y_m");
    assert!(height.abs() < 1e-3, "{height} m");
}

/// An impact of milliseconds is looked at step by step.
#[test]
fn short_runs_have_frames_of_their_steps() {
    let folder = folder("frames");
    let n_frames = |output: &str| {
        let scene =
            format!("[world]\ndt = 1e-5\nduration = 4e-4\n{STEEL}{BEAM}\n[output]\n{output}\n");
        std::fs::write(folder.join("scene.toml"), scene).expect("a scene");
        told(&["run", "scene.toml", "--quiet"], &folder);
        let page = std::fs::read_to_string(folder.join("out/replay.html")).expect("a replay");
        let times = page
            .split("\"times\":\"")
            .nth(1)
            .and_then(|rest| rest.split('"').next());
        // Numbers of four bytes, by four characters to three of these.
        times.expect("times").trim_end_matches('=').len() * 3 / 16
    };
    assert_eq!(n_frames(""), 40);
    assert_eq!(n_frames("every = 1"), 40);
    assert_eq!(n_frames("every = 10"), 4);
}

/// Long steps and long runs are named before they are begun.
#[test]
fn the_doctor_names_long_steps_and_long_runs() {
    let folder = folder("long");
    let found = |world: &str| {
        let scene = format!("[world]\n{world}\n{STEEL}{BEAM}");
        std::fs::write(folder.join("scene.toml"), scene).expect("a scene");
        told(&["doctor", "scene.toml"], &folder)
    };
    assert!(found("duration = 10.0").contains("nothing is likely a mistake"));
    assert!(found("dt = 0.5\nduration = 10.0").contains("a step of 0.500 s is long"));
    let hours = found("dt = 1e-8\nduration = 10.0");
    assert!(
        hours.contains("1000000000 steps") && hours.contains("hours"),
        "{hours}"
    );
}
