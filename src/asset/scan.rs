//! The guard around the OBJ parser: reads the lines, keeps what the parser would not, and gives it what it can read.
//!
//! The parser (`tobj`) gives no line numbers, fails on comments and continuations, and fills in the attributes that a
//! face lacks from its neighbours. So faces are read here, with the line at hand that an error is about: every index is
//! resolved, and every corner has exactly the attributes that its own token names. The numbers of the vertices are read
//! here where they are plain (see [`super::numbers`]), which makes loading a third faster; all others go through the
//! parser as lines that it can read (see [`super::records`]).
//!
//! Leaves: triangles in file order, each face laid out as a fan. Where a fan does not cover its polygon, the next step
//! cuts it anew in place: a polygon of n corners is n − 2 triangles either way.

use super::codes;
use super::corner::{NONE, PerCorner};
use super::face::{Corner, corner, plain_corners};
use super::limits::Budget;
use super::numbers::plain_numbers;
use super::records::{BLOCK, KINDS, Records};
use super::text::{Line, Lines};
use crate::diag::Diagnostic;
use crate::math::{DVec2, DVec3};
use std::path::Path;

/// Errors reported for one file; more would not help.
pub(super) const MAX_ERRORS: usize = 20;

/// Bytes that a vertex of each of [`KINDS`] decodes to.
const RECORD_BYTES: [usize; 3] = [24, 16, 24];
/// Bytes that a triangle decodes to: three indices for each of three corners, and its material.
const TRIANGLE_BYTES: usize = 3 * 3 * 4 + 8;

/// A name or list of names that a line gives (`usemtl`, `mtllib`).
pub(super) struct Named {
    /// Byte offset of its line.
    pub(super) at: usize,
    /// What the line says after its keyword.
    pub(super) name: String,
    /// Number of triangles before it.
    pub(super) first: usize,
}

/// A face of more than three corners.
pub(super) struct Polygon {
    /// The first of its triangles.
    pub(super) first: usize,
    /// Number of corners.
    pub(super) corners: usize,
}

/// How many of something, and the byte offset of the line of the first.
#[derive(Clone, Copy, Default)]
pub(super) struct Tally {
    pub(super) count: usize,
    pub(super) first: usize,
}

impl Tally {
    pub(super) fn add(&mut self, at: usize) {
        if self.count == 0 {
            self.first = at;
        }
        self.count += 1;
    }
}

/// What the scan found.
#[derive(Default)]
pub(super) struct Scan {
    /// The `v` lines.
    pub(super) positions: Vec<DVec3>,
    /// Index into `positions` of each corner, or what is beyond it in an error.
    pub(super) corners: Vec<u32>,
    /// The `vt` lines, and which each corner names.
    pub(super) uvs: PerCorner<DVec2>,
    /// The `vn` lines, of any length, and which each corner names.
    pub(super) normals: PerCorner<DVec3>,
    /// The faces that are no triangles, in file order.
    pub(super) polygons: Vec<Polygon>,
    /// The `usemtl` lines.
    pub(super) uses: Vec<Named>,
    /// The `mtllib` lines.
    pub(super) libraries: Vec<Named>,
    /// Faces of one or two corners, which are skipped.
    pub(super) short: Tally,
    /// Faces that give an attribute to some corners only.
    pub(super) mixed: Tally,
    /// Faces that name uvs or normals though the file has none of that kind.
    pub(super) absent: Tally,
}

/// Scans the text of an OBJ file.
///
/// # Errors
/// Those of all its lines, at most [`MAX_ERRORS`]; a file that takes more than what is left of the budget.
pub(super) fn scan(
    source: &str,
    path: &Path,
    budget: &mut Budget,
) -> Result<Scan, Vec<Diagnostic>> {
    let mut scanner = Scanner {
        source,
        path,
        budget,
        scan: Scan::default(),
        records: [0, 1, 2].map(Records::of),
        counts: [0; 3],
        charged: [0; 3],
        forward: Vec::new(),
        errors: Vec::new(),
        corners: Vec::new(),
    };
    for line in Lines::of(source) {
        scanner.line(&line).map_err(|fatal| vec![fatal])?;
    }
    scanner.finish()
}

struct Scanner<'a> {
    source: &'a str,
    path: &'a Path,
    budget: &'a mut Budget,
    scan: Scan,
    records: [Records; 3],
    /// Lines of each of [`KINDS`] so far.
    counts: [usize; 3],
    /// How many of them the budget knows.
    charged: [usize; 3],
    /// Offsets of faces with a reference beyond what the file had defined so far: an error if the file never does.
    forward: Vec<usize>,
    errors: Vec<Diagnostic>,
    /// Of the face at hand.
    corners: Vec<Corner>,
}

impl Scanner<'_> {
    fn line(&mut self, line: &Line<'_>) -> Result<(), Diagnostic> {
        match line.keyword {
            "f" => return self.face(line),
            "v" => return self.vertex(line, 0),
            "vt" => return self.vertex(line, 1),
            "vn" => return self.vertex(line, 2),
            "usemtl" => self.scan.uses.push(self.named(line)),
            "mtllib" => self.scan.libraries.push(self.named(line)),
            _ => {}
        }
        Ok(())
    }

    fn named(&self, line: &Line<'_>) -> Named {
        Named {
            at: line.at,
            name: line.rest.trim_end().to_owned(),
            first: self.scan.corners.len() / 3,
        }
    }

    /// Takes the numbers that count: of a `v` line three, or four where the fourth is the weight `w` (five or more are
    /// vertex colours); of `vt` two, the second being optional; of `vn` three.
    fn vertex(&mut self, line: &Line<'_>, kind: usize) -> Result<(), Diagnostic> {
        self.counts[kind] += 1;
        if self.counts[kind] - self.charged[kind] == BLOCK {
            self.charge(kind)?;
        }
        match (kind, plain_numbers(line.rest.as_bytes())) {
            (0, Some(([x, y, z, ..], 3 | 5..))) => self.scan.positions.push(DVec3::new(x, y, z)),
            (1, Some(([u, v, ..], 2..))) => self.scan.uvs.values.push(DVec2::new(u, v)),
            (2, Some(([x, y, z, ..], 3..))) => self.scan.normals.values.push(DVec3::new(x, y, z)),
            _ => return self.record(line, kind),
        }
        Ok(())
    }

    /// Keeps a vertex for the parser, and its place.
    fn record(&mut self, line: &Line<'_>, kind: usize) -> Result<(), Diagnostic> {
        let values = line.values();
        let (count, ends) = words(values);
        let (least, kept) = match (kind, count) {
            (0, 4) => (3, 4),
            (1, 1) => (1, 1),
            (1, _) => (2, 2),
            _ => (3, 3),
        };
        let place = self.counts[kind] - 1;
        match kind {
            0 => self.scan.positions.push(DVec3::NAN),
            1 => self.scan.uvs.values.push(DVec2::NAN),
            _ => self.scan.normals.values.push(DVec3::NAN),
        }
        if count < least {
            let says = format!("`{}` needs {least} numbers, not {count}", KINDS[kind]);
            self.error(codes::BAD_NUMBER, line.at, says);
            return Ok(());
        }
        let numbers = &values[..ends[kept - 1]];
        if (kind, count) == (1, 1) {
            self.records[kind].push(place, &[numbers, "0"]);
        } else {
            self.records[kind].push(place, &[numbers]);
        }
        if self.records[kind].is_full() {
            self.read(kind)
        } else {
            Ok(())
        }
    }

    /// Charges the vertices of a kind that are not charged yet.
    fn charge(&mut self, kind: usize) -> Result<(), Diagnostic> {
        let count = self.counts[kind];
        if count >= NONE as usize {
            let says = format!("the file has more than {NONE} `{}` lines", KINDS[kind]);
            return Err(Diagnostic::error(codes::TOO_LARGE, says));
        }
        let bytes = (count - self.charged[kind]) * RECORD_BYTES[kind];
        self.charged[kind] = count;
        self.budget
            .charge(bytes as u64, "the mesh so far", self.path)
    }

    /// Has the parser read the vertices that wait.
    fn read(&mut self, kind: usize) -> Result<(), Diagnostic> {
        let records = &mut self.records[kind];
        let scan = &mut self.scan;
        match kind {
            0 => put(&mut scan.positions, records.read()?, DVec3::from_array),
            1 => put(&mut scan.uvs.values, records.read()?, DVec2::from_array),
            _ => put(&mut scan.normals.values, records.read()?, DVec3::from_array),
        }
        Ok(())
    }

    fn face(&mut self, line: &Line<'_>) -> Result<(), Diagnostic> {
        if !plain_corners(line.rest.as_bytes(), &mut self.corners) {
            self.corners.clear();
            for token in line.values().split_ascii_whitespace() {
                match corner(token, &self.counts) {
                    Ok(corner) => self.corners.push(corner),
                    Err(says) => {
                        self.error(codes::BAD_FACE, line.at, says);
                        return Ok(());
                    }
                }
            }
        }
        if self.corners.len() < 3 {
            self.scan.short.add(line.at);
            return Ok(());
        }
        let beyond = |(&index, count): (&u32, usize)| index != NONE && index as usize >= count;
        let forward = |corner: &Corner| corner.iter().zip(self.counts).any(beyond);
        if self.corners.iter().any(forward) {
            self.forward.push(line.at);
        }
        for kind in 1..KINDS.len() {
            let given = self
                .corners
                .iter()
                .filter(|corner| corner[kind] != NONE)
                .count();
            if given != 0 && given != self.corners.len() {
                self.scan.mixed.add(line.at);
                self.corners
                    .iter_mut()
                    .for_each(|corner| corner[kind] = NONE);
            }
        }
        self.lay()
    }

    /// Lays the face out as a fan.
    fn lay(&mut self) -> Result<(), Diagnostic> {
        let triangles = self.corners.len() - 2;
        let bytes = triangles * TRIANGLE_BYTES;
        self.budget
            .charge(bytes as u64, "the mesh so far", self.path)?;
        let scan = &mut self.scan;
        let before = scan.corners.len();
        if before + 3 * triangles >= NONE as usize {
            let says = format!("the file has more than {} triangles", NONE / 3);
            return Err(Diagnostic::error(codes::TOO_LARGE, says));
        }
        if triangles > 1 {
            scan.polygons.push(Polygon {
                first: before / 3,
                corners: self.corners.len(),
            });
        }
        lay(&mut scan.corners, &self.corners, 0);
        for (kind, of) in [(1, &mut scan.uvs.of), (2, &mut scan.normals.of)] {
            if of.is_empty() && self.corners[0][kind] != NONE {
                of.resize(before, NONE);
            }
            if self.corners[0][kind] != NONE || !of.is_empty() {
                lay(of, &self.corners, kind);
            }
        }
        Ok(())
    }

    fn error(&mut self, code: &'static str, at: usize, says: String) {
        if self.errors.len() < MAX_ERRORS {
            let error = at_line(Diagnostic::error(code, says), self.source, at);
            self.errors.push(error);
        }
    }

    fn finish(mut self) -> Result<Scan, Vec<Diagnostic>> {
        for kind in 0..KINDS.len() {
            self.charge(kind).map_err(|fatal| vec![fatal])?;
            if self.records[kind].len() > 0 {
                self.read(kind).map_err(|fatal| vec![fatal])?;
            }
        }
        self.judge();
        if !self.errors.is_empty() {
            return Err(self.errors);
        }
        if self.scan.corners.is_empty() {
            let error = Diagnostic::error(codes::NO_FACES, "the file has no faces");
            return Err(vec![error]);
        }
        // Faces that name what the file has none of.
        if self.counts[1] == 0 {
            self.scan.uvs = PerCorner::default();
        }
        if self.counts[2] == 0 {
            self.scan.normals = PerCorner::default();
        }
        Ok(self.scan)
    }

    /// Judges the faces that had nothing to refer to when they stood there: one error or warning for each.
    fn judge(&mut self) {
        for at in std::mem::take(&mut self.forward) {
            let Some(line) = Lines::from(self.source, at).next() else {
                continue;
            };
            let indices = |kind: usize| {
                let indices = line.values().split_ascii_whitespace();
                let indices = indices
                    .filter_map(move |token| token.split('/').nth(kind)?.parse::<u64>().ok());
                indices.max().unwrap_or_default()
            };
            let beyond = |kind: usize| indices(kind) > self.counts[kind] as u64;
            let defined = |kind: usize| kind == 0 || self.counts[kind] > 0;
            match (0..KINDS.len()).find(|&kind| defined(kind) && beyond(kind)) {
                Some(kind) => {
                    let (name, index, count) = (KINDS[kind], indices(kind), self.counts[kind]);
                    let says = format!("the face uses `{name}` {index}, but the file has {count}");
                    self.error(codes::BAD_FACE, at, says);
                }
                None if (1..KINDS.len()).any(beyond) => self.scan.absent.add(at),
                None => {}
            }
        }
    }
}

/// Puts values where they belong.
fn put<T, const N: usize>(
    values: &mut [T],
    read: Vec<(usize, [f64; N])>,
    of: impl Fn([f64; N]) -> T,
) {
    for (place, numbers) in read {
        if let Some(value) = values.get_mut(place) {
            *value = of(numbers);
        }
    }
}

/// Words of a line that matter: more of them are colours.
const MAX_WORDS: usize = 5;

/// The number of words, at most [`MAX_WORDS`], and where each ends.
fn words(text: &str) -> (usize, [usize; MAX_WORDS]) {
    let mut ends = [text.len(); MAX_WORDS];
    let (mut count, mut inside) = (0, false);
    for (at, byte) in text.bytes().enumerate() {
        let is_blank = matches!(byte, b' ' | b'\t'..=b'\r');
        if inside && is_blank {
            ends[count - 1] = at;
            if count == MAX_WORDS {
                break;
            }
        }
        count += usize::from(!inside && !is_blank);
        inside = !is_blank;
    }
    (count, ends)
}

/// Appends one attribute of the corners of a face, as a fan.
fn lay(out: &mut Vec<u32>, corners: &[Corner], kind: usize) {
    for pair in corners[1..].windows(2) {
        out.extend([corners[0][kind], pair[0][kind], pair[1][kind]]);
    }
}

/// Adds the place of the line that starts at byte `at`.
pub(super) fn at_line(diagnostic: Diagnostic, source: &str, at: usize) -> Diagnostic {
    let line = source.get(at..).and_then(|text| text.lines().next());
    diagnostic.at(source, at, line.map_or(1, |line| line.trim_end().len()))
}
