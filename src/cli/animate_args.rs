//! The arguments of `animate`.

use super::dial_args::DialArgs;
use super::frame_list::FrameList;
use super::goal_args::parse_noise;
use super::part_args::ShardArg;
use super::progress::How;
use crate::scene::RenderDesc;
use clap::{Args, value_parser};
use std::path::PathBuf;

/// `luxel animate`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  luxel animate spin.ron                           spin_0000.png and so on, the frames that the scene names
  luxel animate spin.ron --frames 0..48:4 --spp 4  every fourth, quickly
  luxel animate spin.ron --noise 5%                every frame to the same error, not with the same samples
  luxel animate spin.ron -o out/f_####.exr --gif spin.gif
  luxel animate spin.ron --shard 0/4               every fourth frame, and another machine those of 1/4
  luxel animate spin.ron --y4m - | ffmpeg -i - -pix_fmt yuv420p -colorspace bt709 spin.mp4

Frame K shows the scene at K / fps seconds and is the file that `luxel render --frame K` writes. Frames appear whole
(NAME.partial until they are), and those that are there from before are kept if they were made of the same scene, files
and settings; others are an error, unless --overwrite. So the same line goes on where it was stopped: Ctrl-C exits
with 75, a full disk with 74. Films are made of the frames' files, and made anew each time: where shares of them were
rendered, the line without --shard makes the film of all.")]
pub(crate) struct AnimateArgs {
    /// The scene file (RON)
    pub(crate) scene: PathBuf,
    /// Which frames: 0..48, 0..=47, 1,3..8, 0..48:2 [default: those of the scene]
    #[arg(long, value_name = "LIST")]
    pub(crate) frames: Option<FrameList>,
    /// The frames' files, .png or .exr; the frame's number takes the place of #### [default: SCENE_####.png in this
    /// folder]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Make a GIF of them too
    #[arg(long, value_name = "FILE.gif")]
    pub(crate) gif: Option<PathBuf>,
    /// Make an uncompressed film of them too, frame by frame; - is stdout, for an encoder
    #[arg(long, value_name = "FILE.y4m")]
    pub(crate) y4m: Option<PathBuf>,
    /// Render share I of N of the frames, from 0: 0/4, or auto or auto/4, as the scheduler says
    #[arg(long, value_name = "I/N", conflicts_with_all = ["gif", "y4m"])]
    pub(crate) shard: Option<ShardArg>,
    /// Render all frames anew, whatever is there
    #[arg(long)]
    pub(crate) overwrite: bool,
    /// Samples per pixel, or with --noise at most so many [default: the scene's]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=i64::from(RenderDesc::MAX_SPP)))]
    pub(crate) spp: Option<u32>,
    /// As many samples in each frame as bring it to this relative error: 1% or 0.01. A pilot finds how many
    #[arg(long, value_name = "ERROR", value_parser = parse_noise)]
    pub(crate) noise: Option<f64>,
    /// How progress is told on stderr
    #[arg(long, value_enum, value_name = "HOW", default_value_t = How::Auto)]
    pub(crate) progress: How,
    #[command(flatten)]
    pub(crate) dials: DialArgs,
}
