//! The bar that people see.

use super::standing::{Standing, words};
use indicatif::{ProgressBar, ProgressStyle};

/// The bar has so many parts.
const PARTS: u64 = 10_000;

/// An empty one, which is not drawn yet.
pub(super) fn bar() -> ProgressBar {
    let bar = ProgressBar::new(PARTS);
    let template = "{percent:>3}% [{bar:30}] {elapsed} {msg}";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}

/// Draws how tracing stands; before that, there is nothing to draw.
pub(super) fn draw(bar: &ProgressBar, standing: &Standing) {
    let Standing::Tracing(tracing) = standing else {
        return;
    };
    bar.set_position((PARTS as f64 * tracing.done) as u64);
    let place = match tracing.frames {
        0..=1 => String::new(),
        _ => format!(
            "frame {}: {:.0} % · ",
            tracing.frame,
            100.0 * tracing.share()
        ),
    };
    let left = tracing.left.map(|left| format!("{} left", words(left)));
    bar.set_message(place + &left.unwrap_or_default());
}
