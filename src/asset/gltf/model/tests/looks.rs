//! Materials and textures.

use super::{Draft, png};
use crate::asset::{AlphaMode, Filter, MeshMaterial, Scattering, TextureUse, Wrap};
use crate::diag::Diagnostic;
use serde_json::{Value, json};

/// A material without a word, and with no texture coordinates.
fn plain(material: Value) -> MeshMaterial {
    let mut draft = Draft::triangle();
    draft.material(material);
    draft.clean().mesh().materials[0].clone()
}

fn with_uvs() -> Draft {
    let mut draft = Draft::triangle();
    for set in ["TEXCOORD_0", "TEXCOORD_1"] {
        let uvs = draft.floats(&[[0.25, 0.5], [0.5, 0.5], [0.5, 0.25]]);
        draft.attribute(set, uvs);
    }
    draft
}

#[test]
fn the_default_material_is_white_and_matte() {
    let read = Draft::triangle().clean();
    let [material] = &read.mesh().materials[..] else {
        panic!("one material");
    };
    assert_eq!(material.scattering, Scattering::Diffuse);
    assert_eq!((material.color, material.emission), ([1.0; 3], [0.0; 3]));
}

#[test]
fn factors_are_read_as_written() {
    let material = plain(json!({
        "name": "paint",
        "pbrMetallicRoughness": { "baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0 },
        "emissiveFactor": [0.1, 0, 1],
        "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 5 } },
        "alphaMode": "MASK",
        "doubleSided": true,
    }));
    assert_eq!(material.name, "paint");
    assert!(material.two_sided);
    assert_eq!(material.color, [0.1, 0.2, 0.3]);
    assert_eq!(material.emission, [0.5, 0.0, 5.0]);
    assert_eq!(material.opacity.mode, AlphaMode::Mask { cutoff: 0.5 });
    assert_eq!(material.opacity.factor, 0.4);
    let material = plain(json!({
        "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 0 },
        "alphaMode": "BLEND",
        "extensions": { "KHR_materials_ior": { "ior": 1.33 } },
    }));
    assert_eq!(material.scattering, Scattering::Plastic { ior: 1.33 });
    assert!(!material.two_sided);
    assert_eq!(material.opacity.mode, AlphaMode::Blend);
    let material = plain(json!({
        "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 0 },
        "extensions": { "KHR_materials_transmission": { "transmissionFactor": 1 } },
    }));
    assert_eq!(material.scattering, Scattering::Glass { ior: 1.5 });
    let material = plain(json!({ "pbrMetallicRoughness": { "roughnessFactor": 0 } }));
    assert_eq!(material.scattering, Scattering::Metal);
}

#[test]
fn old_gloss_gives_its_diffuse_colour() {
    let mut draft = with_uvs();
    let texture = draft.texture();
    draft.material(
        json!({ "extensions": { "KHR_materials_pbrSpecularGlossiness": {
        "diffuseFactor": [0.3, 0.2, 0.1, 1], "glossinessFactor": 0,
        "diffuseTexture": { "index": texture },
    } } }),
    );
    let read = draft.read().expect("a model");
    let material = &read.mesh().materials[0];
    assert_eq!(material.color, [0.3, 0.2, 0.1]);
    assert_eq!(material.scattering, Scattering::Diffuse);
    assert!(material.texture.is_some());
}

#[test]
fn an_unlit_material_shines_with_its_colour() {
    let mut draft = with_uvs();
    let texture = draft.texture();
    draft.material(json!({
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.3, 0.2, 0.1, 1], "baseColorTexture": { "index": texture },
        },
        "extensions": { "KHR_materials_unlit": {} },
    }));
    let read = draft.read().expect("a model");
    assert_eq!(read.codes(), ["W144"]);
    let material = &read.mesh().materials[0];
    assert_eq!(material.scattering, Scattering::Nothing);
    assert_eq!(material.emission, [0.3, 0.2, 0.1]);
    assert!(material.two_sided);
    assert!(material.emission_texture.is_some() && material.texture.is_none());
}

#[test]
fn a_texture_has_its_sampler_its_transform_and_its_coordinates() {
    let mut draft = with_uvs();
    let texture = draft.texture();
    draft.root["samplers"] = json!([{ "wrapS": 33071, "wrapT": 33648, "magFilter": 9728 }]);
    draft.root["textures"][texture]["sampler"] = 0.into();
    draft.material(json!({
        "pbrMetallicRoughness": { "metallicFactor": 0, "baseColorTexture": {
            "index": texture,
            "extensions": { "KHR_texture_transform": { "offset": [0.5, 0.25], "scale": [2, 4], "texCoord": 1 } },
        } },
        "emissiveTexture": { "index": texture },
        "emissiveFactor": [1, 1, 1],
    }));
    let read = draft.clean();
    let mesh = read.mesh();
    let material = &mesh.materials[0];
    assert_eq!(mesh.uvs1.len(), 3);
    let texture = material.texture.expect("a texture");
    let expected = TextureUse {
        texture: texture.texture,
        uv_set: 1,
        // v up: w' = 1 − (4 (1 − w) + 0.25).
        transform: Some([2.0, 0.0, 0.5, 0.0, 4.0, -3.25]),
        wrap: [Wrap::Clamp, Wrap::Mirror],
        filter: Filter::Nearest,
    };
    assert_eq!(texture, expected);
    let emission = material.emission_texture.expect("a texture");
    assert_eq!((emission.uv_set, emission.transform), (0, None));
    assert_eq!(
        emission.texture, texture.texture,
        "one image is one texture"
    );
    let image = read.store.texture(texture.texture);
    assert_eq!((image.width, image.height), (2, 1));
}

#[test]
fn the_second_set_is_kept_only_where_it_is_read() {
    let mut draft = with_uvs();
    let texture = draft.texture();
    draft.material(json!({
        "pbrMetallicRoughness": { "metallicFactor": 0, "baseColorTexture": { "index": texture } },
    }));
    let read = draft.read().expect("a model");
    assert_eq!((read.mesh().uvs.len(), read.mesh().uvs1.len()), (3, 0));
}

#[test]
fn without_coordinates_one_texel_colours_the_primitive() {
    let mut draft = Draft::triangle();
    let texture = draft.texture();
    draft.material(json!({ "pbrMetallicRoughness": {
        "metallicFactor": 0, "baseColorFactor": [0.5, 1, 1, 1], "baseColorTexture": { "index": texture },
    } }));
    let read = draft.read().expect("a model");
    assert_eq!(read.codes(), ["W143"]);
    let material = &read.mesh().materials[0];
    assert_eq!((material.color, material.texture), ([0.5, 0.0, 0.0], None));
}

#[test]
fn roughness_and_metalness_are_the_means_of_their_texture() {
    let mut draft = with_uvs();
    // Green is roughness, blue metalness; red is not read.
    let view = draft.view(&png(2, 1, &[255, 0, 255, 255, 102, 255]));
    draft.root["images"] = json!([{ "bufferView": view, "mimeType": "image/png" }]);
    draft.root["textures"] = json!([{ "source": 0 }]);
    draft.material(json!({
        "name": "steel",
        "pbrMetallicRoughness": { "metallicRoughnessTexture": { "index": 0 } },
    }));
    let read = draft.read().expect("a model");
    assert_eq!(read.mesh().materials[0].scattering, Scattering::Metal);
    assert_eq!(read.codes(), ["W140"]);
    assert!(
        read.warnings[0]
            .message
            .contains("polished metal: \"steel\"")
    );
    assert!(
        read.store.textures.is_empty(),
        "the image itself is not kept"
    );
}

#[test]
fn a_missing_image_is_a_warning_and_a_damaged_one_an_error() {
    let mut draft = with_uvs();
    draft.root["images"] = json!([{ "uri": "wood.png" }]);
    draft.root["textures"] = json!([{ "source": 0 }]);
    draft.material(json!({ "pbrMetallicRoughness": {
        "metallicFactor": 0, "baseColorFactor": [0.5, 1, 1, 1], "baseColorTexture": { "index": 0 },
    } }));
    draft.beside = vec![("Wood.png", b"PNG?".to_vec())];
    let read = draft.read().expect("a model");
    assert_eq!(read.codes(), ["W142"]);
    assert_eq!(
        read.warnings[0].hint.as_deref(),
        Some("did you mean \"Wood.png\"?")
    );
    assert_eq!(read.warnings[0].pointer.as_deref(), Some("/images/0/uri"));
    assert_eq!(read.mesh().materials[0].color, [0.5, 1.0, 1.0]);
    let whole = png(1, 1, &[1, 2, 3]);
    draft.beside = vec![("wood.png", whole[..whole.len() - 20].to_vec())];
    let errors = draft.read().map(|_| ()).expect_err("an error");
    assert_eq!(errors[0].code, "E108", "{errors:?}");
    assert_eq!(errors[0].pointer.as_deref(), Some("/images/0/uri"));
    // Both files are named: the one that is damaged, and the one that names it.
    let names_image = |one: &Diagnostic| one.message.contains("wood.png");
    let in_gltf = |one: &Diagnostic| {
        let ending = one.file.as_ref().and_then(|file| file.extension());
        ending.is_some_and(|ending| ending == "gltf" || ending == "glb")
    };
    for one in [&read.warnings[0], &errors[0]] {
        assert!(names_image(one) && in_gltf(one), "{one:?}");
    }
}

#[test]
fn an_image_that_is_listed_twice_is_one_texture() {
    let mut draft = with_uvs();
    draft.root["images"] = json!([{ "uri": "a.png" }, { "uri": "./a.png" }]);
    draft.root["textures"] = json!([{ "source": 0 }, { "source": 1 }]);
    draft.beside = vec![("a.png", png(1, 1, &[255, 255, 0]))];
    draft.material(json!({
        "pbrMetallicRoughness": {
            "metallicFactor": 0,
            "baseColorTexture": { "index": 0 },
            "metallicRoughnessTexture": { "index": 0 },
        },
        "emissiveTexture": { "index": 1 },
        "emissiveFactor": [1, 1, 1],
    }));
    let read = draft.clean();
    assert_eq!(read.store.textures.len(), 1);
    let material = &read.mesh().materials[0];
    assert_eq!(material.texture, material.emission_texture);
}

#[test]
fn vertex_alpha_multiplies_opacity_where_it_occurs() {
    for (mode, alpha, counts) in [
        ("BLEND", 0.5, true),
        ("MASK", 0.5, true),
        ("BLEND", 1.0, false),
    ] {
        let mut draft = Draft::triangle();
        let colors = draft.floats(&[[1.0, 1.0, 1.0, alpha]; 3]);
        draft.attribute("COLOR_0", colors);
        draft.material(json!({
            "pbrMetallicRoughness": { "metallicFactor": 0 }, "alphaMode": mode,
        }));
        let read = draft.clean();
        assert_eq!(read.mesh().materials[0].opacity.vertex_alpha, counts);
        assert_eq!(read.mesh().colors[0][3], alpha);
    }
}

#[test]
fn what_nothing_uses_is_not_needed() {
    let mut draft = Draft::triangle();
    draft.root["images"] = json!([{ "uri": "nowhere.png" }]);
    draft.root["textures"] = json!([{ "source": 0 }]);
    draft.root["materials"] =
        json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    draft.root["meshes"]
        .as_array_mut()
        .expect("a list")
        .push(json!({ "primitives": [{ "attributes": { "POSITION": 0 }, "material": 0 }] }));
    let read = draft.read().expect("a model");
    assert!(read.store.textures.is_empty());
    assert_eq!(read.model.meshes.len(), 2);
    assert_eq!(read.model.meshes[1], None);
}
