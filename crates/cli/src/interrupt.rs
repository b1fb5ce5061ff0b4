//! Ctrl-C: the first one asks the work to stop and clean up, the second one ends the program at once.

use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// Starts listening. Where that is impossible, Ctrl-C ends the program as usual.
pub fn listen() {
    let handler = || {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    };
    // Without a handler nothing is lost but the tidiness: outputs appear by renaming in any case.
    let _ = ctrlc::set_handler(handler);
}

/// Whether somebody pressed Ctrl-C.
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
