//! The arguments of long renders: what is kept on the way, and which share of the work this machine does.

use super::args::parse_time;
use super::failure::Failure;
use clap::{Args, ValueEnum};
use std::ops::Range;
use std::str::FromStr;
use std::time::Duration;

/// Part of `luxel render`.
#[derive(Clone, Debug, Args)]
pub(crate) struct PartArgs {
    /// Save what there is so often, as OUTPUT.part, and at the end or when stopped (75): the same line goes on from it
    #[arg(long, value_name = "TIME", value_parser = parse_time, conflicts_with_all = ["vs", "replay"])]
    pub(crate) checkpoint: Option<Duration>,
    /// Render share I of N, from 0, into OUTPUT.I-of-N.part, for `luxel merge`: 0/4, or auto or auto/4, as the scheduler says
    #[arg(long, value_name = "I/N", conflicts_with_all = ["vs", "replay", "stats", "samples_range"])]
    pub(crate) shard: Option<ShardArg>,
    /// What is shared: each pixel's samples [default], or the tiles
    #[arg(long, value_enum, value_name = "WHAT", requires = "shard")]
    pub(crate) shard_by: Option<ShardBy>,
    /// Render these of the --spp samples, into OUTPUT.A..B.part; multiples of 8, or the end
    #[arg(long, value_name = "A..B", value_parser = parse_range, requires = "spp", conflicts_with_all = ["vs", "replay", "stats"])]
    pub(crate) samples_range: Option<Range<u32>>,
    /// Begin anew, whatever part is there
    #[arg(long)]
    pub(crate) overwrite: bool,
}

/// `--shard-by`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ShardBy {
    /// Each does some samples of all pixels
    Samples,
    /// Each does all samples of some tiles
    Tiles,
}

/// `--shard`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ShardArg {
    /// This one of so many.
    Named(u32, u32),
    /// The one that the scheduler says, of as many as it or this says.
    Auto(Option<u32>),
}

/// Of an array job of Slurm.
const SLURM: [&str; 4] = [
    "SLURM_ARRAY_TASK_ID",
    "SLURM_ARRAY_TASK_MIN",
    "SLURM_ARRAY_TASK_COUNT",
    "SLURM_ARRAY_TASK_STEP",
];

/// Of an indexed job of Kubernetes, which does not tell how many there are.
const KUBERNETES: &str = "JOB_COMPLETION_INDEX";

impl ShardArg {
    /// Which one of how many; `environment` has what the scheduler says.
    pub(crate) fn resolve(
        self,
        environment: impl Fn(&str) -> Option<String>,
    ) -> Result<(u32, u32), Failure> {
        let count = match self {
            ShardArg::Named(index, count) => return Ok((index, count)),
            ShardArg::Auto(count) => count,
        };
        let number = |name: &str| environment(name)?.trim().parse::<u32>().ok();
        let [id, least, tasks, step] = SLURM.map(number);
        let slurm = id.map(|id| id.saturating_sub(least.unwrap_or(0)) / step.unwrap_or(1).max(1));
        let Some(index) = number(KUBERNETES).or(slurm) else {
            return Err(Failure::usage(
                format!(
                    "--shard auto finds neither {} nor {KUBERNETES} in the environment",
                    SLURM[0]
                ),
                "run it as a task of an array job, or say which: --shard 0/4",
            ));
        };
        let Some(count) = count.or(tasks) else {
            return Err(Failure::usage(
                "the scheduler does not say how many tasks there are",
                "say it: --shard auto/4",
            ));
        };
        if index >= count {
            return Err(Failure::usage(
                format!("task {index} is none of {count}, which count from 0"),
                "number the tasks of the array 0 to N-1, and give N: --shard auto/N",
            ));
        }
        Ok((index, count))
    }

    /// By the environment of this process.
    pub(crate) fn here(self) -> Result<(u32, u32), Failure> {
        self.resolve(|name| std::env::var(name).ok())
    }
}

impl FromStr for ShardArg {
    type Err = String;

    fn from_str(text: &str) -> Result<ShardArg, String> {
        const REMEDY: &str =
            "write which share of how many, from 0: 0/4 to 3/4; or auto, or auto/4";
        let (which, count) = match text.split_once('/') {
            Some((which, count)) => (which, Some(count)),
            None => (text, None),
        };
        let count = count.map(|count| count.parse::<u32>().map_err(|_| REMEDY));
        let count = count.transpose()?.filter(|count| *count > 0);
        match (which, count) {
            ("auto", count) if count.is_some() || !text.contains('/') => Ok(ShardArg::Auto(count)),
            (which, Some(count)) => match which.parse() {
                Ok(index) if index < count => Ok(ShardArg::Named(index, count)),
                _ => Err(REMEDY.to_owned()),
            },
            _ => Err(REMEDY.to_owned()),
        }
    }
}

fn parse_range(text: &str) -> Result<Range<u32>, String> {
    let ends = text.split_once("..");
    let ends = ends.and_then(|(a, b)| Some(a.trim().parse().ok()?..b.trim().parse().ok()?));
    ends.filter(|range: &Range<u32>| !range.is_empty())
        .ok_or_else(|| "write the first sample and the one after the last, e.g. 0..64".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn resolve(text: &str, environment: &[(&str, &str)]) -> Result<(u32, u32), Failure> {
        let arg: ShardArg = text.parse().expect("a shard");
        arg.resolve(|name| {
            let entry = environment.iter().find(|(key, _)| *key == name);
            entry.map(|(_, value)| (*value).to_owned())
        })
    }

    #[test]
    fn shards_count_from_0() {
        assert_eq!("0/4".parse(), Ok(ShardArg::Named(0, 4)));
        assert_eq!("3/4".parse(), Ok(ShardArg::Named(3, 4)));
        assert_eq!("auto/4".parse(), Ok(ShardArg::Auto(Some(4))));
        for bad in [
            "", "4/4", "0", "0/0", "-1/4", "auto/", "auto/0", "a/4", "1/4/8",
        ] {
            assert!(bad.parse::<ShardArg>().is_err(), "{bad}");
        }
    }

    #[test]
    fn schedulers_say_which_share() {
        let slurm = |id| {
            [
                (SLURM[0], id),
                (SLURM[1], "1"),
                (SLURM[2], "4"),
                (SLURM[3], "2"),
            ]
        };
        assert_eq!(resolve("auto", &slurm("1")).ok(), Some((0, 4)));
        assert_eq!(resolve("auto", &slurm("7")).ok(), Some((3, 4)));
        assert_eq!(resolve("auto/8", &slurm("7")).ok(), Some((3, 8)));
        assert!(resolve("auto", &slurm("9")).is_err(), "beyond the last");
        assert_eq!(resolve("2/3", &slurm("1")).ok(), Some((2, 3)), "beats it");
        let kubernetes = [(KUBERNETES, "5")];
        assert_eq!(resolve("auto/8", &kubernetes).ok(), Some((5, 8)));
        assert!(resolve("auto", &kubernetes).is_err(), "of how many?");
        assert!(resolve("auto/8", &[]).is_err());
    }

    #[test]
    fn ranges_are_half_open() {
        assert_eq!(parse_range("0..64"), Ok(0..64));
        for bad in ["", "64", "64..0", "8..8", "a..b", "0..=7"] {
            assert!(parse_range(bad).is_err(), "{bad}");
        }
    }
}
