//! Buffers, buffer views, accessors, and what they serve.

use super::{data, silent, tells};
use serde_json::{Value, json};

#[test]
fn buffers() {
    tells(
        "E126",
        "/buffers/0/uri",
        &[("/buffers/0/uri", json!("missing.bin"))],
    );
    tells(
        "E126",
        "/buffers/0/uri",
        &[("/buffers/0/uri", json!("https://example.org/x.bin"))],
    );
    tells(
        "E126",
        "/buffers/0",
        &[("/buffers/0/uri", json!(data(&[0; 8])))],
    );
    tells("E126", "/buffers/0", &[("/buffers/0/uri", Value::Null)]);
    let broken = json!("data:application/octet-stream;base64,*");
    tells("E126", "/buffers/0/uri", &[("/buffers/0/uri", broken)]);
    let second = |uri: Value| ("/buffers/1", json!({ "byteLength": 9, "uri": uri }));
    tells("W125", "/buffers/1/uri", &[second(json!("missing.bin"))]);
    tells("W125", "/buffers/1", &[second(json!(data(&[0; 8])))]);
    tells(
        "W125",
        "/buffers/1/uri",
        &[second(json!("data:image/png;base64,AAAAAAAAAAAA"))],
    );
    silent(&[second(json!(data(&[0; 12])))]);
    silent(&[("/buffers/1", json!({ "byteLength": 9 }))]);
}

#[test]
fn views_fit_their_buffers() {
    tells(
        "E126",
        "/bufferViews/0",
        &[("/bufferViews/0/byteLength", json!(100_000))],
    );
    tells(
        "E126",
        "/bufferViews/0",
        &[("/bufferViews/0/byteOffset", json!(u64::MAX))],
    );
    let unused = |len: usize| ("/bufferViews/14", json!({ "buffer": 0, "byteLength": len }));
    tells("W125", "/bufferViews/14", &[unused(100_000)]);
    silent(&[unused(4)]);
    let strides = [5, 2, 256, 400];
    for stride in strides {
        tells(
            "W127",
            "/bufferViews/14/byteStride",
            &[unused(300), ("/bufferViews/14/byteStride", json!(stride))],
        );
    }
    tells(
        "W127",
        "/bufferViews/14/byteStride",
        &[unused(4), ("/bufferViews/14/byteStride", json!(8))],
    );
    let indices = json!({ "buffer": 0, "byteLength": 64, "byteStride": 8, "target": 34963 });
    tells(
        "W127",
        "/bufferViews/14/byteStride",
        &[("/bufferViews/14", indices)],
    );
    silent(&[unused(300), ("/bufferViews/14/byteStride", json!(252))]);
}

#[test]
fn accessors_fit_their_views() {
    tells("E127", "/accessors/0", &[("/accessors/0/count", json!(4))]);
    tells(
        "E127",
        "/accessors/0",
        &[("/accessors/0/byteOffset", json!(4))],
    );
    tells(
        "E127",
        "/accessors/0",
        &[("/accessors/0/count", json!(1_u64 << 62))],
    );
    tells(
        "E127",
        "/accessors/0",
        &[("/bufferViews/0/byteStride", json!(8))],
    );
    tells("W127", "/accessors/7", &[("/accessors/7/count", json!(3))]);
    tells(
        "W127",
        "/accessors/8/normalized",
        &[("/accessors/8/normalized", json!(true))],
    );
    tells(
        "W127",
        "/accessors/11/byteOffset",
        &[("/accessors/11/byteOffset", json!(0))],
    );
    let unused = |offset: usize, component: usize, kind: &str| {
        let accessor = json!({ "bufferView": 7, "byteOffset": offset, "componentType": component, "type": kind, "count": 1 });
        ("/accessors/12", accessor)
    };
    tells(
        "W127",
        "/accessors/12/byteOffset",
        &[unused(2, 5126, "SCALAR")],
    );
    tells(
        "W127",
        "/accessors/12/byteOffset",
        &[unused(2, 5121, "MAT2")],
    );
    tells(
        "W127",
        "/accessors/12",
        &[
            unused(0, 5126, "SCALAR"),
            ("/bufferViews/7/byteOffset", json!(206)),
        ],
    );
    silent(&[unused(2, 5121, "SCALAR")]);
    // The last column of a matrix needs no padding (section 3.6.2.4).
    silent(&[unused(128 - 12, 5121, "MAT3")]);
    let short = json!({ "buffer": 0, "byteLength": 11 });
    let matrix = json!({ "bufferView": 14, "componentType": 5121, "type": "MAT3", "count": 1 });
    silent(&[("/bufferViews/14", short), ("/accessors/12", matrix)]);
}

#[test]
fn sparse_elements() {
    let place = "/accessors/11/sparse";
    tells(
        "W127",
        "/accessors/11/sparse/count",
        &[("/accessors/11/sparse/count", json!(4))],
    );
    tells(
        "W127",
        "/accessors/11/sparse/values",
        &[("/accessors/11/sparse/count", json!(2))],
    );
    tells(
        "W127",
        "/accessors/11/sparse/indices/byteOffset",
        &[("/accessors/11/sparse/indices/byteOffset", json!(1))],
    );
    tells(
        "W127",
        "/accessors/11/sparse/values/bufferView",
        &[("/bufferViews/11/byteStride", json!(12))],
    );
    tells(
        "W127",
        "/accessors/11/sparse/indices/bufferView",
        &[("/bufferViews/10/target", json!(34963))],
    );
    tells(
        "E124",
        place,
        &[("/accessors/11/sparse/values", Value::Null)],
    );
    // Three values at the places 2, 1, 0 and at 0, 1, 3.
    let sparse = |places: [u8; 3]| {
        let uri = data(&[&places[..], &[0; 37]].concat());
        let accessor = json!({
            "componentType": 5126, "type": "VEC3", "count": 3,
            "sparse": { "count": 3, "indices": { "bufferView": 14, "componentType": 5121 }, "values": { "bufferView": 15 } },
        });
        [
            ("/buffers/1", json!({ "byteLength": 40, "uri": uri })),
            ("/bufferViews/14", json!({ "buffer": 1, "byteLength": 3 })),
            (
                "/bufferViews/15",
                json!({ "buffer": 1, "byteOffset": 4, "byteLength": 36 }),
            ),
            ("/accessors/12", accessor),
        ]
    };
    silent(&sparse([0, 1, 2]));
    tells("W129", "/accessors/12/sparse", &sparse([2, 1, 0]));
    tells("W129", "/accessors/12/sparse", &sparse([0, 1, 3]));
    let used = ("/meshes/0/primitives/0/attributes/NORMAL", json!(12));
    tells(
        "E127",
        "/accessors/12/sparse",
        &[&sparse([0, 1, 3])[..], &[used]].concat(),
    );
}

#[test]
fn one_purpose_each() {
    let attributes = "/meshes/0/primitives/0/attributes";
    let normal = format!("{attributes}/NORMAL");
    tells(
        "W127",
        "/meshes/0/primitives/0/indices",
        &[("/bufferViews/6/target", json!(34962))],
    );
    tells("W127", &normal, &[("/bufferViews/1/target", json!(34963))]);
    tells(
        "W127",
        "/images/0/bufferView",
        &[("/bufferViews/12/target", json!(34962))],
    );
    tells(
        "W127",
        "/images/0/bufferView",
        &[("/bufferViews/12/byteStride", json!(4))],
    );
    tells(
        "W127",
        "/animations/0/samplers/0/input",
        &[("/bufferViews/8/byteStride", json!(4))],
    );
    tells(
        "W127",
        "/skins/0/inverseBindMatrices",
        &[("/bufferViews/7/byteStride", json!(64))],
    );
    tells(
        "W127",
        "/meshes/0/primitives/0/indices",
        &[
            ("/bufferViews/6/byteStride", json!(4)),
            ("/accessors/6/count", json!(1)),
        ],
    );
    tells(
        "W127",
        "/animations/0/samplers/0/output",
        &[("/animations/0/samplers/0/output", json!(10))],
    );
    // Normals beside positions in one view without a stride.
    let beside = json!({ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3 });
    tells(
        "W127",
        &normal,
        &[("/accessors/12", beside), (normal.as_str(), json!(12))],
    );
    silent(&[
        ("/bufferViews/0/target", json!(34962)),
        ("/bufferViews/6/target", json!(34963)),
    ]);
}

#[test]
fn bounds() {
    tells(
        "W128",
        "/accessors/0/min/0",
        &[("/accessors/0/min/0", json!(-1))],
    );
    tells(
        "W128",
        "/accessors/0/max/1",
        &[("/accessors/0/max/1", json!(0.5))],
    );
    tells(
        "W128",
        "/accessors/0/max",
        &[("/accessors/0/max", json!([1, 1]))],
    );
    tells(
        "W128",
        "/accessors/11/max/2",
        &[("/accessors/11/max/2", json!(3))],
    );
    let place = "/meshes/0/primitives/0/attributes/POSITION";
    tells("W128", place, &[("/accessors/0/min", Value::Null)]);
    tells(
        "W128",
        "/animations/0/samplers/0/input",
        &[("/accessors/8/max", Value::Null)],
    );
    // Bounds are of f32: these digits round to 1.
    silent(&[("/accessors/0/max/0", json!(1.000_000_01))]);
}
