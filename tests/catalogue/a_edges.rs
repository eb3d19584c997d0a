//! A15: rays that leave a room's walls beside an edge, where rounding may put their start behind the other wall.

use crate::book::{Outcome, items};
use crate::rooms;
use crate::support::leave::surface;
use crate::support::shoot::{best, misses};
use crate::support::{Parts, Rng, Solid};
use luxel::build::bvh::Accel;
use luxel::math::{DAffine3, DQuat, DVec3, Vec3};
use luxel::trace::spawn::offset_origin;
use luxel::trace::{Hits, Rays};

items! {
    a15_edges(2e5, 1e8): "A15", "rays that leave the walls of cubes, octahedra, tetrahedra and wedges of 45° at points of their edges, to any direction inside; turned at random, also as instances, sizes 1e±6, offsets to 100 sizes: misses";
}

/// Rays into one room before the next is made.
const RAYS: usize = 2000;

fn a15_edges(trials: u64) -> Outcome {
    let mut rng = Rng(31);
    let mut outcome = Outcome::default();
    let rooms = [
        rooms::cube(),
        rooms::octahedron(),
        rooms::tetrahedron(),
        rooms::wedge(),
    ];
    for case in 0.. {
        if outcome.trials >= trials {
            break;
        }
        let solid = &rooms[case % rooms.len()];
        outcome.add(leaving(solid, case / rooms.len() % 2 == 1, &mut rng));
    }
    outcome
}

/// Rays from the middle at points of the edges, and on from there to any side that is inside.
fn leaving(solid: &Solid, instanced: bool, rng: &mut Rng) -> Outcome {
    let size = rng.log(-6.0, 6.0).abs();
    let away = DVec3::from([(); 3].map(|()| size * rng.log(-2.0, 2.0)));
    let turn = DQuat::from_xyzw(rng.unit(), rng.unit(), rng.unit(), rng.range(-1.0, 1.0));
    let scale = DVec3::splat(size);
    let place = DAffine3::from_scale_rotation_translation(scale, turn.normalize(), away);
    let at = |v: Vec3| place.transform_point3(v.as_dvec3()).as_vec3();
    let placed = Solid {
        vertices: solid.vertices.iter().map(|&v| at(v)).collect(),
        faces: solid.faces.clone(),
    };
    let parts = match instanced {
        true => Parts {
            meshes: vec![solid.triangles()],
            instances: vec![(0, place)],
            ..Parts::default()
        },
        false => Parts::of(placed.triangles()),
    };
    let scene = parts.scene(Accel::Bvh);
    let middle = placed.vertices.iter().sum::<Vec3>() / placed.vertices.len() as f32;
    let mut rays = Rays::default();
    for _ in 0..RAYS {
        let face = placed.faces[rng.below(placed.faces.len())];
        let [a, b] = [face[0], face[1]].map(|i| placed.vertices[i]);
        let target = a + rng.unit() as f32 * (b - a);
        rays.push(middle.to_array(), (target - middle).to_array(), f32::MAX);
    }
    let hits = best(&scene, &rays);
    let mut on = Rays::default();
    for i in 0..rays.len() {
        assert!(hits.prim[i] != Hits::NONE, "a ray from inside misses");
        let (p, ng) = surface(&scene, &rays, &hits, i);
        let inward = (middle - Vec3::from(p)).dot(Vec3::from(ng)).signum();
        let dir = Vec3::from(rng.direction());
        let side = dir.as_dvec3().dot(Vec3::from(ng).as_dvec3()).signum() as f32;
        let dir = (dir * side * inward).to_array();
        on.push(offset_origin(p, ng, hits.err[i], dir), dir, f32::MAX);
    }
    Outcome::new(on.len(), misses(&best(&scene, &on)))
}
