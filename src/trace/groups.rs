//! Grouping: which paths missed, what the others hit, how that scatters, and whether it shines. One pass over the hits,
//! which also looks up materials and their constant colours.
use super::Hits;
use super::wave::{Surfaces, Wave};
use crate::flat::{ColorSource, FlatScene, Scatter, Spheres};
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

/// What became of a path, as far as lists go.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Fate {
    /// `None` if it hit nothing.
    hit: Option<(Shape, Scatter)>,
    emits: bool,
}

/// So many paths are looked at together: mostly, all share one fate, and their lists grow by as many at once.
const TOGETHER: usize = 8;

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
    for first in (0..n).step_by(TOGETHER) {
        let end = n.min(first + TOGETHER);
        let fate = look(scene, hits, surfaces, first);
        let mut fates = [fate; TOGETHER];
        let mut shared = true;
        for i in first + 1..end {
            fates[i - first] = look(scene, hits, surfaces, i);
            shared &= fates[i - first] == fate;
        }
        if shared {
            groups.add(first as u32..end as u32, fate, alive);
            continue;
        }
        for (i, fate) in (first..end).zip(fates) {
            groups.add(i as u32..i as u32 + 1, fate, alive);
        }
    }
}

impl Groups {
    /// Adds paths of one fate to their lists.
    #[inline(always)]
    fn add(&mut self, paths: Range<u32>, fate: Fate, alive: &mut Vec<bool>) {
        let scatters = match fate.hit {
            None => {
                self.missed.extend(paths.clone());
                false
            }
            Some((shape, scatter)) => {
                self.by_shape[shape as usize].extend(paths.clone());
                self.by_scatter[scatter as usize].extend(paths.clone());
                scatter != Scatter::Nothing
            }
        };
        alive.resize(alive.len() + paths.len(), scatters);
        if fate.emits {
            self.at_emitters.extend(paths);
        }
    }
}

/// What path i hit; writes its material and colour down.
#[inline(always)]
fn look(scene: &FlatScene, hits: &Hits, surfaces: &mut Surfaces, i: usize) -> Fate {
    if hits.prim[i] == Hits::NONE {
        let (hit, emits) = (None, false);
        return Fate { hit, emits };
    }
    let shape = Shape::of(hits, i);
    let id = material(scene, hits, i, shape);
    let material = &scene.materials[id as usize];
    surfaces.material[i] = id;
    let color = match material.color {
        ColorSource::Constant(color) if material.scatter != Scatter::Nothing => color,
        _ => [0.0; 3],
    };
    for (array, x) in surfaces.color.iter_mut().zip(color) {
        array[i] = x;
    }
    let [r, g, b] = material.emission;
    Fate {
        hit: Some((shape, material.scatter)),
        emits: (r > 0.0) | (g > 0.0) | (b > 0.0),
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
