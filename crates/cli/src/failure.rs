//! Why a command could not do its work (exit status 2, or 130 after Ctrl-C).

use std::io;
use std::path::Path;

use jaspe_edge::{Refusal, plain};

/// What ended a command early.
#[derive(Debug)]
pub enum Failure {
    /// Something about usage, files or folders, and what to do about it.
    Message {
        /// What is the matter: lower case, no full stop.
        message: String,
        /// What to do next.
        hints: Vec<String>,
    },
    /// Something about usage that has been printed already.
    Reported,
    /// Ctrl-C.
    Interrupted,
    /// Nobody reads standard output any more.
    BrokenPipe,
}

impl Failure {
    /// A failure with nothing to advise yet.
    pub fn new(message: impl Into<String>) -> Self {
        Failure::Message { message: message.into(), hints: Vec::new() }
    }

    /// Adds advice.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        if let Failure::Message { hints, .. } = &mut self {
            hints.push(hint.into());
        }
        self
    }

    /// `path` could not be read.
    pub fn reading(path: &Path, error: &io::Error) -> Self {
        let failure = Failure::new(format!("cannot read `{}`: {}", path.display(), plain(error)));
        match error.kind() {
            io::ErrorKind::NotFound => failure.hint(missing(path)),
            _ => failure,
        }
    }
}

impl From<Refusal> for Failure {
    fn from(Refusal { message, hints }: Refusal) -> Self {
        Failure::Message { message, hints }
    }
}

/// Failing to write results: the reader's leaving is no error.
impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Failure::BrokenPipe,
            _ => Failure::new(format!("cannot write to standard output: {}", plain(&error))),
        }
    }
}

/// Advice about a file that is not there: its folder, or the most similar name beside it.
fn missing(path: &Path) -> String {
    let folder = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        return format!("there is no folder `{}`", folder.display());
    }
    let wanted = path.file_name().unwrap_or_default().to_string_lossy();
    let names = std::fs::read_dir(folder).into_iter().flatten().flatten().take(10_000);
    let names = names.map(|entry| entry.file_name().to_string_lossy().into_owned());
    match nearest(&wanted, names) {
        Some(name) => format!("did you mean `{}`?", folder.join(name).display()),
        None => "paths are relative to the current folder".to_owned(),
    }
}

/// The name that differs from `wanted` in the fewest letters, if those are few.
pub fn nearest(wanted: &str, names: impl Iterator<Item = String>) -> Option<String> {
    let limit = wanted.chars().count() / 3;
    names
        .map(|name| (strsim::damerau_levenshtein(&wanted.to_lowercase(), &name.to_lowercase()), name))
        .filter(|(distance, _)| *distance <= limit)
        .min()
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_found_and_far_ones_are_not() {
        let names = || ["marble", "wood", "stone"].map(str::to_owned).into_iter();
        assert_eq!(nearest("marbel", names()), Some("marble".to_owned()));
        assert_eq!(nearest("Ston", names()), Some("stone".to_owned()));
        assert_eq!(nearest("fire", names()), None);
    }
}
