//! Triangles as the crate `bvh` wants them: boxes that know their place in the tree.

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::Bvh;
use nalgebra::{Point3, Vector3};
use obvhs::ray::Ray;
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;

/// A triangle with its box.
pub(crate) struct Boxed {
    bounds: Aabb<f32, 3>,
    triangle: RtTriangle,
    prim: u32,
    node: usize,
}

impl Boxed {
    pub(crate) fn new((prim, triangle): (u32, &Triangle)) -> Boxed {
        let min = triangle.v0.min(triangle.v1).min(triangle.v2);
        let max = triangle.v0.max(triangle.v1).max(triangle.v2);
        Boxed {
            bounds: Aabb::with_bounds(Point3::from(min.to_array()), Point3::from(max.to_array())),
            triangle: RtTriangle::from(triangle),
            prim,
            node: 0,
        }
    }
}

impl Bounded<f32, 3> for Boxed {
    fn aabb(&self) -> Aabb<f32, 3> {
        self.bounds
    }
}

impl BHShape<f32, 3> for Boxed {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

/// The closest hit; `ray.tmax` becomes its t. The iterator gives boxes by where the ray enters them, so that it may end at
/// the first one behind the hit.
pub(crate) fn closest<'a>(
    tree: &Bvh<f32, 3>,
    shapes: &'a [Boxed],
    ray: &mut Ray,
) -> Option<&'a u32> {
    let line = line(ray);
    let mut hit = None;
    for shape in tree.nearest_traverse_iterator(&line, shapes) {
        let behind = || {
            let interval = line.intersection_slice_for_aabb(&shape.bounds);
            interval.is_none_or(|(near, _)| near > ray.tmax)
        };
        if hit.is_some() && behind() {
            break;
        }
        let t = shape.triangle.intersect(ray);
        if t < ray.tmax {
            ray.tmax = t;
            hit = Some(&shape.prim);
        }
    }
    hit
}

/// Whether anything is hit.
pub(crate) fn any(tree: &Bvh<f32, 3>, shapes: &[Boxed], ray: &Ray) -> bool {
    let line = line(ray);
    let mut candidates = tree.traverse_iterator(&line, shapes);
    candidates.any(|shape| shape.triangle.intersect(ray) < ray.tmax)
}

fn line(ray: &Ray) -> bvh::ray::Ray<f32, 3> {
    bvh::ray::Ray::new(
        Point3::from(ray.origin.to_array()),
        Vector3::from(ray.direction.to_array()),
    )
}
