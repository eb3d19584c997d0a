//! Flatten: extracted items into the arrays of a frame, up to its tree.

use super::bvh::{Accel, Primitives, Quality, SphereItem};
use super::environment::environment;
use super::extract::{Extracted, MeshItem};
use super::instances::{instance, maps};
use super::kept::{Flat, Kept, Sources};
use super::lights::{self, Collector};
use super::materials::{Means, Tables};
use super::meshes::{
    Keep, LocalMesh, MeshKey, Part, Soup, slot, smooth_normals, triangle, used_slots,
};
use super::rebase::to_scene;
use super::spheres;
use crate::asset::{AssetStore, MeshId, PerCorner};
use crate::flat::{
    Environment, EnvironmentTable, Fresnel, Geometry, Instance, LightPlace, Lights, Material,
    MaterialId, Rebase, Spheres, Texture,
};
use crate::math::{Aabb, DAffine3, DVec3, Vec3};
use crate::world::Normals;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What is kept from frame to frame: functions of a mesh and its normals, of a texture, or of the sky, alone.
#[derive(Default)]
pub(crate) struct Cache {
    smooth: BTreeMap<MeshKey, PerCorner<DVec3>>,
    local: BTreeMap<MeshKey, Arc<LocalMesh>>,
    slots: BTreeMap<MeshId, Vec<bool>>,
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
    let mut flattener = Flattener {
        context,
        cache,
        tables,
        lights,
        groups: Vec::new(),
        shared: Shared::default(),
        local_trees: Duration::ZERO,
    };
    let placed = flattener.place(&items.meshes);
    let (sources, instances_moving) = flattener.sources(&items.meshes, &placed, standing);
    let world = kept.and_then(|kept| kept.world(&sources));
    let soup = world
        .is_none()
        .then(|| flattener.soup(&items.meshes, &placed, sources.keep));
    let vertices = |prim: usize| match (&soup, world) {
        (Some(soup), _) => soup.triangles[prim],
        (None, Some(world)) => triangle(&world.triangles, prim),
        // One of both is there.
        (None, None) => [Vec3::NAN; 3],
    };
    flattener.shine(&items.meshes, &placed, vertices);
    for light in &items.lights {
        flattener.lights.punctual(light, &context.rebase);
    }
    let environment = items
        .sky
        .map(|sky| environment(&sky, context.store, &mut flattener.cache.sky));
    if let Some(environment) = &environment {
        flattener.lights.environment(environment);
    }
    let Flattener { tables, shared, .. } = flattener;
    flattener.cache.means = tables.means;
    Flattened {
        sources,
        soup,
        groups: flattener.groups,
        spheres_moving: moving,
        instances_moving,
        local: shared.geometries,
        instances: shared.instances,
        instance_materials: shared.materials,
        spheres,
        materials: tables.materials,
        textures: tables.textures,
        lights: flattener.lights.finish(),
        environment,
        local_trees: flattener.local_trees,
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
    groups: Vec<Range<u32>>,
    shared: Shared,
    local_trees: Duration,
}

/// Instances and what they refer to.
#[derive(Default)]
struct Shared {
    geometries: Vec<Arc<Geometry>>,
    place: BTreeMap<MeshKey, u32>,
    instances: Vec<Instance>,
    materials: Vec<MaterialId>,
}

/// How a mesh entered the scene, with the materials of its slots.
struct Placed {
    way: Way,
    slots: Vec<MaterialId>,
}

enum Way {
    /// As triangles of the world, from this one on.
    Flat(u32),
    /// As this instance.
    Instance(u32, Arc<LocalMesh>),
}

/// What an instance is made of.
struct Seed<'a> {
    item: &'a MeshItem,
    local: Arc<LocalMesh>,
    maps: [DAffine3; 2],
    geometry: u32,
    materials: u32,
}

impl Seed<'_> {
    fn instance(&self) -> Instance {
        instance(
            &self.local,
            self.item,
            self.maps,
            self.geometry,
            self.materials,
        )
    }
}

/// Instances that one thread makes at a time: some tenths of a millisecond of work.
const INSTANCES: usize = 256;

impl Flattener<'_> {
    /// Finds every mesh its way, its materials, and, if it is an instance, its place.
    fn place<'i>(&mut self, items: &'i [MeshItem]) -> Vec<Placed> {
        let mut uses: BTreeMap<MeshKey, u32> = BTreeMap::new();
        for item in items {
            *uses.entry(item.key()).or_default() += 1;
        }
        let mut triangles = 0;
        let mut seeds = Vec::new();
        let place = |item: &'i MeshItem| {
            let shared = item.look.moves || uses[&item.key()] > 1;
            let instanced = shared.then(|| self.maps(item)).flatten();
            let mesh = self.context.store.mesh(item.mesh);
            let used = self.cache.slots.entry(item.mesh);
            let used = used.or_insert_with(|| used_slots(mesh));
            let slots = self.tables.resolve_slots(&item.look, mesh, used);
            let way = match instanced {
                Some((local, maps)) => {
                    seeds.push(self.seed(item, local.clone(), maps, &slots));
                    Way::Instance(seeds.len() as u32 - 1, local)
                }
                None => {
                    let first = triangles;
                    triangles += mesh.triangle_count() as u32;
                    self.groups.push(first..triangles);
                    Way::Flat(first)
                }
            };
            Placed { way, slots }
        };
        let placed = items.iter().map(place).collect();
        let instances = seeds.par_iter().with_min_len(INSTANCES);
        self.shared.instances = instances.map(Seed::instance).collect();
        placed
    }

    /// The local geometry of a mesh that moves or repeats, and its maps; `None` if these have no way back in f32, so that it
    /// must be flattened.
    fn maps(&mut self, item: &MeshItem) -> Option<(Arc<LocalMesh>, [DAffine3; 2])> {
        let start = Instant::now();
        let local = self.cache.local(item, self.context);
        self.local_trees += start.elapsed();
        let maps = maps(&local.rebase, item, &self.context.rebase)?;
        Some((local, maps))
    }

    /// What the next instance is made of, with its places in the tables.
    fn seed<'i>(
        &mut self,
        item: &'i MeshItem,
        local: Arc<LocalMesh>,
        maps: [DAffine3; 2],
        slots: &[MaterialId],
    ) -> Seed<'i> {
        let shared = &mut self.shared;
        let next = shared.geometries.len() as u32;
        let geometry = *shared.place.entry(item.key()).or_insert(next);
        if geometry == next {
            shared.geometries.push(local.geometry.clone());
        }
        let materials = shared.materials.len() as u32;
        shared.materials.extend(slots);
        Seed {
            item,
            local,
            maps,
            geometry,
            materials,
        }
    }

    /// What stands is made of these; beside it, the instances that move and their boxes.
    fn sources(
        &mut self,
        items: &[MeshItem],
        placed: &[Placed],
        spheres: Vec<SphereItem>,
    ) -> (Sources, (Vec<u32>, Vec<Aabb>)) {
        let mut flats = Vec::new();
        let mut keep = self.context.keep;
        let mut standing = (Vec::new(), Vec::new());
        let mut moving = (Vec::new(), Vec::new());
        for (item, Placed { way, slots }) in items.iter().zip(placed) {
            match way {
                Way::Flat(_) => {
                    keep.normals |= self.cache.normals(item, self.context.store).is_some();
                    flats.push(Flat {
                        key: item.key(),
                        pose: item.look.pose,
                        object: item.look.object,
                        slots: slots.clone(),
                    });
                }
                Way::Instance(index, _) => {
                    let apart = item.look.moves && self.context.accel == Accel::Bvh;
                    let (ids, boxes) = if apart { &mut moving } else { &mut standing };
                    ids.push(*index);
                    boxes.push(bounds(&self.shared.instances[*index as usize]));
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
    fn soup(&mut self, items: &[MeshItem], placed: &[Placed], keep: Keep) -> Soup {
        let mut soup = Soup::default();
        for (item, Placed { way, slots }) in items.iter().zip(placed) {
            let Way::Flat(_) = way else {
                continue;
            };
            let mesh = self.context.store.mesh(item.mesh);
            let part = Part {
                mesh,
                normals: self.cache.normals(item, self.context.store),
                to: to_scene(&item.look.pose, &self.context.rebase),
                keep,
            };
            let material = |prim| slots[slot(mesh, prim)].0;
            soup.append(&part, Some(item.look.object), material);
        }
        soup
    }

    /// Adds the triangles that shine; `flat` gives the vertices of one of the world.
    fn shine(&mut self, items: &[MeshItem], placed: &[Placed], flat: impl Fn(usize) -> [Vec3; 3]) {
        let emission = |id: MaterialId, of: &Tables| of.materials[id.0 as usize].emission;
        for (item, Placed { way, slots }) in items.iter().zip(placed) {
            // Most meshes do not shine, and looking at their triangles would cost more than all the rest.
            if slots
                .iter()
                .all(|&id| emission(id, &self.tables) == [0.0; 3])
            {
                continue;
            }
            let mesh = self.context.store.mesh(item.mesh);
            for prim in 0..mesh.triangle_count() {
                let material = slots[slot(mesh, prim as u32)];
                if emission(material, &self.tables) == [0.0; 3] {
                    continue;
                }
                let (v, place) = match way {
                    Way::Flat(first) => {
                        let place = LightPlace {
                            prim: first + prim as u32,
                            instance: None,
                            mirrored: false,
                        };
                        (flat(place.prim as usize), place)
                    }
                    Way::Instance(index, local) => {
                        let instance = &self.shared.instances[*index as usize];
                        let place = LightPlace {
                            prim: prim as u32,
                            instance: Some(*index),
                            mirrored: instance.mirrored,
                        };
                        let v = triangle(&local.geometry.triangles, prim);
                        (lights::placed(v, instance), place)
                    }
                };
                self.lights
                    .triangle(v, place, material, &self.tables.materials);
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

    fn local(&mut self, item: &MeshItem, context: &Context) -> Arc<LocalMesh> {
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
