//! The nodes of a glTF file become entities under the one that names the file.

use super::components::{
    AuthoringIndex, Camera, Ease, Emissive, Keys, Material, Name, Normals, Parent, Pose, Shape,
    Track, Transform, Turn,
};
use crate::asset::{Curve, Interpolation, MeshId, Model, ModelNode, Motion, NodeTransform};
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
    builder.add(Pose::IDENTITY);
    builder.add(transform(&node.transform));
    if let Some(motion) = &node.motion {
        builder.add(keys(motion));
    }
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

fn keys(motion: &Motion) -> Keys {
    let vector = |[x, y, z, _]: [f64; 4]| DVec3::new(x, y, z);
    Keys {
        translate: track(motion.translate.as_ref(), vector),
        rotate: track(motion.rotate.as_ref(), Turn::of_quaternion),
        scale: track(motion.scale.as_ref(), vector),
    }
}

fn track<T>(curve: Option<&Curve>, value: impl Fn([f64; 4]) -> T) -> Track<T> {
    let curve = curve.cloned().unwrap_or_default();
    Track {
        times: curve.times,
        values: curve.values.into_iter().map(value).collect(),
        tangents: curve.tangents,
        ease: match curve.interpolation {
            Interpolation::Linear => Ease::Linear,
            Interpolation::Step => Ease::Step,
            Interpolation::Spline => Ease::Spline,
        },
    }
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
