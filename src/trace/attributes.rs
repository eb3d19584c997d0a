//! What varies over a surface, looked up where a hit or a light sample is: the second set of texture coordinates, corner
//! colours, emission and opacity. Read only by what asks for it.

use super::texture::{eval_alpha, eval_texture};
use super::{Hits, Rays, cut, surface};
use crate::flat::{
    ColorSource, Coverage, FlatScene, LightPlace, Material, Opacity, Scatter, Shading, Spheres,
    Texture,
};
use crate::math::Vec3;

/// A place on a surface.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// As in [`Hits`].
    pub(super) prim: u32,
    /// As in [`Hits`].
    pub(super) instance: u32,
    /// Barycentric weights of the second and third corner.
    pub(super) weights: [f32; 2],
    /// The first set of texture coordinates.
    pub(super) uv: [f32; 2],
}

impl Place {
    /// The place of a hit whose first texture coordinates are known.
    pub(super) fn of_hit(hits: &Hits, i: usize, uv: [f32; 2]) -> Place {
        Place {
            prim: hits.prim[i],
            instance: hits.instance[i],
            weights: [hits.u[i], hits.v[i]],
            uv,
        }
    }

    /// The point of a light triangle with weights (1 − b1 − b2, b1, b2).
    fn on_light(scene: &FlatScene, light: &LightPlace, [b1, b2]: [f32; 2]) -> Place {
        let mut place = Place {
            prim: light.prim,
            instance: light.instance.unwrap_or(Hits::WORLD),
            weights: if light.mirrored { [b2, b1] } else { [b1, b2] },
            uv: [0.0; 2],
        };
        place.uv = place.corners(&shading(scene, place.instance).uvs, 0.0);
        place
    }

    /// Interpolates an array of corners; `none` where there is none, as on spheres.
    fn corners<const N: usize>(&self, array: &[[f32; N]], none: f32) -> [f32; N] {
        if self.prim & Spheres::TAG != 0 {
            return [none; N];
        }
        let corner = 3 * self.prim as usize;
        let [u, v] = self.weights;
        match array.get(corner..corner + 3) {
            Some(c) => std::array::from_fn(|k| c[0][k] * (1.0 - u - v) + c[1][k] * u + c[2][k] * v),
            None => [none; N],
        }
    }

    #[inline(always)]
    fn coordinates(&self, scene: &FlatScene, texture: &Texture) -> [f32; 2] {
        let [u, v] = match texture.uv_set {
            0 => self.uv,
            _ => self.corners(&shading(scene, self.instance).uvs1, 0.0),
        };
        let Some(m) = texture.transform else {
            return [u, v];
        };
        let row = |r: usize| m[r] * u + m[r + 1] * v + m[r + 2];
        [row(0), row(3)].map(|x| if x.is_finite() { x } else { 0.0 })
    }
}

fn shading(scene: &FlatScene, instance: u32) -> &Shading {
    match instance {
        Hits::WORLD => &scene.world.shading,
        i => {
            let geometry = scene.instances[i as usize].geometry;
            &scene.local[geometry as usize].shading
        }
    }
}

/// The material of a primitive.
pub(super) fn material(scene: &FlatScene, prim: u32, instance: u32) -> &Material {
    let id = if prim & Spheres::TAG != 0 {
        scene.spheres.material[(prim & !Spheres::TAG) as usize]
    } else if instance == Hits::WORLD {
        scene.world.material(prim)
    } else {
        let slot = shading(scene, instance).material[prim as usize];
        let first = scene.instances[instance as usize].materials;
        scene.instance_materials[(first + slot) as usize]
    };
    &scene.materials[id.0 as usize]
}

/// A texture's colour at a place.
#[inline(always)]
pub(super) fn texture_color(scene: &FlatScene, texture: u32, place: &Place) -> Vec3 {
    let texture = &scene.textures[texture as usize];
    eval_texture(texture, place.coordinates(scene, texture))
}

/// Corner colours with their alpha at a place; 1 where there are none.
fn corner_color(scene: &FlatScene, place: &Place) -> [f32; 4] {
    place.corners(&shading(scene, place.instance).colors, 1.0)
}

/// Corner colours at a place; 1 where there are none.
pub(super) fn vertex_color(scene: &FlatScene, place: &Place) -> Vec3 {
    let [r, g, b, _] = corner_color(scene, place);
    Vec3::new(r, g, b)
}

/// Radiance at a place of a material that emits.
#[inline(always)]
pub(super) fn emitted(scene: &FlatScene, material: &Material, place: &Place) -> Vec3 {
    match &material.emission_source {
        Some(source) if cut::TEXTURES => emitted_from(scene, material, source, place),
        _ => Vec3::from(material.emission),
    }
}

#[inline(never)]
fn emitted_from(
    scene: &FlatScene,
    material: &Material,
    source: &ColorSource,
    place: &Place,
) -> Vec3 {
    let radiance = match *source {
        ColorSource::Constant(c) => Vec3::from(c),
        ColorSource::Texture { texture, factor } => {
            Vec3::from(factor) * texture_color(scene, texture, place)
        }
    };
    if material.vertex_colors && material.scatter == Scatter::Nothing {
        radiance * vertex_color(scene, place)
    } else {
        radiance
    }
}

/// Share of rays that meet the surface at a place; 0 or 1 under a mask.
fn presence(scene: &FlatScene, material: &Material, place: &Place) -> f32 {
    let covered = |coverage: &Coverage| {
        let mut covered = coverage.factor;
        if let Some(texture) = coverage.texture {
            let texture = &scene.textures[texture as usize];
            covered *= eval_alpha(texture, place.coordinates(scene, texture));
        }
        if coverage.vertex_alpha {
            covered *= corner_color(scene, place)[3];
        }
        covered
    };
    match &material.opacity {
        Opacity::Full => 1.0,
        Opacity::Mask { coverage, cutoff } => f32::from(u8::from(covered(coverage) >= *cutoff)),
        Opacity::Blend(coverage) => covered(coverage).clamp(0.0, 1.0),
    }
}

/// As [`presence`], of hit i.
#[inline(never)]
pub(super) fn hit_presence(scene: &FlatScene, rays: &Rays, hits: &Hits, i: usize) -> f32 {
    let material = material(scene, hits.prim[i], hits.instance[i]);
    if material.opacity == Opacity::Full {
        return 1.0;
    }
    let uv = surface::place(scene, rays, hits, i).uv;
    presence(scene, material, &Place::of_hit(hits, i, uv))
}

/// What the point of a light triangle sends out, as much of it as is there.
#[inline(never)]
pub(super) fn light_radiance(scene: &FlatScene, light: &LightPlace, weights: [f32; 2]) -> Vec3 {
    let place = Place::on_light(scene, light, weights);
    let material = material(scene, place.prim, place.instance);
    emitted(scene, material, &place) * presence(scene, material, &place)
}
