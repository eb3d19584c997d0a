//! [`BitLanes`] of AVX2.
#![allow(unsafe_code, reason = "intrinsics live here")]

use super::avx2::{F32x8, F64x8, MEMBERS_FIRST, Mask8};
use super::{BitLanes, Words};
use std::arch::x86_64::*;

/// Eight u32.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(crate) struct U32x8(__m256i);

impl BitLanes for F32x8 {
    type Bits = U32x8;

    #[inline(always)]
    fn to_bits(self) -> U32x8 {
        // SAFETY: the machine has AVX2, see the module above, here and below.
        unsafe { U32x8(_mm256_castps_si256(self.0)) }
    }
    #[inline(always)]
    fn from_bits(bits: U32x8) -> F32x8 {
        // SAFETY: likewise.
        unsafe { F32x8(_mm256_castsi256_ps(bits.0)) }
    }
    #[inline(always)]
    fn from_words(words: U32x8) -> F32x8 {
        // SAFETY: likewise.
        unsafe { F32x8(_mm256_cvtepi32_ps(words.0)) }
    }
    #[inline(always)]
    fn to_words(self) -> U32x8 {
        // SAFETY: likewise.
        unsafe { U32x8(_mm256_cvttps_epi32(self.0)) }
    }
    #[inline(always)]
    fn wide_lt(a: F64x8, b: F64x8) -> Mask8 {
        // SAFETY: likewise. A true f64 is two true f32, of which the even ones are kept: lanes 0, 1, 4, 5, 2, 3, 6, 7.
        unsafe {
            let low = _mm256_castpd_ps(_mm256_cmp_pd::<_CMP_LT_OQ>(a.0, b.0));
            let high = _mm256_castpd_ps(_mm256_cmp_pd::<_CMP_LT_OQ>(a.1, b.1));
            let pairs = _mm256_castps_pd(_mm256_shuffle_ps::<0b10_00_10_00>(low, high));
            Mask8(_mm256_castpd_ps(_mm256_permute4x64_pd::<0b11_01_10_00>(
                pairs,
            )))
        }
    }
    #[inline(always)]
    fn gather(from: &[f32], index: &[u32]) -> F32x8 {
        let index = &index[..8];
        let at = |i: usize| from[index[i] as usize];
        // SAFETY: likewise.
        unsafe {
            F32x8(_mm256_setr_ps(
                at(0),
                at(1),
                at(2),
                at(3),
                at(4),
                at(5),
                at(6),
                at(7),
            ))
        }
    }
    #[inline(always)]
    fn mask(bits: u32) -> Mask8 {
        // SAFETY: likewise.
        unsafe {
            let each = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
            let set = _mm256_and_si256(_mm256_set1_epi32(bits as i32), each);
            Mask8(_mm256_castsi256_ps(_mm256_cmpeq_epi32(set, each)))
        }
    }
    #[inline(always)]
    fn pack(self, chosen: u32, to: &mut [f32]) {
        let to = &mut to[..8];
        // SAFETY: likewise; eight elements are there.
        unsafe {
            let packed = _mm256_permutevar8x32_ps(self.0, members_first(chosen));
            _mm256_storeu_ps(to.as_mut_ptr(), packed);
        }
    }
}

/// The lanes whose bits are set, as places, then any.
#[inline(always)]
fn members_first(chosen: u32) -> __m256i {
    let row = &MEMBERS_FIRST[(chosen & 255) as usize];
    // SAFETY: likewise; a row has eight bytes.
    unsafe { _mm256_cvtepu8_epi32(_mm_loadl_epi64(row.as_ptr().cast())) }
}

impl Words for U32x8 {
    #[inline(always)]
    fn splat(x: u32) -> U32x8 {
        // SAFETY: likewise.
        unsafe { U32x8(_mm256_set1_epi32(x as i32)) }
    }
    #[inline(always)]
    fn load(from: &[u32]) -> U32x8 {
        let from = &from[..8];
        // SAFETY: likewise; eight elements are there.
        unsafe { U32x8(_mm256_loadu_si256(from.as_ptr().cast())) }
    }
    #[inline(always)]
    fn plus(self, other: U32x8) -> U32x8 {
        // SAFETY: likewise.
        unsafe { U32x8(_mm256_add_epi32(self.0, other.0)) }
    }
    #[inline(always)]
    fn times(self, other: U32x8) -> U32x8 {
        // SAFETY: likewise.
        unsafe { U32x8(_mm256_mullo_epi32(self.0, other.0)) }
    }
    #[inline(always)]
    fn xor(self, other: U32x8) -> U32x8 {
        // SAFETY: likewise.
        unsafe { U32x8(_mm256_xor_si256(self.0, other.0)) }
    }
    #[inline(always)]
    fn and(self, other: U32x8) -> U32x8 {
        // SAFETY: likewise.
        unsafe { U32x8(_mm256_and_si256(self.0, other.0)) }
    }
    #[inline(always)]
    fn or(self, other: U32x8) -> U32x8 {
        // SAFETY: likewise.
        unsafe { U32x8(_mm256_or_si256(self.0, other.0)) }
    }
    #[inline(always)]
    fn up<const K: i32>(self) -> U32x8 {
        // SAFETY: likewise.
        unsafe { U32x8(_mm256_slli_epi32::<K>(self.0)) }
    }
    #[inline(always)]
    fn down<const K: i32>(self) -> U32x8 {
        // SAFETY: likewise.
        unsafe { U32x8(_mm256_srli_epi32::<K>(self.0)) }
    }
    /// Nibbles by a table, then the order of the bytes.
    #[inline(always)]
    fn reversed(self) -> U32x8 {
        const REVERSED: i128 = 0x0f07_0b03_0d05_0901_0e06_0a02_0c04_0800;
        const BYTES: i128 = 0x0c0d_0e0f_0809_0a0b_0405_0607_0001_0203;
        // SAFETY: likewise; an i128 has the sixteen bytes of a register.
        unsafe {
            let table = |bytes: i128| {
                _mm256_broadcastsi128_si256(_mm_loadu_si128((&raw const bytes).cast()))
            };
            let low = _mm256_set1_epi8(15);
            let lower = _mm256_shuffle_epi8(table(REVERSED), _mm256_and_si256(self.0, low));
            let above = _mm256_and_si256(_mm256_srli_epi32::<4>(self.0), low);
            let upper = _mm256_shuffle_epi8(table(REVERSED), above);
            let nibbles = _mm256_or_si256(_mm256_slli_epi32::<4>(lower), upper);
            U32x8(_mm256_shuffle_epi8(nibbles, table(BYTES)))
        }
    }
    #[inline(always)]
    fn gather(from: &[u32], index: &[u32]) -> U32x8 {
        let index = &index[..8];
        let at = |i: usize| from[index[i] as usize] as i32;
        // SAFETY: likewise.
        unsafe {
            U32x8(_mm256_setr_epi32(
                at(0),
                at(1),
                at(2),
                at(3),
                at(4),
                at(5),
                at(6),
                at(7),
            ))
        }
    }
    #[inline(always)]
    fn pack(self, chosen: u32, to: &mut [u32]) {
        let to = &mut to[..8];
        // SAFETY: likewise; eight elements are there.
        unsafe {
            let packed = _mm256_permutevar8x32_epi32(self.0, members_first(chosen));
            _mm256_storeu_si256(to.as_mut_ptr().cast(), packed);
        }
    }
}
