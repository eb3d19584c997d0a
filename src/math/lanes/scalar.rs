//! One lane: f32 and f64 themselves.

use super::{BitLanes, Lanes, WideLanes, Words};

impl Lanes for f32 {
    const N: usize = 1;
    type Mask = bool;
    type Wide = f64;

    #[inline(always)]
    fn splat(x: f32) -> f32 {
        x
    }
    #[inline(always)]
    fn load(from: &[f32]) -> f32 {
        from[0]
    }
    #[inline(always)]
    fn load_bytes(from: &[u8]) -> f32 {
        f32::from(from[0])
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        to[0] = self;
    }
    #[inline(always)]
    fn lt(self, other: f32) -> bool {
        self < other
    }
    #[inline(always)]
    fn le(self, other: f32) -> bool {
        self <= other
    }
    #[inline(always)]
    fn select(mask: bool, yes: f32, no: f32) -> f32 {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn bits(mask: bool) -> u32 {
        u32::from(mask)
    }
    #[inline(always)]
    fn abs(self) -> f32 {
        f32::abs(self)
    }
    #[inline(always)]
    fn sqrt(self) -> f32 {
        f32::sqrt(self)
    }
    #[inline(always)]
    fn min(self, other: f32) -> f32 {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn max(self, other: f32) -> f32 {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn least(self) -> f32 {
        self
    }
    #[inline(always)]
    fn greatest(self) -> f32 {
        self
    }
    #[inline(always)]
    fn widen(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn narrow(wide: f64) -> f32 {
        wide as f32
    }
}

impl WideLanes for f64 {
    #[inline(always)]
    fn splat(x: f64) -> f64 {
        x
    }
    #[inline(always)]
    fn load(from: &[f64]) -> f64 {
        from[0]
    }
    #[inline(always)]
    fn sqrt(self) -> f64 {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn copysign(self, sign: f64) -> f64 {
        f64::copysign(self, sign)
    }
    #[inline(always)]
    fn min(self, other: f64) -> f64 {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn max(self, other: f64) -> f64 {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn positive_or(self, other: f64) -> f64 {
        if self > 0.0 { self } else { other }
    }
    #[inline(always)]
    fn any_not_negative(self) -> bool {
        self >= 0.0
    }
}

impl BitLanes for f32 {
    type Bits = u32;

    #[inline(always)]
    fn to_bits(self) -> u32 {
        f32::to_bits(self)
    }
    #[inline(always)]
    fn from_bits(bits: u32) -> f32 {
        f32::from_bits(bits)
    }
    #[inline(always)]
    fn from_words(words: u32) -> f32 {
        words as f32
    }
    #[inline(always)]
    fn to_words(self) -> u32 {
        self as u32
    }
    #[inline(always)]
    fn wide_lt(a: f64, b: f64) -> bool {
        a < b
    }
    #[inline(always)]
    fn gather(from: &[f32], index: &[u32]) -> f32 {
        from[index[0] as usize]
    }
}

impl Words for u32 {
    #[inline(always)]
    fn splat(x: u32) -> u32 {
        x
    }
    #[inline(always)]
    fn load(from: &[u32]) -> u32 {
        from[0]
    }
    #[inline(always)]
    fn plus(self, other: u32) -> u32 {
        self.wrapping_add(other)
    }
    #[inline(always)]
    fn times(self, other: u32) -> u32 {
        self.wrapping_mul(other)
    }
    #[inline(always)]
    fn xor(self, other: u32) -> u32 {
        self ^ other
    }
    #[inline(always)]
    fn and(self, other: u32) -> u32 {
        self & other
    }
    #[inline(always)]
    fn or(self, other: u32) -> u32 {
        self | other
    }
    #[inline(always)]
    fn up<const K: i32>(self) -> u32 {
        self << K
    }
    #[inline(always)]
    fn down<const K: i32>(self) -> u32 {
        self >> K
    }
    #[inline(always)]
    fn reversed(self) -> u32 {
        self.reverse_bits()
    }
    #[inline(always)]
    fn gather(from: &[u32], index: &[u32]) -> u32 {
        from[index[0] as usize]
    }
    #[inline(always)]
    fn pack(self, _chosen: u32, to: &mut [u32]) {
        to[0] = self;
    }
}
