//! Every stable code of scenes, with what it stands for. A code is never reused for something else.
//!
//! `E0xx`/`W0xx` are of the scene file, here; `E1xx`/`W1xx` of the files that it names (`asset::codes`), `E2xx`/`W2xx` of
//! the use that it makes of them (`world::codes`), `W3xx` of the scene as a whole once all is loaded (`check::codes`).

/// A constant for each code of a module, and the table of all of them: code and meaning, in order.
macro_rules! codes {
    ($(#[$about:meta])* $table:ident: $($name:ident = $code:literal: $meaning:literal;)*) => {
        $(#[doc = concat!("`", $code, "`: ", $meaning, ".")] pub const $name: &str = $code;)*

        $(#[$about])*
        pub const $table: &[(&str, &str)] = &[$(($code, $meaning)),*];
    };
}
pub(crate) use codes;

codes! {
    /// Code and meaning of every diagnostic of a scene file, in order.
    CODES:
    NOT_TEXT = "E001": "the file is not UTF-8 text";
    SYNTAX = "E002": "the text is not RON";
    WRONG_TYPE = "E003": "a value of another kind is needed here";
    UNKNOWN_FIELD = "E004": "there is no such field";
    UNKNOWN_VARIANT = "E005": "there is no such variant";
    MISSING_FIELD = "E006": "a field without a default is missing";
    DUPLICATE_FIELD = "E007": "a field is given twice";
    DUPLICATE_NAME = "E008": "two materials or two entities have the same name";
    UNKNOWN_VERSION = "E009": "the version of the scene format is not known";
    NOT_FINITE = "E010": "a number is not finite, or too large for 64 bits";
    OUT_OF_RANGE = "E011": "a number is out of its range";
    UNKNOWN_NAME = "E012": "no material or entity has this name";
    PARENT_CYCLE = "E013": "an entity is its own ancestor";
    NO_CAMERA = "E014": "the scene has no camera";
    TWO_CAMERAS = "E015": "the scene has more than one camera";
    DEGENERATE = "E016": "a direction or rotation has no length, or two directions coincide";
    STRETCHED_SPHERE = "E017": "a sphere stands under a non-uniform scale";
    MISPLACED = "E018": "a field that has no place here";
    BAD_PATH = "E019": "a path that cannot name a file";
    BAD_FRAMES = "E020": "a frame range that is empty, reversed or not half-open";
    DARK_EMITTER = "E021": "an emitter without a shape";
    ZERO_SCALE = "E022": "a scale of zero flattens the entity";
    KEY_ORDER = "E023": "key times are not in rising order";
    BAD_HEX = "E024": "an sRGB colour that is not \"#rrggbb\"";
    NOT_YET = "E090": "the format knows this, but it cannot be rendered yet";
    NO_LIGHT = "W001": "nothing shines: the image will be black";
    UNUSED_MATERIAL = "W002": "no entity uses this material";
    IDLE_NORMALS = "W003": "`normals` without a mesh has no effect";
    IDLE_MATERIAL = "W004": "`material` without a shape has no effect";
    MANY_SAMPLES = "W005": "so many samples that the render may never end";
    NO_BOUNCES = "W006": "without bounces only emitters and the background are seen";
}
