//! luxel: a data-oriented, ECS-style scene renderer. A CPU path tracer.
//!
//! ```text
//!  scene file ──▶ SceneDesc ──▶ hecs::World(+AssetStore) ──▶ Extracted ──▶ FlatScene ──▶ pixel slices ──▶ Film ──▶ PNG/EXR
//!    (RON)        scene/          world/   (time t)           build/         flat/         trace/         film/
//! ```

pub mod asset;
pub mod build;
pub mod check;
pub mod diag;
pub mod film;
pub mod flat;
pub mod math;
pub mod render;
pub mod scene;
pub mod trace;
pub mod world;
