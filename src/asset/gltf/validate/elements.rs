//! Rules of what the bytes hold: bounds, numbers, unit vectors, indices (specification, sections 3.6.2.5, 3.7 and 3.11).
//!
//! Buffers that were not read are not looked at.

use super::Rules;
use super::formats::semantic;
use super::vertices::resolved;
use super::walk::step;
use crate::asset::codes;
use crate::asset::gltf::accessor::{self, Elements};
use crate::asset::gltf::buffers::Buffers;
use crate::asset::gltf::layout::{Accessor, Component, items};
use crate::asset::gltf::uses::{element, index};
use serde_json::Value;
use std::collections::BTreeSet;

/// Components that are looked at for each byte of the file's buffers: accessors may overlap, and a small file must not
/// make much work.
const COMPONENTS_PER_BYTE: usize = 4;

/// How far the length of a unit vector may be from 1: stored as float, and as integers.
const UNIT: (f64, f64) = (5e-4, 1e-2);

/// The elements of accessors, as long as the budget lasts.
pub(super) struct Data<'a> {
    buffers: &'a Buffers,
    budget: usize,
}

impl Data<'_> {
    /// Elements as numbers; `None` where they are not there, or too many.
    pub(super) fn numbers(&mut self, rules: &Rules, i: usize, stored: bool) -> Option<Elements> {
        let layout = rules.layouts.accessor(i)?;
        let size = layout.count.checked_mul(layout.shape.width())?;
        self.budget = self.budget.checked_sub(size)?;
        let read = if stored {
            accessor::stored
        } else {
            accessor::numbers
        };
        read(rules.layouts, self.buffers, i).ok()
    }
}

/// Checks the elements of every accessor whose bytes were read.
pub(in crate::asset::gltf) fn check(rules: &mut Rules, buffers: &Buffers) {
    let budget = buffers.total().saturating_mul(COMPONENTS_PER_BYTE);
    let mut data = Data { buffers, budget };
    let positions = positions(rules);
    for i in 0..rules.layouts.accessors.len() {
        sparse_order(rules, buffers, i);
        let has_bytes = rules
            .layouts
            .accessor(i)
            .is_some_and(|a| a.views().next().is_some());
        if let Some(elements) = has_bytes.then(|| data.numbers(rules, i, true)).flatten() {
            let pointer = format!("/accessors/{i}");
            finite(rules, positions.contains(&i), &elements, &pointer);
            bounds(rules, i, &elements, &pointer);
        }
    }
    let mut seen = BTreeSet::new();
    for (m, mesh) in items(rules.json, "meshes").iter().enumerate() {
        for (p, primitive) in items(mesh, "primitives").iter().enumerate() {
            let pointer = format!("/meshes/{m}/primitives/{p}");
            let used = rules.uses.meshes.contains(&m);
            attributes(rules, &mut data, primitive, (used, &mut seen), &pointer);
            indices(rules, &mut data, primitive, (m, &mut seen), &pointer);
        }
    }
    super::motion::check(rules, &mut data);
}

/// The accessors of positions of used meshes.
fn positions(rules: &Rules) -> BTreeSet<usize> {
    let meshes = rules.uses.meshes.iter();
    let meshes = meshes.filter_map(|&mesh| element(rules.json, "meshes", mesh));
    let primitives = meshes.flat_map(|mesh| items(mesh, "primitives"));
    primitives
        .filter_map(|p| index(p.get("attributes")?, "POSITION"))
        .collect()
}

/// Sparse indices rise, and stay below the count.
fn sparse_order(rules: &mut Rules, buffers: &Buffers, i: usize) {
    let Some(layout) = rules.layouts.accessor(i) else {
        return;
    };
    let Some(places) = accessor::sparse_places(rules.layouts, buffers, i) else {
        return;
    };
    let count = layout.count;
    let pointer = format!("/accessors/{i}/sparse");
    if let Some(beyond) = places.iter().find(|&&place| place as usize >= count) {
        let used = rules.uses.accessors.contains(&i);
        let says = format!("sparse index {beyond} of {count} elements");
        rules.wrong(
            used,
            (codes::GLTF_ACCESSOR, codes::GLTF_ELEMENTS),
            &pointer,
            says,
        );
    }
    if let Some(k) = places.windows(2).position(|pair| pair[0] >= pair[1]) {
        let says = format!(
            "sparse index {} follows {}: they must rise",
            places[k + 1],
            places[k]
        );
        rules.warn(codes::GLTF_ELEMENTS, pointer, says);
    }
}

fn finite(rules: &mut Rules, needed: bool, elements: &Elements, pointer: &str) {
    let bad = |x: &&f64| !x.is_finite();
    let count = elements.components.iter().filter(bad).count();
    let Some(first) = elements.components.iter().position(|x| !x.is_finite()) else {
        return;
    };
    let element = first / elements.width;
    let says = format!("{count} components are not finite, the first in element {element}");
    rules.wrong(
        needed,
        (codes::GLTF_PRIMITIVE, codes::GLTF_ELEMENTS),
        pointer,
        says,
    );
}

/// `min` and `max` are those of the elements as stored (section 3.6.2.5).
fn bounds(rules: &mut Rules, i: usize, elements: &Elements, pointer: &str) {
    let json = element(rules.json, "accessors", i);
    let layout = rules.layouts.accessor(i);
    let is_float = layout.is_some_and(|layout| layout.component == Component::F32);
    // As f32, as the elements are, however many digits were written.
    let rounded = |x: f64| if is_float { f64::from(x as f32) } else { x };
    for (name, least) in [("min", true), ("max", false)] {
        let declared = json
            .and_then(|json| json.get(name))
            .and_then(Value::as_array);
        let Some(declared) = declared.filter(|all| all.len() == elements.width) else {
            continue;
        };
        for (k, bound) in declared.iter().enumerate() {
            let Some(bound) = bound.as_f64() else {
                continue;
            };
            let all = elements.components.iter().skip(k).step_by(elements.width);
            let there = all.copied().filter(|x| x.is_finite());
            let there = there.reduce(|a, b| if (a < b) == least { a } else { b });
            if let Some(there) = there.filter(|&there| there != rounded(bound)) {
                let says = format!("{name} is declared {bound}, and is {there}");
                rules.warn(codes::GLTF_BOUNDS, format!("{pointer}/{name}/{k}"), says);
            }
        }
    }
}

/// Unit vectors and colours.
fn attributes(
    rules: &mut Rules,
    data: &mut Data,
    primitive: &Value,
    (used, seen): (bool, &mut BTreeSet<(usize, usize)>),
    pointer: &str,
) {
    let attributes = primitive.get("attributes").and_then(Value::as_object);
    for (name, value) in attributes.into_iter().flatten() {
        let known = semantic(name).filter(|known| matches!(*known, "NORMAL" | "TANGENT" | "COLOR"));
        let (Some(known), Some((i, layout))) = (known, resolved(rules, value)) else {
            continue;
        };
        // The third letter tells the three apart.
        if !seen.insert((i, usize::MAX - usize::from(known.as_bytes()[2]))) {
            continue;
        }
        let Some(elements) = data.numbers(rules, i, false) else {
            continue;
        };
        let pointer = step(&format!("{pointer}/attributes"), name);
        match known {
            "COLOR" => colours(rules, &elements, &pointer),
            // Where a used normal is zero, the reader says what it does about it.
            "NORMAL" if used => unit(rules, &layout, &elements, (f64::MIN_POSITIVE, &pointer)),
            _ => unit(rules, &layout, &elements, (0.0, &pointer)),
        }
    }
}

/// Vectors shorter than `least` are not told of.
fn unit(rules: &mut Rules, layout: &Accessor, elements: &Elements, (least, pointer): (f64, &str)) {
    let near = if layout.component == Component::F32 {
        UNIT.0
    } else {
        UNIT.1
    };
    if elements.width < 3 {
        return;
    }
    let (mut count, mut first) = (0, None);
    for (k, v) in elements.components.chunks_exact(elements.width).enumerate() {
        let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        if length.is_finite() && length >= least && (length - 1.0).abs() > near {
            count += 1;
            first.get_or_insert((k, length));
        }
        if let Some(sign) = v.get(3).filter(|sign| sign.abs() != 1.0) {
            count += 1;
            first.get_or_insert((k, *sign));
        }
    }
    if let Some((k, value)) = first {
        let says = format!(
            "{count} vectors are not of unit length or have no sign, the first is element {k}: {value}"
        );
        rules.warn(codes::GLTF_ELEMENTS, pointer, says);
    }
}

fn colours(rules: &mut Rules, elements: &Elements, pointer: &str) {
    let outside = |x: &&f64| !(0.0..=1.0).contains(*x);
    let count = elements.components.iter().filter(outside).count();
    let first = elements.components.iter().find(outside);
    if let Some(first) = first {
        let says =
            format!("{count} components of colours are outside 0 to 1, the first is {first}");
        rules.warn(codes::GLTF_ELEMENTS, pointer, says);
    }
}

/// Indices name vertices, and not the largest value, which restarts a primitive (section 3.7.2.1).
fn indices(
    rules: &mut Rules,
    data: &mut Data,
    primitive: &Value,
    (mesh, seen): (usize, &mut BTreeSet<(usize, usize)>),
    pointer: &str,
) {
    let attributes = primitive.get("attributes").and_then(Value::as_object);
    let position = attributes.and_then(|all| all.get("POSITION").or(all.values().next()));
    let vertices = position
        .and_then(|value| resolved(rules, value))
        .map(|(_, a)| a.count);
    let at = primitive
        .get("indices")
        .and_then(|value| resolved(rules, value));
    let (Some(vertices), Some((i, layout))) = (vertices, at) else {
        return;
    };
    let restart = match layout.component {
        Component::U8 => f64::from(u8::MAX),
        Component::U16 => f64::from(u16::MAX),
        Component::U32 => f64::from(u32::MAX),
        _ => return,
    };
    if !seen.insert((i, vertices)) {
        return;
    }
    let Some(elements) = data.numbers(rules, i, true) else {
        return;
    };
    let of = (codes::GLTF_PRIMITIVE, codes::GLTF_ELEMENTS);
    let used = rules.uses.meshes.contains(&mesh);
    let pointer = format!("{pointer}/indices");
    if let Some(k) = elements.components.iter().position(|&x| x == restart) {
        let says = format!("index {k} is {restart}, which would restart the primitive");
        return rules.wrong(used, of, pointer, says);
    }
    let beyond = |x: &&f64| **x >= vertices as f64;
    let count = elements.components.iter().filter(beyond).count();
    if let Some(k) = elements.components.iter().position(|x| beyond(&x)) {
        let value = elements.components[k];
        let says = format!(
            "{count} indices name no vertex of {vertices}, the first is index {k}: {value}"
        );
        rules.wrong(used, of, pointer, says);
    }
}
