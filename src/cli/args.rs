//! The arguments. Every number is checked here, with its range in the message.

use super::animate_args::AnimateArgs;
use super::author_args::{ConvertArgs, TurntableArgs};
use super::bench_args::BenchArgs;
use super::dial_args::DialArgs;
use super::farm::args::FarmArgs;
use super::goal_args::GoalArgs;
use super::merge_args::{InfoArgs, MergeArgs};
use super::part_args::PartArgs;
use super::progress::How;
use super::replay_args::ReplayArgs;
use super::stability_args::StabilityArgs;
use super::tune_args::TuneArgs;
use super::tuned::QualityArg;
use crate::scene::RenderDesc;
use crate::trace::isa::{Isa, Level};
use clap::{Args, Parser, Subcommand, ValueEnum, value_parser};
use std::path::PathBuf;
use std::time::Duration;

/// A path tracer for scenes that are lists of entities: author in RON, render, measure.
#[derive(Debug, Parser)]
#[command(
    name = "luxel",
    version,
    arg_required_else_help = true,
    after_help = "\
Examples:
  luxel render scenes/hero.ron                     writes hero.png here
  luxel render room.ron -o room.exr --aov normal,depth
  luxel animate spin.ron --gif spin.gif            frame by frame, and a film of them
  luxel check room.ron                             every error at once, of the scene and of its files
  luxel turntable cat.obj                          a mesh from all sides: cat.gif
  luxel explain room.ron                           what the scene makes luxel do
  luxel compare quick.exr reference.exr            how wrong a picture is
  luxel bench                                      how fast rays are traced, and why
  luxel stability room.ron                         what goes wrong with the scene at other sizes and places
  luxel tune room.ron                              which settings are worth their time: draft, preview, final
  luxel merge a.exr.*.part -o a.exr                one image of what many machines rendered
  luxel info a.exr                                 what an image is, and the line that makes it again
  luxel farm slurm spin.ron --out spin | bash      on many machines

Exit codes: 0 done, 1 images differ by more than --max (bench: the arms' hits do; stability: the scene goes wrong), 2 usage, 65 bad scene, image or part, 66 missing file, 70 bug, 74 i/o, 75 stopped, and the same line goes on, 130 stopped"
)]
pub(crate) struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Render one frame of a scene to a PNG or an EXR file
    Render(Box<RenderArgs>),
    /// Render frames of a scene whose parts move; the same line goes on where it was stopped
    Animate(Box<AnimateArgs>),
    /// List every error and warning of a scene and of the files that it names, or of a mesh file
    Check(CheckArgs),
    /// Show a mesh from all sides: no scene file, a GIF within seconds
    Turntable(TurntableArgs),
    /// Write a scene that shows a mesh or a glTF file, to be edited
    Convert(ConvertArgs),
    /// Show what a scene requires: stages, buffers, bytes, tree, defaults in force
    Explain(InspectArgs),
    /// Measure how far an image is from its reference: RMSE, relMSE, PSNR, bias, FLIP
    Compare(CompareArgs),
    /// Measure traversal: layouts, instruction sets, trees, rays, on generated meshes or yours
    Bench(Box<BenchArgs>),
    /// Try a scene at other sizes and places: leaks, self-hits, what goes wrong first
    Stability(StabilityArgs),
    /// Measure what every dial costs and errs in a scene, and find settings for draft, preview and final
    Tune(TuneArgs),
    /// Put the shares of a render together: the bits of a single run
    Merge(MergeArgs),
    /// Show what an image or a part film is, and the line that makes it again
    Info(InfoArgs),
    /// Print a render as a job for Slurm, GNU parallel, OpenJD or Kubernetes
    Farm(FarmArgs),
}

impl Command {
    /// `--threads`, of those that have it.
    pub(crate) fn threads(&self) -> Option<u16> {
        match self {
            Command::Render(args) => args.dials.threads,
            Command::Animate(args) => args.dials.threads,
            Command::Turntable(args) => args.threads,
            Command::Stability(args) => args.threads,
            Command::Tune(args) => args.threads,
            _ => None,
        }
    }
}

/// `luxel render`.
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  luxel render room.ron                            room.png, as the scene says
  luxel render room.ron -o room.exr --aov albedo,normal,depth
  luxel render room.ron --noise 1% --time 10m      until it is 1 % wrong, ten minutes at most
  luxel render room.ron --size 128x128 --spp 4     a quick look
  luxel render room.ron -q preview                 as `luxel tune room.ron` found best
  luxel render room.ron -o - | viewer              PNG on stdout
  luxel render room.ron --replay 0,12,7,3          what sample 3 of pixel (12, 7) of frame 0 met
  luxel render room.ron --checkpoint 60s           killed or stopped, the same line goes on
  luxel render room.ron -o a.exr --shard 2/4       a quarter of the samples: a.exr.2-of-4.part
  luxel merge a.exr.*-of-4.part -o a.exr           all four: to the bit what one machine renders

--spp, --noise and --time: the first that is reached ends the render.
Ctrl-C writes what there is to NAME.partial.png (or .exr) and exits with 130. With --checkpoint, or of a share, it and
SIGTERM save the part film instead and exit with 75; a second one stops at once. A part that is there is gone on from
if it was made of the same scene, files and settings; another is an error, unless --overwrite. It stays beside the
finished image, so that --spp 128 adds the missing samples to those of --spp 64, and --time more with each run.
With equal samples the picture is the same to the bit for any --threads, --tile, --isa, --accel and --tree, however
often it was stopped, and however it was shared.")]
pub(crate) struct RenderArgs {
    /// The scene file (RON)
    pub(crate) scene: PathBuf,
    /// Where to write: .png or .exr by its suffix, - is PNG on stdout [default: SCENE.png in this folder]
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Settings that `luxel tune` found for this scene and wrote beside it; --spp, --size and --bounces still count
    #[arg(short, long, value_enum, value_name = "QUALITY", conflicts_with_all = ["sampler", "nee", "mis", "roulette", "fresnel", "accel", "tree"])]
    pub(crate) quality: Option<QualityArg>,
    /// Samples per pixel [default: the scene's, or as many as --noise and --time take]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=i64::from(RenderDesc::MAX_SPP)))]
    pub(crate) spp: Option<u32>,
    /// Stop after this time, reading and writing included: 30s, 2m, 500ms
    #[arg(long, value_name = "TIME", value_parser = parse_time)]
    pub(crate) time: Option<Duration>,
    /// Frame number; frame K shows the scene at K / fps seconds
    #[arg(long, value_name = "K", default_value_t = 0)]
    pub(crate) frame: u32,
    #[command(flatten)]
    pub(crate) dials: DialArgs,
    /// Write what the render cost as JSON
    #[arg(long, value_name = "FILE.json")]
    pub(crate) stats: Option<PathBuf>,
    /// How progress is told on stderr
    #[arg(long, value_enum, value_name = "HOW", default_value_t = How::Auto)]
    pub(crate) progress: How,
    #[command(flatten)]
    pub(crate) goal: GoalArgs,
    #[command(flatten)]
    pub(crate) parts: PartArgs,
    #[command(flatten)]
    pub(crate) replay: ReplayArgs,
}

/// `luxel check`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  luxel check room.ron                             the scene and every file that it names
  luxel check model.glb                            a mesh file by itself (.obj, .gltf, .glb), and what is in it
  luxel check room.ron --json                      for editors and scripts
  luxel check --codes                              what E012 and W004 stand for

--json prints {errors, warnings, diagnostics: [{severity, code, message, file, line, column, length, text, pointer,
hint}, ..]} and, for a mesh file that is good, contents. What is not known is null. Lines, columns and lengths count
characters from 1; text is the line itself, null where it is very long; pointer is a JSON pointer into a glTF file.
The text shows the first 20 of a code in a file, the JSON all.")]
pub(crate) struct CheckArgs {
    /// The scene (RON), or a mesh file: .obj, .gltf, .glb
    #[arg(required_unless_present = "codes")]
    pub(crate) file: Option<PathBuf>,
    /// Print JSON on stdout
    #[arg(long)]
    pub(crate) json: bool,
    /// Exit with 65 if there are warnings
    #[arg(long)]
    pub(crate) strict: bool,
    /// Most memory that the files of the scene may take: 512M, 8G
    #[arg(long, value_name = "SIZE", default_value = "4G", value_parser = parse_memory)]
    pub(crate) max_memory: u64,
    /// List every code with its meaning
    #[arg(long, conflicts_with = "file")]
    pub(crate) codes: bool,
}

/// `luxel explain`.
#[derive(Debug, Args)]
pub(crate) struct InspectArgs {
    /// The scene file (RON)
    pub(crate) scene: PathBuf,
    /// Most memory that the files of the scene may take: 512M, 8G
    #[arg(long, value_name = "SIZE", default_value = "4G", value_parser = parse_memory)]
    pub(crate) max_memory: u64,
    /// Print JSON on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

/// `luxel compare`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  luxel compare quick.exr reference.exr            the table
  luxel compare new.png old.png --metric flip --max 0.01
                                                   for scripts: exits with 1 if they differ visibly
  luxel compare quick.exr reference.exr --heatmap where.png
  luxel compare ours.exr theirs.exr --mask peers --json

The second image is the truth, r; the first, x, is measured against it: relMSE = mean((x-r)^2 / (r^2 + 0.01)) and the
bias x - r are not symmetric. All but FLIP is measured in linear light; a PNG is decoded first. FLIP is what a person
would see who alternates between the two on a screen: light is clamped to [0, 1]. The intervals are of 95 %.
Images of different size cannot be compared (2), and a value that is not finite is an error (1), masked or not.")]
pub(crate) struct CompareArgs {
    /// The image to measure (PNG or EXR)
    pub(crate) image: PathBuf,
    /// What it should be (PNG or EXR)
    pub(crate) reference: PathBuf,
    /// What --max limits and --heatmap shows
    #[arg(long, value_enum, value_name = "METRIC", default_value_t = MetricArg::Flip)]
    pub(crate) metric: MetricArg,
    /// Exit with 1 if the metric is above this; not for psnr, which is larger for better images
    #[arg(long, value_name = "X", value_parser = parse_error)]
    pub(crate) max: Option<f64>,
    /// Draw the error of each pixel, black for none: FLIP, or for other metrics the relative error, brightest at 100 %
    #[arg(long, value_name = "FILE.png")]
    pub(crate) heatmap: Option<PathBuf>,
    /// Measure part of the image only
    #[arg(long, value_enum)]
    pub(crate) mask: Option<MaskArg>,
    /// Pixels per degree of sight, for FLIP [default: 67.02, a 4K screen from its own width away]
    #[arg(long, value_name = "N", value_parser = parse_ppd)]
    pub(crate) ppd: Option<f64>,
    /// Print JSON on stdout
    #[arg(long)]
    pub(crate) json: bool,
}

/// `--metric`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MetricArg {
    /// Root of the mean squared error
    Rmse,
    /// Mean squared error relative to the reference's square
    Relmse,
    /// Peak signal to noise ratio in dB, the peak being 1
    Psnr,
    /// Mean visible difference, 0 to 1
    Flip,
}

/// `--mask`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum MaskArg {
    /// Leave out what is brighter than 2 in the reference, and 3 pixels around what is brighter than 8
    Peers,
}

/// `WxH`.
pub(super) fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let side = |s: &str| {
        let side = s.parse::<u32>().ok();
        side.filter(|side| (1..=RenderDesc::MAX_SIDE).contains(side))
    };
    let sides = text.split_once(['x', 'X']);
    let Some((width, height)) = sides.and_then(|(w, h)| Some((side(w)?, side(h)?))) else {
        return Err(format!(
            "write width x height, each 1 to {}, e.g. 640x360",
            RenderDesc::MAX_SIDE
        ));
    };
    if u64::from(width) * u64::from(height) > RenderDesc::MAX_PIXELS {
        return Err(format!(
            "at most {} pixels fit; make a side smaller",
            RenderDesc::MAX_PIXELS
        ));
    }
    Ok((width, height))
}

pub(super) fn parse_time(text: &str) -> Result<Duration, String> {
    const REMEDY: &str = "write a number above 0 with its unit, e.g. 30s, 2m, 500ms, 1.5h";
    // Longer than any render, and still a valid deadline.
    const MAX_SECONDS: f64 = 366.0 * 86400.0;
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let seconds_per_unit = match &text[digits.len()..] {
        "ms" => 1e-3,
        "s" => 1.0,
        "m" | "min" => 60.0,
        "h" => 3600.0,
        _ => return Err(REMEDY.to_owned()),
    };
    let number: f64 = digits.parse().map_err(|_| REMEDY.to_owned())?;
    let seconds = number * seconds_per_unit;
    if !(seconds > 0.0 && seconds <= MAX_SECONDS) {
        return Err(format!("{REMEDY}; at most a year"));
    }
    Ok(Duration::from_secs_f64(seconds))
}

/// Bytes; the suffixes are powers of 1024.
pub(crate) fn parse_memory(text: &str) -> Result<u64, String> {
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = match text[digits.len()..].to_ascii_uppercase().as_str() {
        "K" | "KIB" => Some(10),
        "M" | "MIB" => Some(20),
        "G" | "GIB" => Some(30),
        "T" | "TIB" => Some(40),
        _ => None,
    };
    let bytes = unit.and_then(|unit| digits.parse::<u64>().ok()?.checked_mul(1 << unit));
    bytes
        .filter(|&bytes| bytes > 0)
        .ok_or_else(|| "write a whole number above 0 with its unit, e.g. 512M or 8G".to_owned())
}

fn parse_error(text: &str) -> Result<f64, String> {
    let error: Option<f64> = text.parse().ok();
    error
        .filter(|error| *error >= 0.0)
        .ok_or_else(|| "write an error of at least 0, e.g. 0.01".to_owned())
}

fn parse_ppd(text: &str) -> Result<f64, String> {
    let ppd: Option<f64> = text.parse().ok();
    ppd.filter(|ppd| (10.0..=1000.0).contains(ppd))
        .ok_or_else(|| "write a number of pixels from 10 to 1000, e.g. 67".to_owned())
}

pub(super) fn parse_isa(text: &str) -> Result<Isa, String> {
    let level: Level = text.parse()?;
    Isa::available(level).ok_or_else(|| {
        let have: Vec<String> = Isa::all().map(|isa| isa.level().to_string()).collect();
        format!("this machine has no {level}; it has {}", have.join(", "))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_definition_is_sound() {
        Cli::command().debug_assert();
    }

    #[test]
    fn times_have_units() {
        assert_eq!(parse_time("500ms"), Ok(Duration::from_millis(500)));
        assert_eq!(parse_time("2m"), Ok(Duration::from_secs(120)));
        assert_eq!(parse_time("1.5h"), Ok(Duration::from_secs(5400)));
        for bad in [
            "", "30", "s", "-1s", "0s", "NaNs", "infs", "1e99h", "3 s x", "5d", "1e400s",
        ] {
            assert!(parse_time(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn memory_has_units() {
        assert_eq!(parse_memory("512M"), Ok(512 << 20));
        assert_eq!(parse_memory("8GiB"), Ok(8 << 30));
        assert_eq!(parse_memory("1k"), Ok(1024));
        for bad in [
            "",
            "8",
            "G",
            "-1G",
            "0G",
            "1.5G",
            "99999999T",
            "8GB x",
            "1X",
        ] {
            assert!(parse_memory(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn sizes_have_two_sides() {
        assert_eq!(parse_size("640x360"), Ok((640, 360)));
        for bad in [
            "",
            "640",
            "0x5",
            "5x0",
            "-1x5",
            "640x",
            "99999x1",
            "32768x32768",
            "1x1x1",
        ] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
    }
}
