//! `luxel farm`: a render as a job for somebody else's scheduler.
//!
//! Takes a scene and a number of tasks; gives text on stdout: a script for Slurm or GNU parallel, a template for OpenJD, a
//! manifest for Kubernetes. Deliberately absent: queues, workers, anything that waits. A task is a line of luxel that may be
//! stopped and repeated, and that is all a scheduler needs.

pub(super) mod args;
mod job;
mod k8s;
mod openjd;
mod parallel;
mod slurm;

use super::failure::Failure;
use super::{load, print_result};
use args::{FarmArgs, Scheduler};
use job::Job;

/// Prints the job.
pub(crate) fn run(args: &FarmArgs) -> Result<(), Failure> {
    let desc = load::description(&args.scene)?;
    let job = Job::plan(args, &desc)?;
    let text = match args.scheduler {
        Scheduler::Slurm => slurm::script(&job)?,
        Scheduler::Parallel => parallel::script(&job)?,
        Scheduler::Openjd => openjd::template(&job)?,
        Scheduler::K8s => k8s::manifest(&job, &args.container)?,
    };
    print_result(text.as_bytes())
}
