//! Diagnostics for the terminal and for programs.

use annotate_snippets::{Group, Level, Renderer};
use jaspe_edge::Locator;
use jaspe_edge::message::{self, Style};
use jaspe_scene::{Diagnostic, Diagnostics, Severity, Sources, Span};
use serde_json::{Value, json};

/// Prints what ended a command.
pub fn print_failure(message: &str, hints: &[String]) {
    print_line(Level::ERROR, message);
    hints.iter().for_each(|hint| print_line(Level::HELP, hint));
}

/// Prints what went wrong without ending anything.
pub fn print_warning(message: &str) {
    print_line(Level::WARNING, message);
}

fn print_line(level: Level<'_>, text: &str) {
    anstream::eprintln!("{}", Renderer::styled().render(&[Group::with_title(level.primary_title(text))]));
}

/// All diagnostics of at least that severity, with excerpts. Styled: print it through `anstream`, which knows what the
/// terminal takes.
pub fn text(diagnostics: &Diagnostics, sources: &Sources, least: Severity) -> String {
    message::text(diagnostics, sources, least, Style::Styled)
}

/// All diagnostics as data.
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

    #[test]
    fn json_has_the_place_in_numbers() {
        let mut sources = Sources::default();
        sources.add(PathBuf::from("a.sc"), Arc::from("é\nxy".as_bytes()));
        let mut diagnostics = Diagnostics::default();
        diagnostics.push(Diagnostic::warning(Span { file: 0, start: 3, end: 5 }, "odd").hint("do this"));
        let list = json(&diagnostics, &sources);
        let expected = json!([{ "severity": "warning", "message": "odd", "labels": [], "hints": ["do this"],
            "file": "a.sc", "line": 2, "column": 1, "start": 3, "end": 5 }]);
        assert_eq!(json!(list), expected);
    }
}
