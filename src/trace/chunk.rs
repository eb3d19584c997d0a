//! Some paths that a stage works on together, and their elements of SoA arrays.
#![allow(
    clippy::needless_range_loop,
    reason = "lanes are numbers here: several arrays are indexed by one"
)]

use super::vector::V3;
use crate::math::lanes::{BitLanes, Words};

/// The widest lanes of the stages: AVX-512 takes AVX2's.
pub(super) const WIDEST: usize = 8;

/// As many paths as there are lanes, by their index. Where there are fewer, the other lanes repeat the last one: they are
/// computed, and written nowhere.
pub(super) struct Chunk {
    index: [u32; WIDEST],
    len: usize,
    /// The paths follow one another, and every lane has one.
    run: bool,
}

impl Chunk {
    /// The first paths of a list that is not empty.
    #[inline(always)]
    pub(super) fn new<L: BitLanes>(list: &[u32]) -> Chunk {
        let len = list.len().min(L::N);
        let mut index = [0; WIDEST];
        for lane in 0..L::N {
            index[lane] = list[lane.min(len - 1)];
        }
        let apart = index[L::N - 1] - index[0];
        Chunk {
            index,
            len,
            run: len == L::N && apart as usize == L::N - 1,
        }
    }

    /// The paths from `first` on, below `end`.
    #[inline(always)]
    pub(super) fn range<L: BitLanes>(first: usize, end: usize) -> Chunk {
        let len = (end - first).min(L::N);
        let mut index = [0; WIDEST];
        for lane in 0..L::N {
            index[lane] = (first + lane.min(len - 1)) as u32;
        }
        Chunk {
            index,
            len,
            run: len == L::N,
        }
    }

    /// A list, chunk by chunk.
    #[inline(always)]
    pub(super) fn all<L: BitLanes>(list: &[u32]) -> impl Iterator<Item = Chunk> {
        list.chunks(L::N).map(Chunk::new::<L>)
    }

    /// The paths, without repetition.
    #[inline(always)]
    pub(super) fn index(&self) -> &[u32] {
        &self.index[..self.len]
    }

    /// Bit i: lane i is a path and no repetition.
    #[inline(always)]
    pub(super) fn members(&self) -> u32 {
        (1 << self.len) - 1
    }

    /// The element of one lane.
    #[inline(always)]
    pub(super) fn at<T: Copy>(&self, array: &[T], lane: usize) -> T {
        array[self.index[lane] as usize]
    }

    #[inline(always)]
    pub(super) fn lanes<L: BitLanes>(&self, array: &[f32]) -> L {
        match self.run {
            true => L::load(&array[self.index[0] as usize..]),
            false => L::gather(array, &self.index),
        }
    }

    #[inline(always)]
    pub(super) fn words<L: BitLanes>(&self, array: &[u32]) -> L::Bits {
        match self.run {
            true => Words::load(&array[self.index[0] as usize..]),
            false => Words::gather(array, &self.index),
        }
    }

    #[inline(always)]
    pub(super) fn vector<L: BitLanes>(&self, [x, y, z]: &[impl AsRef<[f32]>; 3]) -> V3<L> {
        V3([
            self.lanes(x.as_ref()),
            self.lanes(y.as_ref()),
            self.lanes(z.as_ref()),
        ])
    }

    /// Overwrites the paths' elements.
    #[inline(always)]
    pub(super) fn put<L: BitLanes>(&self, lanes: L, to: &mut [f32]) {
        if self.run {
            return lanes.store(&mut to[self.index[0] as usize..]);
        }
        let mut values = [0.0; WIDEST];
        lanes.store(&mut values);
        for (&i, x) in self.index().iter().zip(values) {
            to[i as usize] = x;
        }
    }

    #[inline(always)]
    pub(super) fn put_vector<L: BitLanes>(&self, V3(v): V3<L>, to: &mut [impl AsMut<[f32]>; 3]) {
        let [x, y, z] = to;
        self.put(v[0], x.as_mut());
        self.put(v[1], y.as_mut());
        self.put(v[2], z.as_mut());
    }
}
