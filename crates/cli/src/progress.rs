//! How far a rendering is, on standard error.

use std::io::{IsTerminal as _, Write as _};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use clap::ValueEnum;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use jaspe_render::Observer;

use crate::{interrupt, report};

/// When progress is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum When {
    /// When standard error is a terminal
    Auto,
    /// Always: a bar in a terminal, a line every ten per cent elsewhere
    On,
    /// Never
    Off,
}

/// Shows the progress of a work, and stops it after Ctrl-C.
#[derive(Debug)]
pub enum Progress {
    /// Says nothing.
    Silent,
    /// A bar with the time left.
    Bar(ProgressBar),
    /// A line every ten per cent.
    Lines {
        /// What is done (`rendering`).
        work: &'static str,
        /// The tenths that were printed.
        printed: AtomicU64,
    },
}

impl Progress {
    /// The kind that fits the terminal, for a work (`rendering`).
    pub fn new(work: &'static str, when: When) -> Self {
        match (when, std::io::stderr().is_terminal()) {
            (When::Auto | When::On, true) => Progress::Bar(bar(work)),
            (When::On, false) => Progress::Lines { work, printed: AtomicU64::new(0) },
            (When::Off, _) | (When::Auto, false) => Progress::Silent,
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Progress::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }

    /// Prints a warning, above the bar if there is one.
    pub fn warn(&self, message: &str) {
        match self {
            Progress::Bar(bar) => bar.suspend(|| report::print_warning(message)),
            Progress::Lines { .. } | Progress::Silent => report::print_warning(message),
        }
    }
}

fn bar(work: &str) -> ProgressBar {
    let template = "{msg} {bar:32} {percent:>3} %  {elapsed} gone, {eta} left";
    let style =
        ProgressStyle::with_template(template).expect("the template is well formed").progress_chars("█▉▊▋▌▍▎▏ ");
    let bar = ProgressBar::with_draw_target(Some(0), ProgressDrawTarget::stderr_with_hz(15))
        .with_style(style)
        .with_message(work.to_owned());
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

impl Observer for Progress {
    fn progress(&self, done: u64, total: u64) {
        match self {
            Progress::Silent => {}
            Progress::Bar(bar) => {
                bar.set_length(total);
                bar.set_position(done);
            }
            Progress::Lines { work, printed } => {
                let tenths = (10 * done).checked_div(total).unwrap_or(0).min(10);
                if printed.fetch_max(tenths, Ordering::Relaxed) < tenths {
                    // Nobody reading progress is no reason to stop.
                    let _ = writeln!(std::io::stderr(), "{work}: {} %", 10 * tenths);
                }
            }
        }
    }

    fn cancelled(&self) -> bool {
        interrupt::asked()
    }
}
