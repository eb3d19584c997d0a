//! The guard before the OBJ parser: reads the lines, checks what the parser would not say, and hands it a clean text.
//!
//! The parser (`tobj`) gives no line numbers, fails on comments and continuations, and fills in the attributes that a
//! face lacks from its neighbours. So this pass remembers where each face stands, resolves its indices, and sorts the
//! faces into one group for each set of attributes (positions alone, with uv, with normals, with both). Within a group
//! every corner has exactly the attributes that its own token names, and there is nothing to fill in.

use super::codes;
use super::text::{Line, Lines};
use crate::diag::Diagnostic;

/// Errors reported for one file; more would not help.
pub(super) const MAX_ERRORS: usize = 20;

/// Which attributes a face gives: bit 0 uv, bit 1 normal. The index of its group.
pub(super) type AttributeSet = u8;

/// The faces have texture coordinates.
pub(super) const WITH_UV: AttributeSet = 1;
/// The faces have normals.
pub(super) const WITH_NORMAL: AttributeSet = 2;

/// One face of the file.
pub(super) struct Face {
    /// Byte offset of its line.
    pub(super) at: usize,
    /// Index into [`Scan::uses`] of the `usemtl` in force.
    pub(super) used: Option<u32>,
    /// Number of corners, at least 3.
    pub(super) corners: u32,
    /// Its attributes, hence its group.
    pub(super) set: AttributeSet,
}

/// A name or list of names that a line gives (`usemtl`, `mtllib`).
pub(super) struct Named {
    /// Byte offset of its line.
    pub(super) at: usize,
    /// What the line says after its keyword.
    pub(super) name: String,
}

/// What the scan found.
#[derive(Default)]
pub(super) struct Scan {
    /// Cleaned `v`, `vt` and `vn` lines, in file order.
    pub(super) vertices: String,
    /// Cleaned `f` lines with absolute indices, by [`AttributeSet`], in file order.
    pub(super) groups: [String; 4],
    /// The faces in file order.
    pub(super) faces: Vec<Face>,
    /// The `usemtl` lines.
    pub(super) uses: Vec<Named>,
    /// The `mtllib` lines.
    pub(super) libraries: Vec<Named>,
    /// Offsets of faces of one or two corners.
    pub(super) short: Vec<usize>,
    /// Offsets of faces that give an attribute to some corners only.
    pub(super) mixed: Vec<usize>,
    /// Offsets of faces that name uvs or normals though the file has none of that kind.
    pub(super) absent: Vec<usize>,
    /// Whether the file has `vt` lines.
    pub(super) has_uvs: bool,
    /// Whether the file has `vn` lines.
    pub(super) has_normals: bool,
    /// Errors, at most [`MAX_ERRORS`].
    pub(super) errors: Vec<Diagnostic>,
}

/// The kinds of index in a corner token, in their order.
const KINDS: [&str; 3] = ["v", "vt", "vn"];

/// Indices of one corner: position, uv, normal; from 1.
type Corner = [Option<u64>; 3];

/// A reference beyond what the file had defined so far: an error if the file never does.
struct Forward {
    at: usize,
    kind: usize,
    index: u64,
}

struct Scanner<'a> {
    source: &'a str,
    scan: Scan,
    counts: [u64; 3],
    forward: Vec<Forward>,
    corners: Vec<Corner>,
}

impl Scan {
    /// Scans the text of an OBJ file.
    pub(super) fn of(source: &str) -> Scan {
        let mut scanner = Scanner {
            source,
            scan: Scan::default(),
            counts: [0; 3],
            forward: Vec::new(),
            corners: Vec::new(),
        };
        for line in Lines::of(source) {
            scanner.line(&line);
        }
        scanner.finish()
    }

    /// Whether any face has an attribute.
    pub(super) fn groups_with(&self, attribute: AttributeSet) -> bool {
        let has = |set: usize| set & usize::from(attribute) != 0;
        (0..self.groups.len()).any(|set| has(set) && !self.groups[set].is_empty())
    }
}

impl Scanner<'_> {
    fn line(&mut self, line: &Line<'_>) {
        match line.keyword {
            "v" => self.vertex(line, 0),
            "vt" => self.vertex(line, 1),
            "vn" => self.vertex(line, 2),
            "f" => self.face(line),
            "usemtl" => self.scan.uses.push(named(line)),
            "mtllib" => self.scan.libraries.push(named(line)),
            _ => {}
        }
    }

    /// Copies the numbers that count: of a `v` line three, or four where the fourth is the weight `w` (five or more are
    /// vertex colours); of `vt` two, the second being optional; of `vn` three.
    fn vertex(&mut self, line: &Line<'_>, kind: usize) {
        let mut numbers = [""; 5];
        let mut count = 0;
        for number in line.values().split_ascii_whitespace().take(numbers.len()) {
            numbers[count] = number;
            count += 1;
        }
        let (least, kept) = match (kind, count) {
            (0, 4) => (3, 4),
            (1, 1) => {
                numbers[1] = "0";
                count = 2;
                (2, 2)
            }
            (1, _) => (2, 2),
            _ => (3, 3),
        };
        self.counts[kind] += 1;
        if count < least {
            let says = format!("`{}` needs {least} numbers, not {count}", KINDS[kind]);
            self.error(codes::BAD_NUMBER, line.at, says);
            return;
        }
        let out = &mut self.scan.vertices;
        out.push_str(KINDS[kind]);
        for number in &numbers[..kept] {
            out.push(' ');
            out.push_str(number);
        }
        out.push('\n');
    }

    fn face(&mut self, line: &Line<'_>) {
        self.corners.clear();
        for token in line.values().split_ascii_whitespace() {
            match self.corner(line.at, token) {
                Ok(corner) => self.corners.push(corner),
                Err(says) => return self.error(codes::BAD_FACE, line.at, says),
            }
        }
        if self.corners.len() < 3 {
            self.scan.short.push(line.at);
            return;
        }
        let set = self.attributes(line.at);
        let Ok(corners) = u32::try_from(self.corners.len()) else {
            return self.error(
                codes::TOO_LARGE,
                line.at,
                "the face has too many corners".into(),
            );
        };
        self.scan.faces.push(Face {
            at: line.at,
            used: (self.scan.uses.len() as u32).checked_sub(1),
            corners,
            set,
        });
        let out = &mut self.scan.groups[usize::from(set)];
        out.push('f');
        for corner in &self.corners {
            push_corner(out, corner, set);
        }
        out.push('\n');
    }

    /// The attributes that all corners of the face have.
    fn attributes(&mut self, at: usize) -> AttributeSet {
        let given = |kind: usize| self.corners.iter().filter(|c| c[kind].is_some()).count();
        let (uvs, normals, all) = (given(1), given(2), self.corners.len());
        if (uvs != 0 && uvs != all) || (normals != 0 && normals != all) {
            self.scan.mixed.push(at);
        }
        let uv = if uvs == all { WITH_UV } else { 0 };
        let normal = if normals == all { WITH_NORMAL } else { 0 };
        uv | normal
    }

    fn corner(&mut self, at: usize, token: &str) -> Result<Corner, String> {
        let mut corner = [None; 3];
        for (kind, digits) in token.split('/').enumerate() {
            if kind >= KINDS.len() {
                return Err(format!("`{token}` has more than three indices"));
            }
            if !digits.is_empty() {
                corner[kind] = Some(self.index(at, kind, digits)?);
            }
        }
        if corner[0].is_none() {
            return Err(format!("`{token}` names no vertex"));
        }
        Ok(corner)
    }

    /// The absolute index, from 1, that an index of a face means; negative ones count from the last line so far.
    fn index(&mut self, at: usize, kind: usize, digits: &str) -> Result<u64, String> {
        let name = KINDS[kind];
        let index: i64 = digits
            .parse()
            .map_err(|_| format!("`{digits}` is not a `{name}` index"))?;
        let count = self.counts[kind];
        match u64::try_from(index) {
            Ok(0) => Err(format!("`{name}` indices start at 1, and this face uses 0")),
            Ok(index) => {
                if index > count {
                    self.forward.push(Forward { at, kind, index });
                }
                Ok(index)
            }
            Err(_) => (count + 1).checked_sub(index.unsigned_abs()).filter(|&i| i > 0).ok_or_else(|| {
                format!("`{name}` index {index} reaches before the first: only {count} stand above this face")
            }),
        }
    }

    fn error(&mut self, code: &'static str, at: usize, says: String) {
        if self.scan.errors.len() < MAX_ERRORS {
            let error = at_line(Diagnostic::error(code, says), self.source, at);
            self.scan.errors.push(error);
        }
    }

    /// Judges the references that had nothing to refer to when they stood there: one error or warning for each face.
    fn finish(mut self) -> Scan {
        let (mut wrong, mut absent) = (None, None);
        for Forward { at, kind, index } in std::mem::take(&mut self.forward) {
            let count = self.counts[kind];
            if index <= count {
                continue;
            }
            if kind > 0 && count == 0 {
                if absent.replace(at) != Some(at) {
                    self.scan.absent.push(at);
                }
            } else if wrong.replace(at) != Some(at) {
                let name = KINDS[kind];
                let says = format!("the face uses `{name}` {index}, but the file has {count}");
                self.error(codes::BAD_FACE, at, says);
            }
        }
        self.scan.has_uvs = self.counts[1] > 0;
        self.scan.has_normals = self.counts[2] > 0;
        self.scan
    }
}

fn named(line: &Line<'_>) -> Named {
    Named {
        at: line.at,
        name: line.rest.trim_end().to_owned(),
    }
}

/// Adds the place of the line that starts at byte `at`.
pub(super) fn at_line(diagnostic: Diagnostic, source: &str, at: usize) -> Diagnostic {
    let line = source.get(at..).and_then(|text| text.lines().next());
    diagnostic.at(source, at, line.map_or(1, |line| line.trim_end().len()))
}

fn push_corner(out: &mut String, corner: &Corner, set: AttributeSet) {
    let index = |kind: usize| corner[kind].unwrap_or_default();
    out.push(' ');
    push_decimal(out, index(0));
    if set != 0 {
        out.push('/');
    }
    if set & WITH_UV != 0 {
        push_decimal(out, index(1));
    }
    if set & WITH_NORMAL != 0 {
        out.push('/');
        push_decimal(out, index(2));
    }
}

/// Appends a number; `write!` would take a third of the whole scan.
fn push_decimal(out: &mut String, mut value: u64) {
    let mut digits = [0u8; 20];
    let mut first = digits.len();
    loop {
        first -= 1;
        digits[first] = b'0' + (value % 10) as u8;
        value /= 10;
        if value == 0 {
            break;
        }
    }
    out.extend(digits[first..].iter().map(|&digit| char::from(digit)));
}
