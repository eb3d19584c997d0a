//! Where things stand in an OBJ file, found again by reading its lines once more: only what is told needs a place, and
//! remembering the line of every face would cost more than all its corners.

use super::text::{Line, Lines};

/// Byte offset of the line of the face that gave a triangle, by its number in a file whose every line could be read.
pub(super) fn line_of_triangle(source: &str, triangle: usize) -> usize {
    let mut triangles = 0;
    let faces = Lines::of(source).filter(|line| line.keyword == "f");
    let mut faces = faces.filter(|line| {
        let corners = line.values().split_ascii_whitespace().count();
        triangles += corners.saturating_sub(2);
        triangles > triangle
    });
    faces.next().map_or(0, |line| line.at)
}

/// The line of a vertex, by its number.
pub(super) fn line_of_vertex(source: &str, vertex: usize) -> Option<Line<'_>> {
    let mut vertices = Lines::of(source).filter(|line| line.keyword == "v");
    vertices.nth(vertex)
}
