//! The flat scene: **data only**. What the build stage writes and the tracing stage reads.
//!
//! *Scene units*: every length here is `(authored − origin) · 2^exponent`, rounded to f32 once ([`Rebase`]).
//! Radiance does not change under that map; only depths are mapped back, when they leave.
//!
//! Deliberately absent: hecs, files, rayon, names, paths, f64 transforms, and any function that searches.

pub mod bvh;
pub mod camera;
pub mod chains;
pub mod environment;
pub mod geometry;
pub mod lights;
pub mod materials;
pub mod needs;
pub mod spheres;
pub mod texture;
pub mod triangles;

pub use bvh::{Bvh, Child, LinearNode};
pub use camera::{Camera, PixelFilter};
pub use chains::{Bounces, Chains};
pub use environment::{Environment, EnvironmentTable};
pub use geometry::{Geometry, Instance, Normals, ObjectId, Shading};
pub use lights::{LightPlace, LightTriangles, Lights, Punctual};
pub use materials::{ColorSource, Coverage, Fresnel, Material, MaterialId, Opacity, Scatter};
pub use needs::Needs;
pub use spheres::{SphereBlock, Spheres};
pub use texture::{FilterMode, Texture, WrapMode};
pub use triangles::{TriangleBlock, Triangles};

/// Lanes of a storage block: one AVX2 register holds a coordinate of all eight.
pub const BLOCK: usize = 8;

/// The map from authored (world) space to scene units, computed once per scene from its rest pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rebase {
    /// Authored coordinates of the scene's origin, a multiple of the grid step.
    pub origin: [f64; 3],
    /// `scene = (authored − origin) · scale`; a power of two.
    pub scale: f64,
}

/// Everything that tracing reads of one frame.
#[derive(Clone, Debug)]
pub struct FlatScene {
    /// World-space triangles and their tree; its leaves may also be spheres and instances.
    pub world: Geometry,
    /// Local-space meshes that move or are used more than once; behind [`Instance::geometry`].
    pub local: Vec<std::sync::Arc<Geometry>>,
    /// Instances, in authoring order.
    pub instances: Vec<Instance>,
    /// Material of (instance, slot): `instance_materials[instance.materials + slot]`.
    pub instance_materials: Vec<MaterialId>,
    /// All spheres.
    pub spheres: Spheres,
    /// Behind [`MaterialId`].
    pub materials: Vec<Material>,
    /// Behind [`ColorSource::Texture`].
    pub textures: Vec<Texture>,
    /// Everything that emits, except a background that is the same everywhere.
    pub lights: Lights,
    /// Ways of light by and through specular spheres.
    pub chains: Chains,
    /// Radiance of rays that hit nothing, the same everywhere.
    pub background: [f32; 3],
    /// Radiance of rays that hit nothing by direction, instead.
    pub environment: Option<Environment>,
    /// The camera of this frame.
    pub camera: Camera,
    /// How scene units came about.
    pub rebase: Rebase,
    /// What this scene requires.
    pub needs: Needs,
    /// Hash input of the noise: two frames differ.
    pub frame: u32,
}
