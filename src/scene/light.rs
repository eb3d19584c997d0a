//! `light: Point(..) | Spot(..) | Sun(..)`.

use super::layer::Node;
use super::reader::{Fields, Reader};
use super::schema::LightDesc;
use super::values::{Domain, MAX_RADIANCE};
use crate::diag::codes;

/// Widest half angle of a spot in degrees: a half space.
const MAX_OUTER_DEG: f64 = 90.0;

/// A light without extent.
pub(super) fn light<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<LightDesc> {
    let (variant, body) = reader.variant(node, "`light`", &["Point", "Spot", "Sun"])?;
    match variant {
        "Point" => {
            let fields = Fields::read(reader, body, "`Point`", &["intensity"])?;
            let intensity = power(&fields, "intensity")?;
            Some(LightDesc::Point { intensity })
        }
        "Sun" => {
            let fields = Fields::read(reader, body, "`Sun`", &["irradiance"])?;
            let irradiance = power(&fields, "irradiance")?;
            Some(LightDesc::Sun { irradiance })
        }
        _ => spot(reader, body),
    }
}

fn spot<'a>(reader: &Reader<'a>, body: Node<'a>) -> Option<LightDesc> {
    let known = ["intensity", "inner_deg", "outer_deg"];
    let fields = Fields::read(reader, body, "`Spot`", &known)?;
    let intensity = power(&fields, "intensity");
    let angle = |name: &str| {
        fields.require(name, |r, n| {
            r.number(n, &format!("`{name}`"), Domain::UpTo(MAX_OUTER_DEG))
        })
    };
    let (inner, outer) = (angle("inner_deg"), angle("outer_deg"));
    if let (Some(inner), Some(outer), Some(place)) = (inner, outer, fields.get("inner_deg"))
        && inner >= outer
    {
        let message = format!("`inner_deg` must be below `outer_deg`, {outer}");
        reader.error(codes::OUT_OF_RANGE, place, message);
        return None;
    }
    Some(LightDesc::Spot {
        intensity: intensity?,
        inner_deg: inner?,
        outer_deg: outer?,
    })
}

fn power(fields: &Fields<'_, '_>, name: &str) -> Option<[f64; 3]> {
    fields.require(name, |r, n| {
        r.vector(n, &format!("`{name}`"), Domain::UpTo(MAX_RADIANCE))
    })
}
