//! The one change that would make a render like this one cheapest, with what it would bring.

use super::stats::Account;
use super::threads;
use crate::build::Quality;

/// What `--tree fast` leaves of the time that trees take, and what it adds to that of the rays ([`Quality::Fast`]).
const FAST_TREE: f64 = 0.35;
const SLOWER_RAYS: f64 = 0.2;

/// Share of the time below which a change is not worth a word.
const WORTH: f64 = 0.1;

/// What is to be changed, and by how much less time a render would take, as a share.
struct Change {
    what: String,
    saves: f64,
}

/// One line, without a full stop.
pub(crate) fn of(account: &Account<'_>, tree_quality: Quality) -> String {
    let stages = &account.stats.stages;
    let (tree, trace) = (stages.bvh.as_secs_f64(), stages.trace.as_secs_f64());
    let whole = stages.total().as_secs_f64().max(f64::MIN_POSITIVE);
    let mut changes = Vec::new();
    let mut propose = |what: String, saved: f64| {
        changes.push(Change {
            what,
            saves: saved / whole,
        });
    };
    if tree_quality == Quality::Good {
        let saved = (1.0 - FAST_TREE) * tree - SLOWER_RAYS * trace;
        propose("--tree fast".to_owned(), saved);
    }
    let allotted = threads::allotted();
    if account.stats.threads < allotted {
        let share = account.stats.threads as f64 / allotted as f64;
        let what = format!("--threads {allotted}, all that there are");
        propose(what, (1.0 - share) * trace);
    }
    let most = changes
        .into_iter()
        .max_by(|a, b| a.saves.total_cmp(&b.saves));
    match most.filter(|change| change.saves >= WORTH) {
        Some(change) => format!(
            "{}: about {:.0} % less time",
            change.what,
            100.0 * change.saves
        ),
        None => fewer_samples(account, trace / whole),
    }
}

/// Where nothing is wasted, only accuracy can be given up.
fn fewer_samples(account: &Account<'_>, share: f64) -> String {
    let half = account.stats.spp / 2;
    let saved = format!("about {:.0} % less time", 50.0 * share);
    match &account.error {
        Some(bar) if half >= 1 => format!(
            "--spp {half}: {saved}, relative RMSE {:.2} % in place of {:.2} %",
            100.0 * bar.at(half),
            100.0 * bar.relative
        ),
        _ => format!("a smaller --size: {saved} for half the pixels"),
    }
}
