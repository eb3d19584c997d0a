//! [`SceneDesc`] to text: the scene as a person would write it.
//!
//! Enters: a scene. Leaves: RON that reads as the same scene (places apart), in the layout of `scenes/`: defaults left
//! out, one entity a line, names in a column. Numbers are the shortest that read back to the same bits.
//!
//! Deliberately absent: comments (the caller puts them in front), and names that a scene lacks: an unnamed parent or a
//! material out of range is written as "", which the reader refuses.

use super::schema::{
    AnimationDesc, CameraDesc, CameraPose, ColorDesc, EntityDesc, FilterDesc, MaterialDesc,
    NormalsDesc, RenderDesc, RotateDesc, SceneDesc, ShapeDesc, SpinDesc, TextureFilterDesc,
    TransformDesc, WrapDesc,
};
use super::{VERSION, settings, srgb};
use std::fmt::Write;

/// Longest line that is written if there is a place to break it.
const WIDTH: usize = 130;

/// Names longer than this do not push the column of all others to the right.
const MAX_COLUMN: usize = 24;

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
    if desc.background != ColorDesc::Linear(SceneDesc::BACKGROUND) {
        section("background", &color(&desc.background));
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

/// Named fields in parentheses, in the order of the calls.
#[derive(Default)]
struct Fields(Vec<String>);

impl Fields {
    fn with(mut self, name: &str, value: impl std::fmt::Display) -> Fields {
        self.0.push(format!("{name}: {value}"));
        self
    }

    /// Leaves the field out where it would say the default.
    fn unless<T: PartialEq>(
        self,
        default: &T,
        name: &str,
        value: &T,
        text: impl Fn(&T) -> String,
    ) -> Fields {
        if value == default {
            self
        } else {
            self.with(name, text(value))
        }
    }

    fn number_unless(self, default: f64, name: &str, value: f64) -> Fields {
        self.unless(&default, name, &value, |x| number(*x))
    }

    /// `(a: .., b: ..)`.
    fn close(self) -> String {
        format!("({})", self.0.join(", "))
    }

    /// The same behind a variant, which stands alone where there is no field.
    fn close_variant(self, variant: &str) -> String {
        if self.0.is_empty() {
            variant.to_owned()
        } else {
            format!("{variant}{}", self.close())
        }
    }
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
    optics(fields, camera, settings::default_focus(&pose)).close()
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

fn color(color: &ColorDesc) -> String {
    /// Numbers that a person would write make a shorter text than this.
    const LONG: usize = 24;
    match color {
        ColorDesc::Linear(rgb) => {
            let linear = format!("Linear{}", vector(rgb));
            match srgb::encode_hex(*rgb) {
                Some(hex) if linear.len() > LONG => format!("Srgb({hex:?})"),
                _ => linear,
            }
        }
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
        ColorDesc::Hdr(path) => format!("Hdr({:?})", path.value),
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
            let start = format!("        ({name:column$}{}", if column > 0 { " " } else { "" });
            let _ = writeln!(text, "{}),", fill(start, &components));
        }
    }
    text.push_str("    ]");
    text
}

/// Appends items to a line, and goes on in the same column below where it would become too long.
fn fill(start: String, items: &[String]) -> String {
    let indent = start.chars().count();
    let mut length = indent;
    let mut text = start;
    for (i, item) in items.iter().enumerate() {
        let item_length = item.chars().count();
        // Before it ", ", behind it a comma or "),".
        if i > 0 && length + item_length + 4 > WIDTH {
            let _ = write!(text, ",\n{:indent$}", "");
            length = indent;
        } else if i > 0 {
            text.push_str(", ");
            length += 2;
        }
        text.push_str(item);
        length += item_length;
    }
    text
}

/// Width of a column that holds all texts but those that are too long.
fn column<'t>(texts: impl Iterator<Item = &'t String>) -> usize {
    let lengths = texts.map(|text| text.chars().count());
    lengths
        .filter(|&length| length <= MAX_COLUMN)
        .max()
        .unwrap_or(0)
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
    if let Some(radiance) = &entity.emissive {
        fields = fields.with("emissive", format!("(radiance: {})", vector(radiance)));
    }
    if let Some(camera) = &entity.camera {
        let optics = optics(Fields::default(), camera, CameraDesc::FOCUS_DISTANCE);
        fields = fields.with("camera", optics.close());
    }
    fields.0
}

fn shape(shape: &ShapeDesc) -> String {
    match shape {
        ShapeDesc::Sphere { radius, inverted } => Fields::default()
            .with("radius", number(*radius))
            .unless(&false, "inverted", inverted, bool::to_string)
            .close_variant("Sphere"),
        ShapeDesc::Mesh(path) => format!("Mesh({:?})", path.value),
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

fn vector(v: &[f64]) -> String {
    let numbers: Vec<String> = v.iter().map(|x| number(*x)).collect();
    format!("({})", numbers.join(", "))
}

/// The shortest digits that read back to the same bits, with an exponent where zeros would be counted otherwise.
fn number(x: f64) -> String {
    if x == 0.0 || (1e-4..1e7).contains(&x.abs()) {
        x.to_string()
    } else {
        format!("{x:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::super::{parse, tests::GOOD};
    use super::*;
    use std::path::Path;

    fn read(text: &str) -> SceneDesc {
        match parse(text, Path::new("scene.ron")) {
            Ok((desc, _)) => desc,
            Err(found) => panic!("{text}\n{found:#?}"),
        }
    }

    /// Everything but places and source; `{:?}` of a number is exact.
    fn content(desc: &SceneDesc) -> String {
        let mut desc = desc.clone();
        desc.source = "".into();
        forget_path(&mut desc.background);
        for named in &mut desc.materials {
            (named.at, named.len) = (0, 0);
            let (MaterialDesc::Diffuse { color }
            | MaterialDesc::Mirror { color }
            | MaterialDesc::Glass { color, .. }
            | MaterialDesc::Plastic { color, .. }
            | MaterialDesc::Metal { color, .. }) = &mut named.material;
            forget_path(color);
        }
        for entity in &mut desc.entities {
            (entity.at, entity.len) = (0, 0);
            if let Some(ShapeDesc::Mesh(path)) = &mut entity.value.shape {
                (path.at, path.len) = (0, 0);
            }
        }
        format!("{desc:?}")
    }

    fn forget_path(color: &mut ColorDesc) {
        if let ColorDesc::Image { path, .. } | ColorDesc::Hdr(path) = color {
            (path.at, path.len) = (0, 0);
        }
    }

    #[track_caller]
    fn assert_round_trip(desc: &SceneDesc) -> String {
        let text = write(desc);
        let again = read(&text);
        assert_eq!(content(&again), content(desc), "{text}");
        assert_eq!(write(&again), text, "writing is stable");
        text
    }

    #[test]
    fn the_content_sees_every_change() {
        let desc = read(GOOD);
        for (from, to) in [
            ("55)", "56)"),
            ("0.6)", "0.61)"),
            ("1.5)", "1.6)"),
            ("cat.png", "dog.png"),
            ("cat.obj", "dog.obj"),
            ("material: \"fur\"", "material: \"glass\""),
        ] {
            let other = read(&GOOD.replacen(from, to, 1));
            assert_ne!(content(&other), content(&desc), "{from}");
        }
    }

    #[test]
    fn every_shipped_scene_survives() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
        let mut count = 0;
        for entry in std::fs::read_dir(folder).expect("scenes/").flatten() {
            let text = std::fs::read_to_string(entry.path()).expect("text");
            assert_round_trip(&read(&text));
            count += 1;
        }
        assert!(count >= 12, "only {count} scenes");
    }

    #[test]
    fn the_sample_is_written_as_a_person_would() {
        let text = assert_round_trip(&read(GOOD));
        let wanted = r#"Scene(
    version: 1,
    camera: (at: (0, 0, 55), look_at: (0, 0, 0)),
    materials: {
        "chalk":  Diffuse,
        "fur":    Diffuse(color: Texture("../assets/cat.png")),
        "chrome": Mirror,
        "glass":  Glass,
    },
    entities: [
        (name: "lamp",  shape: Sphere(radius: 8), transform: (translate: (-10, 20, 40)), emissive: (radiance: (60, 60, 60))),
        (name: "floor", shape: Sphere(radius: 990), material: "chalk", transform: (translate: (0, -1000, 0))),
        (name: "ball",  shape: Sphere(radius: 10), material: "glass", transform: (translate: (25, 0, 0))),
        (name: "hub",   transform: (translate: (0, -10, 0)), spin: (axis: (0, 1, 0), deg_per_s: 90)),
        (name: "cat",   parent: "hub", shape: Mesh("../assets/cat.obj"), material: "fur", normals: Smooth,
                        transform: (rotate: Euler(0, 45, 0), scale: 0.6)),
        (name: "coin",  shape: Sphere(radius: 1), material: "chrome"),
    ],
    animation: (frames: 0..48),
)
"#;
        assert_eq!(text, wanted);
    }

    #[test]
    fn every_variant_and_awkward_value_survives() {
        assert_round_trip(&read("(version: 1, camera: (at: (0,0,1), look_at: (0,0,0)))"));
        assert_round_trip(&read(
            r##"(version: 1,
            render: (size: (7, 9), spp: 3, max_bounces: 0, filter: Gaussian(radius_px: 2.25)),
            background: Srgb("#7f3a01"),
            materials: {
                "with \"quotes\", \\ and\nlines": Diffuse(color: Srgb("#c0ffee")),
                "": Metal(color: Linear(0.1, 0.30000000000000004, 1e-9)),
                "p": Plastic(color: Linear(0, 0, 0), ior: 1.33),
                "i": Diffuse(color: Image(path: "é ü\t.png", wrap: Mirror, filter: Nearest)),
                "w": Mirror(color: Image(path: "x.png", wrap: Clamp)),
                "g": Glass(ior: 0.667, color: Linear(1, 0.5, 1)),
            },
            entities: [
                (), (name: "only a name"),
                (name: "eye", transform: (translate: (1e-200, -12345678.9, 0.00001), rotate: Quat(0, 0.1, 0, 1)),
                    camera: (vfov_deg: 12.5, lens: (aperture_radius: 0.25, focus_distance: 3))),
                (parent: "eye", shape: Sphere(radius: 1e100, inverted: true), emissive: (radiance: (1, 0, 1e18))),
                (parent: "only a name", shape: Mesh("a b.obj"), material: "", normals: Flat,
                    transform: (rotate: AxisAngle(axis: (1, 2, 3), deg: 0), scale: (1, -2, 3)),
                    spin: (axis: (0, 0, 1), deg_per_s: -7.5, pivot: (0, 0, 0))),
                (shape: Mesh("c.obj"), normals: File), (shape: Mesh("d.obj"), normals: Smooth(angle_deg: 30)),
            ],
            animation: (fps: 29.97, frames: 3..9))"##,
        ));
        assert_round_trip(&read(
            "(version: 1, camera: (at: (1, 2, 3), look_at: (0, 0, 0.1), up: (1, 0, 0), vfov_deg: 1e-3,
              lens: (aperture_radius: 0.1)), render: (filter: Box))",
        ));
    }

    #[test]
    fn numbers_are_short_and_exact() {
        for (x, text) in [
            (0.1 + 0.2, "0.30000000000000004"),
            (1000.0, "1000"),
            (1e7, "1e7"),
            (-0.00001, "-1e-5"),
            (0.0001, "0.0001"),
            (f64::MIN_POSITIVE, "2.2250738585072014e-308"),
        ] {
            assert_eq!(number(x), text);
            assert_eq!(number(x).parse(), Ok(x));
        }
    }
}
