//! A mesh on a turntable: whatever its size, origin and up axis, it stands in the middle of the same studio.
//!
//! The mesh is scaled to the studio rather than the studio to the mesh, so that all other numbers are the same for every
//! mesh and easy to edit. The floor and the background are one tone: the floor reflects of key light and sky together
//! just what the background shows, so that no horizon is seen.

use super::fit::View;
use super::numbers::{decimals, significant};
use crate::math::{DVec3, euler_deg, sin_cos_deg};
use crate::scene::{
    AnimationDesc, BackgroundDesc, CameraDesc, CameraPose, ColorDesc, EntityDesc, GltfDesc,
    MaterialDesc, NamedMaterial, Placed, RenderDesc, RotateDesc, SceneDesc, ShapeDesc, SpinDesc,
    TransformDesc,
};
use std::path::Path;

/// Height or width of the turn, whichever is larger, in scene units.
const STAGE: f64 = 10.0;

/// A mesh that lies flat does not lie in the floor: this far above it, in scene units.
const GAP: f64 = 0.002;

/// Significant digits of the scale: far below a pixel, and no more than a person wants to read.
const SCALE_DIGITS: usize = 7;

/// That of a photographer's portrait lens, about.
const VFOV_DEG: f64 = 28.0;

/// Share of the frame that the turn fills.
const FILL: f64 = 0.8;

/// Elevation of the camera in degrees for what is taller than wide, and for what is flat. Above half the field of view,
/// so that the horizon stays out of the frame.
const ELEVATION_DEG: [f64; 2] = [17.0, 44.0];

/// The first frame shows what faces +Z turned to the left by this, in degrees.
const FIRST_DEG: f64 = -35.0;

/// A sphere so large that it passes for a plane, even at its horizon.
const FLOOR_RADIUS: f64 = 1e5;

/// The key light: far and large, so that near and far get the same of it and shadows are soft.
const KEY_RADIUS: f64 = 1100.0;
const KEY_AT: [f64; 3] = [-1800.0, 3100.0, 1700.0];

/// Radiance of the background, and what a white surface that faces the key light gets of it; slightly cool, slightly
/// warm. Together below 1: even a white sheet that faces the key light is not burnt.
const BACKGROUND: [f64; 3] = [0.29, 0.31, 0.34];
const KEY: [f64; 3] = [0.66, 0.61, 0.55];

/// Scattering events on a path: light between the parts of a mesh, and no more than a draft can wait for.
const MAX_BOUNCES: u32 = 4;

/// What is wanted.
#[derive(Clone, Debug)]
pub struct Turntable {
    /// The file, as the scene names it.
    pub path: String,
    /// Whether it is a glTF file, whose nodes are placed together.
    pub gltf: bool,
    /// Which axis of the file points up.
    pub up: Up,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Samples per pixel.
    pub spp: u32,
    /// Frames of the turn, at least 1.
    pub frames: u32,
    /// How long it takes.
    pub seconds: f64,
}

/// An axis of a file that points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Up {
    /// +X.
    X,
    /// +Y, as in luxel and glTF.
    #[default]
    Y,
    /// +Z, as in CAD; −Y is then in front.
    Z,
    /// −X.
    MinusX,
    /// −Y.
    MinusY,
    /// −Z.
    MinusZ,
}

impl Up {
    /// Euler angles that bring it to +Y.
    fn euler_deg(self) -> [f64; 3] {
        match self {
            Up::X => [0.0, 0.0, 90.0],
            Up::Y => [0.0; 3],
            Up::Z => [-90.0, 0.0, 0.0],
            Up::MinusX => [0.0, 0.0, -90.0],
            Up::MinusY => [180.0, 0.0, 0.0],
            Up::MinusZ => [90.0, 0.0, 0.0],
        }
    }
}

/// The points have no extent that a scene could show: none, all in one place, or beyond the numbers of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("it has no triangles, or their size is beyond what a scene can hold")]
pub struct NoExtent;

/// The scene of a turntable. `points` are all corners of the file's triangles, in the file's space.
///
/// # Errors
/// [`NoExtent`].
pub fn turntable(points: &[DVec3], wanted: &Turntable) -> Result<SceneDesc, NoExtent> {
    let placed = Stand::of(points, wanted.up)?;
    let elevation_deg = placed.elevation_deg();
    let (width, height) = wanted.size;
    let view = View {
        vfov_deg: VFOV_DEG,
        aspect: f64::from(width) / f64::from(height),
        elevation_deg,
        fill: FILL,
    };
    let fit = view.fit(&placed.profile);
    let (sin, cos) = sin_cos_deg(elevation_deg);
    let look_at = decimals(fit.look_at);
    let pose = CameraPose {
        at: [
            0.0,
            decimals(look_at + fit.distance * sin),
            decimals(fit.distance * cos),
        ],
        look_at: [0.0, look_at, 0.0],
        up: CameraPose::UP,
    };
    let path = Placed {
        value: wanted.path.clone(),
        ..Placed::default()
    };
    Ok(SceneDesc {
        file: Path::new("").to_owned(),
        source: "".into(),
        render: RenderDesc {
            size: wanted.size,
            spp: wanted.spp,
            max_bounces: MAX_BOUNCES,
            ..RenderDesc::default()
        },
        background: BackgroundDesc::Linear(BACKGROUND),
        camera: Some(CameraDesc {
            pose: Some(pose),
            vfov_deg: VFOV_DEG,
            focus_distance: CameraDesc::default_focus(&pose),
            ..CameraDesc::default()
        }),
        materials: vec![NamedMaterial {
            name: "paper".to_owned(),
            material: MaterialDesc::Diffuse {
                color: ColorDesc::Linear(floor_color()),
            },
            at: 0,
            len: 0,
        }],
        entities: vec![
            key(),
            floor(),
            hub(wanted.seconds),
            mesh(path, wanted, &placed.transform),
        ],
        animation: AnimationDesc {
            fps: f64::from(wanted.frames) / wanted.seconds,
            frames: 0..wanted.frames,
        },
    })
}

/// The mesh on the stage.
struct Stand {
    transform: TransformDesc,
    /// Distance from the axis and height of every point.
    profile: Vec<(f64, f64)>,
}

impl Stand {
    fn of(points: &[DVec3], up: Up) -> Result<Stand, NoExtent> {
        let upright = euler_deg(DVec3::from_array(up.euler_deg()));
        let turned = || points.iter().map(|&p| upright * p);
        let min = turned().fold(DVec3::INFINITY, DVec3::min);
        let max = turned().fold(DVec3::NEG_INFINITY, DVec3::max);
        let middle = DVec3::new(0.5 * min.x + 0.5 * max.x, min.y, 0.5 * min.z + 0.5 * max.z);
        // The larger of the height and the diameter of the turn.
        let size = turned().map(|p| {
            let from = p - middle;
            from.y.max(2.0 * radius(from))
        });
        let size = size.fold(0.0, f64::max);
        let scale = significant(STAGE / size, SCALE_DIGITS);
        let lift = DVec3::new(0.0, GAP, 0.0);
        let translate = (lift - middle * scale).to_array().map(decimals);
        // Every number of a scene lies within 1e±150; there is room to compute with them.
        let range = 1e-140..1e140;
        if !range.contains(&size) || !range.contains(&scale) || !range_of(translate) {
            return Err(NoExtent);
        }
        let place = |p: DVec3| {
            let p = p * scale + DVec3::from_array(translate);
            (radius(p), p.y)
        };
        Ok(Stand {
            transform: TransformDesc {
                translate,
                rotate: RotateDesc::Euler(up.euler_deg()),
                scale: [scale; 3],
            },
            profile: turned().map(place).collect(),
        })
    }

    /// From higher up the flatter it is, since what lies flat shows only its upper side.
    fn elevation_deg(&self) -> f64 {
        let most = |values: &dyn Fn(&(f64, f64)) -> f64| {
            self.profile.iter().map(values).fold(0.0, f64::max)
        };
        let (width, height) = (2.0 * most(&|p| p.0), most(&|p| p.1));
        let flatness = 1.0 - (height / width).min(1.0);
        let [tall, flat] = ELEVATION_DEG;
        (tall + (flat - tall) * flatness).round()
    }
}

/// Distance from the vertical axis.
fn radius(p: DVec3) -> f64 {
    (p.x * p.x + p.z * p.z).sqrt()
}

fn range_of(translate: [f64; 3]) -> bool {
    translate.iter().all(|x| x.abs() < 1e140)
}

fn key() -> Placed<EntityDesc> {
    let distance = KEY_AT.iter().map(|x| x * x).sum::<f64>().sqrt();
    let sine = KEY_RADIUS / distance;
    // E = π L sin² α (closed form for a sphere that is wholly above the surface's horizon), and E / π is wanted.
    let radiance = KEY.map(|share| (share / (sine * sine) * 10.0).round() / 10.0);
    entity(EntityDesc {
        name: Some("key".to_owned()),
        shape: Some(ShapeDesc::Sphere {
            radius: KEY_RADIUS,
            inverted: false,
        }),
        transform: at(KEY_AT),
        emissive: Some(radiance),
        ..EntityDesc::default()
    })
}

/// What a level floor must reflect to show the background's tone: background / (background + key · cos θ).
fn floor_color() -> [f64; 3] {
    let distance = KEY_AT.iter().map(|x| x * x).sum::<f64>().sqrt();
    let cosine = KEY_AT[1] / distance;
    std::array::from_fn(|c| {
        let color = BACKGROUND[c] / (BACKGROUND[c] + KEY[c] * cosine);
        (color * 1e3).round() / 1e3
    })
}

fn floor() -> Placed<EntityDesc> {
    entity(EntityDesc {
        name: Some("floor".to_owned()),
        shape: Some(ShapeDesc::Sphere {
            radius: FLOOR_RADIUS,
            inverted: false,
        }),
        material: Some(0),
        transform: at([0.0, -FLOOR_RADIUS, 0.0]),
        ..EntityDesc::default()
    })
}

/// Turns once in `seconds`.
fn hub(seconds: f64) -> Placed<EntityDesc> {
    entity(EntityDesc {
        name: Some("hub".to_owned()),
        transform: TransformDesc {
            rotate: RotateDesc::Euler([0.0, FIRST_DEG, 0.0]),
            ..TransformDesc::default()
        },
        spin: Some(SpinDesc {
            axis: [0.0, 1.0, 0.0],
            deg_per_s: 360.0 / seconds,
            pivot: None,
        }),
        ..EntityDesc::default()
    })
}

fn mesh(path: Placed<String>, wanted: &Turntable, transform: &TransformDesc) -> Placed<EntityDesc> {
    /// Index of the hub in the scene.
    const HUB: usize = 2;
    let (shape, gltf) = if wanted.gltf {
        // The studio has its own light, and the file's turns with the mesh.
        let gltf = GltfDesc {
            path,
            lights: false,
        };
        (None, Some(Box::new(gltf)))
    } else {
        (Some(ShapeDesc::Mesh { path, mesh: None }), None)
    };
    entity(EntityDesc {
        name: Some("mesh".to_owned()),
        parent: Some(HUB),
        shape,
        gltf,
        transform: *transform,
        ..EntityDesc::default()
    })
}

fn at(translate: [f64; 3]) -> TransformDesc {
    TransformDesc {
        translate,
        ..TransformDesc::default()
    }
}

fn entity(value: EntityDesc) -> Placed<EntityDesc> {
    Placed {
        value,
        at: 0,
        len: 0,
    }
}
