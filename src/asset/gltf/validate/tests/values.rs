//! Versions, types, ranges, indices, extensions.

use super::{found, right, silent, tells, with};
use serde_json::{Value, json};

#[test]
fn versions() {
    tells(
        "E121",
        "/asset/version",
        &[("/asset/version", json!("1.0"))],
    );
    tells(
        "E121",
        "/asset/version",
        &[("/asset/version", json!("3.0"))],
    );
    tells(
        "E121",
        "/asset/minVersion",
        &[("/asset/minVersion", json!("2.1"))],
    );
    tells(
        "E124",
        "/asset/version",
        &[("/asset/version", json!("2.0.1-dev"))],
    );
    tells("E124", "/asset", &[("/asset/version", Value::Null)]);
    tells("E124", "", &[("/asset", Value::Null)]);
    tells(
        "W120",
        "/asset/version",
        &[("/asset/version", json!("2.1"))],
    );
    silent(&[("/asset/minVersion", json!("2.0"))]);
    let old = json!({ "meshes": { "a": {} }, "nodes": {} });
    assert_eq!(found(&old)[0].code, "E121");
    assert_eq!(found(&json!([]))[0].code, "E124");
}

#[test]
fn types_and_ranges() {
    tells("E124", "/nodes", &[("/nodes", json!({}))]);
    tells("E124", "/nodes/0", &[("/nodes/0", json!("node"))]);
    tells(
        "E124",
        "/accessors/0/count",
        &[("/accessors/0/count", json!(0))],
    );
    tells(
        "E124",
        "/accessors/0/count",
        &[("/accessors/0/count", json!(-1))],
    );
    tells(
        "E124",
        "/accessors/0/count",
        &[("/accessors/0/count", json!(3.5))],
    );
    tells(
        "E124",
        "/accessors/0",
        &[("/accessors/0/count", Value::Null)],
    );
    tells(
        "E124",
        "/nodes/2/translation",
        &[("/nodes/2/translation", json!([0, 1]))],
    );
    tells(
        "E124",
        "/nodes/2/translation",
        &[("/nodes/2/translation", json!([0, 1e300, 0]))],
    );
    tells("E124", "/buffers/0/uri", &[("/buffers/0/uri", json!(":"))]);
    tells(
        "E124",
        "/buffers/0/uri",
        &[("/buffers/0/uri", json!("data:nothing"))],
    );
    tells(
        "W120",
        "/materials/0/alphaMode",
        &[("/materials/0/alphaMode", json!("mask"))],
    );
    tells(
        "W120",
        "/samplers/0/wrapS",
        &[("/samplers/0/wrapS", json!(1))],
    );
    tells(
        "W120",
        "/materials/0/emissiveFactor/2",
        &[("/materials/0/emissiveFactor/2", json!(2))],
    );
    tells(
        "W120",
        "/materials/0/doubleSided",
        &[("/materials/0/doubleSided", json!(1))],
    );
    tells(
        "W120",
        "/meshes/0/primitives/0/mode",
        &[("/meshes/0/primitives/0/mode", json!(7))],
    );
    tells(
        "W120",
        "/asset/generator",
        &[("/asset/generator", json!(1))],
    );
    // An integer is one however it is written (JSON Schema), and an unused accessor may be of any type.
    silent(&[
        ("/accessors/0/count", json!(3.0)),
        ("/nodes/0/mesh", json!(0.0)),
    ]);
    let odd = json!({ "componentType": 5130, "type": "VEC9", "count": 3 });
    tells(
        "W120",
        "/accessors/12/type",
        &[("/accessors/12", odd.clone())],
    );
    let place = "/meshes/0/primitives/0/attributes/POSITION";
    tells(
        "E127",
        "/accessors/12",
        &[("/accessors/12", odd), (place, json!(12))],
    );
}

#[test]
fn indices_lead_somewhere() {
    tells("E125", "/nodes/0/mesh", &[("/nodes/0/mesh", json!(1))]);
    tells(
        "E125",
        "/nodes/1/children/0",
        &[("/nodes/1/children/0", json!(9))],
    );
    tells("E125", "/scene", &[("/scene", json!(1))]);
    // 2^32 would wrap to 0 in the typed document.
    tells(
        "E125",
        "/nodes/0/mesh",
        &[("/nodes/0/mesh", json!(1_u64 << 32))],
    );
    let place = "/meshes/0/primitives/0/attributes/POSITION";
    tells("E125", place, &[(place, json!(99))]);
    let place = "/materials/0/pbrMetallicRoughness/baseColorTexture/index";
    tells("E125", place, &[(place, json!(1))]);
    tells("E124", "/nodes/0/mesh", &[("/nodes/0/mesh", json!("0"))]);
    // What luxel does not read, or can do without, is no reason to refuse a file.
    tells("W120", "/nodes/0/skin", &[("/nodes/0/skin", json!(1))]);
    tells("W120", "/nodes/3/camera", &[("/nodes/3/camera", json!(1))]);
    let place = "/nodes/4/extensions/KHR_lights_punctual/light";
    tells("W120", place, &[(place, json!(1))]);
    let place = "/meshes/0/primitives/0/attributes/TANGENT";
    tells("W120", place, &[(place, json!(99))]);
}

#[test]
fn empty_repeated_and_misspelt() {
    tells("W124", "/animations", &[("/animations", json!([]))]);
    tells(
        "W124",
        "/nodes/2/children",
        &[("/nodes/2/children", json!([]))],
    );
    let place = "/meshes/0/primitives/0/targets/0";
    tells("W124", place, &[(place, json!({}))]);
    tells(
        "W124",
        "/meshes/0/weights",
        &[("/meshes/0/weights", json!([]))],
    );
    tells(
        "W120",
        "/nodes/1/children/1",
        &[("/nodes/1/children", json!([2, 2]))],
    );
    tells(
        "W120",
        "/skins/0/joints/2",
        &[("/skins/0/joints", json!([1, 2, 1]))],
    );
    tells(
        "W121",
        "/nodes/1/translate",
        &[("/nodes/1/translate", json!([0, 1, 0]))],
    );
    tells(
        "W121",
        "/materials/0/doublesided",
        &[("/materials/0/doublesided", json!(true))],
    );
    silent(&[
        ("/nodes/2/customThing", json!(1)),
        ("/nodes/2/extras", json!(1)),
    ]);
}

#[test]
fn extensions_are_read_ignored_or_refused() {
    let used = |name: &str| ("/extensionsUsed/9", json!(name));
    let required = |name: &str| ("/extensionsRequired", json!([name]));
    for name in [
        "KHR_draco_mesh_compression",
        "KHR_texture_basisu",
        "EXT_any",
    ] {
        tells(
            "E123",
            "/extensionsRequired/0",
            &[used(name), required(name)],
        );
        tells("W122", "/extensionsUsed/2", &[used(name)]);
    }
    silent(&[used("KHR_xmp_json_ld"), required("KHR_xmp_json_ld")]);
    silent(&[
        used("KHR_mesh_quantization"),
        required("KHR_mesh_quantization"),
    ]);
    tells(
        "W123",
        "/extensionsUsed/2",
        &[used("KHR_mesh_quantization")],
    );
    tells(
        "W123",
        "/extensionsRequired/0",
        &[required("KHR_texture_transform")],
    );
    let bare = with(&[
        ("/extensionsUsed", Value::Null),
        required("KHR_materials_ior"),
    ]);
    let places: Vec<_> = found(&bare)
        .into_iter()
        .map(|one| (one.code, one.pointer.unwrap_or_default()))
        .collect();
    assert!(
        places.contains(&("W123", "/extensionsRequired".into())),
        "{places:?}"
    );
    let place = "/materials/0/extensions/KHR_materials_unlit";
    tells("W123", place, &[(place, json!({}))]);
    let place = "/nodes/0/extensions";
    tells(
        "W123",
        "/nodes/0/extensions/KHR_materials_ior",
        &[(place, json!({ "KHR_materials_ior": {} }))],
    );
    tells("W120", place, &[(place, json!([]))]);
    tells(
        "W120",
        "/nodes/0/extensions/EXT_x",
        &[used("EXT_x"), (place, json!({ "EXT_x": 1 }))],
    );
}

#[test]
fn the_typed_document_has_what_is_read() {
    let changes = [
        ("/meshes/0/primitives/0/mode", json!(99)),
        ("/cameras/0/type", json!("fisheye")),
        (
            "/extensions/KHR_lights_punctual/lights/0/type",
            json!("neon"),
        ),
        ("/nodes/0/name", json!(1)),
    ];
    for json in [right(), with(&changes)] {
        let root: gltf::json::Root =
            gltf::json::deserialize::from_value(super::super::strip(&json)).expect("a document");
        let document = gltf::Document::from_json(root).expect("a valid document");
        let is_right = json == right();
        let nodes: Vec<_> = document.nodes().collect();
        assert_eq!(nodes[0].name().is_some(), is_right);
        assert_eq!(nodes[3].camera().is_some(), is_right);
        let light = nodes[4].light().expect("a light");
        assert_eq!(light.intensity(), if is_right { 1.0 } else { 0.0 });
        let primitive = document
            .meshes()
            .next()
            .and_then(|mesh| mesh.primitives().next());
        let primitive = primitive.expect("a primitive");
        assert_eq!(primitive.mode() == gltf::mesh::Mode::Triangles, is_right);
        assert_eq!(primitive.attributes().count(), 4);
        assert_eq!(document.animations().count() + document.skins().count(), 0);
    }
}

#[test]
fn an_empty_parameter_of_a_data_uri() {
    let uri = right()["buffers"][0]["uri"].to_string();
    let uri = uri.trim_matches('"');
    let odd = uri.replace(";base64", ";;base64");
    tells("W120", "/buffers/0/uri", &[("/buffers/0/uri", json!(odd))]);
    let named = uri.replace(";base64", ";a=b;base64");
    silent(&[("/buffers/0/uri", json!(named))]);
}
