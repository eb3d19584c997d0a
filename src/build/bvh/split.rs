//! Where a range of items splits: the surface area heuristic over bins of centres (Wald, "On fast Construction of
//! SAH-based Bounding Volume Hierarchies", 2007), counted in blocks.
#![allow(
    clippy::needless_range_loop,
    reason = "axes are numbers here: several arrays are indexed by one"
)]

use super::item::{Bounds, Extent, Item, Kinds};
use super::{CHUNK, SHARED};
use crate::flat::BLOCK;
use glam::Vec4;
use rayon::prelude::*;

/// Cost of an inner node in block tests. A node step is about as much work as a block test, but a node is shared by up to
/// eight children. Counted: from 0.2 to 0.6 nodes and blocks are the same within 3 % (thin soup: 7 %); at 0.8 a scanned
/// mesh's rays test half as many blocks again for 3 % fewer nodes.
pub(super) const NODE_COST: f32 = 0.4;

/// Bins per axis, for ranges of at least [`MANY`] items and for smaller ones. Powers of two.
const BINS: usize = 16;
const FEW_BINS: usize = 8;

/// Bins cost as much to sweep as items to fill in.
const MANY: usize = 64;

/// Units of a leaf at most: four blocks, beyond which no estimate is worth more than a split.
const MAX_LEAF: u32 = 4 * BLOCK as u32;

/// Units up to which a leaf of one kind is not questioned: one block. Asking finds a cut for one in a hundred of them.
const MIN_LEAF: u32 = BLOCK as u32;

/// Added to a small number, leaves its nearest integer in the low bits: floats are one apart from here on.
const ROUND: f32 = 8_388_608.0;

/// How a range of items falls in two.
#[derive(Clone, Copy, Debug)]
pub(super) enum Cut {
    /// Items with a place below the limit on some axis go left.
    Bin { grid: Grid, limit: Vec4 },
    /// Half of the items, ordered along the axis, go left.
    Median { axis: usize },
    /// Items of the first item's kind go left.
    Kind,
}

/// How centres fall into bins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    low: Vec4,
    /// Bins per length; 0 on an axis without extent.
    scale: Vec4,
}

impl Grid {
    fn new(extent: &Extent, bins: usize) -> Grid {
        let size = extent.centers.max - extent.centers.min;
        Grid::over(extent.centers.min, size, bins)
    }

    /// With as many bins on the longest axis, and of the same size on the others.
    pub(super) fn cubic(centers: &Bounds, bins: usize) -> Grid {
        let size = (centers.max - centers.min).truncate().max_element();
        Grid::over(centers.min, Vec4::splat(size), bins)
    }

    fn over(low: Vec4, size: Vec4, bins: usize) -> Grid {
        let scale = |size: f32| {
            let scale = bins as f32 / size;
            if scale.is_finite() { scale } else { 0.0 }
        };
        Grid {
            low,
            scale: Vec4::new(scale(size.x), scale(size.y), scale(size.z), 0.0),
        }
    }

    /// On each axis [`ROUND`] plus the bin of a centre, but the last bin has no end.
    #[inline]
    pub(super) fn place(&self, center: Vec4) -> Vec4 {
        // Half a bin less, so that the nearest is the one below.
        (center - self.low) * self.scale - Vec4::splat(0.5) + Vec4::splat(ROUND)
    }

    /// The bins of a centre, of `N`, a power of two.
    #[inline]
    pub(super) fn bins_of<const N: usize>(&self, center: Vec4) -> [usize; 3] {
        let (first, last) = (ROUND, ROUND + (N - 1) as f32);
        let place = self.place(center);
        let place = place.max(Vec4::splat(first)).min(Vec4::splat(last));
        [place.x, place.y, place.z].map(|x| x.to_bits() as usize % N)
    }

    /// The cut in front of a bin, which is not the first.
    fn cut(self, axis: usize, bin: usize) -> Cut {
        let mut limit = Vec4::NEG_INFINITY;
        limit[axis] = ROUND + bin as f32;
        Cut::Bin { grid: self, limit }
    }
}

/// Blocks that so many units fill.
#[inline]
pub(super) fn blocks(units: u32) -> f32 {
    units.div_ceil(BLOCK as u32) as f32
}

fn units_of(items: &[Item], kinds: Kinds) -> u32 {
    if kinds == Kinds::TRIANGLE || kinds == Kinds::SPHERE {
        items.len() as u32
    } else {
        items.iter().map(Item::units).sum()
    }
}

/// The cheapest cut by the heuristic, or nothing when a leaf is cheaper.
pub(super) fn choose(items: &[Item], extent: &Extent) -> Option<Cut> {
    let all = units_of(items, extent.kinds);
    let mixed = extent.kinds.mixed();
    if items.len() == 1 || (all <= MIN_LEAF && !mixed) {
        return None;
    }
    if all <= MIN_LEAF {
        return Some(Cut::Kind);
    }
    let leaf = if all <= MAX_LEAF && !mixed && extent.kinds != Kinds::READY {
        blocks(all)
    } else {
        f32::INFINITY
    };
    let cheapest = if items.len() >= MANY {
        cheapest_bin::<BINS>
    } else {
        cheapest_bin::<FEW_BINS>
    };
    match cheapest(items, extent) {
        Some((work, cut)) if NODE_COST + work / extent.bounds.half_area() < leaf => Some(cut),
        _ if leaf.is_finite() => None,
        _ if mixed => Some(Cut::Kind),
        _ => median(items, extent),
    }
}

/// The cut at the median of the longest axis of centres, or by kind; nothing for a block's worth of one kind.
pub(super) fn median(items: &[Item], extent: &Extent) -> Option<Cut> {
    if items.len() == 1 {
        None
    } else if units_of(items, extent.kinds) > BLOCK as u32 {
        let size = extent.centers.max - extent.centers.min;
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else {
            1 + usize::from(size.z > size.y)
        };
        Some(Cut::Median { axis })
    } else {
        extent.kinds.mixed().then_some(Cut::Kind)
    }
}

/// Boxes and units by axis and bin.
struct Bins<const N: usize> {
    bounds: [[Bounds; N]; 3],
    units: [[u32; N]; 3],
}

impl<const N: usize> Bins<N> {
    const EMPTY: Bins<N> = Bins {
        bounds: [[Bounds::NOTHING; N]; 3],
        units: [[0; N]; 3],
    };

    /// Bins the items. Neighbours tend to fall into the same bins: two sets in turns halve the wait for what was just
    /// stored.
    fn of(items: &[Item], grid: &Grid) -> Bins<N> {
        let mut bins = Bins::EMPTY;
        let (front, back) = items.split_at(items.len() / 2);
        for (a, b) in front.iter().zip(back) {
            let (at_a, at_b) = (grid.bins_of::<N>(a.center()), grid.bins_of::<N>(b.center()));
            bins.add(a, at_a);
            bins.add(b, at_b);
        }
        for item in &back[front.len()..] {
            bins.add(item, grid.bins_of::<N>(item.center()));
        }
        bins
    }

    #[inline]
    fn add(&mut self, item: &Item, at: [usize; 3]) {
        let units = item.units();
        for axis in 0..3 {
            self.bounds[axis][at[axis]].add(item.min, item.max);
            self.units[axis][at[axis]] += units;
        }
    }

    fn merge(mut self, other: &Bins<N>) -> Bins<N> {
        for axis in 0..3 {
            for bin in 0..N {
                let bounds = &mut self.bounds[axis][bin];
                *bounds = bounds.union(&other.bounds[axis][bin]);
                self.units[axis][bin] += other.units[axis][bin];
            }
        }
        self
    }

    /// The first bin right of the cheapest cut of one axis, with its work. The extreme centres are in the first and the
    /// last bin: no side is empty.
    fn sweep(&self, axis: usize) -> (f32, usize) {
        let (bounds, units) = (&self.bounds[axis], &self.units[axis]);
        let mut right = [0.0; N];
        let (mut sum, mut count) = (Bounds::NOTHING, 0);
        for i in (1..N).rev() {
            sum = sum.union(&bounds[i]);
            count += units[i];
            right[i] = sum.half_area() * blocks(count);
        }
        let mut best = (f32::INFINITY, 1);
        let (mut sum, mut count) = (Bounds::NOTHING, 0);
        for i in 1..N {
            sum = sum.union(&bounds[i - 1]);
            count += units[i - 1];
            let work = sum.half_area() * blocks(count) + right[i];
            if work < best.0 {
                best = (work, i);
            }
        }
        best
    }
}

/// The cut of least work, Σ area · blocks, over all bins of all axes; nothing when every centre is the same.
fn cheapest_bin<const N: usize>(items: &[Item], extent: &Extent) -> Option<(f32, Cut)> {
    let grid = Grid::new(extent, N);
    let bins = if items.len() >= SHARED {
        items
            .par_chunks(CHUNK)
            .map(|chunk| Bins::<N>::of(chunk, &grid))
            .reduce_with(|a, b| a.merge(&b))?
    } else {
        Bins::of(items, &grid)
    };
    let mut best: Option<(f32, Cut)> = None;
    for axis in (0..3).filter(|&axis| grid.scale[axis] > 0.0) {
        let (work, bin) = bins.sweep(axis);
        if best.is_none_or(|(least, _)| work < least) {
            best = Some((work, grid.cut(axis, bin)));
        }
    }
    best
}
