//! Diagnostics as people and programs read them: place, excerpt, labels and hints.

use std::borrow::Cow;

use annotate_snippets::{Annotation, AnnotationKind, Element, Group, Level, Origin, Renderer, Snippet};
use jaspe_scene::{Diagnostic, Diagnostics, Severity, Sources, Span};
use serde_json::{Value, json};

use crate::locate::{Excerpt, Locator};
use crate::show::count;

/// Prints what ended a command.
pub fn print_failure(message: &str, hints: &[String]) {
    let line =
        |level: Level<'_>, text: &str| Renderer::styled().render(&[Group::with_title(level.primary_title(text))]);
    anstream::eprintln!("{}", line(Level::ERROR, message));
    for hint in hints {
        anstream::eprintln!("{}", line(Level::HELP, hint));
    }
}

/// All diagnostics of at least that severity, with excerpts, each followed by an empty line. Styled: print it through
/// `anstream`, which knows what the terminal takes.
pub fn text(diagnostics: &Diagnostics, sources: &Sources, least: Severity) -> String {
    let mut locator = Locator::new(sources);
    let shown = diagnostics.iter().filter(|diagnostic| diagnostic.severity >= least);
    let mut text: String = shown.map(|diagnostic| one(diagnostic, &mut locator) + "\n\n").collect();
    if diagnostics.suppressed() > 0 {
        text += &format!("and {} that are not shown\n\n", count(diagnostics.suppressed(), "more message"));
    }
    text
}

/// `2 errors, 1 warning`; `no errors` when there is nothing worse than a note.
pub fn summary(diagnostics: &Diagnostics) -> String {
    let (errors, warnings) = (diagnostics.count(Severity::Error), diagnostics.count(Severity::Warning));
    match (errors, warnings) {
        (0, 0) => "no errors".to_owned(),
        (0, _) => format!("no errors, {}", count(warnings, "warning")),
        (_, 0) => count(errors, "error"),
        _ => format!("{}, {}", count(errors, "error"), count(warnings, "warning")),
    }
}

fn level(severity: Severity) -> Level<'static> {
    match severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Note => Level::NOTE,
    }
}

fn one(diagnostic: &Diagnostic, locator: &mut Locator<'_>) -> String {
    let mut shown: Vec<(Excerpt, Vec<Annotation<'_>>)> = Vec::new();
    for place in places(diagnostic) {
        let Some(excerpt) = locator.excerpt(place.span) else { continue };
        let annotation = place.kind.span(excerpt.span.clone()).label(place.label.map(Cow::Borrowed));
        // Places on the same line share its excerpt.
        match shown.iter_mut().find(|(other, _)| other.shows_the_same_as(&excerpt)) {
            Some((_, annotations)) => annotations.push(annotation),
            None => shown.push((excerpt, vec![annotation])),
        }
    }
    let mut group = level(diagnostic.severity).primary_title(diagnostic.message.as_str()).elements(NOTHING);
    for (excerpt, annotations) in shown {
        group = excerpt_elements(group, excerpt, annotations);
    }
    let help = diagnostic.hints.iter().map(|hint| Level::HELP.message(hint.as_str()));
    Renderer::styled().render(&[group.elements(help)])
}

const NOTHING: [Element<'static>; 0] = [];

/// One spot to show: the diagnostic's own, or that of a label.
struct Place<'a> {
    span: Span,
    kind: AnnotationKind,
    label: Option<&'a str>,
}

fn places(diagnostic: &Diagnostic) -> impl Iterator<Item = Place<'_>> {
    let own = diagnostic.span.map(|span| Place { span, kind: AnnotationKind::Primary, label: None });
    let others = diagnostic.labels.iter().map(|label| Place {
        span: label.span,
        kind: AnnotationKind::Context,
        label: Some(&label.message),
    });
    own.into_iter().chain(others)
}

fn excerpt_elements<'a>(group: Group<'a>, excerpt: Excerpt, annotations: Vec<Annotation<'a>>) -> Group<'a> {
    let position = excerpt.position;
    let snippet = Snippet::source(excerpt.text).line_start(position.line).annotations(annotations);
    if excerpt.is_cut_before {
        // The column cannot be counted in what is shown: it is stated separately.
        let origin = Origin::path(excerpt.path).line(position.line).char_column(position.column);
        group.element(origin).element(snippet)
    } else {
        group.element(snippet.path(excerpt.path))
    }
}

/// The same as data.
pub fn json(diagnostics: &Diagnostics, sources: &Sources) -> Vec<Value> {
    let mut locator = Locator::new(sources);
    diagnostics.iter().map(|diagnostic| one_json(diagnostic, &mut locator)).collect()
}

fn one_json(diagnostic: &Diagnostic, locator: &mut Locator<'_>) -> Value {
    let labels: Vec<Value> = diagnostic
        .labels
        .iter()
        .map(|label| with_place(json!({ "message": label.message }), Some(label.span), locator))
        .collect();
    let value = json!({
        "severity": diagnostic.severity.to_string(),
        "message": diagnostic.message,
        "labels": labels,
        "hints": diagnostic.hints,
    });
    with_place(value, diagnostic.span, locator)
}

/// Adds file, line and column (both from 1), and the first and past-the-last byte.
fn with_place(mut value: Value, span: Option<Span>, locator: &mut Locator<'_>) -> Value {
    let place = span.and_then(|span| Some((span, locator.path(span)?, locator.position(span)?)));
    if let Some((span, path, position)) = place {
        value["file"] = json!(path);
        value["line"] = json!(position.line);
        value["column"] = json!(position.column);
        value["start"] = json!(span.start);
        value["end"] = json!(span.end);
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;
    use std::sync::Arc;

    fn sources(bytes: &[u8]) -> Sources {
        let mut sources = Sources::default();
        sources.add(PathBuf::from("a.sc"), Arc::from(bytes));
        sources
    }

    fn span(start: u32, end: u32) -> Span {
        Span { file: 0, start, end }
    }

    fn plain(diagnostic: Diagnostic, bytes: &[u8]) -> String {
        let mut diagnostics = Diagnostics::default();
        diagnostics.push(diagnostic);
        anstream::adapter::strip_str(&text(&diagnostics, &sources(bytes), Severity::Note)).to_string()
    }

    #[test]
    fn messages_show_place_excerpt_label_and_hint() {
        let source = b"shader {\n\tname marble\n\ttyp marble\n}\n";
        let diagnostic = Diagnostic::error(span(23, 26), "unknown keyword `typ`")
            .label(span(0, 6), "in this block")
            .hint("did you mean `type`?");
        let text = plain(diagnostic, source);
        for part in [
            "error: unknown keyword `typ`",
            "a.sc:3:2",
            "typ marble",
            "^^^",
            "a.sc:1:1",
            "in this block",
            "help: did you mean `type`?",
        ] {
            assert!(text.contains(part), "{part} in\n{text}");
        }
    }

    #[test]
    fn places_on_one_line_share_an_excerpt() {
        let diagnostic = Diagnostic::error(span(9, 10), "`m` twice").label(span(2, 3), "first here");
        let text = plain(diagnostic, b"a m    b m c\nd\n");
        assert_eq!(text.matches("a m    b m c").count(), 1, "{text}");
        assert!(text.contains("a.sc:1:10") && text.contains("first here"), "{text}");
    }

    #[test]
    fn messages_without_a_place_stand_alone() {
        assert_eq!(plain(Diagnostic::note(None, "dark"), b""), "note: dark\n\n");
    }

    #[test]
    fn notes_can_be_left_out_and_suppressed_ones_are_counted() {
        let mut diagnostics = Diagnostics::default();
        (0..Diagnostics::LIMIT + 3).for_each(|_| diagnostics.push(Diagnostic::note(None, "dark")));
        assert_eq!(text(&diagnostics, &sources(b""), Severity::Error), "and 3 more messages that are not shown\n\n");
        assert_eq!(summary(&diagnostics), "no errors");
        diagnostics.push(Diagnostic::error(None, "wrong"));
        assert_eq!(summary(&diagnostics), "1 error");
    }

    #[test]
    fn json_has_the_place_in_numbers() {
        let mut diagnostics = Diagnostics::default();
        diagnostics.push(Diagnostic::warning(span(3, 5), "odd").hint("do this"));
        let list = json(&diagnostics, &sources("é\nxy".as_bytes()));
        let expected = json!([{ "severity": "warning", "message": "odd", "labels": [], "hints": ["do this"],
            "file": "a.sc", "line": 2, "column": 1, "start": 3, "end": 5 }]);
        assert_eq!(json!(list), expected);
    }
}
