//! What an image says about how it was made: what can change a pixel, and nothing else.

use super::Settings;
use crate::asset::AssetStore;
use crate::film::Metadata;
use crate::flat::PixelFilter;
use crate::scene::{RenderDesc, SceneDesc};
use crate::trace::{Fresnel, Sampler};
use sha2::{Digest, Sha256};

/// SHA-256 over the scene file's text and the contents of every file that it names, as 64 hexadecimal digits.
pub(super) fn scene_hash(desc: &SceneDesc, store: &AssetStore) -> String {
    let mut hash = Sha256::new();
    // The length keeps the border between the two parts.
    hash.update((desc.source.len() as u64).to_le_bytes());
    hash.update(desc.source.as_bytes());
    hash.update(store.hash());
    hash.finalize().iter().map(|b| format!("{b:02x}")).collect()
}

/// The samples of a frame.
#[derive(Clone, Copy)]
pub(super) struct Samples {
    /// In every pixel, if that is known.
    pub(super) spp: Option<u32>,
    /// Whether a deadline cut them off: then no setting tells their number.
    pub(super) cut: bool,
}

/// The metadata of a frame. What only one file format has, as a PNG its exposure, is the caller's to add.
pub(super) fn metadata(
    hash: &str,
    frame: u32,
    filter: PixelFilter,
    settings: &Settings,
    samples: Samples,
) -> Metadata {
    let (width, height) = settings.size;
    let dials = &settings.trace;
    let switch = |on| if on { "on" } else { "off" };
    let mut metadata = Metadata::default();
    metadata.push("version", env!("CARGO_PKG_VERSION"));
    metadata.push("scene", hash);
    metadata.push("frame", frame);
    metadata.push("size", format!("{width}x{height}"));
    if let Some(spp) = samples.spp {
        metadata.push("spp", spp);
    }
    if let Some(error) = settings.noise.filter(|_| !samples.cut) {
        metadata.push("error", wanted(error, settings.spp));
        if !settings.adaptive {
            metadata.push("adaptive", "off");
        }
    }
    metadata.push("seed", dials.seed);
    metadata.push("bounces", dials.max_bounces);
    metadata.push("filter", filter_name(filter));
    let sampler = match dials.sampler {
        Sampler::Independent => "independent",
        Sampler::Sobol => "sobol",
    };
    metadata.push("sampler", sampler);
    metadata.push("nee", switch(dials.nee));
    metadata.push("mis", switch(dials.mis));
    if dials.caustics {
        metadata.push("caustics", "on");
    }
    metadata.push("roulette", switch(dials.roulette));
    let fresnel = match dials.fresnel {
        Fresnel::Exact => "exact",
        Fresnel::Schlick => "schlick",
        Fresnel::Off => "off",
    };
    metadata.push("fresnel", fresnel);
    if settings.fixed_noise {
        metadata.push("noise", "fixed");
    }
    metadata
}

/// The error that was asked for, and where the samples had to end.
fn wanted(error: f64, most: u32) -> String {
    match most {
        RenderDesc::MAX_SPP => error.to_string(),
        most => format!("{error} or {most} spp"),
    }
}

fn filter_name(filter: PixelFilter) -> String {
    match filter {
        PixelFilter::Box => "box".to_owned(),
        PixelFilter::Gaussian(radius) => format!("gaussian {radius}px"),
    }
}
