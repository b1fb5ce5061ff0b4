//! Blocks: keywords in tables, in any order, with recovery after errors.

use super::value::{shorten, unknown_word};
use super::{Context, Parsed, Parser};
use crate::description::Name;
use crate::diagnostic::Diagnostic;
use crate::lexer::{Lexer, Token};
use crate::number;
use crate::source::{Span, Spanned};
use crate::suggest;

/// How often a keyword may stand in its block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Times {
    Once,
    Many,
}

/// Reads the value of a keyword into the draft of its block; the span is the keyword's.
pub(crate) type Reader<B> = fn(&mut Parser<'_>, &mut B, Span) -> Parsed<()>;

/// One keyword of a block whose values gather in a `B`.
pub(crate) struct Key<B> {
    pub name: &'static str,
    /// A correct use of it, for hints.
    pub example: &'static str,
    pub times: Times,
    pub read: Reader<B>,
}

impl<B> Clone for Key<B> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<B> Copy for Key<B> {}

impl<B> Key<B> {
    /// A keyword that may be written once.
    pub const fn new(name: &'static str, example: &'static str, read: Reader<B>) -> Self {
        Key { name, example, times: Times::Once, read }
    }

    /// A keyword that may be written several times.
    pub const fn many(name: &'static str, example: &'static str, read: Reader<B>) -> Self {
        Key { name, example, times: Times::Many, read }
    }
}

/// Keywords of which a block needs one, and a correct use of the first.
pub(crate) type Required = (&'static [&'static str], &'static str);

/// What a block takes.
pub(crate) struct Grammar<'k, B> {
    /// What messages call the block: `camera`, `phong`.
    pub what: &'k str,
    pub keys: &'k [Key<B>],
    /// Reads numbers that stand where a keyword could be.
    pub bare: Option<Reader<B>>,
}

/// What became of a block.
#[derive(Debug)]
pub(crate) struct Outcome {
    /// From the block's keyword to its closing brace.
    pub span: Span,
    /// Keywords that were written, or that a misspelt one probably meant.
    seen: Vec<(&'static str, Span)>,
    /// An error was reported.
    pub failed: bool,
    /// A brace may be missing: the next one does not necessarily end the block.
    unsure: bool,
    /// Its end was not found: what it lacks may have been meant to follow.
    cut: bool,
}

impl Outcome {
    /// Whether the keyword was written, well or badly.
    pub fn has(&self, key: &str) -> bool {
        self.seen.iter().any(|(name, _)| *name == key)
    }

    /// Where the keyword was written.
    pub fn place(&self, key: &str) -> Option<Span> {
        self.seen.iter().find(|(name, _)| *name == key).map(|(_, span)| *span)
    }
}

/// Name and type of a block, found by looking ahead.
#[derive(Debug, Default)]
pub(crate) struct Outline {
    pub name: Option<Name>,
    pub kind: Option<Name>,
}

/// How far an [`Outline`] looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Reach {
    Type,
    WholeBlock,
}

/// At which depth of braces recovery may stop at a keyword.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Depth {
    Outer,
    Any,
}

impl Parser<'_> {
    /// Passes the `{` that must follow the keyword of a block.
    pub(super) fn open(&mut self, keyword: &'static str) -> Parsed<()> {
        self.context = Context { name: keyword, example: "" };
        if self.take("{").is_some() {
            return Ok(());
        }
        let found = self.peek();
        Err(self.expected("`{`", found))
    }

    /// Reads the keywords of a block up to its closing brace. `head` is the block's own keyword.
    pub(super) fn block<B>(&mut self, head: Token, grammar: &Grammar<'_, B>, draft: &mut B) -> Outcome {
        let mut outcome = Outcome { span: self.span(head), seen: Vec::new(), failed: false, unsure: false, cut: false };
        loop {
            let before = self.lexer;
            let Some(token) = self.next() else {
                self.unclosed(head, &mut outcome, None);
                break;
            };
            if self.is(token, "}") {
                if !(outcome.unsure && self.key_follows(grammar.keys)) {
                    break;
                }
            } else if self.starts_block(token) {
                self.lexer = before;
                self.unclosed(head, &mut outcome, Some(token));
                break;
            } else {
                self.entry(token, before, grammar, draft, &mut outcome);
            }
        }
        outcome.span.end = self.lexer.position() as u32;
        outcome
    }

    /// Reads one keyword and its value.
    fn entry<B>(
        &mut self,
        token: Token,
        before: Lexer,
        grammar: &Grammar<'_, B>,
        draft: &mut B,
        outcome: &mut Outcome,
    ) {
        let Some(key) = self.key(token, grammar.keys).copied() else {
            let is_number = number::float::<f64>(token.bytes(&self.bytes)).is_some();
            if let (true, Some(bare)) = (is_number, grammar.bare) {
                self.lexer = before;
                let span = self.span(token);
                if bare(self, draft, span).is_err() {
                    outcome.failed = true;
                    self.recover(before, Depth::Any, grammar.keys, outcome);
                }
            } else {
                outcome.failed = true;
                self.unknown_key(token, grammar, outcome);
                self.failed_at = token.start;
                let after = self.lexer;
                // A brace that opens here belongs to the unknown keyword.
                self.recover(if self.is(token, "{") { before } else { after }, Depth::Outer, grammar.keys, outcome);
            }
            return;
        };
        let span = self.span(token);
        if let (Times::Once, Some(first)) = (key.times, outcome.place(key.name)) {
            let message = format!("`{}` is written twice; the last one counts", key.name);
            self.diagnostics.push(Diagnostic::warning(span, message).label(first, "first written here"));
        }
        outcome.seen.push((key.name, span));
        self.context = Context { name: key.name, example: key.example };
        let after = self.lexer;
        if (key.read)(self, draft, span).is_err() {
            outcome.failed = true;
            self.recover(after, Depth::Any, grammar.keys, outcome);
        }
    }

    fn key<'k, B>(&self, token: Token, keys: &'k [Key<B>]) -> Option<&'k Key<B>> {
        let word = token.bytes(&self.bytes);
        keys.iter().find(|key| key.name.as_bytes() == word)
    }

    fn key_follows<B>(&self, keys: &[Key<B>]) -> bool {
        self.peek().is_some_and(|token| self.key(token, keys).is_some() && !self.starts_block(token))
    }

    fn unknown_key<B>(&mut self, token: Token, grammar: &Grammar<'_, B>, outcome: &mut Outcome) {
        let what = grammar.what;
        let span = self.span(token);
        let names = || grammar.keys.iter().map(|key| key.name);
        let diagnostic = if number::float::<f64>(token.bytes(&self.bytes)).is_some() {
            let message = format!("expected a keyword of `{what}`, found the number `{}`", self.shown(token));
            match outcome.seen.last() {
                Some((key, _)) => {
                    Diagnostic::error(span, message).hint(format!("`{key}` takes no further number here"))
                }
                None => Diagnostic::error(span, message),
            }
        } else if self.holds_glued_brace(token) {
            let message = format!("expected a keyword of `{what}`, found `{}`", self.shown(token));
            Diagnostic::error(span, message).hint("put a blank on both sides of every brace")
        } else if self.is(token, "{") {
            Diagnostic::error(span, format!("expected a keyword of `{what}`, found `{{`"))
        } else {
            let word = Spanned::new(self.text(token), span);
            let nearest = suggest::nearest(&word.value, names());
            if let Some(meant) = names().find(|name| Some(*name) == nearest) {
                outcome.seen.push((meant, span));
            }
            let mut diagnostic = unknown_word("keyword", &word, names());
            diagnostic.message = format!("unknown keyword `{}` in `{what}`", shorten(&word.value));
            diagnostic
        };
        self.diagnostics.push(diagnostic);
    }

    /// After an error: on to the next keyword, to the end of the block, or to the next block. `from` is where the value
    /// began, so that braces are counted from there.
    fn recover<B>(&mut self, from: Lexer, mut reach: Depth, keys: &[Key<B>], outcome: &mut Outcome) {
        self.lexer = from;
        let mut depth = 0;
        loop {
            let before = self.lexer;
            let Some(token) = self.next() else { return };
            if self.is(token, "{") {
                depth += 1;
            } else if self.is(token, "}") && depth > 0 {
                depth -= 1;
                // The group in which the error stands is closed: what is in later ones is theirs.
                if depth == 0 && token.start >= self.failed_at {
                    reach = Depth::Outer;
                }
            } else if self.is(token, "<code>") {
                self.lexer.skip_code(&self.bytes);
            } else if self.is(token, "}") || self.starts_block(token) {
                self.lexer = before;
                return;
            } else if token.start >= self.failed_at
                && (depth == 0 || reach == Depth::Any)
                && self.key(token, keys).is_some()
            {
                outcome.unsure |= depth > 0;
                self.lexer = before;
                return;
            }
        }
    }

    /// Reports a block that ends with the file or where the next one starts, unless it is broken anyway.
    fn unclosed(&mut self, head: Token, outcome: &mut Outcome, next: Option<Token>) {
        outcome.cut = true;
        if outcome.failed {
            return;
        }
        let message = format!("this `{}` is never closed", self.shown(head));
        let mut diagnostic = Diagnostic::error(self.span(head), message).hint("add the missing `}`");
        if let Some(next) = next {
            diagnostic = diagnostic.label(self.span(next), "the next block starts here");
        }
        self.diagnostics.push(diagnostic);
    }

    /// Name and type of the block in which the cursor stands, as far as they stand before the type's arguments.
    pub(super) fn outline(&self) -> Outline {
        self.scan(self.lexer, Reach::Type).0
    }

    /// Passes the rest of a block without reading it, and tells its name and type. What is wrong with it is told in
    /// `remark`, unless its end is not to be found, which may be the reason.
    pub(super) fn skip_block(&mut self, head: Token, remark: Option<Diagnostic>) -> Outline {
        let (outline, lexer, closed) = self.scan(self.lexer, Reach::WholeBlock);
        self.lexer = lexer;
        if closed {
            remark.into_iter().for_each(|remark| self.diagnostics.push(remark));
        } else {
            let message = format!("this `{}` is never closed", self.shown(head));
            self.diagnostics.push(Diagnostic::error(self.span(head), message).hint("add the missing `}`"));
        }
        outline
    }

    /// Walks over a block whose `{` has been passed; the last result is whether its end was found.
    fn scan(&self, mut lexer: Lexer, reach: Reach) -> (Outline, Lexer, bool) {
        let mut outline = Outline::default();
        let mut depth = 0;
        loop {
            let before = lexer;
            let Some(token) = lexer.next(&self.bytes) else { return (outline, lexer, false) };
            match token.bytes(&self.bytes) {
                b"{" => depth += 1,
                b"}" if depth == 0 => return (outline, lexer, true),
                b"}" => depth -= 1,
                b"<code>" => lexer.skip_code(&self.bytes),
                b"name" if depth == 0 && outline.name.is_none() => outline.name = self.value_of(&mut lexer),
                b"type" if depth == 0 && outline.kind.is_none() => {
                    outline.kind = self.value_of(&mut lexer);
                    if reach == Reach::Type {
                        return (outline, lexer, true);
                    }
                }
                _ => {
                    let mut at = lexer;
                    if self.starts_block_at(token, &mut at) {
                        return (outline, before, false);
                    }
                }
            }
        }
    }

    /// The word after `name` or `type`.
    fn value_of(&self, lexer: &mut Lexer) -> Option<Name> {
        let before = *lexer;
        let token = lexer.next(&self.bytes)?;
        if self.is(token, "{") || self.is(token, "}") {
            *lexer = before;
            return None;
        }
        Some(Spanned::new(self.text(token), self.span(token)))
    }

    /// Whether `token`, just passed, starts a block at top level: such a word and `{` stand in no block.
    pub(super) fn starts_block(&self, token: Token) -> bool {
        let mut lexer = self.lexer;
        self.starts_block_at(token, &mut lexer)
    }

    fn starts_block_at(&self, token: Token, after: &mut Lexer) -> bool {
        super::statement::is_block(token.bytes(&self.bytes))
            && after.next(&self.bytes).is_some_and(|next| self.is(next, "{"))
    }

    /// Passes a group in braces whose `{` has been passed, as far as its `}`.
    pub(super) fn skip_group(&mut self) {
        let (_, lexer, _) = self.scan(self.lexer, Reach::WholeBlock);
        self.lexer = lexer;
    }

    /// Reports all `required` keywords that the block lacks. Each comes with its alternatives and a correct use.
    pub(super) fn require(&mut self, what: &str, outcome: &Outcome, head: Span, required: &[Required]) {
        let lacks = |(keys, _): &&Required| !keys.iter().any(|key| outcome.has(key));
        let missing: Vec<&Required> = required.iter().filter(lacks).collect();
        if missing.is_empty() || outcome.cut {
            return;
        }
        let keys: Vec<String> = missing.iter().map(|(keys, _)| suggest::list(keys.iter().copied())).collect();
        let forms: Vec<&str> = missing.iter().map(|(_, form)| *form).collect();
        let message = format!("`{what}` lacks {}", suggest::join(&keys, "and"));
        self.diagnostics.push(Diagnostic::error(head, message).hint(format!("add `{}`", forms.join(" "))));
    }
}
