//! `luxel render`.

use super::args::RenderArgs;
use super::failure::Failure;
use super::output::{Encoding, Format, Output, check_writable};
use super::progress::Progress;
use super::stats::Account;
use super::versus::Versus;
use super::{advice, diagnostics, interrupt, load, print_result, replay, say};
use crate::film;
use crate::math;
use crate::render::{Control, Rendering, Settings};
use crate::scene::{RenderDesc, SceneDesc};
use crate::trace::TraceOptions;
use crate::trace::isa::Isa;
use std::ffi::OsStr;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// Renders one frame and writes it.
pub(crate) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let start = Instant::now();
    if let Some(named) = args.replay.replay {
        let (loaded, _) = load::scene(&args.scene, args.max_memory)?;
        let settings = settings(args, &loaded.desc);
        return replay::run(loaded, settings, named);
    }
    let output = Output::choose(args.output.as_deref(), &args.scene, &args.aov)?;
    if let Some(path) = &args.stats {
        check_stats(path)?;
    }
    let control = Arc::new(Control::default());
    interrupt::listen(&control);
    let (loaded, warnings) = load::scene(&args.scene, args.max_memory)?;
    // If nobody listens on stderr, so be it.
    let _ = diagnostics::print(&warnings);
    if args.strict {
        Failure::if_any(&warnings)?;
    }
    if !args.nee.is_on() && loaded.has_punctual_lights() {
        say("warning: with --nee off, lights without extent (`light: ..`) do not shine");
    }
    let mut settings = settings(args, &loaded.desc);
    let time = settings
        .time
        .map(|time| time.saturating_sub(start.elapsed()));
    settings.time = time;
    let mut versus = match &args.goal.vs {
        Some(reference) => Some(Versus::start(reference, &output, settings.size)?),
        None => None,
    };
    let files = loaded.memory();
    let mut renderer = loaded.renderer(settings)?;
    let load = start.elapsed();
    let rendering = {
        let _bar = Progress::start(&control, time);
        match &mut versus {
            None => renderer.render(args.frame, &control),
            Some(versus) => renderer.render_watched(args.frame, &control, |film, spp, time| {
                versus.look(film, spp, time);
            }),
        }
    };
    let mut encoding = Encoding {
        gain: math::pow(2.0, args.exposure),
        aovs: &args.aov,
        metadata: rendering.metadata.clone(),
    };
    if output.format == Format::Png {
        encoding.metadata.push("exposure", args.exposure);
    }
    if rendering.stats.stopped {
        return Err(write_partial(&output, &rendering, &encoding));
    }
    let writing = Instant::now();
    output.write(&rendering.film, &encoding)?;
    let mut account = Account {
        output: output.to_string(),
        film: &rendering.film,
        error: rendering.film.error(),
        goal: args.goal.noise,
        non_finite: &rendering.non_finite,
        stats: rendering.stats,
        load,
        files,
        write: writing.elapsed(),
        isa: isa(args).level().to_string(),
        tree: args.tree.name(),
        advice: String::new(),
    };
    account.advice = advice::of(&account, args.tree.into());
    tell(args, &output, &account)?;
    match versus {
        None => Ok(()),
        Some(versus) => print_result(versus.finish(&args.scene.display().to_string())?.as_bytes()),
    }
}

/// The path on stdout, what it cost on stderr and in the file of `--stats`.
fn tell(args: &RenderArgs, output: &Output, account: &Account<'_>) -> Result<(), Failure> {
    if let Some(path) = &args.stats {
        film::write_file(path, account.json().as_bytes())
            .map_err(|e| Failure::io(format!("\"{}\"", path.display()), &e))?;
    }
    if output.path.is_some() {
        print_result(format!("{output}\n").as_bytes())?;
    }
    say(&account.line());
    say(&format!("what would help most: {}", account.advice));
    if let Some(doubt) = account.doubt() {
        say(&format!("warning: {doubt}"));
    }
    match account.lost() {
        None => Ok(()),
        Some(lost) if args.strict => Err(Failure::lost_samples(lost, LOST_HINT)),
        Some(lost) => {
            say(&format!("warning: {lost}\n  = help: {LOST_HINT}"));
            Ok(())
        }
    }
}

/// What to do about samples that are not finite.
const LOST_HINT: &str =
    "`--replay FRAME,X,Y,SAMPLE` with the same options shows how one came about";

/// Saves what there is of a render that was stopped. Returns the failure to end with.
fn write_partial(output: &Output, rendering: &Rendering, encoding: &Encoding<'_>) -> Failure {
    let samples = rendering.film.total_samples();
    let Some(partial) = output.partial().filter(|_| samples > 0) else {
        say("stopped; there was nothing to save");
        return Failure::stopped();
    };
    if let Err(failure) = partial.write(&rendering.film, encoding) {
        return failure;
    }
    let mean = samples as f64 / rendering.film.pixels() as f64;
    say(&format!(
        "stopped; {partial} has {mean:.1} samples per pixel"
    ));
    if let Err(failure) = print_result(format!("{partial}\n").as_bytes()) {
        return failure;
    }
    Failure::stopped()
}

/// The scene's settings, overridden by the arguments.
fn settings(args: &RenderArgs, desc: &SceneDesc) -> Settings {
    let defaults = Settings::of_scene(desc);
    Settings {
        size: args.size.unwrap_or(defaults.size),
        spp: args.spp.unwrap_or(match (args.goal.noise, args.time) {
            (None, None) => defaults.spp,
            _ => RenderDesc::MAX_SPP,
        }),
        noise: args.goal.noise,
        time: args.time,
        threads: args.threads.map(usize::from),
        tile: args.tile,
        accel: args.accel.into(),
        quality: args.tree.into(),
        trace: TraceOptions {
            max_bounces: args.bounces.unwrap_or(defaults.trace.max_bounces),
            seed: args.seed,
            sampler: args.sampler.into(),
            nee: args.nee.is_on(),
            mis: args.mis.is_on(),
            roulette: args.roulette.is_on(),
            fresnel: args.fresnel.into(),
            isa: isa(args),
            features: args.aov.iter().any(|aov| aov.is_feature()),
            ids: args.aov.iter().any(|aov| aov.is_id()),
        },
    }
}

fn isa(args: &RenderArgs) -> Isa {
    args.isa.unwrap_or_else(Isa::best)
}

/// Other suffixes are refused, so that `--stats room.ron` does not cost anyone a scene.
fn check_stats(path: &Path) -> Result<(), Failure> {
    if path.extension() != Some(OsStr::new("json")) {
        return Err(Failure::usage(
            format!("\"{}\" is no JSON file", path.display()),
            "end the name of --stats in .json",
        ));
    }
    check_writable(path)
}
