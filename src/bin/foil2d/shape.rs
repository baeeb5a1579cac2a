//! Shapes: from what a scene says to meshes with groups of nodes.

use super::at::{At, Pair};
use super::files::check_readable;
use super::outlines::{Refused, Wanted, names, outlines};
use super::problem::Problem;
use super::scene::Shape;
use super::source::Source;
use super::words::{MeshCulprit, of_mesh, too_many_nodes};
use foil2d::fe::mesh::MeshError;
use foil2d::fe::mesh::generate::{self, PolygonOptions};
use foil2d::io::{MshMesh, Outline};
use foil2d::prelude::*;
use std::f64::consts::PI;
use std::fmt::Display;
use std::path::PathBuf;

/// Bytes of a mesh's file to a node, with room to spare.
const BYTES_TO_A_NODE: u64 = 1024;

/// Nodes to a square of the length of an edge, at least.
const OF_TRI6: f64 = 3.5;
const OF_QUAD4: f64 = 0.9;

/// Coordinates beyond this (m) are refused, as the library does.
const LARGEST: f64 = 1e18;

/// A mesh, and groups of its nodes by name.
pub struct Shaped {
    pub mesh: Mesh,
    pub groups: Vec<(String, Vec<usize>)>,
}

/// The mesh of a flexible body.
///
/// - `most_nodes`: the most that it may have.
pub fn shaped(source: &Source, shape: &At<Shape>, most_nodes: usize) -> Result<Shaped, Problem> {
    let draft = Draft {
        source,
        shape,
        most_nodes,
    };
    let shaped = draft.shaped()?;
    draft.check_nodes(shape, shaped.mesh.n_nodes() as f64)?;
    Ok(shaped)
}

/// Triangles of six nodes in an outline.
///
/// # Errors
/// If the outline is none, or more nodes than `most_nodes` are needed.
pub fn mesh_of(outline: &Outline, edge: f64, most_nodes: usize) -> Result<Mesh, MeshError> {
    for (ring, points) in std::iter::once(&outline.outer)
        .chain(&outline.holes)
        .enumerate()
    {
        let lost = |at: &[f64; 2]| !at.iter().all(|x| x.abs() <= LARGEST);
        if let Some(point) = points.iter().position(lost) {
            let at = points[point];
            return Err(MeshError::NonFinitePoint { ring, point, at });
        }
    }
    let mut options = PolygonOptions::new(edge);
    // Midside nodes make four of each.
    options.max_nodes = (most_nodes / 4).max(4);
    outline.mesh(&options)?.to_tri6()
}

struct Draft<'a> {
    source: &'a Source,
    shape: &'a At<Shape>,
    most_nodes: usize,
}

impl Draft<'_> {
    fn shaped(&self) -> Result<Shaped, Problem> {
        let generated = match self.shape.get() {
            Shape::Rectangle { size, cells } => {
                self.positive(size, &size.get().0)?;
                let [nx, ny] = cells.get().0;
                if nx == 0 || ny == 0 {
                    let what = "give one cell or more along x and y";
                    return Err(self.source.problem(cells, what));
                }
                self.check_nodes(cells, (nx as f64 + 1.0) * (ny as f64 + 1.0))?;
                generate::rectangle(size.get().0, [nx, ny], CellKind::Quad4)
            }
            Shape::Disc { radius, edge } => {
                let r = self.positive(radius, &[*radius.get()])?[0];
                self.check_edge(edge, OF_TRI6 * PI * r * r)?;
                generate::disc(r, *edge.get(), CellKind::Tri6)
            }
            Shape::Annulus { inner, outer, edge } => {
                let r = self.positive(inner, &[*inner.get()])?[0];
                let around = self.positive(outer, &[*outer.get()])?[0];
                if r >= around {
                    let what = "`outer` is to be larger than `inner`";
                    return Err(self.source.problem(outer, what));
                }
                self.check_edge(edge, OF_QUAD4 * PI * (around * around - r * r))?;
                generate::annulus(r, around, *edge.get(), CellKind::Quad4)
            }
            Shape::Polygon {
                outline,
                holes,
                edge,
            } => return self.polygon(outline, holes, edge),
            Shape::Msh { file } => return self.msh(file),
            Shape::Outline { edge, scale, .. } => {
                self.check_edge(edge, 0.0)?;
                self.positive(scale, &[*scale.get()])?;
                return self.outline();
            }
        };
        let mesh = generated.map_err(|error| self.source.problem(self.shape, of_mesh(&error).1))?;
        Ok(Shaped::from(mesh))
    }

    fn positive<'n, T>(&self, at: &At<T>, numbers: &'n [f64]) -> Result<&'n [f64], Problem> {
        match numbers.iter().all(|&one| one > 0.0 && one.is_finite()) {
            true => Ok(numbers),
            false => Err(self
                .source
                .problem(at, format!("{numbers:?} m: give a positive length"))),
        }
    }

    /// Refuses an edge that would make too many nodes.
    ///
    /// - `nodes`: of an edge of one metre.
    fn check_edge(&self, edge: &At<f64>, nodes: f64) -> Result<(), Problem> {
        let edge_length = self.positive(edge, &[*edge.get()])?[0];
        self.check_nodes(edge, nodes / (edge_length * edge_length))
    }

    fn check_nodes<T>(&self, at: &At<T>, n_nodes: f64) -> Result<(), Problem> {
        match n_nodes <= self.most_nodes as f64 {
            true => Ok(()),
            false => Err(self
                .source
                .problem(at, too_many_nodes(n_nodes, self.most_nodes))),
        }
    }

    fn polygon(
        &self,
        outline: &At<Vec<Pair<f64>>>,
        holes: &[At<Vec<Pair<f64>>>],
        edge: &At<f64>,
    ) -> Result<Shaped, Problem> {
        self.check_edge(edge, 0.0)?;
        let points = |ring: &At<Vec<Pair<f64>>>| ring.get().iter().map(|at| at.0).collect();
        let drawn = Outline {
            name: None,
            outer: points(outline),
            holes: holes.iter().map(points).collect(),
        };
        let mesh = mesh_of(&drawn, *edge.get(), self.most_nodes);
        let mesh = mesh.map_err(|error| {
            let (culprit, what) = of_mesh(&error);
            match culprit {
                MeshCulprit::Edge => self.source.problem(edge, what),
                MeshCulprit::Ring(0) => self.source.problem(outline, what),
                MeshCulprit::Ring(ring) => match holes.get(ring - 1) {
                    Some(hole) => self.source.problem(hole, what),
                    None => self.source.problem(outline, what),
                },
                MeshCulprit::All => self.source.problem(self.shape, what),
            }
        })?;
        Ok(Shaped::from(mesh))
    }

    fn msh(&self, file: &At<PathBuf>) -> Result<Shaped, Problem> {
        let path = self.source.beside(file.get());
        let most_bytes = (self.most_nodes as u64).saturating_mul(BYTES_TO_A_NODE);
        let refuse = |what: &dyn Display| {
            let what = format!("{}: {what}", path.display());
            self.source.problem(file, what)
        };
        check_readable(&path, most_bytes).map_err(|problem| self.source.problem(file, problem))?;
        let msh = MshMesh::read(&path).map_err(|error| refuse(&error))?;
        let mesh = msh.mesh_with_regions();
        let mesh = mesh.map_err(|error| refuse(&of_mesh(&error).1))?;
        let groups = msh.boundaries.into_iter();
        let groups = groups.map(|group| (group.name, group.nodes)).collect();
        Ok(Shaped { mesh, groups })
    }

    fn outline(&self) -> Result<Shaped, Problem> {
        let Shape::Outline {
            file,
            edge,
            scale,
            name,
            part,
        } = self.shape.get()
        else {
            return Err(self.source.problem(self.shape, "this is no outline"));
        };
        let path = self.source.beside(file.get());
        let wanted: Vec<String> = name.iter().map(|name| name.get().clone()).collect();
        let found = outlines(
            &path,
            &Wanted {
                edge: *edge.get(),
                scale: *scale.get(),
                names: &wanted,
            },
        );
        let found = found.map_err(|refused| match (refused, name) {
            (Refused::Name(what), Some(name)) => self.source.problem(name, what),
            (refused, _) => self.source.problem(file, Problem::from(refused)),
        })?;
        let outline = match (found.as_slice(), part) {
            ([one], None) => one,
            (all, None) => {
                let what = several(all);
                return Err(match name {
                    Some(name) => self.source.problem(name, what),
                    None => self.source.problem(file, what),
                });
            }
            (all, Some(part)) => {
                let index = part.get().checked_sub(1);
                let found = index.and_then(|index| all.get(index));
                found.ok_or_else(|| {
                    let what = format!("`part` counts from 1 to {} here", all.len());
                    self.source.problem(part, what)
                })?
            }
        };
        let mesh = mesh_of(outline, *edge.get(), self.most_nodes);
        let mesh = mesh.map_err(|error| match of_mesh(&error) {
            (MeshCulprit::Edge, what) => self.source.problem(edge, what),
            (_, what) => {
                let what = format!("{}: {what}", path.display());
                self.source.problem(file, what)
            }
        })?;
        Ok(Shaped::from(mesh))
    }
}

/// Says that there is a choice of outlines.
fn several(all: &[Outline]) -> String {
    let named = match names(all).as_slice() {
        [] | [_] => String::new(),
        names => format!(" by a `name` ({})", names.join(", ")),
    };
    let n = all.len();
    format!("there are {n} outlines: choose one{named}, or by a `part` from 1 to {n}")
}

impl From<Mesh> for Shaped {
    fn from(mesh: Mesh) -> Self {
        let groups = Vec::new();
        Self { mesh, groups }
    }
}
