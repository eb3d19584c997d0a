//! Lights without extent.

use glam::DVec3;

pub(crate) enum Bulb {
    Point {
        at: DVec3,
        intensity: DVec3,
    },
    /// Angles in degrees from the axis.
    Spot {
        at: DVec3,
        axis: DVec3,
        intensity: DVec3,
        inner: f64,
        outer: f64,
    },
    Sun {
        towards: DVec3,
        irradiance: DVec3,
    },
}

impl Bulb {
    /// Direction to it, distance, and irradiance of what faces it.
    pub(crate) fn from(&self, here: DVec3) -> (DVec3, f64, DVec3) {
        match *self {
            Bulb::Point { at, intensity } => {
                let way = at - here;
                (
                    way.normalize(),
                    way.length(),
                    intensity / way.length_squared(),
                )
            }
            Bulb::Spot {
                at,
                axis,
                intensity,
                inner,
                outer,
            } => {
                let way = at - here;
                let angle = axis.angle_between(-way).to_degrees();
                let cos = |deg: f64| deg.to_radians().cos();
                let full = if angle <= inner {
                    1.0
                } else if angle >= outer {
                    0.0
                } else {
                    ((cos(angle) - cos(outer)) / (cos(inner) - cos(outer))).powi(2)
                };
                (
                    way.normalize(),
                    way.length(),
                    intensity * full / way.length_squared(),
                )
            }
            Bulb::Sun {
                towards,
                irradiance,
            } => (towards, f64::INFINITY, irradiance),
        }
    }
}
