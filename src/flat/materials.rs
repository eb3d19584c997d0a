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

/// How much of a surface is there: `factor` times the alpha of `texture` and of the corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coverage {
    /// 0 to 1.
    pub factor: f32,
    /// Index into [`super::FlatScene::textures`].
    pub texture: Option<u32>,
    /// Whether the alpha of [`super::Shading::colors`] multiplies it.
    pub vertex_alpha: bool,
}

/// What rays meet of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Opacity {
    /// All of it.
    Full,
    /// What has at least the cutoff's coverage.
    Mask {
        /// Of the surface.
        coverage: Coverage,
        /// 0 to 1.
        cutoff: f32,
    },
    /// As many of the rays as the coverage says; the others go straight on.
    Blend(Coverage),
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
    /// Whether [`super::Shading::colors`] multiply the colour; where nothing is scattered, the emission.
    pub vertex_colors: bool,
    /// Radiance emitted on the side that the geometric normal points to, or on both: what lights are weighed by. Where
    /// it is not the same everywhere, the mean of `emission_source` over its whole image, above 0 if any texel is.
    pub emission: [f32; 3],
    /// The radiance itself, where it is not the same everywhere.
    pub emission_source: Option<ColorSource>,
    /// Whether both sides emit; never a sphere's.
    pub two_sided: bool,
    /// What rays meet.
    pub opacity: Opacity,
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
