//! Precision from file to kernel: transforms, places and units must reach the kernels without loss, and a scene that is
//! moved, scaled or turned must render as itself.
//!
//! `cargo test --release --test precision` is the quick part; `-- --ignored --nocapture` the long one.

#![allow(clippy::unwrap_used, reason = "a test may")]

mod baked;
mod chains;
mod crowd;
mod instances;
mod judge;
mod mirrored;
mod places;
mod rigid;
mod small_turns;
mod stage;
#[path = "../support/mod.rs"]
mod support;
