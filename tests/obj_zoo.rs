//! Every OBJ of a collection of real files loads as another loader read it, or is refused with file and cause.
//!
//! Runs where `LUXEL_DATA` names a folder with `ORACLE.json` and `zoo/`; says that it skips elsewhere.

use luxel::asset::{Loader, Mesh};
use luxel::math::DVec3;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Files that are refused, with the code: broken, or without any face.
const REFUSED: [(&str, &str); 6] = [
    // Its only triangle has no area: its corners lie on a line.
    ("obj/assimp/number_formats.obj", "E102"),
    ("obj/tinyobj/invalid-relative-vertex-index.obj", "E103"),
    ("obj/tinyobj/issue-140-zero-face-idx.obj", "E103"),
    ("obj/tinyobj/line-prim.obj", "E102"),
    ("obj/trimesh/empty.obj", "E102"),
    ("obj/trimesh/face_in_group_name.obj", "E102"),
];

/// Files with triangles without area, which luxel drops and the other reader keeps: how many.
const DROPPED: [(&str, u64); 3] = [
    ("obj/assimp/box_longline.obj", 154),
    ("obj/assimp/spider.obj", 56),
    ("obj/trimesh/capsule.obj", 200),
];

/// Files whose box the other reader gives without the ceiling, at y = 548.8, that faces of the file use.
const OTHER_BOX: [&str; 4] = [
    "obj/tinyobj/cornell_box.obj",
    "obj/tinyobj/cornell_box_multimaterial.obj",
    "obj/tinyobj/missing_material_file.obj",
    "obj/tinyobj/no_material.obj",
];

/// The other reader's boxes may have passed through f32.
const BOX_TOLERANCE: f64 = 1e-6;

#[test]
fn every_file_of_the_zoo_loads_or_is_refused() {
    let Some(data) = std::env::var_os("LUXEL_DATA").map(PathBuf::from) else {
        eprintln!("skipped: LUXEL_DATA is not set");
        return;
    };
    let oracle = std::fs::read_to_string(data.join("ORACLE.json")).expect("ORACLE.json");
    let oracle: Value = serde_json::from_str(&oracle).expect("JSON");
    let mut differences = Vec::new();
    let mut count = 0;
    let files = oracle.as_object().expect("a table").iter();
    for (name, expected) in files.filter(|(name, _)| name.ends_with(".obj")) {
        count += 1;
        let found = compare(name, &data.join("zoo").join(name), expected);
        differences.extend(found.err().map(|found| format!("{name}: {found}")));
    }
    assert!(count >= 50, "only {count} files");
    assert!(differences.is_empty(), "{}", differences.join("\n"));
}

fn compare(name: &str, path: &Path, expected: &Value) -> Result<(), String> {
    let mut loader = Loader::new();
    let loaded = loader.mesh(path);
    let refused = REFUSED.iter().find(|(file, _)| *file == name);
    let id = match (loaded, refused) {
        (Ok(id), None) => id,
        (Ok(_), Some(_)) => return Err("should be refused".into()),
        (Err(errors), Some((_, code))) => {
            let named = |e: &_| is_error(e, code, path);
            let told = errors.iter().all(named);
            return if told {
                Ok(())
            } else {
                Err(format!("{errors:?}"))
            };
        }
        (Err(errors), None) => return Err(format!("refused: {}", errors[0])),
    };
    let store = loader.finish();
    let mesh = store.mesh(id);
    let dropped = DROPPED
        .iter()
        .find(|(file, _)| *file == name)
        .map_or(0, |d| d.1);
    let triangles = mesh.triangle_count() as u64 + dropped;
    if expected["tris"] != triangles {
        return Err(format!("{triangles} triangles, not {}", expected["tris"]));
    }
    let with_uv = uv_triangles(mesh);
    let uvs = with_uv + if with_uv > 0 { dropped } else { 0 };
    if expected["uv_tris"] != uvs {
        return Err(format!(
            "{uvs} triangles with uv, not {}",
            expected["uv_tris"]
        ));
    }
    let same = compare_box(mesh, expected);
    match OTHER_BOX.contains(&name) {
        true if same.is_ok() => Err("the boxes agree after all".into()),
        true => Ok(()),
        false => same,
    }
}

fn is_error(error: &luxel::diag::Diagnostic, code: &str, path: &Path) -> bool {
    error.code == code && error.file.as_deref() == Some(path)
}

fn uv_triangles(mesh: &Mesh) -> u64 {
    let complete = |uvs: &&[Option<_>]| uvs.iter().all(Option::is_some);
    mesh.uvs.chunks(3).filter(complete).count() as u64
}

fn compare_box(mesh: &Mesh, expected: &Value) -> Result<(), String> {
    let used = || {
        mesh.corners
            .iter()
            .map(|&corner| mesh.positions[corner as usize])
    };
    let min = used().fold(DVec3::INFINITY, DVec3::min);
    let max = used().fold(DVec3::NEG_INFINITY, DVec3::max);
    for (found, side) in [(min, "min"), (max, "max")] {
        for (axis, found) in found.to_array().into_iter().enumerate() {
            let Some(expected) = expected[side][axis].as_f64() else {
                return Err(format!("no {side} to compare with"));
            };
            if (found - expected).abs() > BOX_TOLERANCE * expected.abs().max(1.0) {
                return Err(format!("{side}[{axis}] is {found}, not {expected}"));
            }
        }
    }
    Ok(())
}
