//! What is wrong, told where it stands and in the words of scenes.

use super::{BEAM, STEEL, complaint, folder};

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
            "scene.toml:2:9",
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
            "choose one of `a`",
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
        "[[rigid]]\nshape.hull.points = [[0, 0], [0, 0], [0, 0], [0, 0]]\n".to_owned(),
        "[[rigid]]\nshape.hull.points = [[0, 0], [1, 1], [3, 3], [2, 2]]\n".to_owned(),
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
        format!(
            "{STEEL}{BEAM}[[attachment]]\nbody = \"beam\"\nnodes.near = [1.0, 0.0]\nkind.spring = {{ stiffness = 1e30, damping = 0.0 }}\n"
        ),
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

/// What a scene of these lines complains about, if it is run.
fn complaint_of(folder: &std::path::Path, text: &str) -> String {
    std::fs::write(folder.join("scene.toml"), text).expect("a scene");
    complaint(&["run", "scene.toml", "--quiet"], folder)
}

/// Line and column, counted from one, of the only place where a text has a word.
fn place_of(text: &str, word: &str) -> String {
    let byte = text
        .find(word)
        .unwrap_or_else(|| panic!("no {word}: {text}"));
    assert_eq!(
        text.matches(word).count(),
        1,
        "{word} is there once: {text}"
    );
    let before = &text[..byte];
    let line = 1 + before.matches('\n').count();
    let column = 1 + before.len() - before.rfind('\n').map_or(0, |end| end + 1);
    format!("error: scene.toml:{line}:{column}: ")
}

#[test]
fn a_list_of_three_is_not_taken_for_one_of_two() {
    let folder = folder("three");
    let beam = format!("{STEEL}{BEAM}");
    let cases = [
        "[world]\ngravity = [0.0, -9.81, 77.0]\n".to_owned(),
        "[world]\ngravity = [77.0]\n".to_owned(),
        "[[rigid]]\nshape.ball.radius = 1.0\ntranslation = [1.0, 2.0, 77.0]\n".to_owned(),
        "[[rigid]]\nshape.cuboid.size = [1.0, 2.0, 77.0]\n".to_owned(),
        "[[rigid]]\nshape.hull.points = [[0, 0], [1, 0], [1, 1, 77.0]]\n".to_owned(),
        "[[joint]]\nkind = \"fixed\"\nbetween = [\"a\", \"b\", \"77.0\"]\nat = [0.0, 0.0]\n"
            .to_owned(),
        beam.replace("cells = [20, 2]", "cells = [20, 2, 77]"),
        beam.replace("[0.0, inf]", "[0.0, inf, 77.0]"),
        beam.replace("[0.0, inf]]", "[0.0, inf], [77.0, 0.0]]"),
    ];
    for text in cases {
        let complaint = complaint_of(&folder, &text);
        assert!(complaint.contains("a list of two"), "{text}: {complaint}");
        let line = 1 + text[..text.find("77").expect("a seven")]
            .matches('\n')
            .count();
        let is_there = complaint.starts_with(&format!("error: scene.toml:{line}:"));
        assert!(is_there, "line {line} of {text}: {complaint}");
    }
}

/// Each of these was told at the name of its body, if at all.
#[test]
fn what_is_wrong_is_told_at_its_key() {
    let folder = folder("keys");
    let beam = format!("{STEEL}{BEAM}");
    let with = |line: &str| format!("{beam}{line}\n");
    let shape = |new: &str| {
        let old = "shape.rectangle = { size = [1.0, 0.02], cells = [20, 2] }";
        beam.replace(old, new).replace("pin = ", "# ")
    };
    let square = "[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]";
    let polygon = |rest: &str| shape(&format!("shape.polygon = {{ outline = {square}, {rest} }}"));
    let outline = |rest: &str| shape(&format!("shape.outline = {{ file = \"a.json\", {rest} }}"));
    let rigid = |line: &str| format!("[[rigid]]\nname = \"a\"\nshape.ball.radius = 1.0\n{line}\n");
    let held = |rest: &str| format!("{beam}[[attachment]]\nbody = \"beam\"\n{rest}\n");
    let history = |rest: &str| format!("{beam}[[output.history]]\nbody = \"beam\"\n{rest}\n");
    let twice = format!("{beam}{}", BEAM.replace("name = \"beam\"", "name = 'beam'"));
    // Where, and what is told of it.
    let cases = [
        (with("friction = -1"), "-1", "positive"),
        (with("restitution = nan"), "nan", "positive"),
        (with("translation = [1e30, 0.0]"), "[1e30, 0.0]", "finite"),
        (with("rotation = inf\n"), "inf\n", "finite"),
        (with("linvel = [nan, 0.0]"), "[nan, 0.0]", "finite"),
        (
            with("linvel = [0.0, 9e17]\nangvel = 8e17"),
            "8e17",
            "velocity",
        ),
        (beam.replace("0.05", "0.0"), "0.0\npin", "positive"),
        (beam.replace("7800.0", "-1.0"), "-1.0", "density"),
        (beam.replace("1e-3", "-1.0"), "-1.0", "`rayleigh`"),
        (beam.replace("0.3", "0.7"), "0.7", "Poisson"),
        (beam.replace("[20, 2]", "[20, 0]"), "[20, 0]", "one cell"),
        (
            beam.replace("[1.0, 0.02]", "[-1.0, 0.02]"),
            "[-1.0",
            "positive",
        ),
        (
            beam.replace("[0.0, inf]]", "[9.0, nan]]"),
            "[[-inf",
            "corner",
        ),
        (
            shape("shape.disc = { radius = 0.5, edge = 0.0 }"),
            "0.0 }",
            "positive",
        ),
        (
            shape("shape.disc = { radius = 0.5, edge = 1e-4 }"),
            "1e-4",
            "`most_nodes`",
        ),
        (
            shape("shape.annulus = { inner = 3.0, outer = 2.0, edge = 0.1 }"),
            "2.0,",
            "larger",
        ),
        (polygon("edge = 1e-4"), "1e-4", "`most_nodes`"),
        (
            polygon("edge = 0.3, holes = [[[9.0, 9.0], [8.0, 9.0], [8.0, 8.0]]]"),
            "[[9.0",
            "outside",
        ),
        (
            shape("shape.polygon = { outline = [[0, 0], [1, 1], [1, 0], [0, 1]], edge = 0.3 }"),
            "[[0, 0]",
            "meets itself",
        ),
        (outline("edge = 0.3, name = \"b\""), "\"b\"", "`first`"),
        (outline("edge = 0.3"), "\"a.json\"", "2 outlines"),
        (outline("edge = 0.3, part = 33"), "33 }", "from 1 to 2"),
        (
            with("regions = { left = \"steel\" }").replace("pin = ", "# "),
            "\"steel\" }",
            "region",
        ),
        (
            with("force = [{ nodes.near = [0.5, 0.0], force = [nan, 0.0] }]"),
            "[nan",
            "finite",
        ),
        (twice, "'beam'", "already"),
        (rigid("density = -1.0"), "-1.0", "positive"),
        (rigid("angvel = nan"), "nan", "finite"),
        (
            rigid("kind = \"fixed\"\n").replace("\"a\"", "\" \""),
            "\" \"",
            "empty",
        ),
        (
            held("kind = \"weld\"\nnodes.near = [1.0, 0.0]"),
            "\"weld\"",
            "two nodes",
        ),
        (
            held("kind = \"pin\"\nnodes.near = [0.0, 0.0]"),
            "nodes.near",
            "at [0, 0]",
        ),
        (
            held("kind = \"pin\"\nnodes.near = [0.5, 0.01]"),
            "nodes.near",
            "boundary",
        ),
        (
            held("kind.spring = { stiffness = -1.0, damping = 0.0 }\nnodes.near = [1.0, 0.0]"),
            "kind.spring",
            "negative",
        ),
        (
            held("kind = \"pin\"\nnodes.near = [1.0, 0.0]\nto = \"wall\""),
            "\"wall\"",
            "`beam`",
        ),
        (
            held("kind = \"pin\"\nnodes.near = [1.0, 0.0]\nto = 'beam'"),
            "'beam'",
            "itself",
        ),
        (
            history("what = \"angle\"\nnear = [9.0, 0.0]"),
            "[9.0, 0.0]",
            "as a whole",
        ),
        (
            history("what = \"position\"\nnear = [nan, 0.0]"),
            "[nan, 0.0]",
            "finite",
        ),
        (
            format!(
                "{}[[output.history]]\nbody = \"a\"\nwhat = \"reaction\"\n",
                rigid("")
            ),
            "\"reaction\"",
            "rigid",
        ),
        (
            format!(
                "{}[[output.history]]\nbody = 'b'\nwhat = \"angle\"\n",
                rigid("")
            ),
            "'b'",
            "`a`",
        ),
        (
            format!("[world]\nintegrator = \"central_difference\"\n{beam}"),
            "\"central",
            "small_strain",
        ),
        (
            format!("[world]\ndt = 2.0\nduration = 0.5\n{beam}"),
            "0.5",
            "one `dt`",
        ),
        (
            format!("[output]\nevery = 0\n{beam}"),
            "0\n[mat",
            "1 or more",
        ),
    ];
    let two = r#"{"type": "FeatureCollection", "features": [
        {"type": "Feature", "id": "first", "geometry": {"type": "Polygon", "coordinates": [[[0, 0], [2, 0], [2, 1]]]}},
        {"type": "Feature", "id": "second", "geometry": {"type": "Polygon", "coordinates": [[[4, 0], [6, 0], [6, 1]]]}}]}"#;
    std::fs::write(folder.join("a.json"), two).expect("outlines");
    let wrong = cases.iter().filter_map(|(text, place, word)| {
        let complaint = complaint_of(&folder, text);
        let is_told = complaint.starts_with(&place_of(text, place)) && complaint.contains(word);
        (!is_told).then(|| format!("{place}, {word}: {complaint}\n"))
    });
    let wrong: Vec<String> = wrong.collect();
    assert!(wrong.is_empty(), "{}", wrong.concat());
}

/// What a step refuses names bodies as the scene does.
#[test]
fn what_a_step_refuses_is_told_by_name() {
    let folder = folder("step");
    let stiff =
        format!("[world]\nintegrator = \"central_difference\"\n{STEEL}{BEAM}small_strain = true\n");
    let complaint = complaint_of(&folder, &stiff);
    assert!(
        complaint.contains("step 1: `beam`: ") && complaint.contains("`dt`"),
        "{complaint}"
    );
    // What was computed until then is written.
    assert!(complaint.contains("replay.html"), "{complaint}");
}

#[test]
fn meshes_that_would_take_all_memory_are_refused_and_the_bound_is_the_users() {
    let folder = folder("memory");
    let beam = format!("{STEEL}{}", BEAM.replace("[20, 2]", "[1000, 1000]"));
    let complaint = complaint_of(&folder, &beam);
    assert!(
        complaint.starts_with(&place_of(&beam, "[1000, 1000]")),
        "{complaint}"
    );
    assert!(
        complaint.contains("1002001 nodes") && complaint.contains("GB"),
        "{complaint}"
    );
    // Bodies count together.
    let two = format!(
        "{}translation = [0.0, 1.0]\n",
        BEAM.replace("\"beam\"", "'other'")
    );
    let beams = format!("[world]\nmost_nodes = 100\n{STEEL}{BEAM}{two}");
    let complaint = complaint_of(&folder, &beams);
    assert!(
        complaint.contains("63 nodes") && complaint.contains("where 37 are left"),
        "{complaint}"
    );
    std::fs::write(folder.join("scene.toml"), beams.replace("= 100", "= 126")).expect("a scene");
    super::told(&["run", "scene.toml", "--steps", "1", "--quiet"], &folder);
}

#[test]
fn only_files_of_a_bounded_size_are_read() {
    let folder = folder("files");
    let pipe = folder.join("pipe");
    let _ = std::process::Command::new("mkfifo").arg(&pipe).status();
    let endless = ["/dev/zero", &pipe.to_string_lossy()].map(str::to_owned);
    for device in endless
        .iter()
        .filter(|path| std::path::Path::new(path).exists())
    {
        for command in ["run", "doctor", "mesh", "drop"] {
            let complaint = complaint(&[command, device.as_str()], &folder);
            assert!(complaint.contains("regular file"), "{command}: {complaint}");
        }
        let file = format!("{STEEL}{BEAM}").replace(
            "shape.rectangle = { size = [1.0, 0.02], cells = [20, 2] }",
            &format!("shape.msh.file = \"{device}\""),
        );
        let complaint = complaint_of(&folder, &file);
        assert!(complaint.contains("regular file"), "{complaint}");
        assert!(
            complaint.starts_with(&place_of(&file, &format!("\"{device}\""))),
            "{complaint}"
        );
    }
    // A file that is large and has no blocks.
    let large = std::fs::File::create(folder.join("large.svg")).expect("a file");
    large.set_len(65 << 20).expect("a length");
    let told = complaint(&["mesh", "large.svg"], &folder);
    assert!(told.contains("64 MiB"), "{told}");
    std::fs::write(folder.join("latin.toml"), b"# \xe9\n").expect("a file");
    let told = complaint(&["run", "latin.toml"], &folder);
    assert!(told.contains("UTF-8"), "{told}");
    let told = complaint(&["run", "."], &folder);
    assert!(told.contains("folder"), "{told}");
}

/// The run would take minutes: what cannot be written is told before.
#[test]
fn an_output_that_cannot_be_written_is_told_before_the_run() {
    let folder = folder("unwritable");
    let beam = format!("[world]\nduration = 1e5\n[output]\nfolder = \"taken\"\n{STEEL}{BEAM}");
    std::fs::write(folder.join("taken"), "a file where the folder is to be").expect("a file");
    let told = complaint_of(&folder, &beam);
    assert!(told.starts_with(&place_of(&beam, "\"taken\"")), "{told}");
    std::fs::create_dir_all(folder.join("other/replay.html")).expect("a folder");
    let told = complaint(&["run", "scene.toml", "--out", "other"], &folder);
    assert!(told.contains("replay.html"), "{told}");
    std::fs::write(
        folder.join("a.svg"),
        r#"<svg xmlns="http://www.w3.org/2000/svg"><rect width="9" height="9"/></svg>"#,
    )
    .expect("a drawing");
    for arguments in [
        ["drop", "a.svg", "--out", "taken"],
        ["mesh", "a.svg", "--out", "taken/a.vtu"],
    ] {
        let told = complaint(&arguments, &folder);
        assert!(told.contains("taken"), "{told}");
    }
    // What was there is still there.
    let kept = std::fs::read_to_string(folder.join("taken")).expect("a file");
    assert!(kept.starts_with("a file"));
}

#[test]
fn columns_of_one_name_are_refused_and_may_be_given_another() {
    let folder = folder("columns");
    let history = "[[output.history]]\nbody = \"beam\"\nwhat = \"von_mises\"\nnear = [0.0, 0.0]\n";
    let twice = format!(
        "{STEEL}{BEAM}{history}{}",
        history.replace("\"beam\"", "'beam'")
    );
    let told = complaint_of(&folder, &twice);
    assert!(told.starts_with(&place_of(&twice, "'beam'")), "{told}");
    assert!(
        told.contains("`beam_von_mises_Pa`") && told.contains("`name`"),
        "{told}"
    );
    std::fs::write(
        folder.join("scene.toml"),
        format!("{twice}name = \"root\"\n"),
    )
    .expect("a scene");
    super::told(&["run", "scene.toml", "--steps", "1", "--quiet"], &folder);
    let table = std::fs::read_to_string(folder.join("out/history.csv")).expect("a table");
    assert!(
        table
            .lines()
            .next()
            .expect("names")
            .ends_with("beam_von_mises_Pa,root_von_mises_Pa")
    );
}
