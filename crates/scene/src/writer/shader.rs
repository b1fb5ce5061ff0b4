//! The blocks `shader`, `texture` and `modifier`.

use std::io::{self, Write};

use super::text::{Block, color, number, numbers, quoted};
use crate::description::{Modifier, ModifierKind, Name, SettingValue, Shader, ShaderKind, Texture};
use crate::parameters::{Entry, entries};

pub(super) fn shader(shader: &Shader, out: &mut dyn Write) -> io::Result<()> {
    match &shader.kind {
        // A grey stands in for what could not be read.
        ShaderKind::Unsupported => head("shader", &shader.name, "diffuse").entry("diff", "0.5 0.5 0.5"),
        kind => entries(kind)
            .into_iter()
            .fold(head("shader", &shader.name, kind.keyword()), |block, (key, entry)| block.entry(key, written(entry))),
    }
    .close(out)
}

pub(super) fn texture(texture: &Texture, out: &mut dyn Write) -> io::Result<()> {
    let head = head("texture", &texture.name, texture.declaration.name);
    let settings = texture.settings.iter();
    settings.fold(head, |block, setting| block.entry(setting.name, written(Entry::Setting(&setting.value)))).close(out)
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

/// What is written after a keyword.
fn written(entry: Entry<'_>) -> String {
    match entry {
        Entry::Color(value) | Entry::Setting(SettingValue::Color(value)) => color(value),
        Entry::Highlight(value, power) => format!("{} {}", color(value), number(power)),
        Entry::Number(value) => number(value),
        Entry::Pair(values) => numbers(&values),
        Entry::Count(value) => number(value),
        Entry::Texture(name) => quoted(&name.value),
        Entry::Setting(SettingValue::Int(value)) => number(*value),
        Entry::Setting(SettingValue::Float(value)) => number(*value),
        Entry::Setting(SettingValue::Choice(word)) => (*word).to_owned(),
    }
}
