//! The arguments of whatever renders frames of a scene: what they look like, and what computes them.

use super::args::{parse_isa, parse_memory, parse_size};
use crate::build::{Accel, Quality};
use crate::film::Aov;
use crate::render::Settings;
use crate::scene::{RenderDesc, SceneDesc};
use crate::trace::isa::Isa;
use crate::trace::{Fresnel, Sampler, TraceOptions};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum, value_parser};

/// What a frame is rendered with, but for the number of its samples.
#[derive(Clone, Debug, Args)]
pub(crate) struct DialArgs {
    /// Width and height in pixels [default: the scene's]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub(crate) size: Option<(u32, u32)>,
    /// Scattering events on a path; 1 is direct light only [default: the scene's]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(0..=i64::from(RenderDesc::MAX_BOUNCES)))]
    pub(crate) bounces: Option<u32>,
    /// Exposure of a PNG in stops: +1 is twice as bright. An EXR stays linear
    #[arg(long, value_name = "EV", default_value_t = 0.0, allow_negative_numbers = true, value_parser = parse_exposure)]
    pub(crate) exposure: f64,
    /// Another seed is another picture of the same scene, with other noise
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(crate) seed: u64,
    /// Where random numbers come from
    #[arg(long, value_enum, default_value_t = SamplerArg::Sobol)]
    pub(crate) sampler: SamplerArg,
    /// Worker threads [default: what Slurm, else affinity and cgroup leave to the process]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Instruction set: scalar, sse2, avx2, avx512 [default: the best that this machine has]
    #[arg(long, value_name = "ISA", value_parser = parse_isa)]
    pub(crate) isa: Option<Isa>,
    /// How rays find what they hit: test everything, a box per mesh, or the tree
    #[arg(long, value_enum, default_value_t = AccelArg::Bvh)]
    pub(crate) accel: AccelArg,
    /// How well the tree is built: good, or fast, in a third of the time, for many triangles and few samples
    #[arg(long, value_enum, default_value_t = TreeArg::Good)]
    pub(crate) tree: TreeArg,
    /// Side of a tile in pixels
    #[arg(long, value_name = "N", default_value_t = crate::render::Settings::DEFAULT_TILE, value_parser = value_parser!(u32).range(1..=4096))]
    pub(crate) tile: u32,
    /// More images in the EXR file, separated by commas
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = aov_parser())]
    pub(crate) aov: Vec<Aov>,
    /// Sample lights directly (next-event estimation); off, `light: Point, Spot, Sun` are not found and do not shine
    #[arg(long, value_enum, default_value_t = Switch::On)]
    pub(crate) nee: Switch,
    /// Weigh light and material samples against each other (multiple importance sampling)
    #[arg(long, value_enum, default_value_t = Switch::On)]
    pub(crate) mis: Switch,
    /// Also sample lamps through and by balls of glass, mirror and metal: less noise where their caustics are seen, for
    /// an eighth to a third more time. Part of --nee and --mis
    #[arg(long, value_enum, default_value_t = Switch::Off)]
    pub(crate) caustics: Switch,
    /// With --noise, give each part of the image as many samples as it needs; off, all of it the same
    #[arg(long, value_enum, default_value_t = Switch::On)]
    pub(crate) adaptive: Switch,
    /// End dim paths at random, without bias
    #[arg(long, value_enum, default_value_t = Switch::On)]
    pub(crate) roulette: Switch,
    /// Reflectance of glass and plastic
    #[arg(long, value_enum, default_value_t = FresnelArg::Exact)]
    pub(crate) fresnel: FresnelArg,
    /// Fail (65) where `luxel check` has warnings, before rendering, or where a sample is not finite, after it
    #[arg(long)]
    pub(crate) strict: bool,
    /// Most memory that the files of the scene may take: 512M, 8G
    #[arg(long, value_name = "SIZE", default_value = "4G", value_parser = parse_memory)]
    pub(crate) max_memory: u64,
    /// The same noise in every frame, which then seems to hang before the picture; else every frame has its own
    #[arg(long)]
    pub(crate) fixed_noise: bool,
}

impl DialArgs {
    /// The scene's settings, overridden by the arguments.
    pub(crate) fn settings(&self, desc: &SceneDesc, spp: Option<u32>) -> Settings {
        let defaults = Settings::of_scene(desc);
        Settings {
            size: self.size.unwrap_or(defaults.size),
            spp: spp.unwrap_or(defaults.spp),
            threads: self.threads.map(usize::from),
            tile: self.tile,
            accel: self.accel.into(),
            quality: self.tree.into(),
            fixed_noise: self.fixed_noise,
            adaptive: self.adaptive.is_on(),
            trace: TraceOptions {
                max_bounces: self.bounces.unwrap_or(defaults.trace.max_bounces),
                seed: self.seed,
                sampler: self.sampler.into(),
                nee: self.nee.is_on(),
                mis: self.mis.is_on(),
                caustics: self.caustics.is_on(),
                roulette: self.roulette.is_on(),
                fresnel: self.fresnel.into(),
                isa: self.isa(),
                features: self.aov.iter().any(|aov| aov.is_feature()),
                ids: self.aov.iter().any(|aov| aov.is_id()),
            },
            ..defaults
        }
    }

    /// The same for renders that may end at an error: without a number of samples, at as many as that takes.
    pub(crate) fn settings_to(
        &self,
        desc: &SceneDesc,
        spp: Option<u32>,
        noise: Option<f64>,
    ) -> Settings {
        let endless = noise.is_some().then_some(RenderDesc::MAX_SPP);
        Settings {
            noise,
            ..self.settings(desc, spp.or(endless))
        }
    }

    /// The kernels' instruction set.
    pub(crate) fn isa(&self) -> Isa {
        self.isa.unwrap_or_else(Isa::best)
    }
}

/// `on` or `off`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Switch {
    On,
    Off,
}

impl Switch {
    /// Whether it is on.
    pub(crate) fn is_on(self) -> bool {
        self == Switch::On
    }
}

/// `--sampler`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum SamplerArg {
    /// A hash per sample and dimension
    Independent,
    /// Owen-scrambled Sobol points
    Sobol,
}

impl From<SamplerArg> for Sampler {
    fn from(arg: SamplerArg) -> Sampler {
        match arg {
            SamplerArg::Independent => Sampler::Independent,
            SamplerArg::Sobol => Sampler::Sobol,
        }
    }
}

/// `--fresnel`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum FresnelArg {
    /// Fresnel's equations
    Exact,
    /// Schlick's approximation
    Schlick,
    /// Nothing is reflected, except totally
    Off,
}

impl From<FresnelArg> for Fresnel {
    fn from(arg: FresnelArg) -> Fresnel {
        match arg {
            FresnelArg::Exact => Fresnel::Exact,
            FresnelArg::Schlick => Fresnel::Schlick,
            FresnelArg::Off => Fresnel::Off,
        }
    }
}

/// `--accel`.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum AccelArg {
    /// Every ray against every primitive
    Brute,
    /// A bounding box around each mesh
    Box,
    /// The bounding volume hierarchy
    Bvh,
}

impl From<AccelArg> for Accel {
    fn from(arg: AccelArg) -> Accel {
        match arg {
            AccelArg::Brute => Accel::Brute,
            AccelArg::Box => Accel::Box,
            AccelArg::Bvh => Accel::Bvh,
        }
    }
}

/// `--tree`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum TreeArg {
    /// By the surface area heuristic throughout
    Good,
    /// Along the Morton curve at the bottom
    Fast,
}

impl TreeArg {
    /// As it is written.
    pub(crate) fn name(self) -> &'static str {
        match self {
            TreeArg::Good => "good",
            TreeArg::Fast => "fast",
        }
    }
}

impl From<TreeArg> for Quality {
    fn from(arg: TreeArg) -> Quality {
        match arg {
            TreeArg::Good => Quality::Good,
            TreeArg::Fast => Quality::Fast,
        }
    }
}

fn aov_parser() -> impl TypedValueParser<Value = Aov> {
    PossibleValuesParser::new(Aov::ALL.map(Aov::name)).map(|name| {
        let known = Aov::ALL.into_iter().find(|aov| aov.name() == name);
        known.unwrap_or(Aov::Samples)
    })
}

fn parse_exposure(text: &str) -> Result<f64, String> {
    let stops: Option<f64> = text.parse().ok();
    stops
        .filter(|stops| (-64.0..=64.0).contains(stops))
        .ok_or_else(|| "write a number of stops from -64 to 64, e.g. -1.5".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exposures_are_stops() {
        assert_eq!(parse_exposure("-1.5"), Ok(-1.5));
        for bad in ["", "bright", "NaN", "inf", "65"] {
            assert!(parse_exposure(bad).is_err(), "{bad}");
        }
    }
}
