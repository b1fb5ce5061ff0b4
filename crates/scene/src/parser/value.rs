//! Reads single values: words, numbers, vectors.

use super::{Failed, Parsed, Parser};
use crate::description::Name;
use crate::diagnostic::Diagnostic;
use crate::lexer::{Syntax, Token};
use crate::number::{self, Float};
use crate::source::Spanned;
use crate::suggest;

/// Longer words are cut in messages.
const SHOWN: usize = 40;

impl Parser<'_> {
    /// A name or file name: any word but a brace.
    pub(super) fn word(&mut self, what: &str) -> Parsed<Name> {
        match self.next() {
            Some(token) if !self.is(token, "{") && !self.is(token, "}") => {
                Ok(Spanned::new(self.text(token), self.span(token)))
            }
            found => Err(self.expected(what, found)),
        }
    }

    /// A finite number.
    pub(super) fn number<T: Float>(&mut self) -> Parsed<T> {
        let found = self.next();
        let value = found.and_then(|token| number::float::<T>(token.bytes(&self.bytes)));
        match (value, found) {
            (Some(value), Some(_)) if value.is_finite() => Ok(value),
            (Some(_), Some(token)) => Err(self.not_finite(token)),
            _ => Err(self.expected("a number", found)),
        }
    }

    /// `N` finite numbers.
    pub(super) fn numbers<T: Float + Default, const N: usize>(&mut self) -> Parsed<[T; N]> {
        let mut values = [T::default(); N];
        for value in &mut values {
            *value = self.number()?;
        }
        Ok(values)
    }

    /// A whole number.
    pub(super) fn int(&mut self) -> Parsed<i64> {
        let found = self.next();
        if let Some(value) = found.and_then(|token| number::int(token.bytes(&self.bytes))) {
            return Ok(value);
        }
        let as_float = found.and_then(|token| number::float::<f64>(token.bytes(&self.bytes)));
        match (as_float, found) {
            (Some(value), Some(token)) => {
                let message = format!("`{}` expects a whole number, found `{}`", self.context.name, self.shown(token));
                let diagnostic = Diagnostic::error(self.span(token), message);
                let nearest = value.round();
                let diagnostic = if nearest.abs() < 1e9 {
                    diagnostic.hint(format!("write `{nearest}`, without fraction or exponent"))
                } else {
                    diagnostic
                };
                Err(self.fail(found, diagnostic))
            }
            _ => Err(self.expected("a whole number", found)),
        }
    }

    /// `true` or `false`. Any other word is false, as in Sunflow, and gets a warning.
    pub(super) fn boolean(&mut self) -> Parsed<Spanned<bool>> {
        let word = self.word("`true` or `false`")?;
        let value = word.value.eq_ignore_ascii_case("true");
        if !value && !word.value.eq_ignore_ascii_case("false") {
            let message = format!("`{}` is neither `true` nor `false`, and counts as `false`", word.value);
            self.diagnostics.push(Diagnostic::warning(word.span, message).hint("write `true` or `false`"));
        }
        Ok(Spanned::new(value, word.span))
    }

    /// Reads an optional value: `Some` if the next word is a number.
    pub(super) fn number_follows(&self) -> bool {
        self.peek().is_some_and(|token| number::float::<f32>(token.bytes(&self.bytes)).is_some())
    }

    /// Runs `read` and joins its value with the place of the words that it took.
    pub(super) fn spanned<T>(&mut self, read: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<Spanned<T>> {
        let first = self.peek();
        let value = read(self)?;
        let end = self.lexer.position() as u32;
        let span = first.map_or(self.end_span(), |token| self.span(Token { end, ..token }));
        Ok(Spanned::new(value, span))
    }

    /// The word as messages show it: short and printable.
    pub(super) fn shown(&self, token: Token) -> String {
        shorten(&self.text(token))
    }

    /// Reports that something else stands where `what` belongs.
    pub(super) fn expected(&mut self, what: &str, found: Option<Token>) -> Failed {
        let name = self.context.name;
        let Some(token) = found else {
            let end = match self.syntax {
                Syntax::Scene => "the end of the file",
                Syntax::Assignment => "nothing",
            };
            let message = format!("`{name}` expects {what}, found {end}");
            let diagnostic = self.with_example(Diagnostic::error(self.end_span(), message));
            return self.fail(None, diagnostic);
        };
        let message = format!("`{name}` expects {what}, found `{}`", self.shown(token));
        let mut diagnostic = Diagnostic::error(self.span(token), message);
        if self.holds_glued_brace(token) {
            diagnostic = diagnostic.hint("put a blank on both sides of every brace");
        } else {
            diagnostic = self.with_example(diagnostic);
        }
        self.fail(found, diagnostic)
    }

    fn with_example(&self, diagnostic: Diagnostic) -> Diagnostic {
        match self.context.example {
            "" => diagnostic,
            example => diagnostic.hint(format!("for example `{example}`")),
        }
    }

    /// Whether a brace is part of a longer word, as in `1}`.
    pub(super) fn holds_glued_brace(&self, token: Token) -> bool {
        let bytes = token.bytes(&self.bytes);
        bytes.len() > 1 && (bytes.starts_with(b"{") || bytes.ends_with(b"}") || bytes.ends_with(b"{"))
    }

    fn not_finite(&mut self, token: Token) -> Failed {
        let message = format!("`{}` expects a finite number, found `{}`", self.context.name, self.shown(token));
        let diagnostic = self.with_example(Diagnostic::error(self.span(token), message));
        self.fail(Some(token), diagnostic)
    }

    /// The entry of `choices` called as the next word.
    pub(super) fn choice<T: Copy>(&mut self, what: &str, choices: &[(&'static str, T)]) -> Parsed<Spanned<T>> {
        let word = self.word(what)?;
        if let Some((_, value)) = choices.iter().find(|(name, _)| *name == word.value) {
            return Ok(Spanned::new(*value, word.span));
        }
        let diagnostic = unknown_word(what, &word, choices.iter().map(|(name, _)| *name));
        self.failed_at = word.span.end;
        self.diagnostics.push(diagnostic);
        Err(Failed)
    }
}

/// Keeps a value where it was read.
pub(super) fn put<T>(slot: &mut Option<T>, value: Parsed<T>) -> Parsed<()> {
    *slot = Some(value?);
    Ok(())
}

/// An error about a word that is not among `known`, with the nearest one or all of them as a hint.
pub(super) fn unknown_word<'a>(what: &str, word: &Name, known: impl Iterator<Item = &'a str> + Clone) -> Diagnostic {
    let what = what.trim_start_matches("a ").trim_start_matches("an ").trim_start_matches("the ");
    let diagnostic = Diagnostic::error(word.span, format!("unknown {what} `{}`", shorten(&word.value)));
    match suggest::nearest(&word.value, known.clone()) {
        Some(nearest) => diagnostic.hint(format!("did you mean `{nearest}`?")),
        None => diagnostic.hint(format!("expected {}", suggest::list(known))),
    }
}

/// Cuts long words and makes control characters visible.
pub(super) fn shorten(text: &str) -> String {
    let shown = printable(text.chars().take(SHOWN));
    if text.chars().nth(SHOWN).is_some() { shown + "…" } else { shown }
}

/// Makes control characters visible.
pub(super) fn printable(text: impl Iterator<Item = char>) -> String {
    let mut shown = String::new();
    for character in text {
        match character {
            '\u{feff}' => shown.extend(character.escape_default()),
            _ if character.is_control() => shown.extend(character.escape_default()),
            _ => shown.push(character),
        }
    }
    shown
}
