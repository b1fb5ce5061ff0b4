//! What the reader has to say about a scene, as values. Only the edges (command line, Python) print them.

use std::fmt;

use crate::source::Span;

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Worth knowing; nothing is wrong.
    Note,
    /// The scene renders, perhaps not as its author meant.
    Warning,
    /// The scene cannot be rendered as it stands.
    Error,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Severity::Note => "note",
            Severity::Warning => "warning",
            Severity::Error => "error",
        })
    }
}

/// A second place that explains the first ("first declared here").
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What is there.
    pub message: String,
}

/// One message: what was found where, and what to do about it.
///
/// Messages are lower case without a full stop, with names in backquotes: what was expected, what was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// The text it is about; `None` for what concerns the scene as a whole.
    pub span: Option<Span>,
    /// What is the matter.
    pub message: String,
    /// Other places that explain it.
    pub labels: Vec<Label>,
    /// What to do next, each a full suggestion.
    pub hints: Vec<String>,
}

impl Diagnostic {
    /// A diagnostic of the given severity about `span`.
    pub fn new(severity: Severity, span: impl Into<Option<Span>>, message: impl Into<String>) -> Self {
        Diagnostic { severity, span: span.into(), message: message.into(), labels: Vec::new(), hints: Vec::new() }
    }

    /// An error about `span`.
    pub fn error(span: impl Into<Option<Span>>, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, span, message)
    }

    /// A warning about `span`.
    pub fn warning(span: impl Into<Option<Span>>, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, span, message)
    }

    /// A note about `span`.
    pub fn note(span: impl Into<Option<Span>>, message: impl Into<String>) -> Self {
        Self::new(Severity::Note, span, message)
    }

    /// Adds a suggestion.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hints.push(hint.into());
        self
    }

    /// Adds a second place.
    #[must_use]
    pub fn label(mut self, span: Span, message: impl Into<String>) -> Self {
        self.labels.push(Label { span, message: message.into() });
        self
    }
}

/// All diagnostics of one run. Those of the reader are ordered by place.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
    suppressed: usize,
}

impl Diagnostics {
    /// More than this many are counted and not kept, so that a broken file of millions of lines cannot fill the memory.
    pub const LIMIT: usize = 200;

    /// Adds one, or counts it when there are [`Self::LIMIT`] already (the first error is always kept).
    pub fn push(&mut self, diagnostic: Diagnostic) {
        let first_error = diagnostic.severity == Severity::Error && !self.has_errors();
        if self.list.len() < Self::LIMIT || first_error {
            self.list.push(diagnostic);
        } else {
            self.suppressed += 1;
        }
    }

    /// Adds all of `other`.
    pub fn extend(&mut self, other: Diagnostics) {
        self.suppressed += other.suppressed;
        other.list.into_iter().for_each(|diagnostic| self.push(diagnostic));
    }

    /// Orders them by place: file after file, each from its start; those without a place come first.
    pub(crate) fn sort(&mut self) {
        self.list.sort_by_key(|diagnostic| diagnostic.span.map(|span| (span.file, span.start)));
    }

    /// Whether any of them is an error.
    pub fn has_errors(&self) -> bool {
        self.list.iter().any(|diagnostic| diagnostic.severity == Severity::Error)
    }

    /// How many of the given severity are kept.
    pub fn count(&self, severity: Severity) -> usize {
        self.list.iter().filter(|diagnostic| diagnostic.severity == severity).count()
    }

    /// How many were found beyond [`Self::LIMIT`].
    pub fn suppressed(&self) -> usize {
        self.suppressed
    }

    /// The kept ones, in order.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.list.iter()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }
}

impl<'a> IntoIterator for &'a Diagnostics {
    type Item = &'a Diagnostic;
    type IntoIter = std::slice::Iter<'a, Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}
