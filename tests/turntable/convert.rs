//! Converted files show what the files show.

use luxel::asset::{Light, Loader, MeshId, Model, ModelNode, NodeTransform};
use luxel::author::{Converted, convert_mesh, convert_model, points};
use luxel::math::{DAffine3, DMat3, DVec3, axis_angle_deg};
use luxel::render::{Control, Renderer, Settings};
use luxel::scene::{self, LightDesc, RotateDesc, SceneDesc, ShapeDesc};
use luxel::world;
use std::path::{Path, PathBuf};

fn assets() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets")
}

/// The scene that the text reads as.
fn reread(converted: &Converted) -> SceneDesc {
    let text = scene::write(&converted.desc);
    match scene::parse(&text, &assets().join("x.ron")) {
        Ok((desc, _)) => desc,
        Err(found) => panic!("{text}\n{found:#?}"),
    }
}

fn render(desc: &SceneDesc) -> Vec<[f64; 3]> {
    let spawned = world::spawn(desc, Loader::new()).unwrap_or_else(|e| panic!("{e:#?}"));
    let mut settings = Settings::of_scene(desc);
    (settings.size, settings.spp) = ((40, 40), 3);
    let renderer = Renderer::new(desc, spawned.world, &spawned.assets, settings);
    let mut renderer = renderer.expect("threads");
    renderer
        .render(0, &Control::default())
        .film
        .planes()
        .rgb
        .clone()
}

#[test]
fn an_obj_becomes_one_entity_in_view_and_in_light() {
    for (file, plain) in [("cat.obj", false), ("plinth.obj", true)] {
        let mut loader = Loader::new();
        let id = loader.mesh(&assets().join(file)).expect("ours");
        let mesh = loader.loaded(id);
        let converted = convert_mesh(mesh, &points::of_mesh(mesh), file, "thing");
        let desc = reread(&converted);
        let names: Vec<_> = desc
            .entities
            .iter()
            .filter_map(|e| e.value.name.as_deref())
            .collect();
        assert_eq!(names, ["thing", "lamp"]);
        assert_eq!(desc.entities[0].value.material.is_some(), plain, "{file}");
        assert_eq!(converted.notes.len(), 2, "{:?}", converted.notes);
        let pixels = render(&desc);
        let mean: f64 = pixels.iter().map(|p| p[1]).sum::<f64>() / pixels.len() as f64 / 3.0;
        assert!((0.1..0.8).contains(&mean), "{file}: {mean}");
        // A named material renders as the file's own.
        let mut own = desc.clone();
        own.entities[0].value.material = None;
        assert!(render(&own) == pixels, "{file}");
    }
}

fn node(name: Option<&str>, parent: Option<usize>, mesh: Option<usize>) -> ModelNode {
    ModelNode {
        name: name.map(str::to_owned),
        index: 7,
        parent,
        transform: NodeTransform::Parts {
            translate: DVec3::ZERO,
            rotate: [0.0, 0.0, 0.0, 1.0],
            scale: DVec3::ONE,
        },
        mesh,
        camera_vfov_deg: None,
        light: None,
        motion: None,
    }
}

fn model(nodes: Vec<ModelNode>, meshes: Vec<Option<MeshId>>) -> Model {
    Model {
        path: "x.glb".into(),
        nodes,
        meshes,
    }
}

#[test]
fn every_node_becomes_an_entity_of_its_own_name() {
    let mut loader = Loader::new();
    let cat = loader.mesh(&assets().join("cat.obj")).expect("ours");
    let mut root = node(Some("cat"), None, None);
    let turned = axis_angle_deg(DVec3::X, -90.0) * DMat3::from_diagonal(DVec3::new(2.0, 3.0, 0.5));
    root.transform = NodeTransform::Matrix(DAffine3 {
        matrix3: turned,
        translation: DVec3::new(1.0, 2.0, 3.0),
    });
    let mut eye = node(Some("cat"), Some(0), Some(1));
    eye.camera_vfov_deg = Some(40.0);
    let mut other = node(None, Some(1), Some(0));
    other.camera_vfov_deg = Some(50.0);
    other.light = Some(Light::Sun {
        irradiance: [1.0, 2.0, 3.0],
    });
    let file = model(vec![root, eye, other], vec![None, Some(cat)]);
    let found = points::of_model(&file, &loader);
    let converted = convert_model(&file, &loader, &found, "x.glb");
    let desc = reread(&converted);
    let entities: Vec<_> = desc.entities.iter().map(|e| &e.value).collect();
    let names: Vec<_> = entities.iter().filter_map(|e| e.name.as_deref()).collect();
    assert_eq!(names, ["cat", "cat 2", "node 7"]);
    assert_eq!([entities[1].parent, entities[2].parent], [Some(0), Some(1)]);
    let shape = |i: usize| match &entities[i].shape {
        Some(ShapeDesc::Mesh { path, mesh }) => Some((path.value.as_str(), *mesh)),
        _ => None,
    };
    assert_eq!(
        [shape(0), shape(1), shape(2)],
        [None, Some(("x.glb", Some(1))), None]
    );
    assert_eq!(
        entities[0].transform.rotate,
        RotateDesc::Quat([-1.0, 0.0, 0.0, 1.0])
    );
    assert_eq!(entities[0].transform.scale, [2.0, 3.0, 0.5]);
    assert_eq!(entities[0].transform.translate, [1.0, 2.0, 3.0]);
    assert!(desc.camera.is_none(), "the file has one");
    assert!(entities[1].camera.is_some() && entities[2].camera.is_none());
    assert_eq!(
        entities[2].light.as_deref(),
        Some(&LightDesc::Sun {
            irradiance: [1.0, 2.0, 3.0]
        })
    );
    assert_eq!(converted.notes.len(), 1, "{:?}", converted.notes);
}

#[test]
fn matrices_come_apart_into_what_they_were() {
    let loader = Loader::new();
    let mut seed = 0.123_f64;
    let mut next = || {
        seed = (seed * 997.0 + 0.371).fract();
        2.0 * seed - 1.0
    };
    for i in 0..200 {
        let axis = DVec3::new(next(), next(), next());
        let scale = DVec3::new(
            next() + 1.5,
            next() + 1.5,
            if i % 2 == 0 { -0.7 } else { next() + 1.5 },
        );
        let matrix = axis_angle_deg(axis, 360.0 * next()) * DMat3::from_diagonal(scale);
        let mut one = node(None, None, None);
        one.transform = NodeTransform::Matrix(DAffine3 {
            matrix3: matrix,
            translation: DVec3::ZERO,
        });
        let converted = convert_model(&model(vec![one], vec![]), &loader, &[], "x.glb");
        let transform = reread(&converted).entities[0].value.transform;
        let rotation = match transform.rotate {
            RotateDesc::Quat(q) => luxel::math::quaternion(q),
            _ => DMat3::IDENTITY,
        };
        let again = rotation * DMat3::from_diagonal(DVec3::from_array(transform.scale));
        let off = (0..3)
            .map(|c| (again.col(c) - matrix.col(c)).length())
            .fold(0.0, f64::max);
        assert!(off < 1e-14, "{i}: {off:e}");
        assert!(converted.notes.iter().all(|n| !n.contains("sheared")));
    }
}

/// The scene of a converted glTF file renders to the same sums as the file under one entity, with the same camera and
/// light.
#[test]
fn converted_files_render_as_the_files_do() {
    let Some(data) = std::env::var_os("LUXEL_DATA").map(PathBuf::from) else {
        eprintln!("skipped: LUXEL_DATA is not set");
        return;
    };
    let files = [
        "gltf/sample/Box/glTF-Binary/Box.glb",
        "gltf/sample/BoxTextured/glTF/BoxTextured.gltf",
        "gltf/sample/BoxVertexColors/glTF/BoxVertexColors.gltf",
        "gltf/sample/SimpleMeshes/glTF/SimpleMeshes.gltf",
        "gltf/sample/Suzanne/glTF/Suzanne.gltf",
    ];
    let mut compared = 0;
    for file in files {
        let path = data.join("zoo").join(file);
        let mut loader = Loader::new();
        let Ok(id) = loader.model(&path) else {
            continue;
        };
        let model = loader.loaded_model(id);
        let name = path
            .file_name()
            .and_then(|n| n.to_str())
            .unwrap_or_default();
        let found = points::of_model(model, &loader);
        let converted = convert_model(model, &loader, &found, name);
        let read = |text: &str| {
            scene::parse(text, &path.with_file_name("x.ron")).map_err(|e| format!("{text}\n{e:?}"))
        };
        let (ours, _) = read(&scene::write(&converted.desc)).expect("it reads");
        let mut whole = converted.desc.clone();
        // The file under one entity, and the lamp that was added after its nodes.
        let lamp = whole
            .entities
            .iter()
            .position(|e| e.value.emissive.is_some());
        let lamp: Vec<_> = lamp
            .map(|i| whole.entities[i].clone())
            .into_iter()
            .collect();
        whole.materials.clear();
        whole.entities = lamp;
        let text = scene::write(&whole);
        let text = match text.contains("entities: [\n") {
            true => text.replace("entities: [\n", &format!("entities: [(gltf: {name:?}),\n")),
            false => text.replace(
                "    camera:",
                &format!("    entities: [(gltf: {name:?})],\n    camera:"),
            ),
        };
        let (theirs, _) = read(&text).expect("it reads");
        assert!(render(&ours) == render(&theirs), "{file}");
        compared += 1;
    }
    eprintln!("{compared} of {} files compared", files.len());
}

#[test]
fn no_points_at_all_make_a_scene() {
    let loader = Loader::new();
    let converted = convert_model(
        &model(vec![node(None, None, None)], vec![]),
        &loader,
        &[],
        "x.glb",
    );
    assert_eq!(reread(&converted).entities.len(), 2);
}
