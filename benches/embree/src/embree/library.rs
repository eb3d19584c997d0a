//! The functions of the library, and its devices.
//!
//! The declarations are written from the API reference of Embree's documentation (rtcNewDevice to rtcOccluded1, RTCRayHit).

use libloading::Library;
use std::ffi::{CString, c_char, c_void};
use std::path::Path;

/// A device, a scene or a geometry.
pub(super) type Handle = *mut c_void;

/// Called with the bytes that a device allocates or, negative, frees.
pub(super) type MemoryMonitor = extern "C" fn(*mut c_void, isize, bool) -> bool;

pub(super) const INVALID_ID: u32 = u32::MAX;
pub(super) const DEVICE_PROPERTY_VERSION: u32 = 0;
pub(super) const GEOMETRY_TYPE_TRIANGLE: u32 = 0;
pub(super) const GEOMETRY_TYPE_SPHERE_POINT: u32 = 50;
pub(super) const BUFFER_TYPE_INDEX: u32 = 0;
pub(super) const BUFFER_TYPE_VERTEX: u32 = 1;
pub(super) const FORMAT_UINT3: u32 = 0x5003;
pub(super) const FORMAT_FLOAT3: u32 = 0x9003;
pub(super) const FORMAT_FLOAT4: u32 = 0x9004;
pub(super) const SCENE_FLAG_NONE: u32 = 0;
pub(super) const SCENE_FLAG_ROBUST: u32 = 4;

/// RTCRayHit: RTCRay, then RTCHit. Of an occlusion query only the ray is read and written.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
pub(super) struct RayHit {
    pub(super) origin: [f32; 3],
    pub(super) t_near: f32,
    pub(super) dir: [f32; 3],
    pub(super) time: f32,
    pub(super) t_far: f32,
    pub(super) mask: u32,
    pub(super) id: u32,
    pub(super) flags: u32,
    pub(super) normal: [f32; 3],
    pub(super) u: f32,
    pub(super) v: f32,
    pub(super) prim: u32,
    pub(super) geometry: u32,
    /// Instance, and in versions with arrays of instances the index in one.
    pub(super) instance: [u32; 2],
    pub(super) padding: [u32; 3],
}

/// The functions in use; arguments as in the reference, `null` for optional argument structures.
pub(super) struct Functions {
    pub(super) new_device: unsafe extern "C" fn(*const c_char) -> Handle,
    pub(super) release_device: unsafe extern "C" fn(Handle),
    pub(super) device_error: unsafe extern "C" fn(Handle) -> u32,
    pub(super) device_property: unsafe extern "C" fn(Handle, u32) -> isize,
    pub(super) monitor_memory: unsafe extern "C" fn(Handle, MemoryMonitor, *mut c_void),
    pub(super) new_scene: unsafe extern "C" fn(Handle) -> Handle,
    pub(super) release_scene: unsafe extern "C" fn(Handle),
    pub(super) scene_flags: unsafe extern "C" fn(Handle, u32),
    pub(super) commit_scene: unsafe extern "C" fn(Handle),
    pub(super) new_geometry: unsafe extern "C" fn(Handle, u32) -> Handle,
    pub(super) release_geometry: unsafe extern "C" fn(Handle),
    pub(super) commit_geometry: unsafe extern "C" fn(Handle),
    pub(super) attach_geometry: unsafe extern "C" fn(Handle, Handle) -> u32,
    pub(super) share_buffer: SharedBuffer,
    pub(super) intersect: unsafe extern "C" fn(Handle, *mut RayHit, *mut c_void),
    pub(super) occluded: unsafe extern "C" fn(Handle, *mut RayHit, *mut c_void),
}

/// Geometry, type, slot, format, memory, offset, stride, items.
type SharedBuffer = unsafe extern "C" fn(Handle, u32, u32, u32, *const c_void, usize, usize, usize);

/// What can go wrong.
#[derive(Debug, thiserror::Error)]
pub(crate) enum EmbreeError {
    /// No library, or not Embree 4.
    #[error("cannot open Embree: {0}")]
    Open(#[from] libloading::Error),
    /// An error code of the device.
    #[error("Embree failed with RTCError {code} for the device \"{device}\"")]
    Device {
        /// The configuration.
        device: String,
        /// As in the reference.
        code: u32,
    },
}

/// The opened library.
pub(crate) struct Embree {
    functions: Functions,
    /// Keeps the functions in memory.
    _library: Library,
}

impl Embree {
    /// Opens the library.
    pub(crate) fn open(path: &Path) -> Result<Embree, EmbreeError> {
        // SAFETY: of what the file does on loading and of its functions' types, the user is sure who names it as Embree 4.
        unsafe {
            let library = Library::new(path)?;
            let functions = Functions {
                new_device: *library.get(c"rtcNewDevice")?,
                release_device: *library.get(c"rtcReleaseDevice")?,
                device_error: *library.get(c"rtcGetDeviceError")?,
                device_property: *library.get(c"rtcGetDeviceProperty")?,
                monitor_memory: *library.get(c"rtcSetDeviceMemoryMonitorFunction")?,
                new_scene: *library.get(c"rtcNewScene")?,
                release_scene: *library.get(c"rtcReleaseScene")?,
                scene_flags: *library.get(c"rtcSetSceneFlags")?,
                commit_scene: *library.get(c"rtcCommitScene")?,
                new_geometry: *library.get(c"rtcNewGeometry")?,
                release_geometry: *library.get(c"rtcReleaseGeometry")?,
                commit_geometry: *library.get(c"rtcCommitGeometry")?,
                attach_geometry: *library.get(c"rtcAttachGeometry")?,
                share_buffer: *library.get(c"rtcSetSharedGeometryBuffer")?,
                intersect: *library.get(c"rtcIntersect1")?,
                occluded: *library.get(c"rtcOccluded1")?,
            };
            Ok(Embree {
                functions,
                _library: library,
            })
        }
    }

    /// Its version, as in "4.4.0".
    pub(crate) fn version(&self) -> Result<String, EmbreeError> {
        let device = Device::new(self, "")?;
        // SAFETY: the device is alive.
        let v = unsafe { (self.functions.device_property)(device.handle, DEVICE_PROPERTY_VERSION) };
        // Two digits each, after the major version.
        Ok(format!("{}.{}.{}", v / 10000, v / 100 % 100, v % 100))
    }
}

pub(super) struct Device<'a> {
    pub(super) functions: &'a Functions,
    config: String,
    pub(super) handle: Handle,
}

impl<'a> Device<'a> {
    pub(super) fn new(embree: &'a Embree, config: &str) -> Result<Device<'a>, EmbreeError> {
        let functions = &embree.functions;
        let text = CString::new(config).unwrap_or_default();
        // SAFETY: the text ends in a zero and outlives the call.
        let handle = unsafe { (functions.new_device)(text.as_ptr()) };
        let device = Device {
            functions,
            config: config.to_owned(),
            handle,
        };
        device.check()?;
        Ok(device)
    }

    /// The error since the last call, if any; of a null device, that of making it.
    pub(super) fn check(&self) -> Result<(), EmbreeError> {
        // SAFETY: null is allowed.
        match unsafe { (self.functions.device_error)(self.handle) } {
            0 if !self.handle.is_null() => Ok(()),
            code => Err(EmbreeError::Device {
                device: self.config.clone(),
                code,
            }),
        }
    }
}

impl Drop for Device<'_> {
    fn drop(&mut self) {
        if !self.handle.is_null() {
            // SAFETY: the handle is alive, and released once.
            unsafe { (self.functions.release_device)(self.handle) };
        }
    }
}
