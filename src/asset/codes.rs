//! The codes of this module's diagnostics, `E1xx` and `W1xx`, in one place. Codes are stable: never reused.

use crate::diag::codes::codes;

codes! {
    /// Code and meaning of every diagnostic of mesh and image files, in order.
    CODES:
    UNREADABLE = "E101": "a file that cannot be opened or read";
    NO_FACES = "E102": "a mesh file without any face";
    BAD_FACE = "E103": "a face that cannot be parsed, or that names a vertex, uv or normal that does not exist";
    BAD_NUMBER = "E104": "a `v`, `vt` or `vn` line with too few numbers";
    BAD_VERTEX = "E105": "a vertex that a face uses and that is not a number, not finite, or too large";
    BAD_MATERIAL = "E106": "a value of an MTL file that cannot be read or is impossible";
    IMAGE_FORMAT = "E107": "an image of an unknown or unsuitable format";
    IMAGE_CORRUPT = "E108": "an image that is damaged";
    TOO_LARGE = "E109": "an image, polygon or mesh beyond a documented limit";
    PARSER = "E110": "the OBJ parser gave something other than what the guard asked for: a bug of luxel";
    OVER_BUDGET = "E111": "more memory than files may take (`--max-memory`)";
    BAD_RADIANCE = "E112": "an image of radiance with pixels that are negative, not finite or too bright";
    GLTF_CONTAINER = "E120": "a glTF file whose binary container (GLB) is broken, or that is neither GLB nor text";
    GLTF_VERSION = "E121": "a glTF file of another version than 2";
    GLTF_JSON = "E122": "a glTF file whose text is not JSON";
    GLTF_REQUIRES = "E123": "a glTF file that requires an extension which luxel does not have";
    GLTF_VALUE = "E124": "a value of a glTF file that is missing, of the wrong kind or impossible";
    GLTF_REFERENCE = "E125": "an index of a glTF file that leads to nothing";
    GLTF_BUFFER = "E126": "a buffer of a glTF file, or its URI, that gives fewer bytes than it should, or none";
    GLTF_ACCESSOR = "E127": "an accessor of a glTF file that cannot be read";
    GLTF_NODES = "E128": "nodes of a glTF file that are no forest";
    GLTF_PRIMITIVE = "E129": "a mesh primitive of a glTF file that cannot be drawn";
    GLTF_INDEX = "E130": "an index of a glTF mesh primitive that names no vertex";
    GLTF_ATTRIBUTE = "E131": "an attribute of a glTF mesh primitive whose elements have the wrong number of components";
    MTL_MISSING = "W101": "an MTL file that is missing: its materials are replaced by the default";
    UNKNOWN_MATERIAL = "W102": "a `usemtl` that no MTL file defines";
    TEXTURE_MISSING = "W103": "a texture of an MTL file that is missing: the material keeps its colour";
    NOT_MODELLED = "W104": "a property of an MTL file that changes the look and that luxel does not model";
    ZERO_AREA = "W105": "triangles without area, which are dropped";
    BAD_NORMAL = "W106": "normals that are zero or not finite, which count as absent";
    BAD_UV = "W107": "texture coordinates that are not finite, which count as absent";
    SHORT_FACE = "W108": "a face of fewer than three corners, which is skipped";
    MIXED_FACE = "W109": "a face that gives a uv or a normal to only some of its corners, which then counts as giving none";
    BRIGHT_COLOR = "W110": "a colour above 1, taken as 1";
    DUPLICATE_MATERIAL = "W111": "a material that is defined twice: the first counts";
    FOUND_BESIDE = "W112": "a file that was found by its name beside the file that names it, not where its path says";
    BLACK_FACTOR = "W113": "a texture whose material colour (`Kd`) is black, so that the texture cannot be seen";
    TANGLED_FACE = "W114": "a self-intersecting polygon, triangulated as well as it goes";
    ABSENT = "W115": "faces that name uvs or normals where the file has none at all: they count as absent";
    DUPLICATE_FACE = "W116": "triangles that have the same three vertices as one before them";
    INVISIBLE = "W117": "an opacity of zero, as some exporters write for opaque surfaces (`Tr 1`): taken as opaque";
    NO_ALPHA = "W118": "an opacity texture (`map_d`) without alpha: the surface stays opaque";
    NOT_A_PANORAMA = "W119": "an image of the sky that is not twice as wide as high";
    GLTF_ODD_VALUE = "W120": "a value of a glTF file that breaks the format where luxel does not need it";
    GLTF_UNKNOWN_PROPERTY = "W121": "a property of a glTF file that the format does not have, and that resembles one that it has";
    GLTF_EXTENSION = "W122": "an optional extension of a glTF file which luxel does not have";
    GLTF_DECLARATION = "W123": "extensions of a glTF file that are declared wrongly";
    GLTF_EMPTY = "W124": "an empty array or object in a glTF file, which should be absent";
    GLTF_ODD_BUFFER = "W125": "a buffer of a glTF file that breaks the format and can be read";
    GLTF_IMAGE = "W126": "an image of a glTF file that breaks the format or that nothing needs";
    GLTF_LAYOUT = "W127": "an accessor or buffer view of a glTF file that breaks a rule of layout and can be read";
    GLTF_BOUNDS = "W128": "bounds of an accessor of a glTF file that are absent or not those of its elements";
    GLTF_ELEMENTS = "W129": "elements of a glTF file that are out of their range";
    GLTF_ODD_PRIMITIVE = "W130": "a mesh primitive of a glTF file that breaks a rule and can be drawn";
    GLTF_ODD_NODES = "W131": "nodes or scenes of a glTF file that break a rule and can be placed";
    GLTF_MOTION = "W132": "animations, skins or morph targets of a glTF file that break a rule; luxel ignores them anyway";
    GLTF_LOOK = "W133": "cameras, materials or lights of a glTF file that break a rule";
    GLTF_ODD_CONTAINER = "W134": "a glTF container that breaks a rule and can be read";
    GLTF_NOTHING = "W135": "a glTF file whose default scene has nothing to render";
    GLTF_NO_SCENE = "W136": "a glTF file without a scene: its root nodes are shown";
    GLTF_NO_TRIANGLES = "W137": "primitives of a glTF file that have no triangles, which are skipped";
    GLTF_AT_REST = "W138": "skins, morph targets or further animations of a glTF file, which are left out";
    GLTF_CAMERA = "W139": "cameras of a glTF file that are not perspective";
    GLTF_GLOSS = "W140": "materials of a glTF file whose gloss luxel does not have";
    GLTF_NOT_MODELLED = "W141": "what materials of a glTF file ask for and luxel does not model";
    GLTF_IMAGE_MISSING = "W142": "an image of a glTF file that is missing: its materials keep their factors";
    GLTF_WITHOUT_UV = "W143": "primitives of a glTF file without the texture coordinates that their material reads";
    GLTF_UNLIT = "W144": "unlit materials of a glTF file, which are shown as light sources";
}
