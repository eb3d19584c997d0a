//! Rules of cameras, lights, images and textures (specification, sections 3.8 to 3.10; KHR_lights_punctual).

use super::extensions::VARIANTS;
use super::usages::{self, Purpose};
use super::{Rules, extensions};
use crate::asset::codes;
use crate::asset::gltf::layout::{items, natural};
use crate::asset::gltf::uses::{element, index};
use serde_json::Value;
use std::collections::BTreeSet;

pub(super) fn check(rules: &mut Rules) {
    let json = rules.json;
    for (i, one) in items(json, "cameras").iter().enumerate() {
        camera(rules, one, &format!("/cameras/{i}"));
    }
    for (i, one) in extensions::lights(json).iter().enumerate() {
        light(
            rules,
            one,
            &format!("/extensions/KHR_lights_punctual/lights/{i}"),
        );
    }
    for (i, one) in items(json, "materials").iter().enumerate() {
        material(rules, one, &format!("/materials/{i}"));
    }
    for (i, one) in items(json, "images").iter().enumerate() {
        image(rules, i, one, &format!("/images/{i}"));
    }
    for (i, one) in items(json, "textures").iter().enumerate() {
        texture(rules, one, &format!("/textures/{i}"));
    }
}

/// No variant has two materials for one primitive (KHR_materials_variants).
pub(super) fn variants(rules: &mut Rules, primitive: &Value, pointer: &str) {
    let extension = primitive
        .get("extensions")
        .and_then(|all| all.get(VARIANTS));
    let mappings = extension.map_or(&[][..], |all| items(all, "mappings"));
    let mut seen = BTreeSet::new();
    for (m, mapping) in mappings.iter().enumerate() {
        let here: BTreeSet<usize> = items(mapping, "variants")
            .iter()
            .filter_map(natural)
            .collect();
        if let Some(twice) = here.iter().find(|variant| seen.contains(*variant)) {
            let says = format!("variant {twice} has two materials for this primitive");
            let pointer = format!("{pointer}/extensions/{VARIANTS}/mappings/{m}/variants");
            rules.warn(codes::GLTF_LOOK, pointer, says);
        }
        seen.extend(here);
    }
}

fn camera(rules: &mut Rules, camera: &Value, pointer: &str) {
    let kinds = ["perspective", "orthographic"];
    let given = kinds
        .iter()
        .filter(|kind| camera.get(kind).is_some())
        .count();
    if given != 1 && camera.is_object() {
        let says =
            format!("a camera is either perspective or orthographic: {given} of them are given");
        rules.warn(codes::GLTF_LOOK, pointer, says);
    }
    let named = camera
        .get("type")
        .and_then(Value::as_str)
        .filter(|name| kinds.contains(name));
    if let Some(named) = named
        && given == 1
        && camera.get(named).is_none()
    {
        let says = format!("{named:?} is missing, which the camera says it is");
        rules.warn(codes::GLTF_LOOK, pointer, says);
    }
    for kind in kinds {
        let number = |name: &str| camera.get(kind).and_then(|part| part.get(name)?.as_f64());
        let pointer = format!("{pointer}/{kind}");
        if let (Some(near), Some(far)) = (number("znear"), number("zfar"))
            && far <= near
        {
            let says = format!("zfar {far} is not above znear {near}");
            rules.warn(codes::GLTF_LOOK, &pointer, says);
        }
        for name in ["xmag", "ymag"] {
            if number(name) == Some(0.0) {
                let says = format!("{name} is 0: the camera sees nothing");
                rules.warn(codes::GLTF_LOOK, format!("{pointer}/{name}"), says);
            }
        }
        if number("yfov").is_some_and(|angle| angle >= std::f64::consts::PI) {
            let says = "a yfov of half a turn or more";
            rules.warn(codes::GLTF_LOOK, format!("{pointer}/yfov"), says);
        }
    }
}

fn light(rules: &mut Rules, light: &Value, pointer: &str) {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
    let is_spot = light.get("type").and_then(Value::as_str) == Some("spot");
    let Some(spot) = light.get("spot") else {
        if is_spot {
            rules.warn(codes::GLTF_LOOK, pointer, "a spot light without \"spot\"");
        }
        return;
    };
    let angle = |name: &str, default| spot.get(name).map_or(Some(default), Value::as_f64);
    let (inner, outer) = (
        angle("innerConeAngle", 0.0),
        angle("outerConeAngle", FRAC_PI_4),
    );
    if let (Some(inner), Some(outer)) = (inner, outer) {
        let pointer = format!("{pointer}/spot");
        if outer <= inner {
            let says = format!("outerConeAngle {outer} is not above innerConeAngle {inner}");
            rules.warn(codes::GLTF_LOOK, &pointer, says);
        }
        // As f32 the value that everyone writes for 90 degrees is a little above it.
        if outer as f32 > FRAC_PI_2 as f32 {
            let says = format!("outerConeAngle {outer} is above a right angle");
            rules.warn(codes::GLTF_LOOK, format!("{pointer}/outerConeAngle"), says);
        }
    }
}

/// `KHR_materials_ior`: 0, or 1 and above.
fn material(rules: &mut Rules, material: &Value, pointer: &str) {
    let place = "/extensions/KHR_materials_ior/ior";
    let ior = material.pointer(place).and_then(Value::as_f64);
    if let Some(ior) = ior.filter(|ior| (0.0..1.0).contains(ior) && *ior != 0.0) {
        let says = format!("an ior of {ior}: it must be 0, or at least 1");
        rules.warn(codes::GLTF_LOOK, format!("{pointer}{place}"), says);
    }
}

fn image(rules: &mut Rules, i: usize, image: &Value, pointer: &str) {
    let used = rules.uses.images.contains(&i);
    let (uri, view) = (image.get("uri"), index(image, "bufferView"));
    if !image.is_object() {
        return;
    }
    match (uri, image.get("bufferView")) {
        (None, None) => {
            let says = "an image without \"uri\" and \"bufferView\"";
            rules.wrong(used, (codes::GLTF_VALUE, codes::GLTF_IMAGE), pointer, says);
        }
        (Some(_), Some(_)) => {
            let says = "an image with both \"uri\" and \"bufferView\": the uri counts";
            rules.warn(codes::GLTF_IMAGE, pointer, says);
        }
        _ => {}
    }
    let Some(view) = view else { return };
    let pointer = format!("{pointer}/bufferView");
    if image.get("mimeType").is_none() {
        let says = "an image in a buffer view needs a \"mimeType\"";
        rules.warn(codes::GLTF_IMAGE, &pointer, says);
    }
    usages::view(rules, view, Purpose::Image, &pointer);
    if rules
        .layouts
        .view(view)
        .is_some_and(|view| view.stride.is_some())
    {
        usages::strided(rules, view, Purpose::Image, &pointer);
    }
}

/// The image of a texture is PNG or JPEG (section 3.8.2); others come by extensions, beside `source`.
fn texture(rules: &mut Rules, texture: &Value, pointer: &str) {
    let image = index(texture, "source").and_then(|image| element(rules.json, "images", image));
    let mime = image.and_then(|image| image.get("mimeType")?.as_str());
    if let Some(mime) = mime.filter(|mime| !matches!(*mime, "image/png" | "image/jpeg")) {
        let says =
            format!("the image of a texture is {mime:?}, not \"image/png\" or \"image/jpeg\"");
        rules.warn(codes::GLTF_IMAGE, format!("{pointer}/source"), says);
    }
}
