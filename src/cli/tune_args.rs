//! The arguments of `tune`.

use super::args::{parse_memory, parse_size, parse_time};
use clap::{Args, value_parser};
use std::path::PathBuf;
use std::time::Duration;

/// `luxel tune`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  luxel tune room.ron                              a minute; then: luxel render room.ron -q preview
  luxel tune room.ron --budget 5m --svg room.svg   narrower intervals, and a chart of time against error
  luxel tune room.ron --final 1%                   what is your \"final\"?

Every dial trades time for error, and how much depends on the scene. tune renders it small with many settings and seeds,
compares them with a reference, and finds for three qualities the settings that reach an error in the least time:
draft (is everything in its place?), preview (is the light right?) and final (to show). They are written beside the scene,
where `luxel render -q` finds them; a scene that has changed since is told.

The error is RMSE over the root of the mean square of the picture, at full size. A dial marked BIASED changes what the
picture converges to, by the bias that is shown with its 95 % interval; at most a quarter of the error of a final picture
may be bias, half of a preview's, all of a draft's. A smaller picture is judged as it looks enlarged (bilinearly).
Times are CPU time over threads: what a machine takes that has nothing else to do.

The columns: seconds to reach each quality; how many times as fast as the defaults for the finest; CPU time of a sample;
noise at 16 samples; bias; mean brightness beside the reference's; seeds (\"out\" left the race early).")]
pub(crate) struct TuneArgs {
    /// The scene file (RON)
    pub(crate) scene: PathBuf,
    /// How long to measure, loading included: 30s, 5m
    #[arg(long, value_name = "TIME", default_value = "60s", value_parser = parse_time)]
    pub(crate) budget: Duration,
    /// Error of a draft
    #[arg(long, value_name = "ERROR", default_value = "20%", value_parser = parse_share)]
    pub(crate) draft: f64,
    /// Error of a preview
    #[arg(long, value_name = "ERROR", default_value = "6%", value_parser = parse_share)]
    pub(crate) preview: f64,
    /// Error of a final picture
    #[arg(long = "final", value_name = "ERROR", default_value = "2%", value_parser = parse_share)]
    pub(crate) last: f64,
    /// Width and height of the pictures that are wanted [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<(u32, u32)>,
    /// Frame number
    #[arg(long, value_name = "K", default_value_t = 0)]
    pub(crate) frame: u32,
    /// Worker threads [default: what Slurm, else affinity and cgroup leave to the process]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Where the settings are written [default: SCENE.tune.json beside the scene, where `render -q` reads them]
    #[arg(short, long, value_name = "FILE.json")]
    pub(crate) output: Option<PathBuf>,
    /// Write all numbers as comma-separated values
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
    /// Write a chart
    #[arg(long, value_name = "FILE")]
    pub(crate) svg: Option<PathBuf>,
    /// Print JSON in place of the table
    #[arg(long)]
    pub(crate) json: bool,
    /// Most memory that the files of the scene may take: 512M, 8G
    #[arg(long, value_name = "SIZE", default_value = "4G", value_parser = parse_memory)]
    pub(crate) max_memory: u64,
}

/// `5%` or `0.05`.
fn parse_share(text: &str) -> Result<f64, String> {
    let (digits, unit) = match text.strip_suffix('%') {
        Some(digits) => (digits.trim_end(), 0.01),
        None => (text, 1.0),
    };
    let share = digits.parse().ok().map(|number: f64| number * unit);
    share
        .filter(|share| (1e-4..=1.0).contains(share))
        .ok_or_else(|| "write an error from 0.01% to 100%, e.g. 5% or 0.05".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_shares() {
        assert_eq!(parse_share("5%"), Ok(0.05));
        assert_eq!(parse_share("0.25"), Ok(0.25));
        for bad in ["", "0", "-1%", "200%", "NaN", "inf", "few", "5 %%", "1e-9"] {
            assert!(parse_share(bad).is_err(), "{bad}");
        }
    }
}
