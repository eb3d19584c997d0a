//! The arguments of `turntable` and `convert`.

use super::args::{parse_memory, parse_size};
use super::goal_args::parse_noise;
use super::progress::How;
use crate::author::Up;
use crate::scene::RenderDesc;
use clap::{Args, ValueEnum, value_parser};
use std::path::PathBuf;

/// `luxel turntable`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  luxel turntable cat.obj                          cat.gif, a draft
  luxel turntable part.obj --up z --size 640x480 --spp 64
  luxel turntable cat.obj -o turn/cat_####.png     a sequence: turn/cat_0000.png and so on
  luxel turntable cat.obj --scene cat.ron          the scene as well, to go on from

Camera, light and floor fit any size, origin and up axis. The frames are those of `luxel render` with that scene.
Ctrl-C keeps the frames that are finished, of a GIF in NAME.partial.gif, and exits with 130.")]
pub(crate) struct TurntableArgs {
    /// The mesh: .obj, .gltf or .glb
    pub(crate) mesh: PathBuf,
    /// Where to write the turn [default: MESH.gif in this folder]
    #[arg(long, value_name = "FILE.gif")]
    pub(crate) gif: Option<PathBuf>,
    /// The same, or PNG files whose numbers take the place of #: frame_####.png
    #[arg(short, long, value_name = "FILE", conflicts_with = "gif")]
    pub(crate) output: Option<PathBuf>,
    /// Frames of the turn [default: 12.5 a second]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=3600))]
    pub(crate) frames: Option<u32>,
    /// How long the turn takes [default: 3.2, or longer for more than 40 frames]
    #[arg(long, value_name = "S", value_parser = parse_seconds)]
    pub(crate) seconds: Option<f64>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "240x240", value_parser = parse_size)]
    pub(crate) size: (u32, u32),
    /// Samples per pixel
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = value_parser!(u32).range(1..=i64::from(RenderDesc::MAX_SPP)))]
    pub(crate) spp: u32,
    /// As many samples in each frame as bring it to this relative error, 1% or 0.01, in place of --spp
    #[arg(long, value_name = "ERROR", value_parser = parse_noise, conflicts_with = "spp")]
    pub(crate) noise: Option<f64>,
    /// Which axis of the mesh points up
    #[arg(long, value_enum, value_name = "AXIS", default_value_t = UpArg::Y, allow_hyphen_values = true)]
    pub(crate) up: UpArg,
    /// Write the scene too, as a start for one of your own
    #[arg(long, value_name = "FILE.ron")]
    pub(crate) scene: Option<PathBuf>,
    /// Most memory that the files may take: 512M, 8G
    #[arg(long, value_name = "SIZE", default_value = "4G", value_parser = parse_memory)]
    pub(crate) max_memory: u64,
    /// Worker threads [default: what Slurm, else affinity and cgroup leave to the process]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// How progress is told on stderr
    #[arg(long, value_enum, value_name = "HOW", default_value_t = How::Auto)]
    pub(crate) progress: How,
}

/// `luxel convert`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  luxel convert room.glb -o room.ron               every node an entity; the meshes stay in room.glb
  luxel convert cat.obj                            cat.ron

Plain materials become named ones, textured ones stay those of the file. A camera and a light are added where the file
has none, and a comment says so. A scene that is there already is not overwritten.")]
pub(crate) struct ConvertArgs {
    /// The mesh: .obj, .gltf or .glb
    pub(crate) mesh: PathBuf,
    /// The scene file to write [default: MESH.ron in this folder]
    #[arg(short, long, value_name = "FILE.ron")]
    pub(crate) output: Option<PathBuf>,
    /// Most memory that the files may take: 512M, 8G
    #[arg(long, value_name = "SIZE", default_value = "4G", value_parser = parse_memory)]
    pub(crate) max_memory: u64,
}

/// `--up`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum UpArg {
    /// As in luxel and glTF
    Y,
    /// As in CAD and Blender
    Z,
    /// To the right in the file
    X,
    #[value(name = "-y", help = "Upside down")]
    MinusY,
    #[value(name = "-z", help = "Against z")]
    MinusZ,
    #[value(name = "-x", help = "Against x")]
    MinusX,
}

impl From<UpArg> for Up {
    fn from(arg: UpArg) -> Up {
        match arg {
            UpArg::X => Up::X,
            UpArg::Y => Up::Y,
            UpArg::Z => Up::Z,
            UpArg::MinusX => Up::MinusX,
            UpArg::MinusY => Up::MinusY,
            UpArg::MinusZ => Up::MinusZ,
        }
    }
}

fn parse_seconds(text: &str) -> Result<f64, String> {
    // The longest time that a GIF can show one frame is a little more.
    let seconds: Option<f64> = text.parse().ok();
    seconds
        .filter(|seconds| (0.01..=600.0).contains(seconds))
        .ok_or_else(|| "write a number of seconds from 0.01 to 600, e.g. 2.5".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_takes_its_time() {
        assert_eq!(parse_seconds("2.5"), Ok(2.5));
        for bad in ["", "0", "-1", "3s", "NaN", "inf", "601"] {
            assert!(parse_seconds(bad).is_err(), "{bad}");
        }
    }
}
