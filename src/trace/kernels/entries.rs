//! The entries: one set of functions per instruction set, the only ones with `#[target_feature]`. The disassembly test knows
//! them by this module's path.
#![allow(
    unsafe_code,
    reason = "an entry is called on the proof that the machine has its instructions"
)]

use super::batch;
use super::stream::Scratch;
use crate::flat::{FlatScene, Spheres};
use crate::math::lanes::portable;
#[cfg(target_arch = "x86_64")]
use crate::math::lanes::{avx2 as avx2_lanes, avx512 as avx512_lanes};
use crate::trace::{Hits, Rays};
use std::cell::RefCell;

/// A module of entries: lanes for rays against looped spheres, lanes for children and primitives in the tree, features.
macro_rules! entries {
    ($level:ident, $rays:ty, $tree:ty $(, $features:literal)?) => {
        pub(super) mod $level {
            use super::*;

            $(#[target_feature(enable = $features)])?
            #[inline(never)]
            pub(in super::super) fn looped_closest(spheres: &Spheres, rays: &Rays, hits: &mut Hits) {
                batch::looped_closest::<$rays>(spheres, rays, hits);
            }

            $(#[target_feature(enable = $features)])?
            #[inline(never)]
            pub(in super::super) fn looped_occluded(spheres: &Spheres, rays: &Rays, out: &mut [bool]) {
                batch::looped_occluded::<$rays>(spheres, rays, out);
            }

            $(#[target_feature(enable = $features)])?
            #[inline(never)]
            pub(in super::super) fn tree_closest<const T: bool, const S: bool, const I: bool>(
                scene: &FlatScene,
                rays: &Rays,
                hits: &mut Hits,
                scratch: &mut Scratch,
            ) {
                batch::tree_closest::<$tree, T, S, I>(scene, rays, hits, scratch);
            }

            $(#[target_feature(enable = $features)])?
            #[inline(never)]
            pub(in super::super) fn tree_occluded<const T: bool, const S: bool, const I: bool>(
                scene: &FlatScene,
                rays: &Rays,
                out: &mut [bool],
                scratch: &mut Scratch,
            ) {
                batch::tree_occluded::<$tree, T, S, I>(scene, rays, out, scratch);
            }
        }
    };
}

entries!(scalar, f32, f32);
entries!(sse2, portable::F32x8, portable::F32x8);
#[cfg(target_arch = "x86_64")]
entries!(
    avx2,
    avx2_lanes::F32x8,
    avx2_lanes::F32x8,
    "avx2,bmi1,bmi2,lzcnt,popcnt"
);
#[cfg(target_arch = "x86_64")]
entries!(
    avx512,
    avx512_lanes::F32x16,
    avx2_lanes::F32x8,
    "avx2,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl,avx512dq,avx512bw"
);

/// Calls an entry of the level of an [`Isa`](crate::trace::Isa).
macro_rules! on_isa {
    ($isa:expr, $entry:ident $(::<$($flag:literal),*>)? ($($argument:expr),*)) => {{
        use crate::trace::isa::Level;
        use crate::trace::kernels::entries;
        match $isa.level() {
            Level::Scalar => entries::scalar::$entry $(::<$($flag),*>)? ($($argument),*),
            // SAFETY: the value is the proof that this machine has the instructions.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => unsafe { entries::avx2::$entry $(::<$($flag),*>)? ($($argument),*) },
            // SAFETY: likewise.
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => unsafe { entries::avx512::$entry $(::<$($flag),*>)? ($($argument),*) },
            _ => entries::sse2::$entry $(::<$($flag),*>)? ($($argument),*),
        }
    }};
}

/// Calls an entry with the constants of what the tree holds: triangles, spheres, instances.
macro_rules! on_tree {
    ($tree:expr, $isa:expr, $entry:ident($($argument:expr),*)) => {
        match $tree {
            (_, false, false) => on_isa!($isa, $entry::<true, false, false>($($argument),*)),
            (_, false, true) => on_isa!($isa, $entry::<true, false, true>($($argument),*)),
            (false, true, false) => on_isa!($isa, $entry::<false, true, false>($($argument),*)),
            (false, true, true) => on_isa!($isa, $entry::<false, true, true>($($argument),*)),
            (true, true, false) => on_isa!($isa, $entry::<true, true, false>($($argument),*)),
            (true, true, true) => on_isa!($isa, $entry::<true, true, true>($($argument),*)),
        }
    };
}

thread_local! {
    /// Of this thread's walks.
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// Closest hits with the looped spheres; `hits.t` are limits.
pub(super) fn looped_closest(isa: crate::trace::Isa, s: &Spheres, rays: &Rays, hits: &mut Hits) {
    on_isa!(isa, looped_closest(s, rays, hits));
}

/// Occlusion by the looped spheres.
pub(super) fn looped_occluded(isa: crate::trace::Isa, s: &Spheres, rays: &Rays, out: &mut [bool]) {
    on_isa!(isa, looped_occluded(s, rays, out));
}

/// Closest hits in the tree, nearer than those of the looped spheres.
pub(super) fn tree_closest(
    isa: crate::trace::Isa,
    scene: &FlatScene,
    rays: &Rays,
    hits: &mut Hits,
) {
    SCRATCH.with_borrow_mut(|scratch| {
        on_tree!(holds(scene), isa, tree_closest(scene, rays, hits, scratch))
    });
}

/// Occlusion by the tree.
pub(super) fn tree_occluded(
    isa: crate::trace::Isa,
    scene: &FlatScene,
    rays: &Rays,
    out: &mut [bool],
) {
    SCRATCH.with_borrow_mut(|scratch| {
        on_tree!(holds(scene), isa, tree_occluded(scene, rays, out, scratch))
    });
}

/// What the world's tree holds. From its buffers rather than from `Needs`, which also counts triangles of instances.
fn holds(scene: &FlatScene) -> (bool, bool, bool) {
    (
        !scene.world.triangles.blocks.is_empty(),
        !scene.spheres.blocks.is_empty(),
        !scene.world.bvh.instance_order.is_empty(),
    )
}
