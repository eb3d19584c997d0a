//! [`BitLanes`] of SSE2.
#![allow(unsafe_code, reason = "intrinsics live here")]

use super::sse2::{Doubles, Floats, Truths};
use super::{BitLanes, MOST, Words, bits};
use std::arch::x86_64::*;
use std::array::from_fn;

/// So many registers of four u32.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(crate) struct Uints<const R: usize>([__m128i; R]);

impl<const R: usize> Uints<R> {
    /// Register by register.
    #[inline(always)]
    fn with(self, other: Uints<R>, f: impl Fn(__m128i, __m128i) -> __m128i) -> Uints<R> {
        Uints(from_fn(|r| f(self.0[r], other.0[r])))
    }
}

impl<const R: usize> BitLanes for Floats<R> {
    type Bits = Uints<R>;

    #[inline(always)]
    fn to_bits(self) -> Uints<R> {
        // SAFETY: the machine has SSE2, see the module above, here and below.
        Uints(self.0.map(|x| unsafe { _mm_castps_si128(x) }))
    }
    #[inline(always)]
    fn from_bits(bits: Uints<R>) -> Floats<R> {
        // SAFETY: likewise.
        Floats(bits.0.map(|x| unsafe { _mm_castsi128_ps(x) }))
    }
    #[inline(always)]
    fn from_words(words: Uints<R>) -> Floats<R> {
        // SAFETY: likewise.
        Floats(words.0.map(|x| unsafe { _mm_cvtepi32_ps(x) }))
    }
    #[inline(always)]
    fn to_words(self) -> Uints<R> {
        // SAFETY: likewise.
        Uints(self.0.map(|x| unsafe { _mm_cvttps_epi32(x) }))
    }
    #[inline(always)]
    fn wide_lt(a: Doubles<R>, b: Doubles<R>) -> Truths<R> {
        // SAFETY: likewise. A true f64 is two true f32, of which the even ones are kept.
        Truths(from_fn(|r| unsafe {
            let half = |h: usize| _mm_castpd_ps(_mm_cmplt_pd(a.0[r][h], b.0[r][h]));
            _mm_shuffle_ps::<0b10_00_10_00>(half(0), half(1))
        }))
    }
    #[inline(always)]
    fn gather(from: &[f32], index: &[u32]) -> Floats<R> {
        let index = &index[..4 * R];
        let at = |i: usize| from[index[i] as usize];
        // SAFETY: likewise.
        Floats(from_fn(|r| unsafe {
            _mm_setr_ps(at(4 * r), at(4 * r + 1), at(4 * r + 2), at(4 * r + 3))
        }))
    }
}

impl<const R: usize> Words for Uints<R> {
    #[inline(always)]
    fn splat(x: u32) -> Uints<R> {
        // SAFETY: likewise.
        Uints([unsafe { _mm_set1_epi32(x as i32) }; R])
    }
    #[inline(always)]
    fn load(from: &[u32]) -> Uints<R> {
        let from = &from[..4 * R];
        // SAFETY: likewise; four elements are there for every register.
        Uints(from_fn(|r| unsafe {
            _mm_loadu_si128(from.as_ptr().add(4 * r).cast())
        }))
    }
    #[inline(always)]
    fn plus(self, other: Uints<R>) -> Uints<R> {
        // SAFETY: likewise.
        self.with(other, |a, b| unsafe { _mm_add_epi32(a, b) })
    }
    #[inline(always)]
    fn times(self, other: Uints<R>) -> Uints<R> {
        // SAFETY: likewise. SSE2 multiplies the even lanes only.
        self.with(other, |a, b| unsafe {
            let even = _mm_mul_epu32(a, b);
            let odd = _mm_mul_epu32(_mm_srli_epi64::<32>(a), _mm_srli_epi64::<32>(b));
            _mm_unpacklo_epi32(
                _mm_shuffle_epi32::<0b10_00>(even),
                _mm_shuffle_epi32::<0b10_00>(odd),
            )
        })
    }
    #[inline(always)]
    fn xor(self, other: Uints<R>) -> Uints<R> {
        // SAFETY: likewise.
        self.with(other, |a, b| unsafe { _mm_xor_si128(a, b) })
    }
    #[inline(always)]
    fn and(self, other: Uints<R>) -> Uints<R> {
        // SAFETY: likewise.
        self.with(other, |a, b| unsafe { _mm_and_si128(a, b) })
    }
    #[inline(always)]
    fn or(self, other: Uints<R>) -> Uints<R> {
        // SAFETY: likewise.
        self.with(other, |a, b| unsafe { _mm_or_si128(a, b) })
    }
    #[inline(always)]
    fn up<const K: i32>(self) -> Uints<R> {
        // SAFETY: likewise.
        Uints(self.0.map(|x| unsafe { _mm_slli_epi32::<K>(x) }))
    }
    #[inline(always)]
    fn down<const K: i32>(self) -> Uints<R> {
        // SAFETY: likewise.
        Uints(self.0.map(|x| unsafe { _mm_srli_epi32::<K>(x) }))
    }
    #[inline(always)]
    fn gather(from: &[u32], index: &[u32]) -> Uints<R> {
        let index = &index[..4 * R];
        let at = |i: usize| from[index[i] as usize] as i32;
        // SAFETY: likewise.
        Uints(from_fn(|r| unsafe {
            _mm_setr_epi32(at(4 * r), at(4 * r + 1), at(4 * r + 2), at(4 * r + 3))
        }))
    }
    #[inline(always)]
    fn pack(self, chosen: u32, to: &mut [u32]) {
        let mut lanes = [0; MOST];
        for (x, to) in self.0.into_iter().zip(lanes.chunks_exact_mut(4)) {
            // SAFETY: likewise; four elements are there.
            unsafe { _mm_storeu_si128(to.as_mut_ptr().cast(), x) }
        }
        bits::pack(&lanes[..4 * R], chosen, to);
    }
}
