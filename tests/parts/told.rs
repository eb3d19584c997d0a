//! `luxel info`: what a file is, and the line that makes it again, which does.

use crate::folder::{AOVS, Folder};
use std::fs;

/// Runs the line that `info` prints of a file, elsewhere, and asserts that the file comes out of it.
fn again(folder: &Folder, other: &Folder, name: &str) {
    let said = folder.expect(&format!("info {name}"), 0, &[]);
    let line = said
        .lines()
        .last()
        .and_then(|line| line.strip_prefix("luxel "));
    let line = line.expect("a line").replace("SCENE", "s.ron");
    other.expect(&line, 0, &[]);
    assert!(other.bytes(name) == folder.bytes(name), "{line}");
}

#[test]
fn the_line_that_is_told_makes_the_same_file() {
    let (folder, other) = (Folder::new("told"), Folder::new("told-again"));
    for (line, name) in [
        ("--spp 5 -o a.png".to_owned(), "a.png"),
        (
            format!("--spp 3 --frame 2 --seed 9 --size 17x9 -o b.exr --aov {AOVS}"),
            "b.exr",
        ),
        (
            "--spp 3 --nee off --mis off --roulette off --fresnel schlick --exposure -1.5 -o c.png"
                .to_owned(),
            "c.png",
        ),
        (
            "--spp 3 --sampler independent --fixed-noise --frame 3 --bounces 2 -o d.png".to_owned(),
            "d.png",
        ),
        (
            "--spp 16 --shard 1/2 -o e.exr --aov normal,stderr".to_owned(),
            "e.exr.1-of-2.part",
        ),
        (
            "--spp 16 --shard 1/2 --shard-by tiles -o f.png --exposure 1".to_owned(),
            "f.png.1-of-2.part",
        ),
        (
            "--spp 16 --samples-range 8..16 -o g.exr".to_owned(),
            "g.exr.8..16.part",
        ),
        ("--spp 11 --checkpoint 1h -o h.png".to_owned(), "h.png.part"),
        ("--noise 10% -o j.exr --aov samples".to_owned(), "j.exr"),
        (
            "--noise 6% --spp 40 --adaptive off -o k.png".to_owned(),
            "k.png",
        ),
    ] {
        folder.expect(&format!("render s.ron {line}"), 0, &[]);
        again(&folder, &other, name);
    }
    folder.expect("animate s.ron --frames 3 --spp 2 -o i_#.png", 0, &[]);
    again(&folder, &other, "i_3.png");
}

#[test]
fn scripts_are_told_too() {
    let folder = Folder::new("json");
    folder.expect("render s.ron --spp 16 -o a.exr --shard 1/2", 0, &[]);
    let said = folder.expect("info a.exr.1-of-2.part --json", 0, &[]);
    let found: serde_json::Value = serde_json::from_str(&said).expect("JSON");
    assert_eq!(found["kind"], "part");
    assert_eq!(found["finished"], true);
    assert_eq!(found["samples"]["held"], 40 * 24 * 8);
    assert_eq!(found["done"], serde_json::json!([16, 16]));
    assert_eq!(found["metadata"]["part.samples"], "8..16");
    folder.expect("render s.ron --spp 2 -o b.png", 0, &[]);
    let said = folder.expect("info b.png --json", 0, &[]);
    let found: serde_json::Value = serde_json::from_str(&said).expect("JSON");
    assert_eq!(found["kind"], "image");
    assert_eq!(found["metadata"]["spp"], "2");
    assert!(said.contains("luxel render SCENE --size 40x24 --spp 2"));
    fs::write(folder.path("c.png"), b"a letter").expect("ours");
    folder.expect("info c.png", 65, &["neither"]);
    folder.expect("info s.ron", 65, &["neither"]);
    folder.expect("info no.exr", 66, &["no.exr"]);
}
