//! Axis-aligned boxes in double precision.

use crate::asset::Mesh;
use crate::math::{DAffine3, DVec3};

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    pub(super) min: DVec3,
    pub(super) max: DVec3,
}

impl Bounds {
    /// Contains nothing.
    pub(super) const EMPTY: Bounds = Bounds {
        min: DVec3::INFINITY,
        max: DVec3::NEG_INFINITY,
    };

    /// Of the vertices that triangles use.
    pub(super) fn of_mesh(mesh: &Mesh) -> Bounds {
        let used = mesh
            .corners
            .iter()
            .filter_map(|c| mesh.positions.get(*c as usize));
        used.fold(Bounds::EMPTY, |bounds, p| bounds.with(*p))
    }

    pub(super) fn with(self, p: DVec3) -> Bounds {
        Bounds {
            min: self.min.min(p),
            max: self.max.max(p),
        }
    }

    pub(super) fn union(self, other: Bounds) -> Bounds {
        Bounds {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    pub(super) fn corners(&self) -> [DVec3; 8] {
        [0, 1, 2, 3, 4, 5, 6, 7].map(|i| {
            let side = |axis: usize| match i >> axis & 1 {
                0 => self.min[axis],
                _ => self.max[axis],
            };
            DVec3::new(side(0), side(1), side(2))
        })
    }

    /// The box of this one's corners under a map.
    pub(super) fn moved(&self, to: &DAffine3) -> Bounds {
        let corners = self.corners().map(|p| to.transform_point3(p));
        corners.into_iter().fold(Bounds::EMPTY, Bounds::with)
    }

    pub(super) fn center(&self) -> DVec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// The longest side; 0 when empty.
    pub(super) fn longest(&self) -> f64 {
        (self.max - self.min).max_element().max(0.0)
    }

    /// The shortest side.
    pub(super) fn shortest(&self) -> f64 {
        (self.max - self.min).min_element().max(0.0)
    }

    pub(super) fn contains(&self, p: DVec3) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }

    /// The farthest that a coordinate of the box is from those of `p`.
    pub(super) fn reach(&self, p: DVec3) -> f64 {
        (self.max - p).abs().max((self.min - p).abs()).max_element()
    }
}
