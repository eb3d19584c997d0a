//! The scratch copy of the tree: what bugs are planted in, built and run.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A copy with a build folder of its own, both kept from run to run.
pub(crate) struct Tree {
    copy: PathBuf,
    build: PathBuf,
}

/// What a run of tests ended with.
pub(crate) struct Verdict {
    pub(crate) green: Vec<String>,
    pub(crate) red: Vec<String>,
    /// It came to its end, within the time and not by a signal.
    pub(crate) ended: bool,
}

impl Tree {
    /// Makes the copy in `to` that of `root`, without what is built.
    pub(crate) fn copy(root: &Path, to: &Path) -> Tree {
        let tree = Tree {
            copy: to.join("tree"),
            build: to.join("build"),
        };
        sync(root, &tree.copy);
        tree
    }

    /// Writes a file of the copy, if its text is another: builds go by the time of writing.
    pub(crate) fn write(&self, file: &str, text: &str) {
        write(&self.copy.join(file), text.as_bytes());
    }

    /// Builds a test binary, `lib` for the tests in the sources; returns where it is.
    ///
    /// # Errors
    /// What the compiler says.
    pub(crate) fn build(&self, target: &str) -> Result<PathBuf, String> {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut command = Command::new(cargo);
        command
            .current_dir(&self.copy)
            .args(["test", "--no-run", "--quiet", "--profile", "mutants"])
            .args(["--message-format", "json-render-diagnostics"])
            .arg("--target-dir")
            .arg(&self.build)
            .stdin(Stdio::null());
        match target {
            "lib" => command.arg("--lib"),
            _ => command.args(["--test", target]),
        };
        let output = command.output().map_err(|e| format!("cargo: {e}"))?;
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        if !output.status.success() {
            return Err(told);
        }
        let stdout = String::from_utf8_lossy(&output.stdout);
        let artifact = |line: &str| serde_json::from_str::<serde_json::Value>(line).ok();
        let tests = stdout
            .lines()
            .filter_map(artifact)
            .filter(|artifact| artifact["profile"]["test"] == true);
        let mut binaries =
            tests.filter_map(|artifact| Some(artifact["executable"].as_str()?.into()));
        binaries
            .next_back()
            .ok_or_else(|| format!("cargo built no tests of {target}: {told}"))
    }

    /// Runs the tests of a binary whose names hold one of `filters`.
    pub(crate) fn run(&self, binary: &Path, filters: &[&str], patience: Duration) -> Verdict {
        let log = self.build.join("tests.log");
        let out = std::fs::File::create(&log).expect("a log");
        let mut child = Command::new(binary)
            .current_dir(&self.copy)
            .args(filters)
            .stdin(Stdio::null())
            .stdout(out)
            .stderr(Stdio::null())
            .spawn()
            .expect("the tests start");
        let start = Instant::now();
        let ended = loop {
            if let Some(status) = child.try_wait().expect("the tests run") {
                break status.code().is_some();
            }
            if start.elapsed() > patience {
                let _ = child.kill();
                let _ = child.wait();
                break false;
            }
            std::thread::sleep(Duration::from_millis(20));
        };
        let text = std::fs::read_to_string(&log).unwrap_or_default();
        let named = |end: &str| -> Vec<String> {
            let names = text.lines().filter_map(|line| line.strip_suffix(end));
            let names = names.filter_map(|line| line.strip_prefix("test "));
            names.map(str::to_owned).collect()
        };
        Verdict {
            green: named(" ... ok"),
            red: named(" ... FAILED"),
            ended,
        }
    }
}

/// Makes a folder's files those of another; files with the same bytes are left alone.
fn sync(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).expect("a folder of the copy");
    let names = |folder: &Path| -> Vec<std::ffi::OsString> {
        let entries = std::fs::read_dir(folder).expect("a folder");
        entries.map(|e| e.expect("an entry").file_name()).collect()
    };
    let ours =
        |name: &std::ffi::OsString| name != "target" && !name.as_encoded_bytes().starts_with(b".");
    let wanted: Vec<_> = names(from).into_iter().filter(ours).collect();
    for name in names(to).iter().filter(|name| !wanted.contains(name)) {
        let stale = to.join(name);
        let gone = if stale.is_dir() {
            std::fs::remove_dir_all(stale)
        } else {
            std::fs::remove_file(stale)
        };
        gone.expect("what is stale goes");
    }
    for name in &wanted {
        let (from, to) = (from.join(name), to.join(name));
        if from.is_dir() {
            sync(&from, &to);
        } else if from.is_file() {
            write(&to, &std::fs::read(&from).expect("a file of the tree"));
        }
    }
}

fn write(path: &Path, bytes: &[u8]) {
    if std::fs::read(path).is_ok_and(|old| old == bytes) {
        return;
    }
    std::fs::write(path, bytes).expect("a file of the copy");
}
