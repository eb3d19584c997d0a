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
pub(crate) struct F32x8(pub(super) __m256);

/// Eight f64: lanes 0 to 3, lanes 4 to 7.
#[derive(Clone, Copy)]
pub(crate) struct F64x8(pub(super) __m256d, pub(super) __m256d);

/// Eight truth values: all bits or none.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(crate) struct Mask8(pub(super) __m256);

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
    const TOGETHER: bool = true;
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
    fn load_bytes(from: &[u8]) -> F32x8 {
        let from = &from[..8];
        // SAFETY: the machine has AVX2, see the module; eight elements are there.
        unsafe {
            let bytes = _mm_loadl_epi64(from.as_ptr().cast());
            F32x8(_mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(bytes)))
        }
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
    fn sqrt(self) -> F32x8 {
        // SAFETY: the machine has AVX, see the module.
        unsafe { F32x8(_mm256_sqrt_ps(self.0)) }
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
    fn least(self) -> f32 {
        // SAFETY: the machine has AVX, see the module.
        unsafe {
            let four = _mm_min_ps(
                _mm256_castps256_ps128(self.0),
                _mm256_extractf128_ps::<1>(self.0),
            );
            let two = _mm_min_ps(four, _mm_movehl_ps(four, four));
            _mm_cvtss_f32(_mm_min_ss(two, _mm_movehdup_ps(two)))
        }
    }
    #[inline(always)]
    fn greatest(self) -> f32 {
        // SAFETY: the machine has AVX, see the module.
        unsafe {
            let four = _mm_max_ps(
                _mm256_castps256_ps128(self.0),
                _mm256_extractf128_ps::<1>(self.0),
            );
            let two = _mm_max_ps(four, _mm_movehl_ps(four, four));
            _mm_cvtss_f32(_mm_max_ss(two, _mm_movehdup_ps(two)))
        }
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
    /// Rows as registers, four at a time, transposed: what is stored number by number and loaded as a register waits for
    /// all the stores.
    #[inline(always)]
    fn rows(from: &[[f64; 4]], index: &[u32]) -> [F64x8; 4] {
        let index = &index[..8];
        // SAFETY: the machine has AVX, see the module; a row has four elements.
        let row = |i: usize| unsafe { _mm256_loadu_pd(from[index[i] as usize].as_ptr()) };
        // SAFETY: likewise.
        unsafe {
            let [a, b, c, d] = transposed([row(0), row(1), row(2), row(3)]);
            let [e, f, g, h] = transposed([row(4), row(5), row(6), row(7)]);
            [F64x8(a, e), F64x8(b, f), F64x8(c, g), F64x8(d, h)]
        }
    }
    #[inline(always)]
    fn sort_falling(
        keys: &[f32; 8],
        chosen: u32,
        items: &[u32; 8],
        out: &mut [u32; 8],
        bounds: &mut [f32; 8],
    ) -> usize {
        // SAFETY: the machine has AVX2, see the module; the arrays have eight elements.
        unsafe { sort_falling(keys, chosen, items, out, bounds) }
    }
    #[inline(always)]
    fn prefetch(address: *const u8, len: usize) {
        let mut at = 0;
        while at < len {
            // SAFETY: the machine has SSE, and a prefetch of any address does not fault.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(address.wrapping_add(at).cast()) };
            at += 64;
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

/// # Safety
/// The machine has AVX.
#[inline(always)]
unsafe fn transposed([a, b, c, d]: [__m256d; 4]) -> [__m256d; 4] {
    // SAFETY: the caller's.
    unsafe {
        let (ab_even, ab_odd) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
        let (cd_even, cd_odd) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
        [
            _mm256_permute2f128_pd::<0x20>(ab_even, cd_even),
            _mm256_permute2f128_pd::<0x20>(ab_odd, cd_odd),
            _mm256_permute2f128_pd::<0x31>(ab_even, cd_even),
            _mm256_permute2f128_pd::<0x31>(ab_odd, cd_odd),
        ]
    }
}

/// For every set of eight lanes: its members, then one that is not, again and again.
pub(super) static MEMBERS_FIRST: [[u8; 8]; 256] = members_first();

const fn members_first() -> [[u8; 8]; 256] {
    let mut table = [[0; 8]; 256];
    let mut set = 0;
    while set < 256 {
        let [mut at, mut lane] = [0, 0];
        while lane < 8 {
            if set >> lane & 1 == 1 {
                table[set][at] = lane as u8;
                at += 1;
            }
            lane += 1;
        }
        while at < 8 {
            table[set][at] = (set as u32).trailing_ones() as u8;
            at += 1;
        }
        set += 1;
    }
    table
}

/// The larger of a lane and its partner goes to the lane whose bit in `SMALLER` is clear.
macro_rules! compare {
    ($max:ident, $min:ident, $blend:ident, $smaller:literal, $keys:ident, $partners:expr) => {{
        let partners = $partners;
        $keys = $blend::<$smaller>($max($keys, partners), $min($keys, partners));
    }};
}

/// The bits of keys that are not negative order as integers. The lowest three carry the lane, so that what comes out of a
/// sorting network (Batcher 1968) says where it was.
///
/// # Safety
/// The machine has AVX2.
#[inline(always)]
unsafe fn sort_falling(
    keys: &[f32; 8],
    chosen: u32,
    items: &[u32; 8],
    out: &mut [u32; 8],
    bounds: &mut [f32; 8],
) -> usize {
    // SAFETY: the machine has AVX2; all arrays have eight elements, and the table's rows eight bytes.
    unsafe {
        let len = chosen.count_ones() as usize;
        let keys = _mm256_loadu_si256(keys.as_ptr().cast());
        let items = _mm256_loadu_si256(items.as_ptr().cast());
        let [out, bounds]: [*mut __m256i; 2] =
            [out.as_mut_ptr().cast(), bounds.as_mut_ptr().cast()];
        if len <= 4 {
            // Four lanes suffice, and the table's fifth and following are not looked at.
            let row = &MEMBERS_FIRST[(chosen & 255) as usize];
            let from = _mm256_cvtepu8_epi32(_mm_loadl_epi64(row.as_ptr().cast()));
            let near = _mm256_castsi256_si128(_mm256_permutevar8x32_epi32(keys, from));
            let clear = _mm_set1_epi32(-8);
            let mut k = _mm_or_si128(_mm_and_si128(near, clear), _mm256_castsi256_si128(from));
            compare!(
                _mm_max_epi32,
                _mm_min_epi32,
                _mm_blend_epi32,
                0b1010,
                k,
                _mm_shuffle_epi32::<0xb1>(k)
            );
            compare!(
                _mm_max_epi32,
                _mm_min_epi32,
                _mm_blend_epi32,
                0b1100,
                k,
                _mm_shuffle_epi32::<0x1b>(k)
            );
            compare!(
                _mm_max_epi32,
                _mm_min_epi32,
                _mm_blend_epi32,
                0b1010,
                k,
                _mm_shuffle_epi32::<0xb1>(k)
            );
            let sorted = _mm256_permutevar8x32_epi32(items, _mm256_castsi128_si256(k));
            _mm_storeu_si128(out.cast(), _mm256_castsi256_si128(sorted));
            _mm_storeu_si128(bounds.cast(), _mm_and_si128(k, clear));
            return len;
        }
        let lanes = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
        let clear = _mm256_set1_epi32(-8);
        let mut k = _mm256_or_si256(_mm256_and_si256(keys, clear), lanes);
        compare!(
            _mm256_max_epi32,
            _mm256_min_epi32,
            _mm256_blend_epi32,
            0x66,
            k,
            _mm256_shuffle_epi32::<0xb1>(k)
        );
        compare!(
            _mm256_max_epi32,
            _mm256_min_epi32,
            _mm256_blend_epi32,
            0x3c,
            k,
            _mm256_shuffle_epi32::<0x4e>(k)
        );
        compare!(
            _mm256_max_epi32,
            _mm256_min_epi32,
            _mm256_blend_epi32,
            0x5a,
            k,
            _mm256_shuffle_epi32::<0xb1>(k)
        );
        compare!(
            _mm256_max_epi32,
            _mm256_min_epi32,
            _mm256_blend_epi32,
            0xf0,
            k,
            _mm256_permute2x128_si256::<1>(k, k)
        );
        compare!(
            _mm256_max_epi32,
            _mm256_min_epi32,
            _mm256_blend_epi32,
            0xcc,
            k,
            _mm256_shuffle_epi32::<0x4e>(k)
        );
        compare!(
            _mm256_max_epi32,
            _mm256_min_epi32,
            _mm256_blend_epi32,
            0xaa,
            k,
            _mm256_shuffle_epi32::<0xb1>(k)
        );
        _mm256_storeu_si256(out, _mm256_permutevar8x32_epi32(items, k));
        _mm256_storeu_si256(bounds, _mm256_and_si256(k, clear));
        len
    }
}
