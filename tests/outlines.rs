//! Outlines of GeoJSON and of SVG are the shapes that were written, and nothing else does any harm.

use foil2d::fe::mesh::generate::PolygonOptions;
use foil2d::io::{Outline, OutlineError, SvgOptions, outlines_from_json, outlines_from_svg};
use proptest::prelude::*;
use std::f64::consts::PI;

fn area(ring: &[[f64; 2]]) -> f64 {
    let sides = (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()]));
    let twice: f64 = sides.map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum();
    0.5 * twice.abs()
}

/// Area of an outline without its holes (m²).
fn filled(outline: &Outline) -> f64 {
    let holes: f64 = outline.holes.iter().map(|hole| area(hole)).sum();
    area(&outline.outer) - holes
}

const SQUARE: &str = "[[0,0],[2,0],[2,2],[0,2],[0,0]]";
const HOLE: &str = "[[0.5,0.5],[1.5,0.5],[1.5,1.5],[0.5,1.5]]";

#[test]
fn geojson_is_read_with_names_and_holes() {
    let text = format!(
        r#"{{"type":"FeatureCollection","features":[
            {{"type":"Feature","properties":{{"name":"frame"}},"geometry":{{"type":"Polygon","coordinates":[{SQUARE},{HOLE}]}}}},
            {{"type":"Feature","id":7,"properties":null,"geometry":{{"type":"MultiPolygon","coordinates":[[{SQUARE}],[{HOLE}]]}}}},
            {{"type":"Feature","geometry":{{"type":"GeometryCollection","geometries":[{{"type":"Polygon","coordinates":[{HOLE}]}}]}}}}]}}"#
    );
    let outlines = outlines_from_json(&text).expect("it is GeoJSON");
    let told: Vec<_> = outlines
        .iter()
        .map(|outline| (outline.name.as_deref(), filled(outline)))
        .collect();
    let expected = [
        (Some("frame"), 3.0),
        (Some("7"), 4.0),
        (Some("7"), 1.0),
        (None, 1.0),
    ];
    assert_eq!(told, expected);
    // The first point, repeated at the end, is one.
    assert_eq!(outlines[0].outer.len(), 4);
    let mesh = outlines[0]
        .mesh(&PolygonOptions::new(0.3))
        .expect("it is simple");
    assert!((mesh.area() - 3.0).abs() < 1e-12);
    assert_eq!(mesh.boundary().loops().len(), 2);
}

/// An arc of such a radius is divided into curves without end, by the reader of drawings that this one rests on.
#[test]
fn numbers_without_measure_are_refused_by_the_name_of_their_shape() {
    let read = |shape: &str| {
        let drawing = format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9">{shape}</svg>"##
        );
        outlines_from_svg(&drawing, &SvgOptions::new(1e-3))
    };
    let shapes = [
        r#"<path id="a" d="M10 30a10 10 0 1 0-1e300 0z"/>"#,
        r#"<path id="a" d="M10 30A1e39 1 0 1 0 5,0z"/>"#,
        r#"<circle id="a" r="1e300"/>"#,
        r#"<rect id="a" rx="5" width="9e99" height="9e99"/>"#,
        r#"<polygon id="a" points="0,0 1,0 1,-1000000000.5"/>"#,
    ];
    for shape in shapes {
        let told = read(shape);
        assert!(
            matches!(&told, Err(OutlineError::TooLarge { name, .. }) if name == "a"),
            "{shape}: {told:?}"
        );
    }
    let written = r#"<path id="layer99999999999" d="M.5.5l1e0-.5.5.5e+0H-1E-1z"/>"#;
    assert_eq!(read(written).map(|all| all.len()), Ok(1));
}

/// Images may name files, which are none of a drawing's business: this one has no end.
#[test]
fn files_that_a_drawing_names_are_not_read() {
    let drawing = r##"<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><image href="/dev/zero" width="5" height="5"/>
        <rect width="3" height="2"/></svg>"##;
    let found = outlines_from_svg(drawing, &SvgOptions::new(1e-3));
    assert_eq!(found.map(|all| all.len()), Ok(1));
}

/// Such a stroke took minutes and gigabytes, and is no part of a shape.
#[test]
fn strokes_of_any_width_leave_shapes_as_they_are() {
    let arcs: String = (0..60)
        .map(|i| {
            format!(
                "a{} {} 0 1 0 {} {}",
                1 + i % 7,
                1 + i % 5,
                1 + i % 9,
                i % 4 - 2
            )
        })
        .collect();
    let drawing = |paint: &str| {
        format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" width="100" height="100"><path d="M0 0{arcs}z" {paint}/></svg>"##
        )
    };
    let options = SvgOptions::new(1e-3);
    let plain = outlines_from_svg(&drawing(""), &options).expect("a shape");
    for paint in [
        "stroke=\"black\" stroke-width=\"1e9\"",
        "style=\"stroke:red;stroke-width:4e9\"",
    ] {
        let stroked = outlines_from_svg(&drawing(paint), &options).expect("a shape");
        assert_eq!(stroked, plain);
    }
    let unfilled = drawing("fill=\"none\" stroke=\"black\" stroke-width=\"1e9\"");
    assert_eq!(
        outlines_from_svg(&unfilled, &options),
        Err(OutlineError::NoShapes)
    );
}

#[test]
fn what_is_no_polygon_is_told_with_its_place() {
    let cases = [
        ("{", "line 1, column 1: this is no JSON"),
        ("[]", "the text: expected an object of GeoJSON"),
        (
            r#"{"type":"Point","coordinates":[1,2]}"#,
            "type: expected Polygon",
        ),
        (
            r#"{"type":"Polygon"}"#,
            "coordinates: expected a list of rings",
        ),
        (
            r#"{"type":"Polygon","coordinates":[]}"#,
            "coordinates: expected a list of rings",
        ),
        (
            r#"{"type":"Polygon","coordinates":[[[1,2],[3]]]}"#,
            "coordinates[0][1]: expected a point",
        ),
        (
            r#"{"type":"FeatureCollection","features":[{"type":"Feature","geometry":{"type":"Polygon","coordinates":[[["a",2]]]}}]}"#,
            "features[0].geometry.coordinates[0][0]: expected a point",
        ),
        (
            r#"{"type":"FeatureCollection","features":[]}"#,
            "there are no filled shapes",
        ),
    ];
    for (text, expected) in cases {
        let error = outlines_from_json(text).expect_err(text).to_string();
        assert!(error.contains(expected), "{text}: {error}");
    }
    let deep = "[".repeat(100_000);
    assert!(matches!(
        outlines_from_json(&deep),
        Err(OutlineError::NoJson { .. })
    ));
}

fn svg(body: &str) -> String {
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="200mm" height="100mm" viewBox="0 0 200 100">{body}</svg>"#
    )
}

fn read(body: &str) -> Vec<Outline> {
    outlines_from_svg(&svg(body), &SvgOptions::new(1e-5))
        .unwrap_or_else(|error| panic!("{body}: {error}"))
}

/// The drawing is in millimetres, usvg in `f32`: 1e-7 of 0.2 m.
fn assert_at(found: &[[f64; 2]], expected: &[[f64; 2]]) {
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (found, expected) in found.iter().zip(expected) {
        let off = (found[0] - expected[0]).hypot(found[1] - expected[1]);
        assert!(off < 1e-7, "{found:?} {expected:?}");
    }
}

#[test]
fn a_drawing_has_its_size_in_metres_and_y_upward() {
    let outlines = read(r#"<rect id="box" x="20" y="10" width="50" height="30"/>"#);
    assert_eq!(outlines[0].name.as_deref(), Some("box"));
    assert_at(
        &outlines[0].outer,
        &[[0.02, 0.09], [0.07, 0.09], [0.07, 0.06], [0.02, 0.06]],
    );
    let turned = read(
        r#"<g transform="translate(100 50) rotate(90) scale(2)"><path d="M0 0h10v5h-10z"/></g>"#,
    );
    assert_at(
        &turned[0].outer,
        &[[0.1, 0.05], [0.1, 0.03], [0.09, 0.03], [0.09, 0.05]],
    );
    let text = svg(r#"<rect width="10" height="10"/>"#)
        .replace("200mm", "200")
        .replace("100mm", "100");
    let options = SvgOptions {
        pixel: 1.0,
        ..SvgOptions::new(1e-3)
    };
    let pixels = outlines_from_svg(&text, &options).expect("it is a drawing");
    assert!((filled(&pixels[0]) - 100.0).abs() < 1e-4);
}

/// No point leaves the curve, and no side is farther from it than the tolerance. Usvg draws a circle as four cubics, 2.7e-4 of the radius off at most.
#[test]
fn curves_are_divided_to_the_tolerance() {
    let mut sides = Vec::new();
    for tolerance in [1e-3, 1e-4, 1e-5, 1e-6] {
        let text = svg(r#"<circle cx="100" cy="50" r="40"/>"#);
        let outlines =
            outlines_from_svg(&text, &SvgOptions::new(tolerance)).expect("it is a drawing");
        let ring = &outlines[0].outer;
        let off = |[x, y]: [f64; 2]| (x - 0.1).hypot(y - 0.05) - 0.04;
        for (&a, &b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            assert!(off(a).abs() < 3e-4 * 0.04, "{a:?}");
            assert!(
                off(middle) > -tolerance - 1e-7,
                "{} for {tolerance}",
                off(middle)
            );
        }
        assert!((area(ring) / (PI * 0.0016) - 1.0).abs() < 5e-4 + 2.0 * tolerance / 0.04);
        sides.push(ring.len() as f64);
    }
    // Parts go with the root of the tolerance.
    for pair in sides.windows(2) {
        assert!((1.5..4.5).contains(&(pair[1] / pair[0])), "{sides:?}");
    }
    // A quadratic curve: two thirds of the box under a parabola.
    let parabola = read(r#"<path d="M10 80 Q60 -20 110 80 Z"/>"#);
    assert!((filled(&parabola[0]) - 2.0 / 3.0 * 0.1 * 0.05).abs() < 1e-6);
}

#[test]
fn holes_follow_the_rule_that_fills() {
    // Three squares in each other, the middle one the other way round if so asked.
    let path = |rule: &str, middle: &str| {
        format!(r#"<path fill-rule="{rule}" d="M0 0H90V90H0Z {middle} M30 30H60V60H30Z"/>"#)
    };
    let (same, other) = ("M10 10H80V80H10Z", "M10 10V80H80V10Z");
    let areas = |text: &str| {
        let outlines = read(text);
        let areas = outlines
            .iter()
            .map(|outline| (filled(outline) * 1e6).round());
        areas.collect::<Vec<_>>()
    };
    for middle in [same, other] {
        assert_eq!(
            areas(&path("evenodd", middle)),
            [8100.0 - 4900.0, 900.0],
            "a hole with an island"
        );
    }
    assert_eq!(areas(&path("nonzero", same)), [8100.0], "all the same way");
    assert_eq!(areas(&path("nonzero", other)), [3200.0, 900.0]);
    assert_eq!(
        areas(r#"<path d="M0 0H10V10H0ZM20 0H30V10H20Z"/>"#),
        [100.0, 100.0],
        "two parts"
    );
    // What no rule sees: a curve without an area, and one that is not closed.
    assert_eq!(areas(r#"<path d="M0 0H10H0Z M20 0H30V10H20"/>"#), [100.0]);
}

#[test]
fn layers_are_chosen_by_their_ids() {
    let body = r##"<defs><rect id="stamp" width="10" height="10"/></defs>
        <g id="steel"><rect width="10" height="20"/><g><rect id="inner" x="20" width="5" height="5"/></g></g>
        <g id="rubber"><rect x="40" width="10" height="10"/></g>
        <rect x="60" width="10" height="10" fill="none" stroke="black"/>
        <rect x="80" width="10" height="10" display="none"/>
        <use id="copy" href="#stamp" x="100" y="50"/>"##;
    let names = |layers: &[&str]| -> Result<Vec<Option<String>>, OutlineError> {
        let layers = layers.iter().map(|&layer| layer.to_owned()).collect();
        let options = SvgOptions {
            layers,
            ..SvgOptions::new(1e-5)
        };
        let outlines = outlines_from_svg(&svg(body), &options)?;
        Ok(outlines.into_iter().map(|outline| outline.name).collect())
    };
    let told = |names: Vec<Option<String>>| names.into_iter().flatten().collect::<Vec<_>>();
    assert_eq!(
        told(names(&[]).expect("all")),
        ["steel", "inner", "rubber", "copy"]
    );
    assert_eq!(told(names(&["steel"]).expect("one")), ["steel", "inner"]);
    assert_eq!(
        told(names(&["inner", "rubber"]).expect("two")),
        ["inner", "rubber"]
    );
    assert_eq!(
        names(&["steel", "wood"]),
        Err(OutlineError::NoSuchElement {
            name: "wood".into()
        })
    );
}

#[test]
fn what_is_no_drawing_is_refused() {
    let options = SvgOptions::new(1e-5);
    for text in ["", "<svg", "<html/>", "{}"] {
        let error = outlines_from_svg(text, &options).expect_err(text);
        assert!(matches!(error, OutlineError::NoSvg { .. }), "{error}");
    }
    let empty = outlines_from_svg(&svg(""), &options).expect_err("nothing");
    assert_eq!(empty, OutlineError::NoShapes);
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error =
            outlines_from_svg(&svg(""), &SvgOptions::new(tolerance)).expect_err("no tolerance");
        assert!(matches!(
            error,
            OutlineError::InvalidOption {
                name: "tolerance",
                ..
            }
        ));
    }
    let circle = svg(r#"<circle id="c" cx="100" cy="50" r="40"/>"#);
    let error = outlines_from_svg(&circle, &SvgOptions::new(1e-18)).expect_err("too fine");
    assert!(
        matches!(error, OutlineError::TooManyPoints { ref name, .. } if name == "c"),
        "{error}"
    );
}

/// A drawing is meshed as it is: a plate with a round hole.
#[test]
fn a_drawing_is_meshed() {
    let outlines = read(
        r#"<path fill-rule="evenodd" d="M10 10H190V90H10Z M80 50a20 20 0 1 0 40 0a20 20 0 1 0 -40 0Z"/>"#,
    );
    let options = SvgOptions::new(1e-4);
    assert_eq!(options.layers.len(), 0);
    let mesh = outlines[0]
        .mesh(&PolygonOptions::new(0.01))
        .expect("it is simple");
    assert!(
        (mesh.area() - (0.18 * 0.08 - PI * 4e-4)).abs() < 2e-6,
        "{}",
        mesh.area()
    );
}

/// `FOIL2D_FUZZ` takes the number of inputs.
#[test]
fn changed_texts_do_no_harm() {
    let asked = std::env::var("FOIL2D_FUZZ").ok();
    let config = ProptestConfig {
        failure_persistence: None,
        ..ProptestConfig::with_cases(asked.and_then(|n| n.parse().ok()).unwrap_or(1500))
    };
    let json = format!(
        r#"{{"type":"Feature","properties":{{"name":"a"}},"geometry":{{"type":"Polygon","coordinates":[{SQUARE},{HOLE}]}}}}"#
    );
    let drawing = svg(
        r##"<g id="a" transform="rotate(10)"><path d="M0 0C10 0 20 10 20 20S5 30 0 20Z m5 5 l3 0 0 3z"/></g><circle r="5"/><use href="#a"/>"##,
    );
    let pieces = [
        "1e40",
        "-1e-40",
        "NaN",
        "\"",
        "<",
        ">",
        "[",
        "}",
        "9",
        "0",
        "-",
        "e",
        "M",
        "A5 5 0 0 1 ",
        " ",
        "\u{e4}",
        "#a",
        "</g>",
    ];
    let change = (any::<usize>(), 0usize..6, 0..pieces.len());
    let changes = proptest::collection::vec(change, 1..4);
    let n_cases = config.cases;
    let n_sound = std::cell::Cell::new([0; 2]);
    proptest!(config, |(changes in changes)| {
        for (text, is_json) in [(&json, true), (&drawing, false)] {
            let mut text: Vec<char> = text.chars().collect();
            for (at, length, piece) in &changes {
                let at = at % text.len();
                let end = (at + length).min(text.len());
                text.splice(at..end, pieces[*piece].chars());
            }
            let text: String = text.into_iter().collect();
            let found = if is_json {
                outlines_from_json(&text)
            } else {
                outlines_from_svg(&text, &SvgOptions::new(1e-4))
            };
            if let Ok(outlines) = found {
                prop_assert!(!outlines.is_empty());
                let mut sound = n_sound.get();
                sound[usize::from(is_json)] += 1;
                n_sound.set(sound);
            }
        }
    });
    // Some changes leave what can be read, and most do not.
    let sound = n_sound.get();
    assert!(
        sound.iter().all(|&n| n > n_cases / 100 && n < n_cases),
        "{sound:?} of {n_cases}"
    );
}
