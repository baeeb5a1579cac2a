//! `foil2d mesh`.

use super::problem::Problem;
use super::shape::outlines;
use clap::Args;
use foil2d::fe::mesh::generate::PolygonOptions;
use foil2d::io::{VtuEncoding, write_vtu};
use foil2d::prelude::*;
use std::path::PathBuf;

#[derive(Args)]
pub struct Options {
    /// An outline: SVG, or JSON as of maps.
    outline: PathBuf,
    /// Length of the cells' edges (m).
    #[arg(long, default_value_t = 0.05)]
    edge: f64,
    /// Metres to a unit of the file (a pixel, of SVG).
    #[arg(long, default_value_t = 0.01)]
    scale: f64,
    /// Writes the first mesh for ParaView (.vtu).
    #[arg(long)]
    out: Option<PathBuf>,
}

/// Meshes outlines and tells of the meshes.
pub fn mesh(options: &Options) -> Result<(), Problem> {
    for (index, outline) in outlines(&options.outline, options.edge, options.scale)?
        .iter()
        .enumerate()
    {
        let mesh = outline
            .mesh(&PolygonOptions::new(options.edge))
            .and_then(|mesh| mesh.to_tri6())
            .map_err(Problem::plain)?;
        let quality = mesh.quality();
        println!(
            "{}: {} nodes, {} cells of six nodes, {:.4e} m²; smallest angle {:.1} degrees, edges {:.3e} to {:.3e} m",
            outline.name.as_deref().unwrap_or("outline"),
            mesh.n_nodes(),
            mesh.n_cells(),
            mesh.area(),
            quality.min_angle,
            quality.min_edge,
            quality.max_edge,
        );
        if let Some(path) = options.out.as_ref().filter(|_| index == 0) {
            // Any material: the file shows the mesh.
            let material = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
            let body = FlexBodyBuilder::mesh(mesh)
                .material(material)
                .build()
                .map_err(Problem::plain)?;
            write_vtu(path, &body, VtuEncoding::Ascii).map_err(Problem::plain)?;
            println!("wrote {}", path.display());
        }
    }
    Ok(())
}
