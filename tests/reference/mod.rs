//! An independent path tracer: the oracle of the light tests.
//!
//! Slow and obvious on purpose. All of it is f64; every ray meets every surface (no tree, no SIMD); random numbers,
//! intersection, bsdfs, lens, transforms and OBJ reading are written here anew and share no code with luxel. From luxel
//! it takes the parsed scene description alone ([`adapt`]).
//!
//! Estimator: plain path tracing, no roulette. Next-event estimation is an option for small lamps, and then by points
//! uniform on the lamp's *area* with cos/r², where luxel samples solid angles.

pub(crate) mod adapt;
mod bsdf;
mod bulb;
mod camera;
mod obj;
mod random;
mod shape;
mod sky;
mod trace;

pub(crate) use bsdf::{dielectric, internal_reflectance};
pub(crate) use bulb::Bulb;
pub(crate) use camera::{Camera, Filter};
pub(crate) use random::Random;
pub(crate) use shape::{Corners, Hit, Shape, closest};
pub(crate) use sky::Sky;
pub(crate) use trace::{Estimator, render};

use glam::{DAffine2, DVec2, DVec3};
use std::rc::Rc;

/// A whole scene.
pub(crate) struct Scene {
    pub(crate) surfaces: Vec<Surface>,
    pub(crate) bulbs: Vec<Bulb>,
    pub(crate) background: Sky,
    pub(crate) camera: Camera,
}

/// One primitive with what it looks like.
pub(crate) struct Surface {
    pub(crate) shape: Shape,
    pub(crate) material: Rc<Material>,
    /// Radiance on the side of the geometric normal.
    pub(crate) emission: Color,
    /// The corners' colours multiply the emission rather than the material.
    pub(crate) tinted_emission: bool,
    /// Radiance on the other side too.
    pub(crate) two_sided: bool,
    /// Index of the entity in the scene file.
    pub(crate) entity: usize,
}

/// A material.
pub(crate) struct Material {
    pub(crate) kind: Kind,
    pub(crate) color: Color,
    /// The corners' colours multiply the colour.
    pub(crate) tinted: bool,
    pub(crate) veil: Option<Veil>,
}

/// How much of a surface is there.
#[derive(Clone)]
pub(crate) struct Veil {
    pub(crate) factor: f64,
    /// Whether the alpha of the corners counts.
    pub(crate) corners: bool,
    /// Its red is the alpha.
    pub(crate) alpha: Option<Image>,
    /// There if at least this, else a share.
    pub(crate) cutoff: Option<f64>,
}

impl Veil {
    /// Share of rays that meet it.
    fn presence(&self, hit: &Hit) -> f64 {
        let mut alpha = self.alpha.as_ref().map_or(1.0, |image| image.at(hit).x);
        if self.corners {
            alpha *= hit.alpha;
        }
        match self.cutoff {
            Some(cutoff) if self.factor * alpha >= cutoff => 1.0,
            Some(_) => 0.0,
            None => self.factor * alpha,
        }
    }
}

impl Surface {
    /// Radiance at a hit, on the side of the geometric normal.
    fn emitted(&self, hit: &Hit) -> DVec3 {
        let tint = if self.tinted_emission {
            hit.tint
        } else {
            DVec3::ONE
        };
        self.emission.at(hit) * tint
    }

    fn shines(&self) -> bool {
        !matches!(self.emission, Color::Flat(DVec3::ZERO))
    }

    /// Share of rays that meet it at a hit.
    fn presence(&self, hit: &Hit) -> f64 {
        self.material
            .veil
            .as_ref()
            .map_or(1.0, |veil| veil.presence(hit))
    }
}

/// How a material scatters.
#[derive(Clone, Copy)]
pub(crate) enum Kind {
    Nothing,
    Diffuse,
    Mirror,
    Glass {
        ior: f64,
    },
    /// `inner` is the hemispherical mean of the coat's internal reflectance.
    Plastic {
        ior: f64,
        inner: f64,
    },
    Metal,
}

/// A constant or an image.
#[derive(Clone)]
pub(crate) enum Color {
    Flat(DVec3),
    Image(Image),
}

/// Outside [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Wrap {
    Repeat,
    Mirror,
    Clamp,
}

/// Linear texels, row 0 at the top (v = 1).
#[derive(Clone)]
pub(crate) struct Image {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) texels: Vec<DVec3>,
    /// Across and down.
    pub(crate) wrap: [Wrap; 2],
    pub(crate) bilinear: bool,
    /// Which coordinates of a hit it takes.
    pub(crate) second: bool,
    /// What becomes of them first.
    pub(crate) map: DAffine2,
    /// Multiplies the texels.
    pub(crate) factor: DVec3,
}

impl Color {
    pub(crate) fn at(&self, hit: &Hit) -> DVec3 {
        match self {
            Color::Flat(c) => *c,
            Color::Image(image) => image.at(hit),
        }
    }
}

impl Image {
    /// sRGB bytes to linear texels (IEC 61966-2-1).
    pub(crate) fn from_srgb(rgb: &[u8], width: usize, height: usize) -> Image {
        let linear = |b: u8| {
            let e = f64::from(b) / 255.0;
            if e <= 0.04045 {
                e / 12.92
            } else {
                ((e + 0.055) / 1.055).powf(2.4)
            }
        };
        let texels = rgb
            .chunks_exact(3)
            .map(|c| DVec3::new(linear(c[0]), linear(c[1]), linear(c[2])))
            .collect();
        Image {
            width,
            height,
            texels,
            wrap: [Wrap::Repeat; 2],
            bilinear: true,
            second: false,
            map: DAffine2::IDENTITY,
            factor: DVec3::ONE,
        }
    }

    /// The texel of column i, row j, any integers.
    fn texel(&self, i: i64, j: i64) -> DVec3 {
        let place = |i: i64, n: usize, wrap: Wrap| -> usize {
            let n = n as i64;
            let k = match wrap {
                Wrap::Repeat => i.rem_euclid(n),
                Wrap::Clamp => i.clamp(0, n - 1),
                Wrap::Mirror => {
                    let k = i.rem_euclid(2 * n);
                    k.min(2 * n - 1 - k)
                }
            };
            k as usize
        };
        let (column, row) = (
            place(i, self.width, self.wrap[0]),
            place(j, self.height, self.wrap[1]),
        );
        self.texels[row * self.width + column]
    }

    /// At a hit, by its own coordinates.
    fn at(&self, hit: &Hit) -> DVec3 {
        let uv = if self.second { hit.uv1 } else { hit.uv };
        self.factor * self.look_up(self.map.transform_point2(uv))
    }

    /// Texel centres are at half-integers.
    pub(crate) fn look_up(&self, uv: DVec2) -> DVec3 {
        let x = uv.x * self.width as f64;
        let y = (1.0 - uv.y) * self.height as f64;
        if !self.bilinear {
            return self.texel(x.floor() as i64, y.floor() as i64);
        }
        let (x, y) = (x - 0.5, y - 0.5);
        let (i, j) = (x.floor(), y.floor());
        let (a, b) = (x - i, y - j);
        let (i, j) = (i as i64, j as i64);
        let top = self.texel(i, j) * (1.0 - a) + self.texel(i + 1, j) * a;
        let bottom = self.texel(i, j + 1) * (1.0 - a) + self.texel(i + 1, j + 1) * a;
        top * (1.0 - b) + bottom * b
    }
}
