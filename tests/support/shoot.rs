//! Rays into the kernels, and what comes out.

use super::Rng;
use luxel::flat::FlatScene;
use luxel::math::Vec3;
use luxel::trace::{Hits, Isa, Rays, closest_hit};

pub fn trace(scene: &FlatScene, isa: Isa, rays: &Rays) -> Hits {
    let mut hits = Hits::default();
    closest_hit(scene, isa, rays, &mut hits);
    hits
}

pub fn best(scene: &FlatScene, rays: &Rays) -> Hits {
    trace(scene, Isa::best(), rays)
}

pub fn misses(hits: &Hits) -> usize {
    hits.prim.iter().filter(|&&p| p == Hits::NONE).count()
}

pub fn bits(hits: &Hits) -> Vec<[u32; 6]> {
    (0..hits.t.len())
        .map(|i| {
            [
                hits.t[i].to_bits(),
                hits.u[i].to_bits(),
                hits.v[i].to_bits(),
                hits.prim[i],
                hits.instance[i],
                hits.err[i].to_bits(),
            ]
        })
        .collect()
}

pub fn ray(rays: &Rays, i: usize) -> [[f32; 3]; 2] {
    [
        [rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]],
        [rays.dir[0][i], rays.dir[1][i], rays.dir[2][i]],
    ]
}

pub fn soup(rng: &mut Rng, n: usize, half: f64, size: f64) -> Vec<[Vec3; 3]> {
    (0..n)
        .map(|_| {
            let at = Vec3::from(rng.in_cube(half));
            [(); 3].map(|()| at + Vec3::from(rng.in_cube(size)))
        })
        .collect()
}
