//! A good scene reads as written, and no text at all makes the reader panic.

use super::*;

pub(super) const GOOD: &str = r##"
Scene(
    version: 1,
    camera: (at: (0, 0, 55), look_at: (0, 0, 0), up: (0, 1, 0), vfov_deg: 60, lens: (aperture_radius: 0, focus_distance: 55)),
    render: (size: (512, 512), spp: 64, max_bounces: 7, filter: Gaussian(radius_px: 1.5)),
    background: Linear(0, 0, 0), /* a night /* without stars */ */
    materials: {
        "chalk":  Diffuse(color: Linear(0.8, 0.8, 0.8)), // matt
        "fur":    Diffuse(color: Texture("../assets/cat.png")),
        "chrome": Mirror,
        "glass":  Glass(ior: 1.5),
    },
    entities: [
        (name: "lamp",  shape: Sphere(radius: 8), transform: (translate: (-10, 20, 40)), emissive: (radiance: (60, 60, 60))),
        (name: "floor", shape: Sphere(radius: 990), transform: (translate: (0, -1000, 0)), material: "chalk"),
        (name: "ball",  shape: Sphere(radius: 10), transform: (translate: (25, 0, 0)), material: "glass"),
        (name: "hub",   transform: (translate: (0, -10, 0)), spin: (axis: (0, 1, 0), deg_per_s: 90)),
        (name: "cat",   parent: "hub", shape: Mesh("../assets/cat.obj"), material: "fur", normals: Smooth(angle_deg: 60),
                        transform: (rotate: Euler(0, 45, 0), scale: 0.6)),
        (name: "coin",  shape: Sphere(radius: 1), material: "chrome"),
    ],
    animation: (fps: 24, frames: 0..48),
)
"##;

const CAMERA: &str = "camera: (at: (0, 0, 5), look_at: (0, 0, 0))";

fn read(text: &str) -> Result<(SceneDesc, Vec<Diagnostic>), Vec<Diagnostic>> {
    parse(text, Path::new("scene.ron"))
}

fn good(text: &str) -> SceneDesc {
    match read(text) {
        Ok((desc, _)) => desc,
        Err(found) => panic!("{text}\n{found:#?}"),
    }
}

/// A scene with a camera and these fields.
fn with(fields: &str) -> SceneDesc {
    good(&format!("(version: 1, {CAMERA}, {fields})"))
}

/// The material that a text reads as.
fn material(text: &str) -> MaterialDesc {
    with(&format!("materials: {{\"m\": {text}}}")).materials[0]
        .material
        .clone()
}

#[test]
fn the_sample_reads_as_written() {
    let (desc, warnings) = read(GOOD).expect("the sample is good");
    assert_eq!(warnings, []);
    assert_eq!(desc.render, RenderDesc::default());
    let camera = desc.camera.as_ref().expect("a camera");
    assert_eq!(
        camera.pose,
        Some(CameraPose {
            at: [0.0, 0.0, 55.0],
            look_at: [0.0; 3],
            up: [0.0, 1.0, 0.0]
        })
    );
    assert_eq!(
        (
            camera.vfov_deg,
            camera.aperture_radius,
            camera.focus_distance
        ),
        (60.0, 0.0, 55.0)
    );
    let names: Vec<&str> = desc.materials.iter().map(|m| m.name.as_str()).collect();
    assert_eq!(names, ["chalk", "fur", "chrome", "glass"]);
    let chrome = &desc.materials[2];
    assert_eq!(&desc.source[chrome.at..chrome.at + chrome.len], "Mirror");
    assert_eq!(
        desc.animation,
        AnimationDesc {
            fps: 24.0,
            frames: 0..48
        }
    );

    let cat = &desc.entities[4];
    assert!(desc.source[cat.at..cat.at + cat.len].starts_with("(name: \"cat\""));
    assert!(desc.source[cat.at..cat.at + cat.len].ends_with("scale: 0.6))"));
    let mesh = Placed {
        value: "../assets/cat.obj".to_owned(),
        at: desc
            .source
            .find("\"../assets/cat.obj")
            .expect("it is there"),
        len: 19,
    };
    let wanted = EntityDesc {
        name: Some("cat".to_owned()),
        parent: Some(3),
        shape: Some(ShapeDesc::Mesh {
            path: mesh,
            mesh: None,
        }),
        material: Some(1),
        transform: TransformDesc {
            translate: [0.0; 3],
            rotate: RotateDesc::Euler([0.0, 45.0, 0.0]),
            scale: [0.6; 3],
        },
        normals: Some(NormalsDesc::Smooth { angle_deg: 60.0 }),
        ..EntityDesc::default()
    };
    assert_eq!(cat.value, wanted);
    assert_eq!(desc.entities[0].value.emissive, Some([60.0; 3]));
    assert_eq!(
        desc.entities[3].value.spin,
        Some(SpinDesc {
            axis: [0.0, 1.0, 0.0],
            deg_per_s: 90.0,
            pivot: None
        })
    );
}

#[test]
fn places_of_components_are_exact() {
    let desc = good(GOOD);
    let (at, len) = desc.place(4, "material").expect("the cat has a material");
    assert_eq!(&desc.source[at..at + len], "\"fur\"");
    assert_eq!(desc.place(3, "material"), None);
    assert_eq!(desc.place(99, "material"), None);
}

#[test]
fn variants_read_bare_empty_and_full() {
    let clear = ColorDesc::Linear([1.0; 3]);
    let grey = ColorDesc::Linear([0.8; 3]);
    for (forms, wanted) in [
        (
            ["Mirror", "Mirror()", "Mirror(color: Linear(1, 1, 1))"],
            MaterialDesc::Mirror {
                color: clear.clone(),
            },
        ),
        (
            ["Glass", "Glass()", "Glass(ior: 1.5)"],
            MaterialDesc::Glass {
                ior: 1.5,
                color: clear,
            },
        ),
        (
            [
                "Diffuse",
                "Diffuse ( )",
                "Diffuse(color: Linear(0.8, 0.8, 0.8))",
            ],
            MaterialDesc::Diffuse {
                color: grey.clone(),
            },
        ),
        (
            ["Plastic", "Plastic()", "Plastic /* coat */ (ior: 1.5)"],
            MaterialDesc::Plastic {
                color: grey.clone(),
                ior: 1.5,
            },
        ),
        (
            ["Metal", "Metal()", "Metal(roughness: 0)"],
            MaterialDesc::Metal {
                color: grey,
                roughness: 0.0,
            },
        ),
    ] {
        for form in forms {
            assert_eq!(material(form), wanted, "{form}");
        }
    }
    for form in [
        "Smooth",
        "Smooth()",
        "Smooth(angle_deg: 60)",
        "Some(Smooth)",
    ] {
        let desc = with(&format!(
            "entities: [(shape: Mesh(\"a.obj\"), normals: {form})]"
        ));
        assert_eq!(
            desc.entities[0].value.normals,
            Some(NormalsDesc::Smooth { angle_deg: 60.0 }),
            "{form}"
        );
    }
}

#[test]
fn every_colour_takes_every_form() {
    let color = |text: &str| match material(&format!("Diffuse(color: {text})")) {
        MaterialDesc::Diffuse { color } => color,
        other => panic!("{other:?}"),
    };
    assert_eq!(
        color("Linear(0.1, 0.2, 0.30000000000000004)"),
        ColorDesc::Linear([0.1, 0.2, 0.1 + 0.2])
    );
    assert_eq!(
        color("Srgb(\"#ff0000\")"),
        ColorDesc::Linear([1.0, 0.0, 0.0])
    );
    let image = |text, wanted_wrap, wanted_filter| match color(text) {
        ColorDesc::Image { path, wrap, filter } => {
            assert_eq!(
                (path.value.as_str(), wrap, filter),
                ("a b.png", wanted_wrap, wanted_filter),
                "{text}"
            );
        }
        other => panic!("{other:?}"),
    };
    image(
        "Texture(\"a b.png\")",
        WrapDesc::Repeat,
        TextureFilterDesc::Bilinear,
    );
    image(
        "Image(path: \"a b.png\")",
        WrapDesc::Repeat,
        TextureFilterDesc::Bilinear,
    );
    image(
        "Image(path: \"a b.png\", wrap: Clamp, filter: Nearest)",
        WrapDesc::Clamp,
        TextureFilterDesc::Nearest,
    );
    image(
        "Image(path: \"a b.png\", wrap: Mirror, filter: Bilinear)",
        WrapDesc::Mirror,
        TextureFilterDesc::Bilinear,
    );
}

#[test]
fn components_take_their_forms() {
    let desc = with(
        "entities: [(transform: (scale: (1, -2, 3), rotate: AxisAngle(axis: (0, 0, 2), deg: 30)), shape: Mesh(\"a\")), \
         (transform: (rotate: Quat(0, 0, 0, 2)), shape: Sphere(radius: 2, inverted: true), normals: None), \
         (transform: (scale: (-2, 2, 2)), shape: Sphere(radius: 1), spin: (axis: (0, 1, 0), deg_per_s: -9, pivot: (1, 2, 3)))]",
    );
    let entity = |i: usize| &desc.entities[i].value;
    assert_eq!(entity(0).transform.scale, [1.0, -2.0, 3.0]);
    assert_eq!(
        entity(0).transform.rotate,
        RotateDesc::AxisAngle {
            axis: [0.0, 0.0, 2.0],
            deg: 30.0
        }
    );
    assert_eq!(
        entity(1).transform.rotate,
        RotateDesc::Quat([0.0, 0.0, 0.0, 2.0])
    );
    assert_eq!(
        entity(1).shape,
        Some(ShapeDesc::Sphere {
            radius: 2.0,
            inverted: true
        })
    );
    assert_eq!(entity(2).spin.and_then(|s| s.pivot), Some([1.0, 2.0, 3.0]));
}

#[test]
fn a_camera_stands_on_an_entity_too() {
    let desc = good(
        "Scene(version: 1, entities: [(camera: (vfov_deg: 30), transform: (translate: (0, 0, 9)))])",
    );
    assert_eq!(desc.camera, None);
    let wanted = CameraDesc {
        vfov_deg: 30.0,
        ..CameraDesc::default()
    };
    assert_eq!(desc.entities[0].value.camera.as_deref(), Some(&wanted));
    let desc = good("Scene(version: 1, entities: [(camera: ())])");
    assert_eq!(
        desc.entities[0].value.camera.as_deref(),
        Some(&CameraDesc::default())
    );
}

#[test]
fn focus_is_the_distance_of_what_is_looked_at() {
    let desc = good("(version: 1, camera: (at: (1, 2, 3), look_at: (4, 6, 3)))");
    assert_eq!(desc.camera.map(|c| c.focus_distance), Some(5.0));
}

#[test]
fn line_ends_marks_and_last_comments_do_not_matter() {
    let wanted = good(GOOD);
    for text in [
        GOOD.replace('\n', "\r\n"),
        format!("\u{feff}{GOOD}"),
        format!("{GOOD}// the end"),
    ] {
        let desc = good(&text);
        assert_eq!(desc.render, wanted.render);
        assert_eq!(desc.materials[0].material, wanted.materials[0].material);
        assert_eq!(desc.entities.len(), wanted.entities.len());
    }
    good(&format!("#![enable(implicit_some)]\n{GOOD}"));
}

#[test]
fn missing_files_are_told_from_bad_ones() {
    assert!(matches!(
        load(Path::new("no/such/scene.ron")),
        Err(LoadError::Missing(_))
    ));
    assert!(matches!(
        load(Path::new(".")),
        Err(LoadError::Unreadable { .. })
    ));
}

/// Steps of a 64-bit linear congruential generator (Knuth's constants); the high bits are used.
fn next(state: &mut u64) -> usize {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 33) as usize
}

#[test]
fn no_mutation_panics() {
    const TOKENS: [&str; 24] = [
        "(", ")", "[", "]", "{", "}", ",", ":", "\"", "..", "-", "0", "1e400", "NaN", "inf", "//",
        "/*", "*/", "#", "é", "Some(", "None", "\n", "Sphere",
    ];
    let mut state = 7;
    let (mut good, mut bad) = (0, 0);
    for _ in 0..10_000 {
        let mut text: Vec<char> = GOOD.chars().collect();
        for _ in 0..1 + next(&mut state) % 3 {
            let at = next(&mut state) % text.len();
            let cut = at + next(&mut state) % 6.min(text.len() - at);
            let token = match next(&mut state) % 3 {
                0 => "",
                _ => TOKENS[next(&mut state) % TOKENS.len()],
            };
            text.splice(at..cut, token.chars());
        }
        let text: String = text.into_iter().collect();
        match read(&text) {
            Ok(_) => good += 1,
            Err(found) => {
                assert!(!found.is_empty(), "refused without a word: {text}");
                assert!(found.iter().all(|d| d.file.is_some()));
                bad += 1;
            }
        }
    }
    assert!(
        good > 100 && bad > 100,
        "{good} good, {bad} bad: mutations of one kind only show nothing"
    );
}

#[test]
fn bytes_that_are_not_text_are_refused_with_their_place() {
    let path = std::env::temp_dir().join(format!("luxel-not-text-{}.ron", std::process::id()));
    std::fs::write(&path, b"Scene(\n  version: \xff1)").expect("the temporary folder is writable");
    let found = load(&path);
    std::fs::remove_file(&path).expect("the file was there");
    let Err(LoadError::Invalid(found, None)) = found else {
        panic!("{found:?}");
    };
    let place = found[0].span.as_ref().map(|s| (s.line, s.column));
    assert_eq!((found[0].code, place), (codes::NOT_TEXT, Some((2, 12))));
}

#[test]
fn the_order_of_the_text_is_the_order_of_the_errors() {
    let Err(found) = read("(version: 1, entities: [(parent: \"x\"), (shape: Sphere(radius: 0))])")
    else {
        panic!("three errors pass");
    };
    let codes: Vec<&str> = found.iter().map(|d| d.code).collect();
    assert_eq!(codes, ["E012", "E011", "E014"]);
}

#[test]
fn brackets_are_cut_as_ron_cuts_them() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut read_ones = 0;
    for entry in std::fs::read_dir(folder).expect("the folder of scenes") {
        let path = entry.expect("an entry").path();
        let text = std::fs::read_to_string(path).expect("a scene");
        // A block comment sends a layer to `ron`; blanks of the same length do not.
        let [ours, rons] = ["    ", "/**/"].map(|blank| {
            let open = |bracket: &str| format!("{bracket}{blank}");
            let text = text.replace('(', &open("(")).replace("[\n", &open("[\n"));
            let desc = good(&text.replace("{\n", &open("{\n")));
            format!(
                "{:?}",
                (desc.render, desc.camera, desc.materials, desc.entities)
            )
        });
        assert_eq!(ours, rons);
        read_ones += 1;
    }
    assert!(read_ones >= 10);
}
