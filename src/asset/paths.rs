//! Paths that files name, and what a wrong one may have meant.

use super::text::without_comment;
use super::texture_line::unquote;
use std::path::{Path, PathBuf};

/// Bytes of the longest name that is compared with others: file systems have no longer ones.
const MAX_NAME: usize = 255;

/// Words of a `mtllib` line that are tried together as one name with spaces.
const MAX_WORDS_OF_NAME: usize = 8;

/// The files that a `mtllib` line names: of words that exist together as one name with spaces, the longest first.
pub(super) fn library_names(obj: &Path, names: &str) -> Vec<String> {
    if beside(obj, names).is_file() {
        return vec![names.to_owned()];
    }
    let words: Vec<&str> = names
        .split_whitespace()
        .take_while(|word| !word.starts_with('#'))
        .collect();
    let plain = without_comment(names);
    let alone = words.iter().any(|word| beside(obj, word).is_file());
    if !alone && same_name_beside(obj, plain).is_some() {
        return vec![plain.to_owned()];
    }
    let mut found = Vec::new();
    let mut at = 0;
    while at < words.len() {
        let longest = (at + 1..=words.len().min(at + MAX_WORDS_OF_NAME)).rev();
        let joined = |end: usize| words[at..end].join(" ");
        let end = longest
            .into_iter()
            .find(|&end| beside(obj, &joined(end)).is_file())
            .unwrap_or(at + 1);
        found.push(joined(end));
        at = end;
    }
    found
}

/// The file in the folder of `file` whose name is that of a path that `file` names.
pub(super) fn same_name_beside(file: &Path, name: &str) -> Option<PathBuf> {
    let found = file.with_file_name(beside(file, name).file_name()?);
    found.is_file().then_some(found)
}

/// A path that a file names, relative to that file; backslashes separate too.
pub(super) fn beside(file: &Path, name: &str) -> PathBuf {
    let name = unquote(name.trim()).replace('\\', "/");
    let path = file.parent().unwrap_or(Path::new("")).join(name);
    // Drops the `.` of `./name`.
    path.components().collect()
}

pub(super) fn canonical(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// The name of a file in the same folder that a missing file may have meant.
pub(super) fn similar_file(path: &Path) -> Option<String> {
    let name = path.file_name()?.to_str()?;
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let mut names: Vec<String> = std::fs::read_dir(folder.unwrap_or(Path::new(".")))
        .ok()?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    names.sort();
    most_similar(name, names.iter().map(String::as_str)).filter(|similar| similar != name)
}

/// The name nearest to a wrong one, if it is near: at most a third of the letters differ, or only their case. Nothing is
/// near to what is longer than any name.
pub(super) fn most_similar<'a>(
    wrong: &str,
    names: impl Iterator<Item = &'a str>,
) -> Option<String> {
    let most = wrong.chars().count() / 3;
    if wrong.len() > MAX_NAME {
        return None;
    }
    let near = |name: &&str| name.len() <= MAX_NAME;
    let distance =
        |name: &str| strsim::damerau_levenshtein(&wrong.to_lowercase(), &name.to_lowercase());
    let (distance, name) = names
        .filter(near)
        .map(|name| (distance(name), name))
        .min()?;
    (distance <= most).then(|| name.to_owned())
}
