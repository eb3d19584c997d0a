//! Place: every mesh finds its way into the scene, as triangles of the world or as an instance of its local geometry, and
//! its materials. What is decided is decided from the scene alone, but for maps without a way back in f32.
//!
//! Enter: the meshes of a frame, listed. Leave: instances with all that they refer to, and how much room flattened
//! triangles need; these themselves are not looked at here.

use super::extract::MeshItem;
use super::flatten::{Cache, Context};
use super::instances::{instance, is_invertible};
use super::materials::Tables;
use super::meshes::{LocalMesh, MeshKey, used_slots};
use crate::asset::MeshId;
use crate::flat::{Geometry, Instance, MaterialId};
use crate::world::{Emissive, Material};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Instances that one thread makes at a time: some tenths of a millisecond of work.
const INSTANCES: usize = 256;

/// How a mesh entered the scene.
pub(crate) enum Placed {
    /// As triangles of the world, this one of [`Places::flats`].
    Flat(u32),
    /// As this instance.
    Instance(u32),
}

/// A mesh that is flattened.
pub(crate) struct Room {
    /// Of the world.
    pub(crate) triangles: Range<u32>,
    /// The materials of its slots.
    pub(crate) slots: Vec<MaterialId>,
}

/// The meshes of a frame in their places.
#[derive(Default)]
pub(crate) struct Places {
    /// In the order of the items.
    pub(crate) placed: Vec<Placed>,
    pub(crate) flats: Vec<Room>,
    pub(crate) geometries: Vec<Arc<Geometry>>,
    pub(crate) instances: Vec<Instance>,
    /// Behind [`Instance::materials`].
    pub(crate) materials: Vec<MaterialId>,
    /// What new local geometries took.
    pub(crate) local_trees: Duration,
}

/// Finds every mesh its place.
pub(crate) fn place(
    items: &[MeshItem],
    context: &Context,
    cache: &mut Cache,
    tables: &mut Tables,
) -> Places {
    let start = Instant::now();
    let locals = locals(items, context, cache);
    let mut places = Places {
        placed: Vec::with_capacity(items.len()),
        local_trees: start.elapsed(),
        ..Places::default()
    };
    let is_shared = |item: &&MeshItem| locals.contains_key(&item.key());
    let shared: Vec<&MeshItem> = items.iter().filter(is_shared).collect();
    let made = shared.par_iter().with_min_len(INSTANCES);
    let made = made.map(|item| instance(&locals[&item.key()], item, &context.rebase));
    made.collect_into_vec(&mut places.instances);
    let mut furnish = Furnish {
        context,
        slots: &mut cache.slots,
        tables,
        dressed: BTreeMap::new(),
        geometries: BTreeMap::new(),
    };
    let (mut next, mut kept, mut triangles) = (0, 0, 0);
    for item in items {
        if let Some(local) = locals.get(&item.key()) {
            let mut instance = places.instances[next];
            next += 1;
            if is_invertible(&instance) {
                instance.materials = furnish.materials(item, &mut places.materials);
                instance.geometry = furnish.geometry(item, local, &mut places.geometries);
                places.instances[kept] = instance;
                places.placed.push(Placed::Instance(kept as u32));
                kept += 1;
                continue;
            }
        }
        let first = triangles;
        triangles += context.store.mesh(item.mesh).triangle_count() as u32;
        places.placed.push(Placed::Flat(places.flats.len() as u32));
        places.flats.push(Room {
            triangles: first..triangles,
            slots: furnish.slots(item),
        });
    }
    places.instances.truncate(kept);
    places
}

/// The local geometries of meshes that move or repeat.
fn locals(
    items: &[MeshItem],
    context: &Context,
    cache: &mut Cache,
) -> BTreeMap<MeshKey, Arc<LocalMesh>> {
    let mut uses: BTreeMap<MeshKey, (u32, &MeshItem)> = BTreeMap::new();
    for item in items {
        uses.entry(item.key()).or_insert((0, item)).0 += 1;
    }
    // Whether it moves is asked of one alone: more are shared anyway.
    let shared = uses
        .into_iter()
        .filter(|(_, (count, item))| *count > 1 || item.look.moves);
    shared
        .map(|(key, (_, item))| (key, cache.local(item, context)))
        .collect()
}

/// Gives instances what they refer to.
struct Furnish<'a, 't, 'i> {
    context: &'a Context<'a>,
    slots: &'a mut BTreeMap<MeshId, Vec<bool>>,
    tables: &'a mut Tables<'t>,
    /// The materials of the last instance of each mesh: the next usually has the same.
    dressed: BTreeMap<MeshId, Dressed<'i>>,
    geometries: BTreeMap<MeshKey, u32>,
}

/// What an instance's materials come from, and where they are.
type Dressed<'i> = (Option<&'i Material>, Option<&'i Emissive>, u32);

impl<'i> Furnish<'_, '_, 'i> {
    /// The material of every slot.
    fn slots(&mut self, item: &MeshItem) -> Vec<MaterialId> {
        let mesh = self.context.store.mesh(item.mesh);
        let used = self.slots.entry(item.mesh);
        let used = used.or_insert_with(|| used_slots(mesh));
        self.tables.resolve_slots(&item.look, mesh, used)
    }

    /// The first of an instance's materials among `all`.
    fn materials(&mut self, item: &MeshItem<'i>, all: &mut Vec<MaterialId>) -> u32 {
        let (material, emission) = (item.look.material, item.look.emission);
        if let Some(&(m, e, same)) = self.dressed.get(&item.mesh)
            && (m, e) == (material, emission)
        {
            return same;
        }
        let first = all.len() as u32;
        all.extend(self.slots(item));
        self.dressed.insert(item.mesh, (material, emission, first));
        first
    }

    /// The number of an instance's geometry among `all`.
    fn geometry(
        &mut self,
        item: &MeshItem,
        local: &LocalMesh,
        all: &mut Vec<Arc<Geometry>>,
    ) -> u32 {
        *self.geometries.entry(item.key()).or_insert_with(|| {
            all.push(local.geometry.clone());
            all.len() as u32 - 1
        })
    }
}
