//! Rules of skins (specification, section 3.7.3). luxel shows meshes without them: everything is a warning.

use super::Rules;
use super::formats::INVERSE_BIND_MATRICES;
use super::meshes::of_node;
use super::nodes::ancestors;
use super::usages::{self, Purpose};
use crate::asset::codes;
use crate::asset::gltf::layout::{items, natural};
use crate::asset::gltf::uses::{element, index};
use serde_json::Value;
use std::collections::BTreeSet;

pub(super) fn check(rules: &mut Rules, parents: &[Option<usize>]) {
    for (i, skin) in items(rules.json, "skins").iter().enumerate() {
        let pointer = format!("/skins/{i}");
        matrices(rules, skin, &pointer);
        common_root(rules, skin, parents, &pointer);
    }
    for (i, node) in items(rules.json, "nodes").iter().enumerate() {
        let skin = index(node, "skin").and_then(|skin| element(rules.json, "skins", skin));
        if let (Some(skin), Some(mesh)) = (skin, of_node(rules.json, node)) {
            let pointer = format!("/nodes/{i}");
            if !items(mesh, "primitives").iter().any(has_joints) {
                let says = "a skin on a mesh without JOINTS_0";
                rules.warn(codes::GLTF_MOTION, &pointer, says);
            }
            same_scenes(rules, i, skin, parents, &pointer);
        }
    }
}

fn has_joints(primitive: &Value) -> bool {
    primitive.pointer("/attributes/JOINTS_0").is_some()
}

fn joints(skin: &Value) -> impl Iterator<Item = usize> {
    items(skin, "joints").iter().filter_map(natural)
}

fn matrices(rules: &mut Rules, skin: &Value, pointer: &str) {
    let Some(i) = index(skin, "inverseBindMatrices") else {
        return;
    };
    let pointer = format!("{pointer}/inverseBindMatrices");
    usages::accessor(rules, i, Purpose::BindMatrices, &pointer);
    let Some(accessor) = rules.layouts.accessor(i).cloned() else {
        return;
    };
    if !INVERSE_BIND_MATRICES.allow(&accessor) {
        let meant = INVERSE_BIND_MATRICES.names();
        let says = format!(
            "{} cannot be inverse bind matrices, which are {meant}",
            accessor.format()
        );
        rules.warn(codes::GLTF_MOTION, &pointer, says);
    }
    let count = items(skin, "joints").len();
    if accessor.count < count {
        let says = format!(
            "{} inverse bind matrices for {count} joints",
            accessor.count
        );
        rules.warn(codes::GLTF_MOTION, &pointer, says);
    }
}

/// A node and its ancestors.
fn line(parents: &[Option<usize>], node: usize) -> BTreeSet<usize> {
    let mut line = BTreeSet::from([node]);
    line.extend(ancestors(parents, node));
    line
}

/// All joints hang below one node, and below `skeleton` where there is one.
fn common_root(rules: &mut Rules, skin: &Value, parents: &[Option<usize>], pointer: &str) {
    let mut common: Option<BTreeSet<usize>> = None;
    for joint in joints(skin) {
        let line = line(parents, joint);
        common = Some(match common {
            Some(common) => &common & &line,
            None => line,
        });
    }
    let Some(common) = common else { return };
    if common.is_empty() {
        let says = "the joints have no common root";
        rules.warn(codes::GLTF_MOTION, format!("{pointer}/joints"), says);
    }
    if let Some(skeleton) = index(skin, "skeleton")
        && skeleton < parents.len()
        && !common.contains(&skeleton)
    {
        let says = format!("node {skeleton} is not above all joints");
        rules.warn(codes::GLTF_MOTION, format!("{pointer}/skeleton"), says);
    }
}

/// A scene that shows a skinned mesh has its joints too.
fn same_scenes(
    rules: &mut Rules,
    node: usize,
    skin: &Value,
    parents: &[Option<usize>],
    pointer: &str,
) {
    let root = |node| ancestors(parents, node).last().copied().unwrap_or(node);
    let joint_roots: BTreeSet<usize> = joints(skin).map(root).collect();
    let here = root(node);
    for (s, scene) in items(rules.json, "scenes").iter().enumerate() {
        let roots: BTreeSet<usize> = items(scene, "nodes").iter().filter_map(natural).collect();
        if roots.contains(&here) && !joint_roots.is_subset(&roots) {
            let says = format!("scene {s} has this skinned mesh without its joints");
            rules.warn(codes::GLTF_MOTION, pointer, says);
        }
    }
}
