//! Chains of specular bounces on one sphere, through which a lamp may shine on what is diffuse: a caustic each.

/// What light does on its way by a sphere, or into it, where another one may stand in its middle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u32)]
pub enum Bounces {
    /// One reflection, of a mirror.
    Mirror = 1,
    /// One reflection, of a metal.
    Metal,
    /// One reflection, of a dielectric.
    Glass,
    /// A refraction, a reflection of the sphere in the middle, a refraction.
    Inside,
    /// Two refractions.
    Through,
    /// Four refractions, through a sphere and the one in its middle.
    ThroughBoth,
}

impl Bounces {
    /// What the index of the sphere is added to in a key.
    #[must_use]
    pub fn kind(self) -> u32 {
        match self {
            Bounces::Mirror | Bounces::Metal | Bounces::Glass => Chains::REFLECTED,
            Bounces::Through => 3 * Chains::REFLECTED,
            Bounces::ThroughBoth => 5 * Chains::REFLECTED,
            Bounces::Inside => Chains::REFLECTED_INSIDE + Chains::REFLECTED,
        }
    }
}

/// The chains of a scene, in the order of their keys.
#[derive(Clone, Debug, Default)]
pub struct Chains {
    /// What a path that took it is known by: the sphere's index, and what happened since above ([`Bounces::kind`]).
    pub key: Vec<u32>,
    /// Relative index of the sphere, radius of the one in its middle over its own, relative index of that one, and the
    /// greatest distance from the middle, over the radius, at which a ray gets through. Without one in the middle: a ratio
    /// of 2 and an index of 1, which change no ray.
    pub shape: Vec<[f64; 4]>,
    /// Linear RGB that all bounces together multiply light by, but for Fresnel's factors; and the [`Bounces`] as a number.
    pub tint: Vec<[f64; 4]>,
    /// The sphere that reaches into this one from outside, as the floor does under a ball that stands on it: centre and
    /// radius, 0 where there is none. Ways that meet it inside are none.
    pub guest: Vec<[f64; 4]>,
}

impl Chains {
    /// The unit of what happened: once this, a reflection; twice to five times, as many refractions and one.
    pub const REFLECTED: u32 = 1 << 28;
    /// A refraction, then a reflection; another refraction adds a unit.
    pub const REFLECTED_INSIDE: u32 = 6 * Chains::REFLECTED;

    /// How many bounces a key has.
    #[must_use]
    pub fn bounces(key: u32) -> u32 {
        match key / Chains::REFLECTED {
            1 => 1,
            7 => 3,
            kind => kind - 1,
        }
    }

    /// Number of chains.
    #[must_use]
    pub fn len(&self) -> usize {
        self.key.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.key.is_empty()
    }

    /// The sphere of a chain.
    #[inline(always)]
    #[must_use]
    pub fn sphere(&self, chain: usize) -> u32 {
        self.key[chain] & (Chains::REFLECTED - 1)
    }
}
