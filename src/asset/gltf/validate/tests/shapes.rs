//! Meshes, nodes and scenes.

use super::{data, floats, silent, tells};
use serde_json::{Value, json};

const PRIMITIVE: &str = "/meshes/0/primitives/0";

fn attribute(name: &str) -> String {
    format!("{PRIMITIVE}/attributes/{name}")
}

/// An accessor of its own bytes, number 12.
fn own(bytes: &[u8], component: usize, kind: &str, count: usize) -> [(&'static str, Value); 3] {
    [
        (
            "/buffers/1",
            json!({ "byteLength": bytes.len(), "uri": data(bytes) }),
        ),
        (
            "/bufferViews/14",
            json!({ "buffer": 1, "byteLength": bytes.len() }),
        ),
        (
            "/accessors/12",
            json!({ "bufferView": 14, "componentType": component, "type": kind, "count": count }),
        ),
    ]
}

/// The accessor of own bytes in place of an attribute.
fn replaced(code: &str, name: &str, own: &[(&str, Value)]) {
    let place = attribute(name);
    tells(
        code,
        &place,
        &[own, &[(place.as_str(), json!(12))]].concat(),
    );
}

#[test]
fn names_of_attributes() {
    tells(
        "W130",
        &attribute("UNKNOWN"),
        &[(&attribute("UNKNOWN"), json!(1))],
    );
    tells(
        "W130",
        &attribute("TEXCOORD_01"),
        &[(&attribute("TEXCOORD_01"), json!(2))],
    );
    tells(
        "W130",
        &format!("{PRIMITIVE}/attributes"),
        &[(&attribute("TEXCOORD_2"), json!(2))],
    );
    tells(
        "W132",
        &format!("{PRIMITIVE}/attributes"),
        &[(&attribute("WEIGHTS_0"), Value::Null)],
    );
    let place = format!("{PRIMITIVE}/targets/0/JOINTS_0");
    tells("W132", &place, &[(&place, json!(4))]);
    let place = format!("{PRIMITIVE}/targets/0/TEXCOORD_1");
    tells("W132", &place, &[(&place, json!(2))]);
}

#[test]
fn formats_of_attributes() {
    replaced(
        "E129",
        "POSITION",
        &own(&floats(&[0.0; 6]), 5126, "VEC2", 3),
    );
    replaced("E129", "COLOR_0", &own(&floats(&[0.0; 6]), 5126, "VEC2", 3));
    replaced("W130", "TANGENT", &own(&floats(&[1.0; 9]), 5126, "VEC3", 3));
    replaced("W130", "_OWN", &own(&[0; 12], 5125, "SCALAR", 3));
    replaced("W130", "TEXCOORD_0", &own(&[0; 12], 5122, "VEC2", 3));
    replaced("E129", "NORMAL", &own(&floats(&[0.0; 6]), 5126, "VEC3", 2));
    replaced("W130", "_OWN", &own(&floats(&[0.0; 2]), 5126, "SCALAR", 2));
    // 3 × 1 bytes every 3 bytes are not aligned.
    let quantized = [
        ("/extensionsUsed/2", json!("KHR_mesh_quantization")),
        ("/extensionsRequired", json!(["KHR_mesh_quantization"])),
    ];
    let packed = own(&[0, 0, 127, 0, 0, 127, 0, 0, 127], 5120, "VEC3", 3);
    let normalized = ("/accessors/12/normalized", json!(true));
    let packed = [
        &quantized[..],
        &packed[..],
        std::slice::from_ref(&normalized),
    ]
    .concat();
    replaced("W127", "NORMAL", &packed);
    let mut aligned = [
        &quantized[..],
        &own(&[0, 0, 127, 0].repeat(3), 5120, "VEC3", 3)[..],
        &[normalized],
    ]
    .concat();
    aligned.push(("/bufferViews/14/byteStride", json!(4)));
    let place = attribute("NORMAL");
    aligned.push((place.as_str(), json!(12)));
    silent(&aligned);
    // Without the extension they can be read, but should not be.
    replaced("W130", "NORMAL", &aligned[2..6]);
}

#[test]
fn indices() {
    let place = format!("{PRIMITIVE}/indices");
    let indices = |own: &[(&'static str, Value)]| {
        [own, &[("/meshes/0/primitives/0/indices", json!(12))]].concat()
    };
    tells(
        "E129",
        &place,
        &indices(&own(&floats(&[0.0, 1.0, 2.0]), 5126, "SCALAR", 3)),
    );
    tells(
        "E129",
        &place,
        &indices(&own(&[0, 1, 3], 5121, "SCALAR", 3)),
    );
    tells(
        "E129",
        &place,
        &indices(&own(&[0, 1, 255], 5121, "SCALAR", 3)),
    );
    tells(
        "E129",
        &place,
        &indices(&own(&[0, 0, 1, 0, 0xFF, 0xFF], 5123, "SCALAR", 3)),
    );
    silent(&indices(&own(&[0, 1, 2], 5121, "SCALAR", 3)));
    tells(
        "W130",
        PRIMITIVE,
        &indices(&own(&[0, 1, 2, 0], 5121, "SCALAR", 4)),
    );
    let strip = ("/meshes/0/primitives/0/mode", json!(5));
    silent(
        &[
            &indices(&own(&[0, 1, 2, 0], 5121, "SCALAR", 4))[..],
            std::slice::from_ref(&strip),
        ]
        .concat(),
    );
    tells(
        "W130",
        PRIMITIVE,
        &[&indices(&own(&[0, 1], 5121, "SCALAR", 2))[..], &[strip]].concat(),
    );
    // Of a mesh that the scene does not show they are only odd.
    let hidden = [("/scenes/0/nodes", json!([1, 3, 4]))];
    tells(
        "W129",
        &place,
        &[&indices(&own(&[0, 1, 3], 5121, "SCALAR", 3))[..], &hidden].concat(),
    );
}

#[test]
fn elements_of_attributes() {
    replaced_element("W129", "NORMAL", &floats(&[0., 0., 2.].repeat(3)), "VEC3");
    replaced_element(
        "W129",
        "TANGENT",
        &floats(&[1., 0., 0., 0.5].repeat(3)),
        "VEC4",
    );
    replaced_element(
        "W129",
        "COLOR_0",
        &floats(&[1.5, 0., -0.5].repeat(3)),
        "VEC3",
    );
    replaced_element(
        "W132",
        "WEIGHTS_0",
        &floats(&[0.5, 0.4, 0., 0.].repeat(3)),
        "VEC4",
    );
    replaced_element(
        "W132",
        "WEIGHTS_0",
        &floats(&[1.5, -0.5, 0., 0.].repeat(3)),
        "VEC4",
    );
    replaced(
        "W132",
        "JOINTS_0",
        &own(&[0, 2, 0, 0].repeat(3), 5121, "VEC4", 3),
    );
    replaced(
        "W132",
        "JOINTS_0",
        &own(&[1, 1, 0, 0].repeat(3), 5121, "VEC4", 3),
    );
    let nan = own(&floats(&[f32::NAN; 9]), 5126, "VEC3", 3);
    let place = attribute("NORMAL");
    tells(
        "W129",
        "/accessors/12",
        &[&nan[..], &[(place.as_str(), json!(12))]].concat(),
    );
    let place = attribute("POSITION");
    tells(
        "E129",
        "/accessors/12",
        &[&nan[..], &[(place.as_str(), json!(12))]].concat(),
    );
}

fn replaced_element(code: &str, name: &str, bytes: &[u8], kind: &str) {
    replaced(code, name, &own(bytes, 5126, kind, 3));
}

#[test]
fn morph_targets() {
    tells(
        "W132",
        "/meshes/0/weights",
        &[("/meshes/0/weights", json!([0.5, 0.5]))],
    );
    tells(
        "W132",
        "/nodes/0/weights",
        &[("/nodes/0/weights", json!([0.5, 0.5]))],
    );
    tells(
        "W132",
        "/nodes/2/weights",
        &[("/nodes/2/weights", json!([0.5]))],
    );
    let second = json!({ "attributes": { "POSITION": 0 } });
    tells(
        "W132",
        "/meshes/0/primitives/1",
        &[("/meshes/0/primitives/1", second)],
    );
    let place = format!("{PRIMITIVE}/targets/0/POSITION");
    tells("W132", &place, &[(&place, json!(2))]);
    tells("W128", &place, &[(&place, json!(1))]);
    let place = format!("{PRIMITIVE}/targets/0/NORMAL");
    let short = own(&floats(&[0.0; 6]), 5126, "VEC3", 2);
    tells(
        "W132",
        &place,
        &[&short[..], &[(place.as_str(), json!(12))]].concat(),
    );
}

#[test]
fn texture_coordinates_of_what_is_not_shown() {
    let place = format!("{PRIMITIVE}/material");
    let normal = (
        "/materials/0/normalTexture",
        json!({ "index": 0, "texCoord": 1 }),
    );
    tells("W130", &place, &[normal]);
    silent(&[("/materials/0/normalTexture", json!({ "index": 0 }))]);
    let color = (
        "/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord",
        json!(1),
    );
    tells(
        "W130",
        &place,
        &[color, ("/scenes/0/nodes", json!([1, 3, 4]))],
    );
}

#[test]
fn transforms() {
    tells(
        "E128",
        "/nodes/3/matrix",
        &[("/nodes/3/scale", json!([1, 1, 1]))],
    );
    tells(
        "E128",
        "/nodes/1/rotation",
        &[("/nodes/1/rotation", json!([0, 0, 0, 0]))],
    );
    tells(
        "W131",
        "/nodes/1/rotation",
        &[("/nodes/1/rotation", json!([0, 0, 1, 1]))],
    );
    tells(
        "W131",
        "/nodes/3/matrix",
        &[("/nodes/3/matrix/4", json!(1))],
    );
    tells(
        "W131",
        "/nodes/3/matrix",
        &[("/nodes/3/matrix/0", json!(0))],
    );
    tells(
        "W131",
        "/nodes/3/matrix",
        &[("/nodes/3/matrix/3", json!(1))],
    );
    silent(&[
        ("/nodes/3/matrix/0", json!(-2)),
        ("/nodes/3/matrix/12", json!(5)),
    ]);
}

#[test]
fn nodes_are_a_forest() {
    tells(
        "E128",
        "/nodes/2/children/0",
        &[("/nodes/2/children", json!([2]))],
    );
    tells("E128", "/nodes/3", &[("/nodes/3/children", json!([3]))]);
    tells("E128", "/nodes/1", &[("/nodes/2/children", json!([1]))]);
    tells(
        "E128",
        "/nodes/3/children/0",
        &[("/nodes/3/children", json!([2]))],
    );
    tells(
        "E128",
        "/scenes/0/nodes/4",
        &[("/scenes/0/nodes/4", json!(2))],
    );
    let circle = |a: usize, b: usize| {
        [
            ("/nodes/5", json!({ "children": [b] })),
            ("/nodes/6", json!({ "children": [a] })),
        ]
    };
    tells("W131", "/nodes/5", &circle(5, 6));
    let elsewhere = json!([{ "nodes": [0, 1, 3, 4] }, { "nodes": [6] }]);
    tells(
        "W131",
        "/scenes/1/nodes/0",
        &[
            ("/nodes/5", json!({ "children": [6] })),
            ("/nodes/6", json!({})),
            ("/scenes", elsewhere),
        ],
    );
}
