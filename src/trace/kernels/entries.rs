//! The entries: one set of functions per instruction set, the only ones with `#[target_feature]`. The disassembly test knows
//! them by this module's path.
#![allow(
    unsafe_code,
    reason = "an entry is called on the proof that the machine has its instructions"
)]

use super::batch::{self, Scratch};
use super::instances::InstanceLeaves;
use super::packet::{self, Bests, Packet};
use super::ray::WalkRay;
use super::stack::Stack;
use super::walk::{self, Best, Tree};
use crate::flat::{Child, FlatScene, Spheres};
use crate::math::lanes::{Lanes, baseline};
#[cfg(target_arch = "x86_64")]
use crate::math::lanes::{avx2 as avx2_lanes, avx512 as avx512_lanes};
use crate::trace::cut;
use crate::trace::isa::Level;
use crate::trace::{Hits, Isa, Rays};
use std::cell::RefCell;

/// The entries for spheres outside the tree: lanes for rays, features.
macro_rules! looped {
    ($lanes:ty $(, $features:literal)?) => {
        $(#[target_feature(enable = $features)])?
        #[inline(never)]
        pub(in super::super) fn looped_closest(spheres: &Spheres, rays: &Rays, hits: &mut Hits) {
            batch::looped_closest::<$lanes>(spheres, rays, hits);
        }

        $(#[target_feature(enable = $features)])?
        #[inline(never)]
        pub(in super::super) fn looped_occluded(spheres: &Spheres, rays: &Rays, out: &mut [bool]) {
            batch::looped_occluded::<$lanes>(spheres, rays, out);
        }
    };
}

/// What the entries for trees call: functions of their own, so that each is compiled once and not wherever it is called.
pub(super) trait Walks: Lanes {
    /// [`walk::walk`].
    fn walk<I: InstanceLeaves<Self>, const T: bool, const S: bool, const ANY: bool>(
        tree: &Tree,
        start: Child,
        ray: &WalkRay<Self>,
        instances: &mut I,
        stack: &mut Stack,
        best: &mut Best,
    ) -> bool;

    /// [`packet::walk`].
    fn walk_packet<I: InstanceLeaves<Self>, const T: bool, const S: bool, const ANY: bool>(
        tree: &Tree,
        packet: &Packet<Self>,
        instances: &mut I,
        scratch: &mut packet::Scratch,
        floor: &Self,
        best: &mut Bests<Self>,
    );
}

/// The entries for trees: lanes for children, primitives and packets of rays, features.
macro_rules! tree {
    ($lanes:ty $(, $features:literal)?) => {
        $(#[target_feature(enable = $features)])?
        #[inline(never)]
        fn walk<I: InstanceLeaves<$lanes>, const T: bool, const S: bool, const ANY: bool>(
            tree: &Tree,
            start: Child,
            ray: &WalkRay<$lanes>,
            instances: &mut I,
            stack: &mut Stack,
            best: &mut Best,
        ) -> bool {
            walk::walk::<$lanes, I, T, S, ANY>(tree, start, ray, instances, stack, best)
        }

        $(#[target_feature(enable = $features)])?
        #[inline(never)]
        fn walk_packet<I: InstanceLeaves<$lanes>, const T: bool, const S: bool, const ANY: bool>(
            tree: &Tree,
            packet: &Packet<$lanes>,
            instances: &mut I,
            scratch: &mut packet::Scratch,
            floor: &$lanes,
            best: &mut Bests<$lanes>,
        ) {
            packet::walk::<$lanes, I, T, S, ANY>(tree, packet, instances, scratch, *floor, best);
        }

        #[allow(unused_unsafe, reason = "safe where no feature is enabled")]
        impl Walks for $lanes {
            #[inline(always)]
            fn walk<I: InstanceLeaves<$lanes>, const T: bool, const S: bool, const ANY: bool>(
                tree: &Tree,
                start: Child,
                ray: &WalkRay<$lanes>,
                instances: &mut I,
                stack: &mut Stack,
                best: &mut Best,
            ) -> bool {
                // SAFETY: lanes exist where the machine has their instructions, see `math::lanes`.
                unsafe { walk::<I, T, S, ANY>(tree, start, ray, instances, stack, best) }
            }

            #[inline(always)]
            fn walk_packet<
                I: InstanceLeaves<$lanes>,
                const T: bool,
                const S: bool,
                const ANY: bool,
            >(
                tree: &Tree,
                packet: &Packet<$lanes>,
                instances: &mut I,
                scratch: &mut packet::Scratch,
                floor: &$lanes,
                best: &mut Bests<$lanes>,
            ) {
                // SAFETY: likewise.
                unsafe {
                    walk_packet::<I, T, S, ANY>(tree, packet, instances, scratch, floor, best);
                }
            }
        }

        $(#[target_feature(enable = $features)])?
        #[inline(never)]
        pub(in super::super) fn tree_closest<const T: bool, const S: bool, const I: bool>(
            scene: &FlatScene,
            rays: &Rays,
            hits: &mut Hits,
            scratch: &mut Scratch,
        ) {
            batch::tree_closest::<$lanes, T, S, I>(scene, rays, hits, scratch);
        }

        $(#[target_feature(enable = $features)])?
        #[inline(never)]
        pub(in super::super) fn tree_occluded<const T: bool, const S: bool, const I: bool>(
            scene: &FlatScene,
            rays: &Rays,
            out: &mut [bool],
            scratch: &mut Scratch,
        ) {
            batch::tree_occluded::<$lanes, T, S, I>(scene, rays, out, scratch);
        }
    };
}

pub(super) mod scalar {
    use super::*;
    looped!(f32);
    tree!(f32);
}

pub(super) mod sse2 {
    use super::*;
    looped!(baseline::F32x8);
    tree!(baseline::F32x8);
}

#[cfg(target_arch = "x86_64")]
pub(super) mod avx2 {
    use super::*;
    looped!(avx2_lanes::F32x8, "avx2,bmi1,bmi2,lzcnt,popcnt");
    tree!(avx2_lanes::F32x8, "avx2,bmi1,bmi2,lzcnt,popcnt");
}

/// Trees are walked by the entries of AVX2: children, primitives and packets come in eights.
#[cfg(target_arch = "x86_64")]
pub(super) mod avx512 {
    use super::*;
    looped!(
        avx512_lanes::F32x16,
        "avx2,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl,avx512dq,avx512bw"
    );
}

/// Calls an entry for spheres outside the tree.
macro_rules! on_isa {
    ($isa:expr, $entry:ident($($argument:expr),*)) => {
        match $isa.level() {
            Level::Scalar => scalar::$entry($($argument),*),
            // SAFETY: the value is the proof that this machine has the instructions.
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => unsafe { avx2::$entry($($argument),*) },
            // SAFETY: likewise.
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => unsafe { avx512::$entry($($argument),*) },
            _ => sse2::$entry($($argument),*),
        }
    };
}

/// Calls an entry for trees with the constants of what the tree holds, triangles, spheres, instances: of triangles alone and of
/// spheres alone, else all that there can be, since every set costs a compiler seconds.
macro_rules! on_tree {
    ($isa:expr, $scene:expr, $entry:ident($($argument:expr),*)) => {
        match ($isa.level(), holds($scene)) {
            (Level::Scalar, _) => scalar::$entry::<true, true, true>($($argument),*),
            #[cfg(target_arch = "x86_64")]
            (Level::Avx2 | Level::Avx512, (_, false, false)) => {
                // SAFETY: the value is the proof that this machine has the instructions.
                unsafe { avx2::$entry::<true, false, false>($($argument),*) }
            }
            #[cfg(target_arch = "x86_64")]
            (Level::Avx2 | Level::Avx512, (false, true, false)) => {
                // SAFETY: likewise.
                unsafe { avx2::$entry::<false, true, false>($($argument),*) }
            }
            #[cfg(target_arch = "x86_64")]
            (Level::Avx2 | Level::Avx512, _) => {
                // SAFETY: likewise.
                unsafe { avx2::$entry::<true, true, true>($($argument),*) }
            }
            _ => sse2::$entry::<true, true, true>($($argument),*),
        }
    };
}

thread_local! {
    /// Of this thread's walks.
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

/// Closest hits with the looped spheres; `hits.t` are limits.
pub(super) fn looped_closest(isa: Isa, s: &Spheres, rays: &Rays, hits: &mut Hits) {
    on_isa!(isa, looped_closest(s, rays, hits));
}

/// Occlusion by the looped spheres.
pub(super) fn looped_occluded(isa: Isa, s: &Spheres, rays: &Rays, out: &mut [bool]) {
    on_isa!(isa, looped_occluded(s, rays, out));
}

/// Closest hits in the tree, nearer than those of the looped spheres.
pub(super) fn tree_closest(isa: Isa, scene: &FlatScene, rays: &Rays, hits: &mut Hits) {
    SCRATCH
        .with_borrow_mut(|scratch| on_tree!(isa, scene, tree_closest(scene, rays, hits, scratch)));
}

/// Occlusion by the tree.
pub(super) fn tree_occluded(isa: Isa, scene: &FlatScene, rays: &Rays, out: &mut [bool]) {
    SCRATCH
        .with_borrow_mut(|scratch| on_tree!(isa, scene, tree_occluded(scene, rays, out, scratch)));
}

/// What the world's tree holds. From its buffers rather than from `Needs`, which also counts triangles of instances.
fn holds(scene: &FlatScene) -> (bool, bool, bool) {
    (
        !scene.world.triangles.blocks.is_empty(),
        !scene.spheres.blocks.is_empty(),
        cut::INSTANCES && !scene.world.bvh.instance_order.is_empty(),
    )
}
