//! The traversal benchmark: whether and when structure of arrays pays is measured here, not believed.
//!
//! A [`Plan`] names subjects (generated, see [`meshes`], or a user's mesh), [`rays`] and arms ([`crate::measure::arms`]);
//! [`run`] gives a [`Record`] for every combination, [`report`] makes them readable.

mod answers;
mod clock;
mod contender;
mod generator;
mod matrix;
pub mod meshes;
pub mod random;
pub mod rays;
pub mod report;
mod subject;
mod timing;

pub use answers::Disagreement;
pub use generator::Generator;
pub use matrix::{Plan, Record, Source, Stage, run};
pub use random::Random;
pub use rays::{RayKind, RaySets};
pub use subject::{LENGTH, Subject, View};
