//! A planted bug: what its patch file says, and its diff, applied by content.

use std::path::Path;

/// A bug as its file has it.
pub(crate) struct Patch {
    /// The file's name without its suffix.
    pub(crate) name: String,
    /// What it breaks.
    pub(crate) says: String,
    /// Where.
    pub(crate) layer: String,
    /// Test binary (`lib` for the tests in the sources) and part of the names of tests, in the order of the file.
    tests: Vec<(String, String)>,
    hunks: Vec<Hunk>,
}

/// Lines that stand in a file, and what takes their place.
struct Hunk {
    file: String,
    old: String,
    new: String,
}

impl Patch {
    /// Reads a patch file: the sentence, `layer:`, one `test:` a line, and a unified diff.
    ///
    /// # Errors
    /// What is missing or cannot be understood, with the file.
    pub(crate) fn read(path: &Path) -> Result<Patch, String> {
        let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let mut patch = Patch {
            name: name.into_owned(),
            says: String::new(),
            layer: String::new(),
            tests: Vec::new(),
            hunks: Vec::new(),
        };
        let mut file = None;
        for line in text.lines() {
            let error = |what: &str| format!("{}: {what}: {line}", path.display());
            if let Some(name) = line.strip_prefix("+++ b/") {
                file = Some(name.to_owned());
            } else if line.starts_with("--- a/") {
                file = None;
            } else if line.starts_with("@@ ") {
                let file = file.clone().ok_or_else(|| error("a hunk of no file"))?;
                let [old, new] = [(); 2].map(|()| String::new());
                patch.hunks.push(Hunk { file, old, new });
            } else if let Some(hunk) = patch.hunks.last_mut() {
                hunk.line(line).ok_or_else(|| error("no line of a diff"))?;
            } else if let Some(layer) = line.strip_prefix("layer: ") {
                layer.clone_into(&mut patch.layer);
            } else if let Some(test) = line.strip_prefix("test: ") {
                let (target, filter) = test.split_once(' ').ok_or_else(|| error("no test"))?;
                patch.tests.push((target.to_owned(), filter.to_owned()));
            } else if patch.says.is_empty() {
                line.trim_end_matches('.').clone_into(&mut patch.says);
            }
        }
        let empty = patch.says.is_empty() || patch.layer.is_empty() || patch.tests.is_empty();
        if empty || patch.hunks.is_empty() {
            let needs = "a sentence, `layer: `, `test: ` and a unified diff";
            return Err(format!("{} needs {needs}", path.display()));
        }
        Ok(patch)
    }

    /// The test binaries that should see it, each once.
    pub(crate) fn targets(&self) -> Vec<&str> {
        let mut targets: Vec<&str> = Vec::new();
        for (target, _) in &self.tests {
            if !targets.contains(&target.as_str()) {
                targets.push(target);
            }
        }
        targets
    }

    /// What the names of those tests hold that should see it, of one binary.
    pub(crate) fn filters(&self, target: &str) -> Vec<&str> {
        let own = self.tests.iter().filter(|(t, _)| t == target);
        own.map(|(_, filter)| filter.as_str()).collect()
    }

    /// The files of a tree with the bug in them. Hunks are found by their lines, whatever their numbers.
    ///
    /// # Errors
    /// Lines that are not there, or more than once, with the remedy.
    pub(crate) fn planted(&self, root: &Path) -> Result<Vec<(String, String)>, String> {
        let mut files: Vec<(String, String)> = Vec::new();
        for Hunk { file, old, new } in &self.hunks {
            let error = |what: &str, remedy: &str| {
                format!(
                    "tests/mutants/{}.patch: {file} {what} these lines; {remedy}:\n{old}",
                    self.name
                )
            };
            if !files.iter().any(|(known, _)| known == file) {
                let text = std::fs::read_to_string(root.join(file))
                    .map_err(|e| error(&format!("({e}) has none of"), "move the bug"))?;
                files.push((file.clone(), text));
            }
            let Some((_, text)) = files.iter_mut().find(|(known, _)| known == file) else {
                continue;
            };
            let mut places = text.match_indices(old.as_str()).map(|(at, _)| at);
            let whole_lines = |at: &usize| *at == 0 || text.as_bytes()[at - 1] == b'\n';
            let found: Vec<usize> = places.by_ref().filter(whole_lines).collect();
            match found[..] {
                [at] => text.replace_range(at..at + old.len(), new),
                [] => {
                    let remedy = "the code has changed: plant the same bug in it, by hand";
                    return Err(error("no longer has", remedy));
                }
                _ => return Err(error("has more than once", "give more lines around them")),
            }
        }
        Ok(files)
    }
}

impl Hunk {
    /// Takes a line of a diff; nothing if it is none.
    fn line(&mut self, line: &str) -> Option<()> {
        let (sign, rest) = match line.chars().next() {
            None => (' ', ""),
            Some(sign) => (sign, &line[sign.len_utf8()..]),
        };
        let sides = match sign {
            ' ' => [Some(&mut self.old), Some(&mut self.new)],
            '-' => [Some(&mut self.old), None],
            '+' => [None, Some(&mut self.new)],
            _ => return None,
        };
        for side in sides.into_iter().flatten() {
            side.push_str(rest);
            side.push('\n');
        }
        Some(())
    }
}
