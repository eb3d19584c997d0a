//! `render`, `camera` and `animation`.

use super::layer::Node;
use super::reader::{Fields, Reader};
use super::schema::{AnimationDesc, CameraDesc, CameraPose, FilterDesc, RenderDesc};
use super::values::Domain;
use crate::diag::codes;
use std::ops::Range;

/// Widest pixel filter: the side of the largest image.
const MAX_FILTER_RADIUS: f64 = RenderDesc::MAX_SIDE as f64;

/// Largest aperture in focus distances: light may come in almost along the lens, but not from every place at once.
const MAX_APERTURE_IN_FOCUS: f64 = 1e6;

pub(super) fn render<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<RenderDesc> {
    let fields = Fields::read(
        reader,
        node,
        "`render`",
        &["size", "spp", "max_bounces", "filter"],
    )?;
    let default = RenderDesc::default();
    Some(RenderDesc {
        size: fields.read_or("size", default.size, size),
        spp: fields.read_or("spp", default.spp, |r, n| {
            r.whole(n, "`spp`", 1, RenderDesc::MAX_SPP)
        }),
        max_bounces: fields.read_or("max_bounces", default.max_bounces, |r, n| {
            r.whole(n, "`max_bounces`", 0, RenderDesc::MAX_BOUNCES)
        }),
        filter: fields.read_or("filter", default.filter, filter),
    })
}

fn size<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<(u32, u32)> {
    const WANTED: &str = "(width, height) in pixels";
    let items = reader.layer(node, node.tuple(), "`size`", WANTED)?;
    let [width, height] = items[..] else {
        return reader.wrong_type(node, "`size`", WANTED);
    };
    let width = reader.whole(width, "the width", 1, RenderDesc::MAX_SIDE);
    let height = reader.whole(height, "the height", 1, RenderDesc::MAX_SIDE);
    let (width, height) = (width?, height?);
    if u64::from(width) * u64::from(height) > RenderDesc::MAX_PIXELS {
        let most = RenderDesc::MAX_PIXELS;
        let message = format!("`size` must be at most {most} pixels, not {width} x {height}");
        reader.error_hint(codes::OUT_OF_RANGE, node, message, "make a side smaller");
        return None;
    }
    Some((width, height))
}

fn filter<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<FilterDesc> {
    let (variant, body) = reader.variant(node, "`filter`", &["Box", "Gaussian"])?;
    if variant == "Box" {
        reader.no_fields(body, variant)?;
        return Some(FilterDesc::Box);
    }
    let fields = Fields::read(reader, body, "`Gaussian`", &["radius_px"])?;
    let radius_px = fields.read_or("radius_px", FilterDesc::GAUSSIAN_RADIUS_PX, |r, n| {
        r.number(n, "`radius_px`", Domain::Between(0.0, MAX_FILTER_RADIUS))
    });
    Some(FilterDesc::Gaussian { radius_px })
}

/// The camera at top level, which says itself where it stands.
pub(super) fn camera<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<CameraDesc> {
    let fields = Fields::read(
        reader,
        node,
        "`camera`",
        &["at", "look_at", "up", "vfov_deg", "lens"],
    )?;
    let at = fields.require("at", |r, n| r.vector(n, "`at`", Domain::Any));
    let look_at = fields.require("look_at", |r, n| r.vector(n, "`look_at`", Domain::Any));
    let up = fields.read_or("up", CameraPose::UP, |r, n| r.direction(n, "`up`"));
    let pose = at
        .zip(look_at)
        .map(|(at, look_at)| CameraPose { at, look_at, up });
    if let Some(pose) = pose {
        check_view(reader, &fields, &pose);
    }
    let focus = pose.map_or(CameraDesc::FOCUS_DISTANCE, |p| {
        CameraDesc::default_focus(&p)
    });
    Some(CameraDesc {
        pose,
        ..optics(&fields, focus)
    })
}

impl CameraDesc {
    /// Focus of a camera that says none: on the point that it looks at.
    #[must_use]
    pub fn default_focus(pose: &CameraPose) -> f64 {
        let distance = length(sub(pose.look_at, pose.at));
        if distance > 0.0 && distance.is_finite() {
            distance
        } else {
            CameraDesc::FOCUS_DISTANCE
        }
    }
}

/// A camera on an entity, which stands where the entity does.
pub(super) fn entity_camera<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<CameraDesc> {
    let known = ["vfov_deg", "lens", "at", "look_at", "up"];
    let fields = Fields::read(reader, node, "`camera`", &known)?;
    for name in ["at", "look_at", "up"] {
        if let Some(key) = fields.key(name) {
            let hint = "it looks along -Z of its entity: use `transform`, or move the camera to the top level";
            reader.error_hint(
                codes::MISPLACED,
                key,
                format!("a camera on an entity has no `{name}`"),
                hint,
            );
        }
    }
    Some(optics(&fields, CameraDesc::FOCUS_DISTANCE))
}

fn optics(fields: &Fields<'_, '_>, default_focus: f64) -> CameraDesc {
    let lens = fields.read_if("lens", |r, n| {
        Fields::read(r, n, "`lens`", &["aperture_radius", "focus_distance"]).map(|f| lens(&f))
    });
    let (aperture, focus) = lens.unwrap_or_default();
    let aperture = aperture.unwrap_or(CameraDesc::APERTURE_RADIUS);
    let focus = focus.unwrap_or(default_focus);
    if let (Some(lens), true) = (fields.get("lens"), aperture / focus > MAX_APERTURE_IN_FOCUS) {
        let message = format!(
            "the aperture must be at most {MAX_APERTURE_IN_FOCUS:e} focus distances wide, not {:.1e}",
            aperture / focus
        );
        fields.reader.error(codes::OUT_OF_RANGE, lens, message);
    }
    CameraDesc {
        pose: None,
        vfov_deg: fields.read_or("vfov_deg", CameraDesc::VFOV_DEG, |r, n| {
            r.number(n, "`vfov_deg`", Domain::Between(0.0, 180.0))
        }),
        aperture_radius: aperture,
        focus_distance: focus,
    }
}

/// Aperture radius and focus distance, as far as they are given.
fn lens(fields: &Fields<'_, '_>) -> (Option<f64>, Option<f64>) {
    (
        fields.read_if("aperture_radius", |r, n| {
            r.number(n, "`aperture_radius`", Domain::NonNegative)
        }),
        fields.read_if("focus_distance", |r, n| {
            r.number(n, "`focus_distance`", Domain::Positive)
        }),
    )
}

/// The view must have a direction, and `up` another one.
fn check_view(reader: &Reader<'_>, fields: &Fields<'_, '_>, pose: &CameraPose) {
    /// Sine below which `up` is the view direction to within rounding.
    const MIN_SINE: f64 = 1e-9;
    if pose.at == pose.look_at {
        if let Some(key) = fields.get("look_at") {
            reader.error(
                codes::DEGENERATE,
                key,
                "`look_at` is where the camera is: it has no direction to look in",
            );
        }
        return;
    }
    let view = unit(sub(pose.look_at, pose.at));
    let up = unit(pose.up);
    if length(cross(view, up)) < MIN_SINE {
        let hint = "choose another `up`, such as (0, 0, 1)";
        if let Some(node) = fields.get("up").or(fields.get("look_at")) {
            reader.error_hint(
                codes::DEGENERATE,
                node,
                "`up` is parallel to the view",
                hint,
            );
        }
    }
}

pub(super) fn animation<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<AnimationDesc> {
    let fields = Fields::read(reader, node, "`animation`", &["fps", "frames"])?;
    let default = AnimationDesc::default();
    Some(AnimationDesc {
        fps: fields.read_or("fps", default.fps, |r, n| {
            r.number(n, "`fps`", Domain::Positive)
        }),
        frames: fields.read_or("frames", default.frames, frames),
    })
}

fn frames<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<Range<u32>> {
    let Ok(range) = node.literal::<Range<u32>>() else {
        if node.text.contains("..=") {
            let hint = "frame ranges are half-open: 0..48 ends with frame 47";
            reader.error_hint(
                codes::BAD_FRAMES,
                node,
                "`frames` is written with `..`",
                hint,
            );
            return None;
        }
        return reader.wrong_type(node, "`frames`", "a range of whole numbers such as 0..48");
    };
    if range.is_empty() {
        let message = format!("`frames` {} holds no frame", node.text);
        if range.start > range.end {
            let hint = format!("did you mean {}..{}?", range.end, range.start);
            reader.error_hint(codes::BAD_FRAMES, node, message, hint);
        } else {
            reader.error_hint(
                codes::BAD_FRAMES,
                node,
                message,
                "the end of a range does not belong to it",
            );
        }
        return None;
    }
    Some(range)
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Length without overflow or underflow on the way.
fn length(v: [f64; 3]) -> f64 {
    let largest = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    let [x, y, z] = v.map(|c| c / largest);
    largest * (x * x + y * y + z * z).sqrt()
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let largest = v.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let scaled = v.map(|c| c / largest);
    let length = length(scaled);
    scaled.map(|c| c / length)
}
