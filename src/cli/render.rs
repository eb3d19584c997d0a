//! `luxel render`.

use super::args::RenderArgs;
use super::failure::Failure;
use super::output::{Encoding, Output, check_writable};
use super::part::Part;
use super::progress::{Finished, Progress, Watcher, Work, words};
use super::stats::{Account, lost};
use super::tuned::Tuned;
use super::versus::Versus;
use super::{advice, diagnostics, finish, interrupt, load, print_result, replay, say};
use crate::film;
use crate::render::{Canvas, Control, Rendering, Settings, Traced};
use crate::scene::{RenderDesc, SceneDesc};
use std::ffi::OsStr;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// Renders one frame and writes it.
pub(crate) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let start = Instant::now();
    let tuned = Tuned::read(args)?;
    let args = tuned.as_ref().map_or(args, |tuned| &tuned.args);
    if let Some(named) = args.replay.replay {
        let (loaded, _) = load::scene(&args.scene, args.dials.max_memory)?;
        let settings = settings(args, &loaded.desc);
        return replay::run(loaded, settings, named);
    }
    let output = Output::choose(args.output.as_deref(), &args.scene, &args.dials.aov)?;
    if let Some(path) = &args.stats {
        check_stats(path)?;
    }
    let control = Arc::new(Control::default());
    interrupt::listen(&control);
    let mut progress = Progress::start(args.progress);
    let (loaded, warnings) = load::scene(&args.scene, args.dials.max_memory)?;
    // If nobody listens on stderr, so be it.
    let _ = diagnostics::print(&warnings);
    if args.dials.strict {
        Failure::if_any(&warnings)?;
    }
    if !args.dials.nee.is_on() && loaded.has_punctual_lights() {
        say("warning: with --nee off, lights without extent (`light: ..`) do not shine");
    }
    let mut settings = settings(args, &loaded.desc);
    let time = settings.time.map(|time| {
        let after = finish::takes(settings.size, output.format, &args.dials.aov);
        time.saturating_sub(start.elapsed() + after)
    });
    settings.time = time;
    let mut versus = match &args.goal.vs {
        Some(reference) => Some(Versus::start(reference, &output, settings.size)?),
        None => None,
    };
    let part = Part::plan(args, &output, &settings)?;
    let files = loaded.memory();
    let mut renderer = loaded.renderer(settings)?;
    if let Some(tuned) = &tuned {
        tuned.warn_if_stale(renderer.hash());
    }
    let load = start.elapsed();
    let (width, height) = renderer.settings().size;
    let pixels = u64::from(width) * u64::from(height);
    progress.begin(Work {
        control: Arc::clone(&control),
        limit: time,
        frames: vec![args.frame],
        pixels,
    });
    let rendering = match &part {
        Some(part) => {
            let canvas = part.canvas(&renderer, args.frame)?;
            let traced = part.render(&mut renderer, args.frame, &control, &canvas)?;
            if !part.is_whole() {
                progress.end();
                return tell_share(args, part, &canvas, &traced);
            }
            traced.finish(canvas)
        }
        None => {
            let mut watcher = Watcher::of(&progress, pixels);
            renderer.render_watched(args.frame, &control, |film, spp, time| {
                watcher.look(film);
                if let Some(versus) = &mut versus {
                    versus.look(&film(), spp, time);
                }
            })
        }
    };
    progress.end();
    let encoding = Encoding::new(
        output.format,
        rendering.metadata.clone(),
        args.dials.exposure,
        &args.dials.aov,
    );
    if rendering.stats.stopped {
        return Err(write_partial(&output, &rendering, &encoding));
    }
    let writing = Instant::now();
    match part {
        None => output.write(&rendering.film, &encoding)?,
        Some(_) => output.write_again(&rendering.film, &encoding)?,
    }
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
        isa: args.dials.isa().level().to_string(),
        tree: args.dials.tree.name(),
        advice: None,
    };
    account.advice = advice::of(&account, renderer.settings());
    progress.finished(&Finished {
        frame: args.frame,
        path: &account.output,
        rel_err: account.error.as_ref().map(|bar| bar.relative),
        took: start.elapsed(),
    });
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
    if let Some(advice) = &account.advice {
        say(&format!("what would help most: {advice}"));
    }
    if let Some(doubt) = account.doubt() {
        say(&format!("warning: {doubt}"));
    }
    match account.lost() {
        None => Ok(()),
        Some(lost) if args.dials.strict => Err(Failure::lost_samples(lost, LOST_HINT)),
        Some(lost) => {
            say(&format!("warning: {lost}\n  = help: {LOST_HINT}"));
            Ok(())
        }
    }
}

/// The path on stdout, and on stderr what to do with a share.
fn tell_share(
    args: &RenderArgs,
    part: &Part,
    canvas: &Canvas,
    traced: &Traced,
) -> Result<(), Failure> {
    print_result(format!("{}\n", part.path.display()).as_bytes())?;
    say(&format!(
        "{} · trace {} · {:.1} Mrays/s · `luxel merge` makes an image of all shares",
        part.path.display(),
        words(traced.stats.stages.trace),
        traced.stats.mrays_per_second(),
    ));
    let count = canvas.patches().map(|patch| patch.non_finite_samples());
    match lost(count.sum(), &traced.non_finite) {
        None => Ok(()),
        Some(lost) if args.dials.strict => Err(Failure::lost_samples(lost, LOST_HINT)),
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
    // With another end, as many samples as that takes.
    let endless = args.time.map(|_| RenderDesc::MAX_SPP);
    let noise = args.goal.noise;
    Settings {
        time: args.time,
        ..args.dials.settings_to(desc, args.spp.or(endless), noise)
    }
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
