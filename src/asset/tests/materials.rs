//! MTL files: found, read, and what they say of a material.

use super::super::*;
use super::{Folder, TRIANGLE, codes_and_lines, png};

#[test]
fn materials_are_read_as_the_format_allows() {
    let mtl = b"newmtl grey\nKd 0.5\nnewmtl Material #3\nKd 1 2 0.25 # bright\nKe 3 4 5\nnewmtl bare\nd 0.5\nNs 9\nKs 0 0 0\nillum 2\nnewmtl unused\nmap_Kd gone.png\n";
    let obj = format!(
        "mtllib m.mtl\n{TRIANGLE}f 1 2 3\nusemtl Material #3\nf 1 2 3\nusemtl grey # note\nf 1 2 3\nusemtl bar\nf 1 2 3\nusemtl bare\nf 1 2 3\n"
    );
    let (mesh, warnings) = Folder::of(&[("a.obj", obj.as_bytes()), ("m.mtl", mtl)]).load("a.obj");
    let mesh = mesh.expect("a mesh");
    assert_eq!(mesh.material, [None, Some(0), Some(1), None, Some(2)]);
    let read: Vec<_> = mesh
        .materials
        .iter()
        .map(|m| (m.name.as_str(), m.color, m.emission))
        .collect();
    assert_eq!(
        read,
        [
            ("Material #3", [1.0, 1.0, 0.25], [3.0, 4.0, 5.0]),
            ("grey", [0.5; 3], [0.0; 3]),
            ("bare", [0.8; 3], [0.0; 3]),
        ]
    );
    assert_eq!(
        codes_and_lines(&warnings),
        [("W110", 3), ("W102", 10), ("W116", 7)]
    );
    assert_eq!(warnings[1].hint.as_deref(), Some("did you mean \"bare\"?"));
}

#[test]
fn impossible_material_values_are_errors_with_their_line() {
    for (line, says) in [
        ("Kd 0.5 x 0", "`x` is not a number"),
        ("Kd 0.5 0.5", "`Kd` needs one or three numbers, not 2"),
        ("Kd", "`Kd` needs one or three numbers, not 0"),
        ("Ke -1 0 0", "`Ke` cannot be -1"),
        ("Kd nan", "`Kd` cannot be nan"),
        (
            "Kd spectral a.rfl 1",
            "`Kd spectral` is not supported: give linear red, green and blue",
        ),
    ] {
        let mtl = format!("newmtl m\n{line}");
        let obj = format!("mtllib m.mtl\n{TRIANGLE}usemtl m\nf 1 2 3");
        let folder = Folder::of(&[("a.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())]);
        let errors = folder.load("a.obj").0.expect_err("an error");
        assert_eq!(
            (errors[0].message.as_str(), codes_and_lines(&errors)),
            (says, vec![("E106", 2)])
        );
        assert!(
            errors[0]
                .file
                .as_ref()
                .is_some_and(|file| file.ends_with("m.mtl"))
        );
    }
}

#[test]
fn material_files_are_found_by_any_spelling() {
    let mtl = b"newmtl m\nKd 1 0 0";
    for (line, codes) in [
        ("mtllib my mat.mtl", vec![]),
        ("mtllib .\\my mat.mtl", vec![]),
        ("mtllib \"my mat.mtl\"", vec![]),
        ("mtllib other.mtl my mat.mtl", vec![("W101", 1)]),
        ("mtllib /nowhere/my mat.mtl # where?", vec![("W112", 1)]),
        ("mtllib other.mtl", vec![("W101", 1)]),
        ("mtllib", vec![("W102", 5)]),
    ] {
        let obj = format!("{line}\n{TRIANGLE}usemtl m\nf 1 2 3");
        let folder = Folder::of(&[("a.obj", obj.as_bytes()), ("my mat.mtl", mtl)]);
        let (mesh, warnings) = folder.load("a.obj");
        assert_eq!(codes_and_lines(&warnings), codes, "{line}");
        let found = !line.ends_with("other.mtl") && line != "mtllib";
        assert_eq!(
            mesh.expect("a mesh").materials.len(),
            usize::from(found),
            "{line}"
        );
    }
}

#[test]
fn texture_lines_have_options_and_spaces() {
    let image = png(png::ColorType::Rgb, png::BitDepth::Eight, 1, &[1, 2, 3]);
    for (line, codes) in [
        ("map_Kd my tex.png", vec![]),
        ("map_Kd -s 1 1 1 -o 0 -clamp off -bm 2 my tex.png", vec![]),
        ("map_Kd -s 2 2 1 -clamp on my tex.png", vec![]),
        ("map_Kd -mm 0 0.5 -o 1 my tex.png", vec![]),
        ("map_Kd -mm 0.5 1 -t 1 my tex.png", vec![("W104", 2)]),
        ("map_Kd -mm 0 -1 -cc on my tex.png", vec![("W104", 2)]),
        ("map_Kd -s 1e999 my tex.png", vec![("W104", 2)]),
        (
            "map_Kd my tex.png\nKe 0\nmap_Ke my tex.png",
            vec![("W113", 1)],
        ),
        ("map_Kd .\\my tex.png", vec![]),
        ("map_Kd C:\\art\\my tex.png", vec![("W112", 2)]),
        ("map_Kd My Tex.png", vec![("W103", 2)]),
        ("Kd 0 0 0\nmap_Kd my tex.png", vec![("W113", 1)]),
        ("map_Kd my tex.png\nmap_d my tex.png", vec![]),
        (
            "map_Kd my tex.png\nmap_d -s 2 2 2 ./my tex.png",
            vec![("W118", 3)],
        ),
        ("map_Kd my tex.png\nmap_d gone.png", vec![("W103", 3)]),
    ] {
        let mtl = format!("newmtl m\n{line}");
        let obj = format!("mtllib m.mtl\n{TRIANGLE}usemtl m\nf 1 2 3");
        let folder = Folder::of(&[
            ("a.obj", obj.as_bytes()),
            ("m.mtl", mtl.as_bytes()),
            ("my tex.png", &image),
        ]);
        let (mesh, warnings) = folder.load("a.obj");
        let found = !codes.contains(&("W103", 2));
        let opaque = |mesh: &Mesh| mesh.materials[0].opacity == Opacity::OPAQUE;
        assert!(mesh.as_ref().is_ok_and(opaque), "{line}");
        assert_eq!(codes_and_lines(&warnings), codes, "{line}");
        assert_eq!(
            mesh.expect("a mesh").materials[0].texture.is_some(),
            found,
            "{line}"
        );
    }
}

#[test]
fn opacity_is_a_factor_and_the_alpha_of_an_image() {
    use png::{BitDepth::Eight, ColorType::*};
    let clear = png(Rgba, Eight, 1, &[1, 2, 3, 99]);
    let solid = png(Rgba, Eight, 1, &[1, 2, 3, 255]);
    for (line, factor, textured, codes) in [
        ("d 1.000000   ", 1.0, false, vec![]),
        ("d 0.25", 0.25, false, vec![]),
        ("Tr 0.25", 0.75, false, vec![]),
        ("d 0.5\nTr 0.25", 0.5, false, vec![]),
        ("Tr 0.25\nd 0.5", 0.5, false, vec![]),
        ("d 7", 1.0, false, vec![]),
        ("Tr 1.000000", 1.0, false, vec![("W117", 2)]),
        ("d 0", 1.0, false, vec![("W117", 2)]),
        ("d -halo 0.5", 1.0, false, vec![("W104", 2)]),
        ("map_d clear.png", 1.0, true, vec![]),
        ("map_Kd clear.png", 1.0, false, vec![]),
        ("d 0.5\nmap_d clear.png # leaves", 0.5, true, vec![]),
        ("map_d solid.png", 1.0, false, vec![("W118", 2)]),
    ] {
        let mtl = format!("newmtl m\n{line}");
        let obj = format!("mtllib m.mtl\n{TRIANGLE}usemtl m\nf 1 2 3");
        let folder = Folder::of(&[
            ("a.obj", obj.as_bytes()),
            ("m.mtl", mtl.as_bytes()),
            ("clear.png", &clear),
            ("solid.png", &solid),
        ]);
        let (mesh, warnings) = folder.load("a.obj");
        assert_eq!(codes_and_lines(&warnings), codes, "{line}");
        let opacity = mesh.expect("a mesh").materials[0].opacity;
        let blends = opacity.mode == AlphaMode::Blend;
        assert_eq!(
            (opacity.factor, opacity.texture.is_some()),
            (factor, textured),
            "{line}"
        );
        assert_eq!(blends, factor < 1.0 || textured, "{line}");
    }
}

/// Quadratic time would be minutes.
#[test]
fn very_many_names_are_found_and_missed_quickly() {
    const COUNT: usize = 10_000;
    let start = std::time::Instant::now();
    let mut obj = format!("mtllib m.mtl\n{TRIANGLE}");
    let mut mtl = String::new();
    for i in 0..COUNT {
        mtl += &format!("newmtl m{i}\nmap_Kd gone{i}.png\n");
        obj += &format!("usemtl m{i}\nf 1 2 3\nmtllib lost{i}.mtl\n");
    }
    let long = "x".repeat(1 << 20);
    obj += &format!("usemtl {long}\nf 1 2 3\n");
    mtl += &format!("newmtl long\nmap_Kd {long}\n");
    let files = [("a.obj", obj.as_bytes()), ("m.mtl", mtl.as_bytes())];
    let (mesh, warnings) = Folder::of(&files).load("a.obj");
    assert_eq!(mesh.expect("a mesh").materials.len(), COUNT);
    assert!(warnings.len() < 100, "{}", warnings.len());
    let more = format!(", and {} more like it", COUNT - 20);
    let counted = warnings.iter().filter(|one| one.message.ends_with(&more));
    assert_eq!(counted.count(), 2, "{warnings:?}");
    assert!(start.elapsed().as_secs() < 30, "{:?}", start.elapsed());
}

/// u' = scale · u + offset, and what multiplies the texels multiplies the factor.
#[test]
fn texture_lines_place_their_image() {
    let image = png(png::ColorType::Rgba, png::BitDepth::Eight, 1, &[1, 2, 3, 4]);
    let mtl = "newmtl m\nKd 0.5\nmap_Kd -s 2 3 1 -o 0.25 -1 t.png\nmap_Ke -mm 0 4 -clamp on t.png\nmap_d -mm 0 0.5 -s 2 t.png";
    let obj = format!("mtllib m.mtl\n{TRIANGLE}usemtl m\nf 1 2 3");
    let files: [(&str, &[u8]); 3] = [
        ("a.obj", obj.as_bytes()),
        ("m.mtl", mtl.as_bytes()),
        ("t.png", &image),
    ];
    let (mesh, warnings) = Folder::of(&files).load("a.obj");
    assert!(warnings.is_empty(), "{warnings:?}");
    let material = mesh.expect("a mesh").materials[0].clone();
    assert_eq!((material.color, material.emission), ([0.5; 3], [4.0; 3]));
    let color = material.texture.expect("a texture");
    let placed = TextureUse {
        transform: Some([2.0, 0.0, 0.25, 0.0, 3.0, -1.0]),
        ..TextureUse::plain(color.texture)
    };
    assert_eq!(color, placed);
    let clamped = TextureUse {
        wrap: [Wrap::Clamp; 2],
        ..TextureUse::plain(color.texture)
    };
    assert_eq!(material.emission_texture, Some(clamped));
    let veil = TextureUse {
        transform: Some([2.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
        ..TextureUse::plain(color.texture)
    };
    assert_eq!(
        (material.opacity.factor, material.opacity.texture),
        (0.5, Some(veil))
    );
}
