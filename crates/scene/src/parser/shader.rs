//! Reads the `shader` block: the plain shaders by their table, the procedural ones by their declarations.

use jaspe_texture::Texture;
use jaspe_texture::declare::{Declaration, Kind};

use super::block::{Grammar, Key, Required};
pub(super) use super::shader_types::Draft;
use super::shader_types::{NAME, NAME_REQUIRED, SHADERS, ShaderType, TYPE};
use super::value::unknown_word;
use super::{Context, Failed, Namespace, Parsed, Parser};
use crate::description::{Name, Setting, SettingValue, Shader, ShaderKind};
use crate::diagnostic::Diagnostic;
use crate::lexer::Token;
use crate::source::{Span, Spanned};

/// The shader that is written in Java.
const JAVA: &str = "janino";

/// How a shader type is read.
pub(super) enum Type {
    Plain(&'static ShaderType),
    Procedural(&'static Declaration),
}

/// The shader type called so.
pub(super) fn type_called(name: &str) -> Option<Type> {
    let plain = SHADERS.iter().find(|shader| shader.name == name).map(Type::Plain);
    let procedural = || Texture::ALL.iter().find(|d| d.name == name).map(|d| Type::Procedural(d));
    plain.or_else(procedural)
}

fn type_names() -> impl Iterator<Item = &'static str> + Clone {
    SHADERS.iter().map(|shader| shader.name).chain(Texture::ALL.iter().map(|d| d.name))
}

impl Type {
    /// The keywords that it takes: those of a procedural shader come from its declaration.
    pub fn keys(&self) -> Vec<Key<Draft>> {
        match self {
            Type::Plain(shader) => shader.keys.to_vec(),
            Type::Procedural(declaration) => parameter_keys(declaration),
        }
    }

    /// What the draft means, if nothing is missing; the span stands for values that were not written.
    pub fn build(&self, draft: Draft, span: Span) -> Option<ShaderKind> {
        match self {
            Type::Plain(shader) => (shader.build)(draft, span),
            Type::Procedural(declaration) => Some(ShaderKind::Procedural { declaration, settings: draft.settings }),
        }
    }

    fn required(&self) -> Vec<Required> {
        let own = match self {
            Type::Plain(shader) => shader.required,
            Type::Procedural(_) => &[],
        };
        [NAME_REQUIRED].iter().chain(own).copied().collect()
    }
}

/// The keywords of a procedural material.
pub(super) fn parameter_keys(declaration: &Declaration) -> Vec<Key<Draft>> {
    let parameters = declaration.parameters.iter();
    [NAME, TYPE].into_iter().chain(parameters.map(|p| Key::new(p.name, "", parameter_value))).collect()
}

impl Draft {
    /// An empty draft of a procedural shader.
    pub fn procedural(declaration: &'static Declaration) -> Self {
        Draft { declaration: Some(declaration), ..Draft::default() }
    }
}

pub(super) fn shader(parser: &mut Parser<'_>, head: Token) -> Parsed<()> {
    parser.open("shader")?;
    let found = match parser.outline().kind {
        None => Err(parser.missing_type(head, "shader", type_names())),
        Some(kind) => match type_called(&kind.value) {
            Some(shader) => Ok((kind, shader)),
            None if kind.value == JAVA => Err(java(parser.span(head), "the shader", "a grey stands in")),
            None => Err(unknown_word("shader type", &kind, type_names())),
        },
    };
    let (kind, shader) = match found {
        Ok(found) => found,
        Err(remark) => {
            let outline = parser.skip_block(head, Some(remark));
            parser.stand_in(outline.name, head);
            return Ok(());
        }
    };
    let mut draft = match shader {
        Type::Procedural(declaration) => Draft::procedural(declaration),
        _ => Draft::default(),
    };
    let grammar = Grammar { what: &kind.value, keys: &shader.keys(), bare: None };
    let outcome = parser.block(head, &grammar, &mut draft);
    let place = parser.span(head);
    parser.require(&kind.value, &outcome, place, &shader.required());
    // Its colour may stand without a keyword, which `require` cannot see.
    if kind.value == "constant" && draft.diffuse.is_none() && !outcome.failed {
        let diagnostic = Diagnostic::error(place, "`constant` lacks `color`").hint("add `color 1 1 1`");
        parser.diagnostics.push(diagnostic);
    }
    if let Some(name) = draft.name.take() {
        // What lacks a value has been reported, and keeps its name for those who use it.
        let kind = shader.build(draft, outcome.span).unwrap_or(ShaderKind::Unsupported);
        parser.add_shader(Shader { name, kind, span: outcome.span });
    }
    Ok(())
}

impl Parser<'_> {
    /// Keeps the name of a shader that could not be read, so that objects find it.
    fn stand_in(&mut self, name: Option<Name>, head: Token) {
        let end = self.lexer.position() as u32;
        let span = Span { end, ..self.span(head) };
        if let Some(name) = name {
            self.add_shader(Shader { name, kind: ShaderKind::Unsupported, span });
        }
    }

    fn add_shader(&mut self, shader: Shader) {
        self.declare(Namespace::Shader, &shader.name);
        self.scene.shaders.push(shader);
    }
}

/// The remark on something written in Java, which takes a compiler to read.
pub(super) fn java(span: Span, what: &str, consequence: &str) -> Diagnostic {
    let message = format!("skipped: {what} is written in Java (`janino`), which cannot be read: {consequence}");
    Diagnostic::warning(span, message).hint("write it with the other types of this format")
}

/// Reads the value of a declared parameter.
fn parameter_value(parser: &mut Parser<'_>, draft: &mut Draft, key: Span) -> Parsed<()> {
    let Context { name, .. } = parser.context;
    if let Some(Kind::Color) = draft.declaration.and_then(|d| d.parameter(name)).map(|p| p.kind) {
        parser.context.example = "{ \"sRGB nonlinear\" 1 0.5 0 }";
    }
    let parameter = draft.declaration.and_then(|declaration| declaration.parameter(name));
    let parameter = parameter.expect("the keywords are made of the parameters");
    let value = parser.spanned(|parser| match parameter.kind {
        Kind::Int { min, max } => {
            let value = parser.spanned(Parser::int)?;
            parser.require_range(value, min, max, i64::MAX)?;
            Ok(SettingValue::Int(value.value))
        }
        Kind::Float { min, max } => {
            let value = parser.spanned(Parser::number::<f64>)?;
            parser.require_range(value, min, max, f64::MAX)?;
            Ok(SettingValue::Float(value.value))
        }
        Kind::Color => Ok(SettingValue::Color(parser.color()?)),
        Kind::Choice(words) => {
            let choices: Vec<(&'static str, &'static str)> = words.iter().map(|word| (*word, *word)).collect();
            let what = format!("`{name}`");
            Ok(SettingValue::Choice(parser.choice(what.trim_matches('`'), &choices)?.value))
        }
    })?;
    draft.settings.retain(|setting| setting.name != parameter.name);
    draft.settings.push(Setting { name: parameter.name, value: value.value, span: key.to(value.span) });
    Ok(())
}

impl Parser<'_> {
    /// Reports a value out of its range; a range up to `unlimited` has no upper end.
    fn require_range<T: PartialOrd + std::fmt::Display>(
        &mut self,
        value: Spanned<T>,
        min: T,
        max: T,
        unlimited: T,
    ) -> Parsed<()> {
        if value.value >= min && value.value <= max {
            return Ok(());
        }
        let range = match max >= unlimited {
            true => format!("at least {min}"),
            false => format!("from {min} to {max}"),
        };
        let message = format!("`{}` must be {range}, and is {}", self.context.name, value.value);
        self.failed_at = value.span.end;
        self.diagnostics.push(Diagnostic::error(value.span, message));
        Err(Failed)
    }
}

/// All words of the block, for the test of the page on the format.
#[cfg(test)]
pub(super) fn words() -> impl Iterator<Item = &'static str> {
    let keys = SHADERS.iter().flat_map(|shader| shader.keys).map(|key| key.name);
    let keys = keys.filter(|name| !name.starts_with("absorbtion"));
    keys.chain(type_names()).chain([JAVA])
}
