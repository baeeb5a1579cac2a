//! The program `foil2d`, as a user runs it.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder of its own for a test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("cli")
        .join(name);
    // What an earlier run has left would hide what this one does not write.
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder in target");
    folder
}

fn foil2d(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_foil2d"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

/// What a command that succeeds prints.
fn told(arguments: &[&str], folder: &Path) -> String {
    let output = foil2d(arguments, folder);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).expect("text")
}

/// What a command that fails complains about.
fn complaint(arguments: &[&str], folder: &Path) -> String {
    let output = foil2d(arguments, folder);
    assert!(!output.status.success(), "{arguments:?} is refused");
    assert!(output.stdout.is_empty(), "nothing else is told");
    String::from_utf8(output.stderr).expect("text")
}

const STEEL: &str =
    "[materials.steel]\nyoung = 2.1e11\npoisson = 0.3\ndensity = 7800.0\nrayleigh = 1e-3\n";

const BEAM: &str = r#"
[[flexible]]
name = "beam"
material = "steel"
shape.rectangle = { size = [1.0, 0.02], cells = [20, 2] }
thickness = 0.05
pin = [{ nodes.box = [[-inf, -inf], [0.0, inf]] }]
"#;

/// The last row of the table of histories, by the names of its columns.
fn last_row(folder: &Path) -> Vec<(String, f64)> {
    let table = std::fs::read_to_string(folder.join("history.csv")).expect("histories");
    let mut lines = table.lines();
    let names: Vec<String> = lines
        .next()
        .expect("names")
        .split(',')
        .map(String::from)
        .collect();
    let last = lines.last().expect("a row").split(',');
    let values = last.map(|value| value.parse().expect("a number"));
    names.into_iter().zip(values).collect()
}

fn column(row: &[(String, f64)], name: &str) -> f64 {
    let found = row.iter().find(|(own, _)| own == name);
    found
        .unwrap_or_else(|| panic!("no column {name} in {row:?}"))
        .1
}

#[test]
fn a_drawing_becomes_a_picture_and_a_replay_in_one_command() {
    let folder = folder("drop");
    let drawing = r#"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="150" viewBox="0 0 200 150">
        <path id="wedge" d="M20 20 L90 30 L60 90 Z"/>
        <path id="ring" fill-rule="evenodd" d="M110 20 H180 V90 H110 Z M130 40 H160 V70 H130 Z"/></svg>"#;
    std::fs::write(folder.join("shapes.svg"), drawing).expect("a drawing");
    let told = told(
        &["drop", "shapes.svg", "--duration", "2", "--quiet"],
        &folder,
    );
    assert!(told.contains("120 steps, 0 cut, 0 unfinished"), "{told}");
    let out = folder.join("out");
    let still = std::fs::read_to_string(out.join("still.svg")).expect("a picture");
    assert!(still.matches("<polygon").count() > 100, "cells are drawn");
    let replay = std::fs::read_to_string(out.join("replay.html")).expect("a replay");
    assert!(replay.contains("<canvas") && replay.len() > 20_000);
    // The scene that was run is there to be changed, and runs as well.
    let scene = std::fs::read_to_string(out.join("scene.toml")).expect("the scene");
    assert_eq!(scene.matches("[[flexible]]").count(), 2);
    let again = self::told(
        &["run", "out/scene.toml", "--steps", "5", "--quiet"],
        &folder,
    );
    assert!(again.contains("5 steps"), "{again}");
    let energy = column(&last_row(&folder.join("out/out")), "kinetic_J");
    assert!(energy > 0.0);
    let sound = self::told(&["doctor", "out/scene.toml"], &folder);
    assert_eq!(sound, "nothing is likely a mistake\n");
}

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

#[test]
fn what_is_wrong_in_a_scene_is_told_where_it_stands() {
    let folder = folder("wrong");
    let cases = [
        ("[world]\ndurration = 1.0\n", "scene.toml:2:1", "durration"),
        ("[world]\nduration = \n", "scene.toml:2:1", "value"),
        (
            "[[flexible]]\nname = \"a\"\nmaterial = \"steal\"\nshape.disc = { radius = 1.0, edge = 0.3 }\n",
            "scene.toml:3:12",
            "`steal`",
        ),
        (
            "[materials.bad]\nyoung = -1.0\npoisson = 0.3\ndensity = 1.0\n[[flexible]]\nname = \"a\"\nmaterial = \"bad\"\nshape.disc = { radius = 1.0, edge = 0.3 }\n",
            "scene.toml:1:1",
            "-1",
        ),
        (
            "[[rigid]]\nshape.halfspace.normal = [0.0, 0.0]\nkind = \"fixed\"\n",
            "scene.toml:2:26",
            "direction",
        ),
        (
            "[[rigid]]\nname = \"a\"\nshape.ball.radius = 1.0\n[[rigid]]\nname = \"a\"\nshape.ball.radius = 1.0\n",
            "scene.toml:5:8",
            "already",
        ),
        (
            "[[rigid]]\nname = \"a\"\nshape.ball.radius = 1.0\n[[joint]]\nkind = \"fixed\"\nbetween = [\"a\", \"b\"]\nat = [0.0, 0.0]\n",
            "scene.toml:6:17",
            "choose one of a",
        ),
    ];
    for (text, place, word) in cases {
        std::fs::write(folder.join("scene.toml"), text).expect("a scene");
        let complaint = complaint(&["run", "scene.toml"], &folder);
        assert!(
            complaint.contains(place) && complaint.contains(word),
            "{text}: {complaint}"
        );
    }
    let with_beam = |from: &str, to: &str| format!("{STEEL}{}", BEAM.replace(from, to));
    let cases = [
        (
            with_beam("[[-inf, -inf], [0.0, inf]]", "[[5.0, 5.0], [6.0, 6.0]]"),
            "no node",
        ),
        (
            with_beam(
                "nodes.box = [[-inf, -inf], [0.0, inf]]",
                "nodes.group = \"wall\"",
            ),
            "`wall`",
        ),
        (
            with_beam("thickness = 0.05", "thickness = -0.05"),
            "thickness",
        ),
        (
            with_beam(
                "shape.rectangle = { size = [1.0, 0.02], cells = [20, 2] }",
                "shape.msh.file = \"nowhere.msh\"",
            ),
            "nowhere.msh",
        ),
    ];
    for (text, word) in cases {
        std::fs::write(folder.join("scene.toml"), &text).expect("a scene");
        let complaint = complaint(&["run", "scene.toml"], &folder);
        let is_placed = complaint.contains("scene.toml:");
        assert!(is_placed && complaint.contains(word), "{text}: {complaint}");
    }
    let complaint = complaint(&["run", "missing.toml"], &folder);
    assert!(complaint.contains("missing.toml"), "{complaint}");
}

/// Each of these once made the program panic, run for ever, or compute nonsense.
#[test]
fn numbers_that_no_world_has_are_refused_where_they_stand() {
    let folder = folder("numbers");
    let ball = |key: &str| format!("[[rigid]]\nshape.ball.radius = 1.0\n{key}\n");
    let jointed = |joint: &str| {
        let two = "[[rigid]]\nname = \"a\"\nshape.ball.radius = 1.0\n[[rigid]]\nname = \"b\"\nshape.ball.radius = 1.0\n";
        format!("{two}[[joint]]\n{joint}\n")
    };
    let cases = [
        "[world]\ndt = 0\n".to_owned(),
        "[world]\ndt = 1e-300\n".to_owned(),
        "[world]\ndt = nan\n".to_owned(),
        "[world]\nduration = inf\n".to_owned(),
        "[world]\nduration = -1.0\n".to_owned(),
        "[world]\ngravity = [nan, 0.0]\n".to_owned(),
        "[world]\ndecay = -1.0\n".to_owned(),
        "[output]\nevery = 0\n".to_owned(),
        "[[rigid]]\nshape.hull.points = []\n".to_owned(),
        "[[rigid]]\nshape.ball.radius = -1.0\n".to_owned(),
        "[[rigid]]\nshape.cuboid.size = [1.0, nan]\n".to_owned(),
        "[[rigid]]\nshape.halfspace.normal = [0.0, 1.0]\n".to_owned(),
        ball("density = -1.0"),
        ball("friction = -1.0"),
        ball("translation = [nan, 0.0]"),
        ball("angvel = inf"),
        jointed("kind = \"fixed\"\nbetween = [\"a\", \"a\"]\nat = [0.0, 0.0]"),
        jointed("kind = \"fixed\"\nbetween = [\"a\", \"b\"]\nat = [nan, 0.0]"),
        jointed("kind.prismatic.axis = [0.0, 0.0]\nbetween = [\"a\", \"b\"]\nat = [0.0, 0.0]"),
    ];
    for text in cases {
        std::fs::write(folder.join("scene.toml"), &text).expect("a scene");
        for command in ["run", "doctor"] {
            let complaint = complaint(&[command, "scene.toml"], &folder);
            let is_placed = complaint.starts_with("error: scene.toml:");
            assert!(
                is_placed && !complaint.contains("panicked"),
                "{text}: {complaint}"
            );
        }
    }
    std::fs::write(
        folder.join("a.json"),
        r#"{"type": "Polygon", "coordinates": [[[0, 0], [2, 0], [2, 1], [0, 0]]]}"#,
    )
    .expect("an outline");
    for option in [
        "--height=-5",
        "--duration=inf",
        "--young=nan",
        "--scale=0",
        "--edge=0",
    ] {
        let complaint = complaint(&["drop", "a.json", option], &folder);
        let (name, _) = option.split_once('=').expect("an option");
        assert!(complaint.contains(name), "{complaint}");
    }
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

#[test]
fn meshes_and_the_schema_are_told() {
    let folder = folder("mesh");
    let outline =
        r#"{"type": "Polygon", "coordinates": [[[0, 0], [2, 0], [2, 1], [0, 1], [0, 0]]]}"#;
    std::fs::write(folder.join("plate.json"), outline).expect("an outline");
    let arguments = [
        "mesh",
        "plate.json",
        "--scale",
        "0.5",
        "--edge",
        "0.1",
        "--out",
        "plate.vtu",
    ];
    let told = told(&arguments, &folder);
    assert!(told.contains("5.0000e-1 m²"), "{told}");
    let written = std::fs::read_to_string(folder.join("plate.vtu")).expect("a grid");
    assert!(written.contains("UnstructuredGrid"));
    let schema = self::told(&["schema"], &folder);
    let schema: serde_json::Value = serde_json::from_str(&schema).expect("JSON");
    let properties = schema["properties"].as_object().expect("properties");
    for name in [
        "world",
        "materials",
        "flexible",
        "rigid",
        "joint",
        "attachment",
        "output",
    ] {
        let description = &properties[name];
        assert!(description.is_object(), "{name}");
    }
    assert_eq!(schema["additionalProperties"], false);
}
