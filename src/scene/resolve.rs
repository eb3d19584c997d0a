//! What concerns several parts of a scene: names and who they mean, parents, the one camera, spheres under scales.

use super::entity::RawEntity;
use super::layer::Node;
use super::reader::Reader;
use super::schema::{EntityDesc, NamedMaterial, ShapeDesc};
use crate::diag::{Diagnostic, codes};
use std::collections::BTreeMap;

/// Reports duplicate names; fills the parents and materials; then checks what depends on them.
pub(super) fn resolve(
    reader: &Reader<'_>,
    entities: &mut [RawEntity<'_>],
    materials: &[NamedMaterial],
) {
    let names = entity_names(reader, entities);
    let mut material_names = BTreeMap::new();
    for (i, material) in materials.iter().enumerate() {
        material_names.entry(material.name.as_str()).or_insert(i);
    }
    for entity in &mut *entities {
        if let Some((name, place)) = &entity.parent {
            entity.desc.parent = names.get(name).copied();
            if entity.desc.parent.is_none() {
                unknown(
                    reader,
                    *place,
                    &format!("entity named {name:?}"),
                    reader.meant(name, names.keys().map(String::as_str)),
                );
            }
        }
        if let Some((name, place)) = &entity.material {
            entity.desc.material = material_names.get(name.as_str()).copied();
            if entity.desc.material.is_none() {
                let best = reader.meant(name, materials.iter().map(|m| m.name.as_str()));
                unknown(reader, *place, &format!("material {name:?}"), best);
            }
        }
    }
    break_cycles(reader, entities);
    for (i, stretcher) in stretchers(entities).into_iter().enumerate() {
        check_sphere(reader, entities, i, stretcher);
    }
}

/// Index of each name; the first entity of a name has it.
fn entity_names(reader: &Reader<'_>, entities: &[RawEntity<'_>]) -> BTreeMap<String, usize> {
    let mut names = BTreeMap::new();
    for (i, entity) in entities.iter().enumerate() {
        let (Some(name), Some(place)) = (&entity.desc.name, entity.component("name")) else {
            continue;
        };
        if let Some(&first) = names.get(name) {
            let first: &RawEntity<'_> = &entities[first];
            let line = reader.line(first.component("name").unwrap_or(first.node));
            let message = format!("the entity {name:?} is given twice");
            reader.error_hint(
                codes::DUPLICATE_NAME,
                place,
                message,
                format!("the first one is in line {line}"),
            );
        } else {
            names.insert(name.clone(), i);
        }
    }
    names
}

fn unknown(reader: &Reader<'_>, place: Node<'_>, what: &str, best: Option<&str>) {
    let message = format!("there is no {what}");
    match best {
        Some(best) => reader.error_hint(
            codes::UNKNOWN_NAME,
            place,
            message,
            format!("did you mean {best:?}?"),
        ),
        None => reader.error(codes::UNKNOWN_NAME, place, message),
    }
}

/// Reports each cycle of parents once, naming its members, and cuts it.
fn break_cycles(reader: &Reader<'_>, entities: &mut [RawEntity<'_>]) {
    // The entity whose walk upwards came by; `None` where none did yet.
    let mut seen: Vec<Option<usize>> = vec![None; entities.len()];
    for start in 0..entities.len() {
        let mut chain = Vec::new();
        let mut next = Some(start);
        while let Some(i) = next {
            match seen[i] {
                None => seen[i] = Some(start),
                Some(walk) if walk == start => {
                    let first = chain.iter().position(|&c| c == i).unwrap_or_default();
                    report_cycle(reader, entities, &chain[first..]);
                    entities[i].desc.parent = None;
                    break;
                }
                Some(_) => break,
            }
            chain.push(i);
            next = entities[i].desc.parent;
        }
    }
}

fn report_cycle(reader: &Reader<'_>, entities: &[RawEntity<'_>], cycle: &[usize]) {
    /// A longer circle is told by its first members and their number.
    const MAX_TOLD: usize = 10;
    let first = &entities[cycle[0]];
    let name = |i: &usize| {
        format!(
            "{:?}",
            entities[*i].desc.name.as_deref().unwrap_or_default()
        )
    };
    let mut chain: Vec<String> = cycle.iter().take(MAX_TOLD).map(name).collect();
    if cycle.len() > MAX_TOLD {
        chain.push(format!("{} more", cycle.len() - MAX_TOLD));
    }
    chain.push(name(&cycle[0]));
    let place = first
        .parent
        .as_ref()
        .map_or(first.node, |(_, place)| *place);
    reader.error(
        codes::PARENT_CYCLE,
        place,
        format!("parents in a circle: {}", chain.join(" -> ")),
    );
}

/// For each entity, the nearest of itself and its ancestors that has a non-uniform scale.
fn stretchers(entities: &[RawEntity<'_>]) -> Vec<Option<usize>> {
    let stretches = |i: usize| stretch(&entities[i].desc).is_some();
    let mut known: Vec<Option<Option<usize>>> = vec![None; entities.len()];
    let mut chain = Vec::new();
    for start in 0..entities.len() {
        let mut next = Some(start);
        while let Some(i) = next.filter(|i| known[*i].is_none()) {
            chain.push(i);
            next = entities[i].desc.parent;
        }
        let mut above = next.and_then(|i| known[i]).flatten();
        while let Some(i) = chain.pop() {
            above = if stretches(i) { Some(i) } else { above };
            known[i] = Some(above);
        }
    }
    known.into_iter().map(Option::flatten).collect()
}

/// The first of an entity's scales, of its transform and of its keys, that is not uniform.
fn stretch(desc: &EntityDesc) -> Option<[f64; 3]> {
    let keys = desc.keys.iter().flat_map(|keys| &keys.keys);
    let mut scales = std::iter::once(desc.transform.scale).chain(keys.filter_map(|key| key.scale));
    scales.find(|[x, y, z]| x.abs() != y.abs() || y.abs() != z.abs())
}

/// A sphere must stay a sphere.
fn check_sphere(
    reader: &Reader<'_>,
    entities: &[RawEntity<'_>],
    index: usize,
    stretcher: Option<usize>,
) {
    let sphere = &entities[index];
    let (Some(ShapeDesc::Sphere { .. }), Some(place), Some(by)) =
        (&sphere.desc.shape, sphere.component("shape"), stretcher)
    else {
        return;
    };
    let Some([x, y, z]) = stretch(&entities[by].desc) else {
        return;
    };
    let whose = if by == index {
        "its own".to_owned()
    } else {
        format!("the ancestor {:?}'s", label(&entities[by]))
    };
    let message = format!(
        "the sphere {:?} is stretched by {whose} non-uniform scale ({x}, {y}, {z})",
        label(sphere)
    );
    let hint = "scale it by one number, or use a mesh";
    reader.error_hint(codes::STRETCHED_SPHERE, place, message, hint);
}

fn label<'e>(entity: &'e RawEntity<'_>) -> &'e str {
    entity.desc.name.as_deref().unwrap_or("without a name")
}

/// One camera, at top level or on one entity.
pub(super) fn check_cameras(
    reader: &Reader<'_>,
    top: Option<Node<'_>>,
    entities: &[RawEntity<'_>],
) {
    let mut cameras = top
        .into_iter()
        .chain(entities.iter().filter_map(|e| e.camera));
    let Some(first) = cameras.next() else {
        // A glTF file may bring one, which is known when it is read.
        if entities.iter().any(|e| e.component("gltf").is_some()) {
            return;
        }
        let hint = "add `camera: (at: (0, 0, 5), look_at: (0, 0, 0))` at top level";
        let missing = Diagnostic::error(codes::NO_CAMERA, "the scene has no camera");
        reader.report(missing.in_file(reader.file).hint(hint));
        return;
    };
    let line = reader.line(first);
    for other in cameras {
        let message = format!("a second camera; the first is in line {line}");
        reader.error_hint(codes::TWO_CAMERAS, other, message, "keep one of them");
    }
}
