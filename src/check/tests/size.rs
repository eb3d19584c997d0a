//! Sizes, texture coordinates, and numbers at the end of their range.

use super::*;

#[test]
fn single_precision_blurs_what_is_far() {
    let body = |x: f64| {
        format!(
            "{CAMERA} {LIT} entities: [(name: \"box\", shape: Mesh(\"cube.obj\")),
             (name: \"moon\", shape: Sphere(radius: 1), transform: (translate: ({x}, 0, 0)))]"
        )
    };
    let said = expect("moon", &body(1e7), &["W304"]);
    assert!(
        said.contains("\"box\" is 2 wide") && said.contains("\"moon\" is 1.00e7 away"),
        "{said}"
    );
    expect("hill", &body(1e4), &[]);
}

#[test]
fn single_precision_has_an_end() {
    let wall = |radius: f64| {
        format!(
            "{CAMERA} {LIT} entities: [(shape: Mesh(\"cube.obj\")), (name: \"wall\",
             shape: Sphere(radius: {radius}), transform: (translate: (0, {}, 0)))]",
            -radius - 2.0
        )
    };
    let said = expect("wall", &wall(1e60), &["W304"]);
    assert!(said.contains("\"wall\" reaches"), "{said}");
    expect("floor", &wall(1e9), &[]);
}

#[test]
fn a_stray_vertex_makes_points_of_triangles() {
    let stray = |x: f64| {
        let text = format!("{}v {x} 0 0\nf 1 2 9\n", cube(|x| x));
        let folder = Folder::of(&format!("stray{x}"), &[("stray.obj", text)]);
        let text = format!(
            "(version: 1, camera: (at: (0, 0, {}), look_at: ({x}, 0, 0), vfov_deg: 120), {LIT}
             entities: [(shape: Mesh(\"stray.obj\")), (shape: Mesh(\"stray.obj\"))])",
            3.0 * x
        );
        let (desc, _) = scene::parse(&text, &folder.0.join("s.ron")).expect("the scene reads");
        let spawned = spawn(&desc, Loader::new()).expect("the files load");
        check_world(&desc, &spawned.world, &spawned.assets)
    };
    let found = stray(1e9);
    assert_eq!(codes_of(&found), ["W304"], "{found:#?}");
    assert!(
        found[0].message.starts_with("12 of the 13 triangles"),
        "{}",
        found[0]
    );
    assert_eq!(stray(1e5), []);
}

#[test]
fn files_in_other_units() {
    let body = |file: &str, transform: &str| {
        format!(
            "camera: (at: (0, 0.5, 6), look_at: (0, 0, 0)), {LIT}
             entities: [(shape: Sphere(radius: 1)), (name: \"it\", shape: Mesh(\"{file}\"), {transform})]"
        )
    };
    let near = "transform: (translate: (1.5, 0, 0))";
    let said = expect("tiny", &body("tiny.obj", near), &["W305"]);
    assert!(
        said.contains("2000 times smaller") && said.contains("scale: 1000"),
        "{said}"
    );
    let said = expect(
        "huge",
        &body("huge.obj", "transform: (translate: (-2000, -1500, -6000))"),
        &["W305"],
    );
    assert!(
        said.contains("1000 times larger") && said.contains("scale: 0.001"),
        "{said}"
    );
    let scaled = "transform: (translate: (1.5, 0, 0), scale: 1000)";
    expect("scaled", &body("tiny.obj", scaled), &[]);
    // A floor may be as large as it likes.
    let flat = "transform: (translate: (0, -2, 0), scale: (5000, 0.001, 5000))";
    expect("floor", &body("cube.obj", flat), &[]);
}

#[test]
fn faces_without_uv() {
    let quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    let folder = Folder::of(
        "uv",
        &[
            ("all.obj", format!("{quad}f 1/1 2/2 3/3 4/4\n")),
            ("some.obj", format!("{quad}f 1/1 2/2 3/3\nf 1 3 4\n")),
        ],
    );
    let png = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/uv_test.png");
    std::fs::copy(png, folder.0.join("t.png")).expect("the temporary folder is writable");
    let found = |mesh: &str, material: &str| {
        let text = format!(
            "(version: 1, {CAMERA} {LIT} materials: {{\"m\": {material}}},
             entities: [(shape: Mesh({mesh:?}), material: \"m\")])"
        );
        let (desc, _) = scene::parse(&text, &folder.0.join("scene.ron")).expect("the scene reads");
        let spawned = spawn(&desc, Loader::new()).expect("the files load");
        check_world(&desc, &spawned.world, &spawned.assets)
    };
    let textured = "Diffuse(color: Texture(\"t.png\"))";
    let some = found("some.obj", textured);
    assert_eq!(codes_of(&some), ["W309"]);
    assert!(
        some[0].message.starts_with("1 of the 2 textured triangles"),
        "{}",
        some[0]
    );
    assert!(
        some[0].message.contains("the first is triangle 1"),
        "{}",
        some[0]
    );
    assert_eq!(found("all.obj", textured), []);
    assert_eq!(found("some.obj", "Mirror"), []);
}

#[test]
fn extremes_neither_panic_nor_show_what_is_no_number() {
    const ANY: &[&str] = &[
        "0", "1", "-1", "1e-150", "-3.5", "100", "1e9", "-1e60", "1e149",
    ];
    const POSITIVE: &[&str] = &[
        "1", "0.01", "1e-150", "1e-30", "100", "1e9", "1e60", "1e149",
    ];
    const POWER: &[&str] = &["0", "1", "1e9", "1e-30"];
    const VFOV: &[&str] = &["0.001", "1", "60", "179.9"];
    let files = [("cube.obj", cube(|x| x)), ("huge.obj", cube(|x| 1e90 * x))];
    let folder = Folder::of("extremes", &files);
    let mut state = 7_u64;
    let mut pick = |of: &[&'static str]| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        of[(state >> 33) as usize % of.len()]
    };
    let (mut checked, mut said) = (0, 0);
    for _ in 0..200 {
        let mut three = |of| format!("({}, {}, {})", pick(of), pick(of), pick(of));
        let (eye, aim, cube_at, turn) = (three(ANY), three(ANY), three(ANY), three(ANY));
        let stretch = three(POSITIVE);
        let spheres: Vec<[String; 3]> = (0..3)
            .map(|_| [three(ANY), three(ANY), three(POWER)])
            .collect();
        let lens = format!(
            "aperture_radius: {}, focus_distance: {}",
            pick(POSITIVE),
            pick(POSITIVE)
        );
        let mut text = format!(
            "(version: 1, camera: (at: {eye}, look_at: {aim}, vfov_deg: {}, lens: ({lens})), entities: [
             (shape: Mesh(\"cube.obj\"), transform: (translate: {cube_at}, scale: {})),
             (shape: Mesh(\"huge.obj\"), transform: (rotate: Euler{turn}, scale: {stretch})),",
            pick(VFOV),
            pick(POSITIVE)
        );
        for [at, place, power] in spheres {
            text += &format!(
                "(shape: Sphere(radius: {}), transform: (translate: {at})),
                 (light: Point(intensity: {power}), transform: (translate: {place})),",
                pick(POSITIVE)
            );
        }
        let Ok((desc, _)) = scene::parse(&(text + "])"), &folder.0.join("s.ron")) else {
            continue;
        };
        let Ok(spawned) = spawn(&desc, Loader::new()) else {
            continue;
        };
        checked += 1;
        let loaded = check_world(&desc, &spawned.world, &spawned.assets);
        for one in check(&desc).into_iter().chain(loaded) {
            said += 1;
            assert!(!one.to_string().contains("NaN"), "{one}\n{}", desc.source);
        }
    }
    assert!(checked > 50 && said > 50, "{checked} scenes, {said} said");
}
