//! The codes of this module's diagnostics, `E2xx` and `W2xx`, in one place. Codes are stable: never reused.

/// A textured material on a mesh whose file has no texture coordinates.
pub const NO_UV: &str = "E201";
/// An entity whose place or size, with its ancestors', is beyond the range of 64-bit numbers.
pub const OUT_OF_REACH: &str = "E202";

/// A mesh file whose own material is textured, but which has no texture coordinates.
pub const FILE_WITHOUT_UV: &str = "W201";
