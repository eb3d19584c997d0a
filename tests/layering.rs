//! The one-way edges between modules, read from the source: in one crate the compiler cannot enforce them.
//!
//! Also: no function whose bits depend on the machine's libm anywhere in `src/`.

use std::fs;
use std::path::{Path, PathBuf};

/// Module, the modules it may name, the external crates it may name. `std` is everyone's.
type Rule = (
    &'static str,
    &'static [&'static str],
    &'static [&'static str],
);

const RULES: &[Rule] = &[
    ("math", &[], &["glam", "libc"]),
    ("diag", &[], &[]),
    ("flat", &["math"], &["glam"]),
    ("scene", &["diag"], &["ron", "serde", "strsim", "thiserror"]),
    (
        "asset",
        &["diag", "math"],
        &[
            "exr",
            "gltf",
            "image",
            "memchr",
            "rayon",
            "serde_json",
            "sha2",
            "strsim",
            "thiserror",
            "tobj",
        ],
    ),
    (
        "world",
        &["scene", "asset", "diag", "math"],
        &["glam", "hecs", "strsim"],
    ),
    (
        "check",
        &["scene", "asset", "world", "diag", "math"],
        &["hecs"],
    ),
    ("author", &["scene", "asset", "math"], &["thiserror"]),
    (
        "build",
        &["world", "asset", "flat", "math"],
        &["glam", "hecs", "rayon"],
    ),
    ("trace", &["flat", "math"], &["glam"]),
    (
        "film",
        &["math"],
        &["crc32fast", "exr", "gif", "libc", "png", "thiserror"],
    ),
    (
        "render",
        &[
            "world", "build", "flat", "trace", "film", "scene", "asset", "math",
        ],
        &["hecs", "rayon", "sha2"],
    ),
    (
        "measure",
        &[
            "render", "world", "build", "trace", "flat", "film", "scene", "asset", "math",
        ],
        &["exr", "hecs", "nix", "png", "thiserror"],
    ),
    (
        "cli",
        &[
            "asset", "author", "build", "check", "diag", "film", "flat", "math", "measure",
            "render", "scene", "trace", "world",
        ],
        &[
            "annotate_snippets",
            "clap",
            "ctrlc",
            "hecs",
            "indicatif",
            // The number of its threads alone.
            "rayon",
            "serde_json",
            "shlex",
            "strsim",
        ],
    ),
    // The root documents and lists modules; the generator of assets stands on its own.
    ("lib", &[], &[]),
    ("main", &["cli"], &[]),
    ("bin", &[], &[]),
];

/// Every crate of `[dependencies]`, as paths name it.
const CRATES: &[&str] = &[
    "annotate_snippets",
    "clap",
    "crc32fast",
    "ctrlc",
    "exr",
    "gif",
    "glam",
    "gltf",
    "hecs",
    "image",
    "indicatif",
    "libc",
    "memchr",
    "nix",
    "png",
    "rayon",
    "ron",
    "serde",
    "serde_json",
    "sha2",
    "shlex",
    "strsim",
    "thiserror",
    "tobj",
];

/// Methods and constructors that call the machine's libm, or glam's, which do.
const FORBIDDEN: &[&str] = &[
    ".sin()",
    ".cos()",
    ".tan()",
    ".sin_cos()",
    ".asin()",
    ".acos()",
    ".atan()",
    ".atan2(",
    ".sinh()",
    ".cosh()",
    ".tanh()",
    ".exp()",
    ".exp2()",
    ".exp_m1()",
    ".ln()",
    ".ln_1p()",
    ".log(",
    ".log2()",
    ".log10()",
    ".powf(",
    ".powi(",
    ".cbrt()",
    ".hypot(",
    "from_rotation_",
    "from_axis_angle",
    "from_euler",
    "from_scaled_axis",
    "look_at_rh",
    "look_at_lh",
    "look_to_",
    "perspective_",
    ".slerp(",
    ".angle_between(",
];

/// A source file without comments, strings, and everything from `#[cfg(test)]` on.
struct Source {
    path: PathBuf,
    code: String,
}

impl Source {
    fn read(path: &Path) -> Source {
        let text = fs::read_to_string(path).expect("a source file");
        Source {
            path: path.to_owned(),
            code: strip(&text),
        }
    }

    /// The module: the first part of the path below `src/`.
    fn module(&self) -> String {
        let below = self.path.strip_prefix("src").expect("below src");
        let first = below.iter().next().expect("a name").to_string_lossy();
        first.trim_end_matches(".rs").to_owned()
    }
}

/// Blanks comments and string literals, keeps lines, and ends at the tests: by convention the last item of a file.
fn strip(text: &str) -> String {
    let text = text.split("#[cfg(test)]\nmod ").next().unwrap_or("");
    let mut code = String::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let skip = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |i| i + 2)
        } else if let Some(raw) = rest.strip_prefix("r#\"") {
            raw.find("\"#").map_or(rest.len(), |i| i + 5)
        } else if c == '"' {
            string_end(rest)
        } else if rest.starts_with("'\"'") || rest.starts_with("'\\\"'") {
            rest[1..].find('\'').map_or(rest.len(), |i| i + 2)
        } else {
            code.push(c);
            rest = &rest[c.len_utf8()..];
            continue;
        };
        code.extend(rest[..skip].chars().filter(|&c| c == '\n'));
        rest = &rest[skip..];
    }
    code
}

/// Length of the string literal that `text` begins with.
fn string_end(text: &str) -> usize {
    let mut escaped = false;
    for (i, c) in text.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return i + 1,
            _ => {}
        }
    }
    text.len()
}

/// The first names of all paths that begin with `root::`, those in braces included.
fn names_after(code: &str, root: &str) -> Vec<String> {
    let head = |s: &str| -> String {
        let s = s.trim_start();
        let end = s.find(|c: char| !(c.is_alphanumeric() || c == '_'));
        s[..end.unwrap_or(s.len())].to_owned()
    };
    let mut names = Vec::new();
    for (at, _) in code.match_indices(root) {
        if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':') {
            continue;
        }
        let rest = code[at + root.len()..].trim_start();
        match rest.strip_prefix('{') {
            None => names.push(head(rest)),
            Some(list) => {
                let mut depth = 0;
                let item = list.split(|c: char| {
                    match c {
                        '{' => depth += 1,
                        '}' => depth -= 1,
                        _ => {}
                    }
                    depth < 0 || (depth == 0 && c == ',')
                });
                let end = list_length(list);
                let mut taken = 0;
                for part in item {
                    if taken >= end {
                        break;
                    }
                    taken += part.len() + 1;
                    names.push(head(part));
                }
            }
        }
    }
    names.retain(|name| !name.is_empty());
    names
}

/// Length of a list up to the brace that closes it.
fn list_length(list: &str) -> usize {
    let mut depth = 1;
    for (i, c) in list.char_indices() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        if depth == 0 {
            return i;
        }
    }
    list.len()
}

/// External crates whose name begins a path or an attribute's derive. `self::png` and `crate::png` are modules.
fn crates_named(code: &str) -> Vec<&'static str> {
    let names = |name: &&&str| {
        let path = format!("{name}::");
        code.match_indices(&path).any(|(at, _)| {
            let before = code[..at].trim_end_matches("::");
            let rooted = before.len() < at;
            let last = before.chars().next_back().unwrap_or(' ');
            let continues = last.is_alphanumeric() || last == '_';
            // `::png::` is the crate, `self::png::` is not; `my_png::` is not either.
            !continues && (rooted || !code[..at].ends_with(':'))
        })
    };
    CRATES.iter().filter(names).copied().collect()
}

/// Edges of a file that its module's rule does not allow.
fn broken_edges(source: &Source) -> Vec<String> {
    let module = source.module();
    let place = source.path.display();
    let Some((_, modules, crates)) = RULES.iter().find(|rule| rule.0 == module) else {
        return vec![format!("{place}: the module {module} is in no rule")];
    };
    let root = match module.as_str() {
        "main" => "luxel::",
        _ => "crate::",
    };
    let internal = names_after(&source.code, root)
        .into_iter()
        .filter(|name| RULES.iter().any(|rule| rule.0 == name))
        .filter(|name| *name != module && !modules.contains(&name.as_str()));
    let own: Vec<String> = own_modules(&source.path);
    let external = crates_named(&source.code)
        .into_iter()
        .filter(|_| module != "bin")
        .filter(|name| !crates.contains(name) && !own.contains(&(*name).to_owned()))
        .map(str::to_owned);
    internal
        .chain(external)
        .map(|name| format!("{place}: {module} may not name {name}"))
        .collect()
}

/// Modules beside a file: `image::` may be one of them.
fn own_modules(path: &Path) -> Vec<String> {
    let folder = path.parent().map(files).unwrap_or_default();
    let stem = |p: &PathBuf| Some(p.file_stem()?.to_string_lossy().into_owned());
    folder.iter().filter_map(stem).collect()
}

/// All Rust files below a folder, sorted.
fn files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    let below = |path: PathBuf| match path.is_dir() {
        true => files(&path),
        false => vec![path],
    };
    let mut all: Vec<PathBuf> = paths.into_iter().flat_map(below).collect();
    all.retain(|path| path.extension().is_some_and(|e| e == "rs"));
    all
}

/// Files of tests alone, by their names; they stand behind `#[cfg(test)] mod`.
fn is_test(path: &Path) -> bool {
    path.iter()
        .any(|part| part == "tests" || part == "tests.rs" || part == "test_support.rs")
}

fn sources() -> Vec<Source> {
    let all: Vec<Source> = files(Path::new("src"))
        .iter()
        .filter(|path| !is_test(path))
        .map(|path| Source::read(path))
        .collect();
    assert!(all.len() > 20, "only {} sources were found", all.len());
    all
}

#[test]
fn every_edge_is_allowed() {
    let broken: Vec<String> = sources().iter().flat_map(broken_edges).collect();
    assert!(broken.is_empty(), "\n{}", broken.join("\n"));
}

/// Calls of a file whose bits depend on the machine.
fn libm_calls(source: &Source) -> Vec<String> {
    let place = source.path.display();
    let lines = source.code.lines().enumerate();
    lines
        .flat_map(|(i, line)| {
            let words = FORBIDDEN.iter().filter(|word| line.contains(**word));
            words.map(move |word| (i + 1, *word))
        })
        .map(|(line, word)| format!("{place}:{line}: {word}"))
        .collect()
}

#[test]
fn no_result_depends_on_libm() {
    let found: Vec<String> = sources().iter().flat_map(libm_calls).collect();
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn planted_calls_of_libm_are_caught() {
    let calls = |text: &str| {
        libm_calls(&Source {
            path: "src/trace/x.rs".into(),
            code: strip(text),
        })
    };
    let planted = "fn f(x: f32) -> f32 {\n    x.sin() + Quat::from_rotation_y(x).w\n}";
    let places = calls(planted);
    assert_eq!(places.len(), 2, "{places:?}");
    assert!(places[0].starts_with("src/trace/x.rs:2:"), "{places:?}");
    assert!(calls("// x.sin()\nlet y = x.sqrt() + math::sin(x);").is_empty());
    assert!(calls("#[cfg(test)]\nmod tests { fn f() { 1f64.exp(); } }").is_empty());
}

#[test]
fn planted_edges_are_caught() {
    let broken = |path: &str, text: &str| {
        broken_edges(&Source {
            path: path.into(),
            code: strip(text),
        })
        .len()
    };
    assert_eq!(broken("src/trace/x.rs", "use crate::flat::FlatScene;"), 0);
    assert_eq!(broken("src/trace/x.rs", "use crate::scene::SceneDesc;"), 1);
    assert_eq!(broken("src/trace/x.rs", "use crate::{flat, world};"), 1);
    assert_eq!(
        broken(
            "src/trace/x.rs",
            "use crate::{flat::{A, B}, film::C, math};"
        ),
        1
    );
    assert_eq!(broken("src/trace/x.rs", "use hecs::World;"), 1);
    assert_eq!(
        broken("src/flat/x.rs", "fn f() { ::rayon::join(a, b); }"),
        1
    );
    assert_eq!(
        broken("src/scene/x.rs", "fn f() -> crate::math::Vec3 {}"),
        1
    );
    assert_eq!(broken("src/film/x.rs", "use ::png::Encoder;"), 0);
    assert_eq!(broken("src/film/x.rs", "use crate::film::png::encode;"), 0);
    assert_eq!(broken("src/trace/x.rs", "// use crate::scene\n"), 0);
    assert_eq!(broken("src/trace/x.rs", "let a = \"crate::scene::X\";"), 0);
    let tests = "#[cfg(test)]\nmod tests { use crate::scene::X; }";
    assert_eq!(broken("src/trace/x.rs", tests), 0);
    assert_eq!(broken("src/nobody/x.rs", ""), 1);
    assert_eq!(
        broken("src/cli/x.rs", "use crate::render::X; use tobj::Y;"),
        1
    );
}

#[test]
fn the_list_of_crates_is_the_manifest() {
    let manifest = fs::read_to_string("Cargo.toml").expect("the manifest");
    let dependencies = manifest
        .split("[dependencies]\n")
        .nth(1)
        .and_then(|rest| rest.split("\n[").next())
        .expect("dependencies");
    let listed: Vec<String> = dependencies
        .lines()
        .filter_map(|line| Some(line.split_once(" = ")?.0.replace('-', "_")))
        .collect();
    assert_eq!(listed, CRATES);
}
