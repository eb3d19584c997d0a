//! The codes of this module's diagnostics, `E2xx` and `W2xx`, in one place. Codes are stable: never reused.

use crate::diag::codes::codes;

codes! {
    /// Code and meaning of every diagnostic of the use that a scene makes of its files, in order.
    CODES:
    NO_UV = "E201": "a textured material on a mesh whose file has no texture coordinates";
    OUT_OF_REACH = "E202": "an entity whose place or size, with its ancestors', is beyond the range of 64-bit numbers";
    NO_SUCH_MESH = "E203": "a glTF file has no such mesh";
    WHOLE_SCENE = "E204": "a glTF file stands where one mesh is wanted";
    NO_CAMERA = "E205": "neither the scene nor its glTF files have a camera";
    FILE_WITHOUT_UV = "W201": "a mesh file whose own material is textured, but which has no texture coordinates";
    MORE_CAMERAS = "W202": "the glTF files bring more than one camera, and the scene none: the first is taken";
}
