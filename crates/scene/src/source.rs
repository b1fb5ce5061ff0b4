//! Where text comes from: files read through a [`Loader`], and spans into them.

use std::collections::HashMap;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A stretch of one source file, in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// Index of the file in [`Sources`].
    pub file: u32,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

impl Span {
    /// From the start of `self` to the end of `other` (of the same file; otherwise `self`).
    #[must_use]
    pub fn to(self, other: Span) -> Span {
        if self.file == other.file { Span { end: other.end.max(self.end), ..self } } else { self }
    }
}

/// A value and where it was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Where it was written.
    pub span: Span,
}

impl<T> Spanned<T> {
    /// `value`, written at `span`.
    pub fn new(value: T, span: Span) -> Self {
        Spanned { value, span }
    }
}

/// One file that was read.
#[derive(Debug, Clone)]
pub struct Source {
    /// The path as it was asked for.
    pub path: PathBuf,
    /// Its bytes, unchanged.
    pub bytes: Arc<[u8]>,
}

/// A place a person can go to: both count from 1, columns in characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Position {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

/// All files of a scene, in the order in which they were opened.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    files: Vec<Source>,
}

impl Sources {
    /// Adds a file and returns its index.
    pub fn add(&mut self, path: PathBuf, bytes: Arc<[u8]>) -> u32 {
        self.files.push(Source { path, bytes });
        (self.files.len() - 1) as u32
    }

    /// The file with that index.
    pub fn file(&self, index: u32) -> Option<&Source> {
        self.files.get(index as usize)
    }

    /// All files.
    pub fn iter(&self) -> std::slice::Iter<'_, Source> {
        self.files.iter()
    }

    /// Line and column of the start of `span`.
    pub fn position(&self, span: Span) -> Option<Position> {
        let bytes = &self.file(span.file)?.bytes;
        let start = (span.start as usize).min(bytes.len());
        let line_start = bytes[..start].iter().rposition(|&b| b == b'\n').map_or(0, |at| at + 1);
        let line = 1 + bytes[..start].iter().filter(|&&b| b == b'\n').count();
        let column = 1 + String::from_utf8_lossy(&bytes[line_start..start]).chars().count();
        Some(Position { line, column })
    }
}

/// Gives the bytes behind a path: the only way in which the libraries see files.
pub trait Loader: Sync {
    /// The whole content of `path`.
    ///
    /// # Errors
    /// As [`std::fs::read`]; [`io::ErrorKind::NotFound`] means that the next search folder is tried.
    fn load(&self, path: &Path) -> io::Result<Arc<[u8]>>;
}

/// Files of this machine.
#[derive(Debug, Clone, Copy, Default)]
pub struct DiskLoader;

impl DiskLoader {
    /// Larger files are refused rather than read into memory.
    pub const MAX_BYTES: u64 = 4 << 30;
}

impl Loader for DiskLoader {
    fn load(&self, path: &Path) -> io::Result<Arc<[u8]>> {
        let metadata = std::fs::metadata(path)?;
        if !metadata.is_file() {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "not a regular file"));
        }
        if metadata.len() > Self::MAX_BYTES {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "larger than 4 GiB"));
        }
        let mut file = File::open(path)?;
        // Straight into its place: a `Vec` would have to be copied there, and large scenes be in memory twice.
        let mut bytes: Arc<[u8]> = std::iter::repeat_n(0, metadata.len() as usize).collect();
        let place = Arc::get_mut(&mut bytes).expect("nobody else has it yet");
        let mut filled = 0;
        loop {
            match file.read(&mut place[filled..]) {
                Ok(0) => break,
                Ok(count) => filled += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        // Shorter than announced: it has just been cut, or it is a file of the system without a size.
        if filled == bytes.len() && filled > 0 { Ok(bytes) } else { std::fs::read(path).map(Arc::from) }
    }
}

/// Files in memory, by exact path: for tests, notebooks and scenes made by programs.
#[derive(Debug, Clone, Default)]
pub struct MemoryLoader {
    files: HashMap<PathBuf, Arc<[u8]>>,
}

impl MemoryLoader {
    /// Adds or replaces a file.
    #[must_use]
    pub fn with(mut self, path: impl Into<PathBuf>, bytes: impl Into<Arc<[u8]>>) -> Self {
        self.files.insert(path.into(), bytes.into());
        self
    }
}

impl Loader for MemoryLoader {
    fn load(&self, path: &Path) -> io::Result<Arc<[u8]>> {
        self.files.get(path).cloned().ok_or_else(|| io::Error::new(io::ErrorKind::NotFound, "no such file in memory"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_read_whole() {
        let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/source.rs");
        let bytes = DiskLoader.load(&here).expect("this file exists");
        assert_eq!(*bytes, *std::fs::read(&here).expect("this file exists"));
    }

    #[test]
    fn folders_and_missing_files_are_refused() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        assert_eq!(DiskLoader.load(folder).expect_err("a folder").kind(), io::ErrorKind::InvalidInput);
        let missing = folder.join("no such file");
        assert_eq!(DiskLoader.load(&missing).expect_err("missing").kind(), io::ErrorKind::NotFound);
    }

    #[test]
    fn positions_count_lines_and_characters_from_one() {
        let mut sources = Sources::default();
        let file = sources.add("a.sc".into(), Arc::from("é x\r\n\u{fc} y".as_bytes()));
        let at = |start: u32| sources.position(Span { file, start, end: start }).map(|p| (p.line, p.column));
        assert_eq!(at(0), Some((1, 1)));
        assert_eq!(at(3), Some((1, 3)));
        assert_eq!(at(6), Some((2, 1)));
        assert_eq!(at(9), Some((2, 3)));
        assert_eq!(at(1000), Some((2, 4)));
        assert_eq!(sources.position(Span { file: 7, start: 0, end: 0 }), None);
    }
}
