//! Closed meshes.

use super::Rng;
use luxel::math::{DVec3, Vec3};

/// A closed mesh with shared vertices.
#[derive(Clone)]
pub struct Solid {
    pub vertices: Vec<Vec3>,
    pub faces: Vec<[usize; 3]>,
}

impl Solid {
    pub fn triangles(&self) -> Vec<[Vec3; 3]> {
        self.faces
            .iter()
            .map(|f| f.map(|i| self.vertices[i]))
            .collect()
    }

    /// A sphere in `n` rows of `m` columns; the poles have valence `m`.
    pub fn uv_sphere(n: usize, m: usize) -> Solid {
        let pi = std::f64::consts::PI;
        let mut vertices = vec![Vec3::Y];
        for i in 1..n {
            let theta = pi * i as f64 / n as f64;
            for j in 0..m {
                let phi = 2.0 * pi * j as f64 / m as f64;
                let p = DVec3::new(
                    theta.sin() * phi.cos(),
                    theta.cos(),
                    theta.sin() * phi.sin(),
                );
                vertices.push(p.as_vec3());
            }
        }
        vertices.push(-Vec3::Y);
        let at = |i: usize, j: usize| match i {
            0 => 0,
            i if i == n => 1 + (n - 1) * m,
            i => 1 + (i - 1) * m + j % m,
        };
        let mut faces = Vec::new();
        for i in 0..n {
            for j in 0..m {
                let quad = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
                if i > 0 {
                    faces.push([quad[0], quad[1], quad[2]]);
                }
                if i + 1 < n {
                    faces.push([quad[0], quad[2], quad[3]]);
                }
            }
        }
        Solid { vertices, faces }
    }

    /// An icosahedron subdivided `levels` times.
    pub fn icosphere(levels: u32) -> Solid {
        let g = (1.0 + 5f64.sqrt()) / 2.0;
        let mut points: Vec<DVec3> = Vec::new();
        for (a, b) in [(1.0, g), (-1.0, g), (1.0, -g), (-1.0, -g)] {
            points.push(DVec3::new(0.0, a, b).normalize());
            points.push(DVec3::new(a, b, 0.0).normalize());
            points.push(DVec3::new(b, 0.0, a).normalize());
        }
        let side = points[1..]
            .iter()
            .map(|p| p.distance(points[0]))
            .fold(f64::INFINITY, f64::min);
        let near = |a: usize, b: usize| points[a].distance(points[b]) < side * 1.01;
        let mut faces = Vec::new();
        for a in 0..12 {
            for b in a + 1..12 {
                for c in b + 1..12 {
                    if near(a, b) && near(b, c) && near(a, c) {
                        faces.push([a, b, c]);
                    }
                }
            }
        }
        for _ in 0..levels {
            let mut middles = std::collections::BTreeMap::new();
            let mut next = Vec::new();
            for f in &faces {
                let mut middle = |a: usize, b: usize| {
                    *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                        points.push((points[a] + points[b]).normalize());
                        points.len() - 1
                    })
                };
                let [x, y, z] = [middle(f[0], f[1]), middle(f[1], f[2]), middle(f[2], f[0])];
                next.extend([[f[0], x, z], [x, f[1], y], [z, y, f[2]], [x, y, z]]);
            }
            faces = next;
        }
        Solid {
            vertices: points.iter().map(|p| p.as_vec3()).collect(),
            faces,
        }
    }

    /// A tube of radius 0.3 around the unit circle of the plane y = 0, `n` sides in `m` segments.
    pub fn torus(n: usize, m: usize) -> Solid {
        let turn = std::f64::consts::TAU;
        let mut vertices = Vec::new();
        for j in 0..m {
            let phi = turn * j as f64 / m as f64;
            let out = DVec3::new(phi.cos(), 0.0, phi.sin());
            for i in 0..n {
                let theta = turn * i as f64 / n as f64;
                let side = out * theta.cos() + DVec3::Y * theta.sin();
                vertices.push((out + 0.3 * side).as_vec3());
            }
        }
        let at = |i: usize, j: usize| j % m * n + i % n;
        let mut faces = Vec::new();
        for j in 0..m {
            for i in 0..n {
                let quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                faces.push([quad[0], quad[1], quad[2]]);
                faces.push([quad[0], quad[2], quad[3]]);
            }
        }
        Solid { vertices, faces }
    }

    /// An icosphere whose vertices are anywhere between 1 and 6 away from the middle.
    pub fn star(levels: u32, rng: &mut Rng) -> Solid {
        let mut star = Solid::icosphere(levels);
        for v in &mut star.vertices {
            *v *= rng.range(1.0, 6.0) as f32;
        }
        star
    }

    /// As large by `size`, then moved, then rounded to f32 once more: still closed, since vertices are shared.
    pub fn placed(&self, size: f32, offset: Vec3) -> Solid {
        Solid {
            vertices: self.vertices.iter().map(|v| *v * size + offset).collect(),
            faces: self.faces.clone(),
        }
    }
}
