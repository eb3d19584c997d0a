//! Frames of one scene.

use super::lost::{self, NonFinite};
use super::metadata::{self, scene_hash};
use super::passes::{Deadline, Passes};
use super::pilot::{self, Verdict};
use super::tiles::{self, Tile};
use super::{Control, Ended, Settings, Stages, Stats};
use crate::asset::AssetStore;
use crate::build::{BuildOptions, BuildTimes, SceneBuilder};
use crate::film::{Blocks, Film, Metadata, Planes, Window};
use crate::flat::{FlatScene, PixelFilter};
use crate::scene::{BackgroundDesc, FilterDesc, SceneDesc};
use crate::trace::{Rect, TileSums, TraceOptions, Tracer};
use crate::world::{Time, pose};
use hecs::World;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::time::{Duration, Instant};

/// A rendered frame.
#[derive(Clone, Debug)]
pub struct Rendering {
    /// The sums.
    pub film: Film,
    /// What made it.
    pub metadata: Metadata,
    /// What it cost.
    pub stats: Stats,
    /// Samples that the film left out because they are not finite: of all that [`Film::total_non_finite`] counts, the
    /// first by row, column and index.
    pub non_finite: Vec<NonFinite>,
}

/// Renders frames of a scene on threads of its own. Geometry that no frame changes is kept from one to the next.
pub struct Renderer {
    world: World,
    builder: SceneBuilder,
    pool: ThreadPool,
    hash: String,
    fps: f64,
    filter: PixelFilter,
    settings: Settings,
}

impl Renderer {
    /// Prepares to render `world`, which was spawned from `desc` with the files of `store`.
    ///
    /// # Errors
    /// If the threads cannot be started.
    pub fn new(
        desc: &SceneDesc,
        world: World,
        store: &AssetStore,
        settings: Settings,
    ) -> Result<Renderer, ThreadPoolBuildError> {
        // 0 lets rayon ask the machine.
        let pool = ThreadPoolBuilder::new()
            .num_threads(settings.threads.unwrap_or(0))
            .build()?;
        let options = build_options(desc, &settings);
        Ok(Renderer {
            filter: options.filter,
            builder: SceneBuilder::new(&world, store, options),
            world,
            pool,
            hash: scene_hash(desc, store),
            fps: desc.animation.fps,
            settings,
        })
    }

    /// Starts anew with other settings on the same threads: the next build is a first one. `desc` and `store` are those
    /// that it was made with.
    pub fn change(&mut self, desc: &SceneDesc, store: &AssetStore, settings: Settings) {
        let options = build_options(desc, &settings);
        self.filter = options.filter;
        self.builder = SceneBuilder::new(&self.world, store, options);
        self.settings = settings;
    }

    /// SHA-256 of the scene and of every file that it names, in hexadecimal.
    #[must_use]
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// What frames are rendered with.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// How many threads work.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// Gives the world back.
    #[must_use]
    pub fn into_world(self) -> World {
        self.world
    }

    /// What the image of a frame says about how it was made, if every pixel has all samples. What only one file format
    /// has, as a PNG its exposure, is the caller's to add.
    #[must_use]
    pub fn metadata(&self, frame: u32) -> Metadata {
        self.metadata_of(frame, self.settings.spp)
    }

    fn metadata_of(&self, frame: u32, spp: u32) -> Metadata {
        metadata::metadata(&self.hash, frame, self.filter, &self.settings, spp)
    }

    /// Poses the world at `frame / fps` seconds and builds what tracing reads.
    pub fn build(&mut self, frame: u32) -> (FlatScene, BuildTimes) {
        let start = Instant::now();
        pose(&mut self.world, Time::of_frame(frame, self.fps));
        let posing = start.elapsed();
        let (world, builder) = (&self.world, &mut self.builder);
        let noise = if self.settings.fixed_noise { 0 } else { frame };
        let (scene, mut times) = self.pool.install(|| builder.build(world, noise));
        times.pose = posing;
        (scene, times)
    }

    /// Builds a frame that nobody looks at: what it costs to come to it from the one before.
    pub fn update(&mut self, frame: u32) -> BuildTimes {
        let (scene, times) = self.build(frame);
        self.builder.give_back(scene);
        times
    }

    /// Renders a frame, or as much of it as [`Settings`] and `control` allow.
    pub fn render(&mut self, frame: u32, control: &Control) -> Rendering {
        self.render_by(frame, control, |_, _, _| ())
    }

    /// The same, while `watch` sees the film after each pass over the whole image, with the samples per pixel and the time
    /// that tracing has taken so far.
    pub fn render_watched(
        &mut self,
        frame: u32,
        control: &Control,
        mut watch: impl FnMut(&Film, u32, Duration) + Send,
    ) -> Rendering {
        let (width, height) = self.settings.size;
        let mut watching = Duration::ZERO;
        self.render_by(frame, control, |tiles, spp, spent| {
            let now = Instant::now();
            let film = assemble(width, height, tiles.iter().cloned());
            watch(&film, spp, spent - watching);
            watching += now.elapsed();
        })
    }

    fn render_by(
        &mut self,
        frame: u32,
        control: &Control,
        watch: impl FnMut(&[Tile], u32, Duration) + Send,
    ) -> Rendering {
        let deadline = self.settings.time.map(Deadline::after);
        let (scene, times) = self.build(frame);
        let (film, non_finite, mut stats) =
            self.trace(&scene, &self.settings, frame, (control, deadline), watch);
        self.builder.give_back(scene);
        stats.bytes = times.bytes;
        stats.stages = Stages {
            pose: times.pose,
            extract: times.extract,
            flatten: times.flatten,
            bvh: times.bvh,
            ..stats.stages
        };
        Rendering {
            film,
            metadata: self.metadata_of(frame, stats.spp),
            stats,
            non_finite,
        }
    }

    /// Traces what [`Renderer::build`] gave, or another renderer's: for those who trace a build with one setting after
    /// the other. Of `settings`, only samples, tile and the dials of tracing count: size and tree are the build's,
    /// threads the renderer's.
    pub fn trace_built(&self, scene: &FlatScene, settings: &Settings) -> (Film, Stats) {
        let settings = Settings {
            size: (scene.camera.width, scene.camera.height),
            noise: None,
            ..settings.clone()
        };
        let limits = (&Control::default(), None);
        let (film, _, stats) = self.trace(scene, &settings, scene.frame, limits, |_, _, _| ());
        (film, stats)
    }

    fn trace(
        &self,
        scene: &FlatScene,
        settings: &Settings,
        frame: u32,
        (control, deadline): (&Control, Option<Deadline>),
        mut watch: impl FnMut(&[Tile], u32, Duration) + Send,
    ) -> (Film, Vec<NonFinite>, Stats) {
        let (width, height) = settings.size;
        let start = Instant::now();
        let verdict = settings
            .noise
            .map(|wanted| self.ask_pilot(wanted, scene, control, deadline));
        let piloted = start.elapsed();
        let goal = verdict.map_or(settings.spp, |verdict| verdict.spp);
        let pilot = verdict.map_or(0, |verdict| verdict.pilot);
        let pixels = u64::from(width) * u64::from(height);
        control.expect(pixels * (u64::from(pilot) + u64::from(goal)));
        let mut tiles = tiles::cut(settings.size, settings.tile, settings.trace.sampler);
        let passes = Passes::new(0, goal, deadline);
        let watch = |tiles: &[Tile], spp| watch(tiles, spp, start.elapsed());
        let spp = self.run(scene, &settings.trace, &mut tiles, (passes, control), watch);
        let mut stats = Stats {
            threads: self.pool.current_num_threads(),
            // A deadline ends before all samples too, but on purpose.
            stopped: control.stopped() && spp < goal,
            spp,
            pilot,
            ended: match verdict {
                _ if spp < goal => Ended::Time,
                Some(_) if goal < settings.spp => Ended::Noise,
                _ => Ended::Samples,
            },
            ..Stats::default()
        };
        stats.stages.pilot = piloted;
        stats.stages.trace = start.elapsed() - piloted;
        for tile in &tiles {
            stats.closest_rays += tile.sums.rays[0];
            stats.occlusion_rays += tile.sums.rays[1];
        }
        let non_finite = lost::find(&tiles, scene, frame, &settings.trace);
        (assemble(width, height, tiles), non_finite, stats)
    }

    /// How many samples the wanted error takes.
    fn ask_pilot(
        &self,
        wanted: f64,
        scene: &FlatScene,
        control: &Control,
        deadline: Option<Deadline>,
    ) -> Verdict {
        let settings = &self.settings;
        let options = pilot::options(&settings.trace);
        let tiles = tiles::cut(settings.size, settings.tile, options.sampler);
        let most = settings.spp;
        let run = |tiles: &mut [Tile], passes| {
            self.run(scene, &options, tiles, (passes, control), |_, _| ())
        };
        pilot::ask(wanted, most, settings.size, tiles, control, deadline, run)
    }

    /// Traces passes on the threads; gives the samples that are complete.
    fn run(
        &self,
        scene: &FlatScene,
        options: &TraceOptions,
        tiles: &mut [Tile],
        (passes, control): (Passes, &Control),
        watch: impl FnMut(&[Tile], u32) + Send,
    ) -> u32 {
        self.pool.install(|| {
            tiles::run(tiles, passes, control, watch, || {
                let mut tracer = Tracer::new(scene, options);
                move |rect, samples, sums: &mut _| tracer.trace_tile(rect, samples, sums)
            })
        })
    }
}

fn build_options(desc: &SceneDesc, settings: &Settings) -> BuildOptions {
    BuildOptions {
        accel: settings.accel,
        quality: settings.quality,
        size: settings.size,
        filter: match desc.render.filter {
            FilterDesc::Box => PixelFilter::Box,
            FilterDesc::Gaussian { radius_px } => PixelFilter::Gaussian(radius_px as f32),
        },
        background: match desc.background {
            BackgroundDesc::Linear(color) => color.map(|c| c as f32),
            // The world has it.
            BackgroundDesc::Hdr(_) => [0.0; 3],
        },
        uv_aov: settings.trace.ids,
        fresnel: settings.trace.fresnel,
    }
}

/// Puts tiles together, one after the other, so that their memory is given back on the way.
pub(super) fn assemble(width: u32, height: u32, tiles: impl IntoIterator<Item = Tile>) -> Film {
    let mut film = Film::new(width, height);
    for tile in tiles {
        if !tile.sums.count.is_empty() {
            film.put(window(tile.rect), &planes(tile.sums, tile.blocks));
        }
    }
    film
}

fn window(rect: Rect) -> Window {
    Window {
        x: rect.x,
        y: rect.y,
        width: rect.width,
        height: rect.height,
    }
}

/// Moves the arrays: tracing may not know the film, nor the film tracing.
fn planes(sums: TileSums, blocks: Option<Blocks>) -> Planes {
    Planes {
        rgb: sums.rgb,
        rgb_squared: sums.rgb_squared,
        gains: blocks.map(Blocks::means).unwrap_or_default(),
        count: sums.count,
        non_finite: sums.non_finite,
        hit_count: sums.hit_count,
        albedo: sums.albedo,
        normal: sums.normal,
        geonormal: sums.geonormal,
        depth: sums.depth,
        uv: sums.uv,
        prim: sums.prim,
        entity: sums.entity,
    }
}
