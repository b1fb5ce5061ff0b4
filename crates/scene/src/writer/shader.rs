//! The blocks `shader`, `texture` and `modifier`.

use std::io::{self, Write};

use super::text::{Block, color, number, numbers, quoted};
use crate::description::{
    ColorOrTexture, Modifier, ModifierKind, Name, Setting, SettingValue, Shader, ShaderKind, Texture,
};

pub(super) fn shader(shader: &Shader, out: &mut dyn Write) -> io::Result<()> {
    let block = head("shader", &shader.name, shader.kind.keyword());
    match &shader.kind {
        ShaderKind::Constant { color: c } => block.entry("color", color(c)),
        ShaderKind::Diffuse { diffuse: d } => diffuse(block, "diff", d),
        ShaderKind::Phong { diffuse: d, specular, power, samples } => {
            let specular = format!("{} {}", color(specular), number(*power));
            diffuse(block, "diff", d).entry("spec", specular).entry("samples", number(*samples))
        }
        ShaderKind::Mirror { color: c } => block.entry("refl", color(c)),
        ShaderKind::Glass { eta, color: c, absorption_distance, absorption_color } => block
            .entry("eta", number(*eta))
            .entry("color", color(c))
            .entry("absorption.distance", number(*absorption_distance))
            .entry("absorption.color", color(absorption_color)),
        ShaderKind::Shiny { diffuse: d, reflection } => diffuse(block, "diff", d).entry("refl", number(*reflection)),
        ShaderKind::Ward { diffuse: d, specular, roughness, samples } => diffuse(block, "diff", d)
            .entry("spec", color(specular))
            .entry("rough", numbers(roughness))
            .entry("samples", number(*samples)),
        ShaderKind::AmbientOcclusion { bright, dark, samples, distance } => diffuse(block, "bright", bright)
            .entry("dark", color(dark))
            .entry("samples", number(*samples))
            .entry("dist", number(*distance)),
        ShaderKind::Uber { diffuse: d, specular: s, glossy, samples } => block
            .entry("diff", color(&d.color))
            .option("diff.texture", d.texture.as_ref().map(|name| quoted(&name.value)))
            .entry("diff.blend", number(d.blend))
            .entry("refl", color(&s.color))
            .option("spec.texture", s.texture.as_ref().map(|name| quoted(&name.value)))
            .entry("spec.blend", number(s.blend))
            .entry("glossy", number(*glossy))
            .entry("samples", number(*samples)),
        ShaderKind::Wireframe { line, fill, width } => {
            block.entry("line", color(line)).entry("fill", color(fill)).entry("width", number(*width))
        }
        ShaderKind::ViewCaustics | ShaderKind::ViewIrradiance | ShaderKind::ViewGlobal | ShaderKind::Id => block,
        ShaderKind::Procedural { settings: list, .. } => settings(block, list),
        // A grey stands in for what could not be read.
        ShaderKind::Unsupported => head("shader", &shader.name, "diffuse").entry("diff", "0.5 0.5 0.5"),
    }
    .close(out)
}

pub(super) fn texture(texture: &Texture, out: &mut dyn Write) -> io::Result<()> {
    settings(head("texture", &texture.name, texture.declaration.name), &texture.settings).close(out)
}

pub(super) fn modifier(modifier: &Modifier, out: &mut dyn Write) -> io::Result<()> {
    let block = head("modifier", &modifier.name, modifier.kind.keyword());
    match &modifier.kind {
        ModifierKind::Bump { texture, scale } => {
            block.entry("texture", quoted(&texture.value)).entry("scale", number(*scale))
        }
        ModifierKind::NormalMap { texture } => block.entry("texture", quoted(&texture.value)),
        ModifierKind::Perlin { function, size, scale } => {
            block.entry("function", number(*function)).entry("size", number(*size)).entry("scale", number(*scale))
        }
    }
    .close(out)
}

fn head(keyword: &'static str, name: &Name, kind: &str) -> Block {
    Block::new(keyword).entry("name", quoted(&name.value)).entry("type", kind)
}

fn diffuse(block: Block, keyword: &str, value: &ColorOrTexture) -> Block {
    match value {
        ColorOrTexture::Color(value) => block.entry(keyword, color(value)),
        ColorOrTexture::Texture(name) => block.entry("texture", quoted(&name.value)),
    }
}

fn settings(block: Block, settings: &[Setting]) -> Block {
    settings.iter().fold(block, |block, setting| {
        let value = match &setting.value {
            SettingValue::Int(value) => number(*value),
            SettingValue::Float(value) => number(*value),
            SettingValue::Color(value) => color(value),
            SettingValue::Choice(word) => (*word).to_owned(),
        };
        block.entry(setting.name, value)
    })
}
