//! Rotations in f64 from angles in degrees: quarter turns are exact, and a full turn is the identity to the bit.

use super::{DMat3, DVec3, sin_cos};

/// Radians in a degree.
const RADIANS: f64 = std::f64::consts::PI / 180.0;

/// Sine and cosine of an angle in degrees; exact at multiples of 90°, periodic to the bit. NaN for non-finite angles.
///
/// The remainder of a division and the subtraction of the nearest quarter turn are both exact in floating point (the
/// latter by Sterbenz' lemma), so nothing is lost before the kernels see an angle in [−45°, 45°].
#[must_use]
pub fn sin_cos_deg(deg: f64) -> (f64, f64) {
    let turn = deg % 360.0;
    let quarter = (turn / 90.0).round();
    let (s, c) = sin_cos((turn - 90.0 * quarter) * RADIANS);
    // 0 − x instead of −x: no negative zeros, so that equal rotations have equal bits.
    match quarter as i32 {
        1 | -3 => (c, 0.0 - s),
        2 | -2 => (0.0 - s, 0.0 - c),
        3 | -1 => (0.0 - c, s),
        _ => (s, c),
    }
}

/// The vector divided by its length, for any finite length above 0 (no overflow, no underflow); `None` otherwise.
#[must_use]
pub fn unit(v: DVec3) -> Option<DVec3> {
    let largest = v.abs().max_element();
    if !v.is_finite() || largest == 0.0 {
        return None;
    }
    let v = v / largest;
    Some(v / v.dot(v).sqrt())
}

/// R = Rz · Ry · Rx for degrees about x, y and z.
#[must_use]
pub fn euler_deg(deg: DVec3) -> DMat3 {
    let (sx, cx) = sin_cos_deg(deg.x);
    let (sy, cy) = sin_cos_deg(deg.y);
    let (sz, cz) = sin_cos_deg(deg.z);
    DMat3::from_cols(
        DVec3::new(cz * cy, sz * cy, 0.0 - sy),
        DVec3::new(cz * sy * sx - sz * cx, sz * sy * sx + cz * cx, cy * sx),
        DVec3::new(cz * sy * cx + sz * sx, sz * sy * cx - cz * sx, cy * cx),
    )
}

/// Rotation by `deg` degrees about `axis` (any length), counter-clockwise seen against it, by Rodrigues' formula. An
/// axis without a direction gives the identity.
#[must_use]
pub fn axis_angle_deg(axis: DVec3, deg: f64) -> DMat3 {
    let Some(u) = unit(axis) else {
        return DMat3::IDENTITY;
    };
    let (s, c) = sin_cos_deg(deg);
    let k = 1.0 - c;
    let column = |e: DVec3| c * e + s * u.cross(e) + k * u.dot(e) * u;
    DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
}

/// Rotation of the quaternion x, y, z, w of any length; the identity for one without a direction.
#[must_use]
pub fn quaternion(q: [f64; 4]) -> DMat3 {
    let largest = q.iter().fold(0.0f64, |m, c| m.max(c.abs()));
    if !q.iter().all(|c| c.is_finite()) || largest == 0.0 {
        return DMat3::IDENTITY;
    }
    let [x, y, z, w] = q.map(|c| c / largest);
    let s = 2.0 / (x * x + y * y + z * z + w * w);
    DMat3::from_cols(
        DVec3::new(
            1.0 - s * (y * y + z * z),
            s * (x * y + z * w),
            s * (x * z - y * w),
        ),
        DVec3::new(
            s * (x * y - z * w),
            1.0 - s * (x * x + z * z),
            s * (y * z + x * w),
        ),
        DVec3::new(
            s * (x * z + y * w),
            s * (y * z - x * w),
            1.0 - s * (x * x + y * y),
        ),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        for k in -9..9 {
            let (s, c) = sin_cos_deg(90.0 * f64::from(k) + 360e9);
            let expected = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][(k & 3) as usize];
            assert_eq!((s, c), expected);
            assert!(s.to_bits() != (-0.0f64).to_bits() && c.to_bits() != (-0.0f64).to_bits());
        }
        let quarter = axis_angle_deg(DVec3::new(0.0, 1e-300, 0.0), 90.0);
        assert_eq!(quarter * DVec3::X, DVec3::NEG_Z);
        assert_eq!(
            axis_angle_deg(DVec3::new(1.0, -2.0, 0.3), -720.0),
            DMat3::IDENTITY
        );
        assert_eq!(euler_deg(DVec3::new(90.0, 0.0, 90.0)) * DVec3::Z, DVec3::X);
    }

    #[test]
    fn any_angle_is_that_of_the_library() {
        for i in -2000..2000 {
            let deg = f64::from(i) * 0.737;
            let (s, c) = sin_cos_deg(deg);
            let t = sin_cos(deg.to_radians());
            assert!((s - t.0).abs() < 1e-14 && (c - t.1).abs() < 1e-14, "{deg}");
            assert!((s * s + c * c - 1.0).abs() < 4e-16, "{deg}");
        }
    }

    #[test]
    fn directions_have_any_length() {
        for size in [1e-300, 1e-20, 1.0, 1e20, 1e300] {
            let u = unit(DVec3::new(3.0, 0.0, -4.0) * size).unwrap_or_default();
            assert!((u - DVec3::new(0.6, 0.0, -0.8)).length() < 1e-15, "{size}");
            let half = quaternion([0.0, 0.0, size, size]);
            assert!((half * DVec3::X - DVec3::Y).length() < 1e-15, "{size}");
        }
        assert_eq!(unit(DVec3::ZERO), None);
        assert_eq!(unit(DVec3::new(f64::NAN, 1.0, 0.0)), None);
        assert_eq!(quaternion([0.0; 4]), DMat3::IDENTITY);
    }
}
