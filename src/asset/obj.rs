//! OBJ text to a [`Mesh`]: the scan's clean text through `tobj`, then triangles in file order.
//!
//! Enters: the text of a file and its materials by `usemtl` line. Leaves: a mesh whose every corner has the uv and the
//! normal that its own token names. Deliberately absent: curves, points, lines, vertex colours, smoothing groups.

use super::scan::{Face, Scan, WITH_NORMAL, WITH_UV, at_line};
use super::text::{Line, Lines};
use super::triangulate::{self, Trouble};
use super::{Mesh, codes};
use crate::diag::Diagnostic;
use crate::math::{DVec2, DVec3};
use tobj::LoadError;

/// Coordinates beyond this are refused: products of three of them, as in volumes, would overflow.
pub(super) const MAX_COORDINATE: f64 = 1e100;

/// Triangles without area, faces with bad attributes: how many, and the offset of the first one's line.
#[derive(Clone, Copy, Default)]
struct Tally {
    count: usize,
    first: usize,
}

impl Tally {
    fn add(&mut self, at: usize) {
        if self.count == 0 {
            self.first = at;
        }
        self.count += 1;
    }

    fn of(places: &[usize]) -> Tally {
        Tally {
            count: places.len(),
            first: places.first().copied().unwrap_or_default(),
        }
    }
}

/// Builds the triangles of a scanned file. `materials` gives the index into [`Mesh::materials`] of each `usemtl` line.
/// Appends warnings.
///
/// # Errors
/// A number, index or vertex that cannot be used, with its line.
pub(super) fn triangles(
    source: &str,
    scan: &Scan,
    materials: &[Option<u32>],
    warnings: &mut Vec<Diagnostic>,
) -> Result<Mesh, Diagnostic> {
    let mut builder = Builder::new(source, scan, parse(scan)?);
    for face in &scan.faces {
        let material = face.used.and_then(|used| materials[used as usize]);
        builder.face(face, material)?;
    }
    warnings.extend(builder.warnings(scan));
    let mesh = builder.mesh;
    if mesh.corners.is_empty() {
        return Err(Diagnostic::error(
            codes::NO_FACES,
            "no face of the file has an area",
        ));
    }
    Ok(mesh)
}

/// The groups of faces, as the parser reads them.
fn parse(scan: &Scan) -> Result<[tobj::Mesh; 4], Diagnostic> {
    let models = match read(&scan.vertices, &scan.groups) {
        Err(
            LoadError::PositionParseError
            | LoadError::ScalingByZeroError
            | LoadError::TexcoordParseError
            | LoadError::NormalParseError,
        ) => read(&readable(&scan.vertices), &scan.groups),
        read => read,
    };
    let models = models.map_err(|error| {
        Diagnostic::error(codes::PARSER, format!("the OBJ parser says: {error}"))
    })?;
    let mut groups: [tobj::Mesh; 4] = Default::default();
    for model in models {
        match model.name.parse::<usize>() {
            Ok(set @ 0..=3) => groups[set] = model.mesh,
            _ => return Err(unexpected()),
        }
    }
    Ok(groups)
}

/// Has the parser read clean text; each group of faces becomes a model, named by its number.
fn read(vertices: &str, groups: &[String; 4]) -> Result<Vec<tobj::Model>, LoadError> {
    let mut faces = String::with_capacity(groups.iter().fold(64, |sum, group| sum + group.len()));
    for (set, group) in groups
        .iter()
        .enumerate()
        .filter(|(_, group)| !group.is_empty())
    {
        faces.push_str(["g 0\n", "g 1\n", "g 2\n", "g 3\n"][set]);
        faces.push_str(group);
    }
    let options = tobj::LoadOptions {
        single_index: false,
        triangulate: false,
        ignore_points: true,
        ignore_lines: true,
    };
    let mut text = std::io::Read::chain(vertices.as_bytes(), faces.as_bytes());
    let no_materials = |_: &std::path::Path| Ok(Default::default());
    tobj::load_obj_buf(&mut text, &options, no_materials).map(|(models, _)| models)
}

/// Vertex lines with NaN for every number that cannot be read: it matters only if a face uses it.
fn readable(vertices: &str) -> String {
    let mut text = String::with_capacity(vertices.len());
    for line in vertices.lines() {
        for (i, word) in line.split(' ').enumerate() {
            let bad_weight = i == 4 && word.parse() == Ok(0.0);
            let bad = i > 0 && (bad_weight || word.parse::<f64>().is_err());
            text.push_str(if i == 0 { "" } else { " " });
            text.push_str(if bad { "nan" } else { word });
        }
        text.push('\n');
    }
    text
}

fn unexpected() -> Diagnostic {
    Diagnostic::error(
        codes::PARSER,
        "the OBJ parser gave other faces than the file has",
    )
}

/// Walks the faces in file order and the groups in step.
struct Builder<'a> {
    source: &'a str,
    groups: [tobj::Mesh; 4],
    /// Corners of each group that are done.
    done: [usize; 4],
    /// Index in `mesh.positions` of the first position of each group.
    base: [u32; 4],
    mesh: Mesh,
    any_uv: bool,
    any_normal: bool,
    zero_area: Tally,
    bad_uv: Tally,
    bad_normal: Tally,
    tangled: Tally,
    points: Vec<DVec3>,
    triangles: Vec<[usize; 3]>,
}

impl<'a> Builder<'a> {
    fn new(source: &'a str, scan: &Scan, groups: [tobj::Mesh; 4]) -> Builder<'a> {
        let mut mesh = Mesh::default();
        let base = [0, 1, 2, 3].map(|set: usize| {
            let base = mesh.positions.len() as u32;
            let (points, _) = groups[set].positions.as_chunks::<3>();
            mesh.positions
                .extend(points.iter().map(|&p| DVec3::from_array(p)));
            base
        });
        Builder {
            source,
            any_uv: scan.has_uvs && scan.groups_with(WITH_UV),
            any_normal: scan.has_normals && scan.groups_with(WITH_NORMAL),
            groups,
            done: [0; 4],
            base,
            mesh,
            zero_area: Tally::default(),
            bad_uv: Tally::default(),
            bad_normal: Tally::default(),
            tangled: Tally::default(),
            points: Vec::new(),
            triangles: Vec::new(),
        }
    }

    fn face(&mut self, face: &Face, material: Option<u32>) -> Result<(), Diagnostic> {
        let set = usize::from(face.set);
        let first = self.done[set];
        let corners = first..first + face.corners as usize;
        self.done[set] = corners.end;
        let indices = self.groups[set]
            .indices
            .get(corners)
            .ok_or_else(unexpected)?;
        self.points.clear();
        for &index in indices {
            let position = self.mesh.positions[(self.base[set] + index) as usize];
            if !position.is_finite() || position.abs().max_element() > MAX_COORDINATE {
                return Err(bad_vertex(self.source, face, self.points.len(), position));
            }
            self.points.push(position);
        }
        self.triangles.clear();
        match triangulate::triangulate(&self.points, &mut self.triangles) {
            Ok(()) => {}
            Err(Trouble::Tangled) => self.tangled.add(face.at),
            Err(Trouble::TooLarge) => return Err(self.too_many_corners(face)),
        }
        for t in 0..self.triangles.len() {
            let triangle = self.triangles[t];
            if has_area(triangle.map(|k| self.points[k])) {
                self.triangle(face, triangle.map(|k| first + k), material)?;
            } else {
                self.zero_area.add(face.at);
            }
        }
        Ok(())
    }

    /// Adds a triangle of three corners of the face's group.
    fn triangle(
        &mut self,
        face: &Face,
        corners: [usize; 3],
        material: Option<u32>,
    ) -> Result<(), Diagnostic> {
        let set = usize::from(face.set);
        for corner in corners {
            let index = self.base[set] + self.groups[set].indices[corner];
            self.mesh.corners.push(index);
            if self.any_uv {
                let uv = self.uv(face, corner)?;
                self.mesh.uvs.push(uv);
            }
            if self.any_normal {
                let normal = self.normal(face, corner)?;
                self.mesh.normals.push(normal);
            }
        }
        self.mesh.material.push(material);
        Ok(())
    }

    fn uv(&mut self, face: &Face, corner: usize) -> Result<Option<DVec2>, Diagnostic> {
        if face.set & WITH_UV == 0 {
            return Ok(None);
        }
        let group = &self.groups[usize::from(face.set)];
        let (uvs, _) = group.texcoords.as_chunks::<2>();
        let index = group.texcoord_indices.get(corner);
        let uv = index
            .and_then(|&i| uvs.get(i as usize))
            .ok_or_else(unexpected)?;
        let uv = DVec2::from_array(*uv);
        if !uv.is_finite() {
            self.bad_uv.add(face.at);
            return Ok(None);
        }
        Ok(Some(uv))
    }

    fn normal(&mut self, face: &Face, corner: usize) -> Result<Option<DVec3>, Diagnostic> {
        if face.set & WITH_NORMAL == 0 {
            return Ok(None);
        }
        let group = &self.groups[usize::from(face.set)];
        let (normals, _) = group.normals.as_chunks::<3>();
        let index = group.normal_indices.get(corner);
        let normal = index
            .and_then(|&i| normals.get(i as usize))
            .ok_or_else(unexpected)?;
        let unit = super::normals::unit(DVec3::from_array(*normal));
        if unit.is_none() {
            self.bad_normal.add(face.at);
        }
        Ok(unit)
    }

    fn too_many_corners(&self, face: &Face) -> Diagnostic {
        let says = format!(
            "a concave face of {} corners: at most {} can be triangulated",
            face.corners,
            triangulate::MAX_CONCAVE_CORNERS
        );
        at_line(
            Diagnostic::error(codes::TOO_LARGE, says),
            self.source,
            face.at,
        )
    }

    fn warnings(&self, scan: &Scan) -> Vec<Diagnostic> {
        let told = [
            (
                codes::SHORT_FACE,
                Tally::of(&scan.short),
                "faces of fewer than three corners are skipped",
            ),
            (
                codes::MIXED_FACE,
                Tally::of(&scan.mixed),
                "faces give a uv or normal to some corners only, which is ignored",
            ),
            (
                codes::ABSENT,
                Tally::of(&scan.absent),
                "faces name uvs or normals, and the file has none",
            ),
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
        ];
        told.into_iter()
            .filter(|(_, tally, _)| tally.count > 0)
            .map(|(code, tally, says)| {
                let says = format!("{} {says}; the first is here", tally.count);
                at_line(Diagnostic::warning(code, says), self.source, tally.first)
            })
            .collect()
    }
}

/// Whether the triangle has an area: its edges, each scaled to size 1 so that nothing underflows, are not parallel.
pub(super) fn has_area([a, b, c]: [DVec3; 3]) -> bool {
    let scaled = |edge: DVec3| edge / edge.abs().max_element();
    let cross = scaled(b - a).cross(scaled(c - a));
    cross.abs().max_element() > 0.0 && b != c
}

/// The error for corner `corner` of a face, whose position cannot be used.
fn bad_vertex(source: &str, face: &Face, corner: usize, position: DVec3) -> Diagnostic {
    let line = vertex_line(source, face, corner);
    let unreadable = line.as_ref().and_then(|line| {
        let mut words = line.values().split_ascii_whitespace();
        words
            .find(|word| word.parse::<f64>().is_err())
            .map(str::to_owned)
    });
    let says = match unreadable {
        Some(word) => format!("`{word}` is not a number"),
        None if position.is_finite() => "the vertex is beyond 1e100".to_owned(),
        None => "the vertex is not finite".to_owned(),
    };
    let line_of_face = source[..face.at].matches('\n').count() + 1;
    let says = format!("{says}, and the face in line {line_of_face} uses it");
    let at = line.map_or(face.at, |line| line.at);
    at_line(Diagnostic::error(codes::BAD_VERTEX, says), source, at)
}

/// The `v` line that a corner of a face names.
fn vertex_line<'a>(source: &'a str, face: &Face, corner: usize) -> Option<Line<'a>> {
    let line = Lines::of(source).find(|line| line.at == face.at)?;
    let token = line.values().split_ascii_whitespace().nth(corner)?;
    let index: i64 = token.split('/').next()?.parse().ok()?;
    let vertices = || Lines::of(source).filter(|line| line.keyword == "v");
    let index = match usize::try_from(index) {
        Ok(index) => index.checked_sub(1)?,
        Err(_) => {
            let before = vertices().take_while(|line| line.at < face.at).count();
            before.checked_add_signed(isize::try_from(index).ok()?)?
        }
    };
    vertices().nth(index)
}

/// Scans a file; errors of all its lines at once, or that it has no faces.
pub(super) fn scan(source: &str) -> Result<Scan, Vec<Diagnostic>> {
    let mut scan = Scan::of(source);
    if !scan.errors.is_empty() {
        return Err(std::mem::take(&mut scan.errors));
    }
    if scan.faces.is_empty() {
        return Err(vec![Diagnostic::error(
            codes::NO_FACES,
            "the file has no faces",
        )]);
    }
    Ok(scan)
}
