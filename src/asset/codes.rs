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

/// A glTF file whose binary container (GLB) is broken, or that is neither GLB nor text.
pub const GLTF_CONTAINER: &str = "E120";
/// A glTF file of another version than 2.
pub const GLTF_VERSION: &str = "E121";
/// A glTF file whose text is not JSON.
pub const GLTF_JSON: &str = "E122";
/// A glTF file that requires an extension which luxel does not have.
pub const GLTF_REQUIRES: &str = "E123";
/// A value of a glTF file that is missing, of the wrong kind or impossible.
pub const GLTF_VALUE: &str = "E124";
/// An index of a glTF file that leads to nothing.
pub const GLTF_REFERENCE: &str = "E125";
/// A buffer of a glTF file, or its URI, that gives fewer bytes than it should, or none.
pub const GLTF_BUFFER: &str = "E126";
/// An accessor of a glTF file that cannot be read.
pub const GLTF_ACCESSOR: &str = "E127";
/// Nodes of a glTF file that are no forest.
pub const GLTF_NODES: &str = "E128";
/// A mesh primitive of a glTF file that cannot be drawn.
pub const GLTF_PRIMITIVE: &str = "E129";
/// An index of a glTF mesh primitive that names no vertex.
pub const GLTF_INDEX: &str = "E130";
/// An attribute of a glTF mesh primitive whose elements have the wrong number of components.
pub const GLTF_ATTRIBUTE: &str = "E131";

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
/// A value of a glTF file that breaks the format where luxel does not need it.
pub const GLTF_ODD_VALUE: &str = "W120";
/// A property of a glTF file that the format does not have, and that resembles one that it has.
pub const GLTF_UNKNOWN_PROPERTY: &str = "W121";
/// An optional extension of a glTF file which luxel does not have.
pub const GLTF_EXTENSION: &str = "W122";
/// Extensions of a glTF file that are declared wrongly.
pub const GLTF_DECLARATION: &str = "W123";
/// An empty array or object in a glTF file, which should be absent.
pub const GLTF_EMPTY: &str = "W124";
/// A buffer of a glTF file that breaks the format and can be read.
pub const GLTF_ODD_BUFFER: &str = "W125";
/// An image of a glTF file that breaks the format or that nothing needs.
pub const GLTF_IMAGE: &str = "W126";
/// An accessor or buffer view of a glTF file that breaks a rule of layout and can be read.
pub const GLTF_LAYOUT: &str = "W127";
/// Bounds of an accessor of a glTF file that are absent or not those of its elements.
pub const GLTF_BOUNDS: &str = "W128";
/// Elements of a glTF file that are out of their range.
pub const GLTF_ELEMENTS: &str = "W129";
/// A mesh primitive of a glTF file that breaks a rule and can be drawn.
pub const GLTF_ODD_PRIMITIVE: &str = "W130";
/// Nodes or scenes of a glTF file that break a rule and can be placed.
pub const GLTF_ODD_NODES: &str = "W131";
/// Animations, skins or morph targets of a glTF file that break a rule; luxel ignores them anyway.
pub const GLTF_MOTION: &str = "W132";
/// Cameras, materials or lights of a glTF file that break a rule.
pub const GLTF_LOOK: &str = "W133";
/// A glTF container that breaks a rule and can be read.
pub const GLTF_ODD_CONTAINER: &str = "W134";
/// A glTF file whose default scene has nothing to render.
pub const GLTF_NOTHING: &str = "W135";
/// A glTF file without a scene: its root nodes are shown.
pub const GLTF_NO_SCENE: &str = "W136";
/// Primitives of a glTF file that have no triangles, which are skipped.
pub const GLTF_NO_TRIANGLES: &str = "W137";
/// Animations, skins or morph targets of a glTF file, which is shown at rest.
pub const GLTF_AT_REST: &str = "W138";
/// Cameras of a glTF file that are not perspective.
pub const GLTF_CAMERA: &str = "W139";
/// Materials of a glTF file whose gloss luxel does not have.
pub const GLTF_GLOSS: &str = "W140";
/// What materials of a glTF file ask for and luxel does not model.
pub const GLTF_NOT_MODELLED: &str = "W141";
/// An image of a glTF file that is missing: its materials keep their factors.
pub const GLTF_IMAGE_MISSING: &str = "W142";
/// Primitives of a glTF file without the texture coordinates that their material reads.
pub const GLTF_WITHOUT_UV: &str = "W143";
/// Unlit materials of a glTF file, which are shown as light sources.
pub const GLTF_UNLIT: &str = "W144";
