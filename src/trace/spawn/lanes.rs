//! The formulas of [`super`] in lanes; in one lane they are those functions.
#![allow(
    clippy::needless_range_loop,
    reason = "axes are numbers here: several arrays are indexed by one"
)]

use crate::math::lanes::{BitLanes, Lanes, WideLanes, Words};

/// [`super::triangle_point`].
#[inline(always)]
pub(in crate::trace) fn triangle_point<L: Lanes>(v: [[L; 3]; 3], b1: L, b2: L) -> [L; 3] {
    let b0 = L::splat(1.0) - b1 - b2;
    let mut p = [b0; 3];
    for axis in 0..3 {
        p[axis] = b0 * v[0][axis] + b1 * v[1][axis] + b2 * v[2][axis];
    }
    p
}

/// [`super::triangle_normal`].
#[inline(always)]
pub(in crate::trace) fn triangle_normal<L: BitLanes>(v: [[L; 3]; 3]) -> [L; 3] {
    let [mut a, mut b] = [[L::Wide::splat(0.0); 3]; 2];
    for axis in 0..3 {
        let from = v[0][axis].widen();
        a[axis] = v[1][axis].widen() - from;
        b[axis] = v[2][axis].widen() - from;
    }
    let n = [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ];
    normalized::<L>(n)
}

/// [`super::instance_point`], by rows of lanes.
#[inline(always)]
pub(in crate::trace) fn instance_point<L: Lanes, const N: usize>(
    to_world: &[[[f32; N]; 4]; 3],
    [x, y, z]: [L; 3],
) -> [L; 3] {
    let mut world = [x; 3];
    for axis in 0..3 {
        let m = |column: usize| L::load(&to_world[axis][column]).widen();
        let sum = m(0) * x.widen() + m(1) * y.widen() + m(2) * z.widen();
        world[axis] = L::narrow(sum + m(3));
    }
    world
}

/// [`super::instance_normal`], by rows of lanes.
#[inline(always)]
pub(in crate::trace) fn instance_normal<L: BitLanes, const N: usize>(
    to_local: &[[[f32; N]; 4]; 3],
    n: [L; 3],
) -> [L; 3] {
    let mut world = [L::Wide::splat(0.0); 3];
    for axis in 0..3 {
        let w = |row: usize| L::load(&to_local[row][axis]).widen();
        world[axis] = w(0) * n[0].widen() + w(1) * n[1].widen() + w(2) * n[2].widen();
    }
    normalized::<L>(world)
}

/// [`super::sphere_point`].
#[inline(always)]
pub(in crate::trace) fn sphere_point<L: Lanes>(
    [origin, dir]: [[L; 3]; 2],
    t: L,
    center: [L::Wide; 3],
    radius: L::Wide,
) -> ([L; 3], [L; 3]) {
    let mut from_center = center;
    for axis in 0..3 {
        let p = origin[axis].widen() + t.widen() * dir[axis].widen();
        from_center[axis] = p - center[axis];
    }
    let length = length(from_center);
    let [mut point, mut normal] = [[t; 3]; 2];
    for axis in 0..3 {
        let n = from_center[axis] / length;
        point[axis] = L::narrow(center[axis] + radius * n);
        normal[axis] = L::narrow(n);
    }
    (point, normal)
}

/// [`super::offset_origin`].
#[inline(always)]
pub(in crate::trace) fn offset_origin<L: BitLanes>(
    p: [L; 3],
    ng: [L; 3],
    err: L,
    dir: [L; 3],
) -> [L; 3] {
    let zero = L::Wide::splat(0.0);
    let mut cos = zero;
    for axis in 0..3 {
        cos = cos + ng[axis].widen() * dir[axis].widen();
    }
    let distance = L::select(L::wide_lt(cos, zero), -err, err);
    let mut origin = p;
    for axis in 0..3 {
        let offset = distance * ng[axis];
        origin[axis] = next(p[axis] + offset, offset);
    }
    origin
}

/// The next number in the direction of `by`'s sign; `x` itself where that is zero or NaN, and beyond the finite numbers.
#[inline(always)]
fn next<L: BitLanes>(x: L, by: L) -> L {
    let word = <L::Bits as Words>::splat;
    let (zero, sign) = (L::splat(0.0), by.to_bits().and(word(1 << 31)));
    // Up, or down as the negative of up.
    let up = L::from_bits(x.to_bits().xor(sign));
    let bits = up.to_bits();
    let larger = bits.plus(word(1));
    let smaller = bits.plus(word(u32::MAX));
    let moved = L::select(zero.lt(up), L::from_bits(larger), L::from_bits(smaller));
    // Zeros of both signs go to the smallest number.
    let moved = L::select(up.abs().le(zero), L::from_bits(word(1)), moved);
    let moved = L::from_bits(moved.to_bits().xor(sign));
    let goes = zero.lt(by.abs()) & up.lt(L::splat(f32::INFINITY));
    L::select(goes, moved, x)
}

/// 0 where there is no length.
#[inline(always)]
fn normalized<L: BitLanes>(v: [L::Wide; 3]) -> [L; 3] {
    let length = length(v);
    let there = L::wide_lt(L::Wide::splat(0.0), length);
    let unit = |x: L::Wide| L::select(there, L::narrow(x / length), L::splat(0.0));
    [unit(v[0]), unit(v[1]), unit(v[2])]
}

#[inline(always)]
fn length<W: WideLanes>(v: [W; 3]) -> W {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn next_is_that_of_the_standard_library() {
        let values = [
            0.0,
            -0.0,
            1e-45,
            -1e-45,
            1.0,
            -1.0,
            0.1,
            -2.5e7,
            f32::MAX,
            f32::MIN,
            f32::INFINITY,
            f32::NEG_INFINITY,
            f32::NAN,
        ];
        for x in values {
            for (by, want) in [
                (1e-30, x.next_up()),
                (-3.0, x.next_down()),
                (0.0, x),
                (-0.0, x),
                (f32::NAN, x),
            ] {
                let found = next::<f32>(x, by);
                assert!(
                    found.to_bits() == want.to_bits() || x.is_nan() && found.is_nan(),
                    "{x} by {by}: {found}"
                );
            }
        }
    }
}
