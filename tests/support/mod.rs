//! Scenes for the kernels, made without files or worlds, and a small random generator.
#![allow(
    dead_code,
    unreachable_pub,
    unused_imports,
    reason = "each test binary uses its part"
)]

pub mod exact;
pub mod leave;
pub mod shoot;
pub mod solid;

pub use solid::Solid;

use luxel::build::bvh::{Accel, Primitives, Quality, SphereItem, build, build_with, sphere_blocks};
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
        self.scene_by(accel, Quality::Good)
    }

    /// With trees of that quality.
    pub fn scene_by(&self, accel: Accel, quality: Quality) -> FlatScene {
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
                let built = build_with(&p, accel, quality);
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
        let built = build_with(&primitives, accel, quality);
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
                placed: all.iter().map(SphereItem::placed).collect(),
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
        chains: Default::default(),
        background: [0.0; 3],
        environment: None,
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
