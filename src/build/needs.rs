//! What a scene requires, read off its buffers.

use crate::flat::{FlatScene, Geometry, Needs, Opacity, Scatter};

/// The needs of a scene whose buffers are complete.
pub(crate) fn needs(scene: &FlatScene) -> Needs {
    let geometries = || std::iter::once(&scene.world).chain(scene.local.iter().map(AsRef::as_ref));
    let any = |has: fn(&Geometry) -> bool| geometries().any(has);
    let scatters = |scatter| scene.materials.iter().any(|m| m.scatter == scatter);
    Needs {
        triangles: any(|g| !g.triangles.place.is_empty()),
        tree_spheres: !scene.spheres.blocks.is_empty(),
        looped_spheres: !scene.spheres.looped.is_empty(),
        instances: !scene.instances.is_empty(),
        smooth_normals: any(|g| !g.shading.normals.corner.is_empty()),
        uvs: any(|g| !g.shading.uvs.is_empty()) || !scene.spheres.to_local.is_empty(),
        uvs1: any(|g| !g.shading.uvs1.is_empty()),
        vertex_colors: any(|g| !g.shading.colors.is_empty()),
        textures: !scene.textures.is_empty(),
        opacity: scene.materials.iter().any(|m| m.opacity != Opacity::Full),
        lens: scene.camera.aperture_radius > 0.0,
        lights: !scene.lights.is_empty(),
        punctual: !scene.lights.punctual.is_empty(),
        background: scene.background != [0.0; 3],
        environment: scene.environment.is_some(),
        diffuse: scatters(Scatter::Diffuse),
        mirror: scatters(Scatter::Mirror),
        glass: scatters(Scatter::Glass),
        plastic: scatters(Scatter::Plastic),
        metal: scatters(Scatter::Metal),
    }
}
