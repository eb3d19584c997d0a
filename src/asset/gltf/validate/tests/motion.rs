//! Skins and animations: never a reason to refuse a file.

use super::{data, floats, silent, tells};
use serde_json::{Value, json};

#[test]
fn skins() {
    tells("W132", "/nodes/2/skin", &[("/nodes/2/skin", json!(0))]);
    let plain = json!({ "primitives": [{ "attributes": { "POSITION": 0 } }] });
    tells(
        "W132",
        "/nodes/2",
        &[
            ("/nodes/2/skin", json!(0)),
            ("/nodes/2/mesh", json!(1)),
            ("/meshes/1", plain),
        ],
    );
    tells("W132", "/nodes/0", &[("/scenes/0/nodes", json!([0, 3, 4]))]);
    tells(
        "W132",
        "/skins/0/joints",
        &[
            ("/skins/0/joints", json!([1, 3])),
            ("/skins/0/skeleton", Value::Null),
        ],
    );
    tells(
        "W132",
        "/skins/0/skeleton",
        &[("/skins/0/skeleton", json!(2))],
    );
    tells(
        "W132",
        "/skins/0/inverseBindMatrices",
        &[("/accessors/7/count", json!(1))],
    );
    tells(
        "W132",
        "/skins/0/inverseBindMatrices",
        &[("/skins/0/inverseBindMatrices", json!(9))],
    );
    let row = data(&floats(&[[1.0; 16], [1.0; 16]].concat()));
    let own = [
        ("/buffers/1", json!({ "byteLength": 128, "uri": row })),
        ("/bufferViews/7", json!({ "buffer": 1, "byteLength": 128 })),
    ];
    tells("W132", "/skins/0/inverseBindMatrices", &own);
}

#[test]
fn channels() {
    let target = "/animations/0/channels/0/target";
    let aim = |node: usize, path: &str| json!({ "node": node, "path": path });
    tells("W132", target, &[(target, aim(3, "translation"))]);
    tells("W132", target, &[(target, aim(1, "weights"))]);
    tells(
        "W120",
        "/animations/0/channels/0/target/node",
        &[(target, aim(9, "rotation"))],
    );
    tells(
        "W120",
        "/animations/0/channels/0/target/path",
        &[(target, aim(1, "color"))],
    );
    tells(
        "W132",
        "/animations/0/channels/0/sampler",
        &[("/animations/0/channels/0/sampler", json!(1))],
    );
    let again = json!({ "sampler": 0, "target": { "node": 1, "path": "rotation" } });
    tells(
        "W132",
        "/animations/0/channels/1/target",
        &[("/animations/0/channels/1", again)],
    );
    let output = "/animations/0/samplers/0/output";
    tells("W132", output, &[(target, aim(1, "scale"))]);
    tells("W132", output, &[("/accessors/9/count", json!(2))]);
    tells(
        "W132",
        output,
        &[(
            "/animations/0/samplers/0/interpolation",
            json!("CUBICSPLINE"),
        )],
    );
    let other = json!({ "input": 8, "output": 9, "interpolation": "CUBICSPLINE" });
    tells(
        "W132",
        "/animations/0/samplers/1/output",
        &[("/animations/0/samplers/1", other)],
    );
}

#[test]
fn keys() {
    let input = "/animations/0/samplers/0/input";
    let times = |times: &[f32], last: f32| {
        [
            (
                "/buffers/1",
                json!({ "byteLength": 4 * times.len(), "uri": data(&floats(times)) }),
            ),
            (
                "/bufferViews/8",
                json!({ "buffer": 1, "byteLength": 4 * times.len() }),
            ),
            ("/accessors/8/min", json!([times[0]])),
            ("/accessors/8/max", json!([last])),
        ]
    };
    silent(&times(&[0.0, 0.5, 0.75], 0.75));
    tells("W132", input, &times(&[-1.0, 0.5, 0.75], 0.75));
    tells("W132", input, &times(&[0.0, 0.5, 0.5], 0.5));
    tells("W132", input, &[(input, json!(9))]);
    let spline = (
        "/animations/0/samplers/0/interpolation",
        json!("CUBICSPLINE"),
    );
    tells(
        "W132",
        input,
        &[
            spline,
            ("/accessors/8/count", json!(1)),
            ("/accessors/8/max", json!([0])),
        ],
    );
    let turned = data(&floats(&[0.0, 0.0, 0.3, 0.3].repeat(3)));
    let rotations = [
        ("/buffers/1", json!({ "byteLength": 48, "uri": turned })),
        ("/bufferViews/9", json!({ "buffer": 1, "byteLength": 48 })),
    ];
    tells("W132", "/animations/0/channels/0/sampler", &rotations);
}
