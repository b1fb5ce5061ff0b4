//! Where a span is and what to show of its line. Quick on files of any size and lines of any length; bytes that are not
//! UTF-8 are taken as Latin-1, as old exporters wrote them.

use std::collections::HashMap;
use std::ops::Range;

use jaspe_scene::{Position, Sources, Span};

/// A piece of one line, with the marked part inside.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Excerpt {
    /// The file.
    pub path: String,
    /// Where the marked part begins in the file.
    pub position: Position,
    /// The line, or the neighbourhood of the marked part between `…` when the line is long.
    pub text: String,
    /// The marked part, in bytes of `text`.
    pub span: Range<usize>,
    /// Whether `text` lacks the start of the line.
    pub is_cut_before: bool,
}

impl Excerpt {
    /// Whether both show the same piece of the same line.
    pub fn shows_the_same_as(&self, other: &Excerpt) -> bool {
        (&self.path, self.position.line, &self.text) == (&other.path, other.position.line, &other.text)
    }
}

/// Finds lines and columns; what it learns about a file is kept.
#[derive(Debug)]
pub struct Locator<'a> {
    sources: &'a Sources,
    indices: HashMap<u32, Index>,
}

/// What is known about a file.
#[derive(Debug)]
struct Index {
    line_starts: Vec<u32>,
    is_utf8: bool,
    /// A byte, the line that it is in and its column: the next question is often about the same line.
    last: (usize, usize, usize),
}

/// How many bytes of a long line are shown before the marked part, and how many from its start on.
const BEFORE: usize = 60;
const AFTER: usize = 100;

impl<'a> Locator<'a> {
    /// A locator that knows nothing yet.
    pub fn new(sources: &'a Sources) -> Self {
        Locator { sources, indices: HashMap::new() }
    }

    /// The file of a span.
    pub fn path(&self, span: Span) -> Option<String> {
        Some(self.sources.file(span.file)?.path.to_string_lossy().into_owned())
    }

    /// Line and column of the start of a span, both from 1, columns in characters.
    pub fn position(&mut self, span: Span) -> Option<Position> {
        let bytes = &self.sources.file(span.file)?.bytes;
        let start = (span.start as usize).min(bytes.len());
        let index = self.indices.entry(span.file).or_insert_with(|| Index::new(bytes));
        let line = index.line_starts.partition_point(|&line_start| line_start as usize <= start);
        let line_start = index.line_starts[line - 1] as usize;
        let (from, column) = match index.last {
            (last, last_line, column) if last_line == line && last <= start => (last, column),
            _ => (line_start, 1),
        };
        let column = column + character_count(&bytes[from..start], index.is_utf8);
        index.last = (start, line, column);
        Some(Position { line, column })
    }

    /// The span's line, or as much of it as is worth showing.
    pub fn excerpt(&mut self, span: Span) -> Option<Excerpt> {
        let position = self.position(span)?;
        let bytes = &self.sources.file(span.file)?.bytes;
        let is_utf8 = self.indices[&span.file].is_utf8;
        let start = (span.start as usize).min(bytes.len());

        // The ends of the line, if they are near.
        let from = start.saturating_sub(2 * BEFORE);
        let line_start = match bytes[from..start].iter().rposition(|&byte| byte == b'\n') {
            Some(at) => Some(from + at + 1),
            None => (from == 0).then_some(0),
        };
        let to = (start + 2 * AFTER).min(bytes.len());
        let line_end = match bytes[start..to].iter().position(|&byte| byte == b'\n') {
            Some(at) => Some(start + at),
            None => (to == bytes.len()).then_some(to),
        };
        let first = line_start.unwrap_or(start.saturating_sub(BEFORE));
        let last = line_end.unwrap_or((start + AFTER).min(bytes.len()));
        let marked_end = (span.end as usize).clamp(start, last);

        let decode = |range: Range<usize>| decode(&bytes[range], is_utf8);
        let before = format!("{}{}", if line_start.is_none() { "…" } else { "" }, decode(first..start));
        let marked = decode(start..marked_end);
        let after = decode(marked_end..last);
        let end = if line_end.is_none() { "…" } else { "" };
        let text = format!("{before}{marked}{after}").trim_end_matches('\r').to_owned() + end;
        let marked = before.len()..before.len() + marked.trim_end_matches('\r').len();
        Some(Excerpt { path: self.path(span)?, position, text, span: marked, is_cut_before: line_start.is_none() })
    }
}

impl Index {
    fn new(bytes: &[u8]) -> Self {
        let ends = bytes.iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(at, _)| at as u32 + 1);
        Index {
            line_starts: std::iter::once(0).chain(ends).collect(),
            is_utf8: std::str::from_utf8(bytes).is_ok(),
            last: (0, 1, 1),
        }
    }
}

/// UTF-8 characters are counted by their first bytes, the others being 10xxxxxx.
fn character_count(bytes: &[u8], is_utf8: bool) -> usize {
    if is_utf8 { bytes.iter().filter(|&&byte| byte & 0xc0 != 0x80).count() } else { bytes.len() }
}

/// Text of a piece of a file; halves of characters at its ends are dropped.
fn decode(bytes: &[u8], is_utf8: bool) -> String {
    if is_utf8 {
        let start = bytes.iter().position(|&byte| byte & 0xc0 != 0x80).unwrap_or(bytes.len());
        String::from_utf8_lossy(&bytes[start..]).trim_end_matches('\u{fffd}').to_owned()
    } else {
        bytes.iter().map(|&byte| char::from(byte)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;
    use std::sync::Arc;

    fn excerpt(bytes: &[u8], start: usize, end: usize) -> (usize, usize, String, String) {
        let mut sources = Sources::default();
        let file = sources.add(PathBuf::from("a.sc"), Arc::from(bytes));
        let mut locator = Locator::new(&sources);
        let excerpt = locator.excerpt(Span { file, start: start as u32, end: end as u32 }).expect("the file exists");
        let marked = excerpt.text[excerpt.span.clone()].to_owned();
        (excerpt.position.line, excerpt.position.column, excerpt.text, marked)
    }

    #[test]
    fn short_lines_are_shown_whole() {
        let text = b"one\r\ntwo three\r\nfour";
        assert_eq!(excerpt(text, 9, 14), (2, 5, "two three".to_owned(), "three".to_owned()));
        assert_eq!(excerpt(text, 9, 99), (2, 5, "two three".to_owned(), "three".to_owned()));
        assert_eq!(excerpt(text, 16, 20), (3, 1, "four".to_owned(), "four".to_owned()));
        assert_eq!(excerpt(text, 20, 20), (3, 5, "four".to_owned(), String::new()));
        assert_eq!(excerpt(text, 500, 600), (3, 5, "four".to_owned(), String::new()));
        assert_eq!(excerpt(b"", 0, 0), (1, 1, String::new(), String::new()));
        assert_eq!(excerpt(b"a\n", 2, 2), (2, 1, String::new(), String::new()));
    }

    #[test]
    fn long_lines_are_cut_around_the_place() {
        let mut bytes = "ä 1 ".repeat(200_000).into_bytes();
        let at = bytes.len();
        bytes.extend_from_slice(b"wrong");
        bytes.extend_from_slice(" 2 ö".repeat(200_000).as_bytes());
        let (line, column, text, marked) = excerpt(&bytes, at, at + 5);
        assert_eq!((line, column, marked.as_str()), (1, 800_001, "wrong"));
        assert!(text.starts_with('…') && text.ends_with('…') && text.chars().count() < 200, "{text}");
        let (_, _, text, marked) = excerpt(&bytes, 3, bytes.len());
        assert!(text.starts_with("ä 1 ä") && !marked.is_empty(), "{text}");
    }

    #[test]
    fn other_bytes_are_latin_1() {
        assert_eq!(excerpt(b"caf\xe9 xyz", 5, 8), (1, 6, "café xyz".to_owned(), "xyz".to_owned()));
    }

    #[test]
    fn columns_count_characters_in_any_order_of_questions() {
        let mut sources = Sources::default();
        let file = sources.add(PathBuf::from("a.sc"), Arc::from("äöü abc\nxyz".as_bytes()));
        let mut locator = Locator::new(&sources);
        let mut at = |start| {
            let position = locator.position(Span { file, start, end: start }).expect("the file exists");
            (position.line, position.column)
        };
        assert_eq!([at(9), at(11), at(2), at(7)], [(1, 7), (2, 1), (1, 2), (1, 5)]);
    }
}
