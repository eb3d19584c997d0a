//! Light: whether anything shines once the files are loaded, and whether the lights' units can be meant.

use super::bounds::Bounds;
use super::posed::{Form, Item, Lamp, Posed};
use super::{codes, darkness};
use crate::asset::Light;
use crate::diag::Diagnostic;
use crate::math::{DVec3, ln};
use crate::scene::BackgroundDesc;
use crate::world::Emissive;
use std::f64::consts::{LN_2, PI};

/// Radiance of lit white paper above which a picture is white, even with ten stops less.
const GLARING: f64 = 1000.0;

/// Radiance of lit white paper below which an 8-bit picture is black, even with five stops more.
const DIM: f64 = 1e-4;

/// Radiance of white paper in a picture that is exposed as it should be.
const WELL_EXPOSED: f64 = 0.5;

/// Nothing in the world shines, that of files included.
pub(super) fn dark(posed: &Posed) -> Option<Diagnostic> {
    let lit = lit_background(posed)
        || posed.lights.iter().any(|lamp| strength(&lamp.light) > 0.0)
        || posed.items.iter().any(|item| shines(posed, item));
    (!lit).then(|| {
        darkness(
            posed.desc,
            "nothing shines, the files included, and the background is black",
        )
    })
}

/// Whether anything comes from where nothing is.
fn lit_background(posed: &Posed) -> bool {
    match &posed.desc.background {
        BackgroundDesc::Linear(radiance) => *radiance != [0.0; 3],
        BackgroundDesc::Hdr(hdr) => {
            let skies = &posed.store.panoramas;
            hdr.strength > 0.0 && skies.iter().any(|sky| sky.brightest() > 0.0)
        }
    }
}

/// Whether a shape emits: as its entity says, or as its file does where the entity says nothing.
pub(super) fn shines(posed: &Posed, item: &Item) -> bool {
    let emits = |radiance: [f64; 3]| radiance.iter().any(|c| *c > 0.0);
    if let Some(Emissive(radiance)) = item.emissive {
        return emits(*radiance);
    }
    let Some(mesh) = posed.mesh(item).filter(|_| item.material.is_none()) else {
        return false;
    };
    let emitters: Vec<bool> = mesh.materials.iter().map(|m| emits(m.emission)).collect();
    let emitter = |m: u32| emitters.get(m as usize) == Some(&true);
    emitters.contains(&true) && mesh.material.iter().flatten().any(|m| emitter(*m))
}

/// Lights without extent that burn the picture out, or that are its only light and leave it black.
pub(super) fn units(posed: &Posed) -> Option<Diagnostic> {
    let scene = posed.subject();
    let strongest = posed
        .lights
        .iter()
        .map(|lamp| (paper(scene.as_ref(), lamp), lamp))
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    let (radiance, lamp) = strongest;
    let alone = !lit_background(posed) && !posed.items.iter().any(|item| shines(posed, item));
    let what = if radiance > GLARING {
        "white"
    } else if radiance < DIM && radiance > 0.0 && alone {
        "black"
    } else {
        return None;
    };
    let unit = match lamp.light {
        Light::Sun { .. } => "W/m² (is this in lux? 683 lm are about 1 W)",
        _ => "W/sr (is this in candela? 683 lm are about 1 W)",
    };
    let says = format!(
        "white paper in the middle of the scene would have a radiance of {radiance:.1e} by this light: the picture will \
         be {what}"
    );
    let stops = (ln(WELL_EXPOSED / radiance) / LN_2).round();
    let hint = format!("lights are in {unit}; or render with `--exposure {stops}`");
    let component = if lamp.index.node == 0 {
        "light"
    } else {
        "gltf"
    };
    let entity = lamp.index.entity as usize;
    Some(
        posed
            .warn(entity, component, codes::OTHER_LIGHT_UNITS, says)
            .hint(hint),
    )
}

/// Radiance of white paper that faces the light in the middle of the scene, at least a quarter of the scene away.
fn paper(scene: Option<&Bounds>, lamp: &Lamp) -> f64 {
    let strength = strength(&lamp.light);
    if matches!(lamp.light, Light::Sun { .. }) {
        return strength / PI;
    }
    let Some(scene) = scene else {
        return WELL_EXPOSED;
    };
    let distance = (scene.center() - lamp.place)
        .length()
        .max(0.25 * scene.longest());
    if distance > 0.0 {
        strength / (PI * distance * distance)
    } else {
        WELL_EXPOSED
    }
}

/// The mean of the channels.
fn strength(light: &Light) -> f64 {
    let (Light::Point { intensity: rgb }
    | Light::Spot { intensity: rgb, .. }
    | Light::Sun { irradiance: rgb }) = light;
    DVec3::from_array(*rgb).element_sum() / 3.0
}

/// An emitter around the camera that shines away from it: what was meant as a sky is black.
pub(super) fn outward_sky(posed: &Posed, item: &Item) -> Option<Diagnostic> {
    let Form::Sphere { .. } = item.form else {
        return None;
    };
    shines(posed, item).then(|| {
        let says = format!(
            "the camera is inside the emitter {}, which shines outward only",
            posed.label(item)
        );
        let hint = "turn it in: `Sphere(radius: .., inverted: true)`";
        posed
            .warn(item.entity(), "shape", codes::CAMERA_INSIDE, says)
            .hint(hint)
    })
}
