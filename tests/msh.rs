//! Meshes of gmsh: what it has written is read as it says, and nothing else does any harm.

#[path = "msh/damaged.rs"]
mod damaged;
#[path = "msh/read.rs"]
mod read;
