//! [`SceneDesc`] to text: the scene as a person would write it.
//!
//! Enters: a scene. Leaves: RON that reads as the same scene (places apart), in the layout of `scenes/`: defaults left
//! out, one entity a line, names in a column. Numbers are the shortest that read back to the same bits.
//!
//! Deliberately absent: comments (the caller puts them in front), and names that a scene lacks: an unnamed parent or a
//! material out of range is written as "", which the reader refuses.

mod text;

#[cfg(test)]
mod tests;

use super::schema::{
    AnimationDesc, BackgroundDesc, CameraDesc, CameraPose, ColorDesc, EaseDesc, EntityDesc,
    FilterDesc, GltfDesc, HdrDesc, KeyDesc, KeysDesc, LightDesc, MaterialDesc, NormalsDesc,
    RenderDesc, RotateDesc, SceneDesc, ShapeDesc, SpinDesc, TextureFilterDesc, TransformDesc,
    WrapDesc,
};
use super::{VERSION, srgb};
use std::fmt::Write;
use text::{Fields, column, fill, number, vector};

/// The scene as RON, ending in a line end.
#[must_use]
pub fn write(desc: &SceneDesc) -> String {
    let mut text = format!("Scene(\n    version: {VERSION},\n");
    let mut section = |name: &str, value: &str| {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "    {name}: {value},");
    };
    if let Some(camera) = &desc.camera {
        section("camera", &top_camera(camera));
    }
    if desc.render != RenderDesc::default() {
        section("render", &render(&desc.render));
    }
    if desc.background != BackgroundDesc::Linear(SceneDesc::BACKGROUND) {
        section("background", &background(&desc.background));
    }
    if !desc.materials.is_empty() {
        section("materials", &materials(desc));
    }
    if !desc.entities.is_empty() {
        section("entities", &entities(desc));
    }
    if desc.animation != AnimationDesc::default() {
        section("animation", &animation(&desc.animation));
    }
    text.push_str(")\n");
    text
}

fn top_camera(camera: &CameraDesc) -> String {
    // A scene that was read has a pose here; without one a camera stands at the origin and looks along −Z.
    let pose = camera.pose.unwrap_or(CameraPose {
        at: [0.0; 3],
        look_at: [0.0, 0.0, -1.0],
        up: CameraPose::UP,
    });
    let fields = Fields::default()
        .with("at", vector(&pose.at))
        .with("look_at", vector(&pose.look_at))
        .unless(&CameraPose::UP, "up", &pose.up, |up| vector(up));
    optics(fields, camera, CameraDesc::default_focus(&pose)).close()
}

fn optics(fields: Fields, camera: &CameraDesc, default_focus: f64) -> Fields {
    let lens = Fields::default()
        .number_unless(
            CameraDesc::APERTURE_RADIUS,
            "aperture_radius",
            camera.aperture_radius,
        )
        .number_unless(default_focus, "focus_distance", camera.focus_distance);
    let fields = fields.number_unless(CameraDesc::VFOV_DEG, "vfov_deg", camera.vfov_deg);
    if lens.0.is_empty() {
        fields
    } else {
        fields.with("lens", lens.close())
    }
}

fn render(render: &RenderDesc) -> String {
    let default = RenderDesc::default();
    let whole = |n: &u32| n.to_string();
    Fields::default()
        .unless(&default.size, "size", &render.size, |(w, h)| {
            format!("({w}, {h})")
        })
        .unless(&default.spp, "spp", &render.spp, whole)
        .unless(
            &default.max_bounces,
            "max_bounces",
            &render.max_bounces,
            whole,
        )
        .unless(&default.filter, "filter", &render.filter, filter)
        .close()
}

fn filter(filter: &FilterDesc) -> String {
    match filter {
        FilterDesc::Box => "Box".to_owned(),
        FilterDesc::Gaussian { radius_px } => Fields::default()
            .number_unless(FilterDesc::GAUSSIAN_RADIUS_PX, "radius_px", *radius_px)
            .close_variant("Gaussian"),
    }
}

fn animation(animation: &AnimationDesc) -> String {
    let default = AnimationDesc::default();
    Fields::default()
        .number_unless(default.fps, "fps", animation.fps)
        .unless(&default.frames, "frames", &animation.frames, |frames| {
            format!("{}..{}", frames.start, frames.end)
        })
        .close()
}

/// One a line, the values in a column.
fn materials(desc: &SceneDesc) -> String {
    let keys: Vec<String> = desc
        .materials
        .iter()
        .map(|m| format!("{:?}:", m.name))
        .collect();
    let column = column(keys.iter());
    let mut text = "{\n".to_owned();
    for (key, named) in keys.iter().zip(&desc.materials) {
        let _ = writeln!(text, "        {key:column$} {},", material(&named.material));
    }
    text.push_str("    }");
    text
}

fn material(material: &MaterialDesc) -> String {
    let (variant, default, color) = match material {
        MaterialDesc::Diffuse { color } => ("Diffuse", MaterialDesc::DIFFUSE_COLOR, color),
        MaterialDesc::Mirror { color } => ("Mirror", MaterialDesc::CLEAR_COLOR, color),
        MaterialDesc::Glass { color, .. } => ("Glass", MaterialDesc::CLEAR_COLOR, color),
        MaterialDesc::Plastic { color, .. } => ("Plastic", MaterialDesc::DIFFUSE_COLOR, color),
        MaterialDesc::Metal { color, .. } => ("Metal", MaterialDesc::DIFFUSE_COLOR, color),
    };
    let fields = Fields::default().unless(&ColorDesc::Linear(default), "color", color, self::color);
    match material {
        MaterialDesc::Glass { ior, .. } | MaterialDesc::Plastic { ior, .. } => {
            fields.number_unless(MaterialDesc::IOR, "ior", *ior)
        }
        MaterialDesc::Metal { roughness, .. } => {
            fields.number_unless(MaterialDesc::ROUGHNESS, "roughness", *roughness)
        }
        MaterialDesc::Diffuse { .. } | MaterialDesc::Mirror { .. } => fields,
    }
    .close_variant(variant)
}

fn background(background: &BackgroundDesc) -> String {
    let hdr = match background {
        BackgroundDesc::Linear(rgb) => return linear(rgb),
        BackgroundDesc::Hdr(hdr) => hdr,
    };
    let fields = Fields::default()
        .number_unless(HdrDesc::ROTATE_DEG, "rotate_deg", hdr.rotate_deg)
        .number_unless(HdrDesc::STRENGTH, "strength", hdr.strength)
        .unless(&TextureFilterDesc::default(), "filter", &hdr.filter, |f| {
            format!("{f:?}")
        });
    if fields.0.is_empty() {
        return format!("Hdr({:?})", hdr.path.value);
    }
    let path = format!("path: {:?}", hdr.path.value);
    Fields([vec![path], fields.0].concat()).close_variant("Hdr")
}

fn linear(rgb: &[f64; 3]) -> String {
    /// Numbers that a person would write make a shorter text than this.
    const LONG: usize = 24;
    let linear = format!("Linear{}", vector(rgb));
    match srgb::encode_hex(*rgb) {
        Some(hex) if linear.len() > LONG => format!("Srgb({hex:?})"),
        _ => linear,
    }
}

fn color(color: &ColorDesc) -> String {
    match color {
        ColorDesc::Linear(rgb) => linear(rgb),
        ColorDesc::Image { path, wrap, filter } => {
            let fields = Fields::default()
                .unless(&WrapDesc::default(), "wrap", wrap, |w| format!("{w:?}"))
                .unless(&TextureFilterDesc::default(), "filter", filter, |f| {
                    format!("{f:?}")
                });
            if fields.0.is_empty() {
                format!("Texture({:?})", path.value)
            } else {
                let path = format!("path: {:?}", path.value);
                Fields([vec![path], fields.0].concat()).close_variant("Image")
            }
        }
    }
}

fn entities(desc: &SceneDesc) -> String {
    let names: Vec<String> = desc
        .entities
        .iter()
        .map(|e| {
            let name = e.value.name.as_ref();
            name.map_or(String::new(), |name| format!("name: {name:?},"))
        })
        .collect();
    let column = column(names.iter());
    let mut text = "[\n".to_owned();
    for (name, entity) in names.iter().zip(&desc.entities) {
        let components = components(desc, &entity.value);
        if components.is_empty() {
            let _ = writeln!(text, "        ({}),", name.trim_end_matches(','));
        } else {
            let start = format!(
                "        ({name:column$}{}",
                if column > 0 { " " } else { "" }
            );
            let _ = writeln!(text, "{}),", fill(start, &components));
        }
    }
    text.push_str("    ]");
    text
}

/// `component: value` of everything but the name.
fn components(desc: &SceneDesc, entity: &EntityDesc) -> Vec<String> {
    let mut fields = Fields::default();
    if let Some(parent) = entity.parent {
        let parent = desc.entities.get(parent).and_then(|e| e.value.name.clone());
        fields = fields.with("parent", format!("{:?}", parent.unwrap_or_default()));
    }
    if let Some(value) = &entity.shape {
        fields = fields.with("shape", shape(value));
    }
    if let Some(material) = entity.material {
        let name = desc.materials.get(material).map_or("", |m| m.name.as_str());
        fields = fields.with("material", format!("{name:?}"));
    }
    if let Some(value) = &entity.normals {
        fields = fields.with("normals", normals(value));
    }
    fields = fields.unless(
        &TransformDesc::default(),
        "transform",
        &entity.transform,
        transform,
    );
    if let Some(value) = &entity.spin {
        fields = fields.with("spin", spin(value));
    }
    if let Some(value) = &entity.keys {
        fields = fields.with("keys", keys(value));
        fields = fields.unless(&EaseDesc::default(), "ease", &value.ease, |e| {
            format!("{e:?}")
        });
    }
    if let Some(radiance) = &entity.emissive {
        fields = fields.with("emissive", format!("(radiance: {})", vector(radiance)));
    }
    if let Some(camera) = &entity.camera {
        let optics = optics(Fields::default(), camera, CameraDesc::FOCUS_DISTANCE);
        fields = fields.with("camera", optics.close());
    }
    if let Some(value) = &entity.light {
        fields = fields.with("light", light(value));
    }
    if let Some(value) = &entity.gltf {
        fields = fields.with("gltf", gltf(value));
    }
    fields.0
}

fn shape(shape: &ShapeDesc) -> String {
    match shape {
        ShapeDesc::Sphere { radius, inverted } => Fields::default()
            .with("radius", number(*radius))
            .unless(&false, "inverted", inverted, bool::to_string)
            .close_variant("Sphere"),
        ShapeDesc::Mesh { path, mesh: None } => format!("Mesh({:?})", path.value),
        ShapeDesc::Mesh {
            path,
            mesh: Some(mesh),
        } => format!("Mesh(path: {:?}, mesh: {mesh})", path.value),
    }
}

fn light(light: &LightDesc) -> String {
    let fields = Fields::default();
    match light {
        LightDesc::Point { intensity } => fields
            .with("intensity", vector(intensity))
            .close_variant("Point"),
        LightDesc::Spot {
            intensity,
            inner_deg,
            outer_deg,
        } => fields
            .with("intensity", vector(intensity))
            .with("inner_deg", number(*inner_deg))
            .with("outer_deg", number(*outer_deg))
            .close_variant("Spot"),
        LightDesc::Sun { irradiance } => fields
            .with("irradiance", vector(irradiance))
            .close_variant("Sun"),
    }
}

fn gltf(gltf: &GltfDesc) -> String {
    if gltf.lights {
        format!("{:?}", gltf.path.value)
    } else {
        format!("(path: {:?}, lights: false)", gltf.path.value)
    }
}

fn normals(normals: &NormalsDesc) -> String {
    match normals {
        NormalsDesc::File => "File".to_owned(),
        NormalsDesc::Flat => "Flat".to_owned(),
        NormalsDesc::Smooth { angle_deg } => Fields::default()
            .number_unless(NormalsDesc::SMOOTH_ANGLE_DEG, "angle_deg", *angle_deg)
            .close_variant("Smooth"),
    }
}

fn transform(transform: &TransformDesc) -> String {
    let default = TransformDesc::default();
    Fields::default()
        .unless(
            &default.translate,
            "translate",
            &transform.translate,
            |translate| vector(translate),
        )
        .unless(&default.rotate, "rotate", &transform.rotate, rotate)
        .unless(&default.scale, "scale", &transform.scale, scale)
        .close()
}

fn rotate(rotate: &RotateDesc) -> String {
    match rotate {
        RotateDesc::Euler(deg) => format!("Euler{}", vector(deg)),
        RotateDesc::AxisAngle { axis, deg } => Fields::default()
            .with("axis", vector(axis))
            .with("deg", number(*deg))
            .close_variant("AxisAngle"),
        RotateDesc::Quat(q) => format!("Quat{}", vector(q)),
    }
}

fn scale(&[x, y, z]: &[f64; 3]) -> String {
    if x == y && y == z {
        number(x)
    } else {
        vector(&[x, y, z])
    }
}

fn spin(spin: &SpinDesc) -> String {
    let fields = Fields::default()
        .with("axis", vector(&spin.axis))
        .with("deg_per_s", number(spin.deg_per_s));
    match &spin.pivot {
        Some(pivot) => fields.with("pivot", vector(pivot)),
        None => fields,
    }
    .close()
}

fn keys(desc: &KeysDesc) -> String {
    let key = |key: &KeyDesc| {
        let mut fields = Fields::default().with("t", number(key.t));
        if let Some(v) = &key.translate {
            fields = fields.with("translate", vector(v));
        }
        if let Some(r) = &key.rotate {
            fields = fields.with("rotate", rotate(r));
        }
        if let Some(s) = &key.scale {
            fields = fields.with("scale", scale(s));
        }
        fields.close()
    };
    let keys: Vec<String> = desc.keys.iter().map(key).collect();
    format!("[{}]", keys.join(", "))
}
