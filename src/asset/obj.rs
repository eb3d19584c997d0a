//! Triangles of a scanned OBJ file to a [`Mesh`], in place: polygons cut anew where a fan does not cover them, triangles
//! without area dropped, values that nothing uses dropped.
//!
//! Enters: a [`Scan`] and the material of each `usemtl` line. Leaves: a mesh whose every corner has the uv and the
//! normal that its own token names. Deliberately absent: curves, points, lines, vertex colours, smoothing groups.

use super::corner::{NONE, PerCorner};
use super::places::{line_of_triangle, line_of_vertex};
use super::scan::{Scan, Tally, at_line};
use super::triangulate::{self, Trouble};
use super::{Mesh, codes, duplicates};
use crate::diag::Diagnostic;
use crate::math::DVec3;

/// Coordinates beyond this are refused: products of three of them, as in volumes, would overflow.
pub(super) const MAX_COORDINATE: f64 = 1e100;

/// How many triangles or corners, and the first of these triangles.
#[derive(Clone, Copy, Default)]
struct Found {
    count: usize,
    triangle: usize,
}

impl Found {
    fn add(&mut self, triangle: usize) {
        if self.count == 0 {
            self.triangle = triangle;
        }
        self.count += 1;
    }
}

/// What there is to say about the triangles of a file.
#[derive(Default)]
struct Findings {
    tangled: Found,
    bad_uv: Found,
    bad_normal: Found,
    zero_area: Found,
    twice: Found,
}

/// Builds the triangles of a scanned file. `materials` gives the index into [`Mesh::materials`] of each `usemtl` line.
/// Appends warnings.
///
/// # Errors
/// A vertex or polygon that cannot be used, with its line; a file without any area.
pub(super) fn triangles(
    source: &str,
    mut scan: Scan,
    materials: &[Option<u32>],
    warnings: &mut Vec<Diagnostic>,
) -> Result<Mesh, Diagnostic> {
    refuse_bad_vertices(source, &scan)?;
    let mut findings = Findings {
        tangled: cut_polygons(source, &mut scan)?,
        bad_uv: drop_values(&mut scan.uvs, |uv| uv.is_finite().then_some(uv)),
        bad_normal: drop_values(&mut scan.normals, super::normals::unit),
        ..Findings::default()
    };
    let (material, dropped) = keep_with_area(&mut scan, materials);
    if material.is_empty() {
        let says = "no face of the file has an area";
        return Err(Diagnostic::error(codes::NO_FACES, says));
    }
    findings.zero_area = Found {
        count: dropped.len(),
        triangle: dropped.first().copied().unwrap_or_default(),
    };
    let twice = duplicates::find(&scan.corners);
    findings.twice = Found {
        count: twice.count,
        triangle: number_in_file(twice.first, &dropped),
    };
    warnings.extend(findings.warnings(source, &scan));
    Ok(finish(scan, material))
}

/// The number of a triangle in its file, from that among those that are kept. `dropped` are the others, in order.
fn number_in_file(kept: usize, dropped: &[usize]) -> usize {
    let before = dropped.iter().enumerate();
    kept + before
        .take_while(|(i, triangle)| **triangle <= kept + i)
        .count()
}

impl Findings {
    fn warnings(&self, source: &str, scan: &Scan) -> Vec<Diagnostic> {
        let lines = [
            (
                codes::SHORT_FACE,
                scan.short,
                "faces of fewer than three corners are skipped",
            ),
            (
                codes::MIXED_FACE,
                scan.mixed,
                "faces give a uv or normal to some corners only, which is ignored",
            ),
            (
                codes::ABSENT,
                scan.absent,
                "faces name uvs or normals, and the file has none",
            ),
        ];
        let triangles = [
            (
                codes::ZERO_AREA,
                self.zero_area,
                "triangles without area are dropped",
            ),
            (codes::TANGLED_FACE, self.tangled, "faces cross themselves"),
            (
                codes::BAD_UV,
                self.bad_uv,
                "corners have a uv that is not a finite number, which is ignored",
            ),
            (
                codes::BAD_NORMAL,
                self.bad_normal,
                "corners have a normal that is zero or not a finite number, which is ignored",
            ),
            (
                codes::DUPLICATE_FACE,
                self.twice,
                "triangles have the vertices of one before them, which hides them; where they shine, they shine twice",
            ),
        ];
        let triangles = triangles
            .into_iter()
            .filter(|(_, found, _)| found.count > 0);
        let triangles = triangles.map(|(code, Found { count, triangle }, says)| {
            let first = line_of_triangle(source, triangle);
            (code, Tally { count, first }, says)
        });
        let lines = lines.into_iter().filter(|(_, tally, _)| tally.count > 0);
        lines
            .chain(triangles)
            .map(|(code, Tally { count, first }, says)| {
                let says = format!("{count} {says}; the first is here");
                at_line(Diagnostic::warning(code, says), source, first)
            })
            .collect()
    }
}

/// The mesh of what is left, without the values that no corner uses.
fn finish(mut scan: Scan, material: Vec<Option<u32>>) -> Mesh {
    drop_unused(&mut scan.positions, &mut scan.corners);
    drop_unused(&mut scan.uvs.values, &mut scan.uvs.of);
    drop_unused(&mut scan.normals.values, &mut scan.normals.of);
    Mesh {
        positions: scan.positions,
        corners: scan.corners,
        uvs: scan.uvs,
        normals: scan.normals,
        material,
        ..Mesh::default()
    }
}

/// A vertex that cannot be used matters only if a face uses it.
fn refuse_bad_vertices(source: &str, scan: &Scan) -> Result<(), Diagnostic> {
    let good = |p: &DVec3| p.is_finite() && p.abs().max_element() <= MAX_COORDINATE;
    if scan.positions.iter().all(good) {
        return Ok(());
    }
    let bad = |&index: &u32| !good(&scan.positions[index as usize]);
    match scan.corners.iter().position(bad) {
        None => Ok(()),
        Some(corner) => {
            let vertex = scan.corners[corner] as usize;
            let face = line_of_triangle(source, corner / 3);
            Err(bad_vertex(source, face, vertex, scan.positions[vertex]))
        }
    }
}

/// Cuts every polygon of which a fan does not do.
///
/// # Errors
/// A polygon of more corners than can be cut.
fn cut_polygons(source: &str, scan: &mut Scan) -> Result<Found, Diagnostic> {
    let mut tangled = Found::default();
    let (mut points, mut flat) = (Vec::new(), Vec::new());
    let (mut triangles, mut ring) = (Vec::new(), Vec::new());
    for polygon in &scan.polygons {
        let laid = 3 * polygon.first..3 * (polygon.first + polygon.corners - 2);
        let corners = &mut scan.corners[laid.clone()];
        points.clear();
        points.extend(rim(corners).map(|index| scan.positions[index as usize]));
        if triangulate::fan_covers(&points, &mut flat) {
            continue;
        }
        triangles.clear();
        match triangulate::cut(&flat, &mut triangles) {
            Ok(()) => {}
            Err(Trouble::Tangled) => tangled.add(polygon.first),
            Err(Trouble::TooLarge) => return Err(too_many_corners(source, polygon)),
        }
        for of in [&mut scan.corners, &mut scan.uvs.of, &mut scan.normals.of] {
            let Some(of) = of.get_mut(laid.clone()) else {
                continue;
            };
            ring.clear();
            ring.extend(rim(of));
            for (corner, k) in of.iter_mut().zip(triangles.as_flattened()) {
                *corner = ring[*k];
            }
        }
    }
    Ok(tangled)
}

/// The corners of a polygon that is laid out as a fan, once around.
fn rim(fan: &[u32]) -> impl Iterator<Item = u32> {
    let thirds = fan.iter().skip(2).step_by(3);
    fan.iter().take(2).chain(thirds).copied()
}

fn too_many_corners(source: &str, polygon: &super::scan::Polygon) -> Diagnostic {
    let says = format!(
        "a concave face of {} corners: at most {} can be triangulated",
        polygon.corners,
        triangulate::MAX_CONCAVE_CORNERS
    );
    let at = line_of_triangle(source, polygon.first);
    at_line(Diagnostic::error(codes::TOO_LARGE, says), source, at)
}

/// Replaces each value by what `good` makes of it; corners of what it refuses have none.
fn drop_values<T: Copy>(attribute: &mut PerCorner<T>, good: impl Fn(T) -> Option<T>) -> Found {
    let mut refused = Vec::new();
    for (i, value) in attribute.values.iter_mut().enumerate() {
        match good(*value) {
            Some(good) => *value = good,
            None => refused.push(i as u32),
        }
    }
    let mut found = Found::default();
    if !refused.is_empty() {
        for (corner, of) in attribute.of.iter_mut().enumerate() {
            if refused.binary_search(of).is_ok() {
                found.add(corner / 3);
                *of = NONE;
            }
        }
    }
    found
}

/// Drops the triangles without area. Returns the material of each that is kept, and the numbers of the others.
fn keep_with_area(scan: &mut Scan, materials: &[Option<u32>]) -> (Vec<Option<u32>>, Vec<usize>) {
    let count = scan.corners.len() / 3;
    let mut kept = Vec::with_capacity(count);
    let mut dropped = Vec::new();
    let mut uses = scan.uses.iter().zip(materials).peekable();
    let mut material = None;
    for triangle in 0..count {
        while let Some((_, next)) = uses.next_if(|(line, _)| line.first <= triangle) {
            material = *next;
        }
        let from = 3 * triangle..3 * triangle + 3;
        let points = [0, 1, 2].map(|k| scan.positions[scan.corners[from.start + k] as usize]);
        if !has_area(points) {
            dropped.push(triangle);
            continue;
        }
        let to = 3 * kept.len();
        kept.push(material);
        if to != from.start {
            for of in [&mut scan.corners, &mut scan.uvs.of, &mut scan.normals.of] {
                if !of.is_empty() {
                    of.copy_within(from.clone(), to);
                }
            }
        }
    }
    for of in [&mut scan.corners, &mut scan.uvs.of, &mut scan.normals.of] {
        of.truncate(3 * kept.len());
    }
    (kept, dropped)
}

/// Drops the values that no index names.
fn drop_unused<T: Copy>(values: &mut Vec<T>, of: &mut [u32]) {
    let mut used = vec![false; values.len()];
    for &index in of.iter().filter(|&&index| index != NONE) {
        used[index as usize] = true;
    }
    if used.iter().all(|&used| used) {
        return;
    }
    let mut place = vec![NONE; values.len()];
    let mut next = 0;
    for i in (0..values.len()).filter(|&i| used[i]) {
        place[i] = next as u32;
        values[next] = values[i];
        next += 1;
    }
    values.truncate(next);
    values.shrink_to_fit();
    for index in of.iter_mut().filter(|index| **index != NONE) {
        *index = place[*index as usize];
    }
}

/// Whether the triangle has an area: its edges, each scaled to size 1 so that nothing underflows, are not parallel.
pub(super) fn has_area([a, b, c]: [DVec3; 3]) -> bool {
    let scaled = |edge: DVec3| edge / edge.abs().max_element();
    let cross = scaled(b - a).cross(scaled(c - a));
    cross.abs().max_element() > 0.0 && b != c
}

/// The error for a vertex that cannot be used, and the first face that does.
fn bad_vertex(source: &str, face: usize, vertex: usize, position: DVec3) -> Diagnostic {
    let line = line_of_vertex(source, vertex);
    let unreadable = line.as_ref().and_then(|line| {
        let mut words = line.values().split_whitespace();
        words
            .find(|word| word.parse::<f64>().is_err())
            .map(str::to_owned)
    });
    let says = match unreadable {
        Some(word) => format!("`{word}` is not a number"),
        None if position.is_finite() => "the vertex is beyond 1e100".to_owned(),
        None => "the vertex is not finite".to_owned(),
    };
    let line_of_face = source[..face].matches('\n').count() + 1;
    let says = format!("{says}, and the face in line {line_of_face} uses it");
    let at = line.map_or(face, |line| line.at);
    at_line(Diagnostic::error(codes::BAD_VERTEX, says), source, at)
}
