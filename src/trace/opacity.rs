//! Opacity: rays pass surfaces that are not there. Runs after closest hit, and in place of occluded, in scenes that have
//! such surfaces; the kernels know nothing of it.
//!
//! A mask decides by the place alone. A blend lets a path pass by a random number of its own dimension, and takes its
//! share of a shadow ray. Passing is no bounce, and changes neither throughput nor density.

use super::attributes::hit_presence;
use super::sampler::{Pair, sample_pair};
use super::spawn::offset_origin;
use super::surface::place;
use super::vector::{get, set};
use super::wave::Wave;
use super::{Hits, Isa, Rays, Sampler, closest_hit};
use crate::flat::FlatScene;
use crate::math::Vec3;

/// Surfaces that a ray may pass on its way; the next one is there. A ray through more of them sees next to nothing, unless
/// they are masks, and 64 holes in a row are a thicket.
pub(super) const MAX_PASSES: u32 = 64;

/// A shadow ray that passed a surface ends this many error bounds of the surface's hit earlier: the new origin lies beside
/// the old ray by up to two bounds, so that it meets a light with normal n at an angle θ up to 2 tan θ of them earlier.
/// Covers θ < 86°, beyond which a light hardly shines.
const SLACK: f32 = 32.0;

/// Rays that go on, and where paths came from. Empty in scenes that are opaque.
#[derive(Debug, Default)]
pub(super) struct Through {
    rays: Rays,
    hits: Hits,
    /// Path or shadow ray of each ray.
    index: Vec<u32>,
    /// Where each path last scattered: its ray's origin before it passed anything.
    start: [Vec<f32>; 3],
}

impl Through {
    /// Where path i last scattered, if that is kept.
    pub(super) fn start(&self, i: usize) -> Option<Vec3> {
        (i < self.start[0].len()).then(|| get(&self.start, i))
    }
}

/// The number that lets paths pass blends at a bounce.
pub(super) fn random(sampler: Sampler, bounce: u32) -> impl Fn(u32, u32, u32) -> f32 + Copy {
    move |key, sample, pass| sample_pair(sampler, key, sample, Pair::Opacity(bounce, pass))[0]
}

/// Lets every path go on to the first surface that is there: where `number` (of key, sample and pass) is at most the share of
/// rays that meet it. Returns how many rays that took.
#[inline(never)]
pub(super) fn pass_paths(
    wave: &mut Wave,
    scene: &FlatScene,
    isa: Isa,
    number: impl Fn(u32, u32, u32) -> f32,
) -> u64 {
    let Wave {
        paths,
        hits,
        through,
        ..
    } = wave;
    for (start, origin) in through.start.iter_mut().zip(&paths.rays.origin) {
        start.clone_from(origin);
    }
    through.index.clear();
    through.index.extend(0..paths.len() as u32);
    let mut traced = 0;
    for pass in 0..MAX_PASSES {
        through.rays.clear();
        let rays = &mut paths.rays;
        through.index.retain(|&i| {
            let i = i as usize;
            if hits.prim[i] == Hits::NONE {
                return false;
            }
            let presence = hit_presence(scene, rays, hits, i);
            let number = || number(paths.key[i], paths.sample[i], pass);
            if presence >= 1.0 || presence > 0.0 && number() <= presence {
                return false;
            }
            let origin = beyond(scene, rays, hits, i);
            set(&mut rays.origin, i, origin);
            let dir = get(&rays.dir, i).to_array();
            through.rays.push(origin.to_array(), dir, f32::MAX);
            true
        });
        if through.index.is_empty() {
            break;
        }
        closest_hit(scene, isa, &through.rays, &mut through.hits);
        traced += through.rays.len() as u64;
        for (k, &i) in through.index.iter().enumerate() {
            replace(hits, i as usize, &through.hits, k);
        }
    }
    traced
}

/// Finds which shadow rays something blocks, and takes from the others what blends on their way keep. Returns how many
/// rays that took.
#[inline(never)]
pub(super) fn pass_shadows(wave: &mut Wave, scene: &FlatScene, isa: Isa) -> u64 {
    let Wave {
        shadows, through, ..
    } = wave;
    shadows.blocked.clear();
    shadows.blocked.resize(shadows.rays.len(), true);
    through.index.clear();
    through.index.extend(0..shadows.rays.len() as u32);
    through.rays.clone_from(&shadows.rays);
    let mut traced = 0;
    // One pass more: after the last surface comes the way to the light.
    for _ in 0..=MAX_PASSES {
        closest_hit(scene, isa, &through.rays, &mut through.hits);
        traced += through.rays.len() as u64;
        let mut left = 0;
        for k in 0..through.index.len() {
            let i = through.index[k] as usize;
            if through.hits.prim[k] == Hits::NONE {
                shadows.blocked[i] = false;
                continue;
            }
            let presence = hit_presence(scene, &through.rays, &through.hits, k);
            let passes = get(&shadows.radiance, i) * (1.0 - presence);
            if passes == Vec3::ZERO {
                continue;
            }
            set(&mut shadows.radiance, i, passes);
            let origin = beyond(scene, &through.rays, &through.hits, k);
            let t_max = remaining(&through.rays, &through.hits, k, origin);
            if t_max <= 0.0 {
                shadows.blocked[i] = false;
                continue;
            }
            // What goes on moves to the front: `left` is not beyond k.
            let dir = get(&through.rays.dir, k);
            set(&mut through.rays.origin, left, origin);
            set(&mut through.rays.dir, left, dir);
            through.rays.t_max[left] = t_max;
            through.index[left] = i as u32;
            left += 1;
        }
        if left == 0 {
            break;
        }
        through.index.truncate(left);
        through.rays.truncate(left);
    }
    traced
}

/// Where the ray of hit i goes on, on the other side of what it hit.
fn beyond(scene: &FlatScene, rays: &Rays, hits: &Hits, i: usize) -> Vec3 {
    let point = place(scene, rays, hits, i);
    let dir = get(&rays.dir, i).to_array();
    let origin = offset_origin(point.position, point.ng, hits.err[i], dir);
    Vec3::from(origin)
}

/// What is left of a shadow ray's t from its new origin.
fn remaining(rays: &Rays, hits: &Hits, k: usize, origin: Vec3) -> f32 {
    let t_max = rays.t_max[k];
    if t_max == f32::MAX {
        return t_max;
    }
    let way = (origin - get(&rays.origin, k)).dot(get(&rays.dir, k));
    t_max - way - SLACK * hits.err[k]
}

fn replace(hits: &mut Hits, i: usize, by: &Hits, k: usize) {
    hits.t[i] = by.t[k];
    hits.u[i] = by.u[k];
    hits.v[i] = by.v[k];
    hits.prim[i] = by.prim[k];
    hits.instance[i] = by.instance[k];
    hits.err[i] = by.err[k];
}
