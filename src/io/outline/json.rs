//! GeoJSON (RFC 7946), with coordinates in metres: `Polygon`, `MultiPolygon`, and what holds them.

use super::{Outline, OutlineError};
use serde_json::{Map, Value};

type Found<T> = Result<T, OutlineError>;

/// Reads the polygons of a text: a `Polygon`, a `MultiPolygon`, a `Feature` of either, a `FeatureCollection` or a `GeometryCollection`.
///
/// A feature is named by `name` among its properties, or by its `id`. Other geometries are refused, not skipped. Rings may be closed, as the
/// standard has it, or not; anything behind x and y is left out.
///
/// # Errors
/// If the text is no JSON or holds something else: the error says where.
///
/// ```
/// use foil2d::io::outlines_from_json;
///
/// let text = r#"{"type": "Feature", "properties": {"name": "plate"}, "geometry": {"type": "Polygon",
///     "coordinates": [[[0, 0], [2, 0], [2, 1], [0, 1], [0, 0]], [[0.5, 0.4], [0.7, 0.4], [0.6, 0.6], [0.5, 0.4]]]}}"#;
/// let outlines = outlines_from_json(text)?;
/// assert_eq!(outlines[0].name.as_deref(), Some("plate"));
/// assert_eq!((outlines[0].outer.len(), outlines[0].holes.len()), (4, 1));
/// # Ok::<(), foil2d::io::OutlineError>(())
/// ```
pub fn outlines_from_json(text: &str) -> Found<Vec<Outline>> {
    let value: Value = serde_json::from_str(text).map_err(|error| OutlineError::NoJson {
        line: error.line(),
        column: error.column(),
        reason: error.to_string(),
    })?;
    let mut outlines = Vec::new();
    add(&value, "", None, &mut outlines)?;
    if outlines.is_empty() {
        return Err(OutlineError::NoShapes);
    }
    Ok(outlines)
}

fn unexpected<T>(path: &str, expected: &'static str) -> Found<T> {
    let path = if path.is_empty() { "the text" } else { path };
    Err(OutlineError::Unexpected {
        path: path.trim_start_matches('.').to_owned(),
        expected,
    })
}

fn list<'a>(value: &'a Value, path: &str, expected: &'static str) -> Found<&'a [Value]> {
    match value {
        Value::Array(list) => Ok(list),
        _ => unexpected(path, expected),
    }
}

fn add(value: &Value, path: &str, name: Option<&str>, outlines: &mut Vec<Outline>) -> Found<()> {
    let Value::Object(object) = value else {
        return unexpected(path, "an object of GeoJSON");
    };
    let member = |key: &str| {
        (
            format!("{path}.{key}"),
            object.get(key).unwrap_or(&Value::Null),
        )
    };
    match object.get("type").and_then(Value::as_str) {
        Some("Polygon") => {
            let (path, coordinates) = member("coordinates");
            outlines.push(polygon(coordinates, &path, name)?);
        }
        Some("MultiPolygon") => {
            let (path, coordinates) = member("coordinates");
            for (index, one) in list(coordinates, &path, "a list of polygons")?
                .iter()
                .enumerate()
            {
                outlines.push(polygon(one, &format!("{path}[{index}]"), name)?);
            }
        }
        Some("Feature") => {
            let (path, geometry) = member("geometry");
            let own = feature_name(object);
            add(geometry, &path, own.as_deref().or(name), outlines)?;
        }
        Some("FeatureCollection") => {
            let (path, features) = member("features");
            for (index, one) in list(features, &path, "a list of features")?
                .iter()
                .enumerate()
            {
                add(one, &format!("{path}[{index}]"), name, outlines)?;
            }
        }
        Some("GeometryCollection") => {
            let (path, geometries) = member("geometries");
            for (index, one) in list(geometries, &path, "a list of geometries")?
                .iter()
                .enumerate()
            {
                add(one, &format!("{path}[{index}]"), name, outlines)?;
            }
        }
        _ => {
            let (path, _) = member("type");
            return unexpected(
                &path,
                "Polygon, MultiPolygon, Feature, FeatureCollection or GeometryCollection: other geometries have no area",
            );
        }
    }
    Ok(())
}

fn feature_name(feature: &Map<String, Value>) -> Option<String> {
    let named = feature
        .get("properties")
        .and_then(|properties| properties.get("name"));
    let name = named.and_then(Value::as_str).map(str::to_owned);
    name.or_else(|| match feature.get("id") {
        Some(Value::String(id)) => Some(id.clone()),
        Some(Value::Number(id)) => Some(id.to_string()),
        _ => None,
    })
}

fn polygon(value: &Value, path: &str, name: Option<&str>) -> Found<Outline> {
    let rings = list(value, path, "a list of rings, the outline first")?
        .iter()
        .enumerate();
    let rings = rings.map(|(index, one)| ring(one, &format!("{path}[{index}]")));
    let mut rings = rings.collect::<Found<Vec<_>>>()?.into_iter();
    let Some(outer) = rings.next() else {
        return unexpected(path, "a list of rings, the outline first");
    };
    Ok(Outline {
        name: name.map(str::to_owned),
        outer,
        holes: rings.collect(),
    })
}

fn ring(value: &Value, path: &str) -> Found<Vec<[f64; 2]>> {
    let points = list(value, path, "a ring: a list of points")?
        .iter()
        .enumerate();
    let points = points.map(|(index, point)| {
        let coordinate = |axis: usize| point.get(axis).and_then(Value::as_f64);
        match (coordinate(0), coordinate(1)) {
            (Some(x), Some(y)) => Ok([x, y]),
            _ => unexpected(
                &format!("{path}[{index}]"),
                "a point: a list of x and y (m)",
            ),
        }
    });
    let mut points = points.collect::<Found<Vec<_>>>()?;
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    Ok(points)
}
