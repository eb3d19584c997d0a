//! Extract: what the build needs of the world, listed in authoring order, since hecs has none. Nothing is copied that is
//! larger than a reference.

use super::meshes::MeshKey;
use crate::asset::{Light, MeshId};
use crate::flat::ObjectId;
use crate::world::{
    AuthoringIndex, Camera, Emissive, Keys, Material, Normals, Parent, Pose, Poses, Shape, Sky,
    Spin,
};
use hecs::{Entity, QueryBorrow, Satisfies, World};

/// The world at one time, sorted by [`AuthoringIndex`].
#[derive(Debug)]
pub(crate) struct Extracted<'a> {
    pub(crate) camera: (Pose, Camera),
    pub(crate) spheres: Vec<SphereItem<'a>>,
    pub(crate) meshes: Vec<MeshItem<'a>>,
    pub(crate) lights: Vec<LightItem<'a>>,
    pub(crate) sky: Option<Sky>,
}

/// A light without extent, where it is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightItem<'a> {
    index: AuthoringIndex,
    pub(crate) pose: &'a Pose,
    pub(crate) light: &'a Light,
}

/// What every shape has.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look<'a> {
    pub(crate) index: AuthoringIndex,
    pub(crate) pose: &'a Pose,
    /// Overrides what a mesh file says.
    pub(crate) material: Option<&'a Material>,
    pub(crate) emission: Option<&'a Emissive>,
    /// Whether the entity or an ancestor ever moves: known from the scene, not from the frame.
    pub(crate) moves: bool,
}

impl Look<'_> {
    pub(crate) fn object(&self) -> ObjectId {
        ObjectId(self.index.entity)
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct SphereItem<'a> {
    pub(crate) look: Look<'a>,
    pub(crate) radius: f64,
    pub(crate) inverted: bool,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct MeshItem<'a> {
    pub(crate) look: Look<'a>,
    pub(crate) mesh: MeshId,
    pub(crate) normals: Normals,
}

impl MeshItem<'_> {
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

/// What is read of an entity.
pub(crate) type Row<'a> = (
    Entity,
    &'a AuthoringIndex,
    Option<&'a Pose>,
    Option<&'a Shape>,
    Option<&'a Material>,
    Option<&'a Emissive>,
    Option<&'a Camera>,
    Option<&'a Light>,
);

/// Lists the rows of a world, at `poses` or, without them, where it is posed.
pub(crate) fn extract<'a>(
    world: &World,
    rows: &'a mut QueryBorrow<'_, Row<'static>>,
    poses: Option<&'a Poses>,
) -> Extracted<'a> {
    let moving = moving(world);
    let of_meshes = |row: &Row| matches!(row.3, Some(Shape::Mesh { .. }));
    let meshes = rows.iter().filter(of_meshes).count();
    let mut extracted = Extracted {
        camera: (Pose::IDENTITY, NO_CAMERA),
        spheres: Vec::new(),
        meshes: Vec::with_capacity(meshes),
        lights: Vec::new(),
        sky: world.query::<&Sky>().iter().next().copied(),
    };
    for (entity, index, posed, shape, material, emissive, camera, light) in rows.iter() {
        let pose = match poses {
            Some(poses) => poses.of(entity),
            None => posed.unwrap_or(&Pose::IDENTITY),
        };
        let look = Look {
            index: *index,
            pose,
            material,
            emission: emissive,
            moves: moving[entity.id() as usize],
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
            extracted.camera = (*pose, *camera);
        }
        extracted.lights.extend(light.map(|light| LightItem {
            index: *index,
            pose,
            light,
        }));
    }
    extracted
        .spheres
        .sort_unstable_by_key(|item| item.look.index);
    extracted
        .meshes
        .sort_unstable_by_key(|item| item.look.index);
    extracted.lights.sort_unstable_by_key(|item| item.index);
    extracted
}

/// Of every entity, by its number, whether it turns or has keys, or an ancestor does.
fn moving(world: &World) -> Vec<bool> {
    let mut moving = Vec::with_capacity(world.len() as usize);
    let mut children = Vec::new();
    type Moves<'a> = Satisfies<hecs::Or<&'a Spin, &'a Keys>>;
    for (entity, moves, parent) in world.query::<(Entity, Moves, Option<&Parent>)>().iter() {
        let own = entity.id() as usize;
        if own >= moving.len() {
            moving.resize(own + 1, false);
        }
        moving[own] = moves;
        children.extend(parent.map(|parent| (own, parent.0.id() as usize)));
    }
    children.sort_unstable_by_key(|&(_, parent)| parent);
    let mut next: Vec<usize> = (0..moving.len()).filter(|i| moving[*i]).collect();
    while let Some(parent) = next.pop() {
        let first = children.partition_point(|&(_, of)| of < parent);
        let own = children[first..]
            .iter()
            .take_while(|&&(_, of)| of == parent);
        for &(child, _) in own {
            if !std::mem::replace(&mut moving[child], true) {
                next.push(child);
            }
        }
    }
    moving
}
