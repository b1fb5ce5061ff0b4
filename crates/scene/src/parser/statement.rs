//! The top level of a file: which words start a statement, and what happens between them.

use super::value::{shorten, unknown_word};
use super::{Context, Parsed, Parser, camera, gi, image, include, light, modifier, object, shader};
use crate::description::{Dialect, Filter};
use crate::diagnostic::Diagnostic;
use crate::lexer::Token;
use crate::source::Spanned;
use crate::suggest;

/// How a statement goes on after its keyword.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    /// `{ … }`.
    Block,
    /// A few words.
    Line,
}

struct Statement {
    name: &'static str,
    form: Form,
    /// A correct use of it, for hints.
    example: &'static str,
    read: fn(&mut Parser<'_>, Token) -> Parsed<()>,
}

const fn block(name: &'static str, read: fn(&mut Parser<'_>, Token) -> Parsed<()>) -> Statement {
    Statement { name, form: Form::Block, example: "", read }
}

const fn line(name: &'static str, example: &'static str, read: fn(&mut Parser<'_>, Token) -> Parsed<()>) -> Statement {
    Statement { name, form: Form::Line, example, read }
}

/// Everything that may stand at top level (format reference, §2.0), and our own `dialect`.
const STATEMENTS: &[Statement] = &[
    block("image", image::image),
    block("background", image::background),
    block("trace-depths", image::trace_depths),
    block("camera", camera::camera),
    block("light", light::light),
    block("shader", shader::shader),
    block("object", object::object),
    block("instance", object::instance),
    block("gi", gi::gi),
    block("photons", gi::photons),
    block("lightserver", gi::lightserver),
    block("modifier", modifier::modifier),
    block("texture", modifier::texture),
    line("include", "include \"file.sc\"", include::include),
    line("includepath", "includepath \"folder\"", include::include_path),
    line("texturepath", "texturepath \"folder\"", include::texture_path),
    line("override", "override NAME false", override_shader),
    line("dialect", "dialect report", dialect),
    line("filter", "filter mitchell", filter),
    line("bucket", "bucket 32 hilbert", bucket),
    line("accel", "accel bih", accel),
];

/// Whether the word, followed by `{`, starts a block at top level.
pub(super) fn is_block(word: &[u8]) -> bool {
    STATEMENTS.iter().any(|statement| statement.form == Form::Block && statement.name.as_bytes() == word)
}

impl Parser<'_> {
    /// Reads all statements of the current file; the result is how many there were.
    pub(super) fn statements(&mut self) -> usize {
        let mut count = 0;
        while let Some(token) = self.next() {
            let word = token.bytes(&self.bytes);
            let Some(statement) = STATEMENTS.iter().find(|statement| statement.name.as_bytes() == word) else {
                self.unknown_statement(token);
                continue;
            };
            count += 1;
            self.context = Context { name: statement.name, example: statement.example };
            if (statement.read)(self, token).is_err() {
                self.skip_to_statement();
            }
        }
        if let Some(start) = self.lexer.unclosed_quote {
            let quote = self.span(Token { start, end: start + 1 });
            let message = "this quotation ends with its line";
            self.diagnostics.push(Diagnostic::warning(quote, message).hint("add the closing `\"`"));
        }
        if let Some(start) = self.lexer.unclosed_comment {
            let opening = self.span(Token { start, end: start + 2 });
            let message = "this block comment is never closed, and hides the rest of the file";
            self.diagnostics.push(Diagnostic::warning(opening, message).hint("end it with the word `*/`"));
        }
        count
    }

    /// On to the next word that starts a statement.
    fn skip_to_statement(&mut self) {
        loop {
            let before = self.lexer;
            let Some(token) = self.next() else { return };
            let word = token.bytes(&self.bytes);
            let starts = STATEMENTS.iter().any(|s| s.form == Form::Line && s.name.as_bytes() == word);
            if starts || self.starts_block(token) {
                self.lexer = before;
                return;
            }
        }
    }

    fn unknown_statement(&mut self, token: Token) {
        let span = self.span(token);
        if self.is(token, "}") {
            self.loose(super::loose::Loose::StrayBrace, span);
            return;
        }
        if self.is(token, "{") {
            self.diagnostics.push(Diagnostic::error(span, "this `{` follows no keyword"));
            self.skip_group();
            return;
        }
        let text = self.text(token);
        let glued = text.strip_suffix('{').filter(|word| is_block(word.as_bytes()));
        if let Some(keyword) = glued {
            let message = format!("unknown keyword `{}`", shorten(&text));
            let hint = format!("put a blank before the brace: `{keyword} {{`");
            self.diagnostics.push(Diagnostic::error(span, message).hint(hint));
            self.skip_group();
            return;
        }
        let names = STATEMENTS.iter().map(|statement| statement.name);
        self.diagnostics.push(match suggest::nearest(&text, names) {
            Some(nearest) => Diagnostic::error(span, format!("unknown keyword `{}`", shorten(&text)))
                .hint(format!("did you mean `{nearest}`?")),
            None => Diagnostic::warning(span, format!("skipped: unknown keyword `{}`", shorten(&text))),
        });
        if self.take("{").is_some() {
            self.skip_group();
        } else {
            self.skip_to_statement();
        }
    }

    /// The remark on a block without `type`.
    pub(super) fn missing_type(
        &self,
        head: Token,
        what: &str,
        names: impl Iterator<Item = &'static str>,
    ) -> Diagnostic {
        let diagnostic = Diagnostic::error(self.span(head), format!("`{what}` lacks `type`"));
        diagnostic.hint(format!("types are {}", suggest::list_all(names)))
    }
}

fn override_shader(parser: &mut Parser<'_>, _: Token) -> Parsed<()> {
    let name = parser.word("the name of a shader")?;
    let next = parser.peek();
    if next.is_none_or(|token| STATEMENTS.iter().any(|statement| parser.is(token, statement.name))) {
        return Err(parser.expected("`true` or `false` after the name", next));
    }
    parser.scene.override_photons = parser.boolean()?.value;
    parser.scene.override_shader = (name.value != "none").then_some(name);
    Ok(())
}

fn dialect(parser: &mut Parser<'_>, _: Token) -> Parsed<()> {
    let choices: Vec<_> = Dialect::ALL.iter().map(|&dialect| (dialect.name(), dialect)).collect();
    let dialect = parser.choice("a dialect", &choices)?;
    if let Some(first) = parser.scene.dialect.filter(|first| first.value != dialect.value) {
        let diagnostic = Diagnostic::error(dialect.span, "the scene names two dialects");
        parser.diagnostics.push(diagnostic.label(first.span, "first named here").hint("keep one of them"));
        return Ok(());
    }
    parser.scene.dialect.get_or_insert(dialect);
    Ok(())
}

/// `filter NAME [WIDTH HEIGHT]`, the old place of the filter; the sizes mean nothing.
fn filter(parser: &mut Parser<'_>, _: Token) -> Parsed<()> {
    parser.filter()?;
    for _ in 0..2 {
        if parser.number_follows() {
            parser.number::<f32>()?;
        }
    }
    Ok(())
}

/// `bucket SIZE ORDER`: in which squares and in which order Sunflow renders, which can hardly be seen.
fn bucket(parser: &mut Parser<'_>, _: Token) -> Parsed<()> {
    let size = parser.spanned(Parser::int)?;
    let value = parser.clamped("the size of a bucket", size, 16, 512) as u32;
    let order = parser.word("a bucket order")?;
    parser.scene.image.bucket = Some(Spanned::new(value, size.span));
    let name = order.value.rsplit_once(' ').filter(|(prefix, _)| REVERSED.contains(prefix));
    let name = name.map_or(order.value.as_str(), |(_, name)| name);
    if !ORDERS.contains(&name) {
        let mut diagnostic = unknown_word("bucket order", &order, ORDERS.into_iter());
        diagnostic.severity = crate::Severity::Warning;
        parser.diagnostics.push(diagnostic);
    }
    Ok(())
}

/// Orders of buckets, and what may stand before them within the quotes.
const ORDERS: [&str; 6] = ["column", "diagonal", "hilbert", "random", "row", "spiral"];
const REVERSED: [&str; 3] = ["reverse", "inverse", "invert"];

/// Sunflow ignores it as well.
fn accel(parser: &mut Parser<'_>, _: Token) -> Parsed<()> {
    parser.word("the name of an acceleration structure").map(drop)
}

/// Filters by their names in the format.
pub(crate) const FILTERS: &[(&str, Filter)] = &[
    ("box", Filter::Box),
    ("triangle", Filter::Triangle),
    ("gaussian", Filter::Gaussian),
    ("mitchell", Filter::Mitchell),
    ("catmull-rom", Filter::CatmullRom),
    ("blackman-harris", Filter::BlackmanHarris),
    ("sinc", Filter::Sinc),
    ("lanczos", Filter::Lanczos),
    ("bspline", Filter::Bspline),
];

impl Parser<'_> {
    /// Reads a filter; as in Sunflow an unknown one is `box`.
    pub(super) fn filter(&mut self) -> Parsed<()> {
        let word = self.word("a filter")?;
        let filter = FILTERS.iter().find(|(name, _)| *name == word.value).map(|(_, filter)| *filter);
        if filter.is_none() {
            let names = FILTERS.iter().map(|(name, _)| *name);
            let mut diagnostic = unknown_word("filter", &word, names);
            diagnostic.severity = crate::Severity::Warning;
            diagnostic.message.push_str("; `box` is used");
            self.diagnostics.push(diagnostic);
        }
        self.scene.image.filter = Some(Spanned::new(filter.unwrap_or_default(), word.span));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_on_the_format_has_every_word() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/format.md");
        let page = std::fs::read_to_string(path).expect("the page exists");
        let is_word = |c: char| c.is_alphanumeric() || "-._".contains(c);
        let written: std::collections::HashSet<&str> = page.split(|c| !is_word(c)).collect();
        let statements = STATEMENTS.iter().map(|statement| statement.name);
        let filters = FILTERS.iter().map(|(name, _)| *name);
        let all = statements.chain(filters).chain(image::words()).chain(camera::words()).chain(light::words());
        let all = all.chain(shader::words()).chain(object::words()).chain(gi::words()).chain(modifier::words());
        let all: Vec<&str> = all.chain(ORDERS).collect();
        assert!(all.len() > 120, "{}", all.len());
        let missing: Vec<&&str> = all.iter().filter(|word| !written.contains(**word)).collect();
        assert!(missing.is_empty(), "docs/format.md lacks {missing:?}");
    }
}
