//! Lanes: vectors of f32 with companion vectors of f64 of the same count. The one home of intrinsics.
//!
//! Kernels are written once, generic over [`Lanes`]. Backends: [`f32`] itself (one lane), [`sse2`] (four or eight),
//! [`avx2`] (eight) and [`avx512`] (sixteen); [`portable`] arrays in place of `sse2` elsewhere. All of them round alike, lane
//! by lane, so that a kernel's bits do not depend on the backend: nothing here is fused, approximate or reordered.
//!
//! Every function is `#[inline(always)]` and none has `#[target_feature]`, which stands on the top function of a batch only:
//! an intrinsic is inlined once its caller has arrived there. Hence the rule that makes the intrinsics sound: **a value of
//! [`avx2`] or [`avx512`] exists only inside an entry that a [`crate::trace::Isa`] of that level guards**, which is the proof
//! that the machine has the instructions. The module is private to the crate for that reason.
//!
//! What only the stages of tracing need, integers above all, is [`BitLanes`], which sixteen lanes have not.
//!
//! Deliberately absent: shuffles (but for the one order that traversal needs), sums over lanes, fused and approximate
//! operations.

#[cfg(target_arch = "x86_64")]
pub(crate) mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx2_bits;
#[cfg(target_arch = "x86_64")]
pub(crate) mod avx512;
mod bits;
#[cfg(any(test, not(target_arch = "x86_64")))]
pub(crate) mod portable;
mod scalar;
#[cfg(target_arch = "x86_64")]
pub(crate) mod sse2;
#[cfg(target_arch = "x86_64")]
mod sse2_bits;
#[cfg(test)]
mod tests;

/// What every machine of the target has.
#[cfg(not(target_arch = "x86_64"))]
pub(crate) use portable as baseline;
#[cfg(target_arch = "x86_64")]
pub(crate) use sse2 as baseline;

pub(crate) use bits::{BitLanes, Words};
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

/// The widest lanes of all.
pub(crate) const MOST: usize = 16;

/// Lanes of f32.
pub(crate) trait Lanes:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Their number.
    const N: usize;
    /// One truth value per lane.
    type Mask: Copy + BitAnd<Output = Self::Mask> + BitOr<Output = Self::Mask>;
    /// As many lanes of f64.
    type Wide: WideLanes;

    /// `x` in every lane, bit for bit.
    fn splat(x: f32) -> Self;
    /// The first `N` elements.
    fn load(from: &[f32]) -> Self;
    /// The first `N` bytes as numbers.
    fn load_bytes(from: &[u8]) -> Self;
    /// Overwrites the first `N` elements.
    fn store(self, to: &mut [f32]);
    /// `self < other`; false with NaN, like every comparison here.
    fn lt(self, other: Self) -> Self::Mask;
    /// `self <= other`.
    fn le(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is set, else `no`, bit for bit.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Lane i in bit i.
    fn bits(mask: Self::Mask) -> u32;
    /// Without the sign bit.
    fn abs(self) -> Self;
    /// Correctly rounded.
    fn sqrt(self) -> Self;
    /// `if self < other { self } else { other }`: with NaN, `other`.
    fn min(self, other: Self) -> Self;
    /// `if self > other { self } else { other }`: with NaN, `other`.
    fn max(self, other: Self) -> Self;
    /// The smallest of the lanes, none of which is NaN.
    fn least(self) -> f32;
    /// The largest of the lanes, none of which is NaN.
    fn greatest(self) -> f32;
    /// The same values in f64.
    fn widen(self) -> Self::Wide;
    /// Rounded to nearest, ties to even.
    fn narrow(wide: Self::Wide) -> Self;

    /// The rows at `index`, one in each lane: their first elements, their second ones …
    #[inline(always)]
    fn rows(from: &[[f64; 4]], index: &[u32]) -> [Self::Wide; 4] {
        let mut columns = [[0.0; MOST]; 4];
        for (lane, &i) in index[..Self::N].iter().enumerate() {
            for (column, x) in columns.iter_mut().zip(from[i as usize]) {
                column[lane] = x;
            }
        }
        let [a, b, c, d] = &columns;
        let wide = |column: &[f64; MOST]| Self::Wide::load(column);
        [wide(a), wide(b), wide(c), wide(d)]
    }

    /// Writes the elements of `items` whose bits are set in `chosen` to the front of `out`, by falling `keys`, and lower
    /// bounds of their keys, at most seven units in the last place away, to the front of `bounds`; returns their number.
    /// What follows in both is overwritten with anything. Keys that are chosen are not negative, the others are.
    #[inline(always)]
    fn sort_falling(
        keys: &[f32; 8],
        chosen: u32,
        items: &[u32; 8],
        out: &mut [u32; 8],
        bounds: &mut [f32; 8],
    ) -> usize {
        let mut left = chosen;
        let mut len = 0;
        while left != 0 {
            let lane = (left.trailing_zeros() & 7) as usize;
            left &= left - 1;
            let mut at = len & 7;
            while at > 0 && bounds[at - 1] < keys[lane] {
                bounds[at] = bounds[at - 1];
                out[at] = out[at - 1];
                at -= 1;
            }
            bounds[at] = keys[lane];
            out[at] = items[lane];
            len += 1;
        }
        len
    }

    /// Whether many rays go together: lanes are cheap, and [`Lanes::prefetch`] does something.
    const TOGETHER: bool = false;

    /// Asks for the cache lines of `len` bytes from an address on, which need not be anything's.
    #[inline(always)]
    fn prefetch(_address: *const u8, _len: usize) {}
}

/// Lanes of f64.
pub(crate) trait WideLanes:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// `x` in every lane.
    fn splat(x: f64) -> Self;
    /// The first elements, as many as there are lanes.
    fn load(from: &[f64]) -> Self;
    /// Correctly rounded.
    fn sqrt(self) -> Self;
    /// Magnitude of `self`, sign bit of `sign`.
    fn copysign(self, sign: Self) -> Self;
    /// `if self < other { self } else { other }`.
    fn min(self, other: Self) -> Self;
    /// `if self > other { self } else { other }`.
    fn max(self, other: Self) -> Self;
    /// `if self > 0 { self } else { other }`.
    fn positive_or(self, other: Self) -> Self;
    /// Whether any lane is `>= 0`.
    fn any_not_negative(self) -> bool;
}
