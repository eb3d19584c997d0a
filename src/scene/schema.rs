//! The scene format (version 1) as types. Defaults stand here and nowhere else.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

/// A value with the place where it was written: byte offset and length in [`SceneDesc::source`].
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Placed<T> {
    /// The value.
    pub value: T,
    /// Byte offset.
    pub at: usize,
    /// Length in bytes.
    pub len: usize,
}

/// A whole scene file, checked for itself: names resolve, numbers are finite, ranges are in order.
#[derive(Clone, Debug)]
pub struct SceneDesc {
    /// The file; paths in it are relative to its folder.
    pub file: PathBuf,
    /// Its text, for places.
    pub source: Arc<str>,
    /// Image and sampling settings.
    pub render: RenderDesc,
    /// Radiance from everywhere.
    pub background: BackgroundDesc,
    /// The camera at top level, if that is where it stands.
    pub camera: Option<CameraDesc>,
    /// Materials by name, in file order.
    pub materials: Vec<NamedMaterial>,
    /// Entities in file order.
    pub entities: Vec<Placed<EntityDesc>>,
    /// Frame rate and range.
    pub animation: AnimationDesc,
}

impl SceneDesc {
    /// Linear radiance of the background where the scene has none.
    pub const BACKGROUND: [f64; 3] = [0.0; 3];
}

/// `render: (..)`.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderDesc {
    /// Width and height in pixels. Default (512, 512).
    pub size: (u32, u32),
    /// Samples per pixel. Default 64.
    pub spp: u32,
    /// Scattering events on a path; 1 is direct light only. Default 7.
    pub max_bounces: u32,
    /// Pixel filter. Default `Gaussian(radius_px: 1.5)`.
    pub filter: FilterDesc,
}

impl RenderDesc {
    /// Longest side of an image in pixels.
    pub const MAX_SIDE: u32 = 1 << 15;
    /// Most pixels of an image: 8 GB of sums.
    pub const MAX_PIXELS: u64 = 1 << 27;
    /// Most samples per pixel: a count that single precision still holds exactly.
    pub const MAX_SPP: u32 = 1 << 24;
    /// Most scattering events: far beyond what any path survives.
    pub const MAX_BOUNCES: u32 = 65_535;
}

impl Default for RenderDesc {
    fn default() -> Self {
        RenderDesc {
            size: (512, 512),
            spp: 64,
            max_bounces: 7,
            filter: FilterDesc::default(),
        }
    }
}

/// Pixel filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilterDesc {
    /// One pixel wide.
    Box,
    /// Cut off at the radius, σ = radius / 3.
    Gaussian {
        /// In pixels.
        radius_px: f64,
    },
}

impl FilterDesc {
    /// Radius of `Gaussian` where it has none, in pixels.
    pub const GAUSSIAN_RADIUS_PX: f64 = 1.5;
}

impl Default for FilterDesc {
    fn default() -> Self {
        FilterDesc::Gaussian {
            radius_px: FilterDesc::GAUSSIAN_RADIUS_PX,
        }
    }
}

/// `camera: (..)` at top level, or on an entity (then without `pose`).
#[derive(Clone, Debug, PartialEq)]
pub struct CameraDesc {
    /// Where it stands, only at top level.
    pub pose: Option<CameraPose>,
    /// Vertical field of view in degrees. Default 60.
    pub vfov_deg: f64,
    /// Radius of the aperture in scene units; 0 is a pinhole. Default 0.
    pub aperture_radius: f64,
    /// Distance of the focal plane along the view axis. Default: the distance to `look_at`, else 1.
    pub focus_distance: f64,
}

impl CameraDesc {
    /// Vertical field of view where the camera has none, in degrees.
    pub const VFOV_DEG: f64 = 60.0;
    /// A pinhole.
    pub const APERTURE_RADIUS: f64 = 0.0;
    /// Focus of a camera that looks at no point, in scene units.
    pub const FOCUS_DISTANCE: f64 = 1.0;
}

impl Default for CameraDesc {
    fn default() -> Self {
        CameraDesc {
            pose: None,
            vfov_deg: CameraDesc::VFOV_DEG,
            aperture_radius: CameraDesc::APERTURE_RADIUS,
            focus_distance: CameraDesc::FOCUS_DISTANCE,
        }
    }
}

/// `at`, `look_at`, `up` of a camera at top level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraPose {
    /// The eye.
    pub at: [f64; 3],
    /// A point on the view axis.
    pub look_at: [f64; 3],
    /// What is up in the image. Default (0, 1, 0).
    pub up: [f64; 3],
}

impl CameraPose {
    /// `up` where the camera has none.
    pub const UP: [f64; 3] = [0.0, 1.0, 0.0];
}

/// A colour: it always says its space.
#[derive(Clone, Debug, PartialEq)]
pub enum ColorDesc {
    /// Linear R, G, B (Rec. 709 primaries). `Srgb("#c0ffee")` is decoded to this by the reader.
    Linear([f64; 3]),
    /// An image file, sRGB; also what `Texture("x.png")` is read as, with default wrap and filter.
    Image {
        /// Relative to the scene's folder, as written.
        path: Placed<String>,
        /// Default Repeat.
        wrap: WrapDesc,
        /// Default Bilinear.
        filter: TextureFilterDesc,
    },
}

/// `background: ..`.
#[derive(Clone, Debug, PartialEq)]
pub enum BackgroundDesc {
    /// The same everywhere, linear R, G, B. `Srgb("#c0ffee")` is decoded to this by the reader.
    Linear([f64; 3]),
    /// By direction: `Hdr("sky.hdr")`, or with named fields.
    Hdr(HdrDesc),
}

/// `Hdr(path, rotate_deg, strength, filter)`: a picture of all directions.
#[derive(Clone, Debug, PartialEq)]
pub struct HdrDesc {
    /// Relative to the scene's folder, as written.
    pub path: Placed<String>,
    /// Turns the picture about +Y, counter-clockwise seen from above; default 0.
    pub rotate_deg: f64,
    /// Multiplies its radiance; default 1.
    pub strength: f64,
    /// Default Bilinear.
    pub filter: TextureFilterDesc,
}

impl HdrDesc {
    /// `rotate_deg` where it is not said.
    pub const ROTATE_DEG: f64 = 0.0;
    /// `strength` where it is not said.
    pub const STRENGTH: f64 = 1.0;
}

/// Wrap mode of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum WrapDesc {
    /// Tiles.
    #[default]
    Repeat,
    /// Tiles, every second one mirrored.
    Mirror,
    /// The border goes on.
    Clamp,
}

/// Filter of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum TextureFilterDesc {
    /// Four nearest texels.
    #[default]
    Bilinear,
    /// Nearest texel.
    Nearest,
}

/// An entry of `materials`.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedMaterial {
    /// Its key.
    pub name: String,
    /// What it is.
    pub material: MaterialDesc,
    /// Place of the whole entry's value.
    pub at: usize,
    /// Its length in bytes.
    pub len: usize,
}

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialDesc {
    /// Two-sided Lambert. Default colour Linear(0.8, 0.8, 0.8).
    Diffuse {
        /// Albedo.
        color: ColorDesc,
    },
    /// Perfect mirror. Default colour Linear(1, 1, 1).
    Mirror {
        /// Reflectance.
        color: ColorDesc,
    },
    /// Smooth dielectric. Default ior 1.5, colour Linear(1, 1, 1).
    Glass {
        /// Index of refraction, inside over outside at this surface; between 0.01 and 100.
        ior: f64,
        /// Multiplies each transmission, never reflection.
        color: ColorDesc,
    },
    /// Smooth coat over a diffuse base. Default colour Linear(0.8, 0.8, 0.8), ior 1.5.
    Plastic {
        /// Albedo of the base.
        color: ColorDesc,
        /// Of the coat.
        ior: f64,
    },
    /// F = c + (1 − c)(1 − cos θ)⁵. Default colour Linear(0.8, 0.8, 0.8), roughness 0 (anything above: not yet).
    Metal {
        /// Reflectance at normal incidence.
        color: ColorDesc,
        /// GGX α = roughness².
        roughness: f64,
    },
}

impl MaterialDesc {
    /// Linear colour of `Diffuse`, `Plastic` and `Metal` where they have none.
    pub const DIFFUSE_COLOR: [f64; 3] = [0.8; 3];
    /// Linear colour of `Mirror` and `Glass` where they have none.
    pub const CLEAR_COLOR: [f64; 3] = [1.0; 3];
    /// Index of refraction of `Glass` and `Plastic` where they have none: crown glass, near enough.
    pub const IOR: f64 = 1.5;
    /// Roughness of `Metal` where it has none.
    pub const ROUGHNESS: f64 = 0.0;
}

impl Default for MaterialDesc {
    fn default() -> Self {
        MaterialDesc::Diffuse {
            color: ColorDesc::Linear(MaterialDesc::DIFFUSE_COLOR),
        }
    }
}

/// An entity: a struct of optional components. Those that few entities have are boxed: a scene may have very many.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct EntityDesc {
    /// Unique where given.
    pub name: Option<String>,
    /// Index into [`SceneDesc::entities`] of the entity that `parent` names.
    pub parent: Option<usize>,
    /// What it looks like.
    pub shape: Option<ShapeDesc>,
    /// Index into [`SceneDesc::materials`] of the material that `material` names.
    pub material: Option<usize>,
    /// T · R · S in the parent's frame.
    pub transform: TransformDesc,
    /// Turning.
    pub spin: Option<SpinDesc>,
    /// Moving along keys, in place of those parts of `transform` that they name.
    pub keys: Option<Box<KeysDesc>>,
    /// Emitted radiance in W·sr⁻¹·m⁻².
    pub emissive: Option<[f64; 3]>,
    /// Normals of a mesh; default `File`, and where the file has none, `Smooth(angle_deg: 60)` for OBJ, `Flat` for glTF.
    pub normals: Option<NormalsDesc>,
    /// A camera at this entity, looking along its −Z.
    pub camera: Option<Box<CameraDesc>>,
    /// A light at this entity, along its −Z.
    pub light: Option<Box<LightDesc>>,
    /// The nodes of a glTF file under this entity; `material`, `normals` and `emissive` concern all of them.
    pub gltf: Option<Box<GltfDesc>>,
}

/// A shape.
#[derive(Clone, Debug, PartialEq)]
pub enum ShapeDesc {
    /// Around the entity's origin.
    Sphere {
        /// Above 0.
        radius: f64,
        /// Normals inward. Default false.
        inverted: bool,
    },
    /// `Mesh("cat.obj")`, or `Mesh(path: "room.glb", mesh: 3)`.
    Mesh {
        /// Relative to the scene's folder, as written.
        path: Placed<String>,
        /// Index into the `meshes` of a glTF file; an OBJ file has none.
        mesh: Option<u32>,
    },
}

/// `gltf: "room.glb"`, or `gltf: (path: "room.glb", lights: false)`: the nodes of a file's default scene, under the
/// entity.
#[derive(Clone, Debug, PartialEq)]
pub struct GltfDesc {
    /// Relative to the scene's folder, as written.
    pub path: Placed<String>,
    /// Whether the file's punctual lights shine. Default true.
    pub lights: bool,
}

/// `light: ..`: a light without extent, at the entity's origin, along its −Z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightDesc {
    /// Shines equally into every direction.
    Point {
        /// Radiant intensity in W·sr⁻¹, linear RGB.
        intensity: [f64; 3],
    },
    /// Shines into a cone.
    Spot {
        /// Radiant intensity along the axis in W·sr⁻¹, linear RGB.
        intensity: [f64; 3],
        /// Angle from the axis within which it is full, in degrees; from 0 to below `outer_deg`.
        inner_deg: f64,
        /// Angle from the axis beyond which it is nothing, in degrees; at most 90.
        outer_deg: f64,
    },
    /// Shines from infinitely far away.
    Sun {
        /// Irradiance of a surface that faces it in W·m⁻², linear RGB.
        irradiance: [f64; 3],
    },
}

/// `transform: (translate, rotate, scale)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransformDesc {
    /// Default 0.
    pub translate: [f64; 3],
    /// Default none.
    pub rotate: RotateDesc,
    /// A number or a triple; default 1.
    pub scale: [f64; 3],
}

impl Default for TransformDesc {
    fn default() -> Self {
        TransformDesc {
            translate: [0.0; 3],
            rotate: RotateDesc::Euler([0.0; 3]),
            scale: [1.0; 3],
        }
    }
}

/// A rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RotateDesc {
    /// Degrees about x, y, z; R = Rz · Ry · Rx.
    Euler([f64; 3]),
    /// Degrees about an axis (not of length 0).
    AxisAngle {
        /// Any length above 0.
        axis: [f64; 3],
        /// Degrees, counter-clockwise seen against the axis.
        deg: f64,
    },
    /// x, y, z, w; normalised by the world (not of length 0).
    Quat([f64; 4]),
}

/// `spin: (axis, deg_per_s, pivot)`, in the parent's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpinDesc {
    /// Any length above 0.
    pub axis: [f64; 3],
    /// Degrees per second.
    pub deg_per_s: f64,
    /// A point of the parent's frame; default the entity's `translate`.
    pub pivot: Option<[f64; 3]>,
}

/// `keys: [..]` with `ease: ..`.
#[derive(Clone, Debug, PartialEq)]
pub struct KeysDesc {
    /// At rising times, at least one.
    pub keys: Vec<KeyDesc>,
    /// How one comes from each to the next. Default Linear.
    pub ease: EaseDesc,
}

/// `(t, translate, rotate, scale)`: what is not given has no key at this time. Before its first key a part is as there, and
/// behind its last too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeyDesc {
    /// Seconds.
    pub t: f64,
    /// As in a transform.
    pub translate: Option<[f64; 3]>,
    /// As in a transform. Between two keys it turns the shorter way, at most half a turn.
    pub rotate: Option<RotateDesc>,
    /// As in a transform; none goes through 0.
    pub scale: Option<[f64; 3]>,
}

/// `ease: Linear`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum EaseDesc {
    /// At constant speed.
    #[default]
    Linear,
    /// From rest to rest: 3u² − 2u³.
    Smooth,
    /// As the key before says.
    Step,
}

/// Normals of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NormalsDesc {
    /// As in the file.
    File,
    /// One per triangle.
    Flat,
    /// Averaged over faces that meet at less than the angle. Default 60.
    Smooth {
        /// Degrees.
        angle_deg: f64,
    },
}

impl NormalsDesc {
    /// Angle of `Smooth` where it has none, and of meshes whose file has no normals, in degrees.
    pub const SMOOTH_ANGLE_DEG: f64 = 60.0;
}

/// `animation: (fps, frames)`. Default 24 frames a second, frames 0..1.
#[derive(Clone, Debug, PartialEq)]
pub struct AnimationDesc {
    /// Frames a second; frame k is at k / fps seconds.
    pub fps: f64,
    /// Half-open.
    pub frames: Range<u32>,
}

impl Default for AnimationDesc {
    fn default() -> Self {
        AnimationDesc {
            fps: 24.0,
            frames: 0..1,
        }
    }
}
