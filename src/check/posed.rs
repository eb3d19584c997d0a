//! The loaded scene at rest, as the checks look at it: camera, shapes with their places and boxes, lights.
//!
//! Enters: description, world and store. Leaves: a [`Posed`], in authoring order. Deliberately absent: verdicts.

use super::bounds::Bounds;
use crate::asset::{AssetStore, Light, Mesh, MeshId};
use crate::diag::{Diagnostic, Lines};
use crate::math::{DAffine3, DVec3, sin_cos_deg, unit};
use crate::scene::{Placed, SceneDesc};
use crate::world::{AuthoringIndex, Camera, Emissive, Keys, Material, Name, Pose, Shape, Spin};
use hecs::{QueryBorrow, World};
use std::collections::BTreeMap;

/// A sphere this many times as wide as the rest of the scene is a wall, as for the build.
const WALL_RATIO: f64 = 16.0;

/// A scene in its rest pose.
pub(super) struct Posed<'a> {
    pub(super) desc: &'a SceneDesc,
    pub(super) store: &'a AssetStore,
    lines: Lines<'a>,
    pub(super) view: View,
    pub(super) items: Vec<Item<'a>>,
    /// Of the meshes of items, in their own space.
    boxes: BTreeMap<MeshId, Bounds>,
    /// Of the camera and of all items but walls, relative to the camera: what single precision is spread over.
    pub(super) extent: Bounds,
    pub(super) lights: Vec<Lamp>,
    /// Whether something turns in the course of the animation.
    pub(super) moves: bool,
}

/// The camera in world space, without its scale.
pub(super) struct View {
    /// Index of its entity; that of a camera at top level comes after all entities.
    pub(super) entity: usize,
    pub(super) camera: Camera,
    pub(super) eye: DVec3,
    pub(super) right: DVec3,
    pub(super) up: DVec3,
    pub(super) forward: DVec3,
    /// Half the width and half the height of the picture at distance 1 along the view axis.
    pub(super) half: (f64, f64),
    /// Side of a pixel at distance 1.
    pub(super) pixel: f64,
}

/// A sphere or mesh in its place. There may be very many.
pub(super) struct Item<'a> {
    pub(super) index: AuthoringIndex,
    name: Option<&'a Name>,
    pub(super) form: Form,
    pub(super) pose: &'a Pose,
    /// In world space.
    pub(super) bounds: Bounds,
    pub(super) material: Option<&'a Material>,
    pub(super) emissive: Option<&'a Emissive>,
    /// A sphere so much larger than the rest that it passes for a wall or a floor.
    pub(super) wall: bool,
}

/// What an [`Item`] is.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Form {
    /// Radius in world units.
    Sphere {
        radius: f64,
        inverted: bool,
    },
    Mesh(MeshId),
}

/// A light without extent in its place.
pub(super) struct Lamp {
    pub(super) index: AuthoringIndex,
    pub(super) place: DVec3,
    pub(super) light: Light,
}

impl<'a> Posed<'a> {
    /// `None` for a world without a camera, which [`crate::world::spawn`] never makes.
    pub(super) fn of(
        desc: &'a SceneDesc,
        world: &World,
        store: &'a AssetStore,
        rows: &'a mut QueryBorrow<'_, Row<'static>>,
    ) -> Option<Posed<'a>> {
        let mut cameras = world.query::<(&AuthoringIndex, &Pose, &Camera)>();
        let (index, pose, camera) = cameras.iter().min_by_key(|row| row.0)?;
        let view = View::of(desc, *index, pose, *camera);
        let mut lamps = world.query::<(&AuthoringIndex, &Pose, &Light)>();
        let lamps = lamps.iter().map(|(index, pose, light)| Lamp {
            index: *index,
            place: pose.affine().translation,
            light: *light,
        });
        let mut lights: Vec<Lamp> = lamps.collect();
        lights.sort_unstable_by_key(|lamp| lamp.index);
        let turns = world.query::<&Spin>().iter().any(|s| s.deg_per_s != 0.0);
        let goes = world
            .query::<&Keys>()
            .iter()
            .any(|keys| keys.times().nth(1).is_some());
        let (mut items, boxes) = items(rows, store);
        let extent = find_walls(&mut items, view.eye);
        Some(Posed {
            desc,
            extent,
            store,
            lines: Lines::of(&desc.source),
            view,
            items,
            boxes,
            lights,
            moves: (turns || goes) && desc.animation.frames.len() > 1,
        })
    }

    /// A warning at a component of the entity of an item or light.
    pub(super) fn warn(
        &self,
        entity: usize,
        component: &str,
        code: &'static str,
        says: String,
    ) -> Diagnostic {
        let warning = Diagnostic::warning(code, says).in_file(&self.desc.file);
        let whole = self.desc.entities.get(entity);
        let whole = whole.map(|Placed { at, len, .. }| (*at, *len));
        match self.desc.place(entity, component).or(whole) {
            Some((at, len)) => warning.on(&self.lines, at, len),
            None => warning,
        }
    }

    /// A warning at the camera, or at a field of it such as `["lens", "focus_distance"]`.
    pub(super) fn warn_at_camera(
        &self,
        field: &[&str],
        code: &'static str,
        says: String,
    ) -> Diagnostic {
        let warning = Diagnostic::warning(code, says).in_file(&self.desc.file);
        let entity = self.view.entity;
        let top = || {
            let path: Vec<&str> = ["camera"].iter().chain(field).copied().collect();
            let place = self.desc.setting_place(&path);
            place.or_else(|| self.desc.setting_place(&["camera"]))
        };
        let place = match self.desc.entities.get(entity) {
            // A camera of a glTF file is placed where the file is named.
            Some(e) => ["camera", "gltf"]
                .iter()
                .find_map(|component| self.desc.place(entity, component))
                .or(Some((e.at, e.len))),
            None => top(),
        };
        match place {
            Some((at, len)) => warning.on(&self.lines, at, len),
            None => warning,
        }
    }

    /// The box of all items but walls; `None` where there are only walls, or nothing.
    pub(super) fn subject(&self) -> Option<Bounds> {
        let inner = self.items.iter().filter(|item| !item.wall);
        inner.map(|item| item.bounds).reduce(Bounds::union)
    }

    /// The mesh of an item that is one.
    pub(super) fn mesh(&self, item: &Item) -> Option<&'a Mesh> {
        match item.form {
            Form::Mesh(id) => Some(self.store.mesh(id)),
            Form::Sphere { .. } => None,
        }
    }

    /// The box of an item's mesh in its own space.
    pub(super) fn local(&self, mesh: MeshId) -> Bounds {
        self.boxes.get(&mesh).copied().unwrap_or(Bounds::EMPTY)
    }

    /// How a message calls an item: its name, or what it is.
    pub(super) fn label(&self, item: &Item) -> String {
        let file = || self.mesh(item)?.path.file_name();
        match (&item.name, file()) {
            (Some(Name(name)), _) => format!("{name:?}"),
            (None, Some(file)) => format!("the mesh of {}", file.display()),
            (None, None) => "a sphere".to_owned(),
        }
    }
}

impl View {
    fn of(desc: &SceneDesc, index: AuthoringIndex, pose: &Pose, camera: Camera) -> View {
        let forward = unit(pose.linear * DVec3::NEG_Z).unwrap_or(DVec3::NEG_Z);
        let up = unit(pose.linear * DVec3::Y).unwrap_or(DVec3::Y);
        let right = unit(forward.cross(up)).unwrap_or(DVec3::X);
        let (width, height) = desc.render.size;
        let (sin, cos) = sin_cos_deg(0.5 * camera.vfov_deg);
        let half = sin / cos;
        View {
            entity: index.entity as usize,
            camera,
            eye: pose.affine().translation,
            right,
            up: right.cross(forward),
            forward,
            half: (half * f64::from(width) / f64::from(height), half),
            pixel: 2.0 * half / f64::from(height),
        }
    }

    /// A point in the camera's space: right, up, and how far along the view axis.
    pub(super) fn seen(&self, p: DVec3) -> DVec3 {
        let p = p - self.eye;
        DVec3::new(p.dot(self.right), p.dot(self.up), p.dot(self.forward))
    }
}

impl Item<'_> {
    /// Local to world.
    pub(super) fn to_world(&self) -> DAffine3 {
        self.pose.affine()
    }

    /// Index of its entity in the scene.
    pub(super) fn entity(&self) -> usize {
        self.index.entity as usize
    }

    /// The component of its entity that brings it.
    pub(super) fn component(&self) -> &'static str {
        if self.index.node == 0 {
            "shape"
        } else {
            "gltf"
        }
    }

    /// The longest side of its box.
    pub(super) fn size(&self) -> f64 {
        self.bounds.longest()
    }
}

/// What is read of an entity with a shape.
pub(super) type Row<'a> = (
    &'a AuthoringIndex,
    &'a Pose,
    &'a Shape,
    Option<&'a Name>,
    Option<&'a Material>,
    Option<&'a Emissive>,
);

/// Items in authoring order, and the boxes of their meshes.
fn items<'a>(
    rows: &'a mut QueryBorrow<'_, Row<'static>>,
    store: &AssetStore,
) -> (Vec<Item<'a>>, BTreeMap<MeshId, Bounds>) {
    let mut boxes = BTreeMap::new();
    let rows = rows.iter();
    let mut items: Vec<Item> = rows
        .map(|(index, pose, shape, name, material, emissive)| {
            let to_world = pose.affine();
            let (form, bounds) = match *shape {
                Shape::Sphere { radius, inverted } => {
                    let radius = radius * pose.size;
                    let center = to_world.translation;
                    let bounds = Bounds::EMPTY.with(center - radius).with(center + radius);
                    (Form::Sphere { radius, inverted }, bounds)
                }
                Shape::Mesh { mesh, .. } => {
                    let local: &Bounds = boxes
                        .entry(mesh)
                        .or_insert_with(|| Bounds::of_mesh(store.mesh(mesh)));
                    (Form::Mesh(mesh), local.moved(&to_world))
                }
            };
            Item {
                index: *index,
                name,
                form,
                pose,
                bounds,
                material,
                emissive,
                wall: false,
            }
        })
        .collect();
    items.sort_unstable_by_key(|item| item.index);
    (items, boxes)
}

/// Marks the walls and gives the extent of the rest, by the rule of the build (invariant 5 of its rebase): spheres from
/// the smallest on, until one is [`WALL_RATIO`] times as wide as all before it.
fn find_walls(items: &mut [Item], eye: DVec3) -> Bounds {
    let moved = |bounds: &Bounds| Bounds {
        min: bounds.min - eye,
        max: bounds.max - eye,
    };
    let mut extent = Bounds::EMPTY.with(DVec3::ZERO);
    let mut spheres: Vec<&mut Item> = Vec::new();
    for item in items {
        match item.form {
            Form::Mesh(_) => extent = extent.union(moved(&item.bounds)),
            Form::Sphere { .. } => spheres.push(item),
        }
    }
    spheres.sort_by(|a, b| a.size().total_cmp(&b.size()));
    let mut walls = false;
    for sphere in spheres {
        let rest = extent.longest();
        walls |= rest > 0.0 && sphere.size() >= WALL_RATIO * rest;
        sphere.wall = walls;
        if !walls {
            extent = extent.union(moved(&sphere.bounds));
        }
    }
    extent
}
