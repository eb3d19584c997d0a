//! Axis-aligned boxes in f32, the only box type of the buffers.

use glam::Vec3;

/// An axis-aligned box. Empty when any `min` component exceeds its `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates.
    pub min: Vec3,
    /// Largest coordinates.
    pub max: Vec3,
}

impl Aabb {
    /// The box that contains nothing and changes nothing in a union.
    pub const EMPTY: Aabb = Aabb {
        min: Vec3::INFINITY,
        max: Vec3::NEG_INFINITY,
    };

    /// The box of one point.
    #[must_use]
    pub fn point(p: Vec3) -> Aabb {
        Aabb { min: p, max: p }
    }

    /// The smallest box that contains both.
    #[must_use]
    pub fn union(self, other: Aabb) -> Aabb {
        Aabb {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// The smallest box that contains this one and the point.
    #[must_use]
    pub fn with(self, p: Vec3) -> Aabb {
        self.union(Aabb::point(p))
    }

    /// Half of the surface area: the surface area heuristic needs ratios only.
    #[must_use]
    pub fn half_area(&self) -> f32 {
        let e = self.max - self.min;
        e.x * e.y + e.y * e.z + e.z * e.x
    }

    /// Whether it contains nothing.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !(self.min.x <= self.max.x && self.min.y <= self.max.y && self.min.z <= self.max.z)
    }

    /// Whether `other` lies inside, borders included.
    #[must_use]
    pub fn contains(&self, other: &Aabb) -> bool {
        self.min.cmple(other.min).all() && self.max.cmpge(other.max).all()
    }
}
