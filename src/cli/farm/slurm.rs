//! A script that submits an array job to Slurm, and the task that comes last.

use super::job::{Job, shell};
use crate::cli::failure::Failure;

/// The script.
pub(super) fn script(job: &Job) -> Result<String, Failure> {
    let Job {
        name,
        title,
        cpus,
        memory,
        ..
    } = job;
    let logs = format!("{}/logs", job.out);
    // In the names of logs, Slurm reads %.
    let log = |name| shell(&[format!("{}/{name}", logs.replace('%', "%%"))]);
    let (log, last_log, logs) = (log("%A_%a.log")?, log("last_%j.log")?, shell(&[logs])?);
    let line = shell(&job.task("plain"))?;
    let task = step(&format!(
        "{line} --shard \"$SLURM_ARRAY_TASK_ID/{}\"",
        job.shards
    ));
    let last = step(&shell(&job.last())?);
    let to = job.shards - 1;
    let with = format!(
        "--ntasks=1 --cpus-per-task={cpus} --mem={memory}M --requeue --signal=TERM@60 --open-mode=append"
    );
    Ok(format!(
        r#"#!/usr/bin/env bash
# {title}, on Slurm: `bash FILE` submits them.
# Where and for how long they may run is sbatch's to say: SBATCH_PARTITION=long SBATCH_TIMELIMIT=4:00:00 bash FILE
set -euo pipefail
mkdir -p {logs}

tasks=$(sbatch --parsable --job-name={name} --array=0-{to} {with} \
    --output={log} <<'TASK'
{task}TASK
)
tasks=${{tasks%%;*}}

# Not afterok: once a task was requeued, Slurm never releases what waits for success. It judges by itself what is there.
last=$(sbatch --parsable --job-name={name}-last --dependency="afterany:$tasks" {with} \
    --output={last_log} <<'TASK'
{last}TASK
)
echo "tasks $tasks, the last one ${{last%%;*}}; logs in" {logs}
"#
    ))
}

/// The script of a task. Slurm sends the signal before the time limit to steps: `srun` makes one of luxel, and returns its
/// exit code. The shell must survive the signal.
fn step(line: &str) -> String {
    format!(
        r#"#!/usr/bin/env bash
trap : TERM
srun --ntasks=1 --cpus-per-task="$SLURM_CPUS_PER_TASK" {line}
code=$?
# Stopped, with its work saved, and not by scancel, after which it would not be running: the same line goes on.
if [ "$code" = 75 ] && [ "$(squeue -h -j "$SLURM_JOB_ID" -o %T)" = RUNNING ]; then
    scontrol requeue "$SLURM_JOB_ID"
fi
exit "$code"
"#
    )
}
