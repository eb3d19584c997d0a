//! The points that a mesh or a glTF file shows.

use crate::asset::{Loader, Mesh, Model};
use crate::math::DVec3;

/// Every position of a mesh.
#[must_use]
pub fn of_mesh(mesh: &Mesh) -> Vec<DVec3> {
    mesh.positions.clone()
}

/// Those of all meshes of a file, where its nodes put them. `loader` has read it.
#[must_use]
pub fn of_model(model: &Model, loader: &Loader) -> Vec<DVec3> {
    let placed = model.placed();
    let points = placed.iter().flat_map(|(mesh, to)| {
        let positions = &loader.loaded(*mesh).positions;
        positions.iter().map(|p| to.transform_point3(*p))
    });
    points.collect()
}
