//! Reflectance of smooth interfaces.

use super::Fresnel;
use super::vector::V3;
use crate::math::lanes::Lanes;

/// Indices of less are beyond those of glasses and crystals, seen from inside.
const FAR_BELOW: f32 = 0.25;

/// Reflectance and refracted cosine of unpolarised light at a smooth dielectric.
///
/// `cos_i` ≥ 0 is the cosine of incidence, `eta` the index of the far side over that of the near side. The cosine of
/// refraction is 0 when everything is reflected. (Fresnel's equations, mean of both polarisations; Snell's law.)
#[inline]
#[must_use]
pub fn dielectric(mode: Fresnel, cos_i: f32, eta: f32) -> (f32, f32) {
    dielectrics(mode, cos_i, eta)
}

/// [`dielectric`] in lanes.
#[inline(always)]
pub(super) fn dielectrics<L: Lanes>(mode: Fresnel, cos_i: L, eta: L) -> (L, L) {
    let [zero, one] = [L::splat(0.0), L::splat(1.0)];
    // η² cos²θt = η² − 1 + cos²θi: written so, nothing cancels at grazing angles or at indices near 1; and far below 1,
    // nothing near the axis, where alone light passes.
    let scaled = L::select(
        eta.lt(L::splat(FAR_BELOW)),
        eta * eta - (one - cos_i) * (one + cos_i),
        (eta - one) * (eta + one) + cos_i * cos_i,
    );
    let total = scaled.le(zero);
    let cos_t = scaled.sqrt() / eta;
    let r = match mode {
        Fresnel::Exact => {
            let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
            let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
            L::splat(0.5) * (parallel * parallel + perpendicular * perpendicular)
        }
        Fresnel::Schlick => {
            let k = (one - eta) / (one + eta);
            let k0 = k * k;
            k0 + (one - k0) * fifth_power(one - cos_i)
        }
        Fresnel::Off => zero,
    };
    (L::select(total, one, r), L::select(total, zero, cos_t))
}

/// F = c + (1 − c)(1 − cos θ)⁵: what `Metal` is.
#[inline(always)]
#[must_use]
pub(super) fn metal<L: Lanes>(color: V3<L>, cos_i: L) -> V3<L> {
    color + (V3::splat([1.0; 3]) - color) * fifth_power(L::splat(1.0) - cos_i)
}

#[inline(always)]
fn fifth_power<L: Lanes>(x: L) -> L {
    let x2 = x * x;
    x2 * x2 * x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same in f64, by the s and p amplitudes with angles.
    fn exact(cos_i: f64, n: f64) -> f64 {
        let sin_t = (1.0 - cos_i * cos_i).sqrt() / n;
        if sin_t >= 1.0 {
            return 1.0;
        }
        let (i, t) = (cos_i.acos(), sin_t.asin());
        let s = (i.cos() - n * t.cos()) / (i.cos() + n * t.cos());
        let p = (n * i.cos() - t.cos()) / (n * i.cos() + t.cos());
        0.5 * (s * s + p * p)
    }

    #[test]
    fn dielectric_agrees_with_f64() {
        for eta in [
            0.25f32,
            1.0 / 1.5,
            0.999_999,
            1.0,
            1.125,
            1.333,
            1.5,
            2.4,
            4.0,
            1000.0,
        ] {
            for i in 0..=10_000u16 {
                let cos_i = f32::from(i) / 10_000.0;
                let sin2_t = (1.0 - f64::from(cos_i).powi(2)) / f64::from(eta).powi(2);
                let (r, cos_t) = dielectric(Fresnel::Exact, cos_i, eta);
                assert!((0.0..=1.0).contains(&r), "R {r} at {cos_i}, n {eta}");
                // Rounding of the squared cosine, 1 ulp of η² + cos²θi over η², passes through a square root whose slope
                // at the critical angle is infinite.
                let cos2_t = (1.0 - sin2_t).abs();
                let rounding = 1.2e-7 * (1.0 + 1.0 / f64::from(eta * eta));
                let bound = if cos2_t < 1e-5 {
                    2e-2
                } else {
                    3e-7 + 2.0 * rounding / cos2_t.sqrt()
                };
                assert!(
                    (f64::from(r) - exact(f64::from(cos_i), f64::from(eta))).abs() < bound,
                    "{cos_i} {eta}"
                );
                if sin2_t < 1.0 - 1e-5 {
                    let error = (f64::from(cos_t) - cos2_t.sqrt()).abs();
                    assert!(error < 1.2e-7 + rounding / cos2_t.sqrt(), "{cos_i} {eta}");
                }
            }
        }
    }

    /// Of what is left within the critical angle of extreme indices, each cosine of f32.
    #[test]
    fn extreme_indices_agree_with_f64() {
        for eta in [0.01f32, 0.0125, 0.05, 0.1, 0.2] {
            let n = f64::from(eta);
            let critical = (1.0 - n * n).sqrt() as f32;
            let (mut cos_i, mut tried) = (1.0f32, 0);
            while cos_i > critical && tried < 100_000 {
                let c = f64::from(cos_i);
                let cos2_t = (n * n - (1.0 - c) * (1.0 + c)) / (n * n);
                let (r, cos_t) = dielectric(Fresnel::Exact, cos_i, eta);
                if cos2_t > 1e-3 {
                    let error = (f64::from(r) - exact(c, n)).abs();
                    assert!(error < 1e-5, "{cos_i} {eta}: {error}");
                    let error = (f64::from(cos_t) - cos2_t.sqrt()).abs();
                    assert!(error < 4e-6, "{cos_i} {eta}: {error}");
                }
                cos_i = cos_i.next_down();
                tried += 1;
            }
            assert!(tried > 500, "{eta}: {tried}");
        }
    }

    #[test]
    fn normal_incidence_and_schlick() {
        let (r, _) = dielectric(Fresnel::Exact, 1.0, 1.5);
        assert!((r - 0.04).abs() < 1e-7);
        let mut worst = 0f32;
        for i in 0..=1000u16 {
            let c = f32::from(i) / 1000.0;
            worst = worst.max(
                (dielectric(Fresnel::Exact, c, 1.5).0 - dielectric(Fresnel::Schlick, c, 1.5).0)
                    .abs(),
            );
        }
        // The known error of the approximation at n = 1.5.
        assert!((worst - 0.0357).abs() < 2e-4, "{worst}");
    }
}
