//! luxel's traversal as a shared library, behind the five C functions of `trav_plugin.h`: so that a benchmark written by
//! others can time it beside other libraries, on rays and with a referee of its own.
//!
//! ```text
//! cargo build --release -p luxel-plugin        # target/release/libluxel_plugin.so
//! travbench bench --data DATA --mesh bunny --plugin =target/release/libluxel_plugin.so --embree LIBEMBREE
//! ```
//!
//! Variants: `luxel` is what luxel does by itself; `luxel-fast` the same on the tree of `--tree fast`; `luxel-scalar`,
//! `luxel-sse2`, `luxel-avx2` and `luxel-avx512` force an instruction set, and are not available where the machine lacks it.
//!
//! Here stand the functions and all that is unsafe; `engine` is the rest. Deliberately absent: an option that trades
//! exactness for time. What is timed is what renders, watertight, with barycentric coordinates and error bounds that the
//! interface does not ask for.
#![allow(
    unsafe_code,
    reason = "a C interface: pointers come from the caller, who keeps the header's promises"
)]

mod engine;

use engine::{Engine, Hit, Ray, Variant};
use std::ffi::{CStr, c_char, c_void};
use std::slice::from_raw_parts;

/// What a build took; `TravStats` of the header.
#[repr(C)]
pub struct Stats {
    /// CPU time of the process from the caller's arrays to ready, milliseconds.
    pub build_ms: f64,
    /// Bytes of every buffer that traversal reads.
    pub bytes: u64,
}

/// The names of all variants, separated by newlines.
// SAFETY: no other library of the process may have this name, which is the interface's; likewise below.
#[unsafe(no_mangle)]
pub extern "C" fn trav_variants() -> *const c_char {
    Variant::NAMES.as_ptr()
}

/// Builds the tree over `nt` triangles; null for a name that is unknown or a variant that this machine lacks.
///
/// # Safety
/// `variant` ends in a zero, `verts` holds `3 * nv` coordinates, `idx` `3 * nt` indices below `nv`, and `out` is writable; none is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn trav_build(
    variant: *const c_char,
    verts: *const f32,
    nv: u32,
    idx: *const u32,
    nt: u32,
    out: *mut Stats,
) -> *mut c_void {
    // SAFETY: the caller's promise.
    let (name, vertices, triangles) = unsafe {
        (
            CStr::from_ptr(variant),
            from_raw_parts(verts.cast::<[f32; 3]>(), nv as usize),
            from_raw_parts(idx.cast::<[u32; 3]>(), nt as usize),
        )
    };
    let Some(variant) = name.to_str().ok().and_then(Variant::named) else {
        return std::ptr::null_mut();
    };
    let (engine, took) = Engine::build(variant, vertices, triangles);
    let stats = Stats {
        build_ms: took.as_secs_f64() * 1e3,
        bytes: engine.bytes() as u64,
    };
    // SAFETY: the caller's promise.
    unsafe { out.write(stats) };
    Box::into_raw(Box::new(engine)).cast()
}

/// The closest hit of each of `n` rays.
///
/// # Safety
/// `h` is from [`trav_build`] and not freed; `r` holds and `out` has room for `n`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn trav_closest(h: *mut c_void, r: *const Ray, n: u64, out: *mut Hit) {
    // SAFETY: the caller's promise.
    let (engine, rays, out) = unsafe {
        (
            &*h.cast::<Engine>(),
            from_raw_parts(r, n as usize),
            std::slice::from_raw_parts_mut(out, n as usize),
        )
    };
    engine.closest(rays, out);
}

/// Whether each of `n` rays hits anything: 1 or 0.
///
/// # Safety
/// `h` is from [`trav_build`] and not freed; `r` holds and `out` has room for `n`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn trav_occluded(h: *mut c_void, r: *const Ray, n: u64, out: *mut u8) {
    // SAFETY: the caller's promise.
    let (engine, rays, out) = unsafe {
        (
            &*h.cast::<Engine>(),
            from_raw_parts(r, n as usize),
            std::slice::from_raw_parts_mut(out, n as usize),
        )
    };
    engine.occluded(rays, out);
}

/// Frees what [`trav_build`] gave.
///
/// # Safety
/// `h` is from [`trav_build`] and not freed yet.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn trav_free(h: *mut c_void) {
    // SAFETY: the caller's promise.
    drop(unsafe { Box::from_raw(h.cast::<Engine>()) });
}
