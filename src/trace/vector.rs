//! Small vector helpers of the scalar stages: SoA access, bases, maps from the square.

use crate::math::{Vec3, sin_cos_turns};

/// Element i of three arrays.
#[inline(always)]
pub(super) fn get(a: &[Vec<f32>; 3], i: usize) -> Vec3 {
    Vec3::new(a[0][i], a[1][i], a[2][i])
}

/// Writes element i of three arrays.
#[inline(always)]
pub(super) fn set(a: &mut [Vec<f32>; 3], i: usize, v: Vec3) {
    a[0][i] = v.x;
    a[1][i] = v.y;
    a[2][i] = v.z;
}

/// Two unit vectors orthogonal to the unit vector n and to each other (Duff et al. 2017, "Building an orthonormal
/// basis, revisited", JCGT 6(1)).
#[inline]
pub(super) fn basis(n: Vec3) -> (Vec3, Vec3) {
    let sign = 1f32.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    (
        Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
        Vec3::new(b, sign + n.y * n.y * a, -n.y),
    )
}

/// A point of the unit disk, uniformly: the concentric map (Shirley and Chiu 1997).
#[inline]
pub(super) fn concentric_disk(u: [f32; 2]) -> [f32; 2] {
    let (x, y) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    if x == 0.0 && y == 0.0 {
        return [0.0, 0.0];
    }
    let (radius, turns) = if x.abs() > y.abs() {
        (x, 0.125 * (y / x))
    } else {
        (y, 0.25 - 0.125 * (x / y))
    };
    let (sin, cos) = sin_cos_turns(turns);
    [radius * cos, radius * sin]
}

/// A direction about the unit normal n with density cos θ / π (Malley's method).
#[inline]
pub(super) fn cosine_hemisphere(n: Vec3, u: [f32; 2]) -> Vec3 {
    let [x, y] = concentric_disk(u);
    let z = (1.0 - x * x - y * y).max(0.0).sqrt();
    let (s, t) = basis(n);
    s * x + t * y + n * z
}

/// Mirror direction of `wo` (pointing away from the surface) about the unit normal n.
#[inline]
pub(super) fn reflect(wo: Vec3, n: Vec3) -> Vec3 {
    n * (2.0 * wo.dot(n)) - wo
}

/// v scaled to unit length.
#[inline]
pub(super) fn unit(v: Vec3) -> Vec3 {
    v * (1.0 / v.length_squared().sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Sampler;
    use crate::trace::sampler::{Pair, sample_pair};
    use crate::trace::test_support::chi_squared;

    #[test]
    fn basis_is_orthonormal() {
        for i in 0..100_000u32 {
            let u = |k: u32| ((i.wrapping_mul(k) >> 7) % 20_011) as f32 / 20_011.0 * 2.0 - 1.0;
            let mut n = Vec3::new(u(2_654_435_761), u(2_246_822_519), u(3_266_489_917));
            if i % 10 == 0 {
                n = Vec3::new(n.x * 1e-4, n.y * 1e-4, -1.0);
            }
            if n.length_squared() == 0.0 {
                continue;
            }
            let n = unit(n);
            let (s, t) = basis(n);
            for (a, b, want) in [
                (s, t, 0.0),
                (s, n, 0.0),
                (t, n, 0.0),
                (s, s, 1.0),
                (t, t, 1.0),
            ] {
                assert!((a.dot(b) - want).abs() < 4e-7, "{n}");
            }
        }
    }

    #[test]
    fn disk_map_keeps_area() {
        let n = 160_000u32;
        let mut rings = [0u32; 10];
        for i in 0..n {
            // An additive recurrence: a grid would line up with the map's own rings.
            let u = [0.754_877_666, 0.569_840_291].map(|a: f64| (f64::from(i) * a).fract() as f32);
            let [x, y] = concentric_disk(u);
            let r2 = x * x + y * y;
            assert!(r2 <= 1.0 + 1e-6);
            rings[((r2 * 10.0) as usize).min(9)] += 1;
        }
        for count in rings {
            assert!(
                (f64::from(count) / f64::from(n) - 0.1).abs() < 2e-3,
                "{rings:?}"
            );
        }
    }

    /// In (1 − cos²θ, φ) a cosine-weighted direction is uniform.
    #[test]
    fn hemisphere_directions_follow_the_cosine() {
        let n = 200_000;
        for normal in [Vec3::Z, -Vec3::Z, unit(Vec3::new(0.3, -0.8, 0.1))] {
            let (s, t) = basis(normal);
            let points = (0..n).map(|i| {
                let dir =
                    cosine_hemisphere(normal, sample_pair(Sampler::Independent, 9, i, Pair::Pixel));
                let [x, y, z] = [dir.dot(s), dir.dot(t), dir.dot(normal)].map(f64::from);
                assert!(z >= 0.0 && (dir.length() - 1.0).abs() < 1e-6);
                [
                    x * x + y * y,
                    (y.atan2(x) / std::f64::consts::TAU).rem_euclid(1.0),
                ]
            });
            let z = chi_squared(20, 32, n, points);
            assert!(z.abs() < 4.0, "z = {z}");
        }
    }
}
