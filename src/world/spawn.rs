//! Spawn: a description becomes a world, and the files that it names a store.

use super::columns::{Rows, camera_of, normals};
use super::components::{
    AuthoringIndex, Color, Emissive, Keys, Material, Scattering, Shape, Sky, Transform,
};
use super::expand::{self, Root, expand};
use super::{Pose, codes, files::Files, pose};
use crate::asset::{AssetStore, Filter, Loader, MAX_RADIANCE, Mesh, MeshId, ModelId, Wrap};
use crate::diag::{self, Diagnostic, Severity};
use crate::math::{DMat3, DVec3, unit};
use crate::scene::{
    BackgroundDesc, CameraPose, ColorDesc, EntityDesc, GltfDesc, MaterialDesc, Placed, SceneDesc,
    ShapeDesc, TextureFilterDesc, WrapDesc,
};
use hecs::{Entity, World};
use std::collections::BTreeSet;

/// What [`spawn`] gives.
pub struct Spawned {
    /// One entity for each of the scene's, and one for a camera at top level; posed at rest.
    pub world: World,
    /// Every file that the scene names.
    pub assets: AssetStore,
    /// What the files, and the use that the scene makes of them, should be told of.
    pub warnings: Vec<Diagnostic>,
}

/// Loads every file with `loader` and spawns every entity of a scene.
///
/// # Errors
/// Everything that is wrong with files, each at the place in the scene that names the file or at its own line; textured
/// materials on meshes without texture coordinates; entities out of reach. The warnings follow the errors.
pub fn spawn(desc: &SceneDesc, loader: Loader) -> Result<Spawned, Vec<Diagnostic>> {
    let mut files = Files::new(desc, loader);
    files.textures_ahead(images(desc));
    let materials: Vec<Option<Material>> = desc
        .materials
        .iter()
        .map(|m| material(&m.material, &mut files))
        .collect();
    let sources: Vec<Source> = desc
        .entities
        .iter()
        .map(|entity| Source::load(&entity.value, &mut files))
        .collect();
    let sky = sky(desc, &mut files);
    let (assets, mut warnings, mut errors) = files.finish();

    let mut world = World::new();
    let entities: Vec<Entity> = desc.entities.iter().map(|_| world.spawn(())).collect();
    // Each with the index of the entity in the scene.
    let mut nodes: Vec<(usize, Entity)> = Vec::new();
    let mut cameras: Vec<(Entity, f64)> = Vec::new();
    let rows = Rows {
        desc,
        entities: &entities,
        sources: &sources,
        materials: &materials,
    };
    rows.insert(&mut world);
    for (i, entity) in desc.entities.iter().enumerate() {
        let entity = &entity.value;
        if let (Source::Model(model), Some(gltf)) = (sources[i], &entity.gltf) {
            let root = Root {
                entity: entities[i],
                index: i as u32,
                lights: gltf.lights,
                material: entity.material.and_then(|m| *materials.get(m)?),
                normals: normals(entity.normals),
                emissive: entity.emissive.map(Emissive),
            };
            let model = assets.model(model);
            let spawned = expand(&mut world, model, &root);
            let with_camera = spawned.iter().zip(&model.nodes);
            cameras.extend(with_camera.filter_map(|(e, node)| Some((*e, node.camera_vfov_deg?))));
            nodes.extend(spawned.into_iter().map(|e| (i, e)));
        }
        for mesh in sources[i].meshes(&assets) {
            match missing_uv(desc, i, assets.mesh(mesh)) {
                Some(error) if error.severity == Severity::Error => errors.push(error),
                found => warnings.extend(found),
            }
        }
    }
    let last = AuthoringIndex {
        entity: desc.entities.len() as u32,
        node: 0,
    };
    if let Some(sky) = sky {
        world.spawn((AuthoringIndex { node: 1, ..last }, sky));
    }
    if let Some(camera) = &desc.camera {
        world.spawn((
            last,
            camera_transform(camera.pose.as_ref()),
            camera_of(camera),
        ));
    }
    match take_camera(desc, &mut world, &cameras) {
        Some(error) if error.severity == Severity::Error => errors.push(error),
        found => warnings.extend(found),
    }
    let entities = || entities.iter().copied().enumerate();
    let mut lost = BTreeSet::new();
    for t in key_times(&world).into_iter().chain([0.0]) {
        pose(&mut world, t);
        lost.extend(out_of_reach(
            &world,
            nodes.iter().copied().chain(entities()),
        ));
    }
    errors.extend(lost.into_iter().map(|i| told_out_of_reach(desc, i)));
    if errors.is_empty() {
        Ok(Spawned {
            world,
            assets,
            warnings,
        })
    } else {
        errors.extend(warnings);
        Err(errors)
    }
}

/// Loads every file that a scene names and gives what there is to say about them: for a scene that has errors of its own
/// and does not become a world.
#[must_use]
pub fn open_files(desc: &SceneDesc, loader: Loader) -> Vec<Diagnostic> {
    let mut files = Files::new(desc, loader);
    files.textures_ahead(images(desc));
    for named in &desc.materials {
        material(&named.material, &mut files);
    }
    for entity in &desc.entities {
        Source::load(&entity.value, &mut files);
    }
    sky(desc, &mut files);
    let (_, warnings, mut found) = files.finish();
    found.extend(warnings);
    found
}

/// What an entity's triangles come from.
#[derive(Clone, Copy)]
pub(super) enum Source {
    Nothing,
    Mesh(MeshId),
    Model(ModelId),
}

impl Source {
    fn load(entity: &EntityDesc, files: &mut Files) -> Source {
        let mesh = match &entity.shape {
            Some(ShapeDesc::Mesh { path, mesh }) => files.mesh(path, *mesh).map(Source::Mesh),
            _ => None,
        };
        let model = |gltf: &GltfDesc| files.model(&gltf.path).map(Source::Model);
        mesh.or_else(|| entity.gltf.as_deref().and_then(model))
            .unwrap_or(Source::Nothing)
    }

    /// Each once.
    fn meshes(self, assets: &AssetStore) -> Vec<MeshId> {
        match self {
            Source::Nothing => Vec::new(),
            Source::Mesh(mesh) => vec![mesh],
            Source::Model(model) => assets
                .model(model)
                .meshes
                .iter()
                .flatten()
                .copied()
                .collect(),
        }
    }
}

/// Where the scene has no camera, that of a glTF file's node; what there is to say about it.
fn take_camera(
    desc: &SceneDesc,
    world: &mut World,
    cameras: &[(Entity, f64)],
) -> Option<Diagnostic> {
    if desc.camera.is_some() || desc.entities.iter().any(|e| e.value.camera.is_some()) {
        return None;
    }
    let Some((entity, vfov_deg)) = cameras.first() else {
        let says = "neither the scene nor its glTF files have a perspective camera";
        let hint = "add `camera: (at: (0, 0, 5), look_at: (0, 0, 0))` at top level";
        let error = Diagnostic::error(codes::NO_CAMERA, says).hint(hint);
        return Some(error.in_file(&desc.file));
    };
    // The entity was spawned a moment ago, so the only error, "no such entity", cannot happen.
    let _ = world.insert_one(*entity, expand::camera(*vfov_deg));
    if cameras.len() == 1 {
        return None;
    }
    let says = format!(
        "the glTF files bring {} cameras: the first one is taken",
        cameras.len()
    );
    let hint = "add a `camera` to the scene to choose";
    let warning = Diagnostic::warning(codes::MORE_CAMERAS, says).hint(hint);
    Some(warning.in_file(&desc.file))
}

/// Looks from `at` along −Z at `look_at`, with `up` in the plane of Y and Z. The reader has refused degenerate ones.
fn camera_transform(pose: Option<&CameraPose>) -> Transform {
    let Some(pose) = pose else {
        return Transform::default();
    };
    let [at, look_at, up] = [pose.at, pose.look_at, pose.up].map(DVec3::from_array);
    let forward = unit(look_at - at).unwrap_or(DVec3::NEG_Z);
    let up = unit(up).unwrap_or(DVec3::Y);
    let right = unit(forward.cross(up)).unwrap_or_else(|| forward.any_orthonormal_vector());
    Transform {
        translate: at,
        rotate: DMat3::from_cols(right, right.cross(forward), -forward),
        scale: DVec3::ONE,
    }
}

fn material(desc: &MaterialDesc, files: &mut Files) -> Option<Material> {
    let (scattering, color) = match desc {
        MaterialDesc::Diffuse { color } => (Scattering::Diffuse, color),
        MaterialDesc::Mirror { color } => (Scattering::Mirror, color),
        MaterialDesc::Glass { ior, color } => (Scattering::Glass { ior: *ior }, color),
        MaterialDesc::Plastic { ior, color } => (Scattering::Plastic { ior: *ior }, color),
        MaterialDesc::Metal { color, .. } => (Scattering::Metal, color),
    };
    let color = match color {
        ColorDesc::Linear(rgb) => Color::Linear(*rgb),
        ColorDesc::Image { path, wrap, filter } => Color::Texture {
            texture: files.texture(path)?,
            wrap: match wrap {
                WrapDesc::Repeat => Wrap::Repeat,
                WrapDesc::Mirror => Wrap::Mirror,
                WrapDesc::Clamp => Wrap::Clamp,
            },
            filter: texture_filter(*filter),
        },
    };
    Some(Material { scattering, color })
}

fn texture_filter(desc: TextureFilterDesc) -> Filter {
    match desc {
        TextureFilterDesc::Bilinear => Filter::Bilinear,
        TextureFilterDesc::Nearest => Filter::Nearest,
    }
}

/// The background, if it is an image.
fn sky(desc: &SceneDesc, files: &mut Files) -> Option<Sky> {
    let BackgroundDesc::Hdr(hdr) = &desc.background else {
        return None;
    };
    let (image, panorama) = files.panorama(&hdr.path)?;
    let brightest = hdr.strength * f64::from(panorama.brightest());
    if brightest > f64::from(MAX_RADIANCE) {
        let says = format!(
            "its brightest pixel, times its `strength`, is {brightest:e}: radiance is from 0 to {MAX_RADIANCE:e}"
        );
        files.refuse(&hdr.path, diag::codes::OUT_OF_RANGE, &says);
        return None;
    }
    Some(Sky {
        image,
        rotate_deg: hdr.rotate_deg,
        strength: hdr.strength,
        filter: texture_filter(hdr.filter),
    })
}

/// The images that the materials of a scene name, in their order.
fn images(desc: &SceneDesc) -> impl Iterator<Item = &Placed<String>> {
    desc.materials.iter().filter_map(|m| image(&m.material))
}

/// The image that gives a material its colour.
fn image(material: &MaterialDesc) -> Option<&Placed<String>> {
    use MaterialDesc::{Diffuse, Glass, Metal, Mirror, Plastic};
    let (Diffuse { color }
    | Mirror { color }
    | Glass { color, .. }
    | Plastic { color, .. }
    | Metal { color, .. }) = material;
    match color {
        ColorDesc::Image { path, .. } => Some(path),
        ColorDesc::Linear(_) => None,
    }
}

fn is_textured(material: &MaterialDesc) -> bool {
    image(material).is_some()
}

/// What there is to say about a textured mesh whose file has no texture coordinates: an error where the scene's own
/// material is textured, a warning where the file's is.
fn missing_uv(desc: &SceneDesc, entity: usize, mesh: &Mesh) -> Option<Diagnostic> {
    if mesh.uvs.any() {
        return None;
    }
    let Placed { value, at, len } = desc.entities.get(entity)?;
    let file = mesh.path.display();
    let (diagnostic, component) = match value.material.and_then(|m| desc.materials.get(m)) {
        Some(named) if is_textured(&named.material) => {
            let says = format!("this material is textured, but {file} has no texture coordinates");
            let error = Diagnostic::error(codes::NO_UV, says)
                .hint("give it a material of one colour, or add vt lines to the file");
            (error, "material")
        }
        Some(_) => return None,
        None => {
            let own = mesh.materials.iter().find(|m| m.texture.is_some())?;
            let says = format!(
                "the material \"{}\" of {file} is textured, but the file has no texture \
                 coordinates: one texel colours it",
                own.name
            );
            (Diagnostic::warning(codes::FILE_WITHOUT_UV, says), "shape")
        }
    };
    let (at, len) = desc.place(entity, component).unwrap_or((*at, *len));
    Some(diagnostic.in_file(&desc.file).at(&desc.source, at, len))
}

/// Times at which something has a key, at most [`MOST_TIMES`] of them, from first to last.
fn key_times(world: &World) -> Vec<f64> {
    let mut keyed = world.query::<&Keys>();
    let mut times: Vec<f64> = keyed.iter().flat_map(Keys::times).collect();
    times.sort_unstable_by(f64::total_cmp);
    times.dedup();
    let step = times.len().div_ceil(MOST_TIMES).max(1);
    let last = times.last().copied();
    times.into_iter().step_by(step).chain(last).collect()
}

/// So many times are looked at for entities that leave what numbers can say: what is that far away has few keys.
const MOST_TIMES: usize = 256;

/// Indices of the entities whose composed place or size, or that of a node under them, is not finite. `entities` come each
/// with its index.
fn out_of_reach(world: &World, entities: impl Iterator<Item = (usize, Entity)>) -> Vec<usize> {
    let reachable = |entity: Entity| {
        let pose = world.get::<&Pose>(entity).map(|p| *p).unwrap_or_default();
        let radius = match world.get::<&Shape>(entity).as_deref() {
            Ok(Shape::Sphere { radius, .. }) => *radius,
            _ => 1.0,
        };
        pose.affine().is_finite() && (radius * pose.size).is_normal()
    };
    let lost = entities.filter(|(_, e)| !reachable(*e));
    lost.map(|(i, _)| i).collect()
}

fn told_out_of_reach(desc: &SceneDesc, entity: usize) -> Diagnostic {
    let Placed { at, len, .. } = desc.entities[entity];
    let says = "the place or the size of this entity is beyond the range of 64-bit numbers";
    Diagnostic::error(codes::OUT_OF_REACH, says)
        .in_file(&desc.file)
        .at(&desc.source, at, len)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;
    use crate::world::Camera;
    use std::path::Path;

    #[test]
    fn the_first_of_several_cameras_is_taken() {
        let text = "(version: 1, entities: [(gltf: \"a.glb\")])";
        let (desc, _) = scene::parse(text, Path::new("scene.ron")).expect("the scene reads");
        let mut world = World::new();
        let nodes = [30.0, 50.0].map(|vfov_deg| (world.spawn(()), vfov_deg));
        let told = |found: Option<Diagnostic>| found.map(|d| (d.severity, d.code));
        let found = take_camera(&desc, &mut world, &nodes);
        let more = (Severity::Warning, codes::MORE_CAMERAS);
        assert_eq!(told(found), Some(more));
        let taken: Vec<f64> = world
            .query::<&Camera>()
            .iter()
            .map(|c| c.vfov_deg)
            .collect();
        assert_eq!(taken, [30.0]);
        assert_eq!(take_camera(&desc, &mut world, &nodes[..1]), None);
        let none = (Severity::Error, codes::NO_CAMERA);
        assert_eq!(told(take_camera(&desc, &mut world, &[])), Some(none));
    }
}
