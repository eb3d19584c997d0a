//! glTF 2.0 files, `.gltf` and `.glb`, to meshes, textures and nodes.
//!
//! ```text
//!  bytes ─▶ container ─▶ JSON ─▶ validate ─▶ typed document ─▶ nodes, cameras, lights ──────────────┐
//!              └─▶ BIN chunk, files, data URIs ─▶ buffers ─▶ accessor ─▶ numbers ─▶ meshes ──▶ model ┴─▶ Model
//!                                                     └─▶ images ─▶ textures ─▶ materials ──┘
//! ```
//!
//! Everything cites the glTF 2.0 specification by section. Deliberately absent: animations, skins (a skinned mesh stands
//! where its node is, in the pose that it was bound in) and morph targets.

mod accessor;
mod animations;
mod attributes;
mod buffers;
mod container;
mod exact;
mod gloss;
mod images;
mod layout;
mod lights;
mod materials;
mod meshes;
mod model;
mod nodes;
mod notes;
mod source;
mod textures;
mod triangles;
mod uri;
mod uses;
mod validate;

pub(super) use model::read;
