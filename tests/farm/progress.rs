//! What logs are told while luxel works.

use crate::folder::folder;
use crate::support::text;
use serde_json::{Value, json};

/// The lines of stderr that are JSON.
fn events(stderr: &[u8]) -> Vec<Value> {
    let lines = text(stderr);
    let lines = lines.lines().filter(|line| line.starts_with('{'));
    lines
        .map(|line| serde_json::from_str(line).unwrap_or_else(|e| panic!("{line}: {e}")))
        .collect()
}

#[test]
fn json_tells_every_frame_and_where_it_ends() {
    let folder = folder("json");
    let line = [
        "animate",
        "spin.ron",
        "--frames",
        "3..6",
        "--progress",
        "json",
    ];
    let told = events(&folder.expect(&line, 0, &["3 frames in"]).stderr);
    let [frames @ .., last] = &told[..] else {
        panic!("{told:?}");
    };
    let progress = json!({"event": "progress", "frame": 5, "spp": 2, "of": 2, "done": 1.0, "rel_err": null, "eta_s": 0.0});
    assert_eq!(*last, progress);
    for (event, k) in frames.iter().zip(3..) {
        assert_eq!(event["event"], "frame");
        assert_eq!(event["frame"], k);
        assert_eq!(event["path"], format!("spin_{k:04}.png"));
        let error = event["rel_err"].as_f64().expect("known at the end");
        assert!((0.001..1.0).contains(&error), "{error}");
        assert!(event["seconds"].is_number());
    }
    assert_eq!(frames.len(), 3);
}

#[test]
fn a_still_is_told_like_a_frame() {
    let folder = folder("still");
    let line = ["render", "spin.ron", "--frame", "7", "--progress", "json"];
    let told = events(&folder.expect(&line, 0, &[]).stderr);
    let kinds: Vec<&Value> = told.iter().map(|event| &event["event"]).collect();
    assert_eq!(kinds, ["progress", "frame"]);
    for event in &told {
        assert_eq!(event["frame"], 7);
    }
    assert_eq!(told[1]["path"], "spin.png");
}

#[test]
fn every_kind_of_log_has_its_lines_and_silence_none() {
    let folder = folder("kinds");
    for (how, wanted) in [
        ("plain", &["frame 0: 2 of 2 spp, 100 % of all"][..]),
        (
            "openjd",
            &["openjd_progress: 100.0", "openjd_status: frame 0"],
        ),
        ("none", &[]),
        ("auto", &[]),
    ] {
        let line = ["render", "spin.ron", "--progress", how];
        let talk = text(&folder.expect(&line, 0, wanted).stderr);
        let lines = talk.lines().count();
        assert_eq!(
            lines,
            2 + wanted.len(),
            "the account and its advice: {talk}"
        );
    }
}

/// Slow only where the machine is: 12 seconds of tracing by the clock.
#[test]
#[ignore = "waits twelve seconds: cargo test --release --test farm heartbeat -- --ignored"]
fn a_heartbeat_comes_every_ten_seconds_and_knows_the_error() {
    let folder = folder("heartbeat");
    let line = ["render", "spin.ron", "--time", "12s", "--progress", "json"];
    let told = events(&folder.expect(&line, 0, &[]).stderr);
    let known = told.iter().filter(|event| event["rel_err"].is_number());
    assert!(
        told.len() >= 4,
        "two beats, the last one, the frame: {told:?}"
    );
    assert!(known.count() >= 2, "a beat and the frame: {told:?}");
}
