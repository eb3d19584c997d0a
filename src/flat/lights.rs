//! The light table: emissive spheres and triangles, for next-event estimation.
//!
//! A light is chosen with probability `weight / total`, `weight` = area × mean of the RGB radiance; then a point on it:
//! a triangle's uniformly by area, a sphere's uniformly in the solid angle that it subtends.

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
    /// Radiance.
    pub radiance: Vec<[f32; 3]>,
}

/// All lights: spheres first, then triangles, each in authoring order.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    /// Sphere index of each sphere light.
    pub spheres: Vec<u32>,
    /// Triangle lights.
    pub triangles: LightTriangles,
    /// Running sums of the weights over `spheres` then `triangles`, f64; the last is the total.
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

    /// Sum of all weights.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.cumulative.last().copied().unwrap_or(0.0)
    }
}
