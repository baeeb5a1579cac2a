//! `foil2d mesh`.

use super::files::{check_writable, print};
use super::outlines::{Wanted, note_left_out, outlines};
use super::problem::Problem;
use super::scene::MOST_NODES;
use super::shape::mesh_of;
use super::words::of_mesh;
use clap::Args;
use foil2d::io::{VtuEncoding, write_vtu};
use foil2d::prelude::*;
use std::path::PathBuf;

#[derive(Args)]
pub struct Options {
    /// An outline: SVG, or GeoJSON (.json, .geojson).
    outline: PathBuf,
    /// Length of the cells' edges (m).
    #[arg(long, default_value_t = 0.05)]
    edge: f64,
    /// Metres to a unit of the file (a pixel, of SVG).
    #[arg(long, default_value_t = 0.01)]
    scale: f64,
    /// Only the shapes of this id, or of a group (layer) of this id; may be given several times.
    #[arg(long)]
    layer: Vec<String>,
    /// Most nodes of a mesh.
    #[arg(long, default_value_t = MOST_NODES)]
    most_nodes: usize,
    /// Writes the first mesh for ParaView (.vtu).
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Meshes outlines and tells of the meshes.
pub fn mesh(options: &Options) -> Result<(), Problem> {
    for (name, value) in [("edge", options.edge), ("scale", options.scale)] {
        if !(value > 0.0 && value <= 1e12) {
            let what = format!("--{name} is {value}: give a positive number");
            return Err(Problem::plain(what));
        }
    }
    check_writable(options.out.as_slice())?;
    let wanted = Wanted {
        edge: options.edge,
        scale: options.scale,
        names: &options.layer,
    };
    let found = outlines(&options.outline, &wanted)?;
    note_left_out(&options.outline);
    for (index, outline) in found.iter().enumerate() {
        let name = match outline.name.as_deref() {
            Some(name) => format!("`{name}`"),
            None => format!("outline {}", index + 1),
        };
        let mesh = mesh_of(outline, options.edge, options.most_nodes);
        let mesh = mesh.map_err(|error| {
            let what = format!("{name}: {}", of_mesh(&error).1);
            Problem::of_file(what, &options.outline)
        })?;
        let quality = mesh.quality();
        print(&format!(
            "{name}: {} nodes, {} cells of six nodes, {:.4e} m²; smallest angle {:.1} degrees, edges {:.3e} to {:.3e} m\n",
            mesh.n_nodes(),
            mesh.n_cells(),
            mesh.area(),
            quality.min_angle,
            quality.min_edge,
            quality.max_edge,
        ))?;
        if let Some(path) = options.out.as_ref().filter(|_| index == 0) {
            // Any material: the file shows the mesh.
            let material = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
            let body = FlexBodyBuilder::mesh(mesh)
                .material(material)
                .build()
                .map_err(Problem::plain)?;
            write_vtu(path, &body, VtuEncoding::Ascii).map_err(Problem::plain)?;
            print(&format!("wrote {}\n", path.display()))?;
        }
    }
    Ok(())
}
