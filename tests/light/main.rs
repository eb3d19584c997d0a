//! Light: luxel against closed forms, furnaces and an independent f64 reference tracer.
//!
//! `cargo test --release --test light` is the quick part. The long part compares with other renderers' pictures:
//! `LUXEL_DATA=… cargo test --release --test light -- --ignored --nocapture`.

#[path = "../reference/mod.rs"]
mod reference;

mod closed;
mod stats;
mod self_check;
