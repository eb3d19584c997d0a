//! `luxel tune`.

use super::failure::Failure;
use super::output::check_writable;
use super::progress::words;
use super::tune_args::TuneArgs;
use super::{diagnostics, load, print_result, say, tuned};
use crate::film;
use crate::measure::tune::{
    Estimate, Goal, Pick, Plan, Quality, Report, Row, Stage, choose, report, run as measure,
};
use crate::render::{Renderer, Settings};
use serde_json::{Value, json};
use std::ffi::OsStr;
use std::path::Path;
use std::time::{Duration, Instant};

/// What is left of the budget for the choice and for writing.
const REST: f64 = 0.02;

/// Measures the trade of a scene, and prints, draws and writes what came of it.
pub(crate) fn run(args: &TuneArgs) -> Result<(), Failure> {
    let start = Instant::now();
    let output = args.output.clone();
    let output = output.unwrap_or_else(|| tuned::path_of(&args.scene));
    if output.extension() != Some(OsStr::new("json")) {
        return Err(Failure::usage(
            format!("\"{}\" is no JSON file", output.display()),
            "end its name in .json",
        ));
    }
    let (loaded, warnings) = load::scene(&args.scene, args.max_memory)?;
    for path in args.csv.iter().chain(&args.svg).chain([&output]) {
        check_writable(path)?;
    }
    // If nobody listens on stderr, so be it.
    let _ = diagnostics::print(&warnings);
    let (desc, world, assets) = loaded.into_parts();
    let defaults = Settings::of_scene(&desc);
    let settings = Settings {
        size: args.size.unwrap_or(defaults.size),
        threads: args.threads.map(usize::from),
        ..defaults
    };
    let plan = Plan {
        frame: args.frame,
        deadline: start + args.budget.mul_f64(1.0 - REST),
        goals: goals(args),
    };
    let mut renderer =
        Renderer::new(&desc, world, &assets, settings).map_err(|e| Failure::threads(&e))?;
    let found = measure(
        &mut renderer,
        &desc,
        &assets,
        &plan,
        teller(start, args.budget),
    );
    let found = found.ok_or_else(|| {
        Failure::usage(
            format!("{} are too short for this scene", words(args.budget)),
            "give it more: --budget 5m, or tune a smaller picture: --size",
        )
    })?;
    let picks: Vec<Pick> = (plan.goals.iter())
        .filter_map(|goal| choose(&found, *goal))
        .collect();
    write_all(args, &output, &found, &picks, renderer.hash())?;
    let text = match args.json {
        true => format!("{:#}\n", json(&found, &picks)),
        false => report::table(&found, &plan.goals) + &lines(args, &found, &picks),
    };
    print_result(text.as_bytes())?;
    say(&format!(
        "{} · {} settings · {}",
        output.display(),
        found.rows.len(),
        words(start.elapsed())
    ));
    Ok(())
}

fn goals(args: &TuneArgs) -> Vec<Goal> {
    let errors = [args.draft, args.preview, args.last];
    let goal = |(quality, error)| Goal { quality, error };
    Quality::ALL.into_iter().zip(errors).map(goal).collect()
}

fn write_all(
    args: &TuneArgs,
    output: &Path,
    found: &Report,
    picks: &[Pick],
    hash: &str,
) -> Result<(), Failure> {
    let write = |path: &Path, text: String| {
        film::write_file(path, text.as_bytes())
            .map_err(|e| Failure::io(format!("\"{}\"", path.display()), &e))
    };
    if let Some(path) = &args.csv {
        write(path, report::csv(found))?;
    }
    if let Some(path) = &args.svg {
        let scene = args.scene.file_name().unwrap_or_default();
        let title = format!("{}: time against error", scene.to_string_lossy());
        write(path, report::svg(found, picks, &title))?;
    }
    write(output, tuned::text(found, picks, hash))
}

/// A line to paste for every quality.
fn lines(args: &TuneArgs, found: &Report, picks: &[Pick]) -> String {
    let mut text = String::new();
    for pick in picks {
        let seconds = Duration::from_secs_f64(report::wall(found, pick.seconds));
        let bias = match pick.bias > 0.0 {
            true => format!(", {:.1} % of it bias", 100.0 * pick.bias),
            false => String::new(),
        };
        text += &format!(
            "\n{}: {:.1} %{bias}, in {}\n  luxel render {} {}\n",
            pick.quality.name(),
            100.0 * pick.error,
            words(seconds),
            args.scene.display(),
            report::arguments(found, pick)
        );
    }
    for quality in Quality::ALL {
        if picks.iter().all(|pick| pick.quality != quality) {
            text += &format!("\n{}: no setting reaches it\n", quality.name());
        }
    }
    text
}

/// Says what goes on when a stage begins, once nobody would not mind.
fn teller(start: Instant, budget: Duration) -> impl FnMut(Stage) {
    /// How long nobody minds.
    const PATIENCE: Duration = Duration::from_secs(2);
    move |stage| {
        let what = match stage {
            Stage::Sizes => "pictures of the full size",
            Stage::Reference => "the reference",
            Stage::Race => "settings that bias nothing",
            Stage::Turning => "one dial after the other",
            Stage::Confirming => "the best with all their samples",
        };
        if budget > 2 * PATIENCE {
            let [spent, all] = [start.elapsed(), budget].map(words);
            say(&format!("{what} ({spent} of {all})"));
        }
    }
}

fn json(found: &Report, picks: &[Pick]) -> Value {
    let estimate = |e: Estimate| json!({ "value": e.value, "half_width": e.half_width });
    let row = |row: &Row| {
        let levels = row.levels.iter().map(|level| {
            let d = &level.differences;
            json!({
                "spp": level.spp,
                "seeds": level.seeds,
                "seconds_least": level.seconds[0],
                "seconds_median": level.seconds[1],
                "squared_error": estimate(d.squared),
                "variance": estimate(d.variance),
                "squared_bias": estimate(d.bias_squared),
                "brightness": estimate(d.brightness),
                "full_rmse": found.error(row, level, None).value,
                "full_seconds": found.seconds(row, level.spp, None),
            })
        });
        json!({
            "arguments": row.dials.words(&found.exact().dials),
            "biased": row.biases > 0,
            "squared_bias": estimate(row.bias_squared),
            "build_seconds": row.build,
            "seconds_per_sample": row.per_sample,
            "dropped": row.dropped,
            "levels": levels.collect::<Vec<_>>(),
        })
    };
    let pick = |pick: &Pick| {
        json!({
            "quality": pick.quality.name(),
            "arguments": report::arguments(found, pick),
            "error": pick.error,
            "bias": pick.bias,
            "cpu_seconds": pick.seconds,
        })
    };
    json!({
        "full_size": [found.full.0, found.full.1],
        "size": [found.size.0, found.size.1],
        "threads": found.threads,
        "variance_at_full_size": found.scale.map(|s| s[0]),
        "time_at_full_size": found.scale.map(|s| s[1]),
        "reference": { "seeds": found.reference.0, "spp": found.reference.1 },
        "picks": picks.iter().map(pick).collect::<Vec<_>>(),
        "settings": found.rows.iter().map(row).collect::<Vec<_>>(),
    })
}
