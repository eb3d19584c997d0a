//! Sixteen lanes of AVX-512 (F, DQ): an `__m512`, and two `__m512d` for f64.
//!
//! Every `unsafe` block here has one reason: a value of these types exists only inside an entry guarded by an
//! [`Isa`](crate::trace::Isa) of level AVX-512, so that the machine has the instruction; nothing else is
//! required of a caller, but that pointers are those of slices whose length was just checked.
#![allow(unsafe_code, reason = "intrinsics live here")]

use super::{Lanes, WideLanes};
use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

/// Sixteen f32.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(crate) struct F32x16(__m512);

/// Sixteen f64: lanes 0 to 7, lanes 8 to 15.
#[derive(Clone, Copy)]
pub(crate) struct F64x16(__m512d, __m512d);

/// Sixteen truth values.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(crate) struct Mask16(__mmask16);

macro_rules! operators {
    ($lanes:ident: $($trait:ident::$method:ident $intrinsic:ident),*) => {
        $(impl $trait for $lanes {
            type Output = $lanes;
            #[inline(always)]
            fn $method(self, other: $lanes) -> $lanes {
                // SAFETY: the machine has AVX-512, see the module.
                unsafe { $lanes($intrinsic(self.0, other.0)) }
            }
        })*
    };
}
operators!(F32x16: Add::add _mm512_add_ps, Sub::sub _mm512_sub_ps, Mul::mul _mm512_mul_ps, Div::div _mm512_div_ps);

impl BitAnd for Mask16 {
    type Output = Mask16;
    #[inline(always)]
    fn bitand(self, other: Mask16) -> Mask16 {
        Mask16(self.0 & other.0)
    }
}

impl BitOr for Mask16 {
    type Output = Mask16;
    #[inline(always)]
    fn bitor(self, other: Mask16) -> Mask16 {
        Mask16(self.0 | other.0)
    }
}

macro_rules! pair_operators {
    ($($trait:ident::$method:ident $intrinsic:ident),*) => {
        $(impl $trait for F64x16 {
            type Output = F64x16;
            #[inline(always)]
            fn $method(self, other: F64x16) -> F64x16 {
                // SAFETY: the machine has AVX-512, see the module.
                unsafe { F64x16($intrinsic(self.0, other.0), $intrinsic(self.1, other.1)) }
            }
        })*
    };
}
pair_operators!(Add::add _mm512_add_pd, Sub::sub _mm512_sub_pd, Mul::mul _mm512_mul_pd, Div::div _mm512_div_pd);

impl Neg for F32x16 {
    type Output = F32x16;
    #[inline(always)]
    fn neg(self) -> F32x16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe { F32x16(_mm512_xor_ps(self.0, _mm512_set1_ps(-0.0))) }
    }
}

impl Neg for F64x16 {
    type Output = F64x16;
    #[inline(always)]
    fn neg(self) -> F64x16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe {
            let sign = _mm512_set1_pd(-0.0);
            F64x16(_mm512_xor_pd(self.0, sign), _mm512_xor_pd(self.1, sign))
        }
    }
}

impl Lanes for F32x16 {
    const N: usize = 16;
    type Mask = Mask16;
    type Wide = F64x16;

    #[inline(always)]
    fn splat(x: f32) -> F32x16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe { F32x16(_mm512_set1_ps(x)) }
    }
    #[inline(always)]
    fn load(from: &[f32]) -> F32x16 {
        let from = &from[..16];
        // SAFETY: the machine has AVX-512, see the module; sixteen elements are there.
        unsafe { F32x16(_mm512_loadu_ps(from.as_ptr())) }
    }
    #[inline(always)]
    fn load_bytes(from: &[u8]) -> F32x16 {
        let from = &from[..16];
        // SAFETY: the machine has AVX-512, see the module; sixteen elements are there.
        unsafe {
            let bytes = _mm_loadu_si128(from.as_ptr().cast());
            F32x16(_mm512_cvtepi32_ps(_mm512_cvtepu8_epi32(bytes)))
        }
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..16];
        // SAFETY: the machine has AVX-512, see the module; sixteen elements are there.
        unsafe { _mm512_storeu_ps(to.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn lt(self, other: F32x16) -> Mask16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe { Mask16(_mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0)) }
    }
    #[inline(always)]
    fn le(self, other: F32x16) -> Mask16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe { Mask16(_mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0)) }
    }
    #[inline(always)]
    fn select(mask: Mask16, yes: F32x16, no: F32x16) -> F32x16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe { F32x16(_mm512_mask_blend_ps(mask.0, no.0, yes.0)) }
    }
    #[inline(always)]
    fn bits(mask: Mask16) -> u32 {
        u32::from(mask.0)
    }
    #[inline(always)]
    fn abs(self) -> F32x16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe { F32x16(_mm512_andnot_ps(_mm512_set1_ps(-0.0), self.0)) }
    }
    #[inline(always)]
    fn sqrt(self) -> F32x16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe { F32x16(_mm512_sqrt_ps(self.0)) }
    }
    #[inline(always)]
    fn min(self, other: F32x16) -> F32x16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe { F32x16(_mm512_min_ps(self.0, other.0)) }
    }
    #[inline(always)]
    fn max(self, other: F32x16) -> F32x16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe { F32x16(_mm512_max_ps(self.0, other.0)) }
    }
    #[inline(always)]
    fn least(self) -> f32 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe { _mm512_reduce_min_ps(self.0) }
    }
    #[inline(always)]
    fn greatest(self) -> f32 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe { _mm512_reduce_max_ps(self.0) }
    }
    #[inline(always)]
    fn widen(self) -> F64x16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe {
            F64x16(
                _mm512_cvtps_pd(_mm512_castps512_ps256(self.0)),
                _mm512_cvtps_pd(_mm512_extractf32x8_ps::<1>(self.0)),
            )
        }
    }
    #[inline(always)]
    fn narrow(wide: F64x16) -> F32x16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe {
            let low = _mm512_castps256_ps512(_mm512_cvtpd_ps(wide.0));
            F32x16(_mm512_insertf32x8::<1>(low, _mm512_cvtpd_ps(wide.1)))
        }
    }
}

impl WideLanes for F64x16 {
    #[inline(always)]
    fn splat(x: f64) -> F64x16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe { F64x16(_mm512_set1_pd(x), _mm512_set1_pd(x)) }
    }
    #[inline(always)]
    fn load(from: &[f64]) -> F64x16 {
        let from = &from[..16];
        // SAFETY: the machine has AVX-512, see the module; sixteen elements are there.
        unsafe {
            F64x16(
                _mm512_loadu_pd(from.as_ptr()),
                _mm512_loadu_pd(from.as_ptr().add(8)),
            )
        }
    }
    #[inline(always)]
    fn sqrt(self) -> F64x16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe { F64x16(_mm512_sqrt_pd(self.0), _mm512_sqrt_pd(self.1)) }
    }
    #[inline(always)]
    fn copysign(self, sign: F64x16) -> F64x16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe {
            let bit = _mm512_set1_pd(-0.0);
            F64x16(
                _mm512_or_pd(_mm512_andnot_pd(bit, self.0), _mm512_and_pd(bit, sign.0)),
                _mm512_or_pd(_mm512_andnot_pd(bit, self.1), _mm512_and_pd(bit, sign.1)),
            )
        }
    }
    #[inline(always)]
    fn min(self, other: F64x16) -> F64x16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe {
            F64x16(
                _mm512_min_pd(self.0, other.0),
                _mm512_min_pd(self.1, other.1),
            )
        }
    }
    #[inline(always)]
    fn max(self, other: F64x16) -> F64x16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe {
            F64x16(
                _mm512_max_pd(self.0, other.0),
                _mm512_max_pd(self.1, other.1),
            )
        }
    }
    #[inline(always)]
    fn positive_or(self, other: F64x16) -> F64x16 {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe {
            let zero = _mm512_setzero_pd();
            let low = _mm512_cmp_pd_mask::<_CMP_GT_OQ>(self.0, zero);
            let high = _mm512_cmp_pd_mask::<_CMP_GT_OQ>(self.1, zero);
            F64x16(
                _mm512_mask_blend_pd(low, other.0, self.0),
                _mm512_mask_blend_pd(high, other.1, self.1),
            )
        }
    }
    #[inline(always)]
    fn any_not_negative(self) -> bool {
        // SAFETY: the machine has AVX-512, see the module.
        unsafe {
            let zero = _mm512_setzero_pd();
            let low = _mm512_cmp_pd_mask::<_CMP_GE_OQ>(self.0, zero);
            let high = _mm512_cmp_pd_mask::<_CMP_GE_OQ>(self.1, zero);
            low | high != 0
        }
    }
}
