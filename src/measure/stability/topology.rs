//! What is joined: edges that two triangles share, parts of meshes, and whether a part is closed.
//!
//! Vertices of an entity are the same if their coordinates are: that is what the kernels go by.

use crate::flat::{FlatScene, Geometry, Spheres};
use crate::math::{Aabb, DVec3, Vec3};
use crate::trace::{Hits, spawn};

/// The triangles of one geometry.
pub(super) struct Mesh {
    /// Pairs of triangles that share an edge, from either side.
    pub(super) edges: Vec<Edge>,
    /// The part that each triangle belongs to.
    pub(super) part: Vec<u32>,
    /// On which side of the triangles of a part the inside is: −1 against their normals, as usual, 1 along them; 0 where
    /// there is none, since the part has a hole or no volume.
    pub(super) inside: Vec<i8>,
}

/// An edge from corner `corner` of triangle `a` to the next one, which triangle `b` runs along backwards.
#[derive(Clone, Copy)]
pub(super) struct Edge {
    pub(super) a: u32,
    pub(super) corner: u8,
    pub(super) b: u32,
    /// Corner of `b` that is not on the edge.
    pub(super) opposite: u8,
}

/// The geometries of a scene: the world's, then the local ones.
pub(super) struct Topology {
    pub(super) world: Mesh,
    pub(super) local: Vec<Mesh>,
}

impl Topology {
    pub(super) fn of(scene: &FlatScene) -> Topology {
        Topology {
            world: Mesh::of(&scene.world),
            local: scene
                .local
                .iter()
                .map(|geometry| Mesh::of(geometry))
                .collect(),
        }
    }

    /// The mesh of an instance or of the world.
    pub(super) fn mesh(&self, scene: &FlatScene, instance: u32) -> &Mesh {
        match instance {
            Hits::WORLD => &self.world,
            i => &self.local[scene.instances[i as usize].geometry as usize],
        }
    }

    /// Edges, closed parts and open ones of the whole scene, spheres among the closed.
    pub(super) fn count(&self, scene: &FlatScene) -> [usize; 3] {
        let mut sum = [0, scene.spheres.placed.len(), 0];
        let placed = scene
            .instances
            .iter()
            .map(|i| &self.local[i.geometry as usize]);
        for mesh in placed.chain([&self.world]) {
            let open = mesh.inside.iter().filter(|side| **side == 0).count();
            sum[0] += mesh.edges.len();
            sum[1] += mesh.inside.len() - open;
            sum[2] += open;
        }
        sum
    }
}

/// Bits of a coordinate that are equal for equal numbers.
fn key(v: [f32; 3]) -> [u32; 3] {
    v.map(|x| (x + 0.0).to_bits())
}

/// One side of an edge: its ends in rising order, the triangle, its corner where the edge begins, and whether it runs
/// from the lower end to the higher.
type Side = ([u32; 2], u32, u8, bool);

impl Mesh {
    fn of(geometry: &Geometry) -> Mesh {
        let count = geometry.triangles.place.len();
        let corners: Vec<[[f32; 3]; 3]> = (0..count as u32)
            .map(|prim| spawn::triangle_vertices(&geometry.triangles, prim))
            .collect();
        let object = |prim: usize| geometry.shading.object.get(prim).map_or(0, |o| o.0);
        let vertex = weld(&corners, object);
        let mut sides: Vec<Side> = Vec::with_capacity(3 * count);
        for (prim, ids) in vertex.iter().enumerate() {
            for k in 0..3u8 {
                let [from, to] = [ids[k as usize], ids[(k as usize + 1) % 3]];
                if from != to {
                    let ends = [from.min(to), from.max(to)];
                    sides.push((ends, prim as u32, k, from < to));
                }
            }
        }
        sides.sort_unstable();
        let mut parts = Parts((0..count as u32).collect());
        let (mut edges, mut torn) = (Vec::new(), Vec::new());
        for same in sides.chunk_by(|a, b| a.0 == b.0) {
            for pair in same.windows(2) {
                parts.join(pair[0].1, pair[1].1);
            }
            match *same {
                [(_, a, corner, up), (_, b, other, down)] if up != down => edges.push(Edge {
                    a,
                    corner,
                    b,
                    opposite: (other + 2) % 3,
                }),
                _ => {
                    let rising = same.iter().filter(|side| side.3).count();
                    if 2 * rising != same.len() {
                        torn.push(same[0].1);
                    }
                }
            }
        }
        let (part, count) = parts.numbered();
        let inside = sides_of(&corners, &part, count, &torn);
        Mesh {
            edges,
            part,
            inside,
        }
    }

    /// The boxes of the parts, in the geometry's own space.
    pub(super) fn boxes(&self, geometry: &Geometry) -> Vec<Aabb> {
        let mut boxes = vec![Aabb::EMPTY; self.inside.len()];
        for (prim, part) in self.part.iter().enumerate() {
            let vertices = spawn::triangle_vertices(&geometry.triangles, prim as u32);
            for v in vertices {
                boxes[*part as usize] = boxes[*part as usize].with(Vec3::from(v));
            }
        }
        boxes
    }
}

/// A number for every vertex, the same for the same coordinates in the same object.
fn weld(corners: &[[[f32; 3]; 3]], object: impl Fn(usize) -> u32) -> Vec<[u32; 3]> {
    let mut keys: Vec<([u32; 3], u32, u32)> = corners
        .iter()
        .flatten()
        .zip(0..)
        .map(|(v, at)| (key(*v), object(at as usize / 3), at))
        .collect();
    keys.sort_unstable();
    let mut ids = vec![[0; 3]; corners.len()];
    for (id, same) in (0..).zip(keys.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1))) {
        for (_, _, at) in same {
            ids[*at as usize / 3][*at as usize % 3] = id;
        }
    }
    ids
}

/// By the signed volume of every part; 0 for those in `torn`.
fn sides_of(corners: &[[[f32; 3]; 3]], part: &[u32], count: usize, torn: &[u32]) -> Vec<i8> {
    let mut volume = vec![0.0; count];
    let mut origin = vec![None; count];
    for (v, part) in corners.iter().zip(part) {
        let [a, b, c] = v.map(|v| Vec3::from(v).as_dvec3());
        // From a point of the part: far from 0 the sum would cancel.
        let o: DVec3 = *origin[*part as usize].get_or_insert(a);
        volume[*part as usize] += (a - o).dot((b - o).cross(c - o));
    }
    let mut inside: Vec<i8> = volume
        .iter()
        .map(|v: &f64| match v.total_cmp(&0.0) {
            _ if *v == 0.0 => 0,
            std::cmp::Ordering::Greater => -1,
            _ => 1,
        })
        .collect();
    for prim in torn {
        inside[part[*prim as usize] as usize] = 0;
    }
    inside
}

/// Disjoint sets of triangles.
struct Parts(Vec<u32>);

impl Parts {
    fn find(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            let above = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = above;
            i = above;
        }
        i
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b) as usize] = a.min(b);
    }

    /// The number of each one's set, counted from 0, and how many there are.
    fn numbered(mut self) -> (Vec<u32>, usize) {
        let mut numbers = vec![u32::MAX; self.0.len()];
        let mut count = 0;
        let part = (0..self.0.len() as u32).map(|i| {
            let root = self.find(i) as usize;
            if numbers[root] == u32::MAX {
                numbers[root] = count;
                count += 1;
            }
            numbers[root]
        });
        let part = part.collect();
        (part, count as usize)
    }
}

/// The sphere that a primitive is.
pub(super) fn sphere(prim: u32) -> Option<usize> {
    (prim & Spheres::TAG != 0 && prim != Hits::NONE).then_some((prim & !Spheres::TAG) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::bvh::{Accel, Primitives, build};
    use crate::flat::Shading;

    fn mesh(triangles: &[[Vec3; 3]]) -> Mesh {
        let primitives = Primitives {
            triangles,
            ..Primitives::default()
        };
        let built = build(&primitives, Accel::Bvh);
        Mesh::of(&Geometry {
            triangles: built.triangles,
            bvh: built.bvh,
            shading: Shading::default(),
        })
    }

    fn tetrahedron(at: f32, inverted: bool) -> Vec<[Vec3; 3]> {
        let p = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z].map(|p| p + at);
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        faces
            .map(|[a, b, c]| if inverted { [a, c, b] } else { [a, b, c] })
            .map(|face| face.map(|i: usize| p[i]))
            .to_vec()
    }

    #[test]
    fn parts_are_told_apart_and_know_their_inside() {
        let mut all = tetrahedron(0.0, false);
        all.extend(tetrahedron(5.0, true));
        all.extend(&tetrahedron(9.0, false)[..3]);
        let found = mesh(&all);
        assert_eq!(found.part, [0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2]);
        assert_eq!(found.inside, [-1, 1, 0]);
        assert_eq!(found.edges.len(), 6 + 6 + 3);
        for edge in &found.edges {
            let [a, b] = [edge.a, edge.b].map(|i| all[i as usize].map(|v| key(v.to_array())));
            let apart = b[edge.opposite as usize];
            assert!(!a.contains(&apart), "the other end of the edge's neighbour");
        }
    }

    #[test]
    fn a_turned_triangle_is_a_hole() {
        let mut all = tetrahedron(0.0, false);
        all[2].swap(1, 2);
        assert_eq!(mesh(&all).inside, [0]);
    }
}
