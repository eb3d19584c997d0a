//! Items: primitives as the builder sees them, a box and a name in 32 bytes, and what is known of a range of them.

use super::{Primitives, sphere_bounds};
use crate::flat::BLOCK;
use crate::flat::bvh::WIDTH;
use crate::math::{Aabb, Vec3, pages};
use glam::Vec4;
use rayon::prelude::*;

/// What an item is, as bits, so that a range can hold several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kinds(u32);

impl Kinds {
    pub(super) const TRIANGLE: Kinds = Kinds(1 << 8);
    pub(super) const SPHERE: Kinds = Kinds(1 << 9);
    pub(super) const INSTANCE: Kinds = Kinds(1 << 10);
    /// Triangles that are blocks already, and a node over these if there are several.
    pub(super) const READY: Kinds = Kinds(1 << 11);
    /// All that stands still, whose tree is there already.
    pub(super) const STANDING: Kinds = Kinds(1 << 12);
    const ALL: u32 = 31 << 8;

    /// Whether there is more than one.
    pub(super) fn mixed(self) -> bool {
        self.0.count_ones() > 1
    }

    /// Triangles before spheres before instances.
    pub(super) fn order(self) -> u32 {
        self.0
    }
}

/// Integers that ride in the fourth lane of a coordinate register have this bit flipped: arithmetic on the whole
/// register must not meet denormal numbers, which some processors are slow at.
const RIDER: u32 = 1 << 30;

/// Low bits of the second rider: units, of which a ready node has most.
const UNITS: u32 = 0xff;
const _: () = assert!(WIDTH * BLOCK <= UNITS as usize);

/// The smallest coordinates of the box of nothing. Finite, so that its centre is a number.
const NOTHING: Vec4 = Vec4::MAX;

/// A primitive as the builder sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    /// Smallest coordinates; `w` is the index of the primitive among those of its kind.
    pub(super) min: Vec4,
    /// Largest coordinates; `w` is its kind and its units.
    pub(super) max: Vec4,
}

impl Item {
    pub(super) fn new(bounds: Bounds, kind: Kinds, index: usize, units: usize) -> Item {
        let rider = |x: u32| f32::from_bits(x ^ RIDER);
        Item {
            min: bounds.min.with_w(rider(index as u32)),
            max: bounds.max.with_w(rider(kind.0 | units as u32)),
        }
    }

    /// Index among those of its kind.
    pub(super) fn index(&self) -> u32 {
        self.min.w.to_bits() ^ RIDER
    }

    /// What it is.
    pub(super) fn kind(&self) -> Kinds {
        Kinds(self.max.w.to_bits() & Kinds::ALL)
    }

    /// A triangle or a sphere is a lane of a block; an instance weighs as much as a block of triangles, since a whole
    /// walk hangs on it.
    pub(super) fn units(&self) -> u32 {
        self.max.w.to_bits() & UNITS
    }

    /// Twice the centre of the box.
    #[inline]
    pub(super) fn center(&self) -> Vec4 {
        self.min + self.max
    }
}

/// A box in registers; the fourth lanes mean nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub(super) min: Vec4,
    pub(super) max: Vec4,
}

impl Bounds {
    pub(super) const NOTHING: Bounds = Bounds {
        min: NOTHING,
        max: Vec4::MIN,
    };

    #[inline]
    pub(super) fn add(&mut self, min: Vec4, max: Vec4) {
        self.min = self.min.min(min);
        self.max = self.max.max(max);
    }

    #[inline]
    pub(super) fn union(self, other: &Bounds) -> Bounds {
        Bounds {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// Half of the surface area; 0 for the box of nothing.
    #[inline]
    pub(super) fn half_area(&self) -> f32 {
        let e = (self.max - self.min).max(Vec4::ZERO);
        e.x * e.y + (e.x + e.y) * e.z
    }

    /// Twice the centre.
    #[inline]
    pub(super) fn center(&self) -> Vec4 {
        self.min + self.max
    }

    pub(super) fn aabb(&self) -> Aabb {
        let b = Aabb {
            min: self.min.truncate(),
            max: self.max.truncate(),
        };
        if b.is_empty() { Aabb::EMPTY } else { b }
    }
}

impl From<&[Vec3; 3]> for Bounds {
    /// The box of a triangle; of nothing if something is not finite.
    #[inline]
    fn from(v: &[Vec3; 3]) -> Bounds {
        let [a, b, c] = v.map(|v| v.extend(0.0));
        // Zero times what is not finite is not a number.
        if (a * 0.0 + b * 0.0 + c * 0.0).cmpeq(Vec4::ZERO).all() {
            Bounds {
                min: a.min(b).min(c),
                max: a.max(b).max(c),
            }
        } else {
            Bounds::NOTHING
        }
    }
}

impl From<Aabb> for Bounds {
    fn from(b: Aabb) -> Bounds {
        if b.is_empty() {
            Bounds::NOTHING
        } else {
            Bounds {
                min: b.min.extend(0.0),
                max: b.max.extend(0.0),
            }
        }
    }
}

/// What is known of a range of items.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    /// The box of all.
    pub(super) bounds: Bounds,
    /// The box of their [`Item::center`]s.
    pub(super) centers: Bounds,
    /// What they are.
    pub(super) kinds: Kinds,
}

impl Extent {
    pub(super) const NOTHING: Extent = Extent {
        bounds: Bounds::NOTHING,
        centers: Bounds::NOTHING,
        kinds: Kinds(0),
    };

    #[inline]
    pub(super) fn add(&mut self, item: &Item) {
        let center = item.center();
        self.bounds.add(item.min, item.max);
        self.centers.add(center, center);
        self.kinds.0 |= item.max.w.to_bits() & Kinds::ALL;
    }

    pub(super) fn union(self, other: &Extent) -> Extent {
        Extent {
            bounds: self.bounds.union(&other.bounds),
            centers: self.centers.union(&other.centers),
            kinds: Kinds(self.kinds.0 | other.kinds.0),
        }
    }

    pub(super) fn of(items: &[Item]) -> Extent {
        let mut extent = Extent::NOTHING;
        items.iter().for_each(|i| extent.add(i));
        extent
    }
}

/// One item per triangle.
pub(super) fn triangles(p: &Primitives) -> Vec<Item> {
    let mut items = pages::with_capacity(p.triangles.len() + p.spheres.len() + p.instances.len());
    p.triangles
        .par_iter()
        .with_min_len(super::CHUNK)
        .enumerate()
        .map(|(i, t)| Item::new(t.into(), Kinds::TRIANGLE, i, 1))
        .collect_into_vec(&mut items);
    items
}

/// One item per sphere, then one per instance.
pub(super) fn others(p: &Primitives) -> impl Iterator<Item = Item> {
    let spheres = p.spheres.iter().enumerate().map(|(i, s)| {
        let bounds = sphere_bounds(s.center, s.radius);
        Item::new(bounds.into(), Kinds::SPHERE, i, 1)
    });
    let instances = p.instances.iter().enumerate().map(|(i, &b)| {
        let bounds = super::finite_or_empty(b);
        Item::new(bounds.into(), Kinds::INSTANCE, i, BLOCK)
    });
    spheres.chain(instances)
}
