//! The nodes of the default scene.
//!
//! Enters: a typed document. Leave: [`ModelNode`]s in the order of a depth-first walk, with their cameras and lights. The
//! walk keeps a stack of its own and enters no node twice, so that neither cycles nor depth can hurt. Deliberately absent:
//! skins.

use super::animations::motions;
use super::exact::{exact, exact_one};
use super::lights::light;
use super::notes::{Notes, Topic};
use super::source::Source;
use crate::asset::{ModelNode, NodeTransform, codes};
use crate::math::{DAffine3, DMat3, DVec3};
use gltf::camera::Projection;
use gltf::scene::Transform;
use std::collections::BTreeSet;

/// What a scale of zero along one axis counts as, of the largest: flat to the eye, and still with an inverse.
const THINNEST: f64 = 1e-6;

const NO_SCENE: Topic = Topic {
    code: codes::GLTF_NO_SCENE,
    says: "root nodes are shown, since the file has no scene",
    hint: "export the file with a scene",
};

const ORTHOGRAPHIC: Topic = Topic {
    code: codes::GLTF_CAMERA,
    says: "orthographic cameras are left out",
    hint: "add a `camera` to the scene file, far away and with a small `vfov_deg`",
};

const FLAT_CAMERA: Topic = Topic {
    code: codes::GLTF_CAMERA,
    says: "cameras whose field of view is not between 0 and π are left out",
    hint: "`yfov` is in radians",
};

/// The nodes that the default scene shows: those of `scene`, else of the first one, else all that are no child.
///
/// A node that is scaled to nothing hides all below it (section 3.5.3).
pub(super) fn walk(source: &Source, notes: &mut Notes) -> Vec<ModelNode> {
    let mut motions = motions(source, notes);
    let document = &source.document;
    let mut seen = vec![false; document.nodes().len()];
    let mut nodes: Vec<ModelNode> = Vec::new();
    let mut stack: Vec<(usize, Option<usize>)> = Vec::new();
    stack.extend(roots(source, notes).into_iter().rev().map(|i| (i, None)));
    while let Some((index, parent)) = stack.pop() {
        let (Some(node), Some(false)) = (document.nodes().nth(index), seen.get(index)) else {
            continue;
        };
        seen[index] = true;
        let Some(transform) = transform(source, &node) else {
            continue;
        };
        nodes.push(ModelNode {
            name: node.name().map(str::to_owned),
            index: index as u32,
            parent,
            transform,
            mesh: node.mesh().map(|mesh| mesh.index()),
            camera_vfov_deg: camera(source, &node, notes),
            light: light(source, &node),
            motion: motions.remove(&index),
        });
        let here = Some(nodes.len() - 1);
        let children: Vec<usize> = node.children().map(|child| child.index()).collect();
        stack.extend(children.into_iter().rev().map(|child| (child, here)));
    }
    nodes
}

fn roots(source: &Source, notes: &mut Notes) -> Vec<usize> {
    let document = &source.document;
    let scene = document
        .default_scene()
        .or_else(|| document.scenes().next());
    if let Some(scene) = scene {
        return scene.nodes().map(|node| node.index()).collect();
    }
    let children = document.nodes().flat_map(|node| node.children());
    let children: BTreeSet<usize> = children.map(|child| child.index()).collect();
    let all = document.nodes().map(|node| node.index());
    let roots: Vec<usize> = all.filter(|index| !children.contains(index)).collect();
    let first = roots.first().copied().unwrap_or_default();
    notes.add_many(&NO_SCENE, roots.len(), format!("/nodes/{first}"));
    roots
}

/// Where a node is; `None` for one that is scaled to nothing.
fn transform(source: &Source, node: &gltf::Node<'_>) -> Option<NodeTransform> {
    let at = |part: &str| format!("/nodes/{}/{part}", node.index());
    match node.transform() {
        Transform::Matrix { matrix } => {
            let mut typed = [0.0; 16];
            typed.copy_from_slice(matrix.as_flattened());
            let m = exact(&source.json, &at("matrix"), typed);
            let column = |k: usize| DVec3::new(m[4 * k], m[4 * k + 1], m[4 * k + 2]);
            let linear = DMat3::from_cols(column(0), column(1), column(2));
            has_inverse(&linear).then_some(NodeTransform::Matrix(DAffine3 {
                matrix3: linear,
                translation: column(3),
            }))
        }
        Transform::Decomposed {
            translation,
            rotation,
            scale,
        } => {
            let scale = DVec3::from_array(exact(&source.json, &at("scale"), scale));
            let largest = scale.abs().max_element();
            let thick = |s: f64| if s == 0.0 { THINNEST * largest } else { s };
            let rotate = unit_quaternion(exact(&source.json, &at("rotation"), rotation));
            (largest > 0.0).then_some(NodeTransform::Parts {
                translate: exact(&source.json, &at("translation"), translation).into(),
                rotate,
                scale: DVec3::new(thick(scale.x), thick(scale.y), thick(scale.z)),
            })
        }
    }
}

fn has_inverse(linear: &DMat3) -> bool {
    let columns = [linear.x_axis, linear.y_axis, linear.z_axis];
    let lengths = columns.map(|column| column.abs().max_element());
    let scaled = |k: usize| columns[k] / lengths[k];
    lengths.iter().all(|&length| length > 0.0)
        && DMat3::from_cols(scaled(0), scaled(1), scaled(2)).determinant() != 0.0
}

/// Of length 1; the identity for one without a direction.
fn unit_quaternion(q: [f64; 4]) -> [f64; 4] {
    let length = q.iter().fold(0.0, |sum, c| sum + c * c).sqrt();
    if length.is_normal() {
        q.map(|c| c / length)
    } else {
        [0.0, 0.0, 0.0, 1.0]
    }
}

/// The vertical field of view of a node's camera.
fn camera(source: &Source, node: &gltf::Node<'_>, notes: &mut Notes) -> Option<f64> {
    let camera = node.camera()?;
    let place = format!("/cameras/{}", camera.index());
    let Projection::Perspective(perspective) = camera.projection() else {
        notes.add(&ORTHOGRAPHIC, place);
        return None;
    };
    let pointer = format!("{place}/perspective/yfov");
    let yfov = exact_one(&source.json, &pointer, perspective.yfov());
    if !(yfov > 0.0 && yfov < std::f64::consts::PI) {
        notes.add(&FLAT_CAMERA, pointer);
        return None;
    }
    Some(yfov.to_degrees())
}
