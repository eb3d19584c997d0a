//! The codes of this module's diagnostics, `E1xx` and `W1xx`, in one place. Codes are stable: never reused.

/// A file that cannot be opened or read.
pub const UNREADABLE: &str = "E101";
/// A mesh file without any face.
pub const NO_FACES: &str = "E102";
/// A face that cannot be parsed, or that names a vertex, uv or normal that does not exist.
pub const BAD_FACE: &str = "E103";
/// A `v`, `vt` or `vn` line with too few numbers.
pub const BAD_NUMBER: &str = "E104";
/// A vertex that a face uses and that is not a number, not finite, or too large.
pub const BAD_VERTEX: &str = "E105";
/// A value of an MTL file that cannot be read or is impossible.
pub const BAD_MATERIAL: &str = "E106";
/// An image of an unknown or unsuitable format.
pub const IMAGE_FORMAT: &str = "E107";
/// An image that is damaged.
pub const IMAGE_CORRUPT: &str = "E108";
/// An image, polygon or mesh beyond a documented limit.
pub const TOO_LARGE: &str = "E109";
/// The OBJ parser gave something other than what the guard asked for: a bug of luxel.
pub const PARSER: &str = "E110";

/// An MTL file that is missing: its materials are replaced by the default.
pub const MTL_MISSING: &str = "W101";
/// A `usemtl` that no MTL file defines.
pub const UNKNOWN_MATERIAL: &str = "W102";
/// A texture of an MTL file that is missing: the material keeps its colour.
pub const TEXTURE_MISSING: &str = "W103";
/// A property of an MTL file that changes the look and that luxel does not model.
pub const NOT_MODELLED: &str = "W104";
/// Triangles without area, which are dropped.
pub const ZERO_AREA: &str = "W105";
/// Normals that are zero or not finite, which count as absent.
pub const BAD_NORMAL: &str = "W106";
/// Texture coordinates that are not finite, which count as absent.
pub const BAD_UV: &str = "W107";
/// A face of fewer than three corners, which is skipped.
pub const SHORT_FACE: &str = "W108";
/// A face that gives a uv or a normal to only some of its corners, which then counts as giving none.
pub const MIXED_FACE: &str = "W109";
/// A colour above 1, taken as 1.
pub const BRIGHT_COLOR: &str = "W110";
/// A material that is defined twice: the first counts.
pub const DUPLICATE_MATERIAL: &str = "W111";
/// A file that was found by its name beside the file that names it, not where its path says.
pub const FOUND_BESIDE: &str = "W112";
/// A texture whose material colour (`Kd`) is black, so that the texture cannot be seen.
pub const BLACK_FACTOR: &str = "W113";
/// A self-intersecting polygon, triangulated as well as it goes.
pub const TANGLED_FACE: &str = "W114";
/// Faces that name uvs or normals where the file has none at all: they count as absent.
pub const ABSENT: &str = "W115";
