//! The probes: rays whose answers are known beforehand.

use super::Wrongs;
use super::topology::{Edge, Mesh, Topology, sphere};
use crate::flat::FlatScene;
use crate::math::{Aabb, DVec3, Vec3, atan2};
use crate::measure::bench::Random;
use crate::trace::{Hits, Isa, Rays, closest_hit, hit_place, identity, spawn};
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// Scattering events on a walk from the camera.
const LEGS: usize = 4;

/// A ray that is aimed at an edge makes at least this sine with both triangles, whose other corners lie at least this
/// share of their distance beside the ray's plane: then rounding the target does not take the ray past either.
const STEEP: f64 = 0.2;

/// Where a ray that is aimed at an edge may end, in distances to the edge, plus so many error bounds of a hit there.
const REACH: f32 = 1.05;
const BOUNDS: f32 = 16.0;

/// Edges shorter than so many error bounds are too small for rays to be aimed at them.
const SHORTEST: f32 = 64.0;

/// What counts as outside of a part of a mesh: this share of its box's longest side, and so many error bounds, beyond the box.
const OUTSIDE: f32 = 1e-3;

/// Of the rays that leave a surface, one in so many leaves it nearly along it.
const GRAZING: usize = 8;

/// How far off a triangle it is asked what is inside, in the square root of twice its area.
const OFF: f64 = 1e-3;

/// A part that is smaller than so many error bounds is blurred: so `luxel check` sees it, too.
const BLURRED: f32 = 1000.0;

/// What the probes found.
#[derive(Clone, Debug, Default)]
pub(super) struct Findings {
    /// Rays that were judged.
    pub(super) rays: u64,
    pub(super) by_entity: BTreeMap<u32, Wrongs>,
    /// Walks that left the scene, by the entity that they came from last.
    pub(super) escapes: BTreeMap<u32, u64>,
}

/// Sends the probes of a scene, about `count` rays of each kind.
pub(super) fn probe(scene: &FlatScene, topology: &Topology, count: usize) -> Findings {
    let boxes = |mesh: &Mesh, geometry| mesh.boxes(geometry);
    let local = topology.local.iter().zip(&scene.local);
    let mut probe = Probe {
        scene,
        topology,
        boxes: local.map(|(mesh, g)| boxes(mesh, g)).collect(),
        world_boxes: boxes(&topology.world, &scene.world),
        random: Random::new(1),
        findings: Findings::default(),
    };
    let shapes = probe.shapes();
    if !shapes.is_empty() {
        probe.edges(&shapes, count);
        probe.surfaces(&shapes, count);
    }
    probe.walks(count / LEGS);
    probe.findings
}

/// Something to aim at.
#[derive(Clone)]
enum Shape {
    Sphere(u32),
    /// Triangles of an instance, or an entity's in the world.
    Triangles(u32, std::ops::Range<u32>),
}

struct Probe<'a> {
    scene: &'a FlatScene,
    topology: &'a Topology,
    /// Of the parts of local meshes, in their spaces.
    boxes: Vec<Vec<Aabb>>,
    world_boxes: Vec<Aabb>,
    random: Random,
    findings: Findings,
}

/// A batch with its hits.
struct Traced {
    rays: Rays,
    hits: Hits,
}

impl Probe<'_> {
    /// Everything that has a surface; entities take turns, whatever their size.
    fn shapes(&self) -> Vec<Shape> {
        let spheres = (0..self.scene.spheres.placed.len() as u32).map(Shape::Sphere);
        let instances = (0..).zip(&self.scene.instances).map(|(i, instance)| {
            let prims = self.topology.local[instance.geometry as usize].part.len();
            Shape::Triangles(i, 0..prims as u32)
        });
        let mut shapes: Vec<Shape> = spheres.chain(instances).collect();
        let objects = &self.scene.world.shading.object;
        let mut first = 0;
        for same in objects.chunk_by(|a, b| a == b) {
            let next = first + same.len() as u32;
            shapes.push(Shape::Triangles(Hits::WORLD, first..next));
            first = next;
        }
        shapes.retain(|shape| !matches!(shape, Shape::Triangles(_, prims) if prims.is_empty()));
        shapes
    }

    fn trace(&self, rays: Rays) -> Traced {
        let mut hits = Hits::default();
        closest_hit(self.scene, Isa::best(), &rays, &mut hits);
        Traced { rays, hits }
    }

    fn wrong(&mut self, [prim, instance]: [u32; 2], wrongs: Wrongs) {
        let (_, entity) = identity(self.scene, prim, instance);
        *self.findings.by_entity.entry(entity).or_default() += wrongs;
    }

    /// The vertices of a triangle in the scene.
    fn vertices(&self, prim: u32, instance: u32) -> [DVec3; 3] {
        let scene = self.scene;
        let v = match instance {
            Hits::WORLD => spawn::triangle_vertices(&scene.world.triangles, prim),
            i => {
                let instance = &scene.instances[i as usize];
                let local = &scene.local[instance.geometry as usize];
                spawn::triangle_vertices(&local.triangles, prim)
                    .map(|v| spawn::instance_point(instance, v))
            }
        };
        v.map(|v| Vec3::from(v).as_dvec3())
    }

    /// Rays that are aimed at edges.
    fn edges(&mut self, shapes: &[Shape], count: usize) {
        let mut targets: Vec<(u32, usize)> = Vec::new();
        let mut meshes: Vec<u32> = shapes
            .iter()
            .filter_map(|shape| match shape {
                Shape::Triangles(instance, _) => Some(*instance),
                Shape::Sphere(_) => None,
            })
            .collect();
        meshes.dedup();
        meshes.retain(|i| !self.topology.mesh(self.scene, *i).edges.is_empty());
        if meshes.is_empty() {
            return;
        }
        let mut rays = Rays::default();
        for k in 0..count {
            let instance = meshes[k % meshes.len()];
            let edges = &self.topology.mesh(self.scene, instance).edges;
            let edge = self.random.below(edges.len());
            if let Some([origin, dir]) = self.aim(instance, edges[edge]) {
                rays.push(origin, dir, f32::MAX);
                targets.push((instance, edge));
            }
        }
        let Traced { rays, hits } = self.trace(rays);
        for (i, (instance, edge)) in targets.into_iter().enumerate() {
            self.findings.rays += 1;
            if hits.t[i] <= REACH {
                continue;
            }
            let edge = self.topology.mesh(self.scene, instance).edges[edge];
            if self.passed(&rays, i, (instance, edge), hits.t[i]) {
                let leak = Wrongs {
                    leaks: 1,
                    ..Wrongs::default()
                };
                self.wrong([edge.a, instance], leak);
            }
        }
    }

    /// A ray that meets an edge between its triangles at t = 1, if some direction allows it.
    fn aim(&mut self, instance: u32, edge: Edge) -> Option<[[f32; 3]; 2]> {
        let [va, vb] = [edge.a, edge.b].map(|prim| self.vertices(prim, instance));
        let k = edge.corner as usize;
        let [from, to, apart_a] = [va[k], va[(k + 1) % 3], va[(k + 2) % 3]];
        let apart_b = vb[edge.opposite as usize];
        let along = to - from;
        let share = self.random.range(0.25, 0.75);
        let target = from + along * share;
        for _ in 0..4 {
            let away = self.random.direction();
            let beside = along.cross(away);
            let side = |apart: DVec3| {
                let arm = apart - target;
                let normal = along.cross(arm);
                let steep = normal.dot(away).abs() > STEEP * normal.length();
                let part = beside.dot(arm) / (beside.length() * arm.length());
                (steep && part.abs() > STEEP).then_some(part > 0.0)
            };
            if let (Some(a), Some(b)) = (side(apart_a), side(apart_b))
                && a != b
            {
                let origin = (target + away * along.length()).as_vec3();
                let dir = (target - origin.as_dvec3()).as_vec3();
                return Some([origin.to_array(), dir.to_array()]);
            }
        }
        None
    }

    /// Whether a ray that should have met an edge did not, by the error bound of a hit beside the edge.
    fn passed(&self, rays: &Rays, i: usize, (instance, edge): (u32, Edge), t: f32) -> bool {
        let v = self.vertices(edge.a, instance);
        let middle = (v[0] + v[1] + v[2]) / 3.0;
        let [o, d] = [&rays.origin, &rays.dir].map(|a| Vec3::new(a[0][i], a[1][i], a[2][i]));
        let mut beside = Rays::default();
        beside.push(
            o.to_array(),
            (middle - o.as_dvec3()).as_vec3().to_array(),
            f32::MAX,
        );
        let hits = self.trace(beside).hits;
        if [hits.prim[0], hits.instance[0]] != [edge.a, instance] {
            // A triangle that cannot be hit in its middle is smaller than what single precision tells apart.
            return false;
        }
        let (err, distance) = (hits.err[0], d.length());
        distance > SHORTEST * err && t > REACH + BOUNDS * err / distance
    }

    /// Rays that leave points all over every shape.
    fn surfaces(&mut self, shapes: &[Shape], count: usize) {
        let mut rays = Rays::default();
        for k in 0..count {
            let (target, size) = match shapes[k % shapes.len()].clone() {
                Shape::Sphere(s) => {
                    let (spheres, s) = (&self.scene.spheres, s as usize);
                    let (c, r) = (DVec3::from(spheres.center(s)), spheres.radius(s));
                    (c + self.random.direction() * r, r)
                }
                Shape::Triangles(instance, prims) => {
                    let prim = prims.start + self.random.below(prims.len()) as u32;
                    let [a, b, c] = self.vertices(prim, instance);
                    let [u, v] = [self.random.unit(), self.random.unit()];
                    let [u, v] = if u + v > 1.0 {
                        [1.0 - u, 1.0 - v]
                    } else {
                        [u, v]
                    };
                    let p = a + (b - a) * u + (c - a) * v;
                    (p, (b - a).length() + (c - a).length())
                }
            };
            let away = self.random.direction();
            let origin = (target + away * size).as_vec3();
            let dir = (target - origin.as_dvec3()).as_vec3().normalize_or_zero();
            rays.push(origin.to_array(), dir.to_array(), f32::MAX);
        }
        let first = self.trace(rays);
        let mut away = Rays::default();
        let mut left = Vec::new();
        for i in 0..first.rays.len() {
            if first.hits.prim[i] == Hits::NONE {
                continue;
            }
            let [p, ng] = hit_place(self.scene, &first.rays, &first.hits, i);
            for side in [1.0, -1.0] {
                let mut dir = self.random.direction().as_vec3();
                let normal = Vec3::from(ng);
                if i % GRAZING == 0 {
                    dir = (dir.cross(normal) + 1e-3 * side * normal).normalize_or(normal * side);
                }
                let dir = (dir * (dir.dot(normal) * side).signum()).to_array();
                let origin = spawn::offset_origin(p, ng, first.hits.err[i], dir);
                away.push(origin, dir, f32::MAX);
                left.push((i, side));
            }
        }
        let second = self.trace(away);
        for (k, (i, side)) in left.into_iter().enumerate() {
            self.judge(&first, i, &second, k, side);
        }
    }

    /// Judges ray `k`, which left hit `i` on the side that `side` times its normal points to.
    fn judge(&mut self, first: &Traced, i: usize, second: &Traced, k: usize, side: f32) {
        let of = |hits: &Hits, i: usize| [hits.prim[i], hits.instance[i]];
        let (from, to) = (of(&first.hits, i), of(&second.hits, k));
        self.findings.rays += 1;
        let outward = match sphere(from[0]) {
            Some(s) => (side > 0.0) != self.scene.spheres.inverted[s],
            None => true,
        };
        // Bounds are along normals, of which the two hits have different ones.
        let err = first.hits.err[i].max(second.hits.err[k]);
        let leaks = match sphere(from[0]) {
            Some(_) if outward => false,
            Some(s) => self.leaves_sphere(s, err, second, k),
            None => {
                self.leaves_part(from, err, second, k, side)
                    && self.starts_inside(from, [first.hits.u[i], first.hits.v[i]], err)
            }
        };
        let wrongs = Wrongs {
            self_hits: u64::from(outward && from == to),
            leaks: u64::from(leaks),
            non_finite: 0,
        };
        if wrongs.total() > 0 {
            self.wrong(from, wrongs);
        }
    }

    /// Where a ray meets something, if it does.
    fn met(&self, to: &Traced, k: usize) -> Option<Vec3> {
        let hit = to.hits.prim[k] != Hits::NONE;
        hit.then(|| Vec3::from(hit_place(self.scene, &to.rays, &to.hits, k)[0]))
    }

    /// Whether a ray that starts in a sphere meets nothing in it.
    fn leaves_sphere(&self, s: usize, err: f32, to: &Traced, k: usize) -> bool {
        let spheres = &self.scene.spheres;
        let (center, most) = (
            DVec3::from(spheres.center(s)),
            spheres.radius(s) + f64::from(BOUNDS * err),
        );
        self.met(to, k)
            .is_none_or(|p| (p.as_dvec3() - center).length() > most)
    }

    /// Whether a ray that starts on the inner side of a closed part meets nothing in its box.
    fn leaves_part(&self, from: [u32; 2], err: f32, to: &Traced, k: usize, side: f32) -> bool {
        let [prim, instance] = from;
        let mesh = self.topology.mesh(self.scene, instance);
        let part = mesh.part[prim as usize] as usize;
        if f32::from(mesh.inside[part]) != side {
            return false;
        }
        let Some(p) = self.met(to, k) else {
            return true;
        };
        let (own, p, err) = match instance {
            Hits::WORLD => (self.world_boxes[part], p, err),
            i => {
                let instance = &self.scene.instances[i as usize];
                let rows = &instance.to_local;
                let p = p.extend(1.0).to_array();
                let local = rows.map(|row| (0..4).map(|k| row[k] * p[k]).sum());
                // At most the sum of the entries: how much the map can stretch.
                let stretch: f32 = rows.iter().flat_map(|row| &row[..3]).map(|x| x.abs()).sum();
                let own = self.boxes[instance.geometry as usize][part];
                (own, Vec3::from_array(local), err * stretch)
            }
        };
        let slack = OUTSIDE * (own.max - own.min).max_element() + BOUNDS * err;
        (p - own.max).max(own.min - p).max_element() > slack
    }

    /// Whether a ray that leaves this point to the inner side starts inside; asked of few rays. Where a part runs through
    /// itself, what is its inner side elsewhere may be outside: that is told by the winding number in f64 a little off the
    /// triangle. And beside an edge, rounding may put the start, or the ray, beyond the neighbour's face: that counts only
    /// where rounding blurs the whole part.
    fn starts_inside(&self, [prim, instance]: [u32; 2], [u, v]: [f32; 2], err: f32) -> bool {
        let mesh = self.topology.mesh(self.scene, instance);
        let part = mesh.part[prim as usize];
        let (geometry, own) = match instance {
            Hits::WORLD => (&self.scene.world, self.world_boxes[part as usize]),
            i => {
                let placed = &self.scene.instances[i as usize];
                let [min, max] = placed.bounds.map(Vec3::from);
                let geometry = &*self.scene.local[placed.geometry as usize];
                (geometry, Aabb { min, max })
            }
        };
        let blurred = err * BLURRED > (own.max - own.min).max_element();
        if !blurred && self.beside_edge([prim, instance], [u, v], err) {
            return false;
        }
        let vertices = |prim: u32| {
            let v = spawn::triangle_vertices(&geometry.triangles, prim);
            v.map(|v| Vec3::from(v).as_dvec3())
        };
        let inside = |p: DVec3| {
            let of_part = (0..).zip(&mesh.part).filter(|(_, of)| **of == part);
            let angle: f64 = of_part
                .map(|(prim, _)| solid_angle(vertices(prim), p))
                .sum();
            (angle / (4.0 * PI)).abs() > 0.5
        };
        let [a, b, c] = vertices(prim);
        let normal = (b - a).cross(c - a);
        let area = normal.length();
        let side = f64::from(mesh.inside[part as usize]);
        let off = normal * (side * OFF / area.sqrt());
        let beside = a + (b - a) * f64::from(u) + (c - a) * f64::from(v) + off;
        area > 0.0 && inside(beside)
    }

    /// Whether a point of a triangle is within so many error bounds of its edges.
    fn beside_edge(&self, [prim, instance]: [u32; 2], [u, v]: [f32; 2], err: f32) -> bool {
        let p = self.vertices(prim, instance);
        let area = (p[1] - p[0]).cross(p[2] - p[0]).length();
        let weights = [1.0 - u - v, u, v].map(f64::from);
        (0..3).any(|k| {
            let edge = p[(k + 2) % 3] - p[(k + 1) % 3];
            weights[k] * area < f64::from(BOUNDS * err) * edge.length()
        })
    }

    /// Random walks from the camera, on the side of the surfaces that they come to.
    fn walks(&mut self, count: usize) {
        let camera = &self.scene.camera;
        let [forward, right, down] = [camera.forward, camera.right, camera.down].map(Vec3::from);
        let mut rays = Rays::default();
        for _ in 0..count {
            let [x, y] = [camera.width, camera.height]
                .map(|side| (self.random.range(-0.5, 0.5) * f64::from(side)) as f32 * camera.pixel);
            let dir = (forward + right * x + down * y).normalize();
            rays.push(camera.origin, dir.to_array(), f32::MAX);
        }
        // No primitive has this name.
        let mut left = vec![[Hits::NONE; 2]; count];
        for _ in 0..LEGS {
            let now = self.trace(rays);
            rays = Rays::default();
            let mut next = Vec::new();
            for (i, from) in left.iter().enumerate() {
                let to = [now.hits.prim[i], now.hits.instance[i]];
                let camera = from[0] == Hits::NONE;
                self.findings.rays += u64::from(!camera);
                // From within, a sphere is met again.
                if !camera && *from == to && sphere(to[0]).is_none() {
                    let again = Wrongs {
                        self_hits: 1,
                        ..Wrongs::default()
                    };
                    self.wrong(*from, again);
                }
                if to[0] == Hits::NONE {
                    let entity = match camera {
                        true => u32::MAX,
                        false => identity(self.scene, from[0], from[1]).1,
                    };
                    *self.findings.escapes.entry(entity).or_default() += 1;
                    continue;
                }
                let [p, ng] = hit_place(self.scene, &now.rays, &now.hits, i);
                let d = &now.rays.dir;
                let come = Vec3::new(d[0][i], d[1][i], d[2][i]);
                let normal = Vec3::from(ng);
                let facing = if come.dot(normal) < 0.0 {
                    normal
                } else {
                    -normal
                };
                let dir = self.random.direction().as_vec3();
                let dir = if dir.dot(facing) < 0.0 { -dir } else { dir }.to_array();
                rays.push(
                    spawn::offset_origin(p, ng, now.hits.err[i], dir),
                    dir,
                    f32::MAX,
                );
                next.push(to);
            }
            left = next;
        }
    }
}

/// Signed solid angle of a triangle seen from `p` (Van Oosterom and Strackee 1983, "The solid angle of a plane triangle",
/// eq. 8).
fn solid_angle(v: [DVec3; 3], p: DVec3) -> f64 {
    let [a, b, c] = v.map(|v| v - p);
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * atan2(a.dot(b.cross(c)), denominator)
}
