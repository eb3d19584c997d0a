//! The components of an entity. All but [`Pose`] are authored; `pose` writes that one.

use crate::asset::{Filter, MeshId, PanoramaId, TextureId, Wrap};
pub use crate::asset::{Light, Scattering};
use crate::math::{DAffine3, DMat3, DQuat, DVec3};
use hecs::Entity;

/// T · R · S in the parent's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// Authored units.
    pub translate: DVec3,
    /// A rotation, as a matrix: from a quaternion quarter turns would not be exact.
    pub rotate: DMat3,
    /// Along the entity's own axes.
    pub scale: DVec3,
}

impl Default for Transform {
    fn default() -> Self {
        Transform {
            translate: DVec3::ZERO,
            rotate: DMat3::IDENTITY,
            scale: DVec3::ONE,
        }
    }
}

/// What an entity looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// Around the entity's origin.
    Sphere {
        /// Before the entity's scale.
        radius: f64,
        /// Normals point inward.
        inverted: bool,
    },
    /// A mesh of the store.
    Mesh {
        /// Which.
        mesh: MeshId,
        /// Where its shading normals come from.
        normals: Normals,
    },
}

/// Where the shading normals of a mesh come from.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Normals {
    /// The file; where it has none, `Smooth` by [`Normals::DEFAULT_ANGLE_DEG`], or `Flat` if the format says so, as
    /// glTF does.
    #[default]
    File,
    /// The triangles themselves.
    Flat,
    /// Averaged over faces that meet at less than the angle.
    Smooth {
        /// Degrees.
        angle_deg: f64,
    },
}

impl Normals {
    /// What stands in for the normals that a file lacks.
    pub const DEFAULT_ANGLE_DEG: f64 = 60.0;
}

/// How an entity scatters light. An entity without this component looks as its mesh file says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// The kind, with its constants.
    pub scattering: Scattering,
    /// Albedo, reflectance or transmittance.
    pub color: Color,
}

/// Where a colour comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Color {
    /// Linear RGB.
    Linear([f64; 3]),
    /// A texture of the store.
    Texture {
        /// Which.
        texture: TextureId,
        /// Outside [0, 1].
        wrap: Wrap,
        /// Between texels.
        filter: Filter,
    },
}

/// Radiance in W·sr⁻¹·m⁻² on the side that the geometric normal points to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Emissive(pub [f64; 3]);

/// Radiance from infinitely far away, by direction. Where its entity stands does not concern it, nor how that is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    /// Of the store. Its middle is towards +Z, its top towards +Y; seen from below, it is unmirrored.
    pub image: PanoramaId,
    /// Turns it about +Y, counter-clockwise seen from above.
    pub rotate_deg: f64,
    /// Multiplies its radiance.
    pub strength: f64,
    /// Between texels.
    pub filter: Filter,
}

/// A camera at the entity's origin, looking along its −Z with its Y up; scale does not concern it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Vertical field of view.
    pub vfov_deg: f64,
    /// Authored units; 0 is a pinhole.
    pub aperture_radius: f64,
    /// Along the view axis, authored units.
    pub focus_distance: f64,
}

/// The entity in whose frame this one's transform is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parent(pub Entity);

/// Turns in the parent's frame about a point of the parent's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spin {
    /// Any length above 0.
    pub axis: DVec3,
    /// Degrees per second, counter-clockwise seen against the axis.
    pub deg_per_s: f64,
    /// `None`: the entity's own `translate`.
    pub pivot: Option<DVec3>,
}

/// Moves along keys in the parent's frame: a part that has keys is theirs, in place of the [`Transform`]'s.
#[derive(Clone, Debug, PartialEq)]
pub struct Keys {
    /// In place of `translate`.
    pub translate: Track<DVec3>,
    /// In place of `rotate`.
    pub rotate: Track<Turn>,
    /// In place of `scale`.
    pub scale: Track<DVec3>,
}

/// A value at rising times; no times if it has no keys.
#[derive(Clone, Debug, PartialEq)]
pub struct Track<T> {
    /// Seconds, rising.
    pub times: Vec<f64>,
    /// At each of the times.
    pub values: Vec<T>,
    /// Of splines, with which each key is reached and left, per second; else empty.
    pub tangents: Vec<[[f64; 4]; 2]>,
    /// Between the times.
    pub ease: Ease,
}

/// How a value comes from one key to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ease {
    /// At constant speed.
    Linear,
    /// From rest to rest.
    Smooth,
    /// It stays what it was.
    Step,
    /// Along cubic splines.
    Spline,
}

/// A rotation at a key: as authored, and for the way to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Quarter turns are exact.
    pub matrix: DMat3,
    /// Of length 1.
    pub quaternion: DQuat,
}

/// The order of a scene: first by entity, then by node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct AuthoringIndex {
    /// Index of the entity in the scene file. A camera at top level, and the sky, come after all entities.
    pub entity: u32,
    /// 0 for the entity itself; for the nodes of its glTF file, 1 and up in the order of the walk.
    pub node: u32,
}

/// The entity's name in the scene file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name(pub String);

/// Where an entity is at one time: world = `linear` · local + `offset` + `anchor`.
///
/// The anchor is the authored translation of the entity's root, kept apart so that the build can subtract its origin
/// from it *before* anything is added: a scene far from zero then gives the same bits as one near it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Rotation and scale of the whole chain.
    pub linear: DMat3,
    /// Translation relative to the anchor.
    pub offset: DVec3,
    /// `translate` of the root of the chain, as authored.
    pub anchor: DVec3,
    /// Product of the |x scales| of the chain: what a radius is multiplied by (spheres are scaled uniformly).
    pub size: f64,
}

impl Default for Pose {
    fn default() -> Self {
        Pose::IDENTITY
    }
}

impl Pose {
    /// At the world's origin, as it is.
    pub const IDENTITY: Pose = Pose {
        linear: DMat3::IDENTITY,
        offset: DVec3::ZERO,
        anchor: DVec3::ZERO,
        size: 1.0,
    };

    /// As one affine map, local to world.
    #[must_use]
    pub fn affine(&self) -> DAffine3 {
        DAffine3 {
            matrix3: self.linear,
            translation: self.anchor + self.offset,
        }
    }
}
