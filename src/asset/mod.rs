//! Files to arrays: meshes (OBJ with MTL, glTF), textures and skies, behind ids in an immutable store.
//!
//! Stage two. Enter: paths that a scene names. Leave: an immutable [`AssetStore`] and ids into it, or diagnostics with
//! file and line, or file and JSON pointer.
//!
//! ```text
//!  OBJ ─▶ text ─▶ scan (lines, indices, plain numbers; others by tobj) ─▶ obj (polygons cut, triangles in file order) ─▶ Mesh
//!  MTL ─▶ text ─▶ mtl ─▶ MeshMaterial        PNG, JPEG ─▶ texture ─▶ Texture
//!  HDR, EXR ─▶ panorama ─▶ Panorama
//!  glTF, GLB ─▶ gltf (its own picture) ─▶ Model of nodes, Meshes, MeshMaterials, Textures
//! ```
//!
//! Deliberately absent: the scene, the world, pixels of the film.

pub mod codes;
mod corner;
mod duplicates;
mod face;
mod gltf;
mod limits;
mod loader;
mod materials;
mod meaning;
mod mtl;
pub mod normals;
mod numbers;
mod obj;
mod panorama;
mod paths;
mod places;
mod reading;
mod records;
mod scan;
#[cfg(test)]
mod tests;
mod text;
mod texture;
mod texture_line;
mod told;
mod triangulate;

pub use corner::PerCorner;
pub use limits::Limits;
pub use loader::Loader;
pub use panorama::{MAX_RADIANCE, Panorama};
pub use reading::Reading;

use crate::math::{DAffine3, DMat3, DVec2, DVec3, quaternion};
use std::path::PathBuf;
use std::sync::Arc;

/// A mesh of the [`AssetStore`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MeshId(pub u32);

/// A texture of the [`AssetStore`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TextureId(pub u32);

/// An image of the sky of the [`AssetStore`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PanoramaId(pub u32);

/// A glTF file of the [`AssetStore`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ModelId(pub u32);

/// An indexed triangle mesh in its own space, in file order.
///
/// Attributes are per *corner*: corner `3 * triangle + k`. One position may have a different uv and normal in
/// every triangle that uses it, so a seam cannot shift a texture.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// The file.
    pub path: PathBuf,
    /// Vertex positions as authored, of those vertices that a triangle uses.
    pub positions: Vec<DVec3>,
    /// Position index of each corner; length `3 * triangles`. Triangles are in file order after triangulation, without
    /// those that have no area: these are dropped and do not count.
    pub corners: Vec<u32>,
    /// Texture coordinates of each corner, v up; `None` for a triangle whose face has none. Empty when the file has
    /// none at all, else length `3 * triangles`.
    pub uvs: PerCorner<DVec2>,
    /// The second set of texture coordinates, like `uvs`. Empty unless a material of the mesh reads it.
    pub uvs1: PerCorner<DVec2>,
    /// Linear colour and alpha of each corner. The colour multiplies that of materials with
    /// [`MeshMaterial::vertex_colors`], the alpha the opacity of those with [`Opacity::vertex_alpha`]. Empty when the
    /// file has none, else length `3 * triangles`.
    pub colors: Vec<[f32; 4]>,
    /// Normals of each corner as in the file, unit length; `None` where the file gives none. Empty when the file has
    /// none at all, else length `3 * triangles`.
    pub normals: PerCorner<DVec3>,
    /// Whether a mesh without normals is meant to be faceted, as glTF has it (2.0, section 3.7.2.1), not smooth.
    pub faceted: bool,
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

/// A material of a mesh file (MTL, glTF): what luxel reads of it.
#[derive(Clone, Debug)]
pub struct MeshMaterial {
    /// Its name in the file.
    pub name: String,
    /// How it scatters.
    pub scattering: Scattering,
    /// Linear colour (`Kd`, `baseColorFactor`), as a factor of `texture` where there is one.
    pub color: [f64; 3],
    /// Colour texture (`map_Kd`, `baseColorTexture`).
    pub texture: Option<TextureUse>,
    /// Whether [`Mesh::colors`] multiply the colour; where nothing is scattered, the emission.
    pub vertex_colors: bool,
    /// Linear emitted radiance (`Ke`, `emissiveFactor` times its strength), as a factor of `emission_texture`.
    pub emission: [f64; 3],
    /// Texture of the emission (`map_Ke`, `emissiveTexture`).
    pub emission_texture: Option<TextureUse>,
    /// Whether it shines from both sides (`doubleSided`), not from that alone which the geometric normal points to.
    pub two_sided: bool,
    /// How much of the surface is there.
    pub opacity: Opacity,
}

impl MeshMaterial {
    /// An opaque diffuse material of one colour.
    #[must_use]
    pub fn diffuse(name: impl Into<String>, color: [f64; 3]) -> MeshMaterial {
        MeshMaterial {
            name: name.into(),
            scattering: Scattering::Diffuse,
            color,
            texture: None,
            vertex_colors: false,
            emission: [0.0; 3],
            emission_texture: None,
            two_sided: false,
            opacity: Opacity::OPAQUE,
        }
    }
}

/// The kind of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scattering {
    /// Not at all: a pure emitter.
    Nothing,
    /// Two-sided Lambert.
    Diffuse,
    /// Perfect mirror.
    Mirror,
    /// Smooth dielectric.
    Glass {
        /// Inside over outside.
        ior: f64,
    },
    /// Smooth dielectric coat over Lambert.
    Plastic {
        /// Of the coat.
        ior: f64,
    },
    /// Smooth metal.
    Metal,
}

/// How much of a surface is there: `factor` times the alpha of `texture` and of the corners, read by `mode`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opacity {
    /// 0 to 1.
    pub factor: f64,
    /// Whose alpha multiplies the factor; a texture without alpha counts as 1.
    pub texture: Option<TextureUse>,
    /// Whether the alpha of [`Mesh::colors`] multiplies it too.
    pub vertex_alpha: bool,
    /// What the product means.
    pub mode: AlphaMode,
}

impl Opacity {
    /// All of it.
    pub const OPAQUE: Opacity = Opacity {
        factor: 1.0,
        texture: None,
        vertex_alpha: false,
        mode: AlphaMode::Opaque,
    };
}

/// What opacity means (glTF 2.0, section 3.9.4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaMode {
    /// Nothing: all of the surface is there.
    Opaque,
    /// There where opacity is at least the cutoff, not there elsewhere.
    Mask {
        /// 0 to 1.
        cutoff: f64,
    },
    /// Of so many rays the opacity meets the surface; the others go straight on.
    Blend,
}

/// A texture as a material of a file reads it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureUse {
    /// Which.
    pub texture: TextureId,
    /// 0: [`Mesh::uvs`]; 1: [`Mesh::uvs1`].
    pub uv_set: u8,
    /// Row-major 2 × 3 matrix of texture coordinates (v up) to those that are looked up; `None` is the identity.
    pub transform: Option<[f64; 6]>,
    /// Outside [0, 1], along u and v.
    pub wrap: [Wrap; 2],
    /// Between texels.
    pub filter: Filter,
}

impl TextureUse {
    /// The first set of coordinates as they are, tiled and smooth.
    #[must_use]
    pub fn plain(texture: TextureId) -> TextureUse {
        TextureUse {
            texture,
            uv_set: 0,
            transform: None,
            wrap: [Wrap::default(); 2],
            filter: Filter::default(),
        }
    }
}

/// A light without extent; it shines from its place along −Z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Light {
    /// Equally into every direction.
    Point {
        /// Radiant intensity in W·sr⁻¹, linear RGB.
        intensity: [f64; 3],
    },
    /// Into a cone. Between the angles the intensity falls off as the square of (cos θ − cos outer) /
    /// (cos inner − cos outer), the recommendation of KHR_lights_punctual.
    Spot {
        /// Along the axis, in W·sr⁻¹, linear RGB.
        intensity: [f64; 3],
        /// Angle from the axis within which it is full, in degrees.
        inner_deg: f64,
        /// Angle from the axis beyond which it is nothing, in degrees.
        outer_deg: f64,
    },
    /// From infinitely far away.
    Sun {
        /// Irradiance of a surface that faces it in W·m⁻², linear RGB.
        irradiance: [f64; 3],
    },
}

/// A glTF file: the nodes of its default scene.
#[derive(Clone, Debug)]
pub struct Model {
    /// The file.
    pub path: PathBuf,
    /// Nodes in the order of a depth-first walk: parents before their children.
    pub nodes: Vec<ModelNode>,
    /// Meshes by their index in the file; `None` for those that no node of the default scene uses, or that have no
    /// triangle.
    pub meshes: Vec<Option<MeshId>>,
}

impl Model {
    /// What is shown: each mesh with the map to the file's space, in the order of the nodes.
    #[must_use]
    pub fn placed(&self) -> Vec<(MeshId, DAffine3)> {
        let mut frames: Vec<DAffine3> = Vec::with_capacity(self.nodes.len());
        let mut placed = Vec::new();
        for node in &self.nodes {
            // Parents come before their children.
            let parent = node.parent.and_then(|p| frames.get(p).copied());
            let frame = parent.unwrap_or_default() * node.transform.affine();
            frames.push(frame);
            let mesh = node.mesh.and_then(|m| *self.meshes.get(m)?);
            placed.extend(mesh.map(|mesh| (mesh, frame)));
        }
        placed
    }

    /// Whether there is nothing to see, to see by or to see from: no triangles, lights or cameras.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        let serves = |node: &ModelNode| node.light.is_some() || node.camera_vfov_deg.is_some();
        self.meshes.iter().all(Option::is_none) && !self.nodes.iter().any(serves)
    }
}

/// A node of a [`Model`].
#[derive(Clone, Debug)]
pub struct ModelNode {
    /// Its name in the file.
    pub name: Option<String>,
    /// Its index in the file's `nodes`.
    pub index: u32,
    /// Index into [`Model::nodes`].
    pub parent: Option<usize>,
    /// In the parent's frame.
    pub transform: NodeTransform,
    /// Index into [`Model::meshes`].
    pub mesh: Option<usize>,
    /// Vertical field of view in degrees of the perspective camera here, which looks along −Z.
    pub camera_vfov_deg: Option<f64>,
    /// The light here, along −Z.
    pub light: Option<Light>,
    /// How the node moves.
    pub motion: Option<Motion>,
}

/// How a node moves: what has a curve is the curve's, in place of the transform's.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// x, y, z and nothing.
    pub translate: Option<Curve>,
    /// Quaternions x, y, z, w, about 1 long.
    pub rotate: Option<Curve>,
    /// x, y, z and nothing; never 0.
    pub scale: Option<Curve>,
}

/// Values at times; before the first and behind the last as there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// Seconds, rising, at least one.
    pub times: Vec<f64>,
    /// At each of the times.
    pub values: Vec<[f64; 4]>,
    /// Of splines, with which each value is reached and left, per second; else empty.
    pub tangents: Vec<[[f64; 4]; 2]>,
    /// Between the times.
    pub interpolation: Interpolation,
}

/// How a curve goes from one value to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Straight; rotations about one axis.
    #[default]
    Linear,
    /// Not at all, until the next.
    Step,
    /// Along cubic splines.
    Spline,
}

/// Where a node is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NodeTransform {
    /// T · R · S.
    Parts {
        /// In the parent's units.
        translate: DVec3,
        /// Unit quaternion x, y, z, w.
        rotate: [f64; 4],
        /// Along the node's own axes.
        scale: DVec3,
    },
    /// An affine map as authored.
    Matrix(DAffine3),
}

impl NodeTransform {
    /// As one affine map.
    #[must_use]
    pub fn affine(&self) -> DAffine3 {
        match *self {
            NodeTransform::Parts {
                translate,
                rotate,
                scale,
            } => DAffine3 {
                matrix3: quaternion(rotate) * DMat3::from_diagonal(scale),
                translation: translate,
            },
            NodeTransform::Matrix(map) => map,
        }
    }
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
    /// The file, or the glTF file that holds it.
    pub path: PathBuf,
    /// Texels per row.
    pub width: u32,
    /// Rows; row 0 is the top of the image, v = 1.
    pub height: u32,
    /// sRGB-encoded R, G, B of each texel, row by row from the top; length `3 * width * height`. Decoding to linear
    /// happens by table when a texel is read, so that filtering is linear.
    pub texels: Arc<[u8]>,
    /// Alpha of each texel, linear, in the same order; `None` where the image has none, or is opaque everywhere.
    pub alpha: Option<Arc<[u8]>>,
}

/// Everything that files gave, immutable.
#[derive(Clone, Debug, Default)]
pub struct AssetStore {
    /// Behind [`MeshId`].
    pub meshes: Vec<Arc<Mesh>>,
    /// Behind [`TextureId`].
    pub textures: Vec<Arc<Texture>>,
    /// Behind [`PanoramaId`].
    pub panoramas: Vec<Arc<Panorama>>,
    /// Behind [`ModelId`].
    pub models: Vec<Arc<Model>>,
    /// Behind [`AssetStore::hash`].
    content_hash: [u8; 32],
    /// Behind [`AssetStore::bytes`].
    bytes: u64,
    /// Behind [`AssetStore::memory`].
    memory: u64,
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

    /// Bytes that the files decoded to, as charged to [`Limits`].
    #[must_use]
    pub fn memory(&self) -> u64 {
        self.memory
    }

    /// The texture of an id of this store.
    #[must_use]
    pub fn texture(&self, id: TextureId) -> &Arc<Texture> {
        &self.textures[id.0 as usize]
    }

    /// The image of the sky of an id of this store.
    #[must_use]
    pub fn panorama(&self, id: PanoramaId) -> &Arc<Panorama> {
        &self.panoramas[id.0 as usize]
    }

    /// The glTF file of an id of this store.
    #[must_use]
    pub fn model(&self, id: ModelId) -> &Arc<Model> {
        &self.models[id.0 as usize]
    }
}
