//! Nodes, cameras and lights.

use super::Draft;
use crate::asset::{Light, NodeTransform};
use crate::math::{DAffine3, DMat3, DVec3};
use serde_json::json;

#[test]
fn nodes_come_in_the_order_of_the_tree_with_their_transforms() {
    let mut draft = Draft::triangle();
    draft.root["nodes"] = json!([
        { "name": "leaf", "mesh": 0, "scale": [-2, 1, 0.1] },
        { "name": "root", "children": [3, 0] },
        { "name": "alone", "mesh": 0, "rotation": [0, 0, 0.6, 0.8], "translation": [0.1, 0, 0] },
        { "name": "first", "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1] },
    ]);
    draft.root["scenes"] = json!([{ "nodes": [1, 2] }]);
    let read = draft.clean();
    let nodes = &read.model.nodes;
    let order: Vec<_> = nodes
        .iter()
        .map(|n| (n.name.as_deref(), n.index, n.parent))
        .collect();
    assert_eq!(
        order,
        [
            (Some("root"), 1, None),
            (Some("first"), 3, Some(0)),
            (Some("leaf"), 0, Some(0)),
            (Some("alone"), 2, None),
        ]
    );
    let parts = |translate: [f64; 3], rotate, scale: [f64; 3]| NodeTransform::Parts {
        translate: translate.into(),
        rotate,
        scale: scale.into(),
    };
    let still = [0.0, 0.0, 0.0, 1.0];
    // As written, not rounded to 32 bits.
    assert_eq!(nodes[2].transform, parts([0.0; 3], still, [-2.0, 1.0, 0.1]));
    let turned = [0.0, 0.0, 0.6, 0.8];
    assert_eq!(nodes[3].transform, parts([0.1, 0.0, 0.0], turned, [1.0; 3]));
    let quarter = DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z);
    let matrix = DAffine3 {
        matrix3: quarter,
        translation: DVec3::new(5.0, 6.0, 7.0),
    };
    assert_eq!(nodes[1].transform, NodeTransform::Matrix(matrix));
    assert_eq!((nodes[2].mesh, nodes[3].mesh), (Some(0), Some(0)));
}

#[test]
fn a_scale_of_zero_hides_all_below_and_along_one_axis_it_flattens() {
    let mut draft = Draft::triangle();
    draft.root["nodes"] = json!([
        { "name": "hidden", "scale": [0, 0, 0], "children": [1] },
        { "mesh": 0 },
        { "name": "flat", "mesh": 0, "scale": [1, 1, 0] },
    ]);
    draft.root["scenes"] = json!([{ "nodes": [0, 2] }]);
    let read = draft.clean();
    let [flat] = &read.model.nodes[..] else {
        panic!("{:?}", read.model.nodes);
    };
    let NodeTransform::Parts { scale, .. } = flat.transform else {
        panic!("in parts");
    };
    assert_eq!(scale, DVec3::new(1.0, 1.0, 1e-6));
}

#[test]
fn without_a_scene_the_first_or_every_root_is_shown() {
    let mut draft = Draft::triangle();
    draft.root["nodes"] = json!([
        { "name": "a", "mesh": 0 },
        { "name": "b", "mesh": 0, "children": [0] },
        { "name": "c", "mesh": 0 },
    ]);
    draft.root["scenes"] = json!([{ "nodes": [2] }, { "nodes": [1] }]);
    let root = draft.root.as_object_mut().expect("an object");
    root.remove("scene");
    assert_eq!(draft.clean().model.nodes.len(), 1);
    let root = draft.root.as_object_mut().expect("an object");
    root.remove("scenes");
    let read = draft.read().expect("a model");
    assert_eq!(read.codes(), ["W136"]);
    let names: Vec<_> = read.model.nodes.iter().map(|n| n.name.as_deref()).collect();
    assert_eq!(names, [Some("b"), Some("a"), Some("c")]);
}

#[test]
fn a_long_chain_of_nodes_does_not_recurse() {
    let mut draft = Draft::triangle();
    let count = 30_000;
    let link = |i: usize| match i + 1 < count {
        true => json!({ "children": [i + 1] }),
        false => json!({ "mesh": 0 }),
    };
    draft.root["nodes"] = (0..count).map(link).collect();
    let read = draft.clean();
    assert_eq!(read.model.nodes.len(), count);
    assert_eq!(read.model.nodes[count - 1].parent, Some(count - 2));
}

#[test]
fn cameras_are_read_and_orthographic_ones_left_out() {
    let mut draft = Draft::new();
    draft
        .root
        .as_object_mut()
        .expect("an object")
        .remove("meshes");
    draft.root["nodes"] = json!([{ "camera": 0 }, { "camera": 1 }]);
    draft.root["scenes"] = json!([{ "nodes": [0, 1] }]);
    draft.root["cameras"] = json!([
        { "type": "perspective", "perspective": { "yfov": std::f64::consts::FRAC_PI_4, "znear": 0.1 } },
        { "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 1, "znear": 0, "zfar": 9 } },
    ]);
    let read = draft.read().expect("a model");
    let fields: Vec<_> = read.model.nodes.iter().map(|n| n.camera_vfov_deg).collect();
    assert_eq!(fields, [Some(45.0), None]);
    assert_eq!(read.codes(), ["W139"]);
}

#[test]
fn lights_are_colour_times_intensity_in_degrees() {
    let mut draft = Draft::triangle();
    let of = |light: usize| json!({ "extensions": { "KHR_lights_punctual": { "light": light } } });
    draft.root["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    draft.root["nodes"] = (0..4).map(of).collect();
    draft.root["scenes"] = json!([{ "nodes": [0, 1, 2, 3] }]);
    draft.root["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
        { "type": "point", "color": [1, 0.5, 0], "intensity": 0.3, "range": 5 },
        { "type": "directional", "intensity": 2 },
        { "type": "spot", "spot": { "innerConeAngle": 0.5, "outerConeAngle": std::f64::consts::FRAC_PI_2 } },
        { "type": "spot", "spot": {} },
    ] } });
    let read = draft.clean();
    let lights: Vec<_> = read
        .model
        .nodes
        .iter()
        .map(|n| n.light.expect("a light"))
        .collect();
    let spot = |inner_deg, outer_deg| Light::Spot {
        intensity: [1.0; 3],
        inner_deg,
        outer_deg,
    };
    assert_eq!(
        lights,
        [
            Light::Point {
                intensity: [0.3, 0.15, 0.0]
            },
            Light::Sun {
                irradiance: [2.0; 3]
            },
            spot(0.5f64.to_degrees(), 90.0),
            spot(0.0, f64::from(std::f32::consts::FRAC_PI_4).to_degrees()),
        ]
    );
}

#[test]
fn what_does_not_move_is_said_once() {
    let mut draft = Draft::triangle();
    let target = draft.floats(&[[0.0; 3]; 3]);
    draft.root["accessors"][target]["min"] = json!([0, 0, 0]);
    draft.root["accessors"][target]["max"] = json!([0, 0, 0]);
    draft.primitive()["targets"] = json!([{ "POSITION": target }]);
    draft.root["skins"] = json!([{ "joints": [0] }]);
    let read = draft.read().expect("a model");
    let rest: Vec<_> = read.warnings.iter().filter(|w| w.code == "W138").collect();
    assert_eq!(rest.len(), 1, "{:?}", read.warnings);
    assert!(
        rest[0].message.ends_with("skins (1), morph targets (1)"),
        "{}",
        rest[0].message
    );
}
