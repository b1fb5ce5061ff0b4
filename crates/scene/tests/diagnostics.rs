//! The scenes in `tests/diagnostics` say in comments which messages they give rise to.
//!
//! Above the line that it is about stands, for each message, `# error: 9-13 the message` (or `warning`, `note`), with
//! the first and the last column of its place, then its second places as `# label: 9-13 …` with their line's number
//! in brackets, and its hints as `# hint: …`. Messages about no place stand at the top, without columns. Line numbers
//! do not count these comments: the scene is read without them.
//!
//! `JASPE_BLESS=1 cargo test -p jaspe-scene --test diagnostics` writes them as they are today.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::{fs, io};

use jaspe_scene::{Diagnostic, Diagnostics, Loader, Scene, Span, read};

const KINDS: [&str; 5] = ["# error:", "# warning:", "# note:", "# label:", "# hint:"];

fn strip(text: &str) -> String {
    text.split_inclusive('\n').filter(|line| !KINDS.iter().any(|kind| line.starts_with(kind))).collect()
}

/// The files without their comments.
struct Stripped;

impl Loader for Stripped {
    fn load(&self, path: &Path) -> io::Result<Arc<[u8]>> {
        fs::read_to_string(folder().join(path)).map(|text| Arc::from(strip(&text).as_bytes()))
    }
}

/// First and last column of a place, as far as its first line goes.
fn columns(scene: &Scene, span: Span) -> String {
    let start = scene.sources.position(span).expect("the place is in a file");
    let end = scene.sources.position(Span { start: span.end, ..span }).expect("the place is in a file");
    match end.column.saturating_sub(1) {
        _ if span.start == span.end => format!("{}", start.column),
        _ if end.line != start.line => format!("{}-", start.column),
        last => format!("{}-{last}", start.column),
    }
}

/// The comment that stands for a message.
fn comment(scene: &Scene, diagnostic: &Diagnostic) -> String {
    let place = diagnostic.span.map(|span| format!(" {}", columns(scene, span))).unwrap_or_default();
    let mut text = format!("# {}:{place} {}\n", diagnostic.severity, diagnostic.message);
    for label in &diagnostic.labels {
        let position = scene.sources.position(label.span).expect("the place is in a file");
        let _ = writeln!(text, "# label: [{}] {} {}", position.line, columns(scene, label.span), label.message);
    }
    for hint in &diagnostic.hints {
        let _ = writeln!(text, "# hint: {hint}");
    }
    text
}

/// The text of a file with the comments that belong to it.
fn annotate(scene: &Scene, diagnostics: &Diagnostics, file: u32, text: &str) -> String {
    let mut lines: Vec<String> = text.split_inclusive('\n').map(str::to_owned).collect();
    lines.push(String::new());
    let mut above = vec![String::new(); lines.len()];
    for diagnostic in diagnostics {
        let line = match diagnostic.span {
            Some(span) if span.file == file => scene.sources.position(span).expect("the place is in a file").line,
            None if file == 0 => 1,
            _ => continue,
        };
        above[line.min(lines.len()) - 1] += &comment(scene, diagnostic);
    }
    above.iter().zip(&lines).flat_map(|(above, line)| [above.as_str(), line.as_str()]).collect()
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/diagnostics")
}

#[test]
fn every_scene_gives_the_messages_that_it_announces() {
    let bless = std::env::var_os("JASPE_BLESS").is_some();
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder()).expect("the folder exists").map(|entry| entry.expect("readable").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "sc"));
    paths.sort();
    assert!(paths.len() >= 20, "found only {} scenes", paths.len());
    let (mut failures, mut messages) = (Vec::new(), 0);
    for path in &paths {
        let name = Path::new(path.file_name().expect("a file has a name"));
        let (scene, diagnostics) = read(name, &Stripped);
        messages += diagnostics.iter().count();
        for (file, source) in scene.sources.iter().enumerate() {
            let at = folder().join(&source.path);
            let written = fs::read_to_string(&at).expect("it was read before");
            let expected = annotate(&scene, &diagnostics, file as u32, &strip(&written));
            if expected != written && bless {
                fs::write(&at, &expected).expect("writable");
            } else if expected != written {
                failures.push(format!("{}: today it reads\n{expected}", source.path.display()));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(messages >= 100, "only {messages} messages");
}
