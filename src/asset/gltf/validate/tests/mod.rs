//! Every rule of the validator: a file that breaks it is told so at the place, and one that does not is not.

use crate::asset::Loader;
use crate::asset::gltf::source::Source;
use crate::diag::{Diagnostic, Severity};
use serde_json::{Value, json};
use std::path::Path;

mod layout;
mod looks;
mod motion;
mod shapes;
mod values;

/// Little-endian bytes in base64, as a data URI.
fn data(bytes: &[u8]) -> String {
    const DIGITS: &[u8] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::from("data:application/octet-stream;base64,");
    for three in bytes.chunks(3) {
        let word =
            three.iter().fold(0, |word, &b| word << 8 | usize::from(b)) << (8 * (3 - three.len()));
        for k in 0..4 {
            let digit = DIGITS[word >> (18 - 6 * k) & 63];
            text.push(if k <= three.len() {
                char::from(digit)
            } else {
                '='
            });
        }
    }
    text
}

fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

/// A PNG of one white pixel, which the crate `image` wrote.
fn png() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let white = image::RgbImage::from_pixel(1, 1, image::Rgb([255; 3]));
    white
        .write_to(&mut bytes, image::ImageFormat::Png)
        .expect("a PNG");
    bytes.into_inner()
}

const IDENTITY: [f32; 16] = [
    1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.,
];

/// A file with one of everything, and nothing wrong: a textured, skinned, morphing, animated triangle beside a camera
/// and a light.
fn right() -> Value {
    let mut bytes = Vec::new();
    let mut views = Vec::new();
    let mut part = |more: Vec<u8>| {
        views.push(json!({ "buffer": 0, "byteOffset": bytes.len(), "byteLength": more.len() }));
        bytes.extend(more);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    };
    part(floats(&[0., 0., 0., 1., 0., 0., 0., 1., 0.])); // 0: positions
    part(floats(&[0., 0., 1.].repeat(3))); // 1: normals
    part(floats(&[0., 0., 1., 0., 0., 1.])); // 2: coordinates
    part(floats(&[1., 0.5, 0.].repeat(3))); // 3: colours
    part([0, 1, 0, 0].repeat(3)); // 4: joints
    part(floats(&[0.5, 0.5, 0., 0.].repeat(3))); // 5: weights
    part(vec![0, 0, 1, 0, 2, 0]); // 6: indices
    part(floats(&[IDENTITY, IDENTITY].concat())); // 7: bind matrices
    part(floats(&[0., 1., 2.])); // 8: key times
    part(floats(&[0., 0., 0., 1.].repeat(3))); // 9: rotations
    part(vec![1, 0]); // 10: sparse places
    part(floats(&[2., 2., 2.])); // 11: sparse values
    part(png()); // 12: image
    part(floats(&[1., 0., 0., 1.].repeat(3))); // 13: tangents
    let accessor = |view: usize, component: usize, kind: &str, count: usize| json!({ "bufferView": view, "componentType": component, "type": kind, "count": count });
    let mut accessors = vec![
        accessor(0, 5126, "VEC3", 3),
        accessor(1, 5126, "VEC3", 3),
        accessor(2, 5126, "VEC2", 3),
        accessor(3, 5126, "VEC3", 3),
        accessor(4, 5121, "VEC4", 3),
        accessor(5, 5126, "VEC4", 3),
        accessor(6, 5123, "SCALAR", 3),
        accessor(7, 5126, "MAT4", 2),
        accessor(8, 5126, "SCALAR", 3),
        accessor(9, 5126, "VEC4", 3),
        accessor(13, 5126, "VEC4", 3),
        // 11: morphed positions, all zeros but the second.
        json!({
            "componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [2, 2, 2],
            "sparse": { "count": 1, "indices": { "bufferView": 10, "componentType": 5123 },
                "values": { "bufferView": 11 } },
        }),
    ];
    accessors[0]["min"] = json!([0, 0, 0]);
    accessors[0]["max"] = json!([1, 1, 0]);
    accessors[8]["min"] = json!([0]);
    accessors[8]["max"] = json!([2]);
    json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_ior"],
        "extensions": { "KHR_lights_punctual": { "lights": [{ "type": "spot", "spot": { "outerConeAngle": 0.5 } }] } },
        "buffers": [{ "byteLength": bytes.len(), "uri": data(&bytes) }],
        "bufferViews": views,
        "accessors": accessors,
        "images": [{ "bufferView": 12, "mimeType": "image/png" }],
        "samplers": [{ "wrapS": 33071, "magFilter": 9728 }],
        "textures": [{ "source": 0, "sampler": 0 }],
        "materials": [{
            "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 }, "baseColorFactor": [1, 1, 1, 1] },
            "alphaMode": "MASK", "alphaCutoff": 0.5, "emissiveFactor": [0, 0, 1],
            "extensions": { "KHR_materials_ior": { "ior": 1.5 } },
        }],
        "meshes": [{
            "primitives": [{
                "attributes": { "POSITION": 0, "NORMAL": 1, "TANGENT": 10, "TEXCOORD_0": 2, "COLOR_0": 3, "JOINTS_0": 4,
                    "WEIGHTS_0": 5, "_OWN": 1 },
                "indices": 6, "material": 0, "mode": 4, "targets": [{ "POSITION": 11 }],
            }],
            "weights": [0.5],
        }],
        "nodes": [
            { "mesh": 0, "skin": 0, "name": "triangle" },
            { "children": [2], "rotation": [0, 0, 0, 1] },
            { "translation": [0, 1, 0] },
            { "camera": 0, "matrix": IDENTITY },
            { "extensions": { "KHR_lights_punctual": { "light": 0 } } },
        ],
        "skins": [{ "joints": [1, 2], "skeleton": 1, "inverseBindMatrices": 7 }],
        "animations": [{
            "samplers": [{ "input": 8, "output": 9 }],
            "channels": [{ "sampler": 0, "target": { "node": 1, "path": "rotation" } }],
        }],
        "cameras": [{ "type": "perspective", "perspective": { "yfov": 1, "znear": 0.1, "zfar": 10 } }],
        "scenes": [{ "nodes": [0, 1, 3, 4] }],
        "scene": 0,
    })
}

/// Everything that the validator says of a file.
fn found(json: &Value) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    let bytes = json.to_string().into_bytes();
    let source = Source::of_bytes(
        &mut Loader::new(),
        Path::new("x.gltf"),
        bytes,
        &mut warnings,
    );
    warnings.extend(source.err().unwrap_or_default());
    warnings
}

/// The file with values put at pointers; null takes what is there away.
fn with(changes: &[(&str, Value)]) -> Value {
    let mut json = right();
    for (pointer, value) in changes {
        let (above, name) = pointer.rsplit_once('/').expect("a pointer");
        let parent = json
            .pointer_mut(above)
            .unwrap_or_else(|| panic!("no {above}"));
        match (parent, name.parse::<usize>()) {
            (Value::Array(all), Ok(at)) if at < all.len() => all[at] = value.clone(),
            (Value::Array(all), _) => all.push(value.clone()),
            (Value::Object(map), _) if value.is_null() => drop(map.remove(name)),
            (parent, _) => parent[name] = value.clone(),
        }
    }
    json
}

#[test]
fn a_right_file_is_silent() {
    assert_eq!(found(&right()), []);
}

/// Asserts that changes bring a finding with this code at this place.
fn tells(code: &str, place: &str, changes: &[(&str, Value)]) {
    let found = found(&with(changes));
    let told = found
        .iter()
        .any(|one| one.code == code && one.pointer.as_deref() == Some(place));
    assert!(told, "{code} at {place} for {changes:?}: {found:#?}");
    let is_error = code.starts_with('E');
    let severe = found.iter().any(|one| one.severity == Severity::Error);
    assert_eq!(severe, is_error, "{code} for {changes:?}: {found:#?}");
}

/// Asserts that changes bring no finding at all.
fn silent(changes: &[(&str, Value)]) {
    assert_eq!(found(&with(changes)), [], "{changes:?}");
}
