//! `--vs` of `luxel render`: how the error falls, pass by pass.

use super::compare::{read, refused};
use super::failure::Failure;
use super::output::{Output, check_writable};
use crate::film::{self, Film};
use crate::measure::{Image, Pair, PairError, Selection, fall::Fall};
use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The error so far, and where it goes.
pub(crate) struct Versus {
    fall: Fall,
    csv: PathBuf,
    svg: PathBuf,
    failed: Option<PairError>,
}

impl Versus {
    /// Reads the reference; refuses now what cannot be compared or written later.
    pub(crate) fn start(
        reference: &Path,
        output: &Output,
        size: (u32, u32),
    ) -> Result<Versus, Failure> {
        let Some(path) = &output.path else {
            return Err(Failure::usage(
                "--vs writes NAME.error.csv and NAME.error.svg beside the image, and stdout has no name",
                "name the image: -o FILE",
            ));
        };
        let (csv, svg) = (
            path.with_extension("error.csv"),
            path.with_extension("error.svg"),
        );
        check_writable(&csv)?;
        check_writable(&svg)?;
        let image = read(reference)?;
        let (width, height) = (size.0 as usize, size.1 as usize);
        let found = (image.width(), image.height());
        if found != (width, height) {
            return Err(refused(&PairError::Sizes((width, height), found)));
        }
        Pair::new(&image, &image, Selection::All).map_err(|e| refused(&e))?;
        Ok(Versus {
            fall: Fall::new(image),
            csv,
            svg,
            failed: None,
        })
    }

    /// Measures the image after a pass.
    pub(crate) fn look(&mut self, film: &Film, spp: u32, time: Duration) {
        let said = film.error().map(|bar| (bar.relative, bar.half_width));
        let Some(image) = Image::new(film.width() as usize, film.radiance()) else {
            return;
        };
        if let Err(e) = self.fall.add(&image, spp, time, said) {
            self.failed = Some(e);
        }
    }

    /// Writes both files; gives their names.
    pub(crate) fn finish(self, title: &str) -> Result<String, Failure> {
        if let Some(e) = &self.failed {
            return Err(refused(e));
        }
        let write = |path: &Path, text: &str| {
            let io = |e: &dyn Display| Failure::io(format!("\"{}\"", path.display()), e);
            film::write_file(path, text.as_bytes()).map_err(|e| io(&e))
        };
        write(&self.csv, &self.fall.csv())?;
        write(&self.svg, &self.fall.svg(title))?;
        Ok(format!("{}\n{}\n", self.csv.display(), self.svg.display()))
    }
}
