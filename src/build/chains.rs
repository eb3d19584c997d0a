//! Which chains of specular bounces a scene has: reflections of mirrors, metals and glass balls, the ways through glass
//! balls that hold nothing, or one more in their middle, and the way into such a shell, off the inner ball and out.
//!
//! Deliberately absent: walls, which f32 cannot aim by; lamps with a picture, whose radiance is not the same all over; and
//! all chains where rays may pass surfaces.

use super::rebase::WALL_RATIO;
use crate::flat::{BLOCK, Bounces, Chains, ColorSource, FlatScene, Material, Opacity, Scatter};
use crate::math::DVec3;

/// Chains at most, of the spheres that come first: one of them is chosen blindly at every vertex.
const MOST: usize = 64;

/// In place of what stands in the middle: [`Chains::shape`].
const NOTHING_INSIDE: [f64; 2] = [2.0, 1.0];

/// The chains of a scene whose other buffers are complete.
pub(crate) fn chains(scene: &FlatScene) -> Chains {
    let mut found = Vec::new();
    if lamps_have_one_radiance(scene) && receives(scene) && !scene.needs.opacity {
        // A key has room for so many spheres.
        let spheres = 0..scene.spheres.placed.len().min(Chains::REFLECTED as usize);
        let chains = spheres.flat_map(|sphere| of_sphere(scene, sphere));
        found.extend(chains.take(MOST));
    }
    found.sort_by_key(|chain: &Chain| chain.key);
    let mut chains = Chains::default();
    for chain in found {
        chains.key.push(chain.key);
        chains.shape.push(chain.shape);
        chains.tint.push(chain.tint);
        chains.guest.push(chain.guest);
    }
    chains
}

/// A row of [`Chains`].
struct Chain {
    key: u32,
    shape: [f64; 4],
    tint: [f64; 4],
    guest: [f64; 4],
}

fn lamps_have_one_radiance(scene: &FlatScene) -> bool {
    let lamps = &scene.lights.spheres;
    let plain = |&lamp: &u32| material(scene, lamp as usize).emission_source.is_none();
    !lamps.is_empty() && lamps.iter().all(plain)
}

fn receives(scene: &FlatScene) -> bool {
    scene.needs.diffuse || scene.needs.plastic
}

fn material(scene: &FlatScene, sphere: usize) -> &Material {
    &scene.materials[scene.spheres.material[sphere].0 as usize]
}

/// The colour of a sphere that is specular all over, dark, and no wall.
fn plain_color(scene: &FlatScene, sphere: usize) -> Option<[f64; 3]> {
    let material = material(scene, sphere);
    let radius = scene.spheres.radius(sphere);
    let dark = material.emission == [0.0; 3] && material.opacity == Opacity::Full;
    match material.color {
        ColorSource::Constant(color) if dark && radius > 0.0 && 2.0 * radius < WALL_RATIO => {
            Some(color.map(f64::from))
        }
        _ => None,
    }
}

fn chain(sphere: usize, bounces: Bounces, shape: [f64; 4], [r, g, b]: [f64; 3]) -> Chain {
    Chain {
        key: sphere as u32 + bounces.kind(),
        shape,
        tint: [r, g, b, f64::from(bounces as u32)],
        guest: [0.0; 4],
    }
}

fn of_sphere(scene: &FlatScene, sphere: usize) -> Vec<Chain> {
    let material = material(scene, sphere);
    let specular = matches!(
        material.scatter,
        Scatter::Mirror | Scatter::Metal | Scatter::Glass
    );
    if !specular || scene.spheres.inverted[sphere] || surrounded(scene, sphere) {
        return Vec::new();
    }
    let Some(color) = plain_color(scene, sphere) else {
        return Vec::new();
    };
    let ior = f64::from(material.ior);
    let [ratio, inner] = NOTHING_INSIDE;
    match material.scatter {
        Scatter::Mirror => vec![chain(
            sphere,
            Bounces::Mirror,
            [1.0, ratio, inner, 1.0],
            color,
        )],
        Scatter::Metal => vec![chain(
            sphere,
            Bounces::Metal,
            [1.0, ratio, inner, 1.0],
            color,
        )],
        Scatter::Glass if ior != 1.0 => {
            let reflected = chain(sphere, Bounces::Glass, [ior, ratio, inner, 1.0], [1.0; 3]);
            let mut chains = vec![reflected];
            if clear_of_triangles(scene, sphere) {
                chains.extend(through(scene, sphere, ior, color));
            }
            chains
        }
        _ => Vec::new(),
    }
}

/// The ways through a glass ball.
fn through(scene: &FlatScene, sphere: usize, ior: f64, color: [f64; 3]) -> Vec<Chain> {
    let spheres = &scene.spheres;
    let twice = color.map(|c| c * c);
    let concentric = |&other: &usize| spheres.center(other) == spheres.center(sphere);
    let (middles, guests): (Vec<usize>, Vec<usize>) =
        within(scene, sphere).into_iter().partition(concentric);
    let mut chains = match middles.as_slice() {
        [] => {
            let [ratio, inner] = NOTHING_INSIDE;
            let shape = [ior, ratio, inner, ior.min(1.0)];
            vec![chain(sphere, Bounces::Through, shape, twice)]
        }
        &[middle] => {
            let other = material(scene, middle);
            let color = plain_color(scene, middle);
            let (Scatter::Glass, true, Some(color)) =
                (other.scatter, within(scene, middle).is_empty(), color)
            else {
                return Vec::new();
            };
            let mut inner = f64::from(other.ior);
            if spheres.inverted[middle] {
                inner = 1.0 / inner;
            }
            let ratio = spheres.radius(middle) / spheres.radius(sphere);
            let into = ior.min(1.0).min(ratio * ior);
            let both = [0, 1, 2].map(|k| twice[k] * color[k] * color[k]);
            let under = into.min(ratio * ior * inner);
            let shape = |greatest| [ior, ratio, inner, greatest];
            vec![
                chain(sphere, Bounces::Inside, shape(into), twice),
                chain(sphere, Bounces::ThroughBoth, shape(under), both),
            ]
        }
        _ => return Vec::new(),
    };
    match guests.as_slice() {
        [] => chains,
        &[guest] => {
            chains
                .iter_mut()
                .for_each(|chain| chain.guest = spheres.placed[guest]);
            chains
        }
        _ => Vec::new(),
    }
}

/// The spheres whose surfaces are not wholly outside a ball, without itself and what surrounds it.
fn within(scene: &FlatScene, sphere: usize) -> Vec<usize> {
    let spheres = &scene.spheres;
    let (center, radius) = (spheres.center(sphere), spheres.radius(sphere));
    let meets = |&other: &usize| {
        let r = spheres.radius(other);
        let apart = distance(center, spheres.center(other));
        other != sphere && apart < radius + r && apart + radius > r
    };
    (0..spheres.placed.len()).filter(meets).collect()
}

/// Whether a ball of glass is all around a sphere, so that no ray meets it first. (Walls and shells of what is no glass do
/// no harm.)
fn surrounded(scene: &FlatScene, sphere: usize) -> bool {
    let spheres = &scene.spheres;
    let (center, radius) = (spheres.center(sphere), spheres.radius(sphere));
    (0..spheres.placed.len()).any(|other| {
        let apart = distance(center, spheres.center(other));
        other != sphere
            && material(scene, other).scatter == Scatter::Glass
            && apart + radius <= spheres.radius(other)
    })
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    DVec3::from(a).distance(b.into())
}

/// Whether no box of a triangle or of an instance reaches into a ball.
fn clear_of_triangles(scene: &FlatScene, sphere: usize) -> bool {
    let (center, radius) = (scene.spheres.center(sphere), scene.spheres.radius(sphere));
    let outside = |[min, max]: [[f32; 3]; 2]| {
        let beyond = |k: usize| {
            let (low, high) = (f64::from(min[k]), f64::from(max[k]));
            center[k] - center[k].max(low).min(high)
        };
        DVec3::new(beyond(0), beyond(1), beyond(2)).length() >= radius
    };
    let boxes = scene.world.triangles.blocks.iter().flat_map(|block| {
        (0..BLOCK)
            .filter(|&lane| block.v[0][0][lane].is_finite())
            .map(|lane| {
                let of = |pick: fn(f32, f32) -> f32| {
                    [0, 1, 2].map(|k| {
                        let [a, b, c] = [0, 1, 2].map(|corner: usize| block.v[corner][k][lane]);
                        pick(a, pick(b, c))
                    })
                };
                [of(f32::min), of(f32::max)]
            })
    });
    boxes
        .chain(scene.instances.iter().map(|i| i.bounds))
        .all(outside)
}
