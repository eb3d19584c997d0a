//! Warnings about a scene that reads well but is probably not what was meant.
//!
//! Enters: a [`SceneDesc`]; then the world and the store that came of it. Leaves: diagnostics, all at once, each at the
//! entity or the camera that causes it, each with a remedy. Errors of a file are found where it is read.
//! What may be meant is not warned of: better silent than wrong. Deliberately absent: reading files, pixels.

mod angles;
mod bounds;
pub mod codes;
mod inside;
mod light;
mod posed;
mod scale;
#[cfg(test)]
mod tests;
mod uvs;
mod view;
mod words;

use crate::asset::AssetStore;
use crate::diag::codes as scene_codes;
use crate::diag::{Diagnostic, Lines};
use crate::scene::{BackgroundDesc, EntityDesc, SceneDesc, ShapeDesc};
use hecs::World;
use posed::Posed;
use std::collections::BTreeSet;
pub use uvs::check_mesh;
pub(crate) use words::short;

/// Samples per pixel above which a warning is due: at 512 × 512 pixels some hundred billion paths, a day or more.
const MANY_SAMPLES: u32 = 1 << 18;

/// Code and meaning of every diagnostic of every module, in order.
pub fn all_codes() -> impl Iterator<Item = (&'static str, &'static str)> {
    let tables = [
        scene_codes::CODES,
        crate::asset::codes::CODES,
        crate::world::codes::CODES,
        codes::CODES,
    ];
    tables.into_iter().flatten().copied()
}

/// What can be said about a scene without opening the files that it names, in the order of the text.
#[must_use]
pub fn check(desc: &SceneDesc) -> Vec<Diagnostic> {
    let lines = Lines::of(&desc.source);
    let mut found = settings(desc, &lines);
    found.extend(unused_materials(desc, &lines));
    found.extend(angles::radians(desc, &lines));
    in_order(&mut found);
    found
}

/// What can be said about a scene whose files are loaded: `world` and `store` are those that
/// [`crate::world::spawn`] made of `desc`. In the order of the text; what has no place comes last.
#[must_use]
pub fn check_world(desc: &SceneDesc, world: &World, store: &AssetStore) -> Vec<Diagnostic> {
    let mut rows = world.query();
    let Some(posed) = Posed::of(desc, world, store, &mut rows) else {
        return Vec::new();
    };
    let mut found = inside::camera_inside(&posed);
    found.extend(view::view(&posed));
    found.extend(scale::blurred_place(&posed));
    found.extend(scale::out_of_range(&posed));
    found.extend(scale::collapsed(&posed));
    found.extend(scale::other_units(&posed));
    found.extend(light::units(&posed));
    found.extend(uvs::partly_textured(&posed));
    found.extend(light::dark(&posed));
    in_order(&mut found);
    found
}

/// What can be said about light where the files could not be loaded: nothing shines unless a file does.
#[must_use]
pub fn check_light(desc: &SceneDesc) -> Option<Diagnostic> {
    let may_shine = |e: &EntityDesc| {
        let by_file = matches!(e.shape, Some(ShapeDesc::Mesh { .. }))
            && e.material.is_none()
            && e.emissive.is_none();
        let by_light = e.light.is_some() || e.gltf.is_some();
        by_file || by_light || e.emissive.is_some_and(|radiance| radiance != [0.0; 3])
    };
    let dark = desc.background == BackgroundDesc::Linear([0.0; 3])
        && !desc.entities.iter().any(|e| may_shine(&e.value));
    dark.then(|| darkness(desc, "nothing shines and the background is black"))
}

fn darkness(desc: &SceneDesc, why: &str) -> Diagnostic {
    Diagnostic::warning(
        scene_codes::NO_LIGHT,
        format!("{why}: the image will be black"),
    )
    .in_file(&desc.file)
    .hint("give an entity `emissive: (radiance: (10, 10, 10))`, or the scene a `background`")
}

fn in_order(found: &mut [Diagnostic]) {
    found.sort_by_key(|d| {
        let place = d.span.as_ref().map(|s| (s.line, s.column));
        (place.is_none(), place)
    });
}

fn warning(
    desc: &SceneDesc,
    lines: &Lines<'_>,
    code: &'static str,
    place: Option<(usize, usize)>,
    message: String,
) -> Diagnostic {
    let warning = Diagnostic::warning(code, message).in_file(&desc.file);
    match place {
        Some((at, len)) => warning.on(lines, at, len),
        None => warning,
    }
}

fn settings(desc: &SceneDesc, lines: &Lines<'_>) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let spp = desc.render.spp;
    if spp > MANY_SAMPLES {
        let place = desc.setting_place(&["render", "spp"]);
        let message = format!("{spp} samples for each pixel may never end");
        found.push(
            warning(desc, lines, scene_codes::MANY_SAMPLES, place, message)
                .hint("halving the noise takes four times the samples"),
        );
    }
    if desc.render.max_bounces == 0 {
        let place = desc.setting_place(&["render", "max_bounces"]);
        let message = "with `max_bounces: 0` only emitters and the background are seen".to_owned();
        let warning = warning(desc, lines, scene_codes::NO_BOUNCES, place, message);
        found.push(warning.hint("1 is direct light"));
    }
    found
}

fn unused_materials(desc: &SceneDesc, lines: &Lines<'_>) -> impl Iterator<Item = Diagnostic> {
    let used: BTreeSet<usize> = desc
        .entities
        .iter()
        .filter_map(|e| e.value.material)
        .collect();
    let unused = desc.materials.iter().enumerate();
    unused
        .filter(move |(i, _)| !used.contains(i))
        .map(|(_, m)| {
            let message = format!("no entity uses the material {:?}", m.name);
            let place = Some((m.at, m.len));
            warning(desc, lines, scene_codes::UNUSED_MATERIAL, place, message)
                .hint("give it to an entity, `material: ..`, or take it out")
        })
}
