//! Frames of one scene.

use super::lost::{self, NonFinite};
use super::metadata::{self, Samples, scene_hash};
use super::passes::{Deadline, Passes};
use super::pilot::{self, Verdict};
use super::{Canvas, Control, Ended, Settings, Share, Stages, Stats, tiles};
use crate::asset::AssetStore;
use crate::build::{BuildOptions, BuildTimes, SceneBuilder};
use crate::film::{Film, Metadata};
use crate::flat::{FlatScene, PixelFilter};
use crate::scene::{BackgroundDesc, FilterDesc, SceneDesc};
use crate::trace::{Tallies, TileSums, TraceOptions, Tracer};
use crate::world::{Time, pose};
use hecs::World;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::sync::{Mutex, PoisonError};
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

/// A frame whose samples are on a canvas.
#[derive(Clone, Debug)]
pub struct Traced {
    /// What made it.
    pub metadata: Metadata,
    /// What it cost.
    pub stats: Stats,
    /// As [`Rendering::non_finite`].
    pub non_finite: Vec<NonFinite>,
}

impl Traced {
    /// Puts the film together.
    #[must_use]
    pub fn finish(self, canvas: Canvas) -> Rendering {
        Rendering {
            film: canvas.into_film(),
            metadata: self.metadata,
            stats: self.stats,
            non_finite: self.non_finite,
        }
    }
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
        let threads = settings.threads.unwrap_or_else(rayon::current_num_threads);
        let pool = ThreadPoolBuilder::new().num_threads(threads).build()?;
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

    /// What the image of a frame says about how it was made, if every pixel has all samples; of a wanted error, without
    /// their number, which only rendering tells. What only one file format has, as a PNG its exposure, is the caller's to
    /// add.
    #[must_use]
    pub fn metadata(&self, frame: u32) -> Metadata {
        let settings = &self.settings;
        let spp = settings.noise.is_none().then_some(settings.spp);
        self.metadata_of(frame, Samples { spp, cut: false })
    }

    fn metadata_of(&self, frame: u32, samples: Samples) -> Metadata {
        metadata::metadata(&self.hash, frame, self.filter, &self.settings, samples)
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
        let canvas = Canvas::new(&self.settings, &Share::default());
        let traced = self.render_onto(frame, control, &canvas);
        traced.finish(canvas)
    }

    /// The same, while `watch` may ask for a copy of the film after each pass over the whole image; it is told the samples
    /// per pixel and the time that tracing has taken so far.
    pub fn render_watched(
        &mut self,
        frame: u32,
        control: &Control,
        mut watch: impl FnMut(&dyn Fn() -> Film, u32, Duration) + Send,
    ) -> Rendering {
        let canvas = Canvas::new(&self.settings, &Share::default());
        let mut watching = Duration::ZERO;
        let traced = self.render_by(frame, control, &canvas, |spp, spent| {
            let now = Instant::now();
            watch(&|| canvas.film(), spp, spent - watching);
            watching += now.elapsed();
        });
        traced.finish(canvas)
    }

    /// Adds to a canvas what it has not yet of a frame, or as much of it as [`Settings`] and `control` allow. It may be
    /// looked at meanwhile.
    pub fn render_onto(&mut self, frame: u32, control: &Control, canvas: &Canvas) -> Traced {
        self.render_by(frame, control, canvas, |_, _| ())
    }

    fn render_by(
        &mut self,
        frame: u32,
        control: &Control,
        canvas: &Canvas,
        watch: impl FnMut(u32, Duration) + Send,
    ) -> Traced {
        let deadline = self.settings.time.map(Deadline::after);
        control.begin();
        let (scene, times) = self.build(frame);
        let mut stats = self.trace(&scene, &self.settings, canvas, (control, deadline), watch);
        let non_finite = lost::find(canvas, &scene, frame, &self.settings.trace);
        self.builder.give_back(scene);
        stats.bytes = times.bytes;
        stats.stages = Stages {
            pose: times.pose,
            extract: times.extract,
            flatten: times.flatten,
            bvh: times.bvh,
            ..stats.stages
        };
        Traced {
            metadata: self.metadata_of(
                frame,
                Samples {
                    spp: Some(stats.spp),
                    cut: stats.ended == Ended::Time,
                },
            ),
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
        let canvas = Canvas::new(&settings, &Share::default());
        let limits = (&Control::default(), None);
        let stats = self.trace(scene, &settings, &canvas, limits, |_, _| ());
        (canvas.into_film(), stats)
    }

    fn trace(
        &self,
        scene: &FlatScene,
        settings: &Settings,
        canvas: &Canvas,
        (control, deadline): (&Control, Option<Deadline>),
        mut watch: impl FnMut(u32, Duration) + Send,
    ) -> Stats {
        let start = Instant::now();
        // Where samples are to go, nobody has written down.
        let known = canvas.verdict().filter(|_| !settings.is_adaptive());
        let mut goals = Vec::new();
        let verdict = settings.noise.map(|wanted| {
            known.unwrap_or_else(|| {
                let verdict;
                (verdict, goals) = self.ask_pilot(wanted, scene, control, deadline);
                canvas.trust(verdict);
                verdict
            })
        });
        let piloted = start.elapsed();
        canvas.set_goals(&goals);
        let end = canvas.end.unwrap_or(settings.spp);
        let mean = verdict.map_or(end, |verdict| verdict.spp);
        let goal = goals.iter().copied().max().unwrap_or(mean);
        let pilot = verdict.map_or(0, |verdict| verdict.pilot);
        let piloted_now = if known.is_some() { 0 } else { pilot };
        let pixels = u64::from(settings.size.0) * u64::from(settings.size.1);
        control.expect(pixels * u64::from(piloted_now) + canvas.missing(goal));
        let passes = Passes::new(canvas.done().0, goal, deadline);
        let watch = |spp| watch(spp, start.elapsed());
        let (complete, tracing) =
            self.run(scene, &settings.trace, canvas, (passes, control), watch);
        let all = complete >= goal;
        let mut stats = Stats {
            threads: self.pool.current_num_threads(),
            // A deadline ends before all samples too, but on purpose.
            stopped: control.stopped() && !all,
            spp: match goals.is_empty() {
                true => complete,
                false => canvas.spp(),
            },
            cells: goals.iter().min().map(|least| (*least, goal)),
            pilot,
            ended: match verdict {
                _ if !all => Ended::Time,
                Some(_) if mean < settings.spp => Ended::Noise,
                _ => Ended::Samples,
            },
            tracing,
            ..Stats::default()
        };
        stats.stages.pilot = piloted;
        stats.stages.trace = start.elapsed() - piloted;
        stats
    }

    /// How many samples the wanted error takes.
    fn ask_pilot(
        &self,
        wanted: f64,
        scene: &FlatScene,
        control: &Control,
        deadline: Option<Deadline>,
    ) -> (Verdict, Vec<u32>) {
        let settings = &self.settings;
        let options = pilot::options(&settings.trace);
        let canvas = Canvas::new(settings, &Share::default());
        let most = settings.spp;
        let run = |canvas: &Canvas, passes| {
            self.run(scene, &options, canvas, (passes, control), |_| ())
                .0
        };
        let wanted = (wanted, settings.is_adaptive());
        pilot::ask(wanted, most, settings.size, &canvas, control, deadline, run)
    }

    /// Traces passes on the threads; gives the samples that are complete, and what the stages cost.
    fn run(
        &self,
        scene: &FlatScene,
        options: &TraceOptions,
        canvas: &Canvas,
        (passes, control): (Passes, &Control),
        watch: impl FnMut(u32) + Send,
    ) -> (u32, Tallies) {
        let cost = Mutex::new(Tallies::default());
        let complete = self.pool.install(|| {
            tiles::run(&canvas.tiles, passes, control, watch, || {
                let (mut tracer, cost) = (Tracer::new(scene, options), &cost);
                move |rect, samples, sums: &mut TileSums| {
                    tracer.trace_tile(rect, samples, sums);
                    *cost.lock().unwrap_or_else(PoisonError::into_inner) += sums.cost;
                }
            })
        });
        let cost = cost.into_inner().unwrap_or_else(PoisonError::into_inner);
        (complete, cost)
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
        caustics: settings.trace.caustics,
    }
}
