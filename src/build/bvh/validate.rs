//! What a built tree promises, checked: for tests.

use super::{Built, Primitives, sphere_bounds};
use crate::flat::bvh::{Child, MAX_DEPTH, WIDTH, kind};
use crate::math::{Aabb, Vec3};

/// Checks that every box contains its children and its primitives, that every primitive is there once, that children
/// follow their parents, side by side, and that no path is longer than [`MAX_DEPTH`].
///
/// # Errors
/// The first broken promise, in words.
pub fn validate(p: &Primitives, built: &Built) -> Result<(), String> {
    let mut walk = Walk {
        p,
        built,
        seen: [
            vec![0; p.triangles.len()],
            vec![0; p.spheres.len()],
            vec![0; p.instances.len()],
        ],
        deepest: 0,
    };
    let empty = p.triangles.is_empty() && p.spheres.is_empty() && p.instances.is_empty();
    if !empty {
        let bvh = &built.bvh;
        walk.child(bvh.root, &bvh.bounds, 0)?;
    }
    for (name, seen) in ["triangle", "sphere", "instance"].iter().zip(&walk.seen) {
        if let Some(i) = seen.iter().position(|&n| n != 1) {
            return Err(format!("{name} {i} is in {} leaves", seen[i]));
        }
    }
    if walk.deepest != built.bvh.depth || built.bvh.depth as usize > MAX_DEPTH {
        return Err(format!(
            "depth {} said to be {}",
            walk.deepest, built.bvh.depth
        ));
    }
    Ok(())
}

struct Walk<'a> {
    p: &'a Primitives<'a>,
    built: &'a Built,
    /// How often each triangle, sphere and instance was met.
    seen: [Vec<u32>; 3],
    deepest: u32,
}

impl Walk<'_> {
    fn child(&mut self, child: Child, bounds: &Aabb, depth: u32) -> Result<(), String> {
        let run = child.index()..child.index() + child.run_len();
        match child.kind() {
            kind::INNER => self.inner(child.index(), bounds, depth),
            kind::TRIANGLES => run
                .into_iter()
                .try_for_each(|b| self.triangle_block(b, bounds)),
            kind::SPHERES => run
                .into_iter()
                .try_for_each(|b| self.sphere_block(b, bounds)),
            _ => run.into_iter().try_for_each(|i| {
                let instance = self.built.bvh.instance_order[i] as usize;
                self.seen[2][instance] += 1;
                inside(bounds, &self.p.instances[instance], "instance")
            }),
        }
    }

    fn inner(&mut self, at: usize, bounds: &Aabb, depth: u32) -> Result<(), String> {
        self.deepest = self.deepest.max(depth + 1);
        let node = self.built.bvh.nodes[at];
        let mut beside = None;
        for slot in 0..WIDTH {
            let child = Child(node.child[slot]);
            if child == Child::inner(0) {
                continue;
            }
            if child.kind() == kind::INNER && child.index() <= at {
                return Err(format!("node {at} has child {}", child.index()));
            }
            if child.kind() == kind::INNER {
                if beside.is_some_and(|last| node.child[slot] != last + 1) {
                    return Err(format!("inner children of node {at} are apart"));
                }
                beside = Some(node.child[slot]);
            }
            let own = node.child_box(slot);
            inside(bounds, &own, "child box")?;
            self.child(child, &own, depth + 1)?;
        }
        Ok(())
    }

    fn triangle_block(&mut self, b: usize, bounds: &Aabb) -> Result<(), String> {
        for (lane, &prim) in self.built.triangles.blocks[b].prim.iter().enumerate() {
            if prim == u32::MAX {
                continue;
            }
            let place = self.built.triangles.place[prim as usize];
            if place as usize != crate::flat::BLOCK * b + lane {
                return Err(format!("triangle {prim} is not in its place"));
            }
            self.seen[0][prim as usize] += 1;
            let own = triangle_bounds(&self.p.triangles[prim as usize]);
            inside(bounds, &own, "triangle")?;
        }
        Ok(())
    }

    fn sphere_block(&mut self, b: usize, bounds: &Aabb) -> Result<(), String> {
        for &prim in &self.built.sphere_blocks[b].prim {
            if prim == u32::MAX {
                continue;
            }
            let known = self.p.spheres.iter().position(|s| s.prim == prim);
            let i = known.ok_or_else(|| format!("no sphere {prim}"))?;
            self.seen[1][i] += 1;
            let s = self.p.spheres[i];
            inside(bounds, &sphere_bounds(s.center, s.radius), "sphere")?;
        }
        Ok(())
    }
}

/// A box of something that is not finite is in no box, and need not be.
fn inside(outer: &Aabb, inner: &Aabb, what: &str) -> Result<(), String> {
    let finite = inner.min.is_finite() && inner.max.is_finite();
    if !finite || outer.contains(inner) {
        Ok(())
    } else {
        Err(format!("{what} {inner:?} is outside {outer:?}"))
    }
}

/// The box of a triangle; empty if something is not finite.
fn triangle_bounds(v: &[Vec3; 3]) -> Aabb {
    // Minima drop NaN: ask for it first.
    if v.iter().all(|v| v.is_finite()) {
        Aabb::point(v[0]).with(v[1]).with(v[2])
    } else {
        Aabb::EMPTY
    }
}
