//! The traversal benchmark: whether and when structure of arrays pays is measured here, not believed.
//!
//! A [`Plan`] names subjects (generated, see [`meshes`], or a user's mesh), [`rays`] and arms ([`crate::measure::arms`]);
//! [`run`] gives a [`Record`] for every combination, [`report`] makes them readable.
//!
//! # Method
//!
//! **One thing at a time.** An arm is a tree, a layout of primitives and an instruction set. Arms of one subject trace the
//! same rays in the same order. All trees come from one build and have the same leaves: the binary tree only splits each
//! eight-wide node into pairs, and the one with boxes in bytes rounds them outward. The layouts hold the same primitives in
//! the same order, and all instruction sets run the same source. Hence two rows that differ in one word differ in that thing
//! alone. The rivals walk one ray after the other; the product's kernels are a row of their own, `luxel`, and do more: they
//! also bound the error of every hit.
//!
//! **Right before fast.** Before anything is timed, every arm traces every ray that it will be timed on, and t, u, v and the
//! primitive of the closest hit, or the occlusion, must be those of the product's kernels, bit for bit. If one is not, the
//! run ends with the arm and the ray. The checksum of the answers stands in every row, so that runs on different machines
//! compare, too.
//!
//! **Time** is CPU time of one thread, by the clock of the thread where the system has one. A ray set is cut into chunks of
//! 4096 rays. In a pass every arm traces all chunks, one arm after the other; then the next pass begins. A chunk's time is
//! its shortest of all passes, at least three, and the time of the ray set is the sum over its chunks. Disturbances only
//! ever add time (interrupts, a neighbour in the shared cache, a slower clock), so that the shortest time of a short piece of
//! work is the best estimate of what the work itself takes; taking turns makes what lasts longer than a pass hit all arms
//! alike. Between two passes over a chunk lies the whole rest of the set, so that its minimum is not that of warm caches.
//! Differences of a few percent between runs are noise all the same.
//!
//! **Work** is counted by a pass of its own, outside the timing: inner nodes whose children's boxes were tested, primitives
//! that were tested in leaves, and the lanes that these took with the padding of leaves. It is a function of the tree and the
//! rays: the instruction set does not change it, nor does the layout, but for the padding.
//!
//! **Bytes** a primitive are those of nodes and primitives that traversal may touch. **Build** is the wall time of the
//! product's builder on all threads.

mod answers;
pub(super) mod clock;
mod contender;
mod generator;
mod matrix;
pub mod meshes;
mod plan;
pub mod random;
pub mod rays;
mod record;
pub mod report;
mod subject;
mod timing;

pub use answers::Disagreement;
pub use generator::Generator;
pub use matrix::run;
pub use plan::{Plan, Source, Stage};
pub use random::Random;
pub use rays::{RayKind, RaySets};
pub use record::Record;
pub use subject::{LENGTH, Subject, View};
