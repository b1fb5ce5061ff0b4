//! `--checkpoint` and `--resume`: the state of a rendering in a file, from which it goes on after an interruption.
//!
//! The file names what it belongs to: the files that the scene is made of, and the options that change the picture. A
//! state of anything else is refused, and the message says what the difference is.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use jaspe_edge::file::Target;
use jaspe_edge::plain;
use jaspe_render::{Checkpoint, CheckpointError};
use jaspe_scene::{DiskLoader, Loader};

use crate::failure::Failure;
use crate::interrupt;

/// Most of the time that goes into keeping states: one part in so many.
const SHARE: u32 = 20;
/// Bytes of a state for each pixel, at most, and for everything else: names of files, options.
const BYTES: [u64; 2] = [64, 16 << 20];

/// Files of this machine, with a note of each that is read.
#[derive(Debug, Default)]
pub struct Recorder(Mutex<Vec<String>>);

impl Loader for Recorder {
    fn load(&self, path: &Path) -> io::Result<Arc<[u8]>> {
        let bytes = DiskLoader.load(path)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let note = format!("file {name} {} {:08x}", bytes.len(), crc32fast::hash(&bytes));
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(note);
        Ok(bytes)
    }
}

impl Recorder {
    /// What a rendering is recognised by: a line for each file, and one for each option.
    pub fn origin(self, options: &[String]) -> String {
        let mut lines = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        lines.sort();
        lines.extend_from_slice(options);
        lines.join("\n")
    }
}

/// Where states are kept, and how often.
#[derive(Debug)]
pub struct Keeper {
    target: Target,
    path: PathBuf,
    every: Duration,
    schedule: Mutex<Schedule>,
}

#[derive(Debug)]
struct Schedule {
    next: Instant,
    /// Why the last state could not be written.
    trouble: Option<String>,
}

impl Keeper {
    /// Keeps states in a file, which is there already only if its state is what the rendering goes on from.
    pub fn new(path: &Path, resumed: Option<&Path>, every: Duration) -> Result<Self, Failure> {
        let same = |other: &Path| fs::canonicalize(other).ok() == fs::canonicalize(path).ok();
        if path.is_file() && !resumed.is_some_and(same) {
            let failure = Failure::new(format!("there is a checkpoint in `{}` already", path.display()));
            return Err(failure.hint(format!("go on from it with --resume {}, or remove it", path.display())));
        }
        let schedule = Mutex::new(Schedule { next: Instant::now() + every, trouble: None });
        Ok(Keeper { target: Target::new(path)?, path: path.to_owned(), every, schedule })
    }

    /// Where states are kept.
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn schedule(&self) -> std::sync::MutexGuard<'_, Schedule> {
        self.schedule.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether it is time for another state.
    pub fn is_due(&self) -> bool {
        interrupt::asked() || Instant::now() >= self.schedule().next
    }

    /// Writes a state. Returns what went wrong, the first time that it does.
    pub fn keep(&self, state: &Checkpoint, origin: &str) -> Option<String> {
        let started = Instant::now();
        let result = self.target.write(&state.to_bytes(origin));
        let mut schedule = self.schedule();
        schedule.next = Instant::now() + self.every.max(SHARE * started.elapsed());
        let before = std::mem::replace(&mut schedule.trouble, result.err().map(|refusal| refusal.to_string()));
        if before.is_some() { None } else { schedule.trouble.clone() }
    }

    /// Whether the last state is in the file.
    pub fn has_kept(&self) -> bool {
        self.schedule().trouble.is_none() && self.path.exists()
    }

    /// Removes the file: the picture is written.
    pub fn remove(&self) -> Option<String> {
        match fs::remove_file(&self.path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Some(plain(&error)),
            _ => None,
        }
    }
}

/// Makes sure that there is a file to go on from, before any long work begins.
pub fn look_for(path: &Path) -> Result<(), Failure> {
    let metadata = File::open(path).and_then(|file| file.metadata()).map_err(|error| Failure::reading(path, &error))?;
    if metadata.is_file() { Ok(()) } else { Err(unusable(path, "is no file")) }
}

/// Reads the state of a picture of so many pixels.
pub fn read(path: &Path, origin: &str, pixels: u64) -> Result<Checkpoint, Failure> {
    let most = BYTES[0] * pixels + BYTES[1] + origin.len() as u64;
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(most + 1).read_to_end(&mut bytes));
    read.map_err(|error| Failure::reading(path, &error))?;
    Checkpoint::from_bytes(&bytes, origin).map_err(|error| {
        let failure = unusable(path, &error.to_string());
        match error {
            CheckpointError::Foreign => failure.hint("--resume takes a file that --checkpoint has written"),
            CheckpointError::Damaged => failure.hint("start anew without --resume"),
            CheckpointError::Version(_) => failure.hint("go on with that version, or start anew without --resume"),
            CheckpointError::Origin(theirs) => failure
                .hint(difference(&theirs, origin))
                .hint("give the same scene and the same options, or start anew without --resume"),
        }
    })
}

/// A state that is none for this rendering.
pub fn unusable(path: &Path, reason: &str) -> Failure {
    Failure::new(format!("cannot go on from `{}`: it {reason}", path.display()))
}

/// The first thing in which two origins differ.
fn difference(theirs: &str, ours: &str) -> String {
    let only = |these: &str, those: &str| {
        let line = these.lines().find(|&line| !those.lines().any(|other| other == line));
        // Whoever wrote the file, it shall not write to the terminal.
        line.map(|line| line.chars().take(200).collect::<String>().escape_debug().to_string())
    };
    let file = |line: &str| Some(line.strip_prefix("file ")?.rsplitn(3, ' ').nth(2)?.to_owned());
    match (only(theirs, ours), only(ours, theirs)) {
        (Some(then), now) => match (file(&then), now.as_deref().and_then(file)) {
            (Some(then), Some(now)) if then == now => format!("`{now}` has changed since"),
            (Some(then), _) => format!("its scene was made of `{then}`, among others"),
            (None, _) => format!("it was started with `{then}`"),
        },
        (None, Some(now)) => match file(&now) {
            Some(now) => format!("its scene was made without `{now}`"),
            None => format!("it was started without `{now}`"),
        },
        (None, None) => "the same files were read in another order".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_named() {
        let ours = "file a.sc 10 00000001\nfile b.png 20 00000002\n--samples 4";
        for (theirs, said) in [
            ("file a.sc 11 00000009\nfile b.png 20 00000002\n--samples 4", "`a.sc` has changed since"),
            (
                "file x y.sc 10 00000001\nfile b.png 20 00000002\n--samples 4",
                "its scene was made of `x y.sc`, among others",
            ),
            ("file a.sc 10 00000001\nfile b.png 20 00000002\n--samples 9", "it was started with `--samples 9`"),
            ("file a.sc 10 00000001\nfile b.png 20 00000002", "it was started without `--samples 4`"),
            ("file a.sc 10 00000001\n--samples 4", "its scene was made without `b.png`"),
            (
                "file a.sc 10 00000001\nfile b.png 20 00000002\n--samples 4\n\u{1b}[2J",
                "it was started with `\\u{1b}[2J`",
            ),
        ] {
            assert_eq!(difference(theirs, ours), said);
        }
    }

    #[test]
    fn states_are_kept_when_due_and_trouble_is_told_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("state");
        let keeper = Keeper::new(&path, None, Duration::from_secs(3600)).expect("it can be written");
        assert!(!keeper.is_due() && !keeper.has_kept());
        keeper.schedule().next = Instant::now();
        assert!(keeper.is_due());
        let state = Checkpoint::default();
        assert_eq!(keeper.keep(&state, "x"), None);
        assert!(!keeper.is_due() && keeper.has_kept());
        assert!(read(&path, "x", 1).is_ok_and(|read| read == state));
        assert!(read(&path, "y", 1).is_err());

        assert!(Keeper::new(&path, None, Duration::ZERO).is_err(), "the work of hours is not overwritten");
        assert!(Keeper::new(&path, Some(&path), Duration::ZERO).is_ok());
        assert_eq!((keeper.remove(), keeper.remove()), (None, None));
        assert!(!path.exists());

        drop(folder);
        assert!(keeper.keep(&state, "x").is_some());
        assert!(keeper.keep(&state, "x").is_none() && !keeper.has_kept());
    }
}
