//! The entries of the rivals: one function per instruction set, as `trace::kernels::entries` has them.
#![allow(
    unsafe_code,
    reason = "an entry is called on the proof that the machine has its instructions"
)]

use super::layouts::Primitives;
use super::nodes::{Node, Tree};
use super::walk::{self, Answers};
use super::work::Work;
use crate::math::lanes::baseline;
use crate::trace::isa::Level;
use crate::trace::{Isa, Rays};

/// A function for an instruction set, in a module of its name: its lanes, its features.
macro_rules! entry {
    ($level:ident, $lanes:ty $(, $features:literal)?) => {
        mod $level {
            use super::*;

            $(#[target_feature(enable = $features)])?
            #[inline(never)]
            pub(super) fn batch<N: Node, P: Primitives>(
                tree: &Tree<N>,
                primitives: &P,
                rays: &Rays,
                answers: Answers,
            ) {
                walk::batch::<$lanes, N, P>(tree, primitives, rays, answers, &mut ());
            }
        }
    };
}

entry!(scalar, f32);
entry!(sse2, baseline::F32x8);
#[cfg(target_arch = "x86_64")]
entry!(avx2, crate::math::lanes::avx2::F32x8, "avx2");

/// Traces a batch. Above AVX2 there is no entry: eight lanes do not fill its registers.
pub(super) fn batch<N: Node, P: Primitives>(
    isa: Isa,
    tree: &Tree<N>,
    primitives: &P,
    rays: &Rays,
    answers: Answers,
) {
    match isa.level() {
        Level::Scalar if P::SCALAR => scalar::batch(tree, primitives, rays, answers),
        // SAFETY: the value is the proof that this machine has the instructions: AVX2 is part of both levels.
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 | Level::Avx512 => unsafe { avx2::batch(tree, primitives, rays, answers) },
        _ => sse2::batch(tree, primitives, rays, answers),
    }
}

/// Traces a batch on one lane and counts.
#[inline(never)]
pub(super) fn counted<N: Node, P: Primitives>(
    tree: &Tree<N>,
    primitives: &P,
    rays: &Rays,
    answers: Answers,
) -> Work {
    let mut work = Work::default();
    walk::batch::<f32, N, P>(tree, primitives, rays, answers, &mut work);
    work
}
