//! Opacity: masks and blends, against closed forms, furnaces and the reference.

use crate::files::{ABOVE, give, of_entity, repaint, texture, under};
use crate::luxel_side::{Stage, options, trace};
use crate::objs;
use crate::reference::{Color, Corners, Estimator, Image, Kind, Shape, Veil};
use crate::stats::{Mean, assert_agree, assert_mean};
use glam::DVec3;
use luxel::asset::{
    AlphaMode, AssetStore, Filter, MeshMaterial, Opacity, Scattering, TextureId, TextureUse,
};
use luxel::build::Accel;
use luxel::trace::{Isa, Rect, Sampler, TileSums, TraceOptions, Tracer};
use std::sync::Arc;

const MASK: AlphaMode = AlphaMode::Mask { cutoff: 0.5 };

/// Left column not there, right column there, by a mask; 1/4 and 3/4 by a blend.
const HALVES: [u8; 2] = [64, 191];

/// Gives the first mesh a white diffuse material of this opacity, with [`HALVES`] as alpha where `textured`.
fn veil(
    factor: f64,
    mode: AlphaMode,
    textured: bool,
    filter: Filter,
) -> impl Fn(&mut AssetStore) + Copy {
    move |assets| {
        let of = TextureUse {
            filter,
            ..TextureUse::plain(TextureId(0))
        };
        let material = MeshMaterial {
            opacity: Opacity {
                factor,
                texture: textured.then_some(of),
                vertex_alpha: false,
                mode,
            },
            ..MeshMaterial::diffuse("veil", [1.0; 3])
        };
        let image = texture(&[255; 6], 2, 1, Some(&HALVES));
        give(assets, textured.then_some(image), material);
    }
}

/// A square from −1 to 1 facing the camera at z = 3, under a white sky, with something behind.
fn facing(name: &str, more: &str) -> Stage {
    Stage::new(name).file("square.obj", &objs::square(0.0, 1.0)).scene(&format!(
        r#"camera: (at: (0, 0, 3), look_at: (0, 0, 0), vfov_deg: 35), render: (size: (16, 16)), {more}"#
    ))
}

const SQUARE: &str = r#"(shape: Mesh("square.obj"), normals: Flat)"#;
const WHITE_SKY: &str = "background: Linear(1, 1, 1),";

fn bare(max_bounces: u32) -> TraceOptions {
    TraceOptions {
        nee: false,
        roulette: false,
        ..options(max_bounces)
    }
}

/// Passing costs nothing and takes no bounce: white veils vanish in a white sky, in every sample, mask or blend.
#[test]
fn white_veils_vanish_in_a_white_sky() {
    const SPP: u32 = 32;
    let veils = format!(
        r#"{WHITE_SKY} entities: [{SQUARE},
            (shape: Mesh("square.obj"), normals: Flat, transform: (translate: (0.1, 0.2, -0.5), rotate: Euler(10, 20, 30))),
            (shape: Mesh("square.obj"), normals: Flat, transform: (translate: (0.1, 0.2, -0.6), rotate: Euler(10, 20, 0)))]"#
    );
    for (name, mode, factor, textured) in [
        ("mask", MASK, 1.0, true),
        ("blend", AlphaMode::Blend, 1.0, true),
        ("glass pane", AlphaMode::Blend, 0.3, false),
        ("nothing", AlphaMode::Blend, 0.0, false),
    ] {
        let stage = facing("white_veils", &veils)
            .retouch(veil(factor, mode, textured, Filter::Bilinear), |_| ());
        let sums = stage.sums(0, SPP, &bare(20));
        for (i, (sum, squares)) in sums.rgb.iter().zip(&sums.rgb_squared).enumerate() {
            let n = f64::from(SPP);
            // Two white walls face to face may keep a path for 20 bounces: that sample is 0.
            assert!(sum == squares, "{name}: pixel {i}: {sum:?} {squares:?}");
            assert!(n - sum[0] <= 1.0, "{name}: pixel {i}: {} of {n}", sum[0]);
        }
    }
}

/// A mask is there or not, with nothing between; behind its hole stands what stands there, in every image.
#[test]
fn a_mask_has_a_hole() {
    const SPP: u32 = 8;
    let stage = facing(
        "mask_hole",
        &format!(
            r#"background: Linear(0, 0, 0), entities: [{SQUARE},
            (name: "wall", shape: Sphere(radius: 40), transform: (translate: (0, 0, -42)), emissive: (radiance: (3, 3, 3)))]"#
        ),
    )
    .retouch(veil(1.0, MASK, true, Filter::Nearest), |_| ());
    let options = TraceOptions {
        features: true,
        ids: true,
        ..bare(0)
    };
    let sums = stage.sums(0, SPP, &options);
    for (i, sum) in sums.rgb.iter().enumerate() {
        // Pixels at the borders of the halves see both.
        let (x, y) = (i % 16, i / 16);
        if !(2..=13).contains(&y) || !(2..=6).contains(&x) && !(9..=13).contains(&x) {
            continue;
        }
        let hole = x < 8;
        let expected = if hole { 3.0 } else { 0.0 };
        assert_eq!(sum[0], expected * f64::from(SPP), "pixel {x}, {y}");
        assert_eq!(sums.entity[i], u32::from(hole), "entity of pixel {x}, {y}");
        let depth = sums.depth[i] / f64::from(sums.hit_count[i]);
        let range = if hole { 5.0..5.2 } else { 2.999..3.001 };
        assert!(range.contains(&depth), "depth {depth} of pixel {x}, {y}");
    }
}

/// The centre's images take a blend from one half on.
#[test]
fn identities_take_half_a_blend() {
    for (factor, there) in [(0.49, false), (0.5, true)] {
        let stage = facing("blend_ids", &format!("{WHITE_SKY} entities: [{SQUARE}]")).retouch(
            veil(factor, AlphaMode::Blend, false, Filter::Nearest),
            |_| (),
        );
        let options = TraceOptions {
            ids: true,
            ..bare(1)
        };
        let sums = stage.sums(0, 1, &options);
        assert_eq!(sums.entity[8 * 16 + 8] == 0, there, "{factor}");
    }
}

/// A black half-transparent veil before the camera lets half of the light through; so does one before a lamp, and its
/// shadow rays are halved to the bit.
#[test]
fn half_a_veil_halves_the_light() {
    let black = |assets: &mut AssetStore| {
        veil(0.5, AlphaMode::Blend, false, Filter::Nearest)(assets);
        Arc::make_mut(&mut assets.meshes[0]).materials[0].color = [0.0; 3];
    };
    let before = facing(
        "veil_before",
        &format!("background: Linear(2, 2, 2), entities: [{SQUARE}]"),
    )
    .retouch(black, |_| ());
    let picture = before.luxel(0, 1024, &bare(3));
    let inside = |x: usize, y: usize| (3..13).contains(&x) && (3..13).contains(&y);
    assert_mean(
        "half a veil",
        picture.mean(0, inside),
        Mean::exact(1.0),
        0.02,
    );

    // The veil hangs level between a floor and its lights, out of the camera's sight.
    let lit = |factor: f64| {
        let stage = Stage::new("veil_over")
            .file("square.obj", &objs::square(0.0, 1.0))
            .file("floor.obj", &objs::square(0.0, 1.0))
            .scene(
                r#"camera: (at: (0, 0.4, 2.6), look_at: (0, 0, 0), vfov_deg: 30), render: (size: (16, 16)),
                entities: [(shape: Mesh("square.obj"), normals: Flat, transform: (translate: (0, 1, 0), rotate: Euler(-90, 0, 0), scale: 20)),
                    (shape: Mesh("floor.obj"), normals: Flat, transform: (rotate: Euler(-90, 0, 0))),
                    (shape: Sphere(radius: 0.3), transform: (translate: (0.3, 1.6, 0)), emissive: (radiance: (3, 3, 3))),
                    (shape: Mesh("floor.obj"), normals: Flat, transform: (translate: (0, 1.8, 0), rotate: Euler(80, 0, 0), scale: 0.2), emissive: (radiance: (3, 3, 3))),
                    (light: Point(intensity: (2, 2, 2)), transform: (translate: (0, 1.4, 0))),
                    (light: Sun(irradiance: (1, 1, 1)), transform: (rotate: Euler(-80, 0, 0)))]"#,
            )
            .retouch(veil(factor, AlphaMode::Blend, false, Filter::Nearest), |_| ());
        let options = TraceOptions {
            mis: false,
            ..options(1)
        };
        stage.sums(0, 16, &options)
    };
    let (veiled, open) = (lit(0.5), lit(0.0));
    let mut lit = 0;
    for (i, (a, b)) in veiled.rgb.iter().zip(&open.rgb).enumerate() {
        assert!(2.0 * a[0] == b[0], "pixel {i}: {a:?} {b:?}");
        lit += u32::from(b[0] > 0.0);
    }
    assert!(lit > 80, "{lit} lit pixels");
}

const SKY: &str = "background: Linear(0.6, 0.8, 1),";
const POINT: &str =
    "(light: Point(intensity: (1, 2, 3)), transform: (translate: (-0.3, 2.4, 0.3)))";
const LAMP: &str = "(shape: Sphere(radius: 0.8), transform: (translate: (0.4, 3.2, -0.2)), emissive: (radiance: (2, 2, 2)))";

/// Two veils, one turned over and mirrored, by image and factor, under the sky and a point or a lamp.
fn agree(
    name: &str,
    mode: AlphaMode,
    emission: f64,
    (sky, light): (&str, &str),
    spp: [u32; 2],
    detectable: f64,
) {
    let lamps = sky.is_empty();
    let stage = Stage::new(name)
        .file("square.obj", &objs::square(-0.3, 1.4))
        .file("floor.obj", &objs::square(0.0, 1.0))
        .scene(&format!(
            r#"camera: (at: (0, 2.6, 3.2), look_at: (0, 0.7, 0), vfov_deg: 42), render: (size: (16, 16), filter: Box), {sky}
            entities: [(shape: Mesh("square.obj"), normals: Flat, transform: ({ABOVE})), {light},
                (shape: Mesh("square.obj"), normals: Flat, transform: (translate: (0, 0.9, 0), rotate: Euler(-60, 30, 0), scale: (0.6, 0.6, -1))),
                (shape: Mesh("floor.obj"), normals: Flat, material: "floor", transform: (rotate: Euler(-90, 0, 0), scale: 3))],
            materials: {{"floor": Diffuse(color: Linear(0.6, 0.5, 0.4))}}"#
        ))
        .retouch(
            move |assets| {
                veil(0.9, mode, true, Filter::Bilinear)(assets);
                let material = &mut Arc::make_mut(&mut assets.meshes[0]).materials[0];
                material.color = [0.8, 0.6, 0.7];
                material.emission = [emission; 3];
            },
            move |scene| {
                let alpha = Image {
                    texels: HALVES.map(|a| DVec3::splat(f64::from(a) / 255.0)).to_vec(),
                    ..Image::from_srgb(&[0; 6], 2, 1)
                };
                let veil = Veil {
                    corners: false,
                    factor: 0.9,
                    alpha: Some(alpha),
                    cutoff: (mode != AlphaMode::Blend).then_some(0.5),
                };
                for entity in [0, 2] {
                    for surface in of_entity(scene, entity) {
                        surface.emission = Color::Flat(DVec3::splat(emission));
                        repaint(surface, |m| {
                            m.color = Color::Flat(DVec3::new(0.8, 0.6, 0.7));
                            m.veil = Some(veil.clone());
                        });
                    }
                }
            },
        );
    let found = stage.luxel(0, spp[0], &options(3));
    let estimator = Estimator {
        max_bounces: 3,
        lamps,
    };
    let truth = stage.reference(0, spp[1], estimator);
    assert_agree(name, &found, &truth, detectable);
}

const OUTDOORS: (&str, &str) = (SKY, POINT);

#[test]
fn masks_agree_with_the_reference() {
    agree("masks", MASK, 0.0, OUTDOORS, [512, 480], 0.005);
}

#[test]
fn blends_agree_with_the_reference() {
    agree("blends", AlphaMode::Blend, 0.0, OUTDOORS, [512, 480], 0.005);
}

/// Veils that shine: light samples see as much of them as is there.
#[test]
fn shining_veils_agree_with_the_reference() {
    agree(
        "shining_blends",
        AlphaMode::Blend,
        1.0,
        OUTDOORS,
        [512, 480],
        0.005,
    );
    agree("shining_masks", MASK, 1.0, OUTDOORS, [512, 480], 0.005);
}

/// An unlit surface: it shines from both sides, by its corners' colours, as far as their alpha says.
fn unlit_corners(name: &str, mode: AlphaMode) -> Stage {
    let corner = |k: usize| {
        let colors = [
            [1.0, 0.1, 0.2, 0.1],
            [0.0, 1.0, 0.3, 1.0],
            [0.5, 0.4, 1.0, 0.4],
            [0.9, 0.9, 0.0, 0.9],
        ];
        colors[[0, 1, 2, 0, 2, 3][k]]
    };
    let place = "translate: (-0.2, 0.7, 0.1), rotate: Euler(15, 70, 0), scale: 0.6";
    under(name, place, "background: Linear(0.1, 0.2, 0.1),").retouch(
        move |assets| {
            let material = MeshMaterial {
                scattering: Scattering::Nothing,
                vertex_colors: true,
                emission: [2.0; 3],
                two_sided: true,
                opacity: Opacity {
                    factor: 0.9,
                    texture: None,
                    vertex_alpha: true,
                    mode,
                },
                ..MeshMaterial::diffuse("unlit", [0.0; 3])
            };
            give(assets, None, material);
            let colors = (0..6).map(|k| corner(k).map(|c| c as f32));
            Arc::make_mut(&mut assets.meshes[0]).colors = colors.collect();
        },
        move |scene| {
            for (t, surface) in of_entity(scene, 0).enumerate() {
                let Shape::Triangle { more, .. } = &mut surface.shape else {
                    continue;
                };
                let corners = [0, 1, 2].map(|k| corner(3 * t + k));
                *more = Some(Box::new(Corners {
                    tint: corners.map(|[r, g, b, _]| DVec3::new(r, g, b)),
                    alpha: corners.map(|[.., alpha]| alpha),
                    ..Corners::PLAIN
                }));
                surface.emission = Color::Flat(DVec3::splat(2.0));
                surface.tinted_emission = true;
                surface.two_sided = true;
                repaint(surface, |m| {
                    m.kind = Kind::Nothing;
                    m.veil = Some(Veil {
                        corners: true,
                        factor: 0.9,
                        alpha: None,
                        cutoff: (mode != AlphaMode::Blend).then_some(0.5),
                    });
                });
            }
        },
    )
}

#[test]
fn corners_veil_what_only_shines() {
    for (name, mode) in [("corner_blend", AlphaMode::Blend), ("corner_mask", MASK)] {
        let stage = unlit_corners(name, mode);
        let found = stage.luxel(0, 512, &options(2));
        let estimator = Estimator {
            max_bounces: 2,
            lamps: true,
        };
        let truth = stage.reference(0, 960, estimator);
        assert_agree(name, &found, &truth, 0.02);
    }
}

/// What a path finds behind a veil is weighed by the density of its scattering.
#[test]
fn a_lamp_behind_veils_agrees_with_the_reference() {
    agree(
        "lamp_behind",
        AlphaMode::Blend,
        0.0,
        ("", LAMP),
        [2048, 1920],
        0.015,
    );
}

/// More surfaces in a row than a path may pass: the 65th is there, for paths and for shadow rays.
#[test]
fn a_thicket_ends_at_its_cap() {
    let row = |n: usize| {
        let squares: Vec<String> = (0..n)
            .map(|i| {
                let z = 1.0 - 0.02 * i as f64;
                format!(r#"(shape: Mesh("square.obj"), normals: Flat, transform: (translate: (0, 0, {z})))"#)
            })
            .collect();
        facing(
            "thicket",
            &format!("{WHITE_SKY} entities: [{}]", squares.join(",")),
        )
        .retouch(veil(0.0, AlphaMode::Blend, false, Filter::Nearest), |_| ())
        .sums(0, 1, &bare(0))
        .rgb[8 * 16 + 8][0]
    };
    assert_eq!(row(64), 1.0);
    assert_eq!(row(65), 0.0);
}

/// Instruction sets, trees and tiles give the same bits.
#[test]
fn veils_are_the_same_for_every_tree_and_tile() {
    let stage = under("veil_bits", ABOVE, "background: Linear(0.3, 0.4, 0.5),")
        .retouch(veil(0.9, AlphaMode::Blend, true, Filter::Bilinear), |_| ());
    let exact = |isa| TraceOptions {
        isa,
        sampler: Sampler::Sobol,
        ..options(4)
    };
    let best = exact(Isa::best());
    let truth = trace(&stage.flat(0, &best), 8, &best).rgb;
    for isa in Isa::all() {
        assert!(
            trace(&stage.flat(0, &best), 8, &exact(isa)).rgb == truth,
            "{}",
            isa.level()
        );
    }
    let brute = stage.flat_by(0, &best, Accel::Brute);
    assert!(trace(&brute, 8, &best).rgb == truth, "brute");
    let mut tracer = Tracer::new(&brute, &best);
    for y in 0..4 {
        let rect = Rect {
            x: 3,
            y: 4 * y,
            width: 9,
            height: 4,
        };
        let mut sums = TileSums::default();
        tracer.trace_tile(rect, 0..3, &mut sums);
        tracer.trace_tile(rect, 3..8, &mut sums);
        for (i, sum) in sums.rgb.iter().enumerate() {
            let (x, y) = (3 + i % 9, 4 * y as usize + i / 9);
            assert!(*sum == truth[y * 16 + x], "pixel {x}, {y}");
        }
    }
}
