//! The text form, `.sca`.

use super::super::value::{shorten, unknown_word};
use super::super::{Context, Parsed, Parser};
use super::value::{Interpolation, Value};
use super::{Generic, Kind, SCENE_OPTIONS};
use crate::description::Name;
use crate::diagnostic::Diagnostic;
use crate::lexer::Token;
use crate::number;
use crate::source::Spanned;

/// What the words mean, each with its short forms.
const STATEMENTS: &[(&[&str], Statement)] = &[
    (&["parameter", "param", "p"], Statement::Parameter),
    (&["geometry", "geom", "g"], Statement::Declare(Kind::Geometry)),
    (&["instance", "inst", "i"], Statement::Declare(Kind::Instance)),
    (&["shader", "shd", "s"], Statement::Declare(Kind::Shader)),
    (&["modifier", "mod", "m"], Statement::Declare(Kind::Modifier)),
    (&["light", "l"], Statement::Declare(Kind::Light)),
    (&["camera", "cam", "c"], Statement::Declare(Kind::Camera)),
    (&["options", "opt", "o"], Statement::Declare(Kind::Options)),
    (&["include", "inc"], Statement::Include),
    (&["searchpath"], Statement::SearchPath),
    (&["remove"], Statement::Remove),
    (&["frame"], Statement::Frame),
    (&["plugin", "plug"], Statement::Plugin),
    (&["reset"], Statement::Reset),
];

#[derive(Debug, Clone, Copy)]
enum Statement {
    Parameter,
    Declare(Kind),
    Include,
    SearchPath,
    Remove,
    Frame,
    Plugin,
    Reset,
}

/// Types of values, each with its short forms.
const TYPES: &[(&[&str], Type)] = &[
    (&["string", "str"], Type::String),
    (&["boolean", "bool"], Type::Bool),
    (&["integer", "int"], Type::Int),
    (&["float", "flt"], Type::Float),
    (&["color", "col"], Type::Color),
    (&["point", "pnt", "vector", "vec"], Type::Point),
    (&["texcoord", "tex"], Type::TexCoord),
    (&["matrix", "mat"], Type::Matrix),
];

#[derive(Debug, Clone, Copy)]
enum Type {
    String,
    Bool,
    Int,
    Float,
    Color,
    Point,
    TexCoord,
    Matrix,
}

const INTERPOLATIONS: &[(&str, Interpolation)] = &[
    ("none", Interpolation::None),
    ("vertex", Interpolation::Vertex),
    ("face", Interpolation::Face),
    ("facevarying", Interpolation::FaceVarying),
];

pub(super) fn statements(parser: &mut Parser<'_>) -> usize {
    let mut generic = Generic::default();
    let mut count = 0;
    while let Some(token) = parser.next() {
        let found = STATEMENTS.iter().find(|(words, _)| words.iter().any(|word| parser.is(token, word)));
        let Some((words, statement)) = found else {
            let word = Spanned::new(parser.text(token), parser.span(token));
            let names = STATEMENTS.iter().map(|(words, _)| words[0]);
            parser.diagnostics.push(unknown_word("statement", &word, names));
            skip(parser);
            continue;
        };
        count += 1;
        parser.context = Context { name: words[0], example: "" };
        if one(parser, &mut generic, *statement, token).is_err() {
            skip(parser);
        }
    }
    count
}

/// On to the next word that starts a statement and is no short form, which could be anything.
fn skip(parser: &mut Parser<'_>) {
    loop {
        let before = parser.lexer;
        let Some(token) = parser.next() else { return };
        let starts =
            |(words, _): &(&[&str], Statement)| words.iter().any(|word| word.len() > 1 && parser.is(token, word));
        if STATEMENTS.iter().any(starts) {
            parser.lexer = before;
            return;
        }
    }
}

fn one(parser: &mut Parser<'_>, generic: &mut Generic, statement: Statement, head: Token) -> Parsed<()> {
    match statement {
        Statement::Parameter => {
            let name = parser.word("the name of a parameter")?;
            let value = value(parser)?;
            generic.parameters.push(name, value);
        }
        Statement::Declare(Kind::Options) => {
            let name = parser.word("the name of options, such as `::options`")?;
            let span = parser.span(head).to(name.span);
            generic.declare(parser, Kind::Options, name, None, span);
        }
        Statement::Declare(kind) => {
            let name = parser.word("a name")?;
            let class = parser.word("a type")?;
            let span = parser.span(head).to(class.span);
            generic.declare(parser, kind, name, Some(class), span);
        }
        Statement::Include => {
            let name = parser.word("a file name")?;
            let span = parser.span(head).to(name.span);
            parser.generic_include(name, span);
        }
        Statement::SearchPath => {
            let kind = parser.choice("a kind of search path", &[("texture", "texture"), ("include", "include")])?;
            let folder = parser.word("a folder")?;
            parser.search_path(kind.value, folder);
        }
        Statement::Remove => {
            let name = parser.word("a name")?;
            let message = format!("skipped: `{}` is not removed", shorten(&name.value));
            parser.diagnostics.push(Diagnostic::warning(name.span, message));
        }
        Statement::Frame => parser.int().map(drop)?,
        Statement::Plugin => {
            let [kind, name] = [parser.word("a kind of plugin")?, parser.word("a name")?];
            if parser.take("<code>").is_some() {
                let bytes = parser.bytes.clone();
                parser.lexer.skip_code(&bytes);
            }
            let span = kind.span.to(name.span);
            parser.diagnostics.push(super::super::shader::java(span, "the plugin", "it is left out"));
        }
        Statement::Reset => {
            let message =
                format!("skipped: `reset` does not clear what was read; `{SCENE_OPTIONS}` and all names stay");
            parser.diagnostics.push(Diagnostic::warning(parser.span(head), message));
        }
    }
    Ok(())
}

/// A type and a value of that type; after `[]` a list of them.
fn value(parser: &mut Parser<'_>) -> Parsed<Value> {
    let word = parser.word("a type")?;
    let (name, is_list) = match word.value.strip_suffix("[]") {
        Some(name) => (name, true),
        None => (word.value.as_str(), false),
    };
    let Some((_, kind)) = TYPES.iter().find(|(words, _)| words.contains(&name)) else {
        let names = TYPES.iter().map(|(words, _)| words[0]);
        let diagnostic = unknown_word("type of value", &word, names);
        parser.failed_at = word.span.end;
        parser.diagnostics.push(diagnostic);
        return Err(super::super::Failed);
    };
    if is_list { list(parser, *kind, &word) } else { single(parser, *kind) }
}

fn single(parser: &mut Parser<'_>, kind: Type) -> Parsed<Value> {
    Ok(match kind {
        Type::String => Value::String(parser.word("a word")?),
        Type::Bool => Value::Bool(parser.boolean()?.value),
        Type::Int => Value::Int(parser.int()?),
        Type::Float => Value::Float(parser.number()?),
        Type::Color => Value::Color(parser.color_in_space()?),
        Type::Point => Value::Point(parser.numbers()?),
        // Nothing takes a single one.
        Type::TexCoord => Value::TexCoords(Interpolation::None, vec![parser.numbers()?]),
        Type::Matrix => Value::Matrix(parser.still_transform()?),
    })
}

fn list(parser: &mut Parser<'_>, kind: Type, word: &Name) -> Parsed<Value> {
    if let Type::String | Type::Int = kind {
        let count = parser.count()?;
        return Ok(match kind {
            Type::String => Value::Strings((0..count).map(|_| parser.word("a word")).collect::<Parsed<_>>()?),
            _ => Value::Ints((0..count).map(|_| parser.int()).collect::<Parsed<_>>()?),
        });
    }
    let interpolation = parser.choice("an interpolation", INTERPOLATIONS)?.value;
    let count = parser.count()?;
    Ok(match kind {
        Type::Float => Value::Floats(numbers::<1>(parser, word, count)?.into_iter().flatten().collect()),
        Type::Point => Value::Points(interpolation, numbers(parser, word, count)?),
        Type::TexCoord => Value::TexCoords(interpolation, numbers(parser, word, count)?),
        _ => {
            let message = format!("there are no lists of `{}`", shorten(&word.value));
            return Err(parser.refuse(word.span, message));
        }
    })
}

/// So many tuples of numbers.
fn numbers<const N: usize>(parser: &mut Parser<'_>, word: &Name, count: usize) -> Parsed<Vec<[f32; N]>> {
    let list = parser.list(word.span, count, number::float::<f32>)?;
    parser.check_count(&list, count)?;
    Ok(list.values)
}
