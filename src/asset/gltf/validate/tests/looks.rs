//! Cameras, lights, materials, images and textures.

use super::{data, png, silent, tells};
use serde_json::{Value, json};

#[test]
fn cameras() {
    let place = "/cameras/0/perspective";
    tells(
        "W133",
        place,
        &[("/cameras/0/perspective/zfar", json!(0.1))],
    );
    tells(
        "W133",
        "/cameras/0/perspective/yfov",
        &[("/cameras/0/perspective/yfov", json!(4))],
    );
    tells(
        "W120",
        "/cameras/0/perspective/yfov",
        &[("/cameras/0/perspective/yfov", json!(0))],
    );
    tells(
        "W120",
        place,
        &[("/cameras/0/perspective/znear", Value::Null)],
    );
    tells(
        "W133",
        "/cameras/0",
        &[("/cameras/0/perspective", Value::Null)],
    );
    tells(
        "W133",
        "/cameras/0",
        &[("/cameras/0/type", json!("orthographic"))],
    );
    let flat = json!({ "xmag": 1, "ymag": 1, "znear": 0, "zfar": 1 });
    tells(
        "W133",
        "/cameras/0",
        &[("/cameras/0/orthographic", flat.clone())],
    );
    let second = |flat: Value| {
        (
            "/cameras/1",
            json!({ "type": "orthographic", "orthographic": flat }),
        )
    };
    silent(&[second(flat.clone())]);
    let zero = ("/cameras/1/orthographic/xmag", json!(0));
    tells(
        "W133",
        "/cameras/1/orthographic/xmag",
        &[second(flat.clone()), zero],
    );
    let equal = ("/cameras/1/orthographic/zfar", json!(0));
    tells("W133", "/cameras/1/orthographic", &[second(flat), equal]);
}

#[test]
fn lights() {
    let place = "/extensions/KHR_lights_punctual/lights/0";
    let spot = format!("{place}/spot");
    tells("W133", place, &[(&spot, Value::Null)]);
    let angle = format!("{spot}/innerConeAngle");
    tells("W133", &spot, &[(&angle, json!(0.5))]);
    silent(&[(&angle, json!(0.4))]);
    let angle = format!("{spot}/outerConeAngle");
    tells("W133", &angle, &[(&angle, json!(2))]);
    silent(&[(&angle, json!(1.570_796_4))]);
    let kind = format!("{place}/type");
    tells("W120", &kind, &[(&kind, json!("area"))]);
}

#[test]
fn materials() {
    let place = "/materials/0/extensions/KHR_materials_ior/ior";
    tells("W133", place, &[(place, json!(0.5))]);
    silent(&[(place, json!(0))]);
    // A cutoff that does nothing is no harm.
    silent(&[("/materials/0/alphaMode", json!("OPAQUE"))]);
}

#[test]
fn images() {
    tells("E124", "/images/0", &[("/images/0", json!({}))]);
    tells("W126", "/images/1", &[("/images/1", json!({}))]);
    tells(
        "W126",
        "/images/0",
        &[("/images/0/uri", json!("missing.png"))],
    );
    tells(
        "W126",
        "/images/0/bufferView",
        &[("/images/0/mimeType", Value::Null)],
    );
    tells(
        "W126",
        "/images/0",
        &[("/images/0/mimeType", json!("image/jpeg"))],
    );
    tells(
        "W126",
        "/textures/0/source",
        &[("/images/0/mimeType", json!("image/webp"))],
    );
    tells(
        "W126",
        "/images/1/uri",
        &[("/images/1", json!({ "uri": "missing.png" }))],
    );
    tells(
        "W126",
        "/images/1/uri",
        &[("/images/1", json!({ "uri": "https://example.org/x.png" }))],
    );
    let embedded = |media: &str, bytes: &[u8]| {
        let uri = data(bytes).replace("application/octet-stream", media);
        ("/images/1", json!({ "uri": uri }))
    };
    silent(&[embedded("image/png", &png())]);
    tells("W126", "/images/1", &[embedded("image/jpeg", &png())]);
    tells("W126", "/images/1", &[embedded("image/png", &png()[..20])]);
    let webp = embedded("image/webp", b"RIFF\0\0\0\0WEBPVP8 ");
    tells("W126", "/images/1", std::slice::from_ref(&webp));
    let with_extension = [webp, ("/extensionsUsed/2", json!("EXT_texture_webp"))];
    tells("W122", "/extensionsUsed/2", &with_extension);
}

#[test]
fn variants() {
    const LIST: &str = "/extensions/KHR_materials_variants";
    const MAPPINGS: &str = "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings";
    let with = |list: Value, mappings: Value| {
        [
            ("/extensionsUsed/9", json!("KHR_materials_variants")),
            (LIST, list),
            (
                "/meshes/0/primitives/0/extensions",
                json!({ "KHR_materials_variants": mappings }),
            ),
        ]
    };
    let two = || json!({ "variants": [{ "name": "a" }, { "name": "b" }] });
    let map = |variants: Value| json!({ "mappings": [{ "material": 0, "variants": variants }] });
    silent(&with(two(), map(json!([0, 1]))));
    let place = |end: &str| format!("{MAPPINGS}{end}");
    tells(
        "W120",
        &place("/0/variants/1"),
        &with(two(), map(json!([0, 2]))),
    );
    tells("W124", &place("/0/variants"), &with(two(), map(json!([]))));
    tells(
        "W120",
        &place("/0"),
        &with(two(), json!({ "mappings": [{ "variants": [0] }] })),
    );
    let twice = json!({ "mappings": [{ "material": 0, "variants": [0] }, { "material": 0, "variants": [1, 0] }] });
    tells("W133", &place("/1/variants"), &with(two(), twice));
    let one = || map(json!([0]));
    tells("W120", LIST, &with(json!({}), one()));
    tells(
        "W124",
        &format!("{LIST}/variants"),
        &with(json!({ "variants": [] }), one()),
    );
    let unnamed = json!({ "variants": [{ "name": 1 }, { "name": "b" }] });
    tells(
        "W120",
        &format!("{LIST}/variants/0/name"),
        &with(unnamed, one()),
    );
    tells(
        "W123",
        "/meshes/0/extensions/KHR_materials_variants",
        &[
            ("/extensionsUsed/9", json!("KHR_materials_variants")),
            (
                "/meshes/0/extensions",
                json!({ "KHR_materials_variants": {} }),
            ),
        ],
    );
}

#[test]
#[cfg(unix)]
fn an_image_that_is_a_pipe_is_not_waited_for() {
    let folder = std::env::temp_dir().join(format!("luxel-pipe-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let pipe = folder.join("pipe.png");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.is_ok_and(|status| status.success()));
    // Used and unused.
    for image in ["/images/0", "/images/1"] {
        let uri = json!({ "uri": pipe.to_string_lossy() });
        let found = super::found(&super::with(&[(image, uri)]));
        assert!(found.iter().all(|one| one.code == "W126"), "{found:?}");
        assert_eq!(found.is_empty(), image == "/images/0");
    }
    let _ = std::fs::remove_dir_all(folder);
}
