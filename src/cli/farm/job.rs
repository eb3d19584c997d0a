//! What every scheduler is asked for: tasks, and one that comes last.

use super::args::{By, FarmArgs, FormatArg, Scheduler};
use crate::cli::args::{Cli, Command, RenderArgs};
use crate::cli::failure::Failure;
use crate::cli::frame_list::FrameList;
use crate::cli::part_args::ShardBy;
use crate::cli::share;
use crate::cli::tuned::Tuned;
use crate::film::Blocks;
use crate::scene::SceneDesc;
use clap::Parser;
use std::path::Path;

/// Tasks, if nobody says how many.
const SHARDS: u32 = 8;

/// How often a task of a still saves what it has. The frames of an animation are saved one by one.
const CHECKPOINT: &str = "60s";

/// One render in parts.
pub(super) struct Job {
    /// Lower-case letters, digits and dashes.
    pub(super) name: String,
    /// What is rendered in which parts, for people.
    pub(super) title: String,
    /// The scene; absolute, as all paths.
    pub(super) scene: String,
    /// The folder of the results.
    pub(super) out: String,
    pub(super) shards: u32,
    pub(super) by: By,
    pub(super) cpus: u16,
    /// In MiB.
    pub(super) memory: u64,
    /// The program.
    luxel: String,
    /// The still, or the frames with #### for their number.
    image: String,
    options: Vec<String>,
}

impl Job {
    /// What the arguments ask for; refused now if the tasks would be.
    pub(super) fn plan(args: &FarmArgs, desc: &SceneDesc) -> Result<Job, Failure> {
        let frames = &desc.animation.frames;
        let by = args.by.unwrap_or(match frames.len() {
            0..=1 => By::Samples,
            _ => By::Frames,
        });
        let stem = text(Path::new(args.scene.file_stem().unwrap_or_default()))?;
        let out = absolute(&args.out)?;
        let number = if by == By::Frames { "_####" } else { "" };
        let suffix = match args.format {
            FormatArg::Png => "png",
            FormatArg::Exr => "exr",
        };
        let mut job = Job {
            name: name(&stem),
            title: stem.clone(),
            luxel: program(args)?,
            scene: absolute(&args.scene)?,
            image: format!("{out}/{stem}{number}.{suffix}"),
            out,
            shards: args.shards.unwrap_or(SHARDS),
            by,
            cpus: args.cpus,
            memory: args.memory >> 20,
            options: args.options.clone(),
        };
        let what = match job.first_task()? {
            Command::Animate(task) => {
                let scenes = || FrameList::of_range(frames.clone());
                let frames = task.frames.unwrap_or_else(scenes);
                job.shards = job.shards.min(frames.len());
                frames.to_string()
            }
            Command::Render(task) => {
                let tuned = Tuned::read(&task)?;
                let task = tuned.as_ref().map_or(&*task, |tuned| &tuned.args);
                job.shards = shares(task, desc, job.shards)?;
                format!("{} samples of a still", spp(task, desc))
            }
            _ => String::new(),
        };
        job.title = format!("{stem}, {what}, in {} tasks", job.shards);
        Ok(job)
    }

    /// The line of a task, but for `--shard` and which one.
    pub(super) fn task(&self, progress: &str) -> Vec<String> {
        let keep: &[&str] = match self.by {
            By::Frames => &[],
            By::Samples => &["--checkpoint", CHECKPOINT],
        };
        let line = [&self.line(), keep, &["--progress", progress]].concat();
        self.with_options(line)
    }

    /// The line of the last task.
    pub(super) fn last(&self) -> Vec<String> {
        if self.by == By::Frames {
            return self.with_options(self.line());
        }
        let share = |i| format!("{}.{i}-of-{}.part", self.image, self.shards);
        let shares = (0..self.shards).map(share);
        let to = ["-o".to_owned(), self.image.clone()];
        let merge = [self.luxel.clone(), "merge".to_owned()];
        merge.into_iter().chain(shares).chain(to).collect()
    }

    fn line(&self) -> Vec<&str> {
        let command = match self.by {
            By::Frames => "animate",
            By::Samples => "render",
        };
        vec![&self.luxel, command, &self.scene, "-o", &self.image]
    }

    fn with_options(&self, line: Vec<&str>) -> Vec<String> {
        let line = line.into_iter().map(str::to_owned);
        line.chain(self.options.iter().cloned()).collect()
    }

    /// Reads a task's line as the task will.
    fn first_task(&self) -> Result<Command, Failure> {
        let mut line = self.task("plain");
        line.extend(["--shard".to_owned(), format!("0/{}", self.shards)]);
        match Cli::try_parse_from(line) {
            Ok(cli) => Ok(cli.command),
            Err(e) => {
                let told = e.to_string();
                let told = told.lines().next().unwrap_or_default();
                Err(Failure::usage(
                    format!(
                        "tasks would be refused: {}",
                        told.trim_start_matches("error: ")
                    ),
                    "behind -- stand options of `luxel animate` (frames) or `luxel render` (samples)",
                ))
            }
        }
    }
}

/// Samples per pixel that a render has in the end.
fn spp(task: &RenderArgs, desc: &SceneDesc) -> u32 {
    task.spp.unwrap_or(desc.render.spp)
}

/// In how many shares a still is rendered: as many as are wanted, but none without a block of samples of its own.
fn shares(task: &RenderArgs, desc: &SceneDesc, wanted: u32) -> Result<u32, Failure> {
    if task.goal.noise.is_some() || task.time.is_some() {
        return Err(Failure::usage(
            "tasks share a known number of samples, which --noise and --time leave open",
            "give --spp N instead",
        ));
    }
    let spp = spp(task, desc);
    let shares = match task.parts.shard_by {
        Some(ShardBy::Tiles) => wanted,
        _ => wanted.min(spp.div_ceil(Blocks::LENGTH)),
    };
    let settings = task.dials.settings(desc, Some(spp));
    share::of_all((0, shares), task.parts.shard_by, &settings)?;
    Ok(shares)
}

/// What tasks run: this luxel, if nobody says; in a container that of its path.
fn program(args: &FarmArgs) -> Result<String, Failure> {
    match (&args.luxel, args.scheduler) {
        (Some(path), _) => text(path),
        (None, Scheduler::K8s) => Ok("luxel".to_owned()),
        (None, _) => {
            let this = std::env::current_exe();
            text(&this.map_err(|e| Failure::io("the path of luxel", &e))?)
        }
    }
}

/// The path as every folder sees it.
pub(super) fn absolute(path: &Path) -> Result<String, Failure> {
    let path = std::path::absolute(path)
        .map_err(|e| Failure::io(format!("\"{}\"", path.display()), &e))?;
    text(&path)
}

/// A path as text that a script can hold.
fn text(path: &Path) -> Result<String, Failure> {
    let text = path.to_str().filter(|it| !it.contains(char::is_control));
    text.map(str::to_owned).ok_or_else(|| {
        Failure::usage(
            format!("{path:?} cannot stand in a script"),
            "give it a name in UTF-8 without control characters",
        )
    })
}

/// A name that every scheduler takes.
fn name(stem: &str) -> String {
    let plain = |c: char| match c {
        c if c.is_ascii_alphanumeric() => c.to_ascii_lowercase(),
        _ => '-',
    };
    let plain: String = stem.chars().take(40).map(plain).collect();
    format!("luxel-{plain}").trim_matches('-').to_owned()
}

/// Makes a folder and becomes the command: for those who start tasks without a script around them.
pub(super) fn in_folder(folder: &str, command: Vec<String>) -> Vec<String> {
    let shell = ["sh", "-c", r#"mkdir -p "$0" && exec "$@""#, folder];
    let shell = shell.into_iter().map(str::to_owned);
    shell.chain(command).collect()
}

/// A command as a shell reads it.
pub(super) fn shell(words: &[String]) -> Result<String, Failure> {
    let words = words.iter().map(String::as_str);
    shlex::try_join(words).map_err(|e| Failure::usage(e, "leave the null character out"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_suit_every_scheduler() {
        assert_eq!(name("Room_2"), "luxel-room-2");
        assert_eq!(name("_"), "luxel");
        assert_eq!(name("\u{e9}lan"), "luxel--lan");
    }
}
