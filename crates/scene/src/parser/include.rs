//! Files: the main one, those that it includes, and the folders in which they are looked for.

use std::collections::HashMap;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use super::{Context, Failed, Parsed, Parser, generic, unreadable};
use crate::description::{Include, Name};
use crate::diagnostic::Diagnostic;
use crate::lexer::{Lexer, Syntax, Token};
use crate::source::Span;

/// Files may include each other this deep.
const MAX_DEPTH: usize = 64;
/// So many files are read in all; files that include each other twice would otherwise multiply without end.
const MAX_FILES: usize = 1000;

/// Files that are open or were read, and where others are looked for.
#[derive(Debug, Default)]
pub(super) struct Files {
    /// The files being read, the main one first, and the statements that include them.
    open: Vec<(PathBuf, Option<Span>)>,
    loaded: HashMap<PathBuf, Arc<[u8]>>,
    count: usize,
}

impl Parser<'_> {
    /// Reads the main file of a scene.
    pub(super) fn main_file(&mut self, path: &Path, bytes: Arc<[u8]>) {
        let statements = self.file(path, bytes, None);
        if statements == Some(0) && !self.diagnostics.is_empty() && !self.diagnostics.has_errors() {
            let message = format!("`{}` holds no scene", path.display());
            let hint = "a scene consists of blocks like `camera { … }` and `object { … }`";
            self.diagnostics.push(Diagnostic::error(None, message).hint(hint));
        }
        self.drop_instances_of_dropped_objects();
    }

    /// Reads one file from its start to its end; the result is its number of statements.
    fn file(&mut self, path: &Path, bytes: Arc<[u8]>, from: Option<Span>) -> Option<usize> {
        if u32::try_from(bytes.len()).is_err() {
            self.diagnostics.push(Diagnostic::error(from, format!("`{}` is larger than 4 GiB", path.display())));
            return None;
        }
        self.search_in(path.parent().unwrap_or(Path::new("")));
        self.files.count += 1;
        self.files.open.push((normal(path), from));
        let index = self.scene.sources.add(path.to_owned(), bytes.clone());
        let lexer = Lexer::new(&bytes, Syntax::Scene);
        let outer = (
            std::mem::replace(&mut self.bytes, bytes),
            std::mem::replace(&mut self.file, index),
            std::mem::replace(&mut self.lexer, lexer),
            std::mem::take(&mut self.loose),
            std::mem::replace(&mut self.direct_samples, 1),
        );
        let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
        let statements = match extension.as_str() {
            "sca" => generic::statements(self),
            "scb" => generic::binary(self),
            _ => self.statements(),
        };
        let found = std::mem::replace(&mut self.loose, outer.3);
        self.report_loose(found);
        (self.bytes, self.file, self.lexer, self.direct_samples) = (outer.0, outer.1, outer.2, outer.4);
        self.files.open.pop();
        Some(statements)
    }

    /// Sunflow: the folder of every file is searched for includes and textures from then on.
    fn search_in(&mut self, folder: &Path) {
        for folders in [&mut self.scene.include_folders, &mut self.scene.texture_folders] {
            if !folders.iter().any(|known| known == folder) {
                folders.push(folder.to_owned());
            }
        }
    }

    /// A folder as named by a statement of the current file, relative to that file.
    fn folder(&self, name: &Name) -> PathBuf {
        let (path, _) = self.files.open.last().expect("a statement stands in a file");
        let file = self.scene.sources.file(self.file).map_or(path.as_path(), |source| source.path.as_path());
        file.parent().unwrap_or(Path::new("")).join(&name.value)
    }

    /// Finds and loads an included file.
    fn find(&mut self, name: &Name) -> Result<(PathBuf, Arc<[u8]>), Diagnostic> {
        let file = Path::new(name.value.strip_prefix("//").unwrap_or(&name.value));
        let here = Path::new("").to_owned();
        let folders: Vec<PathBuf> = if file.is_absolute() {
            vec![here]
        } else {
            let folders = &self.scene.include_folders;
            folders.iter().cloned().chain((!folders.contains(&here)).then_some(here)).collect()
        };
        for folder in &folders {
            let path = folder.join(file);
            if let Some(bytes) = self.files.loaded.get(&path) {
                return Ok((path, bytes.clone()));
            }
            match self.loader.load(&path) {
                Ok(bytes) => {
                    self.files.loaded.insert(path.clone(), bytes.clone());
                    return Ok((path, bytes));
                }
                Err(error) if error.kind() == io::ErrorKind::NotFound => {}
                Err(error) => return Err(Diagnostic::error(name.span, unreadable(&path, &error))),
            }
        }
        let shown = |folder: &PathBuf| match folder.as_os_str().is_empty() {
            true => "the current folder".to_owned(),
            false => format!("`{}`", folder.display()),
        };
        let places: Vec<String> = folders.iter().map(shown).collect();
        let error = io::Error::from(io::ErrorKind::NotFound);
        let diagnostic = Diagnostic::error(name.span, unreadable(file, &error));
        Err(if file.is_absolute() { diagnostic } else { diagnostic.hint(format!("looked in {}", places.join(", "))) })
    }

    /// Reports a file that is about to be included by itself, directly or not.
    fn refuse_loop(&mut self, name: &Name, path: &Path) -> Parsed<()> {
        let path = normal(path);
        let Some(at) = self.files.open.iter().position(|(open, _)| *open == path) else { return Ok(()) };
        let message = format!("`{}` includes itself", path.display());
        let mut diagnostic = Diagnostic::error(name.span, message).hint("remove one of the `include` lines");
        for (_, from) in &self.files.open[at + 1..] {
            if let Some(from) = from {
                diagnostic = diagnostic.label(*from, "on the way here");
            }
        }
        self.diagnostics.push(diagnostic);
        Err(Failed)
    }
}

/// `include FILE`: reads another file as if it stood here. An error in it does not end the including file.
pub(super) fn include(parser: &mut Parser<'_>, head: Token) -> Parsed<()> {
    let name = parser.word("a file name")?;
    parser.failed_at = name.span.end;
    let span = parser.span(head).to(name.span);
    follow(parser, name, span);
    Ok(())
}

/// Reads the file of a statement that includes it.
pub(super) fn follow(parser: &mut Parser<'_>, name: Name, span: Span) {
    let extension = Path::new(&name.value).extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    match extension.as_str() {
        "sc" | "sca" | "scb" => {}
        "rib" | "ra2" | "ra3" => {
            let message = format!("skipped: `.{extension}` files cannot be included");
            let hint = "name a mesh by an object of type `file-mesh`";
            parser.diagnostics.push(Diagnostic::warning(name.span, message).hint(hint));
            return;
        }
        _ => {
            let message = format!("cannot include `{}`: not a `.sc` file", super::value::shorten(&name.value));
            parser.diagnostics.push(Diagnostic::error(name.span, message));
            return;
        }
    }
    let (path, bytes) = match parser.find(&name) {
        Ok(found) => found,
        Err(diagnostic) => {
            parser.diagnostics.push(diagnostic);
            return;
        }
    };
    if parser.refuse_loop(&name, &path).is_err() {
        return;
    }
    if parser.files.open.len() >= MAX_DEPTH || parser.files.count >= MAX_FILES {
        let limits = format!("at most {MAX_FILES} files, {MAX_DEPTH} deep");
        let diagnostic = Diagnostic::error(name.span, format!("too many includes: {limits}, are read"));
        parser.diagnostics.push(diagnostic);
        return;
    }
    let file = parser.scene.sources.iter().count() as u32;
    parser.scene.includes.push(Include { span, name: name.clone(), file });
    parser.file(&path, bytes, Some(name.span));
    parser.context = Context::default();
}

/// `includepath FOLDER`: one more folder in which includes are looked for.
pub(super) fn include_path(parser: &mut Parser<'_>, _: Token) -> Parsed<()> {
    let name = parser.word("a folder")?;
    add_include_folder(parser, &name);
    Ok(())
}

pub(super) fn add_include_folder(parser: &mut Parser<'_>, name: &Name) {
    let folder = parser.folder(name);
    if !parser.scene.include_folders.contains(&folder) {
        parser.scene.include_folders.push(folder);
    }
}

/// `texturepath FOLDER`: one more folder in which textures are looked for.
pub(super) fn texture_path(parser: &mut Parser<'_>, _: Token) -> Parsed<()> {
    let name = parser.word("a folder")?;
    add_texture_folder(parser, &name);
    Ok(())
}

pub(super) fn add_texture_folder(parser: &mut Parser<'_>, name: &Name) {
    let folder = parser.folder(name);
    if !parser.scene.texture_folders.contains(&folder) {
        parser.scene.texture_folders.push(folder);
    }
}

/// The path without `.` and `a/..`, so that a file has one name.
fn normal(path: &Path) -> PathBuf {
    let mut parts = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir if matches!(parts.components().next_back(), Some(Component::Normal(_))) => {
                parts.pop();
            }
            other => parts.push(other),
        }
    }
    parts
}
