//! `NAME.KEY=VALUE`: changes one keyword of one shader or texture after reading, with the same tables as the file.

use std::sync::Arc;

use super::shader::{self, Draft, Type};
use super::value::shorten;
use super::{Context, Parser};
use crate::description::{Name, Scene, ShaderKind, Texture};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::lexer::{Lexer, Syntax};
use crate::source::MemoryLoader;
use crate::suggest;

/// What messages call the text of an assignment.
const SOURCE: &str = "--set";

/// Sets a keyword of a named shader or texture, as if its block in the scene said so: `set(scene, "floor.depth=5")`.
///
/// Colours are written as in a scene, with blanks or commas (`1,0.5,0` is linear light), or as `#rrggbb`. The text of
/// the assignment becomes one of the scene's sources, so that messages can show it.
///
/// # Errors
/// What is wrong with the assignment; the scene then keeps its value.
pub fn set(scene: &mut Scene, assignment: &str) -> Result<(), Diagnostics> {
    let loader = MemoryLoader::default();
    let mut parser = Parser::new(&loader);
    parser.bytes = Arc::from(assignment.as_bytes());
    parser.file = scene.sources.add(SOURCE.into(), parser.bytes.clone());
    parser.syntax = Syntax::Assignment;
    match assign(&mut parser, scene, assignment) {
        Some((target, kind)) if !parser.diagnostics.has_errors() => {
            match (target, kind) {
                (Target::Shader(index), kind) => scene.shaders[index].kind = kind,
                (Target::Texture(index), ShaderKind::Procedural { settings, .. }) => {
                    scene.textures[index].settings = settings;
                }
                (Target::Texture(_), _) => {}
            }
            Ok(())
        }
        _ => Err(parser.diagnostics),
    }
}

/// What changes, by its index.
#[derive(Debug, Clone, Copy)]
enum Target {
    Shader(usize),
    Texture(usize),
}

/// What changes and what it becomes; otherwise the reason is among the parser's diagnostics.
fn assign(parser: &mut Parser<'_>, scene: &Scene, assignment: &str) -> Option<(Target, ShaderKind)> {
    let Some((path, _)) = assignment.split_once('=') else {
        let diagnostic = Diagnostic::error(place(parser, 0, assignment), "expected `NAME.KEY=VALUE`");
        parser.diagnostics.push(diagnostic.hint("for example `floor.depth=5`"));
        return None;
    };
    let (target, key) = find(parser, scene, path)?;
    let span = place(parser, path.len() - key.len(), key);
    let (block, opened) = match target {
        Target::Shader(index) => (scene.shaders[index].span, open(&scene.shaders[index].kind)),
        Target::Texture(index) => {
            let Texture { declaration, settings, span, .. } = scene.textures[index].clone();
            (span, open(&ShaderKind::Procedural { declaration, settings }))
        }
    };
    let Some((kind, mut draft)) = opened else {
        let message =
            format!("`{}` is written in Java, which cannot be changed", shorten(&path[..path.len() - key.len() - 1]));
        parser.diagnostics.push(Diagnostic::error(span, message));
        return None;
    };
    let keys = kind.keys();
    let settable = || keys.iter().filter(|key| !matches!(key.name, "name" | "type"));
    let Some(found) = settable().find(|candidate| candidate.name == key) else {
        let word = Name { value: key.to_owned(), span };
        let names: Vec<&str> = settable().map(|key| key.name).collect();
        let diagnostic = super::value::unknown_word("keyword", &word, names.into_iter());
        parser.diagnostics.push(diagnostic);
        return None;
    };
    parser.lexer = Lexer::at(path.len() + 1, Syntax::Assignment);
    parser.context = Context { name: found.name, example: found.example };
    (found.read)(parser, &mut draft, span).ok()?;
    if let Some(surplus) = parser.next() {
        let message = format!("`{key}` takes no further value, found `{}`", parser.shown(surplus));
        parser.diagnostics.push(Diagnostic::error(parser.span(surplus), message));
        return None;
    }
    Some((target, kind.build(draft, block)?))
}

/// The shader, or else the texture, whose name starts `path`, and the keyword that remains. Both may contain dots.
fn find<'a>(parser: &mut Parser<'_>, scene: &Scene, path: &'a str) -> Option<(Target, &'a str)> {
    let splits = path.match_indices('.').map(|(dot, _)| (&path[..dot], &path[dot + 1..]));
    let named = |name: &str| {
        let shader = scene.shaders.iter().position(|shader| shader.name.value == name).map(Target::Shader);
        let texture = || scene.textures.iter().position(|texture| texture.name.value == name).map(Target::Texture);
        shader.or_else(texture)
    };
    if let Some(found) = splits.clone().find_map(|(name, key)| Some((named(name)?, key))) {
        return Some(found);
    }
    let name = splits.map(|(name, _)| name).next().unwrap_or(path);
    let textures = scene.textures.iter().map(|texture| texture.name.value.as_str());
    let known = || scene.shaders.iter().map(|shader| shader.name.value.as_str()).chain(textures.clone());
    let message = format!("there is no shader `{}`", shorten(name));
    let diagnostic = Diagnostic::error(place(parser, 0, name), message);
    parser.diagnostics.push(match (suggest::nearest(name, known()), scene.shaders.len()) {
        (Some(nearest), _) => diagnostic.hint(format!("did you mean `{nearest}`?")),
        (None, 1..=20) => diagnostic.hint(format!("the scene has {}", suggest::list_all(known()))),
        (None, _) => diagnostic,
    });
    None
}

/// How a shader is read, and a draft with its present values.
fn open(kind: &ShaderKind) -> Option<(Type, Draft)> {
    let (name, draft) = match kind.clone() {
        ShaderKind::Constant { color } => ("constant", Draft { diffuse: Some(color), ..Draft::default() }),
        ShaderKind::Diffuse { diffuse } => ("diffuse", Draft { diffuse: Some(diffuse), ..Draft::default() }),
        ShaderKind::Phong { diffuse, specular, power, samples } => {
            let (diffuse, specular) = (Some(diffuse), Some((specular, power)));
            ("phong", Draft { diffuse, specular, samples: Some(samples), ..Draft::default() })
        }
        ShaderKind::Mirror { color } => ("mirror", Draft { color: Some(color), ..Draft::default() }),
        ShaderKind::Glass { eta, color, absorption_distance, absorption_color } => {
            let draft = Draft {
                eta: Some(eta),
                color: Some(color),
                absorption_distance: Some(absorption_distance),
                absorption_color: Some(absorption_color),
                ..Draft::default()
            };
            ("glass", draft)
        }
        ShaderKind::Shiny { diffuse, reflection } => {
            ("shiny", Draft { diffuse: Some(diffuse), reflection: Some(reflection), ..Draft::default() })
        }
        ShaderKind::Ward { diffuse, specular, roughness, samples } => {
            let (diffuse, color, roughness) = (Some(diffuse), Some(specular), Some(roughness));
            ("ward", Draft { diffuse, color, roughness, samples: Some(samples), ..Draft::default() })
        }
        ShaderKind::AmbientOcclusion { bright, dark, samples, distance } => {
            let (diffuse, dark, distance) = (Some(bright), Some(dark), Some(distance));
            ("amb-occ", Draft { diffuse, dark, distance, samples: Some(samples), ..Draft::default() })
        }
        ShaderKind::Uber { diffuse, specular, glossy, samples } => {
            let (diffuse_layer, specular_layer) = (diffuse.into(), specular.into());
            let (glossy, samples) = (Some(glossy), Some(samples));
            ("uber", Draft { diffuse_layer, specular_layer, glossy, samples, ..Draft::default() })
        }
        ShaderKind::Wireframe { line, fill, width } => {
            ("wireframe", Draft { dark: Some(line), color: Some(fill), width: Some(width), ..Draft::default() })
        }
        kind @ (ShaderKind::ViewCaustics | ShaderKind::ViewIrradiance | ShaderKind::ViewGlobal | ShaderKind::Id) => {
            (kind.keyword(), Draft::default())
        }
        ShaderKind::Procedural { declaration, settings } => {
            (declaration.name, Draft { settings, ..Draft::procedural(declaration) })
        }
        ShaderKind::Unsupported => return None,
    };
    Some((shader::type_called(name)?, draft))
}

fn place(parser: &Parser<'_>, start: usize, text: &str) -> crate::Span {
    let end = (start + text.len()) as u32;
    crate::Span { file: parser.file, start: start as u32, end }
}
