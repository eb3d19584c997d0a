//! Blocks: triangles and spheres in lanes.
#![allow(
    clippy::needless_range_loop,
    reason = "axes are numbers here: several arrays are indexed by one"
)]

use super::tree::{Child, Grove};
use super::{SPHERES, SphereItem, sphere_bounds};
use crate::flat::{BLOCK, LinearNode, SphereBlock, TriangleBlock, Triangles};
use crate::math::{Vec3, pages};
use std::sync::atomic::{AtomicU32, Ordering};

/// What there is of a tree's lowest level before the tree: all of it in the fast mode, nothing otherwise.
pub(super) struct Ready {
    /// Blocks along the curve.
    pub(super) blocks: Vec<TriangleBlock>,
    /// What each item of kind `READY` stands for: a block, or a node of `grove` over blocks.
    pub(super) children: Vec<Child>,
    /// Nodes over up to eight blocks, one for each child, unused where that is a block.
    pub(super) grove: Grove,
    /// See [`Triangles::place`]; noted by whoever writes a block, on any thread.
    pub(super) place: Vec<AtomicU32>,
}

impl Ready {
    /// Nothing of so many triangles.
    pub(super) fn new(triangles: usize) -> Ready {
        let mut place = pages::with_capacity(triangles);
        place.resize_with(triangles, AtomicU32::default);
        Ready {
            blocks: Vec::new(),
            children: Vec::new(),
            grove: Grove::default(),
            place,
        }
    }

    /// With further blocks behind those that are there.
    pub(super) fn with(mut self, further: Vec<TriangleBlock>) -> Triangles {
        if self.blocks.is_empty() {
            self.blocks = further;
        } else {
            self.blocks.extend(further);
        }
        let place = self.place.into_iter();
        Triangles {
            blocks: self.blocks,
            place: place.map(AtomicU32::into_inner).collect(),
        }
    }
}

/// Block number `at`, of the `count` triangles that `prim` names, whose places it notes.
pub(super) fn triangle_block(
    triangles: &[[Vec3; 3]],
    count: usize,
    prim: impl Fn(usize) -> u32,
    at: usize,
    place: &[AtomicU32],
) -> TriangleBlock {
    let mut block = TriangleBlock {
        v: [[[0.0; BLOCK]; 3]; 3],
        prim: [u32::MAX; BLOCK],
    };
    for lane in 0..BLOCK {
        let vertices = if lane < count {
            let prim = prim(lane);
            block.prim[lane] = prim;
            place[prim as usize].store((BLOCK * at + lane) as u32, Ordering::Relaxed);
            finite_or_nan(triangles[prim as usize])
        } else {
            [Vec3::NAN; 3]
        };
        for (k, vertex) in vertices.iter().map(Vec3::to_array).enumerate() {
            for axis in 0..3 {
                block.v[k][axis][lane] = vertex[axis];
            }
        }
    }
    block
}

/// A triangle whose corners are not all finite as one that no ray hits: infinite ones a ray might.
fn finite_or_nan(v: [Vec3; 3]) -> [Vec3; 3] {
    // Zero times what is not finite is not a number.
    if (v[0] * 0.0 + v[1] * 0.0 + v[2] * 0.0) == Vec3::ZERO {
        v
    } else {
        [Vec3::NAN; 3]
    }
}

/// A block of so many spheres as there are lanes, or fewer.
pub(super) fn sphere_block(spheres: &[SphereItem]) -> SphereBlock {
    let mut block = SphereBlock {
        bounds: LinearNode::EMPTY.planes.map(|p| [p[0]; SPHERES]),
        center: [[0.0; SPHERES]; 3],
        radius: [0.0; SPHERES],
        prim: [u32::MAX; SPHERES],
    };
    for (lane, s) in spheres.iter().enumerate() {
        let bounds = sphere_bounds(s.center, s.radius);
        for axis in 0..3 {
            block.bounds[axis][lane] = bounds.min[axis];
            block.bounds[axis + 3][lane] = bounds.max[axis];
            block.center[axis][lane] = s.center[axis];
        }
        block.radius[lane] = s.radius;
        block.prim[lane] = s.prim;
    }
    block
}
