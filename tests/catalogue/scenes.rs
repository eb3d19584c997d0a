//! Twenty scenes of about a thousand primitives, each hard in its own way, and rays at them.

use crate::support::shoot::soup;
use crate::support::{Parts, Rng, Solid};
use luxel::math::{DAffine3, DQuat, DVec3, Vec3};
use luxel::trace::Rays;

type Named = (&'static str, Parts);

pub(crate) fn twenty() -> Vec<Named> {
    let mut rng = Rng(50);
    let ball = Solid::icosphere(3);
    let at = |x: f32| Vec3::new(x, -x, 0.5 * x);
    let meshes = [
        ("soup", soup(&mut rng, 1200, 1.0, 0.1)),
        ("dense soup", soup(&mut rng, 600, 1.0, 1.0)),
        ("ball", ball.triangles()),
        ("ball of poles", Solid::uv_sphere(24, 24).triangles()),
        (
            "star",
            Solid::star(3, &mut rng).placed(0.2, Vec3::ZERO).triangles(),
        ),
        ("torus", Solid::torus(20, 32).triangles()),
        ("lattice", lattice(24)),
        ("slivers", slivers(&mut rng, 1000)),
        ("stack", stack(&mut rng)),
        (
            "in a plane",
            soup(&mut rng, 800, 1.0, 0.2)
                .iter()
                .map(|t| t.map(|v| v.with_z(0.25)))
                .collect(),
        ),
        ("concentric", concentric(400)),
        ("far", ball.placed(1.0, at(1e5)).triangles()),
        ("tiny", ball.placed(1e-6, Vec3::ZERO).triangles()),
        ("huge", ball.placed(1e6, Vec3::ZERO).triangles()),
        (
            "many sizes",
            (0..900).map(|i| many_sizes(&mut rng, i)).collect(),
        ),
    ];
    let mut all: Vec<Named> = meshes
        .into_iter()
        .map(|(name, triangles)| (name, Parts::of(triangles)))
        .collect();
    all.extend(with_spheres(&mut rng));
    assert_eq!(all.len(), 20);
    all
}

fn lattice(n: i32) -> Vec<[Vec3; 3]> {
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..n {
            let p = |x: i32, y: i32| Vec3::new((i + x) as f32, (j + y) as f32, 0.0) / 16.0 - 0.75;
            triangles.extend([[p(0, 0), p(1, 0), p(1, 1)], [p(0, 0), p(1, 1), p(0, 1)]]);
        }
    }
    triangles
}

fn slivers(rng: &mut Rng, n: usize) -> Vec<[Vec3; 3]> {
    let sliver = |rng: &mut Rng| {
        let a = Vec3::from(rng.in_cube(1.0));
        let along = Vec3::from(rng.direction());
        let thin = Vec3::from(rng.direction()) * rng.log(-7.0, -1.0) as f32;
        [a, a + along, a + 0.5 * along + thin]
    };
    (0..n).map(|_| sliver(rng)).collect()
}

/// The same few triangles many times, turned over or rotated in their corners.
fn stack(rng: &mut Rng) -> Vec<[Vec3; 3]> {
    let few = soup(rng, 20, 1.0, 1.0);
    (0..1000)
        .map(|i| {
            let [a, b, c] = few[rng.below(few.len())];
            [[a, b, c], [a, c, b], [b, c, a]][i % 3]
        })
        .collect()
}

fn concentric(n: usize) -> Vec<[Vec3; 3]> {
    (1..=n)
        .map(|i| {
            let s = i as f32 / n as f32;
            [[-s, -s, 0.1 * s], [s, -s, 0.0], [0.0, s, -0.1 * s]].map(Vec3::from)
        })
        .collect()
}

fn many_sizes(rng: &mut Rng, i: usize) -> [Vec3; 3] {
    let size = 2f64.powi(-(i as i32 % 40));
    let middle = Vec3::from(rng.in_cube(1.0)) * size.sqrt() as f32;
    [(); 3].map(|()| middle + Vec3::from(rng.in_cube(size)))
}

fn with_spheres(rng: &mut Rng) -> Vec<Named> {
    let spheres = |rng: &mut Rng, n: usize, low: f64, high: f64| -> Vec<([f64; 3], f64)> {
        let one = |rng: &mut Rng| (rng.in_cube(1.0).map(f64::from), rng.log(low, high).abs());
        (0..n).map(|_| one(rng)).collect()
    };
    let nested = (0..200).map(|k| ([0.0; 3], 1.0 - 1e-6 * f64::from(k)));
    let turn = DQuat::from_xyzw(0.1, 0.5, -0.3, 0.8).normalize();
    let place = |rng: &mut Rng, mirror: f64| {
        let s = DVec3::new(mirror * 0.3, 0.1 + 0.3 * rng.unit(), 0.3);
        DAffine3::from_scale_rotation_translation(
            s,
            turn,
            DVec3::from(rng.in_cube(1.0).map(f64::from)),
        )
    };
    let instances: Vec<(usize, DAffine3)> = (0..12)
        .map(|i| (i % 2, place(rng, if i % 3 == 0 { -1.0 } else { 1.0 })))
        .collect();
    let local = vec![Solid::icosphere(2).triangles(), soup(rng, 100, 1.0, 0.5)];
    vec![
        (
            "balls",
            Parts {
                tree_spheres: spheres(rng, 1000, -3.0, -0.7),
                ..Parts::default()
            },
        ),
        (
            "shells",
            Parts {
                tree_spheres: nested.collect(),
                ..Parts::default()
            },
        ),
        (
            "room",
            Parts {
                looped: vec![
                    ([0.0, -1e5 - 1.5, 0.0], 1e5),
                    ([0.0, 0.0, 1e3 + 1.5], 1e3),
                    ([1e8 + 1.5, 0.0, 0.0], 1e8),
                ],
                tree_spheres: spheres(rng, 300, -2.0, -0.5),
                ..Parts::default()
            },
        ),
        (
            "instances",
            Parts {
                meshes: local.clone(),
                instances: instances.clone(),
                ..Parts::default()
            },
        ),
        (
            "everything",
            Parts {
                triangles: soup(rng, 500, 1.0, 0.3),
                tree_spheres: spheres(rng, 200, -2.0, -0.7),
                looped: vec![([0.0, -1e4 - 1.5, 0.0], 1e4)],
                meshes: local,
                instances,
                ..Parts::default()
            },
        ),
    ]
}

/// Rays at a scene: at its vertices and at anything, from near and from its own vertices, some along the axes, some with an
/// end.
pub(crate) fn rays_at(parts: &Parts, n: usize, rng: &mut Rng) -> Rays {
    let of_all = parts.triangles.iter().flatten();
    let size = of_all
        .clone()
        .fold(0.0f32, |m, v| m.max(v.abs().max_element()));
    let size = if parts.triangles.is_empty() {
        1.0
    } else {
        size
    };
    let middle = match parts.triangles.len() {
        0 => Vec3::ZERO,
        n => of_all.map(|v| *v / (3 * n) as f32).sum(),
    };
    let reach = f64::from(
        (parts.triangles.iter().flatten())
            .fold(0.0f32, |m, v| m.max((*v - middle).abs().max_element())),
    );
    let reach = if reach > 0.0 { reach } else { f64::from(size) };
    let mut rays = Rays::default();
    for i in 0..n {
        let some = |rng: &mut Rng| middle + Vec3::from(rng.in_cube(1.5 * reach));
        let vertex = |rng: &mut Rng| match parts.triangles.len() {
            0 => some(rng),
            n => parts.triangles[rng.below(n)][rng.below(3)],
        };
        let target = if i % 3 == 0 { some(rng) } else { vertex(rng) };
        let origin = if i % 5 == 0 { vertex(rng) } else { some(rng) };
        let mut dir = target - origin;
        if i % 7 == 0 {
            dir = dir.with_x(0.0);
        }
        if i % 11 == 0 {
            dir = Vec3::AXES[i % 3] * if i % 2 == 0 { 1.0 } else { -1.0 };
        }
        let t_max = if i % 13 == 0 {
            rng.range(0.0, 1.5) as f32
        } else {
            f32::MAX
        };
        rays.push(origin.to_array(), dir.to_array(), t_max);
    }
    rays
}
