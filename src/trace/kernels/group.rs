//! Which rays of a batch go how: in packets where they go one way from one place, together where the tree is too large for
//! caches, and each by itself.
//!
//! Rays are in the caller's order, in which neighbours in the picture stand together. Those that are no packet as they stand
//! are sorted by octant and kz, [`GROUPED`] at a time: what diffuse surfaces scatter goes every way, but from one place.
//! (Zen 3, sorted packets over packets as they stand: diffuse bounces in a mesh of 3,686 triangles 1.35, shadow rays there
//! 1.25, in one of 871,414 1.2, in one of 4,193,408 1.2.) Not for closest hits in a tree that is too large for caches:
//! such packets fall apart long before they reach its leaves (0.8), hence they must also be narrow there.

use super::batch::{MOST_LANES, load3};
use super::entries::Walks;
use super::instances::InstanceLeaves;
use super::packet::{self, Bests, Packet};
use super::prepared::AHEAD;
use super::ray::{CELLS, Setup, cells, dot, splat};
use super::stack::Stack;
use super::stream;
use super::walk::{Best, Sink, Tree};
use crate::flat::bvh::WIDTH;
use crate::math::lanes::Lanes;
use crate::trace::Rays;

/// Rays that are grouped at a time.
const GROUPED: usize = 1024;

/// Rays of a sorted packet at least: fewer are faster each by itself.
const FEW: usize = 3;

/// How far apart the origins of a packet may be, by the sum over the axes, of the extent of the tree.
const REACH: f32 = 1.0 / 32.0;

/// Least squared cosine between the first ray of a narrow packet and the others.
const NARROW: f32 = 0.5;

/// In place of a ray in a packet that is not full.
const NO_RAY: u32 = u32::MAX;

/// Room for what is kept from batch to batch.
#[derive(Default)]
pub(super) struct Scratch {
    groups: Groups,
    stream: stream::Scratch,
    packets: packet::Scratch,
}

/// Rays by how they go.
#[derive(Default)]
struct Groups {
    /// Rays of one octant and one kz.
    packets: Vec<[u32; WIDTH]>,
    /// Rays that are in no packet as they stand, with their cells.
    waiting: Vec<(u32, u8)>,
    /// Their number by cell.
    counts: [usize; CELLS],
    /// They, by cell.
    sorted: Vec<u32>,
    /// Rays that are in no packet at all.
    alone: Vec<u32>,
}

/// Walks the rays of a batch through the tree. With `ANY`, a ray is done at its first hit below its limit, of which `best`
/// then tells the primitive.
#[inline(always)]
pub(super) fn walk_batch<
    L: Walks,
    I: InstanceLeaves<L>,
    R: Sink,
    const T: bool,
    const S: bool,
    const ANY: bool,
>(
    tree: &Tree,
    rays: &Rays,
    sink: &mut R,
    instances: &mut I,
    scratch: &mut Scratch,
) {
    let Scratch {
        groups,
        stream,
        packets,
    } = scratch;
    let cold = stream::pays::<L>(tree);
    let wide = L::TOGETHER && (ANY || !cold);
    let mut first = 0;
    while first < rays.len() {
        groups.neighbours::<L>(rays, first, !wide);
        if wide {
            groups.sort();
        } else {
            groups.leave();
        }
        first += GROUPED;
        if L::TOGETHER {
            walk_packets::<L, I, R, T, S, ANY>(tree, rays, groups, sink, instances, packets);
        }
        let alone = &groups.alone;
        if cold {
            stream::walk_all::<L, I, R, T, S, ANY>(tree, rays, alone, sink, instances, stream);
        } else {
            walk_each::<L, I, R, T, S, ANY>(tree, rays, alone, sink, instances, stream);
        }
    }
}

/// Walks the packets; the rays of what turns out to be none are left alone.
#[inline(always)]
fn walk_packets<
    L: Walks,
    I: InstanceLeaves<L>,
    R: Sink,
    const T: bool,
    const S: bool,
    const ANY: bool,
>(
    tree: &Tree,
    rays: &Rays,
    groups: &mut Groups,
    sink: &mut R,
    instances: &mut I,
    scratch: &mut packet::Scratch,
) {
    let extent = tree.bvh.bounds.max - tree.bvh.bounds.min;
    let reach = REACH * (extent.x + extent.y + extent.z);
    for which in &groups.packets {
        let [origin, dir] = gather::<L>(rays, which);
        let Some(packet) = Packet::new(origin, dir, reach) else {
            for &ray in which {
                if ray != NO_RAY {
                    groups.alone.push(ray);
                }
            }
            continue;
        };
        // What is missing or not to be walked wants nothing.
        let mut bests = [Best::below(packet::NOTHING); WIDTH];
        let mut walked = [false; WIDTH];
        for (lane, &ray) in which.iter().enumerate() {
            if ray != NO_RAY
                && let Some(best) = sink.best(ray as usize)
            {
                bests[lane] = best;
                walked[lane] = true;
            }
        }
        let mut best = Bests::of(&bests);
        let floor = L::splat(tree.floor);
        L::walk_packet::<I, T, S, ANY>(tree, &packet, instances, scratch, &floor, &mut best);
        let bests = best.scatter();
        for (lane, &ray) in which.iter().enumerate() {
            if walked[lane] {
                sink.done(ray as usize, &bests[lane]);
            }
        }
    }
}

/// The rays of a packet in lanes; what is missing goes like the first.
#[inline(always)]
fn gather<L: Lanes>(rays: &Rays, which: &[u32; WIDTH]) -> [[L; 3]; 2] {
    let mut rows = [[0.0; WIDTH]; 6];
    for (lane, &ray) in which.iter().enumerate() {
        let ray = if ray == NO_RAY { which[0] } else { ray } as usize;
        for axis in 0..3 {
            rows[axis][lane] = rays.origin[axis][ray];
            rows[3 + axis][lane] = rays.dir[axis][ray];
        }
    }
    let row = |row: usize| L::load(&rows[row]);
    [[row(0), row(1), row(2)], [row(3), row(4), row(5)]]
}

impl Groups {
    /// Groups from ray `first` on: the packets that neighbours are, and the others.
    #[inline(always)]
    fn neighbours<L: Lanes>(&mut self, rays: &Rays, first: usize, must_be_narrow: bool) {
        self.packets.clear();
        self.waiting.clear();
        self.alone.clear();
        self.counts = [0; CELLS];
        let mut at = first;
        while at < first + GROUPED && at < rays.len() {
            let [origin, dir]: [[L; 3]; 2] = [load3(&rays.origin, at), load3(&rays.dir, at)];
            // Beyond the last ray there is no direction.
            let mut sound = Setup::sound(origin, dir);
            let cell = cells(dir);
            let mut lanes = [0.0; MOST_LANES];
            cell.store(&mut lanes);
            let like = L::splat(lanes[0]);
            let mut alike = cell.le(like) & like.le(cell);
            if must_be_narrow {
                alike = alike & narrow(dir);
            }
            if L::TOGETHER && L::bits(alike) & sound == u32::MAX >> (u32::BITS - L::N as u32) {
                let mut packet = [0; WIDTH];
                for (lane, ray) in packet.iter_mut().enumerate() {
                    *ray = (at + lane) as u32;
                }
                self.packets.push(packet);
                sound = 0;
            }
            while sound != 0 {
                let lane = sound.trailing_zeros() as usize % MOST_LANES;
                sound &= sound - 1;
                let cell = lanes[lane] as u8 % CELLS as u8;
                self.counts[usize::from(cell)] += 1;
                self.waiting.push(((at + lane) as u32, cell));
            }
            at += L::N;
        }
    }

    /// Makes packets of those that wait, cell by cell and in their order.
    #[inline(always)]
    fn sort(&mut self) {
        self.sorted.clear();
        self.sorted.resize(self.waiting.len(), 0);
        let mut ends = [0; CELLS];
        let mut end = 0;
        for (cell, count) in self.counts.into_iter().enumerate() {
            ends[cell] = end;
            end += count;
        }
        for &(ray, cell) in &self.waiting {
            let end = &mut ends[usize::from(cell) % CELLS];
            self.sorted[*end] = ray;
            *end += 1;
        }
        for (end, count) in ends.into_iter().zip(self.counts) {
            for rays in self.sorted[end - count..end].chunks(WIDTH) {
                if rays.len() < FEW {
                    self.alone.extend_from_slice(rays);
                } else {
                    let mut packet = [NO_RAY; WIDTH];
                    packet[..rays.len()].copy_from_slice(rays);
                    self.packets.push(packet);
                }
            }
        }
    }

    /// Leaves those that wait alone.
    #[inline(always)]
    fn leave(&mut self) {
        self.alone.extend(self.waiting.iter().map(|&(ray, _)| ray));
    }
}

/// Which directions are near the first.
#[inline(always)]
fn narrow<L: Lanes>(dir: [L; 3]) -> L::Mask {
    let mut first = [[0.0; MOST_LANES]; 3];
    for axis in 0..3 {
        dir[axis].store(&mut first[axis]);
    }
    let first = splat([first[0][0], first[1][0], first[2][0]]);
    let along = dot(dir, first);
    let least = L::splat(NARROW) * dot(first, first) * dot(dir, dir);
    L::splat(0.0).le(along) & least.le(along * along)
}

/// Walks rays of a batch through the tree, each by itself.
#[inline(always)]
fn walk_each<
    L: Walks,
    I: InstanceLeaves<L>,
    R: Sink,
    const T: bool,
    const S: bool,
    const ANY: bool,
>(
    tree: &Tree,
    rays: &Rays,
    which: &[u32],
    sink: &mut R,
    instances: &mut I,
    scratch: &mut stream::Scratch,
) {
    let mut stack = Stack::BOTTOM;
    for (k, &ray) in which.iter().enumerate() {
        if k.is_multiple_of(AHEAD) {
            scratch.prepared.fill::<L>(rays, &which[k..]);
        }
        if let Some(mut best) = sink.best(ray as usize) {
            let of = scratch.prepared.ray(k);
            L::walk::<I, T, S, ANY>(tree, tree.bvh.root, &of, instances, &mut stack, &mut best);
            sink.done(ray as usize, &best);
        }
    }
}
