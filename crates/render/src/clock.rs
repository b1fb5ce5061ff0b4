//! Where the time of a thread goes, measured batch by batch.
//!
//! Every moment of a thread's work belongs to one stage: a lap ends where the next one begins. So the stages add up to
//! the work, and what is missing from the time of the whole rendering is what threads waited.

use std::time::{Duration, Instant};

/// What a thread does at a time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stage {
    Trace,
    Texture,
    Shade,
}

/// What threads spent on each stage of rendering, all threads together.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Spent {
    /// Finding what rays meet, and whether they are blocked.
    pub trace: Duration,
    /// Evaluating textures, procedural ones and pictures, and the bumps that follow them.
    pub texture: Duration,
    /// All else: aiming rays, surfaces, shaders, lights, sums of samples.
    pub shade: Duration,
}

impl Spent {
    /// What two parts of a rendering spent together.
    #[must_use]
    pub fn plus(self, other: Spent) -> Spent {
        Spent {
            trace: self.trace + other.trace,
            texture: self.texture + other.texture,
            shade: self.shade + other.shade,
        }
    }
}

/// One thread's stopwatch. It is read once per batch and stage: some 30 ns, where a batch takes tens of microseconds.
#[derive(Debug)]
pub(crate) struct Clock {
    since: Instant,
    pub spent: Spent,
}

impl Clock {
    /// A clock that starts now.
    pub fn start() -> Clock {
        Clock { since: Instant::now(), spent: Spent::default() }
    }

    /// Ends a lap: the time since the last one went to this stage.
    pub fn lap(&mut self, stage: Stage) {
        let now = Instant::now();
        let lap = now - self.since;
        self.since = now;
        match stage {
            Stage::Trace => self.spent.trace += lap,
            Stage::Texture => self.spent.texture += lap,
            Stage::Shade => self.spent.shade += lap,
        }
    }
}
