//! Unwrapping: triangles to charts, charts to places in the texture.
//!
//! Enters: a mesh and the part that owns each point. Leaves: texel coordinates of every corner. A chart is a connected
//! set of triangles of one part that face one of the six axis directions; it is projected along that axis, so within
//! it nothing folds, and its border is a seam. Deliberately absent: colours.

use crate::net::Mesh;
use crate::shape::{Cat, Part};
use luxel::math::{DVec2, DVec3};
use std::collections::BTreeMap;

/// Free texels around every chart, so that bilinear filtering never reaches another one.
pub(crate) const MARGIN: f64 = 3.0;
/// A triangle may be taken over by a neighbouring chart if the cosine between its normal and the axis is at least this.
const TAKEOVER_COSINE: f64 = 0.3;
/// Charts of fewer triangles are dissolved into a neighbour where possible.
const SMALL_CHART: usize = 24;
/// Rounds of smoothing chart borders.
const SMOOTH_ROUNDS: usize = 8;
/// The face is seen closest: its chart has this many times the resolution.
const FACE_MAGNIFICATION: f64 = 1.7;

/// Where the corners of each triangle lie in the texture, in texels, y down.
pub(crate) struct Layout {
    pub(crate) corners: Vec<[DVec2; 3]>,
    /// Chart of each triangle.
    pub(crate) chart: Vec<usize>,
}

type Label = (Part, usize);

/// Unwraps into a texture of the given size.
pub(crate) fn unwrap(cat: &Cat, mesh: &Mesh, size: [usize; 2]) -> Layout {
    let adjacent = adjacency(&mesh.triangles);
    let labels = labels(cat, mesh, &adjacent);
    let (chart, charts) = components(&labels, &adjacent);
    let mut places = vec![Place::EMPTY; charts];
    let mut flat: Vec<[DVec2; 3]> = Vec::with_capacity(chart.len());
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        let scale = if labels[t] == (Part::Head, 4) {
            FACE_MAGNIFICATION
        } else {
            1.0
        };
        let uv = triangle.map(|i| project(mesh.positions[i], labels[t].1) * scale);
        uv.iter().for_each(|&q| places[chart[t]].include(q));
        flat.push(uv);
    }
    let scale = pack(&mut places, size);
    let corners = flat
        .iter()
        .zip(&chart)
        .map(|(uv, &c)| {
            uv.map(|q| places[c].corner + (q - places[c].min) * scale + DVec2::splat(MARGIN))
        })
        .collect();
    Layout { corners, chart }
}

/// The triangle across each side (from corner k to k + 1). Sides without a partner point at their own triangle.
pub(crate) fn adjacency(triangles: &[[usize; 3]]) -> Vec<[usize; 3]> {
    let mut sides = BTreeMap::new();
    for (t, tri) in triangles.iter().enumerate() {
        for k in 0..3 {
            sides.insert((tri[k], tri[(k + 1) % 3]), t);
        }
    }
    let across = |t: usize, tri: &[usize; 3], k: usize| {
        *sides.get(&(tri[(k + 1) % 3], tri[k])).unwrap_or(&t)
    };
    triangles
        .iter()
        .enumerate()
        .map(|(t, tri)| [0, 1, 2].map(|k| across(t, tri, k)))
        .collect()
}

/// Axes 0..6: +x, −x, +y, −y, +z, −z.
fn axis(direction: usize) -> DVec3 {
    let sign = if direction.is_multiple_of(2) {
        1.0
    } else {
        -1.0
    };
    [DVec3::X, DVec3::Y, DVec3::Z][direction / 2] * sign
}

/// Seen against the axis, x to the right and y down, never mirrored.
fn project(p: DVec3, direction: usize) -> DVec2 {
    match direction {
        0 => DVec2::new(-p.z, -p.y),
        1 => DVec2::new(p.z, -p.y),
        2 => DVec2::new(p.x, p.z),
        3 => DVec2::new(p.x, -p.z),
        4 => DVec2::new(p.x, -p.y),
        _ => DVec2::new(-p.x, -p.y),
    }
}

/// Part and direction of each triangle, with smooth borders and without crumbs.
fn labels(cat: &Cat, mesh: &Mesh, adjacent: &[[usize; 3]]) -> Vec<Label> {
    let normals: Vec<DVec3> = mesh
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|i| mesh.positions[i]);
            (b - a).cross(c - a).normalize_or_zero()
        })
        .collect();
    let mut labels: Vec<Label> = mesh
        .triangles
        .iter()
        .zip(&normals)
        .map(|(t, n)| {
            let part = cat.part(t.iter().map(|&i| mesh.positions[i]).sum::<DVec3>() / 3.0);
            let best = (1..6).fold(0, |best, d| {
                if n.dot(axis(d)) > n.dot(axis(best)) {
                    d
                } else {
                    best
                }
            });
            (part, best)
        })
        .collect();
    for _ in 0..SMOOTH_ROUNDS {
        let before = labels.clone();
        for (t, near) in adjacent.iter().enumerate() {
            let [a, b, c] = near.map(|i| before[i]);
            let majority = if a == b || a == c {
                a
            } else if b == c {
                b
            } else {
                continue;
            };
            if normals[t].dot(axis(majority.1)) >= TAKEOVER_COSINE {
                labels[t] = majority;
            }
        }
    }
    dissolve_crumbs(&mut labels, &normals, adjacent);
    labels
}

/// Gives the triangles of small charts to a neighbouring chart whose axis they face, until nothing changes.
fn dissolve_crumbs(labels: &mut [Label], normals: &[DVec3], adjacent: &[[usize; 3]]) {
    for _ in 0..SMALL_CHART {
        let (chart, charts) = components(labels, adjacent);
        let mut size = vec![0; charts];
        chart.iter().for_each(|&c| size[c] += 1);
        let mut changed = false;
        for t in 0..labels.len() {
            let large = |&&n: &&usize| {
                size[chart[n]] >= SMALL_CHART
                    && normals[t].dot(axis(labels[n].1)) >= TAKEOVER_COSINE
            };
            if size[chart[t]] < SMALL_CHART
                && let Some(&to) = adjacent[t].iter().find(large)
            {
                labels[t] = labels[to];
                changed = true;
            }
        }
        if !changed {
            return;
        }
    }
}

/// Connected components of equal labels, numbered in order of their first triangle.
fn components(labels: &[Label], adjacent: &[[usize; 3]]) -> (Vec<usize>, usize) {
    let mut chart = vec![usize::MAX; labels.len()];
    let mut count = 0;
    for start in 0..labels.len() {
        if chart[start] != usize::MAX {
            continue;
        }
        chart[start] = count;
        let mut open = vec![start];
        while let Some(t) = open.pop() {
            for &n in &adjacent[t] {
                if chart[n] == usize::MAX && labels[n] == labels[start] {
                    chart[n] = count;
                    open.push(n);
                }
            }
        }
        count += 1;
    }
    (chart, count)
}

/// Box of a chart before scaling, and the corner of its place in the texture.
#[derive(Clone, Copy)]
struct Place {
    min: DVec2,
    max: DVec2,
    corner: DVec2,
}

impl Place {
    const EMPTY: Place = Place {
        min: DVec2::splat(f64::INFINITY),
        max: DVec2::splat(f64::NEG_INFINITY),
        corner: DVec2::ZERO,
    };

    fn include(&mut self, p: DVec2) {
        self.min = self.min.min(p);
        self.max = self.max.max(p);
    }
}

/// Shelves, the tallest charts first; returns the largest tried scale (texels per unit) at which all fit.
fn pack(places: &mut [Place], size: [usize; 2]) -> f64 {
    const LARGEST_SCALE: f64 = 4000.0;
    const SHRINK: f64 = 0.99;
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_by(|&a, &b| {
        let height = |i: usize| places[i].max.y - places[i].min.y;
        height(b).total_cmp(&height(a)).then(a.cmp(&b))
    });
    let mut scale = LARGEST_SCALE;
    while !fits(places, &order, size, scale) {
        scale *= SHRINK;
    }
    scale
}

/// Puts the charts on shelves at a scale; whether they fit.
fn fits(places: &mut [Place], order: &[usize], size: [usize; 2], scale: f64) -> bool {
    let [width, height] = size.map(|n| n as f64);
    let (mut x, mut y, mut shelf) = (0.0, 0.0, 0.0_f64);
    for &i in order {
        let extent = ((places[i].max - places[i].min) * scale).ceil() + DVec2::splat(2.0 * MARGIN);
        if x + extent.x > width {
            (x, y, shelf) = (0.0, y + shelf, 0.0);
        }
        if x + extent.x > width || y + extent.y > height {
            return false;
        }
        places[i].corner = DVec2::new(x, y);
        x += extent.x;
        shelf = shelf.max(extent.y);
    }
    true
}
