//! Materials: exact Fresnel, Lambert, mirror, glass, coated Lambert, Schlick's metal.

use super::{Hit, Kind, Material, Random};
use glam::DVec3;
use std::f64::consts::PI;

/// A scattered path.
pub(crate) struct Scattered {
    pub(crate) dir: DVec3,
    /// f cos θ / pdf.
    pub(crate) weight: DVec3,
    /// Whether a light sample could not have taken this direction.
    pub(crate) specular: bool,
}

/// Unpolarised reflectance and, unless all is reflected, the cosine of refraction. `n` is the index beyond over the
/// index on this side (Born and Wolf, §1.5.2).
pub(crate) fn dielectric(cos: f64, n: f64) -> (f64, Option<f64>) {
    let sin2 = (1.0 - cos * cos).max(0.0) / (n * n);
    if sin2 >= 1.0 {
        return (1.0, None);
    }
    let beyond = (1.0 - sin2).sqrt();
    let s = (cos - n * beyond) / (cos + n * beyond);
    let p = (n * cos - beyond) / (n * cos + beyond);
    ((s * s + p * p) / 2.0, Some(beyond))
}

/// 1 − (1 − F_ext) / n², F_ext = ∫ F(cos) 2 cos d cos by the midpoint rule.
pub(crate) fn internal_reflectance(n: f64) -> f64 {
    const STEPS: u32 = 100_000;
    let external: f64 = (0..STEPS)
        .map(|k| (f64::from(k) + 0.5) / f64::from(STEPS))
        .map(|cos| dielectric(cos, n).0 * 2.0 * cos / f64::from(STEPS))
        .sum();
    1.0 - (1.0 - external) / (n * n)
}

/// The mirror direction about `ns`, folded up about the plane of `ng` where it would dip below the surface.
fn mirror(wo: DVec3, ng: DVec3, ns: DVec3) -> DVec3 {
    let dir = ns * (2.0 * wo.dot(ns)) - wo;
    let below = dir.dot(ng).min(0.0);
    (dir - ng * (2.0 * below)).normalize()
}

impl Material {
    fn color_at(&self, hit: &Hit) -> DVec3 {
        self.color.at(hit) * if self.tinted { hit.tint } else { DVec3::ONE }
    }

    /// The part that light samples can reach: f towards `wi`. `ng` and `ns` are on the side of `wo`.
    pub(crate) fn smooth(&self, hit: &Hit, wo: DVec3, wi: DVec3) -> DVec3 {
        let (ng, ns) = facing(hit, wo);
        let cos = wi.dot(ns);
        if wi.dot(ng) <= 0.0 || cos <= 0.0 {
            return DVec3::ZERO;
        }
        let color = self.color_at(hit);
        match self.kind {
            Kind::Diffuse => color / PI,
            Kind::Plastic { ior, inner } => {
                let enter = 1.0 - dielectric(wo.dot(ns).clamp(0.0, 1.0), ior).0;
                base(color, ior, inner) * (enter * (1.0 - dielectric(cos, ior).0) / PI)
            }
            _ => DVec3::ZERO,
        }
    }

    /// Continues a path, or ends it.
    pub(crate) fn scatter(&self, hit: &Hit, wo: DVec3, random: &mut Random) -> Option<Scattered> {
        let (ng, ns) = facing(hit, wo);
        let color = self.color_at(hit);
        let cos = wo.dot(ns).clamp(0.0, 1.0);
        match self.kind {
            Kind::Nothing => None,
            Kind::Diffuse => lambert(ng, ns, color, random),
            Kind::Mirror => Some(Scattered {
                dir: mirror(wo, ng, ns),
                weight: color,
                specular: true,
            }),
            Kind::Metal => Some(Scattered {
                dir: mirror(wo, ng, ns),
                weight: color + (DVec3::ONE - color) * (1.0 - cos).powi(5),
                specular: true,
            }),
            Kind::Glass { ior } => {
                let inside = wo.dot(hit.ng) < 0.0;
                let n = if inside { 1.0 / ior } else { ior };
                Some(glass(wo, (ng, ns), n, color, random))
            }
            Kind::Plastic { ior, inner } => {
                let (coat, _) = dielectric(cos, ior);
                if random.unit() < coat {
                    return Some(Scattered {
                        dir: mirror(wo, ng, ns),
                        weight: DVec3::ONE,
                        specular: true,
                    });
                }
                let mut s = lambert(ng, ns, base(color, ior, inner), random)?;
                s.weight *= 1.0 - dielectric(s.dir.dot(ns), ior).0;
                Some(s)
            }
        }
    }
}

/// a / (n² (1 − a F_int)).
fn base(color: DVec3, ior: f64, inner: f64) -> DVec3 {
    color / ((DVec3::ONE - color * inner) * (ior * ior))
}

fn facing(hit: &Hit, wo: DVec3) -> (DVec3, DVec3) {
    let side = if wo.dot(hit.ng) >= 0.0 { 1.0 } else { -1.0 };
    (hit.ng * side, hit.ns * side)
}

fn lambert(ng: DVec3, ns: DVec3, color: DVec3, random: &mut Random) -> Option<Scattered> {
    let dir = random.cosine(ns);
    (dir.dot(ng) > 0.0).then_some(Scattered {
        dir,
        weight: color,
        specular: false,
    })
}

/// Reflects with probability F; else refracts, and radiance changes by (n1 / n2)².
fn glass(
    wo: DVec3,
    (ng, ns): (DVec3, DVec3),
    n: f64,
    color: DVec3,
    random: &mut Random,
) -> Scattered {
    let cos = wo.dot(ns).clamp(0.0, 1.0);
    let (reflectance, beyond) = dielectric(cos, n);
    match beyond {
        Some(beyond) if random.unit() >= reflectance => Scattered {
            dir: (ns * (cos / n - beyond) - wo / n).normalize(),
            weight: color / (n * n),
            specular: true,
        },
        _ => Scattered {
            dir: mirror(wo, ng, ns),
            weight: DVec3::ONE,
            specular: true,
        },
    }
}
