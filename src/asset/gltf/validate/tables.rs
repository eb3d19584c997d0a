//! The objects of glTF 2.0 (specification, section 5), property by property, and those of the extensions that luxel
//! reads (KHR registry).

use super::extensions::VARIANTS;
use super::schema::{
    ANY, Kind, NOT_NEGATIVE, Object, POSITIVE, Property, SHARE, SINE, keep, need, object, skip,
};
use Kind::{
    Attributes, Bool, Code, Index, IndexOf, Integer, List, Number, Numbers, Set, Text, Uri,
    Version, Word,
};

const NAME: Property = keep("name", Text);

pub(super) static ROOT: Object = Object {
    properties: &[
        need("asset", Kind::Object(&ASSET)).required(),
        keep("extensionsUsed", Set(&Text)),
        keep("extensionsRequired", Set(&Text)),
        need("accessors", List(&Kind::Object(&ACCESSOR))),
        skip("animations", List(&Kind::Object(&ANIMATION))),
        need("buffers", List(&Kind::Object(&BUFFER))),
        need("bufferViews", List(&Kind::Object(&BUFFER_VIEW))),
        keep("cameras", List(&Kind::Object(&CAMERA))),
        need("images", List(&Kind::Object(&IMAGE))),
        need("materials", List(&Kind::Object(&MATERIAL))),
        need("meshes", List(&Kind::Object(&MESH))),
        need("nodes", List(&Kind::Object(&NODE))),
        need("samplers", List(&Kind::Object(&SAMPLER))),
        need("scene", Index("scenes")),
        need("scenes", List(&Kind::Object(&SCENE))),
        skip("skins", List(&Kind::Object(&SKIN))),
        need("textures", List(&Kind::Object(&TEXTURE))),
    ],
    extensions: &[("KHR_lights_punctual", &LIGHTS), (VARIANTS, &VARIANT_LIST)],
};

static ASSET: Object = object(&[
    skip("copyright", Text),
    skip("generator", Text),
    need("version", Version).required(),
    keep("minVersion", Version),
]);

const COMPONENT_TYPES: &[u64] = &[5120, 5121, 5122, 5123, 5125, 5126];

// `type` and `componentType` are kept only, since an accessor that nothing uses may be of any type.
static ACCESSOR: Object = object(&[
    need("bufferView", Index("bufferViews")),
    need("byteOffset", Integer(0)),
    keep("componentType", Code(COMPONENT_TYPES)).required(),
    need("normalized", Bool),
    need("count", Integer(1)).required(),
    keep(
        "type",
        Word(&["SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"]),
    )
    .required(),
    skip("max", Numbers(&[1, 2, 3, 4, 9, 16], ANY)),
    skip("min", Numbers(&[1, 2, 3, 4, 9, 16], ANY)),
    need("sparse", Kind::Object(&SPARSE)),
    NAME,
]);

static SPARSE: Object = object(&[
    need("count", Integer(1)).required(),
    need("indices", Kind::Object(&SPARSE_INDICES)).required(),
    need("values", Kind::Object(&SPARSE_VALUES)).required(),
]);

static SPARSE_INDICES: Object = object(&[
    need("bufferView", Index("bufferViews")).required(),
    need("byteOffset", Integer(0)),
    keep("componentType", Code(&[5121, 5123, 5125])).required(),
]);

static SPARSE_VALUES: Object = object(&[
    need("bufferView", Index("bufferViews")).required(),
    need("byteOffset", Integer(0)),
]);

static BUFFER: Object = object(&[
    need("uri", Uri),
    need("byteLength", Integer(1)).required(),
    NAME,
]);

static BUFFER_VIEW: Object = object(&[
    need("buffer", Index("buffers")).required(),
    need("byteOffset", Integer(0)),
    need("byteLength", Integer(1)).required(),
    need("byteStride", Integer(0)),
    skip("target", Code(&[34962, 34963])),
    NAME,
]);

static IMAGE: Object = object(&[
    need("uri", Uri),
    keep("mimeType", Text),
    need("bufferView", Index("bufferViews")),
    NAME,
]);

static TEXTURE: Object = object(&[
    need("sampler", Index("samplers")),
    need("source", Index("images")),
    NAME,
]);

static SAMPLER: Object = object(&[
    keep("magFilter", Code(&[9728, 9729])),
    keep("minFilter", Code(&[9728, 9729, 9984, 9985, 9986, 9987])),
    keep("wrapS", Code(&[33071, 33648, 10497])),
    keep("wrapT", Code(&[33071, 33648, 10497])),
    NAME,
]);

static MATERIAL: Object = Object {
    properties: &[
        need("pbrMetallicRoughness", Kind::Object(&METALLIC_ROUGHNESS)),
        keep("normalTexture", Kind::Object(&NORMAL_TEXTURE)),
        keep("occlusionTexture", Kind::Object(&OCCLUSION_TEXTURE)),
        need("emissiveTexture", Kind::Object(&TEXTURE_INFO)),
        keep("emissiveFactor", Numbers(&[3], SHARE)),
        keep("alphaMode", Word(&["OPAQUE", "MASK", "BLEND"])),
        keep("alphaCutoff", Number(NOT_NEGATIVE)),
        keep("doubleSided", Bool),
        NAME,
    ],
    extensions: &[
        ("KHR_materials_emissive_strength", &EMISSIVE_STRENGTH),
        ("KHR_materials_ior", &IOR),
        ("KHR_materials_pbrSpecularGlossiness", &SPECULAR_GLOSSINESS),
        ("KHR_materials_transmission", &TRANSMISSION),
        ("KHR_materials_unlit", &UNLIT),
    ],
};

static METALLIC_ROUGHNESS: Object = object(&[
    keep("baseColorFactor", Numbers(&[4], SHARE)),
    need("baseColorTexture", Kind::Object(&TEXTURE_INFO)),
    keep("metallicFactor", Number(SHARE)),
    keep("roughnessFactor", Number(SHARE)),
    need("metallicRoughnessTexture", Kind::Object(&TEXTURE_INFO)),
]);

type Extensions = &'static [(&'static str, &'static Object)];

const OF_TEXTURE_INFO: Extensions = &[("KHR_texture_transform", &TEXTURE_TRANSFORM)];

static TEXTURE_INFO: Object = Object {
    properties: &[
        need("index", Index("textures")).required(),
        keep("texCoord", Integer(0)),
    ],
    extensions: OF_TEXTURE_INFO,
};

static NORMAL_TEXTURE: Object = Object {
    properties: &[
        need("index", Index("textures")).required(),
        keep("texCoord", Integer(0)),
        keep("scale", Number(ANY)),
    ],
    extensions: OF_TEXTURE_INFO,
};

static OCCLUSION_TEXTURE: Object = Object {
    properties: &[
        need("index", Index("textures")).required(),
        keep("texCoord", Integer(0)),
        keep("strength", Number(SHARE)),
    ],
    extensions: OF_TEXTURE_INFO,
};

static MESH: Object = object(&[
    need("primitives", List(&Kind::Object(&PRIMITIVE))).required(),
    skip("weights", Numbers(&[], ANY)),
    NAME,
]);

// An unknown mode is not drawn.
static PRIMITIVE: Object = Object {
    properties: &[
        need("attributes", Attributes).required(),
        need("indices", Index("accessors")),
        need("material", Index("materials")),
        keep("mode", Code(&[0, 1, 2, 3, 4, 5, 6])),
        skip("targets", List(&Attributes)),
    ],
    extensions: &[(VARIANTS, &VARIANT_MAPPINGS)],
};

static NODE: Object = Object {
    properties: &[
        keep("camera", Index("cameras")),
        need("children", Set(&Index("nodes"))),
        skip("skin", Index("skins")),
        need("matrix", Numbers(&[16], ANY)),
        need("mesh", Index("meshes")),
        need("rotation", Numbers(&[4], SINE)),
        need("scale", Numbers(&[3], ANY)),
        need("translation", Numbers(&[3], ANY)),
        skip("weights", Numbers(&[], ANY)),
        NAME,
    ],
    extensions: &[("KHR_lights_punctual", &NODE_LIGHT)],
};

static SCENE: Object = object(&[need("nodes", Set(&Index("nodes"))), NAME]);

static CAMERA: Object = object(&[
    keep("orthographic", Kind::Object(&ORTHOGRAPHIC)),
    keep("perspective", Kind::Object(&PERSPECTIVE)),
    keep("type", Word(&["perspective", "orthographic"])).required(),
    NAME,
]);

static ORTHOGRAPHIC: Object = object(&[
    keep("xmag", Number(ANY)).required(),
    keep("ymag", Number(ANY)).required(),
    keep("zfar", Number(POSITIVE)).required(),
    keep("znear", Number(NOT_NEGATIVE)).required(),
]);

static PERSPECTIVE: Object = object(&[
    keep("aspectRatio", Number(POSITIVE)),
    keep("yfov", Number(POSITIVE)).required(),
    keep("zfar", Number(POSITIVE)),
    keep("znear", Number(POSITIVE)).required(),
]);

static SKIN: Object = object(&[
    skip("inverseBindMatrices", Index("accessors")),
    skip("skeleton", Index("nodes")),
    skip("joints", Set(&Index("nodes"))).required(),
    NAME,
]);

static ANIMATION: Object = object(&[
    skip("channels", List(&Kind::Object(&CHANNEL))).required(),
    skip("samplers", List(&Kind::Object(&ANIMATION_SAMPLER))).required(),
    NAME,
]);

// `sampler` is an index within the animation: see animations.rs.
static CHANNEL: Object = object(&[
    skip("sampler", Integer(0)).required(),
    skip("target", Kind::Object(&TARGET)).required(),
]);

static TARGET: Object = object(&[
    skip("node", Index("nodes")),
    skip(
        "path",
        Word(&["translation", "rotation", "scale", "weights", "pointer"]),
    )
    .required(),
]);

static ANIMATION_SAMPLER: Object = object(&[
    skip("input", Index("accessors")).required(),
    skip("interpolation", Word(&["LINEAR", "STEP", "CUBICSPLINE"])),
    skip("output", Index("accessors")).required(),
]);

static LIGHTS: Object = object(&[keep("lights", List(&Kind::Object(&LIGHT))).required()]);

static LIGHT: Object = object(&[
    NAME,
    keep("color", Numbers(&[3], SHARE)),
    keep("intensity", Number(NOT_NEGATIVE)),
    keep("type", Word(&["directional", "point", "spot"])).required(),
    keep("range", Number(POSITIVE)),
    keep("spot", Kind::Object(&SPOT)),
]);

static SPOT: Object = object(&[
    keep("innerConeAngle", Number(NOT_NEGATIVE)),
    keep("outerConeAngle", Number(POSITIVE)),
]);

static NODE_LIGHT: Object =
    object(&[keep("light", IndexOf("KHR_lights_punctual", "lights")).required()]);

static VARIANT_LIST: Object = object(&[skip("variants", List(&Kind::Object(&VARIANT))).required()]);

static VARIANT: Object = object(&[skip("name", Text).required()]);

static VARIANT_MAPPINGS: Object =
    object(&[skip("mappings", List(&Kind::Object(&VARIANT_MAPPING))).required()]);

static VARIANT_MAPPING: Object = object(&[
    skip("material", Index("materials")).required(),
    skip("variants", Set(&IndexOf(VARIANTS, "variants"))).required(),
    NAME,
]);

static EMISSIVE_STRENGTH: Object = object(&[keep("emissiveStrength", Number(NOT_NEGATIVE))]);

static IOR: Object = object(&[keep("ior", Number(NOT_NEGATIVE))]);

static SPECULAR_GLOSSINESS: Object = object(&[
    keep("diffuseFactor", Numbers(&[4], SHARE)),
    keep("diffuseTexture", Kind::Object(&TEXTURE_INFO)),
    keep("specularFactor", Numbers(&[3], SHARE)),
    keep("glossinessFactor", Number(SHARE)),
    keep("specularGlossinessTexture", Kind::Object(&TEXTURE_INFO)),
]);

static TRANSMISSION: Object = object(&[
    keep("transmissionFactor", Number(SHARE)),
    keep("transmissionTexture", Kind::Object(&TEXTURE_INFO)),
]);

static UNLIT: Object = object(&[]);

static TEXTURE_TRANSFORM: Object = object(&[
    keep("offset", Numbers(&[2], ANY)),
    keep("rotation", Number(ANY)),
    keep("scale", Numbers(&[2], ANY)),
    keep("texCoord", Integer(0)),
]);
