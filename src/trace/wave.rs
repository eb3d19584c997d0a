//! The wave: a batch of paths in SoA path state, all at the same bounce.

use super::chain::{Reached, Record};
use super::chunk::WIDEST;
use super::groups::{self, Glances, Groups};
use super::vector::{V3, get, set};
use super::{Hits, Rays, opacity::Through};
use crate::flat::FlatScene;
use crate::math::Vec3;
use crate::math::lanes::{BitLanes, Words};

/// Paths in flight at once. Batches of 512 to 2048 were within 5 % of each other in a probe of the room of spheres.
pub(super) const WAVE: usize = 1024;

/// Path state; entry i of every array is one live path.
#[derive(Debug, Default)]
pub(super) struct Paths {
    /// The ray to trace next.
    pub(super) rays: Rays,
    /// Product of bsdf weights so far.
    pub(super) throughput: [Vec<f32>; 3],
    /// Solid-angle density with which the ray's direction was sampled; 0 where no light sample competes (camera rays
    /// and mirror-like lobes).
    pub(super) pdf: Vec<f32>,
    /// Product of squared relative indices of refraction: what roulette takes out of the throughput, since it will be
    /// put back when the path leaves the medium.
    pub(super) eta2: Vec<f32>,
    /// Which sample of the wave it is.
    pub(super) slot: Vec<u32>,
    /// Key of its pixel's random numbers.
    pub(super) key: Vec<u32>,
    /// Its sample index.
    pub(super) sample: Vec<u32>,
    /// Its last diffuse vertex, where scenes have chains.
    pub(super) record: Record,
}

/// What the surface stage finds; entry i belongs to path i, and is meaningless where the path hit nothing or where there
/// is none: the arrays only grow.
#[derive(Debug, Default)]
pub(super) struct Surfaces {
    /// Position, scene units.
    pub(super) position: [Vec<f32>; 3],
    /// Unit geometric normal on the authored outside.
    pub(super) ng: [Vec<f32>; 3],
    /// Unit shading normal on the same side as `ng`.
    pub(super) ns: [Vec<f32>; 3],
    /// Texture coordinates, where the material reads a texture.
    pub(super) uv: [Vec<f32>; 2],
    /// Index into the scene's materials.
    pub(super) material: Vec<u32>,
    /// Colour of the material here.
    pub(super) color: [Vec<f32>; 3],
}

/// Shadow rays of a bounce with what they bring if nothing is in the way.
#[derive(Debug, Default)]
pub(super) struct Shadows {
    pub(super) rays: Rays,
    /// Radiance times throughput.
    pub(super) radiance: [Vec<f32>; 3],
    pub(super) slot: Vec<u32>,
    pub(super) blocked: Vec<bool>,
}

/// Samples of the wave by slot: they keep their place while paths move.
#[derive(Debug, Default)]
pub(super) struct Slots {
    /// Sample index.
    pub(super) sample: Vec<u32>,
    /// Centre of the pixel, in pixels of the image.
    pub(super) center: [Vec<f32>; 2],
    /// Radiance gathered so far.
    pub(super) radiance: [Vec<f32>; 3],
    /// Albedo, shading normal, geometric normal of the first hit; empty unless asked for.
    pub(super) features: [[Vec<f32>; 3]; 3],
    /// Depth of the first hit along the view axis in scene units, +∞ for none; empty unless asked for.
    pub(super) depth: Vec<f32>,
}

/// All buffers of a worker; reused from wave to wave.
#[derive(Debug, Default)]
pub(super) struct Wave {
    pub(super) paths: Paths,
    pub(super) hits: Hits,
    pub(super) surfaces: Surfaces,
    pub(super) shadows: Shadows,
    pub(super) slots: Slots,
    pub(super) through: Through,
    pub(super) groups: Groups,
    pub(super) glances: Glances,
    pub(super) reached: Reached,
    /// Whether path i goes on.
    pub(super) alive: Vec<bool>,
}

impl Wave {
    /// Empty buffers for the paths of a scene.
    pub(super) fn new(scene: &FlatScene) -> Wave {
        Wave {
            glances: groups::glances(scene),
            ..Wave::default()
        }
    }

    /// Where path i last scattered, and how far from there its hit is.
    pub(super) fn leg(&self, i: usize) -> (Vec3, f32) {
        let (origin, t) = (get(&self.paths.rays.origin, i), self.hits.t[i]);
        match self.through.start(i) {
            Some(start) => {
                let passed = (origin - start).dot(get(&self.paths.rays.dir, i));
                (start, passed + t)
            }
            None => (origin, t),
        }
    }
}

impl Paths {
    pub(super) fn len(&self) -> usize {
        self.slot.len()
    }

    pub(super) fn clear(&mut self) {
        self.rays.clear();
        self.throughput.iter_mut().for_each(Vec::clear);
        self.pdf.clear();
        self.eta2.clear();
        self.slot.clear();
        self.key.clear();
        self.sample.clear();
        self.record.code.clear();
    }

    /// The starts of n paths, one for each slot, but for their rays and random numbers.
    pub(super) fn start(&mut self, n: usize) {
        let fill = |array: &mut Vec<f32>, value: f32| {
            array.clear();
            array.resize(n, value);
        };
        for array in self.rays.origin.iter_mut().chain(&mut self.rays.dir) {
            array.resize(n, 0.0);
        }
        fill(&mut self.rays.t_max, f32::MAX);
        self.throughput.iter_mut().for_each(|a| fill(a, 1.0));
        fill(&mut self.pdf, 0.0);
        fill(&mut self.eta2, 1.0);
        self.slot.clear();
        self.slot.extend(0..n as u32);
    }

    /// Appends a ray of a pixel that needs no random numbers.
    pub(super) fn push(&mut self, origin: Vec3, dir: Vec3, slot: u32) {
        self.rays.push(origin.to_array(), dir.to_array(), f32::MAX);
        self.slot.push(slot);
        self.key.push(0);
        self.sample.push(0);
    }

    /// Keeps the paths that `alive` says, in order.
    #[inline(always)]
    pub(super) fn compact<L: BitLanes>(&mut self, alive: &[bool]) {
        let n = self.len();
        let [ox, oy, oz] = &mut self.rays.origin;
        let [dx, dy, dz] = &mut self.rays.dir;
        let [r, g, b] = &mut self.throughput;
        let (pdf, eta2) = (&mut self.pdf, &mut self.eta2);
        let floats = [ox, oy, oz, dx, dy, dz, r, g, b, pdf, eta2];
        let words = [&mut self.slot, &mut self.key, &mut self.sample];
        let kept = keep::<L, 11, 3>(&alive[..n], floats, words);
        // All are alike: no path has an end.
        self.rays.t_max.truncate(kept);
        if !self.record.code.is_empty() {
            let Record { origin, pdf, code } = &mut self.record;
            let [x, y, z] = origin;
            keep::<L, 4, 1>(&alive[..n], [x, y, z, pdf], [code]);
        }
    }
}

/// Keeps the elements that `alive` says, in order; returns how many.
#[inline(always)]
fn keep<L: BitLanes, const F: usize, const W: usize>(
    alive: &[bool],
    mut floats: [&mut Vec<f32>; F],
    mut words: [&mut Vec<u32>; W],
) -> usize {
    let n = alive.len();
    let (whole, mut to) = (n - n % L::N, 0);
    for at in (0..whole).step_by(L::N) {
        let kept = members::<L>(&alive[at..]);
        let count = kept.count_ones() as usize;
        if to < at || count < L::N {
            for array in &mut floats {
                L::load(&array[at..]).pack(kept, &mut array[to..]);
            }
            for array in &mut words {
                <L::Bits as Words>::load(&array[at..]).pack(kept, &mut array[to..]);
            }
        }
        to += count;
    }
    for at in (whole..n).filter(|&at| alive[at]) {
        floats.iter_mut().for_each(|array| array[to] = array[at]);
        words.iter_mut().for_each(|array| array[to] = array[at]);
        to += 1;
    }
    floats.into_iter().for_each(|array| array.truncate(to));
    words.into_iter().for_each(|array| array.truncate(to));
    to
}

/// Bit i: element i, as many as there are lanes.
#[inline(always)]
fn members<L: BitLanes>(alive: &[bool]) -> u32 {
    match alive {
        // Byte i, which is 0 or 1, times 2^(56 − 7 i) is bit 56 + i; no two products meet.
        &[a, b, c, d, e, f, g, h, ..] if L::N == 8 => {
            let bytes = u64::from_le_bytes([a, b, c, d, e, f, g, h].map(u8::from));
            (bytes.wrapping_mul(0x0102_0408_1020_4080) >> 56) as u32
        }
        _ => (0..L::N).fold(0, |bits, i| bits | u32::from(alive[i]) << i),
    }
}

impl Surfaces {
    /// Makes room for n paths.
    pub(super) fn reserve(&mut self, n: usize) {
        if n <= self.material.len() {
            return;
        }
        let vectors = self
            .position
            .iter_mut()
            .chain(&mut self.ng)
            .chain(&mut self.ns)
            .chain(&mut self.color);
        vectors.chain(&mut self.uv).for_each(|a| a.resize(n, 0.0));
        self.material.resize(n, 0);
    }
}

impl Shadows {
    /// Makes room for n rays, and for the lanes that are written beyond them.
    pub(super) fn reserve(&mut self, n: usize) {
        let floats = self.rays.origin.iter_mut().chain(&mut self.rays.dir);
        for array in floats
            .chain(&mut self.radiance)
            .chain([&mut self.rays.t_max])
        {
            array.resize(n + WIDEST, 0.0);
        }
        self.slot.resize(n + WIDEST, 0);
    }

    /// Keeps the first n rays.
    pub(super) fn truncate(&mut self, n: usize) {
        self.rays.truncate(n);
        self.radiance.iter_mut().for_each(|a| a.truncate(n));
        self.slot.truncate(n);
    }

    /// Writes the rays of the lanes whose bits are set from `at` on, in order; returns how many. There is room for as many
    /// as there are lanes.
    #[inline(always)]
    pub(super) fn pack<L: BitLanes>(
        &mut self,
        at: usize,
        chosen: u32,
        (V3(origin), V3(dir), t_max): (V3<L>, V3<L>, L),
        V3(radiance): V3<L>,
        slots: L::Bits,
    ) -> usize {
        for axis in 0..3 {
            origin[axis].pack(chosen, &mut self.rays.origin[axis][at..]);
            dir[axis].pack(chosen, &mut self.rays.dir[axis][at..]);
            radiance[axis].pack(chosen, &mut self.radiance[axis][at..]);
        }
        t_max.pack(chosen, &mut self.rays.t_max[at..]);
        slots.pack(chosen, &mut self.slot[at..]);
        chosen.count_ones() as usize
    }
}

impl Slots {
    /// Makes room for n samples and forgets the old ones.
    pub(super) fn reset(&mut self, n: usize, features: bool) {
        self.sample.clear();
        self.center.iter_mut().for_each(Vec::clear);
        let fill = |a: &mut Vec<f32>, n: usize, value: f32| {
            a.clear();
            a.resize(n, value);
        };
        self.radiance.iter_mut().for_each(|a| fill(a, n, 0.0));
        let n = if features { n } else { 0 };
        self.features
            .iter_mut()
            .flatten()
            .for_each(|a| fill(a, n, 0.0));
        fill(&mut self.depth, n, f32::INFINITY);
    }

    /// Gives the next slot a sample of a pixel.
    #[inline(always)]
    pub(super) fn push(&mut self, sample: u32, [x, y]: [u32; 2]) {
        self.sample.push(sample);
        self.center[0].push(x as f32 + 0.5);
        self.center[1].push(y as f32 + 0.5);
    }

    /// Adds radiance to a sample.
    #[inline(always)]
    pub(super) fn add(&mut self, slot: usize, radiance: Vec3) {
        let sum = get(&self.radiance, slot) + radiance;
        set(&mut self.radiance, slot, sum);
    }
}
