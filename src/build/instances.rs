//! Instances: a local geometry's place in the scene, composed and inverted in f64 and rounded once, with a box that no
//! rounding of a ray's transform can leave.

use super::extract::MeshItem;
use super::meshes::{LocalMesh, mirrors};
use super::rebase::{local_to_scene, round_down, round_up};
use crate::flat::{Instance, Rebase};
use crate::math::{Aabb, DAffine3, DVec3, Vec3};

/// Unit roundoff of f32.
const UNIT: f64 = 1.0 / 16_777_216.0;

/// Roundings on the longest way from a coordinate to its transform: the matrix entry, a product, three additions, and
/// the rounding of the ray's own coordinate; two to spare.
const ROUNDINGS: f64 = 8.0;

/// γ_n = n u / (1 − n u): Higham, Accuracy and Stability of Numerical Algorithms, lemma 3.1.
const GAMMA: f64 = ROUNDINGS * UNIT / (1.0 - ROUNDINGS * UNIT);

/// Coordinates that rays inside the scene start from and end at, scene units: the scene is about 1 wide around 0.
const REACH: f64 = 2.0;

/// The flat instance, whose places in the scene's tables are the caller's to fill in.
pub(crate) fn instance(local: &LocalMesh, item: &MeshItem, scene: &Rebase) -> Instance {
    let to_world = local_to_scene(&local.rebase, item.look.pose, scene);
    let to_local = to_world.inverse();
    let bounds = bounds(local, &to_world, &to_local);
    Instance {
        to_world: rows(&to_world),
        to_local: rows(&to_local),
        bounds: [bounds.min.to_array(), bounds.max.to_array()],
        geometry: 0,
        materials: 0,
        object: item.look.object(),
        mirrored: mirrors(&to_world.matrix3),
    }
}

/// Whether f32 can hold its maps: a mesh that is scaled to (almost) nothing along some axis has no way back, and must be
/// flattened.
pub(crate) fn is_invertible(instance: &Instance) -> bool {
    let entries = instance.to_world.iter().chain(&instance.to_local);
    entries.flatten().all(|x| x.is_finite())
}

/// A box of the transformed vertices, outward by what rounding can move a ray or a hit.
///
/// With M, m the map to the scene, A, a the map back, |·| entry by entry, and R = max(`REACH`, box): a ray's origin
/// and any point along it reach local space with an error of at most γ (|A| R + |a|), which is |M| times that in the
/// scene; a hit comes back with an error of at most γ (|M||p| + |m|). Each is taken twice for the ray's origin and its
/// direction.
fn bounds(local: &LocalMesh, to_world: &DAffine3, to_local: &DAffine3) -> Aabb {
    let Some(extent) = local.support.extent(to_world) else {
        return Aabb::EMPTY;
    };
    let reach = extent
        .min
        .abs()
        .max(extent.max.abs())
        .max(DVec3::splat(REACH));
    let (m, a) = (to_world.matrix3.abs(), to_local.matrix3.abs());
    let there = m * (a * reach + to_local.translation.abs());
    let back = m * local.farthest + to_world.translation.abs();
    let slack = 2.0 * GAMMA * (there + back);
    let (min, max) = (extent.min - slack, extent.max + slack);
    Aabb {
        min: Vec3::from_array(min.to_array().map(round_down)),
        max: Vec3::from_array(max.to_array().map(round_up)),
    }
}

fn rows(m: &DAffine3) -> [[f32; 4]; 3] {
    let [x, y, z, t] = [
        m.matrix3.x_axis,
        m.matrix3.y_axis,
        m.matrix3.z_axis,
        m.translation,
    ];
    [0, 1, 2].map(|i| [x[i] as f32, y[i] as f32, z[i] as f32, t[i] as f32])
}
