//! Everything that follows a rendering: its progress, a viewer, and a file for its state.

use jaspe_render::{Checkpoint, Film, Observer};

use crate::keeper::Keeper;
use crate::progress::Progress;
use crate::viewer::Viewer;

/// All that follows a rendering.
#[derive(Debug)]
pub struct Watch {
    /// How far it is.
    pub progress: Progress,
    /// Where its state is kept, and what the file says that it belongs to.
    pub keeper: Option<(Keeper, String)>,
    /// Where its tiles are shown.
    pub viewer: Option<Viewer>,
    /// Whether warnings are left out.
    pub quiet: bool,
}

impl Watch {
    /// Prints a warning, if there is one.
    pub fn warn(&self, warning: Option<String>) {
        if let Some(message) = warning.filter(|_| !self.quiet) {
            self.progress.warn(&message);
        }
    }
}

impl Observer for Watch {
    fn progress(&self, done: u64, total: u64) {
        self.progress.progress(done, total);
    }

    fn cancelled(&self) -> bool {
        self.progress.cancelled()
    }

    fn tile(&self, corner: [u32; 2], part: &Film) {
        self.warn(self.viewer.as_ref().and_then(|viewer| viewer.show(corner, part)));
    }

    fn wants_checkpoint(&self) -> bool {
        self.keeper.as_ref().is_some_and(|(keeper, _)| keeper.is_due())
    }

    fn checkpoint(&self, state: Checkpoint) {
        let Some((keeper, origin)) = &self.keeper else { return };
        self.warn(keeper.keep(&state, origin));
    }
}
