//! The arguments of `merge` and `info`.

use clap::Args;
use std::path::PathBuf;

/// `luxel merge`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  luxel merge a.exr.*-of-4.part -o a.exr           what four machines rendered, as if one had
  luxel merge a.exr.part -o look.exr --allow-gaps  what a render that goes on has so far

The parts may come in any order, and be shares of samples, of tiles or of both. They must be of the same render and the
same luxel, whole, without a sample twice, and without one missing. The image has the bits, the auxiliary images and the
metadata of a single run; --aov and --exposure are those that the parts were rendered with.")]
pub(crate) struct MergeArgs {
    /// Part films that `luxel render --shard` wrote
    #[arg(required = true, value_name = "PARTS")]
    pub(crate) parts: Vec<PathBuf>,
    /// Where to write: .png or .exr by its suffix
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Make an image of what there is, even if samples or tiles are missing: pixels without any are black
    #[arg(long)]
    pub(crate) allow_gaps: bool,
}

/// `luxel info`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  luxel info room.exr                              what made it, and the line that makes it again
  luxel info room.exr.0-of-4.part --json           how far a share is, for scripts

--json prints {file, kind: \"image\" or \"part\", metadata, command} and, for a part, {samples: {held, of}, done: [least, most],
finished}: held and of count the samples of all its pixels, done those of one pixel up to which all and some are there.")]
pub(crate) struct InfoArgs {
    /// An image (PNG or EXR) or a part film of luxel
    pub(crate) file: PathBuf,
    /// Print JSON on stdout
    #[arg(long)]
    pub(crate) json: bool,
}
