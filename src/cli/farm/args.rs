//! The arguments of `farm`.

use crate::cli::args::parse_memory;
use clap::{Args, ValueEnum, value_parser};
use std::path::PathBuf;

/// `luxel farm`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  luxel farm slurm spin.ron --out /shared/spin > spin.sh   and then: bash spin.sh
  luxel farm slurm room.ron --out room --shards 32 -- --spp 4096 --size 3840x2160
  luxel farm parallel spin.ron --out spin | bash           this machine; LUXEL_HOSTS=a,b,: bash for several with ssh
  luxel farm openjd spin.ron --out spin > spin.json        openjd run spin.json; Deadline Cloud takes it too
  luxel farm k8s room.ron --out room | kubectl apply -f -  an Indexed Job

It prints text and submits nothing. Each task is a line of `luxel animate` or `luxel render` with its --shard; what is
behind -- goes to each. A task that was stopped (75) is queued again and goes on from what it saved; one whose scene is
bad (65) is not. The last one runs when all others have ended, however they did: `luxel merge`, which refuses shares that
are missing, or `luxel animate` of all frames, which renders those that are.")]
pub(crate) struct FarmArgs {
    /// Who runs the tasks
    #[arg(value_enum)]
    pub(crate) scheduler: Scheduler,
    /// The scene file (RON)
    pub(crate) scene: PathBuf,
    /// The folder of images, shares and logs; all machines see it and the scene under the same names
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// How many tasks, at most one for a frame or for 8 samples [default: 8]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=100_000))]
    pub(crate) shards: Option<u32>,
    /// What they share [default: the scene's frames if there are several, else each pixel's samples]
    #[arg(long, value_enum, value_name = "WHAT")]
    pub(crate) by: Option<By>,
    /// Of frames and of the still
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = FormatArg::Png)]
    pub(crate) format: FormatArg,
    /// Threads of a task, where the scheduler wants to know
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = value_parser!(u16).range(1..=1024))]
    pub(crate) cpus: u16,
    /// Memory of a task, where the scheduler wants to know
    #[arg(long, value_name = "SIZE", default_value = "8G", value_parser = parse_memory)]
    pub(crate) memory: u64,
    /// The luxel that tasks run [default: this one; k8s: that of the image]
    #[arg(long, value_name = "PATH")]
    pub(crate) luxel: Option<PathBuf>,
    /// The container image that has luxel, and the volume claim that holds the current folder, for k8s
    #[arg(long, value_name = "IMAGE,CLAIM", default_value = "luxel,luxel", value_parser = parse_pair)]
    pub(crate) container: (String, String),
    /// What `luxel animate` or `luxel render` is to be told too
    #[arg(last = true, value_name = "OPTIONS")]
    pub(crate) options: Vec<String>,
}

/// Who runs tasks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Scheduler {
    /// An array job and one that depends on it, as a script that submits them
    Slurm,
    /// A job template, as JSON
    Openjd,
    /// A script for one machine, or for a few with ssh
    Parallel,
    /// An Indexed Job of Kubernetes, as JSON
    K8s,
}

/// `--by`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum By {
    /// Each task renders some frames
    Frames,
    /// Each task renders some samples of one frame
    Samples,
}

/// `--format`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum FormatArg {
    Png,
    Exr,
}

fn parse_pair(text: &str) -> Result<(String, String), String> {
    let pair = text.split_once(',');
    let pair = pair.filter(|(image, claim)| !image.is_empty() && !claim.is_empty());
    pair.map(|(image, claim)| (image.to_owned(), claim.to_owned()))
        .ok_or_else(|| "write an image and a volume claim, e.g. registry/luxel:1,films".to_owned())
}
