//! What is traced: triangles and spheres about ten units long, and where its rays come from.

use crate::asset::Mesh;
use crate::build::bvh::{Built, Primitives, SphereItem};
use crate::flat::{
    Camera, FlatScene, Geometry, Lights, Needs, PixelFilter, Rebase, Shading, Spheres,
};
use crate::math::{Aabb, DAffine3, DVec3, Vec3};
use std::ops::Range;

/// Longest extent of every object.
pub const LENGTH: f64 = 10.0;

/// Distance of a room's walls and ceiling from its object, which stands on the floor.
const ROOM: f32 = 8.0;

/// The floor lies so far below the object that the two share no plane.
const GAP: f32 = 0.01;

/// Something to trace.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Vertices of each triangle; those of a room come last.
    pub triangles: Vec<[Vec3; 3]>,
    /// The object's triangles and the room's: what [`Accel::Box`](crate::build::Accel::Box) puts a box around. Empty means
    /// one group.
    pub groups: Vec<Range<u32>>,
    /// Spheres, `prim` ascending from 0.
    pub spheres: Vec<SphereItem>,
    /// The box of the object, without its room.
    pub object: Aabb,
    /// Where primary rays start and shadow rays end.
    pub view: View,
}

/// A pinhole camera and a lamp. Neither is part of the geometry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The pinhole.
    pub eye: DVec3,
    /// The middle of the image.
    pub target: DVec3,
    /// A parallelogram: corner, edge, edge.
    pub lamp: [DVec3; 3],
}

impl View {
    /// From in front, a little above and to the right; the lamp is above, inside the room if there is one.
    #[must_use]
    pub fn of(object: &Aabb) -> View {
        let [low, high] = [object.min, object.max].map(Vec3::as_dvec3);
        let center = 0.5 * (low + high);
        let half = 0.5 * (high - low);
        View {
            eye: center + DVec3::new(3.0, 0.5 * half.y + 1.0, half.z + 5.0),
            target: center,
            lamp: [
                center + DVec3::new(-2.0, half.y + 6.0, -2.0),
                DVec3::new(4.0, 0.0, 0.0),
                DVec3::new(0.0, 0.0, 4.0),
            ],
        }
    }
}

impl Subject {
    /// Triangles under the open sky.
    #[must_use]
    pub fn open(triangles: Vec<[Vec3; 3]>) -> Subject {
        let object = triangles
            .iter()
            .flatten()
            .fold(Aabb::EMPTY, |bounds, &vertex| bounds.with(vertex));
        Subject {
            view: View::of(&object),
            triangles,
            groups: Vec::new(),
            spheres: Vec::new(),
            object,
        }
    }

    /// Spheres in the void.
    #[must_use]
    pub fn of_spheres(spheres: Vec<SphereItem>) -> Subject {
        let object = spheres.iter().fold(Aabb::EMPTY, |bounds, s| {
            bounds.union(crate::build::bvh::sphere_bounds(s.center, s.radius))
        });
        Subject {
            triangles: Vec::new(),
            groups: Vec::new(),
            spheres,
            object,
            view: View::of(&object),
        }
    }

    /// Meshes of a user where these maps place them, together moved to the origin and scaled to [`LENGTH`]; in f64, then
    /// rounded once. `None` if they have no triangles or no extent.
    #[must_use]
    pub fn of_meshes(parts: &[(&Mesh, DAffine3)]) -> Option<Subject> {
        let corners = || {
            parts.iter().flat_map(|&(mesh, to)| {
                let place = move |&i: &u32| to.transform_point3(mesh.positions[i as usize]);
                mesh.corners.iter().map(place)
            })
        };
        let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = corners().fold(nothing, |(low, high), p| (low.min(p), high.max(p)));
        let scale = LENGTH / (high - low).max_element();
        if !scale.is_finite() || scale <= 0.0 {
            return None;
        }
        let center = low + 0.5 * (high - low);
        let fitted: Vec<Vec3> = corners()
            .map(|p| ((p - center) * scale).as_vec3())
            .collect();
        let triangle = |c: &[Vec3]| [c[0], c[1], c[2]];
        Some(Subject::open(
            fitted.chunks_exact(3).map(triangle).collect(),
        ))
    }

    /// The same in a closed box of twelve triangles, so that no ray gets away.
    #[must_use]
    pub fn in_room(mut self) -> Subject {
        let low = self.object.min - Vec3::new(ROOM, GAP, ROOM);
        let high = self.object.max + Vec3::splat(ROOM);
        let corner = |i: usize| {
            let pick = |axis: usize| if i >> axis & 1 == 0 { low } else { high }[axis];
            Vec3::new(pick(0), pick(1), pick(2))
        };
        // Corner i has its bits as coordinates; seen from inside, each face runs counter-clockwise.
        for [a, b, c, d] in [
            [0, 2, 6, 4],
            [1, 5, 7, 3],
            [0, 4, 5, 1],
            [2, 3, 7, 6],
            [0, 1, 3, 2],
            [4, 6, 7, 5],
        ] {
            let [a, b, c, d] = [a, b, c, d].map(corner);
            self.triangles.extend([[a, b, c], [a, c, d]]);
        }
        let all = self.triangles.len() as u32;
        self.groups = vec![0..all - 12, all - 12..all];
        self
    }

    /// Number of triangles and spheres.
    #[must_use]
    pub fn len(&self) -> usize {
        self.triangles.len() + self.spheres.len()
    }

    /// Whether there is nothing to hit.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// What a tree is built over.
    #[must_use]
    pub fn primitives(&self) -> Primitives<'_> {
        Primitives {
            triangles: &self.triangles,
            groups: &self.groups,
            spheres: &self.spheres,
            ..Primitives::default()
        }
    }

    /// A flat scene with nothing but the geometry and its tree, for the product's own kernels.
    #[must_use]
    pub fn scene(&self, built: Built) -> FlatScene {
        FlatScene {
            world: Geometry {
                triangles: built.triangles,
                bvh: built.bvh,
                shading: Shading::default(),
            },
            local: Vec::new(),
            instances: Vec::new(),
            instance_materials: Vec::new(),
            spheres: Spheres {
                blocks: built.sphere_blocks,
                placed: self.spheres.iter().map(SphereItem::placed).collect(),
                ..Spheres::default()
            },
            materials: Vec::new(),
            textures: Vec::new(),
            lights: Lights::default(),
            chains: Default::default(),
            background: [0.0; 3],
            environment: None,
            camera: UNUSED_CAMERA,
            rebase: Rebase {
                origin: [0.0; 3],
                scale: 1.0,
            },
            needs: Needs::default(),
            frame: 0,
        }
    }
}

/// The kernels see rays only.
const UNUSED_CAMERA: Camera = Camera {
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
};
