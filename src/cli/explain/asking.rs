//! Which entities ask for what a scene needs.

use crate::cli::names::entity_name;
use crate::flat::{
    ColorSource, FlatScene, Geometry, Material, MaterialId, ObjectId, Opacity, SphereBlock,
};
use crate::scene::{NormalsDesc, SceneDesc, ShapeDesc};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Who asked for something.
pub(super) enum Asked {
    /// A part of the scene that is no entity.
    Place(&'static str),
    /// The first entity, and how many more.
    Entities(String, usize),
}

impl Asked {
    /// `"cat" and 7 more`.
    pub(super) fn words(&self) -> String {
        match self {
            Asked::Place(place) => (*place).to_owned(),
            Asked::Entities(first, 0) => first.clone(),
            Asked::Entities(first, more) => format!("{first} and {more} more"),
        }
    }
}

/// The objects that ask.
type Objects = BTreeSet<ObjectId>;

/// Whether a material reads a texture that is wanted.
pub(super) fn reads(material: &Material, wanted: &dyn Fn(u32) -> bool) -> bool {
    let of = |source: ColorSource| match source {
        ColorSource::Texture { texture, .. } => wanted(texture),
        ColorSource::Constant(_) => false,
    };
    let coverage = match material.opacity {
        Opacity::Full => None,
        Opacity::Mask { coverage, .. } | Opacity::Blend(coverage) => coverage.texture,
    };
    of(material.color) || material.emission_source.is_some_and(of) || coverage.is_some_and(wanted)
}

/// Finds who asks for what.
pub(super) struct Asking<'a> {
    desc: &'a SceneDesc,
    scene: &'a FlatScene,
    /// Of each material, the entities that have it, by themselves or by their files.
    wearers: Vec<Objects>,
}

impl<'a> Asking<'a> {
    pub(super) fn new(desc: &'a SceneDesc, scene: &'a FlatScene) -> Asking<'a> {
        Asking {
            desc,
            scene,
            wearers: wearers(scene),
        }
    }

    fn told(&self, objects: &Objects) -> Option<Asked> {
        let first = entity_name(self.desc, *objects.first()?);
        Some(Asked::Entities(first, objects.len() - 1))
    }

    /// By their objects; files where no entity of the scene is known.
    fn by(&self, objects: &Objects) -> Asked {
        self.told(objects).unwrap_or(Asked::Place("files"))
    }

    /// Entities of the scene file of which `wanted` holds.
    fn entities(&self, wanted: impl Fn(usize) -> bool) -> Objects {
        let all = (0..self.desc.entities.len()).filter(|&i| wanted(i));
        all.map(|i| ObjectId(i as u32)).collect()
    }

    /// Entities with a material of which `wanted` holds.
    fn wearing(&self, wanted: impl Fn(&Material) -> bool) -> Objects {
        let wearers = self.scene.materials.iter().zip(&self.wearers);
        let wearers = wearers.filter(|(material, _)| wanted(material));
        wearers.flat_map(|(_, objects)| objects).copied().collect()
    }

    pub(super) fn material(&self, wanted: impl Fn(&Material) -> bool) -> Asked {
        self.by(&self.wearing(wanted))
    }

    pub(super) fn triangles(&self) -> Asked {
        let mut objects: Objects = self.scene.instances.iter().map(|i| i.object).collect();
        runs(&self.scene.world.shading.object).for_each(|object| _ = objects.insert(object));
        self.by(&objects)
    }

    pub(super) fn instances(&self) -> Asked {
        self.by(&self.scene.instances.iter().map(|i| i.object).collect())
    }

    pub(super) fn spheres(&self, blocks: &[SphereBlock]) -> Asked {
        let prims = blocks.iter().flat_map(|block| block.prim);
        let used = prims.filter(|&prim| prim != u32::MAX);
        self.by(&used
            .map(|prim| self.scene.spheres.object[prim as usize])
            .collect())
    }

    pub(super) fn smooth(&self) -> Asked {
        self.by(&self.entities(|i| {
            let entity = &self.desc.entities[i].value;
            let mesh =
                matches!(entity.shape, Some(ShapeDesc::Mesh { .. })) || entity.gltf.is_some();
            mesh && entity.normals != Some(NormalsDesc::Flat)
        }))
    }

    fn shining(&self) -> Objects {
        self.entities(|i| {
            let entity = &self.desc.entities[i].value;
            entity.light.is_some() || entity.gltf.is_some() && self.scene.needs.punctual
        })
    }

    pub(super) fn punctual(&self) -> Asked {
        self.by(&self.shining())
    }

    pub(super) fn lights(&self) -> Option<Asked> {
        let mut objects = self.wearing(|m| m.emission != [0.0; 3]);
        objects.extend(self.shining());
        self.told(&objects)
    }
}

/// The entities of each material. Meshes are looked at once, however many instances they have.
fn wearers(scene: &FlatScene) -> Vec<Objects> {
    let mut wearers = vec![Objects::new(); scene.materials.len()];
    let mut wear = |material: MaterialId, object: ObjectId| {
        wearers[material.0 as usize].insert(object);
    };
    let spheres = scene.spheres.material.iter().zip(&scene.spheres.object);
    spheres.for_each(|(material, object)| wear(*material, *object));
    let shading = &scene.world.shading;
    let triangles: Vec<(u32, ObjectId)> = (shading.material.iter().copied())
        .zip(shading.object.iter().copied())
        .collect();
    runs(&triangles).for_each(|(material, object)| wear(MaterialId(material), object));
    let slots = |local: &Arc<Geometry>| runs(&local.shading.material).collect();
    let slots: Vec<BTreeSet<u32>> = scene.local.iter().map(slots).collect();
    for instance in &scene.instances {
        for slot in &slots[instance.geometry as usize] {
            let index = instance.materials + slot;
            wear(scene.instance_materials[index as usize], instance.object);
        }
    }
    wearers
}

/// The first of each run of equal ones: neighbours are mostly alike.
fn runs<T: Copy + PartialEq>(all: &[T]) -> impl Iterator<Item = T> {
    all.chunk_by(|a, b| a == b).map(|run| run[0])
}
