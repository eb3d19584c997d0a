//! Closed forms in f64. Each has a check value that was found by quadrature or by hand.

use crate::reference::{dielectric, internal_reflectance};
use std::f64::consts::PI;

/// E / (π L) on a plane from a sphere of radius over distance `s` at the zenith angle `theta`, cut by the horizon where
/// it reaches below (configuration factor of a sphere and a tilted element).
pub(crate) fn sphere_light(theta: f64, s: f64) -> f64 {
    let cos = theta.cos();
    if cos >= s {
        return s * s * cos;
    }
    let x = (1.0 / (s * s) - 1.0).sqrt();
    let y = (-x / theta.tan()).clamp(-1.0, 1.0);
    let q = theta.sin() * (1.0 - y * y).sqrt();
    ((cos * y.acos() - x * q) * s * s + (q / x).atan()) / PI
}

/// E / (π L) from a parallel disc of radius r at height h, its axis x aside.
pub(crate) fn disc_light(x: f64, h: f64, r: f64) -> f64 {
    let (x2, h2, r2) = (x * x, h * h, r * r);
    let b = x2 + h2 + r2;
    0.5 * (1.0 - (x2 + h2 - r2) / (b * b - 4.0 * r2 * x2).sqrt())
}

/// Radiance over albedo on a plane under a uniform sky of 1, x aside of where a black ball of radius r rests on it.
pub(crate) fn contact(x: f64, r: f64) -> f64 {
    let q = x / r;
    1.0 - (1.0 + q * q).powf(-1.5)
}

/// Radiance after n bounces in a closed room that emits 1 everywhere.
pub(crate) fn furnace(albedo: f64, n: i32) -> f64 {
    (0..=n).map(|k| albedo.powi(k)).sum()
}

/// Wall radiance of a sphere whose black share f emits.
pub(crate) fn integrating_sphere(f: f64, emission: f64, albedo: f64) -> f64 {
    albedo * f * emission / (1.0 - albedo * (1.0 - f))
}

/// Radiance of the inner and of the outer of two concentric spheres; the inner emits.
pub(crate) fn concentric(ratio: f64, emission: f64, inner: f64, outer: f64) -> (f64, f64) {
    let f = ratio * ratio;
    let k = outer * f / (1.0 - outer * (1.0 - f));
    let l1 = emission / (1.0 - inner * k);
    (l1, k * l1)
}

/// Transmittance of a slab, all inner reflections summed, for one mean reflectance of both polarisations.
pub(crate) fn slab(deg: f64, n: f64) -> f64 {
    let (r, _) = dielectric(deg.to_radians().cos(), n);
    (1.0 - r) / (1.0 + r)
}

/// Radius of the blur on the focal plane.
pub(crate) fn blur(aperture: f64, focus: f64, z: f64) -> f64 {
    aperture * (z - focus).abs() / z
}

#[test]
fn check_values() {
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-7, "{a} is not {b}");
    near(sphere_light(0.7, 0.5), 0.191_210_547);
    near(sphere_light(1.2, 0.9), 0.395_239_788);
    near(sphere_light(1.7, 0.5), 0.015_016_890_5);
    near(disc_light(0.8, 1.3, 0.6), 0.108_017_438);
    near(contact(0.3, 1.0), 0.121_260_289);
    near(furnace(0.5, 60), 2.0);
    near(integrating_sphere(0.1, 5.0, 0.7), 0.945_945_946);
    near(concentric(0.5, 1.0, 0.3, 0.8).0, 1.176_470_588);
    near(concentric(0.5, 1.0, 0.3, 0.8).1, 0.588_235_294);
    for (deg, t) in [
        (0.0, 0.923_077),
        (30.0, 0.920_266),
        (60.0, 0.836_232),
        (80.0, 0.441_229),
    ] {
        assert!((slab(deg, 1.5) - t).abs() < 1e-6);
    }
    near(blur(0.05, 4.0, 6.5), 0.019_230_769_2);
    near(internal_reflectance(1.5), 0.596_345_76);
}
