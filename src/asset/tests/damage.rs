//! Damaged files are refused or read, never a panic.

use super::super::*;
use super::{Folder, SQUARE};
use crate::diag::{Diagnostic, Severity};
use std::fs;
use std::path::Path;

/// SplitMix64 (Steele, Lea and Flood 2014).
fn next(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// Every so many rounds go through files, which are slow, and through what files name.
const FILE_EVERY: usize = 25;

#[test]
fn no_damage_to_a_file_is_a_panic() {
    let obj = format!(
        "mtllib m.mtl\n{SQUARE}vt 0 0\nvt 1 0.5\nvn 0 0 1\nusemtl a\nf 1/1/1 2/2/1 3/1/1 4/2/1\nf -1 -2 -3 -4 1\nusemtl b\nf 1//1 2//1 \\\n3//1\n"
    );
    let mtl = "newmtl a\nKd 0.5 0.5 0.5\nmap_Kd -s 1 1 1 t.png\nnewmtl b\nKe 1 2 3\nd 0.5\n";
    let pieces: [&[u8]; 16] = [
        b"-", b"/", b"\\\n", b"#", b" ", b"\n", b"0", b"9", b"nan", b"1e999", b"\xFF", b"\0",
        b"f ", b"v ", b"usemtl ", b"\"",
    ];
    let folder = Folder::of(&[]);
    let (mut state, mut loaded, mut refused) = (1, 0, 0);
    for round in 0..5000 {
        let mut texts = [obj.clone().into_bytes(), mtl.as_bytes().to_vec()];
        for _ in 0..=next(&mut state) % 3 {
            let text = &mut texts[usize::from(next(&mut state).is_multiple_of(4))];
            let at = next(&mut state) as usize % text.len();
            let piece = pieces[next(&mut state) as usize % pieces.len()];
            match next(&mut state) % 3 {
                0 => drop(text.splice(at..at, piece.iter().copied())),
                1 => drop(text.remove(at)),
                _ => text[at] = piece[0],
            }
        }
        let _ = mtl::read(&text::decode(&texts[1]));
        match parse(&text::decode(&texts[0])) {
            Ok(mesh) => {
                loaded += 1;
                check_shape(&mesh);
            }
            Err(errors) => {
                refused += 1;
                let known =
                    |e: &Diagnostic| e.severity == Severity::Error && e.code != codes::PARSER;
                assert!(errors.iter().all(known), "{errors:?}");
            }
        }
        if round % FILE_EVERY == 0 {
            fs::write(folder.0.join("a.obj"), &texts[0]).expect("a file");
            fs::write(folder.0.join("m.mtl"), &texts[1]).expect("a file");
            if let Ok(mesh) = folder.load("a.obj").0 {
                check_shape(&mesh);
            }
        }
    }
    assert!(
        loaded > 500 && refused > 500,
        "{loaded} loaded, {refused} refused"
    );
}

/// Text to mesh, without its materials.
fn parse(text: &str) -> Result<Mesh, Vec<Diagnostic>> {
    let scan = scan::scan(text, Path::new("a.obj"), &mut limits::Budget::default())?;
    let materials = vec![None; scan.uses.len()];
    obj::triangles(text, scan, &materials, &mut Vec::new()).map_err(|error| vec![error])
}

/// What [`Mesh`] promises of its arrays.
fn check_shape(mesh: &Mesh) {
    let corners = 3 * mesh.triangle_count();
    assert_eq!(
        (mesh.corners.len(), mesh.material.len()),
        (corners, corners / 3)
    );
    assert!(mesh.uvs.is_empty() || mesh.uvs.len() == corners);
    assert!(mesh.normals.is_empty() || mesh.normals.len() == corners);
    assert!(
        mesh.corners
            .iter()
            .all(|&c| mesh.positions[c as usize].is_finite())
    );
    assert!(
        mesh.material
            .iter()
            .flatten()
            .all(|&m| (m as usize) < mesh.materials.len())
    );
    let smooth = normals::smooth(mesh, 60.0);
    let is_unit = |n: DVec3| (n.length() - 1.0).abs() < 1e-12;
    assert!(smooth.len() == corners && smooth.iter().all(|n| n.is_some_and(is_unit)));
}
