//! The codes of what concerns a scene as a whole, `W3xx`, in one place. Codes are stable: never reused.

use crate::diag::codes::codes;

codes! {
    /// Code and meaning of every diagnostic of a loaded scene, in order.
    CODES:
    CAMERA_INSIDE = "W301": "the camera is inside a mesh or a solid sphere";
    NOTHING_IN_VIEW = "W302": "no shape is in view";
    BELOW_A_PIXEL = "W303": "all shapes together cover less than a pixel";
    BLURRED_PLACE = "W304": "a shape so far from the rest that single precision blurs its place or its form";
    OTHER_UNITS = "W305": "a mesh a thousand times larger or smaller than everything else in view";
    OUT_OF_FOCUS = "W306": "the lens blurs everything in view beyond recognition";
    RADIANS = "W307": "an angle that looks like radians where degrees are meant";
    OTHER_LIGHT_UNITS = "W308": "lights so strong or so weak that their units are probably others";
    PARTLY_WITHOUT_UV = "W309": "triangles without texture coordinates under a textured material";
}
