//! glTF 2.0 files, `.gltf` and `.glb`, to meshes, textures and nodes.
//!
//! ```text
//!  bytes ─▶ container ─▶ JSON ─▶ validate ─▶ typed document ─┐
//!              └─▶ BIN chunk, files, data URIs ─▶ buffers ─▶ accessor ─▶ numbers
//! ```
//!
//! Everything cites the glTF 2.0 specification by section.

mod accessor;
mod buffers;
mod container;
mod layout;
mod source;
mod uri;
