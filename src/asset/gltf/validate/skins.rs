//! Rules of skins (specification, section 3.7.3). luxel shows meshes without them: everything is a warning.

use super::Rules;
use super::formats::INVERSE_BIND_MATRICES;
use super::meshes::of_node;
use super::nodes::{ancestors, roots};
use super::usages::{self, Purpose};
use crate::asset::codes;
use crate::asset::gltf::layout::{items, natural};
use crate::asset::gltf::uses::index;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

pub(super) fn check(rules: &mut Rules, parents: &[Option<usize>]) {
    let roots = roots(parents);
    let skins = items(rules.json, "skins");
    for (i, skin) in skins.iter().enumerate() {
        let pointer = format!("/skins/{i}");
        matrices(rules, skin, &pointer);
        common_root(rules, skin, parents, &pointer);
    }
    let joint_roots = |skin| {
        joints(skin)
            .filter_map(|joint| roots.get(joint).copied())
            .collect()
    };
    let joint_roots: Vec<BTreeSet<usize>> = skins.iter().map(joint_roots).collect();
    let scenes = items(rules.json, "scenes").iter();
    let scene_roots = |scene| items(scene, "nodes").iter().filter_map(natural).collect();
    let scene_roots: Vec<BTreeSet<usize>> = scenes.map(scene_roots).collect();
    // Whether a scene has the joints of a skin, by both.
    let mut complete = BTreeMap::new();
    for (i, node) in items(rules.json, "nodes").iter().enumerate() {
        let Some(skin) = index(node, "skin").filter(|&skin| skin < skins.len()) else {
            continue;
        };
        let Some(mesh) = of_node(rules.json, node) else {
            continue;
        };
        let pointer = format!("/nodes/{i}");
        if !items(mesh, "primitives").iter().any(has_joints) {
            let says = "a skin on a mesh without JOINTS_0";
            rules.warn(codes::GLTF_MOTION, &pointer, says);
        }
        for (s, scene) in scene_roots
            .iter()
            .enumerate()
            .filter(|(_, all)| all.contains(&roots[i]))
        {
            let complete = complete.entry((skin, s));
            if !*complete.or_insert_with(|| joint_roots[skin].is_subset(scene)) {
                let says = format!("scene {s} has this skinned mesh without its joints");
                rules.warn(codes::GLTF_MOTION, &pointer, says);
            }
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

/// All joints hang below one node, and below `skeleton` where there is one.
fn common_root(rules: &mut Rules, skin: &Value, parents: &[Option<usize>], pointer: &str) {
    let mut all = joints(skin);
    let Some(first) = all.next() else { return };
    let line: Vec<usize> = std::iter::once(first)
        .chain(ancestors(parents, first))
        .collect();
    // The place in the line above the first joint at which the line of another node joins it, if it does.
    let mut joins: BTreeMap<usize, Option<usize>> = line
        .iter()
        .enumerate()
        .map(|(k, &n)| (n, Some(k)))
        .collect();
    let mut lowest = Some(0);
    for joint in all {
        let mut path = Vec::new();
        let mut at = Some(joint);
        let place = loop {
            let Some(node) = at else { break None };
            if let Some(&place) = joins.get(&node) {
                break place;
            }
            joins.insert(node, None);
            path.push(node);
            at = parents.get(node).copied().flatten();
        };
        joins.extend(path.into_iter().map(|node| (node, place)));
        lowest = lowest.zip(place).map(|(a, b)| a.max(b));
    }
    if lowest.is_none() {
        let says = "the joints have no common root";
        rules.warn(codes::GLTF_MOTION, format!("{pointer}/joints"), says);
    }
    let common = lowest.map_or(&[][..], |lowest| &line[lowest..]);
    if let Some(skeleton) = index(skin, "skeleton").filter(|skeleton| !common.contains(skeleton))
        && skeleton < parents.len()
    {
        let says = format!("node {skeleton} is not above all joints");
        rules.warn(codes::GLTF_MOTION, format!("{pointer}/skeleton"), says);
    }
}
