use super::*;
use crate::asset::Loader;
use crate::asset::gltf::container::Container;
use crate::asset::limits::Budget;
use serde_json::{Value, json};

/// One buffer of these bytes, percent-encoded, one view of it, and an accessor.
fn read(bytes: &[u8], stride: Option<usize>, accessor: Value) -> Result<Elements, Diagnostic> {
    let encoded: String = bytes.iter().map(|b| format!("%{b:02x}")).collect();
    let len = bytes.len();
    let mut json = json!({
        "buffers": [{ "byteLength": len, "uri": format!("data:,{encoded}") }],
        "bufferViews": [{ "buffer": 0, "byteLength": len }],
        "accessors": [accessor],
    });
    if let Some(stride) = stride {
        json["bufferViews"][0]["byteStride"] = stride.into();
    }
    let container = Container::open(b"{}".to_vec(), &mut Vec::new())?;
    let mut buffers = Buffers::of(container, &json, &Budget::default());
    buffers.load(&mut Loader::new(), "x.gltf".as_ref(), &json, 0)?;
    numbers(&Layouts::of(&json), &buffers, 0)
}

fn accessor(component: usize, kind: &str, count: usize) -> Value {
    json!({ "bufferView": 0, "componentType": component, "type": kind, "count": count })
}

fn components(bytes: &[u8], component: usize, normalized: bool) -> Vec<f64> {
    let size = Component::of(component as u64).map_or(1, Component::size);
    let mut accessor = accessor(component, "SCALAR", bytes.len() / size);
    accessor["normalized"] = normalized.into();
    read(bytes, None, accessor).expect("elements").components
}

#[test]
fn every_component_type_is_read() {
    assert_eq!(components(&[0x80, 0x7F], 5120, false), [-128.0, 127.0]);
    assert_eq!(components(&[0x80, 0xFF], 5121, false), [128.0, 255.0]);
    assert_eq!(components(&[0, 0x80, 1, 0], 5122, false), [-32768.0, 1.0]);
    assert_eq!(components(&[0xFF, 0xFF], 5123, false), [65535.0]);
    assert_eq!(components(&[0xFF; 4], 5125, false), [4_294_967_295.0]);
    assert_eq!(components(&(-1.5_f32).to_le_bytes(), 5126, false), [-1.5]);
}

#[test]
fn normalized_integers_follow_the_formulas() {
    assert_eq!(
        components(&[0x80, 0x81, 0, 0x7F], 5120, true),
        [-1.0, -1.0, 0.0, 1.0]
    );
    assert_eq!(components(&[0, 51, 255], 5121, true), [0.0, 0.2, 1.0]);
    assert_eq!(components(&[0, 0x80, 0xFF, 0x7F], 5122, true), [-1.0, 1.0]);
    assert_eq!(components(&[0xFF, 0xFF], 5123, true), [1.0]);
}

#[test]
fn strides_and_columns_are_kept() {
    let read = |stride, accessor| read(&(0..24).collect::<Vec<u8>>(), stride, accessor);
    let vectors = read(Some(8), accessor(5121, "VEC2", 3)).expect("elements");
    assert_eq!(vectors.components, [0.0, 1.0, 8.0, 9.0, 16.0, 17.0]);
    let matrices = read(None, accessor(5121, "MAT2", 2)).expect("elements");
    assert_eq!(matrices.width, 4);
    assert_eq!(
        matrices.components,
        [0.0, 1.0, 4.0, 5.0, 8.0, 9.0, 12.0, 13.0]
    );
    assert!(read(Some(1), accessor(5121, "VEC2", 3)).is_err());
}

#[test]
fn sparse_elements_take_their_places() {
    let sparse = json!({
        "count": 2,
        "indices": { "bufferView": 0, "byteOffset": 0, "componentType": 5121 },
        "values": { "bufferView": 0, "byteOffset": 2 },
    });
    let bare = json!({ "componentType": 5121, "type": "SCALAR", "count": 4, "sparse": sparse });
    let elements = read(&[1, 3, 7, 9], None, bare.clone()).expect("elements");
    assert_eq!(elements.components, [0.0, 7.0, 0.0, 9.0]);
    let mut on_base = bare.clone();
    on_base["bufferView"] = 0.into();
    let elements = read(&[1, 3, 7, 9], None, on_base).expect("elements");
    assert_eq!(elements.components, [1.0, 7.0, 7.0, 9.0]);
    assert!(read(&[1, 4, 7, 9], None, bare).is_err());
}

#[test]
fn nothing_is_allocated_for_what_is_not_there() {
    let huge = usize::MAX / 2;
    assert!(read(&[0; 8], None, accessor(5121, "SCALAR", huge)).is_err());
    let zeros = json!({ "componentType": 5126, "type": "MAT4", "count": 1_000_000_000 });
    assert!(read(&[0; 8], None, zeros).is_err());
    let zeros = json!({ "componentType": 5126, "type": "VEC2", "count": 2 });
    assert_eq!(
        read(&[0; 8], None, zeros).expect("zeros").components,
        [0.0; 4]
    );
}
