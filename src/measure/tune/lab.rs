//! The laboratory: builds of the scene, kept, and pictures of them, timed.

use super::dials::Dials;
use crate::asset::AssetStore;
use crate::build::{Accel, Quality};
use crate::flat::{FlatScene, Fresnel, Needs};
use crate::measure::bench::clock;
use crate::render::{Renderer, Settings};
use crate::scene::SceneDesc;
use std::time::{Duration, Instant};

/// Side of a tile: small pictures must have tiles enough for all threads.
const TILE: u32 = 16;

/// Longer than any budget, and still a time that a clock can be asked for.
const MOST_SECONDS: f64 = 1e9;

/// What a build depends on.
type Key = ((u32, u32), Accel, Quality, Fresnel);

/// A build, and the CPU seconds that it took.
struct Built {
    key: Key,
    scene: FlatScene,
    seconds: f64,
}

/// A picture.
pub(super) struct Shot {
    /// Linear light by rows from the top.
    pub(super) pixels: Vec<[f32; 3]>,
    /// CPU seconds of tracing.
    pub(super) seconds: f64,
}

/// Makes pictures.
pub(super) struct Lab<'a> {
    renderer: &'a mut Renderer,
    desc: &'a SceneDesc,
    store: &'a AssetStore,
    settings: Settings,
    frame: u32,
    built: Vec<Built>,
    threads: usize,
    /// Wall and CPU seconds of all pictures so far, to tell what the next will take.
    spent: [f64; 2],
}

impl<'a> Lab<'a> {
    /// A laboratory for the scene of a renderer, whose settings are those of exact pictures.
    pub(super) fn new(
        renderer: &'a mut Renderer,
        desc: &'a SceneDesc,
        store: &'a AssetStore,
        frame: u32,
    ) -> Lab<'a> {
        Lab {
            settings: renderer.settings().clone(),
            threads: renderer.threads(),
            renderer,
            desc,
            store,
            frame,
            built: Vec::new(),
            spent: [0.0; 2],
        }
    }

    /// What the scene requires, and how many primitives it has.
    pub(super) fn needs(&mut self, size: (u32, u32), dials: &Dials) -> (Needs, usize) {
        let which = self.build(size, dials);
        let scene = &self.built[which].scene;
        let locals = scene.local.iter().map(|g| &g.shading);
        let triangles: usize = locals
            .chain([&scene.world.shading])
            .map(|shading| shading.material.len())
            .sum();
        (scene.needs, triangles + scene.spheres.placed.len())
    }

    /// Index of a build; made if there is none yet, as a first frame's.
    fn build(&mut self, size: (u32, u32), dials: &Dials) -> usize {
        let key = (size, dials.accel, dials.quality, dials.fresnel);
        let known = self.built.iter().position(|b| b.key == key);
        known.unwrap_or_else(|| {
            let mut settings = self.settings.clone();
            dials.put(&mut settings);
            settings.size = size;
            self.renderer.change(self.desc, self.store, settings);
            let start = clock::of_all_threads(self.threads);
            let (scene, _) = self.renderer.build(self.frame);
            let seconds = self.since(start);
            self.built.push(Built {
                key,
                scene,
                seconds,
            });
            self.built.len() - 1
        })
    }

    fn since(&self, start: Duration) -> f64 {
        let spent = clock::of_all_threads(self.threads).saturating_sub(start);
        spent.as_secs_f64()
    }

    /// CPU seconds of the build that `dials` need.
    pub(super) fn build_seconds(&self, size: (u32, u32), dials: &Dials) -> f64 {
        let key = (size, dials.accel, dials.quality, dials.fresnel);
        let known = self.built.iter().find(|b| b.key == key);
        known.map_or(0.0, |b| b.seconds)
    }

    /// Whether work of some CPU seconds will be over in time, at the pace of all pictures so far: a CPU second is less
    /// than a second of the clock with many threads, more on a busy machine.
    pub(super) fn fits(&self, seconds: f64, until: Instant) -> bool {
        let pace = self.spent[0] / self.spent[1].max(f64::MIN_POSITIVE);
        Instant::now() + Duration::from_secs_f64((seconds * pace).min(MOST_SECONDS)) <= until
    }

    /// CPU seconds that there are until then, at the pace of all pictures so far.
    pub(super) fn seconds_until(&self, until: Instant) -> f64 {
        let left = until.saturating_duration_since(Instant::now());
        left.as_secs_f64() * self.spent[1] / self.spent[0].max(f64::MIN_POSITIVE)
    }

    /// Gives back the memory of builds of a size.
    pub(super) fn forget(&mut self, size: (u32, u32)) {
        self.built.retain(|b| b.key.0 != size);
    }

    /// Renders a picture.
    pub(super) fn shoot(&mut self, dials: &Dials, size: (u32, u32), spp: u32, seed: u64) -> Shot {
        let which = self.build(size, dials);
        let mut settings = self.settings.clone();
        dials.put(&mut settings);
        settings.spp = spp;
        settings.tile = TILE;
        settings.trace.seed = seed;
        let (wall, cpu) = (Instant::now(), clock::of_all_threads(self.threads));
        let (film, _) = (self.renderer).trace_built(&self.built[which].scene, &settings);
        let seconds = self.since(cpu);
        self.spent[0] += wall.elapsed().as_secs_f64();
        self.spent[1] += seconds;
        Shot {
            pixels: film.radiance(),
            seconds,
        }
    }
}
