//! Lights of KHR_lights_punctual.
//!
//! Units: candela and lux are taken as W·sr⁻¹ and W·m⁻², one to one. The same holds for emission, whose factors are nits by
//! KHR_materials_emissive_strength: one factor for both keeps a file consistent in itself, authors keep both near 1, and
//! `--exposure` does the rest. Deliberately absent: `range`, which bounds what a rasteriser computes, not what shines.

use super::exact::{exact, exact_one};
use super::source::Source;
use crate::asset::Light;
use gltf::khr_lights_punctual::Kind;

/// Widest angle from the axis of a spot, in degrees (KHR_lights_punctual: π/2).
const MAX_OUTER_DEG: f64 = 90.0;

/// Largest intensity and radiance, as for lights of a scene file: sums and products of a path still fit single precision.
pub(super) const MAX_POWER: f64 = 1e18;

/// Narrowest, in degrees: the extension wants more than nothing.
const MIN_OUTER_DEG: f64 = 1e-3;

/// Widest cone of full intensity, of the outer one: the falloff between them must have a width.
const MAX_INNER: f64 = 1.0 - 1e-9;

/// The light of a node.
pub(super) fn light(source: &Source, node: &gltf::Node<'_>) -> Option<Light> {
    let light = node.light()?;
    let json = &source.json;
    let at = |part: &str| {
        let index = light.index();
        format!("/extensions/KHR_lights_punctual/lights/{index}/{part}")
    };
    let color = exact(json, &at("color"), light.color());
    let strength = exact_one(json, &at("intensity"), light.intensity());
    let power = color.map(|c| (c * strength).clamp(0.0, MAX_POWER));
    Some(match light.kind() {
        Kind::Directional => Light::Sun { irradiance: power },
        Kind::Point => Light::Point { intensity: power },
        Kind::Spot {
            inner_cone_angle,
            outer_cone_angle,
        } => {
            let angle = |part, typed| exact_one(json, &at(part), typed).to_degrees();
            let outer_deg = angle("spot/outerConeAngle", outer_cone_angle);
            let outer_deg = outer_deg.clamp(MIN_OUTER_DEG, MAX_OUTER_DEG);
            let inner_deg = angle("spot/innerConeAngle", inner_cone_angle);
            Light::Spot {
                intensity: power,
                inner_deg: inner_deg.clamp(0.0, outer_deg * MAX_INNER),
                outer_deg,
            }
        }
    })
}
