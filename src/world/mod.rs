//! The world: a [`hecs::World`] of components, spawned from a scene file's description and posed at a time.
//!
//! Enters: a [`crate::scene::SceneDesc`]. Leaves: a world with every file loaded into an [`crate::asset::AssetStore`],
//! and, after [`pose`], a [`Pose`] on every entity. Why hecs: authoring, animation and change; the build reads it once a
//! frame, and tracing never sees it.
//!
//! Deliberately absent: kernels, flat buffers, pixels.

pub mod codes;
mod columns;
mod components;
mod expand;
mod files;
mod pose;
mod spawn;
mod track;

pub use components::{
    AuthoringIndex, Camera, Color, Ease, Emissive, Keys, Light, Material, Name, Normals, Parent,
    Pose, Scattering, Shape, Sky, Spin, Track, Transform, Turn,
};
pub use pose::{Poses, Time, pose, poses};
pub use spawn::{Spawned, open_files, spawn};
