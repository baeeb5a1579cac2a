//! Shapes from other programs, and results for them.
//!
//! # In
//!
//! | from | by |
//! |---|---|
//! | gmsh, `.msh` 2.2 and 4.1, text and binary | [`MshMesh::read`](crate::io::MshMesh::read): physical curves and points are groups of nodes, physical surfaces [regions](crate::io::MshMesh::mesh_with_regions) |
//! | drawings, `.svg` | `io::outlines_from_svg`, feature `svg`: filled shapes with their holes, by layer |
//! | maps, GeoJSON | `io::outlines_from_json`, feature `json` |
//!
//! # Out
//!
//! | for | by |
//! |---|---|
//! | ParaView | [`VtuSeries`](crate::io::VtuSeries): grids with stresses, velocities, forces, and their times |
//! | a browser | [`Replay`](crate::io::Replay): one page that plays the run, without a network |
//! | a page of text | [`write_still`](crate::io::write_still): a picture of a step, as SVG; `io::write_still_png`, feature `png`, as PNG |
//! | a table | [`History`](crate::io::History): numbers of your choice, as CSV |
//!
//! ```
//! use foil2d::io::{History, Replay, Scene, still};
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//!
//! let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
//! let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
//! let block = FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(rubber);
//! let block = flex_bodies.insert(block, &mut world)?;
//! let (mut flex, mut replay) = (FlexPipeline::new(), Replay::new("a block falls"));
//! let mut history = History::new(["height"]);
//! for step in 0..30 {
//!     let report = flex.step(&mut world, &mut flex_bodies)?;
//!     let time = f64::from(step + 1) / 60.0;
//!     replay.record(time, &Scene::of(&world, &flex_bodies, report))?;
//!     history.record(time, [flex_bodies[block].centre_of_mass()[1]])?;
//! }
//! let scene = Scene::of(&world, &flex_bodies, flex.report());
//! assert!(replay.to_html().contains("a block falls") && still(&scene)?.starts_with("<svg"));
//! assert_eq!(history.to_csv().lines().count(), 31);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Without Rust
//!
//! The program `foil2d` (feature `cli`; from the repository by `cargo install --path . --features cli`) runs scenes in TOML:
//!
//! | command | does |
//! |---|---|
//! | `foil2d drop drawing.svg` | drops the shapes of a drawing on a floor; writes a picture of the stresses, a replay, a table, and the scene for changes of your own |
//! | `foil2d example > scene.toml` | writes a scene to begin with, with comments |
//! | `foil2d run scene.toml` | runs it |
//! | `foil2d doctor scene.toml` | names likely mistakes without running it |
//! | `foil2d mesh drawing.svg` | tells of the meshes of a drawing |
//! | `foil2d schema` | describes every key of scenes, as a JSON schema |
//!
//! A scene of more than `most_nodes` nodes (100,000 without) is refused before it takes all memory; errors tell the line and column of the key that is at fault.
//!
//! # What is likely a mistake
//!
//! [`doctor::examine`](crate::doctor::examine) names it before a run, [`doctor::Course`](crate::doctor::Course) tells what a run was like.
