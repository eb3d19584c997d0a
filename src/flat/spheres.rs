//! Spheres: f64 centres and radii for the final root, f32 boxes to find the candidates.

use super::{BLOCK, MaterialId, ObjectId};

/// Eight spheres in lanes, in leaf order. Unused lanes have an empty box (`min = +∞`, `max = −∞`) and radius 0.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct SphereBlock {
    /// `bounds[0..3]` minima, `bounds[3..6]` maxima, rounded outward from f64; scene units.
    pub bounds: [[f32; BLOCK]; 6],
    /// Centre, scene units, f64: `center[axis][lane]`.
    pub center: [[f64; BLOCK]; 3],
    /// Radius, scene units, f64.
    pub radius: [f64; BLOCK],
    /// Sphere index of each lane, authoring order. `u32::MAX` in unused lanes.
    pub prim: [u32; BLOCK],
}

/// All spheres of the scene. A sphere's *primitive id* in hits is `TAG | index`.
#[derive(Clone, Debug, Default)]
pub struct Spheres {
    /// Spheres outside the tree, tested by every ray: walls and other huge ones (their boxes would spoil the tree),
    /// and all of them in a scene of few. Spheres in authoring order, `u32::MAX`-padded.
    pub looped: Vec<SphereBlock>,
    /// Spheres in the tree, in leaf order.
    pub blocks: Vec<SphereBlock>,
    /// Centre and radius of each in authoring order, scene units: what is read together lies together.
    pub placed: Vec<[f64; 4]>,
    /// Whether normals point inward.
    pub inverted: Vec<bool>,
    /// Material of each.
    pub material: Vec<MaterialId>,
    /// Object of each.
    pub object: Vec<ObjectId>,
    /// Row-major rotation from scene axes to the sphere's own, for its texture coordinates; empty unless a sphere is
    /// textured or uv is asked for.
    pub to_local: Vec<[f32; 9]>,
}

impl Spheres {
    /// Marks a sphere's primitive id in a hit.
    pub const TAG: u32 = 1 << 31;

    /// Centre of a sphere.
    #[inline(always)]
    #[must_use]
    pub fn center(&self, sphere: usize) -> [f64; 3] {
        let [x, y, z, _] = self.placed[sphere];
        [x, y, z]
    }

    /// Radius of a sphere.
    #[inline(always)]
    #[must_use]
    pub fn radius(&self, sphere: usize) -> f64 {
        self.placed[sphere][3]
    }
}
