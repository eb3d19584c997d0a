//! The renderer under test, from the text of a scene to sums; and the files that the tests' scenes name.

use crate::reference::{self, Estimator};
use crate::stats::Picture;
use luxel::asset::AssetStore;
use luxel::build::{Accel, Quality};
use luxel::flat::FlatScene;
use luxel::render::{Renderer, Settings};
use luxel::scene::SceneDesc;
use luxel::trace::{Rect, Sampler, TileSums, TraceOptions, Tracer};
use std::path::PathBuf;

/// A scene text in a folder of its own under the build's scratch space.
pub(crate) struct Stage {
    folder: PathBuf,
    text: String,
    /// Changes what the files gave.
    files: Box<dyn Fn(&mut AssetStore)>,
    /// Changes the reference's scene likewise.
    truth: Box<dyn Fn(&mut reference::Scene)>,
}

/// Seeds of one picture: their spread is its error.
const SEEDS: u64 = 16;

/// Independent samples.
pub(crate) fn options(max_bounces: u32) -> TraceOptions {
    TraceOptions {
        max_bounces,
        sampler: Sampler::Independent,
        ..TraceOptions::default()
    }
}

impl Stage {
    /// `name` must be the test's own: tests run side by side.
    pub(crate) fn new(name: &str) -> Stage {
        let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
        std::fs::create_dir_all(&folder).expect("a scratch folder");
        Stage {
            folder,
            text: String::new(),
            files: Box::new(|_| ()),
            truth: Box::new(|_| ()),
        }
    }

    /// Sets the scene; `body` is what stands inside `Scene( .. )` after the version.
    pub(crate) fn scene(mut self, body: &str) -> Stage {
        self.text = format!("Scene(version: 1, {body})");
        self
    }

    /// Writes a file that the scene names.
    pub(crate) fn file(self, name: &str, text: &str) -> Stage {
        std::fs::write(self.folder.join(name), text).expect("a scratch file");
        self
    }

    /// Gives meshes what few files bring: to what luxel loaded, and to the reference, which reads no such files.
    pub(crate) fn retouch(
        mut self,
        files: impl Fn(&mut AssetStore) + 'static,
        truth: impl Fn(&mut reference::Scene) + 'static,
    ) -> Stage {
        self.files = Box::new(files);
        self.truth = Box::new(truth);
        self
    }

    /// Writes a PNG of sRGB bytes that the scene names.
    pub(crate) fn png(self, name: &str, rgb: &[u8], width: u32, height: u32) -> Stage {
        image::save_buffer(
            self.folder.join(name),
            rgb,
            width,
            height,
            image::ExtendedColorType::Rgb8,
        )
        .expect("a scratch picture");
        self
    }

    /// Writes a Radiance HDR image that the scene names.
    pub(crate) fn hdr(self, name: &str, texels: &[[f32; 3]], width: usize) -> Stage {
        let texels: Vec<image::Rgb<f32>> = texels.iter().map(|t| image::Rgb(*t)).collect();
        let mut bytes = Vec::new();
        image::codecs::hdr::HdrEncoder::new(&mut bytes)
            .encode(&texels, width, texels.len() / width)
            .expect("a scratch sky");
        std::fs::write(self.folder.join(name), bytes).expect("a scratch file");
        self
    }

    /// As luxel reads it.
    pub(crate) fn describe(&self) -> SceneDesc {
        match luxel::scene::parse(&self.text, &self.folder.join("scene.ron")) {
            Ok((desc, _)) => desc,
            Err(errors) => panic!("{errors:#?}\n{}", self.text),
        }
    }

    /// As luxel traces it.
    pub(crate) fn flat(&self, frame: u32, options: &TraceOptions) -> FlatScene {
        self.flat_by(frame, options, Accel::Bvh)
    }

    /// As luxel traces it, with as much of a tree.
    pub(crate) fn flat_by(&self, frame: u32, options: &TraceOptions, accel: Accel) -> FlatScene {
        let desc = self.describe();
        let mut spawned = match luxel::world::spawn(&desc, luxel::asset::Loader::new()) {
            Ok(spawned) => spawned,
            Err(errors) => panic!("{errors:#?}"),
        };
        (self.files)(&mut spawned.assets);
        let settings = Settings {
            size: desc.render.size,
            spp: desc.render.spp,
            noise: None,
            adaptive: true,
            time: None,
            threads: Some(1),
            tile: Settings::DEFAULT_TILE,
            accel,
            quality: Quality::Good,
            fixed_noise: false,
            trace: *options,
        };
        let renderer = Renderer::new(&desc, spawned.world, &spawned.assets, settings);
        renderer.expect("a thread").build(frame).0
    }

    /// What luxel makes of all pixels.
    pub(crate) fn sums(&self, frame: u32, spp: u32, options: &TraceOptions) -> TileSums {
        trace(&self.flat(frame, options), spp, options)
    }

    /// What luxel makes of it, for statistics: the pictures of [`SEEDS`] seeds with Sobol points, together `spp` samples
    /// of every pixel. Each is one estimate: samples of one seed are not independent of each other, seeds are.
    pub(crate) fn luxel(&self, frame: u32, spp: u32, options: &TraceOptions) -> Picture {
        let flat = self.flat(frame, options);
        let (width, height) = (flat.camera.width as usize, flat.camera.height as usize);
        let mut picture = Picture::new(width, height);
        for seed in 0..SEEDS {
            let options = TraceOptions {
                seed,
                sampler: Sampler::Sobol,
                ..*options
            };
            let sums = trace(&flat, spp / SEEDS as u32, &options);
            for (i, (sum, n)) in sums.rgb.iter().zip(&sums.count).enumerate() {
                picture.add(i % width, i / width, sum.map(|s| s / f64::from(*n)));
            }
        }
        picture
    }

    /// The scene as the reference sees it.
    pub(crate) fn reference_scene(&self, frame: u32) -> reference::Scene {
        let mut scene = reference::adapt::scene(&self.describe(), frame);
        (self.truth)(&mut scene);
        scene
    }

    /// What the reference makes of it.
    pub(crate) fn reference(&self, frame: u32, spp: u32, estimator: Estimator) -> Picture {
        reference::render(&self.reference_scene(frame), estimator, spp, 7)
    }
}

/// The whole picture as one tile.
pub(crate) fn trace(flat: &FlatScene, spp: u32, options: &TraceOptions) -> TileSums {
    let rect = Rect {
        x: 0,
        y: 0,
        width: flat.camera.width,
        height: flat.camera.height,
    };
    let mut sums = TileSums::default();
    Tracer::new(flat, options).trace_tile(rect, 0..spp, &mut sums);
    let lost: u32 = sums.non_finite.iter().sum();
    assert_eq!(lost, 0, "samples that are not finite");
    sums
}
