//! Grouping: which paths missed, what the others hit, how that scatters, and whether it shines. One pass over the hits,
//! which also looks up materials and their constant colours.
#![allow(
    clippy::needless_range_loop,
    reason = "paths are numbers here: several arrays are indexed by one"
)]

use super::Hits;
use super::wave::Wave;
use crate::flat::{ColorSource, FlatScene, Scatter, Spheres};

/// Paths by what became of them, as indices that rise.
#[derive(Debug, Default)]
pub(super) struct Groups {
    /// Those that hit nothing.
    pub(super) missed: Vec<u32>,
    /// Those that hit something, by [`Shape`].
    pub(super) by_shape: [Vec<u32>; 3],
    /// The same, by [`Scatter`].
    pub(super) by_scatter: [Vec<u32>; 6],
    /// Those of them that hit something that emits, seen from whichever side.
    pub(super) at_emitters: Vec<u32>,
}

/// What a hit is on.
#[derive(Clone, Copy)]
pub(super) enum Shape {
    Sphere,
    /// Of the world.
    Triangle,
    /// A triangle of an instance.
    Instance,
}

impl Shape {
    #[inline(always)]
    pub(super) fn of(hits: &Hits, i: usize) -> Shape {
        if hits.prim[i] & Spheres::TAG != 0 {
            Shape::Sphere
        } else if hits.instance[i] == Hits::WORLD {
            Shape::Triangle
        } else {
            Shape::Instance
        }
    }
}

impl Groups {
    fn clear(&mut self) {
        let lists = self.by_shape.iter_mut().chain(&mut self.by_scatter);
        lists
            .chain([&mut self.missed, &mut self.at_emitters])
            .for_each(Vec::clear);
    }
}

/// Fills `wave.groups` and `wave.alive`, and of `wave.surfaces` material and colour, as far as no texture is asked for.
#[inline(always)]
pub(super) fn group(wave: &mut Wave, scene: &FlatScene) {
    let Wave {
        paths,
        hits,
        surfaces,
        groups,
        alive,
        ..
    } = wave;
    groups.clear();
    let n = paths.len();
    surfaces.reserve(n);
    alive.clear();
    alive.resize(n, false);
    // Cut to one length, so that i is compared with it once.
    let (prims, alive) = (&hits.prim[..n], &mut alive[..n]);
    let [r, g, b] = &mut surfaces.color;
    let [r, g, b] = [&mut r[..n], &mut g[..n], &mut b[..n]];
    let ids = &mut surfaces.material[..n];
    for i in 0..n {
        if prims[i] == Hits::NONE {
            groups.missed.push(i as u32);
            continue;
        }
        let shape = Shape::of(hits, i);
        let id = material(scene, hits, i, shape);
        let material = &scene.materials[id as usize];
        groups.by_shape[shape as usize].push(i as u32);
        groups.by_scatter[material.scatter as usize].push(i as u32);
        let scatters = material.scatter != Scatter::Nothing;
        alive[i] = scatters;
        let [er, eg, eb] = material.emission;
        if (er > 0.0) | (eg > 0.0) | (eb > 0.0) {
            groups.at_emitters.push(i as u32);
        }
        ids[i] = id;
        [r[i], g[i], b[i]] = match material.color {
            ColorSource::Constant(color) if scatters => color,
            _ => [0.0; 3],
        };
    }
}

/// Index of the material that was hit.
#[inline(always)]
fn material(scene: &FlatScene, hits: &Hits, i: usize, shape: Shape) -> u32 {
    let prim = hits.prim[i];
    match shape {
        Shape::Sphere => scene.spheres.material[(prim & !Spheres::TAG) as usize].0,
        Shape::Triangle => scene.world.shading.material[prim as usize],
        Shape::Instance => {
            let instance = &scene.instances[hits.instance[i] as usize];
            let slot = scene.local[instance.geometry as usize].shading.material[prim as usize];
            scene.instance_materials[(instance.materials + slot) as usize].0
        }
    }
}
