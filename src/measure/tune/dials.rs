//! The dials that are tried, and how a command line says them.

use crate::build::{Accel, Quality};
use crate::flat::Needs;
use crate::render::Settings;
use crate::trace::{Fresnel, Sampler};

/// What changes time or error, besides samples and size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dials {
    /// Scattering events on a path.
    pub bounces: u32,
    /// Whether lights are sampled.
    pub nee: bool,
    /// Whether light and material samples are weighed against each other; nothing without `nee`.
    pub mis: bool,
    /// Source of random numbers.
    pub sampler: Sampler,
    /// Russian roulette.
    pub roulette: bool,
    /// Reflectance of dielectrics.
    pub fresnel: Fresnel,
    /// How much of a tree.
    pub accel: Accel,
    /// How well trees are built.
    pub quality: Quality,
}

impl Dials {
    /// As settings have them.
    #[must_use]
    pub fn of(settings: &Settings) -> Dials {
        let trace = &settings.trace;
        Dials {
            bounces: trace.max_bounces,
            nee: trace.nee,
            mis: trace.mis,
            sampler: trace.sampler,
            roulette: trace.roulette,
            fresnel: trace.fresnel,
            accel: settings.accel,
            quality: settings.quality,
        }
    }

    /// Sets them.
    pub fn put(&self, settings: &mut Settings) {
        let trace = &mut settings.trace;
        trace.max_bounces = self.bounces;
        trace.nee = self.nee;
        trace.mis = self.mis;
        trace.sampler = self.sampler;
        trace.roulette = self.roulette;
        trace.fresnel = self.fresnel;
        settings.accel = self.accel;
        settings.quality = self.quality;
    }

    /// The arguments of `luxel render` for what is not as in `exact`, which has the defaults but for its bounces.
    #[must_use]
    pub fn arguments(&self, exact: &Dials) -> Vec<(&'static str, String)> {
        let switch = |on: bool| if on { "on" } else { "off" }.to_owned();
        let all = [
            (
                self.bounces != exact.bounces,
                "--bounces",
                self.bounces.to_string(),
            ),
            (self.nee != exact.nee, "--nee", switch(self.nee)),
            (self.mis != exact.mis, "--mis", switch(self.mis)),
            (
                self.sampler != exact.sampler,
                "--sampler",
                sampler_name(self.sampler).to_owned(),
            ),
            (
                self.roulette != exact.roulette,
                "--roulette",
                switch(self.roulette),
            ),
            (
                self.fresnel != exact.fresnel,
                "--fresnel",
                fresnel_name(self.fresnel).to_owned(),
            ),
            (
                self.accel != exact.accel,
                "--accel",
                accel_name(self.accel).to_owned(),
            ),
            (
                self.quality != exact.quality,
                "--tree",
                tree_name(self.quality).to_owned(),
            ),
        ];
        let differ = all.into_iter().filter(|(differs, ..)| *differs);
        differ.map(|(_, name, value)| (name, value)).collect()
    }

    /// The same in a line; empty if nothing differs.
    #[must_use]
    pub fn words(&self, exact: &Dials) -> String {
        let pairs = self.arguments(exact);
        let words: Vec<String> = pairs.iter().map(|(n, v)| format!("{n} {v}")).collect();
        words.join(" ")
    }

    /// How many of the dials that are not as in `exact` change what a picture converges to.
    #[must_use]
    pub fn biases(&self, exact: &Dials, needs: &Needs) -> usize {
        let dark = needs.punctual && exact.nee && !self.nee;
        usize::from(self.bounces != exact.bounces)
            + usize::from(self.fresnel != exact.fresnel)
            + usize::from(dark)
    }
}

/// As on the command line.
#[must_use]
pub fn sampler_name(sampler: Sampler) -> &'static str {
    match sampler {
        Sampler::Independent => "independent",
        Sampler::Sobol => "sobol",
    }
}

/// As on the command line.
#[must_use]
pub fn fresnel_name(fresnel: Fresnel) -> &'static str {
    match fresnel {
        Fresnel::Exact => "exact",
        Fresnel::Schlick => "schlick",
        Fresnel::Off => "off",
    }
}

/// As on the command line.
#[must_use]
pub fn accel_name(accel: Accel) -> &'static str {
    match accel {
        Accel::Brute => "brute",
        Accel::Box => "box",
        Accel::Bvh => "bvh",
    }
}

/// As on the command line.
#[must_use]
pub fn tree_name(quality: Quality) -> &'static str {
    match quality {
        Quality::Good => "good",
        Quality::Fast => "fast",
    }
}

/// Every choice of those dials that change no expectation: they race first. With a light that no ray can meet, lights
/// must be sampled.
pub(super) fn unbiased(exact: &Dials, needs: &Needs) -> Vec<Dials> {
    let lights = [(true, true), (true, false), (false, true)];
    let mut all = vec![*exact];
    for sampler in [Sampler::Sobol, Sampler::Independent] {
        for (nee, mis) in lights {
            for roulette in [true, false] {
                let dials = Dials {
                    sampler,
                    nee,
                    mis,
                    roulette,
                    ..*exact
                };
                let idle = !nee && !needs.lights;
                if dials != *exact && !idle && dials.biases(exact, needs) == 0 {
                    all.push(dials);
                }
            }
        }
    }
    all
}

/// Most primitives for which it is worth a try to have no tree.
const FEW: usize = 256;

/// `base` with one dial turned, that biases or only takes another time.
pub(super) fn variants(base: &Dials, needs: &Needs, primitives: usize) -> Vec<Dials> {
    let full = base.bounces;
    let mut fewer = vec![full * 3 / 4, full / 2, full / 4, 1];
    fewer.retain(|n| (1..full).contains(n));
    fewer.dedup();
    let mut all: Vec<Dials> = (fewer.into_iter())
        .map(|bounces| Dials { bounces, ..*base })
        .collect();
    if needs.glass || needs.plastic {
        let other = [Fresnel::Schlick, Fresnel::Off];
        all.extend(other.map(|fresnel| Dials { fresnel, ..*base }));
    }
    let quality = Quality::Fast;
    all.push(Dials { quality, ..*base });
    if primitives <= FEW {
        let accel = Accel::Brute;
        all.push(Dials { accel, ..*base });
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::TraceOptions;

    const EXACT: Dials = Dials {
        bounces: 8,
        nee: true,
        mis: true,
        sampler: Sampler::Sobol,
        roulette: true,
        fresnel: Fresnel::Exact,
        accel: Accel::Bvh,
        quality: Quality::Good,
    };

    #[test]
    fn only_what_differs_is_said() {
        assert_eq!(EXACT.words(&EXACT), "");
        let other = Dials {
            bounces: 2,
            roulette: false,
            accel: Accel::Brute,
            ..EXACT
        };
        let words = other.words(&EXACT);
        assert_eq!(words, "--bounces 2 --roulette off --accel brute");
    }

    #[test]
    fn defaults_are_those_of_tracing() {
        let trace = TraceOptions::default();
        assert!(trace.nee && trace.mis && trace.roulette);
        assert_eq!(
            (trace.sampler, trace.fresnel),
            (EXACT.sampler, EXACT.fresnel)
        );
        assert_eq!((EXACT.accel, EXACT.quality), Default::default());
    }

    #[test]
    fn a_scene_is_tried_with_what_can_matter() {
        let lit = Needs {
            lights: true,
            ..Needs::default()
        };
        assert_eq!(unbiased(&EXACT, &lit).len(), 12);
        let punctual = Needs {
            punctual: true,
            ..lit
        };
        let all = unbiased(&EXACT, &punctual);
        assert!(all.len() == 8 && all.iter().all(|d| d.nee));
        let glass = Needs { glass: true, ..lit };
        assert_eq!(variants(&EXACT, &glass, 10).len(), 4 + 2 + 2);
        assert_eq!(variants(&EXACT, &lit, 1000).len(), 4 + 1);
        let direct = Dials {
            bounces: 1,
            ..EXACT
        };
        assert_eq!(variants(&direct, &lit, 1000).len(), 1);
    }
}
