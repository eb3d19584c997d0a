//! Extract: what the build needs of the world, copied out in authoring order, since hecs has none.

use super::meshes::MeshKey;
use crate::asset::{Light, MeshId};
use crate::flat::ObjectId;
use crate::world::{
    AuthoringIndex, Camera, Emissive, Keys, Material, Normals, Parent, Pose, Shape, Sky, Spin,
};
use hecs::{Entity, World};
use std::collections::{HashMap, HashSet};

/// The world at one time, sorted by [`AuthoringIndex`].
#[derive(Debug)]
pub(crate) struct Extracted {
    pub(crate) camera: (Pose, Camera),
    pub(crate) spheres: Vec<SphereItem>,
    pub(crate) meshes: Vec<MeshItem>,
    pub(crate) lights: Vec<LightItem>,
    pub(crate) sky: Option<Sky>,
}

/// A light without extent, where it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightItem {
    pub(crate) pose: Pose,
    pub(crate) light: Light,
}

/// What every shape has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look {
    pub(crate) object: ObjectId,
    pub(crate) pose: Pose,
    /// Overrides what a mesh file says.
    pub(crate) material: Option<Material>,
    pub(crate) emission: Option<[f64; 3]>,
    /// Whether the entity or an ancestor ever moves: known from the scene, not from the frame.
    pub(crate) moves: bool,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct SphereItem {
    pub(crate) look: Look,
    pub(crate) radius: f64,
    pub(crate) inverted: bool,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct MeshItem {
    pub(crate) look: Look,
    pub(crate) mesh: MeshId,
    pub(crate) normals: Normals,
}

impl MeshItem {
    pub(crate) fn key(&self) -> MeshKey {
        MeshKey::new(self.mesh, self.normals)
    }
}

/// A world without a camera (`spawn` makes none) is seen from its origin.
const NO_CAMERA: Camera = Camera {
    vfov_deg: 60.0,
    aperture_radius: 0.0,
    focus_distance: 1.0,
};

/// Reads the world; `pose_of` says where an entity is.
pub(crate) fn extract(world: &World, pose_of: impl Fn(Entity) -> Pose) -> Extracted {
    let mut query = world.query::<(
        Entity,
        &AuthoringIndex,
        Option<&Shape>,
        Option<&Material>,
        Option<&Emissive>,
        Option<&Camera>,
        Option<&Light>,
    )>();
    let mut rows: Vec<_> = query.iter().collect();
    rows.sort_by_key(|row| row.1);
    let moving = moving(world);
    let mut extracted = Extracted {
        camera: (Pose::default(), NO_CAMERA),
        spheres: Vec::new(),
        meshes: Vec::new(),
        lights: Vec::new(),
        sky: world.query::<&Sky>().iter().next().copied(),
    };
    for (entity, index, shape, material, emissive, camera, light) in rows {
        let look = Look {
            object: ObjectId(index.entity),
            pose: pose_of(entity),
            material: material.copied(),
            emission: emissive.map(|e| e.0),
            moves: moving.contains(&entity),
        };
        match shape.copied() {
            Some(Shape::Sphere { radius, inverted }) => extracted.spheres.push(SphereItem {
                look,
                radius,
                inverted,
            }),
            Some(Shape::Mesh { mesh, normals }) => extracted.meshes.push(MeshItem {
                look,
                mesh,
                normals,
            }),
            None => {}
        }
        if let Some(camera) = camera {
            extracted.camera = (look.pose, *camera);
        }
        extracted.lights.extend(light.map(|light| LightItem {
            pose: look.pose,
            light: *light,
        }));
    }
    extracted
}

/// Every entity that turns or has keys, or whose ancestor does.
fn moving(world: &World) -> HashSet<Entity> {
    let mut children: HashMap<Entity, Vec<Entity>> = HashMap::new();
    for (entity, parent) in world.query::<(Entity, &Parent)>().iter() {
        children.entry(parent.0).or_default().push(entity);
    }
    let mut next: Vec<Entity> = world
        .query::<(Entity, hecs::Or<&Spin, &Keys>)>()
        .iter()
        .map(|(entity, _)| entity)
        .collect();
    let mut moving = HashSet::new();
    while let Some(entity) = next.pop() {
        if moving.insert(entity) {
            next.extend(children.get(&entity).into_iter().flatten());
        }
    }
    moving
}
