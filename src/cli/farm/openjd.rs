//! A job template of Open Job Description, as `openjd run` and AWS Deadline Cloud take it.

use super::job::{Job, in_folder};
use crate::cli::failure::Failure;
use serde_json::{Value, json};

/// Seconds that a task has to save its work.
const NOTICE: u32 = 120;

/// The template.
pub(super) fn template(job: &Job) -> Result<String, Failure> {
    let mut task = in_folder(&job.out, job.task("openjd"));
    let last = job.last();
    let mut words = task.iter().chain(&last);
    if let Some(word) = words.find(|word| word.contains("{{")) {
        return Err(Failure::usage(
            format!("OpenJD would read \"{word}\" as a format string"),
            "name it without {{",
        ));
    }
    let shard = format!("{{{{Task.Param.Shard}}}}/{}", job.shards);
    task.extend(["--shard".to_owned(), shard]);
    let needs = json!({"amounts": [
        {"name": "amount.worker.vcpu", "min": job.cpus},
        {"name": "amount.worker.memory", "min": job.memory},
    ]});
    let template = json!({
        "specificationVersion": "jobtemplate-2023-09",
        "name": job.name,
        "description": job.title,
        "steps": [
            {
                "name": "Tasks",
                "parameterSpace": {"taskParameterDefinitions": [
                    {"name": "Shard", "type": "INT", "range": format!("0-{}", job.shards - 1)},
                ]},
                "hostRequirements": needs,
                "script": script(&task),
            },
            {
                "name": "Last",
                "dependencies": [{"dependsOn": "Tasks"}],
                "hostRequirements": needs,
                "script": script(&last),
            },
        ],
    });
    Ok(format!("{template:#}\n"))
}

fn script(line: &[String]) -> Value {
    json!({"actions": {"onRun": {
        "command": line.first(),
        "args": line.get(1..),
        "cancelation": {"mode": "NOTIFY_THEN_TERMINATE", "notifyPeriodInSeconds": NOTICE},
    }}})
}
