//! The jobs of `luxel farm`, run to their end by stand-ins for the schedulers: a few lines of shell that start tasks as
//! those do. In folders whose names a shell would take apart, and to the bits of a plain run. `prove.sh` beside this file
//! does the same with the schedulers themselves.

use crate::folder::folder;
use crate::support::{Folder, expect, text};
use serde_json::Value;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Quotes, a variable, a command, words, and what GNU parallel replaces.
const ODD: &str = "it's \"odd\" $HOME `ls` {} {#} & *";

/// A folder of scenes below one with a stand-in for every command of a scheduler.
struct Farm {
    folder: Folder,
    scenes: PathBuf,
}

/// Runs the script on stdin for each index of --array, as `sbatch` would later.
const SBATCH: &str = r#"last=0
for word in "$@"; do
    case $word in
    --array=0-*) last=${word#--array=0-} ;;
    --output=*) log=${word#--output=} ;;
    esac
done
script=$(cat)
for i in $(seq 0 "$last"); do
    SLURM_JOB_ID=7 SLURM_ARRAY_TASK_ID=$i SLURM_CPUS_PER_TASK=1 bash -c "$script" >>"$log" 2>&1
done
echo '7;cluster'
"#;

const SRUN: &str = r#"while [ "${1#--}" != "$1" ]; do shift; done
exec "$@"
"#;

/// Runs the commands on stdin.
const PARALLEL: &str = r#"while IFS= read -r line; do bash -c "$line" || failed=1; done
exit "${failed:-0}"
"#;

impl Farm {
    fn new(name: &str) -> Farm {
        let folder = folder(&format!("farm-{name}"));
        let scenes = folder.0.join(ODD);
        fs::create_dir(&scenes).expect("a folder");
        for file in ["spin.ron", "cube.obj"] {
            fs::rename(folder.0.join(file), scenes.join(file)).expect("ours");
        }
        let farm = Farm { folder, scenes };
        for (name, body) in [("sbatch", SBATCH), ("srun", SRUN), ("parallel", PARALLEL)] {
            farm.stand_in(name, body);
        }
        farm
    }

    fn stand_in(&self, name: &str, body: &str) {
        let path = self.folder.0.join(name);
        fs::write(&path, format!("#!/usr/bin/env bash\n{body}")).expect("writable");
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("ours");
    }

    /// A command among the scenes that finds the stand-ins first.
    fn command(&self, program: &str) -> Command {
        let path = std::env::var("PATH").unwrap_or_default();
        let mut command = Command::new(program);
        command
            .current_dir(&self.scenes)
            .env("PATH", format!("{}:{path}", self.folder.0.display()))
            .env("NO_COLOR", "1");
        command
    }

    fn luxel(&self, words: &[&str]) -> Output {
        let mut command = self.command(env!("CARGO_BIN_EXE_luxel"));
        command.args(words).output().expect("luxel runs")
    }

    /// What `luxel farm` prints.
    #[track_caller]
    fn job(&self, words: &[&str]) -> String {
        let printed = self.luxel(&[&["farm"], words].concat());
        expect(&printed, 0, &[]);
        text(&printed.stdout)
    }

    /// Runs a job in three tasks: the animation, or a still.
    fn run(&self, scheduler: &str, what: &str, out: &str) {
        let this = env!("CARGO_BIN_EXE_luxel");
        let line = [
            scheduler, "spin.ron", "--out", out, "--shards", "3", "--luxel", this,
        ];
        let more = match what {
            "frames" => &["--", "--frames", "2..6"][..],
            _ => &["--by", "samples", "--format", "exr", "--", "--spp", "32"],
        };
        let job = self.job(&[&line, more].concat());
        match scheduler {
            "slurm" | "parallel" => {
                let done = self.command("bash").args(["-c", &job]).output();
                expect(&done.expect("bash"), 0, &[]);
            }
            "openjd" => self.run_openjd(&job),
            _ => self.run_k8s(&job),
        }
    }

    /// As OpenJD does: steps in order, a task for every number of a parameter's range.
    fn run_openjd(&self, job: &str) {
        let job: Value = serde_json::from_str(job).expect("JSON");
        for step in job["steps"].as_array().expect("steps") {
            let parameter = &step["parameterSpace"]["taskParameterDefinitions"][0];
            let range = parameter["range"].as_str().unwrap_or("0-0");
            let (first, last) = range.split_once('-').expect("a range");
            let run = &step["script"]["actions"]["onRun"];
            for i in first.parse().expect("a number")..=last.parse::<u32>().expect("a number") {
                let words = [vec![string(&run["command"])], strings(&run["args"])].concat();
                self.words(words, "{{Task.Param.Shard}}", &i.to_string());
            }
        }
    }

    /// As Kubernetes does: every index of the first Job, then the second, if there is one.
    fn run_k8s(&self, job: &str) {
        let job: Value = serde_json::from_str(job).expect("JSON");
        for job in job["items"].as_array().expect("a list") {
            for i in 0..job["spec"]["completions"].as_u64().unwrap_or(1) {
                let container = &job["spec"]["template"]["spec"]["containers"][0];
                let words = strings(&container["command"]);
                self.words(words, "$(JOB_COMPLETION_INDEX)", &i.to_string());
            }
        }
    }

    #[track_caller]
    fn words(&self, words: Vec<String>, variable: &str, value: &str) {
        let mut words = words.into_iter();
        let mut command = self.command(&words.next().expect("a program"));
        let words = words.map(|word| word.replace(variable, value).replace("$$(", "$("));
        expect(&command.args(words).output().expect("runs"), 0, &[]);
    }

    fn bytes(&self, path: impl AsRef<Path>) -> Vec<u8> {
        let path = self.scenes.join(path);
        fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
    }
}

fn string(value: &Value) -> String {
    value.as_str().expect("a string").to_owned()
}

fn strings(values: &Value) -> Vec<String> {
    let values = values.as_array().expect("an array");
    values.iter().map(string).collect()
}

#[test]
fn every_job_renders_what_one_machine_renders() {
    let farm = Farm::new("same");
    let plain = [
        "animate",
        "spin.ron",
        "--frames",
        "2..6",
        "-o",
        "plain_####.png",
    ];
    expect(&farm.luxel(&plain), 0, &[]);
    let plain = ["render", "spin.ron", "--spp", "32", "-o", "plain.exr"];
    expect(&farm.luxel(&plain), 0, &[]);
    for scheduler in ["slurm", "parallel", "openjd", "k8s"] {
        let out = format!("{scheduler} it's $x");
        farm.run(scheduler, "frames", &out);
        for k in 2..6 {
            let same = farm.bytes(format!("{out}/spin_{k:04}.png"));
            assert!(
                same == farm.bytes(format!("plain_{k:04}.png")),
                "{scheduler}, frame {k}"
            );
        }
        farm.run(scheduler, "samples", &out);
        let same = farm.bytes(format!("{out}/spin.exr"));
        assert!(same == farm.bytes("plain.exr"), "{scheduler}");
    }
}

#[test]
fn slurm_repeats_a_task_that_saved_its_work_and_no_other() {
    let farm = Farm::new("requeue");
    let log = farm.folder.0.join("requeued");
    farm.stand_in("scontrol", &format!("echo \"$@\" >>'{}'\n", log.display()));
    farm.stand_in("squeue", "echo \"$STATE\"\n");
    farm.stand_in("srun", "exit \"$CODE\"\n");
    // Runs one task and prints its code in place of an id.
    farm.stand_in(
        "sbatch",
        "SLURM_JOB_ID=7 SLURM_ARRAY_TASK_ID=0 SLURM_CPUS_PER_TASK=1 bash; echo $?\n",
    );
    let job = farm.job(&["slurm", "spin.ron", "--out", "out"]);
    for (code, state, requeued) in [
        ("75", "RUNNING", true),
        // Cancelled by somebody, who does not want it again.
        ("75", "COMPLETING", false),
        ("65", "RUNNING", false),
        ("0", "RUNNING", false),
    ] {
        let mut bash = farm.command("bash");
        bash.args(["-c", &job])
            .env("CODE", code)
            .env("STATE", state);
        let told = text(&bash.output().expect("bash").stdout);
        assert!(told.starts_with(&format!("tasks {code}, ")), "{told}");
        let found = fs::read_to_string(&log).unwrap_or_default();
        assert_eq!(found.contains("requeue 7"), requeued, "{code} {state}");
        let _ = fs::remove_file(&log);
    }
}

#[test]
fn parallel_repeats_a_task_that_saved_its_work_and_no_other() {
    let farm = Farm::new("again");
    // Stopped twice, then done; or bad.
    farm.stand_in(
        "stub",
        "echo >>runs; [ \"$(wc -l <runs)\" = \"$END\" ] || exit \"$CODE\"\n",
    );
    let stub = farm.folder.0.join("stub");
    let stub = stub.to_str().expect("text");
    let line = [
        "parallel", "spin.ron", "--out", "o", "--shards", "1", "--luxel", stub,
    ];
    let job = farm.job(&line);
    for (code, end, runs) in [("75", "3", 3), ("65", "3", 2), ("75", "0", 6)] {
        let mut bash = farm.command("bash");
        bash.args(["-c", &job]).env("CODE", code).env("END", end);
        assert!(bash.output().is_ok());
        let found = text(&farm.bytes("runs")).lines().count();
        // The last task is one more run, which nobody repeats.
        let last = usize::from(code == "75" && end == "3");
        assert_eq!(found, runs + last, "{code} {end}");
        fs::remove_file(farm.scenes.join("runs")).expect("ours");
    }
}

#[test]
fn scenes_of_several_frames_are_shared_by_frames_and_no_task_has_nothing_to_do() {
    let farm = Farm::new("frames");
    for (more, said) in [
        (&[][..], "spin, 12 frames: 0–11, in 8 tasks"),
        (&["--shards", "50"], "12 frames: 0–11, in 12 tasks"),
        (&["--", "--frames", "3,5"], "2 frames: 3, 5, in 2 tasks"),
        (
            &["--by", "samples"],
            "spin, 2 samples of a still, in 1 tasks",
        ),
        (
            &["--by", "samples", "--", "--spp", "100"],
            "spin, 100 samples of a still, in 8 tasks",
        ),
        (
            &["--by", "samples", "--", "--spp", "25"],
            "spin, 25 samples of a still, in 4 tasks",
        ),
    ] {
        let job = farm.job(&[&["slurm", "spin.ron", "--out", "o"], more].concat());
        assert!(job.contains(said), "no \"{said}\" in:\n{job}");
    }
}

#[test]
fn what_tasks_would_refuse_is_refused_now() {
    let farm = Farm::new("refused");
    fs::write(farm.scenes.join("bad.ron"), "Scene(").expect("writable");
    for (words, code, said) in [
        (
            &["slurm", "spin.ron", "--out", "o", "--", "--bogus"][..],
            2,
            "'--bogus'",
        ),
        (
            &["slurm", "spin.ron", "--out", "o", "--", "--shard", "0/2"],
            2,
            "--shard",
        ),
        (
            &["slurm", "spin.ron", "--out", "o", "--", "--size", "0x0"],
            2,
            "0x0",
        ),
        (
            &[
                "slurm", "spin.ron", "--out", "o", "--by", "samples", "--", "--noise", "1%",
            ],
            2,
            "--spp N",
        ),
        (
            &[
                "slurm",
                "spin.ron",
                "--out",
                "o",
                "--by",
                "samples",
                "--",
                "--shard-by",
                "tiles",
            ],
            2,
            "2 tiles are not enough for 8",
        ),
        (&["slurm", "none.ron", "--out", "o"], 66, "none.ron"),
        (&["slurm", "bad.ron", "--out", "o"], 65, "bad.ron"),
        (
            &["slurm", "spin.ron", "--out", "a\nb"],
            2,
            "control characters",
        ),
        (
            &["openjd", "spin.ron", "--out", "{{o}}"],
            2,
            "format string",
        ),
        (
            &["k8s", "spin.ron", "--out", "../o/../../o"],
            2,
            "below the current folder",
        ),
        (
            &["k8s", "spin.ron", "--out", "o", "--container", "luxel"],
            2,
            "volume claim",
        ),
    ] {
        let refused = farm.luxel(&[&["farm"], words].concat());
        expect(&refused, code, &[said]);
        assert_eq!(text(&refused.stdout), "", "{words:?}");
    }
}
