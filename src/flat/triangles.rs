//! Triangles in lane blocks, in leaf order.

use super::BLOCK;

/// Eight triangles, coordinate by coordinate.
///
/// Vertices, not precomputed edges, since the watertight test wants them: two triangles that share an edge must see
/// the same bits of its ends.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct TriangleBlock {
    /// `v[vertex][axis][lane]`, scene units or local units of the mesh. Unused lanes hold NaN,
    /// which no ray hits.
    pub v: [[[f32; BLOCK]; 3]; 3],
    /// Primitive index of each lane: the triangle's index in authoring order in its geometry. `u32::MAX` in unused
    /// lanes.
    pub prim: [u32; BLOCK],
}

/// Triangles of one geometry.
#[derive(Clone, Debug, Default)]
pub struct Triangles {
    /// In leaf order: a leaf is a run of whole blocks.
    pub blocks: Vec<TriangleBlock>,
    /// `8 * block + lane` of each primitive; indexed by primitive. Length: number of triangles.
    pub place: Vec<u32>,
}
