//! Keyframes: a value at some times, and between them what `ease` says. A pure function of time.

use super::components::{Ease, Keys, Track, Turn};
use crate::math::{DMat3, DQuat, DVec3, atan2, quaternion, sin};

/// Below this angle in radians, sines of shares of it are the shares themselves in f64.
const STRAIGHT: f64 = 1e-8;

/// Where a time lies among keys.
enum Place {
    /// At a key, or before the first, or behind the last.
    At(usize),
    /// Behind this key, so far on the way to the next: 0 to 1, as time goes, before any ease.
    Between(usize, f64),
}

impl<T> Track<T> {
    fn place(&self, t: f64) -> Option<Place> {
        let last = self.times.len().checked_sub(1)?;
        let behind = self.times.partition_point(|&key| key <= t);
        let at = behind.saturating_sub(1);
        if behind == 0 || at == last || self.times[at] == t || self.ease == Ease::Step {
            return Some(Place::At(at));
        }
        let span = self.times[at + 1] - self.times[at];
        Some(Place::Between(at, (t - self.times[at]) / span))
    }

    /// The shares of a key and the next, and of the tangents between, `share` of the way (glTF 2.0, appendix C).
    fn weights(&self, at: usize, share: f64) -> [f64; 4] {
        let u = share;
        match self.ease {
            Ease::Linear | Ease::Step => [1.0 - u, u, 0.0, 0.0],
            Ease::Smooth => {
                let u = u * u * (3.0 - 2.0 * u);
                [1.0 - u, u, 0.0, 0.0]
            }
            Ease::Spline => {
                let span = self.times[at + 1] - self.times[at];
                let next = u * u * (3.0 - 2.0 * u);
                let leave = u * (1.0 - u) * (1.0 - u);
                let arrive = u * u * (u - 1.0);
                [1.0 - next, next, span * leave, span * arrive]
            }
        }
    }

    /// The tangents with which key `at` is left and the next is reached; 0 for all but splines.
    fn tangents(&self, at: usize) -> [[f64; 4]; 2] {
        match self.tangents.get(at..at + 2) {
            Some([from, to]) => [from[1], to[0]],
            _ => [[0.0; 4]; 2],
        }
    }
}

impl Track<DVec3> {
    /// The value at `t` less the first, and the first; `None` without keys. Apart, so that a scene far from zero gives the
    /// same bits as one near it.
    pub(super) fn since_first(&self, t: f64) -> Option<(DVec3, DVec3)> {
        let first = *self.values.first()?;
        let moved = match self.place(t)? {
            Place::At(at) => self.values[at] - first,
            Place::Between(at, share) => {
                let [_, w, w0, w1] = self.weights(at, share);
                let tangent = |t: [f64; 4]| DVec3::new(t[0], t[1], t[2]);
                let [leave, arrive] = self.tangents(at).map(tangent);
                let way = self.values[at + 1] - self.values[at];
                (self.values[at] - first) + way * w + (leave * w0 + arrive * w1)
            }
        };
        Some((moved, first))
    }

    /// The value at `t`; `None` without keys.
    pub(super) fn at(&self, t: f64) -> Option<DVec3> {
        Some(match self.place(t)? {
            Place::At(at) => self.values[at],
            Place::Between(at, share) => {
                let [w, v, w0, w1] = self.weights(at, share);
                let tangent = |t: [f64; 4]| DVec3::new(t[0], t[1], t[2]);
                let [leave, arrive] = self.tangents(at).map(tangent);
                self.values[at] * w + self.values[at + 1] * v + (leave * w0 + arrive * w1)
            }
        })
    }
}

impl Track<Turn> {
    /// The rotation at `t`; `None` without keys. At a key it is the authored one to the bit.
    pub(super) fn at(&self, t: f64) -> Option<DMat3> {
        Some(match self.place(t)? {
            Place::At(at) => self.values[at].matrix,
            Place::Between(at, share) => {
                let [w, v, w0, w1] = self.weights(at, share);
                let (a, b) = (self.values[at].quaternion, self.values[at + 1].quaternion);
                let q = match self.ease {
                    Ease::Spline => {
                        let [leave, arrive] = self.tangents(at).map(DQuat::from_array);
                        a * w + b * v + leave * w0 + arrive * w1
                    }
                    _ => slerp(a, b, v),
                };
                quaternion(q.to_array())
            }
        })
    }
}

impl Turn {
    /// From a rotation matrix. Only +, −, ×, ÷ and √.
    #[must_use]
    pub fn of_matrix(matrix: DMat3) -> Turn {
        Turn {
            matrix,
            quaternion: DQuat::from_mat3(&matrix),
        }
    }

    /// From a quaternion x, y, z, w of any length above 0.
    #[must_use]
    pub fn of_quaternion(q: [f64; 4]) -> Turn {
        let largest = q.iter().fold(0.0f64, |m, c| m.max(c.abs()));
        let q = DQuat::from_array(q.map(|c| c / largest));
        Turn {
            matrix: quaternion(q.to_array()),
            quaternion: q * (1.0 / q.dot(q).sqrt()),
        }
    }
}

/// From unit quaternion `a` to `b`, the shorter way, at constant speed (Shoemake 1985). Half a turn has no shorter way: it
/// goes the one that the signs of the quaternions say.
fn slerp(a: DQuat, b: DQuat, u: f64) -> DQuat {
    let b = if a.dot(b) < 0.0 { -b } else { b };
    let length = |q: DQuat| q.dot(q).sqrt();
    let angle = 2.0 * atan2(length(b - a), length(b + a));
    if angle < STRAIGHT {
        return a * (1.0 - u) + b * u;
    }
    let whole = sin(angle);
    a * (sin((1.0 - u) * angle) / whole) + b * (sin(u * angle) / whole)
}

impl Keys {
    /// Every time at which something has a key.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        let Keys {
            translate,
            rotate,
            scale,
        } = self;
        let all = [&translate.times, &rotate.times, &scale.times];
        all.into_iter().flatten().copied()
    }

    /// The same motion of a root in a world that is `scale` times as large and moved by `shift`.
    #[must_use]
    pub fn placed(&self, by: f64, shift: DVec3) -> Keys {
        let mut keys = self.clone();
        let larger = |t: &mut [[f64; 4]; 2]| *t = t.map(|t| t.map(|x| x * by));
        keys.translate
            .values
            .iter_mut()
            .for_each(|v| *v = *v * by + shift);
        keys.translate.tangents.iter_mut().for_each(larger);
        keys.scale.values.iter_mut().for_each(|v| *v *= by);
        keys.scale.tangents.iter_mut().for_each(larger);
        keys
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::axis_angle_deg;

    fn track<T>(keys: Vec<(f64, T)>, ease: Ease) -> Track<T> {
        let (times, values) = keys.into_iter().unzip();
        Track {
            times,
            values,
            tangents: Vec::new(),
            ease,
        }
    }

    fn about_y(deg: f64) -> Turn {
        Turn::of_matrix(axis_angle_deg(DVec3::Y, deg))
    }

    #[test]
    fn numbers_go_as_their_ease_says() {
        let at = |ease, t| {
            let keys = vec![(1.0, DVec3::ZERO), (3.0, DVec3::X), (4.0, DVec3::Y)];
            track(keys, ease).at(t).expect("keys")
        };
        for ease in [Ease::Linear, Ease::Smooth, Ease::Step] {
            for (t, wanted) in [
                (-9.0, DVec3::ZERO),
                (1.0, DVec3::ZERO),
                (3.0, DVec3::X),
                (9.0, DVec3::Y),
            ] {
                assert_eq!(at(ease, t), wanted, "{ease:?} {t}");
            }
        }
        assert_eq!(at(Ease::Linear, 1.5), DVec3::X * 0.25);
        assert_eq!(at(Ease::Smooth, 1.5), DVec3::X * 0.15625);
        assert_eq!(at(Ease::Smooth, 2.0), DVec3::X * 0.5);
        assert_eq!(at(Ease::Step, 2.999), DVec3::ZERO);
        assert_eq!(at(Ease::Step, 3.5), DVec3::X);
        assert_eq!(
            track(Vec::<(f64, DVec3)>::new(), Ease::Linear).at(0.0),
            None
        );
    }

    #[test]
    fn rotations_turn_at_constant_speed_the_shorter_way() {
        for (from, to) in [
            (0.0, 90.0),
            (0.0, 179.0),
            (350.0, 10.0),
            (20.0, -120.0),
            (5.0, 5.0),
        ] {
            let turned = track(vec![(0.0, about_y(from)), (2.0, about_y(to))], Ease::Linear);
            let mut way: f64 = to - from;
            way -= 360.0 * (way / 360.0).round();
            for share in [0.1, 0.25, 0.5, 0.9] {
                let wanted = axis_angle_deg(DVec3::Y, from + way * share);
                let found = turned.at(2.0 * share).expect("keys");
                let error = (found - wanted)
                    .to_cols_array()
                    .iter()
                    .fold(0.0f64, |m, x| m.max(x.abs()));
                assert!(error < 1e-15 * 4.0, "{from} to {to} at {share}: {error:e}");
            }
            assert_eq!(turned.at(0.0), Some(about_y(from).matrix), "exact at a key");
            assert_eq!(turned.at(2.0), Some(about_y(to).matrix));
        }
    }

    #[test]
    fn splines_are_those_of_gltf() {
        // A cubic is its own spline: x(t) = t³ − 2t² + 3 with x'(t) = 3t² − 4t, keys at 1 and 3.
        let (x, slope) = (
            |t: f64| t * t * t - 2.0 * t * t + 3.0,
            |t: f64| 3.0 * t * t - 4.0 * t,
        );
        let spline = Track {
            times: vec![1.0, 3.0],
            values: [1.0, 3.0].map(|t| DVec3::splat(x(t))).to_vec(),
            tangents: [1.0, 3.0].map(|t| [[slope(t); 4]; 2]).to_vec(),
            ease: Ease::Spline,
        };
        for t in [1.0, 1.25, 2.0, 2.7, 3.0] {
            let found = spline.at(t).expect("keys").y;
            assert!((found - x(t)).abs() < 1e-14, "{t}: {found}");
            let (moved, first) = spline.since_first(t).expect("keys");
            assert!(((first + moved).z - x(t)).abs() < 1e-14);
        }
    }
}
