//! Scenes for the kernels, made without files or worlds, and a small random generator.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses its part")]

use luxel::build::bvh::{Accel, Primitives, SphereItem, build, sphere_blocks};
use luxel::flat::{
    Camera, FlatScene, Geometry, Instance, Lights, Needs, ObjectId, PixelFilter, Rebase, Shading,
    Spheres,
};
use luxel::math::{Aabb, DAffine3, DVec3, Vec3};
use std::sync::Arc;

/// SplitMix64.
pub struct Rng(pub u64);

impl Rng {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    pub fn in_cube(&mut self, half: f64) -> [f32; 3] {
        [(); 3].map(|()| self.range(-half, half) as f32)
    }

    /// Uniform on the unit sphere.
    pub fn direction(&mut self) -> [f32; 3] {
        loop {
            let v = DVec3::from([(); 3].map(|()| self.range(-1.0, 1.0)));
            let l = v.length();
            if l > 1e-3 && l <= 1.0 {
                return (v / l).as_vec3().to_array();
            }
        }
    }

    /// Magnitudes spread evenly over powers of ten, either sign.
    pub fn log(&mut self, low: f64, high: f64) -> f64 {
        let sign = if self.bits() & 1 == 0 { 1.0 } else { -1.0 };
        sign * 10f64.powf(self.range(low, high))
    }
}

/// A scene in the making.
#[derive(Default, Clone)]
pub struct Parts {
    pub triangles: Vec<[Vec3; 3]>,
    pub groups: Vec<std::ops::Range<u32>>,
    /// Spheres of the tree; their indices follow those of `looped`.
    pub tree_spheres: Vec<([f64; 3], f64)>,
    pub looped: Vec<([f64; 3], f64)>,
    pub meshes: Vec<Vec<[Vec3; 3]>>,
    /// (mesh, transform).
    pub instances: Vec<(usize, DAffine3)>,
}

impl Parts {
    pub fn of(triangles: Vec<[Vec3; 3]>) -> Parts {
        Parts {
            triangles,
            ..Parts::default()
        }
    }

    pub fn scene(&self, accel: Accel) -> FlatScene {
        let items = |from: &[([f64; 3], f64)], first: usize| -> Vec<SphereItem> {
            let item = |(i, &(center, radius)): (usize, &([f64; 3], f64))| SphereItem {
                center,
                radius,
                prim: (first + i) as u32,
            };
            from.iter().enumerate().map(item).collect()
        };
        let looped = items(&self.looped, 0);
        let in_tree = items(&self.tree_spheres, self.looped.len());
        let local: Vec<Arc<Geometry>> = self
            .meshes
            .iter()
            .map(|m| {
                let p = Primitives {
                    triangles: m,
                    ..Primitives::default()
                };
                let built = build(&p, accel);
                Arc::new(Geometry {
                    triangles: built.triangles,
                    bvh: built.bvh,
                    shading: Shading::default(),
                })
            })
            .collect();
        let instances: Vec<Instance> = self
            .instances
            .iter()
            .map(|&(mesh, m)| instance(mesh, m, &local[mesh].bvh.bounds))
            .collect();
        let boxes: Vec<Aabb> = instances
            .iter()
            .map(|i| Aabb {
                min: i.bounds[0].into(),
                max: i.bounds[1].into(),
            })
            .collect();
        let primitives = Primitives {
            triangles: &self.triangles,
            groups: &self.groups,
            spheres: &in_tree,
            instances: &boxes,
        };
        let built = build(&primitives, accel);
        let all: Vec<SphereItem> = looped.iter().chain(&in_tree).copied().collect();
        FlatScene {
            world: Geometry {
                triangles: built.triangles,
                bvh: built.bvh,
                shading: Shading::default(),
            },
            local,
            instances,
            spheres: Spheres {
                looped: sphere_blocks(&looped),
                blocks: built.sphere_blocks,
                center: all.iter().map(|s| s.center).collect(),
                radius: all.iter().map(|s| s.radius).collect(),
                ..Spheres::default()
            },
            ..empty_scene()
        }
    }
}

fn rows(m: DAffine3) -> [[f32; 4]; 3] {
    let (r, t) = (m.matrix3, m.translation);
    [0, 1, 2].map(|i| [r.x_axis[i], r.y_axis[i], r.z_axis[i], t[i]].map(|x| x as f32))
}

fn instance(mesh: usize, m: DAffine3, local: &Aabb) -> Instance {
    let mut bounds = Aabb::EMPTY;
    for corner in 0..8 {
        let pick = |axis: usize| {
            f64::from(if corner >> axis & 1 == 0 {
                local.min[axis]
            } else {
                local.max[axis]
            })
        };
        let p = m.transform_point3(DVec3::new(pick(0), pick(1), pick(2)));
        bounds = bounds.with(p.as_vec3());
    }
    let slack = (bounds.max - bounds.min).max_element()
        + bounds.max.abs().max(bounds.min.abs()).max_element();
    bounds.min -= 1e-5 * slack;
    bounds.max += 1e-5 * slack;
    Instance {
        to_world: rows(m),
        to_local: rows(m.inverse()),
        bounds: [bounds.min.to_array(), bounds.max.to_array()],
        geometry: mesh as u32,
        materials: 0,
        object: ObjectId(0),
        mirrored: m.matrix3.determinant() < 0.0,
    }
}

/// A scene without anything in it.
pub fn empty_scene() -> FlatScene {
    let nothing = build(&Primitives::default(), Accel::Bvh);
    FlatScene {
        world: Geometry {
            triangles: nothing.triangles,
            bvh: nothing.bvh,
            shading: Shading::default(),
        },
        local: Vec::new(),
        instances: Vec::new(),
        instance_materials: Vec::new(),
        spheres: Spheres::default(),
        materials: Vec::new(),
        textures: Vec::new(),
        lights: Lights::default(),
        background: [0.0; 3],
        camera: Camera {
            origin: [0.0; 3],
            right: [1.0, 0.0, 0.0],
            down: [0.0, -1.0, 0.0],
            forward: [0.0, 0.0, -1.0],
            pixel: 1.0,
            aperture_radius: 0.0,
            focus_distance: 1.0,
            width: 1,
            height: 1,
            filter: PixelFilter::Box,
        },
        rebase: Rebase {
            origin: [0.0; 3],
            scale: 1.0,
        },
        needs: Needs::default(),
        frame: 0,
    }
}

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
}
