//! luxel's traversal beside that of the Rust crates `obvhs` and `bvh`: triangles and batches of rays enter, hits leave.
//!
//! ```text
//! cargo bench -p luxel-peers                        # both benchmarks
//! cargo bench -p luxel-peers --bench traversal      # time, by Criterion
//! cargo bench -p luxel-peers --bench instructions   # instructions a ray, by Valgrind
//! RUSTFLAGS="-C target-cpu=native" cargo bench ...  # what obvhs and bvh make of a native build; luxel needs none
//! ```
//!
//! Every peer is used as its documentation shows. Deliberately absent: peers in other languages (`benches/embree`), and
//! spheres, which these crates leave to the caller.

mod boxes;

use boxes::Boxed;
use bvh::bvh::Bvh;
use glam::Vec3A;
use luxel::build::bvh::{Accel, build};
use luxel::flat::FlatScene;
use luxel::measure::bench::{RayKind, Subject};
use luxel::trace::{Hits, Isa, Rays, closest_hit, occluded};
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;
use std::time::Duration;

/// Whose tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Who {
    /// luxel, on the best instruction set.
    Luxel,
    /// The compressed wide tree of `obvhs`, medium build.
    ObvhsCwbvh,
    /// The binary tree of `obvhs`, medium build.
    ObvhsBvh2,
    /// The binary tree of `bvh`, walked by its ordered iterator.
    Bvh,
}

impl Who {
    /// All, luxel first.
    pub const ALL: [Who; 4] = [Who::Luxel, Who::ObvhsCwbvh, Who::ObvhsBvh2, Who::Bvh];

    /// For tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Who::Luxel => "luxel",
            Who::ObvhsCwbvh => "obvhs-cwbvh",
            Who::ObvhsBvh2 => "obvhs-bvh2",
            Who::Bvh => "bvh",
        }
    }
}

/// A tree, ready.
pub struct Engine(Tree);

enum Tree {
    Luxel(Box<FlatScene>),
    Cwbvh(CwBvh, Vec<RtTriangle>),
    Bvh2(Bvh2, Vec<RtTriangle>),
    /// The crate's triangle test culls back faces; that of `obvhs` stands in.
    Bvh(Bvh<f32, 3>, Vec<Boxed>),
}

impl Engine {
    /// Builds the tree over the triangles of a subject.
    #[must_use]
    pub fn build(who: Who, subject: &Subject) -> Engine {
        let triangle = |v: &[luxel::math::Vec3; 3]| {
            let [v0, v1, v2] = v.map(|v| Vec3A::from_array(v.to_array()));
            Triangle { v0, v1, v2 }
        };
        let triangles: Vec<Triangle> = subject.triangles.iter().map(triangle).collect();
        let in_order = |order: &[u32]| -> Vec<RtTriangle> {
            let of = |&i: &u32| RtTriangle::from(&triangles[i as usize]);
            order.iter().map(of).collect()
        };
        let medium = BvhBuildParams::medium_build();
        let mut took = Duration::ZERO;
        Engine(match who {
            Who::Luxel => {
                let built = build(&subject.primitives(), Accel::Bvh);
                Tree::Luxel(Box::new(subject.scene(built)))
            }
            Who::ObvhsCwbvh => {
                let tree = build_cwbvh_from_tris(&triangles, medium, &mut took);
                let leaves = in_order(&tree.primitive_indices);
                Tree::Cwbvh(tree, leaves)
            }
            Who::ObvhsBvh2 => {
                let tree = build_bvh2_from_tris(&triangles, medium, &mut took);
                let leaves = in_order(&tree.primitive_indices);
                Tree::Bvh2(tree, leaves)
            }
            Who::Bvh => {
                let mut boxed: Vec<Boxed> = (0u32..).zip(&triangles).map(Boxed::new).collect();
                Tree::Bvh(Bvh::build(&mut boxed), boxed)
            }
        })
    }

    /// What the set asks for: t and primitives of `hits`, or `blocked`.
    pub fn trace(&self, kind: RayKind, rays: &Rays, hits: &mut Hits, blocked: &mut Vec<bool>) {
        if kind.occlusion() {
            self.occluded(rays, blocked);
        } else {
            self.closest(rays, hits);
        }
    }

    fn closest(&self, rays: &Rays, hits: &mut Hits) {
        match &self.0 {
            Tree::Luxel(scene) => closest_hit(scene, Isa::best(), rays, hits),
            Tree::Cwbvh(tree, leaves) => each(rays, hits, |ray| {
                let mut hit = RayHit::none();
                tree.ray_traverse(ray, &mut hit, |ray, i| leaves[i].intersect(ray));
                (hit.t, tree.primitive_indices.get(hit.primitive_id as usize))
            }),
            Tree::Bvh2(tree, leaves) => each(rays, hits, |ray| {
                let mut hit = RayHit::none();
                tree.ray_traverse(ray, &mut hit, |ray, i| leaves[i].intersect(ray));
                (hit.t, tree.primitive_indices.get(hit.primitive_id as usize))
            }),
            Tree::Bvh(tree, shapes) => each(rays, hits, |mut ray| {
                let id = boxes::closest(tree, shapes, &mut ray);
                (ray.tmax, id)
            }),
        }
    }

    fn occluded(&self, rays: &Rays, out: &mut Vec<bool>) {
        if let Tree::Luxel(scene) = &self.0 {
            return occluded(scene, Isa::best(), rays, out);
        }
        out.clear();
        out.extend((0..rays.len()).map(|i| match &self.0 {
            Tree::Luxel(_) => unreachable!("handled above, a batch at a time"),
            Tree::Cwbvh(tree, leaves) => {
                !tree.ray_traverse_miss(ray(rays, i), |ray, i| leaves[i].intersect(ray))
            }
            Tree::Bvh2(tree, leaves) => {
                !tree.ray_traverse_miss(ray(rays, i), |ray, i| leaves[i].intersect(ray))
            }
            Tree::Bvh(tree, shapes) => boxes::any(tree, shapes, &ray(rays, i)),
        }));
    }
}

/// A closest hit for each ray: t and the primitive, if there is one.
#[inline(always)]
fn each<'a>(rays: &Rays, hits: &mut Hits, mut trace: impl FnMut(Ray) -> (f32, Option<&'a u32>)) {
    hits.t.clear();
    hits.prim.clear();
    for i in 0..rays.len() {
        let (t, prim) = trace(ray(rays, i));
        hits.t.push(t);
        hits.prim.push(prim.map_or(Hits::NONE, |&prim| prim));
    }
}

#[inline(always)]
fn ray(rays: &Rays, i: usize) -> Ray {
    let [origin, dir] = [&rays.origin, &rays.dir].map(|a| Vec3A::new(a[0][i], a[1][i], a[2][i]));
    Ray::new(origin, dir, 0.0, rays.t_max[i])
}
