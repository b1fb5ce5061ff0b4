//! Reads the `light` block.

use super::block::{Grammar, Key, Outcome, Required};
use super::{Parsed, Parser};
use crate::description::{Color, Light, LightKind};
use crate::diagnostic::Diagnostic;
use crate::lexer::Token;

/// The keywords of a light as far as they were written.
#[derive(Debug, Default)]
struct Draft {
    color: Option<Color>,
    power: Option<f32>,
    position: Option<[f32; 3]>,
    source: Option<[f32; 3]>,
    target: Option<[f32; 3]>,
    radius: Option<f32>,
    intensity: Option<f32>,
}

struct LightType {
    name: &'static str,
    keys: &'static [Key<Draft>],
    required: &'static [Required],
    build: fn(Draft) -> Option<LightKind>,
}

const TYPE: Key<Draft> = Key::new("type", "type point", |p, _, _| p.word("a light type").map(drop));

const LIGHTS: &[LightType] = &[
    LightType {
        name: "point",
        keys: &[
            TYPE,
            Key::new("color", "color 1 1 1", |p, d, _| {
                d.color = Some(p.color()?);
                Ok(())
            }),
            Key::new("power", "power 100", power),
            Key::new("p", "p 0 5 0", |p, d, _| {
                d.position = Some(p.numbers()?);
                Ok(())
            }),
        ],
        required: &[(&["power"], "color 1 1 1 power 100"), (&["p"], "p 0 5 0")],
        build: |d| Some(LightKind::Point { color: d.color?, power: d.power?, position: d.position? }),
    },
    LightType {
        name: "directional",
        keys: &[
            TYPE,
            Key::new("source", "source 0 0 4", |p, d, _| {
                d.source = Some(p.numbers()?);
                Ok(())
            }),
            Key::new("target", "target 0 0 0", |p, d, _| {
                d.target = Some(p.numbers()?);
                Ok(())
            }),
            Key::new("radius", "radius 1", |p, d, _| {
                d.radius = Some(p.positive("`radius`")?);
                Ok(())
            }),
            Key::new("emit", "emit 1 1 1", |p, d, _| {
                d.color = Some(p.color()?);
                Ok(())
            }),
            Key::new("intensity", "intensity 2", |p, d, _| {
                d.intensity = Some(p.number()?);
                Ok(())
            }),
        ],
        required: &[
            (&["source"], "source 0 0 4"),
            (&["target"], "target 0 0 0"),
            (&["radius"], "radius 1"),
            (&["emit"], "emit 1 1 1"),
        ],
        build: |d| {
            let (source, target, radius, emit) = (d.source?, d.target?, d.radius?, d.color?);
            Some(LightKind::Directional { source, target, radius, emit, intensity: d.intensity.unwrap_or(1.0) })
        },
    },
];

/// Sunflow's other lights.
const UNSUPPORTED: &[&str] = &["spherical", "meshlight", "mesh", "sunsky", "ibl", "cornellbox"];

/// `power F`, or in the old form `power COLOR`.
fn power(parser: &mut Parser<'_>, draft: &mut Draft, _: crate::Span) -> Parsed<()> {
    let before = parser.lexer;
    let is_group = parser.peek().is_some_and(|token| parser.is(token, "{"));
    if !is_group {
        let power = parser.number()?;
        if !parser.number_follows() {
            draft.power = Some(power);
            return Ok(());
        }
        parser.lexer = before;
    }
    draft.color = Some(parser.color()?);
    draft.power = Some(1.0);
    Ok(())
}

pub(super) fn light(parser: &mut Parser<'_>, head: Token) -> Parsed<()> {
    parser.open("light")?;
    let names = || LIGHTS.iter().map(|light| light.name);
    let Some(kind) = parser.outline().kind else {
        let remark = parser.missing_type(head, "light", names());
        parser.skip_block(head, Some(remark));
        return Ok(());
    };
    let Some(light) = LIGHTS.iter().find(|light| light.name == kind.value) else {
        let remark = parser.other_type(head, "light", &kind, names(), UNSUPPORTED);
        parser.skip_block(head, Some(remark));
        return Ok(());
    };
    let mut draft = Draft::default();
    let outcome = parser.block(head, &Grammar { what: light.name, keys: light.keys, bare: None }, &mut draft);
    let place = parser.span(head);
    parser.require(light.name, &outcome, place, light.required);
    parser.require_color(&draft, &outcome, head);
    if let Some(kind) = (light.build)(draft) {
        parser.scene.lights.push(Light { kind, span: outcome.span });
    }
    Ok(())
}

impl Parser<'_> {
    /// A point light has a colour, by itself or in the old form of `power`.
    fn require_color(&mut self, draft: &Draft, outcome: &Outcome, head: Token) {
        if draft.power.is_some() && draft.color.is_none() && !outcome.has("color") {
            let diagnostic = Diagnostic::error(self.span(head), "`point` lacks `color`");
            self.diagnostics.push(diagnostic.hint("add `color 1 1 1`"));
        }
    }
}

/// All words of the block, for the test of the page on the format.
#[cfg(test)]
pub(super) fn words() -> impl Iterator<Item = &'static str> {
    let keys = LIGHTS.iter().flat_map(|light| light.keys).map(|key| key.name);
    keys.chain(LIGHTS.iter().map(|light| light.name)).chain(UNSUPPORTED.iter().copied())
}
