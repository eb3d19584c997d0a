//! The one change that would help most: the same error in less time, or less error where it is too much to look at.
//!
//! Changes are judged by time at equal error. Deliberately absent: dials that err (tune weighs those), and whatever gains less
//! than is worth a word.

use super::progress::words;
use super::stats::Account;
use super::threads;
use crate::build::{Accel, Quality};
use crate::film::{Blocks, ErrorBar};
use crate::render::{Ended, Settings, Verdict};
use crate::scene::RenderDesc;
use crate::trace::{Sampler, Stage};
use std::time::Duration;

/// What `--tree fast` leaves of the time that trees take, and what it adds to that of the rays ([`Quality::Fast`]).
const FAST_TREE: f64 = 0.35;
const SLOWER_RAYS: f64 = 0.2;

/// Gain in time at equal error below which a change is not worth a word.
const WORTH: f64 = 1.1;

/// Gain from which on a change comes before less error: something is switched off that had better be on.
const MUST: f64 = 1.5;

/// What dials gain that are on by default, at equal error: the least on the scenes of the README's table.
const SOBOL: f64 = 1.6;
const LIGHT_SAMPLING: f64 = 4.7;

/// Nanoseconds of a ray from which on it is told that no tree is used.
const SLOW_RAY: f64 = 1000.0;

/// Errors of a preview and of a final picture, as `luxel tune` has them.
const GOALS: [f64; 2] = [0.06, 0.02];

/// An error this many times what a picture is for is worth more samples.
const TOO_MUCH: f64 = 1.5;

/// Fewest samples of a pixel that tell where the error is.
const ENOUGH: u32 = 32;

/// A change, and how many times less time the same error then takes.
struct Change {
    what: String,
    gain: f64,
}

/// One line, without a full stop; nothing where nothing helps.
pub(crate) fn of(account: &Account<'_>, settings: &Settings) -> Option<String> {
    let changes = [
        more_threads(account),
        better_numbers(settings),
        sampled_lights(account, settings),
        a_tree(account, settings),
        a_faster_tree(account, settings),
        samples_by_cell(account, settings),
    ];
    let best = changes.into_iter().flatten();
    let best = best.max_by(|a, b| a.gain.total_cmp(&b.gain));
    let best = best.filter(|change| change.gain >= WORTH);
    match best {
        Some(change) if change.gain >= MUST => Some(change.what),
        best => less_error(account, settings).or(best.map(|change| change.what)),
    }
}

/// Some of the time saved, as a gain.
fn gain(saved: f64, account: &Account<'_>) -> f64 {
    let whole = account.stats.stages.total().as_secs_f64();
    whole / (whole - saved).max(f64::MIN_POSITIVE)
}

fn less_time(gain: f64) -> String {
    format!("about {:.0} % less time", 100.0 * (1.0 - 1.0 / gain))
}

fn more_threads(account: &Account<'_>) -> Option<Change> {
    let (allotted, threads) = (threads::allotted(), account.stats.threads);
    let trace = account.stats.stages.trace.as_secs_f64();
    let share = threads as f64 / allotted as f64;
    let gain = gain((1.0 - share) * trace, account);
    (threads < allotted).then(|| Change {
        what: format!(
            "--threads {allotted}, all that there are: {}",
            less_time(gain)
        ),
        gain,
    })
}

fn better_numbers(settings: &Settings) -> Option<Change> {
    (settings.trace.sampler == Sampler::Independent).then(|| Change {
        what: format!(
            "--sampler sobol: the same error in {SOBOL} times less time or better, as on scenes of the README"
        ),
        gain: SOBOL,
    })
}

/// What there is to sample is known by what shone into the paths.
fn sampled_lights(account: &Account<'_>, settings: &Settings) -> Option<Change> {
    let tracing = &account.stats.tracing;
    let lit = tracing.of(Stage::Emission).items > 0;
    let scatters = tracing.of(Stage::Diffuse).items + tracing.of(Stage::Plastic).items > 0;
    (!settings.trace.nee && lit && scatters).then(|| Change {
        what: format!(
            "--nee on: the same error in {LIGHT_SAMPLING} times less time or better, as on scenes of the README"
        ),
        gain: LIGHT_SAMPLING,
    })
}

/// How far a tree helps is only known to be as far as rays take time.
fn a_tree(account: &Account<'_>, settings: &Settings) -> Option<Change> {
    let tracing = &account.stats.tracing;
    let share = tracing.share(&[Stage::ClosestHit, Stage::Opacity, Stage::Occlusion]);
    let per_ray = share * tracing.nanoseconds() as f64 / (account.stats.rays() as f64).max(1.0);
    (settings.accel != Accel::Bvh && per_ray > SLOW_RAY).then(|| Change {
        what: format!(
            "--accel bvh: most of the {:.0} % of the time that rays take, {per_ray:.0} ns each",
            100.0 * share
        ),
        gain: 1.0 / (1.0 - 0.5 * share),
    })
}

fn a_faster_tree(account: &Account<'_>, settings: &Settings) -> Option<Change> {
    let stages = &account.stats.stages;
    let (tree, trace) = (stages.bvh.as_secs_f64(), stages.trace.as_secs_f64());
    let gain = gain((1.0 - FAST_TREE) * tree - SLOWER_RAYS * trace, account);
    (settings.quality == Quality::Good).then(|| Change {
        what: format!("--tree fast: {}", less_time(gain)),
        gain,
    })
}

/// An error that samples can be told by.
fn trusted<'a>(account: &'a Account<'_>) -> Option<&'a ErrorBar> {
    account
        .error
        .as_ref()
        .filter(|bar| !bar.is_fragile() && bar.relative > 0.0)
}

/// The mean number of samples with which cells that get what they need have an error; pilot included.
fn samples_of_cells(account: &Account<'_>, error: f64) -> Option<f64> {
    let (film, side) = (account.film, Settings::CELL);
    let goals = film.allot(error, side, Blocks::LENGTH, RenderDesc::MAX_SPP)?;
    let columns = film.width().div_ceil(side);
    let length = |at: u32, whole: u32| f64::from(side.min(whole - at * side));
    let samples = goals.iter().enumerate().map(|(cell, &goal)| {
        let (x, y) = (cell as u32 % columns, cell as u32 / columns);
        length(x, film.width()) * length(y, film.height()) * f64::from(goal)
    });
    let mean = samples.sum::<f64>() / film.pixels() as f64;
    let longest = goals.iter().copied().max().unwrap_or(0);
    Some(mean + f64::from(Verdict::pilot_for(mean.ceil() as u32, longest)))
}

/// Samples where the error is; as far as they gain if the error is only known to its interval, which goes into their number
/// squared.
fn samples_by_cell(account: &Account<'_>, settings: &Settings) -> Option<Change> {
    let bar = trusted(account)?;
    let (stats, stages) = (&account.stats, &account.stats.stages);
    if settings.is_adaptive() || stats.ended == Ended::Time || stats.spp < ENOUGH {
        return None;
    }
    let doubt = 1.0 + 2.0 * bar.half_width / bar.relative;
    let needed = doubt * samples_of_cells(account, bar.relative)?;
    let pilot = f64::from(stats.pilot);
    let saved = 1.0 - needed / (f64::from(stats.spp) + pilot);
    let gain = gain(saved * (stages.pilot + stages.trace).as_secs_f64(), account);
    let what = match settings.noise {
        Some(_) => "--adaptive on".to_owned(),
        None => format!("--noise {}%", digits(bar.relative)),
    };
    Some(Change {
        what: format!(
            "{what}: the same error, samples where it is, {}",
            less_time(gain)
        ),
        gain,
    })
}

/// The error that the next better quality has, if the picture is far from it and was not asked for by its error.
fn less_error(account: &Account<'_>, settings: &Settings) -> Option<String> {
    let bar = trusted(account)?;
    let stats = &account.stats;
    if settings.noise.is_some() || stats.stopped {
        return None;
    }
    let wanted = GOALS
        .into_iter()
        .find(|goal| bar.relative > TOO_MUCH * goal)?;
    let uniform = f64::from(bar.samples_for(wanted, 1, RenderDesc::MAX_SPP));
    let by_cell = match settings.adaptive && stats.spp >= ENOUGH {
        true => samples_of_cells(account, wanted),
        false => None,
    };
    let samples = by_cell.unwrap_or(uniform);
    let times = samples / f64::from(stats.spp.max(1));
    let seconds = stats.stages.trace.as_secs_f64() * times;
    let took = words(Duration::from_secs_f64(seconds));
    let what = match settings.time {
        Some(_) => format!("--time {}s", seconds.ceil().max(1.0)),
        None if by_cell.is_some_and(|samples| samples < uniform) => {
            format!("--noise {}%", digits(wanted))
        }
        None => format!("--spp {uniform:.0}"),
    };
    Some(format!(
        "{what}: relative RMSE {} % in place of {} %, {} times the time, about {took}",
        digits(wanted),
        digits(bar.relative),
        factor(times),
    ))
}

/// A factor, with two digits.
fn factor(times: f64) -> String {
    if times < 9.95 {
        format!("{times:.1}")
    } else {
        format!("{times:.0}")
    }
}

/// A share in percent, with two digits.
fn digits(share: f64) -> String {
    let percent = 100.0 * share;
    match percent {
        _ if percent >= 9.95 => format!("{percent:.0}"),
        _ if percent >= 0.995 => format!("{percent:.1}"),
        _ => format!("{percent:.2}"),
    }
}
