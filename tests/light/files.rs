//! What mesh files bring and scene files have no words for: emission textures, a second set of texture coordinates and their
//! transforms, colours at corners, surfaces that only shine.

use crate::luxel_side::{Stage, options};
use crate::objs;
use crate::reference::{self, Color, Corners, Estimator, Shape};
use crate::stats::assert_agree;
use glam::{DAffine2, DMat2, DVec2, DVec3};
use luxel::asset::{
    AssetStore, Filter, Mesh, MeshMaterial, Scattering, Texture, TextureId, TextureUse, Wrap,
};
use luxel::trace::{Sampler, TraceOptions};
use std::rc::Rc;
use std::sync::Arc;

/// Black in places, bright in others, no symmetry.
const WIDTH: u32 = 5;
const HEIGHT: u32 = 4;

fn texels() -> Vec<u8> {
    (0..WIDTH * HEIGHT * 3)
        .map(|k| {
            if k / 3 % 3 == 0 {
                0
            } else {
                (k * k * 31 + k * 89 + 17) as u8
            }
        })
        .collect()
}

/// Adds a texture and the only material of the first mesh.
pub(crate) fn give(assets: &mut AssetStore, texture: Option<Texture>, material: MeshMaterial) {
    assets.textures.extend(texture.map(Arc::new));
    let mesh: &mut Mesh = Arc::make_mut(&mut assets.meshes[0]);
    mesh.material = vec![Some(0); mesh.triangle_count()];
    mesh.materials = vec![material];
}

pub(crate) fn texture(texels: &[u8], width: u32, height: u32, alpha: Option<&[u8]>) -> Texture {
    Texture {
        path: "made by a test".into(),
        width,
        height,
        texels: texels.into(),
        alpha: alpha.map(Into::into),
    }
}

fn image() -> reference::Image {
    reference::Image::from_srgb(&texels(), WIDTH as usize, HEIGHT as usize)
}

/// The surfaces of an entity.
pub(crate) fn of_entity(
    scene: &mut reference::Scene,
    entity: usize,
) -> impl Iterator<Item = &mut reference::Surface> {
    scene
        .surfaces
        .iter_mut()
        .filter(move |s| s.entity == entity)
}

/// Another material of the same kind.
pub(crate) fn repaint(surface: &mut reference::Surface, paint: impl Fn(&mut reference::Material)) {
    let mut material = reference::Material {
        kind: surface.material.kind,
        color: surface.material.color.clone(),
        tinted: surface.material.tinted,
        veil: surface.material.veil.clone(),
    };
    paint(&mut material);
    surface.material = Rc::new(material);
}

/// A square (mesh 0, entity 0) above a floor and a ball.
pub(crate) fn under(name: &str, place: &str, more: &str) -> Stage {
    Stage::new(name)
        .file("square.obj", &objs::square(-0.3, 1.4))
        .file("floor.obj", &objs::square(0.0, 1.0))
        .scene(&format!(
            r#"camera: (at: (0, 2.6, 3.2), look_at: (0, 0.7, 0), vfov_deg: 42), render: (size: (16, 16), filter: Box), {more}
            entities: [(shape: Mesh("square.obj"), normals: Flat, transform: ({place})),
                (shape: Mesh("floor.obj"), normals: Flat, material: "floor", transform: (rotate: Euler(-90, 0, 0), scale: 3)),
                (shape: Sphere(radius: 0.4), transform: (translate: (0.5, 0.4, 0)), material: "ball")],
            materials: {{"floor": Diffuse(color: Linear(0.6, 0.5, 0.4)), "ball": Plastic(color: Linear(0.2, 0.5, 0.7))}}"#
        ))
}

pub(crate) const ABOVE: &str = "translate: (0, 1.6, -0.2), rotate: Euler(80, 10, 0), scale: 0.7";
/// Turned over, and with its shape's handedness: an instance could not tell otherwise.
const MIRRORED: &str =
    "translate: (0, 1.6, -0.2), rotate: Euler(80, 10, 0), scale: (-0.7, 0.7, -0.5)";

fn agree(name: &str, stage: &Stage, luxel: u32, reference: u32, max_bounces: u32, lamps: bool) {
    let found = stage.luxel(0, luxel, &options(max_bounces));
    let estimator = Estimator { max_bounces, lamps };
    let truth = stage.reference(0, reference, estimator);
    assert_agree(name, &found, &truth, 0.02);
}

fn lamp(name: &str, place: &str) -> Stage {
    sided_lamp(name, place, false)
}

fn sided_lamp(name: &str, place: &str, two_sided: bool) -> Stage {
    under(name, place, "").retouch(
        move |assets| {
            let material = MeshMaterial {
                two_sided,
                emission: [5.0, 7.0, 9.0],
                emission_texture: Some(TextureUse::plain(TextureId(0))),
                ..MeshMaterial::diffuse("lamp", [0.3; 3])
            };
            give(
                assets,
                Some(texture(&texels(), WIDTH, HEIGHT, None)),
                material,
            );
        },
        move |scene| {
            for surface in of_entity(scene, 0) {
                surface.two_sided = two_sided;
                surface.emission = Color::Image(reference::Image {
                    factor: DVec3::new(5.0, 7.0, 9.0),
                    ..image()
                });
                repaint(surface, |m| m.color = Color::Flat(DVec3::splat(0.3)));
            }
        },
    )
}

#[test]
fn a_textured_lamp() {
    agree("textured lamp", &lamp("lamp", ABOVE), 1024, 1920, 2, true);
}

#[test]
fn a_mirrored_textured_lamp() {
    agree(
        "mirrored lamp",
        &lamp("mirrored_lamp", MIRRORED),
        1024,
        2880,
        2,
        true,
    );
}

/// A lamp by its texture alone, and by chance alone: what one estimator misses, the other would show.
#[test]
fn estimators_agree_on_a_textured_lamp() {
    let stage = lamp("lamp_estimators", ABOVE);
    let picture = |nee, mis| {
        let options = TraceOptions {
            nee,
            mis,
            ..options(1)
        };
        stage.luxel(0, if nee { 1024 } else { 8192 }, &options)
    };
    let truth = picture(true, true);
    assert_agree("light samples alone", &picture(true, false), &truth, 0.02);
    assert_agree("chance alone", &picture(false, false), &truth, 0.03);
}

/// Between the floor's halves: either side of it lights one of them.
const UPRIGHT: &str = "translate: (-0.3, 0.7, 0.1), rotate: Euler(15, 75, 0), scale: 0.7";
const UPRIGHT_MIRRORED: &str =
    "translate: (-0.3, 0.7, 0.1), rotate: Euler(15, 75, 0), scale: (-0.7, 0.7, 0.7)";

#[test]
fn a_lamp_that_shines_from_both_sides() {
    for (name, place) in [("two_sided", UPRIGHT), ("two_mirrored", UPRIGHT_MIRRORED)] {
        let stage = sided_lamp(name, place, true);
        agree(name, &stage, 4096, 5760, 1, true);
        let flat = stage.flat(0, &options(1));
        assert_eq!(flat.lights.triangles.two_sided, [true; 2]);
        let one = sided_lamp(name, place, false).flat(0, &options(1));
        assert!(one.lights.triangles.two_sided.is_empty());
        assert_eq!(flat.lights.total(), 2.0 * one.lights.total());
    }
}

/// The light's density is the one that its samples have: alone or weighed, they give what chance gives.
#[test]
fn estimators_agree_on_both_sides() {
    let stage = sided_lamp("two_sided_estimators", UPRIGHT, true);
    let picture = |nee, mis| {
        let options = TraceOptions {
            nee,
            mis,
            ..options(1)
        };
        stage.luxel(0, if nee { 8192 } else { 16384 }, &options)
    };
    let truth = picture(true, true);
    assert_agree("light samples alone", &picture(true, false), &truth, 0.02);
    assert_agree("chance alone", &picture(false, false), &truth, 0.03);
}

/// A closed box of one white texel: the furnace, by a texture.
#[test]
fn a_textured_furnace_is_exact() {
    const SPP: u32 = 16;
    let stage = Stage::new("textured_furnace").file("cube.obj", &objs::cube(true)).scene(
        r#"camera: (at: (0.1, 0.2, 0.3), look_at: (0.4, -1, 0.7), vfov_deg: 100), render: (size: (8, 8)),
            entities: [(shape: Mesh("cube.obj"), normals: Flat)]"#,
    );
    let stage = stage.retouch(
        |assets| {
            let material = MeshMaterial {
                emission: [1.0; 3],
                emission_texture: Some(TextureUse::plain(TextureId(0))),
                ..MeshMaterial::diffuse("white", [0.5; 3])
            };
            give(assets, Some(texture(&[255; 3], 1, 1, None)), material);
        },
        |_| (),
    );
    let bare = TraceOptions {
        nee: false,
        roulette: false,
        ..options(3)
    };
    let sums = stage.sums(0, SPP, &bare);
    assert!(
        sums.rgb
            .iter()
            .flatten()
            .all(|&c| c == 1.875 * f64::from(SPP))
    );
}

/// The second set of texture coordinates, turned, stretched and moved, with one way of wrapping across and another down.
#[test]
fn a_second_set_of_coordinates_is_mapped_and_wrapped() {
    const MAP: [f64; 6] = [1.3, -0.6, 0.2, 0.5, 0.9, -0.7];
    let second = |k: usize| {
        let corners = [[0.1, 0.0], [1.7, -0.2], [1.4, 2.1], [-0.3, 1.2]];
        DVec2::from(corners[[0, 1, 2, 0, 2, 3][k]])
    };
    for (name, wrap, places) in [
        (
            "rm",
            [Wrap::Repeat, Wrap::Mirror],
            [reference::Wrap::Repeat, reference::Wrap::Mirror],
        ),
        (
            "cr",
            [Wrap::Clamp, Wrap::Repeat],
            [reference::Wrap::Clamp, reference::Wrap::Repeat],
        ),
    ] {
        let stage = under(
            &format!("second_{name}"),
            ABOVE,
            "background: Linear(0.6, 0.8, 1),",
        )
        .retouch(
            move |assets| {
                let of = TextureUse {
                    texture: TextureId(0),
                    uv_set: 1,
                    transform: Some(MAP),
                    wrap,
                    filter: Filter::Bilinear,
                };
                let material = MeshMaterial {
                    texture: Some(of),
                    ..MeshMaterial::diffuse("coat", [0.9, 0.8, 0.7])
                };
                give(
                    assets,
                    Some(texture(&texels(), WIDTH, HEIGHT, None)),
                    material,
                );
                Arc::make_mut(&mut assets.meshes[0]).uvs1 =
                    (0..6).map(|k| Some(second(k))).collect();
            },
            move |scene| {
                let [a, b, c, d, e, f] = MAP;
                for (t, surface) in of_entity(scene, 0).enumerate() {
                    let Shape::Triangle { more, .. } = &mut surface.shape else {
                        continue;
                    };
                    *more = Some(Box::new(Corners {
                        uv1: [0, 1, 2].map(|k| second(3 * t + k)),
                        ..Corners::PLAIN
                    }));
                    repaint(surface, |m| {
                        m.color = Color::Image(reference::Image {
                            second: true,
                            map: DAffine2 {
                                matrix2: DMat2::from_cols(DVec2::new(a, d), DVec2::new(b, e)),
                                translation: DVec2::new(c, f),
                            },
                            wrap: places,
                            factor: DVec3::new(0.9, 0.8, 0.7),
                            ..image()
                        });
                    });
                }
            },
        );
        agree(name, &stage, 256, 480, 3, false);
    }
}

fn tint(k: usize) -> [f32; 3] {
    [
        [1.0, 0.1, 0.2],
        [0.0, 1.0, 0.3],
        [0.5, 0.4, 1.0],
        [0.9, 0.9, 0.0],
    ][[0, 1, 2, 0, 2, 3][k]]
}

/// Colours at corners, of what reflects and of what only shines.
fn tinted(name: &str, place: &str, unlit: bool) -> Stage {
    under(name, place, "background: Linear(0.3, 0.4, 0.5),").retouch(
        move |assets| {
            let material = MeshMaterial {
                vertex_colors: true,
                scattering: if unlit {
                    Scattering::Nothing
                } else {
                    Scattering::Diffuse
                },
                emission: [f64::from(u8::from(unlit)) * 2.0; 3],
                ..MeshMaterial::diffuse("tinted", [0.8, 0.9, 1.0])
            };
            give(assets, None, material);
            Arc::make_mut(&mut assets.meshes[0]).colors = (0..6)
                .map(|k| {
                    let [r, g, b] = tint(k);
                    [r, g, b, 1.0]
                })
                .collect();
        },
        move |scene| {
            for (t, surface) in of_entity(scene, 0).enumerate() {
                let Shape::Triangle { more, .. } = &mut surface.shape else {
                    continue;
                };
                *more = Some(Box::new(Corners {
                    tint: [0, 1, 2].map(|k| DVec3::from(tint(3 * t + k).map(f64::from))),
                    ..Corners::PLAIN
                }));
                surface.tinted_emission = unlit;
                surface.emission = Color::Flat(DVec3::splat(f64::from(u8::from(unlit)) * 2.0));
                repaint(surface, |m| {
                    m.tinted = true;
                    m.color = Color::Flat(DVec3::new(0.8, 0.9, 1.0));
                    if unlit {
                        m.kind = reference::Kind::Nothing;
                    }
                });
            }
        },
    )
}

#[test]
fn corners_colour_what_reflects() {
    agree(
        "tinted",
        &tinted("tinted", ABOVE, false),
        256,
        480,
        3,
        false,
    );
}

#[test]
fn corners_colour_what_only_shines() {
    agree("unlit", &tinted("unlit", ABOVE, true), 256, 480, 2, true);
}

/// What nobody reads is not kept.
#[test]
fn scenes_without_such_files_keep_none_of_it() {
    let plain = under("plain_files", ABOVE, "background: Linear(0.3, 0.4, 0.5),");
    let needs = plain.flat(0, &options(1)).needs;
    assert!(!needs.uvs1 && !needs.vertex_colors && !needs.opacity && !needs.punctual && !needs.uvs);
    let tinted = tinted("tinted_needs", ABOVE, true).flat(0, &options(1));
    assert!(tinted.needs.vertex_colors && !tinted.needs.uvs1 && !tinted.needs.opacity);
    assert_eq!(tinted.lights.triangles.place.len(), 2);
    let options = TraceOptions {
        sampler: Sampler::Sobol,
        ..options(1)
    };
    let lamp = lamp("lamp_needs", ABOVE).flat(0, &options);
    assert!(lamp.needs.uvs && lamp.needs.textures && !lamp.needs.vertex_colors);
}
