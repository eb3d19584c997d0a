//! What the charts of reports are drawn with.

use std::fmt::Write;

/// What texts are told apart by: `t` title, `s` strong, `a` ends here, `m` is centred here, `n` quiet, `w` a warning,
/// `k` small.
const STYLE: &str = ".t{font-size:15px;font-weight:600}.s{font-weight:600}.a{text-anchor:end}.m{text-anchor:middle}\
.n{fill:#666}.w{fill:#b3261e}.k{font-size:9px}";

/// A whole picture of `body` on white, sizes in pixels.
pub(super) fn document([width, height]: [f64; 2], body: &str) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" \
         height=\"{height}\" font-family=\"sans-serif\" font-size=\"11\" fill=\"#222\"><style>{STYLE}</style>\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>{body}</svg>\n"
    )
}

/// Words at a place, in the classes of [`STYLE`].
pub(super) fn text(body: &mut String, [x, y]: [f64; 2], class: &str, words: &str) {
    let words = words.replace('&', "&amp;").replace('<', "&lt;");
    // Writing to a string does not fail.
    let _ = write!(
        body,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" class=\"{class}\">{words}</text>"
    );
}
