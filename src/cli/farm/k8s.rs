//! An Indexed Job of Kubernetes 1.29 or later and, for a still, a Job that merges.

use super::args::By;
use super::job::{Job, absolute, in_folder};
use crate::cli::failure::{Failure, code};
use serde_json::{Value, json};
use std::path::{Component, Path};

/// How often a task may fail for reasons that pass, such as a disk that is away.
const RETRIES: u32 = 3;

/// Seconds that a task has to save its work.
const NOTICE: u32 = 120;

/// Kubernetes lets no Job wait for another: until all shares are there and whole, merging fails.
const UNTIL: &str = r#"until "$@"; do sleep 60; done"#;

/// The manifest; `container` is the image that has luxel, and the claim of the volume that holds the current folder.
pub(super) fn manifest(job: &Job, container: &(String, String)) -> Result<String, Failure> {
    let folder = absolute(Path::new("."))?;
    for path in [&job.scene, &job.out] {
        let climbs = Path::new(path)
            .components()
            .any(|it| it == Component::ParentDir);
        if climbs || !Path::new(path).starts_with(&folder) || folder == "/" {
            return Err(Failure::usage(
                format!("\"{path}\" is not below the current folder"),
                "call luxel in the folder that the volume holds",
            ));
        }
    }
    let pod = |command: Vec<String>| {
        let amounts = json!({"cpu": job.cpus, "memory": format!("{}Mi", job.memory)});
        json!({
            "restartPolicy": "Never",
            "terminationGracePeriodSeconds": NOTICE,
            "containers": [{
                "name": "luxel",
                "image": container.0,
                "command": command,
                "workingDir": folder,
                // A limit, too: luxel takes as many threads as the cgroup allots.
                "resources": {"requests": amounts, "limits": amounts},
                "volumeMounts": [{"name": "films", "mountPath": folder}],
            }],
            "volumes": [{"name": "films", "persistentVolumeClaim": {"claimName": container.1}}],
        })
    };
    let mut task = plain(in_folder(&job.out, job.task("json")));
    task.extend([
        "--shard".to_owned(),
        format!("$(JOB_COMPLETION_INDEX)/{}", job.shards),
    ]);
    let tasks = json!({
        "completionMode": "Indexed",
        "completions": job.shards,
        "parallelism": job.shards,
        "backoffLimitPerIndex": RETRIES,
        "podFailurePolicy": {"rules": [
            // Stopped with its work saved: queued again, however often.
            on_exit("Ignore", &[code::RESUMABLE]),
            {"action": "Ignore", "onPodConditions": [{"type": "DisruptionTarget"}]},
            // Nothing that a retry mends.
            on_exit("FailIndex", &[code::USAGE, code::DATA, code::NO_INPUT, code::BUG]),
        ]},
        "template": {"spec": pod(task)},
    });
    let mut items = vec![item(&job.name, &tasks)];
    if job.by == By::Samples {
        let until = ["sh", "-c", UNTIL, "until"].map(str::to_owned);
        let last = plain([until.to_vec(), job.last()].concat());
        let last = json!({"template": {"spec": pod(last)}});
        items.push(item(&format!("{}-last", job.name), &last));
    }
    let list = json!({"apiVersion": "v1", "kind": "List", "items": items});
    Ok(format!("{list:#}\n"))
}

fn item(name: &str, spec: &Value) -> Value {
    json!({"apiVersion": "batch/v1", "kind": "Job", "metadata": {"name": name}, "spec": spec})
}

fn on_exit(action: &str, codes: &[u8]) -> Value {
    json!({"action": action, "onExitCodes": {"operator": "In", "values": codes}})
}

/// Words that Kubernetes leaves as they are: in its own, $(NAME) is a variable.
fn plain(words: Vec<String>) -> Vec<String> {
    let words = words.into_iter();
    words.map(|word| word.replace("$(", "$$(")).collect()
}
