//! The light table: emissive spheres and triangles with their weights.

use crate::flat::{Instance, Lights, Material, MaterialId, Spheres};
use crate::math::{DVec3, Vec3};
use std::f64::consts::PI;

/// Lights while they are collected: spheres first, then triangles.
#[derive(Debug, Default)]
pub(crate) struct Collector {
    lights: Lights,
    total: f64,
}

impl Collector {
    /// Adds the spheres that emit.
    pub(crate) fn spheres(&mut self, spheres: &Spheres, materials: &[Material]) {
        for (i, radius) in spheres.radius.iter().enumerate() {
            let area = 4.0 * PI * radius * radius;
            if self.weigh(area, emission(materials, spheres.material[i])) {
                self.lights.spheres.push(i as u32);
            }
        }
    }

    /// Adds a triangle in scene units, counter-clockwise seen from its emitting side, if its material emits.
    pub(crate) fn triangle(&mut self, v: [Vec3; 3], material: MaterialId, materials: &[Material]) {
        let radiance = emission(materials, material);
        let [a, b, c] = v.map(Vec3::as_dvec3);
        let area = 0.5 * (b - a).cross(c - a).length();
        // A triangle whose area is 0 in f32 has no density to sample it by.
        if area as f32 == 0.0 || !self.weigh(area, radiance) {
            return;
        }
        let triangles = &mut self.lights.triangles;
        triangles.v0.push(v[0].to_array());
        triangles.e1.push((b - a).as_vec3().to_array());
        triangles.e2.push((c - a).as_vec3().to_array());
        triangles.area.push(area as f32);
        triangles.radiance.push(radiance);
    }

    /// Whether something of this area is a light: then its weight counts.
    fn weigh(&mut self, area: f64, radiance: [f32; 3]) -> bool {
        let mean = radiance.iter().map(|c| f64::from(*c)).sum::<f64>() / 3.0;
        let weight = area * mean;
        let shines = weight > 0.0 && weight.is_finite();
        if shines {
            self.total += weight;
            self.lights.cumulative.push(self.total);
        }
        shines
    }

    pub(crate) fn finish(self) -> Lights {
        self.lights
    }
}

/// A local triangle in scene units, by the rounded map that hits use; corners swapped where it mirrors.
pub(crate) fn placed(v: [Vec3; 3], instance: &Instance) -> [Vec3; 3] {
    let row = |r: &[f32; 4], p: DVec3| {
        let [x, y, z, t] = r.map(f64::from);
        x * p.x + y * p.y + z * p.z + t
    };
    let [a, b, c] = v.map(|p| {
        let p = p.as_dvec3();
        Vec3::from_array(instance.to_world.map(|r| row(&r, p) as f32))
    });
    if instance.mirrored {
        [a, c, b]
    } else {
        [a, b, c]
    }
}

fn emission(materials: &[Material], id: MaterialId) -> [f32; 3] {
    materials[id.0 as usize].emission
}
