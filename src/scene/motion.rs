//! Components that the format knows and the renderer does not: `keys`, `light` and `gltf`.
//!
//! They are read and checked like the others, so that a scene is told everything at once, and then refused.

use super::entity;
use super::layer::Node;
use super::reader::{Fields, Reader};
use super::values::Domain;
use crate::diag::codes;

/// Checks and refuses those of the components that the entity has.
pub(super) fn refuse(fields: &Fields<'_, '_>) {
    fields.read_if("keys", keys);
    fields.read_if("ease", ease);
    fields.read_if("light", light);
    fields.read_if("gltf", |r, n| r.path(n, "`gltf`"));
    if let (Some(key), None) = (fields.key("ease"), fields.get("keys")) {
        fields
            .reader
            .error(codes::MISPLACED, key, "`ease` needs `keys`");
    }
    for name in ["keys", "light", "gltf"] {
        if let Some(key) = fields.key(name) {
            fields.reader.not_yet(key, &format!("`{name}`"));
        }
    }
}

/// `[(t: 0, translate: .., rotate: .., scale: ..), ..]` with rising t.
fn keys<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<()> {
    let keys = reader.layer(node, node.list(), "`keys`", "a list [(t: 0, ..), ..]")?;
    if keys.is_empty() {
        reader.error(codes::OUT_OF_RANGE, node, "`keys` holds no key");
    }
    let mut last: Option<f64> = None;
    for key in keys {
        let Some(fields) =
            Fields::read(reader, key, "a key", &["t", "translate", "rotate", "scale"])
        else {
            continue;
        };
        fields.read_if("translate", entity::translate);
        fields.read_if("rotate", entity::rotate);
        fields.read_if("scale", entity::scale);
        let Some(t) = fields.require("t", |r, n| r.number(n, "`t`", Domain::Any)) else {
            continue;
        };
        if let (Some(before), Some(place)) = (last.filter(|&before| before >= t), fields.get("t")) {
            let message = format!("the key at t = {t} comes after the one at t = {before}");
            reader.error_hint(codes::KEY_ORDER, place, message, "key times must rise");
        }
        last = Some(t);
    }
    Some(())
}

fn ease<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<()> {
    let (variant, body) = reader.variant(node, "`ease`", &["Linear", "Smooth", "Step"])?;
    reader.no_fields(body, variant)
}

fn light<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<()> {
    let (variant, body) = reader.variant(node, "`light`", &["Point", "Spot", "Sun"])?;
    match variant {
        "Point" => {
            let fields = Fields::read(reader, body, "`Point`", &["intensity"])?;
            power(&fields, "intensity")
        }
        "Sun" => {
            let fields = Fields::read(reader, body, "`Sun`", &["irradiance"])?;
            power(&fields, "irradiance")
        }
        _ => {
            let fields = Fields::read(
                reader,
                body,
                "`Spot`",
                &["intensity", "inner_deg", "outer_deg"],
            )?;
            let intensity = power(&fields, "intensity");
            let angle = |name: &str| {
                fields.require(name, |r, n| {
                    r.number(n, &format!("`{name}`"), Domain::Between(0.0, 90.0))
                })
            };
            let (inner, outer) = (angle("inner_deg"), angle("outer_deg"));
            if let (Some(inner), Some(outer), Some(place)) = (inner, outer, fields.get("inner_deg"))
                && inner > outer
            {
                let message = format!("`inner_deg` must not be above `outer_deg`, {outer}");
                reader.error(codes::OUT_OF_RANGE, place, message);
            }
            intensity
        }
    }
}

fn power(fields: &Fields<'_, '_>, name: &str) -> Option<()> {
    fields
        .require(name, |r, n| {
            r.vector::<3>(n, &format!("`{name}`"), Domain::NonNegative)
        })
        .map(|_| ())
}
