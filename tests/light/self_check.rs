//! The reference against closed forms: an oracle is no better than its own test.

use crate::closed;
use crate::reference::{
    Camera, Color, Estimator, Filter, Kind, Material, Scene, Shape, Sky, Surface,
    internal_reflectance, render,
};
use crate::stats::{Mean, assert_mean};
use glam::{DMat3, DVec2, DVec3};
use std::rc::Rc;

const BARE: Estimator = Estimator {
    max_bounces: 1,
    lamps: false,
};

/// A pinhole at `eye` that sees a solid angle of almost nothing around `target`.
fn spot(eye: DVec3, target: DVec3) -> Camera {
    let forward = (target - eye).normalize();
    let right = forward.any_orthonormal_vector();
    Camera {
        eye,
        right,
        up: right.cross(forward),
        forward,
        slope: 1e-4,
        aperture: 0.0,
        focus: 1.0,
        width: 8,
        height: 8,
        filter: Filter::Box,
    }
}

fn surface(shape: Shape, kind: Kind, color: f64, emission: f64) -> Surface {
    Surface {
        shape,
        material: Rc::new(Material {
            kind,
            color: Color::Flat(DVec3::splat(color)),
            tinted: false,
            veil: None,
        }),
        emission: Color::Flat(DVec3::splat(emission)),
        tinted_emission: false,
        two_sided: false,
        entity: 0,
    }
}

fn ball(center: DVec3, radius: f64, inverted: bool) -> Shape {
    Shape::Sphere {
        center,
        radius,
        inverted,
        axes: DMat3::IDENTITY,
    }
}

/// A triangle of side about 0.1 around a point of the plane y = 0, facing up.
fn receiver(at: DVec3) -> Shape {
    Shape::Triangle {
        p: [
            at + DVec3::new(-0.1, 0.0, -0.1),
            at + DVec3::new(0.0, 0.0, 0.1),
            at + DVec3::new(0.1, 0.0, -0.1),
        ],
        n: None,
        uv: [DVec2::ZERO; 3],
        more: None,
    }
}

fn check(name: &str, scene: &Scene, estimator: Estimator, spp: u32, truth: f64) {
    let picture = render(scene, estimator, spp, 1);
    assert_mean(name, picture.whole(0), Mean::exact(truth), 0.02);
}

#[test]
fn a_sphere_lights_a_plane_by_chance_and_by_area() {
    for (theta, s) in [(0.7f64, 0.5), (1.2, 0.9), (1.7, 0.5)] {
        let lamp = DVec3::new(theta.sin(), theta.cos(), 0.0) * 4.0;
        let scene = Scene {
            surfaces: vec![
                surface(receiver(DVec3::ZERO), Kind::Diffuse, 0.5, 0.0),
                surface(ball(lamp, 4.0 * s, false), Kind::Nothing, 0.0, 1.0),
            ],
            bulbs: Vec::new(),
            background: Sky::Flat(DVec3::ZERO),
            camera: spot(DVec3::new(-0.4, 0.3, 0.1), DVec3::ZERO),
        };
        let truth = 0.5 * closed::sphere_light(theta, s);
        let spp = if theta > 1.5 { 80_000 } else { 10_000 };
        // Close to a lamp, or where it is all but set, points of its area are hopeless.
        let by_area = theta < 1.0;
        for lamps in [false, true].into_iter().take(1 + usize::from(by_area)) {
            let estimator = Estimator { lamps, ..BARE };
            check("reference, sphere light", &scene, estimator, spp, truth);
        }
    }
}

#[test]
fn a_room_multiplies_light() {
    let room = |inner: f64| Scene {
        surfaces: vec![
            surface(ball(DVec3::ZERO, 2.0, true), Kind::Diffuse, 0.8, 0.0),
            surface(ball(DVec3::ZERO, 1.0, false), Kind::Diffuse, inner, 1.0),
        ],
        bulbs: Vec::new(),
        background: Sky::Flat(DVec3::ZERO),
        camera: spot(DVec3::new(0.0, 0.0, 1.5), DVec3::new(0.0, 0.0, 9.0)),
    };
    let (_, truth) = closed::concentric(0.5, 1.0, 0.3, 0.8);
    for lamps in [false, true] {
        let estimator = Estimator {
            max_bounces: 60,
            lamps,
        };
        check("reference, concentric", &room(0.3), estimator, 2000, truth);
    }
}

#[test]
fn white_things_vanish_in_a_white_sky() {
    let ior = 1.5;
    let plastic = Kind::Plastic {
        ior,
        inner: internal_reflectance(ior),
    };
    let kinds = [
        Kind::Diffuse,
        Kind::Mirror,
        Kind::Metal,
        Kind::Glass { ior },
        Kind::Glass { ior: 0.8 },
        plastic,
    ];
    for kind in kinds {
        let scene = Scene {
            surfaces: vec![surface(ball(DVec3::ZERO, 1.0, false), kind, 1.0, 0.0)],
            bulbs: Vec::new(),
            background: Sky::Flat(DVec3::ONE),
            camera: Camera {
                slope: 0.3,
                ..spot(DVec3::new(0.0, 1.0, 4.0), DVec3::ZERO)
            },
        };
        let estimator = Estimator {
            max_bounces: 400,
            lamps: false,
        };
        check("reference, white ball", &scene, estimator, 200, 1.0);
    }
}
