//! A window of a film that is still growing: what its samples add up to so far, ready to go on or to be put together with
//! what others have of the same window.

use super::blocks::Whole;
use super::{Blocks, Planes, Sums, Window};

/// Some samples of each pixel of a window, row by row. Arrays that were not asked for are empty; all are, without a sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Patch {
    /// Which pixels.
    pub window: Window,
    /// The first sample that it has.
    pub first: u32,
    /// One after the last sample that it has.
    pub done: u32,
    /// As [`Planes::count`].
    pub count: Vec<u32>,
    /// As [`Planes::non_finite`].
    pub non_finite: Vec<u32>,
    /// As [`Planes::hit_count`].
    pub hit_count: Vec<u32>,
    /// As [`Planes::uv`].
    pub uv: Vec<[f32; 2]>,
    /// As [`Planes::prim`].
    pub prim: Vec<u32>,
    /// As [`Planes::entity`].
    pub entity: Vec<u32>,
    /// Pixel in the window and index of samples that were left out; the first ones.
    pub lost: Vec<[u32; 2]>,
    /// Of the block of samples that is not complete.
    pub open: Sums,
    /// Of those that are.
    pub blocks: Blocks,
}

impl Patch {
    /// No sample yet; the first one will be `first`, the first of a block.
    #[must_use]
    pub fn new(window: Window, first: u32, independent: bool) -> Patch {
        Patch {
            window,
            first,
            done: first,
            blocks: Blocks::new(independent),
            ..Patch::default()
        }
    }

    /// Takes note that `open` has all samples up to `end`, which lies no further than [`Blocks::next`] of what it had.
    /// `spare` is memory from one call to the next; its numbers are of no importance.
    pub fn advance(&mut self, end: u32, spare: &mut Sums) {
        if end == Blocks::next(self.done) {
            self.blocks.take(end, &mut self.open, spare);
        }
        self.done = end;
    }

    /// Adds later samples of the same window, whose arrays are as many and as long.
    ///
    /// # Panics
    /// If these samples are not later ones.
    pub fn append(&mut self, next: Patch) {
        assert!(self.done <= next.first, "samples in their order");
        if self.done.is_multiple_of(Blocks::LENGTH) {
            self.open = Sums::default();
        } else {
            self.blocks.leave(self.done, std::mem::take(&mut self.open));
        }
        self.blocks.append(next.blocks);
        self.open = next.open;
        for (into, from) in [
            (&mut self.count, next.count),
            (&mut self.non_finite, next.non_finite),
            (&mut self.hit_count, next.hit_count),
        ] {
            for (sum, n) in into.iter_mut().zip(from) {
                *sum += n;
            }
        }
        self.lost.extend(next.lost);
        self.done = next.done;
    }

    /// Samples that were left out because they were not finite.
    #[must_use]
    pub fn non_finite_samples(&self) -> u64 {
        self.non_finite.iter().map(|&n| u64::from(n)).sum()
    }

    /// Whether it is one that tracing an image of `size` leaves: in its place, its samples in order, and with all arrays that
    /// are wanted and no others. For patches from files.
    #[must_use]
    pub fn fits(&self, (width, height): (u32, u32), features: bool, ids: bool) -> bool {
        let w = self.window;
        let inside = |from: u32, length: u32, whole: u32| {
            length > 0 && from.checked_add(length).is_some_and(|end| end <= whole)
        };
        if !inside(w.x, w.width, width) || !inside(w.y, w.height, height) {
            return false;
        }
        let pixels = w.width as usize * w.height as usize;
        if self.done == self.first {
            return self.blocks.nodes.is_empty() && self.open.rgb.is_empty();
        }
        let has = |wanted: bool, length: usize| length == if wanted { pixels } else { 0 };
        let sums = |sums: &Sums| {
            let [rgb, squared, albedo, normal, geonormal] = sums.triples().map(Vec::len);
            has(true, rgb)
                && has(true, squared)
                && [albedo, normal, geonormal, sums.depth.len()]
                    .into_iter()
                    .all(|length| has(features, length))
        };
        self.first.is_multiple_of(Blocks::LENGTH)
            && self.first < self.done
            && has(true, self.count.len())
            && has(true, self.non_finite.len())
            && has(features, self.hit_count.len())
            && [self.uv.len(), self.prim.len(), self.entity.len()]
                .into_iter()
                .all(|length| has(ids, length))
            && self
                .lost
                .iter()
                .all(|[pixel, _]| (*pixel as usize) < pixels)
            && sums(&self.open)
            && self.blocks.nodes.iter().all(|node| sums(&node.sums))
    }

    /// One division away from an image.
    #[must_use]
    pub fn into_planes(self) -> Planes {
        let open = match self.done.is_multiple_of(Blocks::LENGTH) {
            // Zeros, or nothing.
            true => Sums::default(),
            false => self.open,
        };
        let Whole { sums, gains } = self.blocks.finish(self.done, open);
        Planes {
            rgb: sums.rgb,
            rgb_squared: sums.rgb_squared,
            gains,
            count: self.count,
            non_finite: self.non_finite,
            hit_count: self.hit_count,
            albedo: sums.albedo,
            normal: sums.normal,
            geonormal: sums.geonormal,
            depth: sums.depth,
            uv: self.uv,
            prim: self.prim,
            entity: self.entity,
        }
    }
}
