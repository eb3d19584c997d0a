use super::plane::{Ends, STARTS, Shape, Way};
use crate::flat::Bounces;
use crate::math::{DVec2, DVec3};
use crate::trace::Sampler::Independent;
use crate::trace::sampler::{Pair, sample_pair};

/// A chain's spheres in f64: index of the outer one, radius and index of the inner one.
#[derive(Clone, Copy)]
struct Ball {
    ior: f64,
    inner: Option<(f64, f64)>,
    bounces: Bounces,
}

const BALLS: [Ball; 7] = [
    Ball {
        ior: 1.5,
        inner: None,
        bounces: Bounces::Through,
    },
    Ball {
        ior: 1.33,
        inner: None,
        bounces: Bounces::Through,
    },
    Ball {
        ior: 1.0 / 1.5,
        inner: None,
        bounces: Bounces::Through,
    },
    Ball {
        ior: 1.5,
        inner: Some((0.9, 1.0 / 1.5)),
        bounces: Bounces::ThroughBoth,
    },
    Ball {
        ior: 1.5,
        inner: Some((0.9, 1.0 / 1.5)),
        bounces: Bounces::Inside,
    },
    Ball {
        ior: 1.5,
        inner: None,
        bounces: Bounces::Glass,
    },
    Ball {
        ior: 1.0,
        inner: None,
        bounces: Bounces::Mirror,
    },
];

impl Ball {
    fn shape(&self) -> Shape<f32> {
        let (ratio, inner) = self.inner.unwrap_or((2.0, 1.0));
        let mut greatest: f64 = 1.0;
        if !matches!(self.bounces, Bounces::Glass | Bounces::Mirror) {
            greatest = greatest.min(self.ior);
            if self.inner.is_some() {
                greatest = greatest.min(ratio * self.ior);
            }
            if self.bounces == Bounces::ThroughBoth {
                greatest = greatest.min(ratio * self.ior * inner);
            }
        }
        Shape {
            ior: self.ior as f32,
            ratio: ratio as f32,
            inner: inner as f32,
            greatest: greatest as f32,
            bounces: self.bounces as u32 as f32,
        }
    }

    /// The last line of a ray in space, by Snell's law and normals alone; nothing where it does not take the chain.
    fn trace(&self, from: DVec3, dir: DVec3) -> Option<(DVec3, DVec3)> {
        let mut spheres = vec![(1.0, self.ior)];
        if let Some(inner) = self.inner {
            spheres.push(inner);
        }
        let (mut p, mut d) = (from, dir);
        if matches!(self.bounces, Bounces::Glass | Bounces::Mirror) {
            p = enter(p, d, 1.0)?;
            d -= p * (2.0 * d.dot(p));
            return Some((p, d));
        }
        let middle = spheres.len() - 1;
        for (k, (radius, ior)) in spheres.clone().into_iter().enumerate() {
            p = enter(p, d, radius)?;
            if self.bounces == Bounces::Inside && k == middle {
                d -= p * (2.0 * d.dot(p) / p.length_squared());
                spheres.pop();
                break;
            }
            d = refract(d, p / radius, ior)?;
        }
        for &(radius, ior) in spheres.iter().rev() {
            p += d * leave(p, d, radius);
            d = refract(d, -p / radius, 1.0 / ior)?;
        }
        Some((p, d))
    }
}

/// Where a ray from outside meets a sphere about 0.
fn enter(p: DVec3, d: DVec3, radius: f64) -> Option<DVec3> {
    let (b, c) = (p.dot(d), p.length_squared() - radius * radius);
    let disc = b * b - c;
    (disc > 0.0 && b < 0.0).then(|| p + d * (-b - disc.sqrt()))
}

/// How far a ray from inside is from a sphere about 0.
fn leave(p: DVec3, d: DVec3, radius: f64) -> f64 {
    let (b, c) = (p.dot(d), p.length_squared() - radius * radius);
    -b + (b * b - c).max(0.0).sqrt()
}

fn refract(d: DVec3, normal: DVec3, eta: f64) -> Option<DVec3> {
    let cos = -d.dot(normal);
    let k = 1.0 - (1.0 - cos * cos) / (eta * eta);
    (k >= 0.0).then(|| d / eta + normal * (cos / eta - k.sqrt()))
}

/// A pair of points beside a ball.
fn ends(i: u32) -> Ends<f32> {
    let [a, b] = sample_pair(Independent, 3, i, Pair::Pixel);
    let [c, _] = sample_pair(Independent, 3, i, Pair::Lens);
    let (far, angle) = (1.5 + 6.0 * b, std::f32::consts::PI * c);
    Ends {
        distance: 1.02 + 3.0 * a * a,
        along: far * angle.cos(),
        beside: far * angle.sin(),
    }
}

fn first(way: &Way<f32>, ends: &Ends<f32>) -> DVec3 {
    let [cos, sin] = way.first(ends).map(f64::from);
    DVec3::new(cos, sin, 0.0)
}

/// Whatever a search finds, a ray that is traced through the ball passes the lamp's point.
#[test]
fn ways_meet_the_lamp() {
    for (k, ball) in BALLS.iter().enumerate() {
        let shape = ball.shape();
        let (mut found, mut worst) = (0, 0.0f64);
        for i in 0..20_000 {
            let ends = ends(i);
            let start = STARTS[i as usize % STARTS.len()];
            let (way, is_found) = Way::find(&shape, &ends, start);
            if !is_found {
                continue;
            }
            found += 1;
            let from = DVec3::new(-f64::from(ends.distance), 0.0, 0.0);
            let (p, d) = ball
                .trace(from, first(&way, &ends))
                .expect("takes the chain");
            let lamp = DVec3::new(f64::from(ends.along), f64::from(ends.beside), 0.0);
            let ahead = (lamp - p).dot(d);
            assert!(ahead > 0.0, "ball {k}: {i}");
            worst = worst.max((lamp - p - d * ahead).length() / (1.0 + lamp.length()));
            let [entry, exit] = way.inside(&shape, &ends).map(|[end, foot]| {
                let [end, foot] = [end, foot].map(|p| DVec2::from(p.map(f64::from)));
                let right = (end - foot).dot(foot).abs();
                assert!(
                    right < 1e-3 || ball.bounces < Bounces::Inside,
                    "ball {k}: {i}"
                );
                end
            });
            assert!((entry.length() - 1.0).abs() < 1e-3, "ball {k}: {i}");
            let towards = (entry - from.truncate()).normalize();
            let first = first(&way, &ends).truncate();
            assert!(towards.dot(first) > 1.0 - 1e-4, "ball {k}: {i}");
            assert!((exit - p.truncate()).length() < 2e-3, "ball {k}: {i}");
        }
        println!("ball {k}: {found} of 20000 found, {worst:.1e} beside at most");
        assert!(found > 1_000 && worst < 1e-3, "ball {k}: {found}, {worst}");
    }
}

/// A lamp where a ray arrives that was traced through the ball: the searches find that ray among others.
#[test]
fn searches_find_what_arrives() {
    for (k, ball) in BALLS.iter().enumerate() {
        let shape = ball.shape();
        let [mut sent, mut found] = [0; 2];
        for i in 0..20_000 {
            let [a, b] = sample_pair(Independent, 4, i, Pair::Pixel);
            let [c, _] = sample_pair(Independent, 4, i, Pair::Lens);
            let distance = 1.02 + 3.0 * f64::from(a * a);
            let h = 0.998 * f64::from(shape.greatest * (2.0 * b - 1.0));
            let sin = h / distance;
            let dir = DVec3::new((1.0 - sin * sin).sqrt(), sin, 0.0);
            let from = DVec3::new(-distance, 0.0, 0.0);
            let (p, d) = ball.trace(from, dir).expect("takes the chain");
            let lamp = p + d * (0.2 + 5.0 * f64::from(c));
            // The lamp's side is up, whichever it was.
            let (beside, h) = if lamp.y < 0.0 {
                (-lamp.y, -h)
            } else {
                (lamp.y, h)
            };
            let ends = Ends {
                distance: distance as f32,
                along: lamp.x as f32,
                beside: beside as f32,
            };
            sent += 1;
            found += u32::from(STARTS.iter().any(|&start| {
                let (way, is_found) = Way::find(&shape, &ends, start);
                is_found && (f64::from(way.h) - h).abs() < 1.0 / 512.0
            }));
        }
        println!("ball {k}: {found} of {sent} found again");
        assert!(found > sent / 10 * 9, "ball {k}: {found} of {sent}");
    }
}

/// Solid angle over area against differences: the last lines of neighbouring directions, where they pass the lamp.
#[test]
fn density_is_that_of_neighbouring_rays() {
    for (k, ball) in BALLS.iter().enumerate() {
        let shape = ball.shape();
        let mut compared = 0;
        for i in 0..4_000 {
            let ends = ends(i);
            let start = STARTS[i as usize % STARTS.len()];
            let (way, is_found) = Way::find(&shape, &ends, start);
            if !is_found || way.h.abs() < 0.02 || way.h.abs() > 0.9 * shape.greatest {
                continue;
            }
            let from = DVec3::new(-f64::from(ends.distance), 0.0, 0.0);
            let dir = first(&way, &ends);
            let (_, last) = ball.trace(from, dir).expect("takes the chain");
            let lamp = DVec3::new(f64::from(ends.along), f64::from(ends.beside), 0.0);
            let at = |dir: DVec3| {
                let (q, d) = ball.trace(from, dir.normalize()).expect("a neighbour");
                q + d * ((lamp - q).dot(last) / d.dot(last))
            };
            let step = 1e-5;
            let [s, t] = [DVec3::new(-dir.y, dir.x, 0.0), DVec3::Z];
            let across =
                [s, t].map(|axis| (at(dir + axis * step) - at(dir - axis * step)) / (2.0 * step));
            let area = across[0].cross(across[1]).length();
            if area < 0.05 {
                // Beside a fold the density has a pole, and f32 has not its place.
                continue;
            }
            let density = f64::from(way.density(&ends));
            assert!(
                (density * area - 1.0).abs() < 0.02,
                "ball {k}: {i}: {density} {}",
                1.0 / area
            );
            compared += 1;
        }
        assert!(compared > 100, "ball {k}: {compared}");
    }
}
