//! A mesh or a glTF file as a scene to edit: every node an entity, plain materials by name, and what a picture needs
//! besides, a camera and light, where the file has none.

use super::fit::View;
use super::{node, numbers};
use crate::asset::{Light, Loader, Mesh, Model};
use crate::math::{DVec3, sin_cos_deg};
use crate::scene::{
    AnimationDesc, BackgroundDesc, CameraDesc, CameraPose, EntityDesc, LightDesc, NamedMaterial,
    Placed, RenderDesc, SceneDesc, ShapeDesc, TransformDesc,
};
use std::collections::BTreeSet;

/// Where the camera stands that luxel adds: degrees above the horizon, and to the right of +Z.
const ELEVATION_DEG: f64 = 20.0;
const AZIMUTH_DEG: f64 = 30.0;

/// Its field of view in degrees, and the share of the frame that it fills.
const VFOV_DEG: f64 = 35.0;
const FILL: f64 = 0.8;

/// The lamp that luxel adds: its direction, its distance and radius in extents of the scene, and what a white surface
/// that faces it gets of it.
const LAMP: DVec3 = DVec3::new(-0.5, 0.75, 0.43);
const LAMP_DISTANCE: f64 = 4.0;
const LAMP_RADIUS: f64 = 0.6;
const LAMP_GIVES: [f64; 3] = [0.8, 0.75, 0.68];

/// Digits of its radius.
const LAMP_DIGITS: usize = 4;

/// The sky that comes with it.
const SKY: [f64; 3] = [0.28, 0.31, 0.36];

/// A scene, and what a person should be told of it.
#[derive(Clone, Debug)]
pub struct Converted {
    /// The scene, without places.
    pub desc: SceneDesc,
    /// What luxel added or could not keep, a sentence each.
    pub notes: Vec<String>,
}

/// The scene of an OBJ file, which `path` names: one entity. `name` is what to call it.
#[must_use]
pub fn convert_mesh(mesh: &Mesh, points: &[DVec3], path: &str, name: &str) -> Converted {
    let mut scene = Scene::default();
    let entity = EntityDesc {
        name: Some(name.to_owned()),
        shape: Some(shape(path, None)),
        material: scene.plain_material(mesh),
        ..EntityDesc::default()
    };
    scene.shines = emits(mesh);
    scene.entities.push(entity);
    scene.finish(points)
}

/// The scene of a glTF file, which `path` names and `loader` has read: an entity per node.
#[must_use]
pub fn convert_model(model: &Model, loader: &Loader, points: &[DVec3], path: &str) -> Converted {
    let mut scene = Scene::default();
    let mut names = BTreeSet::new();
    for node in &model.nodes {
        let wanted = node.name.clone().filter(|name| !name.trim().is_empty());
        let wanted = wanted.unwrap_or_else(|| format!("node {}", node.index));
        let name = unique(&wanted, &mut names);
        let mesh = node.mesh.and_then(|m| Some((m, (*model.meshes.get(m)?)?)));
        let mut entity = EntityDesc {
            parent: node.parent,
            transform: node::transform(&node.transform, &name, &mut scene.notes),
            light: node.light.map(|l| Box::new(light(l))),
            ..EntityDesc::default()
        };
        if let Some((index, mesh)) = mesh {
            let mesh = loader.loaded(mesh);
            entity.shape = Some(shape(path, Some(index as u32)));
            entity.material = scene.plain_material(mesh);
            scene.shines |= emits(mesh);
        }
        if let Some(motion) = &node.motion {
            entity.keys = node::keys(motion, &name, &mut scene.notes).map(Box::new);
        }
        if let Some(vfov_deg) = node.camera_vfov_deg {
            entity.camera = scene.camera(vfov_deg, &name).map(Box::new);
        }
        scene.shines |= entity.light.is_some();
        entity.name = Some(name);
        scene.entities.push(entity);
    }
    scene.finish(points)
}

/// A scene in the making.
#[derive(Default)]
struct Scene {
    entities: Vec<EntityDesc>,
    materials: Vec<NamedMaterial>,
    notes: Vec<String>,
    /// Whether an entity has a camera.
    sees: bool,
    /// Whether something gives light.
    shines: bool,
}

impl Scene {
    /// The first camera of the file; a scene has one.
    fn camera(&mut self, vfov_deg: f64, name: &str) -> Option<CameraDesc> {
        if self.sees {
            self.notes.push(format!(
                "Of the file's cameras the first is here, not that of {name:?}."
            ));
            return None;
        }
        self.sees = true;
        Some(CameraDesc {
            vfov_deg,
            ..CameraDesc::default()
        })
    }

    /// The index of the material that stands for that of a mesh in one plain colour; others stay the file's.
    fn plain_material(&mut self, mesh: &Mesh) -> Option<usize> {
        let (name, material) = node::plain_material(mesh)?;
        let same = |m: &NamedMaterial| m.material == material && m.name.starts_with(&name);
        if let Some(known) = self.materials.iter().position(same) {
            return Some(known);
        }
        let mut names = self.materials.iter().map(|m| m.name.clone()).collect();
        self.materials.push(NamedMaterial {
            name: unique(&name, &mut names),
            material,
            at: 0,
            len: 0,
        });
        Some(self.materials.len() - 1)
    }

    /// As long as the last key, at the default rate.
    fn animation(&self) -> AnimationDesc {
        let default = AnimationDesc::default();
        let keys = self.entities.iter().filter_map(|e| e.keys.as_ref());
        let last = keys
            .filter_map(|keys| Some(keys.keys.last()?.t))
            .fold(0.0, f64::max);
        // The cast saturates.
        let end = (last * default.fps).ceil() as u32;
        AnimationDesc {
            frames: 0..end.max(default.frames.end),
            ..default
        }
    }

    /// Adds what is missing.
    fn finish(mut self, points: &[DVec3]) -> Converted {
        let bounds = Bounds::of(points);
        let camera = (!self.sees).then(|| bounds.camera());
        if camera.is_some() {
            self.notes
                .push("The file has no camera: this one is luxel's.".to_owned());
        }
        let mut background = SceneDesc::BACKGROUND;
        if !self.shines {
            self.notes
                .push("The file has no light: the lamp and the background are luxel's.".to_owned());
            background = SKY;
            let mut names = self
                .entities
                .iter()
                .filter_map(|e| e.name.clone())
                .collect();
            let lamp = bounds.lamp(unique("lamp", &mut names));
            self.entities.push(lamp);
        }
        let animation = self.animation();
        let placed = |value| Placed {
            value,
            at: 0,
            len: 0,
        };
        Converted {
            desc: SceneDesc {
                file: "".into(),
                source: "".into(),
                render: RenderDesc::default(),
                background: BackgroundDesc::Linear(background),
                camera,
                materials: self.materials,
                entities: self.entities.into_iter().map(placed).collect(),
                animation,
            },
            notes: self.notes,
        }
    }
}

/// The middle of a file and how far it reaches.
struct Bounds {
    middle: DVec3,
    /// Distance from the vertical axis through the middle, and height over the middle, of each point.
    profile: Vec<(f64, f64)>,
    reach: f64,
}

impl Bounds {
    fn of(points: &[DVec3]) -> Bounds {
        let min = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let max = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let middle = 0.5 * min + 0.5 * max;
        let middle = if middle.is_finite() {
            middle
        } else {
            DVec3::ZERO
        };
        let from = |&p: &DVec3| {
            let p = p - middle;
            ((p.x * p.x + p.z * p.z).sqrt(), p.y)
        };
        let profile: Vec<_> = points.iter().map(from).collect();
        let reach = profile
            .iter()
            .map(|&(r, y)| r.max(y.abs()))
            .fold(0.0, f64::max);
        Bounds {
            middle,
            profile,
            // A file without triangles has lights to look at, perhaps.
            reach: if reach > 0.0 && reach.is_finite() {
                reach
            } else {
                1.0
            },
        }
    }

    /// Sees everything.
    fn camera(&self) -> CameraDesc {
        let (width, height) = RenderDesc::default().size;
        let view = View {
            vfov_deg: VFOV_DEG,
            aspect: f64::from(width) / f64::from(height),
            elevation_deg: ELEVATION_DEG,
            fill: FILL,
        };
        let point = [(self.reach, 0.0)];
        let profile = if self.profile.is_empty() {
            &point
        } else {
            self.profile.as_slice()
        };
        let fit = view.fit(profile);
        let (sin, cos) = sin_cos_deg(ELEVATION_DEG);
        let (sin_azimuth, cos_azimuth) = sin_cos_deg(AZIMUTH_DEG);
        let away = DVec3::new(cos * sin_azimuth, sin, cos * cos_azimuth);
        let look_at = self.middle + DVec3::new(0.0, fit.look_at, 0.0);
        let pose = CameraPose {
            at: self.short(look_at + fit.distance * away),
            look_at: self.short(look_at),
            up: CameraPose::UP,
        };
        CameraDesc {
            pose: Some(pose),
            vfov_deg: VFOV_DEG,
            focus_distance: CameraDesc::default_focus(&pose),
            ..CameraDesc::default()
        }
    }

    fn lamp(&self, name: String) -> EntityDesc {
        let sine = LAMP_RADIUS / LAMP_DISTANCE;
        EntityDesc {
            name: Some(name),
            shape: Some(ShapeDesc::Sphere {
                radius: numbers::significant(LAMP_RADIUS * self.reach, LAMP_DIGITS),
                inverted: false,
            }),
            transform: TransformDesc {
                translate: self.short(self.middle + LAMP * (LAMP_DISTANCE * self.reach)),
                ..TransformDesc::default()
            },
            // E = π L sin² α.
            emissive: Some(LAMP_GIVES.map(|share| (share / (sine * sine)).round())),
            ..EntityDesc::default()
        }
    }

    /// A place in few digits.
    fn short(&self, p: DVec3) -> [f64; 3] {
        numbers::place(p, self.reach)
    }
}

fn shape(path: &str, mesh: Option<u32>) -> ShapeDesc {
    ShapeDesc::Mesh {
        path: Placed {
            value: path.to_owned(),
            ..Placed::default()
        },
        mesh,
    }
}

fn emits(mesh: &Mesh) -> bool {
    mesh.materials.iter().any(|m| m.emission != [0.0; 3])
}

fn light(light: Light) -> LightDesc {
    match light {
        Light::Point { intensity } => LightDesc::Point { intensity },
        Light::Spot {
            intensity,
            inner_deg,
            outer_deg,
        } => LightDesc::Spot {
            intensity,
            inner_deg,
            outer_deg,
        },
        Light::Sun { irradiance } => LightDesc::Sun { irradiance },
    }
}

/// The name, with a number behind it if it is taken.
fn unique(wanted: &str, taken: &mut BTreeSet<String>) -> String {
    let numbered = (2u32..).map(|n| format!("{wanted} {n}"));
    let mut names = std::iter::once(wanted.to_owned()).chain(numbered);
    let name = names.find(|name| !taken.contains(name)).unwrap_or_default();
    taken.insert(name.clone());
    name
}
