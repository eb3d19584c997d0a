//! Rules of nodes and scenes: a forest of transforms (specification, sections 3.5 and 5.25).

use super::Rules;
use super::meshes::{of_node, target_count};
use crate::asset::codes;
use crate::asset::gltf::layout::{items, natural};
use serde_json::Value;
use std::collections::BTreeSet;

const OF_NODES: (&str, &str) = (codes::GLTF_NODES, codes::GLTF_ODD_NODES);

/// How far a rotation's length may be from 1: what is left of a unit quaternion of f32 written with few digits.
const UNIT: f64 = 5e-3;

/// Checks nodes and scenes, and gives the parent of each node.
pub(super) fn check(rules: &mut Rules) -> Vec<Option<usize>> {
    let json = rules.json;
    let nodes = items(json, "nodes");
    let parents = parents(rules, nodes);
    cycles(rules, &parents);
    for (i, node) in nodes.iter().enumerate() {
        let pointer = format!("/nodes/{i}");
        let used = rules.uses.nodes.contains(&i);
        transform(rules, used, node, &pointer);
        needs_mesh(rules, node, &pointer);
    }
    for (s, scene) in items(json, "scenes").iter().enumerate() {
        for (k, node) in items(scene, "nodes").iter().enumerate() {
            let parent = natural(node).and_then(|i| *parents.get(i)?);
            if let Some(parent) = parent {
                let used = rules.uses.nodes.contains(&parent);
                let says = format!("node {node} is no root: it is a child of node {parent}");
                rules.wrong(used, OF_NODES, format!("/scenes/{s}/nodes/{k}"), says);
            }
        }
    }
    parents
}

/// The parent of each node; a second one is reported.
fn parents(rules: &mut Rules, nodes: &[Value]) -> Vec<Option<usize>> {
    let mut parents = vec![None; nodes.len()];
    for (i, node) in nodes.iter().enumerate() {
        for (k, child) in items(node, "children").iter().enumerate() {
            let Some(child) = natural(child) else {
                continue;
            };
            match parents.get_mut(child) {
                Some(Some(first)) if *first != i => {
                    let says = format!("node {child} is a child of node {first} and of node {i}");
                    let used = rules.uses.nodes.contains(&child);
                    rules.wrong(used, OF_NODES, format!("/nodes/{i}/children/{k}"), says);
                }
                Some(free @ None) => *free = Some(i),
                _ => {}
            }
        }
    }
    parents
}

/// Nodes that are their own ancestors, each circle once.
fn cycles(rules: &mut Rules, parents: &[Option<usize>]) {
    let mut done = BTreeSet::new();
    for start in 0..parents.len() {
        let mut path = BTreeSet::new();
        let mut at = Some(start);
        while let Some(node) = at.filter(|node| !done.contains(node)) {
            if !path.insert(node) {
                // A circle hangs below no root: it is used only where there is no tree at all.
                let used = rules.uses.nodes.contains(&node);
                let says = format!("node {node} is its own ancestor");
                rules.wrong(used, OF_NODES, format!("/nodes/{node}"), says);
                break;
            }
            at = parents.get(node).copied().flatten();
        }
        done.extend(path);
    }
}

fn transform(rules: &mut Rules, used: bool, node: &Value, pointer: &str) {
    let parts = ["translation", "rotation", "scale"];
    if let Some(matrix) = numbers(node, "matrix", 16) {
        let pointer = format!("{pointer}/matrix");
        if parts.iter().any(|part| node.get(part).is_some()) {
            let says = "a matrix beside translation, rotation or scale: which of them counts is not defined";
            rules.wrong(used, OF_NODES, &pointer, says);
        }
        if !is_affine_product(&matrix) {
            let says = "the matrix is not a product of translation, rotation and scale";
            rules.warn(codes::GLTF_ODD_NODES, &pointer, says);
        }
    }
    if let Some(rotation) = numbers(node, "rotation", 4) {
        let length = rotation.iter().map(|x| x * x).sum::<f64>().sqrt();
        let pointer = format!("{pointer}/rotation");
        if length == 0.0 {
            rules.wrong(used, OF_NODES, pointer, "the rotation has no length");
        } else if (length - 1.0).abs() > UNIT {
            let says = format!("the rotation has the length {length:.6}, not 1");
            rules.warn(codes::GLTF_ODD_NODES, pointer, says);
        }
    }
}

/// An array of this many numbers.
fn numbers(object: &Value, name: &str, len: usize) -> Option<Vec<f64>> {
    let all = object.get(name)?.as_array()?.iter().map(Value::as_f64);
    all.collect::<Option<Vec<f64>>>()
        .filter(|all| all.len() == len)
}

/// Whether a matrix in columns ends in the row 0 0 0 1 and has orthogonal columns, none without length.
fn is_affine_product(m: &[f64]) -> bool {
    /// Cosine that still counts as a right angle: matrices are written with few digits.
    const RIGHT_ANGLE: f64 = 5e-3;
    let [x, y, z, t] = [0, 4, 8, 12].map(|at| &m[at..at + 4]);
    let last_row = x[3] == 0.0 && y[3] == 0.0 && z[3] == 0.0 && t[3] == 1.0;
    let dot = |a: &[f64], b: &[f64]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let right = |a: &[f64], b: &[f64]| {
        let lengths = (dot(a, a) * dot(b, b)).sqrt();
        lengths > 0.0 && dot(a, b).abs() <= RIGHT_ANGLE * lengths
    };
    last_row && right(x, y) && right(y, z) && right(z, x)
}

/// Weights and skins are of the node's mesh.
fn needs_mesh(rules: &mut Rules, node: &Value, pointer: &str) {
    for name in ["weights", "skin"] {
        if node.get(name).is_some() && node.get("mesh").is_none() {
            let says = format!("{name:?} without a mesh");
            rules.warn(codes::GLTF_MOTION, format!("{pointer}/{name}"), says);
        }
    }
    let weights = node.get("weights").and_then(Value::as_array);
    if let (Some(weights), Some(mesh)) = (weights, of_node(rules.json, node)) {
        let count = target_count(mesh);
        if weights.len() != count {
            let says = format!("{} weights for {count} morph targets", weights.len());
            rules.warn(codes::GLTF_MOTION, format!("{pointer}/weights"), says);
        }
    }
}

/// The ancestors of a node, nearest first, itself left out; ends where they repeat.
pub(super) fn ancestors(parents: &[Option<usize>], node: usize) -> Vec<usize> {
    let mut seen = BTreeSet::from([node]);
    let mut path = Vec::new();
    let mut at = node;
    while let Some(parent) = parents
        .get(at)
        .copied()
        .flatten()
        .filter(|&p| seen.insert(p))
    {
        path.push(parent);
        at = parent;
    }
    path
}

/// The root above each node; for one that hangs from a circle, some node of it.
pub(super) fn roots(parents: &[Option<usize>]) -> Vec<usize> {
    let mut roots: Vec<Option<usize>> = vec![None; parents.len()];
    for start in 0..parents.len() {
        let mut path = Vec::new();
        let mut at = start;
        let root = loop {
            if let Some(known) = roots[at] {
                break known;
            }
            // Taken back below; ends the climb where it meets itself.
            roots[at] = Some(at);
            path.push(at);
            match parents[at] {
                Some(parent) if parent < parents.len() => at = parent,
                _ => break at,
            }
        };
        for node in path {
            roots[node] = Some(root);
        }
    }
    roots.into_iter().flatten().collect()
}
