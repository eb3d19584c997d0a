//! Rules of meshes and their morph targets (specification, sections 3.7.2 and 5.23).

use super::formats::of_target;
use super::usages::{self, Purpose};
use super::walk::step;
use super::{Rules, extensions, looks, vertices};
use crate::asset::codes;
use crate::asset::gltf::layout::{items, natural};
use crate::asset::gltf::uses::index;
use serde_json::{Map, Value};

pub(super) fn check(rules: &mut Rules) {
    let json = rules.json;
    let quantized = extensions::declared(json).contains("KHR_mesh_quantization");
    for (i, mesh) in items(json, "meshes").iter().enumerate() {
        let pointer = format!("/meshes/{i}");
        let used = rules.uses.meshes.contains(&i);
        morphs(rules, mesh, &pointer);
        for (k, primitive) in items(mesh, "primitives").iter().enumerate() {
            let pointer = format!("{pointer}/primitives/{k}");
            vertices::check(rules, primitive, (used, quantized), &pointer);
            looks::variants(rules, primitive, &pointer);
            for (t, target) in items(primitive, "targets").iter().enumerate() {
                let pointer = format!("{pointer}/targets/{t}");
                target_attributes(rules, primitive, target, quantized, &pointer);
            }
        }
    }
}

/// The morph targets of a mesh's first primitive.
pub(super) fn target_count(mesh: &Value) -> usize {
    items(mesh, "primitives")
        .first()
        .map_or(0, |first| items(first, "targets").len())
}

/// All primitives have as many morph targets as the mesh has weights.
fn morphs(rules: &mut Rules, mesh: &Value, pointer: &str) {
    let count = target_count(mesh);
    for (k, primitive) in items(mesh, "primitives").iter().enumerate().skip(1) {
        let other = items(primitive, "targets").len();
        if other != count {
            let place = if primitive.get("targets").is_some() {
                "/targets"
            } else {
                ""
            };
            let says = format!("{other} morph targets, where the first primitive has {count}");
            rules.warn(
                codes::GLTF_MOTION,
                format!("{pointer}/primitives/{k}{place}"),
                says,
            );
        }
    }
    let weights = mesh.get("weights").and_then(Value::as_array);
    if let Some(weights) = weights.filter(|weights| weights.len() != count) {
        let says = format!("{} weights for {count} morph targets", weights.len());
        rules.warn(codes::GLTF_MOTION, format!("{pointer}/weights"), says);
    }
}

fn target_attributes(
    rules: &mut Rules,
    primitive: &Value,
    target: &Value,
    quantized: bool,
    pointer: &str,
) {
    let base = primitive.get("attributes").and_then(Value::as_object);
    for (name, value) in target.as_object().into_iter().flatten() {
        let pointer = step(pointer, name);
        let formats = of_target(name, quantized);
        if formats.is_none() && !name.starts_with('_') {
            let says = format!("a morph target has no attribute {name:?}");
            rules.warn(codes::GLTF_MOTION, &pointer, says);
        }
        let Some((i, accessor)) = vertices::resolved(rules, value) else {
            continue;
        };
        usages::accessor(rules, i, Purpose::Vertices, &pointer);
        vertices::alignment(rules, &accessor, &pointer);
        if let Some(formats) = formats.filter(|formats| !formats.allow(&accessor)) {
            let says = format!(
                "{} cannot be {name}, which is {}",
                accessor.format(),
                formats.names()
            );
            rules.warn(codes::GLTF_MOTION, &pointer, says);
        }
        if name == "POSITION" {
            vertices::bounds(rules, i, &pointer);
        }
        base_of(rules, base, (name, accessor.count), &pointer);
    }
}

/// A target moves attributes that the primitive has, all of them.
fn base_of(
    rules: &mut Rules,
    base: Option<&Map<String, Value>>,
    (name, count): (&str, usize),
    pointer: &str,
) {
    let Some(base) = base.and_then(|base| base.get(name)) else {
        let says = format!("a morph target moves {name:?}, which the primitive does not have");
        return rules.warn(codes::GLTF_MOTION, pointer, says);
    };
    let base = natural(base).and_then(|i| rules.layouts.accessor(i));
    if let Some(there) = base.map(|base| base.count).filter(|&there| there != count) {
        let says = format!("a morph target moves {count} elements of {there}");
        rules.warn(codes::GLTF_MOTION, pointer, says);
    }
}

/// The mesh of a node, where it has one.
pub(super) fn of_node<'a>(json: &'a Value, node: &Value) -> Option<&'a Value> {
    items(json, "meshes").get(index(node, "mesh")?)
}
