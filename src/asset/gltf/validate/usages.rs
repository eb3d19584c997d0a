//! Buffer views and accessors may serve one purpose only (specification, sections 3.6.2.1 and 3.6.2.4).

use super::Rules;
use super::accessors::{ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER};
use crate::asset::codes;
use crate::asset::gltf::uses::{element, index};
use std::collections::BTreeMap;

/// What something is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    Vertices,
    Indices,
    BindMatrices,
    KeyTimes,
    KeyValues,
    Image,
}

impl Purpose {
    fn name(self) -> &'static str {
        match self {
            Purpose::Vertices => "vertex attributes",
            Purpose::Indices => "indices",
            Purpose::BindMatrices => "inverse bind matrices",
            Purpose::KeyTimes => "key times",
            Purpose::KeyValues => "key values",
            Purpose::Image => "an image",
        }
    }

    /// The purpose of a buffer view: key times and values may share one.
    fn of_view(self) -> Purpose {
        if self == Purpose::KeyValues {
            Purpose::KeyTimes
        } else {
            self
        }
    }
}

/// First purposes, by index.
#[derive(Debug, Default)]
pub(in crate::asset::gltf) struct Usages {
    accessors: BTreeMap<usize, Purpose>,
    views: BTreeMap<usize, Purpose>,
    /// The first accessor of vertices of each view.
    vertices: BTreeMap<usize, usize>,
}

/// Notes that the thing at `pointer` uses an accessor, and reports what contradicts earlier uses.
pub(super) fn accessor(rules: &mut Rules, accessor: usize, purpose: Purpose, pointer: &str) {
    let first = *rules.usages.accessors.entry(accessor).or_insert(purpose);
    if first != purpose {
        let (first, now) = (first.name(), purpose.name());
        let says = format!("accessor {accessor} serves for {first} and for {now}");
        rules.warn(codes::GLTF_LAYOUT, pointer, says);
    }
    let Some(view_index) = rules.layouts.accessor(accessor).and_then(|a| a.view) else {
        return;
    };
    view(rules, view_index, purpose, pointer);
    let stride = rules.layouts.view(view_index).and_then(|view| view.stride);
    if purpose == Purpose::Vertices {
        let first = *rules.usages.vertices.entry(view_index).or_insert(accessor);
        if first != accessor && stride.is_none() {
            let says = format!(
                "buffer view {view_index} holds two vertex attributes, and has no byteStride"
            );
            rules.warn(codes::GLTF_LAYOUT, pointer, says);
        }
    } else if stride.is_some() {
        strided(rules, view_index, purpose, pointer);
    }
}

/// Notes that the thing at `pointer` uses a buffer view.
pub(super) fn view(rules: &mut Rules, view_index: usize, purpose: Purpose, pointer: &str) {
    let purpose = purpose.of_view();
    let target =
        element(rules.json, "bufferViews", view_index).and_then(|view| index(view, "target"));
    let by_target = match target {
        Some(ARRAY_BUFFER) => Some(Purpose::Vertices),
        Some(ELEMENT_ARRAY_BUFFER) => Some(Purpose::Indices),
        _ => None,
    };
    let first = *rules
        .usages
        .views
        .entry(view_index)
        .or_insert(by_target.unwrap_or(purpose));
    if first != purpose {
        let (first, now) = (first.name(), purpose.name());
        let says = format!("buffer view {view_index} is for {first}, and serves for {now}");
        rules.warn(codes::GLTF_LAYOUT, pointer, says);
    }
}

/// A byteStride where the format allows none.
pub(super) fn strided(rules: &mut Rules, view_index: usize, purpose: Purpose, pointer: &str) {
    let says = format!(
        "buffer view {view_index} has a byteStride, and serves for {}",
        purpose.name()
    );
    rules.warn(codes::GLTF_LAYOUT, pointer, says);
}
