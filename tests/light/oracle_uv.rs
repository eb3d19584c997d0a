//! Texture coordinates of real meshes against those that another program saw: `$LUXEL_DATA/oracle_uv`.

use crate::luxel_side::{Stage, options};
use crate::npy;
use luxel::trace::TraceOptions;
use std::path::{Path, PathBuf};

/// What the oracle's arrays were written to be compared at.
const TOLERANCE: f32 = 1e-3;

/// Least share of hit pixels within the tolerance.
const SHARE: f64 = 0.999;

/// The folder of real inputs, or a note that there is none.
pub(crate) fn inputs() -> Option<PathBuf> {
    let folder = std::env::var_os("LUXEL_DATA").map(PathBuf::from);
    if folder.is_none() {
        println!("skipped: LUXEL_DATA is not set");
    }
    folder
}

#[test]
fn real_meshes_have_their_uv() {
    let Some(inputs) = inputs() else { return };
    let cameras = std::fs::read(inputs.join("oracle_uv/cameras.json")).expect("cameras.json");
    let cameras: serde_json::Value = serde_json::from_slice(&cameras).expect("JSON");
    for name in ["fuze", "spider", "capsule"] {
        compare(&inputs, name, &cameras[name]);
    }
}

fn compare(inputs: &Path, name: &str, camera: &serde_json::Value) {
    let triple = |key: &str| [0, 1, 2].map(|k| camera[key][k].as_f64().expect("a number"));
    let (at, look) = (triple("camera"), triple("look"));
    let target = [0, 1, 2].map(|k| at[k] + look[k]);
    let (width, height) = (
        camera["width"].as_u64().expect("a width") as usize,
        camera["height"].as_u64().expect("a height") as usize,
    );
    assert_eq!(width, height, "hfov is vfov in square pictures alone");
    let mesh = inputs.join(camera["file"].as_str().expect("a file"));
    let text = |[x, y, z]: [f64; 3]| format!("({x}, {y}, {z})");
    let stage = Stage::new(&format!("oracle_{name}")).scene(&format!(
        "camera: (at: {}, look_at: {}, vfov_deg: {}), render: (size: ({width}, {height})),
        entities: [(shape: Mesh({:?}))]",
        text(at),
        text(target),
        camera["hfov_deg"],
        mesh.to_str().expect("a path in UTF-8")
    ));
    let sums = stage.sums(
        0,
        1,
        &TraceOptions {
            ids: true,
            ..options(0)
        },
    );
    let archive = std::fs::read(inputs.join(format!("oracle_uv/{name}.npz"))).expect("an archive");
    let uv = npy::floats(&npy::member(&archive, "uv.npy"));
    let triangle = npy::ints(&npy::member(&archive, "tri.npy"));
    let (mut hits, mut near, mut far) = (0u32, 0u32, Vec::new());
    for (i, &expected) in triangle.iter().enumerate().filter(|(_, t)| **t >= 0) {
        hits += 1;
        let apart = (0..2).any(|k| (sums.uv[i][k] - uv[2 * i + k]).abs() > TOLERANCE);
        if !apart {
            near += 1;
        } else if !at_border(&triangle, width, i) {
            far.push((i % width, i / width, expected, sums.prim[i]));
        }
    }
    println!("{name}: uv of {near} of {hits} pixels within {TOLERANCE}");
    assert!(
        f64::from(near) >= SHARE * f64::from(hits),
        "{name}: {near} of {hits}"
    );
    assert!(far.is_empty(), "{name}: apart inside of triangles: {far:?}");
}

/// Whether some pixel around shows another triangle, or none.
fn at_border(triangle: &[i32], width: usize, i: usize) -> bool {
    let (x, y) = ((i % width) as i64, (i / width) as i64);
    let side = width as i64;
    (-1..=1).any(|dy| {
        (-1..=1).any(|dx| {
            let (x, y) = (x + dx, y + dy);
            let inside = (0..side).contains(&x) && (0..side).contains(&y);
            inside && triangle[(y * side + x) as usize] != triangle[i]
        })
    })
}
