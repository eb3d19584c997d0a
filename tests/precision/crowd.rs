//! Crowds: instances of two closed meshes, placed in every way that may hurt, as entities and baked into one mesh.

use crate::chains::Level;
use crate::stage::{Stage, obj, points};
use crate::support::{Rng, Solid};
use luxel::flat::FlatScene;
use luxel::math::DVec3;
use luxel::trace::spawn::triangle_vertices;
use luxel::trace::{Hits, Rays, identity};
use std::fmt::Write;

/// Unit roundoff of f32.
const U: f64 = 1.0 / (1u64 << 24) as f64;

/// Instances of a crowd: half of them balls, half of them rings.
const MEMBERS: usize = 40;

/// How a crowd is placed.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Placed {
    /// Turned, of about one size.
    Turned,
    /// By 10^±1 along every axis, every second one mirrored.
    Stretched,
    /// Of sizes 10^±3.
    Sizes,
    /// Far from the origin, a million times as far as it is wide.
    Far,
    /// Of meshes that lie far from their own origins.
    OffCentre,
    /// Under two parents, each turned, stretched and mirrored by its own axes.
    Chained,
}

impl Placed {
    pub(crate) const ALL: [Placed; 6] = [
        Placed::Turned,
        Placed::Stretched,
        Placed::Sizes,
        Placed::Far,
        Placed::OffCentre,
        Placed::Chained,
    ];

    /// How far the meshes lie from their origins.
    fn off(self) -> DVec3 {
        match self {
            Placed::OffCentre => DVec3::new(1000.0, -300.0, 70.0),
            _ => DVec3::ZERO,
        }
    }

    /// Where the crowd is.
    fn at(self) -> DVec3 {
        match self {
            Placed::Far => DVec3::new(6e6, -2e6, 5e5),
            _ => DVec3::ZERO,
        }
    }

    /// The levels of a member, outermost first.
    fn levels(self, member: usize, rng: &mut Rng) -> Vec<Level> {
        let decades = match self {
            Placed::Stretched => 1.0,
            Placed::Chained => 0.4,
            _ => 0.0,
        };
        let count = if matches!(self, Placed::Chained) {
            3
        } else {
            1
        };
        let mut levels: Vec<Level> = (0..count).map(|_| Level::random(rng, decades)).collect();
        for level in &mut levels {
            if decades > 0.0 && rng.below(2) == 0 {
                level.scale[member % 3] *= -1.0;
            }
            if matches!(self, Placed::Sizes) {
                level.scale *= 10f64.powf(rng.range(-3.0, 0.0));
            }
        }
        levels[0].translate = 3.0 * levels[0].translate + self.at();
        // What is far from its own origin comes back to where the others are.
        if let Some(last) = levels.last_mut() {
            last.translate += last.translate - last.apply(self.off());
        }
        levels
    }
}

/// A closed mesh, and points inside of it.
struct Kind {
    solid: Solid,
    vertices: Vec<DVec3>,
    ring: bool,
}

impl Kind {
    fn new(ring: bool, off: DVec3) -> Kind {
        let solid = if ring {
            Solid::torus(6, 12)
        } else {
            Solid::icosphere(1)
        };
        let vertices = points(&solid).iter().map(|v| *v + off).collect();
        Kind {
            solid,
            vertices,
            ring,
        }
    }

    /// Without its offset.
    fn inside(&self, rng: &mut Rng) -> DVec3 {
        let aside = DVec3::from(rng.in_cube(0.1).map(f64::from));
        // Halfway between two segments, where a ring of twelve is thinnest.
        let (sin, cos) = (std::f64::consts::TAU * rng.unit()).sin_cos();
        let middle = DVec3::new(cos, 0.0, sin);
        if self.ring {
            0.97 * middle + aside
        } else {
            4.0 * aside
        }
    }
}

/// A crowd as instances and as one mesh.
pub(crate) struct Crowd {
    pub(crate) instanced: FlatScene,
    pub(crate) baked: FlatScene,
    /// In the units of both, in f64, in the order of the baked file.
    exact: Vec<[DVec3; 3]>,
    /// Points inside of the mesh that a triangle belongs to.
    inside: Vec<DVec3>,
    /// The first triangle of the member that an entity is.
    first: Vec<Option<usize>>,
    /// What f64 rounds authored coordinates by on their way, in those units.
    blur: f64,
}

impl Crowd {
    pub(crate) fn new(placed: Placed, rng: &mut Rng) -> Crowd {
        let kinds = [false, true].map(|ring| Kind::new(ring, placed.off()));
        let eye = placed.at();
        let head = format!(
            "camera: (at: ({:?}, {:?}, {:?}), look_at: ({:?}, {:?}, {:?})), entities: [",
            eye.x,
            eye.y,
            eye.z + 12.0,
            eye.x,
            eye.y,
            eye.z
        );
        let mut text = head.clone();
        let (mut vertices, mut faces) = (Vec::new(), Vec::new());
        let (mut inside, mut first) = (Vec::new(), Vec::new());
        for member in 0..MEMBERS {
            let kind = &kinds[member % 2];
            let levels = placed.levels(member, rng);
            let world = |p: DVec3| levels.iter().rev().fold(p, |p, level| level.apply(p));
            for (k, level) in levels.iter().enumerate() {
                let parent = match k {
                    0 => String::new(),
                    _ => format!("parent: \"{member} {}\", ", k - 1),
                };
                let leaf = k + 1 == levels.len();
                let shape = format!("shape: Mesh(\"{}.obj\"), normals: Flat, ", member % 2);
                let shape = if leaf { shape } else { String::new() };
                writeln!(
                    text,
                    "(name: \"{member} {k}\", {parent}{shape}{}),",
                    level.text()
                )
                .unwrap();
                first.push(leaf.then_some(faces.len()));
            }
            let base = vertices.len();
            vertices.extend(kind.vertices.iter().map(|v| world(*v)));
            for face in &kind.solid.faces {
                faces.push(face.map(|i| i + base));
                inside.push(world(kind.inside(rng) + placed.off()));
            }
        }
        let baked = format!("{head}(shape: Mesh(\"all.obj\"), normals: Flat)]");
        let stage = Stage::new(&format!("baked_{placed:?}"))
            .file("0.obj", &obj(&kinds[0].vertices, &kinds[0].solid.faces))
            .file("1.obj", &obj(&kinds[1].vertices, &kinds[1].solid.faces))
            .file("all.obj", &obj(&vertices, &faces));
        let [instanced, baked] = [text + "]", baked].map(|body| stage.flat(&body));
        assert_eq!(
            (instanced.instances.len(), baked.instances.len()),
            (MEMBERS, 0)
        );
        assert_eq!(instanced.rebase, baked.rebase);
        let (origin, scale) = (DVec3::from(baked.rebase.origin), baked.rebase.scale);
        let scene = |p: DVec3| (p - origin) * scale;
        Crowd {
            instanced,
            baked,
            exact: faces
                .iter()
                .map(|face| face.map(|i| scene(vertices[i])))
                .collect(),
            inside: inside.into_iter().map(scene).collect(),
            first,
            blur: 8.0
                * f64::EPSILON
                * scale
                * (placed.at().length() + 10.0 * placed.off().length() + 10.0),
        }
    }

    /// The triangle of the baked file that was hit.
    pub(crate) fn name(&self, scene: &FlatScene, hits: &Hits, i: usize) -> Option<usize> {
        let (prim, instance) = (hits.prim[i], hits.instance[i]);
        (prim != Hits::NONE).then(|| {
            let (triangle, entity) = identity(scene, prim, instance);
            let first = if instance == Hits::WORLD {
                Some(0)
            } else {
                self.first[entity as usize]
            };
            first.expect("an entity with a mesh") + triangle as usize
        })
    }

    /// A fourth each: from anywhere to anywhere; from anywhere at edges; at vertices; from inside at either.
    pub(crate) fn rays(&self, count: usize, rng: &mut Rng) -> Rays {
        let mut rays = Rays::default();
        for i in 0..count {
            let target = rng.below(self.exact.len());
            let corners = self.exact[target];
            let k = rng.below(3);
            let [a, b] = [corners[k], corners[(k + 1) % 3]];
            let to = match i % 4 {
                0 => DVec3::from(rng.in_cube(0.4).map(f64::from)),
                1 => a + (b - a) * rng.unit(),
                2 => a,
                _ => a + (b - a) * (rng.below(2) as f64 * rng.unit()),
            };
            let from = match i % 4 {
                3 => self.inside[target],
                _ => DVec3::from(rng.direction().map(f64::from)) * rng.range(0.3, 1.2),
            };
            let from = from.as_vec3();
            let dir = (to - from.as_dvec3()).as_vec3();
            rays.push(from.to_array(), dir.to_array(), f32::MAX);
        }
        rays
    }

    /// Both scenes are this one, rounded once.
    pub(crate) fn assert_rounded_once(&self) {
        for (name, exact) in self.exact.iter().enumerate() {
            let vertices = triangle_vertices(&self.baked.world.triangles, name as u32);
            for (v, exact) in vertices.iter().zip(exact) {
                for axis in 0..3 {
                    let off = (f64::from(v[axis]) - exact[axis]).abs();
                    assert!(
                        off <= U * exact[axis].abs() + 1e-15,
                        "{name}: {v:?} {exact}"
                    );
                }
            }
        }
        for instance in &self.instanced.instances {
            let local = &self.instanced.local[instance.geometry as usize];
            let first = self.first[instance.object.0 as usize].expect("an entity with a mesh");
            for prim in 0..local.triangles.place.len() as u32 {
                let name = first + local.shading.file_prim[prim as usize] as usize;
                let vertices = triangle_vertices(&local.triangles, prim);
                for (v, exact) in vertices.iter().zip(&self.exact[name]) {
                    for (row, v) in instance.to_local.iter().zip(v) {
                        let [x, y, z, w] = row.map(f64::from);
                        let terms = [x * exact.x, y * exact.y, z * exact.z, w];
                        let off = (terms.iter().sum::<f64>() - f64::from(*v)).abs();
                        let sum: f64 = terms.iter().map(|t| t.abs()).sum();
                        let blur = self.blur * (x.abs() + y.abs() + z.abs());
                        let bound = U * (sum + f64::from(v.abs())) + blur;
                        assert!(off <= bound, "{name}: {off} {bound}");
                    }
                }
            }
        }
    }
}
