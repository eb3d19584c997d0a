//! Materials and textures: resolved, each kept once, in order of first use.

use super::extract::Look;
use super::fresnel::internal_reflectance;
use crate::asset::{self, AlphaMode, AssetStore, Mesh, MeshMaterial, TextureId, TextureUse};
use crate::flat::{
    self, ColorSource, Coverage, FilterMode, Fresnel, MaterialId, Opacity, Scatter, WrapMode,
};
use crate::math::SRGB_BYTES;
use crate::world::{Color, Scattering};
use std::collections::{BTreeMap, HashMap};

/// Albedo of what says nothing about its material.
const DEFAULT_ALBEDO: f64 = 0.8;

/// The index that stands where a material has none.
const NO_IOR: f64 = 1.0;

/// What a material is looked up by: its bits.
type Key = [u32; 18];

/// Means of textures over all their texels, linear RGB.
pub(crate) type Means = BTreeMap<TextureId, [f64; 3]>;

/// The tables of a frame while they grow.
pub(crate) struct Tables<'a> {
    store: &'a AssetStore,
    fresnel: Fresnel,
    pub(crate) materials: Vec<flat::Material>,
    known: HashMap<Key, MaterialId>,
    pub(crate) textures: Vec<flat::Texture>,
    sampled: Vec<TextureUse>,
    pub(crate) means: Means,
}

/// What a surface sends out: its mean, and where it comes from if it varies.
type Emission = ([f32; 3], Option<ColorSource>);

impl<'a> Tables<'a> {
    pub(crate) fn new(store: &'a AssetStore, fresnel: Fresnel, means: Means) -> Tables<'a> {
        Tables {
            store,
            fresnel,
            materials: Vec::new(),
            known: HashMap::new(),
            textures: Vec::new(),
            sampled: Vec::new(),
            means,
        }
    }

    /// The material of an entity's surface; `file` is what its mesh file says of the triangle.
    ///
    /// The entity's material overrides the file's, emission and opacity included; an emitter without either reflects
    /// nothing.
    pub(crate) fn resolve(&mut self, look: &Look, file: Option<&MeshMaterial>) -> MaterialId {
        let file = file.filter(|_| look.material.is_none());
        let (scatter, color, ior) = match (look.material, file) {
            (Some(material), _) => {
                let (scatter, ior) = scattering(material.scattering);
                (scatter, self.color(material.color), ior)
            }
            (None, Some(file)) => {
                let (scatter, ior) = scattering(file.scattering);
                (scatter, self.source(file.color, file.texture), ior)
            }
            (None, None) if look.emission.is_some() => {
                (Scatter::Nothing, constant([0.0; 3]), NO_IOR)
            }
            (None, None) => (Scatter::Diffuse, constant([DEFAULT_ALBEDO; 3]), NO_IOR),
        };
        let (emission, emission_source) = match (look.emission, file) {
            (Some(emission), _) => (emission.0.map(|c| c as f32), None),
            (None, Some(file)) => self.emission(file),
            (None, None) => ([0.0; 3], None),
        };
        let internal = match scatter {
            Scatter::Plastic => internal_reflectance(ior, self.fresnel),
            _ => 0.0,
        };
        let opacity = file.map_or(Opacity::Full, |file| self.opacity(&file.opacity));
        self.insert(flat::Material {
            scatter,
            color,
            ior: ior as f32,
            internal_reflectance: internal as f32,
            vertex_colors: file.is_some_and(|file| file.vertex_colors),
            emission,
            emission_source,
            two_sided: look.emission.is_none() && file.is_some_and(|file| file.two_sided),
            opacity,
        })
    }

    /// The material of every slot of a mesh (see [`slot`](super::meshes::slot)); one that is not in `used` is given any.
    pub(crate) fn resolve_slots(
        &mut self,
        look: &Look,
        mesh: &Mesh,
        used: &[bool],
    ) -> Vec<MaterialId> {
        (0..used.len())
            .map(|slot| {
                if used[slot] {
                    self.resolve(look, mesh.materials.get(slot))
                } else {
                    MaterialId(0)
                }
            })
            .collect()
    }

    fn insert(&mut self, material: flat::Material) -> MaterialId {
        let next = MaterialId(self.materials.len() as u32);
        let id = *self.known.entry(key(&material)).or_insert(next);
        if id == next {
            self.materials.push(material);
        }
        id
    }

    fn color(&mut self, color: Color) -> ColorSource {
        match color {
            Color::Linear(rgb) => constant(rgb),
            Color::Texture {
                texture,
                wrap,
                filter,
            } => {
                let of = TextureUse {
                    wrap: [wrap; 2],
                    filter,
                    ..TextureUse::plain(texture)
                };
                self.source([1.0; 3], Some(of))
            }
        }
    }

    fn source(&mut self, factor: [f64; 3], texture: Option<TextureUse>) -> ColorSource {
        match texture {
            None => constant(factor),
            Some(of) => ColorSource::Texture {
                texture: self.texture(of),
                factor: factor.map(|c| c as f32),
            },
        }
    }

    /// The mean of a texture's emission is not 0 where any texel shines: its light must be found.
    fn emission(&mut self, file: &MeshMaterial) -> Emission {
        let mean = match file.emission_texture {
            Some(of) => self.mean(of.texture),
            None => [1.0; 3],
        };
        let emission = [0, 1, 2].map(|k| match file.emission[k] * mean[k] {
            shines if shines > 0.0 => (shines as f32).max(f32::MIN_POSITIVE),
            _ => 0.0,
        });
        let colored = file.vertex_colors && file.scattering == Scattering::Nothing;
        let varies = emission != [0.0; 3] && (file.emission_texture.is_some() || colored);
        let source = varies.then(|| self.source(file.emission, file.emission_texture));
        (emission, source)
    }

    /// Textures without alpha, and opacities that leave nothing out, cost nothing.
    fn opacity(&mut self, opacity: &asset::Opacity) -> Opacity {
        let texture = opacity
            .texture
            .filter(|of| self.store.texture(of.texture).alpha.is_some());
        let factor = opacity.factor as f32;
        let full = texture.is_none()
            && !opacity.vertex_alpha
            && match opacity.mode {
                AlphaMode::Opaque => true,
                AlphaMode::Mask { cutoff } => factor >= cutoff as f32,
                AlphaMode::Blend => factor >= 1.0,
            };
        if full || opacity.mode == AlphaMode::Opaque {
            return Opacity::Full;
        }
        let coverage = Coverage {
            factor,
            texture: texture.map(|of| self.texture(of)),
            vertex_alpha: opacity.vertex_alpha,
        };
        match opacity.mode {
            AlphaMode::Mask { cutoff } => Opacity::Mask {
                coverage,
                cutoff: cutoff as f32,
            },
            AlphaMode::Opaque | AlphaMode::Blend => Opacity::Blend(coverage),
        }
    }

    fn texture(&mut self, wanted: TextureUse) -> u32 {
        let place = self.sampled.iter().position(|known| *known == wanted);
        let place = place.unwrap_or_else(|| {
            self.sampled.push(wanted);
            let texture = self.store.texture(wanted.texture);
            self.textures.push(bound(texture, &wanted));
            self.textures.len() - 1
        });
        place as u32
    }

    fn mean(&mut self, id: TextureId) -> [f64; 3] {
        let texture = self.store.texture(id);
        *self.means.entry(id).or_insert_with(|| mean(texture))
    }
}

/// An image as a material reads it.
fn bound(texture: &asset::Texture, of: &TextureUse) -> flat::Texture {
    let identity = of.transform == Some([1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    flat::Texture {
        texels: texture.texels.clone(),
        alpha: texture.alpha.clone(),
        width: texture.width,
        height: texture.height,
        uv_set: of.uv_set.min(1),
        transform: of
            .transform
            .filter(|_| !identity)
            .map(|m| m.map(|x| x as f32)),
        wrap: of.wrap.map(|wrap| match wrap {
            asset::Wrap::Repeat => WrapMode::Repeat,
            asset::Wrap::Mirror => WrapMode::Mirror,
            asset::Wrap::Clamp => WrapMode::Clamp,
        }),
        filter: match of.filter {
            asset::Filter::Bilinear => FilterMode::Bilinear,
            asset::Filter::Nearest => FilterMode::Nearest,
        },
    }
}

/// Linear mean of all texels: bytes are counted first, so that the sum is exact.
fn mean(texture: &asset::Texture) -> [f64; 3] {
    let mut counts = [[0u64; 256]; 3];
    let (texels, _) = texture.texels.as_chunks::<3>();
    for texel in texels {
        for (counts, byte) in counts.iter_mut().zip(texel) {
            counts[*byte as usize] += 1;
        }
    }
    let total = texels.len().max(1) as f64;
    counts.map(|counts| {
        let sum = counts.iter().zip(SRGB_BYTES.iter());
        sum.map(|(n, linear)| *n as f64 * f64::from(*linear))
            .sum::<f64>()
            / total
    })
}

fn scattering(scattering: Scattering) -> (Scatter, f64) {
    match scattering {
        Scattering::Nothing => (Scatter::Nothing, NO_IOR),
        Scattering::Diffuse => (Scatter::Diffuse, NO_IOR),
        Scattering::Mirror => (Scatter::Mirror, NO_IOR),
        Scattering::Glass { ior } => (Scatter::Glass, ior),
        Scattering::Plastic { ior } => (Scatter::Plastic, ior),
        Scattering::Metal => (Scatter::Metal, NO_IOR),
    }
}

fn constant(rgb: [f64; 3]) -> ColorSource {
    ColorSource::Constant(rgb.map(|c| c as f32))
}

fn key(material: &flat::Material) -> Key {
    let of_source = |source: &ColorSource| match *source {
        ColorSource::Constant(rgb) => (0, rgb),
        ColorSource::Texture { texture, factor } => (texture + 1, factor),
    };
    let of_coverage = |coverage: &Coverage| {
        let texture = coverage.texture.map_or(0, |t| t + 1);
        (texture, coverage.factor, coverage.vertex_alpha)
    };
    let (texture, [r, g, b]) = of_source(&material.color);
    let [er, eg, eb] = material.emission;
    let source = material.emission_source.as_ref().map(of_source);
    let (emission_texture, [sr, sg, sb]) = source.unwrap_or_default();
    let (mode, (alpha, factor, vertex_alpha), cutoff) = match &material.opacity {
        Opacity::Full => (0, (0, 0.0, false), 0.0),
        Opacity::Mask { coverage, cutoff } => (1, of_coverage(coverage), *cutoff),
        Opacity::Blend(coverage) => (2, of_coverage(coverage), 0.0),
    };
    let flags = [
        material.vertex_colors,
        source.is_some(),
        material.two_sided,
        vertex_alpha,
    ];
    let flags = flags.map(u32::from);
    let flags = flags.into_iter().fold(mode, |all, flag| all << 1 | flag);
    let mut key = [0; 18];
    key[0] = material.scatter as u32;
    key[1..5].copy_from_slice(&[flags, texture, emission_texture, alpha]);
    let numbers = [
        r,
        g,
        b,
        er,
        eg,
        eb,
        sr,
        sg,
        sb,
        material.ior,
        material.internal_reflectance,
        factor,
        cutoff,
    ];
    key[5..].copy_from_slice(&numbers.map(f32::to_bits));
    key
}
