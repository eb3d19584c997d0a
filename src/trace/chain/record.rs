//! What paths remember of their last diffuse vertex, and the share of light that they find through a chain.

use super::plane::{STARTS, Way};
use super::{LampPoint, Link, RATE, SAME};
use crate::flat::{Chains, FlatScene, Spheres};
use crate::math::lanes::BitLanes;
use crate::math::{DVec3, Vec3};
use crate::trace::TraceOptions;
use crate::trace::chunk::{Chunk, WIDEST};
use crate::trace::light::light_pdf;
use crate::trace::scatter::mis_weight;
use crate::trace::vector::{V3, get};
use crate::trace::wave::Wave;

/// No chain begins: the camera's ray, or bounces that are none.
const NONE: u32 = u32::MAX;

/// At a diffuse vertex.
const BEGUN: u32 = u32::MAX - 1;

/// Entry i belongs to path i. Empty where the scene has no chains.
#[derive(Debug, Default)]
pub(in crate::trace) struct Record {
    /// Where the ray of the last diffuse vertex began.
    pub(in crate::trace) origin: [Vec<f32>; 3],
    /// Solid-angle density of its direction.
    pub(in crate::trace) pdf: Vec<f32>,
    /// The key of a chain, when light comes next; or what else happened since.
    pub(in crate::trace) code: Vec<u32>,
}

impl Record {
    /// The starts of n paths.
    pub(in crate::trace) fn start(&mut self, n: usize) {
        for array in self.origin.iter_mut().chain([&mut self.pdf]) {
            array.resize(n, 0.0);
        }
        self.code.clear();
        self.code.resize(n, NONE);
    }

    /// Notes what the paths of a chunk do at what they hit: leave with a density, be reflected, or be refracted.
    #[inline(always)]
    pub(in crate::trace) fn note<L: BitLanes>(
        &mut self,
        chunk: &Chunk,
        prims: &[u32],
        origin: V3<L>,
        [pdf, eta2]: [L; 2],
    ) {
        let mut lanes = [[0.0; WIDEST]; 5];
        let V3([x, y, z]) = origin;
        for (array, of) in lanes.iter_mut().zip([x, y, z, pdf, eta2]) {
            of.store(array);
        }
        let [x, y, z, pdf, eta2] = &lanes;
        for (lane, &i) in chunk.index().iter().enumerate() {
            let i = i as usize;
            if pdf[lane] > 0.0 {
                for (array, of) in self.origin.iter_mut().zip([x, y, z]) {
                    array[i] = of[lane];
                }
                self.pdf[i] = pdf[lane];
                self.code[i] = BEGUN;
            } else {
                self.code[i] = next(self.code[i], prims[i], eta2[lane] != 1.0);
            }
        }
    }
}

/// What a bounce at a primitive makes of a code.
fn next(code: u32, prim: u32, refracted: bool) -> u32 {
    match code {
        NONE => NONE,
        BEGUN if prim & Spheres::TAG == 0 => NONE,
        BEGUN => {
            let sphere = prim & !Spheres::TAG;
            let units = if refracted { 2 } else { 1 };
            if sphere < Chains::REFLECTED {
                sphere + units * Chains::REFLECTED
            } else {
                NONE
            }
        }
        _ => match (code / Chains::REFLECTED, refracted) {
            (2..=4 | 6, true) => code + Chains::REFLECTED,
            (2, false) => code % Chains::REFLECTED + Chains::REFLECTED_INSIDE,
            _ => NONE,
        },
    }
}

/// Whether chains are sampled at all.
pub(in crate::trace) fn wanted(scene: &FlatScene, options: &TraceOptions) -> bool {
    options.nee && options.mis && options.caustics && !scene.chains.is_empty()
}

/// The weight of the light of a lamp that path i meets: 1 unless chains may have found it, too.
pub(in crate::trace) fn shared(
    scene: &FlatScene,
    options: &TraceOptions,
    wave: &Wave,
    i: usize,
) -> f32 {
    let record = &wave.paths.record;
    let Some(&code) = record.code.get(i) else {
        return 1.0;
    };
    let Ok(chain) = scene.chains.key.binary_search(&code) else {
        return 1.0;
    };
    let prim = wave.hits.prim[i];
    let lamp = prim & !Spheres::TAG;
    let is_lamp = prim & Spheres::TAG != 0 && !scene.spheres.inverted[lamp as usize];
    if !is_lamp {
        return 1.0;
    }
    let [position, ng] = [&wave.surfaces.position, &wave.surfaces.ng].map(|v| get(v, i));
    let from = get(&record.origin, i);
    let (point, normal) = (V3::from(position), V3::from(ng));
    let chains = [chain as u32; WIDEST];
    let [origin, dir] = [&wave.paths.rays.origin, &wave.paths.rays.dir].map(|v| get(v, i));
    let link = Link::<f32>::new(scene, &chains, V3::from(from), LampPoint::At(point));
    let taken = link.take(own_lines(&link, origin, dir));
    if !taken.found {
        return 1.0;
    }
    let center = DVec3::from_array(link.center);
    let (chance, _) = link.carried(&taken.way, options.fresnel);
    let own = record.pdf[i] * link.density(&taken.way, normal) * chance;
    let mean = Vec3::from(scene.materials[wave.surfaces.material[i] as usize].emission);
    let seen = (position.as_dvec3() - center).as_vec3();
    let distance = seen.length();
    let cos = -ng.dot(seen) / distance;
    if cos <= 0.0 {
        return 1.0;
    }
    let cone = light_pdf(scene, center.as_vec3(), (seen, distance), (prim, ng), mean);
    let per_chain = RATE * taken.share / scene.chains.len() as f32;
    mis_weight(own, cone * cos / (distance * distance) * per_chain)
}

/// Which ways have a ray as their last line.
fn own_lines(link: &Link<f32>, origin: Vec3, dir: Vec3) -> [bool; STARTS.len()] {
    let start = (origin.as_dvec3() - DVec3::from_array(link.center)).as_vec3() / link.radius;
    let [u, e] = [link.u, link.e].map(Vec3::from);
    let h = start.dot(e * dir.dot(u) - u * dir.dot(e));
    let leaves = (start.length() - 1.0).abs() < SAME;
    let own = |(way, found): &(Way<f32>, bool)| *found && leaves && (way.h - h).abs() < SAME;
    [own(&link.ways[0]), own(&link.ways[1]), own(&link.ways[2])]
}
