//! The nodes of a glTF file become entities under the one that names the file.

use super::components::{
    AuthoringIndex, Camera, Emissive, Material, Name, Normals, Parent, Shape, Transform,
};
use crate::asset::{MeshId, Model, ModelNode, NodeTransform};
use crate::math::{DVec3, quaternion};
use crate::scene::CameraDesc;
use hecs::{Entity, EntityBuilder, World};

/// What the entity that names a file says of all its nodes.
pub(super) struct Root {
    pub(super) entity: Entity,
    /// Of the entity in the scene file.
    pub(super) index: u32,
    /// Whether the file's lights shine.
    pub(super) lights: bool,
    pub(super) material: Option<Material>,
    pub(super) normals: Normals,
    pub(super) emissive: Option<Emissive>,
}

/// Spawns every node of `model`. Gives the entities in the order of its nodes.
pub(super) fn expand(world: &mut World, model: &Model, root: &Root) -> Vec<Entity> {
    let mut entities: Vec<Entity> = Vec::with_capacity(model.nodes.len());
    for (i, node) in model.nodes.iter().enumerate() {
        let mesh = node.mesh.and_then(|m| *model.meshes.get(m)?);
        let mut components = components(node, mesh, root);
        components.add(AuthoringIndex {
            entity: root.index,
            node: i as u32 + 1,
        });
        // Parents come before their children.
        let parent = node.parent.and_then(|p| entities.get(p).copied());
        components.add(Parent(parent.unwrap_or(root.entity)));
        entities.push(world.spawn(components.build()));
    }
    entities
}

/// The components that need no other entity. The camera waits until it is known which one is meant.
fn components(node: &ModelNode, mesh: Option<MeshId>, root: &Root) -> EntityBuilder {
    let mut builder = EntityBuilder::new();
    builder.add(transform(&node.transform));
    if let Some(name) = &node.name {
        builder.add(Name(name.clone()));
    }
    if let Some(light) = node.light.filter(|_| root.lights) {
        builder.add(light);
    }
    let Some(mesh) = mesh else {
        return builder;
    };
    builder.add(Shape::Mesh {
        mesh,
        normals: root.normals,
    });
    if let Some(material) = root.material {
        builder.add(material);
    }
    if let Some(emissive) = root.emissive {
        builder.add(emissive);
    }
    builder
}

fn transform(node: &NodeTransform) -> Transform {
    match *node {
        NodeTransform::Parts {
            translate,
            rotate,
            scale,
        } => Transform {
            translate,
            rotate: quaternion(rotate),
            scale,
        },
        NodeTransform::Matrix(map) => Transform {
            translate: map.translation,
            rotate: map.matrix3,
            scale: DVec3::ONE,
        },
    }
}

/// The camera of a node: a pinhole, since glTF knows no lens.
pub(super) fn camera(vfov_deg: f64) -> Camera {
    Camera {
        vfov_deg,
        aperture_radius: CameraDesc::APERTURE_RADIUS,
        focus_distance: CameraDesc::FOCUS_DISTANCE,
    }
}
