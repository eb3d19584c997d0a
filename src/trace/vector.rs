//! Vectors in lanes, bases, maps from the square, and single elements of SoA vectors.

use super::chunk::WIDEST;
use crate::math::Vec3;
use crate::math::lanes::{BitLanes, Lanes, Words};
use std::ops::{Add, Div, Mul, Neg, Sub};

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

/// A vector of each lane.
#[derive(Clone, Copy)]
pub(super) struct V3<L>(pub(super) [L; 3]);

impl<L: Lanes> Add for V3<L> {
    type Output = V3<L>;
    #[inline(always)]
    fn add(self, V3(b): V3<L>) -> V3<L> {
        let V3(a) = self;
        V3([a[0] + b[0], a[1] + b[1], a[2] + b[2]])
    }
}

impl<L: Lanes> Sub for V3<L> {
    type Output = V3<L>;
    #[inline(always)]
    fn sub(self, V3(b): V3<L>) -> V3<L> {
        let V3(a) = self;
        V3([a[0] - b[0], a[1] - b[1], a[2] - b[2]])
    }
}

/// By component.
impl<L: Lanes> Mul for V3<L> {
    type Output = V3<L>;
    #[inline(always)]
    fn mul(self, V3(b): V3<L>) -> V3<L> {
        let V3(a) = self;
        V3([a[0] * b[0], a[1] * b[1], a[2] * b[2]])
    }
}

impl<L: Lanes> Mul<L> for V3<L> {
    type Output = V3<L>;
    #[inline(always)]
    fn mul(self, s: L) -> V3<L> {
        let V3(a) = self;
        V3([a[0] * s, a[1] * s, a[2] * s])
    }
}

/// By component.
impl<L: Lanes> Div for V3<L> {
    type Output = V3<L>;
    #[inline(always)]
    fn div(self, V3(b): V3<L>) -> V3<L> {
        let V3(a) = self;
        V3([a[0] / b[0], a[1] / b[1], a[2] / b[2]])
    }
}

impl<L: Lanes> Div<L> for V3<L> {
    type Output = V3<L>;
    #[inline(always)]
    fn div(self, s: L) -> V3<L> {
        let V3(a) = self;
        V3([a[0] / s, a[1] / s, a[2] / s])
    }
}

impl<L: Lanes> Neg for V3<L> {
    type Output = V3<L>;
    #[inline(always)]
    fn neg(self) -> V3<L> {
        let V3(a) = self;
        V3([-a[0], -a[1], -a[2]])
    }
}

impl<L: Lanes> V3<L> {
    #[inline(always)]
    pub(super) fn splat(v: [f32; 3]) -> V3<L> {
        V3([L::splat(v[0]), L::splat(v[1]), L::splat(v[2])])
    }

    /// The first elements of three arrays.
    #[inline(always)]
    pub(super) fn load([x, y, z]: &[[f32; WIDEST]; 3]) -> V3<L> {
        V3([L::load(x), L::load(y), L::load(z)])
    }

    /// The same in f64.
    #[inline(always)]
    pub(super) fn widen(self) -> [L::Wide; 3] {
        let V3([x, y, z]) = self;
        [x.widen(), y.widen(), z.widen()]
    }

    /// Rounded to f32.
    #[inline(always)]
    pub(super) fn narrow([x, y, z]: [L::Wide; 3]) -> V3<L> {
        V3([L::narrow(x), L::narrow(y), L::narrow(z)])
    }

    #[inline(always)]
    pub(super) fn dot(self, V3(b): V3<L>) -> L {
        let V3(a) = self;
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    #[inline(always)]
    pub(super) fn select(mask: L::Mask, V3(yes): V3<L>, V3(no): V3<L>) -> V3<L> {
        V3([
            L::select(mask, yes[0], no[0]),
            L::select(mask, yes[1], no[1]),
            L::select(mask, yes[2], no[2]),
        ])
    }

    /// Lanes of which some component is above 0.
    #[inline(always)]
    pub(super) fn any_positive(self) -> L::Mask {
        let (V3(a), zero) = (self, L::splat(0.0));
        zero.lt(a[0]) | zero.lt(a[1]) | zero.lt(a[2])
    }

    /// Lanes of which every component is finite.
    #[inline(always)]
    pub(super) fn finite(self) -> L::Mask {
        let (V3(a), infinite) = (self, L::splat(f32::INFINITY));
        a[0].abs().lt(infinite) & a[1].abs().lt(infinite) & a[2].abs().lt(infinite)
    }

    /// Scaled to unit length.
    #[inline(always)]
    pub(super) fn unit(self) -> V3<L> {
        self * (L::splat(1.0) / self.dot(self).sqrt())
    }
}

impl From<Vec3> for V3<f32> {
    #[inline(always)]
    fn from(v: Vec3) -> V3<f32> {
        V3(v.to_array())
    }
}

impl From<V3<f32>> for Vec3 {
    #[inline(always)]
    fn from(V3(v): V3<f32>) -> Vec3 {
        Vec3::from(v)
    }
}

/// The magnitude of 1, the sign of `x`.
#[inline(always)]
fn sign<L: BitLanes>(x: L) -> L {
    let sign = x.to_bits().and(Words::splat(1 << 31));
    L::from_bits(sign.or(Words::splat(1f32.to_bits())))
}

/// Two unit vectors orthogonal to the unit vector n and to each other (Duff et al. 2017, "Building an orthonormal
/// basis, revisited", JCGT 6(1)).
#[inline(always)]
pub(super) fn basis<L: BitLanes>(V3([x, y, z]): V3<L>) -> (V3<L>, V3<L>) {
    let (one, sign) = (L::splat(1.0), sign(z));
    let a = -one / (sign + z);
    let b = x * y * a;
    (
        V3([one + sign * x * x * a, sign * b, -sign * x]),
        V3([b, sign + y * y * a, -y]),
    )
}

/// Sine and cosine of `turns` · 2π, for `turns` in [−1, 1]: [`crate::math::sin_cos_turns`] in lanes, to the bit.
#[inline(always)]
pub(super) fn sin_cos_turns<L: BitLanes>(turns: L) -> (L, L) {
    let word = |x| <L::Bits as Words>::splat(x);
    let f = L::splat;
    // Exact: eight more than a multiple of a quarter, and what is left in [−1/8, 1/8].
    let quarter = (turns * f(4.0) + f(8.5)).to_words();
    let r = (turns - (L::from_words(quarter) - f(8.0)) * f(0.25)) * f(std::f32::consts::TAU);
    let x = r * r;
    let s = r + r
        * x
        * (f(-1.0 / 6.0) + x * (f(1.0 / 120.0) + x * (f(-1.0 / 5_040.0) + x * f(1.0 / 362_880.0))));
    let c = f(1.0)
        + x * (f(-0.5) + x * (f(1.0 / 24.0) + x * (f(-1.0 / 720.0) + x * f(1.0 / 40_320.0))));
    let odd = f(0.5).lt(L::from_words(quarter.and(word(1))));
    let (sin, cos) = (L::select(odd, c, s), L::select(odd, s, c));
    (turned(sin, quarter), turned(cos, quarter.plus(word(1))))
}

/// With the other sign where the second bit of `quarter` is set.
#[inline(always)]
fn turned<L: BitLanes>(x: L, quarter: L::Bits) -> L {
    let sign = quarter.and(Words::splat(2)).up::<30>();
    L::from_bits(x.to_bits().xor(sign))
}

/// A point of the unit disk, uniformly: the concentric map (Shirley and Chiu 1997).
#[inline(always)]
pub(super) fn concentric_disk<L: BitLanes>(u: [L; 2]) -> [L; 2] {
    let (zero, f) = (L::splat(0.0), L::splat);
    let (x, y) = (f(2.0) * u[0] - f(1.0), f(2.0) * u[1] - f(1.0));
    let wide = y.abs().lt(x.abs());
    let radius = L::select(wide, x, y);
    let slope = f(0.125) * (L::select(wide, y, x) / radius);
    let turns = L::select(wide, slope, f(0.25) - slope);
    // 0 / 0 in the middle.
    let middle = x.abs().le(zero) & y.abs().le(zero);
    let (sin, cos) = sin_cos_turns(L::select(middle, zero, turns));
    [radius * cos, radius * sin]
}

/// The least cos² θ of a direction about a normal: sample numbers keep 2⁻²⁴ away from 0 and 1, so that points of the disk
/// keep 2⁻²³ away from its rim. Rounding alone may put them onto it, and a path along the surface would end.
const RIM: f32 = 1.0 / (1u32 << 22) as f32;

/// A direction about the unit normal n with density cos θ / π (Malley's method).
#[inline(always)]
pub(super) fn cosine_hemisphere<L: BitLanes>(n: V3<L>, u: [L; 2]) -> V3<L> {
    let [x, y] = concentric_disk(u);
    let z = (L::splat(1.0) - x * x - y * y).max(L::splat(RIM)).sqrt();
    let (s, t) = basis(n);
    s * x + t * y + n * z
}

/// Mirror direction of `wo` (pointing away from the surface) about the unit normal n.
#[inline(always)]
pub(super) fn reflect<L: Lanes>(wo: V3<L>, n: V3<L>) -> V3<L> {
    n * (L::splat(2.0) * wo.dot(n)) - wo
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
            let (s, t) = basis(V3::from(n));
            let (s, t) = (Vec3::from(s), Vec3::from(t));
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

    #[test]
    fn turns_have_the_bits_of_one() {
        for i in 0..=200_000u32 {
            let turns = i as f32 / 100_000.0 - 1.0;
            let [a, b] = [sin_cos_turns(turns), crate::math::sin_cos_turns(turns)];
            assert_eq!(
                (a.0.to_bits(), a.1.to_bits()),
                (b.0.to_bits(), b.1.to_bits()),
                "{turns}"
            );
        }
    }

    /// All along the border of the square of sample numbers, directions still leave the surface.
    #[test]
    fn no_direction_lies_in_the_surface() {
        let least = 1.0 / (1u32 << 24) as f32;
        let normal = V3::from(unit(Vec3::new(0.3, -0.8, 0.1)));
        for i in 0..1u32 << 18 {
            let along = (i as f32 + 0.5) / (1u32 << 18) as f32;
            for end in [least, 1.0 - least] {
                for u in [[along, end], [end, along]] {
                    let cos = cosine_hemisphere(normal, u).dot(normal);
                    assert!(cos > 4e-4, "{u:?}: {cos}");
                }
            }
        }
    }

    /// In (1 − cos²θ, φ) a cosine-weighted direction is uniform.
    #[test]
    fn hemisphere_directions_follow_the_cosine() {
        let n = 200_000;
        for normal in [Vec3::Z, -Vec3::Z, unit(Vec3::new(0.3, -0.8, 0.1))] {
            let (s, t) = basis(V3::from(normal));
            let (s, t) = (Vec3::from(s), Vec3::from(t));
            let points = (0..n).map(|i| {
                let u = sample_pair(Sampler::Independent, 9, i, Pair::Pixel);
                let dir = Vec3::from(cosine_hemisphere(V3::from(normal), u));
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
