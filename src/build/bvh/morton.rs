//! The fast mode: triangles sorted along the Morton curve become blocks as they come (after Lauterbach et al., "Fast BVH
//! Construction on GPUs", 2009), and the tree is built over those blocks, as over primitives.
//!
//! Deliberately absent: spheres and instances, which are few.

use super::CHUNK;
use super::blocks::{Ready, triangle_block};
use super::item::{Bounds, Item, Kinds};
use super::split::Grid;
use super::tree::{BuildNode, Child, Shape};
use crate::flat::bvh::WIDTH;
use crate::flat::{BLOCK, TriangleBlock};
use crate::math::{Vec3, pages};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::AtomicU32;

/// Bits of a Morton code per axis: what one pass of the sort takes.
const BITS: usize = 10;

/// Cells of the curve's grid per axis.
const CELLS: usize = 1 << BITS;

/// Where the code begins in a key; below is the triangle's index.
const CODE: usize = 32;

/// Triangles of a run at most: eight blocks, which one node holds.
const RUN: usize = WIDTH * BLOCK;

/// Ranges of sorted keys.
type Ranges = Vec<Range<usize>>;

/// Triangles along the curve in blocks, nodes over runs of these, and an item for each run. Triangles that the curve
/// cannot tell apart, more than fit a node, are items by themselves.
pub(super) fn runs(triangles: &[[Vec3; 3]]) -> (Ready, Vec<Item>) {
    let keys = sorted(keys(triangles));
    let (runs, crowds) = split(&keys, 0);
    let mut ready = Ready::new(triangles.len());
    let (groups, firsts) = groups(&runs);
    let mut bounds = pages::with_capacity(groups.len());
    ready.blocks = pages::with_capacity(groups.len());
    groups
        .par_iter()
        .with_min_len(CHUNK / BLOCK)
        .enumerate()
        .map(|(at, group)| block(triangles, &keys[group.clone()], at, &ready.place))
        .unzip_into_vecs(&mut ready.blocks, &mut bounds);
    ready.children = pages::with_capacity(runs.len());
    ready.grove.nodes = pages::with_capacity(runs.len());
    firsts
        .par_iter()
        .with_min_len(CHUNK / RUN)
        .enumerate()
        .map(|(at, &first)| {
            let end = firsts.get(at + 1).map_or(bounds.len(), |&next| next);
            over(at, first, &bounds[first..end])
        })
        .unzip_into_vecs(&mut ready.children, &mut ready.grove.nodes);
    let mut items = pages::with_capacity(runs.len());
    for (at, (child, run)) in ready.children.iter().zip(&runs).enumerate() {
        let lanes = run.len().next_multiple_of(BLOCK);
        items.push(Item::new(child.bounds.into(), Kinds::READY, at, lanes));
    }
    items.extend(crowds.into_iter().flatten().map(|i| {
        let prim = keys[i] as u32 as usize;
        let bounds = Bounds::from(&triangles[prim]);
        Item::new(bounds, Kinds::TRIANGLE, prim, 1)
    }));
    (ready, items)
}

/// The keys of every block, and the first block of every run.
fn groups(runs: &[Range<usize>]) -> (Ranges, Vec<usize>) {
    let keys: usize = runs.iter().map(Range::len).sum();
    let mut groups = pages::with_capacity(keys / BLOCK + runs.len());
    let mut firsts = Vec::with_capacity(runs.len());
    for run in runs {
        firsts.push(groups.len());
        let starts = run.clone().step_by(BLOCK);
        groups.extend(starts.map(|at| at..run.end.min(at + BLOCK)));
    }
    (groups, firsts)
}

/// Run number `at` as a child: its only block, number `first`, or a node over its blocks, with their boxes.
fn over(at: usize, first: usize, bounds: &[Bounds]) -> (Child, BuildNode) {
    let all = bounds.iter().fold(Bounds::NOTHING, |all, b| all.union(b));
    let block = |i: usize| Shape::Block((first + i) as u32);
    let mut node = BuildNode::default();
    for (i, bounds) in bounds.iter().enumerate() {
        node[i] = Some(Child {
            bounds: bounds.aabb(),
            shape: block(i),
        });
    }
    let shape = if bounds.len() == 1 {
        block(0)
    } else {
        Shape::Node(at as u32)
    };
    let bounds = all.aabb();
    (Child { bounds, shape }, node)
}

/// The block of these triangles, number `at`, with its box.
fn block(
    triangles: &[[Vec3; 3]],
    keys: &[u64],
    at: usize,
    place: &[AtomicU32],
) -> (TriangleBlock, Bounds) {
    let prim = |lane: usize| keys[lane] as u32;
    let block = triangle_block(triangles, keys.len(), prim, at, place);
    let mut bounds = Bounds::NOTHING;
    for lane in 0..keys.len() {
        bounds = bounds.union(&Bounds::from(&triangles[prim(lane) as usize]));
    }
    (block, bounds)
}

/// The Morton code of every triangle's centre above its index.
fn keys(triangles: &[[Vec3; 3]]) -> Vec<u64> {
    let centers = triangles
        .par_chunks(CHUNK)
        .map(|chunk| {
            chunk.iter().fold(Bounds::NOTHING, |mut centers, triangle| {
                let center = Bounds::from(triangle).center();
                centers.add(center, center);
                centers
            })
        })
        .reduce(|| Bounds::NOTHING, |a, b| a.union(&b));
    let grid = Grid::cubic(&centers, CELLS);
    let mut keys = pages::with_capacity(triangles.len());
    triangles
        .par_iter()
        .with_min_len(CHUNK)
        .enumerate()
        .map(|(i, triangle)| {
            let bounds = Bounds::from(triangle);
            let [x, y, z] = grid.bins_of::<CELLS>(bounds.center()).map(spread);
            (x << 2 | y << 1 | z) << CODE | i as u64
        })
        .collect_into_vec(&mut keys);
    keys
}

/// Two zero bits above each of the ten.
fn spread(x: usize) -> u64 {
    let x = x as u64;
    let x = (x | x << 16) & 0x0300_00ff;
    let x = (x | x << 8) & 0x0300_f00f;
    let x = (x | x << 4) & 0x030c_30c3;
    (x | x << 2) & 0x0924_9249
}

/// Sorts by code, and by index where codes are equal: three passes over ten bits each, which keep the order of equals.
fn sorted(mut keys: Vec<u64>) -> Vec<u64> {
    const PASSES: usize = 3;
    let digit = |key: u64, pass: usize| (key >> (CODE + BITS * pass)) as usize % CELLS;
    let mut counts = [[0u32; CELLS]; PASSES];
    for &key in &keys {
        for (pass, counts) in counts.iter_mut().enumerate() {
            counts[digit(key, pass)] += 1;
        }
    }
    let mut out = pages::with_capacity(keys.len());
    out.resize(keys.len(), 0);
    for (pass, counts) in counts.iter_mut().enumerate() {
        let mut next = 0;
        for count in counts.iter_mut() {
            next += std::mem::replace(count, next);
        }
        for &key in &keys {
            let at = &mut counts[digit(key, pass)];
            out[*at as usize] = key;
            *at += 1;
        }
        std::mem::swap(&mut keys, &mut out);
    }
    keys
}

/// Splits sorted keys, the first of which is the `first` of all, at the highest bit in which their codes differ, down
/// to runs. What is more and cannot be split is a crowd. Returns runs and crowds.
fn split(keys: &[u64], first: usize) -> (Ranges, Ranges) {
    let half = if keys.len() < CHUNK { 0 } else { half_of(keys) };
    if half == 0 {
        let (mut runs, mut crowds) = (Vec::new(), Vec::new());
        split_into(keys, first, &mut runs, &mut crowds);
        return (runs, crowds);
    }
    let (left, right) = keys.split_at(half);
    let ((mut runs, mut crowds), (more_runs, more_crowds)) =
        rayon::join(|| split(left, first), || split(right, first + half));
    runs.extend(more_runs);
    crowds.extend(more_crowds);
    (runs, crowds)
}

fn split_into(keys: &[u64], first: usize, runs: &mut Ranges, crowds: &mut Ranges) {
    let all = first..first + keys.len();
    if keys.len() <= RUN {
        runs.extend((!keys.is_empty()).then_some(all));
        return;
    }
    let half = half_of(keys);
    if half == 0 {
        crowds.push(all);
    } else {
        split_into(&keys[..half], first, runs, crowds);
        split_into(&keys[half..], first + half, runs, crowds);
    }
}

/// Keys below the highest bit in which the codes differ; 0 if they do not.
fn half_of(keys: &[u64]) -> usize {
    let ends = keys.first().zip(keys.last());
    let differ = ends.map_or(0, |(low, high)| (low ^ high) >> CODE);
    if differ == 0 {
        return 0;
    }
    let bit = 1 << (CODE as u32 + differ.ilog2());
    keys.partition_point(|key| key & bit == 0)
}
