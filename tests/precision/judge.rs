//! The f64 referee over every space in which kernels test triangles: the world's, and that of each instance.

use crate::support::shoot::ray;
use luxel::build::bvh::Primitives;
use luxel::flat::{FlatScene, Geometry, Instance};
use luxel::math::Vec3;
use luxel::measure::referee::{Found, Referee, Verdict};
use luxel::trace::spawn::triangle_vertices;
use luxel::trace::{Hits, Rays};

/// The triangles of a scene as rays see them.
pub(crate) struct Triangles {
    world: Vec<[Vec3; 3]>,
    locals: Vec<Vec<[Vec3; 3]>>,
}

impl Triangles {
    pub(crate) fn of(scene: &FlatScene) -> Triangles {
        let all = |geometry: &Geometry| {
            let prims = 0..geometry.triangles.place.len() as u32;
            let vertices = |prim| triangle_vertices(&geometry.triangles, prim).map(Vec3::from);
            prims.map(vertices).collect()
        };
        Triangles {
            world: all(&scene.world),
            locals: scene.local.iter().map(|local| all(local)).collect(),
        }
    }
}

/// A referee for each space.
pub(crate) struct Judge<'a> {
    scene: &'a FlatScene,
    world: Referee<'a>,
    locals: Vec<Referee<'a>>,
}

impl<'a> Judge<'a> {
    pub(crate) fn new(scene: &'a FlatScene, triangles: &'a Triangles) -> Judge<'a> {
        let referee = |triangles: &'a Vec<[Vec3; 3]>| {
            Referee::new(Primitives {
                triangles,
                ..Primitives::default()
            })
        };
        Judge {
            scene,
            world: referee(&triangles.world),
            locals: triangles.locals.iter().map(referee).collect(),
        }
    }

    /// Of what was found for a ray: right in its own space, and nothing before it in any other.
    pub(crate) fn verdict(&self, rays: &Rays, hits: &Hits, i: usize) -> Verdict {
        let (t, prim) = (hits.t[i], hits.prim[i]);
        let hit = (prim != Hits::NONE).then_some((hits.instance[i], Found { t, prim }));
        self.judge(ray(rays, i), hit)
    }

    /// The same of a hit with the instance that it is on.
    pub(crate) fn judge(&self, ray: [[f32; 3]; 2], hit: Option<(u32, Found)>) -> Verdict {
        let world = std::iter::once((Hits::WORLD, &self.world, ray));
        let instances = (0..).zip(&self.scene.instances);
        let instances = instances.map(|(index, instance)| {
            let referee = &self.locals[instance.geometry as usize];
            (index, referee, local(instance, ray))
        });
        let mut verdict = Verdict::Agrees;
        for (space, referee, ray) in world.chain(instances) {
            let found = hit.filter(|(of, _)| *of == space).map(|(_, found)| found);
            let t_max = match (found, hit) {
                (None, Some((_, elsewhere))) => elsewhere.t,
                _ => f32::MAX,
            };
            match referee.trace(ray, t_max).judge(found) {
                Verdict::Wrong => return Verdict::Wrong,
                Verdict::Agrees => {}
                doubt => verdict = doubt,
            }
        }
        verdict
    }
}

/// A ray in an instance's space, to the bit as kernels have it.
fn local(instance: &Instance, [o, d]: [[f32; 3]; 2]) -> [[f32; 3]; 2] {
    let rows = instance.to_local;
    let turned = |v: [f32; 3]| rows.map(|[x, y, z, _]| x * v[0] + y * v[1] + z * v[2]);
    let origin = [0, 1, 2].map(|row| turned(o)[row] + rows[row][3]);
    [origin, turned(d)]
}
