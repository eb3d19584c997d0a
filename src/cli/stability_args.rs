//! The arguments of `stability`.

use super::args::{parse_memory, parse_size};
use crate::scene::RenderDesc;
use clap::{Args, value_parser};
use std::path::PathBuf;

/// `luxel stability`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  luxel stability room.ron                         is this scene safe, and what goes wrong first
  luxel stability room.ron --svg room.svg          the same as a chart
  luxel stability room.ron --scales 1e-9,1e9 --offsets 0 --rays 1000000

The scene is built at every scale and moved by every offset; all lengths, places and lights follow, so that nothing of
the picture should change. An offset of 1 moves it by its width without its walls, rounded up to a power of two, along x,
-y and z. A leak is a ray that must hit and does not: one that is aimed at an edge between two triangles, one that starts
inside of a closed surface, or one that walks out of a closed room. A self-hit is a ray that hits the triangle, or from
outside the sphere, that it left. \"Of noise\" is the RMSE to the picture at home over that of another seed: a path that
passes an edge by less than the last bit may pass it on the other side, but no more than noise may change.

Exits with 1 if anything goes wrong.")]
pub(crate) struct StabilityArgs {
    /// The scene file (RON)
    pub(crate) scene: PathBuf,
    /// What all lengths are multiplied by [default: every power of ten from 1e-6 to 1e6, and 2^-20 and 2^20]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = parse_scale)]
    pub(crate) scales: Vec<f64>,
    /// How far the scene is moved, in its widths [default: 1 to 1e7 by powers of ten, and 1e7 at the outermost scales]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = parse_offset)]
    pub(crate) offsets: Vec<f64>,
    /// Rays of each of five kinds, at every placing
    #[arg(long, value_name = "N", default_value_t = 1 << 15, value_parser = value_parser!(u32).range(1..=1 << 24))]
    pub(crate) rays: u32,
    /// Width and height of the pictures [default: 3072 pixels in the scene's shape]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<(u32, u32)>,
    /// Samples per pixel of the pictures
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = value_parser!(u32).range(1..=i64::from(RenderDesc::MAX_SPP)))]
    pub(crate) spp: u32,
    /// Frame number
    #[arg(long, value_name = "K", default_value_t = 0)]
    pub(crate) frame: u32,
    /// Worker threads [default: what Slurm, else affinity and cgroup leave to the process]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
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

fn parse_scale(text: &str) -> Result<f64, String> {
    let scale: Option<f64> = text.parse().ok();
    scale
        .filter(|scale| (1e-30..=1e30).contains(scale))
        .ok_or_else(|| "write a number from 1e-30 to 1e30, e.g. 1e-3".to_owned())
}

fn parse_offset(text: &str) -> Result<f64, String> {
    let offset: Option<f64> = text.parse().ok();
    offset
        .filter(|offset| (0.0..=1e15).contains(offset))
        .ok_or_else(|| "write a number of widths from 0 to 1e15, e.g. 1e7".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn placings_have_their_range() {
        assert_eq!(parse_scale("1e-6"), Ok(1e-6));
        assert_eq!(parse_offset("0"), Ok(0.0));
        for bad in ["0", "-1", "inf", "NaN", "1e31", "far"] {
            assert!(parse_scale(bad).is_err(), "{bad}");
        }
        for bad in ["-1", "inf", "NaN", "1e16", ""] {
            assert!(parse_offset(bad).is_err(), "{bad}");
        }
    }
}
