//! Sizes: shapes that single precision blurs, and meshes whose file is in other units than the scene.

use super::codes;
use super::inside::winding_at;
use super::posed::{Form, Item, Posed};
use super::view::may_be_seen;
use super::words::short;
use crate::diag::Diagnostic;

/// Half a step of single precision, relative to the coordinate.
const HALF_STEP: f64 = 1.0 / (1 << 24) as f64;

/// Shapes keep at least this share of their size; beyond it, facets and seams show.
const MAX_ERROR: f64 = 1e-3;

/// So many times larger or smaller than the rest is another unit: millimetres among metres.
const UNIT_RATIO: f64 = 1000.0;

/// A mesh smaller than this many pixels is probably not meant to be.
const SMALL_PIXELS: f64 = 2.0;

/// The thinnest of what is a body, not a floor or a backdrop: a share of its length.
const FLAT: f64 = 0.01;

/// Winding number from which on a mesh surrounds the camera, as a dome or a valley does.
const SURROUNDS: f64 = 0.25;

/// The shape that single precision blurs most. Coordinates are rounded about the middle of the scene.
pub(super) fn blurred_place(posed: &Posed) -> Option<Diagnostic> {
    let middle = posed.extent.center() + posed.view.eye;
    let error = |item: &Item| item.bounds.reach(middle) * HALF_STEP / item.size();
    let blurred = |item: &&Item| {
        let mesh = matches!(item.form, Form::Mesh(_));
        mesh && item.size() > 0.0 && error(item) > MAX_ERROR
    };
    let all: Vec<&Item> = posed.items.iter().filter(blurred).collect();
    let worst = all.iter().max_by(|a, b| error(a).total_cmp(&error(b)))?;
    let others = match all.len() - 1 {
        0 => String::new(),
        1 => "; so it is with another shape".to_owned(),
        n => format!("; so it is with {n} other shapes"),
    };
    let says = format!(
        "{} is {} wide in a scene that is {} wide: in single precision its points are off by {:.1} % of its size{others}",
        posed.label(worst),
        short(worst.size()),
        short(posed.extent.longest()),
        100.0 * error(worst)
    );
    let culprit = farthest(posed);
    let hint = format!("bring what is far away nearer ({culprit}), or render it by itself");
    let warning = posed.warn(
        worst.entity(),
        worst.component(),
        codes::BLURRED_PLACE,
        says,
    );
    Some(warning.hint(hint))
}

/// What is farthest from the middle of all shapes: mostly what makes the scene so wide.
fn farthest(posed: &Posed) -> String {
    let inner: Vec<&Item> = posed.items.iter().filter(|item| !item.wall).collect();
    let mut middles = [0, 1, 2].map(|axis| {
        let mut all: Vec<f64> = inner.iter().map(|i| i.bounds.center()[axis]).collect();
        all.push(posed.view.eye[axis]);
        all.sort_by(f64::total_cmp);
        all[all.len() / 2]
    });
    let middle = crate::math::DVec3::from_array(std::mem::take(&mut middles));
    let camera = (posed.view.eye - middle).length();
    let distance = |item: &Item| (item.bounds.center() - middle).length();
    let last = inner
        .iter()
        .max_by(|a, b| distance(a).total_cmp(&distance(b)));
    match last {
        Some(item) if distance(item) >= camera => {
            format!("{} is {} away", posed.label(item), short(distance(item)))
        }
        _ => format!("the camera is {} away", short(camera)),
    }
}

/// Meshes a thousand times smaller than all else in view and hardly to be seen, or a thousand times larger and no floor,
/// backdrop or dome.
pub(super) fn other_units(posed: &Posed) -> Vec<Diagnostic> {
    let mut seen: Vec<&Item> = posed
        .items
        .iter()
        .filter(|item| item.size() > 0.0 && may_be_seen(&posed.view, item))
        .collect();
    seen.sort_by(|a, b| a.size().total_cmp(&b.size()));
    let gap = |pair: &[&Item]| pair[1].size() >= UNIT_RATIO * pair[0].size();
    let mut found = Vec::new();
    if let Some(at) = seen.windows(2).position(gap) {
        let (small, rest) = seen.split_at(at + 1);
        let is_lost = |item: &&&Item| matches!(item.form, Form::Mesh(_)) && is_lost(posed, item);
        found.extend(
            small
                .iter()
                .filter(is_lost)
                .map(|item| told(posed, item, rest[0])),
        );
    }
    let inner: Vec<&Item> = seen.into_iter().filter(|item| !item.wall).collect();
    if let [.., second, largest] = inner.as_slice()
        && gap(&[second, largest])
        && is_body(posed, largest)
    {
        found.push(told(posed, largest, second));
    }
    found
}

fn is_lost(posed: &Posed, item: &Item) -> bool {
    let distance = (item.bounds.center() - posed.view.eye).length();
    item.size() < SMALL_PIXELS * posed.view.pixel * distance
}

/// Whether a mesh is there as its file has it, has a volume, and does not stand around the camera.
fn is_body(posed: &Posed, item: &Item) -> bool {
    matches!(item.form, Form::Mesh(_))
        && item.scale == 1.0
        && item.bounds.shortest() > FLAT * item.size()
        && winding_at(posed, item, posed.view.eye).abs() < SURROUNDS
}

fn told(posed: &Posed, item: &Item, other: &Item) -> Diagnostic {
    let larger = item.size() > other.size();
    let (ratio, word) = match larger {
        true => (item.size() / other.size(), "larger"),
        false => (other.size() / item.size(), "smaller"),
    };
    let says = format!(
        "{} is {} wide, {} times {word} than {}, the next in size: is its file in other units?",
        posed.label(item),
        short(item.size()),
        short(ratio.round()),
        posed.label(other)
    );
    let scale = if larger { 0.001 } else { 1000.0 } * item.scale;
    let hint = format!("`transform: (scale: {})`", short(scale));
    posed
        .warn(item.entity(), item.component(), codes::OTHER_UNITS, says)
        .hint(hint)
}
