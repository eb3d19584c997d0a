//! Eight lanes as plain arrays: what the compiler makes of them at the target's baseline.

use super::{Lanes, WideLanes};
use std::array::from_fn;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

/// Eight f32.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
pub(crate) struct F32x8([f32; 8]);

/// Eight f64.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct F64x8([f64; 8]);

/// Eight truth values: all bits or none.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
pub(crate) struct Mask8([u32; 8]);

macro_rules! operators {
    ($lanes:ident: $($trait:ident::$method:ident $op:tt),*) => {
        $(impl $trait for $lanes {
            type Output = $lanes;
            #[inline(always)]
            fn $method(self, other: $lanes) -> $lanes {
                $lanes(from_fn(|i| self.0[i] $op other.0[i]))
            }
        })*
    };
}
operators!(F32x8: Add::add +, Sub::sub -, Mul::mul *, Div::div /);
operators!(F64x8: Add::add +, Sub::sub -, Mul::mul *, Div::div /);
operators!(Mask8: BitAnd::bitand &, BitOr::bitor |);

impl Neg for F32x8 {
    type Output = F32x8;
    #[inline(always)]
    fn neg(self) -> F32x8 {
        F32x8(self.0.map(|x| -x))
    }
}

impl Neg for F64x8 {
    type Output = F64x8;
    #[inline(always)]
    fn neg(self) -> F64x8 {
        F64x8(self.0.map(|x| -x))
    }
}

impl F32x8 {
    #[inline(always)]
    fn compare(self, other: F32x8, test: impl Fn(f32, f32) -> bool) -> Mask8 {
        Mask8(from_fn(|i| {
            u32::from(test(self.0[i], other.0[i])).wrapping_neg()
        }))
    }
}

impl Lanes for F32x8 {
    const N: usize = 8;
    type Mask = Mask8;
    type Wide = F64x8;

    #[inline(always)]
    fn splat(x: f32) -> F32x8 {
        F32x8([x; 8])
    }
    #[inline(always)]
    fn load(from: &[f32]) -> F32x8 {
        let from = &from[..8];
        F32x8(from_fn(|i| from[i]))
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        to[..8].copy_from_slice(&self.0);
    }
    #[inline(always)]
    fn lt(self, other: F32x8) -> Mask8 {
        self.compare(other, |a, b| a < b)
    }
    #[inline(always)]
    fn le(self, other: F32x8) -> Mask8 {
        self.compare(other, |a, b| a <= b)
    }
    #[inline(always)]
    fn select(mask: Mask8, yes: F32x8, no: F32x8) -> F32x8 {
        F32x8(from_fn(|i| {
            f32::from_bits((yes.0[i].to_bits() & mask.0[i]) | (no.0[i].to_bits() & !mask.0[i]))
        }))
    }
    #[inline(always)]
    fn bits(mask: Mask8) -> u32 {
        let mut bits = 0;
        for (i, m) in mask.0.iter().enumerate() {
            bits |= m & (1 << i);
        }
        bits
    }
    #[inline(always)]
    fn abs(self) -> F32x8 {
        F32x8(self.0.map(f32::abs))
    }
    #[inline(always)]
    fn min(self, other: F32x8) -> F32x8 {
        F32x8(from_fn(|i| Lanes::min(self.0[i], other.0[i])))
    }
    #[inline(always)]
    fn max(self, other: F32x8) -> F32x8 {
        F32x8(from_fn(|i| Lanes::max(self.0[i], other.0[i])))
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
    fn widen(self) -> F64x8 {
        F64x8(self.0.map(f64::from))
    }
    #[inline(always)]
    fn narrow(wide: F64x8) -> F32x8 {
        F32x8(wide.0.map(|x| x as f32))
    }
}

impl WideLanes for F64x8 {
    #[inline(always)]
    fn splat(x: f64) -> F64x8 {
        F64x8([x; 8])
    }
    #[inline(always)]
    fn load(from: &[f64]) -> F64x8 {
        let from = &from[..8];
        F64x8(from_fn(|i| from[i]))
    }
    #[inline(always)]
    fn sqrt(self) -> F64x8 {
        F64x8(self.0.map(f64::sqrt))
    }
    #[inline(always)]
    fn copysign(self, sign: F64x8) -> F64x8 {
        F64x8(from_fn(|i| self.0[i].copysign(sign.0[i])))
    }
    #[inline(always)]
    fn min(self, other: F64x8) -> F64x8 {
        F64x8(from_fn(|i| WideLanes::min(self.0[i], other.0[i])))
    }
    #[inline(always)]
    fn max(self, other: F64x8) -> F64x8 {
        F64x8(from_fn(|i| WideLanes::max(self.0[i], other.0[i])))
    }
    #[inline(always)]
    fn positive_or(self, other: F64x8) -> F64x8 {
        F64x8(from_fn(|i| self.0[i].positive_or(other.0[i])))
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
