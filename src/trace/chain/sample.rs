//! Sampling chains from diffuse and plastic vertices, and tracing their two ends: from the vertex to the sphere, and from
//! there to the lamp. What lies between is known to be clear.

use super::plane::STARTS;
use super::{LampPoint, Link, RATE, Taken};
use crate::flat::{Chains, Scatter, Spheres};
use crate::math::DVec3;
use crate::math::lanes::BitLanes;
use crate::trace::chunk::{Chunk, WIDEST};
use crate::trace::light::sample_lamp;
use crate::trace::sampler::Pair;
use crate::trace::scatter::{Bounce, Columns, Local, Numbers, RECEIVERS, mis_weight, receive};
use crate::trace::spawn::lanes::offset_origin;
use crate::trace::vector::{V3, get};
use crate::trace::wave::Wave;
use crate::trace::{Hits, Rays, closest_hit};
use std::f32::consts::FRAC_1_PI;

/// How far a computed point of a sphere may be from it, relative to its coordinates and the radius.
const ROUNDING: f32 = 1.0 / (1 << 21) as f32;

/// Ways that are to be traced: entry i of every array is one.
#[derive(Debug, Default)]
pub(in crate::trace) struct Reached {
    /// From the vertex, from the sphere.
    rays: [Rays; 2],
    /// Primitives that those rays must hit: the sphere, the lamp.
    prims: [Vec<u32>; 2],
    /// Radiance times throughput; once traced, of those alone that arrived.
    pub(in crate::trace) radiance: [Vec<f32>; 3],
    slot: Vec<u32>,
    hits: Hits,
    /// The paths that are to have one.
    chosen: Vec<u32>,
}

impl Reached {
    fn clear(&mut self) {
        self.rays.iter_mut().for_each(Rays::clear);
        self.prims.iter_mut().for_each(Vec::clear);
        self.radiance.iter_mut().for_each(Vec::clear);
        self.slot.clear();
    }
}

/// Samples a chain from every diffuse and plastic path of a wave, where that is due.
#[inline(always)]
pub(in crate::trace) fn sample<L: BitLanes>(wave: &mut Wave, bounce: Bounce) {
    let mut reached = std::mem::take(&mut wave.reached);
    reached.clear();
    let (columns, groups, _) = Columns::new(wave);
    for kind in RECEIVERS {
        let mut chosen = std::mem::take(&mut reached.chosen);
        chosen.clear();
        for chunk in Chunk::all::<L>(&groups.by_scatter[kind as usize]) {
            let [pick, _] = picks::<L>(&columns, bounce, &chunk);
            let mut left = L::bits(pick.lt(L::splat(RATE))) & chunk.members();
            while left != 0 {
                chosen.push(chunk.index()[left.trailing_zeros() as usize]);
                left &= left - 1;
            }
        }
        for chunk in Chunk::all::<L>(&chosen) {
            sample_chunk::<L>(&columns, &mut reached, bounce, (kind, &chunk));
        }
        reached.chosen = chosen;
    }
    wave.reached = reached;
}

/// The numbers that choose: whether, which chain and from which side; and the lamp.
#[inline(always)]
fn picks<L: BitLanes>(columns: &Columns, bounce: Bounce, chunk: &Chunk) -> [L; 2] {
    let numbers = Numbers::<L>::new((columns.key, columns.sample), bounce, chunk);
    numbers.pair(Pair::Chain(bounce.index))
}

#[inline(always)]
fn sample_chunk<L: BitLanes>(
    columns: &Columns,
    reached: &mut Reached,
    bounce: Bounce,
    (kind, chunk): (Scatter, &Chunk),
) {
    let Bounce { scene, options, .. } = bounce;
    let [pick, choice] = picks::<L>(columns, bounce, chunk);
    let count = scene.chains.len() as u32;
    let mut numbers = [0.0; WIDEST];
    (pick * L::splat((STARTS.len() as u32 * count) as f32 / RATE)).store(&mut numbers);
    let (mut chains, mut spheres) = ([0; WIDEST], [0; WIDEST]);
    let (mut starts, mut ends) = ([0; STARTS.len()], 0);
    for lane in 0..L::N {
        let number = numbers[lane] as u32;
        chains[lane] = (number / STARTS.len() as u32).min(count - 1);
        spheres[lane] = scene.chains.sphere(chains[lane] as usize);
        starts[number as usize % STARTS.len()] |= 1 << lane;
        // Light at the end of a chain that is too long for paths does not count.
        let key = scene.chains.key[chains[lane] as usize];
        ends |= u32::from(bounce.index + Chains::bounces(key) < options.max_bounces) << lane;
    }
    let [x, y, z, _] = L::rows(&scene.spheres.placed, &spheres);
    let center = V3::narrow([x, y, z]);
    let of_path = Numbers::<L>::new((columns.key, columns.sample), bounce, chunk);
    let u = of_path.pair(Pair::ChainLight(bounce.index));
    let lamp = sample_lamp(scene, center, choice, u);
    let local = Local::<L>::new(columns, chunk);
    let from = local.origin(local.ng);
    let seen = LampPoint::Seen(lamp.dir * lamp.distance);
    let link = Link::new(scene, &chains, from, seen);
    let [first, second, third] = starts;
    let Taken { way, found, share } = link.take([L::mask(first), L::mask(second), L::mask(third)]);
    let dir = link.first(&way);
    let cos = local.cosine(dir);
    let zero = L::splat(0.0);
    let per_chain = share * L::splat(RATE / count as f32);
    let lamp_pdf = lamp.pdf * lamp.cos * per_chain / (lamp.distance * lamp.distance);
    let (f_pi, base) = receive(kind, bounce, columns, chunk, &local, cos);
    let per_pi = cos * L::splat(FRAC_1_PI);
    let (chance, carried) = link.carried(&way, options.fresnel);
    let density = link.density(&way, lamp.normal);
    let weight = mis_weight(lamp_pdf, base * per_pi * density * chance);
    let throughput: V3<L> = chunk.vector(&columns.throughput);
    let radiance =
        throughput * f_pi * lamp.radiance * carried * (per_pi * density * weight / lamp_pdf);
    let sound = found & zero.lt(cos) & zero.lt(lamp.cos) & radiance.finite();
    let valid = L::bits(sound & radiance.any_positive()) & lamp.valid & ends & chunk.members();
    if valid == 0 {
        return;
    }
    let exit = link.in_plane(way.exit());
    let place = center + exit * link.radius;
    let size = link.radius + place.0[0].abs() + place.0[1].abs() + place.0[2].abs();
    let err = size * L::splat(ROUNDING);
    let start = V3(offset_origin(place.0, exit.0, err, exit.0));
    let end = center + lamp.dir * lamp.distance;
    let last = (end - start).unit();
    let mut lanes = [[0.0; WIDEST]; 15];
    let vectors = [from, dir, start, last, radiance];
    for (arrays, V3(v)) in lanes.chunks_mut(3).zip(vectors) {
        for (array, x) in arrays.iter_mut().zip(v) {
            x.store(array);
        }
    }
    let lines = link.inside(&way);
    for (lane, &i) in chunk.index().iter().enumerate() {
        let guest = scene.chains.guest[chains[lane] as usize];
        if valid >> lane & 1 == 0 || guest[3] > 0.0 && meets(&lines, lane, guest) {
            continue;
        }
        let vector = |k: usize| [lanes[k][lane], lanes[k + 1][lane], lanes[k + 2][lane]];
        reached.rays[0].push(vector(0), vector(3), f32::MAX);
        reached.rays[1].push(vector(6), vector(9), f32::MAX);
        reached.prims[0].push(Spheres::TAG | spheres[lane]);
        reached.prims[1].push(Spheres::TAG | lamp.sphere[lane]);
        for (array, x) in reached.radiance.iter_mut().zip(vector(12)) {
            array.push(x);
        }
        reached.slot.push(columns.slot[i as usize]);
    }
}

/// Whether one of two lines in lanes reaches into a sphere.
#[inline(always)]
fn meets<L: BitLanes>(lines: &[[V3<L>; 2]; 2], lane: usize, [x, y, z, radius]: [f64; 4]) -> bool {
    let center = DVec3::new(x, y, z);
    lines.iter().any(|[a, b]| {
        let (a, b) = (point(a, lane), point(b, lane));
        let along = b - a;
        let t = (center - a).dot(along) / along.length_squared();
        let nearest = a + along * t.clamp(0.0, 1.0);
        (nearest - center).length() < radius
    })
}

/// A lane's point.
#[inline(always)]
fn point<L: BitLanes>(V3([x, y, z]): &V3<L>, lane: usize) -> DVec3 {
    let mut point = [[0.0; WIDEST]; 3];
    x.store(&mut point[0]);
    y.store(&mut point[1]);
    z.store(&mut point[2]);
    DVec3::new(
        f64::from(point[0][lane]),
        f64::from(point[1][lane]),
        f64::from(point[2][lane]),
    )
}

/// Adds the light of the ways that nothing blocks; returns how many rays that took.
pub(in crate::trace) fn trace(wave: &mut Wave, bounce: Bounce) -> u64 {
    let Bounce { scene, options, .. } = bounce;
    crate::trace::stages::sample_chains(wave, bounce);
    let Reached {
        rays: [first, last],
        prims,
        radiance,
        slot,
        hits,
        ..
    } = &mut wave.reached;
    closest_hit(scene, options.isa, first, hits);
    let mut traced = first.len();
    let mut open = 0;
    for i in 0..first.len() {
        if hits.prim[i] == prims[0][i] && hits.instance[i] == Hits::WORLD {
            last.keep(i, open);
            prims[1][open] = prims[1][i];
            slot[open] = slot[i];
            radiance.iter_mut().for_each(|array| array[open] = array[i]);
            open += 1;
        }
    }
    last.truncate(open);
    traced += open;
    closest_hit(scene, options.isa, last, hits);
    let mut arrived = 0;
    for i in 0..open {
        if hits.prim[i] == prims[1][i] {
            wave.slots.add(slot[i] as usize, get(radiance, i));
            radiance
                .iter_mut()
                .for_each(|array| array[arrived] = array[i]);
            arrived += 1;
        }
    }
    radiance
        .iter_mut()
        .for_each(|array| array.truncate(arrived));
    traced as u64
}
