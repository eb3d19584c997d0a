//! `luxel turntable`.

use super::author_args::TurntableArgs;
use super::failure::Failure;
use super::frames::{Frames, Output, Turn};
use super::progress::{Progress, Work, words};
use super::{diagnostics, interrupt, say, start, stats};
use crate::author::{self, Turntable};
use crate::render::{Control, Renderer, Settings};
use crate::scene::{self, RenderDesc};
use crate::world;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What to do about samples that are not finite.
const LOST_HINT: &str = "write the scene by `--scene FILE`: then `luxel render FILE --replay FRAME,X,Y,SAMPLE` shows how one \
    came about";

/// Renders a mesh that turns once.
pub(crate) fn run(args: &TurntableArgs) -> Result<(), Failure> {
    let launched = Instant::now();
    let turn = Turn::of(args.frames, args.seconds);
    let asked = args.gif.as_deref().or(args.output.as_deref());
    let default = with_suffix(args.mesh.file_stem(), "gif");
    let output = Output::choose(asked, default, args.size, &turn)?;
    if let Some(scene) = &args.scene {
        start::check_scene(scene)?;
    }
    let control = Arc::new(Control::of_frames(turn.frames));
    interrupt::listen(&control);
    let progress = Progress::start(args.progress);
    let mut renderer = renderer(args, &turn)?;
    let mut frames = Frames::new(output, &turn);
    let (mut lost, mut named, mut spp) = (0, Vec::new(), Vec::new());
    let mut beside = Duration::ZERO;
    progress.begin(Work {
        control: Arc::clone(&control),
        limit: None,
        frames: (0..turn.frames).collect(),
        pixels: u64::from(args.size.0) * u64::from(args.size.1),
    });
    for frame in 0..turn.frames {
        let rendering = renderer.render(frame, &control);
        if rendering.stats.stopped {
            break;
        }
        let traced = Instant::now();
        frames.add(frame, &rendering)?;
        beside += rendering.stats.stages.beside_tracing() + traced.elapsed();
        spp.push(rendering.stats.spp);
        lost += rendering.film.total_non_finite();
        named.extend(rendering.non_finite);
    }
    drop(progress);
    if let Some(lost) = stats::lost(lost, &named) {
        say(&format!("warning: {lost}\n  = help: {LOST_HINT}"));
    }
    let writing = Instant::now();
    let finished = frames.finish()?;
    beside += writing.elapsed();
    if control.stopped() && finished.count < turn.frames {
        let told = finished.path.unwrap_or_else(|| "nothing".to_owned());
        say(&format!(
            "stopped; {told} has {} of {} frames",
            finished.count, turn.frames
        ));
        return Err(Failure::stopped());
    }
    let (width, height) = args.size;
    let path = finished.path.unwrap_or_default();
    say(&format!(
        "{path} · {width}×{height} · {} frames · {} · {}; beside tracing, {} a frame",
        turn.frames,
        stats::spp_of_all(&spp),
        words(launched.elapsed()),
        words(beside.checked_div(turn.frames).unwrap_or_default())
    ));
    Ok(())
}

/// Reads the mesh, makes the scene, and writes it if asked to.
fn renderer(args: &TurntableArgs, turn: &Turn) -> Result<Renderer, Failure> {
    let place = scene_path(args);
    let mesh = start::mesh(&args.mesh, args.max_memory)?;
    let wanted = Turntable {
        path: start::path_from(&place, &args.mesh)?,
        gltf: matches!(mesh.what, start::What::Model(_)),
        up: args.up.into(),
        size: args.size,
        spp: args.spp,
        frames: turn.frames,
        seconds: turn.seconds,
    };
    let desc = author::turntable(&mesh.points, &wanted).map_err(|e| {
        // They may say why there is nothing to place.
        let _ = diagnostics::print(mesh.loader.warnings());
        Failure::bad_file(format!("cannot place \"{}\": {e}", args.mesh.display()))
    })?;
    let text = format!("{}{}", header(args, &place), scene::write(&desc));
    if args.scene.is_some() {
        start::write_scene(&place, &text)?;
        say(&format!(
            "{0}: the scene; render it with: luxel render {0} --frame 0",
            place.display()
        ));
    }
    // The frames are those of the text: what is written renders to the same bytes.
    let (desc, _) = scene::parse(&text, &place).map_err(Failure::scene)?;
    let spawned = world::spawn(&desc, mesh.loader).map_err(Failure::scene)?;
    // If nobody listens on stderr, so be it.
    let _ = diagnostics::print(&spawned.warnings);
    let own = Settings::of_scene(&desc);
    let settings = Settings {
        noise: args.noise,
        // In its place, as many as the error takes.
        spp: args.noise.map_or(own.spp, |_| RenderDesc::MAX_SPP),
        threads: args.threads.map(usize::from),
        ..own
    };
    Renderer::new(&desc, spawned.world, &spawned.assets, settings).map_err(|e| Failure::threads(&e))
}

/// Where the scene stands, or would stand: beside the mesh, so that its text does not depend on the current folder.
fn scene_path(args: &TurntableArgs) -> PathBuf {
    match &args.scene {
        Some(path) => path.clone(),
        None => {
            let name = with_suffix(args.mesh.file_stem(), "turntable.ron");
            args.mesh.with_file_name(name)
        }
    }
}

/// What a person should know who opens the scene.
fn header(args: &TurntableArgs, place: &Path) -> String {
    let name = |path: &Path| {
        path.file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .replace(char::is_control, "?")
    };
    format!(
        "// {} on a turntable: the hub turns once, the mesh stands on it, ten units high or wide.\n\
         // The floor is a sphere so large that it passes for a plane, of the background's tone; the key light is far away.\n\
         //     luxel render {} --frame 0\n",
        name(&args.mesh),
        name(place)
    )
}

/// `STEM.suffix`.
fn with_suffix(stem: Option<&OsStr>, suffix: &str) -> PathBuf {
    let mut name = stem.unwrap_or(OsStr::new("turntable")).to_owned();
    name.push(".");
    name.push(suffix);
    PathBuf::from(name)
}
