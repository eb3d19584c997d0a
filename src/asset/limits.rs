//! What files may take: a budget of memory, charged before anything is allocated for what a file claims.

use super::codes;
use crate::diag::Diagnostic;
use std::path::Path;

/// What the files of a scene may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of all that files decode to, and of each file itself.
    pub memory: u64,
}

impl Limits {
    /// 4 GiB: some 40 million triangles with normals and texture coordinates, or 85 textures of 4096 × 4096.
    pub const DEFAULT: Limits = Limits { memory: 4 << 30 };
}

impl Default for Limits {
    fn default() -> Limits {
        Limits::DEFAULT
    }
}

/// The memory that is left of [`Limits`].
#[derive(Clone, Debug, Default)]
pub(super) struct Budget {
    limits: Limits,
    used: u64,
    /// What is in memory for as long as a file is read: its own bytes.
    held: u64,
}

impl Budget {
    pub(super) fn of(limits: Limits) -> Budget {
        Budget {
            limits,
            ..Budget::default()
        }
    }

    /// Takes `bytes` for `what`, a part of the file `path`.
    ///
    /// # Errors
    /// If they are not left: nothing is taken then.
    pub(super) fn charge(&mut self, bytes: u64, what: &str, path: &Path) -> Result<(), Diagnostic> {
        self.allow(bytes, what, path)?;
        self.used += bytes;
        Ok(())
    }

    /// Whether `bytes` are left for something that is gone again when the file is read.
    ///
    /// # Errors
    /// If they are not.
    pub(super) fn allow(&self, bytes: u64, what: &str, path: &Path) -> Result<(), Diagnostic> {
        let limit = self.limits.memory;
        let taken = self.used.saturating_add(self.held);
        if self.has(bytes) {
            return Ok(());
        }
        let before = match taken {
            0 => String::new(),
            used => format!(" besides the {} that files take already", size(used)),
        };
        let says = format!(
            "{what} takes {}{before}: the limit is {}",
            size(bytes),
            size(limit)
        );
        Err(Diagnostic::error(codes::OVER_BUDGET, says)
            .in_file(path)
            .hint(format!(
                "raise the limit if this is meant: `--max-memory {}`",
                enough(taken.saturating_add(bytes))
            )))
    }

    /// Whether `bytes` are left.
    pub(super) fn has(&self, bytes: u64) -> bool {
        let taken = self.used.saturating_add(self.held);
        taken.saturating_add(bytes) <= self.limits.memory
    }

    /// Gives back what was charged for something that came to nothing.
    pub(super) fn give_back(&mut self, bytes: u64) {
        self.used = self.used.saturating_sub(bytes);
    }

    /// Counts the bytes of a file that is being read, until [`Budget::let_go`].
    pub(super) fn hold(&mut self, bytes: u64) {
        self.held = self.held.saturating_add(bytes);
    }

    /// The bytes of the file are gone again.
    pub(super) fn let_go(&mut self, bytes: u64) {
        self.held = self.held.saturating_sub(bytes);
    }

    /// Bytes taken so far.
    pub(super) fn used(&self) -> u64 {
        self.used
    }
}

/// `512 B`, `1.5 MiB`, `4.0 GiB`, `12.9 TiB`: rounded up, so that what does not fit does not look as if it did.
fn size(bytes: u64) -> String {
    const UNITS: [&str; 5] = ["KiB", "MiB", "GiB", "TiB", "PiB"];
    if bytes < 1024 {
        return format!("{bytes} B");
    }
    let mut size = bytes as f64 / 1024.0;
    let mut unit = 0;
    while size >= 1024.0 && unit + 1 < UNITS.len() {
        size /= 1024.0;
        unit += 1;
    }
    format!("{:.1} {}", (size * 10.0).ceil() / 10.0, UNITS[unit])
}

/// The next power of two in the notation of `--max-memory`.
fn enough(bytes: u64) -> String {
    let power = bytes.checked_next_power_of_two().unwrap_or(u64::MAX);
    match power {
        0..0x4000_0000 => format!("{}M", (power >> 20).max(1)),
        _ => format!("{}G", power >> 30),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_refused_with_number_and_remedy() {
        let mut budget = Budget::default();
        let path = Path::new("big.png");
        assert_eq!(budget.charge(1 << 30, "the image", path), Ok(()));
        assert_eq!(budget.charge(3 << 30, "the image", path), Ok(()));
        let error = budget.charge(1, "the image", path).expect_err("an error");
        assert_eq!(error.code, "E111");
        assert_eq!(
            error.message,
            "the image takes 1 B besides the 4.0 GiB that files take already: the limit is 4.0 GiB"
        );
        assert_eq!(
            error.hint.as_deref(),
            Some("raise the limit if this is meant: `--max-memory 8G`")
        );
        assert_eq!(budget.used(), 4 << 30);
        budget.give_back(2 << 30);
        budget.hold(1 << 30);
        assert!(budget.allow((1 << 30) + 1, "the image", path).is_err());
        assert_eq!(budget.allow(1 << 30, "the image", path), Ok(()));
        budget.let_go(1 << 30);
        assert_eq!(budget.charge(2 << 30, "the image", path), Ok(()));
        for huge in [u64::MAX, u64::MAX - (4 << 30)] {
            assert!(budget.allow(huge, "the image", path).is_err());
        }
    }

    #[test]
    fn sizes_read_well() {
        let sizes = [1, 1536, (4 << 30) + 1, 900 << 40].map(size);
        assert_eq!(sizes, ["1 B", "1.5 KiB", "4.1 GiB", "900.0 TiB"]);
        let enough = [1, 3 << 20, (4 << 30) + 1].map(enough);
        assert_eq!(enough, ["1M", "4M", "8G"]);
    }
}
