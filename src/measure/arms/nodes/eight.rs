//! What nodes of eight children share: the box test in lanes, and the order of those that are met.

use crate::flat::bvh::{STACK, WIDTH};
use crate::math::lanes::Lanes;
use crate::trace::kernels::ray::WalkRay;

/// Where the ray enters each of eight boxes, and in bits which of them it meets before `cull`.
#[inline(always)]
pub(super) fn boxes_met<L: Lanes>(
    planes: &[[f32; WIDTH]; 6],
    ray: &WalkRay<L>,
    cull: f32,
) -> ([f32; WIDTH], u32) {
    let mut near = [0.0; WIDTH];
    let mut met = 0;
    let mut at = 0;
    while at < WIDTH {
        let interval = ray.slabs(planes, at);
        interval.near.store(&mut near[at..]);
        met |= L::bits(interval.meets(L::splat(cull))) << at;
        at += L::N;
    }
    (near, met)
}

/// Puts off the children that are met, farthest first, and returns the nearest.
#[inline(always)]
pub(super) fn put_off<C: Copy>(
    near: &[f32; WIDTH],
    mut met: u32,
    child: impl Fn(usize) -> C,
    stack: &mut [(C, f32); STACK],
    top: &mut usize,
) -> Option<C> {
    if met == 0 {
        return None;
    }
    let mut nearest = lowest(met);
    met &= met - 1;
    let first = *top;
    while met != 0 {
        let mut far = lowest(met);
        met &= met - 1;
        if near[far] < near[nearest] {
            (far, nearest) = (nearest, far);
        }
        let entry = (child(far), near[far]);
        let mut place = *top;
        while place > first && stack[place - 1].1 < entry.1 {
            stack[place] = stack[place - 1];
            place -= 1;
        }
        stack[place] = entry;
        *top += 1;
    }
    Some(child(nearest))
}

/// Index of the lowest set bit of eight.
#[inline(always)]
fn lowest(bits: u32) -> usize {
    bits.trailing_zeros() as usize & (WIDTH - 1)
}
