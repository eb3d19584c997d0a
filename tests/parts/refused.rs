//! Parts that do not fit, are damaged or of another luxel, and places that take no part: clear words, and nothing is lost.

use crate::folder::{Folder, expect};
use std::fs;
use std::process::Command;

/// Two shares of a render, `a.exr.0-of-2.part` and `a.exr.1-of-2.part`.
fn shared(name: &str) -> Folder {
    let folder = Folder::new(name);
    for share in ["0/2", "1/2"] {
        folder.expect(
            &format!("render s.ron --spp 16 -o a.exr --shard {share}"),
            0,
            &[],
        );
    }
    folder
}

#[test]
fn parts_that_make_no_image_are_told_and_left_alone() {
    let folder = shared("fit");
    let (a, b) = ("a.exr.0-of-2.part", "a.exr.1-of-2.part");
    for (parts, words) in [
        (a.to_owned(), ["no part has samples 8..16", "--allow-gaps"]),
        (b.to_owned(), ["no part has samples 0..8", "--allow-gaps"]),
        (format!("{a} {b} {a}"), ["both have samples 0..8", "once"]),
    ] {
        folder.expect(&format!("merge {parts} -o a.exr"), 2, &words);
    }
    for (more, word) in [
        ("--spp 16 --seed 1", "seed 1"),
        ("--spp 32", "spp 32"),
        ("--spp 16 --bounces 2", "bounces 2"),
        ("--spp 16 --exposure 1", "exposure 1"),
        ("--spp 16 --aov normal", "aov normal"),
        ("--spp 16 --tile 8", "--tile"),
    ] {
        let line = format!("render s.ron -o b.exr --samples-range 0..8 {more}");
        folder.expect(&line, 0, &[]);
        let line = format!("merge {a} b.exr.0..8.part -o a.exr");
        folder.expect(&line, 2, &[word]);
        fs::remove_file(folder.path("b.exr.0..8.part")).expect("ours");
    }
    let scene = fs::read_to_string(folder.path("s.ron")).expect("there");
    fs::write(folder.path("s.ron"), scene.replace("0.8, 0.6", "0.8, 0.7")).expect("ours");
    folder.expect("render s.ron --spp 16 -o c.exr --shard 1/2", 0, &[]);
    folder.expect(
        &format!("merge {a} c.exr.1-of-2.part -o a.exr"),
        2,
        &["another scene"],
    );
    folder.expect(
        "render s.ron --spp 16 -o a.exr --shard 1/2",
        2,
        &["another scene", "--overwrite"],
    );
    folder.expect("merge no.part -o a.exr", 66, &["no.part"]);
    folder.expect("merge s.ron -o a.exr", 65, &["no part film"]);
    folder.expect(&format!("merge {a} {b} -o a.jpg"), 2, &["a.jpg"]);
    assert!(!folder.path("a.exr").exists());
}

#[test]
fn damaged_parts_and_those_of_other_versions_are_refused() {
    let folder = shared("damaged");
    let (a, b) = ("a.exr.0-of-2.part", "a.exr.1-of-2.part");
    let whole = folder.bytes(b);
    let (share, merge) = (
        "render s.ron --spp 16 -o a.exr --shard 1/2",
        format!("merge {a} {b} -o a.exr"),
    );
    let refused = |bytes: &[u8], word: &str| {
        fs::write(folder.path(b), bytes).expect("ours");
        folder.expect(&merge, 65, &[b, word]);
        folder.expect(share, 65, &[b, word, "--overwrite"]);
        folder.expect(&format!("info {b}"), 65, &[b, word]);
        assert!(folder.bytes(b) == bytes, "it is left as it was");
    };
    refused(&whole[..whole.len() / 2], "cut short");
    refused(&whole[..whole.len() - 1], "cut short");
    for at in [whole.len() / 3, whole.len() / 2, whole.len() - 2] {
        let mut bytes = whole.clone();
        bytes[at] ^= 0x10;
        refused(&bytes, "cannot be used");
    }
    let mut newer = whole.clone();
    newer["luxel part ".len()] = b'2';
    refused(&newer, "another format");
    // Of another luxel, with a good checksum.
    let version = format!("version: {}", env!("CARGO_PKG_VERSION"));
    let at = whole
        .windows(version.len())
        .position(|w| w == version.as_bytes());
    let mut other = whole.clone();
    other[at.expect("a version") + "version: ".len()] = b'9';
    let end = other.len() - 4;
    let checksum = crc32fast::hash(&other[..end]);
    other[end..].copy_from_slice(&checksum.to_le_bytes());
    fs::write(folder.path(b), &other).expect("ours");
    folder.expect(&merge, 65, &["was made by luxel 9"]);
    folder.expect(share, 2, &["was made by luxel 9", "--overwrite"]);
    folder.expect(&format!("{share} --overwrite"), 0, &[]);
    assert!(folder.bytes(b) == whole);
    folder.expect(&merge, 0, &[]);
}

#[cfg(unix)]
#[test]
fn without_room_it_says_so_and_loses_nothing() {
    let folder = Folder::new("room");
    let line = "render s.ron --spp 16 -o a.exr --checkpoint 1h";
    folder.expect(line, 0, &[]);
    let (image, part) = (folder.bytes("a.exr"), folder.bytes("a.exr.part"));
    // A limit on the size of files stands in for a full disk.
    let luxel = env!("CARGO_BIN_EXE_luxel");
    let script = format!(
        "trap '' XFSZ; ulimit -f 8; exec '{luxel}' render s.ron --spp 400 -o a.exr --checkpoint 5ms"
    );
    let output = Command::new("sh")
        .args(["-c", &script])
        .current_dir(folder.path(""))
        .output();
    expect(
        &output.expect("a shell"),
        74,
        &[
            "going on",
            "warning: \"a.exr.part\" is not saved",
            "cannot write \"a.exr.part\"",
        ],
    );
    assert_eq!(folder.names(), ["a.exr", "a.exr.part"]);
    assert!(folder.bytes("a.exr") == image && folder.bytes("a.exr.part") == part);
    folder.expect(
        "render s.ron --spp 24 -o a.exr --checkpoint 1h",
        0,
        &["sample 16 is next"],
    );
}

#[cfg(unix)]
#[test]
fn a_folder_that_takes_no_file_is_refused_before_rendering() {
    let folder = Folder::new("read-only");
    let minute = "--spp 16777216 --size 4000x4000";
    for (line, path) in [
        ("--checkpoint 1s -o no/such/a.exr", "no/such/a.exr"),
        // Whose permissions stop nobody: it takes no files at all.
        ("--shard 0/4 -o /proc/a.exr", "/proc/a.exr"),
    ] {
        folder.expect(&format!("render s.ron {minute} {line}"), 74, &[path]);
    }
    fs::create_dir(folder.path("b.exr.part")).expect("ours");
    let line = format!("render s.ron {minute} --checkpoint 1s -o b.exr");
    folder.expect(&line, 74, &["b.exr.part", "folder"]);
    fs::remove_dir(folder.path("b.exr.part")).expect("ours");
}
