//! The shaders that are not procedural: their keywords and what these mean.

use jaspe_texture::declare::Declaration;

use super::block::{Key, Required};
use super::loose::Loose;
use super::value::put;
use super::{Parsed, Parser};
use crate::description::{Blend, Color, ColorOrTexture, Name, Setting, ShaderKind};
use crate::source::Span;

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
    pub required: &'static [Required],
    /// What the draft means; the span stands for values that were not written.
    pub build: fn(Draft, Span) -> Option<ShaderKind>,
}

pub(super) const NAME: Key<Draft> = Key::new("name", "name red", |p, d, _| put(&mut d.name, p.word("a name")));

pub(super) const TYPE: Key<Draft> = Key::new("type", "type diffuse", |p, d, _| {
    let kind = p.word("a shader type")?;
    // `type constant COLOR` is as good as `type constant color COLOR`.
    if kind.value == "constant" && p.color_follows() {
        d.diffuse = Some(ColorOrTexture::Color(p.color()?));
    }
    Ok(())
});

const COLOR: Key<Draft> = Key::new("color", "color { \"sRGB nonlinear\" 1 0.5 0 }", color);
const REFL: Key<Draft> = Key::new("refl", "refl { \"sRGB nonlinear\" 1 1 1 }", color);

fn color(parser: &mut Parser<'_>, draft: &mut Draft, _: Span) -> Parsed<()> {
    put(&mut draft.color, parser.color())
}

const DIFF: Key<Draft> = Key::new("diff", "diff { \"sRGB nonlinear\" 1 0.5 0 }", diffuse_color);
/// The colour of what shines by itself, in whose place a texture may stand.
const SHINING: Key<Draft> = Key::new("color", "color { \"sRGB nonlinear\" 1 0.5 0 }", diffuse_color);
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

pub(super) const NAME_REQUIRED: Required = (&["name"], "name NAME");
const DIFFUSE_REQUIRED: Required = (&["diff", "texture"], "diff 0.5 0.5 0.5");

/// The shaders that are not procedural.
pub(super) const SHADERS: &[ShaderType] = &[
    ShaderType {
        name: "constant",
        keys: &[NAME, TYPE, SHINING, TEXTURE],
        required: &[],
        build: |d, _| Some(ShaderKind::Constant { color: d.diffuse? }),
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
