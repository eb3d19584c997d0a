//! Lanes as plain arrays, for machines without a backend of their own: what the compiler makes of them at the target's
//! baseline.

use super::{BitLanes, Lanes, WideLanes, Words, bits};
use std::array::from_fn;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

/// Some f32.
#[derive(Clone, Copy)]
#[repr(C, align(16))]
pub(crate) struct Floats<const N: usize>([f32; N]);

/// Some f64.
#[derive(Clone, Copy)]
#[repr(C, align(16))]
pub(crate) struct Doubles<const N: usize>([f64; N]);

/// Some truth values: all bits or none.
#[derive(Clone, Copy)]
#[repr(C, align(16))]
pub(crate) struct Truths<const N: usize>([u32; N]);

/// Four f32.
pub(crate) type F32x4 = Floats<4>;

/// Eight f32.
pub(crate) type F32x8 = Floats<8>;

macro_rules! operators {
    ($lanes:ident: $($trait:ident::$method:ident $op:tt),*) => {
        $(impl<const N: usize> $trait for $lanes<N> {
            type Output = $lanes<N>;
            #[inline(always)]
            fn $method(self, other: $lanes<N>) -> $lanes<N> {
                $lanes(from_fn(|i| self.0[i] $op other.0[i]))
            }
        })*
    };
}
operators!(Floats: Add::add +, Sub::sub -, Mul::mul *, Div::div /);
operators!(Doubles: Add::add +, Sub::sub -, Mul::mul *, Div::div /);
operators!(Truths: BitAnd::bitand &, BitOr::bitor |);

impl<const N: usize> Neg for Floats<N> {
    type Output = Floats<N>;
    #[inline(always)]
    fn neg(self) -> Floats<N> {
        Floats(self.0.map(|x| -x))
    }
}

impl<const N: usize> Neg for Doubles<N> {
    type Output = Doubles<N>;
    #[inline(always)]
    fn neg(self) -> Doubles<N> {
        Doubles(self.0.map(|x| -x))
    }
}

impl<const N: usize> Floats<N> {
    #[inline(always)]
    fn compare(self, other: Floats<N>, test: impl Fn(f32, f32) -> bool) -> Truths<N> {
        Truths(from_fn(|i| {
            u32::from(test(self.0[i], other.0[i])).wrapping_neg()
        }))
    }
}

impl<const N: usize> Lanes for Floats<N> {
    const N: usize = N;
    type Mask = Truths<N>;
    type Wide = Doubles<N>;

    #[inline(always)]
    fn splat(x: f32) -> Floats<N> {
        Floats([x; N])
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Floats<N> {
        let from = &from[..N];
        Floats(from_fn(|i| from[i]))
    }
    #[inline(always)]
    fn load_bytes(from: &[u8]) -> Floats<N> {
        let from = &from[..N];
        Floats(from_fn(|i| f32::from(from[i])))
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        to[..N].copy_from_slice(&self.0);
    }
    #[inline(always)]
    fn lt(self, other: Floats<N>) -> Truths<N> {
        self.compare(other, |a, b| a < b)
    }
    #[inline(always)]
    fn le(self, other: Floats<N>) -> Truths<N> {
        self.compare(other, |a, b| a <= b)
    }
    #[inline(always)]
    fn select(mask: Truths<N>, yes: Floats<N>, no: Floats<N>) -> Floats<N> {
        Floats(from_fn(|i| {
            f32::from_bits((yes.0[i].to_bits() & mask.0[i]) | (no.0[i].to_bits() & !mask.0[i]))
        }))
    }
    #[inline(always)]
    fn bits(mask: Truths<N>) -> u32 {
        let mut bits = 0;
        for (i, m) in mask.0.iter().enumerate() {
            bits |= m & (1 << i);
        }
        bits
    }
    #[inline(always)]
    fn abs(self) -> Floats<N> {
        Floats(self.0.map(f32::abs))
    }
    #[inline(always)]
    fn sqrt(self) -> Floats<N> {
        Floats(self.0.map(f32::sqrt))
    }
    #[inline(always)]
    fn min(self, other: Floats<N>) -> Floats<N> {
        Floats(from_fn(|i| Lanes::min(self.0[i], other.0[i])))
    }
    #[inline(always)]
    fn max(self, other: Floats<N>) -> Floats<N> {
        Floats(from_fn(|i| Lanes::max(self.0[i], other.0[i])))
    }
    #[inline(always)]
    fn least(self) -> f32 {
        self.0.into_iter().fold(f32::INFINITY, Lanes::min)
    }
    #[inline(always)]
    fn greatest(self) -> f32 {
        self.0.into_iter().fold(f32::NEG_INFINITY, Lanes::max)
    }
    #[inline(always)]
    fn widen(self) -> Doubles<N> {
        Doubles(self.0.map(f64::from))
    }
    #[inline(always)]
    fn narrow(wide: Doubles<N>) -> Floats<N> {
        Floats(wide.0.map(|x| x as f32))
    }
}

impl<const N: usize> WideLanes for Doubles<N> {
    #[inline(always)]
    fn splat(x: f64) -> Doubles<N> {
        Doubles([x; N])
    }
    #[inline(always)]
    fn load(from: &[f64]) -> Doubles<N> {
        let from = &from[..N];
        Doubles(from_fn(|i| from[i]))
    }
    #[inline(always)]
    fn sqrt(self) -> Doubles<N> {
        Doubles(self.0.map(f64::sqrt))
    }
    #[inline(always)]
    fn copysign(self, sign: Doubles<N>) -> Doubles<N> {
        Doubles(from_fn(|i| self.0[i].copysign(sign.0[i])))
    }
    #[inline(always)]
    fn min(self, other: Doubles<N>) -> Doubles<N> {
        Doubles(from_fn(|i| WideLanes::min(self.0[i], other.0[i])))
    }
    #[inline(always)]
    fn max(self, other: Doubles<N>) -> Doubles<N> {
        Doubles(from_fn(|i| WideLanes::max(self.0[i], other.0[i])))
    }
    #[inline(always)]
    fn positive_or(self, other: Doubles<N>) -> Doubles<N> {
        Doubles(from_fn(|i| self.0[i].positive_or(other.0[i])))
    }
    #[inline(always)]
    fn any_not_negative(self) -> bool {
        let mut any = false;
        for x in self.0 {
            any |= x >= 0.0;
        }
        any
    }
}

impl<const N: usize> BitLanes for Floats<N> {
    type Bits = Uints<N>;

    #[inline(always)]
    fn to_bits(self) -> Uints<N> {
        Uints(self.0.map(f32::to_bits))
    }
    #[inline(always)]
    fn from_bits(bits: Uints<N>) -> Floats<N> {
        Floats(bits.0.map(f32::from_bits))
    }
    #[inline(always)]
    fn from_words(words: Uints<N>) -> Floats<N> {
        Floats(words.0.map(|x| x as f32))
    }
    #[inline(always)]
    fn to_words(self) -> Uints<N> {
        Uints(self.0.map(|x| x as u32))
    }
    #[inline(always)]
    fn wide_lt(a: Doubles<N>, b: Doubles<N>) -> Truths<N> {
        Truths(from_fn(|i| u32::from(a.0[i] < b.0[i]).wrapping_neg()))
    }
    #[inline(always)]
    fn gather(from: &[f32], index: &[u32]) -> Floats<N> {
        Floats(from_fn(|i| from[index[i] as usize]))
    }
}

/// Some u32.
#[derive(Clone, Copy)]
#[repr(C, align(16))]
pub(crate) struct Uints<const N: usize>([u32; N]);

impl<const N: usize> Uints<N> {
    #[inline(always)]
    fn with(self, other: Uints<N>, f: impl Fn(u32, u32) -> u32) -> Uints<N> {
        Uints(from_fn(|i| f(self.0[i], other.0[i])))
    }
}

impl<const N: usize> Words for Uints<N> {
    #[inline(always)]
    fn splat(x: u32) -> Uints<N> {
        Uints([x; N])
    }
    #[inline(always)]
    fn load(from: &[u32]) -> Uints<N> {
        let from = &from[..N];
        Uints(from_fn(|i| from[i]))
    }
    #[inline(always)]
    fn plus(self, other: Uints<N>) -> Uints<N> {
        self.with(other, u32::wrapping_add)
    }
    #[inline(always)]
    fn times(self, other: Uints<N>) -> Uints<N> {
        self.with(other, u32::wrapping_mul)
    }
    #[inline(always)]
    fn xor(self, other: Uints<N>) -> Uints<N> {
        self.with(other, |a, b| a ^ b)
    }
    #[inline(always)]
    fn and(self, other: Uints<N>) -> Uints<N> {
        self.with(other, |a, b| a & b)
    }
    #[inline(always)]
    fn or(self, other: Uints<N>) -> Uints<N> {
        self.with(other, |a, b| a | b)
    }
    #[inline(always)]
    fn up<const K: i32>(self) -> Uints<N> {
        Uints(self.0.map(|x| x << K))
    }
    #[inline(always)]
    fn down<const K: i32>(self) -> Uints<N> {
        Uints(self.0.map(|x| x >> K))
    }
    #[inline(always)]
    fn gather(from: &[u32], index: &[u32]) -> Uints<N> {
        Uints(from_fn(|i| from[index[i] as usize]))
    }
    #[inline(always)]
    fn pack(self, chosen: u32, to: &mut [u32]) {
        bits::pack(&self.0, chosen, to);
    }
}
