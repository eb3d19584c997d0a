//! How many threads a process takes.

use crate::folder::folder;
use crate::support::{Folder, expect};
use std::fs;

/// What `--stats` says after a render under these variables.
fn threads(folder: &Folder, variables: &[(&str, &str)], more: &[&str]) -> u64 {
    let line = ["render", "spin.ron", "--spp", "1", "--stats", "stats.json"];
    let mut command = folder.command(&[&line, more].concat());
    for name in [
        "SLURM_CPUS_PER_TASK",
        "SLURM_CPUS_ON_NODE",
        "RAYON_NUM_THREADS",
    ] {
        command.env_remove(name);
    }
    command.envs(variables.iter().copied());
    expect(&command.output().expect("luxel runs"), 0, &[]);
    let stats = fs::read(folder.0.join("stats.json")).expect("stats");
    let stats: serde_json::Value = serde_json::from_slice(&stats).expect("JSON");
    stats["threads"].as_u64().expect("a number")
}

#[test]
fn the_command_line_is_obeyed_before_slurm_and_slurm_before_the_machine() {
    let folder = folder("allotment");
    let machine = std::thread::available_parallelism().expect("known").get() as u64;
    let task = ("SLURM_CPUS_PER_TASK", "3");
    let node = ("SLURM_CPUS_ON_NODE", "4");
    let rayon = ("RAYON_NUM_THREADS", "5");
    for (variables, more, wanted) in [
        (&[][..], &[][..], machine),
        (&[rayon], &[], 5),
        (&[rayon, node], &[], 4),
        (&[rayon, node, task], &[], 3),
        (&[rayon, node, task], &["--threads", "6"], 6),
        (&[("SLURM_CPUS_PER_TASK", "many")], &[], machine),
    ] {
        let found = threads(&folder, variables, more);
        assert_eq!(found, wanted, "{variables:?} {more:?}");
    }
}
