//! Materials of a glTF file to [`MeshMaterial`]s.
//!
//! Enter: a material as a primitive uses it, and decoded images. Leaves: colour, emission, opacity and the nearest
//! scattering that luxel has (the table of `gloss`). Deliberately absent: normal textures, which are said; occlusion
//! textures, since a path tracer computes occlusion; `doubleSided` but for emission, since every surface reflects on two
//! sides here.

use super::exact::{exact, exact_one};
use super::gloss::{Approximated, DEFAULT_IOR, Surface};
use super::images::{Images, Wanted};
use super::notes::{Notes, Topic};
use super::source::Source;
use super::textures::{Sampled, sampled, uv_set};
use crate::asset::{AlphaMode, Loader, MeshMaterial, Opacity, Scattering, TextureUse, codes};
use gltf::Material;
use gltf::material::AlphaMode as FileAlphaMode;
use gltf::texture::Info;

/// What `alphaCutoff` is where a material does not say (section 5.19.9).
const DEFAULT_CUTOFF: f64 = 0.5;

const NORMAL_MAP: Topic = Topic {
    code: codes::GLTF_NOT_MODELLED,
    says: "materials have a normal texture, which is not modelled",
    hint: "their surfaces are as smooth as their mesh",
};

const TRANSMISSION_MAP: Topic = Topic {
    code: codes::GLTF_NOT_MODELLED,
    says: "materials have a transmission texture, of which only the factor is used",
    hint: "split the mesh by material",
};

const UNLIT: Topic = Topic {
    code: codes::GLTF_UNLIT,
    says: "unlit materials are shown as light sources of their colour",
    hint: "they light what is near them; choose another look by `material` on the entity",
};

const WITHOUT_UV: Topic = Topic {
    code: codes::GLTF_WITHOUT_UV,
    says: "primitives lack the texture coordinates that their material reads: one texel colours them",
    hint: "unwrap the mesh, or give it another material",
};

/// What decides the material of a primitive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Look {
    /// Index in the file; `None` is the default material.
    pub(super) material: Option<usize>,
    /// Which sets of texture coordinates the primitive has.
    pub(super) uv_sets: [bool; 2],
    /// Whether it has vertex colours.
    pub(super) colors: bool,
    /// Whether the alpha of any of them is below 1.
    pub(super) alphas: bool,
}

impl Look {
    pub(super) fn has_uv_set(&self, set: u32) -> bool {
        self.uv_sets.get(set as usize) == Some(&true)
    }
}

/// The textures that luxel reads texel by texel, each with the rest of the pointer to it.
fn infos<'a>(material: &Material<'a>) -> [Option<(Info<'a>, &'static str)>; 2] {
    let color = match material.pbr_specular_glossiness() {
        Some(old) => {
            let pointer = "extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture";
            old.diffuse_texture().map(|info| (info, pointer))
        }
        None => {
            let pbr = material.pbr_metallic_roughness();
            let pointer = "pbrMetallicRoughness/baseColorTexture";
            pbr.base_color_texture().map(|info| (info, pointer))
        }
    };
    let shines = !material.unlit() && material.emissive_factor() != [0.0; 3];
    let emission = material.emissive_texture().filter(|_| shines);
    [color, emission.map(|info| (info, "emissiveTexture"))]
}

/// Whether a material reads a set of texture coordinates.
pub(super) fn reads_uv_set(material: &Material<'_>, set: u32) -> bool {
    let mut infos = infos(material).into_iter().flatten();
    infos.any(|(info, _)| uv_set(&info) == set)
}

/// Says that a primitive lacks texture coordinates, if it does.
pub(super) fn say_missing_uvs(
    material: &Material<'_>,
    look: &Look,
    primitive: &str,
    notes: &mut Notes,
) {
    let mut infos = infos(material).into_iter().flatten();
    if infos.any(|(info, _)| !look.has_uv_set(uv_set(&info))) {
        notes.add(&WITHOUT_UV, primitive);
    }
}

/// Notes which images a material reads.
pub(super) fn want(material: &Material<'_>, wanted: &mut Wanted) {
    let image = |info: &Info<'_>| Some(info.texture().source()?.index());
    let infos = infos(material).into_iter().flatten();
    wanted
        .colors
        .extend(infos.filter_map(|(info, _)| image(&info)));
    let gloss = gloss_texture(material);
    wanted.gloss.extend(gloss.and_then(|info| image(&info)));
}

/// The texture of roughness and metalness, if anything looks at it.
fn gloss_texture<'a>(material: &Material<'a>) -> Option<Info<'a>> {
    if material.unlit() || material.pbr_specular_glossiness().is_some() {
        return None;
    }
    material
        .pbr_metallic_roughness()
        .metallic_roughness_texture()
}

/// Makes the materials of a file, and gathers what there is to say about them.
pub(super) struct Maker<'a> {
    pub(super) loader: &'a Loader,
    pub(super) source: &'a Source,
    pub(super) images: &'a Images,
    pub(super) notes: &'a mut Notes,
    pub(super) approximated: Approximated,
}

impl Maker<'_> {
    /// The material of primitives that look alike.
    ///
    /// The default material is a white metal of roughness 1 by the letter, and here white and matte, as meant.
    pub(super) fn material(&mut self, look: &Look) -> MeshMaterial {
        let index = look.material;
        let file = index.and_then(|index| self.source.document.materials().nth(index));
        let (Some(file), Some(index)) = (file, index) else {
            return MeshMaterial {
                vertex_colors: look.colors,
                ..MeshMaterial::diffuse("default", [1.0; 3])
            };
        };
        let place = format!("/materials/{index}");
        let name = file.name().map(str::to_owned);
        let name = name.unwrap_or_else(|| format!("material {index}"));
        let [color_info, emission_info] = infos(&file);
        let (factor, surface) = self.surface(&file, &place);
        let (color, texture) = self.textured(color_factor(factor), color_info, &place, look);
        let opacity = Opacity {
            factor: factor[3].clamp(0.0, 1.0),
            texture,
            vertex_alpha: look.alphas,
            mode: self.alpha_mode(&file, &place),
        };
        self.say(&file, &place);
        let mut material = MeshMaterial {
            texture,
            vertex_colors: look.colors,
            two_sided: file.double_sided() || file.unlit(),
            opacity,
            ..MeshMaterial::diffuse(name, color)
        };
        if file.unlit() {
            material.scattering = Scattering::Nothing;
            material.emission = color;
            material.emission_texture = texture;
            material.color = [0.0; 3];
            material.texture = None;
            return material;
        }
        let (scattering, same) = surface.scattering();
        if !same {
            self.approximated.add(scattering, &material.name, &place);
        }
        material.scattering = scattering;
        let emission = self.emission(&file, &place);
        (material.emission, material.emission_texture) =
            self.textured(emission, emission_info, &place, look);
        material
    }

    /// The base colour with its alpha, and the gloss.
    fn surface(&self, file: &Material<'_>, place: &str) -> ([f64; 4], Surface) {
        let json = &self.source.json;
        let one = |part: &str, typed| exact_one(json, &format!("{place}/{part}"), typed);
        let ior = one(
            "extensions/KHR_materials_ior/ior",
            file.ior().unwrap_or(DEFAULT_IOR as f32),
        );
        let clear = file.transmission().map(|t| t.transmission_factor());
        let transmission = one(
            "extensions/KHR_materials_transmission/transmissionFactor",
            clear.unwrap_or_default(),
        );
        if let Some(old) = file.pbr_specular_glossiness() {
            let at = format!("{place}/extensions/KHR_materials_pbrSpecularGlossiness");
            let pointer = format!("{at}/glossinessFactor");
            let glossiness = exact_one(json, &pointer, old.glossiness_factor());
            let surface = Surface {
                transmission,
                metallic: 0.0,
                roughness: 1.0 - glossiness,
                ior,
            };
            let diffuse = exact(json, &format!("{at}/diffuseFactor"), old.diffuse_factor());
            return (diffuse, surface);
        }
        let pbr = file.pbr_metallic_roughness();
        let at = |part: &str| format!("pbrMetallicRoughness/{part}");
        let mut surface = Surface {
            transmission,
            metallic: one(&at("metallicFactor"), pbr.metallic_factor()),
            roughness: one(&at("roughnessFactor"), pbr.roughness_factor()),
            ior,
        };
        let image = gloss_texture(file).and_then(|info| Some(info.texture().source()?.index()));
        if let Some(mean) = image.and_then(|image| self.images.gloss(image)) {
            surface.metallic *= mean.metallic;
            surface.roughness *= mean.roughness;
        }
        let pointer = format!("{place}/{}", at("baseColorFactor"));
        (exact(json, &pointer, pbr.base_color_factor()), surface)
    }

    fn emission(&self, file: &Material<'_>, place: &str) -> [f64; 3] {
        let json = &self.source.json;
        let strength = exact_one(
            json,
            &format!("{place}/extensions/KHR_materials_emissive_strength/emissiveStrength"),
            file.emissive_strength().unwrap_or(1.0),
        );
        let pointer = format!("{place}/emissiveFactor");
        let factor = exact(json, &pointer, file.emissive_factor());
        factor.map(|c| (c * strength).clamp(0.0, super::lights::MAX_POWER))
    }

    /// A factor and its texture, as far as the primitive can be textured.
    fn textured(
        &self,
        factor: [f64; 3],
        info: Option<(Info<'_>, &str)>,
        place: &str,
        look: &Look,
    ) -> ([f64; 3], Option<TextureUse>) {
        let Some((info, part)) = info else {
            return (factor, None);
        };
        let pointer = format!("{place}/{part}");
        let of = (&info, pointer.as_str());
        match sampled(self.loader, self.source, self.images, of, look) {
            Sampled::Nothing => (factor, None),
            Sampled::Texture(texture) => (factor, Some(texture)),
            Sampled::Texel(texel) => (std::array::from_fn(|k| factor[k] * texel[k]), None),
        }
    }

    fn alpha_mode(&self, file: &Material<'_>, place: &str) -> AlphaMode {
        match file.alpha_mode() {
            FileAlphaMode::Opaque => AlphaMode::Opaque,
            FileAlphaMode::Mask => {
                let pointer = format!("{place}/alphaCutoff");
                let cutoff = file.alpha_cutoff().unwrap_or(DEFAULT_CUTOFF as f32);
                AlphaMode::Mask {
                    cutoff: exact_one(&self.source.json, &pointer, cutoff),
                }
            }
            FileAlphaMode::Blend => AlphaMode::Blend,
        }
    }

    /// What this material asks for and does not get.
    fn say(&mut self, file: &Material<'_>, place: &str) {
        if file.unlit() {
            self.notes.add(&UNLIT, place);
            return;
        }
        if file.normal_texture().is_some() {
            self.notes
                .add(&NORMAL_MAP, format!("{place}/normalTexture"));
        }
        let clear = file.transmission();
        if clear.is_some_and(|clear| clear.transmission_texture().is_some()) {
            self.notes.add(&TRANSMISSION_MAP, place);
        }
    }
}

fn color_factor([r, g, b, _]: [f64; 4]) -> [f64; 3] {
    [r, g, b].map(|c| c.clamp(0.0, 1.0))
}
