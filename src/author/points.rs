//! The points that a mesh or a glTF file shows.

use crate::asset::{Loader, Mesh, Model, NodeTransform};
use crate::math::{DAffine3, DMat3, DVec3, quaternion};

/// Every position that a triangle uses, once.
#[must_use]
pub fn of_mesh(mesh: &Mesh) -> Vec<DVec3> {
    let mut points = Vec::new();
    add(mesh, &DAffine3::IDENTITY, &mut points);
    points
}

/// Those of all meshes of a file, where its nodes put them. `loader` has read it.
#[must_use]
pub fn of_model(model: &Model, loader: &Loader) -> Vec<DVec3> {
    let mut points = Vec::new();
    let mut frames: Vec<DAffine3> = Vec::with_capacity(model.nodes.len());
    for node in &model.nodes {
        // Parents come before their children.
        let parent = node.parent.and_then(|p| frames.get(p).copied());
        let frame = parent.unwrap_or_default() * affine(&node.transform);
        frames.push(frame);
        if let Some(mesh) = node.mesh.and_then(|m| *model.meshes.get(m)?) {
            add(loader.loaded(mesh), &frame, &mut points);
        }
    }
    points
}

fn add(mesh: &Mesh, to: &DAffine3, points: &mut Vec<DVec3>) {
    let mut used = vec![false; mesh.positions.len()];
    for &corner in &mesh.corners {
        if let Some(used) = used.get_mut(corner as usize) {
            *used = true;
        }
    }
    let used = mesh.positions.iter().zip(used).filter(|(_, used)| *used);
    points.extend(used.map(|(p, _)| to.transform_point3(*p)));
}

fn affine(transform: &NodeTransform) -> DAffine3 {
    match *transform {
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
