//! The settings that `luxel tune` found, beside the scene, and `luxel render -q`, which takes them.

use super::args::RenderArgs;
use super::dial_args::{AccelArg, FresnelArg, SamplerArg, Switch, TreeArg};
use super::failure::Failure;
use super::say;
use crate::measure::tune::{Pick, Quality, Report, report};
use crate::measure::tune::{accel_name, fresnel_name, sampler_name, tree_name};
use crate::scene::RenderDesc;
use clap::ValueEnum;
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

/// `--quality`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum QualityArg {
    /// Is everything in its place?
    Draft,
    /// Is the light right?
    Preview,
    /// To show
    Final,
}

impl QualityArg {
    fn name(self) -> &'static str {
        match self {
            QualityArg::Draft => Quality::Draft.name(),
            QualityArg::Preview => Quality::Preview.name(),
            QualityArg::Final => Quality::Final.name(),
        }
    }
}

/// `SCENE.tune.json` beside `SCENE.ron`.
pub(crate) fn path_of(scene: &Path) -> PathBuf {
    scene.with_extension("tune.json")
}

/// The file: the scene's hash, and the settings of every quality that can be reached.
pub(crate) fn text(found: &Report, picks: &[Pick], hash: &str) -> String {
    let switch = |on: bool| if on { "on" } else { "off" };
    let mut qualities = Map::new();
    for pick in picks {
        let dials = &found.rows[pick.row].dials;
        let settings = json!({
            "size": format!("{}x{}", pick.size.0, pick.size.1),
            "spp": pick.spp,
            "bounces": dials.bounces,
            "nee": switch(dials.nee),
            "mis": switch(dials.mis),
            "sampler": sampler_name(dials.sampler),
            "roulette": switch(dials.roulette),
            "fresnel": fresnel_name(dials.fresnel),
            "accel": accel_name(dials.accel),
            "tree": tree_name(dials.quality),
            "arguments": report::arguments(found, pick),
            "error": pick.error,
            "bias": pick.bias,
            "cpu_seconds": pick.seconds,
        });
        qualities.insert(pick.quality.name().to_owned(), settings);
    }
    let value = json!({
        "version": env!("CARGO_PKG_VERSION"),
        "scene": hash,
        "size": format!("{}x{}", found.full.0, found.full.1),
        "qualities": qualities,
    });
    format!("{value:#}\n")
}

/// Arguments with the settings of a quality, and the hash of the scene that they were found for.
pub(crate) struct Tuned {
    /// As given, and what they leave open from the file.
    pub(crate) args: RenderArgs,
    file: PathBuf,
    scene: String,
}

impl Tuned {
    /// What `-q` asks for; `None` if it is not there.
    pub(crate) fn read(args: &RenderArgs) -> Result<Option<Tuned>, Failure> {
        let Some(quality) = args.quality else {
            return Ok(None);
        };
        let file = path_of(&args.scene);
        let bytes = std::fs::read(&file)
            .map_err(|cause| Failure::untuned(quality.name(), &file, &args.scene, &cause))?;
        let found: Value =
            serde_json::from_slice(&bytes).map_err(|e| bad(&file, &e.to_string()))?;
        let scene = words(&found, "scene").ok_or_else(|| bad(&file, "no `scene`"))?;
        let settings = &found["qualities"][quality.name()];
        if settings.is_null() {
            let reason = format!("no settings for {}", quality.name());
            return Err(bad(&file, &reason));
        }
        let mut args = args.clone();
        put(&mut args, settings).map_err(|key| bad(&file, &format!("no good `{key}`")))?;
        Ok(Some(Tuned {
            args,
            scene: scene.to_owned(),
            file,
        }))
    }

    /// Tells of a scene that is not the one that was tuned.
    pub(crate) fn warn_if_stale(&self, hash: &str) {
        if self.scene != hash {
            say(&format!(
                "warning: the scene has changed since \"{}\" was written: its settings may no longer be the best\n  \
                 = help: luxel tune {}",
                self.file.display(),
                self.args.scene.display()
            ));
        }
    }
}

fn bad(file: &Path, reason: &str) -> Failure {
    Failure::bad_file(format!(
        "\"{}\" has {reason}; write it anew with `luxel tune`",
        file.display()
    ))
}

/// Sets what the command line leaves open. The name of what is missing or not allowed is the error.
fn put(args: &mut RenderArgs, settings: &Value) -> Result<(), &'static str> {
    let whole = |key: &'static str, range: std::ops::RangeInclusive<u32>| {
        let number = settings[key].as_u64().and_then(|n| u32::try_from(n).ok());
        number.filter(|n| range.contains(n)).ok_or(key)
    };
    let size = words(settings, "size").and_then(|text| super::args::parse_size(text).ok());
    args.dials.size = Some(args.dials.size.unwrap_or(size.ok_or("size")?));
    let spp = whole("spp", 1..=RenderDesc::MAX_SPP)?;
    args.spp = Some(args.spp.unwrap_or(spp));
    let bounces = whole("bounces", 0..=RenderDesc::MAX_BOUNCES)?;
    args.dials.bounces = Some(args.dials.bounces.unwrap_or(bounces));
    args.dials.nee = named::<Switch>(settings, "nee")?;
    args.dials.mis = named::<Switch>(settings, "mis")?;
    args.dials.sampler = named::<SamplerArg>(settings, "sampler")?;
    args.dials.roulette = named::<Switch>(settings, "roulette")?;
    args.dials.fresnel = named::<FresnelArg>(settings, "fresnel")?;
    args.dials.accel = named::<AccelArg>(settings, "accel")?;
    args.dials.tree = named::<TreeArg>(settings, "tree")?;
    Ok(())
}

fn words<'a>(value: &'a Value, key: &str) -> Option<&'a str> {
    value[key].as_str()
}

fn named<T: ValueEnum>(settings: &Value, key: &'static str) -> Result<T, &'static str> {
    let value = words(settings, key).and_then(|text| T::from_str(text, false).ok());
    value.ok_or(key)
}
