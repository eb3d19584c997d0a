//! Rules of what the bytes of skins and animations hold (specification, sections 3.7.3 and 3.11). luxel reads neither:
//! everything is a warning.

use super::Rules;
use super::elements::Data;
use crate::asset::codes;
use crate::asset::gltf::accessor::Elements;
use crate::asset::gltf::layout::items;
use crate::asset::gltf::uses::index;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// How far the length of a key's quaternion may be from 1.
const UNIT: f64 = 5e-3;

/// How far a sum of weights may be from 1, for each weight.
const WEIGHT: f64 = 2e-7;

/// What the last row of an affine matrix holds, at these components of its columns.
const LAST_ROW: [(usize, f64); 4] = [(3, 0.0), (7, 0.0), (11, 0.0), (15, 1.0)];

pub(super) fn check(rules: &mut Rules, data: &mut Data) {
    for (i, skin) in items(rules.json, "skins").iter().enumerate() {
        let elements =
            index(skin, "inverseBindMatrices").and_then(|m| data.numbers(rules, m, false));
        if let Some(elements) = elements.filter(|elements| elements.width == 16) {
            matrices(rules, &elements, &format!("/skins/{i}/inverseBindMatrices"));
        }
    }
    let mut seen = BTreeSet::new();
    for (i, animation) in items(rules.json, "animations").iter().enumerate() {
        for (k, sampler) in items(animation, "samplers").iter().enumerate() {
            let input = index(sampler, "input").filter(|input| seen.insert(*input));
            if let Some(elements) = input.and_then(|input| data.numbers(rules, input, false)) {
                times(
                    rules,
                    &elements,
                    &format!("/animations/{i}/samplers/{k}/input"),
                );
            }
        }
        for (k, channel) in items(animation, "channels").iter().enumerate() {
            let pointer = format!("/animations/{i}/channels/{k}/sampler");
            rotations(rules, data, animation, channel, &pointer);
        }
    }
    let joints = joint_counts(rules.json);
    for (m, mesh) in items(rules.json, "meshes").iter().enumerate() {
        let joints = joints.get(&m).copied();
        for (p, primitive) in items(mesh, "primitives").iter().enumerate() {
            let pointer = format!("/meshes/{m}/primitives/{p}/attributes");
            skinning(rules, data, primitive, joints, &pointer);
        }
    }
}

fn matrices(rules: &mut Rules, elements: &Elements, pointer: &str) {
    for (k, matrix) in elements.components.chunks_exact(16).enumerate() {
        for (at, meant) in LAST_ROW {
            if matrix[at] != meant {
                let says = format!(
                    "component {at} of matrix {k} is {}, not {meant}",
                    matrix[at]
                );
                rules.warn(codes::GLTF_MOTION, pointer, says);
            }
        }
    }
}

/// Key times are not negative, and rise.
fn times(rules: &mut Rules, elements: &Elements, pointer: &str) {
    let times = &elements.components;
    if let Some(k) = times.iter().position(|&time| time < 0.0) {
        let says = format!("key {k} is at the negative time {}", times[k]);
        rules.warn(codes::GLTF_MOTION, pointer, says);
    }
    if let Some(k) = times.windows(2).position(|pair| pair[0] >= pair[1]) {
        let says = format!(
            "key {} is at {}, not after {}",
            k + 1,
            times[k + 1],
            times[k]
        );
        rules.warn(codes::GLTF_MOTION, pointer, says);
    }
}

/// Keys of rotations are unit quaternions; the tangents of splines are not.
fn rotations(
    rules: &mut Rules,
    data: &mut Data,
    animation: &Value,
    channel: &Value,
    pointer: &str,
) {
    if channel.pointer("/target/path").and_then(Value::as_str) != Some("rotation") {
        return;
    }
    let sampler = index(channel, "sampler").and_then(|at| items(animation, "samplers").get(at));
    let output = sampler.and_then(|sampler| index(sampler, "output"));
    let Some(elements) = output.and_then(|output| data.numbers(rules, output, false)) else {
        return;
    };
    let spline = sampler.and_then(|s| s.get("interpolation")?.as_str()) == Some("CUBICSPLINE");
    let (skip, step) = if spline { (1, 3) } else { (0, 1) };
    if elements.width != 4 {
        return;
    }
    for (k, q) in elements
        .components
        .chunks_exact(4)
        .enumerate()
        .skip(skip)
        .step_by(step)
    {
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length.is_finite() && (length - 1.0).abs() > UNIT {
            let says = format!("rotation {k} has the length {length}, not 1");
            rules.warn(codes::GLTF_MOTION, pointer, says);
        }
    }
}

/// Joints of the smallest skin that a node puts on a mesh, by mesh.
fn joint_counts(json: &Value) -> BTreeMap<usize, usize> {
    let mut counts = BTreeMap::new();
    for node in items(json, "nodes") {
        let skin = index(node, "skin").and_then(|skin| items(json, "skins").get(skin));
        if let (Some(mesh), Some(skin)) = (index(node, "mesh"), skin) {
            let count = items(skin, "joints").len();
            let least = counts.entry(mesh).or_insert(count);
            *least = count.min(*least);
        }
    }
    counts
}

/// Weights are not negative and sum to 1; joints are there, and each once for a vertex.
fn skinning(
    rules: &mut Rules,
    data: &mut Data,
    primitive: &Value,
    count: Option<usize>,
    pointer: &str,
) {
    let attributes = primitive.get("attributes");
    let mut read = |stem: &str| -> Vec<Elements> {
        let name = |set: usize| index(attributes?, &format!("{stem}_{set}"));
        let sets = (0..).map_while(name);
        let sets = sets.map_while(|i| data.numbers(rules, i, false));
        sets.filter(|elements| elements.width == 4).collect()
    };
    let (joints, weights) = (read("JOINTS"), read("WEIGHTS"));
    let vertices = joints
        .iter()
        .chain(&weights)
        .map(|e| e.components.len() / 4)
        .min();
    let row = |sets: &[Elements], v: usize| -> Vec<f64> {
        sets.iter()
            .flat_map(|set| set.components[4 * v..4 * v + 4].to_vec())
            .collect()
    };
    for v in 0..vertices.unwrap_or(0) {
        let (joints, weights) = (row(&joints, v), row(&weights, v));
        vertex(rules, v, (&joints, &weights), count, pointer);
    }
}

fn vertex(
    rules: &mut Rules,
    v: usize,
    (joints, weights): (&[f64], &[f64]),
    count: Option<usize>,
    pointer: &str,
) {
    if let Some(weight) = weights.iter().find(|&&weight| weight < 0.0) {
        let says = format!("vertex {v} has the negative weight {weight}");
        rules.warn(codes::GLTF_MOTION, format!("{pointer}/WEIGHTS_0"), says);
    }
    let sum: f64 = weights.iter().sum();
    let some = weights.iter().filter(|&&weight| weight != 0.0).count();
    if !weights.is_empty() && (sum - 1.0).abs() > WEIGHT * some.max(1) as f64 {
        let says = format!("the weights of vertex {v} sum to {sum}, not 1");
        rules.warn(codes::GLTF_MOTION, format!("{pointer}/WEIGHTS_0"), says);
    }
    let mut seen = Vec::new();
    for (&joint, weight) in joints
        .iter()
        .zip(weights.iter().chain(std::iter::repeat(&1.0)))
    {
        let pointer = format!("{pointer}/JOINTS_0");
        if count.is_some_and(|count| joint >= count as f64) {
            let says = format!("vertex {v} names joint {joint}, which its skin does not have");
            rules.warn(codes::GLTF_MOTION, &pointer, says);
        }
        if *weight != 0.0 && seen.contains(&joint) {
            let says = format!("vertex {v} names joint {joint} twice");
            rules.warn(codes::GLTF_MOTION, pointer, says);
        }
        if *weight != 0.0 {
            seen.push(joint);
        }
    }
}
