//! Paths of files as a scene in a folder names them.

use std::path::{Component, Path, PathBuf};

/// A file cannot be named by a scene.
#[derive(Debug, thiserror::Error)]
pub enum PathError {
    /// Its path is not Unicode, and scenes are text.
    #[error("\"{}\" cannot be written in a scene: it is not Unicode", .0.display())]
    NotText(PathBuf),
    /// It is not there, or the folder of the scene is not.
    #[error("\"{}\": {source}", .path.display())]
    Missing {
        /// Which.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
}

/// The path of an existing `file` relative to the folder of `scene`, which need not exist itself. Links of folders are
/// followed first, as the system will follow them; a link that is the file itself keeps its name, since what the file
/// names lies beside the link.
///
/// # Errors
/// [`PathError`].
pub fn path_from(scene: &Path, file: &Path) -> Result<String, PathError> {
    let missing = |source| PathError::Missing {
        path: file.to_owned(),
        source,
    };
    let name = file
        .file_name()
        .ok_or_else(|| missing(std::io::ErrorKind::NotFound.into()))?;
    file.metadata().map_err(missing)?;
    let path = relative(&folder_of(scene)?, &folder_of(file)?.join(name));
    match path.to_str() {
        // The format wants `/` on every system.
        Some(text) => Ok(text.replace(std::path::MAIN_SEPARATOR, "/")),
        None => Err(PathError::NotText(file.to_owned())),
    }
}

/// The folder that a file is in, from the root and without links.
fn folder_of(file: &Path) -> Result<PathBuf, PathError> {
    let folder = match file.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    folder.canonicalize().map_err(|source| PathError::Missing {
        path: folder.to_owned(),
        source,
    })
}

/// The way from a folder to a file, both absolute and without `.`, `..` or links.
fn relative(folder: &Path, file: &Path) -> PathBuf {
    let (from, to): (Vec<_>, Vec<_>) = (folder.components().collect(), file.components().collect());
    let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    if common == 0 {
        // Another drive.
        return file.to_owned();
    }
    let up = std::iter::repeat_n(Component::ParentDir, from.len() - common);
    up.chain(to.into_iter().skip(common)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_lead_up_and_down() {
        let of = |a: &str, b: &str| relative(Path::new(a), Path::new(b));
        assert_eq!(of("/a/b", "/a/b/c.obj"), Path::new("c.obj"));
        assert_eq!(of("/a/b", "/a/c/d.obj"), Path::new("../c/d.obj"));
        assert_eq!(of("/a/b", "/d.obj"), Path::new("../../d.obj"));
        assert_eq!(of("/", "/x/d.obj"), Path::new("x/d.obj"));
        assert_eq!(of("/a/bc", "/a/b/d.obj"), Path::new("../b/d.obj"));
    }

    #[test]
    fn real_files_are_found_again() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let cat = root.join("assets/cat.obj");
        for scene in [
            "x.ron",
            "scenes/x.ron",
            "src/scene/x.ron",
            "src/../scenes/x.ron",
        ] {
            let scene = root.join(scene);
            let path = path_from(&scene, &cat).expect("both exist");
            let found = scene.with_file_name(&path);
            assert!(
                !path.starts_with('/') && found.is_file(),
                "{scene:?}: {path}"
            );
        }
        assert!(path_from(&root.join("no/such/x.ron"), &cat).is_err());
        assert!(path_from(&root.join("x.ron"), &root.join("assets/dog.obj")).is_err());
    }
}
