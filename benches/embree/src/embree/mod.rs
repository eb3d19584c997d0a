//! Embree 4 by its C interface, opened at run time. Triangles or spheres enter, hits leave.
//!
//! All that is unsafe is here: [`library`] opens, this builds and traces. Deliberately absent: packets, filters, instances,
//! motion, and any error that is not of opening or building.
#![allow(unsafe_code, reason = "a C library, opened at run time")]

mod library;

use cpu_time::ProcessTime;
use library::{
    BUFFER_TYPE_INDEX, BUFFER_TYPE_VERTEX, Device, FORMAT_FLOAT3, FORMAT_FLOAT4, FORMAT_UINT3,
    GEOMETRY_TYPE_SPHERE_POINT, GEOMETRY_TYPE_TRIANGLE, Handle, INVALID_ID, RayHit,
    SCENE_FLAG_NONE, SCENE_FLAG_ROBUST,
};
pub(crate) use library::{Embree, EmbreeError};
use luxel::flat::Spheres;
use luxel::measure::bench::Subject;
use luxel::trace::{Hits, Rays};
use std::ffi::c_void;
use std::sync::atomic::{AtomicI64, Ordering};
use std::time::Duration;

/// Bytes that live in the device whose scene is built: only one is built at a time.
static LIVE: AtomicI64 = AtomicI64::new(0);

extern "C" fn count_bytes(_: *mut c_void, bytes: isize, _: bool) -> bool {
    LIVE.fetch_add(bytes as i64, Ordering::Relaxed);
    true
}

/// A built scene of one geometry.
pub(crate) struct Scene<'a> {
    device: Device<'a>,
    handle: Handle,
    /// Or'ed to the primitive of a hit: marks spheres.
    tag: u32,
    /// What the build took of CPU time, all threads.
    pub(crate) took: Duration,
    /// Bytes of the tree and its leaves, by Embree's memory monitor; without the vertices given.
    pub(crate) bytes: usize,
    /// Vertices and indices stay shared with the geometry.
    _input: Input,
}

/// Buffers as Embree wants them.
struct Input {
    geometry: u32,
    /// x, y, z of corners, or x, y, z, radius of spheres; padded, since 16 bytes are read from every vertex.
    vertices: Vec<f32>,
    indices: Vec<[u32; 3]>,
}

impl Input {
    fn of(subject: &Subject) -> Input {
        let corners = subject
            .triangles
            .iter()
            .flatten()
            .flat_map(|v| v.to_array());
        let spheres = subject.spheres.iter().flat_map(|s| {
            let [x, y, z] = s.center.map(|c| c as f32);
            [x, y, z, s.radius as f32]
        });
        let is_mesh = !subject.triangles.is_empty();
        let mut vertices: Vec<f32> = if is_mesh {
            corners.collect()
        } else {
            spheres.collect()
        };
        vertices.push(0.0);
        let count = subject.triangles.len() as u32;
        Input {
            geometry: if is_mesh {
                GEOMETRY_TYPE_TRIANGLE
            } else {
                GEOMETRY_TYPE_SPHERE_POINT
            },
            vertices,
            indices: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        }
    }
}

impl<'a> Scene<'a> {
    /// Builds the subject's triangles or, if it has none, its spheres, with medium quality, which is the default.
    pub(crate) fn build(
        embree: &'a Embree,
        config: &str,
        robust: bool,
        subject: &Subject,
    ) -> Result<Scene<'a>, EmbreeError> {
        let device = Device::new(embree, config)?;
        let f = device.functions;
        let input = Input::of(subject);
        let floats = if input.indices.is_empty() { 4 } else { 3 };
        let format = if input.indices.is_empty() {
            FORMAT_FLOAT4
        } else {
            FORMAT_FLOAT3
        };
        LIVE.store(0, Ordering::Relaxed);
        // SAFETY: handles are alive until released; buffers have as many items as told and live as long as the scene.
        let (handle, took) = unsafe {
            (f.monitor_memory)(device.handle, count_bytes, std::ptr::null_mut());
            let geometry = (f.new_geometry)(device.handle, input.geometry);
            let share = |buffer, format, memory: *const c_void, item: usize, items: usize| {
                (f.share_buffer)(geometry, buffer, 0, format, memory, 0, item, items);
            };
            let vertices = input.vertices.len() / floats;
            let item = floats * size_of::<f32>();
            share(
                BUFFER_TYPE_VERTEX,
                format,
                input.vertices.as_ptr().cast(),
                item,
                vertices,
            );
            if !input.indices.is_empty() {
                let memory = input.indices.as_ptr().cast();
                let item = size_of::<[u32; 3]>();
                share(
                    BUFFER_TYPE_INDEX,
                    FORMAT_UINT3,
                    memory,
                    item,
                    input.indices.len(),
                );
            }
            let start = ProcessTime::now();
            (f.commit_geometry)(geometry);
            let scene = (f.new_scene)(device.handle);
            let flags = if robust {
                SCENE_FLAG_ROBUST
            } else {
                SCENE_FLAG_NONE
            };
            (f.scene_flags)(scene, flags);
            (f.attach_geometry)(scene, geometry);
            (f.release_geometry)(geometry);
            (f.commit_scene)(scene);
            (scene, start.elapsed())
        };
        device.check()?;
        Ok(Scene {
            handle,
            tag: if input.indices.is_empty() {
                Spheres::TAG
            } else {
                0
            },
            took,
            bytes: LIVE.load(Ordering::Relaxed).max(0) as usize,
            _input: input,
            device,
        })
    }

    /// The closest hit of each ray: t and primitive of `hits`, the rest of which stays as it is.
    pub(crate) fn closest(&self, rays: &Rays, hits: &mut Hits) {
        hits.t.resize(rays.len(), 0.0);
        hits.prim.resize(rays.len(), 0);
        for i in 0..rays.len() {
            let mut query = query(rays, i);
            // SAFETY: the scene is committed, the ray lives, and is aligned and laid out as RTCRayHit.
            unsafe {
                (self.device.functions.intersect)(self.handle, &mut query, std::ptr::null_mut())
            };
            (hits.t[i], hits.prim[i]) = if query.geometry == INVALID_ID {
                (f32::INFINITY, Hits::NONE)
            } else {
                (query.t_far, self.tag | query.prim)
            };
        }
    }

    /// Whether each ray hits anything.
    pub(crate) fn occluded(&self, rays: &Rays, out: &mut Vec<bool>) {
        out.resize(rays.len(), false);
        for (i, out) in out.iter_mut().enumerate() {
            let mut query = query(rays, i);
            // SAFETY: as above; RTCRay is the beginning of RTCRayHit.
            unsafe {
                (self.device.functions.occluded)(self.handle, &mut query, std::ptr::null_mut())
            };
            // By the reference, an occluded ray's end becomes −∞.
            *out = query.t_far < 0.0;
        }
    }
}

impl Drop for Scene<'_> {
    fn drop(&mut self) {
        // SAFETY: the handle is alive, and released once, before its device.
        unsafe { (self.device.functions.release_scene)(self.handle) };
    }
}

#[inline(always)]
fn query(rays: &Rays, i: usize) -> RayHit {
    RayHit {
        origin: [rays.origin[0][i], rays.origin[1][i], rays.origin[2][i]],
        t_near: 0.0,
        dir: [rays.dir[0][i], rays.dir[1][i], rays.dir[2][i]],
        time: 0.0,
        t_far: rays.t_max[i],
        mask: u32::MAX,
        id: 0,
        flags: 0,
        normal: [0.0; 3],
        u: 0.0,
        v: 0.0,
        prim: INVALID_ID,
        geometry: INVALID_ID,
        instance: [INVALID_ID; 2],
        padding: [0; 3],
    }
}
