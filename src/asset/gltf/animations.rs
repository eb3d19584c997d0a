//! How nodes move (specification, section 3.11): the first animation, each channel as a [`Curve`].
//!
//! A channel that cannot be read leaves its node at rest, and a warning says so. Deliberately absent: weights of morph
//! targets, pointers, and every animation but the first.

use super::layout::items;
use super::notes::{Notes, Topic};
use super::source::Source;
use super::uses::index;
use crate::asset::{Curve, Interpolation, Motion, codes};
use serde_json::Value;
use std::collections::BTreeMap;

/// What a scale of 0 counts as, which has no way back.
const THINNEST: f64 = 1e-6;

const UNREADABLE: Topic = Topic {
    code: codes::GLTF_AT_REST,
    says: "channels of the animation cannot be read, and what they move is at rest",
    hint: "export the file again",
};

const FURTHER: Topic = Topic {
    code: codes::GLTF_AT_REST,
    says: "animations beside the first are left out",
    hint: "export the one that is wanted alone",
};

/// The motion of every node that moves, by its index.
pub(super) fn motions(source: &Source, notes: &mut Notes) -> BTreeMap<usize, Motion> {
    let animations = items(&source.json, "animations");
    let further = animations.len().saturating_sub(1);
    notes.add_many(&FURTHER, further, "/animations/1");
    let mut motions: BTreeMap<usize, Motion> = BTreeMap::new();
    let Some(animation) = animations.first() else {
        return motions;
    };
    let samplers = items(animation, "samplers");
    for (k, channel) in items(animation, "channels").iter().enumerate() {
        let target = channel.get("target").unwrap_or(&Value::Null);
        let path = target.get("path").and_then(Value::as_str);
        let (Some(node), Some(path @ ("translation" | "rotation" | "scale"))) =
            (index(target, "node"), path)
        else {
            continue;
        };
        let matrix = items(&source.json, "nodes")
            .get(node)
            .and_then(|n| n.get("matrix"));
        let sampler = index(channel, "sampler").and_then(|i| samplers.get(i));
        let curve = sampler
            .filter(|_| matrix.is_none())
            .and_then(|sampler| curve(source, sampler, path));
        let Some(curve) = curve else {
            notes.add(&UNREADABLE, format!("/animations/0/channels/{k}"));
            continue;
        };
        let motion = motions.entry(node).or_default();
        let part = match path {
            "translation" => &mut motion.translate,
            "rotation" => &mut motion.rotate,
            _ => &mut motion.scale,
        };
        // Of two that move the same, the first counts.
        part.get_or_insert(curve);
    }
    motions
}

/// A sampler, if it is whole: times that rise, and as many values of the right kind.
fn curve(source: &Source, sampler: &Value, path: &str) -> Option<Curve> {
    let interpolation = match sampler.get("interpolation").and_then(Value::as_str) {
        None | Some("LINEAR") => Interpolation::Linear,
        Some("STEP") => Interpolation::Step,
        Some("CUBICSPLINE") => Interpolation::Spline,
        Some(_) => return None,
    };
    let input = source.numbers(index(sampler, "input")?).ok()?;
    let output = source.numbers(index(sampler, "output")?).ok()?;
    let times = input.components;
    let rises = times.windows(2).all(|two| two[0] < two[1]);
    let finite = |numbers: &[f64]| numbers.iter().all(|x| x.is_finite());
    let width = if path == "rotation" { 4 } else { 3 };
    let per_key = match interpolation {
        Interpolation::Spline => 3,
        _ => 1,
    };
    let count = times.len() * per_key * width;
    if input.width != 1
        || output.width != width
        || times.is_empty()
        || output.components.len() != count
        || !rises
        || !finite(&times)
        || !finite(&output.components)
    {
        return None;
    }
    let mut elements = output.components.chunks_exact(width).map(|element| {
        let mut four = [0.0; 4];
        four[..width].copy_from_slice(element);
        four
    });
    let mut curve = Curve {
        times,
        interpolation,
        ..Curve::default()
    };
    for _ in 0..curve.times.len() {
        let into = (per_key == 3).then(|| elements.next()).flatten();
        let mut value = elements.next()?;
        let out = (per_key == 3).then(|| elements.next()).flatten();
        match path {
            "scale" => value = value.map(|s| if s == 0.0 { THINNEST } else { s }),
            "rotation" if value == [0.0; 4] => value[3] = 1.0,
            _ => {}
        }
        curve.values.push(value);
        curve.tangents.extend(into.zip(out).map(|(a, b)| [a, b]));
    }
    Some(curve)
}
