//! Light: luxel against closed forms, furnaces and an independent f64 reference tracer.
//!
//! `cargo test --release --test light` is the quick part. The long part compares with other renderers' pictures:
//! `LUXEL_DATA=… cargo test --release --test light peers -- --ignored --nocapture`.

#[path = "../reference/mod.rs"]
mod reference;

mod acne;
mod agreement;
mod boxes;
mod channels;
mod closed;
mod estimators;
mod files;
mod furnace;
mod invariance;
mod luxel_side;
mod npy;
mod objs;
mod oracle_uv;
mod peers;
mod punctual;
mod radiance;
mod self_check;
mod shadows;
mod sky;
mod stats;
mod tallies;
mod textures;
mod veils;
