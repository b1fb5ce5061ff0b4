//! Reads the blocks `modifier` and `texture`.

use jaspe_texture::Texture as Procedural;

use super::block::{Grammar, Key, Required};
use super::shader::{self, parameter_keys};
use super::value::{put, unknown_word};
use super::{Namespace, Parsed, Parser};
use crate::description::{Modifier, ModifierKind, Name, Texture};
use crate::lexer::Token;

/// The keywords of a modifier as far as they were written.
#[derive(Debug, Default)]
struct Draft {
    name: Option<Name>,
    texture: Option<Name>,
    function: Option<i32>,
    size: Option<f32>,
    scale: Option<f32>,
}

struct ModifierType {
    name: &'static str,
    keys: &'static [Key<Draft>],
    required: &'static [Required],
    build: fn(Draft) -> Option<ModifierKind>,
}

const NAME: Key<Draft> = Key::new("name", "name bumps", |p, d, _| put(&mut d.name, p.word("a name")));
const TYPE: Key<Draft> = Key::new("type", "type bump", |p, _, _| p.word("a modifier type").map(drop));
const TEXTURE: Key<Draft> =
    Key::new("texture", "texture \"bumps.png\"", |p, d, _| put(&mut d.texture, p.word("a file name")));
const SCALE: Key<Draft> = Key::new("scale", "scale 0.02", |p, d, _| put(&mut d.scale, p.number()));

const NAME_REQUIRED: Required = (&["name"], "name NAME");
const TEXTURE_REQUIRED: Required = (&["texture"], "texture FILE");

const MODIFIERS: &[ModifierType] = &[
    ModifierType {
        name: "bump",
        keys: &[NAME, TYPE, TEXTURE, SCALE],
        required: &[NAME_REQUIRED, TEXTURE_REQUIRED, (&["scale"], "scale 0.02")],
        build: |d| Some(ModifierKind::Bump { texture: d.texture?, scale: d.scale? }),
    },
    ModifierType {
        name: "normalmap",
        keys: &[NAME, TYPE, TEXTURE],
        required: &[NAME_REQUIRED, TEXTURE_REQUIRED],
        build: |d| Some(ModifierKind::NormalMap { texture: d.texture? }),
    },
    ModifierType {
        name: "perlin",
        keys: &[
            NAME,
            TYPE,
            Key::new("function", "function 0", |p, d, _| {
                // Every number but 0 and 1 means the third function.
                put(&mut d.function, p.int().map(|value| i32::try_from(value).unwrap_or(2)))
            }),
            Key::new("size", "size 1", |p, d, _| put(&mut d.size, p.number())),
            SCALE,
        ],
        required: &[NAME_REQUIRED, (&["function"], "function 0"), (&["size"], "size 1"), (&["scale"], "scale 50")],
        build: |d| Some(ModifierKind::Perlin { function: d.function?, size: d.size?, scale: d.scale? }),
    },
];

pub(super) fn modifier(parser: &mut Parser<'_>, head: Token) -> Parsed<()> {
    parser.open("modifier")?;
    let names = || MODIFIERS.iter().map(|modifier| modifier.name);
    let Some(kind) = parser.outline().kind else {
        let remark = parser.missing_type(head, "modifier", names());
        parser.skip_block(head, Some(remark));
        return Ok(());
    };
    let Some(modifier) = MODIFIERS.iter().find(|modifier| modifier.name == kind.value) else {
        parser.skip_block(head, Some(unknown_word("modifier type", &kind, names())));
        return Ok(());
    };
    let mut draft = Draft::default();
    let outcome = parser.block(head, &Grammar { what: modifier.name, keys: modifier.keys, bare: None }, &mut draft);
    parser.require(modifier.name, &outcome, parser.span(head), modifier.required);
    let name = draft.name.take();
    if let (Some(name), Some(kind)) = (name, (modifier.build)(draft)) {
        parser.declare(Namespace::Modifier, &name);
        parser.scene.modifiers.push(Modifier { name, kind, span: outcome.span });
    }
    Ok(())
}

/// A procedural texture by itself: the keywords of the material of that name.
pub(super) fn texture(parser: &mut Parser<'_>, head: Token) -> Parsed<()> {
    parser.open("texture")?;
    let names = || Procedural::ALL.iter().map(|declaration| declaration.name);
    let Some(kind) = parser.outline().kind else {
        let remark = parser.missing_type(head, "texture", names());
        parser.skip_block(head, Some(remark));
        return Ok(());
    };
    let Some(declaration) = Procedural::ALL.iter().find(|declaration| declaration.name == kind.value) else {
        parser.skip_block(head, Some(unknown_word("texture type", &kind, names())));
        return Ok(());
    };
    let mut draft = shader::Draft::procedural(declaration);
    let keys = parameter_keys(declaration);
    let outcome = parser.block(head, &Grammar { what: declaration.name, keys: &keys, bare: None }, &mut draft);
    parser.require("texture", &outcome, parser.span(head), &[NAME_REQUIRED]);
    if let Some(name) = draft.name {
        parser.declare(Namespace::Texture, &name);
        let settings = draft.settings;
        parser.scene.textures.push(Texture { name, declaration, settings, span: outcome.span });
    }
    Ok(())
}

/// All words of these blocks, for the test of the page on the format.
#[cfg(test)]
pub(super) fn words() -> impl Iterator<Item = &'static str> {
    let keys = MODIFIERS.iter().flat_map(|modifier| modifier.keys).map(|key| key.name);
    keys.chain(MODIFIERS.iter().map(|modifier| modifier.name))
}
