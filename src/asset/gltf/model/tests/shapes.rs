//! Accessors and primitives to triangles.

use super::{Draft, Read};
use crate::asset::Mesh;
use crate::math::{DVec2, DVec3};
use serde_json::json;

/// The corners of every triangle as points.
fn triangles(mesh: &Mesh) -> Vec<[[f64; 3]; 3]> {
    let corners = mesh.corners.as_chunks::<3>().0.iter();
    corners
        .map(|corners| corners.map(|i| mesh.positions[i as usize].to_array()))
        .collect()
}

const QUAD: [[f32; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [1.0, 1.0, 0.0],
];

#[test]
fn indices_of_every_size_and_none_give_the_same_triangle() {
    let plain = Draft::triangle().clean();
    let expected = [[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]];
    assert_eq!(triangles(plain.mesh()), expected);
    for (component, size) in [(5121, 1), (5123, 2), (5125, 4)] {
        let mut draft = Draft::new();
        // The last vertex is used by nothing, and not kept.
        draft.positions(&[[0.0, 1.0, 0.0], [0.0; 3], [1.0, 0.0, 0.0], [9.0; 3]]);
        let index = |i: u32| i.to_le_bytes()[..size].to_vec();
        let bytes: Vec<u8> = [1, 2, 0].into_iter().flat_map(index).collect();
        let accessor = draft.accessor("SCALAR", component, 3, &bytes);
        draft.primitive()["indices"] = accessor.into();
        let read = draft.clean();
        assert_eq!(triangles(read.mesh()), expected);
        assert_eq!(read.mesh().positions.len(), 3);
        assert_eq!(read.mesh().material, [Some(0)]);
    }
}

#[test]
fn strips_and_fans_face_the_same_way_as_lists() {
    let area = |order: &[u16], mode: u32| {
        let mut draft = Draft::new();
        draft.positions(&QUAD);
        draft.indices(order);
        draft.primitive()["mode"] = mode.into();
        let read = draft.clean();
        let cross = |[a, b, c]: [[f64; 3]; 3]| {
            let [a, b, c] = [a, b, c].map(DVec3::from_array);
            (b - a).cross(c - a).z
        };
        triangles(read.mesh())
            .into_iter()
            .map(cross)
            .collect::<Vec<f64>>()
    };
    assert_eq!(area(&[0, 1, 2, 2, 1, 3], 4), [1.0, 1.0]);
    assert_eq!(area(&[0, 1, 2, 3], 5), [1.0, 1.0]);
    assert_eq!(area(&[0, 1, 3, 2], 6), [1.0, 1.0]);
    // A strip turns corners by repeating them: no word of that.
    assert_eq!(area(&[0, 1, 2, 2, 2, 1, 3], 5), [1.0, 1.0]);
}

#[test]
fn triangles_without_area_are_dropped_and_counted() {
    let mut draft = Draft::new();
    draft.positions(&QUAD);
    draft.indices(&[0, 1, 1, 0, 1, 2, 3, 3, 3]);
    let read = draft.read().expect("a model");
    assert_eq!(triangles(read.mesh()).len(), 1);
    assert_eq!(read.codes(), ["W105"]);
    assert!(read.warnings[0].message.starts_with("2 triangles"));
    let pointer = read.warnings[0].pointer.as_deref();
    assert_eq!(pointer, Some("/meshes/0/primitives/0"));
}

#[test]
fn points_and_lines_are_skipped_with_a_word() {
    for mode in 0..4 {
        let mut draft = Draft::triangle();
        draft.primitive()["mode"] = mode.into();
        // Lines come in pairs.
        draft.indices(&[0, 1]);
        let read = draft.read().expect("a model");
        assert_eq!(read.codes(), ["W137", "W135"]);
        assert_eq!(read.model.meshes, [None]);
    }
}

#[test]
fn interleaved_and_separate_attributes_are_the_same() {
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let separate = || {
        let mut draft = Draft::triangle();
        let normals = draft.floats(&[[0.0, 0.0, 1.0]; 3]);
        draft.attribute("NORMAL", normals);
        let uvs = draft.floats(&corners);
        draft.attribute("TEXCOORD_0", uvs);
        draft.clean()
    };
    let mut draft = Draft::new();
    let mut bytes = Vec::new();
    for [u, v] in corners {
        let vertex = [u, v, 0.0, 0.0, 0.0, 1.0, u, v];
        bytes.extend(vertex.iter().flat_map(|x: &f32| x.to_le_bytes()));
    }
    let view = draft.view(&bytes);
    draft.root["bufferViews"][view]["byteStride"] = 32.into();
    for (name, kind, offset) in [
        ("POSITION", "VEC3", 0),
        ("NORMAL", "VEC3", 12),
        ("TEXCOORD_0", "VEC2", 24),
    ] {
        let mut accessor = json!({
            "bufferView": view, "byteOffset": offset, "type": kind, "componentType": 5126, "count": 3,
        });
        if name == "POSITION" {
            accessor["min"] = json!([0, 0, 0]);
            accessor["max"] = json!([1, 1, 0]);
        }
        let accessor = draft.push("accessors", accessor);
        draft.attribute(name, accessor);
    }
    let (separate, together) = (separate(), draft.clean());
    let (a, b) = (separate.mesh(), together.mesh());
    assert_eq!(triangles(a), triangles(b));
    assert_eq!((&a.normals, &a.uvs), (&b.normals, &b.uvs));
    assert_eq!(b.normals.iter().collect::<Vec<_>>(), [Some(DVec3::Z); 3]);
    // v up: glTF has 0 at the top.
    assert_eq!(
        b.uvs.iter().collect::<Vec<_>>(),
        [[0.0, 1.0], [1.0, 1.0], [0.0, 0.0]].map(|uv| Some(DVec2::from_array(uv)))
    );
}

#[test]
fn sparse_elements_replace_others_or_zeros() {
    let sparse = |base: bool| {
        let mut draft = Draft::new();
        let indices = draft.view(&[0, 2]);
        let values: Vec<u8> = [[5.0f32, 0.0, 0.0], [0.0, 7.0, 0.0]]
            .as_flattened()
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        let values = draft.view(&values);
        let accessor = draft.positions(&[[1.0; 3]; 3]);
        let accessor = &mut draft.root["accessors"][accessor];
        accessor["sparse"] = json!({
            "count": 2,
            "indices": { "bufferView": indices, "componentType": 5121 },
            "values": { "bufferView": values },
        });
        let low = if base { 0.0 } else { 0.0f64.min(0.0) };
        accessor["min"] = json!([low, low, 0]);
        accessor["max"] = json!([5, 7, if base { 1 } else { 0 }]);
        if !base {
            accessor
                .as_object_mut()
                .expect("an object")
                .remove("bufferView");
        }
        draft.read().expect("a model")
    };
    let middle = |read: &Read| triangles(read.mesh())[0];
    assert_eq!(
        middle(&sparse(true)),
        [[5.0, 0.0, 0.0], [1.0; 3], [0.0, 7.0, 0.0]]
    );
    assert_eq!(
        middle(&sparse(false)),
        [[5.0, 0.0, 0.0], [0.0; 3], [0.0, 7.0, 0.0]]
    );
}

#[test]
fn quantised_attributes_are_what_they_stand_for() {
    let mut draft = Draft::new();
    draft.root["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
    draft.root["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    // 16-bit positions are padded to 8 bytes.
    let points: [[i16; 4]; 3] = [[0, 0, 0, 0], [32767, 0, 0, 0], [0, -32767, 0, 0]];
    let bytes: Vec<u8> = points
        .as_flattened()
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    let accessor = draft.accessor("VEC3", 5122, 3, &bytes);
    let view = draft.root["accessors"][accessor]["bufferView"].clone();
    draft.root["bufferViews"][view.as_u64().expect("an index") as usize]["byteStride"] = 8.into();
    let accessor_json = &mut draft.root["accessors"][accessor];
    accessor_json["normalized"] = true.into();
    accessor_json["min"] = json!([0, -32767, 0]);
    accessor_json["max"] = json!([32767, 0, 0]);
    draft.attribute("POSITION", accessor);
    let bytes = [0, 255, 0, 0, 255, 0, 0, 0, 51, 51, 0, 0];
    let uvs = draft.accessor("VEC2", 5121, 3, &bytes);
    draft.root["accessors"][uvs]["normalized"] = true.into();
    let view = draft.root["accessors"][uvs]["bufferView"].clone();
    draft.root["bufferViews"][view.as_u64().expect("an index") as usize]["byteStride"] = 4.into();
    draft.attribute("TEXCOORD_0", uvs);
    let read = draft.clean();
    assert_eq!(
        triangles(read.mesh())[0],
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]
    );
    let uvs: Vec<_> = read
        .mesh()
        .uvs
        .iter()
        .flatten()
        .map(|uv| uv.to_array())
        .collect();
    assert_eq!(uvs, [[0.0, 0.0], [1.0, 1.0], [0.2, 0.8]]);
}

#[test]
fn vertex_colours_of_every_format_are_linear_factors() {
    let color = |kind: &str, component: u32, bytes: &[u8]| {
        let mut draft = Draft::triangle();
        let accessor = draft.accessor(kind, component, 3, bytes);
        if component != 5126 {
            draft.root["accessors"][accessor]["normalized"] = true.into();
        }
        draft.attribute("COLOR_0", accessor);
        let read = draft.read().expect("a model");
        assert!(read.mesh().materials[0].vertex_colors);
        assert!(
            read.codes().iter().all(|code| *code == "W127"),
            "{:?}",
            read.warnings
        );
        read.mesh().colors.clone()
    };
    let expected = |alpha: f32| [[1.0, 0.0, 0.2, alpha]; 3];
    let floats: Vec<u8> = [1.0f32, 0.0, 0.2]
        .repeat(3)
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    assert_eq!(color("VEC3", 5126, &floats), expected(1.0));
    let bytes = [255, 0, 51, 102].repeat(3);
    assert_eq!(color("VEC4", 5121, &bytes), expected(0.4));
    let shorts: Vec<u8> = [65535u16, 0, 13107, 39321]
        .repeat(3)
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    assert_eq!(color("VEC4", 5123, &shorts), expected(0.6));
}

#[test]
fn primitives_are_joined_and_those_without_normals_are_flat() {
    let mut draft = Draft::triangle();
    let first = draft.primitive().clone();
    assert!(draft.clean().mesh().faceted);
    assert!(draft.clean().mesh().normals.is_empty());
    let normals = draft.floats(&[[0.6, 0.0, 0.8]; 3]);
    draft.attribute("NORMAL", normals);
    let second = draft.primitive().clone();
    draft.root["materials"] =
        json!([{ "name": "a", "pbrMetallicRoughness": { "metallicFactor": 0 } }]);
    draft.root["meshes"][0]["primitives"] = json!([first, second]);
    draft.root["meshes"][0]["primitives"][1]["material"] = 0.into();
    let read = draft.clean();
    let mesh = read.mesh();
    assert_eq!(mesh.positions.len(), 3, "the vertices are shared");
    assert_eq!(mesh.material, [Some(0), Some(1)]);
    let names: Vec<&str> = mesh.materials.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["default", "a"]);
    assert!(!mesh.faceted);
    let normals: Vec<_> = mesh.normals.iter().collect();
    assert_eq!(normals[..3], [Some(DVec3::Z); 3]);
    let authored = normals[3].expect("a normal");
    assert!(authored.distance(DVec3::new(0.6, 0.0, 0.8)) < 1e-7);
}

#[test]
fn a_normal_that_is_none_is_absent() {
    let mut draft = Draft::triangle();
    let normals = draft.floats(&[[0.0; 3], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]);
    draft.attribute("NORMAL", normals);
    let read = draft.read().expect("a model");
    assert_eq!(
        read.mesh().normals.iter().collect::<Vec<_>>(),
        [None, Some(DVec3::Z), Some(DVec3::Z)]
    );
    assert!(read.codes().contains(&"W106"), "{:?}", read.warnings);
}

#[test]
fn a_small_file_that_asks_for_billions_of_triangles_is_refused() {
    let mut draft = Draft::triangle();
    draft.indices(&[0, 1, 2].repeat(1 << 14));
    let primitive = draft.primitive().clone();
    draft.root["meshes"][0]["primitives"] = vec![primitive; 4000].into();
    let errors = draft.read().map(|_| ()).expect_err("an error");
    assert_eq!(errors[0].code, "E111", "{errors:?}");
}

#[test]
fn indices_and_vertices_that_cannot_be_used_are_errors_with_a_place() {
    let mut beyond = Draft::triangle();
    beyond.indices(&[0, 1, 3]);
    let mut infinite = Draft::new();
    let accessor = infinite.floats(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [f32::INFINITY, 1.0, 0.0]]);
    infinite.root["accessors"][accessor]["min"] = json!([0, 0, 0]);
    infinite.root["accessors"][accessor]["max"] = json!([1, 1, 0]);
    infinite.attribute("POSITION", accessor);
    for draft in [beyond, infinite] {
        let errors = draft.read().map(|_| ()).expect_err("an error");
        let pointer = errors[0].pointer.as_deref().expect("a pointer");
        let places = ["/meshes/0", "/accessors/"];
        assert!(
            places.iter().any(|place| pointer.starts_with(place)),
            "{errors:?}"
        );
    }
}

#[test]
fn an_accessor_of_zeros_is_refused_by_the_budget() {
    let mut draft = Draft::triangle();
    draft.indices(&[0, 1, 2]);
    let zeros = json!({ "componentType": 5126, "type": "VEC3", "count": 1_000_000_000,
        "min": [0, 0, 0], "max": [0, 0, 0] });
    let accessors = draft.root["accessors"].as_array_mut().expect("accessors");
    accessors.push(zeros);
    let index = accessors.len() - 1;
    draft.attribute("POSITION", index);
    let errors = draft.read().map(|_| ()).expect_err("an error");
    assert_eq!(errors[0].code, "E111", "{errors:?}");
    assert_eq!(errors[0].pointer, Some(format!("/accessors/{index}")));
    let hint = errors[0].hint.as_deref().unwrap_or_default();
    // 24 bytes for each of three components and their double precision: 24 GB.
    assert!(hint.contains("--max-memory 32G"), "{hint}");
}

#[test]
fn a_zero_normal_is_told_of_once() {
    let mut draft = Draft::triangle();
    let normals = draft.floats(&[[0.0; 3], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]);
    draft.attribute("NORMAL", normals);
    assert_eq!(draft.read().expect("a model").codes(), ["W106"]);
}
