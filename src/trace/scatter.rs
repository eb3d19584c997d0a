//! Sample light and sample bsdf, one loop per kind of scattering, over lanes of paths.
//!
//! Weights are f cos θ / pdf in closed form: a Lambert sample multiplies the throughput by the albedo and nothing
//! else, so that a furnace is exact in every sample.
#![allow(
    clippy::needless_range_loop,
    reason = "lanes are numbers here: several arrays are indexed by one"
)]

use super::chain::Record;
use super::chunk::{Chunk, WIDEST};
use super::fresnel::{dielectrics, metal};
use super::groups::Groups;
use super::light::{LightSample, sample_lights as sample_table};
use super::sampler::{Pair, sample_pairs};
use super::spawn::lanes::offset_origin;
use super::vector::{V3, cosine_hemisphere, reflect};
use super::wave::{Shadows, Wave};
use super::{Fresnel, TraceOptions, cut};
use crate::flat::{FlatScene, Scatter};
use crate::math::lanes::{BitLanes, Lanes};
use std::f32::consts::FRAC_1_PI;

/// What every stage of a bounce is lent.
#[derive(Clone, Copy)]
pub(super) struct Bounce<'a> {
    pub(super) scene: &'a FlatScene,
    pub(super) options: &'a TraceOptions,
    /// 0 = at the first hit.
    pub(super) index: u32,
}

/// The arrays of a wave's paths, cut to one length, so that a chunk is checked against it once.
pub(super) struct Columns<'a> {
    origin: [&'a mut [f32]; 3],
    dir: [&'a mut [f32]; 3],
    pub(super) throughput: [&'a mut [f32]; 3],
    pdf: &'a mut [f32],
    eta2: &'a mut [f32],
    pub(super) slot: &'a [u32],
    pub(super) key: &'a [u32],
    pub(super) sample: &'a [u32],
    err: &'a [f32],
    position: [&'a [f32]; 3],
    ng: [&'a [f32]; 3],
    ns: [&'a [f32]; 3],
    color: [&'a [f32]; 3],
    material: &'a [u32],
    alive: &'a mut [bool],
    prim: &'a [u32],
    record: &'a mut Record,
}

impl<'a> Columns<'a> {
    #[inline(always)]
    pub(super) fn new(wave: &'a mut Wave) -> (Columns<'a>, &'a Groups, &'a mut Shadows) {
        let n = wave.paths.len();
        let (paths, surfaces) = (&mut wave.paths, &wave.surfaces);
        let columns = Columns {
            origin: cut_mut(&mut paths.rays.origin, n),
            dir: cut_mut(&mut paths.rays.dir, n),
            throughput: cut_mut(&mut paths.throughput, n),
            pdf: &mut paths.pdf[..n],
            eta2: &mut paths.eta2[..n],
            slot: &paths.slot[..n],
            key: &paths.key[..n],
            sample: &paths.sample[..n],
            err: &wave.hits.err[..n],
            position: cut(&surfaces.position, n),
            ng: cut(&surfaces.ng, n),
            ns: cut(&surfaces.ns, n),
            color: cut(&surfaces.color, n),
            material: &surfaces.material[..n],
            alive: &mut wave.alive[..n],
            prim: &wave.hits.prim[..n],
            record: &mut paths.record,
        };
        (columns, &wave.groups, &mut wave.shadows)
    }
}

#[inline(always)]
fn cut([x, y, z]: &[Vec<f32>; 3], n: usize) -> [&[f32]; 3] {
    [&x[..n], &y[..n], &z[..n]]
}

#[inline(always)]
fn cut_mut([x, y, z]: &mut [Vec<f32>; 3], n: usize) -> [&mut [f32]; 3] {
    [&mut x[..n], &mut y[..n], &mut z[..n]]
}

/// The surroundings of paths, turned to the side that each came from.
pub(super) struct Local<L: BitLanes> {
    wo: V3<L>,
    pub(super) ng: V3<L>,
    ns: V3<L>,
    position: V3<L>,
    err: L,
    color: V3<L>,
    /// The path came from the authored outside.
    outside: L::Mask,
}

/// What a bsdf sample decides.
struct Scattered<L: BitLanes> {
    dir: V3<L>,
    /// f cos θ / pdf.
    weight: V3<L>,
    /// Over solid angle; 0 for a mirror-like lobe.
    pdf: L,
    /// Squared relative index of a refraction, else 1.
    eta2: L,
}

impl<L: BitLanes> Local<L> {
    #[inline(always)]
    pub(super) fn new(columns: &Columns, chunk: &Chunk) -> Local<L> {
        let wo = -chunk.vector(&columns.dir);
        let (ng, ns) = (chunk.vector(&columns.ng), chunk.vector(&columns.ns));
        let outside = L::splat(0.0).le(wo.dot(ng));
        let side = L::select(outside, L::splat(1.0), L::splat(-1.0));
        Local {
            wo,
            ng: ng * side,
            ns: ns * side,
            position: chunk.vector(&columns.position),
            err: chunk.lanes(columns.err),
            color: chunk.vector(&columns.color),
            outside,
        }
    }

    /// Where rays towards `dir` start.
    #[inline(always)]
    pub(super) fn origin(&self, dir: V3<L>) -> V3<L> {
        V3(offset_origin(self.position.0, self.ng.0, self.err, dir.0))
    }

    /// Cosine at the shading normal; 0 below either surface.
    #[inline(always)]
    pub(super) fn cosine(&self, dir: V3<L>) -> L {
        let zero = L::splat(0.0);
        let above = zero.lt(dir.dot(self.ng));
        L::select(above, dir.dot(self.ns).max(zero), zero)
    }

    /// Mirror direction about the shading normal. Where that dips below the geometric surface it is folded back up,
    /// continuously, so that smooth mirrors have no black specks.
    #[inline(always)]
    fn mirror(&self) -> V3<L> {
        let dir = reflect(self.wo, self.ns);
        let below = dir.dot(self.ng);
        let folded = dir - self.ng * (L::splat(2.0) * below);
        V3::select(below.lt(L::splat(0.0)), folded, dir)
    }

    /// Cosine of incidence at the shading normal, within [0, 1].
    #[inline(always)]
    fn incidence(&self) -> L {
        let cos = self.wo.dot(self.ns);
        L::splat(1.0).min(L::splat(0.0).max(cos))
    }
}

/// Power heuristic, exponent 2 (Veach 1997, §9.2.4); exact when a density is 0 or infinite.
#[inline(always)]
pub(super) fn mis_weight<L: Lanes>(pdf: L, other: L) -> L {
    let one = L::splat(1.0);
    let ratio = other / pdf;
    let weight = one / (one + ratio * ratio);
    L::select(other.abs().le(L::splat(0.0)), one, weight)
}

/// The coat and the base of plastics, seen from one direction.
///
/// The base under the coat reflects (1 − F(θi)) (1 − F(θo)) a / (π n² (1 − a F_int)): what enters, bounces between base
/// and coat, and leaves (the smooth case of Ashikhmin and Shirley's energy argument; at a = 1 all light comes back).
struct Plastic<L: BitLanes> {
    mode: Fresnel,
    ior: L,
    coat: L,
    base: V3<L>,
    /// Probability of sampling the coat.
    coat_share: L,
}

impl<L: BitLanes> Plastic<L> {
    #[inline(always)]
    fn new(bounce: Bounce, columns: &Columns, chunk: &Chunk, local: &Local<L>) -> Plastic<L> {
        let mode = bounce.options.fresnel;
        let [mut iors, mut reflectances] = [[0.0; WIDEST]; 2];
        for lane in 0..L::N {
            let material = &bounce.scene.materials[chunk.at(columns.material, lane) as usize];
            (iors[lane], reflectances[lane]) = (material.ior, material.internal_reflectance);
        }
        let (ior, internal) = (L::load(&iors), L::load(&reflectances));
        let one = L::splat(1.0);
        let (coat, _) = dielectrics(mode, local.incidence(), ior);
        let n2 = ior * ior;
        let inner = V3::splat([1.0; 3]) - local.color * internal;
        let base = local.color / (inner * n2);
        // The base sends back about (1 − F) a (1 − F_int) / (1 − a F_int) of what comes.
        let V3([r, g, b]) = base * n2 * (one - internal);
        let base_power = (one - coat) * r.max(g.max(b));
        let share = coat / (coat + base_power);
        Plastic {
            mode,
            ior,
            coat,
            base,
            coat_share: L::select(L::splat(0.0).lt(base_power), share, one),
        }
    }

    /// π times the base's bsdf towards `dir`.
    #[inline(always)]
    fn eval_base(&self, cos: L) -> V3<L> {
        let one = L::splat(1.0);
        let (out, _) = dielectrics(self.mode, cos.min(one), self.ior);
        self.base * ((one - self.coat) * (one - out))
    }
}

/// Next-event estimation at the diffuse and plastic paths: fills the shadow rays of this bounce.
#[inline(always)]
pub(super) fn sample_lights<L: BitLanes>(wave: &mut Wave, bounce: Bounce) {
    let (columns, groups, shadows) = Columns::new(wave);
    let lists = RECEIVERS.map(|kind| groups.by_scatter[kind as usize].as_slice());
    shadows.reserve(lists[0].len() + lists[1].len());
    let mut len = 0;
    for (kind, list) in RECEIVERS.into_iter().zip(lists) {
        for chunk in Chunk::all::<L>(list) {
            len += sample_light::<L>(&columns, shadows, bounce, (kind, &chunk), len);
        }
    }
    shadows.truncate(len);
}

/// One chunk of it: writes its shadow rays from `at` on, returns how many.
#[inline(always)]
fn sample_light<L: BitLanes>(
    columns: &Columns,
    shadows: &mut Shadows,
    bounce: Bounce,
    (kind, chunk): (Scatter, &Chunk),
    at: usize,
) -> usize {
    let local = Local::<L>::new(columns, chunk);
    let origin = local.origin(local.ng);
    let light = light_from(columns, bounce, chunk, origin);
    let cos = local.cosine(light.dir);
    let valid = light.valid & L::bits(L::splat(0.0).lt(cos)) & chunk.members();
    if valid == 0 {
        return 0;
    }
    let per_pi = L::splat(FRAC_1_PI);
    let (f_pi, share) = receive(kind, bounce, columns, chunk, &local, cos);
    let mut weight = L::splat(1.0);
    if bounce.options.mis {
        weight = mis_weight(light.pdf, share * cos * per_pi);
    }
    if cut::PUNCTUAL && light.punctual != 0 {
        weight = L::select(L::mask(light.punctual), L::splat(1.0), weight);
    }
    let throughput: V3<L> = chunk.vector(&columns.throughput);
    let radiance = throughput * f_pi * light.radiance * (per_pi * cos * weight / light.pdf);
    let slots = chunk.words::<L>(columns.slot);
    let ray = (origin, light.dir, light.t_max);
    shadows.pack(at, valid, ray, radiance, slots)
}

/// What receives light: the kinds of scattering that light is sampled for.
pub(super) const RECEIVERS: [Scatter; 2] = [Scatter::Diffuse, Scatter::Plastic];

/// π times the bsdf of what receives, towards a direction of that cosine, and the density of that direction over cos / π.
#[inline(always)]
pub(super) fn receive<L: BitLanes>(
    kind: Scatter,
    bounce: Bounce,
    columns: &Columns,
    chunk: &Chunk,
    local: &Local<L>,
    cos: L,
) -> (V3<L>, L) {
    if kind == Scatter::Diffuse {
        return (local.color, L::splat(1.0));
    }
    let plastic = Plastic::new(bounce, columns, chunk, local);
    (plastic.eval_base(cos), L::splat(1.0) - plastic.coat_share)
}

#[inline(always)]
fn light_from<L: BitLanes>(
    columns: &Columns,
    bounce: Bounce,
    chunk: &Chunk,
    origin: V3<L>,
) -> LightSample<L> {
    let numbers = Numbers::<L>::new((columns.key, columns.sample), bounce, chunk);
    // One light needs no choice.
    let choice = || numbers.pair(Pair::Choice(bounce.index))[0];
    let u = numbers.pair(Pair::Light(bounce.index));
    sample_table(bounce.scene, origin, choice, u)
}

/// Where the random numbers of paths come from.
pub(super) struct Numbers<L: BitLanes> {
    sampler: super::Sampler,
    key: L::Bits,
    sample: L::Bits,
}

impl<L: BitLanes> Numbers<L> {
    #[inline(always)]
    pub(super) fn new(
        (key, sample): (&[u32], &[u32]),
        bounce: Bounce,
        chunk: &Chunk,
    ) -> Numbers<L> {
        Numbers {
            sampler: bounce.options.sampler,
            key: chunk.words::<L>(key),
            sample: chunk.words::<L>(sample),
        }
    }

    #[inline(always)]
    pub(super) fn pair(&self, pair: Pair) -> [L; 2] {
        sample_pairs(self.sampler, self.key, self.sample, pair)
    }
}

/// Samples the bsdf of every path of one kind: its next ray, its throughput, or its end.
#[inline(always)]
pub(super) fn sample_bsdf<L: BitLanes>(wave: &mut Wave, bounce: Bounce, kind: Scatter) {
    let (mut columns, groups, _) = Columns::new(wave);
    for chunk in Chunk::all::<L>(&groups.by_scatter[kind as usize]) {
        let local = Local::<L>::new(&columns, &chunk);
        let numbers = || Numbers::<L>::new((columns.key, columns.sample), bounce, &chunk);
        let scattered = match kind {
            Scatter::Nothing => return,
            Scatter::Diffuse => {
                sample_diffuse(&local, numbers().pair(Pair::Direction(bounce.index)))
            }
            Scatter::Mirror => mirrored(&local, local.color),
            Scatter::Metal => mirrored(&local, metal(local.color, local.incidence())),
            Scatter::Glass => {
                let [_, lobe] = numbers().pair(Pair::Choice(bounce.index));
                sample_glass(bounce, &columns, &chunk, &local, lobe)
            }
            Scatter::Plastic => {
                let numbers = numbers();
                let [_, lobe] = numbers.pair(Pair::Choice(bounce.index));
                let plastic = Plastic::new(bounce, &columns, &chunk, &local);
                let u = numbers.pair(Pair::Direction(bounce.index));
                sample_plastic(&plastic, &local, lobe, u)
            }
        };
        follow(&mut columns, &chunk, &local, &scattered);
    }
}

/// Sends paths on their way; those that carry nothing end.
#[inline(always)]
fn follow<L: BitLanes>(c: &mut Columns, chunk: &Chunk, local: &Local<L>, s: &Scattered<L>) {
    let alive = L::bits(s.weight.any_positive());
    chunk.put_vector(local.origin(s.dir), &mut c.origin);
    chunk.put_vector(s.dir, &mut c.dir);
    let throughput = chunk.vector(&c.throughput) * s.weight;
    chunk.put_vector(throughput, &mut c.throughput);
    chunk.put(s.pdf, c.pdf);
    let eta2 = chunk.lanes::<L>(c.eta2) * s.eta2;
    chunk.put(eta2, c.eta2);
    if !c.record.code.is_empty() {
        c.record
            .note(chunk, c.prim, local.origin(s.dir), [s.pdf, s.eta2]);
    }
    // They are alive so far, all of them.
    let members = chunk.members();
    if alive & members != members {
        for (lane, &i) in chunk.index().iter().enumerate() {
            c.alive[i as usize] = alive >> lane & 1 == 1;
        }
    }
}

/// A mirror-like lobe.
#[inline(always)]
fn mirrored<L: BitLanes>(local: &Local<L>, weight: V3<L>) -> Scattered<L> {
    Scattered {
        dir: local.mirror(),
        weight,
        pdf: L::splat(0.0),
        eta2: L::splat(1.0),
    }
}

#[inline(always)]
fn sample_diffuse<L: BitLanes>(local: &Local<L>, u: [L; 2]) -> Scattered<L> {
    let dir = cosine_hemisphere(local.ns, u);
    let cos = local.cosine(dir);
    let above = L::splat(0.0).lt(cos);
    Scattered {
        dir,
        weight: V3::select(above, local.color, V3::splat([0.0; 3])),
        pdf: cos * L::splat(FRAC_1_PI),
        eta2: L::splat(1.0),
    }
}

/// Reflects with probability F, else refracts. Radiance that is carried into the denser side shrinks by the squared
/// relative index (Veach 1997, §5.2), and grows back when it leaves.
#[inline(always)]
fn sample_glass<L: BitLanes>(
    bounce: Bounce,
    columns: &Columns,
    chunk: &Chunk,
    local: &Local<L>,
    lobe: L,
) -> Scattered<L> {
    let mut iors = [0.0; WIDEST];
    for lane in 0..L::N {
        let material = chunk.at(columns.material, lane) as usize;
        iors[lane] = bounce.scene.materials[material].ior;
    }
    let [zero, one] = [L::splat(0.0), L::splat(1.0)];
    let ior = L::load(&iors);
    let eta = L::select(local.outside, ior, one / ior);
    let cos_i = local.incidence();
    let (reflectance, cos_t) = dielectrics(bounce.options.fresnel, cos_i, eta);
    let reflects = lobe.lt(reflectance);
    let dir = (local.ns * cos_i - local.wo) * (one / eta) - local.ns * cos_t;
    // A shading normal may bend the ray back above the surface: fold it below, as reflection does upwards.
    let above = dir.dot(local.ng);
    let folded = dir - local.ng * (L::splat(2.0) * above);
    let refracted = V3::select(zero.lt(above), folded, dir);
    let weight = local.color * (one / (eta * eta));
    Scattered {
        dir: V3::select(reflects, local.mirror(), refracted),
        weight: V3::select(reflects, V3::splat([1.0; 3]), weight),
        pdf: zero,
        eta2: L::select(reflects, one, eta * eta),
    }
}

#[inline(always)]
fn sample_plastic<L: BitLanes>(
    plastic: &Plastic<L>,
    local: &Local<L>,
    lobe: L,
    u: [L; 2],
) -> Scattered<L> {
    let [zero, one] = [L::splat(0.0), L::splat(1.0)];
    let coated = lobe.lt(plastic.coat_share);
    let coat = plastic.coat / plastic.coat_share;
    let share = one - plastic.coat_share;
    let dir = cosine_hemisphere(local.ns, u);
    let cos = local.cosine(dir);
    let base = plastic.eval_base(cos) / share;
    let base = V3::select(zero.lt(cos), base, V3::splat([0.0; 3]));
    Scattered {
        dir: V3::select(coated, local.mirror(), dir),
        weight: V3::select(coated, V3([coat; 3]), base),
        pdf: L::select(coated, zero, share * cos * L::splat(FRAC_1_PI)),
        eta2: one,
    }
}
