//! Lights without extent, seen from a point: one direction, and the irradiance of what faces it.

use super::light::{LightSample, SHORT};
use super::vector::V3;
use crate::flat::{Lights, Punctual};
use crate::math::{DVec3, Vec3};

/// The one direction to light number `chosen` of the table; `None` where nothing of it arrives, or more than can be said.
#[inline(never)]
pub(super) fn sample_punctual(
    lights: &Lights,
    from: Vec3,
    chosen: usize,
) -> Option<LightSample<f32>> {
    let probability = lights.share(chosen);
    let first = lights.spheres.len() + lights.triangles.area.len();
    let (to, irradiance, t_max) = match &lights.punctual[chosen - first] {
        Punctual::Sun {
            to_light,
            irradiance,
        } => (DVec3::from(*to_light), *irradiance, f32::MAX),
        Punctual::Point {
            position,
            intensity,
        } => towards(*position, from, *intensity, |_| 1.0),
        Punctual::Spot {
            position,
            axis,
            intensity,
            cos_inner,
            cos_outer,
        } => towards(*position, from, *intensity, |to| {
            let cos = -to.dot(DVec3::from(*axis));
            if cos >= *cos_inner {
                return 1.0;
            }
            let falloff = ((cos - cos_outer) / (cos_inner - cos_outer)).max(0.0);
            falloff * falloff
        }),
    };
    let radiance = DVec3::from(irradiance).as_vec3();
    let pdf = probability as f32;
    let arrives = radiance.max_element() > 0.0 && radiance.is_finite() && pdf > 0.0;
    arrives.then_some(LightSample {
        dir: V3::from(to.as_vec3()),
        t_max,
        radiance: V3::from(radiance),
        pdf,
        punctual: 1,
        valid: 1,
    })
}

/// Unit direction to a point, irradiance from there, and where the shadow ray ends; `share` is of the intensity, by the
/// direction.
fn towards(
    position: [f64; 3],
    from: Vec3,
    intensity: [f64; 3],
    share: impl Fn(DVec3) -> f64,
) -> (DVec3, [f64; 3], f32) {
    let to = DVec3::from(position) - from.as_dvec3();
    let d2 = to.length_squared();
    let dir = to / d2.sqrt();
    let share = share(dir) / d2;
    let t_max = (d2.sqrt() as f32).min(f32::MAX) * SHORT;
    (dir, intensity.map(|c| c * share), t_max)
}
