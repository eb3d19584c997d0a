//! An entity: a struct of optional components.

use super::layer::Node;
use super::motion;
use super::reader::{Fields, Reader};
use super::schema::{
    EntityDesc, GltfDesc, NormalsDesc, RotateDesc, ShapeDesc, SpinDesc, TransformDesc,
};
use super::values::{Domain, MAX_RADIANCE};
use super::{light, settings};
use crate::diag::codes;

/// Every component, in the order of the format's description.
const COMPONENTS: [&str; 13] = [
    "name",
    "parent",
    "shape",
    "material",
    "transform",
    "spin",
    "keys",
    "ease",
    "emissive",
    "normals",
    "camera",
    "light",
    "gltf",
];

/// An entity whose names are not resolved yet.
pub(super) struct RawEntity<'a> {
    /// Without `parent` and `material`.
    pub(super) desc: EntityDesc,
    pub(super) node: Node<'a>,
    pub(super) parent: Option<(String, Node<'a>)>,
    pub(super) material: Option<(String, Node<'a>)>,
    pub(super) camera: Option<Node<'a>>,
}

impl<'a> RawEntity<'a> {
    /// The value of a component that is written: looked for again, since few are asked for and entities may be many.
    pub(super) fn component(&self, name: &str) -> Option<Node<'a>> {
        self.node.field(name)?.given()
    }
}

pub(super) fn entity<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<RawEntity<'a>> {
    let fields = Fields::read(reader, node, "an entity", &COMPONENTS)?;
    let reference =
        |name: &str, what: &str| fields.read_if(name, |r, n| Some((r.string(n, what)?, n)));
    let desc = EntityDesc {
        name: fields.read_if("name", |r, n| r.string(n, "`name`")),
        parent: None,
        shape: fields.read_if("shape", shape),
        material: None,
        transform: fields.read_or("transform", TransformDesc::default(), transform),
        spin: fields.read_if("spin", spin),
        keys: motion::keys(&fields).map(Box::new),
        emissive: fields.read_if("emissive", emissive),
        normals: fields.read_if("normals", normals),
        camera: fields
            .read_if("camera", settings::entity_camera)
            .map(Box::new),
        light: fields.read_if("light", light::light).map(Box::new),
        gltf: fields.read_if("gltf", gltf).map(Box::new),
    };
    check_components(&fields);
    Some(RawEntity {
        desc,
        node,
        parent: reference("parent", "`parent`"),
        material: reference("material", "`material`"),
        camera: fields.get("camera"),
    })
}

/// Components that need another one.
fn check_components(fields: &Fields<'_, '_>) {
    let reader = fields.reader;
    let [shape, gltf, material] = ["shape", "gltf", "material"].map(|name| fields.get(name));
    let shapeless = shape.is_none() && gltf.is_none();
    if let (Some(place), true) = (fields.get("emissive"), shapeless) {
        reader.error_hint(
            codes::DARK_EMITTER,
            place,
            "`emissive` needs a `shape` that shines",
            "add a `shape`",
        );
    }
    if let (Some(place), true) = (material, shapeless) {
        reader.warn(
            codes::IDLE_MATERIAL,
            place,
            "`material` has no effect on an entity without a `shape`",
        );
    }
    // The file's nodes stand for shapes.
    let is_mesh = gltf.is_some() || shape.is_some_and(|s| s.text.starts_with("Mesh"));
    if let (Some(place), false) = (fields.get("normals"), is_mesh) {
        reader.warn(
            codes::IDLE_NORMALS,
            place,
            "`normals` has no effect on an entity without a mesh",
        );
    }
    if let (Some(place), Some(_)) = (gltf, shape) {
        reader.error_hint(
            codes::MISPLACED,
            place,
            "an entity has either a `shape` or a `gltf`",
            "give the file an entity of its own, with this one as its `parent`",
        );
    }
}

fn shape<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<ShapeDesc> {
    let (variant, body) = reader.variant(node, "`shape`", &["Sphere", "Mesh"])?;
    if variant == "Mesh" {
        return mesh(reader, body);
    }
    let fields = Fields::read(reader, body, "`Sphere`", &["radius", "inverted"])?;
    let radius = fields.require("radius", |r, n| r.number(n, "`radius`", Domain::Positive));
    let inverted = fields.read_or("inverted", false, |r, n| r.truth(n, "`inverted`"));
    Some(ShapeDesc::Sphere {
        radius: radius?,
        inverted,
    })
}

/// `("cat.obj")` or `(path: "room.glb", mesh: 3)`.
fn mesh<'a>(reader: &Reader<'a>, body: Node<'a>) -> Option<ShapeDesc> {
    if body.fields().is_ok_and(|fields| !fields.is_empty()) {
        let fields = Fields::read(reader, body, "`Mesh`", &["path", "mesh"])?;
        let path = fields.require("path", |r, n| r.path(n, "the mesh"));
        let mesh = fields.read_if("mesh", |r, n| r.whole(n, "`mesh`", 0, u32::MAX));
        return Some(ShapeDesc::Mesh { path: path?, mesh });
    }
    let path = reader.single(body, "Mesh", "Mesh(\"file\")")?;
    let path = reader.path(path, "the mesh")?;
    Some(ShapeDesc::Mesh { path, mesh: None })
}

/// `"room.glb"` or `(path: "room.glb", lights: false)`.
fn gltf<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<GltfDesc> {
    if node.text.starts_with('(') {
        let fields = Fields::read(reader, node, "`gltf`", &["path", "lights"])?;
        let path = fields.require("path", |r, n| r.path(n, "the glTF file"));
        let lights = fields.read_or("lights", true, |r, n| r.truth(n, "`lights`"));
        return Some(GltfDesc {
            path: path?,
            lights,
        });
    }
    let path = reader.path(node, "`gltf`")?;
    Some(GltfDesc { path, lights: true })
}

fn transform<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<TransformDesc> {
    let fields = Fields::read(
        reader,
        node,
        "`transform`",
        &["translate", "rotate", "scale"],
    )?;
    let default = TransformDesc::default();
    Some(TransformDesc {
        translate: fields.read_or("translate", default.translate, translate),
        rotate: fields.read_or("rotate", default.rotate, rotate),
        scale: fields.read_or("scale", default.scale, scale),
    })
}

pub(super) fn translate<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<[f64; 3]> {
    reader.vector(node, "`translate`", Domain::Any)
}

/// A number or a triple.
pub(super) fn scale<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<[f64; 3]> {
    let scale = if node.text.starts_with('(') {
        reader.vector(node, "`scale`", Domain::Any)?
    } else if node.number().is_some() {
        [reader.number(node, "`scale`", Domain::Any)?; 3]
    } else {
        return reader.wrong_type(node, "`scale`", "a number or three numbers in parentheses");
    };
    if scale.contains(&0.0) {
        reader.error(
            codes::ZERO_SCALE,
            node,
            "a `scale` of 0 flattens the entity",
        );
        return None;
    }
    Some(scale)
}

pub(super) fn rotate<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<RotateDesc> {
    let (variant, body) = reader.variant(node, "`rotate`", &["Euler", "AxisAngle", "Quat"])?;
    match variant {
        "Euler" => reader
            .vector(body, "`Euler`", Domain::Any)
            .map(RotateDesc::Euler),
        "Quat" => reader.direction(body, "`Quat`").map(RotateDesc::Quat),
        _ => {
            let fields = Fields::read(reader, body, "`AxisAngle`", &["axis", "deg"])?;
            let axis = fields.require("axis", |r, n| r.direction(n, "`axis`"));
            let deg = fields.require("deg", |r, n| r.number(n, "`deg`", Domain::Any));
            Some(RotateDesc::AxisAngle {
                axis: axis?,
                deg: deg?,
            })
        }
    }
}

fn spin<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<SpinDesc> {
    let fields = Fields::read(reader, node, "`spin`", &["axis", "deg_per_s", "pivot"])?;
    let axis = fields.require("axis", |r, n| r.direction(n, "`axis`"));
    let deg_per_s = fields.require("deg_per_s", |r, n| r.number(n, "`deg_per_s`", Domain::Any));
    let pivot = fields.read_if("pivot", |r, n| r.vector(n, "`pivot`", Domain::Any));
    Some(SpinDesc {
        axis: axis?,
        deg_per_s: deg_per_s?,
        pivot,
    })
}

fn emissive<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<[f64; 3]> {
    let fields = Fields::read(reader, node, "`emissive`", &["radiance"])?;
    fields.require("radiance", |r, n| {
        r.vector(n, "`radiance`", Domain::UpTo(MAX_RADIANCE))
    })
}

fn normals<'a>(reader: &Reader<'a>, node: Node<'a>) -> Option<NormalsDesc> {
    let (variant, body) = reader.variant(node, "`normals`", &["File", "Flat", "Smooth"])?;
    if variant == "Smooth" {
        let fields = Fields::read(reader, body, "`Smooth`", &["angle_deg"])?;
        let angle_deg = fields.read_or("angle_deg", NormalsDesc::SMOOTH_ANGLE_DEG, |r, n| {
            r.number(n, "`angle_deg`", Domain::UpTo(180.0))
        });
        return Some(NormalsDesc::Smooth { angle_deg });
    }
    reader.no_fields(body, variant)?;
    Some(if variant == "File" {
        NormalsDesc::File
    } else {
        NormalsDesc::Flat
    })
}
