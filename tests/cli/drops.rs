//! Drawings that become worlds and meshes.

use super::{column, complaint, foil2d, folder, last_row};
use std::path::{Path, PathBuf};

/// A folder of its own for a test, with one drawing in it.
fn folder_with(name: &str, file: &str, drawing: &str) -> PathBuf {
    let folder = folder(name);
    std::fs::write(folder.join(file), drawing).expect("a drawing");
    folder
}

fn words(line: &str) -> Vec<&str> {
    line.split(' ').collect()
}

/// What a command that succeeds prints.
fn told(line: &str, folder: &Path) -> String {
    super::told(&words(line), folder)
}

/// What a command that succeeds notes beside that.
fn noted(line: &str, folder: &Path) -> String {
    let output = foil2d(&words(line), folder);
    let notes = String::from_utf8(output.stderr).expect("text");
    assert!(output.status.success(), "{notes}");
    notes
}

/// The scene that was made of a drawing.
fn scene(folder: &Path) -> String {
    std::fs::read_to_string(folder.join("out/scene.toml")).expect("the scene")
}

fn n_flexible(scene: &str) -> usize {
    scene.matches("[[flexible]]").count()
}

#[test]
fn a_drawing_becomes_a_picture_and_a_replay_in_one_command() {
    let drawing = r#"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="150" viewBox="0 0 200 150">
        <path id="wedge" d="M20 20 L90 30 L60 90 Z"/>
        <path id="ring" fill-rule="evenodd" d="M110 20 H180 V90 H110 Z M130 40 H160 V70 H130 Z"/></svg>"#;
    let folder = folder_with("drop", "shapes.svg", drawing);
    let dropped = told("drop shapes.svg --duration 2 --quiet", &folder);
    assert!(
        dropped.contains("120 steps, 0 cut, 0 unfinished"),
        "{dropped}"
    );
    let out = folder.join("out");
    let still = std::fs::read_to_string(out.join("still.svg")).expect("a picture");
    assert!(still.matches("<polygon").count() > 100, "cells are drawn");
    let png = std::fs::read(out.join("still.png")).expect("the picture as PNG");
    // Behind the signature of eight bytes and the name of the first chunk.
    assert_eq!(png[..8], *b"\x89PNG\r\n\x1a\n");
    assert_eq!(png[16..20], 1920_u32.to_be_bytes(), "px wide");
    let replay = std::fs::read_to_string(out.join("replay.html")).expect("a replay");
    assert!(replay.contains("<canvas") && replay.len() > 20_000);
    // The scene that was run is there to be changed, and runs as well.
    assert_eq!(n_flexible(&scene(&folder)), 2);
    let again = told("run out/scene.toml --steps 5 --quiet", &folder);
    assert!(again.contains("5 steps"), "{again}");
    let energy = column(&last_row(&folder.join("out/out")), "kinetic_J");
    assert!(energy > 0.0);
    let sound = told("doctor out/scene.toml", &folder);
    assert_eq!(sound, "nothing is likely a mistake\n");
}

#[test]
fn meshes_and_the_schema_are_told() {
    let outline =
        r#"{"type": "Polygon", "coordinates": [[[0, 0], [2, 0], [2, 1], [0, 1], [0, 0]]]}"#;
    let folder = folder_with("mesh", "plate.json", outline);
    let told_of_mesh = told(
        "mesh plate.json --scale 0.5 --edge 0.1 --out plate.vtu",
        &folder,
    );
    assert!(told_of_mesh.contains("5.0000e-1 m²"), "{told_of_mesh}");
    let written = std::fs::read_to_string(folder.join("plate.vtu")).expect("a grid");
    assert!(written.contains("UnstructuredGrid"));
    let schema = told("schema", &folder);
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

/// A page behind all, and shapes on it: as drawings are. They are put above each other and told by name.
#[test]
fn shapes_that_lie_on_each_other_are_put_apart_and_named() {
    let drawing = r##"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="150">
        <rect id="page" width="200" height="150"/><rect id="left" x="20" y="20" width="40" height="40"/>
        <rect id="twin" x="20" y="20" width="40" height="40"/><circle id="right" cx="150" cy="75" r="30"/></svg>"##;
    let folder = folder_with("overlap", "page.svg", drawing);
    let notes = noted("drop page.svg --duration 0.5 --edge 0.15 --quiet", &folder);
    for name in ["left", "twin", "right"] {
        assert!(
            notes.contains(&format!("note: `{name}` lies on another")),
            "{notes}"
        );
    }
    assert!(!notes.contains("`page`"), "{notes}");
    let sound = told("doctor out/scene.toml", &folder);
    assert!(!sound.contains("into each other"), "{sound}");
    // Or some of them only.
    told(
        "drop page.svg --duration 0.1 --layer left --layer right --quiet",
        &folder,
    );
    let scene = scene(&folder);
    assert_eq!(n_flexible(&scene), 2);
    assert!(!scene.contains("twin") && scene.contains("translation = [0.0, 0.0]"));
    let complaint = complaint(&words("drop page.svg --layer middle"), &folder);
    assert!(
        complaint.contains("`middle`") && complaint.contains("`left`"),
        "{complaint}"
    );
}

/// Groups are layers: their shapes are found by the id of the group, however these are called themselves.
#[test]
fn outlines_are_found_by_their_layer() {
    let drawing = r##"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100">
        <g id="frame"><path id="path12" fill-rule="evenodd" d="M0 0H100V100H0Z M10 10H90V90H10Z"/></g>
        <g id="bolts"><rect x="20" y="20" width="10" height="10"/><rect id="other" x="40" y="20" width="20" height="10"/></g></svg>"##;
    let folder = folder_with("layers", "part.svg", drawing);
    let frame = told("mesh part.svg --layer frame", &folder);
    assert!(
        frame.starts_with("`path12`: ") && frame.contains("3.6000e-1 m²"),
        "{frame}"
    );
    let scene = |which: &str| {
        format!(
            "{}[[flexible]]\nname = \"a\"\nmaterial = \"steel\"\nshape.outline = {{ file = \"part.svg\", scale = 0.01, edge = 0.05, {which} }}\n\
             [[output.history]]\nbody = \"a\"\nwhat = \"position\"\n",
            super::STEEL
        )
    };
    let at = |which: &str| {
        std::fs::write(folder.join("scene.toml"), scene(which)).expect("a scene");
        told("run scene.toml --steps 1 --quiet", &folder);
        column(&last_row(&folder.join("out")), "a_x_m")
    };
    assert!((at("name = \"frame\"") - 0.5).abs() < 1e-6);
    assert!((at("name = \"bolts\", part = 1") - 0.25).abs() < 1e-6);
    assert!((at("name = \"bolts\", part = 2") - 0.5).abs() < 1e-6);
    std::fs::write(folder.join("scene.toml"), scene("name = \"bolts\"")).expect("a scene");
    let complaint = complaint(&words("run scene.toml"), &folder);
    assert!(
        complaint.contains("2 outlines") && complaint.contains("`part`"),
        "{complaint}"
    );
}

/// Shapes that no mesh can be made of are left out by name, and names that TOML has to quote come through.
#[test]
fn bad_shapes_are_left_out_and_odd_names_kept() {
    let drawing = r##"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="100">
        <path id="bow" d="M0 0L40 40L40 0L0 40Z"/><rect id="a &quot;quoted&quot; \ na&#x200b;me" x="60" y="20" width="40" height="40"/>
        <rect id="floor" x="120" y="20" width="40" height="40"/></svg>"##;
    let folder = folder_with("odd", "odd.svg", drawing);
    let notes = noted("drop odd.svg --duration 0.1", &folder);
    assert!(
        notes.contains("`bow` is left out: the outline meets itself"),
        "{notes}"
    );
    let scene = scene(&folder);
    assert_eq!(n_flexible(&scene), 2, "{scene}");
    told("run out/scene.toml --steps 1 --quiet", &folder);
}

/// Shapes of picometres: what single precision makes of them is told to overlap for ever, which is no reason to lift for ever.
#[test]
fn shapes_too_small_for_the_world_come_to_an_end() {
    let drawing = r##"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="60"><rect id="a" width="20" height="20"/>
        <rect id="b" x="20" width="20" height="20"/><rect id="c" y="20" width="20" height="20"/></svg>"##;
    let folder = folder_with("tiny", "tiny.svg", drawing);
    let line = "drop tiny.svg --scale 1e-12 --edge 1e-11 --duration 0.02 --quiet";
    let output = foil2d(&words(line), &folder);
    let told = String::from_utf8(output.stderr).expect("text");
    assert!(
        output.status.success() || told.contains("error: "),
        "{told}"
    );
}

/// Which of two rings that meet is around the other has no answer: one of them once vanished, and holes became bodies.
#[test]
fn subpaths_that_cross_or_touch_are_refused_by_name() {
    let cases = [
        "M0 0 H50 V50 H0 Z M30 30 H80 V80 H30 Z",
        "M50 50 L100 0 L100 100 Z M50 50 L0 100 L0 0 Z",
        "M0 0 H100 V100 H0 Z M0 0 L50 20 L20 50 Z",
        "M0 0 H50 V50 H0 Z M0 0 H50 V50 H0 Z",
        "M0 0 H50 V50 H0 Z M10 50 H40 V80 H10 Z",
    ];
    for path in cases {
        for rule in ["nonzero", "evenodd"] {
            let drawing = format!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100"><path id="part" fill-rule="{rule}" d="{path}"/></svg>"#
            );
            let folder = folder_with("subpaths", "shapes.svg", &drawing);
            let told = complaint(&["mesh", "shapes.svg"], &folder);
            assert!(told.contains("subpaths of `part`"), "{path}: {told}");
        }
    }
}

#[test]
fn a_scene_that_somebody_has_changed_is_not_written_over() {
    let drawing = r#"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="60"><rect id="box" width="50" height="50"/></svg>"#;
    let folder = folder_with("changed", "box.svg", drawing);
    let command = "drop box.svg --duration 0.05 --quiet";
    told(command, &folder);
    // Another one of its own is written over.
    told("drop box.svg --duration 0.1 --quiet", &folder);
    told(command, &folder);
    let changed = format!("{}\n# mine\n", scene(&folder));
    std::fs::write(folder.join("out/scene.toml"), &changed).expect("a scene");
    let refused = complaint(&words(command), &folder);
    assert!(refused.contains("--out"), "{refused}");
    assert_eq!(scene(&folder), changed);
}

/// Forty squares, each of which had a thousand nodes, were not stepped within minutes.
#[test]
fn many_shapes_have_no_more_nodes_than_a_few() {
    let squares: String = (0..40)
        .map(|i| {
            let [x, y] = [20 * (i % 10), 20 * (i / 10)];
            format!(r#"<rect id="r{i}" x="{x}" y="{y}" width="15" height="15"/>"#)
        })
        .collect();
    let drawing = format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="80">{squares}</svg>"#
    );
    let folder = folder_with("many", "many.svg", &drawing);
    told("drop many.svg --duration 0.02 --quiet", &folder);
    assert_eq!(n_flexible(&scene(&folder)), 40);
    let edge: f64 = scene(&folder)
        .split("edge = ")
        .nth(1)
        .and_then(|rest| rest.split(',').next())
        .and_then(|edge| edge.parse().ok())
        .expect("an edge");
    assert!(edge > 0.02 && edge < 0.05, "{edge} m of 0.15 m");
}

#[test]
fn what_is_no_filled_shape_is_told() {
    let drawing = r#"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="200"><rect width="50" height="50"/>
        <defs><text>hidden</text></defs><text x="0" y="150">text</text><image width="5" height="5" href="a.png"/>
        <path d="M0 100 H150" stroke="black" fill="none"/><line x2="9" stroke="red"/><circle r="9" style="stroke: red; fill: none"/></svg>"#;
    let folder = folder_with("left", "left.svg", drawing);
    let notes = noted("mesh left.svg", &folder);
    let expected = "left out of left.svg: 1 text(s), 1 image(s), 3 line(s) without a fill";
    assert!(notes.contains(expected), "{notes}");
    std::fs::write(
        folder.join("all.svg"),
        drawing.replace("<text", "<g").replace("</text", "</g"),
    )
    .expect("a drawing");
    assert!(!noted("mesh all.svg", &folder).contains("text(s)"));
}
