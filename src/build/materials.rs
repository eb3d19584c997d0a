//! Materials and textures: resolved, each kept once, in order of first use.

use super::extract::Look;
use super::fresnel::internal_reflectance;
use super::meshes::used_slots;
use crate::asset::{self, AssetStore, Mesh, MeshMaterial, TextureId};
use crate::flat::{self, ColorSource, FilterMode, Fresnel, MaterialId, Scatter, WrapMode};
use crate::world::{Color, Scattering};
use std::collections::HashMap;

/// Albedo of what says nothing about its material.
const DEFAULT_ALBEDO: f64 = 0.8;

/// The index that stands where a material has none.
const NO_IOR: f64 = 1.0;

/// What a material is looked up by: its bits.
type Key = [u32; 10];

/// The tables of a frame while they grow.
pub(crate) struct Tables<'a> {
    store: &'a AssetStore,
    fresnel: Fresnel,
    pub(crate) materials: Vec<flat::Material>,
    known: HashMap<Key, MaterialId>,
    pub(crate) textures: Vec<flat::Texture>,
    sampled: Vec<(TextureId, asset::Wrap, asset::Filter)>,
}

impl<'a> Tables<'a> {
    pub(crate) fn new(store: &'a AssetStore, fresnel: Fresnel) -> Tables<'a> {
        Tables {
            store,
            fresnel,
            materials: Vec::new(),
            known: HashMap::new(),
            textures: Vec::new(),
            sampled: Vec::new(),
        }
    }

    /// The material of an entity's surface; `file` is what its mesh file says of the triangle.
    ///
    /// The entity's material overrides the file's, emission included; an emitter without either reflects nothing.
    pub(crate) fn resolve(&mut self, look: &Look, file: Option<&MeshMaterial>) -> MaterialId {
        let (scatter, color, ior) = match (look.material, file) {
            (Some(material), _) => {
                let (scatter, ior) = scattering(material.scattering);
                (scatter, self.color(material.color), ior)
            }
            (None, Some(file)) => {
                let (scatter, ior) = scattering(file.scattering);
                (scatter, self.file_color(file), ior)
            }
            (None, None) if look.emission.is_some() => {
                (Scatter::Nothing, constant([0.0; 3]), NO_IOR)
            }
            (None, None) => (Scatter::Diffuse, constant([DEFAULT_ALBEDO; 3]), NO_IOR),
        };
        let file_emission = file.filter(|_| look.material.is_none()).map(|f| f.emission);
        let emission = look.emission.or(file_emission).unwrap_or([0.0; 3]);
        let internal = match scatter {
            Scatter::Plastic => internal_reflectance(ior, self.fresnel),
            _ => 0.0,
        };
        self.insert(flat::Material {
            scatter,
            color,
            ior: ior as f32,
            internal_reflectance: internal as f32,
            emission: emission.map(|c| c as f32),
        })
    }

    /// The material of every slot of a mesh (see [`slot`](super::meshes::slot)); one that no triangle uses is given any.
    pub(crate) fn resolve_slots(&mut self, look: &Look, mesh: &Mesh) -> Vec<MaterialId> {
        let used = used_slots(mesh);
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
            } => ColorSource::Texture {
                texture: self.texture(texture, wrap, filter),
                factor: [1.0; 3],
            },
        }
    }

    fn file_color(&mut self, file: &MeshMaterial) -> ColorSource {
        match file.texture {
            None => constant(file.color),
            Some(of) => ColorSource::Texture {
                texture: self.texture(of.texture, of.wrap[0], of.filter),
                factor: file.color.map(|c| c as f32),
            },
        }
    }

    fn texture(&mut self, id: TextureId, wrap: asset::Wrap, filter: asset::Filter) -> u32 {
        let wanted = (id, wrap, filter);
        let place = self.sampled.iter().position(|known| *known == wanted);
        let place = place.unwrap_or_else(|| {
            let texture = self.store.texture(id);
            self.sampled.push(wanted);
            self.textures.push(flat::Texture {
                texels: texture.texels.clone(),
                width: texture.width,
                height: texture.height,
                wrap: match wrap {
                    asset::Wrap::Repeat => WrapMode::Repeat,
                    asset::Wrap::Mirror => WrapMode::Mirror,
                    asset::Wrap::Clamp => WrapMode::Clamp,
                },
                filter: match filter {
                    asset::Filter::Bilinear => FilterMode::Bilinear,
                    asset::Filter::Nearest => FilterMode::Nearest,
                },
            });
            self.textures.len() - 1
        });
        place as u32
    }

    /// Whether any material reads a texture.
    pub(crate) fn textured(&self) -> bool {
        !self.textures.is_empty()
    }
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
    let (texture, [r, g, b]) = match material.color {
        ColorSource::Constant(rgb) => (0, rgb),
        ColorSource::Texture { texture, factor } => (texture + 1, factor),
    };
    let [er, eg, eb] = material.emission;
    let bits = [
        r,
        g,
        b,
        er,
        eg,
        eb,
        material.ior,
        material.internal_reflectance,
    ]
    .map(f32::to_bits);
    let mut key = [0; 10];
    key[0] = material.scatter as u32;
    key[1] = texture;
    key[2..].copy_from_slice(&bits);
    key
}
