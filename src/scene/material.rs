//! `materials: {"name": Variant(..)}`.

use super::layer::Node;
use super::reader::{Fields, Reader};
use super::schema::{ColorDesc, MaterialDesc, NamedMaterial};
use super::values::Domain;
use crate::diag::codes;
use std::collections::HashMap;

/// Indices of refraction are above this and below the next, far beyond any matter: glass multiplies radiance by the
/// squared index, and a plastic divides by what its coat lets out, about 1 / n³, in single precision.
const MIN_IOR: f64 = 0.01;
const MAX_IOR: f64 = 100.0;

/// The materials of the map, each read by itself; an unreadable one keeps its name with the default material, so
/// that what refers to it is not reported too.
pub(super) fn materials<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<Vec<NamedMaterial>> {
    let entries = reader.layer(
        node,
        node.entries(),
        "`materials`",
        "a map {\"name\": material, ..}",
    )?;
    let mut materials: Vec<NamedMaterial> = Vec::with_capacity(entries.len());
    let mut first_of: HashMap<String, usize> = HashMap::with_capacity(entries.len());
    for entry in entries {
        let Some(name) = reader.string(entry.key, "the name of a material") else {
            continue;
        };
        if let Some(&at) = first_of.get(&name) {
            let line = reader.line(Node { at, ..entry.value });
            let hint = format!("the first one is in line {line}");
            reader.error_hint(
                codes::DUPLICATE_NAME,
                entry.key,
                format!("the material {name:?} is given twice"),
                hint,
            );
        } else {
            first_of.insert(name.clone(), entry.value.at);
        }
        let material = material(reader, entry.value).unwrap_or_default();
        let (at, len) = (entry.value.at, entry.value.text.len());
        materials.push(NamedMaterial {
            name,
            material,
            at,
            len,
        });
    }
    Some(materials)
}

fn material<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<MaterialDesc> {
    let known = ["Diffuse", "Mirror", "Glass", "Plastic", "Metal"];
    let (variant, body) = reader.variant(node, "a material", &known)?;
    let read = |what, known| Fields::read(reader, body, what, known);
    match variant {
        "Diffuse" => read("`Diffuse`", &["color"]).map(|f| MaterialDesc::Diffuse {
            color: color(&f, MaterialDesc::DIFFUSE_COLOR),
        }),
        "Mirror" => read("`Mirror`", &["color"]).map(|f| MaterialDesc::Mirror {
            color: color(&f, MaterialDesc::CLEAR_COLOR),
        }),
        "Glass" => read("`Glass`", &["ior", "color"]).map(|f| MaterialDesc::Glass {
            ior: ior(&f),
            color: color(&f, MaterialDesc::CLEAR_COLOR),
        }),
        "Plastic" => read("`Plastic`", &["color", "ior"]).map(|f| MaterialDesc::Plastic {
            color: color(&f, MaterialDesc::DIFFUSE_COLOR),
            ior: ior(&f),
        }),
        _ => read("`Metal`", &["color", "roughness"]).map(|f| MaterialDesc::Metal {
            color: color(&f, MaterialDesc::DIFFUSE_COLOR),
            roughness: roughness(&f),
        }),
    }
}

fn color(fields: &Fields<'_, '_>, default: [f64; 3]) -> ColorDesc {
    fields.read_or("color", ColorDesc::Linear(default), |r, n| {
        r.color(n, "`color`")
    })
}

fn ior(fields: &Fields<'_, '_>) -> f64 {
    fields.read_or("ior", MaterialDesc::IOR, |r, n| {
        r.number(n, "`ior`", Domain::Between(MIN_IOR, MAX_IOR))
    })
}

fn roughness(fields: &Fields<'_, '_>) -> f64 {
    fields.read_or("roughness", MaterialDesc::ROUGHNESS, |r, n| {
        let roughness = r.number(n, "`roughness`", Domain::Unit)?;
        if roughness > 0.0 {
            r.not_yet(n, "a `roughness` above 0");
        }
        Some(roughness)
    })
}
