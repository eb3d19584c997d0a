//! The codes of this module's diagnostics, `E2xx` and `W2xx`, in one place. Codes are stable: never reused.

/// A textured material on a mesh whose file has no texture coordinates.
pub const NO_UV: &str = "E201";
/// An entity whose place or size, with its ancestors', is beyond the range of 64-bit numbers.
pub const OUT_OF_REACH: &str = "E202";
/// A glTF file has no such mesh.
pub const NO_SUCH_MESH: &str = "E203";
/// A glTF file stands where one mesh is wanted.
pub const WHOLE_SCENE: &str = "E204";
/// Neither the scene nor its glTF files have a camera.
pub const NO_CAMERA: &str = "E205";

/// A mesh file whose own material is textured, but which has no texture coordinates.
pub const FILE_WITHOUT_UV: &str = "W201";
/// The glTF files bring more than one camera, and the scene none: the first is taken.
pub const MORE_CAMERAS: &str = "W202";
