//! A geometry (triangles, their cold shading arrays, their tree) and its instances.

use super::{Bvh, MaterialId, Triangles};

/// An entity with a shape, by its index in the scene file's `entities`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ObjectId(pub u32);

/// Triangles of one space with what is read once per hit.
#[derive(Clone, Debug)]
pub struct Geometry {
    /// Hot: what rays are tested against.
    pub triangles: Triangles,
    /// Hot: the tree over them.
    pub bvh: Bvh,
    /// Cold: what a hit looks up.
    pub shading: Shading,
}

/// Cold arrays, indexed by primitive or by corner (`3 * prim + k`), in authoring order.
#[derive(Clone, Debug, Default)]
pub struct Shading {
    /// Corner normals; only triangles that are smooth have meaningful ones.
    pub normals: Normals,
    /// Corner texture coordinates, v up. Empty unless a textured material or the uv AOV needs them.
    pub uvs: Vec<[f32; 2]>,
    /// The second set of corner texture coordinates. Empty unless a texture reads it.
    pub uvs1: Vec<[f32; 2]>,
    /// Linear corner colours with alpha, 1 where the file has none. Empty unless a material reads them.
    pub colors: Vec<[f32; 4]>,
    /// World geometry: the material. Local geometry: the material *slot*, see [`super::FlatScene::instance_materials`].
    pub material: Vec<u32>,
    /// World geometry: the object of each primitive. Local geometry: empty, its instance knows.
    pub object: Vec<ObjectId>,
    /// Triangle index in its mesh file, after triangulation; for the prim AOV.
    pub file_prim: Vec<u32>,
}

/// Corner normals.
#[derive(Clone, Debug, Default)]
pub struct Normals {
    /// Unit normals per corner in the geometry's space; empty when no triangle is smooth. A flat triangle among
    /// smooth ones has its geometric normal three times.
    pub corner: Vec<[f32; 3]>,
}

/// A local geometry in its place. Matrices are row-major 3 × 4, f64 composed and rounded once.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Instance {
    /// Local to scene units.
    pub to_world: [[f32; 4]; 3],
    /// Scene units to local.
    pub to_local: [[f32; 4]; 3],
    /// Box in scene units, inflated by the transform's error bound. A ray that misses it misses the instance, in every
    /// tree and without one: the box is part of what an instance is.
    pub bounds: [[f32; 3]; 2],
    /// Index into [`super::FlatScene::local`].
    pub geometry: u32,
    /// First index into [`super::FlatScene::instance_materials`].
    pub materials: u32,
    /// The entity.
    pub object: ObjectId,
    /// The transform mirrors: in the scene, counter-clockwise vertices run clockwise about the outward normal.
    pub mirrored: bool,
}

impl Geometry {
    /// Material of a primitive of the world geometry.
    #[must_use]
    pub fn material(&self, prim: u32) -> MaterialId {
        MaterialId(self.shading.material[prim as usize])
    }
}
