//! Rules of buffers, buffer views and accessors: lengths, strides, alignment (specification, section 3.6).

use super::Rules;
use super::schema::{Kind, Range};
use super::walk::is_of;
use crate::asset::codes;
use crate::asset::gltf::accessor::span;
use crate::asset::gltf::layout::{Accessor, Component, Shape, items, natural};
use crate::asset::gltf::uri;
use crate::asset::gltf::uses::index;
use serde_json::Value;

/// `target` of a view of vertex attributes, and of one of indices.
pub(super) const ARRAY_BUFFER: usize = 34962;
pub(super) const ELEMENT_ARRAY_BUFFER: usize = 34963;

/// Strides that a view may have (section 5.11.5).
const STRIDES: std::ops::RangeInclusive<usize> = 4..=252;

const OF_ACCESSOR: (&str, &str) = (codes::GLTF_ACCESSOR, codes::GLTF_LAYOUT);

pub(super) fn check(rules: &mut Rules) {
    for i in 0..items(rules.json, "buffers").len() {
        buffer(rules, i);
    }
    for i in 0..rules.layouts.views.len() {
        view(rules, i);
    }
    for i in 0..rules.layouts.accessors.len() {
        accessor(rules, i);
    }
}

/// The media type of an embedded buffer (section 3.6.1.1).
fn buffer(rules: &mut Rules, i: usize) {
    const BYTES: [&str; 2] = ["application/octet-stream", "application/gltf-buffer"];
    let pointer = format!("/buffers/{i}/uri");
    let text = rules.json.pointer(&pointer).and_then(Value::as_str);
    let media = text.and_then(uri::media_type);
    if let Some(media) = media.filter(|media| !BYTES.contains(&media.as_str())) {
        let says = format!(
            "the media type of a buffer is {media:?}, not {:?}",
            BYTES[0]
        );
        rules.warn(codes::GLTF_ODD_BUFFER, pointer, says);
    }
}

fn view(rules: &mut Rules, i: usize) {
    let Some(&view) = rules.layouts.view(i) else {
        return;
    };
    let pointer = format!("/bufferViews/{i}");
    let json = &items(rules.json, "bufferViews")[i];
    let buffer = items(rules.json, "buffers").get(view.buffer);
    let there = buffer.and_then(|buffer| index(buffer, "byteLength"));
    let end = view.offset.checked_add(view.len);
    if let Some(there) = there
        && end.is_none_or(|end| end > there)
    {
        let (len, offset, buffer) = (view.len, view.offset, view.buffer);
        let says = format!(
            "{len} bytes from byte {offset} do not fit the {there} bytes of buffer {buffer}"
        );
        let used = rules.uses.views.contains(&i);
        rules.wrong(
            used,
            (codes::GLTF_BUFFER, codes::GLTF_ODD_BUFFER),
            &pointer,
            says,
        );
    }
    let Some(stride) = view.stride else { return };
    let pointer = format!("{pointer}/byteStride");
    if !STRIDES.contains(&stride) || stride % 4 != 0 {
        let says = format!("a byteStride of {stride} is not a multiple of 4 from 4 to 252");
        rules.warn(codes::GLTF_LAYOUT, &pointer, says);
    }
    if stride > view.len {
        let says = format!("a byteStride of {stride} in a view of {} bytes", view.len);
        rules.warn(codes::GLTF_LAYOUT, &pointer, says);
    }
    if index(json, "target") == Some(ELEMENT_ARRAY_BUFFER) {
        let says = "only a view of vertex attributes may have a byteStride";
        rules.warn(codes::GLTF_LAYOUT, &pointer, says);
    }
}

fn accessor(rules: &mut Rules, i: usize) {
    let json = &items(rules.json, "accessors")[i];
    let pointer = format!("/accessors/{i}");
    let Some(accessor) = rules.layouts.accessor(i).cloned() else {
        return unknown_format(rules, i, json, &pointer);
    };
    let (component, shape) = (accessor.component, accessor.shape);
    if accessor.normalized && matches!(component, Component::F32 | Component::U32) {
        let says = format!("{} cannot be normalized", component.name());
        rules.warn(codes::GLTF_LAYOUT, format!("{pointer}/normalized"), says);
    }
    if accessor.view.is_none() && json.get("byteOffset").is_some() {
        let says = "a byteOffset without a bufferView";
        rules.warn(codes::GLTF_LAYOUT, format!("{pointer}/byteOffset"), says);
    }
    if accessor.offset % component.size() != 0 {
        let (offset, size) = (accessor.offset, component.size());
        let says =
            format!("a byteOffset of {offset} is not a multiple of the component's {size} bytes");
        rules.warn(codes::GLTF_LAYOUT, format!("{pointer}/byteOffset"), says);
    }
    if shape.is_matrix() && accessor.offset % 4 != 0 {
        let says = format!(
            "matrices at byte {} are not aligned to 4 bytes",
            accessor.offset
        );
        rules.warn(codes::GLTF_LAYOUT, format!("{pointer}/byteOffset"), says);
    }
    for name in ["min", "max"] {
        bounds(rules, json, name, &accessor, &pointer);
    }
    let used = rules.uses.accessors.contains(&i);
    if let Some(view) = accessor.view {
        let place = (view, accessor.offset);
        let elements = (component, shape, accessor.count);
        fits(rules, used, place, elements, &pointer);
    }
    sparse(rules, used, &accessor, &pointer);
}

/// A `type` or `componentType` that glTF 2.0 does not have: fatal where something needs it.
fn unknown_format(rules: &mut Rules, i: usize, json: &Value, pointer: &str) {
    let known_type = json.get("type").and_then(Value::as_str).and_then(Shape::of);
    let component = index(json, "componentType").map(|code| code as u64);
    let known = known_type.is_some() && component.and_then(Component::of).is_some();
    if rules.uses.accessors.contains(&i) && !known {
        let says = "an accessor of unknown type, which the scene needs";
        rules.report.error(codes::GLTF_ACCESSOR, pointer, says);
    }
}

/// One number for each component (section 3.6.2.5).
fn bounds(rules: &mut Rules, json: &Value, name: &str, accessor: &Accessor, pointer: &str) {
    let width = accessor.shape.width();
    let any = Range {
        least: f64::NEG_INFINITY,
        most: f64::INFINITY,
        above: false,
    };
    if let Some(bound) = json
        .get(name)
        .filter(|bound| is_of(rules.json, bound, &Kind::Numbers(&[], any)))
        && bound.as_array().is_some_and(|all| all.len() != width)
    {
        let len = bound.as_array().map_or(0, Vec::len);
        let says = format!("{len} bounds for {width} components");
        rules.warn(codes::GLTF_BOUNDS, format!("{pointer}/{name}"), says);
    }
}

/// Whether elements fit the view that they are in, and are aligned in it.
fn fits(
    rules: &mut Rules,
    used: bool,
    (view_index, offset): (usize, usize),
    (component, shape, count): (Component, Shape, usize),
    pointer: &str,
) {
    let Some(&view) = rules.layouts.view(view_index) else {
        return;
    };
    let size = shape.size(component);
    if let Some(stride) = view.stride.filter(|&stride| stride < size) {
        let says = format!(
            "elements of {size} bytes do not fit the byteStride {stride} of buffer view {view_index}"
        );
        rules.wrong(used, OF_ACCESSOR, pointer, says);
    }
    let total = offset.saturating_add(view.offset);
    if total % component.size() != 0 {
        let size = component.size();
        let says = format!(
            "starts at byte {total} of its buffer, not a multiple of the component's {size} bytes"
        );
        rules.warn(codes::GLTF_LAYOUT, pointer, says);
    }
    let len = span(count, view.stride.unwrap_or(size), shape.extent(component));
    let end = len.and_then(|len| offset.checked_add(len));
    if end.is_none_or(|end| end > view.len) {
        let says = format!(
            "{count} elements of {size} bytes from byte {offset} do not fit the {} bytes of buffer view {view_index}",
            view.len
        );
        rules.wrong(used, OF_ACCESSOR, pointer, says);
    }
}

/// Rules of sparse elements (section 3.6.2.3).
fn sparse(rules: &mut Rules, used: bool, accessor: &Accessor, pointer: &str) {
    let Some(sparse) = &accessor.sparse else {
        return;
    };
    let pointer = format!("{pointer}/sparse");
    if sparse.count > accessor.count {
        let (count, all) = (sparse.count, accessor.count);
        let says = format!("{count} sparse elements of {all} elements");
        rules.wrong(used, OF_ACCESSOR, format!("{pointer}/count"), says);
    }
    let indices = (sparse.index, Shape::SCALAR, sparse.count);
    let values = (accessor.component, accessor.shape, sparse.count);
    let parts = [
        ("indices", sparse.indices, indices),
        ("values", sparse.values, values),
    ];
    for (name, place, elements) in parts {
        let pointer = format!("{pointer}/{name}");
        fits(rules, used, place, elements, &pointer);
        let size = elements.0.size();
        if place.1 % size != 0 {
            let says = format!(
                "a byteOffset of {} is not a multiple of the component's {size} bytes",
                place.1
            );
            rules.warn(codes::GLTF_LAYOUT, format!("{pointer}/byteOffset"), says);
        }
        let view = items(rules.json, "bufferViews").get(place.0);
        for word in ["byteStride", "target"] {
            if view
                .and_then(|view| view.get(word))
                .and_then(natural)
                .is_some()
            {
                let says = format!(
                    "the buffer view {} of sparse elements has a {word}",
                    place.0
                );
                rules.warn(codes::GLTF_LAYOUT, format!("{pointer}/bufferView"), says);
            }
        }
    }
}
