//! Eight lanes of AVX: an `__m256`, and two `__m256d` for f64.
//!
//! Every `unsafe` block here has one reason: a value of these types exists only inside an entry guarded by an
//! [`Isa`](crate::trace::Isa) of level AVX2 or above, so that the machine has the instruction; nothing else is
//! required of a caller, but that pointers are those of slices whose length was just checked.
#![allow(unsafe_code, reason = "intrinsics live here")]

use super::{Lanes, WideLanes};
use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

/// Eight f32.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(crate) struct F32x8(__m256);

/// Eight f64: lanes 0 to 3, lanes 4 to 7.
#[derive(Clone, Copy)]
pub(crate) struct F64x8(__m256d, __m256d);

/// Eight truth values: all bits or none.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(crate) struct Mask8(__m256);

macro_rules! operators {
    ($lanes:ident: $($trait:ident::$method:ident $intrinsic:ident),*) => {
        $(impl $trait for $lanes {
            type Output = $lanes;
            #[inline(always)]
            fn $method(self, other: $lanes) -> $lanes {
                // SAFETY: the machine has AVX, see the module.
                unsafe { $lanes($intrinsic(self.0, other.0)) }
            }
        })*
    };
}
operators!(F32x8: Add::add _mm256_add_ps, Sub::sub _mm256_sub_ps, Mul::mul _mm256_mul_ps, Div::div _mm256_div_ps);
operators!(Mask8: BitAnd::bitand _mm256_and_ps, BitOr::bitor _mm256_or_ps);

macro_rules! pair_operators {
    ($($trait:ident::$method:ident $intrinsic:ident),*) => {
        $(impl $trait for F64x8 {
            type Output = F64x8;
            #[inline(always)]
            fn $method(self, other: F64x8) -> F64x8 {
                // SAFETY: the machine has AVX, see the module.
                unsafe { F64x8($intrinsic(self.0, other.0), $intrinsic(self.1, other.1)) }
            }
        })*
    };
}
pair_operators!(Add::add _mm256_add_pd, Sub::sub _mm256_sub_pd, Mul::mul _mm256_mul_pd, Div::div _mm256_div_pd);

impl Neg for F32x8 {
    type Output = F32x8;
    #[inline(always)]
    fn neg(self) -> F32x8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe { F32x8(_mm256_xor_ps(self.0, _mm256_set1_ps(-0.0))) }
    }
}

impl Neg for F64x8 {
    type Output = F64x8;
    #[inline(always)]
    fn neg(self) -> F64x8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe {
            let sign = _mm256_set1_pd(-0.0);
            F64x8(_mm256_xor_pd(self.0, sign), _mm256_xor_pd(self.1, sign))
        }
    }
}

impl Lanes for F32x8 {
    const N: usize = 8;
    type Mask = Mask8;
    type Wide = F64x8;

    #[inline(always)]
    fn splat(x: f32) -> F32x8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe { F32x8(_mm256_set1_ps(x)) }
    }
    #[inline(always)]
    fn load(from: &[f32]) -> F32x8 {
        let from = &from[..8];
        // SAFETY: the machine has AVX, see the module; eight elements are there.
        unsafe { F32x8(_mm256_loadu_ps(from.as_ptr())) }
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..8];
        // SAFETY: the machine has AVX, see the module; eight elements are there.
        unsafe { _mm256_storeu_ps(to.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn lt(self, other: F32x8) -> Mask8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe { Mask8(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)) }
    }
    #[inline(always)]
    fn le(self, other: F32x8) -> Mask8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe { Mask8(_mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0)) }
    }
    #[inline(always)]
    fn select(mask: Mask8, yes: F32x8, no: F32x8) -> F32x8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe { F32x8(_mm256_blendv_ps(no.0, yes.0, mask.0)) }
    }
    #[inline(always)]
    fn bits(mask: Mask8) -> u32 {
        // SAFETY: the machine has AVX, see the module.
        unsafe { _mm256_movemask_ps(mask.0) as u32 }
    }
    #[inline(always)]
    fn abs(self) -> F32x8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe { F32x8(_mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0)) }
    }
    #[inline(always)]
    fn min(self, other: F32x8) -> F32x8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe { F32x8(_mm256_min_ps(self.0, other.0)) }
    }
    #[inline(always)]
    fn max(self, other: F32x8) -> F32x8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe { F32x8(_mm256_max_ps(self.0, other.0)) }
    }
    #[inline(always)]
    fn widen(self) -> F64x8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe {
            F64x8(
                _mm256_cvtps_pd(_mm256_castps256_ps128(self.0)),
                _mm256_cvtps_pd(_mm256_extractf128_ps::<1>(self.0)),
            )
        }
    }
    #[inline(always)]
    fn narrow(wide: F64x8) -> F32x8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe {
            F32x8(_mm256_set_m128(
                _mm256_cvtpd_ps(wide.1),
                _mm256_cvtpd_ps(wide.0),
            ))
        }
    }
}

impl WideLanes for F64x8 {
    #[inline(always)]
    fn splat(x: f64) -> F64x8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe { F64x8(_mm256_set1_pd(x), _mm256_set1_pd(x)) }
    }
    #[inline(always)]
    fn load(from: &[f64]) -> F64x8 {
        let from = &from[..8];
        // SAFETY: the machine has AVX, see the module; eight elements are there.
        unsafe {
            F64x8(
                _mm256_loadu_pd(from.as_ptr()),
                _mm256_loadu_pd(from.as_ptr().add(4)),
            )
        }
    }
    #[inline(always)]
    fn sqrt(self) -> F64x8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe { F64x8(_mm256_sqrt_pd(self.0), _mm256_sqrt_pd(self.1)) }
    }
    #[inline(always)]
    fn copysign(self, sign: F64x8) -> F64x8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe {
            let bit = _mm256_set1_pd(-0.0);
            F64x8(
                _mm256_or_pd(_mm256_andnot_pd(bit, self.0), _mm256_and_pd(bit, sign.0)),
                _mm256_or_pd(_mm256_andnot_pd(bit, self.1), _mm256_and_pd(bit, sign.1)),
            )
        }
    }
    #[inline(always)]
    fn min(self, other: F64x8) -> F64x8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe {
            F64x8(
                _mm256_min_pd(self.0, other.0),
                _mm256_min_pd(self.1, other.1),
            )
        }
    }
    #[inline(always)]
    fn max(self, other: F64x8) -> F64x8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe {
            F64x8(
                _mm256_max_pd(self.0, other.0),
                _mm256_max_pd(self.1, other.1),
            )
        }
    }
    #[inline(always)]
    fn positive_or(self, other: F64x8) -> F64x8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe {
            let zero = _mm256_setzero_pd();
            let low = _mm256_cmp_pd::<_CMP_GT_OQ>(self.0, zero);
            let high = _mm256_cmp_pd::<_CMP_GT_OQ>(self.1, zero);
            F64x8(
                _mm256_blendv_pd(other.0, self.0, low),
                _mm256_blendv_pd(other.1, self.1, high),
            )
        }
    }
    #[inline(always)]
    fn any_not_negative(self) -> bool {
        // SAFETY: the machine has AVX, see the module.
        unsafe {
            let zero = _mm256_setzero_pd();
            let low = _mm256_cmp_pd::<_CMP_GE_OQ>(self.0, zero);
            let high = _mm256_cmp_pd::<_CMP_GE_OQ>(self.1, zero);
            _mm256_movemask_pd(_mm256_or_pd(low, high)) != 0
        }
    }
}
