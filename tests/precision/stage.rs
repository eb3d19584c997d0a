//! Scenes from text to what is traced.

use crate::support::Solid;
use luxel::build::{Accel, BuildOptions, Quality, SceneBuilder};
use luxel::flat::{FlatScene, Fresnel, PixelFilter};
use luxel::math::DVec3;
use luxel::trace::{Hits, Isa, Rays, Rect, TileSums, TraceOptions, Tracer, closest_hit};
use luxel::world::{self, Spawned};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// A folder of one test's own.
pub(crate) struct Stage(PathBuf);

impl Stage {
    pub(crate) fn new(name: &str) -> Stage {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("precision");
        let folder = folder.join(name);
        std::fs::create_dir_all(&folder).unwrap();
        Stage(folder)
    }

    pub(crate) fn file(self, name: &str, text: &str) -> Stage {
        std::fs::write(self.0.join(name), text).unwrap();
        self
    }

    /// The world of `Scene(version: 1, body)`, or what is wrong with it.
    pub(crate) fn spawn(&self, body: &str) -> Result<Spawned, String> {
        let text = format!("Scene(version: 1, {body})");
        let told = |all: Vec<luxel::diag::Diagnostic>| {
            let all: Vec<String> = all.iter().map(ToString::to_string).collect();
            all.join("\n")
        };
        let (desc, _) = luxel::scene::parse(&text, &self.0.join("scene.ron")).map_err(told)?;
        world::spawn(&desc, luxel::asset::Loader::new()).map_err(told)
    }

    /// As it is traced, posed at `t` seconds.
    pub(crate) fn flat_at(&self, body: &str, t: f64) -> FlatScene {
        let mut spawned = self.spawn(body).unwrap_or_else(|told| panic!("{told}"));
        let options = BuildOptions {
            accel: Accel::Bvh,
            quality: Quality::Good,
            size: (24, 16),
            filter: PixelFilter::Box,
            background: [0.4, 0.5, 0.6],
            uv_aov: false,
            fresnel: Fresnel::Exact,
            caustics: false,
        };
        let mut builder = SceneBuilder::new(&spawned.world, &spawned.assets, options);
        world::pose(&mut spawned.world, t);
        builder.build(&spawned.world, 0).0
    }

    pub(crate) fn flat(&self, body: &str) -> FlatScene {
        self.flat_at(body, 0.0)
    }
}

/// All pixels.
pub(crate) fn picture(flat: &FlatScene, spp: u32, options: &TraceOptions) -> TileSums {
    let rect = Rect {
        x: 0,
        y: 0,
        width: flat.camera.width,
        height: flat.camera.height,
    };
    let mut sums = TileSums::default();
    Tracer::new(flat, options).trace_tile(rect, 0..spp, &mut sums);
    assert_eq!(sums.lost, [], "samples that are not finite");
    sums
}

/// mean (x − r)² / (r² + 0.01) of two pictures of as many samples.
pub(crate) fn relmse(x: &TileSums, r: &TileSums) -> f64 {
    let n = f64::from(x.count[0]);
    let squared = |(x, r): (&f64, &f64)| (x - r).powi(2) / n / n / ((r / n).powi(2) + 0.01);
    let channels = x.rgb.iter().flatten().zip(r.rgb.iter().flatten());
    channels.map(squared).sum::<f64>() / (3 * x.rgb.len()) as f64
}

pub(crate) fn trace(scene: &FlatScene, rays: &Rays) -> Hits {
    let mut hits = Hits::default();
    closest_hit(scene, Isa::best(), rays, &mut hits);
    hits
}

/// A file of these triangles; numbers are written so that they read back to the same bits.
pub(crate) fn obj(vertices: &[DVec3], faces: &[[usize; 3]]) -> String {
    let mut text = String::new();
    for v in vertices {
        writeln!(text, "v {:?} {:?} {:?}", v.x, v.y, v.z).unwrap();
    }
    for [a, b, c] in faces {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1).unwrap();
    }
    text
}

pub(crate) fn points(solid: &Solid) -> Vec<DVec3> {
    solid.vertices.iter().map(|v| v.as_dvec3()).collect()
}

/// A cube from −1 to 1.
pub(crate) fn cube() -> (Vec<DVec3>, Vec<[usize; 3]>) {
    let side = |k: usize, bit: usize| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
    let corner = |k: usize| DVec3::new(side(k, 0), side(k, 1), side(k, 2));
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let faces = quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    ((0..8).map(corner).collect(), faces.collect())
}

/// The same faces seen from the other side.
pub(crate) fn turned(faces: &[[usize; 3]]) -> Vec<[usize; 3]> {
    faces.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

pub(crate) fn triple(v: [f64; 3]) -> String {
    format!("({:?}, {:?}, {:?})", v[0], v[1], v[2])
}
