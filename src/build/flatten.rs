//! Flatten: extracted items into the arrays of a frame, up to its tree.

use super::bvh::{Accel, Primitives, Quality, SphereItem};
use super::extract::{Extracted, MeshItem};
use super::instances::{instance, maps};
use super::lights::{self, Collector};
use super::materials::{Means, Tables};
use super::meshes::{Keep, LocalMesh, MeshKey, Part, Soup, slot, smooth_normals};
use super::rebase::to_scene;
use super::spheres;
use crate::asset::{AssetStore, PerCorner};
use crate::flat::{
    Fresnel, Geometry, Instance, LightPlace, Lights, Material, MaterialId, Rebase, Spheres, Texture,
};
use crate::math::{Aabb, DAffine3, DVec3, Vec3};
use crate::world::Normals;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What is kept from frame to frame: functions of a mesh and its normals, or of a texture, alone.
#[derive(Default)]
pub(crate) struct Cache {
    smooth: BTreeMap<MeshKey, PerCorner<DVec3>>,
    local: BTreeMap<MeshKey, Arc<LocalMesh>>,
    means: Means,
}

/// Everything of a frame but its tree and its camera.
pub(crate) struct Flattened {
    pub(crate) soup: Soup,
    /// The triangles of each flattened mesh.
    groups: Vec<Range<u32>>,
    tree_spheres: Vec<SphereItem>,
    boxes: Vec<Aabb>,
    pub(crate) local: Vec<Arc<Geometry>>,
    pub(crate) instances: Vec<Instance>,
    pub(crate) instance_materials: Vec<MaterialId>,
    pub(crate) spheres: Spheres,
    pub(crate) materials: Vec<Material>,
    pub(crate) textures: Vec<Texture>,
    pub(crate) lights: Lights,
    /// What new local geometries took.
    pub(crate) local_trees: Duration,
}

impl Flattened {
    /// What the tree is built over.
    pub(crate) fn primitives(&self) -> Primitives<'_> {
        Primitives {
            triangles: &self.soup.triangles,
            groups: &self.groups,
            spheres: &self.tree_spheres,
            instances: &self.boxes,
        }
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

/// Flattens a frame.
pub(crate) fn flatten(items: &Extracted, context: &Context, cache: &mut Cache) -> Flattened {
    let means = std::mem::take(&mut cache.means);
    let mut tables = Tables::new(context.store, context.fresnel, means);
    let mut lights = Collector::default();
    let (spheres, tree_spheres) = spheres::flatten(
        &items.spheres,
        &context.rebase,
        &mut tables,
        context.keep.uvs,
    );
    lights.spheres(&spheres, &tables.materials);
    let mut flattener = Flattener {
        context,
        cache,
        tables,
        lights,
        soup: Soup::default(),
        groups: Vec::new(),
        shared: Shared::default(),
        local_trees: Duration::ZERO,
    };
    flattener.meshes(&items.meshes);
    for light in &items.lights {
        flattener.lights.punctual(light, &context.rebase);
    }
    let Flattener { tables, shared, .. } = flattener;
    flattener.cache.means = tables.means;
    Flattened {
        soup: flattener.soup,
        groups: flattener.groups,
        tree_spheres,
        boxes: shared.instances.iter().map(bounds).collect(),
        local: shared.geometries,
        instances: shared.instances,
        instance_materials: shared.materials,
        spheres,
        materials: tables.materials,
        textures: tables.textures,
        lights: flattener.lights.finish(),
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
    soup: Soup,
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

/// How a mesh enters the scene.
enum Way {
    Flat,
    Instance(Arc<LocalMesh>, [DAffine3; 2]),
}

impl Flattener<'_> {
    fn meshes(&mut self, items: &[MeshItem]) {
        let mut uses: BTreeMap<MeshKey, u32> = BTreeMap::new();
        for item in items {
            *uses.entry(item.key()).or_default() += 1;
        }
        let ways: Vec<Way> = items
            .iter()
            .map(|item| self.way(item, item.moves || uses[&item.key()] > 1))
            .collect();
        let smooth = items.iter().zip(&ways).any(|(item, way)| {
            matches!(way, Way::Flat) && self.cache.normals(item, self.context.store).is_some()
        });
        for (item, way) in items.iter().zip(ways) {
            match way {
                Way::Flat => self.flat(item, smooth),
                Way::Instance(local, maps) => self.instance(item, &local, maps),
            }
        }
    }

    /// A mesh that moves or repeats is instanced, unless its map has no way back in f32.
    fn way(&mut self, item: &MeshItem, shared: bool) -> Way {
        if !shared {
            return Way::Flat;
        }
        let start = Instant::now();
        let local = self.cache.local(item, self.context);
        self.local_trees += start.elapsed();
        match maps(&local.rebase, item, &self.context.rebase) {
            Some(maps) => Way::Instance(local, maps),
            None => Way::Flat,
        }
    }

    fn flat(&mut self, item: &MeshItem, smooth: bool) {
        let mesh = self.context.store.mesh(item.mesh);
        let slots = self.tables.resolve_slots(&item.look, mesh);
        let normals = self.cache.normals(item, self.context.store);
        let part = Part {
            mesh,
            normals,
            to: to_scene(&item.look.pose, &self.context.rebase),
            keep: Keep {
                normals: smooth,
                ..self.context.keep
            },
        };
        let material = |prim| slots[slot(mesh, prim)];
        let first = self.soup.triangles.len();
        self.soup
            .append(&part, Some(item.look.object), |prim| material(prim).0);
        self.groups
            .push(first as u32..self.soup.triangles.len() as u32);
        for (prim, v) in (0..).zip(&self.soup.triangles[first..]) {
            let place = LightPlace {
                prim: first as u32 + prim,
                instance: None,
                mirrored: false,
            };
            self.lights
                .triangle(*v, place, material(prim), &self.tables.materials);
        }
    }

    fn instance(&mut self, item: &MeshItem, local: &LocalMesh, maps: [DAffine3; 2]) {
        let mesh = self.context.store.mesh(item.mesh);
        let slots = self.tables.resolve_slots(&item.look, mesh);
        let shared = &mut self.shared;
        let next = shared.geometries.len() as u32;
        let geometry = *shared.place.entry(item.key()).or_insert(next);
        if geometry == next {
            shared.geometries.push(local.geometry.clone());
        }
        let instance = instance(local, item, maps, geometry, shared.materials.len() as u32);
        shared.materials.extend(&slots);
        shared.instances.push(instance);
        for prim in 0..mesh.triangle_count() {
            let material = slots[slot(mesh, prim as u32)];
            // Most meshes do not shine, and placing their triangles would cost more than all the rest.
            if self.tables.materials[material.0 as usize].emission == [0.0; 3] {
                continue;
            }
            let v = lights::placed(local.triangle(prim), &instance);
            let place = LightPlace {
                prim: prim as u32,
                instance: Some(self.shared.instances.len() as u32 - 1),
                mirrored: instance.mirrored,
            };
            self.lights
                .triangle(v, place, material, &self.tables.materials);
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
