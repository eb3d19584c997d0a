//! Ctrl-C and SIGTERM: once to finish quickly with what there is, twice to leave at once.

use super::failure::code;
use super::say;
use crate::render::Control;
use std::sync::Arc;

/// Lets the signals stop `control`. If the handler cannot be set, the signals keep their usual, harsher meaning.
pub(crate) fn listen(control: &Arc<Control>) {
    let control = Arc::clone(control);
    let handler = move || {
        if control.stopped() {
            std::process::exit(i32::from(code::STOPPED));
        }
        control.stop();
        say("stopping; once more to quit at once");
    };
    if let Err(e) = ctrlc::set_handler(handler) {
        say(&format!("warning: Ctrl-C will not save a picture: {e}"));
    }
}
