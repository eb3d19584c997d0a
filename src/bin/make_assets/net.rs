//! Surface nets: an implicit surface to a closed quad mesh, relaxed until its quads are well shaped, then triangles.
//!
//! Enters: the [`Cat`] and a cell size. Leaves: positions and outward triangles. Source: S. Gibson, "Constrained
//! Elastic SurfaceNets", 1998: one vertex in every grid cell that the surface crosses, at the mean of the crossings of
//! its edges; one quad around every grid edge that the surface crosses. No table of cases.

use crate::shape::{BOUNDS, Cat};
use luxel::math::DVec3;
use std::collections::BTreeMap;

/// Rounds of moving each vertex towards the mean of its neighbours and back onto the surface.
const RELAX_ROUNDS: usize = 12;
/// How far of the way to that mean.
const RELAX_STEP: f64 = 0.6;
/// Triangles per (unit length / cell)²: twice the mean number of cells that a unit of the cat's surface crosses times
/// its area; measured on this cat.
const TRIANGLES_PER_CELL_AREA: f64 = 6.6;

/// Cells of the head, where the detail is, are smaller than those of the body by this factor, ...
const HEAD_CELL: f64 = 0.66;
/// ... above this height, with a transition of this length around it; the head's axis is at this z.
const NECK: f64 = 0.62;
const NECK_LENGTH: f64 = 0.12;
const HEAD_Z: f64 = 0.08;
/// Fewer could not show the ears.
const FEWEST_TRIANGLES: usize = 1000;
/// Where two sheets of the surface cross one cell, their quads share an edge. That depends on how the grid happens to
/// lie: cell sizes tried before giving up, and how much smaller each is.
const TRIES: u32 = 16;
const TRY_STEP: f64 = 0.004;

/// Triangles with shared vertices.
pub(crate) struct Mesh {
    pub(crate) positions: Vec<DVec3>,
    /// Counter-clockwise seen from outside.
    pub(crate) triangles: Vec<[usize; 3]>,
}

/// The cat with about the given number of triangles, closed; `None` if no cell size tried gives a closed mesh.
pub(crate) fn mesh(cat: &Cat, triangles: usize) -> Option<Mesh> {
    let cell = (TRIANGLES_PER_CELL_AREA / triangles.max(FEWEST_TRIANGLES) as f64).sqrt();
    let (mut positions, quads) = (0..TRIES)
        .map(|k| Grid::sample(cat, cell * (1.0 - TRY_STEP * f64::from(k))).nets())
        .find(|(_, quads)| is_closed(quads))?;
    let neighbours = neighbours(positions.len(), &quads);
    for _ in 0..RELAX_ROUNDS {
        let means: Vec<DVec3> = neighbours
            .iter()
            .map(|near| near.iter().map(|&i| positions[i]).sum::<DVec3>() / near.len() as f64)
            .collect();
        for (p, mean) in positions.iter_mut().zip(means) {
            *p = cat.project(*p + (mean - *p) * RELAX_STEP, 1);
        }
    }
    for p in &mut positions {
        *p = cat.project(*p, 3);
    }
    stand_on_ground(&mut positions);
    let triangles = quads.iter().flat_map(|&q| split(&positions, q)).collect();
    Some(Mesh {
        positions,
        triangles,
    })
}

/// Values of the field at grid points.
struct Grid {
    origin: DVec3,
    cell: f64,
    /// Points along x, y, z.
    size: [usize; 3],
    /// x fastest.
    values: Vec<f64>,
}

impl Grid {
    fn sample(cat: &Cat, cell: f64) -> Grid {
        let (lo, hi) = (
            BOUNDS.0,
            BOUNDS.1.with_y(NECK + (BOUNDS.1.y - NECK) / HEAD_CELL),
        );
        let size = ((hi - lo) / cell).to_array().map(|n| n as usize + 2);
        let mut grid = Grid {
            origin: lo,
            cell,
            size,
            values: Vec::with_capacity(size.iter().product()),
        };
        for z in 0..size[2] {
            for y in 0..size[1] {
                for x in 0..size[0] {
                    grid.values.push(cat.value(grid.point([x, y, z])));
                }
            }
        }
        grid
    }

    fn point(&self, at: [usize; 3]) -> DVec3 {
        unwarp(self.origin + DVec3::from_array(at.map(|i| i as f64)) * self.cell)
    }

    fn index(&self, at: [usize; 3]) -> usize {
        (at[2] * self.size[1] + at[1]) * self.size[0] + at[0]
    }

    /// Vertices of crossed cells and quads around crossed edges.
    fn nets(&self) -> (Vec<DVec3>, Vec<[usize; 4]>) {
        let mut vertices = BTreeMap::new();
        let mut positions = Vec::new();
        let mut quads = Vec::new();
        for z in 1..self.size[2] - 1 {
            for y in 1..self.size[1] - 1 {
                for x in 1..self.size[0] - 1 {
                    for axis in 0..3 {
                        let Some(mut cells) = self.cells_around([x, y, z], axis) else {
                            continue;
                        };
                        for cell in &mut cells {
                            let at = *cell;
                            *cell = [*vertices.entry(self.index(at)).or_insert_with(|| {
                                positions.push(self.crossing_mean(at));
                                positions.len() - 1
                            }); 3];
                        }
                        quads.push(cells.map(|c| c[0]));
                    }
                }
            }
        }
        (positions, quads)
    }

    /// The four cells around the edge from a point along an axis, counter-clockwise from outside, if it is crossed.
    fn cells_around(&self, at: [usize; 3], axis: usize) -> Option<[[usize; 3]; 4]> {
        let mut end = at;
        end[axis] += 1;
        let inside = [at, end].map(|p| self.values[self.index(p)] < 0.0);
        if inside[0] == inside[1] {
            return None;
        }
        let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut cells = [at; 4];
        cells[1][b] -= 1;
        cells[2][b] -= 1;
        cells[2][c] -= 1;
        cells[3][c] -= 1;
        if inside[1] {
            cells.reverse();
        }
        Some(cells)
    }

    /// Mean of the crossings of the twelve edges of a cell.
    fn crossing_mean(&self, cell: [usize; 3]) -> DVec3 {
        let mut sum = DVec3::ZERO;
        let mut count = 0.0;
        for corner in 0..8 {
            let a = [0, 1, 2].map(|k| cell[k] + (corner >> k & 1));
            for axis in (0..3).filter(|k| corner >> k & 1 == 0) {
                let mut b = a;
                b[axis] += 1;
                let (fa, fb) = (self.values[self.index(a)], self.values[self.index(b)]);
                if (fa < 0.0) != (fb < 0.0) {
                    sum += self.point(a).lerp(self.point(b), fa / (fa - fb));
                    count += 1.0;
                }
            }
        }
        sum / count
    }
}

/// Whether every side of a quad is a side of exactly one other quad, the other way round.
fn is_closed(quads: &[[usize; 4]]) -> bool {
    let mut sides: Vec<(usize, usize)> = quads
        .iter()
        .flat_map(|q| [0, 1, 2, 3].map(|k| (q[k], q[(k + 1) % 4])))
        .collect();
    sides.sort_unstable();
    sides.windows(2).all(|w| w[0] != w[1])
        && sides
            .iter()
            .all(|&(a, b)| sides.binary_search(&(b, a)).is_ok())
}

/// From the space in which the grid is regular, where the head is enlarged, to the cat's.
fn unwarp(p: DVec3) -> DVec3 {
    let t = ((p.y - NECK) / NECK_LENGTH + 0.5).clamp(0.0, 1.0);
    let shrink = 1.0 + (HEAD_CELL - 1.0) * t;
    let y = p.y.min(NECK) + (p.y - NECK).max(0.0) * HEAD_CELL;
    DVec3::new(p.x * shrink, y, HEAD_Z + (p.z - HEAD_Z) * shrink)
}

/// Vertices joined to each vertex by a side of a quad.
fn neighbours(vertices: usize, quads: &[[usize; 4]]) -> Vec<Vec<usize>> {
    let mut near = vec![Vec::new(); vertices];
    for quad in quads {
        for k in 0..4 {
            near[quad[k]].push(quad[(k + 1) % 4]);
        }
    }
    near
}

/// Along the shorter diagonal.
fn split(positions: &[DVec3], [a, b, c, d]: [usize; 4]) -> [[usize; 3]; 2] {
    let (ac, bd) = (
        positions[a].distance_squared(positions[c]),
        positions[b].distance_squared(positions[d]),
    );
    if ac <= bd {
        [[a, b, c], [a, c, d]]
    } else {
        [[a, b, d], [b, c, d]]
    }
}

/// Shifts the mesh so that its lowest vertex is at y = 0.
fn stand_on_ground(positions: &mut [DVec3]) {
    let lowest = positions.iter().fold(f64::INFINITY, |low, p| low.min(p.y));
    for p in positions {
        p.y -= lowest;
    }
}
