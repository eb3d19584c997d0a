//! Sample light and sample bsdf, one loop per kind of scattering.
//!
//! Weights are f cos θ / pdf in closed form: a Lambert sample multiplies the throughput by the albedo and nothing
//! else, so that a furnace is exact in every sample.

use super::fresnel::{dielectric, metal};
use super::light::{LightSample, sample_light};
use super::sampler::{Pair, sample_pair};
use super::spawn::offset_origin;
use super::vector::{cosine_hemisphere, get, reflect, set};
use super::wave::Wave;
use super::{Fresnel, TraceOptions};
use crate::flat::{FlatScene, Material, Scatter};
use crate::math::Vec3;
use std::f32::consts::FRAC_1_PI;

/// What every stage of a bounce is lent.
#[derive(Clone, Copy)]
pub(super) struct Bounce<'a> {
    pub(super) scene: &'a FlatScene,
    pub(super) options: &'a TraceOptions,
    /// 0 = at the first hit.
    pub(super) index: u32,
}

/// A path's surroundings, turned to the side that it came from.
struct Local {
    wo: Vec3,
    ng: Vec3,
    ns: Vec3,
    position: Vec3,
    err: f32,
    color: Vec3,
    /// The path came from the authored outside.
    outside: bool,
}

/// What a bsdf sample decides.
struct Scattered {
    dir: Vec3,
    /// f cos θ / pdf.
    weight: Vec3,
    /// Over solid angle; 0 for a mirror-like lobe.
    pdf: f32,
    /// Squared relative index of a refraction, else 1.
    eta2: f32,
}

impl Local {
    fn new(wave: &Wave, i: usize) -> Local {
        let wo = -get(&wave.paths.rays.dir, i);
        let s = &wave.surfaces;
        let (ng, ns) = (get(&s.ng, i), get(&s.ns, i));
        let outside = wo.dot(ng) >= 0.0;
        let side = if outside { 1.0 } else { -1.0 };
        Local {
            wo,
            ng: ng * side,
            ns: ns * side,
            position: get(&s.position, i),
            err: wave.hits.err[i],
            color: get(&s.color, i),
            outside,
        }
    }

    /// Where rays towards `dir` start.
    fn origin(&self, dir: Vec3) -> Vec3 {
        let (p, ng) = (self.position.to_array(), self.ng.to_array());
        Vec3::from(offset_origin(p, ng, self.err, dir.to_array()))
    }

    /// Cosine at the shading normal; 0 below either surface.
    fn cosine(&self, dir: Vec3) -> f32 {
        if dir.dot(self.ng) > 0.0 {
            dir.dot(self.ns).max(0.0)
        } else {
            0.0
        }
    }

    /// Mirror direction about the shading normal. Where that dips below the geometric surface it is folded back up,
    /// continuously, so that smooth mirrors have no black specks.
    fn mirror(&self) -> Vec3 {
        let dir = reflect(self.wo, self.ns);
        let below = dir.dot(self.ng);
        if below < 0.0 {
            dir - self.ng * (2.0 * below)
        } else {
            dir
        }
    }
}

/// Cosine of incidence at the shading normal, within [0, 1].
fn incidence(local: &Local) -> f32 {
    local.wo.dot(local.ns).clamp(0.0, 1.0)
}

/// Power heuristic, exponent 2 (Veach 1997, §9.2.4); exact when a density is 0 or infinite.
#[inline]
pub(super) fn mis_weight(pdf: f32, other: f32) -> f32 {
    if other == 0.0 {
        return 1.0;
    }
    let ratio = other / pdf;
    1.0 / (1.0 + ratio * ratio)
}

/// The coat and the base of a plastic, seen from one direction.
///
/// The base under the coat reflects (1 − F(θi)) (1 − F(θo)) a / (π n² (1 − a F_int)): what enters, bounces between base
/// and coat, and leaves (the smooth case of Ashikhmin and Shirley's energy argument; at a = 1 all light comes back).
struct Plastic<'a> {
    mode: Fresnel,
    material: &'a Material,
    coat: f32,
    base: Vec3,
    /// Probability of sampling the coat.
    coat_share: f32,
}

impl<'a> Plastic<'a> {
    fn new(mode: Fresnel, material: &'a Material, local: &Local) -> Plastic<'a> {
        let (coat, _) = dielectric(mode, incidence(local), material.ior);
        let inner = Vec3::ONE - local.color * material.internal_reflectance;
        let base = local.color / (inner * (material.ior * material.ior));
        // The base sends back about (1 − F) a (1 − F_int) / (1 − a F_int) of what comes.
        let back = base * (material.ior * material.ior) * (1.0 - material.internal_reflectance);
        let (coat_power, base_power) = (coat, (1.0 - coat) * back.max_element());
        let coat_share = if base_power > 0.0 {
            coat_power / (coat_power + base_power)
        } else {
            1.0
        };
        Plastic {
            mode,
            material,
            coat,
            base,
            coat_share,
        }
    }

    /// π times the base's bsdf towards `dir`.
    fn eval_base(&self, cos: f32) -> Vec3 {
        let (out, _) = dielectric(self.mode, cos.min(1.0), self.material.ior);
        self.base * ((1.0 - self.coat) * (1.0 - out))
    }
}

/// Next-event estimation at the diffuse and plastic paths: fills the shadow rays of this bounce.
pub(super) fn sample_lights(wave: &mut Wave, bounce: Bounce) {
    wave.shadows.clear();
    for kind in [Scatter::Diffuse, Scatter::Plastic] {
        for k in 0..wave.by_scatter[kind as usize].len() {
            let i = wave.by_scatter[kind as usize][k] as usize;
            let local = Local::new(wave, i);
            let slot = wave.paths.slot[i];
            let origin = local.origin(local.ng);
            let Some(light) = light_from(wave, bounce, slot as usize, origin) else {
                continue;
            };
            let cos = local.cosine(light.dir);
            if cos == 0.0 {
                continue;
            }
            let (f_pi, share) = if kind == Scatter::Diffuse {
                (local.color, 1.0)
            } else {
                let material = &bounce.scene.materials[wave.surfaces.material[i] as usize];
                let plastic = Plastic::new(bounce.options.fresnel, material, &local);
                (plastic.eval_base(cos), 1.0 - plastic.coat_share)
            };
            let weight = if bounce.options.mis && !light.punctual {
                mis_weight(light.pdf, share * cos * FRAC_1_PI)
            } else {
                1.0
            };
            let throughput = get(&wave.paths.throughput, i);
            let radiance =
                throughput * f_pi * light.radiance * (FRAC_1_PI * cos * weight / light.pdf);
            wave.shadows
                .push(origin, light.dir, light.t_max, radiance, slot);
        }
    }
}

fn light_from(wave: &Wave, bounce: Bounce, slot: usize, origin: Vec3) -> Option<LightSample> {
    let (key, sample) = (wave.slots.key[slot], wave.slots.sample[slot]);
    // One light needs no choice.
    let choice = match bounce.scene.lights.len() {
        1 => 0.0,
        _ => sample_pair(
            bounce.options.sampler,
            key,
            sample,
            Pair::Choice(bounce.index),
        )[0],
    };
    let u = sample_pair(
        bounce.options.sampler,
        key,
        sample,
        Pair::Light(bounce.index),
    );
    sample_light(bounce.scene, origin, choice, u)
}

/// Samples the bsdf of every path of one kind: its next ray, its throughput, or its end.
pub(super) fn sample_bsdf(wave: &mut Wave, bounce: Bounce, kind: Scatter) {
    for k in 0..wave.by_scatter[kind as usize].len() {
        let i = wave.by_scatter[kind as usize][k] as usize;
        let local = Local::new(wave, i);
        let material = &bounce.scene.materials[wave.surfaces.material[i] as usize];
        let slot = wave.paths.slot[i] as usize;
        let (key, sample) = (wave.slots.key[slot], wave.slots.sample[slot]);
        let pair = |pair| sample_pair(bounce.options.sampler, key, sample, pair);
        let scattered = match kind {
            Scatter::Nothing => None,
            Scatter::Diffuse => sample_diffuse(&local, pair(Pair::Direction(bounce.index))),
            Scatter::Mirror => Some(Scattered {
                dir: local.mirror(),
                weight: local.color,
                pdf: 0.0,
                eta2: 1.0,
            }),
            Scatter::Metal => {
                let weight = metal(local.color, incidence(&local));
                Some(Scattered {
                    dir: local.mirror(),
                    weight,
                    pdf: 0.0,
                    eta2: 1.0,
                })
            }
            Scatter::Glass => {
                let [_, lobe] = pair(Pair::Choice(bounce.index));
                Some(sample_glass(bounce.options.fresnel, material, &local, lobe))
            }
            Scatter::Plastic => {
                let [_, lobe] = pair(Pair::Choice(bounce.index));
                let plastic = Plastic::new(bounce.options.fresnel, material, &local);
                sample_plastic(&plastic, &local, lobe, pair(Pair::Direction(bounce.index)))
            }
        };
        match scattered {
            Some(s) if s.weight.max_element() > 0.0 => follow(wave, i, &local, &s),
            _ => wave.alive[i] = false,
        }
    }
}

/// Sends path i on its way.
fn follow(wave: &mut Wave, i: usize, local: &Local, s: &Scattered) {
    let paths = &mut wave.paths;
    set(&mut paths.rays.origin, i, local.origin(s.dir));
    set(&mut paths.rays.dir, i, s.dir);
    let throughput = get(&paths.throughput, i) * s.weight;
    set(&mut paths.throughput, i, throughput);
    paths.pdf[i] = s.pdf;
    paths.eta2[i] *= s.eta2;
}

fn sample_diffuse(local: &Local, u: [f32; 2]) -> Option<Scattered> {
    let dir = cosine_hemisphere(local.ns, u);
    let cos = local.cosine(dir);
    (cos > 0.0).then_some(Scattered {
        dir,
        weight: local.color,
        pdf: cos * FRAC_1_PI,
        eta2: 1.0,
    })
}

/// Reflects with probability F, else refracts. Radiance that is carried into the denser side shrinks by the squared
/// relative index (Veach 1997, §5.2), and grows back when it leaves.
fn sample_glass(mode: Fresnel, material: &Material, local: &Local, lobe: f32) -> Scattered {
    let eta = if local.outside {
        material.ior
    } else {
        1.0 / material.ior
    };
    let cos_i = incidence(local);
    let (reflectance, cos_t) = dielectric(mode, cos_i, eta);
    if lobe < reflectance {
        return Scattered {
            dir: local.mirror(),
            weight: Vec3::ONE,
            pdf: 0.0,
            eta2: 1.0,
        };
    }
    let dir = (local.ns * cos_i - local.wo) * (1.0 / eta) - local.ns * cos_t;
    // A shading normal may bend the ray back above the surface: fold it below, as reflection does upwards.
    let above = dir.dot(local.ng);
    let dir = if above > 0.0 {
        dir - local.ng * (2.0 * above)
    } else {
        dir
    };
    Scattered {
        dir,
        weight: local.color * (1.0 / (eta * eta)),
        pdf: 0.0,
        eta2: eta * eta,
    }
}

fn sample_plastic(plastic: &Plastic, local: &Local, lobe: f32, u: [f32; 2]) -> Option<Scattered> {
    if lobe < plastic.coat_share {
        let weight = Vec3::splat(plastic.coat / plastic.coat_share);
        return Some(Scattered {
            dir: local.mirror(),
            weight,
            pdf: 0.0,
            eta2: 1.0,
        });
    }
    let share = 1.0 - plastic.coat_share;
    let dir = cosine_hemisphere(local.ns, u);
    let cos = local.cosine(dir);
    let weight = plastic.eval_base(cos) / share;
    (cos > 0.0).then_some(Scattered {
        dir,
        weight,
        pdf: share * cos * FRAC_1_PI,
        eta2: 1.0,
    })
}
