//! Scenes that luxel writes itself: before stage one.
//!
//! Enters: a mesh or a glTF file that was read, and what is wanted of it. Leaves: a [`crate::scene::SceneDesc`], which
//! [`crate::scene::write()`] turns into the text that a person would start from.
//!
//! Deliberately absent: the world, pixels, the reading of files.

mod convert;
mod fit;
mod node;
mod numbers;
mod paths;
pub mod points;
mod turntable;

pub use convert::{Converted, convert_mesh, convert_model};
pub use paths::{PathError, path_from};
pub use turntable::{NoExtent, Turntable, Up, turntable};
