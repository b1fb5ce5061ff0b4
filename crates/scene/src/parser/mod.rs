//! Turns words into a [`Scene`]: the second stage of reading, `tokens ──parse──▶ Scene + Diagnostics`.
//!
//! Every block declares its keywords once, in a table of [`block::Key`]s beside the function that reads each value;
//! "did you mean", the hints and `--set` walk the same tables. An error is reported where it is found and reading goes
//! on at the next keyword, the end of the block, or the next block, so that one run tells all there is to tell, and
//! each mistake once. Names stay text: resolving them is left to the renderer.

mod block;
mod camera;
mod color;
mod generic;
mod gi;
mod image;
mod include;
mod light;
mod list;
mod loose;
mod mesh;
mod modifier;
mod object;
mod set;
mod shader;
mod shader_types;
mod shape;
mod statement;
mod transform;
mod value;

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::io;
use std::path::Path;
use std::sync::Arc;

use crate::description::{Name, Scene};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::lexer::{Lexer, Syntax, Token};
use crate::source::{Loader, Span};

pub(crate) use image::SAMPLERS;
pub use set::set;
pub(crate) use statement::FILTERS;

/// Reads the scene at `path`, with everything that it includes.
///
/// There is always a scene; whether it may be rendered, [`Diagnostics::has_errors`] tells.
pub fn read(path: &Path, loader: &dyn Loader) -> (Scene, Diagnostics) {
    match loader.load(path) {
        Ok(bytes) => parse(path, bytes, loader),
        Err(error) => {
            let mut diagnostics = Diagnostics::default();
            diagnostics.push(Diagnostic::error(None, unreadable(path, &error)));
            (Scene::default(), diagnostics)
        }
    }
}

/// Reads a scene from memory. `path` is what messages call it, and includes are looked for beside it.
pub fn parse(path: &Path, bytes: impl Into<Arc<[u8]>>, loader: &dyn Loader) -> (Scene, Diagnostics) {
    let mut parser = Parser::new(loader);
    parser.main_file(path, bytes.into());
    parser.diagnostics.sort();
    (parser.scene, parser.diagnostics)
}

/// `` cannot read `a.sc`: no such file ``, in our own words where the system's differ between machines.
fn unreadable(path: &Path, error: &io::Error) -> String {
    let path = value::printable(path.display().to_string().chars());
    match error.kind() {
        io::ErrorKind::NotFound => format!("cannot read `{path}`: no such file"),
        io::ErrorKind::PermissionDenied => format!("cannot read `{path}`: permission denied"),
        _ => format!("cannot read `{path}`: {error}"),
    }
}

/// The value of a keyword could not be read; the diagnostic has been given.
#[derive(Debug)]
pub(crate) struct Failed;

/// What a reading function returns: on failure it has already told why.
pub(crate) type Parsed<T> = Result<T, Failed>;

/// The keyword whose value is being read, for messages.
#[derive(Debug, Clone, Copy, Default)]
struct Context {
    name: &'static str,
    /// A correct use of it, for hints; may be empty.
    example: &'static str,
}

/// Things that may share a name without being confused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Namespace {
    Shader,
    Texture,
    Modifier,
    /// Objects and instances.
    Object,
}

/// The state of reading one scene: a cursor in the current file and everything found so far.
pub(crate) struct Parser<'l> {
    loader: &'l dyn Loader,
    scene: Scene,
    diagnostics: Diagnostics,
    bytes: Arc<[u8]>,
    file: u32,
    syntax: Syntax,
    lexer: Lexer,
    context: Context,
    /// Start of the last word that did not fit; recovery looks for keywords from here.
    failed_at: u32,
    loose: loose::Found,
    files: include::Files,
    /// Where names were first declared.
    names: HashMap<(Namespace, String), Span>,
    /// Triangles, spheres and the like that shapes of few words ask for.
    generated: u64,
    /// Sunflow: samples of the lights of this file that do not say how many.
    direct_samples: u32,
    /// Objects of a type that is not supported: instances of them are dropped too.
    dropped_objects: HashMap<String, Span>,
}

impl<'l> Parser<'l> {
    fn new(loader: &'l dyn Loader) -> Self {
        Parser {
            loader,
            scene: Scene::default(),
            diagnostics: Diagnostics::default(),
            bytes: Arc::from([]),
            file: 0,
            syntax: Syntax::Scene,
            lexer: Lexer::at(0, Syntax::Scene),
            context: Context::default(),
            failed_at: 0,
            loose: loose::Found::default(),
            files: include::Files::default(),
            names: HashMap::new(),
            generated: 0,
            direct_samples: 1,
            dropped_objects: HashMap::new(),
        }
    }

    /// Notes a name, and warns if it is taken.
    fn declare(&mut self, namespace: Namespace, name: &Name) {
        match self.names.entry((namespace, name.value.clone())) {
            Entry::Vacant(entry) => {
                entry.insert(name.span);
            }
            Entry::Occupied(first) => {
                let what = match namespace {
                    Namespace::Shader => "a shader",
                    Namespace::Texture => "a texture",
                    Namespace::Modifier => "a modifier",
                    Namespace::Object => "an object or instance",
                };
                let message =
                    format!("there is already {what} `{}`; names find the first one", value::shorten(&name.value));
                let diagnostic = Diagnostic::warning(name.span, message);
                self.diagnostics.push(diagnostic.label(*first.get(), "first declared here"));
            }
        }
    }

    fn next(&mut self) -> Option<Token> {
        self.lexer.next(&self.bytes)
    }

    fn peek(&self) -> Option<Token> {
        let mut lexer = self.lexer;
        lexer.next(&self.bytes)
    }

    /// Whether the next word is `word`; if so, it is passed.
    fn take(&mut self, word: &str) -> Option<Token> {
        let token = self.peek().filter(|token| self.is(*token, word))?;
        self.next();
        Some(token)
    }

    fn is(&self, token: Token, word: &str) -> bool {
        token.bytes(&self.bytes) == word.as_bytes()
    }

    /// The text of a word: UTF-8 if it is, otherwise Latin-1.
    fn text(&self, token: Token) -> String {
        let bytes = token.bytes(&self.bytes);
        std::str::from_utf8(bytes).map_or_else(|_| bytes.iter().map(|&b| char::from(b)).collect(), str::to_owned)
    }

    fn span(&self, token: Token) -> Span {
        Span { file: self.file, start: token.start, end: token.end }
    }

    /// The empty span at the end of the file.
    fn end_span(&self) -> Span {
        let end = self.bytes.len() as u32;
        Span { file: self.file, start: end, end }
    }

    /// Reports an error at a word that does not fit.
    fn fail(&mut self, at: Option<Token>, diagnostic: Diagnostic) -> Failed {
        self.failed_at = at.map_or(self.bytes.len() as u32, |token| token.start);
        self.diagnostics.push(diagnostic);
        Failed
    }
}
