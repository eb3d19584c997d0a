//! Packets: as many rays as there are lanes, which go one way, walk the tree as one.
//!
//! A node is met by the packet's *span*, the intervals of its origins and of its 1 / d, against eight boxes at a time
//! (Wald, Slusallek, Benthin and Wagner, *Interactive rendering with coherent ray tracing*, 2001; the intervals are those of
//! Boulos, Wald and Shirley, *Geometric and arithmetic culling methods for entire ray packets*, 2006). A box that the span
//! meets is put off, and tested against the rays themselves, in lanes, once its turn comes. So are the primitives of a
//! leaf. Every ray is tested by the formulas that it is tested by alone, and every operation on a span is monotone, so that a
//! span's interval contains those of its rays to the bit: hits are the same.
//!
//! Camera rays, shadow rays towards one light, and what mirrors make of them are such rays, as long as the batch has
//! neighbours next to each other.

use super::entries::Walks;
use super::instances::InstanceLeaves;
use super::ray::{Interval, Plane, Setup, WalkRay};
use super::sphere::WideRay;
use super::stack::{DONE, FETCHED, Stack};
use super::triangle::{self, Candidates, Corners};
use super::walk::{Best, Tree, lowest};
use crate::flat::bvh::{WIDTH, kind};
use crate::flat::{BLOCK, Child, SphereBlock, Spheres, TriangleBlock};
use crate::math::lanes::{Lanes, WideLanes};
use crate::trace::Hits;

/// Rays that go one way.
#[derive(Clone, Copy)]
pub(super) struct Packet<L> {
    pub(super) ray: WalkRay<L>,
    /// The origin that enters a box first and the one that leaves it last, by axis.
    origin: [[L; 3]; 2],
    /// Least and greatest 1 / d for near planes, and for far ones.
    inv: [[[L; 3]; 2]; 2],
}

/// The closest hits of a packet so far, as [`Best`] in lanes; ids travel as bits.
#[derive(Clone, Copy)]
pub(super) struct Bests<L> {
    pub(super) t: L,
    u: L,
    v: L,
    prim: L,
    instance: L,
}

/// What a ray that wants no more is limited to: no box is entered before 0.
pub(super) const NOTHING: f32 = -1.0;

/// So few rays go on each by itself.
const LONE: u32 = 2;

/// Stacks: of the packet, and of a ray that goes on by itself.
#[derive(Default)]
pub(super) struct Scratch {
    packet: Box<Stack>,
    alone: Box<Stack>,
}

impl<L: Lanes> Packet<L> {
    /// Rays of one octant and one kz, those of the first. Nothing if one is parallel to a plane, or if their origins are
    /// farther apart than `reach`, by the sum over the axes.
    #[inline(always)]
    pub(super) fn new(origin: [L; 3], dir: [L; 3], reach: f32) -> Option<Packet<L>> {
        let mut ends = [[0.0; 2]; 3];
        let mut apart = 0.0;
        for axis in 0..3 {
            ends[axis] = [origin[axis].greatest(), origin[axis].least()];
            apart += ends[axis][0] - ends[axis][1];
        }
        let setup = Setup::new(dir);
        let [near, far] = setup.inv;
        let most = L::splat(f32::MAX);
        let slanted = far[0].abs().le(most) & far[1].abs().le(most) & far[2].abs().le(most);
        if apart > reach || L::bits(slanted) != (1 << L::N) - 1 {
            return None;
        }
        let ray = WalkRay::packet(origin, dir, &setup);
        let mut packet = Packet {
            ray,
            origin: [origin; 2],
            inv: [[near; 2], [far; 2]],
        };
        for axis in 0..3 {
            let first = usize::from(ray.negative(axis));
            for end in 0..2 {
                packet.origin[end][axis] = L::splat(ends[axis][first ^ end]);
                packet.inv[end][0][axis] = L::splat(setup.inv[end][axis].least());
                packet.inv[end][1][axis] = L::splat(setup.inv[end][axis].greatest());
            }
        }
        Some(packet)
    }

    /// Where the first ray enters boxes and the last one leaves them, or beyond.
    #[inline(always)]
    fn between(&self, near_planes: [L; 3], far_planes: [L; 3]) -> Interval<L> {
        let mut near = L::splat(0.0);
        let mut far = L::splat(f32::INFINITY);
        for axis in 0..3 {
            let n = near_planes[axis] - self.origin[0][axis];
            let f = far_planes[axis] - self.origin[1][axis];
            let [near_inv, far_inv] = &self.inv;
            near = (n * near_inv[0][axis]).min(n * near_inv[1][axis]).max(near);
            far = (f * far_inv[0][axis]).max(f * far_inv[1][axis]).min(far);
        }
        Interval { near, far }
    }

    /// The eight boxes of planes that begin with those of the minima.
    #[inline(always)]
    fn boxes(&self, planes: &[[f32; BLOCK]; 6]) -> Interval<L> {
        let (near, far) = (self.ray.planes.near, self.ray.planes.far);
        let row = |plane: Plane| L::load(&planes[plane.row()]);
        self.between(
            [row(near[0]), row(near[1]), row(near[2])],
            [row(far[0]), row(far[1]), row(far[2])],
        )
    }
}

/// A box of eight against the rays.
#[inline(always)]
fn one_box<L: Lanes>(ray: &WalkRay<L>, planes: &[[f32; BLOCK]; 6], i: usize) -> Interval<L> {
    let (near, far) = (ray.planes.near, ray.planes.far);
    let of = |plane: Plane| L::splat(planes[plane.row()][i]);
    ray.between(
        [of(near[0]), of(near[1]), of(near[2])],
        [of(far[0]), of(far[1]), of(far[2])],
    )
}

impl<L: Lanes> Bests<L> {
    /// From those of each ray.
    #[inline(always)]
    pub(super) fn of(bests: &[Best; BLOCK]) -> Bests<L> {
        let mut values = [[0.0; BLOCK]; 5];
        for (i, best) in bests.iter().enumerate() {
            values[0][i] = best.t;
            values[1][i] = best.u;
            values[2][i] = best.v;
            values[3][i] = f32::from_bits(best.prim);
            values[4][i] = f32::from_bits(best.instance);
        }
        Bests::from_rows(&values)
    }

    #[inline(always)]
    fn from_rows(values: &[[f32; BLOCK]; 5]) -> Bests<L> {
        Bests {
            t: L::load(&values[0]),
            u: L::load(&values[1]),
            v: L::load(&values[2]),
            prim: L::load(&values[3]),
            instance: L::load(&values[4]),
        }
    }

    #[inline(always)]
    fn rows(&self) -> [[f32; BLOCK]; 5] {
        let mut values = [[0.0; BLOCK]; 5];
        for (row, of) in values
            .iter_mut()
            .zip([self.t, self.u, self.v, self.prim, self.instance])
        {
            of.store(row);
        }
        values
    }

    /// All of them, by lane.
    #[inline(always)]
    pub(super) fn scatter(&self) -> [Best; BLOCK] {
        let rows = self.rows();
        let mut out = [Best::below(0.0); BLOCK];
        for (i, out) in out.iter_mut().enumerate() {
            *out = Best {
                t: rows[0][i],
                u: rows[1][i],
                v: rows[2][i],
                prim: rows[3][i].to_bits(),
                instance: rows[4][i].to_bits(),
            };
        }
        out
    }

    /// Only the rays of the mask: the others want nothing.
    #[inline(always)]
    pub(super) fn only(&self, which: L::Mask) -> Bests<L> {
        let t = L::select(which, self.t, L::splat(NOTHING));
        Bests { t, ..*self }
    }

    /// Takes over what became of the rays of the mask.
    #[inline(always)]
    pub(super) fn update(&mut self, which: L::Mask, by: &Bests<L>) {
        self.t = L::select(which, by.t, self.t);
        self.u = L::select(which, by.u, self.u);
        self.v = L::select(which, by.v, self.v);
        self.prim = L::select(which, by.prim, self.prim);
        self.instance = L::select(which, by.instance, self.instance);
    }

    /// As [`Best::cull`].
    #[inline(always)]
    pub(super) fn cull(&self) -> L {
        self.t.min(L::splat(f32::MAX))
    }

    /// The farthest of them.
    #[inline(always)]
    fn farthest(&self) -> f32 {
        self.cull().greatest()
    }

    /// Takes a primitive for the rays that hit it, at t and with weights of its vertices; an infinite t is no hit. With
    /// `ANY`, a ray that hits it below its limit is done.
    #[inline(always)]
    fn offer<const ANY: bool>(&mut self, t: L, [u, v]: [L; 2], prim: u32, instance: u32) {
        let closer = t.lt(self.t);
        let ids = [
            L::splat(f32::from_bits(prim)),
            L::splat(f32::from_bits(instance)),
        ];
        if ANY {
            self.t = L::select(closer, L::splat(NOTHING), self.t);
            self.prim = L::select(closer, ids[0], self.prim);
            return;
        }
        let equal = L::bits(t.le(self.t) & self.t.le(t) & t.lt(L::splat(f32::INFINITY)));
        if equal != 0 {
            self.settle(equal, t, [u, v], prim, instance);
        }
        self.t = L::select(closer, t, self.t);
        self.u = L::select(closer, u, self.u);
        self.v = L::select(closer, v, self.v);
        self.prim = L::select(closer, ids[0], self.prim);
        self.instance = L::select(closer, ids[1], self.instance);
    }

    /// The ties of [`Bests::offer`], lane by lane.
    #[inline(always)]
    fn settle(&mut self, mut equal: u32, t: L, [u, v]: [L; 2], prim: u32, instance: u32) {
        let mut rows = self.rows();
        let offered = Bests {
            t,
            u,
            v,
            prim: L::splat(f32::from_bits(prim)),
            instance: L::splat(f32::from_bits(instance)),
        };
        let (bests, offered) = (self.scatter(), offered.scatter());
        while equal != 0 {
            let i = lowest(equal);
            equal &= equal - 1;
            if bests[i].yields_to(&offered[i]) {
                rows[1][i] = offered[i].u;
                rows[2][i] = offered[i].v;
                rows[3][i] = f32::from_bits(prim);
                rows[4][i] = f32::from_bits(instance);
            }
        }
        *self = Bests::from_rows(&rows);
    }
}

/// A triangle of a block in all lanes.
struct Everywhere<'a>(&'a TriangleBlock, usize);

impl<L: Lanes> Corners<L> for Everywhere<'_> {
    #[inline(always)]
    fn load(&self, vertex: usize, axis: usize) -> L {
        L::splat(self.0.v[vertex][axis][self.1])
    }

    #[inline(always)]
    fn vertices(&self, _: usize) -> [[f32; 3]; 3] {
        let (v, lane) = (&self.0.v, self.1);
        [
            [v[0][0][lane], v[0][1][lane], v[0][2][lane]],
            [v[1][0][lane], v[1][1][lane], v[1][2][lane]],
            [v[2][0][lane], v[2][1][lane], v[2][2][lane]],
        ]
    }
}

/// Walks a packet through the tree, as [`walk`](super::walk::walk) walks a ray. No hit is nearer than `floor`.
#[inline(always)]
pub(super) fn walk<
    L: Walks,
    I: InstanceLeaves<L>,
    const T: bool,
    const S: bool,
    const ANY: bool,
>(
    tree: &Tree,
    packet: &Packet<L>,
    instances: &mut I,
    scratch: &mut Scratch,
    floor: L,
    best: &mut Bests<L>,
) {
    let stack = &mut scratch.packet;
    let nodes = &tree.bvh.nodes;
    let mut child = tree.bvh.root;
    if child.kind() == kind::INNER && nodes.is_empty() {
        return;
    }
    let mut farthest = best.farthest();
    let mut top = 1;
    loop {
        let run = child.index()..child.index() + child.run_len();
        match child.kind() {
            kind::INNER => {
                let node = &nodes[child.index()];
                let interval = packet.boxes(&node.planes);
                let meets = interval.meets(L::splat(farthest));
                let mut near = [0.0; WIDTH];
                L::select(meets, interval.near, L::splat(-1.0)).store(&mut near);
                let met = L::bits(meets);
                let mut left = met;
                while left != 0 {
                    let next = Child(node.child[lowest(left)]);
                    left &= left - 1;
                    L::prefetch(tree.address(next), FETCHED);
                }
                let mut places = [0; WIDTH];
                for (i, place) in places.iter_mut().enumerate() {
                    *place = (child.index() * WIDTH + i) as u32;
                }
                if let Some(children) = stack.children[top..].first_chunk_mut()
                    && let Some(entries) = stack.entries[top..].first_chunk_mut()
                {
                    top += L::sort_falling(&near, met, &places, children, entries);
                }
            }
            kind::TRIANGLES if T => {
                for block in &tree.triangles[run] {
                    let range = [floor, L::splat(farthest)];
                    triangles::<L, ANY>(tree, block, packet, range, best);
                }
                farthest = best.farthest();
            }
            kind::SPHERES if S => {
                for block in &tree.spheres[run] {
                    spheres::<L, ANY>(block, packet, farthest, best);
                }
                farthest = best.farthest();
            }
            kind::INSTANCES => {
                let run = &tree.bvh.instance_order[run];
                instances.test_packet::<ANY>(run, packet, best);
                farthest = best.farthest();
            }
            _ => (),
        }
        loop {
            let mut at = top - 1;
            while stack.entries[at] > farthest {
                at -= 1;
            }
            top = at;
            let place = stack.children[at];
            if place == DONE.0 {
                return;
            }
            let (node, i) = (&nodes[place as usize / WIDTH], place as usize % WIDTH);
            let own = one_box(&packet.ray, &node.planes, i);
            let met = L::bits(own.meets(best.cull()));
            if met != 0 {
                child = Child(node.child[i]);
                if met.count_ones() > LONE {
                    break;
                }
                let (rays, apart) = ((&packet.ray, floor), &mut scratch.alone);
                alone::<L, I, T, S, ANY>(tree, child, met, rays, instances, apart, best);
                farthest = best.farthest();
            }
        }
    }
}

/// Walks rays of a packet, those of the lanes in `which`, each by itself from a child on.
#[inline(always)]
fn alone<L: Walks, I: InstanceLeaves<L>, const T: bool, const S: bool, const ANY: bool>(
    tree: &Tree,
    child: Child,
    mut which: u32,
    (rays, floor): (&WalkRay<L>, L),
    instances: &mut I,
    stack: &mut Stack,
    best: &mut Bests<L>,
) {
    let mut rows = best.rows();
    let mut floors = [0.0; BLOCK];
    floor.store(&mut floors);
    while which != 0 {
        let i = lowest(which);
        which &= which - 1;
        let ray = rays.alone(i);
        let floor = floors[i];
        let tree = &Tree { floor, ..*tree };
        let mut best = Best {
            t: rows[0][i],
            u: rows[1][i],
            v: rows[2][i],
            prim: rows[3][i].to_bits(),
            instance: rows[4][i].to_bits(),
        };
        if L::walk::<I, T, S, ANY>(tree, child, &ray, instances, stack, &mut best) {
            best.t = NOTHING;
        }
        rows[0][i] = best.t;
        rows[1][i] = best.u;
        rows[2][i] = best.v;
        rows[3][i] = f32::from_bits(best.prim);
        rows[4][i] = f32::from_bits(best.instance);
    }
    *best = Bests::from_rows(&rows);
}

/// A block of triangles: those whose boxes the span meets, one after the other against all rays.
#[inline(always)]
fn triangles<L: Lanes, const ANY: bool>(
    tree: &Tree,
    block: &TriangleBlock,
    packet: &Packet<L>,
    [floor, farthest]: [L; 2],
    best: &mut Bests<L>,
) {
    let zero = L::splat(0.0);
    let [mut near_planes, mut far_planes] = [[zero; 3]; 2];
    let mut used = zero.le(zero);
    for axis in 0..3 {
        let [a, b, c] = [
            L::load(&block.v[0][axis]),
            L::load(&block.v[1][axis]),
            L::load(&block.v[2][axis]),
        ];
        let [min, max] = [a.min(b).min(c), a.max(b).max(c)];
        let negative = packet.ray.negative(axis);
        near_planes[axis] = if negative { max } else { min };
        far_planes[axis] = if negative { min } else { max };
        // Padding is not a number.
        used = used & a.le(a);
    }
    let interval = packet.between(near_planes, far_planes);
    let mut left = L::bits(used & interval.meets(farthest));
    let mut c = Candidates::NONE;
    while left != 0 {
        let i = lowest(left);
        left &= left - 1;
        let range = [floor, best.t];
        let corners = Everywhere(block, i);
        if triangle::test(&packet.ray, &corners, 0, range, &mut c) != 0 {
            let weights = c.all_weights();
            best.offer::<ANY>(L::load(&c.t), weights, block.prim[i], tree.instance);
        }
    }
}

/// A block of spheres, likewise.
#[inline(always)]
fn spheres<L: Lanes, const ANY: bool>(
    block: &SphereBlock,
    packet: &Packet<L>,
    farthest: f32,
    best: &mut Bests<L>,
) {
    let zero = L::splat(0.0);
    let met = packet.boxes(&block.bounds).meets(L::splat(farthest));
    let mut left = L::bits(met);
    if left == 0 {
        return;
    }
    let wide = WideRay::new(packet.ray.origin, packet.ray.dir);
    while left != 0 {
        let i = lowest(left);
        left &= left - 1;
        let own = one_box(&packet.ray, &block.bounds, i);
        let met = own.meets(best.cull());
        let center = [
            L::Wide::splat(block.center[0][i]),
            L::Wide::splat(block.center[1][i]),
            L::Wide::splat(block.center[2][i]),
        ];
        if L::bits(met) != 0
            && let Some(root) = wide.root::<L>(center, L::Wide::splat(block.radius[i]))
        {
            let clamped = root.min(own.far).max(own.near);
            let counts = met
                & zero.lt(root)
                & root.lt(L::splat(f32::INFINITY))
                & zero.lt(clamped)
                & clamped.le(best.t);
            let t = L::select(counts, clamped, L::splat(f32::INFINITY));
            let prim = Spheres::TAG | block.prim[i];
            best.offer::<ANY>(t, [zero; 2], prim, Hits::WORLD);
        }
    }
}
