//! The light table: emissive spheres and triangles, lights without extent, and the sky, for next-event estimation.
//!
//! A light is chosen with probability `weight / total`, `weight` = power / π, power being the mean of its RGB. For a
//! surface that is area × radiance, twice where both sides shine; then a point on it: a triangle's uniformly by area, a sphere's uniformly in the solid
//! angle that it subtends. What comes from infinitely far is weighed by what of it meets the scene ([`super::Environment`]
//! has its own table of directions).

/// Emissive triangles in scene space, whatever they are stored in.
#[derive(Clone, Debug, Default)]
pub struct LightTriangles {
    /// First vertex.
    pub v0: Vec<[f32; 3]>,
    /// Second minus first vertex, counter-clockwise seen from the emitting side.
    pub e1: Vec<[f32; 3]>,
    /// Third minus first vertex.
    pub e2: Vec<[f32; 3]>,
    /// Area in scene units.
    pub area: Vec<f32>,
    /// Radiance; its mean where it varies.
    pub radiance: Vec<[f32; 3]>,
    /// Whether each shines from both sides: half of its samples are for either. Empty unless any does.
    pub two_sided: Vec<bool>,
    /// Where to look up what varies over each triangle. Empty unless a material's emission or opacity does.
    pub place: Vec<LightPlace>,
}

/// A light triangle as hits know it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightPlace {
    /// Primitive of its geometry.
    pub prim: u32,
    /// Index of its instance; `None` in the world geometry.
    pub instance: Option<u32>,
    /// Its second and third corner have changed places, since the instance mirrors.
    pub mirrored: bool,
}

/// A light without extent, in scene units. f64: what is far away or tiny in scene units stays finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Punctual {
    /// Equally into every direction.
    Point {
        /// Where.
        position: [f64; 3],
        /// Radiant intensity times the square of the rebase's scale: over a squared distance it is irradiance.
        intensity: [f64; 3],
    },
    /// Into a cone; between the angles falling off as the square of (cos θ − `cos_outer`) / (`cos_inner` − `cos_outer`).
    Spot {
        /// Where.
        position: [f64; 3],
        /// Unit; where it shines to.
        axis: [f64; 3],
        /// As of a point, along the axis.
        intensity: [f64; 3],
        /// Of the angle from the axis within which it is full.
        cos_inner: f64,
        /// Of the angle from the axis beyond which it is nothing.
        cos_outer: f64,
    },
    /// From infinitely far away.
    Sun {
        /// Unit, to the light.
        to_light: [f64; 3],
        /// Irradiance of a surface that faces it.
        irradiance: [f64; 3],
    },
}

/// All lights: spheres first, then triangles, then those without extent, each in authoring order; the sky comes last.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    /// Sphere index of each sphere light.
    pub spheres: Vec<u32>,
    /// Triangle lights.
    pub triangles: LightTriangles,
    /// Lights without extent.
    pub punctual: Vec<Punctual>,
    /// Whether the scene's environment is a light, the last one.
    pub environment: bool,
    /// Running sums of the weights over `spheres`, `triangles`, `punctual` and the environment, f64; the last is the total.
    pub cumulative: Vec<f64>,
}

impl Lights {
    /// Number of lights.
    #[must_use]
    pub fn len(&self) -> usize {
        self.cumulative.len()
    }

    /// Whether nothing emits.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.cumulative.is_empty()
    }

    /// Probability of choosing a light.
    #[must_use]
    pub fn share(&self, light: usize) -> f64 {
        let below = light.checked_sub(1).map_or(0.0, |k| self.cumulative[k]);
        (self.cumulative[light] - below) / self.total()
    }

    /// Sum of all weights.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.cumulative.last().copied().unwrap_or(0.0)
    }
}
