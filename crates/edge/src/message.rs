//! Diagnostics as people read them: place, excerpt, labels and hints.

use std::borrow::Cow;

use annotate_snippets::{Annotation, AnnotationKind, Element, Group, Level, Origin, Renderer, Snippet};
use jaspe_scene::{Diagnostic, Diagnostics, Severity, Sources, Span};

use crate::locate::{Excerpt, Locator};

/// How messages are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// Letters alone.
    Plain,
    /// With the colours of a terminal.
    Styled,
}

impl Style {
    fn renderer(self) -> Renderer {
        match self {
            Style::Plain => Renderer::plain(),
            Style::Styled => Renderer::styled(),
        }
    }
}

/// All diagnostics of at least that severity, with excerpts, each followed by an empty line.
pub fn text(diagnostics: &Diagnostics, sources: &Sources, least: Severity, style: Style) -> String {
    let mut locator = Locator::new(sources);
    let shown = diagnostics.iter().filter(|diagnostic| diagnostic.severity >= least);
    let mut text: String = shown.map(|diagnostic| one(diagnostic, &mut locator, style) + "\n\n").collect();
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

fn one(diagnostic: &Diagnostic, locator: &mut Locator<'_>, style: Style) -> String {
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
    style.renderer().render(&[group.elements(help)])
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

/// `1 error`, `2 errors`.
pub fn count(number: usize, noun: &str) -> String {
    if number == 1 { format!("1 {noun}") } else { format!("{number} {noun}s") }
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
        text(&diagnostics, &sources(bytes), Severity::Note, Style::Plain)
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
        assert_eq!(
            text(&diagnostics, &sources(b""), Severity::Error, Style::Plain),
            "and 3 more messages that are not shown\n\n"
        );
        assert_eq!(summary(&diagnostics), "no errors");
        diagnostics.push(Diagnostic::error(None, "wrong"));
        assert_eq!(summary(&diagnostics), "1 error");
    }

    #[test]
    fn one_thing_is_singular() {
        assert_eq!(count(1, "error"), "1 error");
        assert_eq!(count(0, "warning"), "0 warnings");
    }
}
