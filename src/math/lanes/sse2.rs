//! Lanes of SSE2, in registers of four f32 or two f64: what every x86-64 has. The same as [`portable`](super::portable), which
//! the compiler would have to put together from single numbers, at a multiple of the compile time.
//!
//! Every `unsafe` block here has one reason: this module exists on x86-64 alone, whose baseline is SSE2; nothing else is
//! required of a caller, but that pointers are those of slices whose length was just checked.
#![allow(unsafe_code, reason = "intrinsics live here")]

use super::{Lanes, WideLanes};
use std::arch::x86_64::*;
use std::array::from_fn;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

/// So many registers of four f32.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(crate) struct Floats<const R: usize>(pub(super) [__m128; R]);

/// As many f64, two registers for each of those.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(crate) struct Doubles<const R: usize>(pub(super) [[__m128d; 2]; R]);

/// As many truth values: all bits or none.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(crate) struct Truths<const R: usize>(pub(super) [__m128; R]);

/// Four f32.
pub(crate) type F32x4 = Floats<1>;

/// Eight f32.
pub(crate) type F32x8 = Floats<2>;

macro_rules! operators {
    ($lanes:ident: $($trait:ident::$method:ident $intrinsic:ident),*) => {
        $(impl<const R: usize> $trait for $lanes<R> {
            type Output = $lanes<R>;
            #[inline(always)]
            fn $method(self, other: $lanes<R>) -> $lanes<R> {
                // SAFETY: the machine has SSE2, see the module.
                $lanes(from_fn(|r| unsafe { $intrinsic(self.0[r], other.0[r]) }))
            }
        })*
    };
}
operators!(Floats: Add::add _mm_add_ps, Sub::sub _mm_sub_ps, Mul::mul _mm_mul_ps, Div::div _mm_div_ps);
operators!(Truths: BitAnd::bitand _mm_and_ps, BitOr::bitor _mm_or_ps);

macro_rules! wide_operators {
    ($($trait:ident::$method:ident $intrinsic:ident),*) => {
        $(impl<const R: usize> $trait for Doubles<R> {
            type Output = Doubles<R>;
            #[inline(always)]
            fn $method(self, other: Doubles<R>) -> Doubles<R> {
                // SAFETY: the machine has SSE2, see the module.
                self.with(other, |a, b| unsafe { $intrinsic(a, b) })
            }
        })*
    };
}
wide_operators!(Add::add _mm_add_pd, Sub::sub _mm_sub_pd, Mul::mul _mm_mul_pd, Div::div _mm_div_pd);

impl<const R: usize> Neg for Floats<R> {
    type Output = Floats<R>;
    #[inline(always)]
    fn neg(self) -> Floats<R> {
        // SAFETY: the machine has SSE2, see the module.
        Floats(self.0.map(|x| unsafe { _mm_xor_ps(x, _mm_set1_ps(-0.0)) }))
    }
}

impl<const R: usize> Neg for Doubles<R> {
    type Output = Doubles<R>;
    #[inline(always)]
    fn neg(self) -> Doubles<R> {
        // SAFETY: the machine has SSE2, see the module.
        self.with(self, |x, _| unsafe { _mm_xor_pd(x, _mm_set1_pd(-0.0)) })
    }
}

impl<const R: usize> Doubles<R> {
    /// Register by register.
    #[inline(always)]
    fn with(self, other: Doubles<R>, f: impl Fn(__m128d, __m128d) -> __m128d) -> Doubles<R> {
        let half = |r: usize, h: usize| f(self.0[r][h], other.0[r][h]);
        Doubles(from_fn(|r| [half(r, 0), half(r, 1)]))
    }
}

impl<const R: usize> Lanes for Floats<R> {
    const N: usize = 4 * R;
    type Mask = Truths<R>;
    type Wide = Doubles<R>;

    #[inline(always)]
    fn splat(x: f32) -> Floats<R> {
        // SAFETY: the machine has SSE2, see the module.
        Floats([unsafe { _mm_set1_ps(x) }; R])
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Floats<R> {
        let from = &from[..4 * R];
        // SAFETY: the machine has SSE2, see the module; four elements are there for every register.
        Floats(from_fn(|r| unsafe {
            _mm_loadu_ps(from.as_ptr().add(4 * r))
        }))
    }
    #[inline(always)]
    fn load_bytes(from: &[u8]) -> Floats<R> {
        let from = &from[..4 * R];
        let word = |r: usize| {
            from[4 * r..]
                .first_chunk::<4>()
                .map_or(0, |&b| i32::from_le_bytes(b))
        };
        // SAFETY: the machine has SSE2, see the module.
        Floats(from_fn(|r| unsafe {
            let zero = _mm_setzero_si128();
            let pairs = _mm_unpacklo_epi8(_mm_cvtsi32_si128(word(r)), zero);
            _mm_cvtepi32_ps(_mm_unpacklo_epi16(pairs, zero))
        }))
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..4 * R];
        for (r, x) in self.0.into_iter().enumerate() {
            // SAFETY: the machine has SSE2, see the module; four elements are there for every register.
            unsafe { _mm_storeu_ps(to.as_mut_ptr().add(4 * r), x) }
        }
    }
    #[inline(always)]
    fn lt(self, other: Floats<R>) -> Truths<R> {
        // SAFETY: the machine has SSE2, see the module.
        Truths(from_fn(|r| unsafe { _mm_cmplt_ps(self.0[r], other.0[r]) }))
    }
    #[inline(always)]
    fn le(self, other: Floats<R>) -> Truths<R> {
        // SAFETY: the machine has SSE2, see the module.
        Truths(from_fn(|r| unsafe { _mm_cmple_ps(self.0[r], other.0[r]) }))
    }
    #[inline(always)]
    fn select(mask: Truths<R>, yes: Floats<R>, no: Floats<R>) -> Floats<R> {
        // SAFETY: the machine has SSE2, see the module.
        Floats(from_fn(|r| unsafe {
            let yes = _mm_and_ps(mask.0[r], yes.0[r]);
            _mm_or_ps(yes, _mm_andnot_ps(mask.0[r], no.0[r]))
        }))
    }
    #[inline(always)]
    fn bits(mask: Truths<R>) -> u32 {
        let mut bits = 0;
        for (r, m) in mask.0.into_iter().enumerate() {
            // SAFETY: the machine has SSE2, see the module.
            bits |= unsafe { _mm_movemask_ps(m) as u32 } << (4 * r);
        }
        bits
    }
    #[inline(always)]
    fn abs(self) -> Floats<R> {
        // SAFETY: the machine has SSE2, see the module.
        Floats(
            self.0
                .map(|x| unsafe { _mm_andnot_ps(_mm_set1_ps(-0.0), x) }),
        )
    }
    #[inline(always)]
    fn sqrt(self) -> Floats<R> {
        // SAFETY: the machine has SSE2, see the module.
        Floats(self.0.map(|x| unsafe { _mm_sqrt_ps(x) }))
    }
    #[inline(always)]
    fn min(self, other: Floats<R>) -> Floats<R> {
        // SAFETY: the machine has SSE2, see the module.
        Floats(from_fn(|r| unsafe { _mm_min_ps(self.0[r], other.0[r]) }))
    }
    #[inline(always)]
    fn max(self, other: Floats<R>) -> Floats<R> {
        // SAFETY: the machine has SSE2, see the module.
        Floats(from_fn(|r| unsafe { _mm_max_ps(self.0[r], other.0[r]) }))
    }
    #[inline(always)]
    fn least(self) -> f32 {
        let mut lanes = [[0.0; 4]; R];
        self.store(lanes.as_flattened_mut());
        lanes.into_iter().flatten().fold(f32::INFINITY, Lanes::min)
    }
    #[inline(always)]
    fn greatest(self) -> f32 {
        let mut lanes = [[0.0; 4]; R];
        self.store(lanes.as_flattened_mut());
        lanes
            .into_iter()
            .flatten()
            .fold(f32::NEG_INFINITY, Lanes::max)
    }
    #[inline(always)]
    fn widen(self) -> Doubles<R> {
        // SAFETY: the machine has SSE2, see the module.
        let halves = |x| unsafe { [_mm_cvtps_pd(x), _mm_cvtps_pd(_mm_movehl_ps(x, x))] };
        Doubles(self.0.map(halves))
    }
    #[inline(always)]
    fn narrow(wide: Doubles<R>) -> Floats<R> {
        // SAFETY: the machine has SSE2, see the module.
        let joined = |[a, b]: [_; 2]| unsafe { _mm_movelh_ps(_mm_cvtpd_ps(a), _mm_cvtpd_ps(b)) };
        Floats(wide.0.map(joined))
    }
}

impl<const R: usize> WideLanes for Doubles<R> {
    #[inline(always)]
    fn splat(x: f64) -> Doubles<R> {
        // SAFETY: the machine has SSE2, see the module.
        Doubles([[unsafe { _mm_set1_pd(x) }; 2]; R])
    }
    #[inline(always)]
    fn load(from: &[f64]) -> Doubles<R> {
        let from = &from[..4 * R];
        // SAFETY: the machine has SSE2, see the module; four elements are there for every pair of registers.
        Doubles(from_fn(|r| unsafe {
            let at = from.as_ptr().add(4 * r);
            [_mm_loadu_pd(at), _mm_loadu_pd(at.add(2))]
        }))
    }
    #[inline(always)]
    fn sqrt(self) -> Doubles<R> {
        // SAFETY: the machine has SSE2, see the module.
        self.with(self, |x, _| unsafe { _mm_sqrt_pd(x) })
    }
    #[inline(always)]
    fn copysign(self, sign: Doubles<R>) -> Doubles<R> {
        // SAFETY: the machine has SSE2, see the module.
        self.with(sign, |x, sign| unsafe {
            let bit = _mm_set1_pd(-0.0);
            _mm_or_pd(_mm_and_pd(bit, sign), _mm_andnot_pd(bit, x))
        })
    }
    #[inline(always)]
    fn min(self, other: Doubles<R>) -> Doubles<R> {
        // SAFETY: the machine has SSE2, see the module.
        self.with(other, |a, b| unsafe { _mm_min_pd(a, b) })
    }
    #[inline(always)]
    fn max(self, other: Doubles<R>) -> Doubles<R> {
        // SAFETY: the machine has SSE2, see the module.
        self.with(other, |a, b| unsafe { _mm_max_pd(a, b) })
    }
    #[inline(always)]
    fn positive_or(self, other: Doubles<R>) -> Doubles<R> {
        // SAFETY: the machine has SSE2, see the module.
        self.with(other, |x, other| unsafe {
            let positive = _mm_cmpgt_pd(x, _mm_setzero_pd());
            _mm_or_pd(_mm_and_pd(positive, x), _mm_andnot_pd(positive, other))
        })
    }
    #[inline(always)]
    fn any_not_negative(self) -> bool {
        let mut any = 0;
        for x in self.0.into_iter().flatten() {
            // SAFETY: the machine has SSE2, see the module.
            any |= unsafe { _mm_movemask_pd(_mm_cmpge_pd(x, _mm_setzero_pd())) };
        }
        any != 0
    }
}
