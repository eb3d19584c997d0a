//! Materials: what the surface stage needs, resolved.

/// A material of [`super::FlatScene::materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialId(pub u32);

/// How a material scatters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u32)]
pub enum Scatter {
    /// Not at all: a pure emitter.
    Nothing,
    /// Two-sided Lambert.
    Diffuse,
    /// Perfect mirror.
    Mirror,
    /// Smooth dielectric.
    Glass,
    /// Smooth dielectric coat over Lambert.
    Plastic,
    /// Smooth metal, F = c + (1 − c)(1 − cos θ)⁵.
    Metal,
}

/// Where a colour comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ColorSource {
    /// Linear RGB.
    Constant([f32; 3]),
    /// Linear factor times a texture of [`super::FlatScene::textures`].
    Texture {
        /// Index.
        texture: u32,
        /// Factor.
        factor: [f32; 3],
    },
}

/// A material with its emission.
#[derive(Clone, Copy, Debug)]
pub struct Material {
    /// How it scatters.
    pub scatter: Scatter,
    /// Albedo, reflectance or transmittance.
    pub color: ColorSource,
    /// Inside over outside; Glass and Plastic.
    pub ior: f32,
    /// Hemispherical mean of the coat's internal reflectance, ∫ F(n → 1) 2 cos θ sin θ dθ; Plastic.
    pub internal_reflectance: f32,
    /// Radiance emitted on the side that the geometric normal points to.
    pub emission: [f32; 3],
}

/// Reflectance of dielectrics.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Fresnel {
    /// Fresnel's equations, unpolarised.
    #[default]
    Exact,
    /// Schlick's approximation, R = k0 + (1 − k0)(1 − |cos θ|)⁵.
    Schlick,
    /// Nothing is reflected, except totally.
    Off,
}
