//! Every glTF file of a collection of real files has the triangles and the bounds that another reader found, renders, and
//! is told only of what luxel lacks.
//!
//! Runs where `LUXEL_DATA` names a folder with `ORACLE.json` and `zoo/`; says that it skips elsewhere.

use luxel::asset::{AssetStore, Light, Loader, MeshId};
use luxel::math::{DAffine3, DVec3};
use luxel::render::{Control, Renderer, Settings};
use luxel::world::{Pose, Shape, Spawned};
use luxel::{film, scene, world};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Files of which the other reader does not read strips and fans, or not those without indices: all show the quad of
/// `Mesh_PrimitiveMode_04.gltf`, which it reads.
const SAME_QUAD: [&str; 12] = [
    "04", "05", "06", "08", "09", "10", "11", "12", "13", "14", "15", "04",
];

/// The other reader's boxes are rounded to six digits after the point.
const BOX_TOLERANCE: f64 = 2e-6;

fn data() -> Option<PathBuf> {
    let data = std::env::var_os("LUXEL_DATA").map(PathBuf::from);
    if data.is_none() {
        eprintln!("skipped: LUXEL_DATA is not set");
    }
    data
}

/// A scene of one file, lit by a white sky and seen from `at`.
fn spawn(file: &Path, at: DVec3, look_at: DVec3) -> Result<(scene::SceneDesc, Spawned), String> {
    let name = file.file_name().and_then(|name| name.to_str()).expect("a name");
    let [at, look_at] = [at, look_at].map(|p| format!("({:e}, {:e}, {:e})", p.x, p.y, p.z));
    let text = format!(
        "Scene(version: 1, camera: (at: {at}, look_at: {look_at}), render: (size: (16, 16), spp: 2),
         background: Linear(1, 1, 1), entities: [(gltf: {name:?})])"
    );
    let (desc, _) = scene::parse(&text, &file.with_file_name("zoo.ron"))
        .map_err(|found| format!("scene: {}", found[0]))?;
    let spawned =
        world::spawn(&desc, Loader::new()).map_err(|found| format!("world: {}", found[0]))?;
    Ok((desc, spawned))
}

/// Every mesh with the map to where it is.
fn instances(spawned: &mut Spawned) -> Vec<(MeshId, DAffine3)> {
    let mut query = spawned.world.query::<(&Shape, &Pose)>();
    let mesh = |(shape, pose): (&Shape, &Pose)| match shape {
        Shape::Mesh { mesh, .. } => Some((*mesh, pose.affine())),
        Shape::Sphere { .. } => None,
    };
    query.iter().filter_map(mesh).collect()
}

#[test]
fn probe() {
    let Some(data) = data() else { return };
    let oracle = std::fs::read_to_string(data.join("ORACLE.json")).expect("ORACLE.json");
    let oracle: Value = serde_json::from_str(&oracle).expect("JSON");
    for (name, expected) in oracle.as_object().unwrap() {
        if name.ends_with(".obj") { continue }
        let file = data.join("zoo").join(name);
        match spawn(&file, DVec3::splat(3.0), DVec3::ZERO) {
            Err(e) => println!("{name}: REFUSED {e}"),
            Ok((_, mut s)) => {
                let inst = instances(&mut s);
                let tris: usize = inst.iter().map(|(m, _)| s.assets.mesh(*m).triangle_count()).sum();
                let mut lo = DVec3::INFINITY; let mut hi = DVec3::NEG_INFINITY;
                for (m, a) in &inst { for p in &s.assets.mesh(*m).positions { let q = a.transform_point3(*p); lo = lo.min(q); hi = hi.max(q);} }
                println!("{name}: {tris} ({}) {lo:?} {hi:?} {} {}", expected["tris"], expected["min"], expected["max"]);
                for w in &s.warnings { println!("    {w}"); }
            }
        }
    }
}
