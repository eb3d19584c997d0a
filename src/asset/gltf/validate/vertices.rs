//! Rules of the attributes and indices of a primitive (specification, section 3.7.2.1).

use super::Rules;
use super::formats::{self, SETS, of_attribute, semantic};
use super::usages::{self, Purpose};
use super::walk::step;
use crate::asset::codes;
use crate::asset::gltf::layout::{Accessor, Component, items, natural};
use crate::asset::gltf::uses::{element, index, is_read, texture_infos};
use serde_json::{Map, Value};

const OF_PRIMITIVE: (&str, &str) = (codes::GLTF_PRIMITIVE, codes::GLTF_ODD_PRIMITIVE);

/// `mode` of triangles, strips and fans (section 5.24.4).
const TRIANGLES: usize = 4;
const STRIP_AND_FAN: [usize; 2] = [5, 6];

pub(super) fn check(
    rules: &mut Rules,
    primitive: &Value,
    (used, quantized): (bool, bool),
    pointer: &str,
) {
    let Some(attributes) = primitive.get("attributes").and_then(Value::as_object) else {
        return;
    };
    let place = format!("{pointer}/attributes");
    sets(rules, attributes, &place);
    let mut vertices = None;
    let position = attributes.get_key_value("POSITION");
    for (name, value) in position.into_iter().chain(attributes) {
        let pointer = step(&place, name);
        let used = used && is_read(name);
        // POSITION comes first and again: once is enough.
        if name == "POSITION" && vertices.is_some() {
            continue;
        }
        let formats = of_attribute(name, quantized);
        if formats.is_none() && !name.starts_with('_') {
            let says = format!("there is no attribute {name:?}");
            rules.warn(codes::GLTF_ODD_PRIMITIVE, &pointer, says);
        }
        let Some((i, accessor)) = resolved(rules, value) else {
            continue;
        };
        usages::accessor(rules, i, Purpose::Vertices, &pointer);
        alignment(rules, &accessor, &pointer);
        format(rules, used, name, &accessor, formats, &pointer);
        if name == "POSITION" {
            bounds(rules, i, &pointer);
        }
        let first = *vertices.get_or_insert(accessor.count);
        if accessor.count != first {
            let says = format!(
                "{} elements, where the primitive has {first} vertices",
                accessor.count
            );
            rules.wrong(used, OF_PRIMITIVE, &pointer, says);
        }
    }
    let indices = indices(rules, primitive, used, pointer);
    if let Some(count) = indices.or(vertices) {
        corners(rules, primitive, count, pointer);
    }
    texture_coordinates(rules, primitive, used, attributes, pointer);
}

/// The accessor behind an index, if it is well formed.
pub(super) fn resolved(rules: &Rules, value: &Value) -> Option<(usize, Accessor)> {
    let i = natural(value)?;
    Some((i, rules.layouts.accessor(i)?.clone()))
}

/// Each element of a vertex attribute starts at a multiple of 4 bytes of its view (section 3.6.2.4).
pub(super) fn alignment(rules: &mut Rules, accessor: &Accessor, pointer: &str) {
    let view = accessor.view.and_then(|view| rules.layouts.view(view));
    let Some(view) = view else { return };
    let stride = view.stride.unwrap_or(accessor.size());
    if !accessor.offset.is_multiple_of(4) || !stride.is_multiple_of(4) {
        let says = format!(
            "elements every {stride} bytes from byte {} are not aligned to 4 bytes",
            accessor.offset
        );
        rules.warn(codes::GLTF_LAYOUT, pointer, says);
    }
}

/// POSITION says its bounds (section 3.7.2.1).
pub(super) fn bounds(rules: &mut Rules, accessor: usize, pointer: &str) {
    let json = element(rules.json, "accessors", accessor);
    let has = |name: &str| json.is_some_and(|json| json.get(name).is_some());
    if !has("min") || !has("max") {
        let says = format!("accessor {accessor} of positions has no min and max");
        rules.warn(codes::GLTF_BOUNDS, pointer, says);
    }
}

fn format(
    rules: &mut Rules,
    used: bool,
    name: &str,
    accessor: &Accessor,
    formats: Option<formats::Formats>,
    pointer: &str,
) {
    match formats {
        Some(formats) if !formats.allow(accessor) => {
            let says = format!(
                "{} cannot be {name}, which is {}",
                accessor.format(),
                formats.names()
            );
            // Numbers of another type can still be read.
            let fatal = used && !formats.allow_shape(accessor);
            rules.wrong(fatal, OF_PRIMITIVE, pointer, says);
        }
        None if accessor.component == Component::U32 => {
            let says = "a vertex attribute cannot be UNSIGNED_INT";
            rules.warn(codes::GLTF_ODD_PRIMITIVE, pointer, says);
        }
        _ => {}
    }
}

/// Numbered sets start at 0 and have no gaps; joints and weights come in pairs.
fn sets(rules: &mut Rules, attributes: &Map<String, Value>, pointer: &str) {
    let mut counts = [0; SETS.len()];
    for (count, stem) in counts.iter_mut().zip(SETS) {
        let of_stem = |name: &&String| semantic(name) == Some(stem);
        *count = attributes.keys().filter(of_stem).count();
        let missing = (0..*count).find(|i| !attributes.contains_key(&format!("{stem}_{i}")));
        if let Some(missing) = missing {
            let says = format!("{stem}_{missing} is missing before a higher one");
            rules.warn(codes::GLTF_ODD_PRIMITIVE, pointer, says);
        }
    }
    let [.., joints, weights] = counts;
    if joints != weights {
        let says = format!("{joints} sets of JOINTS for {weights} of WEIGHTS");
        rules.warn(codes::GLTF_MOTION, pointer, says);
    }
}

/// Checks the accessor of indices and gives their number.
fn indices(rules: &mut Rules, primitive: &Value, used: bool, pointer: &str) -> Option<usize> {
    let pointer = format!("{pointer}/indices");
    let (i, accessor) = resolved(rules, primitive.get("indices")?)?;
    usages::accessor(rules, i, Purpose::Indices, &pointer);
    if !formats::INDICES.allow(&accessor) {
        let meant = formats::INDICES.names();
        let says = format!("{} cannot be indices, which are {meant}", accessor.format());
        rules.wrong(used, OF_PRIMITIVE, pointer, says);
    }
    Some(accessor.count)
}

/// The number of corners makes whole triangles.
fn corners(rules: &mut Rules, primitive: &Value, count: usize, pointer: &str) {
    let mode = primitive.get("mode").map_or(Some(TRIANGLES), natural);
    let says = match mode {
        Some(TRIANGLES) if !count.is_multiple_of(3) => {
            format!(
                "{count} corners are no whole triangles: the last {} are dropped",
                count % 3
            )
        }
        Some(mode) if STRIP_AND_FAN.contains(&mode) && count < 3 => {
            format!("{count} corners make no triangle")
        }
        _ => return,
    };
    rules.warn(codes::GLTF_ODD_PRIMITIVE, pointer, says);
}

/// The material's textures find their set of coordinates. Those that are shown are told of where they are read.
fn texture_coordinates(
    rules: &mut Rules,
    primitive: &Value,
    used: bool,
    attributes: &Map<String, Value>,
    pointer: &str,
) {
    let Some(material) =
        index(primitive, "material").and_then(|i| items(rules.json, "materials").get(i))
    else {
        return;
    };
    let others = ["/normalTexture", "/occlusionTexture"];
    let places = texture_infos(material).into_iter().map(|(place, _)| place);
    let places = places.filter(|_| !used);
    for place in places.chain(others) {
        let Some(info) = material.pointer(place) else {
            continue;
        };
        let transform = info.pointer("/extensions/KHR_texture_transform/texCoord");
        let set = transform.or(info.get("texCoord")).map_or(Some(0), natural);
        let Some(set) = set.filter(|set| !attributes.contains_key(&format!("TEXCOORD_{set}")))
        else {
            continue;
        };
        let place = place.trim_start_matches('/');
        let says = format!(
            "the material's {place} needs TEXCOORD_{set}, which the primitive does not have"
        );
        rules.warn(
            codes::GLTF_ODD_PRIMITIVE,
            format!("{pointer}/material"),
            says,
        );
    }
}
