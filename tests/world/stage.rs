//! Scenes of files of these tests, spawned and built.

use glam::Vec3;
use luxel::build::{Accel, BuildOptions, BuildTimes, Quality, SceneBuilder};
use luxel::flat::{FlatScene, Fresnel, PixelFilter};
use luxel::world::{self, Spawned};
use std::path::{Path, PathBuf};

/// A lopsided tetrahedron with a seam: every corner has its own uv.
pub(crate) const TETRA: &str = "\
v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 3\n\
vt 0 0\nvt 1 0\nvt 0 1\nvt 0.25 0.75\n\
f 1/1 3/2 2/3\nf 1/4 2/2 4/3\nf 1/1 4/4 3/2\nf 2/3 3/1 4/4\n";

pub(crate) fn options() -> BuildOptions {
    BuildOptions {
        accel: Accel::Bvh,
        quality: Quality::Good,
        size: (64, 48),
        filter: PixelFilter::Box,
        background: [0.0; 3],
        uv_aov: true,
        fresnel: Fresnel::Exact,
        caustics: false,
    }
}

pub(crate) fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("world");
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Writes a file once, whole, whatever other tests do at the same time.
pub(crate) fn file(name: &str, text: &str) {
    let whole = folder().join(format!("{name}.{:?}", std::thread::current().id()));
    std::fs::write(&whole, text).unwrap();
    std::fs::rename(whole, folder().join(name)).unwrap();
}

pub(crate) fn try_spawn(text: &str) -> Result<Spawned, Vec<luxel::diag::Diagnostic>> {
    file("tetra.obj", TETRA);
    let (desc, _) = luxel::scene::parse(text, &folder().join("scene.ron")).unwrap();
    world::spawn(&desc, luxel::asset::Loader::new())
}

pub(crate) fn spawn(text: &str) -> Spawned {
    try_spawn(text).unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// A scene around `entities`.
pub(crate) fn scene(entities: &str) -> String {
    format!(
        "Scene(version: 1, camera: (at: (0, 0, 8), look_at: (0, 0, 0)), materials: {{
            \"red\": Diffuse(color: Linear(0.8, 0.1, 0.1)), \"coat\": Plastic(), \"glass\": Glass(ior: 1.5) }},
        entities: [{entities}])"
    )
}

pub(crate) fn build_at(spawned: &mut Spawned, t: f64) -> (FlatScene, BuildTimes) {
    world::pose(&mut spawned.world, t);
    SceneBuilder::new(&spawned.world, &spawned.assets, options()).build(&spawned.world, 0)
}

pub(crate) fn build(text: &str) -> FlatScene {
    build_at(&mut spawn(text), 0.0).0
}

/// Triangles of the scene in scene units, from wherever they are stored, with the object they belong to.
pub(crate) fn triangles(scene: &FlatScene) -> Vec<(u32, [Vec3; 3])> {
    let vertices = |g: &luxel::flat::Geometry, prim: usize| {
        let place = g.triangles.place[prim] as usize;
        let block = &g.triangles.blocks[place / 8];
        assert_eq!(block.prim[place % 8] as usize, prim);
        block
            .v
            .map(|v| Vec3::from_array(v.map(|lanes| lanes[place % 8])))
    };
    let mut all = Vec::new();
    for (prim, object) in scene.world.shading.object.iter().enumerate() {
        all.push((object.0, vertices(&scene.world, prim)));
    }
    for instance in &scene.instances {
        let local = &scene.local[instance.geometry as usize];
        for prim in 0..local.triangles.place.len() {
            let v = vertices(local, prim).map(|p| {
                Vec3::from_array(
                    instance
                        .to_world
                        .map(|r| r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3]),
                )
            });
            let v = if instance.mirrored {
                [v[0], v[2], v[1]]
            } else {
                v
            };
            all.push((instance.object.0, v));
        }
    }
    all.sort_by_key(|t| t.0);
    all
}
