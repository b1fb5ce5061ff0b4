//! Reads the `shader` block: the plain shaders from the table here, the procedural ones from their declarations.

use jaspe_texture::Texture;
use jaspe_texture::declare::{Declaration, Kind};

use super::block::{Grammar, Key, Required};
use super::loose::Loose;
use super::value::{put, unknown_word};
use super::{Context, Failed, Namespace, Parsed, Parser};
use crate::description::{Blend, Color, ColorOrTexture, Name, Setting, SettingValue, Shader, ShaderKind};
use crate::diagnostic::Diagnostic;
use crate::lexer::Token;
use crate::source::{Span, Spanned};

/// The keywords of a shader as far as they were written.
#[derive(Debug, Default)]
pub(super) struct Draft {
    pub name: Option<Name>,
    pub declaration: Option<&'static Declaration>,
    pub settings: Vec<Setting>,
    pub color: Option<Color>,
    pub diffuse: Option<ColorOrTexture>,
    pub specular: Option<(Color, f32)>,
    pub samples: Option<u32>,
    pub eta: Option<f32>,
    pub absorption_distance: Option<f32>,
    pub absorption_color: Option<Color>,
    pub dark: Option<Color>,
    pub distance: Option<f32>,
    pub reflection: Option<f32>,
    pub roughness: Option<[f32; 2]>,
    pub diffuse_layer: Layer,
    pub specular_layer: Layer,
    pub glossy: Option<f32>,
    pub width: Option<f32>,
}

/// A part of an `uber` shader as far as it was written.
#[derive(Debug, Clone, Default)]
pub(super) struct Layer {
    pub color: Option<Color>,
    pub texture: Option<Name>,
    pub blend: Option<f32>,
}

impl From<Blend> for Layer {
    fn from(Blend { color, texture, blend }: Blend) -> Self {
        Layer { color: Some(color), texture, blend: Some(blend) }
    }
}

impl Layer {
    fn build(self, default_blend: f32, span: Span) -> Blend {
        let color = self.color.unwrap_or_else(|| Color::new_linear([0.5; 3], span));
        Blend { color, texture: self.texture, blend: self.blend.unwrap_or(default_blend) }
    }
}

/// A shader with a fixed set of keywords.
pub(super) struct ShaderType {
    pub name: &'static str,
    pub keys: &'static [Key<Draft>],
    required: &'static [Required],
    /// What the draft means; the span stands for values that were not written.
    pub build: fn(Draft, Span) -> Option<ShaderKind>,
}

const NAME: Key<Draft> = Key::new("name", "name red", |p, d, _| put(&mut d.name, p.word("a name")));

const TYPE: Key<Draft> = Key::new("type", "type diffuse", |p, d, _| {
    let kind = p.word("a shader type")?;
    // `type constant COLOR` is as good as `type constant color COLOR`.
    if kind.value == "constant" && p.color_follows() {
        d.color = Some(p.color()?);
    }
    Ok(())
});

const COLOR: Key<Draft> = Key::new("color", "color { \"sRGB nonlinear\" 1 0.5 0 }", color);
const REFL: Key<Draft> = Key::new("refl", "refl { \"sRGB nonlinear\" 1 1 1 }", color);

fn color(parser: &mut Parser<'_>, draft: &mut Draft, _: Span) -> Parsed<()> {
    put(&mut draft.color, parser.color())
}

const DIFF: Key<Draft> = Key::new("diff", "diff { \"sRGB nonlinear\" 1 0.5 0 }", diffuse_color);
const BRIGHT: Key<Draft> = Key::new("bright", "bright 1 1 1", diffuse_color);

fn diffuse_color(parser: &mut Parser<'_>, draft: &mut Draft, _: Span) -> Parsed<()> {
    put(&mut draft.diffuse, parser.color().map(ColorOrTexture::Color))
}

const TEXTURE: Key<Draft> = Key::new("texture", "texture \"wall.png\"", |p, d, _| {
    put(&mut d.diffuse, p.word("a file name").map(ColorOrTexture::Texture))
});

const SPEC: Key<Draft> = Key::new("spec", "spec { \"sRGB nonlinear\" 1 1 1 } 50", |p, d, _| {
    d.specular = Some((p.color()?, p.number()?));
    Ok(())
});

const SAMPLES: Key<Draft> = Key::new("samples", "samples 4", |p, d, _| put(&mut d.samples, p.samples()));
const ETA: Key<Draft> = Key::new("eta", "eta 1.5", |p, d, _| put(&mut d.eta, p.positive("`eta`")));
const DARK: Key<Draft> = Key::new("dark", "dark 0 0 0", |p, d, _| put(&mut d.dark, p.color()));
const DIST: Key<Draft> = Key::new("dist", "dist 10", |p, d, _| put(&mut d.distance, p.number()));

fn absorption_distance(parser: &mut Parser<'_>, draft: &mut Draft, _: Span) -> Parsed<()> {
    draft.absorption_distance = Some(parser.number()?);
    Ok(())
}

fn absorption_color(parser: &mut Parser<'_>, draft: &mut Draft, _: Span) -> Parsed<()> {
    draft.absorption_color = Some(parser.color()?);
    if parser.number_follows() {
        let number = parser.spanned(Parser::number::<f32>)?;
        parser.loose(Loose::NumberAfterAbsorption, number.span);
    }
    Ok(())
}

/// A part from 0 to 1; as in Sunflow, brought there.
fn part(parser: &mut Parser<'_>, slot: &mut Option<f32>) -> Parsed<()> {
    let what = parser.context.name;
    let part = parser.spanned(Parser::number::<f32>)?;
    *slot = Some(parser.clamped(&format!("`{what}`"), part, 0.0, 1.0));
    Ok(())
}

/// `refl` and `spec` of an `uber` shader mean the same.
fn specular_color(parser: &mut Parser<'_>, draft: &mut Draft, _: Span) -> Parsed<()> {
    put(&mut draft.specular_layer.color, parser.color())
}

const NAME_REQUIRED: Required = (&["name"], "name NAME");
const DIFFUSE_REQUIRED: Required = (&["diff", "texture"], "diff 0.5 0.5 0.5");

/// The shaders that are not procedural.
const SHADERS: &[ShaderType] = &[
    ShaderType {
        name: "constant",
        keys: &[NAME, TYPE, COLOR],
        required: &[],
        build: |d, _| Some(ShaderKind::Constant { color: d.color? }),
    },
    ShaderType {
        name: "diffuse",
        keys: &[NAME, TYPE, DIFF, TEXTURE],
        required: &[DIFFUSE_REQUIRED],
        build: |d, _| Some(ShaderKind::Diffuse { diffuse: d.diffuse? }),
    },
    ShaderType {
        name: "phong",
        keys: &[NAME, TYPE, DIFF, TEXTURE, SPEC, SAMPLES],
        required: &[DIFFUSE_REQUIRED, (&["spec"], "spec 1 1 1 50")],
        build: |d, _| {
            let (specular, power) = d.specular?;
            Some(ShaderKind::Phong { diffuse: d.diffuse?, specular, power, samples: d.samples.unwrap_or(4) })
        },
    },
    ShaderType {
        name: "mirror",
        keys: &[NAME, TYPE, REFL],
        required: &[(&["refl"], "refl 1 1 1")],
        build: |d, _| Some(ShaderKind::Mirror { color: d.color? }),
    },
    ShaderType {
        name: "glass",
        keys: &[
            NAME,
            TYPE,
            ETA,
            COLOR,
            // Sunflow: its own examples spell it with a `b`.
            Key::new("absorbtion.distance", "absorbtion.distance 5", absorption_distance),
            Key::new("absorbtion.color", "absorbtion.color 0.5 0.5 0.5", absorption_color),
            Key::new("absorption.distance", "absorption.distance 5", absorption_distance),
            Key::new("absorption.color", "absorption.color 0.5 0.5 0.5", absorption_color),
        ],
        required: &[(&["eta"], "eta 1.5"), (&["color"], "color 1 1 1")],
        build: |d, span| {
            Some(ShaderKind::Glass {
                eta: d.eta?,
                color: d.color?,
                absorption_distance: d.absorption_distance.unwrap_or(0.0),
                absorption_color: d.absorption_color.unwrap_or_else(|| Color::new_linear([0.5; 3], span)),
            })
        },
    },
    ShaderType {
        name: "shiny",
        keys: &[NAME, TYPE, DIFF, TEXTURE, Key::new("refl", "refl 0.5", |p, d, _| put(&mut d.reflection, p.number()))],
        required: &[DIFFUSE_REQUIRED, (&["refl"], "refl 0.5")],
        build: |d, _| Some(ShaderKind::Shiny { diffuse: d.diffuse?, reflection: d.reflection? }),
    },
    ShaderType {
        name: "ward",
        keys: &[
            NAME,
            TYPE,
            DIFF,
            TEXTURE,
            Key::new("spec", "spec 0.5 0.5 0.5", color),
            Key::new("rough", "rough 0.2 0.1", |p, d, _| {
                let along = p.positive("the first number of `rough`")?;
                put(&mut d.roughness, p.positive("the second number of `rough`").map(|across| [along, across]))
            }),
            SAMPLES,
        ],
        required: &[DIFFUSE_REQUIRED, (&["spec"], "spec 0.5 0.5 0.5"), (&["rough"], "rough 0.2 0.1")],
        build: |d, _| {
            let (diffuse, specular, roughness) = (d.diffuse?, d.color?, d.roughness?);
            Some(ShaderKind::Ward { diffuse, specular, roughness, samples: d.samples.unwrap_or(4) })
        },
    },
    ShaderType { name: "amb-occ", keys: AMBIENT_OCCLUSION, required: &[], build: ambient_occlusion },
    ShaderType { name: "amb-occ2", keys: AMBIENT_OCCLUSION, required: &[], build: ambient_occlusion },
    ShaderType {
        name: "uber",
        keys: &[
            NAME,
            TYPE,
            Key::new("diff", "diff 0.5 0.5 0.5", |p, d, _| put(&mut d.diffuse_layer.color, p.color())),
            Key::new("diff.texture", "diff.texture \"wall.png\"", |p, d, _| {
                put(&mut d.diffuse_layer.texture, p.word("a file name"))
            }),
            Key::new("diff.blend", "diff.blend 1", |p, d, _| part(p, &mut d.diffuse_layer.blend)),
            Key::new("refl", "refl 0.5 0.5 0.5", specular_color),
            Key::new("spec", "spec 0.5 0.5 0.5", specular_color),
            // The old form of `diff.texture` and `diff.blend`.
            Key::new("texture", "texture \"wall.png\" 1", |p, d, _| {
                d.diffuse_layer.texture = Some(p.word("a file name")?);
                part(p, &mut d.diffuse_layer.blend)
            }),
            Key::new("spec.texture", "spec.texture \"shine.png\"", |p, d, _| {
                put(&mut d.specular_layer.texture, p.word("a file name"))
            }),
            Key::new("spec.blend", "spec.blend 1", |p, d, _| part(p, &mut d.specular_layer.blend)),
            Key::new("glossy", "glossy 0.1", |p, d, _| part(p, &mut d.glossy)),
            SAMPLES,
        ],
        required: &[],
        build: |d, span| {
            let diffuse = d.diffuse_layer.build(1.0, span);
            // Sunflow: what is not said of the specular part is as for the diffuse one (R11).
            let specular = d.specular_layer.build(diffuse.blend, span);
            let (glossy, samples) = (d.glossy.unwrap_or(0.0), d.samples.unwrap_or(4));
            Some(ShaderKind::Uber { diffuse, specular, glossy, samples })
        },
    },
    ShaderType {
        name: "wireframe",
        keys: &[
            NAME,
            TYPE,
            Key::new("line", "line 0 0 0", |p, d, _| put(&mut d.dark, p.color())),
            Key::new("fill", "fill 1 1 1", color),
            Key::new("width", "width 0.0004", |p, d, _| put(&mut d.width, p.positive("`width`"))),
        ],
        required: &[],
        build: |d, span| {
            Some(ShaderKind::Wireframe {
                line: d.dark.unwrap_or_else(|| Color::new_linear([0.0; 3], span)),
                fill: d.color.unwrap_or_else(|| Color::new_linear([1.0; 3], span)),
                // Sunflow: WireframeShader.
                width: d.width.unwrap_or(std::f32::consts::PI / 8192.0),
            })
        },
    },
    ShaderType { name: "view-caustics", keys: BARE, required: &[], build: |_, _| Some(ShaderKind::ViewCaustics) },
    ShaderType { name: "view-irradiance", keys: BARE, required: &[], build: |_, _| Some(ShaderKind::ViewIrradiance) },
    ShaderType { name: "view-global", keys: BARE, required: &[], build: |_, _| Some(ShaderKind::ViewGlobal) },
    ShaderType { name: "id", keys: BARE, required: &[], build: |_, _| Some(ShaderKind::Id) },
];

/// The keywords of a shader that has none of its own.
const BARE: &[Key<Draft>] = &[NAME, TYPE];
const AMBIENT_OCCLUSION: &[Key<Draft>] = &[NAME, TYPE, DIFF, BRIGHT, TEXTURE, DARK, SAMPLES, DIST];

fn ambient_occlusion(draft: Draft, span: Span) -> Option<ShaderKind> {
    let white = || ColorOrTexture::Color(Color::new_linear([1.0; 3], span));
    Some(ShaderKind::AmbientOcclusion {
        bright: draft.diffuse.unwrap_or_else(white),
        dark: draft.dark.unwrap_or_else(|| Color::new_linear([0.0; 3], span)),
        samples: draft.samples.unwrap_or(32),
        distance: draft.distance.unwrap_or(0.0),
    })
}

/// The shader that is written in Java.
const JAVA: &str = "janino";

/// How a shader type is read.
pub(super) enum Type {
    Plain(&'static ShaderType),
    Procedural(&'static Declaration),
}

/// The shader type called so.
pub(super) fn type_called(name: &str) -> Option<Type> {
    let plain = SHADERS.iter().find(|shader| shader.name == name).map(Type::Plain);
    let procedural = || Texture::ALL.iter().find(|d| d.name == name).map(|d| Type::Procedural(d));
    plain.or_else(procedural)
}

fn type_names() -> impl Iterator<Item = &'static str> + Clone {
    SHADERS.iter().map(|shader| shader.name).chain(Texture::ALL.iter().map(|d| d.name))
}

impl Type {
    /// The keywords that it takes: those of a procedural shader come from its declaration.
    pub fn keys(&self) -> Vec<Key<Draft>> {
        match self {
            Type::Plain(shader) => shader.keys.to_vec(),
            Type::Procedural(declaration) => parameter_keys(declaration),
        }
    }

    /// What the draft means, if nothing is missing; the span stands for values that were not written.
    pub fn build(&self, draft: Draft, span: Span) -> Option<ShaderKind> {
        match self {
            Type::Plain(shader) => (shader.build)(draft, span),
            Type::Procedural(declaration) => Some(ShaderKind::Procedural { declaration, settings: draft.settings }),
        }
    }

    fn required(&self) -> Vec<Required> {
        let own = match self {
            Type::Plain(shader) => shader.required,
            Type::Procedural(_) => &[],
        };
        [NAME_REQUIRED].iter().chain(own).copied().collect()
    }
}

/// The keywords of a procedural material.
pub(super) fn parameter_keys(declaration: &Declaration) -> Vec<Key<Draft>> {
    let parameters = declaration.parameters.iter();
    [NAME, TYPE].into_iter().chain(parameters.map(|p| Key::new(p.name, "", parameter_value))).collect()
}

impl Draft {
    /// An empty draft of a procedural shader.
    pub fn procedural(declaration: &'static Declaration) -> Self {
        Draft { declaration: Some(declaration), ..Draft::default() }
    }
}

pub(super) fn shader(parser: &mut Parser<'_>, head: Token) -> Parsed<()> {
    parser.open("shader")?;
    let found = match parser.outline().kind {
        None => Err(parser.missing_type(head, "shader", type_names())),
        Some(kind) => match type_called(&kind.value) {
            Some(shader) => Ok((kind, shader)),
            None if kind.value == JAVA => Err(java(parser.span(head), "the shader", "a grey stands in")),
            None => Err(unknown_word("shader type", &kind, type_names())),
        },
    };
    let (kind, shader) = match found {
        Ok(found) => found,
        Err(remark) => {
            let outline = parser.skip_block(head, Some(remark));
            parser.stand_in(outline.name, head);
            return Ok(());
        }
    };
    let mut draft = match shader {
        Type::Procedural(declaration) => Draft::procedural(declaration),
        _ => Draft::default(),
    };
    let grammar = Grammar { what: &kind.value, keys: &shader.keys(), bare: None };
    let outcome = parser.block(head, &grammar, &mut draft);
    let place = parser.span(head);
    parser.require(&kind.value, &outcome, place, &shader.required());
    // Its colour may stand without a keyword, which `require` cannot see.
    if kind.value == "constant" && draft.color.is_none() && !outcome.failed {
        let diagnostic = Diagnostic::error(place, "`constant` lacks `color`").hint("add `color 1 1 1`");
        parser.diagnostics.push(diagnostic);
    }
    if let Some(name) = draft.name.take() {
        // What lacks a value has been reported, and keeps its name for those who use it.
        let kind = shader.build(draft, outcome.span).unwrap_or(ShaderKind::Unsupported);
        parser.add_shader(Shader { name, kind, span: outcome.span });
    }
    Ok(())
}

impl Parser<'_> {
    /// Keeps the name of a shader that could not be read, so that objects find it.
    fn stand_in(&mut self, name: Option<Name>, head: Token) {
        let end = self.lexer.position() as u32;
        let span = Span { end, ..self.span(head) };
        if let Some(name) = name {
            self.add_shader(Shader { name, kind: ShaderKind::Unsupported, span });
        }
    }

    fn add_shader(&mut self, shader: Shader) {
        self.declare(Namespace::Shader, &shader.name);
        self.scene.shaders.push(shader);
    }
}

/// The remark on something written in Java, which takes a compiler to read.
pub(super) fn java(span: Span, what: &str, consequence: &str) -> Diagnostic {
    let message = format!("skipped: {what} is written in Java (`janino`), which cannot be read: {consequence}");
    Diagnostic::warning(span, message).hint("write it with the other types of this format")
}

/// Reads the value of a declared parameter.
fn parameter_value(parser: &mut Parser<'_>, draft: &mut Draft, key: Span) -> Parsed<()> {
    let Context { name, .. } = parser.context;
    if let Some(Kind::Color) = draft.declaration.and_then(|d| d.parameter(name)).map(|p| p.kind) {
        parser.context.example = "{ \"sRGB nonlinear\" 1 0.5 0 }";
    }
    let parameter = draft.declaration.and_then(|declaration| declaration.parameter(name));
    let parameter = parameter.expect("the keywords are made of the parameters");
    let value = parser.spanned(|parser| match parameter.kind {
        Kind::Int { min, max } => {
            let value = parser.spanned(Parser::int)?;
            parser.require_range(value, min, max, i64::MAX)?;
            Ok(SettingValue::Int(value.value))
        }
        Kind::Float { min, max } => {
            let value = parser.spanned(Parser::number::<f64>)?;
            parser.require_range(value, min, max, f64::MAX)?;
            Ok(SettingValue::Float(value.value))
        }
        Kind::Color => Ok(SettingValue::Color(parser.color()?)),
        Kind::Choice(words) => {
            let choices: Vec<(&'static str, &'static str)> = words.iter().map(|word| (*word, *word)).collect();
            let what = format!("`{name}`");
            Ok(SettingValue::Choice(parser.choice(what.trim_matches('`'), &choices)?.value))
        }
    })?;
    draft.settings.retain(|setting| setting.name != parameter.name);
    draft.settings.push(Setting { name: parameter.name, value: value.value, span: key.to(value.span) });
    Ok(())
}

impl Parser<'_> {
    /// Reports a value out of its range; a range up to `unlimited` has no upper end.
    fn require_range<T: PartialOrd + std::fmt::Display>(
        &mut self,
        value: Spanned<T>,
        min: T,
        max: T,
        unlimited: T,
    ) -> Parsed<()> {
        if value.value >= min && value.value <= max {
            return Ok(());
        }
        let range = match max >= unlimited {
            true => format!("at least {min}"),
            false => format!("from {min} to {max}"),
        };
        let message = format!("`{}` must be {range}, and is {}", self.context.name, value.value);
        self.failed_at = value.span.end;
        self.diagnostics.push(Diagnostic::error(value.span, message));
        Err(Failed)
    }
}

/// All words of the block, for the test of the page on the format.
#[cfg(test)]
pub(super) fn words() -> impl Iterator<Item = &'static str> {
    let keys = SHADERS.iter().flat_map(|shader| shader.keys).map(|key| key.name);
    let keys = keys.filter(|name| !name.starts_with("absorbtion"));
    keys.chain(type_names()).chain([JAVA])
}
