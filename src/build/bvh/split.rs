//! Where a range of items splits: the surface area heuristic over bins of centroids (Wald 2007), counted in blocks.

use super::tree::{Item, Kind};
use crate::flat::BLOCK;
use crate::math::{Aabb, Vec3};

/// Cost of an inner node in block tests. A node step is a box test and the choice of the next child; a block test is
/// eight watertight triangles, about twice the work, but a node is shared by up to eight children.
pub(super) const NODE_COST: f32 = 0.4;

/// Bins per axis.
const BINS: usize = 16;

/// Units of a leaf at most: four blocks, beyond which no estimate is worth more than a split.
const MAX_LEAF: u64 = 4 * BLOCK as u64;

/// Units up to which a leaf of one kind is not questioned: half a block.
const MIN_LEAF: u64 = BLOCK as u64 / 2;

/// Just below the number of bins, so that the largest centroid falls into the last one.
const BIN_SCALE: f32 = BINS as f32 * (1.0 - 4.0 * f32::EPSILON);

/// How a range of items falls in two.
#[derive(Clone, Copy, Debug)]
pub(super) enum Cut {
    /// Items whose bin on `axis` is below `bin` go left.
    Bin {
        axis: usize,
        low: f32,
        scale: f32,
        bin: usize,
    },
    /// Half of the items, ordered along the axis, go left.
    Median { axis: usize },
    /// Items of the first item's kind go left.
    Kind,
}

/// A triangle or a sphere is a lane of a block; an instance weighs as much as a block, since a whole walk hangs on it.
pub(super) fn units(item: &Item) -> u64 {
    match item.kind {
        Kind::Triangle | Kind::Sphere => 1,
        Kind::Instance => BLOCK as u64,
    }
}

/// Blocks that so many units fill.
pub(super) fn blocks(units: u64) -> f32 {
    units.div_ceil(BLOCK as u64) as f32
}

/// Half of the surface area; 0 for the empty box.
pub(super) fn half_area(b: &Aabb) -> f32 {
    if b.is_empty() { 0.0 } else { b.half_area() }
}

/// The box of all.
pub(super) fn bounds_of(items: &[Item]) -> Aabb {
    items.iter().fold(Aabb::EMPTY, |b, i| b.union(i.bounds))
}

/// NaN for the empty box.
fn centroid(item: &Item) -> Vec3 {
    item.bounds.min * 0.5 + item.bounds.max * 0.5
}

/// The box of the centroids.
fn centroids(items: &[Item]) -> Aabb {
    items
        .iter()
        .filter(|i| !i.bounds.is_empty())
        .fold(Aabb::EMPTY, |b, i| b.with(centroid(i)))
}

/// NaN falls into bin 0.
fn bin_of(x: f32, low: f32, scale: f32) -> usize {
    (((x - low) * scale) as usize).min(BINS - 1)
}

fn mixed(items: &[Item]) -> bool {
    items.windows(2).any(|w| w[0].kind != w[1].kind)
}

/// The cheapest cut by the heuristic, or nothing when a leaf is cheaper.
pub(super) fn choose(items: &[Item], bounds: &Aabb) -> Option<Cut> {
    let all: u64 = items.iter().map(units).sum();
    let mixed = mixed(items);
    if items.len() == 1 || (all <= MIN_LEAF && !mixed) {
        return None;
    }
    if all <= MIN_LEAF {
        return Some(Cut::Kind);
    }
    let leaf = if all <= MAX_LEAF && !mixed {
        blocks(all)
    } else {
        f32::INFINITY
    };
    match cheapest_bin(items) {
        Some((work, cut)) if NODE_COST + work / half_area(bounds) < leaf => Some(cut),
        _ if leaf.is_finite() => None,
        _ if mixed => Some(Cut::Kind),
        _ => median(items),
    }
}

/// The cut at the median of the longest axis of centroids, or by kind; nothing for a block's worth of one kind.
pub(super) fn median(items: &[Item]) -> Option<Cut> {
    let all: u64 = items.iter().map(units).sum();
    if items.len() == 1 {
        None
    } else if all > BLOCK as u64 {
        let c = centroids(items);
        let extent = c.max - c.min;
        let axis = if extent.x >= extent.y && extent.x >= extent.z {
            0
        } else {
            1 + usize::from(extent.z > extent.y)
        };
        Some(Cut::Median { axis })
    } else {
        mixed(items).then_some(Cut::Kind)
    }
}

/// Moves the left items of the cut to the front; returns their number, neither none nor all.
pub(super) fn partition(items: &mut [Item], cut: &Cut) -> usize {
    match *cut {
        Cut::Bin {
            axis,
            low,
            scale,
            bin,
        } => partition_by(items, |i| bin_of(centroid(i)[axis], low, scale) < bin),
        Cut::Kind => {
            let kind = items[0].kind;
            partition_by(items, |i| i.kind == kind)
        }
        Cut::Median { axis } => {
            let half = items.len() / 2;
            items.select_nth_unstable_by(half, |a, b| {
                let by_place = centroid(a)[axis].total_cmp(&centroid(b)[axis]);
                by_place.then((a.kind, a.index).cmp(&(b.kind, b.index)))
            });
            half
        }
    }
}

fn partition_by(items: &mut [Item], left: impl Fn(&Item) -> bool) -> usize {
    let mut end = 0;
    for i in 0..items.len() {
        if left(&items[i]) {
            items.swap(i, end);
            end += 1;
        }
    }
    end
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Aabb,
    units: u64,
}

const EMPTY_BIN: Bin = Bin {
    bounds: Aabb::EMPTY,
    units: 0,
};

impl Bin {
    fn add(&mut self, other: &Bin) {
        self.bounds = self.bounds.union(other.bounds);
        self.units += other.units;
    }

    /// Area times blocks.
    fn work(&self) -> f32 {
        half_area(&self.bounds) * blocks(self.units)
    }
}

/// The cut of least work, Σ area · blocks, over all bins of all axes; nothing when every centroid is the same.
fn cheapest_bin(items: &[Item]) -> Option<(f32, Cut)> {
    let c = centroids(items);
    let scale = Vec3::splat(BIN_SCALE) / (c.max - c.min);
    let mut bins = [[EMPTY_BIN; BINS]; 3];
    for item in items {
        let x = centroid(item);
        let one = Bin {
            bounds: item.bounds,
            units: units(item),
        };
        for (axis, row) in bins.iter_mut().enumerate() {
            row[bin_of(x[axis], c.min[axis], scale[axis])].add(&one);
        }
    }
    let mut best: Option<(f32, Cut)> = None;
    for axis in 0..3 {
        // An infinite or undefined scale is an axis without extent.
        if !scale[axis].is_finite() {
            continue;
        }
        if let Some((work, bin)) = sweep(&bins[axis])
            && best.is_none_or(|(least, _)| work < least)
        {
            let cut = Cut::Bin {
                axis,
                low: c.min[axis],
                scale: scale[axis],
                bin,
            };
            best = Some((work, cut));
        }
    }
    best
}

/// The first bin right of the cheapest cut of one axis, with its work.
fn sweep(row: &[Bin; BINS]) -> Option<(f32, usize)> {
    let mut right = [(0.0, 0); BINS];
    let mut sum = EMPTY_BIN;
    for i in (1..BINS).rev() {
        sum.add(&row[i]);
        right[i] = (sum.work(), sum.units);
    }
    let mut best: Option<(f32, usize)> = None;
    let mut left = EMPTY_BIN;
    for i in 1..BINS {
        left.add(&row[i - 1]);
        let work = left.work() + right[i].0;
        if left.units > 0 && right[i].1 > 0 && best.is_none_or(|(least, _)| work < least) {
            best = Some((work, i));
        }
    }
    best
}
