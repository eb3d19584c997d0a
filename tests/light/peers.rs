//! Rooms that other renderers drew with 2048 samples: `$LUXEL_DATA/../peers`.

use crate::luxel_side::{Stage, options};
use crate::npy;
use crate::oracle_uv::inputs;
use luxel::trace::{Sampler, TraceOptions};
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

const SIDE: usize = 256;
const SPP: u32 = 64;

/// Scenes with the most relative squared error allowed at 64 samples.
const SCENES: [(&str, f64); 3] = [("S1", 0.0070), ("S2", 0.07), ("S3", 0.0075)];

/// Most that a mean over the mask may differ.
const BIAS: f64 = 0.01;

/// Reach of a burnt-out pixel around itself, in pixels.
const REACH: i64 = 3;

#[test]
#[ignore = "long: half a minute; needs LUXEL_DATA; run with --ignored"]
fn rooms_look_as_other_renderers_draw_them() {
    let Some(inputs) = inputs() else { return };
    let peers = inputs.join("../peers");
    let scenes = std::fs::read(peers.join("scenes.json")).expect("scenes.json");
    let scenes: Value = serde_json::from_slice(&scenes).expect("JSON");
    for (name, limit) in SCENES {
        let stage = Stage::new(&format!("peer_{name}")).scene(&translate(&scenes[name], &peers));
        let exact = TraceOptions {
            sampler: Sampler::Sobol,
            ..options(scenes[name]["max_scatter"].as_u64().expect("bounces") as u32)
        };
        let sums = stage.sums(0, SPP, &exact);
        let found: Vec<[f64; 3]> = sums
            .rgb
            .iter()
            .map(|sum| sum.map(|s| s / f64::from(SPP)))
            .collect();
        let file = peers.join(format!("ref/{name}_mitsuba_2048spp.npy"));
        let truth: Vec<[f64; 3]> = npy::floats(&std::fs::read(file).expect("a reference"))
            .chunks_exact(3)
            .map(|c| [c[0], c[1], c[2]].map(f64::from))
            .collect();
        judge(name, &found, &truth, limit);
    }
}

fn judge(name: &str, found: &[[f64; 3]], truth: &[[f64; 3]], limit: f64) {
    let mask = mask(truth);
    let (mut error, mut sums, mut count) = (0.0, [[0.0; 3]; 2], 0.0);
    for (x, r) in (0..truth.len())
        .filter(|i| mask[*i])
        .map(|i| (found[i], truth[i]))
    {
        count += 1.0;
        for c in 0..3 {
            error += (x[c] - r[c]).powi(2) / (r[c] * r[c] + 0.01) / 3.0;
            sums[0][c] += x[c];
            sums[1][c] += r[c];
        }
    }
    let relmse = error / count;
    let bias = [0, 1, 2].map(|c| sums[0][c] / sums[1][c] - 1.0);
    println!("{name}: relMSE {relmse:.5} (at most {limit}), bias {bias:.4?}, mask {count}");
    assert!(relmse <= limit, "{name}: relMSE {relmse}");
    assert!(
        bias.iter().all(|b| b.abs() <= BIAS),
        "{name}: bias {bias:?}"
    );
}

/// Pixels of at most 2 with none above 8 within reach; rows and columns wrap around.
fn mask(truth: &[[f64; 3]]) -> Vec<bool> {
    let brightest = |i: usize| truth[i].into_iter().fold(0.0, f64::max);
    let side = SIDE as i64;
    (0..truth.len())
        .map(|i| {
            let (x, y) = ((i % SIDE) as i64, (i / SIDE) as i64);
            let hot = (-REACH..=REACH).any(|dy| {
                (-REACH..=REACH).any(|dx| {
                    let (x, y) = ((x + dx).rem_euclid(side), (y + dy).rem_euclid(side));
                    brightest((y * side + x) as usize) > 8.0
                })
            });
            brightest(i) <= 2.0 && !hot
        })
        .collect()
}

/// The peers' scene in the scene format. Glass of an index below 1 inside glass is the hollow of a ball.
fn translate(scene: &Value, peers: &Path) -> String {
    let number = |v: &Value| v.as_f64().expect("a number");
    let triple = |v: &Value| format!("({}, {}, {})", number(&v[0]), number(&v[1]), number(&v[2]));
    let camera = &scene["camera"];
    let (mut materials, mut entities) = (String::new(), String::new());
    let mut place = |shape: String, look: String| {
        writeln!(entities, "(shape: {shape}, {look}),").expect("a string");
    };
    let mut material = |v: &Value| {
        let text = match v["type"].as_str() {
            Some("diffuse") => format!("Diffuse(color: Linear{})", triple(&v["rgb"])),
            Some("mirror") => format!("Mirror(color: Linear{})", triple(&v["rgb"])),
            Some("glass") => format!("Glass(ior: {})", number(&v["ior"])),
            other => panic!("material {other:?}"),
        };
        let name = format!("m{}", materials.lines().count());
        writeln!(materials, "\"{name}\": {text},").expect("a string");
        format!("material: \"{name}\"")
    };
    let list = |key: &str| scene[key].as_array().expect("a list").clone();
    let sphere = |v: &Value| {
        let (radius, at) = (number(&v["r"]), triple(&v["c"]));
        format!("Sphere(radius: {radius}), transform: (translate: {at})")
    };
    for v in list("spheres") {
        place(sphere(&v), material(&v["mat"]));
    }
    for v in list("lights") {
        place(
            sphere(&v),
            format!("emissive: (radiance: {})", triple(&v["L"])),
        );
    }
    for v in list("meshes") {
        let file = peers
            .join("meshes")
            .join(v["file"].as_str().expect("a file"));
        let path = file.to_str().expect("a path in UTF-8");
        place(
            format!("Mesh({path:?}), normals: Flat"),
            material(&v["mat"]),
        );
    }
    format!(
        "camera: (at: {}, look_at: {}, up: {}, vfov_deg: {}), render: (size: ({SIDE}, {SIDE}), filter: Box),
        materials: {{{materials}}}, entities: [{entities}]",
        triple(&camera["pos"]),
        triple(&camera["look"]),
        triple(&camera["up"]),
        number(&camera["vfov"])
    )
}
