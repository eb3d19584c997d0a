//! Components that move an entity along keys: `keys`, and with them `ease`.

use super::entity;
use super::layer::Node;
use super::reader::{Fields, Reader};
use super::schema::{EaseDesc, KeyDesc, KeysDesc};
use super::values::Domain;
use crate::diag::codes;

/// `keys: [..]` with `ease: ..`.
pub(super) fn keys<'a>(fields: &Fields<'a, '_>) -> Option<KeysDesc> {
    let eased = fields.read_if("ease", ease);
    if let (Some(key), None) = (fields.key("ease"), fields.get("keys")) {
        fields
            .reader
            .error(codes::MISPLACED, key, "`ease` needs `keys`");
    }
    let ease = eased.unwrap_or_default();
    let keys = fields.read_if("keys", |r, n| list(r, n, ease))?;
    Some(KeysDesc { keys, ease })
}

/// `[(t: 0, translate: .., rotate: .., scale: ..), ..]` with rising t.
fn list<'a>(reader: &Reader<'a>, node: Node<'a>, ease: EaseDesc) -> Option<Vec<KeyDesc>> {
    let nodes = reader.layer(node, node.list(), "`keys`", "a list [(t: 0, ..), ..]")?;
    if nodes.is_empty() {
        reader.error(codes::OUT_OF_RANGE, node, "`keys` holds no key");
    }
    let mut keys: Vec<KeyDesc> = Vec::with_capacity(nodes.len());
    let mut scaled: Option<[f64; 3]> = None;
    for node in nodes {
        let names = ["t", "translate", "rotate", "scale"];
        let Some(fields) = Fields::read(reader, node, "a key", &names) else {
            continue;
        };
        let translate = fields.read_if("translate", entity::translate);
        let rotate = fields.read_if("rotate", entity::rotate);
        let scale = fields.read_if("scale", entity::scale);
        if let (Some(scale), Some(place)) = (scale, fields.get("scale")) {
            if let Some(before) = scaled.filter(|_| ease != EaseDesc::Step) {
                check_sign(reader, place, before, scale);
            }
            scaled = Some(scale);
        }
        let Some(t) = fields.require("t", |r, n| r.number(n, "`t`", Domain::Any)) else {
            continue;
        };
        let last = keys.last().map(|key| key.t);
        if let (Some(before), Some(place)) = (last.filter(|&before| before >= t), fields.get("t")) {
            let message = format!("the key at t = {t} comes after the one at t = {before}");
            reader.error_hint(codes::KEY_ORDER, place, message, "key times must rise");
        }
        keys.push(KeyDesc {
            t,
            translate,
            rotate,
            scale,
        });
    }
    Some(keys)
}

/// On its way from one sign to the other a scale is 0 for a moment.
fn check_sign(reader: &Reader<'_>, place: Node<'_>, before: [f64; 3], scale: [f64; 3]) {
    if before
        .iter()
        .zip(scale)
        .any(|(a, b)| (*a < 0.0) != (b < 0.0))
    {
        reader.error_hint(
            codes::ZERO_SCALE,
            place,
            "on the way from the key before, this `scale` passes 0, which flattens the entity",
            "keep its sign, or jump: ease: Step",
        );
    }
}

fn ease<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<EaseDesc> {
    let (variant, body) = reader.variant(node, "`ease`", &["Linear", "Smooth", "Step"])?;
    reader.no_fields(body, variant)?;
    Some(match variant {
        "Linear" => EaseDesc::Linear,
        "Smooth" => EaseDesc::Smooth,
        _ => EaseDesc::Step,
    })
}
