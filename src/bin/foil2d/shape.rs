//! Shapes: from what a scene says to meshes with groups, and to rapier's colliders.

use super::problem::Problem;
use super::scene::{RigidShape, Shape};
use super::source::Source;
use foil2d::fe::mesh::generate::{self, PolygonOptions};
use foil2d::io::{MshMesh, Outline, SvgOptions, outlines_from_json, outlines_from_svg};
use foil2d::math::hypot;
use foil2d::prelude::*;
use foil2d::rapier::math::Real;
use foil2d::rapier::prelude::*;
use std::path::Path;

/// A distance of curves from the sides that stand for them, over the length of an edge.
const FLATTENING: f64 = 0.02;

/// A mesh, and groups of its nodes by name.
pub struct Shaped {
    pub mesh: Mesh,
    pub groups: Vec<(String, Vec<usize>)>,
}

impl From<Mesh> for Shaped {
    fn from(mesh: Mesh) -> Self {
        let groups = Vec::new();
        Self { mesh, groups }
    }
}

/// Vectors of rapier.
pub fn vector([x, y]: [f64; 2]) -> Vector {
    Vector::new(x as Real, y as Real)
}

/// The mesh of a flexible body.
pub fn shaped(source: &Source, shape: &Shape) -> Result<Shaped, Problem> {
    let meshed = match shape {
        Shape::Rectangle { size, cells } => generate::rectangle(*size, *cells, CellKind::Quad4),
        Shape::Disc { radius, edge } => generate::disc(*radius, *edge, CellKind::Tri6),
        Shape::Annulus { inner, outer, edge } => {
            generate::annulus(*inner, *outer, *edge, CellKind::Quad4)
        }
        Shape::Polygon {
            outline,
            holes,
            edge,
        } => generate::polygon(outline, holes, &PolygonOptions::new(*edge))
            .and_then(|mesh| mesh.to_tri6()),
        Shape::Msh { file } => {
            let path = source.beside(file.get());
            let refuse =
                |error: &dyn std::fmt::Display| source.problem(file, of_file(&path, error));
            let msh = MshMesh::read(&path).map_err(|error| refuse(&error))?;
            return of_msh(msh).map_err(|error| refuse(&error));
        }
        Shape::Outline {
            file,
            edge,
            scale,
            name,
        } => {
            let path = source.beside(file.get());
            let outlines =
                outlines(&path, *edge, *scale).map_err(|problem| source.problem(file, problem))?;
            let found = match name {
                None => outlines.first(),
                Some(name) => outlines
                    .iter()
                    .find(|one| one.name.as_deref() == Some(name.get())),
            };
            let outline = found.ok_or_else(|| match name {
                Some(name) => {
                    source.problem(name, no_such("outline", name.get(), &names(&outlines)))
                }
                None => source.problem(file, "the file has no outline: fill a closed shape"),
            })?;
            let mesh = outline.mesh(&PolygonOptions::new(*edge));
            let mesh = mesh.and_then(|mesh| mesh.to_tri6());
            return match mesh {
                Ok(mesh) => Ok(mesh.into()),
                Err(error) => Err(source.problem(file, of_file(&path, error))),
            };
        }
    };
    Ok(meshed.map_err(Problem::plain)?.into())
}

/// A mesh of gmsh with its groups.
fn of_msh(msh: MshMesh) -> Result<Shaped, foil2d::fe::mesh::MeshError> {
    let mesh = msh.mesh_with_regions()?;
    let groups = msh.boundaries.into_iter();
    let groups = groups.map(|group| (group.name, group.nodes)).collect();
    Ok(Shaped { mesh, groups })
}

/// The outlines of an SVG or JSON file, `scale` metres to its unit.
pub fn outlines(path: &Path, edge: f64, scale: f64) -> Result<Vec<Outline>, Problem> {
    let text =
        std::fs::read_to_string(path).map_err(|error| Problem::plain(of_file(path, error)))?;
    let is_json = path
        .extension()
        .is_some_and(|extension| extension == "json");
    let found = if is_json {
        outlines_from_json(&text)
            .map(|outlines| outlines.into_iter().map(|one| scaled(one, scale)).collect())
    } else {
        let options = SvgOptions {
            pixel: scale,
            ..SvgOptions::new(FLATTENING * edge)
        };
        outlines_from_svg(&text, &options)
    };
    found.map_err(|error| Problem::plain(of_file(path, error)))
}

fn scaled(mut outline: Outline, scale: f64) -> Outline {
    let rings = std::iter::once(&mut outline.outer).chain(&mut outline.holes);
    rings.flatten().flatten().for_each(|x| *x *= scale);
    outline
}

/// Names of outlines.
pub fn names(outlines: &[Outline]) -> Vec<&str> {
    let all = outlines.iter();
    all.filter_map(|outline| outline.name.as_deref()).collect()
}

/// Says that there is nothing of a name, and what there is.
pub fn no_such(kind: &str, name: &str, known: &[&str]) -> String {
    match known {
        [] => format!("there is no {kind} `{name}`: there is none with a name"),
        _ => format!(
            "there is no {kind} `{name}`: choose one of {}",
            known.join(", ")
        ),
    }
}

fn of_file(path: &Path, error: impl std::fmt::Display) -> String {
    format!("{}: {error}", path.display())
}

/// The collider of a rigid body.
pub fn collider(source: &Source, shape: &RigidShape) -> Result<ColliderBuilder, Problem> {
    Ok(match shape {
        RigidShape::Ball { radius } => ColliderBuilder::ball(*radius as Real),
        RigidShape::Cuboid { size } => {
            ColliderBuilder::cuboid(0.5 * size[0] as Real, 0.5 * size[1] as Real)
        }
        RigidShape::Capsule { from, to, radius } => {
            ColliderBuilder::capsule_from_endpoints(vector(*from), vector(*to), *radius as Real)
        }
        RigidShape::Hull { points } => {
            let all: Vec<Vector> = points.get().iter().map(|&at| vector(at)).collect();
            let hull = match all.len() {
                // Parry 0.31 panics.
                0..3 => None,
                _ => ColliderBuilder::convex_hull(&all),
            };
            hull.ok_or_else(|| {
                source.problem(
                    points,
                    "the points have no convex hull: give three or more that are not on a line",
                )
            })?
        }
        RigidShape::Polyline { points } => {
            let all: Vec<Vector> = points.get().iter().map(|&at| vector(at)).collect();
            if all.len() < 2 {
                return Err(source.problem(points, "a polyline has two points or more"));
            }
            ColliderBuilder::polyline(all, None)
        }
        RigidShape::Halfspace { normal } => {
            let [x, y] = *normal.get();
            let length = hypot(x, y);
            if !(length > 0.0 && length.is_finite()) {
                return Err(source.problem(
                    normal,
                    "the normal has no direction: give one such as [0.0, 1.0]",
                ));
            }
            ColliderBuilder::new(SharedShape::halfspace(vector([x / length, y / length])))
        }
    })
}
