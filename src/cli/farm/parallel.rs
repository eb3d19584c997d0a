//! A script for GNU parallel: this machine, or a few that share a folder.

use super::job::{Job, shell};
use crate::cli::failure::Failure;

/// Repeats what was stopped with its work saved, and nothing else.
const AGAIN: &str =
    r#"for try in 1 2 3 4 5; do "$@"; code=$?; [ "$code" = 75 ] || exit "$code"; done; exit 75"#;

/// The script.
pub(super) fn script(job: &Job) -> Result<String, Failure> {
    let logs = format!("{}/logs", job.out);
    let joblog = shell(&[format!("{logs}/parallel.tsv")])?;
    let logs = shell(&[logs])?;
    let again = ["bash", "-c", AGAIN, "again"].map(str::to_owned);
    let line = shell(&[again.to_vec(), job.task("plain")].concat())?;
    let tasks: String = (0..job.shards)
        .map(|i| format!("{line} --shard {i}/{}\n", job.shards))
        .collect();
    let last = shell(&job.last())?;
    let title = &job.title;
    Ok(format!(
        r#"#!/usr/bin/env bash
# {title}, by GNU parallel: `bash FILE`, and again to go on.
# Several machines with ssh, one task each at a time: LUXEL_HOSTS=a,b,: bash FILE, where : is this one.
set -euo pipefail
mkdir -p {logs}

# TERM lets luxel save; it has a minute. What failed is seen by the last task, which judges what is there.
parallel --jobs 1 --sshlogin "${{LUXEL_HOSTS:-:}}" --joblog {joblog} --line-buffer --tag \
    --termseq TERM,60000,KILL,25 <<'TASKS' || echo "$? tasks failed" >&2
{tasks}TASKS

{last}
"#
    ))
}
