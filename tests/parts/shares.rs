//! 1, 2, 4, 8 shares of samples, of tiles and of frames are one run, byte by byte.

use crate::folder::{AOVS, Folder};

/// Renders all shares and merges them, the last one first.
fn merged(folder: &Folder, line: &str, shares: u32, by: &str) -> Vec<u8> {
    let mut parts = Vec::new();
    for share in 0..shares {
        let line = format!("render s.ron {line} -o m.exr --shard {share}/{shares} --shard-by {by}");
        let path = folder.expect(&line, 0, &["luxel merge"]);
        assert_eq!(path, format!("m.exr.{share}-of-{shares}.part\n"));
        parts.insert(0, path);
    }
    let said = folder.expect(
        &format!("merge -o m.exr {}", parts.join(" ")),
        0,
        &["m.exr · 40×24"],
    );
    assert_eq!(said, "m.exr\n");
    folder.bytes("m.exr")
}

#[test]
fn shares_of_a_still_are_one_run_to_the_bit() {
    let folder = Folder::new("shares");
    for (line, counts) in [
        (format!("--aov {AOVS} --tile 8"), [1, 2, 4, 8]),
        // The last block is not complete, and shares are of several nodes.
        (
            format!("--aov {AOVS} --spp 93 --tile 16 --seed 5"),
            [3, 4, 5, 6],
        ),
        (format!("--aov {AOVS} --sampler independent"), [1, 2, 2, 2]),
    ] {
        folder.clear();
        folder.expect(&format!("render s.ron -o one.exr {line}"), 0, &[]);
        let one = folder.bytes("one.exr");
        for shares in counts {
            for by in ["samples", "tiles"] {
                assert_eq!(
                    merged(&folder, &line, shares, by),
                    one,
                    "{line} {shares} {by}"
                );
                folder.clear();
            }
        }
    }
}

#[test]
fn ranges_named_one_by_one_and_other_machines_give_the_same_picture() {
    let folder = Folder::new("ranges");
    folder.expect("render s.ron -o one.png --spp 40 --exposure 1", 0, &[]);
    for (range, more) in [
        ("0..8", "--threads 1 --isa scalar"),
        ("8..24", "--accel brute"),
        ("24..40", "--tree fast"),
    ] {
        let line =
            format!("render s.ron -o m.png --spp 40 --exposure 1 --samples-range {range} {more}");
        assert_eq!(
            folder.expect(&line, 0, &[]),
            format!("m.png.{range}.part\n")
        );
    }
    folder.expect(
        "merge m.png.24..40.part m.png.0..8.part m.png.8..24.part -o m.png",
        0,
        &[],
    );
    assert!(folder.bytes("m.png") == folder.bytes("one.png"));
}

#[test]
fn shares_of_frames_are_one_animation() {
    let folder = Folder::new("frames");
    let line = "animate s.ron --spp 2 -o f_#.png --size 16x12";
    folder.expect(line, 0, &[]);
    let names = folder.names();
    let one: Vec<Vec<u8>> = names.iter().map(|name| folder.bytes(name)).collect();
    assert_eq!(one.len(), 8);
    for shares in [1, 2, 4, 8] {
        folder.clear();
        for share in 0..shares {
            let said = folder.expect(&format!("{line} --shard {share}/{shares}"), 0, &[]);
            assert_eq!(said.lines().count(), 8 / shares);
        }
        assert_eq!(folder.names(), names);
        for (name, one) in names.iter().zip(&one) {
            assert!(folder.bytes(name) == *one, "{name} of {shares} shares");
        }
    }
    folder.expect(&format!("{line} --shard 8/9"), 0, &["none of them"]);
}

#[test]
fn schedulers_say_which_share() {
    let folder = Folder::new("auto");
    let auto = |share: &str, environment: &[(&str, &str)]| {
        let line = format!("render s.ron -o a.exr --shard {share}");
        let mut command = folder.command(&line);
        let output = command.envs(environment.iter().copied()).output();
        let output = output.expect("luxel runs");
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let slurm = |id| {
        [
            ("SLURM_ARRAY_TASK_ID", id),
            ("SLURM_ARRAY_TASK_MIN", "1"),
            ("SLURM_ARRAY_TASK_COUNT", "2"),
        ]
    };
    assert_eq!(auto("auto", &slurm("1")), "a.exr.0-of-2.part\n");
    assert_eq!(auto("auto", &slurm("2")), "a.exr.1-of-2.part\n");
    assert_eq!(auto("0/4", &slurm("2")), "a.exr.0-of-4.part\n");
    let kubernetes = [("JOB_COMPLETION_INDEX", "3")];
    assert_eq!(auto("auto/4", &kubernetes), "a.exr.3-of-4.part\n");
}

#[test]
fn lines_that_make_no_share_are_told() {
    let folder = Folder::new("lines");
    for (line, words) in [
        ("--shard 4/4", "from 0"),
        ("--shard 0/9", "blocks of 8"),
        ("--shard 0/200 --shard-by tiles", "fewer shares"),
        ("--shard 0/2 --noise 1%", "--spp N"),
        ("--shard 0/2 --time 1s", "--spp N"),
        ("--shard 0/2 -o -", "-o FILE.exr"),
        ("--samples-range 0..12 --spp 64", "multiples of 8"),
        ("--samples-range 0..72 --spp 64", "multiples of 8"),
        ("--samples-range 0..8", "--spp"),
        ("--checkpoint 0s", "30s"),
    ] {
        folder.expect(&format!("render s.ron {line}"), 2, &[words]);
    }
    let mut auto = folder.command("render s.ron --shard auto");
    let output = auto.env_remove("SLURM_ARRAY_TASK_ID").output();
    crate::folder::expect(&output.expect("luxel runs"), 2, &["SLURM_ARRAY_TASK_ID"]);
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}
