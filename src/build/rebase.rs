//! Rebase: the map from authored space to scene units, in which the scene is about 1 wide and near 0.
//!
//! Computed from the rest pose alone. The scale is a power of two and the origin lies on a grid of powers of two, so
//! that a scene that is scaled by one or moved along the other gives the same bits.

use super::extract::Extracted;
use crate::asset::{AssetStore, Mesh, MeshId};
use crate::flat::Rebase;
use crate::math::{DAffine3, DMat3, DVec3};
use crate::world::Pose;
use std::collections::BTreeMap;

/// A sphere this many times as wide as the rest of the scene is a wall: it neither widens the grid nor enters the tree.
pub(crate) const WALL_RATIO: f64 = 16.0;

/// The grid's step is the extent's power of two divided by two to this: fine enough to centre the scene, coarse enough
/// for authored coordinates to be exact multiples of it.
const GRID_BITS: i32 = 20;

/// Exponents of extents are kept in this range, in which the scale and its reciprocal are normal numbers.
const MAX_EXPONENT: i32 = 1000;

/// An axis-aligned box in f64; the f32 box of the buffers is rounded from it at the end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    pub(crate) min: DVec3,
    pub(crate) max: DVec3,
}

impl Extent {
    pub(crate) const EMPTY: Extent = Extent {
        min: DVec3::INFINITY,
        max: DVec3::NEG_INFINITY,
    };

    pub(crate) fn add(&mut self, p: DVec3) {
        self.min = self.min.min(p);
        self.max = self.max.max(p);
    }

    /// The longest side; 0 when empty.
    fn longest(&self) -> f64 {
        (self.max - self.min).max_element().max(0.0)
    }

    fn of_points(points: &[DVec3], to: &DAffine3) -> Extent {
        let mut extent = Extent::EMPTY;
        for point in points {
            extent.add(to.transform_point3(*point));
        }
        extent
    }

    fn union(&mut self, other: &Extent) {
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }
}

/// The rebase of a scene at rest.
pub(crate) fn of_scene(rest: &Extracted, store: &AssetStore) -> Rebase {
    let (camera, _) = &rest.camera;
    let near = Rebase {
        origin: camera.anchor.to_array(),
        scale: 1.0,
    };
    let mut extent = Extent::EMPTY;
    extent.add(to_scene(camera, &near).translation);
    let mut points: BTreeMap<MeshId, Vec<DVec3>> = BTreeMap::new();
    for item in &rest.meshes {
        let to = to_scene(item.look.pose, &near);
        let points = points.entry(item.mesh);
        let points = points.or_insert_with(|| used_points(store.mesh(item.mesh)));
        extent.union(&Extent::of_points(points, &to));
    }
    let mut spheres: Vec<(f64, DVec3)> = rest
        .spheres
        .iter()
        .map(|s| {
            let center = to_scene(s.look.pose, &near).translation;
            (s.radius * s.look.pose.size, center)
        })
        .collect();
    spheres.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (radius, center) in spheres {
        let rest = extent.longest();
        if rest > 0.0 && 2.0 * radius >= WALL_RATIO * rest {
            break;
        }
        extent.add(center - radius);
        extent.add(center + radius);
    }
    on_grid(&extent, camera.anchor)
}

/// The rebase of a mesh's own space, for local geometry.
pub(crate) fn of_mesh(mesh: &Mesh) -> Rebase {
    let extent = Extent::of_points(&used_points(mesh), &DAffine3::IDENTITY);
    on_grid(&extent, DVec3::ZERO)
}

/// The vertices of all triangles, each once.
fn used_points(mesh: &Mesh) -> Vec<DVec3> {
    let mut used = vec![false; mesh.positions.len()];
    for corner in &mesh.corners {
        used[*corner as usize] = true;
    }
    let points = mesh.positions.iter().zip(used);
    points
        .filter(|(_, used)| *used)
        .map(|(point, _)| *point)
        .collect()
}

/// Centres and scales an extent whose coordinates are relative to `reference`.
fn on_grid(extent: &Extent, reference: DVec3) -> Rebase {
    let exponent = ceil_log2(extent.longest());
    let step = power_of_two(exponent - GRID_BITS);
    let center = 0.5 * extent.min + 0.5 * extent.max;
    let center = if center.is_finite() {
        center
    } else {
        DVec3::ZERO
    };
    // The reference's own place on the grid first: what is left is small, and the same wherever the scene stands.
    let snapped = reference.map(|x| round(x / step));
    let rest = center + (reference - snapped * step);
    let origin = (snapped + rest.map(|x| round(x / step))) * step;
    Rebase {
        origin: origin.to_array(),
        scale: power_of_two(-exponent),
    }
}

/// The nearest whole number, halves up: unlike rounding to even, it does not depend on where 0 is.
fn round(x: f64) -> f64 {
    let below = x.floor();
    if x - below >= 0.5 { below + 1.0 } else { below }
}

/// Smallest e with x ≤ 2^e, by the exponent bits; 0 for what has no extent.
fn ceil_log2(x: f64) -> i32 {
    if !(x.is_finite() && x > 0.0) {
        return 0;
    }
    let bits = x.to_bits();
    let exponent = ((bits >> 52) as i32) - 1023;
    let fraction = bits & ((1 << 52) - 1);
    (exponent + i32::from(fraction != 0)).clamp(-MAX_EXPONENT, MAX_EXPONENT)
}

/// 2^e for e in the range of normal numbers.
fn power_of_two(e: i32) -> f64 {
    f64::from_bits(((e.clamp(-1022, 1023) + 1023) as u64) << 52)
}

/// The map from an entity's own space to scene units, in f64.
///
/// The origin is subtracted from the anchor first: both lie on coarse grids, so that the difference is exact.
pub(crate) fn to_scene(pose: &Pose, rebase: &Rebase) -> DAffine3 {
    let origin = DVec3::from_array(rebase.origin);
    DAffine3 {
        matrix3: pose.linear * rebase.scale,
        translation: ((pose.anchor - origin) + pose.offset) * rebase.scale,
    }
}

/// The map from a mesh's own space to its local units, in f64.
pub(crate) fn to_local(rebase: &Rebase) -> DAffine3 {
    DAffine3 {
        matrix3: DMat3::from_diagonal(DVec3::splat(rebase.scale)),
        translation: DVec3::from_array(rebase.origin) * -rebase.scale,
    }
}

/// The map from local units of a mesh to scene units, in f64.
pub(crate) fn local_to_scene(local: &Rebase, pose: &Pose, scene: &Rebase) -> DAffine3 {
    let to = to_scene(pose, scene);
    DAffine3 {
        matrix3: to.matrix3 * (1.0 / local.scale),
        translation: to.transform_point3(DVec3::from_array(local.origin)),
    }
}

/// The largest f32 that is not above `x`.
pub(crate) fn round_down(x: f64) -> f32 {
    let y = x as f32;
    if f64::from(y) > x { y.next_down() } else { y }
}

/// The smallest f32 that is not below `x`.
pub(crate) fn round_up(x: f64) -> f32 {
    let y = x as f32;
    if f64::from(y) < x { y.next_up() } else { y }
}
