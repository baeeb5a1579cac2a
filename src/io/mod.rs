//! Into the library and out of it: meshes of other programs.

mod msh;

pub use msh::{MshError, MshMesh, MshPlace, NamedCells, NamedNodes};
