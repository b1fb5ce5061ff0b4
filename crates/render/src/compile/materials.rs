//! Shaders → materials, in the working space of the dialect: linear light for Sunflow, display values for the report.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::Vec3;
use jaspe_scene::description::{
    Blend, Color, ColorOrTexture, ModifierKind, Name, Setting, SettingValue, Shader, ShaderKind,
};
use jaspe_scene::{Diagnostic, Diagnostics, Dialect, Loader, Scene, Span};
use jaspe_texture::Texture;
use jaspe_texture::declare::{Declaration, Value};

use super::bounded;
use crate::material::{Albedo, Coat, Gloss, Material, PictureMap, Procedural, Response};
use crate::modifier::Modifier;
use crate::options::Look;
use crate::picture::Picture;

/// The part of the light that water lets through in the report's dialect.
const WATER_TRANSMISSION: f32 = 0.2;

/// All materials of a scene, the black one first, by the names of their shaders.
pub(super) struct Materials<'a> {
    pub all: Vec<Material>,
    by_name: BTreeMap<&'a str, u32>,
    modifiers: BTreeMap<&'a str, Arc<Modifier>>,
    /// Materials whose normals a modifier turns, by what they are otherwise and the modifier.
    modified: HashMap<(u32, &'a str), u32>,
    /// Replaces every material.
    everywhere: Option<u32>,
}

impl<'a> Materials<'a> {
    /// The material of a shader, if there is one of that name.
    pub fn get(&self, name: &str) -> Option<u32> {
        self.everywhere.or_else(|| self.by_name.get(name).copied())
    }

    /// The names there are.
    pub fn known(&self) -> impl Iterator<Item = &str> {
        self.by_name.keys().copied()
    }

    /// A material whose normals the modifier of that name turns, if there is one.
    pub fn modify(&mut self, material: u32, modifier: &str) -> Option<u32> {
        let (&name, turned) = self.modifiers.get_key_value(modifier)?;
        let all = &mut self.all;
        Some(*self.modified.entry((material, name)).or_insert_with(|| {
            let base = all[material as usize].clone();
            all.push(Material { modifier: Some(turned.clone()), ..base });
            (all.len() - 1) as u32
        }))
    }

    /// The names of the modifiers there are.
    pub fn known_modifiers(&self) -> impl Iterator<Item = &str> {
        self.modifiers.keys().copied()
    }

    /// A material that no shader names.
    pub fn add(&mut self, material: Material) -> u32 {
        self.all.push(material);
        (self.all.len() - 1) as u32
    }
}

/// The materials of a scene's shaders.
pub(super) fn compile<'a>(
    scene: &'a Scene,
    pictures: &mut Pictures<'_>,
    look: Option<Look>,
    diagnostics: &mut Diagnostics,
) -> Materials<'a> {
    let mut materials = Materials {
        all: vec![Material::black()],
        by_name: BTreeMap::new(),
        modifiers: BTreeMap::new(),
        modified: HashMap::new(),
        everywhere: None,
    };
    for shader in &scene.shaders {
        if materials.by_name.contains_key(shader.name.value.as_str()) {
            continue;
        }
        let material = if look.is_some() { Material::black() } else { material(shader, pictures, diagnostics) };
        let index = materials.add(material);
        materials.by_name.insert(&shader.name.value, index);
    }
    if pictures.dialect == Dialect::Sunflow {
        for written in &scene.modifiers {
            if let Some(modifier) = modifier(&written.kind, pictures, diagnostics) {
                materials.modifiers.entry(&written.name.value).or_insert_with(|| Arc::new(modifier));
            }
        }
    }
    if let Some(look) = look {
        materials.everywhere = Some(materials.add(Material::new(Albedo::Color(Vec3::ONE), Response::Look(look))));
    } else if let Some(name) = scene.override_shader.as_ref().filter(|name| name.value != "none") {
        match materials.by_name.get(name.value.as_str()) {
            Some(&material) => materials.everywhere = Some(material),
            None => diagnostics.push(Diagnostic::warning(name.span, format!("there is no shader `{}`", name.value))),
        }
    }
    materials
}

fn material(shader: &Shader, pictures: &mut Pictures<'_>, diagnostics: &mut Diagnostics) -> Material {
    let dialect = pictures.dialect;
    let plain = |color: &Color| Albedo::Color(working(color, dialect));
    let gloss = |color: &Color| Gloss::Color(working(color, dialect));
    let (albedo, response) = match &shader.kind {
        ShaderKind::Constant { color } => (pictures.albedo(color, diagnostics), Response::Constant),
        ShaderKind::Diffuse { diffuse } => (pictures.albedo(diffuse, diagnostics), Response::Matte(Coat::None)),
        ShaderKind::Phong { diffuse, specular, power, samples } => {
            let coat = Coat::Phong { specular: gloss(specular), power: *power, samples: bounded(*samples) };
            (pictures.albedo(diffuse, diagnostics), Response::Matte(coat))
        }
        ShaderKind::Ward { diffuse, specular, roughness, samples } => {
            let coat = Coat::Ward { specular: gloss(specular), roughness: *roughness, samples: bounded(*samples) };
            (pictures.albedo(diffuse, diagnostics), Response::Matte(coat))
        }
        ShaderKind::Shiny { diffuse, reflection } => {
            let coat = Coat::Mirror { specular: Gloss::Albedo(*reflection) };
            (pictures.albedo(diffuse, diagnostics), Response::Matte(coat))
        }
        ShaderKind::Uber { diffuse, specular, glossy, samples } => {
            let specular = match pictures.blend(specular, diagnostics) {
                Albedo::Color(color) => Gloss::Color(color),
                painted => Gloss::Painted(Box::new(painted)),
            };
            let coat = if *glossy == 0.0 {
                Coat::Mirror { specular }
            } else {
                Coat::Phong { specular, power: 2.0 / glossy, samples: bounded(*samples) }
            };
            (pictures.blend(diffuse, diagnostics), Response::Matte(coat))
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
        ShaderKind::AmbientOcclusion { bright, dark, samples, distance } => {
            let response = Response::AmbientOcclusion {
                dark: working(dark, dialect),
                samples: bounded(*samples),
                distance: *distance,
            };
            (pictures.albedo(bright, diagnostics), response)
        }
        ShaderKind::Wireframe { line, fill, width } => {
            (plain(fill), Response::Wireframe { line: working(line, dialect), width: *width })
        }
        ShaderKind::ViewIrradiance => (Albedo::Color(Vec3::ONE), Response::ViewIrradiance),
        ShaderKind::ViewCaustics => (Albedo::Color(Vec3::ONE), Response::ViewCaustics),
        // Sunflow: what its caches keep of a surface. There are none here, so it shows the light that arrives.
        ShaderKind::ViewGlobal => (Albedo::Color(Vec3::ONE), Response::ViewIrradiance),
        ShaderKind::Id => (Albedo::Color(Vec3::ONE), Response::Look(Look::Ids)),
        ShaderKind::Unsupported => (Albedo::Color(Vec3::splat(0.5)), Response::Matte(Coat::None)),
        ShaderKind::Procedural { declaration, settings } => {
            match pictures.procedural(declaration, settings, shader.span) {
                Ok(procedural) => {
                    let water = dialect == Dialect::Report && declaration.name == "water";
                    let transmission = if water { WATER_TRANSMISSION } else { 0.0 };
                    let coat = Coat::Touch { reflection: procedural.texture.reflection(), transmission };
                    (Albedo::Procedural(Box::new(procedural)), Response::Matte(coat))
                }
                Err(diagnostic) => {
                    diagnostics.push(diagnostic);
                    return Material::black();
                }
            }
        }
    };
    Material::new(albedo, response)
}

fn modifier(kind: &ModifierKind, pictures: &mut Pictures<'_>, diagnostics: &mut Diagnostics) -> Option<Modifier> {
    let raw = |pictures: &mut Pictures<'_>, name: &Name, diagnostics: &mut Diagnostics| {
        pictures.load(name, Reading::Raw).map_err(|diagnostic| diagnostics.push(diagnostic)).ok()
    };
    match kind {
        ModifierKind::Bump { texture, scale } => match pictures.named(texture) {
            Some(Ok(procedural)) => {
                Some(Modifier::BumpProcedural { texture: Box::new(procedural.texture), scale: *scale })
            }
            Some(Err(diagnostic)) => {
                diagnostics.push(diagnostic);
                None
            }
            None => Some(Modifier::Bump { picture: raw(pictures, texture, diagnostics)?, scale: *scale }),
        },
        ModifierKind::NormalMap { texture } => {
            Some(Modifier::NormalMap { picture: raw(pictures, texture, diagnostics)? })
        }
        &ModifierKind::Perlin { function, size, scale } => Some(Modifier::Perlin { function, size, scale }),
    }
}

/// A colour in the dialect's working space.
pub(super) fn working(color: &Color, dialect: Dialect) -> Vec3 {
    Vec3::from_array(match dialect {
        Dialect::Sunflow => color.linear(),
        // The original takes the numbers as they are, whatever the colour space.
        Dialect::Report => color.raw(),
    })
}

/// Pictures and textures that shaders name; every picture is loaded once for each way of reading it.
pub(super) struct Pictures<'a> {
    scene: &'a Scene,
    pub dialect: Dialect,
    loader: &'a dyn Loader,
    loaded: HashMap<(PathBuf, Reading), Arc<PictureMap>>,
}

/// How a picture becomes numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Reading {
    /// Colours in the dialect's working space.
    Colors,
    /// Heights and normals: the bytes.
    Raw,
}

impl<'a> Pictures<'a> {
    pub fn new(scene: &'a Scene, dialect: Dialect, loader: &'a dyn Loader) -> Self {
        Pictures { scene, dialect, loader, loaded: HashMap::new() }
    }

    fn albedo(&mut self, source: &ColorOrTexture, diagnostics: &mut Diagnostics) -> Albedo {
        match source {
            ColorOrTexture::Color(color) => Albedo::Color(working(color, self.dialect)),
            ColorOrTexture::Texture(name) => self.texture(name, diagnostics),
        }
    }

    fn blend(&mut self, blend: &Blend, diagnostics: &mut Diagnostics) -> Albedo {
        let color = working(&blend.color, self.dialect);
        match &blend.texture {
            Some(name) if blend.blend > 0.0 => {
                let over = Box::new(self.texture(name, diagnostics));
                Albedo::Blend { color, over, amount: blend.blend }
            }
            _ => Albedo::Color(color),
        }
    }

    /// A texture block of that name, or a picture; black if there is neither.
    fn texture(&mut self, name: &Name, diagnostics: &mut Diagnostics) -> Albedo {
        let found = match self.named(name) {
            Some(procedural) => procedural.map(|procedural| Albedo::Procedural(Box::new(procedural))),
            None => self.picture(name).map(Albedo::Picture),
        };
        found.unwrap_or_else(|diagnostic| {
            diagnostics.push(diagnostic);
            Albedo::Color(Vec3::ZERO)
        })
    }

    /// The procedural texture of a `texture` block, if there is one of that name.
    fn named(&self, name: &Name) -> Option<Result<Procedural, Diagnostic>> {
        let texture = self.scene.textures.iter().find(|texture| texture.name.value == name.value)?;
        Some(self.procedural(texture.declaration, &texture.settings, texture.span))
    }

    /// One of the procedural textures.
    fn procedural(
        &self,
        declaration: &'static Declaration,
        settings: &[Setting],
        span: Span,
    ) -> Result<Procedural, Diagnostic> {
        let report = self.dialect == Dialect::Report;
        let color = |color: &Color| {
            let components = if report { color.raw() } else { color.display() };
            components.map(|c| f64::from(c).clamp(0.0, 1.0))
        };
        let argument = |setting: &Setting| {
            let value = match &setting.value {
                SettingValue::Int(value) => Value::Int(*value),
                SettingValue::Float(value) => Value::Float(*value),
                SettingValue::Color(value) => Value::Color(color(value)),
                SettingValue::Choice(value) => Value::Choice(value),
            };
            (setting.name, value)
        };
        let arguments: Vec<(&str, Value)> = settings.iter().map(argument).collect();
        let texture =
            Texture::build(declaration.name, &arguments).map_err(|error| Diagnostic::error(span, error.to_string()))?;
        // The report's colours are those of the display, and light seldom makes them brighter.
        let texture = if report { texture.in_figure_space().in_bytes() } else { texture };
        Ok(Procedural { texture, decode: !report })
    }

    /// A picture of colours in the dialect's working space.
    pub fn picture(&mut self, name: &Name) -> Result<Arc<PictureMap>, Diagnostic> {
        self.load(name, Reading::Colors)
    }

    /// Looks for a picture in the texture folders, then where the program runs.
    fn load(&mut self, name: &Name, reading: Reading) -> Result<Arc<PictureMap>, Diagnostic> {
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
            if let Some(known) = self.loaded.get(&(path.clone(), reading)) {
                return Ok(known.clone());
            }
            let bytes = match self.loader.load(&path) {
                Ok(bytes) => bytes,
                Err(error) if error.kind() == std::io::ErrorKind::NotFound => continue,
                Err(error) => return Err(unusable(name, &error.to_string())),
            };
            let picture = Picture::decode(&bytes, &path).map_err(|error| unusable(name, &error.to_string()))?;
            let map = Arc::new(match (reading, self.dialect) {
                (Reading::Raw, _) => PictureMap::raw(picture),
                (Reading::Colors, Dialect::Sunflow) => PictureMap::linear(picture),
                (Reading::Colors, Dialect::Report) => PictureMap::display(picture),
            });
            self.loaded.insert((path, reading), map.clone());
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
