//! Warnings about a scene that reads well but is probably not what was meant.
//!
//! Enters: a [`SceneDesc`]. Leaves: diagnostics, all at once. Errors of a scene file are found where it is read.
//! Deliberately absent: assets, pixels.

use crate::diag::{Diagnostic, codes};
use crate::scene::{ColorDesc, EntityDesc, SceneDesc, ShapeDesc};
use std::collections::BTreeSet;

/// Samples per pixel above which a warning is due: at 512 × 512 pixels some hundred billion paths, a day or more.
const MANY_SAMPLES: u32 = 1 << 18;

/// What can be said about a scene without opening the files that it names, in the order of the text.
#[must_use]
pub fn check(desc: &SceneDesc) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    found.extend(settings(desc));
    found.extend(unused_materials(desc));
    found.sort_by_key(|d: &Diagnostic| d.span.as_ref().map(|s| (s.line, s.column)));
    found.extend(darkness(desc));
    found
}

fn warning(
    desc: &SceneDesc,
    code: &'static str,
    place: Option<(usize, usize)>,
    message: String,
) -> Diagnostic {
    let warning = Diagnostic::warning(code, message).in_file(&desc.file);
    match place {
        Some((at, len)) => warning.at(&desc.source, at, len),
        None => warning,
    }
}

fn settings(desc: &SceneDesc) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let spp = desc.render.spp;
    if spp > MANY_SAMPLES {
        let place = desc.setting_place(&["render", "spp"]);
        let message = format!("{spp} samples for each pixel may never end");
        found.push(
            warning(desc, codes::MANY_SAMPLES, place, message)
                .hint("halving the noise takes four times the samples"),
        );
    }
    if desc.render.max_bounces == 0 {
        let place = desc.setting_place(&["render", "max_bounces"]);
        let message = "with `max_bounces: 0` only emitters and the background are seen".to_owned();
        found.push(warning(desc, codes::NO_BOUNCES, place, message).hint("1 is direct light"));
    }
    found
}

fn unused_materials(desc: &SceneDesc) -> impl Iterator<Item = Diagnostic> {
    let used: BTreeSet<usize> = desc
        .entities
        .iter()
        .filter_map(|e| e.value.material)
        .collect();
    desc.materials
        .iter()
        .enumerate()
        .filter(move |(i, _)| !used.contains(i))
        .map(|(_, material)| {
            let message = format!("no entity uses the material {:?}", material.name);
            warning(
                desc,
                codes::UNUSED_MATERIAL,
                Some((material.at, material.len)),
                message,
            )
        })
}

/// Nothing shines. A mesh without a material may, by its file, and so may a glTF file.
fn darkness(desc: &SceneDesc) -> Option<Diagnostic> {
    let may_shine = |e: &EntityDesc| {
        let by_file = matches!(e.shape, Some(ShapeDesc::Mesh { .. }))
            && e.material.is_none()
            && e.emissive.is_none();
        let by_light = e.light.is_some() || e.gltf.is_some();
        by_file || by_light || e.emissive.is_some_and(|radiance| radiance != [0.0; 3])
    };
    let dark = desc.background == ColorDesc::Linear([0.0; 3])
        && !desc.entities.iter().any(|e| may_shine(&e.value));
    dark.then(|| {
        let message =
            "nothing shines and the background is black: the image will be black".to_owned();
        let hint =
            "give an entity `emissive: (radiance: (10, 10, 10))`, or the scene a `background`";
        warning(desc, codes::NO_LIGHT, None, message).hint(hint)
    })
}
