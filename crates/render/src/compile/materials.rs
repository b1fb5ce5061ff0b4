//! Shaders → materials, in the working space of the dialect: linear light for Sunflow, display values for the report.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::Vec3;
use jaspe_scene::description::{Color, ColorOrTexture, Name, Setting, SettingValue, Shader, ShaderKind};
use jaspe_scene::{Diagnostic, Diagnostics, Dialect, Loader, Scene, Span};
use jaspe_texture::Texture;
use jaspe_texture::declare::{Declaration, Value};

use crate::material::{Albedo, Material, PictureMap, Procedural, Response};
use crate::options::Look;
use crate::picture::Picture;

/// The part of the light that water lets through in the report's dialect.
const WATER_TRANSMISSION: f32 = 0.2;

/// Materials by the names of their shaders.
pub(super) struct Names<'a> {
    by_name: BTreeMap<&'a str, u32>,
    /// Replaces every material.
    everywhere: Option<u32>,
}

impl Names<'_> {
    /// The material of a shader, if there is one of that name.
    pub fn get(&self, name: &str) -> Option<u32> {
        self.everywhere.or_else(|| self.by_name.get(name).copied())
    }

    /// The names there are.
    pub fn known(&self) -> impl Iterator<Item = &str> {
        self.by_name.keys().copied()
    }
}

/// All materials, the black one first, and their names.
pub(super) fn compile<'a>(
    scene: &'a Scene,
    dialect: Dialect,
    loader: &dyn Loader,
    look: Option<Look>,
    diagnostics: &mut Diagnostics,
) -> (Vec<Material>, Names<'a>) {
    let mut materials = vec![Material::black()];
    let mut names = Names { by_name: BTreeMap::new(), everywhere: None };
    let mut pictures = Pictures { scene, dialect, loader, loaded: HashMap::new() };
    for shader in &scene.shaders {
        if names.by_name.contains_key(shader.name.value.as_str()) {
            continue;
        }
        let material =
            if look.is_some() { Material::black() } else { material(shader, dialect, &mut pictures, diagnostics) };
        names.by_name.insert(&shader.name.value, materials.len() as u32);
        materials.push(material);
    }
    if let Some(look) = look {
        names.everywhere = Some(materials.len() as u32);
        materials.push(Material { albedo: Albedo::Color(Vec3::ONE), response: Response::Look(look) });
    } else if let Some(name) = scene.override_shader.as_ref().filter(|name| name.value != "none") {
        match names.by_name.get(name.value.as_str()) {
            Some(&material) => names.everywhere = Some(material),
            None => diagnostics.push(Diagnostic::warning(name.span, format!("there is no shader `{}`", name.value))),
        }
    }
    (materials, names)
}

fn material(shader: &Shader, dialect: Dialect, pictures: &mut Pictures<'_>, diagnostics: &mut Diagnostics) -> Material {
    let plain = |color: &Color| Albedo::Color(working(color, dialect));
    let (albedo, response) = match &shader.kind {
        ShaderKind::Constant { color } => (plain(color), Response::Constant),
        ShaderKind::Diffuse { diffuse } => (pictures.albedo(diffuse, diagnostics), Response::Matte),
        ShaderKind::Phong { diffuse, specular, power, samples } => {
            let specular = working(specular, dialect);
            (pictures.albedo(diffuse, diagnostics), Response::Phong { specular, power: *power, samples: *samples })
        }
        ShaderKind::Mirror { color } => (plain(color), Response::Mirror),
        ShaderKind::Glass { eta, color, absorption_distance, absorption_color } => {
            let absorption = if *absorption_distance > 0.0 {
                (Vec3::ONE - working(absorption_color, dialect)) / *absorption_distance
            } else {
                Vec3::ZERO
            };
            (plain(color), Response::Glass { eta: *eta, absorption })
        }
        ShaderKind::Procedural { declaration, settings } => {
            match procedural(declaration, settings, dialect, shader.span) {
                Ok(material) => return material,
                Err(diagnostic) => {
                    diagnostics.push(diagnostic);
                    return Material::black();
                }
            }
        }
        _ => (Albedo::Color(Vec3::splat(0.5)), Response::Matte),
    };
    Material { albedo, response }
}

/// A colour in the dialect's working space.
fn working(color: &Color, dialect: Dialect) -> Vec3 {
    Vec3::from_array(match dialect {
        Dialect::Sunflow => color.linear(),
        // The original takes the numbers as they are, whatever the colour space.
        Dialect::Report => color.raw(),
    })
}

/// One of the procedural materials.
fn procedural(
    declaration: &'static Declaration,
    settings: &[Setting],
    dialect: Dialect,
    span: Span,
) -> Result<Material, Diagnostic> {
    let color = |color: &Color| {
        let components = if dialect == Dialect::Report { color.raw() } else { color.display() };
        components.map(|c| f64::from(c).clamp(0.0, 1.0))
    };
    let arguments: Vec<(&str, Value)> = settings
        .iter()
        .map(|setting| {
            let value = match &setting.value {
                SettingValue::Int(value) => Value::Int(*value),
                SettingValue::Float(value) => Value::Float(*value),
                SettingValue::Color(value) => Value::Color(color(value)),
                SettingValue::Choice(value) => Value::Choice(value),
            };
            (setting.name, value)
        })
        .collect();
    let texture =
        Texture::build(declaration.name, &arguments).map_err(|error| Diagnostic::error(span, error.to_string()))?;
    let texture = if dialect == Dialect::Report { texture.in_figure_space() } else { texture };
    let transmission = if dialect == Dialect::Report && declaration.name == "water" { WATER_TRANSMISSION } else { 0.0 };
    let response = Response::Procedural { reflection: texture.reflection(), transmission };
    let decode = dialect == Dialect::Sunflow;
    Ok(Material { albedo: Albedo::Procedural(Box::new(Procedural { texture, decode })), response })
}

/// Pictures that shaders name, each loaded once.
struct Pictures<'a> {
    scene: &'a Scene,
    dialect: Dialect,
    loader: &'a dyn Loader,
    loaded: HashMap<PathBuf, Arc<PictureMap>>,
}

impl Pictures<'_> {
    fn albedo(&mut self, source: &ColorOrTexture, diagnostics: &mut Diagnostics) -> Albedo {
        match source {
            ColorOrTexture::Color(color) => Albedo::Color(working(color, self.dialect)),
            ColorOrTexture::Texture(name) => match self.picture(name) {
                Ok(picture) => Albedo::Picture(picture),
                Err(diagnostic) => {
                    diagnostics.push(diagnostic);
                    Albedo::Color(Vec3::ZERO)
                }
            },
        }
    }

    /// Looks for a picture in the texture folders, then where the program runs.
    fn picture(&mut self, name: &Name) -> Result<Arc<PictureMap>, Diagnostic> {
        // Sunflow: one leading `//` marks a path relative to the file, as Blender writes it.
        let written = Path::new(name.value.strip_prefix("//").unwrap_or(&name.value));
        let folders = &self.scene.texture_folders;
        // The original kept its pictures in a folder `textures`.
        let candidates = folders
            .iter()
            .map(|folder| folder.join(written))
            .chain(folders.iter().map(|folder| folder.join("textures").join(written)))
            .chain([written.to_path_buf()]);
        for path in candidates {
            if let Some(known) = self.loaded.get(&path) {
                return Ok(known.clone());
            }
            let bytes = match self.loader.load(&path) {
                Ok(bytes) => bytes,
                Err(error) if error.kind() == std::io::ErrorKind::NotFound => continue,
                Err(error) => return Err(unusable(name, &error.to_string())),
            };
            let picture = Picture::decode(&bytes, &path).map_err(|error| unusable(name, &error.to_string()))?;
            let map = Arc::new(match self.dialect {
                Dialect::Sunflow => PictureMap::linear(picture),
                Dialect::Report => PictureMap::display(picture),
            });
            self.loaded.insert(path, map.clone());
            return Ok(map);
        }
        let mut diagnostic =
            Diagnostic::warning(name.span, format!("the texture `{}` was not found: black is used", name.value));
        if !folders.is_empty() {
            let list: Vec<String> = folders.iter().map(|folder| format!("`{}`", shown(folder))).collect();
            diagnostic = diagnostic.hint(format!("looked in {}", list.join(", ")));
        }
        Err(diagnostic.hint("add the folder that holds it with the line `texturepath FOLDER`"))
    }
}

/// A folder as a person reads it.
fn shown(folder: &Path) -> String {
    if folder.as_os_str().is_empty() { ".".to_owned() } else { folder.display().to_string() }
}

fn unusable(name: &Name, why: &str) -> Diagnostic {
    Diagnostic::warning(name.span, format!("the texture `{}` cannot be used: {why}; black is used", name.value))
        .hint(format!("use {}", Picture::FORMATS))
}
