//! The extensions of glTF that are known by name: which luxel reads, which change nothing that it shows, and what to do
//! about the others.
//!
//! Specification: section 3.12; the registry of extensions in Khronos' repository of glTF.

use super::report::Report;
use crate::asset::codes;
use crate::asset::gltf::layout::items;
use crate::diag::Diagnostic;
use serde_json::Value;
use std::collections::BTreeSet;

/// What luxel does with an extension.
#[derive(Clone, Copy)]
enum Verdict {
    /// Reads it.
    Read,
    /// Needs nothing of it: it does not change a picture of the scene at rest. Silent, even where it is required.
    Nothing,
    /// Lacks it. Without it `.0`; with `.1` the file can be made to do without.
    Lacks(&'static str, &'static str),
}

use Verdict::{Lacks, Nothing, Read};

const COMPRESSED: &str =
    "export without compression, or run `gltf-transform copy in.glb out.glb`, which decodes it";
const AS_PNG: &str = "export PNG or JPEG textures, or run `gltf-transform png in.glb out.glb`";
const PLAIN: &str = "export without this extension";
const EXPANDED: &str = "export the instances as nodes";
const SHINE: &str = "the material shows without it";

const KNOWN: &[(&str, Verdict)] = &[
    ("KHR_lights_punctual", Read),
    ("KHR_materials_emissive_strength", Read),
    ("KHR_materials_ior", Read),
    ("KHR_materials_pbrSpecularGlossiness", Read),
    ("KHR_materials_transmission", Read),
    ("KHR_materials_unlit", Read),
    ("KHR_mesh_quantization", Read),
    ("KHR_texture_transform", Read),
    // Metadata, interaction, sound, physics, motion: nothing to see in a picture of the scene at rest.
    ("AGI_articulations", Nothing),
    ("AGI_stk_metadata", Nothing),
    ("CESIUM_primitive_outline", Nothing),
    ("EXT_instance_features", Nothing),
    ("EXT_mesh_features", Nothing),
    ("EXT_mesh_manifold", Nothing),
    ("EXT_structural_metadata", Nothing),
    ("KHR_animation_pointer", Nothing),
    ("KHR_audio_emitter", Nothing),
    ("KHR_interactivity", Nothing),
    (VARIANTS, Nothing),
    ("KHR_node_hoverability", Nothing),
    ("KHR_node_selectability", Nothing),
    ("KHR_physics_rigid_bodies", Nothing),
    ("KHR_implicit_shapes", Nothing),
    ("KHR_xmp", Nothing),
    ("KHR_xmp_json_ld", Nothing),
    ("MSFT_audio_emitter", Nothing),
    ("MSFT_collision_primitives", Nothing),
    ("MSFT_physics", Nothing),
    ("OMI_audio_emitter", Nothing),
    ("OMI_collider", Nothing),
    ("OMI_physics_body", Nothing),
    ("OMI_physics_shape", Nothing),
    ("VRMC_node_constraint", Nothing),
    ("VRMC_springBone", Nothing),
    // What luxel lacks.
    ("EXT_lights_ies", Lacks("its lights shine evenly", PLAIN)),
    (
        "EXT_lights_image_based",
        Lacks("its environment is not there", PLAIN),
    ),
    (
        "EXT_mesh_gpu_instancing",
        Lacks("its instances are not there", EXPANDED),
    ),
    (
        "EXT_meshopt_compression",
        Lacks("its uncompressed copy is read", COMPRESSED),
    ),
    (
        "EXT_texture_avif",
        Lacks("its PNG or JPEG copy is read", AS_PNG),
    ),
    (
        "EXT_texture_webp",
        Lacks("its PNG or JPEG copy is read", AS_PNG),
    ),
    (
        "KHR_draco_mesh_compression",
        Lacks("its uncompressed copy is read", COMPRESSED),
    ),
    ("KHR_materials_anisotropy", Lacks(SHINE, PLAIN)),
    ("KHR_materials_clearcoat", Lacks(SHINE, PLAIN)),
    ("KHR_materials_diffuse_transmission", Lacks(SHINE, PLAIN)),
    ("KHR_materials_dispersion", Lacks(SHINE, PLAIN)),
    ("KHR_materials_iridescence", Lacks(SHINE, PLAIN)),
    ("KHR_materials_sheen", Lacks(SHINE, PLAIN)),
    ("KHR_materials_specular", Lacks(SHINE, PLAIN)),
    ("KHR_materials_volume", Lacks(SHINE, PLAIN)),
    (
        "KHR_meshopt_compression",
        Lacks("its uncompressed copy is read", COMPRESSED),
    ),
    (
        "KHR_node_visibility",
        Lacks(
            "hidden nodes are shown",
            "delete what is hidden before exporting",
        ),
    ),
    (
        "KHR_texture_basisu",
        Lacks("its PNG or JPEG copy is read", AS_PNG),
    ),
    ("MSFT_lod", Lacks("the finest level is shown", PLAIN)),
    (
        "MSFT_texture_dds",
        Lacks("its PNG or JPEG copy is read", AS_PNG),
    ),
    ("VRMC_materials_mtoon", Lacks(SHINE, PLAIN)),
];

fn verdict(name: &str) -> Verdict {
    let known = KNOWN.iter().find(|(known, _)| *known == name);
    known.map_or(Lacks("it is ignored", PLAIN), |(_, verdict)| *verdict)
}

/// Whether luxel reads an extension.
pub(super) fn is_read(name: &str) -> bool {
    matches!(verdict(name), Read)
}

/// Whether the tables know all places where an extension may stand.
pub(super) fn has_places(name: &str) -> bool {
    is_read(name) || name == VARIANTS
}

/// Sets of materials to choose from: checked, and not read, since the material of a primitive is the default.
pub(super) const VARIANTS: &str = "KHR_materials_variants";

/// An array of an extension at the top level.
pub(super) fn listed<'a>(json: &'a Value, extension: &str, array: &str) -> &'a [Value] {
    let extensions = json.get("extensions").and_then(|all| all.get(extension));
    extensions.map_or(&[], |all| items(all, array))
}

/// The lights of `KHR_lights_punctual`.
pub(super) fn lights(json: &Value) -> &[Value] {
    listed(json, "KHR_lights_punctual", "lights")
}

/// The extensions that a file says it uses.
pub(super) fn declared(json: &Value) -> BTreeSet<&str> {
    let used = items(json, "extensionsUsed").iter();
    used.filter_map(Value::as_str).collect()
}

/// Checks what a file declares: refuses what it requires and luxel lacks, and names once what it uses and luxel lacks.
pub(super) fn check(json: &Value, report: &mut Report) {
    let used = declared(json);
    let required = items(json, "extensionsRequired");
    let required: Vec<&str> = required.iter().filter_map(Value::as_str).collect();
    let is_required: BTreeSet<&str> = required.iter().copied().collect();
    if json.get("extensionsRequired").is_some() && json.get("extensionsUsed").is_none() {
        let says = "\"extensionsRequired\" without \"extensionsUsed\"";
        report.warning(codes::GLTF_DECLARATION, "/extensionsRequired", says);
    }
    for (i, name) in required.iter().enumerate() {
        let pointer = format!("/extensionsRequired/{i}");
        if let Lacks(_, remedy) = verdict(name) {
            let says = format!("the file requires the extension {name}, which luxel lacks");
            report.add(
                Diagnostic::error(codes::GLTF_REQUIRES, says)
                    .pointer(&pointer)
                    .hint(remedy),
            );
        }
        if !used.contains(name) {
            let says = format!("{name:?} is required, but not in \"extensionsUsed\"");
            report.warning(codes::GLTF_DECLARATION, pointer, says);
        }
    }
    for (i, value) in items(json, "extensionsUsed").iter().enumerate() {
        let Some(name) = value.as_str() else { continue };
        let pointer = format!("/extensionsUsed/{i}");
        match verdict(name) {
            Lacks(instead, _) if !is_required.contains(name) => {
                let says = format!("luxel lacks the extension {name}: {instead}");
                report.warning(codes::GLTF_EXTENSION, pointer, says);
            }
            Read if name == "KHR_mesh_quantization" && !is_required.contains(name) => {
                let says = format!("{name:?} is used, and must be in \"extensionsRequired\" too");
                report.warning(codes::GLTF_DECLARATION, pointer, says);
            }
            _ => {}
        }
    }
}
