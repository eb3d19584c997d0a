//! Flatten: extracted items into the arrays of a frame, up to its tree.

use super::bvh::{Accel, Primitives, Quality, SphereItem};
use super::environment::environment;
use super::extract::{Extracted, MeshItem};
use super::kept::{Flat, Kept, Sources};
use super::lights::{self, Collector};
use super::materials::{Means, Tables};
use super::meshes::{Keep, LocalMesh, MeshKey, Part, Soup, slot, smooth_normals, triangle};
use super::place::{Placed, Places, place};
use super::rebase::to_scene;
use super::spheres;
use crate::asset::{AssetStore, MeshId, PerCorner};
use crate::flat::{
    Environment, EnvironmentTable, Fresnel, Geometry, Instance, LightPlace, Lights, Material,
    MaterialId, Rebase, Spheres, Texture,
};
use crate::math::{Aabb, DVec3, Vec3};
use crate::world::Normals;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

/// What is kept from frame to frame: functions of a mesh and its normals, of a texture, or of the sky, alone.
#[derive(Default)]
pub(crate) struct Cache {
    smooth: BTreeMap<MeshKey, PerCorner<DVec3>>,
    local: BTreeMap<MeshKey, Arc<LocalMesh>>,
    /// Which slots of a mesh occur.
    pub(crate) slots: BTreeMap<MeshId, Vec<bool>>,
    means: Means,
    sky: Option<Arc<EnvironmentTable>>,
}

/// Everything of a frame but its tree and its camera.
pub(crate) struct Flattened {
    /// What the arrays of all that stands are made of.
    pub(crate) sources: Sources,
    /// The triangles that stand; `None` where their arrays are there from before.
    pub(crate) soup: Option<Soup>,
    /// The triangles of each flattened mesh.
    groups: Vec<Range<u32>>,
    /// Spheres of the tree that move.
    spheres_moving: Vec<SphereItem>,
    /// Instances that move: which, and their boxes.
    pub(crate) instances_moving: (Vec<u32>, Vec<Aabb>),
    pub(crate) local: Vec<Arc<Geometry>>,
    pub(crate) instances: Vec<Instance>,
    pub(crate) instance_materials: Vec<MaterialId>,
    pub(crate) spheres: Spheres,
    pub(crate) materials: Vec<Material>,
    pub(crate) textures: Vec<Texture>,
    pub(crate) lights: Lights,
    pub(crate) environment: Option<Environment>,
    /// What new local geometries took.
    pub(crate) local_trees: Duration,
}

impl Flattened {
    /// What stands, of these triangles.
    pub(crate) fn standing<'a>(&'a self, triangles: &'a [[Vec3; 3]]) -> Primitives<'a> {
        Primitives {
            triangles,
            groups: &self.groups,
            spheres: &self.sources.spheres,
            instances: &self.sources.instances.1,
        }
    }

    /// What moves.
    pub(crate) fn moving(&self) -> Primitives<'_> {
        Primitives {
            spheres: &self.spheres_moving,
            instances: &self.instances_moving.1,
            ..Primitives::default()
        }
    }

    /// All spheres of the tree, and all boxes of instances, in the scene's order.
    pub(crate) fn together(&self) -> (Vec<SphereItem>, Vec<Aabb>) {
        let mut spheres = [&self.sources.spheres[..], &self.spheres_moving].concat();
        spheres.sort_by_key(|sphere| sphere.prim);
        (spheres, self.instances.iter().map(bounds).collect())
    }
}

/// What does not change while a frame is flattened.
pub(crate) struct Context<'a> {
    pub(crate) store: &'a AssetStore,
    pub(crate) rebase: Rebase,
    pub(crate) accel: Accel,
    pub(crate) quality: Quality,
    pub(crate) fresnel: Fresnel,
    /// What is kept of every mesh.
    pub(crate) keep: Keep,
}

/// Flattens a frame. What stands is not touched if `kept` has it.
pub(crate) fn flatten(
    items: &Extracted,
    context: &Context,
    cache: &mut Cache,
    kept: Option<&Kept>,
) -> Flattened {
    let means = std::mem::take(&mut cache.means);
    let mut tables = Tables::new(context.store, context.fresnel, means);
    let mut lights = Collector::default();
    let (spheres, [mut standing, mut moving]) = spheres::flatten(
        &items.spheres,
        &context.rebase,
        &mut tables,
        context.keep.uvs,
    );
    if context.accel != Accel::Bvh {
        // What has no tree stands as a whole, or is made anew.
        standing.append(&mut moving);
        standing.sort_by_key(|sphere| sphere.prim);
    }
    lights.spheres(&spheres, &tables.materials);
    let places = place(&items.meshes, context, cache, &mut tables);
    let mut flattener = Flattener {
        context,
        cache,
        tables,
        lights,
        places,
    };
    let (sources, instances_moving) = flattener.sources(&items.meshes, standing);
    let world = kept.and_then(|kept| kept.world(&sources));
    let soup = world
        .is_none()
        .then(|| flattener.soup(&items.meshes, sources.keep));
    let vertices = |prim: usize| match (&soup, world) {
        (Some(soup), _) => soup.triangles[prim],
        (None, Some(world)) => triangle(&world.triangles, prim),
        // One of both is there.
        (None, None) => [Vec3::NAN; 3],
    };
    flattener.shine(&items.meshes, vertices);
    for light in &items.lights {
        flattener.lights.punctual(light, &context.rebase);
    }
    let environment = items
        .sky
        .map(|sky| environment(&sky, context.store, &mut flattener.cache.sky));
    if let Some(environment) = &environment {
        flattener.lights.environment(environment);
    }
    let Flattener { tables, places, .. } = flattener;
    flattener.cache.means = tables.means;
    Flattened {
        sources,
        soup,
        groups: places
            .flats
            .into_iter()
            .map(|flat| flat.triangles)
            .collect(),
        spheres_moving: moving,
        instances_moving,
        local: places.geometries,
        instances: places.instances,
        instance_materials: places.materials,
        spheres,
        materials: tables.materials,
        textures: tables.textures,
        lights: flattener.lights.finish(),
        environment,
        local_trees: places.local_trees,
    }
}

fn bounds(instance: &Instance) -> Aabb {
    let [min, max] = instance.bounds.map(Vec3::from_array);
    Aabb { min, max }
}

/// The arrays of meshes while they grow.
struct Flattener<'a> {
    context: &'a Context<'a>,
    cache: &'a mut Cache,
    tables: Tables<'a>,
    lights: Collector,
    places: Places,
}

impl Flattener<'_> {
    /// What stands is made of these; beside it, the instances that move and their boxes.
    fn sources(
        &mut self,
        items: &[MeshItem],
        spheres: Vec<SphereItem>,
    ) -> (Sources, (Vec<u32>, Vec<Aabb>)) {
        let mut flats = Vec::new();
        let mut keep = self.context.keep;
        let mut standing = (Vec::new(), Vec::new());
        let mut moving = (Vec::new(), Vec::new());
        for (item, placed) in items.iter().zip(&self.places.placed) {
            match placed {
                Placed::Flat(index) => {
                    let slots = &self.places.flats[*index as usize].slots;
                    keep.normals |= self.cache.normals(item, self.context.store).is_some();
                    flats.push(Flat {
                        key: item.key(),
                        pose: *item.look.pose,
                        object: item.look.object(),
                        slots: slots.clone(),
                    });
                }
                Placed::Instance(index) => {
                    let apart = item.look.moves && self.context.accel == Accel::Bvh;
                    let (ids, boxes) = if apart { &mut moving } else { &mut standing };
                    if ids.is_empty() {
                        // All of them, usually.
                        let left = self.places.instances.len() - *index as usize;
                        ids.reserve_exact(left);
                        boxes.reserve_exact(left);
                    }
                    ids.push(*index);
                    boxes.push(bounds(&self.places.instances[*index as usize]));
                }
            }
        }
        let sources = Sources {
            flats,
            keep,
            spheres,
            instances: standing,
        };
        (sources, moving)
    }

    /// The triangles of flattened meshes.
    fn soup(&mut self, items: &[MeshItem], keep: Keep) -> Soup {
        let mut soup = Soup::default();
        for (item, placed) in items.iter().zip(&self.places.placed) {
            let Placed::Flat(index) = placed else {
                continue;
            };
            let slots = &self.places.flats[*index as usize].slots;
            let mesh = self.context.store.mesh(item.mesh);
            let part = Part {
                mesh,
                normals: self.cache.normals(item, self.context.store),
                to: to_scene(item.look.pose, &self.context.rebase),
                keep,
            };
            let material = |prim| slots[slot(mesh, prim)].0;
            soup.append(&part, Some(item.look.object()), material);
        }
        soup
    }

    /// Adds the triangles that shine; `flat` gives the vertices of one of the world.
    fn shine(&mut self, items: &[MeshItem], flat: impl Fn(usize) -> [Vec3; 3]) {
        let (places, materials) = (&self.places, &self.tables.materials);
        let shines = |id: &MaterialId| materials[id.0 as usize].emission != [0.0; 3];
        for (item, placed) in items.iter().zip(&places.placed) {
            let slots = match placed {
                Placed::Flat(index) => &places.flats[*index as usize].slots[..],
                Placed::Instance(index) => {
                    let first = places.instances[*index as usize].materials as usize;
                    let slots = self.cache.slots.get(&item.mesh).map_or(0, Vec::len);
                    &places.materials[first..first + slots]
                }
            };
            // Most meshes do not shine, and looking at their triangles would cost more than all the rest.
            if !slots.iter().any(shines) {
                continue;
            }
            let mesh = self.context.store.mesh(item.mesh);
            for prim in 0..mesh.triangle_count() {
                let material = slots[slot(mesh, prim as u32)];
                if !shines(&material) {
                    continue;
                }
                let (v, place) = match placed {
                    Placed::Flat(index) => {
                        let first = places.flats[*index as usize].triangles.start;
                        let place = LightPlace {
                            prim: first + prim as u32,
                            instance: None,
                            mirrored: false,
                        };
                        (flat(place.prim as usize), place)
                    }
                    Placed::Instance(index) => {
                        let instance = &places.instances[*index as usize];
                        let place = LightPlace {
                            prim: prim as u32,
                            instance: Some(*index),
                            mirrored: instance.mirrored,
                        };
                        let local = &places.geometries[instance.geometry as usize];
                        (
                            lights::placed(triangle(&local.triangles, prim), instance),
                            place,
                        )
                    }
                };
                self.lights.triangle(v, place, material, materials);
            }
        }
    }
}

impl Cache {
    /// Unit corner normals of an item; `None` where every triangle is flat.
    fn normals<'a>(
        &'a mut self,
        item: &MeshItem,
        store: &'a AssetStore,
    ) -> Option<&'a PerCorner<DVec3>> {
        let mesh = store.mesh(item.mesh);
        match item.normals {
            Normals::Flat => None,
            Normals::File if mesh.normals.is_empty() && mesh.faceted => None,
            Normals::File if mesh.normals.all() => Some(&mesh.normals),
            normals => {
                let smooth = self.smooth.entry(item.key());
                Some(smooth.or_insert_with(|| smooth_normals(mesh, normals)))
            }
        }
    }

    /// The local geometry of an item that moves or repeats.
    pub(crate) fn local(&mut self, item: &MeshItem, context: &Context) -> Arc<LocalMesh> {
        if let Some(known) = self.local.get(&item.key()) {
            return known.clone();
        }
        let mesh = context.store.mesh(item.mesh);
        let normals = self.normals(item, context.store);
        let local = Arc::new(LocalMesh::new(mesh, normals, context));
        self.local.insert(item.key(), local.clone());
        local
    }
}
