//! Reads the generic forms of a scene, `.sca` (text) and `.scb` (binary): the calls of Sunflow's programming interface, one after the
//! other (format reference, §6).
//!
//! ```text
//! words or bytes ──▶ parameters, then what they are for ──▶ the same description as of a `.sc` file
//! ```

mod binary;
mod camera;
mod geometry;
mod light;
mod options;
mod shader;
mod text;
mod value;

use super::value::shorten;
use super::{Parser, include};
use crate::description::Name;
use crate::diagnostic::Diagnostic;
use crate::source::{Span, Spanned};
use value::Parameters;

/// What a statement declares.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Geometry,
    Instance,
    Shader,
    Modifier,
    Light,
    Camera,
    Options,
}

/// The options of the scene as a whole.
const SCENE_OPTIONS: &str = "::options";
/// In place of a type: more parameters for something that exists.
const INCREMENTAL: &str = "incremental";

/// The state of reading one such file.
#[derive(Debug, Default)]
struct Generic {
    /// Those that wait for what they are for.
    parameters: Parameters,
}

/// Reads the text of the current file; the result is its number of statements.
pub(super) fn statements(parser: &mut Parser<'_>) -> usize {
    text::statements(parser)
}

/// Reads the bytes of the current file; the result is its number of statements.
pub(super) fn binary(parser: &mut Parser<'_>) -> usize {
    binary::statements(parser)
}

impl Generic {
    /// Declares something with the parameters that have gathered. `span` is the statement.
    fn declare(&mut self, parser: &mut Parser<'_>, kind: Kind, name: Name, class: Option<Name>, span: Span) {
        let mut parameters = std::mem::take(&mut self.parameters);
        let Some(class) = class.filter(|_| kind != Kind::Options) else {
            if name.value == SCENE_OPTIONS {
                options::apply(parser, &mut parameters);
            }
            parameters.report(parser);
            return;
        };
        if class.value == INCREMENTAL {
            let message = format!("skipped: the change of `{}` is not supported", shorten(&name.value));
            let hint = "give it all of its parameters where it is declared";
            parser.diagnostics.push(Diagnostic::warning(span, message).hint(hint));
            return;
        }
        let known = match kind {
            Kind::Geometry => geometry::geometry(parser, &mut parameters, &name, &class, span),
            Kind::Instance => geometry::instance(parser, &mut parameters, &name, &class, span),
            Kind::Shader => shader::shader(parser, &mut parameters, &name, &class, span),
            Kind::Modifier => shader::modifier(parser, &mut parameters, &name, &class, span),
            Kind::Light => light::light(parser, &mut parameters, &name, &class, span),
            Kind::Camera => camera::camera(parser, &mut parameters, &class, span),
            Kind::Options => true,
        };
        if !known {
            let message = format!("skipped: unknown type `{}`", shorten(&class.value));
            parser.diagnostics.push(Diagnostic::warning(class.span, message));
            return;
        }
        parameters.report(parser);
    }
}

impl Parser<'_> {
    /// Follows `include FILE`.
    fn generic_include(&mut self, name: Name, span: Span) {
        include::follow(self, name, span);
    }

    /// `searchpath texture|include FOLDER`.
    fn search_path(&mut self, kind: &str, folder: Name) {
        match kind {
            "texture" => include::add_texture_folder(self, &folder),
            _ => include::add_include_folder(self, &folder),
        }
    }
}

/// A name that is not written anywhere.
fn unwritten(name: &str, span: Span) -> Name {
    Spanned::new(name.to_owned(), span)
}
