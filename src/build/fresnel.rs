//! Hemispherical means of dielectric reflectance, for the light that a plastic's coat keeps inside.

use crate::flat::Fresnel;

/// Intervals of Simpson's rule: the error is below 1e-12 for every index of refraction from 1.0001 to 100.
const INTERVALS: u32 = 1024;

/// Mean reflectance for diffuse light from inside: F_int = 1 − (1 − F_ext) / n².
///
/// It follows from reciprocity, F(θ) = F(θ′) along a refracted path, and n² for the solid angle that refraction
/// spreads; n is inside over outside, any value above 0.
pub(crate) fn internal_reflectance(ior: f64, fresnel: Fresnel) -> f64 {
    match fresnel {
        // For n < 1 the same identity reads F_int(n) = F_ext(1/n).
        Fresnel::Exact if ior < 1.0 => exact(1.0 / ior),
        _ => 1.0 - (1.0 - external_reflectance(ior, fresnel)) / (ior * ior),
    }
}

/// Mean reflectance for diffuse light from outside: F_ext = ∫ F 2 cos θ sin θ dθ, 1 where reflection is total.
pub(crate) fn external_reflectance(ior: f64, fresnel: Fresnel) -> f64 {
    let total = (1.0 - ior * ior).max(0.0);
    let partial = match fresnel {
        Fresnel::Exact if ior < 1.0 => ior * ior * exact(1.0 / ior),
        Fresnel::Exact => exact(ior),
        Fresnel::Schlick => schlick(ior, total),
        Fresnel::Off => 0.0,
    };
    total + partial
}

/// F_ext for n ≥ 1 by Simpson's rule. With cos θ = x² the integrand is smooth at grazing angles even for n near 1.
fn exact(ior: f64) -> f64 {
    let f = |i: u32| {
        let x = f64::from(i) / f64::from(INTERVALS);
        4.0 * x * x * x * reflectance(x * x, ior)
    };
    let sum: f64 = (0..INTERVALS / 2)
        .map(|i| f(2 * i) + 4.0 * f(2 * i + 1) + f(2 * i + 2))
        .sum();
    sum / (3.0 * f64::from(INTERVALS))
}

/// Fresnel's equations, unpolarised, for n ≥ 1.
fn reflectance(cos: f64, ior: f64) -> f64 {
    if cos == 0.0 {
        return 1.0;
    }
    let cos_t = (1.0 - (1.0 - cos * cos) / (ior * ior)).max(0.0).sqrt();
    let s = (cos - ior * cos_t) / (cos + ior * cos_t);
    let p = (ior * cos - cos_t) / (ior * cos + cos_t);
    0.5 * (s * s + p * p)
}

/// ∫ (k0 + (1 − k0)(1 − c)⁵) 2c dc from the critical angle (sin² = 1 − c² of it is `1 − total`) to 1, in closed form.
fn schlick(ior: f64, total: f64) -> f64 {
    let k0 = ((ior - 1.0) / (ior + 1.0)) * ((ior - 1.0) / (ior + 1.0));
    let w = 1.0 - total.sqrt();
    let w6 = (w * w * w) * (w * w * w);
    k0 * (1.0 - total) + (1.0 - k0) * w6 * (1.0 / 3.0 - 2.0 * w / 7.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::ln;

    /// F_ext for n > 1 in closed form: Duntley, "The optical properties of diffusing materials", 1942 (by Walsh).
    fn walsh(n: f64) -> f64 {
        let n2 = n * n;
        let n4 = n2 * n2;
        0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0))
            + n2 * (n2 - 1.0) * (n2 - 1.0) / ((n2 + 1.0) * (n2 + 1.0) * (n2 + 1.0))
                * ln((n - 1.0) / (n + 1.0))
            - 2.0 * n2 * n * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0))
            + 8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * (n4 - 1.0) * (n4 - 1.0)) * ln(n)
    }

    #[test]
    fn means_agree_with_the_closed_form() {
        assert!((external_reflectance(1.5, Fresnel::Exact) - 0.091_777_96).abs() < 5e-9);
        assert!((internal_reflectance(1.5, Fresnel::Exact) - 0.596_345_76).abs() < 5e-9);
        for n in [1.1, 1.33, 1.5, 2.4, 10.0] {
            let error = external_reflectance(n, Fresnel::Exact) - walsh(n);
            assert!(error.abs() < 1e-10, "{n}: {error}");
        }
    }

    #[test]
    fn inside_and_outside_are_two_sides_of_one_surface() {
        for fresnel in [Fresnel::Exact, Fresnel::Off] {
            for n in [0.4, 0.99, 1.0, 1.01, 3.0] {
                let swapped = external_reflectance(1.0 / n, fresnel);
                let error = internal_reflectance(n, fresnel) - swapped;
                assert!(error.abs() < 1e-12, "{fresnel:?} {n}: {error}");
            }
        }
        assert_eq!(external_reflectance(1.0, Fresnel::Exact), 0.0);
    }

    #[test]
    fn schlick_is_the_integral_of_its_formula() {
        for n in [0.6, 1.0, 1.5] {
            let k0: f64 = (n - 1.0) / (n + 1.0) * ((n - 1.0) / (n + 1.0));
            let steps = 200_000;
            let mean: f64 = (0..steps)
                .map(|i| {
                    let c = (f64::from(i) + 0.5) / f64::from(steps);
                    let total = 1.0 - c * c > n * n;
                    let w = 1.0 - c;
                    let r = k0 + (1.0 - k0) * (w * w * w * w * w);
                    2.0 * c * if total { 1.0 } else { r } / f64::from(steps)
                })
                .sum();
            let error = external_reflectance(n, Fresnel::Schlick) - mean;
            assert!(error.abs() < 2e-5, "{n}: {error}");
        }
    }
}
