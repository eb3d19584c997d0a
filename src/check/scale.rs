//! Sizes: shapes that single precision blurs, and meshes whose file is in other units than the scene.

use super::bounds::Bounds;
use super::codes;
use super::inside::winding_at;
use super::posed::{Form, Item, Posed};
use super::view::may_be_seen;
use super::words::short;
use crate::asset::{Mesh, MeshId};
use crate::diag::Diagnostic;
use crate::math::DVec3;
use std::collections::BTreeMap;

/// Half a step of single precision, relative to the coordinate.
const HALF_STEP: f64 = 1.0 / (1 << 24) as f64;

/// Shapes keep at least this share of their size; beyond it, facets and seams show.
const MAX_ERROR: f64 = 1e-3;

/// Largest coordinate of single precision, with room for what is computed from it, over the width of the rest.
const RANGE: f64 = 1e37;

/// One in so many triangles: fewer are slivers, as scans have them.
const MIN_COLLAPSED: usize = 100;

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

/// A shape beyond the range of single precision, which begins where the rest of the scene is 1 wide.
pub(super) fn out_of_range(posed: &Posed) -> Option<Diagnostic> {
    let middle = posed.extent.center() + posed.view.eye;
    let extent = posed.extent.longest();
    let beyond = |item: &&Item| extent > 0.0 && item.bounds.reach(middle) / extent > RANGE;
    let item = posed.items.iter().find(beyond)?;
    let says = format!(
        "{} reaches {:.1e} times as far as the rest of the scene is wide: single precision ends at 3e38",
        posed.label(item),
        item.bounds.reach(middle) / extent
    );
    let warning = posed.warn(item.entity(), item.component(), codes::BLURRED_PLACE, says);
    Some(warning.hint(
        "make it smaller or bring it nearer: a wall needs no more than a million times the rest",
    ))
}

/// Meshes of which many triangles are smaller than a step of single precision over the whole mesh.
pub(super) fn collapsed(posed: &Posed) -> Vec<Diagnostic> {
    let mut known: BTreeMap<MeshId, Option<(usize, usize)>> = BTreeMap::new();
    let mut found = Vec::new();
    for item in &posed.items {
        let (Form::Mesh(id), Some(mesh)) = (item.form, posed.mesh(item)) else {
            continue;
        };
        let count = *known.entry(id).or_insert_with(|| {
            let step = posed.local(id).longest() * HALF_STEP;
            let (triangles, _) = mesh.corners.as_chunks::<3>();
            let lost = triangles.iter().filter(|t| is_below(mesh, t, step)).count();
            (lost * MIN_COLLAPSED > triangles.len()).then_some((lost, triangles.len()))
        });
        let Some((lost, all)) = count else {
            continue;
        };
        // Told at the first entity that brings the mesh.
        known.insert(id, None);
        let says = format!(
            "{lost} of the {all} triangles of {} are smaller than a step of single precision over its {}: they are \
             points",
            posed.label(item),
            short(posed.local(id).longest())
        );
        let hint =
            "does one vertex lie far from the rest by mistake? Otherwise cut the mesh into files";
        let warning = posed.warn(item.entity(), item.component(), codes::BLURRED_PLACE, says);
        found.push(warning.hint(hint));
    }
    found
}

/// Whether the longest side of a triangle's box is below a step.
fn is_below(mesh: &Mesh, triangle: &[u32; 3], step: f64) -> bool {
    let corners = triangle
        .iter()
        .filter_map(|c| mesh.positions.get(*c as usize));
    corners
        .fold(Bounds::EMPTY, |bounds, p| bounds.with(*p))
        .longest()
        < step
}

/// What is farthest from the middle of all shapes: mostly what makes the scene so wide.
fn farthest(posed: &Posed) -> String {
    let inner: Vec<&Item> = posed.items.iter().filter(|item| !item.wall).collect();
    let middles = [0, 1, 2].map(|axis| {
        let mut all: Vec<f64> = inner.iter().map(|i| i.bounds.center()[axis]).collect();
        all.push(posed.view.eye[axis]);
        all.sort_by(f64::total_cmp);
        all[all.len() / 2]
    });
    let middle = DVec3::from_array(middles);
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
        .filter(|item| item.size() > 0.0 && may_be_seen(posed, item))
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
        && item.pose.size == 1.0
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
    let scale = if larger { 0.001 } else { 1000.0 } * item.pose.size;
    let hint = format!("`transform: (scale: {})`", short(scale));
    posed
        .warn(item.entity(), item.component(), codes::OTHER_UNITS, says)
        .hint(hint)
}
