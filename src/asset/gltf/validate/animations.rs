//! Rules of animations (specification, section 3.11). What breaks them stays at rest: everything is a warning.

use super::Rules;
use super::formats::{KEY_TIMES, of_path};
use super::meshes::{of_node, target_count};
use super::usages::{self, Purpose};
use crate::asset::codes;
use crate::asset::gltf::layout::items;
use crate::asset::gltf::uses::{element, index};
use serde_json::Value;
use std::collections::BTreeMap;

/// Values per key of a cubic spline: the value and two tangents.
const CUBIC: usize = 3;

pub(super) fn check(rules: &mut Rules) {
    // By output accessor: whether a spline uses it.
    let mut outputs = BTreeMap::new();
    for (i, animation) in items(rules.json, "animations").iter().enumerate() {
        let pointer = format!("/animations/{i}");
        for (k, sampler) in items(animation, "samplers").iter().enumerate() {
            let pointer = format!("{pointer}/samplers/{k}");
            times(rules, sampler, &pointer);
            values(rules, sampler, &mut outputs, &pointer);
        }
        let mut targets = BTreeMap::new();
        for (k, channel) in items(animation, "channels").iter().enumerate() {
            let pointer = format!("{pointer}/channels/{k}");
            let Some(target) = channel.get("target") else {
                continue;
            };
            aim(rules, target, &pointer);
            let path = target.get("path").and_then(Value::as_str);
            if let (Some(node), Some(path)) = (index(target, "node"), path)
                && let Some(first) = targets.insert((node, path), k)
            {
                let says = format!("moves the same as channel {first}");
                rules.warn(codes::GLTF_MOTION, format!("{pointer}/target"), says);
            }
            moved(rules, animation, channel, path, (i, k));
        }
    }
}

fn is_cubic(sampler: &Value) -> bool {
    sampler.get("interpolation").and_then(Value::as_str) == Some("CUBICSPLINE")
}

fn times(rules: &mut Rules, sampler: &Value, pointer: &str) {
    let Some(i) = index(sampler, "input") else {
        return;
    };
    let pointer = format!("{pointer}/input");
    usages::accessor(rules, i, Purpose::KeyTimes, &pointer);
    let Some(accessor) = rules.layouts.accessor(i).cloned() else {
        return;
    };
    if !KEY_TIMES.allow(&accessor) {
        let says = format!(
            "{} cannot be key times, which are {}",
            accessor.format(),
            KEY_TIMES.names()
        );
        rules.warn(codes::GLTF_MOTION, &pointer, says);
    }
    let json = element(rules.json, "accessors", i);
    if ["min", "max"]
        .iter()
        .any(|name| json.is_some_and(|json| json.get(name).is_none()))
    {
        let says = format!("accessor {i} of key times has no min and max");
        rules.warn(codes::GLTF_BOUNDS, &pointer, says);
    }
    if is_cubic(sampler) && accessor.count < 2 {
        let says = format!("a spline needs two keys, and has {}", accessor.count);
        rules.warn(codes::GLTF_MOTION, &pointer, says);
    }
}

fn values(rules: &mut Rules, sampler: &Value, outputs: &mut BTreeMap<usize, bool>, pointer: &str) {
    let Some(i) = index(sampler, "output") else {
        return;
    };
    let pointer = format!("{pointer}/output");
    usages::accessor(rules, i, Purpose::KeyValues, &pointer);
    let cubic = is_cubic(sampler);
    if *outputs.entry(i).or_insert(cubic) != cubic {
        let says = format!("accessor {i} serves a spline and another interpolation");
        rules.warn(codes::GLTF_MOTION, pointer, says);
    }
}

/// What a channel moves can be moved.
fn aim(rules: &mut Rules, target: &Value, pointer: &str) {
    let pointer = format!("{pointer}/target");
    let node = index(target, "node").and_then(|node| element(rules.json, "nodes", node));
    let path = target.get("path").and_then(Value::as_str);
    let (Some(node), Some(path)) = (node, path) else {
        return;
    };
    if path == "weights" {
        if of_node(rules.json, node).is_none_or(|mesh| target_count(mesh) == 0) {
            let says = "moves weights of a node without morph targets";
            rules.warn(codes::GLTF_MOTION, pointer, says);
        }
    } else if node.get("matrix").is_some() && path != "pointer" {
        let says = format!("moves the {path} of a node that has a matrix");
        rules.warn(codes::GLTF_MOTION, pointer, says);
    }
}

/// Format and count of the values that a channel reads.
fn moved(
    rules: &mut Rules,
    animation: &Value,
    channel: &Value,
    path: Option<&str>,
    (i, k): (usize, usize),
) {
    let samplers = items(animation, "samplers");
    let Some(at) = index(channel, "sampler") else {
        return;
    };
    let Some(sampler) = samplers.get(at) else {
        let says = format!("{at} is not an index into \"samplers\": there is no such element");
        let pointer = format!("/animations/{i}/channels/{k}/sampler");
        return rules.warn(codes::GLTF_MOTION, pointer, says);
    };
    let accessor = |name| {
        index(sampler, name)
            .and_then(|i| rules.layouts.accessor(i))
            .cloned()
    };
    let (Some(input), Some(output)) = (accessor("input"), accessor("output")) else {
        return;
    };
    let Some(formats) = path.and_then(of_path) else {
        return;
    };
    let pointer = format!("/animations/{i}/samplers/{at}/output");
    if !formats.allow(&output) {
        let path = path.unwrap_or_default();
        let says = format!(
            "{} cannot be {path}, which is {}",
            output.format(),
            formats.names()
        );
        rules.warn(codes::GLTF_MOTION, &pointer, says);
    }
    let node = channel
        .pointer("/target/node")
        .and_then(crate::asset::gltf::layout::natural);
    let mesh = node.and_then(|n| of_node(rules.json, element(rules.json, "nodes", n)?));
    let per_key = match (path, mesh) {
        (Some("weights"), Some(mesh)) => target_count(mesh),
        (Some("weights"), None) => return,
        _ => 1,
    };
    let per_key = per_key * if is_cubic(sampler) { CUBIC } else { 1 };
    let meant = input.count.saturating_mul(per_key);
    if output.count != meant && meant > 0 {
        let says = format!(
            "{} values for {} keys, which need {meant}",
            output.count, input.count
        );
        rules.warn(codes::GLTF_MOTION, pointer, says);
    }
}
