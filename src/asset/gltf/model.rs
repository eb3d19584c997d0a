//! A glTF file to a [`Model`]: nodes, then the meshes that they use, then the materials of these, then their images.
//!
//! Nothing is read that the default scene does not need.

use super::gloss::Approximated;
use super::images::{self, Wanted};
use super::materials::{self, Look, Maker};
use super::meshes::{self, Shaped};
use super::nodes;
use super::notes::Notes;
use super::source::Source;
use crate::asset::{Loader, MeshMaterial, Model, codes};
use crate::diag::Diagnostic;
use rayon::prelude::*;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Reads a glTF file. Warnings go to the loader.
///
/// # Errors
/// Everything that keeps the file from being used, each with its JSON pointer.
pub(in crate::asset) fn read(loader: &mut Loader, path: &Path) -> Result<Model, Vec<Diagnostic>> {
    let mut source = Source::open(loader, path)?;
    let mut notes = Notes::default();
    let model = model(loader, &mut source, &mut notes);
    loader.warnings.extend(notes.warnings(path));
    let here = |error: Diagnostic| match error.file {
        Some(_) => error,
        None => error.in_file(path),
    };
    model.map_err(|errors| errors.into_iter().map(here).collect())
}

fn model(
    loader: &mut Loader,
    source: &mut Source,
    notes: &mut Notes,
) -> Result<Model, Vec<Diagnostic>> {
    let nodes = nodes::walk(source, notes);
    let used: BTreeSet<usize> = nodes.iter().filter_map(|node| node.mesh).collect();
    let bytes = used.iter().map(|&index| meshes::bytes(source, index));
    let bytes = bytes.fold(0, u64::saturating_add);
    // Many primitives may share one accessor: a small file may ask for any number of triangles.
    let room = loader.charge(bytes, "what the triangles decode to", &source.path);
    room.map_err(|error| vec![error.pointer("/meshes")])?;
    let mut shaped = shape(source, &used, notes)?;
    let looks = shaped.values().flat_map(|shaped| &shaped.looks);
    let looks: BTreeSet<Look> = looks.copied().collect();
    let materials = look(loader, source, &looks, notes)?;
    say_at_rest(source, notes);
    let mut meshes = vec![None; source.document.meshes().len()];
    for (&index, shaped) in &mut shaped {
        if shaped.mesh.corners.is_empty() {
            continue;
        }
        let mut mesh = std::mem::take(&mut shaped.mesh);
        let known = |look: &Look| materials.get(look).cloned();
        mesh.materials = shaped.looks.iter().filter_map(known).collect();
        meshes[index] = Some(loader.keep_mesh(mesh));
    }
    let model = Model {
        path: source.path.clone(),
        nodes,
        meshes,
    };
    if model.is_empty() {
        notes.tell(nothing());
    }
    Ok(model)
}

/// The triangles of the meshes in use, several meshes at a time.
fn shape(
    source: &Source,
    used: &BTreeSet<usize>,
    notes: &mut Notes,
) -> Result<BTreeMap<usize, Shaped>, Vec<Diagnostic>> {
    let used: Vec<usize> = used.iter().copied().collect();
    let read = |&index: &usize| (index, meshes::mesh(source, index));
    let read: Vec<_> = used.par_iter().map(read).collect();
    let mut shaped = BTreeMap::new();
    let mut errors = Vec::new();
    for (index, read) in read {
        match read {
            Ok(mut mesh) => {
                notes.absorb(std::mem::take(&mut mesh.notes));
                shaped.insert(index, mesh);
            }
            Err(found) => errors.extend(found),
        }
    }
    if errors.is_empty() {
        Ok(shaped)
    } else {
        Err(errors)
    }
}

/// The materials of every look.
fn look(
    loader: &mut Loader,
    source: &mut Source,
    looks: &BTreeSet<Look>,
    notes: &mut Notes,
) -> Result<BTreeMap<Look, MeshMaterial>, Vec<Diagnostic>> {
    let mut wanted = Wanted::default();
    let indices: BTreeSet<usize> = looks.iter().filter_map(|look| look.material).collect();
    for index in indices {
        if let Some(material) = source.document.materials().nth(index) {
            materials::want(&material, &mut wanted);
        }
    }
    let images = images::read(loader, source, &wanted, notes)?;
    let mut maker = Maker {
        loader,
        source,
        images: &images,
        notes,
        approximated: Approximated::default(),
    };
    let made = looks.iter().map(|look| (*look, maker.material(look)));
    let made = made.collect();
    let Maker { approximated, .. } = maker;
    approximated.say(notes);
    Ok(made)
}

/// One warning for all that would bend.
fn say_at_rest(source: &Source, notes: &mut Notes) {
    let count = |name: &str| {
        let items = source.json.get(name).and_then(Value::as_array);
        items.map_or(0, Vec::len)
    };
    let skins = count("skins");
    let meshes = source.json.get("meshes").and_then(Value::as_array);
    let morphs = |mesh: &&Value| {
        let primitives = mesh.get("primitives").and_then(Value::as_array);
        let mut primitives = primitives.into_iter().flatten();
        primitives.any(|primitive| primitive.get("targets").is_some())
    };
    let morphs = meshes.into_iter().flatten().filter(morphs).count();
    let moving = [
        (skins, "skins", "/skins"),
        (morphs, "morph targets", "/meshes"),
    ];
    let moving: Vec<_> = moving.into_iter().filter(|(n, ..)| *n > 0).collect();
    let Some((_, _, first)) = moving.first() else {
        return;
    };
    let list: Vec<String> = moving
        .iter()
        .map(|(n, of, _)| format!("{of} ({n})"))
        .collect();
    let says = format!(
        "not modelled, and what they would bend is as it was made: {}",
        list.join(", ")
    );
    let warning = Diagnostic::warning(codes::GLTF_AT_REST, says).pointer(*first);
    notes.tell(warning.hint("bake the pose that you want"));
}

fn nothing() -> Diagnostic {
    let says = "nothing to render: the file's default scene has no triangles, lights or cameras";
    Diagnostic::warning(codes::GLTF_NOTHING, says)
        .pointer("")
        .hint("export the objects themselves with the file")
}

#[cfg(test)]
mod tests;
