//! `luxel compare`.

use crate::folder;
use crate::support::{Folder, expect, text};
use std::fs;

/// Two renders of the scene with other noise: `a.exr`, `b.exr`, and `a.png`.
fn renders(name: &str) -> Folder {
    let folder = folder(name);
    for (output, seed) in [("a.exr", "1"), ("b.exr", "2"), ("a.png", "1")] {
        let args = ["render", "scene.ron", "-o", output, "--seed", seed];
        expect(&folder.run(&args), 0, &[]);
    }
    folder
}

#[test]
fn an_image_compared_with_itself_has_no_error() {
    let folder = renders("compare-same");
    for image in ["a.exr", "a.png"] {
        for metric in ["rmse", "relmse", "flip"] {
            let args = ["compare", image, image, "--metric", metric, "--max", "0"];
            let output = folder.run(&args);
            expect(&output, 0, &[]);
            let table = text(&output.stdout);
            for row in ["RMSE  0\n", "relMSE  0\n", "PSNR  inf dB\n", "FLIP  0\n"] {
                assert!(table.contains(row), "no {row:?} in:\n{table}");
            }
        }
    }
}

#[test]
fn noise_is_measured_and_judged() {
    let folder = renders("compare-noise");
    let output = folder.run(&["compare", "a.exr", "b.exr", "--json"]);
    expect(&output, 0, &[]);
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(value["size"], serde_json::json!([40, 24]));
    assert_eq!(value["pixels"], 960);
    let of = |name: &str| value[name].as_f64().expect("a number");
    assert!(of("rmse") > 0.0 && of("relmse") > 0.0);
    assert!(of("flip") > 0.0 && of("flip") < 1.0);
    assert!((of("psnr") + 20.0 * of("rmse").log10()).abs() < 1e-9);
    for metric in ["rmse", "relmse", "flip"] {
        let judged = |max: f64| {
            let max = max.to_string();
            folder.run(&[
                "compare", "a.exr", "b.exr", "--metric", metric, "--max", &max,
            ])
        };
        expect(&judged(of(metric) * 1.01), 0, &[]);
        let output = judged(of(metric) * 0.99);
        expect(&output, 1, &["is above"]);
        assert!(text(&output.stdout).contains("reference  b.exr"));
    }
}

#[test]
fn the_mask_leaves_lamps_and_their_rims_out() {
    let folder = folder("compare-mask");
    let write = |name: &str, lamp: f32| {
        let pixel = |x, y| {
            let light = if (x, y) == (6, 6) { lamp } else { 0.5 };
            (light, light, light)
        };
        exr::prelude::write_rgb_file(folder.path(name), 12, 12, pixel).expect("writable");
    };
    write("image.exr", 100.0);
    write("reference.exr", 9.0);
    let measured = |args: &[&str]| -> serde_json::Value {
        let args = [&["compare", "image.exr", "reference.exr", "--json"], args].concat();
        serde_json::from_slice(&folder.run(&args).stdout).expect("JSON")
    };
    let (whole, masked) = (measured(&[]), measured(&["--mask", "peers"]));
    assert_eq!(
        (&whole["pixels"], &masked["pixels"]),
        (&144.into(), &95.into())
    );
    assert_eq!(masked["mask"], "peers");
    // 91 off in one pixel of 144.
    let rmse = whole["rmse"].as_f64().expect("a number");
    assert!((rmse - 91.0 / 12.0).abs() < 1e-12, "{rmse}");
    assert_eq!(masked["rmse"], 0.0);
}

#[test]
fn heat_maps_are_pictures_of_the_same_size() {
    let folder = renders("compare-heat");
    for metric in ["flip", "rmse"] {
        let args = [
            "compare",
            "a.exr",
            "b.exr",
            "--heatmap",
            "e.png",
            "--metric",
            metric,
        ];
        expect(&folder.run(&args), 0, &[]);
        expect(&folder.run(&["compare", "e.png", "a.exr"]), 0, &[]);
        fs::remove_file(folder.path("e.png")).expect("written");
    }
}

#[test]
fn what_cannot_be_compared_is_told() {
    let folder = renders("compare-bad");
    let small = ["render", "scene.ron", "-o", "small.png", "--size", "8x5"];
    expect(&folder.run(&small), 0, &[]);
    fs::write(folder.path("cut.exr"), &folder.bytes("a.exr")[..300]).expect("writable");
    let before = folder.names();
    let cases: &[(&[&str], i32, &[&str])] = &[
        (&["a.exr", "small.png"], 2, &["40×24", "8×5"]),
        (&["a.exr", "none.exr"], 66, &["none.exr"]),
        (&["scene.ron", "a.exr"], 65, &["scene.ron", "neither"]),
        (&["cut.exr", "a.exr"], 65, &["cut.exr", "EXR"]),
        (&["a.exr"], 2, &["REFERENCE"]),
        (
            &["a.exr", "b.exr", "--metric", "psnr", "--max", "30"],
            2,
            &["psnr", "--metric rmse"],
        ),
        (&["a.exr", "b.exr", "--max", "NaN"], 2, &["0.01"]),
        (&["a.exr", "b.exr", "--ppd", "1"], 2, &["10 to 1000"]),
        (&["a.exr", "b.exr", "--heatmap", "e.exr"], 2, &[".png"]),
        (
            &["a.png", "b.exr", "--heatmap", "./a.png"],
            2,
            &["overwrite"],
        ),
        (
            &["a.exr", "b.exr", "--heatmap", "no/e.png"],
            74,
            &["no/e.png"],
        ),
    ];
    for (args, code, words) in cases {
        let args = [&["compare"], *args].concat();
        expect(&folder.run(&args), *code, words);
    }
    assert_eq!(folder.names(), before);
}

#[test]
fn values_that_are_not_finite_fail() {
    use exr::prelude::write_rgb_file;
    let folder = folder("compare-nan");
    let write = |name: &str, bad: f32| {
        let pixel = |x, y| match (x, y) {
            (3, 2) | (1, 4) => (0.5f32, bad, 0.5),
            _ => (0.5, 0.5, 0.5),
        };
        write_rgb_file(folder.path(name), 6, 5, pixel).expect("writable");
    };
    write("good.exr", 0.5);
    for (name, bad) in [("nan.exr", f32::NAN), ("inf.exr", f32::INFINITY)] {
        write(name, bad);
        let place = ["2 pixels", "not finite", "column 3, row 2"];
        expect(&folder.run(&["compare", name, "good.exr"]), 1, &place);
        let output = folder.run(&["compare", "good.exr", name, "--mask", "peers"]);
        expect(&output, 1, &["the reference has 2 pixels"]);
        expect(&folder.run(&["compare", name, name]), 1, &["the image has"]);
    }
}
