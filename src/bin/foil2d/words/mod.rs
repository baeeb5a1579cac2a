//! What the library says, in the words of scenes: keys of TOML for methods of Rust, names for handles.

mod bodies;
mod course;
mod finding;
mod meshes;
mod parser;
mod step;

pub use bodies::{AttachCulprit, Culprit, of_attachment, of_build, of_material};
pub use course::of_course;
pub use finding::of_finding;
pub use meshes::{MeshCulprit, of_mesh, rounded, too_many_nodes};
pub use parser::of_parser;
pub use step::of_step;
