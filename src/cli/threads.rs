//! How many threads the process works with: what the command line or the scheduler allots, never the whole of a shared
//! machine.
//!
//! The number is rayon's global pool, on which files are decoded and which renderers without a number of their own
//! follow. Deliberately absent: pinning threads to processors, which is the scheduler's.

use rayon::ThreadPoolBuilder;
use std::{env, thread};

/// Who says a number, the first one first: Slurm for each task, Slurm for the job on this machine, and the user of any
/// program that has rayon.
const ALLOTMENTS: [&str; 3] = [
    "SLURM_CPUS_PER_TASK",
    "SLURM_CPUS_ON_NODE",
    "RAYON_NUM_THREADS",
];

/// Lets the process work on `asked` threads, else on as many as are allotted to it. Before anything is read.
pub(crate) fn allot(asked: Option<u16>) {
    let threads = asked.map_or_else(allotted, usize::from);
    // It fails only where the pool is there already: who came first has decided.
    let _ = ThreadPoolBuilder::new().num_threads(threads).build_global();
}

/// What Slurm says, else RAYON_NUM_THREADS, else the processors that affinity and the cgroup's quota leave to the process.
pub(crate) fn allotted() -> usize {
    let said = |name: &&str| env::var(name).ok().and_then(|number| threads(&number));
    let offered = || thread::available_parallelism().map_or(1, usize::from);
    ALLOTMENTS.iter().find_map(said).unwrap_or_else(offered)
}

/// A number of threads.
fn threads(number: &str) -> Option<usize> {
    number.parse().ok().filter(|n| (1..=1024).contains(n))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_threads_are_numbers() {
        assert_eq!(threads("3"), Some(3));
        for bad in ["", "0", "-1", "2(x3)", "100000"] {
            assert_eq!(threads(bad), None, "{bad}");
        }
    }
}
