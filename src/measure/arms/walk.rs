//! The walk of the rivals: one ray after the other, nearest child first, boxes beyond the closest hit passed over when they
//! are popped. What most of the field does; the product's own walk is not this one.

use super::layouts::{Best, Primitives};
use super::nodes::{Node, Stack, Tree};
use super::work::Watch;
use crate::math::lanes::Lanes;
use crate::trace::kernels::ray::WalkRay;
use crate::trace::{Hits, Rays};

/// What a batch asks for, and where the answers go. In one type, so that a kernel is compiled once for both.
pub(super) enum Answers<'a> {
    /// The closest hit.
    Closest(&'a mut Hits),
    /// Whether there is a hit.
    Occluded(&'a mut [bool]),
}

/// A ray in the lanes that boxes are tested in, and in those of primitives.
struct Ray<B, T> {
    boxes: WalkRay<B>,
    tested: WalkRay<T>,
}

impl<B: Lanes, T: Lanes> Ray<B, T> {
    /// Nothing for a ray that cannot hit.
    #[inline(always)]
    fn new(origin: [f32; 3], dir: [f32; 3], slabs: [f32; 2]) -> Option<Ray<B, T>> {
        Some(Ray {
            boxes: WalkRay::widened(origin, dir, slabs)?,
            tested: WalkRay::new(origin, dir)?,
        })
    }
}

/// Traces a batch.
#[inline(always)]
pub(super) fn batch<L: Lanes, N: Node, P: Primitives>(
    tree: &Tree<N>,
    primitives: &P,
    rays: &Rays,
    mut answers: Answers,
    watch: &mut impl Watch,
) {
    let any = matches!(answers, Answers::Occluded(_));
    let mut stack = Stack::EMPTY;
    for i in 0..rays.len() {
        let origin = [rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]];
        let dir = [rays.dir[0][i], rays.dir[1][i], rays.dir[2][i]];
        let t_max = rays.t_max[i];
        let mut best = Best::below(limit(t_max, any));
        let mut found = false;
        if t_max > 0.0
            && let Some(ray) = Ray::new(origin, dir, tree.slabs)
        {
            found = walk::<L, N, P>(tree, primitives, &ray, any, &mut stack, &mut best, watch);
        }
        match &mut answers {
            Answers::Occluded(out) => out[i] = found,
            Answers::Closest(hits) => {
                let missed = best.prim == Hits::NONE;
                hits.t[i] = if missed { f32::INFINITY } else { best.t };
                hits.u[i] = best.u;
                hits.v[i] = best.v;
                hits.prim[i] = best.prim;
            }
        }
    }
}

/// The lowest t that does not count: `t_max` itself blocks no light, but may be hit.
#[inline(always)]
fn limit(t_max: f32, any: bool) -> f32 {
    if any {
        t_max
    } else {
        Lanes::min(t_max, f32::MAX).next_up()
    }
}

/// Leaves the closest hit in `best`, or if `any` will do, returns true at the first below `best.t`.
#[inline(always)]
fn walk<L: Lanes, N: Node, P: Primitives>(
    tree: &Tree<N>,
    primitives: &P,
    ray: &Ray<N::Boxes<L>, P::Tested<L>>,
    any: bool,
    stack: &mut Stack,
    best: &mut Best,
    watch: &mut impl Watch,
) -> bool {
    let Some(mut child) = tree.root else {
        return false;
    };
    stack.clear();
    loop {
        // Nothing at infinity is ever entered.
        let cull = Lanes::min(best.t, f32::MAX);
        if child.slots == 0 {
            watch.node();
            let node = &tree.nodes[child.first as usize];
            if let Some(nearest) = node.enter::<L>(&ray.boxes, cull, stack) {
                child = nearest;
                continue;
            }
        } else {
            watch.leaf(|| primitives.count(child), child.slots);
            if primitives.test::<L>(child, &ray.tested, any, best) {
                return true;
            }
        }
        match stack.pop(Lanes::min(best.t, f32::MAX)) {
            Some(next) => child = next,
            None => return false,
        }
    }
}
