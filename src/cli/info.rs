//! `luxel info`: what an image or a part film is, and the line that makes it again.

use super::failure::Failure;
use super::merge::{aovs_of, image_metadata, open};
use super::merge_args::InfoArgs;
use super::part::{OWN, image_of};
use super::print_result;
use crate::film::part::{MAGIC, PartFile};
use crate::film::{self, Aov, Metadata, Stored};
use serde_json::{Map, Value, json};
use std::fs;
use std::path::Path;

/// Prints what the file says.
pub(crate) fn run(args: &InfoArgs) -> Result<(), Failure> {
    let path = args.file.as_path();
    let found = match Kind::of(path)? {
        Kind::Part => of_part(path, &open(path)?),
        Kind::Image(stored) => of_image(path, &stored),
    };
    let text = match args.json {
        true => format!("{:#}\n", found.json(path)),
        false => found.text(path),
    };
    print_result(text.as_bytes())
}

enum Kind {
    Part,
    Image(Stored),
}

impl Kind {
    /// By how the file begins.
    fn of(path: &Path) -> Result<Kind, Failure> {
        use std::io::Read;
        let mut start = Vec::new();
        let file = fs::File::open(path).map_err(|e| Failure::no_input(path, &e))?;
        file.take(8)
            .read_to_end(&mut start)
            .map_err(|e| Failure::no_input(path, &e))?;
        if start.starts_with(&MAGIC.as_bytes()[..8]) {
            return Ok(Kind::Part);
        }
        let whole = || fs::read(path).map_err(|e| Failure::no_input(path, &e));
        let stored = match start.as_slice() {
            [0x89, b'P', b'N', b'G', ..] => film::decode_png(&whole()?),
            [0x76, 0x2f, 0x31, 0x01, ..] => film::decode_exr(&whole()?, 1.0),
            _ => {
                return Err(Failure::bad_file(format!(
                    "\"{}\" is neither an image nor a part film of luxel",
                    path.display()
                )));
            }
        };
        let bad = |e| Failure::bad_file(format!("\"{}\": {e}", path.display()));
        let stored = stored.map_err(bad)?;
        match stored.metadata.value("scene") {
            Some(_) => Ok(Kind::Image(stored)),
            None => Err(bad(film::DecodeError {
                format: "PNG",
                reason: "it does not say what made it".to_owned(),
            })),
        }
    }
}

/// What there is to tell.
struct Found {
    kind: &'static str,
    metadata: Metadata,
    command: String,
    progress: Option<Held>,
}

/// How far a part is.
struct Held {
    /// Samples of its pixels together.
    held: u64,
    of: u64,
    /// Of one pixel: up to where all have them, and some.
    done: [u32; 2],
}

fn of_image(path: &Path, stored: &Stored) -> Found {
    let layers = stored
        .channels
        .iter()
        .filter_map(|name| name.split_once('.'));
    let layers: Vec<&str> = layers.map(|(layer, _)| layer).collect();
    let has = |aov: &Aov| layers.contains(&aov.name());
    let aovs: Vec<Aov> = Aov::ALL.into_iter().filter(has).collect();
    Found {
        kind: "image",
        command: command(&stored.metadata, &aovs, &path.display().to_string(), ""),
        metadata: stored.metadata.clone(),
        progress: None,
    }
}

fn of_part(path: &Path, file: &PartFile) -> Found {
    let header = &file.header;
    let spp = header.value("spp").and_then(|spp| spp.parse().ok());
    let spp: u32 = spp.unwrap_or(0);
    let ends = header
        .value("part.samples")
        .and_then(|s| s.split_once(".."));
    let end = ends.and_then(|(_, end)| end.parse().ok()).unwrap_or(spp);
    let mut held = Held {
        held: 0,
        of: 0,
        done: [u32::MAX, 0],
    };
    let mut all = 0;
    for entry in &file.entries {
        let pixels = u64::from(entry.window.width) * u64::from(entry.window.height);
        all += pixels;
        held.held += pixels * u64::from(entry.done.saturating_sub(entry.first));
        held.of += pixels * u64::from(end.saturating_sub(entry.first));
        held.done = [held.done[0].min(entry.done), held.done[1].max(entry.done)];
    }
    // Where cells have numbers of their own, the mean was rounded.
    if header.value("error").is_some() && (held.held + all / 2) / all.max(1) == u64::from(spp) {
        held.of = held.held;
    }
    let image = image_of(path).unwrap_or_else(|| "OUTPUT".into());
    let value = |key| header.value(key);
    let share = match (
        value("part.shard"),
        value("part.tiles"),
        value("part.samples"),
    ) {
        (Some(shard), ..) => format!(" --shard {shard}"),
        (_, Some(shard), _) => format!(" --shard {shard} --shard-by tiles"),
        (.., Some(samples)) => format!(" --samples-range {samples}"),
        _ => " --checkpoint 60s".to_owned(),
    };
    let aovs = aovs_of(header).unwrap_or_default();
    let mut of_line = image_metadata(header);
    of_line.push("exposure", header.value("part.exposure").unwrap_or("0"));
    Found {
        kind: "part",
        command: command(&of_line, &aovs, &image.display().to_string(), &share),
        metadata: header.clone(),
        progress: Some(held),
    }
}

/// The line that renders it, with SCENE for the file, which nobody wrote down.
fn command(metadata: &Metadata, aovs: &[Aov], output: &str, share: &str) -> String {
    let mut line = "luxel render SCENE".to_owned();
    // `0.01`, or `0.01 or 500 spp`: what was asked for, in place of the samples that came of it.
    let error = metadata.value("error");
    if let Some(error) = error {
        line += " --noise ";
        line += &error.replace(" or ", " --spp ").replace(" spp", "");
    }
    // What stands in a scene is not assumed to be the scene's; defaults of luxel are.
    for (key, flag, default) in [
        ("frame", "--frame", "0"),
        ("size", "--size", ""),
        ("spp", "--spp", ""),
        ("adaptive", "--adaptive", "on"),
        ("bounces", "--bounces", ""),
        ("seed", "--seed", "0"),
        ("sampler", "--sampler", "sobol"),
        ("nee", "--nee", "on"),
        ("mis", "--mis", "on"),
        ("caustics", "--caustics", "off"),
        ("roulette", "--roulette", "on"),
        ("fresnel", "--fresnel", "exact"),
        ("exposure", "--exposure", "0"),
    ] {
        match metadata.value(key) {
            Some(_) if key == "spp" && error.is_some() => {}
            Some(value) if value != default => line += &format!(" {flag} {value}"),
            _ => {}
        }
    }
    if metadata.value("noise") == Some("fixed") {
        line += " --fixed-noise";
    }
    if !aovs.is_empty() {
        let names: Vec<&str> = aovs.iter().map(|aov| aov.name()).collect();
        line += &format!(" --aov {}", names.join(","));
    }
    line + share + " -o " + &quoted(output)
}

/// A word for a shell.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._-#+,:=@%".contains(c);
    match !word.is_empty() && word.chars().all(plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}

impl Found {
    fn text(&self, path: &Path) -> String {
        let mut text = match &self.progress {
            None => format!("{}: an image of luxel\n", path.display()),
            Some(held) if held.held == held.of => {
                format!("{}: a part film of luxel, finished\n", path.display())
            }
            Some(held) => format!(
                "{}: a part film of luxel, {:.1} % of its samples\n",
                path.display(),
                100.0 * held.held as f64 / held.of.max(1) as f64
            ),
        };
        for (key, value) in self.metadata.entries() {
            let key = key.strip_prefix(OWN).unwrap_or(key);
            text += &format!("  {key:<10} {value}\n");
        }
        text + &format!("SCENE is the file whose hash is above:\n{}\n", self.command)
    }

    fn json(&self, path: &Path) -> Value {
        let entries = self.metadata.entries();
        let metadata: Map<String, Value> = entries
            .map(|(key, value)| (key.to_owned(), json!(value)))
            .collect();
        let mut found = json!({
            "file": path.display().to_string(),
            "kind": self.kind,
            "metadata": metadata,
            "command": self.command,
        });
        if let Some(held) = &self.progress {
            found["samples"] = json!({ "held": held.held, "of": held.of });
            found["done"] = json!(held.done);
            found["finished"] = json!(held.held == held.of);
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_know_their_image_by_name() {
        let of = |name: &str| image_of(Path::new(name));
        for name in ["a.exr.part", "a.exr.0-of-4.part", "a.exr.0..8.part"] {
            assert_eq!(of(name), Some("a.exr".into()), "{name}");
        }
        assert_eq!(of("d/x.y.png.part"), Some("d/x.y.png".into()));
        assert_eq!(of("a.exr"), None);
    }

    #[test]
    fn words_are_safe_in_a_shell() {
        assert_eq!(quoted("out/a-1.exr"), "out/a-1.exr");
        assert_eq!(quoted("it's $5.exr"), "'it'\\''s $5.exr'");
    }
}
