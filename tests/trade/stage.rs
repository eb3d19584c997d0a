//! Scenes and films: the command line's way from a text to an image, without files.

use luxel::asset::Loader;
use luxel::film::Film;
use luxel::render::{Control, Renderer, Rendering, Settings};
use luxel::scene::SceneDesc;
use luxel::trace::{Sampler, TraceOptions};
use std::path::{Path, PathBuf};

/// A scene, and the size that it is rendered at.
pub(crate) struct Stage {
    pub(crate) name: String,
    desc: SceneDesc,
    size: (u32, u32),
    nee: bool,
}

/// What is asked of a render.
#[derive(Clone, Copy)]
pub(crate) struct Ask {
    pub(crate) spp: u32,
    pub(crate) noise: Option<f64>,
    pub(crate) adaptive: bool,
    pub(crate) seed: u64,
    pub(crate) sampler: Sampler,
    pub(crate) tile: u32,
    pub(crate) threads: usize,
}

impl Ask {
    pub(crate) fn new(spp: u32, seed: u64) -> Ask {
        Ask {
            spp,
            noise: None,
            adaptive: true,
            seed,
            sampler: Sampler::Sobol,
            tile: 16,
            threads: 2,
        }
    }
}

impl Stage {
    /// `body` is what stands inside `Scene( .. )` after the version.
    pub(crate) fn of(name: &str, body: &str, size: (u32, u32)) -> Stage {
        Stage::read(
            name,
            &format!("Scene(version: 1, {body})"),
            Path::new("."),
            size,
        )
    }

    fn read(name: &str, text: &str, place: &Path, size: (u32, u32)) -> Stage {
        match luxel::scene::parse(text, place) {
            Ok((desc, _)) => Stage {
                name: name.to_owned(),
                desc,
                size,
                nee: true,
            },
            Err(errors) => panic!("{name}: {errors:#?}"),
        }
    }

    /// A scene of the repository, `width` pixels wide.
    pub(crate) fn shipped(name: &str, width: u32) -> Stage {
        let path = folder().join(format!("{name}.ron"));
        let text = std::fs::read_to_string(&path).expect("a scene");
        let mut stage = Stage::read(name, &text, &path, (1, 1));
        let (w, h) = stage.desc.render.size;
        stage.size = (width, (width * h / w).max(1));
        stage
    }

    /// All scenes of the repository, likewise.
    pub(crate) fn all_shipped(width: u32) -> Vec<Stage> {
        let files = std::fs::read_dir(folder()).expect("scenes");
        let mut names: Vec<String> = files
            .filter_map(|file| {
                let path = file.expect("a file").path();
                let is_scene = path.extension().is_some_and(|e| e == "ron");
                is_scene.then(|| {
                    path.file_stem()
                        .expect("a name")
                        .to_string_lossy()
                        .into_owned()
                })
            })
            .collect();
        names.sort();
        names
            .iter()
            .map(|name| Stage::shipped(name, width))
            .collect()
    }

    /// With `--nee off`.
    pub(crate) fn without_light_samples(mut self) -> Stage {
        self.nee = false;
        self
    }

    /// Samples per pixel that the scene asks for.
    pub(crate) fn spp(&self) -> u32 {
        self.desc.render.spp
    }

    pub(crate) fn render(&self, ask: Ask) -> Rendering {
        let spawned = match luxel::world::spawn(&self.desc, Loader::new()) {
            Ok(spawned) => spawned,
            Err(errors) => panic!("{errors:#?}"),
        };
        let defaults = Settings::of_scene(&self.desc);
        let settings = Settings {
            size: self.size,
            spp: ask.spp,
            noise: ask.noise,
            adaptive: ask.adaptive,
            threads: Some(ask.threads),
            tile: ask.tile,
            trace: TraceOptions {
                seed: ask.seed,
                sampler: ask.sampler,
                nee: self.nee,
                ..defaults.trace
            },
            ..defaults
        };
        let renderer = Renderer::new(&self.desc, spawned.world, &spawned.assets, settings);
        renderer.expect("threads").render(0, &Control::default())
    }

    pub(crate) fn film(&self, ask: Ask) -> Film {
        self.render(ask).film
    }
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}
