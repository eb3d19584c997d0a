//! Eight children a node, their planes in bytes: 128 bytes, half of [`Wide`](super::Wide). A plane is a number of steps from
//! the node's origin, the steps being powers of two by axis (Ylitie, Karras and Laine, *Efficient Incoherent Ray Traversal on
//! GPUs Through Compressed Wide BVHs*, 2017; on CPUs Benthin et al., *Compressed-Leaf Bounding Volume Hierarchies*, 2018).
//!
//! A byte's plane is rounded outward as the walk computes it, not as mathematics does: `origin + byte · step`, of which the
//! product is exact and the sum rounds alike on every machine. So every box contains the exact one, to the bit, and the slab
//! test, which is monotone in the planes, needs no slack of its own.

use super::eight::put_off;
use super::{Child, Node, Stack, Tree, child, root};
use crate::flat::bvh::WIDTH;
use crate::flat::{self, Bvh, LinearNode};
use crate::math::lanes::Lanes;
use crate::trace::kernels::ray::{Plane, WIDENED, WalkRay};

/// A node.
#[repr(C, align(64))]
pub(in super::super) struct Quantised {
    /// What planes are counted from: the least corner of all children, by axis.
    origin: [f32; 3],
    /// A power of two by axis.
    step: [f32; 3],
    /// As [`LinearNode::planes`], in steps from the origin; anything in unused slots.
    planes: [[u8; WIDTH]; 6],
    first: [u32; WIDTH],
    slots: [u8; WIDTH],
    /// A bit for each slot in use: bytes have no empty box.
    used: u32,
}

const _: () = assert!(size_of::<Quantised>() == 128);

/// Where a byte's plane is.
#[inline(always)]
fn plane<L: Lanes>(origin: f32, step: f32, bytes: L) -> L {
    L::splat(origin) + bytes * L::splat(step)
}

impl Node for Quantised {
    type Boxes<L: Lanes> = L;

    fn tree(bvh: &Bvh, leaf: impl Fn(u32, u32) -> Child) -> Tree<Quantised> {
        let nodes = bvh.nodes.iter().map(|node| {
            let mut quantised = Quantised::boxes(node);
            for slot in 0..WIDTH {
                let child = child(flat::Child(node.child[slot]), &leaf);
                quantised.first[slot] = child.first;
                quantised.slots[slot] = child.slots as u8;
                debug_assert_eq!(u32::from(quantised.slots[slot]), child.slots);
            }
            quantised
        });
        Tree {
            nodes: nodes.collect(),
            root: root(bvh, &leaf),
            slabs: WIDENED,
        }
    }

    #[inline(always)]
    fn enter<L: Lanes>(&self, ray: &WalkRay<L>, cull: f32, stack: &mut Stack) -> Option<Child> {
        let mut near = [0.0; WIDTH];
        let mut met = 0;
        let mut at = 0;
        while at < WIDTH {
            let nearer = self.planes::<L>(ray.planes.near, at);
            let interval = ray.between(nearer, self.planes::<L>(ray.planes.far, at));
            interval.near.store(&mut near[at..]);
            met |= L::bits(interval.meets(L::splat(cull))) << at;
            at += L::N;
        }
        let child = |slot: usize| Child {
            first: self.first[slot],
            slots: u32::from(self.slots[slot]),
        };
        let met = met & self.used;
        put_off(&near, met, child, &mut stack.entries, &mut stack.top)
    }
}

impl Quantised {
    /// A plane for each axis, of `L::N` boxes from lane `at` on.
    #[inline(always)]
    fn planes<L: Lanes>(&self, of: [Plane; 3], at: usize) -> [L; 3] {
        let bytes = [
            L::load_bytes(&self.planes[of[0].row()][at..]),
            L::load_bytes(&self.planes[of[1].row()][at..]),
            L::load_bytes(&self.planes[of[2].row()][at..]),
        ];
        [
            plane(self.origin[0], self.step[0], bytes[0]),
            plane(self.origin[1], self.step[1], bytes[1]),
            plane(self.origin[2], self.step[2], bytes[2]),
        ]
    }

    /// The boxes of a node's children.
    fn boxes(node: &LinearNode) -> Quantised {
        let mut quantised = Quantised {
            origin: [0.0; 3],
            step: [f32::MIN_POSITIVE; 3],
            planes: [[0; WIDTH]; 6],
            first: [0; WIDTH],
            slots: [0; WIDTH],
            used: 0,
        };
        let used: Vec<usize> = (0..WIDTH).filter(|&slot| node.child[slot] != 0).collect();
        for axis in 0..3 {
            let [minima, maxima] = [&node.planes[axis], &node.planes[axis + 3]];
            let low = used
                .iter()
                .fold(f32::INFINITY, |low, &i| low.min(minima[i]));
            let high = used
                .iter()
                .fold(f32::NEG_INFINITY, |high, &i| high.max(maxima[i]));
            let step = step(low, high);
            quantised.origin[axis] = low;
            quantised.step[axis] = step;
            for &slot in &used {
                quantised.used |= 1 << slot;
                quantised.planes[axis][slot] = below(low, step, minima[slot]);
                quantised.planes[axis + 3][slot] = above(low, step, maxima[slot]);
            }
        }
        quantised
    }
}

/// The least power of two, or the next but one, with which a byte reaches from one to the other.
fn step(low: f32, high: f32) -> f32 {
    /// All bits of an f32 but the mantissa.
    const POWER: u32 = 0xff80_0000;
    let fair = high / 255.0 - low / 255.0;
    let mut step = f32::from_bits(fair.to_bits() & POWER).max(f32::MIN_POSITIVE);
    while plane(low, step, 255.0) < high {
        step *= 2.0;
    }
    step
}

/// The largest byte whose plane is not above a minimum, which is not below the origin.
fn below(origin: f32, step: f32, minimum: f32) -> u8 {
    let mut byte = ((minimum - origin) / step) as u8;
    while plane(origin, step, f32::from(byte)) > minimum {
        byte -= 1;
    }
    byte
}

/// A least byte whose plane is not below a maximum, which 255 steps reach.
fn above(origin: f32, step: f32, maximum: f32) -> u8 {
    let mut byte = ((maximum - origin) / step).ceil() as u8;
    while plane(origin, step, f32::from(byte)) < maximum {
        byte += 1;
    }
    byte
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::bvh::{Accel, Primitives, build};
    use crate::math::{Aabb, Vec3};
    use crate::measure::bench::{Random, meshes};

    /// The box that the walk sees.
    fn seen(node: &Quantised, slot: usize) -> Aabb {
        let at = |row: usize| {
            let axis = row % 3;
            let byte = f32::from(node.planes[row][slot]);
            plane(node.origin[axis], node.step[axis], byte)
        };
        Aabb {
            min: Vec3::new(at(0), at(1), at(2)),
            max: Vec3::new(at(3), at(4), at(5)),
        }
    }

    /// Checks every child; returns how much the boxes grow on average, by area.
    fn contained(bvh: &Bvh) -> f64 {
        let leaf = |first, slots| Child { first, slots };
        let tree = Quantised::tree(bvh, leaf);
        assert_eq!(tree.nodes.len(), bvh.nodes.len());
        let (mut exact_area, mut seen_area) = (0.0, 0.0);
        for (exact, node) in bvh.nodes.iter().zip(&tree.nodes) {
            for slot in 0..WIDTH {
                let used = exact.child[slot] != 0;
                assert_eq!(node.used >> slot & 1 == 1, used);
                let word = child(flat::Child(exact.child[slot]), leaf);
                assert_eq!(
                    (node.first[slot], u32::from(node.slots[slot])),
                    (word.first, word.slots)
                );
                if used {
                    let [exact, seen] = [exact.child_box(slot), seen(node, slot)];
                    assert!(seen.min.cmple(exact.min).all(), "{exact:?} {seen:?}");
                    assert!(exact.max.cmple(seen.max).all(), "{exact:?} {seen:?}");
                    exact_area += f64::from(exact.half_area());
                    seen_area += f64::from(seen.half_area());
                }
            }
        }
        seen_area / exact_area
    }

    fn built(triangles: &[[Vec3; 3]]) -> Bvh {
        let primitives = Primitives {
            triangles,
            ..Primitives::default()
        };
        build(&primitives, Accel::Bvh).bvh
    }

    #[test]
    fn boxes_contain_the_exact_ones() {
        for subject in [meshes::ball(20), meshes::terrain(40), meshes::soup(3000)] {
            let grown = contained(&built(&subject.triangles));
            assert!((1.0..1.05).contains(&grown), "{grown}");
        }
    }

    /// Far from the origin, where a step is less than the distance of neighbouring numbers; flat; in one place; tiny.
    #[test]
    fn boxes_contain_the_exact_ones_at_the_extremes() {
        let mut random = Random::new(5);
        let mut scattered = |scale: [f32; 3], offset: f32| -> Vec<[Vec3; 3]> {
            let mut vertex = || {
                let unit = [0; 3].map(|_| random.unit() as f32 - 0.5);
                Vec3::from(unit) * Vec3::from(scale) + offset
            };
            (0..2000).map(|_| [vertex(), vertex(), vertex()]).collect()
        };
        for (scale, offset) in [
            ([1.0, 1.0, 1.0], 1e6),
            ([1.0, 1e-6, 1.0], -3e5),
            ([0.0, 1.0, 1.0], 0.1),
            ([0.0, 0.0, 0.0], 7.0),
            ([1e-38, 1e-39, 1e-44], 0.0),
            ([1e30, 1e25, 1e20], 0.0),
        ] {
            contained(&built(&scattered(scale, offset)));
        }
    }
}
