//! A scene description to a reference scene: poses, meshes and materials by code of its own.
//!
//! Understands what the tests use: a camera at top level or on an entity, meshes with file normals or `Flat`, materials on the entity.

use super::{
    Bulb, Camera, Color, Filter, Image, Kind, Material, Scene, Shape, Sky, Surface, Wrap,
    internal_reflectance, obj,
};
use glam::{DMat3, DVec3};
use luxel::scene::{
    BackgroundDesc, CameraDesc, ColorDesc, EntityDesc, FilterDesc, LightDesc, MaterialDesc,
    NormalsDesc, RotateDesc, SceneDesc, ShapeDesc, TextureFilterDesc, WrapDesc,
};
use std::path::Path;
use std::rc::Rc;

/// x ↦ linear · x + offset.
#[derive(Clone, Copy)]
struct Map {
    linear: DMat3,
    offset: DVec3,
}

impl Map {
    fn at(&self, p: DVec3) -> DVec3 {
        self.linear * p + self.offset
    }

    fn after(&self, inner: &Map) -> Map {
        Map {
            linear: self.linear * inner.linear,
            offset: self.at(inner.offset),
        }
    }
}

/// The scene of a frame.
pub(crate) fn scene(desc: &SceneDesc, frame: u32) -> Scene {
    let folder = desc.file.parent().unwrap_or(Path::new(""));
    let time = f64::from(frame) / desc.animation.fps;
    let materials: Vec<Rc<Material>> = desc
        .materials
        .iter()
        .map(|m| Rc::new(material(&m.material, folder)))
        .collect();
    let plain = Rc::new(Material {
        kind: Kind::Diffuse,
        color: Color::Flat(DVec3::splat(0.8)),
        tinted: false,
        veil: None,
    });
    let nothing = Rc::new(Material {
        kind: Kind::Nothing,
        color: Color::Flat(DVec3::ZERO),
        tinted: false,
        veil: None,
    });
    let (mut surfaces, mut bulbs) = (Vec::new(), Vec::new());
    for (i, entity) in desc.entities.iter().enumerate() {
        let entity = &entity.value;
        let map = map_of(desc, i, time);
        bulbs.extend(entity.light.as_deref().map(|light| bulb(*light, &map)));
        let Some(shape) = &entity.shape else { continue };
        let material = match (entity.material, entity.emissive) {
            (Some(m), _) => &materials[m],
            (None, Some(_)) => &nothing,
            (None, None) => &plain,
        };
        for shape in shapes(shape, entity, &map, folder) {
            surfaces.push(Surface {
                shape,
                material: Rc::clone(material),
                emission: Color::Flat(DVec3::from(entity.emissive.unwrap_or_default())),
                tinted_emission: false,
                two_sided: false,
                entity: i,
            });
        }
    }
    Scene {
        surfaces,
        bulbs,
        background: background(&desc.background, folder),
        camera: camera(desc, time),
    }
}

fn background(desc: &BackgroundDesc, folder: &Path) -> Sky {
    let hdr = match desc {
        BackgroundDesc::Linear(rgb) => return Sky::Flat(DVec3::from(*rgb)),
        BackgroundDesc::Hdr(hdr) => hdr,
    };
    let file = image::open(folder.join(&hdr.path.value)).expect("the sky of a test");
    let rgb = file.to_rgb32f();
    let texels = rgb.pixels().map(|p| DVec3::from(p.0.map(f64::from)));
    Sky::Image {
        image: Image {
            texels: texels.collect(),
            wrap: [Wrap::Repeat, Wrap::Clamp],
            bilinear: hdr.filter == TextureFilterDesc::Bilinear,
            factor: DVec3::splat(hdr.strength),
            ..Image::from_srgb(&[], rgb.width() as usize, rgb.height() as usize)
        },
        turned: turn(DVec3::Y, hdr.rotate_deg),
    }
}

fn bulb(light: LightDesc, map: &Map) -> Bulb {
    let axis = (map.linear * DVec3::NEG_Z).normalize();
    match light {
        LightDesc::Point { intensity } => Bulb::Point {
            at: map.offset,
            intensity: DVec3::from(intensity),
        },
        LightDesc::Spot {
            intensity,
            inner_deg,
            outer_deg,
        } => Bulb::Spot {
            at: map.offset,
            axis,
            intensity: DVec3::from(intensity),
            inner: inner_deg,
            outer: outer_deg,
        },
        LightDesc::Sun { irradiance } => Bulb::Sun {
            towards: -axis,
            irradiance: DVec3::from(irradiance),
        },
    }
}

fn constant(color: &ColorDesc) -> DVec3 {
    match color {
        ColorDesc::Linear(c) => DVec3::from(*c),
        other => panic!("not a constant: {other:?}"),
    }
}

fn color(color: &ColorDesc, folder: &Path) -> Color {
    let ColorDesc::Image { path, wrap, filter } = color else {
        return Color::Flat(constant(color));
    };
    let file = image::open(folder.join(&path.value)).expect("the texture of a test");
    let rgb = file.to_rgb8();
    let mut image = Image::from_srgb(rgb.as_raw(), rgb.width() as usize, rgb.height() as usize);
    image.wrap = [match wrap {
        WrapDesc::Repeat => Wrap::Repeat,
        WrapDesc::Mirror => Wrap::Mirror,
        WrapDesc::Clamp => Wrap::Clamp,
    }; 2];
    image.bilinear = *filter == TextureFilterDesc::Bilinear;
    Color::Image(image)
}

fn material(desc: &MaterialDesc, folder: &Path) -> Material {
    let (kind, c) = match desc {
        MaterialDesc::Diffuse { color } => (Kind::Diffuse, color),
        MaterialDesc::Mirror { color } => (Kind::Mirror, color),
        MaterialDesc::Glass { ior, color } => (Kind::Glass { ior: *ior }, color),
        MaterialDesc::Plastic { ior, color } => {
            let (ior, inner) = (*ior, internal_reflectance(*ior));
            (Kind::Plastic { ior, inner }, color)
        }
        MaterialDesc::Metal { color, .. } => (Kind::Metal, color),
    };
    Material {
        kind,
        color: color(c, folder),
        tinted: false,
        veil: None,
    }
}

/// The matrix that turns by an angle in degrees about an axis (Rodrigues).
fn turn(axis: DVec3, deg: f64) -> DMat3 {
    let k = axis.normalize();
    let (sin, cos) = deg.to_radians().sin_cos();
    let column = |e: DVec3| e * cos + k.cross(e) * sin + k * (k.dot(e) * (1.0 - cos));
    DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
}

fn rotation(rotate: RotateDesc) -> DMat3 {
    match rotate {
        RotateDesc::Euler([x, y, z]) => turn(DVec3::Z, z) * turn(DVec3::Y, y) * turn(DVec3::X, x),
        RotateDesc::AxisAngle { axis, deg } => turn(DVec3::from(axis), deg),
        RotateDesc::Quat([x, y, z, w]) => {
            let axis = DVec3::new(x, y, z);
            if axis == DVec3::ZERO {
                return DMat3::IDENTITY;
            }
            turn(axis, 2.0 * axis.length().atan2(w).to_degrees())
        }
    }
}

/// M = parent · T(p) · Spin · T(−p) · T · R · S.
fn map_of(desc: &SceneDesc, entity: usize, time: f64) -> Map {
    let e = &desc.entities[entity].value;
    let t = &e.transform;
    let mut map = Map {
        linear: rotation(t.rotate) * DMat3::from_diagonal(DVec3::from(t.scale)),
        offset: DVec3::from(t.translate),
    };
    if let Some(spin) = &e.spin {
        let pivot = DVec3::from(spin.pivot.unwrap_or(t.translate));
        let linear = turn(DVec3::from(spin.axis), spin.deg_per_s * time);
        let about = Map {
            linear,
            offset: pivot - linear * pivot,
        };
        map = about.after(&map);
    }
    match e.parent {
        Some(parent) => map_of(desc, parent, time).after(&map),
        None => map,
    }
}

fn shapes(shape: &ShapeDesc, entity: &EntityDesc, map: &Map, folder: &Path) -> Vec<Shape> {
    match shape {
        ShapeDesc::Sphere { radius, inverted } => vec![Shape::Sphere {
            center: map.offset,
            radius: radius * map.linear.determinant().abs().cbrt(),
            inverted: *inverted,
            axes: map.linear,
        }],
        ShapeDesc::Mesh { path, .. } => obj::read(&folder.join(&path.value))
            .into_iter()
            .map(|face| triangle(face, entity.normals, map))
            .collect(),
    }
}

/// A mirrored triangle is wound the other way, so that its normal stays outside.
fn triangle(face: obj::Face, normals: Option<NormalsDesc>, map: &Map) -> Shape {
    let mirrored = map.linear.determinant() < 0.0;
    let wind = |[a, b, c]: [DVec3; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
    let cotransform = map.linear.inverse().transpose();
    let n = match normals {
        Some(NormalsDesc::Flat) => None,
        None | Some(NormalsDesc::File) => face.n,
        Some(other) => panic!("the reference does not know {other:?}"),
    };
    let [a, b, c] = face.uv;
    Shape::Triangle {
        p: wind(face.p.map(|p| map.at(p))),
        n: n.map(|n| wind(n.map(|n| (cotransform * n).normalize()))),
        uv: if mirrored { [a, c, b] } else { [a, b, c] },
        more: None,
    }
}

/// Where the camera stands, and unit vectors forward and to the right.
fn view(desc: &SceneDesc, time: f64) -> (&CameraDesc, DVec3, [DVec3; 2]) {
    if let Some(camera) = &desc.camera {
        let pose = camera.pose.as_ref().expect("its pose");
        let eye = DVec3::from(pose.at);
        let forward = (DVec3::from(pose.look_at) - eye).normalize();
        let right = forward.cross(DVec3::from(pose.up)).normalize();
        return (camera, eye, [forward, right]);
    }
    let mut cameras = desc.entities.iter().enumerate().filter_map(|(i, e)| {
        let camera = e.value.camera.as_deref()?;
        Some((i, camera))
    });
    let (i, camera) = cameras.next().expect("a camera");
    let map = map_of(desc, i, time);
    let forward = (map.linear * DVec3::NEG_Z).normalize();
    (
        camera,
        map.offset,
        [forward, (map.linear * DVec3::X).normalize()],
    )
}

fn camera(desc: &SceneDesc, time: f64) -> Camera {
    let (camera, eye, [forward, right]) = view(desc, time);
    Camera {
        eye,
        right,
        up: right.cross(forward),
        forward,
        slope: (camera.vfov_deg.to_radians() / 2.0).tan(),
        aperture: camera.aperture_radius,
        focus: camera.focus_distance,
        width: desc.render.size.0,
        height: desc.render.size.1,
        filter: match desc.render.filter {
            FilterDesc::Box => Filter::Box,
            FilterDesc::Gaussian { radius_px } => Filter::Gaussian(radius_px),
        },
    }
}
