//! Files to arrays: meshes (OBJ with MTL) and textures, behind ids in an immutable store.
//!
//! Stage two. Enter: paths that a scene names. Leave: an immutable [`AssetStore`] and ids into it, or diagnostics with
//! file and line.
//!
//! ```text
//!  OBJ ─▶ text ─▶ scan (lines, indices, groups of equal attributes) ─▶ tobj ─▶ obj (triangles in file order) ─▶ Mesh
//!  MTL ─▶ text ─▶ mtl ─▶ MeshMaterial        PNG, JPEG ─▶ texture ─▶ Texture
//! ```
//!
//! Deliberately absent: the scene, the world, pixels of the film.

pub mod codes;
mod loader;
mod materials;
mod mtl;
pub mod normals;
mod obj;
mod paths;
mod scan;
#[cfg(test)]
mod tests;
mod text;
mod texture;
mod triangulate;

pub use loader::Loader;

use crate::math::{DVec2, DVec3};
use std::path::PathBuf;
use std::sync::Arc;

/// A mesh of the [`AssetStore`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MeshId(pub u32);

/// A texture of the [`AssetStore`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TextureId(pub u32);

/// An indexed triangle mesh in its own space, in file order.
///
/// Attributes are per *corner*: corner `3 * triangle + k`. One position may have a different uv and normal in
/// every triangle that uses it, so a seam cannot shift a texture.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The file.
    pub path: PathBuf,
    /// Vertex positions as authored.
    pub positions: Vec<DVec3>,
    /// Position index of each corner; length `3 * triangles`. Triangles are in file order after triangulation, without
    /// those that have no area: these are dropped and do not count.
    pub corners: Vec<u32>,
    /// Texture coordinates of each corner, v up; `None` for a triangle whose face has none. Empty when the file has
    /// none at all, else length `3 * triangles`.
    pub uvs: Vec<Option<DVec2>>,
    /// Normals of each corner as in the file, unit length; `None` where the file gives none. Empty when the file has
    /// none at all, else length `3 * triangles`.
    pub normals: Vec<Option<DVec3>>,
    /// Index into `materials` of each triangle; `None` where the file names none. Length `triangles`.
    pub material: Vec<Option<u32>>,
    /// The materials that the file names, in order of first use.
    pub materials: Vec<MeshMaterial>,
}

impl Mesh {
    /// Number of triangles.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.corners.len() / 3
    }
}

/// A material of a mesh file (MTL): what luxel reads of it.
#[derive(Clone, Debug)]
pub struct MeshMaterial {
    /// Its name in the file.
    pub name: String,
    /// Linear diffuse colour (`Kd`), as a factor of `texture` where there is one.
    pub color: [f64; 3],
    /// Colour texture (`map_Kd`).
    pub texture: Option<TextureId>,
    /// Linear emitted radiance (`Ke`).
    pub emission: [f64; 3],
}

/// Wrap mode of a texture outside [0, 1].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Wrap {
    /// Tiles.
    #[default]
    Repeat,
    /// Tiles, every second one mirrored.
    Mirror,
    /// The border's colour goes on.
    Clamp,
}

/// Texture filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Filter {
    /// Weighted mean of the four nearest texels.
    #[default]
    Bilinear,
    /// The nearest texel.
    Nearest,
}

/// A decoded image.
#[derive(Clone, Debug)]
pub struct Texture {
    /// The file.
    pub path: PathBuf,
    /// Texels per row.
    pub width: u32,
    /// Rows; row 0 is the top of the image, v = 1.
    pub height: u32,
    /// sRGB-encoded R, G, B of each texel, row by row from the top; length `3 * width * height`. Decoding to linear
    /// happens by table when a texel is read, so that filtering is linear.
    pub texels: Arc<[u8]>,
}

/// Everything that files gave, immutable.
#[derive(Clone, Debug, Default)]
pub struct AssetStore {
    /// Behind [`MeshId`].
    pub meshes: Vec<Arc<Mesh>>,
    /// Behind [`TextureId`].
    pub textures: Vec<Arc<Texture>>,
    /// Behind [`AssetStore::hash`].
    content_hash: [u8; 32],
    /// Behind [`AssetStore::bytes`].
    bytes: u64,
}

impl AssetStore {
    /// The mesh of an id of this store.
    #[must_use]
    pub fn mesh(&self, id: MeshId) -> &Arc<Mesh> {
        &self.meshes[id.0 as usize]
    }

    /// SHA-256 over the SHA-256 of every file that was read, in the order of reading, which the scene decides. Paths do
    /// not enter, so that a moved scene keeps its hash; the order does, so that two files that change places change it.
    #[must_use]
    pub fn hash(&self) -> [u8; 32] {
        self.content_hash
    }

    /// Bytes of all the files that were read.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The texture of an id of this store.
    #[must_use]
    pub fn texture(&self, id: TextureId) -> &Arc<Texture> {
        &self.textures[id.0 as usize]
    }
}
