//! What the stages of tracing need beyond [`Lanes`]: the bits of lanes as whole numbers, elements from anywhere, and lanes
//! that are left out.

use super::Lanes;

/// Lanes of u32 that wrap.
pub(crate) trait Words: Copy {
    /// `x` in every lane.
    fn splat(x: u32) -> Self;
    /// The first elements, as many as there are lanes.
    fn load(from: &[u32]) -> Self;
    /// Sum modulo 2³².
    fn plus(self, other: Self) -> Self;
    /// Product modulo 2³².
    fn times(self, other: Self) -> Self;
    /// Exclusive or.
    fn xor(self, other: Self) -> Self;
    /// And.
    fn and(self, other: Self) -> Self;
    /// Or.
    fn or(self, other: Self) -> Self;
    /// Shifted up by `K` bits.
    fn up<const K: i32>(self) -> Self;
    /// Shifted down by `K` bits, zeros from above.
    fn down<const K: i32>(self) -> Self;
    /// The elements at `index`, as many as there are lanes.
    fn gather(from: &[u32], index: &[u32]) -> Self;
    /// Writes the lanes whose bits are set in `chosen` to the front of `to`, in order. What follows, as far as there are
    /// lanes, is overwritten with anything.
    fn pack(self, chosen: u32, to: &mut [u32]);

    /// Bit i becomes bit 31 − i.
    #[inline(always)]
    fn reversed(self) -> Self {
        #[inline(always)]
        fn swap<W: Words, const K: i32>(x: W, low: u32) -> W {
            let low = W::splat(low);
            x.down::<K>().and(low).or(x.and(low).up::<K>())
        }
        let x = swap::<Self, 1>(self, 0x5555_5555);
        let x = swap::<Self, 2>(x, 0x3333_3333);
        let x = swap::<Self, 4>(x, 0x0f0f_0f0f);
        let x = swap::<Self, 8>(x, 0x00ff_00ff);
        x.down::<16>().or(x.up::<16>())
    }
}

/// Lanes whose bits can be worked with.
pub(crate) trait BitLanes: Lanes {
    /// As many u32.
    type Bits: Words;

    /// The same bits.
    fn to_bits(self) -> Self::Bits;
    /// The same bits.
    fn from_bits(bits: Self::Bits) -> Self;
    /// The numbers, which are below 2³¹, rounded to nearest.
    fn from_words(words: Self::Bits) -> Self;
    /// Towards zero; for numbers between 0 and 2³¹.
    fn to_words(self) -> Self::Bits;
    /// `a < b`, lane by lane; false with NaN.
    fn wide_lt(a: Self::Wide, b: Self::Wide) -> Self::Mask;
    /// The elements at `index`, as many as there are lanes.
    fn gather(from: &[f32], index: &[u32]) -> Self;
    /// Set where bit i is, in lane i.
    #[inline(always)]
    fn mask(bits: u32) -> Self::Mask {
        let mut lanes = [0.0; super::MOST];
        for (lane, x) in lanes[..Self::N].iter_mut().enumerate() {
            *x = (bits >> lane & 1) as f32;
        }
        Self::splat(0.0).lt(Self::load(&lanes))
    }
    /// As [`Words::pack`].
    #[inline(always)]
    fn pack(self, chosen: u32, to: &mut [f32]) {
        // One lane at a time is what a machine without the instruction does, too.
        let mut lanes = [0.0; super::MOST];
        self.store(&mut lanes);
        pack(&lanes[..Self::N], chosen, to);
    }
}

/// Elements whose bits are set to the front of `to`.
#[inline(always)]
pub(super) fn pack<T: Copy>(lanes: &[T], chosen: u32, to: &mut [T]) {
    let to = &mut to[..lanes.len()];
    let mut at = 0;
    for (i, &x) in lanes.iter().enumerate() {
        // `at` is not beyond i.
        to[at] = x;
        at += (chosen >> i & 1) as usize;
    }
}
