//! The dials of tracing. Each default is the exact one.

use super::Isa;
pub use crate::flat::Fresnel;

/// Where random numbers come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Sampler {
    /// A hash of (seed, frame, pixel, sample, dimension).
    Independent,
    /// Owen-scrambled Sobol points, padded pairs of dimensions.
    #[default]
    Sobol,
}

/// What tracing may be told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TraceOptions {
    /// Scattering events on a path; 1 is direct light only.
    pub max_bounces: u32,
    /// Another picture of the same scene.
    pub seed: u64,
    /// Source of random numbers.
    pub sampler: Sampler,
    /// Next-event estimation: sample lights at every diffuse vertex.
    pub nee: bool,
    /// Weigh light and bsdf samples by the power heuristic; off: lights by next-event estimation alone, where it can.
    pub mis: bool,
    /// Sample lamps through and by specular spheres, as part of next-event estimation with weights.
    pub caustics: bool,
    /// Russian roulette.
    pub roulette: bool,
    /// Reflectance of dielectrics.
    pub fresnel: Fresnel,
    /// Which kernels.
    pub isa: Isa,
    /// Whether the averaged feature AOVs (albedo, normals, depth) are wanted.
    pub features: bool,
    /// Whether the centre-ray AOVs (uv, prim, entity) are wanted.
    pub ids: bool,
}

impl Default for TraceOptions {
    fn default() -> Self {
        TraceOptions {
            max_bounces: 7,
            seed: 0,
            sampler: Sampler::Sobol,
            nee: true,
            mis: true,
            caustics: false,
            roulette: true,
            fresnel: Fresnel::Exact,
            isa: Isa::best(),
            features: false,
            ids: false,
        }
    }
}
