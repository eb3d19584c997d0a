//! The entities of a scene into its world, a column of components at a time.
//!
//! hecs keeps what has the same components in one table, a column for each, and doubles a table that is full. Here every
//! table is made as large as it will be, so that ten thousand entities take no more than they need, and none is moved.

use super::Pose;
use super::components::{
    AuthoringIndex, Camera, Ease, Emissive, Keys, Material, Name, Normals, Parent, Shape, Spin,
    Track, Transform, Turn,
};
use super::spawn::Source;
use crate::asset::Light;
use crate::math::{DMat3, DVec3, axis_angle_deg, euler_deg, quaternion};
use crate::scene::{
    CameraDesc, EaseDesc, EntityDesc, KeyDesc, KeysDesc, LightDesc, NormalsDesc, RotateDesc,
    SceneDesc, ShapeDesc, TransformDesc,
};
use hecs::{ColumnBatchBuilder, ColumnBatchType, Component, Entity, World};
use std::collections::BTreeMap;

/// The entities of a scene with what their components are made of, all by the index of the entity but materials.
pub(super) struct Rows<'a> {
    pub(super) desc: &'a SceneDesc,
    /// In the world, without components.
    pub(super) entities: &'a [Entity],
    pub(super) sources: &'a [Source],
    /// By their own index; `None` where its file is missing.
    pub(super) materials: &'a [Option<Material>],
}

/// One entity.
#[derive(Clone, Copy)]
struct Row<'a> {
    index: usize,
    desc: &'a EntityDesc,
    source: Source,
}

/// What is done with every component that an entity of a scene may have.
trait Visit {
    /// `of` makes the component of a row that has it.
    fn column<T: Component>(&mut self, of: impl Fn(Row) -> Option<T>);
}

/// Which of them a row has, as bits.
struct Kinds<'a> {
    row: Row<'a>,
    bits: u32,
    next: u32,
}

impl Visit for Kinds<'_> {
    fn column<T: Component>(&mut self, of: impl Fn(Row) -> Option<T>) {
        self.bits |= u32::from(of(self.row).is_some()) << self.next;
        self.next += 1;
    }
}

/// The columns of a table, by bits.
struct Table {
    bits: u32,
    columns: ColumnBatchType,
}

impl Visit for Table {
    fn column<T: Component>(&mut self, _: impl Fn(Row) -> Option<T>) {
        if self.bits & 1 == 1 {
            self.columns.add::<T>();
        }
        self.bits >>= 1;
    }
}

/// A table being filled.
struct Fill<'a> {
    rows: &'a Rows<'a>,
    /// Indices of its entities.
    members: &'a [usize],
    table: &'a ColumnBatchBuilder,
}

impl Visit for Fill<'_> {
    fn column<T: Component>(&mut self, of: impl Fn(Row) -> Option<T>) {
        let Some(mut column) = self.table.writer::<T>() else {
            return;
        };
        for component in self.members.iter().filter_map(|i| of(self.rows.row(*i))) {
            // There is room for each member's.
            let _ = column.push(component);
        }
    }
}

impl Rows<'_> {
    /// Gives every entity its components.
    pub(super) fn insert(&self, world: &mut World) {
        let mut tables: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for i in 0..self.entities.len() {
            let mut kinds = Kinds {
                row: self.row(i),
                bits: 0,
                next: 0,
            };
            self.components(&mut kinds);
            tables.entry(kinds.bits).or_default().push(i);
        }
        for (bits, members) in tables {
            let columns = ColumnBatchType::new();
            let mut table = Table { bits, columns };
            self.components(&mut table);
            let table = table.columns.into_batch(members.len() as u32);
            self.components(&mut Fill {
                rows: self,
                members: &members,
                table: &table,
            });
            let entities: Vec<Entity> = members.iter().map(|i| self.entities[*i]).collect();
            // It is complete: every column was written for every member.
            if let Ok(table) = table.build() {
                world.spawn_column_batch_at(&entities, table);
            }
        }
    }

    fn row(&self, index: usize) -> Row<'_> {
        Row {
            index,
            desc: &self.desc.entities[index].value,
            source: self.sources[index],
        }
    }

    /// Every component that an entity may have, always in this order.
    fn components(&self, visit: &mut impl Visit) {
        visit.column(|row| {
            Some(AuthoringIndex {
                entity: row.index as u32,
                node: 0,
            })
        });
        // Here already, or the first pose would move all components to another table.
        visit.column(|_| Some(Pose::IDENTITY));
        visit.column(|row| Some(transform(&row.desc.transform)));
        visit.column(|row| Some(Name(row.desc.name.clone()?)));
        visit.column(|row| Some(Parent(*self.entities.get(row.desc.parent?)?)));
        visit.column(shape);
        visit.column(|row| *self.materials.get(row.desc.material?)?);
        visit.column(|row| {
            let spin = row.desc.spin.as_ref()?;
            Some(Spin {
                axis: DVec3::from_array(spin.axis),
                deg_per_s: spin.deg_per_s,
                pivot: spin.pivot.map(DVec3::from_array),
            })
        });
        visit.column(|row| Some(keys_of(row.desc.keys.as_deref()?)));
        visit.column(|row| Some(Emissive(row.desc.emissive?)));
        visit.column(|row| Some(camera_of(row.desc.camera.as_deref()?)));
        visit.column(|row| Some(light_of(row.desc.light.as_deref()?)));
    }
}

fn shape(row: Row) -> Option<Shape> {
    match (&row.desc.shape, row.source) {
        (Some(ShapeDesc::Sphere { radius, inverted }), _) => Some(Shape::Sphere {
            radius: *radius,
            inverted: *inverted,
        }),
        (_, Source::Mesh(mesh)) => Some(Shape::Mesh {
            mesh,
            normals: normals(row.desc.normals),
        }),
        _ => None,
    }
}

fn keys_of(desc: &KeysDesc) -> Keys {
    let turn = |desc: RotateDesc| match desc {
        RotateDesc::Quat(q) => Turn::of_quaternion(q),
        desc => Turn::of_matrix(rotation(desc)),
    };
    let vector = DVec3::from_array;
    Keys {
        translate: track(desc, |key| key.translate.map(vector)),
        rotate: track(desc, |key| key.rotate.map(turn)),
        scale: track(desc, |key| key.scale.map(vector)),
    }
}

/// The keys that have a value of this part.
fn track<T>(desc: &KeysDesc, value: impl Fn(&KeyDesc) -> Option<T>) -> Track<T> {
    let keys = desc.keys.iter();
    let (times, values) = keys.filter_map(|key| Some((key.t, value(key)?))).unzip();
    Track {
        times,
        values,
        tangents: Vec::new(),
        ease: match desc.ease {
            EaseDesc::Linear => Ease::Linear,
            EaseDesc::Smooth => Ease::Smooth,
            EaseDesc::Step => Ease::Step,
        },
    }
}

fn light_of(desc: &LightDesc) -> Light {
    match *desc {
        LightDesc::Point { intensity } => Light::Point { intensity },
        LightDesc::Spot {
            intensity,
            inner_deg,
            outer_deg,
        } => Light::Spot {
            intensity,
            inner_deg,
            outer_deg,
        },
        LightDesc::Sun { irradiance } => Light::Sun { irradiance },
    }
}

pub(super) fn normals(desc: Option<NormalsDesc>) -> Normals {
    match desc {
        None | Some(NormalsDesc::File) => Normals::File,
        Some(NormalsDesc::Flat) => Normals::Flat,
        Some(NormalsDesc::Smooth { angle_deg }) => Normals::Smooth { angle_deg },
    }
}

fn transform(desc: &TransformDesc) -> Transform {
    Transform {
        translate: DVec3::from_array(desc.translate),
        rotate: rotation(desc.rotate),
        scale: DVec3::from_array(desc.scale),
    }
}

fn rotation(desc: RotateDesc) -> DMat3 {
    match desc {
        RotateDesc::Euler(deg) => euler_deg(DVec3::from_array(deg)),
        RotateDesc::AxisAngle { axis, deg } => axis_angle_deg(DVec3::from_array(axis), deg),
        RotateDesc::Quat(q) => quaternion(q),
    }
}

pub(super) fn camera_of(desc: &CameraDesc) -> Camera {
    Camera {
        vfov_deg: desc.vfov_deg,
        aperture_radius: desc.aperture_radius,
        focus_distance: desc.focus_distance,
    }
}
