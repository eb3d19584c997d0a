//! Spheres: f64 centres and radii in scene units, in the tree or in the loop beside it.

use super::bvh::{self, SphereItem as Item};
use super::extract::SphereItem;
use super::materials::Tables;
use super::rebase::{WALL_RATIO, to_scene};
use crate::flat::{MaterialId, Rebase, Spheres};
use crate::math::DMat3;

/// Up to this many spheres are tested one after the other, two blocks of eight: as fast as walking a tree over them.
const LOOP_ALL: usize = 16;

/// Flattens all spheres; those that belong in the tree come back beside them: first those that stand still, then those that
/// move.
pub(crate) fn flatten(
    items: &[SphereItem],
    rebase: &Rebase,
    tables: &mut Tables,
    rotations: bool,
) -> (Spheres, [Vec<Item>; 2]) {
    let mut spheres = Spheres::default();
    let mut looped = Vec::new();
    let mut in_tree = [Vec::new(), Vec::new()];
    for (prim, item) in items.iter().enumerate() {
        let pose = item.look.pose;
        let center = to_scene(pose, rebase).translation.to_array();
        let radius = item.radius * pose.size * rebase.scale;
        let material: MaterialId = tables.resolve(&item.look, None);
        let [x, y, z] = center;
        spheres.placed.push([x, y, z, radius]);
        spheres.inverted.push(item.inverted);
        spheres.material.push(material);
        spheres.object.push(item.look.object());
        if rotations {
            spheres.to_local.push(to_local(&pose.linear, pose.size));
        }
        let placed = Item {
            center,
            radius,
            prim: prim as u32,
        };
        // The rest of the scene is 1 wide.
        let wall = 2.0 * radius >= WALL_RATIO;
        let list = if wall || items.len() <= LOOP_ALL {
            &mut looped
        } else {
            &mut in_tree[usize::from(item.look.moves)]
        };
        list.push(placed);
    }
    spheres.looped = bvh::sphere_blocks(&looped);
    (spheres, in_tree)
}

/// Row-major inverse of the rotation: the transpose of the map, without its uniform scale. Its rows are the map's
/// columns, one after the other.
fn to_local(linear: &DMat3, size: f64) -> [f32; 9] {
    linear.to_cols_array().map(|x| (x / size) as f32)
}
