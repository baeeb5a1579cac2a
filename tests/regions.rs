//! Bodies of several materials, by regions of their mesh, at small and at large strain.

#[path = "regions/bodies.rs"]
mod bodies;
mod common;
#[path = "regions/statics.rs"]
mod statics;
#[path = "regions/together.rs"]
mod together;
