//! The traversal benchmark: whether and when structure of arrays pays is measured here, not believed.
//!
//! [`meshes`] makes subjects, [`rays`] the rays that are traced in them.

pub mod meshes;
pub mod random;
pub mod rays;
mod subject;

pub use random::Random;
pub use rays::{RayKind, RaySets};
pub use subject::{LENGTH, Subject, View};
