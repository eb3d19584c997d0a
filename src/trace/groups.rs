//! Grouping: which paths missed, what the others hit, how that scatters, and whether it shines. One pass over the hits,
//! which also looks up materials and their constant colours.
#![allow(
    clippy::needless_range_loop,
    reason = "lanes are numbers here: several arrays are indexed by one"
)]

use super::Hits;
use super::chunk::WIDEST;
use super::wave::{Surfaces, Wave};
use crate::flat::{ColorSource, FlatScene, Material, Scatter, Spheres};
use crate::math::lanes::{BitLanes, Words};
use std::ops::Range;

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
#[derive(Clone, Copy, PartialEq, Eq)]
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
    /// How many paths scatter in a way.
    pub(super) fn count(&self, kind: Scatter) -> u64 {
        self.by_scatter[kind as usize].len() as u64
    }

    fn clear(&mut self) {
        let lists = self.by_shape.iter_mut().chain(&mut self.by_scatter);
        lists
            .chain([&mut self.missed, &mut self.at_emitters])
            .for_each(Vec::clear);
    }
}

/// What grouping asks of materials, a row each: the constant colour, 0 where there is none or nothing scatters, and the
/// [`fate`] of who meets it, as a number. The last row is that of meeting nothing.
pub(super) type Glances = Vec<[f64; 4]>;

/// What became of a path, as far as lists go: the number of its [`Scatter`], what it shines, and its [`Shape`] above.
mod fate {
    pub(super) const SCATTER: u32 = 7;
    pub(super) const EMITS: u32 = 1 << 3;
    pub(super) const MISSED: u32 = 1 << 4;
    pub(super) const SHAPE: u32 = 5;
}

/// The table of a scene's materials.
pub(super) fn glances(scene: &FlatScene) -> Glances {
    let nothing = [0.0, 0.0, 0.0, f64::from(fate::MISSED)];
    let rows = scene.materials.iter().map(glance);
    rows.chain([nothing]).collect()
}

fn glance(material: &Material) -> [f64; 4] {
    let [r, g, b] = match material.color {
        ColorSource::Constant(color) if material.scatter != Scatter::Nothing => color,
        _ => [0.0; 3],
    };
    let emits = material.emission.iter().any(|&x| x > 0.0);
    let fate = material.scatter as u32 | if emits { fate::EMITS } else { 0 };
    [r.into(), g.into(), b.into(), fate.into()]
}

/// Fills `wave.groups` and `wave.alive`, and of `wave.surfaces` material and colour, as far as no texture is asked for.
#[inline(always)]
pub(super) fn group<L: BitLanes>(wave: &mut Wave, scene: &FlatScene) {
    let Wave {
        paths,
        hits,
        surfaces,
        groups,
        glances,
        alive,
        ..
    } = wave;
    groups.clear();
    let n = paths.len();
    surfaces.reserve(n.next_multiple_of(L::N));
    alive.clear();
    for first in (0..n).step_by(L::N) {
        let end = n.min(first + L::N);
        let fates = look::<L>((scene, glances), hits, surfaces, first..end);
        let fates = &fates[..end - first];
        // Mostly, all share one fate, and their lists grow by as many at once.
        let differ = fates.iter().fold(0, |bits, f| bits | f ^ fates[0]);
        if differ == 0 {
            groups.add(first as u32..end as u32, fates[0], alive);
            continue;
        }
        for (i, &fate) in (first as u32..).zip(fates) {
            groups.add(i..i + 1, fate, alive);
        }
    }
}

impl Groups {
    /// Adds paths of one fate to their lists.
    #[inline(always)]
    fn add(&mut self, paths: Range<u32>, fate: u32, alive: &mut Vec<bool>) {
        let scatter = fate & fate::SCATTER;
        let hit = fate & fate::MISSED == 0;
        if hit {
            let shape = (fate >> fate::SHAPE) as usize % self.by_shape.len();
            self.by_shape[shape].extend(paths.clone());
            let scatter = scatter as usize % self.by_scatter.len();
            self.by_scatter[scatter].extend(paths.clone());
        } else {
            self.missed.extend(paths.clone());
        }
        let scatters = hit && scatter != Scatter::Nothing as u32;
        alive.resize(alive.len() + paths.len(), scatters);
        if fate & fate::EMITS != 0 {
            self.at_emitters.extend(paths);
        }
    }
}

/// The fates of paths, as many as there are lanes at most; writes their materials and colours down.
#[inline(always)]
fn look<L: BitLanes>(
    (scene, glances): (&FlatScene, &Glances),
    hits: &Hits,
    surfaces: &mut Surfaces,
    paths: Range<usize>,
) -> [u32; WIDEST] {
    let first = paths.start;
    let (mut ids, mut shapes) = ([glances.len() as u32 - 1; WIDEST], [0; WIDEST]);
    for i in paths {
        if hits.prim[i] != Hits::NONE {
            let shape = Shape::of(hits, i);
            ids[i - first] = material(scene, hits, i, shape);
            shapes[i - first] = (shape as u32) << fate::SHAPE;
        }
    }
    let [r, g, b, fate] = L::rows(glances, &ids);
    for (array, x) in surfaces.color.iter_mut().zip([r, g, b]) {
        L::narrow(x).store(&mut array[first..]);
    }
    surfaces.material[first..first + L::N].copy_from_slice(&ids[..L::N]);
    let fate = L::narrow(fate).to_words().or(Words::load(&shapes));
    let mut fates = [0.0; WIDEST];
    L::from_bits(fate).store(&mut fates);
    fates.map(f32::to_bits)
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
