//! Writes a [`Scene`] as text that reads as the same scene: `Scene ──write──▶ bytes`.
//!
//! The text is tidy and stricter than what was read: keywords stand in the order that Sunflow insists on, old forms in
//! their new one, and numbers in the shortest decimals that give the same value. Comments are not kept.

mod light;
mod object;
mod options;
mod shader;
mod text;

use std::io::{self, Write};
use std::path::{Component, Path, PathBuf};

use crate::description::{Geometry, Image, LightKind, ModifierKind, Scene, ShaderKind, TraceDepths};
use crate::source::Span;
use text::quoted;

/// What becomes of `include` lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Includes {
    /// What included files hold is written where they were included.
    Inline,
    /// The lines stay, and only what the main file itself holds is written.
    Keep,
}

/// Writes a scene. `folder` is where the file will stand: folders in which textures and other files are looked for are
/// named relative to it.
///
/// # Errors
/// Those of `out`.
pub fn write(scene: &Scene, includes: Includes, folder: &Path, out: &mut dyn Write) -> io::Result<()> {
    let own = |span: Span| includes == Includes::Inline || span.file == 0;
    // What is merged from several blocks is taken apart again: each file keeps what counted of its own.
    let merged =
        Merged { image: options::own_image(&scene.image, own), depths: options::own_depths(&scene.trace_depths, own) };
    let mut items = statements(scene, &merged, includes);
    items.retain(|(span, _)| own(*span));
    items.sort_by_key(|(span, _)| place(scene, includes, *span));
    for line in folders(scene, includes, folder) {
        writeln!(out, "{line}")?;
    }
    for (_, statement) in items {
        statement.write(scene, &merged, out)?;
    }
    Ok(())
}

/// What is merged from several blocks, as far as it is to be written.
struct Merged {
    image: Image,
    depths: TraceDepths,
}

/// Something that stands at top level.
#[derive(Clone, Copy)]
enum Statement {
    Dialect,
    Image,
    Bucket,
    Background,
    TraceDepths,
    Gi,
    Photons,
    Override,
    Include(usize),
    Camera(usize),
    Light(usize),
    Texture(usize),
    Shader(usize),
    Modifier(usize),
    Object(usize),
    Instance(usize),
}

/// All statements with the places where they were written.
fn statements(scene: &Scene, merged: &Merged, includes: Includes) -> Vec<(Span, Statement)> {
    let mut found: Vec<(Span, Statement)> = Vec::new();
    let mut add = |span: Option<Span>, statement| found.extend(span.map(|span| (span, statement)));
    add(scene.dialect.map(|dialect| dialect.span), Statement::Dialect);
    // It stands where the last of the blocks stood, and so counts as it did.
    let last = |spans: Vec<Option<Span>>| spans.into_iter().flatten().max_by_key(|span| place(scene, includes, *span));
    add(last(options::image_places(&merged.image)), Statement::Image);
    add(merged.image.bucket.map(|size| size.span), Statement::Bucket);
    add(scene.background.as_ref().map(|background| background.span), Statement::Background);
    add(last(options::depth_places(&merged.depths)), Statement::TraceDepths);
    add(scene.gi.as_ref().map(|gi| gi.span), Statement::Gi);
    add(scene.caustics.map(|caustics| caustics.span), Statement::Photons);
    add(scene.override_shader.as_ref().map(|name| name.span), Statement::Override);
    fn each<T>(items: &[T], span: impl Fn(&T) -> Span, kind: fn(usize) -> Statement) -> Vec<(Span, Statement)> {
        items.iter().enumerate().map(|(index, item)| (span(item), kind(index))).collect()
    }
    found.extend(each(&scene.cameras, |camera| camera.span, Statement::Camera));
    found.extend(each(&scene.lights, |light| light.span, Statement::Light));
    found.extend(each(&scene.textures, |texture| texture.span, Statement::Texture));
    found.extend(each(&scene.shaders, |shader| shader.span, Statement::Shader));
    found.extend(each(&scene.modifiers, |modifier| modifier.span, Statement::Modifier));
    found.extend(each(&scene.objects, |object| object.span, Statement::Object));
    found.extend(each(&scene.instances, |instance| instance.span, Statement::Instance));
    if includes == Includes::Keep {
        found.extend(each(&scene.includes, |include| include.span, Statement::Include));
    }
    found
}

/// The order in which things were read: what a file holds stands where the file was included.
fn place(scene: &Scene, includes: Includes, span: Span) -> Vec<u32> {
    let mut path = vec![span.start];
    let mut file = span.file;
    while includes == Includes::Inline
        && let Some(include) = scene.includes.iter().find(|include| include.file == file)
    {
        path.push(include.span.start);
        file = include.span.file;
    }
    path.reverse();
    path
}

impl Statement {
    fn write(self, scene: &Scene, merged: &Merged, out: &mut dyn Write) -> io::Result<()> {
        match self {
            Statement::Dialect => options::dialect(scene, out),
            Statement::Image => options::image(&merged.image, out),
            Statement::Bucket => options::bucket(&merged.image, out),
            Statement::Background => options::background(scene, out),
            Statement::TraceDepths => options::trace_depths(&merged.depths, out),
            Statement::Gi => options::gi(scene, out),
            Statement::Photons => options::photons(scene, out),
            Statement::Override => options::override_shader(scene, out),
            Statement::Include(index) => writeln!(out, "include {}", quoted(&scene.includes[index].name.value)),
            Statement::Camera(index) => options::camera(&scene.cameras[index], out),
            Statement::Light(index) => light::light(&scene.lights[index], out),
            Statement::Texture(index) => shader::texture(&scene.textures[index], out),
            Statement::Shader(index) => shader::shader(&scene.shaders[index], out),
            Statement::Modifier(index) => shader::modifier(&scene.modifiers[index], out),
            Statement::Object(index) => object::object(&scene.objects[index], out),
            Statement::Instance(index) => object::instance(&scene.instances[index], out),
        }
    }
}

/// The lines `texturepath` and `includepath` that are needed for the files that the scene names.
fn folders(scene: &Scene, includes: Includes, folder: &Path) -> Vec<String> {
    let names_texture = scene.shaders.iter().any(|shader| names_texture(&shader.kind))
        || scene.modifiers.iter().any(|modifier| !matches!(modifier.kind, ModifierKind::Perlin { .. }))
        || scene.lights.iter().any(|light| matches!(light.kind, LightKind::Ibl { .. }));
    let names_file = includes == Includes::Keep
        || scene
            .objects
            .iter()
            .any(|object| matches!(object.geometry, Geometry::FileMesh { .. } | Geometry::Particles { .. }));
    let lines = |keyword: &str, list: &[PathBuf]| -> Vec<String> {
        let others = list.iter().filter(|known| known.as_path() != folder);
        others.map(|known| format!("{keyword} {}", quoted(&relative(known, folder)))).collect()
    };
    let mut found = Vec::new();
    if names_texture {
        found.extend(lines("texturepath", &scene.texture_folders));
    }
    if names_file {
        found.extend(lines("includepath", &scene.include_folders));
    }
    found
}

fn names_texture(kind: &ShaderKind) -> bool {
    use crate::description::ColorOrTexture::Texture;
    match kind {
        ShaderKind::Diffuse { diffuse }
        | ShaderKind::Phong { diffuse, .. }
        | ShaderKind::Shiny { diffuse, .. }
        | ShaderKind::Ward { diffuse, .. }
        | ShaderKind::AmbientOcclusion { bright: diffuse, .. } => matches!(diffuse, Texture(_)),
        ShaderKind::Uber { diffuse, specular, .. } => diffuse.texture.is_some() || specular.texture.is_some(),
        _ => false,
    }
}

/// How a folder is called from another one; both are absolute or both are relative to the same place, if possible.
fn relative(folder: &Path, from: &Path) -> String {
    let is_plain = |path: &Path| path.components().all(|part| matches!(part, Component::Normal(_)));
    let shared = folder.components().zip(from.components()).take_while(|(a, b)| a == b).count();
    let rest: PathBuf = folder.components().skip(shared).collect();
    let up: PathBuf = from.components().skip(shared).map(|_| Component::ParentDir).collect();
    if folder.is_absolute() != from.is_absolute() || !is_plain(&from.components().skip(shared).collect::<PathBuf>()) {
        return folder.display().to_string();
    }
    let path = if rest.as_os_str().is_empty() { up } else { up.join(rest) };
    if path.as_os_str().is_empty() { ".".to_owned() } else { path.display().to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_named_from_where_the_file_stands() {
        let from = |folder: &str, base: &str| relative(Path::new(folder), Path::new(base));
        assert_eq!(from("scenes/include", "scenes"), "include");
        assert_eq!(from("scenes", "out/deep"), "../../scenes");
        assert_eq!(from("", "out"), "..");
        assert_eq!(from("scenes", ""), "scenes");
        assert_eq!(from("/abs/textures", "scenes"), "/abs/textures");
        assert_eq!(from("/abs/textures", "/abs/scenes"), "../textures");
    }
}
