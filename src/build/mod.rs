//! Build: a posed world becomes a [`FlatScene`]: extract (in authoring order) → flatten → tree.
//!
//! Enters: `&World`, read-only by type, and the store. Leaves: arrays and ids; names, paths, entities and f64
//! transforms end here. A frame depends on the scene and the world's poses alone, never on the frame before: what is
//! kept between frames (the rebase, local geometries, smoothed normals, the tree of what stands) is a function of the
//! scene, or known again by what it is made of.
//!
//! Nothing deforms: what moves is moved as a whole, so that no tree is ever refitted.
//!
//! Deliberately absent: files, pixels, and any error: what cannot be built was refused when it was read.

pub mod bvh;
mod bytes;
mod camera;
mod chains;
mod environment;
mod extract;
mod flatten;
mod fresnel;
mod instances;
mod kept;
mod lights;
mod materials;
mod meshes;
mod needs;
mod place;
mod rebase;
mod spheres;
mod support;

pub use bvh::{Accel, Quality};
pub use bytes::{BufferBytes, buffer_bytes};

use crate::asset::{AssetStore, MeshId};
use crate::flat::{FlatScene, Fresnel, Geometry, PixelFilter, Rebase};
use crate::math::Vec3;
use crate::world::poses;
use bvh::{Built, Standing};
use extract::{Extracted, extract};
use flatten::{Cache, Context, Flattened, flatten};
use hecs::World;
use kept::Kept;
use materials::{Means, Tables};
use meshes::{Keep, used_slots};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// What the build must know besides the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildOptions {
    /// How much of a tree.
    pub accel: Accel,
    /// How well trees are built: the scene's in every frame, those of local geometries once.
    pub quality: Quality,
    /// Image width and height in pixels.
    pub size: (u32, u32),
    /// Pixel filter.
    pub filter: PixelFilter,
    /// Radiance of rays that hit nothing, linear RGB.
    pub background: [f32; 3],
    /// Whether texture coordinates are wanted even where nothing is textured.
    pub uv_aov: bool,
    /// Reflectance of dielectrics, for the mean that a plastic keeps inside.
    pub fresnel: Fresnel,
    /// Whether ways of light by and through specular spheres are looked for.
    pub caustics: bool,
}

/// What the steps of one build took, and what came out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BuildTimes {
    /// Placing what moves: before the build, and told beside it.
    pub pose: Duration,
    /// World to sorted items.
    pub extract: Duration,
    /// Items to arrays.
    pub flatten: Duration,
    /// Trees: the scene's, and in the first frame those of its local geometries.
    pub bvh: Duration,
    /// Expected block tests of a ray that meets the scene's box, by the surface area heuristic.
    pub cost: f32,
    /// Size of all buffers.
    pub bytes: usize,
}

/// Builds the frames of one scene.
pub struct SceneBuilder {
    store: AssetStore,
    options: BuildOptions,
    rebase: Rebase,
    /// What is read of meshes.
    keep: Keep,
    cache: Cache,
    /// What stands still.
    kept: Option<Kept>,
}

impl SceneBuilder {
    /// Prepares the builds of a scene. The world may be posed at any time: the rebase comes from its poses at rest.
    #[must_use]
    pub fn new(world: &World, store: &AssetStore, options: BuildOptions) -> SceneBuilder {
        let poses = poses(world, 0.0);
        let mut rows = world.query();
        let rest = extract(world, &mut rows, Some(&poses));
        SceneBuilder {
            store: store.clone(),
            options,
            rebase: rebase::of_scene(&rest, store),
            keep: keep(&rest, store, options.uv_aov),
            cache: Cache::default(),
            kept: None,
        }
    }

    /// Builds the frame that the world is posed for; `frame` is what tells its noise from other frames'.
    pub fn build(&mut self, world: &World, frame: u32) -> (FlatScene, BuildTimes) {
        let start = Instant::now();
        let mut rows = world.query();
        let extracted = extract(world, &mut rows, None);
        let extracting = start.elapsed();

        let context = Context {
            store: &self.store,
            rebase: self.rebase,
            accel: self.options.accel,
            quality: self.options.quality,
            fresnel: self.options.fresnel,
            keep: self.keep,
        };
        let mut kept = self.kept.take();
        let mut flat = flatten(&extracted, &context, &mut self.cache, kept.as_ref());
        let (pose, camera) = &extracted.camera;
        let camera = camera::camera(pose, camera, &self.rebase, &self.options);
        drop(extracted);
        let flattening = start.elapsed() - extracting - flat.local_trees;

        let start = Instant::now();
        let soup = flat.soup.take();
        let again = kept
            .as_mut()
            .filter(|_| soup.is_none())
            .and_then(Kept::take);
        let (standing, shading) = match again {
            Some((built, standing, shading)) => ((built, standing), shading),
            None => {
                let soup = soup.unwrap_or_default();
                (self.stand(&flat, &soup.triangles), soup.shading)
            }
        };
        let built = self.tree(&mut flat, standing);
        let tree = start.elapsed() + flat.local_trees;

        let mut scene = FlatScene {
            camera,
            world: Geometry {
                triangles: built.triangles,
                bvh: built.bvh,
                shading,
            },
            local: flat.local,
            instances: flat.instances,
            instance_materials: flat.instance_materials,
            spheres: flat.spheres,
            materials: flat.materials,
            textures: flat.textures,
            lights: flat.lights,
            chains: Default::default(),
            background: self.options.background,
            environment: flat.environment,
            rebase: self.rebase,
            needs: Default::default(),
            frame,
        };
        scene.spheres.blocks = built.sphere_blocks;
        scene.needs = needs::needs(&scene);
        if self.options.caustics {
            scene.chains = chains::chains(&scene);
        }
        let times = BuildTimes {
            pose: Duration::ZERO,
            extract: extracting,
            flatten: flattening,
            bvh: tree,
            cost: built.cost,
            bytes: buffer_bytes(&scene).iter().map(|b| b.bytes).sum(),
        };
        (scene, times)
    }

    /// The tree over what stands.
    fn stand(&self, flat: &Flattened, triangles: &[[Vec3; 3]]) -> (Built, Standing) {
        let BuildOptions { accel, quality, .. } = self.options;
        let mut built = bvh::build_with(&flat.standing(triangles), accel, quality);
        let (ids, _) = &flat.sources.instances;
        for index in &mut built.bvh.instance_order {
            *index = ids[*index as usize];
        }
        let standing = Standing::of(&built);
        (built, standing)
    }

    /// The tree of a frame, over what stands and what moves.
    fn tree(&mut self, flat: &mut Flattened, (built, standing): (Built, Standing)) -> Built {
        let (ids, _) = &flat.instances_moving;
        match kept::above(built, &standing, &flat.moving(), ids) {
            Ok(built) => {
                self.kept = Some(Kept::new(std::mem::take(&mut flat.sources), standing));
                built
            }
            Err(standing) => {
                let (spheres, instances) = flat.together();
                let all = bvh::Primitives {
                    triangles: &kept::vertices(&standing.triangles),
                    spheres: &spheres,
                    instances: &instances,
                    ..Default::default()
                };
                bvh::build_with(&all, self.options.accel, self.options.quality)
            }
        }
    }

    /// Takes a frame apart that this builder built last, for what stands in it: the next frame is built sooner, and no
    /// different.
    pub(crate) fn give_back(&mut self, scene: FlatScene) {
        if let Some(kept) = &mut self.kept {
            kept.give_back(scene);
        }
    }

    /// How scene units come about.
    #[must_use]
    pub fn rebase(&self) -> Rebase {
        self.rebase
    }
}

/// What the materials that occur read of meshes.
fn keep(scene: &Extracted, store: &AssetStore, uv_aov: bool) -> Keep {
    let mut tables = Tables::new(store, Fresnel::Off, Means::default());
    for item in &scene.spheres {
        tables.resolve(&item.look, None);
    }
    let mut slots: BTreeMap<MeshId, Vec<bool>> = BTreeMap::new();
    for item in &scene.meshes {
        let mesh = store.mesh(item.mesh);
        let used = slots.entry(item.mesh).or_insert_with(|| used_slots(mesh));
        tables.resolve_slots(&item.look, mesh, used);
    }
    let reads = |set| tables.textures.iter().any(|t| t.uv_set == set);
    Keep {
        normals: false,
        uvs: uv_aov || reads(0),
        uvs1: reads(1),
        colors: tables.materials.iter().any(|m| m.vertex_colors),
    }
}
