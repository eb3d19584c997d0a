//! The README's trade between time and error: what `luxel tune` finds in three scenes, as tables, with charts in
//! `assets/readme`: the settings of each scene, then what each dial costs and errs.
//!
//! `cargo bench --bench trade`, from the project's folder; three minutes. `cargo bench --bench trade -- 5m` measures each
//! scene for five minutes, `-- 5m hero` that scene only.

use luxel::measure::tune::{Goal, Pick, Plan, Quality, Report, Row, choose, report, run};
use luxel::render::{Renderer, Settings};
use luxel::trace::Isa;
use std::error::Error;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// What the charts are of: a room of spheres, many lights, and a mesh among all materials.
const SCENES: [&str; 3] = ["diffuse_room", "lights", "hero"];

/// How long a scene is measured, if not said.
const BUDGET: Duration = Duration::from_secs(60);

/// The defaults of `luxel tune`.
const ERRORS: [f64; 3] = [0.20, 0.06, 0.02];

fn main() -> Result<(), Box<dyn Error>> {
    // Cargo adds `--bench`.
    let mut words = std::env::args().skip(1).filter(|a| !a.starts_with("--"));
    let minutes = words.next().and_then(|w| w.strip_suffix('m')?.parse().ok());
    let budget = minutes.map_or(BUDGET, |m: f64| Duration::from_secs_f64(60.0 * m));
    let only: Vec<String> = words.collect();
    println!(
        "{} ({}), {} threads, {}, commit {}\n",
        processor(),
        Isa::best().level(),
        std::thread::available_parallelism()?,
        said("rustc", &["--version"]),
        said("git", &["rev-parse", "--short", "HEAD"]),
    );
    let mut found = Vec::new();
    for scene in SCENES {
        if only.is_empty() || only.iter().any(|name| name == scene) {
            found.push((scene, measure(scene, budget)?));
        }
    }
    dials(&found);
    Ok(())
}

fn measure(scene: &str, budget: Duration) -> Result<Report, Box<dyn Error>> {
    let path = Path::new("scenes").join(scene).with_extension("ron");
    let desc = luxel::scene::load(&path)?.desc;
    let spawned = luxel::world::spawn(&desc, luxel::asset::Loader::new())
        .map_err(|errors| errors[0].to_string())?;
    let settings = Settings::of_scene(&desc);
    let mut renderer = Renderer::new(&desc, spawned.world, &spawned.assets, settings)?;
    let goals = Quality::ALL.into_iter().zip(ERRORS);
    let plan = Plan {
        frame: 0,
        deadline: Instant::now() + budget,
        goals: goals
            .map(|(quality, error)| Goal { quality, error })
            .collect(),
    };
    let found = run(&mut renderer, &desc, &spawned.assets, &plan, |_| ());
    let found = found.ok_or("the budget is too short")?;
    let picks: Vec<Pick> = (plan.goals.iter())
        .filter_map(|goal| choose(&found, *goal))
        .collect();
    println!(
        "`{scene}`, {}×{} (measured at {}×{})\n",
        found.full.0, found.full.1, found.size.0, found.size.1
    );
    println!("{}", report::markdown(&found, &plan.goals));
    println!("{}", lines(scene, &found, &picks));
    let title = format!("{scene}: time against error");
    let chart = format!("assets/readme/tune_{scene}.svg");
    std::fs::write(chart, report::svg(&found, &picks, &title))?;
    Ok(found)
}

fn lines(scene: &str, found: &Report, picks: &[Pick]) -> String {
    let line = |pick: &Pick| {
        format!(
            "luxel render scenes/{scene}.ron {}  # {}: {:.1} %, {:.2} s\n",
            report::arguments(found, pick),
            pick.quality.name(),
            100.0 * pick.error,
            report::wall(found, pick.seconds)
        )
    };
    picks.iter().map(line).collect()
}

/// What every dial costs and errs: each row beside one that differs in this dial alone, which has its default.
fn dials(found: &[(&str, Report)]) {
    let names: Vec<String> = found
        .iter()
        .map(|(scene, _)| format!("`{scene}`"))
        .collect();
    println!("| dial | {} |", names.join(" | "));
    println!("|---|{}", "---:|".repeat(names.len()));
    let mut lines: Vec<(String, Vec<String>)> = Vec::new();
    for (k, (_, report)) in found.iter().enumerate() {
        for (dial, ratios) in turned(report) {
            let known = lines.iter().position(|(name, _)| *name == dial);
            let line = known.unwrap_or_else(|| {
                lines.push((dial, vec![String::new(); found.len()]));
                lines.len() - 1
            });
            // The first pair of a dial and scene is the one with the fewest other dials turned.
            let cell = &mut lines[line].1[k];
            if cell.is_empty() {
                *cell = ratios;
            }
        }
    }
    for (dial, cells) in lines {
        println!("| `{dial}` | {} |", cells.join(" | "));
    }
}

/// Pairs of rows that differ in one dial, which has its default in one of them.
fn turned(report: &Report) -> Vec<(String, String)> {
    let exact = report.exact().dials;
    let mut all = Vec::new();
    for row in &report.rows {
        for base in &report.rows {
            let (own, theirs) = (row.dials.arguments(&exact), base.dials.arguments(&exact));
            let turned: Vec<_> = own.iter().filter(|a| !theirs.contains(a)).collect();
            if let [(name, value)] = turned[..]
                && own.len() == theirs.len() + 1
            {
                all.push((format!("{name} {value}"), ratios(row, base)));
            }
        }
    }
    all
}

/// Time of a sample and time to equal noise of a row over another's, with the most samples that both have; and its bias.
fn ratios(row: &Row, base: &Row) -> String {
    let last = (row.levels.iter().rev())
        .find_map(|a| Some((a, base.levels.iter().find(|b| a.spp == b.spp)?)));
    let variance = last.map_or(f64::NAN, |(a, b)| {
        a.differences.variance.value / b.differences.variance.value
    });
    let time = row.per_sample / base.per_sample;
    let bias = row.bias_squared;
    let percent = |x: f64| 100.0 * x.max(0.0).sqrt();
    let bias = match (row.biases, bias.differs_from_zero()) {
        (0, _) => String::new(),
        (_, false) => format!(", bias < {:.2} %", percent(bias.upper())),
        (_, true) => format!(", bias {:.2} %", percent(bias.value)),
    };
    format!("{time:.2} / {:.2}{bias}", time * variance)
}

/// What a program says of itself.
fn said(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output();
    output.map_or("?".to_owned(), |o| {
        String::from_utf8_lossy(&o.stdout).trim().to_owned()
    })
}

fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = text.lines().find(|line| line.starts_with("model name"));
    let name = line.and_then(|line| line.split_once(':'));
    name.map_or("?".to_owned(), |(_, name)| name.trim().to_owned())
}
