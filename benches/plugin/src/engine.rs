//! Triangles and rays as the caller has them enter, hits leave; in between luxel's own builder and kernels, through its
//! public interface.

use cpu_time::ProcessTime;
use luxel::build::buffer_bytes;
use luxel::build::bvh::{Accel, Primitives, Quality, build_with};
use luxel::flat::FlatScene;
use luxel::math::Vec3;
use luxel::measure::bench::Subject;
use luxel::trace::isa::Level;
use luxel::trace::{Hits, Isa, Rays, closest_hit, occluded};
use std::ffi::CStr;
use std::time::Duration;

/// Rays converted at a time: as many as a wave of the renderer has, few enough to stay in the first two caches.
const BATCH: usize = 1024;

/// From here on a `tmax` means "any".
const INFINITE: f32 = 1e30;

/// `TravRay` of the header.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Ray {
    origin: [f32; 3],
    t_max: f32,
    /// Unit.
    dir: [f32; 3],
    padding: f32,
}

/// `TravHit` of the header.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct Hit {
    t: f32,
    /// Index of the input triangle; `u32::MAX` for a miss, as in [`Hits`].
    prim: u32,
}

/// How to trace.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Variant {
    isa: Isa,
    quality: Quality,
}

impl Variant {
    /// Every name, separated by newlines.
    pub(crate) const NAMES: &CStr =
        c"luxel\nluxel-fast\nluxel-scalar\nluxel-sse2\nluxel-avx2\nluxel-avx512";

    /// The variant of a name, if this machine can run it.
    pub(crate) fn named(name: &str) -> Option<Variant> {
        let (isa, quality) = match name.strip_prefix("luxel")? {
            "" => (Isa::best(), Quality::Good),
            "-fast" => (Isa::best(), Quality::Fast),
            level => {
                let level = level.strip_prefix('-')?.parse::<Level>().ok()?;
                (Isa::available(level)?, Quality::Good)
            }
        };
        Some(Variant { isa, quality })
    }
}

/// A tree over triangles.
pub(crate) struct Engine {
    scene: FlatScene,
    isa: Isa,
}

impl Engine {
    /// Builds it; also the CPU time that this took, of all threads.
    pub(crate) fn build(
        variant: Variant,
        vertices: &[[f32; 3]],
        triangles: &[[u32; 3]],
    ) -> (Engine, Duration) {
        let start = ProcessTime::now();
        let corner = |i: u32| Vec3::from(vertices[i as usize]);
        let triangles: Vec<[Vec3; 3]> = triangles.iter().map(|t| t.map(corner)).collect();
        let primitives = Primitives {
            triangles: &triangles,
            ..Primitives::default()
        };
        let built = build_with(&primitives, Accel::Bvh, variant.quality);
        let took = start.elapsed();
        let engine = Engine {
            scene: Subject::open(Vec::new()).scene(built),
            isa: variant.isa,
        };
        (engine, took)
    }

    /// Of every buffer that traversal reads: a bare scene has no others.
    pub(crate) fn bytes(&self) -> usize {
        buffer_bytes(&self.scene).iter().map(|b| b.bytes).sum()
    }

    /// The closest hit of each ray.
    pub(crate) fn closest(&self, rays: &[Ray], out: &mut [Hit]) {
        let (mut batch, mut hits) = (Rays::default(), Hits::default());
        for (rays, out) in rays.chunks(BATCH).zip(out.chunks_mut(BATCH)) {
            gather(rays, &mut batch);
            closest_hit(&self.scene, self.isa, &batch, &mut hits);
            for (out, (&t, &prim)) in out.iter_mut().zip(hits.t.iter().zip(&hits.prim)) {
                *out = Hit { t, prim };
            }
        }
    }

    /// Whether each ray hits anything: 1 or 0.
    pub(crate) fn occluded(&self, rays: &[Ray], out: &mut [u8]) {
        let (mut batch, mut hits) = (Rays::default(), Vec::new());
        for (rays, out) in rays.chunks(BATCH).zip(out.chunks_mut(BATCH)) {
            gather(rays, &mut batch);
            occluded(&self.scene, self.isa, &batch, &mut hits);
            for (out, &hit) in out.iter_mut().zip(&hits) {
                *out = u8::from(hit);
            }
        }
    }
}

/// Rays to structure of arrays, axis by axis: the source stays in the first cache meanwhile.
fn gather(rays: &[Ray], batch: &mut Rays) {
    batch.clear();
    for axis in 0..3 {
        batch.origin[axis].extend(rays.iter().map(|r| r.origin[axis]));
        batch.dir[axis].extend(rays.iter().map(|r| r.dir[axis]));
    }
    let t_max = |r: &Ray| {
        if r.t_max < INFINITE {
            r.t_max
        } else {
            f32::MAX
        }
    };
    batch.t_max.extend(rays.iter().map(t_max));
}
