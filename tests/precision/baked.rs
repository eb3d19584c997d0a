//! Instances against the same triangles baked into the world, ray by ray: the same triangle of the same entity, or two
//! answers that the f64 referee both finds within their bounds.
//!
//! What is compared are two roundings of one scene. So that they stand for it, the maps and the baked vertices are held to
//! one rounding of f64 besides, and the referee judges each answer in the space in which its kernel found it.

use crate::crowd::{Crowd, Placed};
use crate::judge::{Judge, Triangles};
use crate::stage::trace;
use crate::support::Rng;
use crate::support::shoot::ray;
use luxel::measure::referee::{Found, Verdict};
use luxel::trace::Rays;
use rayon::prelude::*;
use std::ops::AddAssign;

/// What became of rays.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    hits: u64,
    same: u64,
    /// Other triangles, or hit and miss, both within their bounds.
    within: u64,
    outside: u64,
}

impl AddAssign for Count {
    fn add_assign(&mut self, more: Count) {
        self.hits += more.hits;
        self.same += more.same;
        self.within += more.within;
        self.outside += more.outside;
    }
}

fn compare(crowd: &Crowd, rays: &Rays) -> Count {
    let scenes = [&crowd.instanced, &crowd.baked];
    let triangles = scenes.map(Triangles::of);
    let judges = [0, 1].map(|k| Judge::new(scenes[k], &triangles[k]));
    let hits = scenes.map(|scene| trace(scene, rays));
    let one = |i: usize| {
        let names = [0, 1].map(|k| crowd.name(scenes[k], &hits[k], i));
        let mut count = Count {
            hits: u64::from(names[1].is_some()),
            ..Count::default()
        };
        if names[0] == names[1] {
            count.same = 1;
            return count;
        }
        let verdicts = [0, 1].map(|k| judges[k].verdict(rays, &hits[k], i));
        if verdicts.contains(&Verdict::Wrong) {
            println!("ray {i} {:?}: {names:?} {verdicts:?}", ray(rays, i));
            count.outside = 1;
        } else {
            count.within = 1;
        }
        count
    };
    let sum = |mut a: Count, b: Count| {
        a += b;
        a
    };
    (0..rays.len())
        .into_par_iter()
        .map(one)
        .reduce(Count::default, sum)
}

/// Rays in all, of crowds of every kind.
fn run(rounds: u64) -> Count {
    const RAYS: usize = 1_000_000 / Placed::ALL.len() + 1;
    let mut all = Count::default();
    for round in 0..rounds {
        for (k, placed) in Placed::ALL.into_iter().enumerate() {
            let mut rng = Rng(1000 * round + k as u64);
            let crowd = Crowd::new(placed, &mut rng);
            crowd.assert_rounded_once();
            let count = compare(&crowd, &crowd.rays(RAYS, &mut rng));
            if round == 0 {
                println!("{placed:?}: {count:?}");
            }
            all += count;
        }
    }
    println!(
        "{} rays, {} hits: {} the same, {} different within bounds, {} outside",
        all.same + all.within + all.outside,
        all.hits,
        all.same,
        all.within,
        all.outside
    );
    all
}

#[track_caller]
fn assert_good(count: Count) {
    let rays = count.same + count.within + count.outside;
    assert_eq!(count.outside, 0);
    assert!(2 * count.hits > rays && count.within > 0, "{count:?}");
}

#[test]
fn instances_give_the_triangles_of_their_baked_copy() {
    assert_good(run(1));
}

#[test]
#[ignore = "long: a hundred million rays; run with --ignored"]
fn instances_give_the_triangles_of_their_baked_copy_a_hundred_million_times() {
    assert_good(run(100));
}

/// The judge sees what is planted: a mesh that is missed from inside, a t that is off, another triangle.
#[test]
fn wrong_answers_are_outside() {
    let mut rng = Rng(7);
    let crowd = Crowd::new(Placed::Chained, &mut rng);
    let triangles = Triangles::of(&crowd.instanced);
    let judge = Judge::new(&crowd.instanced, &triangles);
    let rays = crowd.rays(4000, &mut rng);
    let hits = trace(&crowd.instanced, &rays);
    for i in (3..rays.len()).step_by(4) {
        let ray = ray(&rays, i);
        let (t, prim) = (hits.t[i], hits.prim[i]);
        assert_ne!(judge.verdict(&rays, &hits, i), Verdict::Wrong, "{ray:?}");
        let planted = [
            None,
            Some((hits.instance[i], Found { t: t + 0.01, prim })),
            Some((hits.instance[i] ^ 1, Found { t, prim: prim / 2 })),
        ];
        for wrong in planted {
            assert_eq!(judge.judge(ray, wrong), Verdict::Wrong, "{ray:?} {wrong:?}");
        }
    }
}
