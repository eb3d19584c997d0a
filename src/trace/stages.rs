//! The entries of the stages in lanes: one set of functions per instruction set, the only ones here with
//! `#[target_feature]`. AVX-512 takes AVX2's.
#![allow(
    unsafe_code,
    reason = "an entry is called on the proof that the machine has its instructions"
)]

use super::camera;
use super::chain;
use super::roulette;
use super::scatter::{self, Bounce};
use super::surface;
use super::wave::Wave;
use super::{Isa, Sampler, isa::Level};
use crate::flat::{Camera, FlatScene, Scatter};
#[cfg(target_arch = "x86_64")]
use crate::math::lanes::avx2 as avx2_lanes;
use crate::math::lanes::baseline;

macro_rules! stages {
    ($lanes:ty $(, $features:literal)?) => {
        $(#[target_feature(enable = $features)])?
        #[inline(never)]
        pub(super) fn generate(wave: &mut Wave, camera: &Camera, sampler: Sampler) {
            camera::generate::<$lanes>(wave, camera, sampler);
        }

        $(#[target_feature(enable = $features)])?
        #[inline(never)]
        pub(super) fn surface(wave: &mut Wave, scene: &FlatScene) {
            surface::surface::<$lanes>(wave, scene);
        }

        $(#[target_feature(enable = $features)])?
        #[inline(never)]
        pub(super) fn sample_lights(wave: &mut Wave, bounce: Bounce) {
            scatter::sample_lights::<$lanes>(wave, bounce);
        }

        $(#[target_feature(enable = $features)])?
        #[inline(never)]
        pub(super) fn sample_chains(wave: &mut Wave, bounce: Bounce) {
            chain::sample::<$lanes>(wave, bounce);
        }

        $(#[target_feature(enable = $features)])?
        #[inline(never)]
        pub(super) fn sample_bsdf(wave: &mut Wave, bounce: Bounce, kind: Scatter) {
            scatter::sample_bsdf::<$lanes>(wave, bounce, kind);
        }

        $(#[target_feature(enable = $features)])?
        #[inline(never)]
        pub(super) fn roulette(wave: &mut Wave, bounce: Bounce) {
            roulette::roulette::<$lanes>(wave, bounce);
        }

        $(#[target_feature(enable = $features)])?
        #[inline(never)]
        pub(super) fn compact(wave: &mut Wave) {
            wave.paths.compact::<$lanes>(&wave.alive);
        }
    };
}

mod scalar {
    use super::*;
    stages!(f32);
}

mod sse2 {
    use super::*;
    stages!(baseline::F32x8);
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use super::*;
    stages!(avx2_lanes::F32x8, "avx2,bmi1,bmi2,lzcnt,popcnt");
}

/// Calls the entry of an instruction set.
macro_rules! on_isa {
    ($isa:expr, $entry:ident($($argument:expr),*)) => {
        match $isa.level() {
            Level::Scalar => scalar::$entry($($argument),*),
            // SAFETY: the value is the proof that this machine has the instructions.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 | Level::Avx512 => unsafe { avx2::$entry($($argument),*) },
            _ => sse2::$entry($($argument),*),
        }
    };
}

/// [`camera::generate`].
pub(super) fn generate(isa: Isa, wave: &mut Wave, camera: &Camera, sampler: Sampler) {
    on_isa!(isa, generate(wave, camera, sampler));
}

/// [`surface::surface`].
pub(super) fn surface(isa: Isa, wave: &mut Wave, scene: &FlatScene) {
    on_isa!(isa, surface(wave, scene));
}

/// [`scatter::sample_lights`].
pub(super) fn sample_lights(wave: &mut Wave, bounce: Bounce) {
    on_isa!(bounce.options.isa, sample_lights(wave, bounce));
}

/// [`chain::sample`].
pub(super) fn sample_chains(wave: &mut Wave, bounce: Bounce) {
    on_isa!(bounce.options.isa, sample_chains(wave, bounce));
}

/// [`scatter::sample_bsdf`].
pub(super) fn sample_bsdf(wave: &mut Wave, bounce: Bounce, kind: Scatter) {
    on_isa!(bounce.options.isa, sample_bsdf(wave, bounce, kind));
}

/// [`roulette::roulette`].
pub(super) fn roulette(wave: &mut Wave, bounce: Bounce) {
    on_isa!(bounce.options.isa, roulette(wave, bounce));
}

/// [`super::wave::Paths::compact`], by what is alive.
pub(super) fn compact(isa: Isa, wave: &mut Wave) {
    on_isa!(isa, compact(wave));
}
