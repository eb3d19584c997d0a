//! What stands still, from frame to frame: its arrays, and by what they are known again.
//!
//! Nothing of a frame depends on whether they were there: they are kept while all that they are made of is the same.

use super::bvh::{self, Built, SphereItem, Standing};
use super::meshes::{Keep, MeshKey};
use crate::flat::{FlatScene, Geometry, MaterialId, ObjectId, Shading, SphereBlock};
use crate::math::Aabb;
use crate::world::Pose;

/// All that the arrays are made of.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Sources {
    /// Flattened meshes.
    pub(crate) flats: Vec<Flat>,
    pub(crate) keep: Keep,
    /// Spheres of the tree that stand.
    pub(crate) spheres: Vec<SphereItem>,
    /// Instances that stand: which, and their boxes.
    pub(crate) instances: (Vec<u32>, Vec<Aabb>),
}

/// A flattened mesh.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Flat {
    pub(crate) key: MeshKey,
    pub(crate) pose: Pose,
    pub(crate) object: ObjectId,
    pub(crate) slots: Vec<MaterialId>,
}

/// The arrays of what stands, or, while a frame has them, only what is known of them.
pub(crate) struct Kept {
    sources: Sources,
    standing: Standing,
    arrays: Option<Arrays>,
}

struct Arrays {
    world: Geometry,
    spheres: Vec<SphereBlock>,
}

impl Kept {
    pub(crate) fn new(sources: Sources, standing: Standing) -> Kept {
        Kept {
            sources,
            standing,
            arrays: None,
        }
    }

    /// The geometry, if it is made of the same as `sources` say.
    pub(crate) fn world(&self, sources: &Sources) -> Option<&Geometry> {
        let arrays = self.arrays.as_ref()?;
        (self.sources == *sources).then_some(&arrays.world)
    }

    /// Gives the arrays away: the tree and what it is, and the shading.
    pub(crate) fn take(&mut self) -> Option<(Built, Standing, Shading)> {
        let Arrays { world, spheres } = self.arrays.take()?;
        let built = Built {
            bvh: world.bvh,
            triangles: world.triangles,
            sphere_blocks: spheres,
            cost: self.standing.cost(),
        };
        Some((built, self.standing, world.shading))
    }

    /// Takes them back from the frame they were given to.
    pub(crate) fn give_back(&mut self, scene: FlatScene) {
        let FlatScene {
            mut world, spheres, ..
        } = scene;
        let mut blocks = spheres.blocks;
        self.standing.cut_back(&mut world.bvh, &mut blocks);
        self.arrays = Some(Arrays {
            world,
            spheres: blocks,
        });
    }
}

/// The vertices of every triangle, as rays see them.
pub(crate) fn vertices(world: &crate::flat::Triangles) -> Vec<[crate::math::Vec3; 3]> {
    let prims = 0..world.place.len();
    prims
        .map(|prim| super::meshes::triangle(world, prim))
        .collect()
}

/// The tree of a frame: what stands, with what moves above it.
pub(crate) fn above(
    built: Built,
    standing: &Standing,
    moving: &bvh::Primitives,
    ids: &[u32],
) -> Result<Built, Built> {
    let mut built = standing.with(built, moving)?;
    for index in &mut built.bvh.instance_order[standing.instances()..] {
        *index = ids[*index as usize];
    }
    Ok(built)
}
