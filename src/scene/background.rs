//! `background`: one radiance, or a picture of all directions.

use super::layer::Node;
use super::reader::{Fields, Reader};
use super::schema::{BackgroundDesc, HdrDesc, TextureFilterDesc};
use super::values::{Domain, MAX_RADIANCE, texture_filter};

const NAME: &str = "`background`";

pub(super) fn background<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<BackgroundDesc> {
    let (variant, body) = reader.color_variant(node, NAME, &["Linear", "Srgb", "Hdr"])?;
    match variant {
        "Linear" => reader
            .vector(body, NAME, Domain::UpTo(MAX_RADIANCE))
            .map(BackgroundDesc::Linear),
        "Srgb" => reader.srgb(body).map(BackgroundDesc::Linear),
        _ => hdr(reader, body).map(BackgroundDesc::Hdr),
    }
}

/// `("sky.hdr")` or `(path: "sky.hdr", rotate_deg: 90)`.
fn hdr<'a>(reader: &Reader<'a>, body: Node<'a>) -> Option<HdrDesc> {
    const WHAT: &str = "the sky";
    if body.fields().is_ok_and(|fields| !fields.is_empty()) {
        let known = ["path", "rotate_deg", "strength", "filter"];
        let fields = Fields::read(reader, body, "`Hdr`", &known)?;
        let path = fields.require("path", |r, n| r.path(n, WHAT));
        let rotate_deg = fields.read_or("rotate_deg", HdrDesc::ROTATE_DEG, |r, n| {
            r.number(n, "`rotate_deg`", Domain::Any)
        });
        let strength = fields.read_or("strength", HdrDesc::STRENGTH, |r, n| {
            r.number(n, "`strength`", Domain::UpTo(MAX_RADIANCE))
        });
        let filter = fields.read_or("filter", TextureFilterDesc::default(), texture_filter);
        return Some(HdrDesc {
            path: path?,
            rotate_deg,
            strength,
            filter,
        });
    }
    let path = reader.single(body, "Hdr", "Hdr(\"file\")")?;
    Some(HdrDesc {
        path: reader.path(path, WHAT)?,
        rotate_deg: HdrDesc::ROTATE_DEG,
        strength: HdrDesc::STRENGTH,
        filter: TextureFilterDesc::default(),
    })
}
