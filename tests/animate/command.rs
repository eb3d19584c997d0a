//! `luxel animate` from outside.

use crate::folder::{files, folder, names};
use crate::support::{Folder, text};
use std::fs;

#[test]
fn frames_are_those_of_render_and_do_not_depend_on_each_other() {
    let folder = folder("frames");
    let told = folder.expect(
        &["animate", "spin.ron"],
        0,
        &["12 frames: 0–11", "frame 11: pose", "trace"],
    );
    let paths: Vec<String> = (0..12).map(|k| format!("spin_{k:04}.png")).collect();
    assert_eq!(text(&told.stdout), paths.join("\n") + "\n");
    assert_eq!(names(&folder), paths);
    let all = files(&folder);
    assert_ne!(all["spin_0003.png"], all["spin_0004.png"]);
    folder.expect(
        &["render", "spin.ron", "--frame", "7", "-o", "alone.png"],
        0,
        &[],
    );
    folder.expect(
        &[
            "animate",
            "spin.ron",
            "--frames",
            "11,3..=9:3",
            "-o",
            "some/f#.png",
        ],
        0,
        &["4 frames: 3–9 by 3, 11"],
    );
    assert_eq!(files(&folder)["alone.png"], all["spin_0007.png"]);
    for k in [3, 6, 9, 11] {
        let some = fs::read(folder.0.join(format!("some/f{k}.png"))).expect("there");
        assert_eq!(some, all[&paths[k]], "frame {k}");
    }
}

#[test]
fn a_full_turn_is_frame_0_under_fixed_noise() {
    let folder = folder("turn");
    let args = [
        "animate",
        "spin.ron",
        "--fixed-noise",
        "--frames",
        "0,12,13",
        "-o",
        "f_##.exr",
    ];
    folder.expect(&args, 0, &[]);
    let pixels = |k: u32| {
        let path = folder.0.join(format!("f_{k:02}.exr"));
        luxel::measure::Image::read(&path)
            .expect("an image")
            .pixels()
            .to_vec()
    };
    assert_eq!(pixels(0), pixels(12));
    assert_ne!(pixels(0), pixels(13));
    let args = [
        "animate",
        "spin.ron",
        "--frames",
        "0,12",
        "-o",
        "own_##.exr",
    ];
    folder.expect(&args, 0, &[]);
    let own = luxel::measure::Image::read(&folder.0.join("own_12.exr")).expect("an image");
    assert_ne!(
        own.pixels(),
        pixels(12),
        "else every frame has its own noise"
    );
}

#[test]
fn finished_frames_are_kept_if_they_are_what_is_asked_for() {
    let folder = folder("kept");
    let line = ["animate", "spin.ron", "--frames", "0..4"];
    folder.expect(&line, 0, &["4 frames: 0–3"]);
    let times = |folder: &Folder| {
        let of = |k: u32| {
            fs::metadata(folder.0.join(format!("spin_{k:04}.png"))).and_then(|m| m.modified())
        };
        (0..4).map(|k| of(k).expect("there")).collect::<Vec<_>>()
    };
    let before = times(&folder);
    fs::remove_file(folder.0.join("spin_0002.png")).expect("ours");
    let again = folder.expect(&line, 0, &["4 frames: 0–3; 3 of them are finished"]);
    assert_eq!(text(&again.stdout), "spin_0002.png\n");
    let after = times(&folder);
    assert_eq!(
        [before[0], before[1], before[3]],
        [after[0], after[1], after[3]]
    );

    let all = files(&folder);
    let with = |more: &[&'static str]| [&line[..], more].concat();
    folder.expect(
        &with(&["--spp", "3"]),
        2,
        &["spin_0000.png", "made with spp 2, not 3", "--overwrite"],
    );
    folder.expect(
        &with(&["--exposure", "1"]),
        2,
        &["made with exposure 0, not 1"],
    );
    folder.expect(&with(&["--fixed-noise"]), 2, &["does not say its noise"]);
    let scene = fs::read_to_string(folder.0.join("spin.ron")).expect("ours");
    fs::write(folder.0.join("spin.ron"), format!("{scene}\n")).expect("ours");
    folder.expect(&line, 2, &["made of another scene"]);
    fs::write(folder.0.join("spin.ron"), scene).expect("ours");
    let cube = fs::read_to_string(folder.0.join("cube.obj")).expect("ours");
    fs::write(
        folder.0.join("cube.obj"),
        cube.replace("v 1 1 1", "v 1 1 1.5"),
    )
    .expect("ours");
    folder.expect(&line, 2, &["made of another scene, or of other files"]);
    fs::write(folder.0.join("cube.obj"), cube).expect("ours");
    assert_eq!(files(&folder), all, "nothing was touched");

    let half = &all["spin_0001.png"][..all["spin_0001.png"].len() / 2];
    fs::write(folder.0.join("spin_0001.png"), half).expect("ours");
    folder.expect(&line, 2, &["spin_0001.png", "no whole PNG"]);
    fs::write(folder.0.join("spin_0001.png"), "somebody's notes").expect("ours");
    folder.expect(&line, 2, &["spin_0001.png", "no whole PNG"]);
    folder.expect(&with(&["--overwrite"]), 0, &["4 frames: 0–3\n"]);
    assert_eq!(files(&folder), all);
}

#[test]
fn further_images_are_settings_too() {
    let folder = folder("aov");
    let line = ["animate", "spin.ron", "--frames", "0..2", "-o", "f_#.exr"];
    let with = |more: &[&'static str]| [&line[..], more].concat();
    folder.expect(&with(&["--aov", "normal,depth"]), 0, &[]);
    folder.expect(
        &with(&["--aov", "depth,normal"]),
        0,
        &["2 of them are finished"],
    );
    folder.expect(&with(&["--aov", "depth"]), 2, &["other images (--aov)"]);
    folder.expect(&line, 2, &["other images (--aov)"]);
}

#[test]
fn films_are_those_of_the_frames_whenever_these_were_made() {
    let folder = folder("films");
    let line = ["animate", "spin.ron", "--gif", "a.gif", "--y4m", "a.y4m"];
    folder.expect(&line, 0, &[]);
    let first = files(&folder);
    for name in ["a.gif", "a.y4m", "spin_0005.png"] {
        fs::remove_file(folder.0.join(name)).expect("ours");
    }
    folder.expect(&line, 0, &["11 of them are finished"]);
    assert_eq!(files(&folder), first);
    let out = folder.expect(
        &["animate", "spin.ron", "--y4m", "-"],
        0,
        &["12 of them are finished"],
    );
    assert_eq!(out.stdout, first["a.y4m"], "and nothing else on stdout");
    let film = &first["a.y4m"];
    let header = b"YUV4MPEG2 W40 H24 F24:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\n";
    assert!(film.starts_with(header));
    assert_eq!(
        film.len(),
        header.len() + 12 * ("FRAME\n".len() + 3 * 40 * 24)
    );
    // Linear frames, the same film: the picture is what a PNG would show.
    folder.expect(
        &["animate", "spin.ron", "-o", "f_##.exr", "--y4m", "b.y4m"],
        0,
        &[],
    );
    assert_eq!(files(&folder)["b.y4m"], *film);
    // Every second frame at half the rate.
    let half = folder.expect(
        &["animate", "spin.ron", "--frames", "0..12:2", "--y4m", "-"],
        0,
        &[],
    );
    assert!(text(&half.stdout[..60]).contains("F12:1"));
}

#[test]
fn wrong_lines_are_explained_and_cost_nothing() {
    let folder = folder("wrong");
    let cases: &[(&[&str], &[&str])] = &[
        (&["--frames", "48..0"], &["48..0", "0..48"]),
        (&["--frames", "5..5"], &["holds no frame"]),
        (&["--frames", "x"], &["`x` is no frame number"]),
        (&["-o", "f.png"], &["one picture", "####"]),
        (&["-o", "f_##.gif"], &[".png", ".exr"]),
        (
            &["-o", "f_##.png", "--aov", "depth"],
            &["PNG cannot hold depth"],
        ),
        (&["--gif", "a.png"], &["does not look like a GIF"]),
        (&["--y4m", "a.mp4"], &["YUV4MPEG2", ".y4m"]),
        (&["--spp", "0"], &["--spp"]),
    ];
    for (args, words) in cases {
        folder.expect(&[&["animate", "spin.ron"], *args].concat(), 2, words);
    }
    folder.expect(&["animate", "none.ron"], 66, &["none.ron"]);
    let scene = fs::read_to_string(folder.0.join("spin.ron")).expect("ours");
    fs::write(
        folder.0.join("bad.ron"),
        scene.replace("(0, 1, 0.5)", "(0, 0, 0)"),
    )
    .expect("ours");
    folder.expect(
        &["animate", "bad.ron"],
        65,
        &["`axis` must not have length 0"],
    );
    let keys = "keys: [(t: 1), (t: 0.5)]";
    let at = scene.find("spin:").expect("a spin");
    let end = scene[at..].find(")),").expect("its end") + at + 1;
    fs::write(
        folder.0.join("bad.ron"),
        format!("{}{keys}{}", &scene[..at], &scene[end..]),
    )
    .expect("ours");
    folder.expect(&["animate", "bad.ron"], 65, &["key times must rise"]);
    assert_eq!(names(&folder), ["bad.ron"]);
    folder.expect(
        &["animate", "spin.ron", "-o", "spin.ron/f_#.png"],
        74,
        &["spin.ron"],
    );
}
