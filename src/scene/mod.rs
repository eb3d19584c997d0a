//! Text to [`SceneDesc`]: the scene format, every default and unit, and errors with their places.
//!
//! Deliberately absent: hecs, pixels, the contents of asset files.

pub mod schema;

pub use schema::*;
