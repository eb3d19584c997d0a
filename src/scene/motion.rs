//! Components that the format knows and the renderer does not: `keys` with `ease`.
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
    if let (Some(key), None) = (fields.key("ease"), fields.get("keys")) {
        fields
            .reader
            .error(codes::MISPLACED, key, "`ease` needs `keys`");
    }
    if let Some(key) = fields.key("keys") {
        fields.reader.not_yet(key, "`keys`");
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
