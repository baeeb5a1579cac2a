//! A guide, page by page; all code on these pages is run as tests.
//!
//! | page | tells |
//! |---|---|
//! | [`first_beam`] | a beam in a rapier world, and whether it is right |
//! | [`choosing`] | what you want, and what to choose for it |
//! | [`mesh_and_step`] | which mesh, which step, which damping, which integrator |
//! | [`contact`] | what touches what, with which forces, at which distance |
//! | [`large_or_small`] | bodies that bend far and bodies that do not |
//! | [`reports`] | what a step tells, and what to do about it |
//! | [`statics`] | equilibria and natural modes, without a world |
//! | [`files`] | shapes from other programs, and results for them |
//! | [`embedding`] | flexible bodies in an app that exists: events, joints, saving, sleep |
//! | [`other_apps`] | rapier's testbed, macroquad, Bevy |
//! | [`performance`] | what a step costs, and how to make it cost less |
//! | [`soft_bodies`] | coming from rapier's own soft bodies |
//! | [`equations`] | the equations of the source, and where each is computed |
//! | [`limits`] | what the crate cannot do, or does with an error that is known |

pub mod choosing;
pub mod contact;
pub mod embedding;
pub mod equations;
pub mod files;
pub mod first_beam;
pub mod large_or_small;
pub mod limits;
pub mod mesh_and_step;
pub mod other_apps;
pub mod performance;
pub mod reports;
pub mod soft_bodies;
pub mod statics;
