//! Which file is being read, for another thread to tell of: reading itself never looks at a clock.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The file that a [`super::Loader`] reads at the moment.
#[derive(Debug, Default)]
pub struct Reading(Mutex<Option<(PathBuf, u64)>>);

impl Reading {
    /// The last file that was begun, and its size in bytes.
    #[must_use]
    pub fn file(&self) -> Option<(PathBuf, u64)> {
        self.0
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }

    pub(super) fn begin(&self, path: &Path, bytes: u64) {
        let file = Some((path.to_owned(), bytes));
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = file;
    }
}
