//! The keywords of a shader or texture with their present values: what `set` changes, read. The writer walks the same list.

use jaspe_texture::declare::{Declaration, Value};

use crate::description::{Color, ColorOrTexture, Name, Scene, Setting, SettingValue, ShaderKind};
use crate::srgb::srgb_decode;

/// The value of a keyword as programs see it.
#[derive(Debug, Clone, PartialEq)]
pub enum Parameter {
    /// A whole number.
    Int(i64),
    /// A number.
    Float(f64),
    /// Several numbers in a row; the first three of four may be a colour in linear light.
    Floats(Vec<f64>),
    /// A colour, as linear light.
    Color([f64; 3]),
    /// A word, or the name of a texture or a file.
    Word(String),
    /// What follows from the surroundings, since nothing was written.
    Auto,
}

/// Every keyword of a shader, or else of a texture, that has a value: those that were written, and the defaults of the
/// others. `None` when neither a shader nor a texture has the name.
pub fn parameters(scene: &Scene, name: &str) -> Option<Vec<(&'static str, Parameter)>> {
    if let Some(shader) = scene.shaders.iter().find(|shader| shader.name.value == name) {
        return Some(match &shader.kind {
            ShaderKind::Procedural { declaration, settings } => declared(declaration, settings),
            kind => entries(kind).into_iter().map(|(key, entry)| (key, entry.parameter())).collect(),
        });
    }
    let texture = scene.textures.iter().find(|texture| texture.name.value == name)?;
    Some(declared(texture.declaration, &texture.settings))
}

/// The parameters of a procedural material.
fn declared(declaration: &'static Declaration, settings: &[Setting]) -> Vec<(&'static str, Parameter)> {
    let value = |parameter: &jaspe_texture::declare::Parameter| match settings
        .iter()
        .find(|setting| setting.name == parameter.name)
    {
        Some(setting) => Entry::Setting(&setting.value).parameter(),
        None => match parameter.default {
            Value::Int(value) => Parameter::Int(value),
            Value::Float(value) => Parameter::Float(value),
            Value::Color(display) => Parameter::Color(display.map(|part| short(srgb_decode(part) as f32))),
            Value::Choice(word) => Parameter::Word(word.to_owned()),
            Value::Auto => Parameter::Auto,
        },
    };
    declaration.parameters.iter().map(|parameter| (parameter.name, value(parameter))).collect()
}

/// What stands after a keyword.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Entry<'a> {
    Color(&'a Color),
    /// A colour and an exponent.
    Highlight(&'a Color, f32),
    Number(f32),
    Pair([f32; 2]),
    Count(u32),
    Texture(&'a Name),
    Setting(&'a SettingValue),
}

impl Entry<'_> {
    fn parameter(self) -> Parameter {
        let color = |color: &Color| color.linear().map(short);
        match self {
            Entry::Color(value) | Entry::Setting(SettingValue::Color(value)) => Parameter::Color(color(value)),
            Entry::Highlight(value, power) => Parameter::Floats([&color(value)[..], &[short(power)]].concat()),
            Entry::Number(number) => Parameter::Float(short(number)),
            Entry::Pair(numbers) => Parameter::Floats(numbers.map(short).to_vec()),
            Entry::Count(count) => Parameter::Int(i64::from(count)),
            Entry::Texture(name) => Parameter::Word(name.value.clone()),
            Entry::Setting(SettingValue::Int(value)) => Parameter::Int(*value),
            Entry::Setting(SettingValue::Float(value)) => Parameter::Float(*value),
            Entry::Setting(SettingValue::Choice(word)) => Parameter::Word((*word).to_owned()),
        }
    }
}

/// The number of double precision with the same shortest decimals, which reads back as the same number of single precision.
fn short(number: f32) -> f64 {
    number.to_string().parse().unwrap_or(f64::from(number))
}

/// The keywords of a shader beside its name and type, in the order that Sunflow insists on.
pub(crate) fn entries(kind: &ShaderKind) -> Vec<(&'static str, Entry<'_>)> {
    match kind {
        ShaderKind::Constant { color } => vec![colored("color", color)],
        ShaderKind::Diffuse { diffuse } => vec![colored("diff", diffuse)],
        ShaderKind::Phong { diffuse, specular, power, samples } => vec![
            colored("diff", diffuse),
            ("spec", Entry::Highlight(specular, *power)),
            ("samples", Entry::Count(*samples)),
        ],
        ShaderKind::Mirror { color } => vec![("refl", Entry::Color(color))],
        ShaderKind::Glass { eta, color, absorption_distance, absorption_color } => vec![
            ("eta", Entry::Number(*eta)),
            ("color", Entry::Color(color)),
            ("absorption.distance", Entry::Number(*absorption_distance)),
            ("absorption.color", Entry::Color(absorption_color)),
        ],
        ShaderKind::Shiny { diffuse, reflection } => {
            vec![colored("diff", diffuse), ("refl", Entry::Number(*reflection))]
        }
        ShaderKind::Ward { diffuse, specular, roughness, samples } => vec![
            colored("diff", diffuse),
            ("spec", Entry::Color(specular)),
            ("rough", Entry::Pair(*roughness)),
            ("samples", Entry::Count(*samples)),
        ],
        ShaderKind::AmbientOcclusion { bright, dark, samples, distance } => vec![
            colored("bright", bright),
            ("dark", Entry::Color(dark)),
            ("samples", Entry::Count(*samples)),
            ("dist", Entry::Number(*distance)),
        ],
        ShaderKind::Uber { diffuse, specular, glossy, samples } => {
            let mut list = vec![("diff", Entry::Color(&diffuse.color))];
            list.extend(diffuse.texture.as_ref().map(|name| ("diff.texture", Entry::Texture(name))));
            list.extend([("diff.blend", Entry::Number(diffuse.blend)), ("refl", Entry::Color(&specular.color))]);
            list.extend(specular.texture.as_ref().map(|name| ("spec.texture", Entry::Texture(name))));
            list.push(("spec.blend", Entry::Number(specular.blend)));
            list.extend([("glossy", Entry::Number(*glossy)), ("samples", Entry::Count(*samples))]);
            list
        }
        ShaderKind::Wireframe { line, fill, width } => {
            vec![("line", Entry::Color(line)), ("fill", Entry::Color(fill)), ("width", Entry::Number(*width))]
        }
        ShaderKind::Procedural { settings, .. } => {
            settings.iter().map(|setting| (setting.name, Entry::Setting(&setting.value))).collect()
        }
        ShaderKind::ViewCaustics
        | ShaderKind::ViewIrradiance
        | ShaderKind::ViewGlobal
        | ShaderKind::Id
        | ShaderKind::Unsupported => Vec::new(),
    }
}

fn colored<'a>(key: &'static str, value: &'a ColorOrTexture) -> (&'static str, Entry<'a>) {
    match value {
        ColorOrTexture::Color(color) => (key, Entry::Color(color)),
        ColorOrTexture::Texture(name) => ("texture", Entry::Texture(name)),
    }
}
