//! What the camera sees: something at all, larger than a pixel, sharper than a blur, under an angle in degrees.
//!
//! Boxes stand for shapes, and a box that may be in view counts as in view: better silent than wrong.

use super::codes;
use super::posed::{Form, Item, Posed};
use super::words::{place, short};
use crate::diag::Diagnostic;
use crate::math::{DVec3, acos};
use std::f64::consts::PI;

/// Share of the picture's height over which a point is blurred beyond recognition.
const HOPELESS_BLUR: f64 = 0.15;

/// Fields of view below this many degrees may be radians: π, rounded up.
const MAX_RADIANS: f64 = 3.2;

/// So many times the picture must the subject be for a narrow view to be a mistake.
const CROPPED: f64 = 2.0;

/// What is wrong with the view, if something is.
pub(super) fn view(posed: &Posed) -> Vec<Diagnostic> {
    let seen: Vec<&Item> = posed
        .items
        .iter()
        .filter(|i| may_be_seen(posed, i))
        .collect();
    let mut found = Vec::new();
    if seen.is_empty() && !posed.moves {
        found.extend(nothing(posed));
    }
    found.extend(below_a_pixel(posed, &seen));
    found.extend(radians(posed));
    found.extend(blurred(posed, &seen));
    found
}

/// Whether an item's box, or the sphere itself, reaches into the view.
pub(super) fn may_be_seen(posed: &Posed, item: &Item) -> bool {
    let view = &posed.view;
    let (right, up) = view.half;
    // Inward normals of the pyramid's sides, and of the plane through the eye.
    let sides = [
        DVec3::new(1.0, 0.0, right),
        DVec3::new(-1.0, 0.0, right),
        DVec3::new(0.0, 1.0, up),
        DVec3::new(0.0, -1.0, up),
        DVec3::new(0.0, 0.0, 1.0),
    ];
    // A lens sees past the sides, by its radius.
    let slack = view.camera.aperture_radius;
    match item.form {
        Form::Sphere { radius, .. } => {
            let center = view.seen(item.to_world().translation);
            sides
                .iter()
                .all(|n| center.dot(*n) > -(radius + slack) * n.length())
        }
        Form::Mesh(_) => {
            let corners = corners(posed, item);
            let inside = |n: &DVec3| corners.iter().any(|p| p.dot(*n) > -slack * n.length());
            sides.iter().all(inside)
        }
    }
}

/// The corners of an item's own box in the camera's space.
fn corners(posed: &Posed, item: &Item) -> [DVec3; 8] {
    let view = &posed.view;
    match item.form {
        Form::Sphere { .. } => item.bounds.corners().map(|p| view.seen(p)),
        Form::Mesh(id) => {
            let to_world = item.to_world();
            let corners = posed.local(id).corners();
            corners.map(|p| view.seen(to_world.transform_point3(p)))
        }
    }
}

/// A glTF file that has nothing to show has said so when it was read.
fn nothing(posed: &Posed) -> Option<Diagnostic> {
    let view = &posed.view;
    let distance = |item: &Item| (item.bounds.center() - view.eye).length();
    let nearest = posed
        .items
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let Some(nearest) = nearest else {
        if posed.store.models.iter().any(|model| model.is_empty()) {
            return None;
        }
        let says = "nothing is in view: the scene has no shape".to_owned();
        let hint = "give an entity `shape: Sphere(radius: 1)`, `shape: Mesh(\"file.obj\")` or `gltf: \"file.glb\"`";
        let warning = posed.warn_at_camera(&[], codes::NOTHING_IN_VIEW, says);
        return Some(warning.hint(hint));
    };
    let center = nearest.bounds.center();
    let seen = view.seen(center);
    let label = posed.label(nearest);
    let says = if seen.z < 0.0 {
        let behind = short(-seen.z);
        format!(
            "nothing is in view: the nearest shape, {label}, is {behind} units behind the camera"
        )
    } else {
        let angle = acos((seen.z / seen.length()).clamp(-1.0, 1.0)) * 180.0 / PI;
        format!(
            "nothing is in view: the nearest shape, {label}, is {} units away, {angle:.0}° off the view axis",
            short(seen.length())
        )
    };
    let hint = format!("turn the camera: `look_at: {}`", place(center));
    let warning = posed.warn_at_camera(&["look_at"], codes::NOTHING_IN_VIEW, says);
    Some(warning.hint(hint))
}

/// A rectangle on the picture's plane at distance 1: least and greatest right and up.
struct Rect {
    min: (f64, f64),
    max: (f64, f64),
}

impl Rect {
    /// Of boxes that lie wholly before the camera; `None` where one does not, or there is none.
    fn of<'i>(posed: &Posed, items: impl Iterator<Item = &'i Item<'i>>) -> Option<Rect> {
        let mut rect: Option<Rect> = None;
        for p in items.flat_map(|item| corners(posed, item)) {
            if p.z <= 0.0 {
                return None;
            }
            let (x, y) = (p.x / p.z, p.y / p.z);
            let r = rect.unwrap_or(Rect {
                min: (x, y),
                max: (x, y),
            });
            rect = Some(Rect {
                min: (r.min.0.min(x), r.min.1.min(y)),
                max: (r.max.0.max(x), r.max.1.max(y)),
            });
        }
        rect
    }

    fn size(&self) -> f64 {
        (self.max.0 - self.min.0).max(self.max.1 - self.min.1)
    }
}

fn below_a_pixel(posed: &Posed, seen: &[&Item]) -> Option<Diagnostic> {
    let rect = Rect::of(posed, seen.iter().copied())?;
    let pixels = rect.size() / posed.view.pixel;
    if pixels >= 1.0 || posed.moves {
        return None;
    }
    let subject = seen.iter().map(|i| i.bounds).reduce(|a, b| a.union(b))?;
    let near = 0.5 * subject.longest() / (0.6 * posed.view.half.1);
    let says = format!(
        "the whole scene covers {} of a pixel: it is {} wide and {} away",
        short(pixels),
        short(subject.longest()),
        short((subject.center() - posed.view.eye).length())
    );
    let hint = format!(
        "move the camera to some {} units from {}, or scale the scene up",
        short(near),
        place(subject.center())
    );
    Some(
        posed
            .warn_at_camera(&["at"], codes::BELOW_A_PIXEL, says)
            .hint(hint),
    )
}

/// A field of view of a few degrees that is not a telephoto lens: the subject does not fit by far.
fn radians(posed: &Posed) -> Option<Diagnostic> {
    let view = &posed.view;
    let vfov = view.camera.vfov_deg;
    if vfov >= MAX_RADIANS {
        return None;
    }
    let inner = posed.items.iter().filter(|item| !item.wall);
    let rect = Rect::of(
        posed,
        inner.filter(|item| view.seen(item.bounds.center()).z > 0.0),
    );
    let fits = rect.is_some_and(|rect| rect.size() <= CROPPED * 2.0 * view.half.0.max(view.half.1));
    (!fits).then(|| {
        let says = format!("`vfov_deg: {vfov}` is in degrees, and shows a small part of the scene");
        let hint = format!(
            "{vfov} radians would be {} degrees",
            short(vfov * 180.0 / PI)
        );
        posed
            .warn_at_camera(&["vfov_deg"], codes::RADIANS, says)
            .hint(hint)
    })
}

/// A lens for which nothing in view is sharp enough to be recognised: its circle of confusion at distance d, as seen on
/// the plane at distance 1, is 2 A |1/d − 1/f| wide (aperture radius A, focus at f).
fn blurred(posed: &Posed, seen: &[&Item]) -> Option<Diagnostic> {
    let view = &posed.view;
    let (aperture, focus) = (view.camera.aperture_radius, view.camera.focus_distance);
    if aperture == 0.0 || posed.moves {
        return None;
    }
    let mut least = f64::INFINITY;
    let (mut near, mut far) = (f64::INFINITY, 0.0_f64);
    for item in seen {
        let depths = corners(posed, item).map(|p| p.z);
        let nearest = depths.iter().copied().fold(f64::INFINITY, f64::min);
        let farthest = depths.iter().copied().fold(0.0, f64::max);
        let sharpest = focus
            .max(nearest.max(f64::MIN_POSITIVE))
            .min(farthest.max(f64::MIN_POSITIVE));
        least = least.min(2.0 * aperture * (1.0 / sharpest - 1.0 / focus).abs());
        (near, far) = (near.min(nearest), far.max(farthest));
    }
    let blur = least / (2.0 * view.half.1);
    (blur > HOPELESS_BLUR && blur.is_finite()).then(|| {
        let says = format!(
            "the lens focuses at {} and what is in view is {} to {} away: every point is blurred over {} % of the \
             picture's height",
            short(focus),
            short(near.max(0.0)),
            short(far),
            short(100.0 * blur)
        );
        let hint = "set `focus_distance` to the distance of the subject, or make `aperture_radius` smaller";
        posed.warn_at_camera(&["lens"], codes::OUT_OF_FOCUS, says).hint(hint)
    })
}
