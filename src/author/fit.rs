//! A camera that sees a turning mesh whole: no closer than every point, at every angle of the turn, allows.
//!
//! A point at height y and distance r from the vertical axis turns through a circle. From elevation e, distance d and a
//! look-at point at height h on the axis, with the half-extents of the image plane T at distance 1, the circle's image
//! is widest where cos φ + T cos e sin φ is largest, and highest and lowest where it is nearest and farthest: each edge
//! of the frame gives a lower bound of d that is linear in (r, y), and h shifts weight from the upper to the lower one.

use crate::math::{sin_cos_deg, tan};

/// The frame and the direction to see it from.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    /// Vertical field of view in degrees.
    pub(super) vfov_deg: f64,
    /// Width over height.
    pub(super) aspect: f64,
    /// Degrees above the horizon.
    pub(super) elevation_deg: f64,
    /// Share of the frame that the turn may fill, along either side.
    pub(super) fill: f64,
}

/// Where the camera is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fit {
    /// From the point that it looks at.
    pub(super) distance: f64,
    /// Height on the axis of that point.
    pub(super) look_at: f64,
}

/// The bounds of one edge of the frame: `distance ≥ constant + slope · look_at`.
#[derive(Clone, Copy)]
struct Bound {
    constant: f64,
    slope: f64,
}

impl View {
    /// The nearest camera that sees all `profile` points (distance from the axis, height) through the whole turn.
    pub(super) fn fit(&self, profile: &[(f64, f64)]) -> Fit {
        let half = tan(0.5 * self.vfov_deg.to_radians()) * self.fill;
        let (sin, cos) = sin_cos_deg(self.elevation_deg);
        let most = |f: &dyn Fn(f64, f64) -> f64| {
            let values = profile.iter().map(|&(r, y)| f(r, y));
            values.fold(f64::NEG_INFINITY, f64::max)
        };
        // The nearest (+1) and the farthest (−1) point of each circle, at the edge above (+1) or below (−1).
        let vertical = |edge: f64| {
            let at = |r: f64, y: f64, near: f64| {
                y * sin + near * r * cos + edge * (y * cos - near * r * sin) / half
            };
            Bound {
                constant: most(&|r, y| at(r, y, 1.0).max(at(r, y, -1.0))),
                slope: -sin - edge * cos / half,
            }
        };
        let (above, below) = (vertical(1.0), vertical(-1.0));
        let wide = half * self.aspect;
        let beside = {
            let reach = (1.0 + wide * wide * cos * cos).sqrt() / wide;
            Bound {
                constant: most(&|r, y| y * sin + r * reach),
                slope: -sin,
            }
        };
        // Where the upper and the lower edge are equally near, neither can give way to the other.
        let look_at = (above.constant - below.constant) / (below.slope - above.slope);
        let bounds = [above, below, beside];
        let distances = bounds.map(|b| b.constant + b.slope * look_at);
        Fit {
            distance: distances.into_iter().fold(0.0, f64::max),
            look_at,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest extents of the image of the whole turn, as shares of the frame: right, top, bottom. By brute force.
    fn seen(view: &View, fit: Fit, profile: &[(f64, f64)]) -> [f64; 3] {
        const STEPS: u32 = 3600;
        let half = (0.5 * view.vfov_deg).to_radians().tan();
        let (sin, cos) = view.elevation_deg.to_radians().sin_cos();
        let mut most = [f64::NEG_INFINITY; 3];
        for &(r, y) in profile {
            for i in 0..STEPS {
                let turn = f64::from(i) / f64::from(STEPS) * std::f64::consts::TAU;
                let (x, z) = (r * turn.cos(), r * turn.sin());
                let up = (y - fit.look_at) * cos - z * sin;
                let depth = fit.distance - (y - fit.look_at) * sin - z * cos;
                assert!(depth > 0.0, "behind the camera");
                let image = [
                    x / depth / half / view.aspect,
                    up / depth / half,
                    -up / depth / half,
                ];
                for (most, share) in most.iter_mut().zip(image) {
                    *most = most.max(share);
                }
            }
        }
        most
    }

    #[test]
    fn the_turn_fills_its_share_and_no_more() {
        let shapes: [&[(f64, f64)]; 6] = [
            &[(0.0, 0.0), (5.0, 3.0), (0.1, 10.0)],
            &[(5.0, 0.0)],
            &[(5.0, 0.0), (5.0, 10.0)],
            &[(0.01, 0.0), (0.01, 10.0)],
            &[(0.0, 0.0), (5.0, 9.0), (5.0, 9.5)],
            &[(3.0, 0.0), (5.0, 0.4)],
        ];
        for profile in shapes {
            for (elevation_deg, aspect, vfov_deg) in
                [(14.0, 1.0, 30.0), (35.0, 2.0, 50.0), (5.0, 0.5, 20.0)]
            {
                let fill = 0.8;
                let view = View {
                    vfov_deg,
                    aspect,
                    elevation_deg,
                    fill,
                };
                let fit = view.fit(profile);
                let [right, top, bottom] = seen(&view, fit, profile);
                let most = right.max(top).max(bottom);
                assert!(most <= fill + 1e-9, "{profile:?} {most}");
                assert!(
                    most >= fill - 1e-3,
                    "{profile:?} {most}: it could be nearer"
                );
                if right < most {
                    assert!((top - bottom).abs() < 1e-3, "{profile:?} {top} {bottom}");
                }
            }
        }
    }
}
