//! Reads the `light` block.

use super::block::{Grammar, Key, Outcome, Reader, Required};
use super::mesh::{self, MeshDraft};
use super::value::put;
use super::{Parsed, Parser};
use crate::description::{Color, CornellBox, Ground, Light, LightKind, Name};
use crate::diagnostic::Diagnostic;
use crate::lexer::Token;
use crate::source::Span;

/// The keywords of a light as far as they were written.
#[derive(Debug, Default)]
struct Draft {
    name: Option<Name>,
    color: Option<Color>,
    /// Power, radiance or intensity: what multiplies the colour.
    power: Option<f32>,
    position: Option<[f32; 3]>,
    source: Option<[f32; 3]>,
    target: Option<[f32; 3]>,
    radius: Option<f32>,
    samples: Option<u32>,
    low_samples: Option<u32>,
    /// Sunflow: what `lightserver` says in place of `samples` that are missing.
    direct_samples: u32,
    mesh: MeshDraft,
    up: Option<[f32; 3]>,
    east: Option<[f32; 3]>,
    direction: Option<[f32; 3]>,
    turbidity: Option<f32>,
    extends: bool,
    ground: Option<Color>,
    image: Option<Name>,
    lock: Option<bool>,
    corners: [Option<[f32; 3]>; 2],
    walls: [Option<Color>; 5],
}

struct LightType {
    name: &'static str,
    keys: &'static [Key<Draft>],
    bare: Option<Reader<Draft>>,
    required: &'static [Required],
    build: fn(&mut Parser<'_>, Draft, Span) -> Option<LightKind>,
}

const TYPE: Key<Draft> = Key::new("type", "type point", |p, _, _| p.word("a light type").map(drop));
const COLOR: Key<Draft> = Key::new("color", "color 1 1 1", |p, d, _| put(&mut d.color, p.color()));
const EMIT: Key<Draft> = Key::new("emit", "emit 1 1 1", |p, d, _| put(&mut d.color, p.color()));
const RADIANCE: Key<Draft> = Key::new("radiance", "radiance 10", |p, d, _| put(&mut d.power, p.number()));
const RADIUS: Key<Draft> = Key::new("radius", "radius 1", |p, d, _| put(&mut d.radius, p.positive("`radius`")));
const SAMPLES: Key<Draft> = Key::new("samples", "samples 16", |p, d, _| put(&mut d.samples, p.samples()));
const CENTER: Key<Draft> = Key::new("center", "center 0 0 5", |p, d, _| put(&mut d.position, p.numbers()));
const NAME: Key<Draft> = Key::new("name", "name lamp", |p, d, _| put(&mut d.name, p.word("a name")));
const UP: Key<Draft> = Key::new("up", "up 0 0 1", |p, d, _| put(&mut d.up, p.direction()));

const LIGHTS: &[LightType] = &[
    LightType {
        name: "point",
        keys: &[
            TYPE,
            COLOR,
            Key::new("power", "power 100", power),
            Key::new("p", "p 0 5 0", |p, d, _| put(&mut d.position, p.numbers())),
        ],
        bare: None,
        required: &[(&["power"], "color 1 1 1 power 100"), (&["p"], "p 0 5 0")],
        build: |_, d, _| Some(LightKind::Point { color: d.color?, power: d.power?, position: d.position? }),
    },
    LightType {
        name: "directional",
        keys: &[
            TYPE,
            Key::new("source", "source 0 0 4", |p, d, _| put(&mut d.source, p.numbers())),
            Key::new("target", "target 0 0 0", |p, d, _| put(&mut d.target, p.numbers())),
            RADIUS,
            EMIT,
            Key::new("intensity", "intensity 2", |p, d, _| put(&mut d.power, p.number())),
        ],
        bare: None,
        required: &[
            (&["source"], "source 0 0 4"),
            (&["target"], "target 0 0 0"),
            (&["radius"], "radius 1"),
            (&["emit"], "emit 1 1 1"),
        ],
        build: |_, d, _| {
            let (source, target, radius, emit) = (d.source?, d.target?, d.radius?, d.color?);
            Some(LightKind::Directional { source, target, radius, emit, intensity: d.power.unwrap_or(1.0) })
        },
    },
    LightType {
        name: "spherical",
        keys: &[TYPE, COLOR, RADIANCE, CENTER, RADIUS, SAMPLES],
        bare: None,
        required: &[
            (&["color"], "color 1 1 1"),
            (&["radiance"], "radiance 10"),
            (&["center"], "center 0 0 5"),
            (&["radius"], "radius 1"),
            (&["samples"], "samples 16"),
        ],
        build: |_, d, _| {
            let (color, radiance, center, radius) = (d.color?, d.power?, d.position?, d.radius?);
            Some(LightKind::Spherical { color, radiance, center, radius, samples: d.samples? })
        },
    },
    LightType {
        name: "meshlight",
        keys: &[
            TYPE,
            NAME,
            EMIT,
            RADIANCE,
            SAMPLES,
            Key::new("points", "points 3 0 0 0 1 0 0 0 1 0", |p, d, key| p.mesh_points(key, &mut d.mesh)),
            Key::new("triangles", "triangles 1 0 1 2", |p, d, key| p.mesh_triangles(key, &mut d.mesh)),
        ],
        bare: None,
        required: &[(&["emit"], "emit 1 1 1"), mesh::POINTS_REQUIRED, mesh::TRIANGLES_REQUIRED],
        build: mesh_light,
    },
    LightType {
        name: "mesh",
        keys: &[TYPE, NAME, EMIT, SAMPLES],
        bare: Some(|p, d, key| p.legacy_lists(&mut d.mesh, key)),
        required: &[(&["emit"], "emit 1 1 1")],
        build: mesh_light,
    },
    LightType {
        name: "sunsky",
        keys: &[
            TYPE,
            UP,
            Key::new("east", "east 0 1 0", |p, d, _| put(&mut d.east, p.direction())),
            Key::new("sundir", "sundir 1 1 1", |p, d, _| put(&mut d.direction, p.direction())),
            Key::new("turbidity", "turbidity 4", |p, d, _| put(&mut d.turbidity, p.positive("`turbidity`"))),
            SAMPLES,
            Key::new("ground.extendsky", "ground.extendsky true", |p, d, _| {
                d.extends = p.boolean()?.value;
                Ok(())
            }),
            Key::new("ground.color", "ground.color 0.2 0.2 0.2", |p, d, _| put(&mut d.ground, p.color())),
        ],
        bare: None,
        required: &[
            (&["up"], "up 0 0 1"),
            (&["east"], "east 0 1 0"),
            (&["sundir"], "sundir 1 1 1"),
            (&["turbidity"], "turbidity 4"),
        ],
        build: |_, d, head| {
            let black = || Color::new_linear([0.0; 3], head);
            let ground = if d.extends { Ground::Sky } else { Ground::Color(d.ground.unwrap_or_else(black)) };
            let (up, east, sundir, turbidity) = (d.up?, d.east?, d.direction?, d.turbidity?);
            Some(LightKind::SunSky { up, east, sundir, turbidity, samples: d.samples.unwrap_or(64), ground })
        },
    },
    LightType {
        name: "ibl",
        keys: &[
            TYPE,
            Key::new("image", "image sky.hdr", |p, d, _| put(&mut d.image, p.word("a file name"))),
            Key::new("center", "center 0 -1 0", |p, d, _| put(&mut d.direction, p.direction())),
            UP,
            Key::new("lock", "lock true", |p, d, _| put(&mut d.lock, p.boolean().map(|lock| lock.value))),
            SAMPLES,
            Key::new("lowsamples", "lowsamples 8", |p, d, _| put(&mut d.low_samples, p.samples())),
        ],
        bare: None,
        required: &[
            (&["image"], "image sky.hdr"),
            (&["center"], "center 0 -1 0"),
            (&["up"], "up 0 0 1"),
            (&["lock"], "lock true"),
        ],
        build: |_, d, _| {
            let samples = d.samples.unwrap_or(d.direct_samples);
            let low_samples = d.low_samples.unwrap_or(samples);
            Some(LightKind::Ibl {
                image: d.image?,
                center: d.direction?,
                up: d.up?,
                lock: d.lock?,
                samples,
                low_samples,
            })
        },
    },
    LightType {
        name: "cornellbox",
        keys: &[
            TYPE,
            Key::new("corner0", "corner0 -60 -60 0", |p, d, _| put(&mut d.corners[0], p.numbers())),
            Key::new("corner1", "corner1 60 60 100", |p, d, _| put(&mut d.corners[1], p.numbers())),
            Key::new("left", "left 0.8 0.25 0.25", |p, d, _| put(&mut d.walls[0], p.color())),
            Key::new("right", "right 0.25 0.25 0.8", |p, d, _| put(&mut d.walls[1], p.color())),
            Key::new("top", "top 0.7 0.7 0.7", |p, d, _| put(&mut d.walls[2], p.color())),
            Key::new("bottom", "bottom 0.7 0.7 0.7", |p, d, _| put(&mut d.walls[3], p.color())),
            Key::new("back", "back 0.7 0.7 0.7", |p, d, _| put(&mut d.walls[4], p.color())),
            EMIT,
            SAMPLES,
        ],
        bare: None,
        required: &[
            (&["corner0"], "corner0 -60 -60 0"),
            (&["corner1"], "corner1 60 60 100"),
            (&["left"], "left 0.8 0.25 0.25"),
            (&["right"], "right 0.25 0.25 0.8"),
            (&["top"], "top 0.7 0.7 0.7"),
            (&["bottom"], "bottom 0.7 0.7 0.7"),
            (&["back"], "back 0.7 0.7 0.7"),
            (&["emit"], "emit 15 15 15"),
        ],
        build: |_, d, _| {
            let [left, right, top, bottom, back] = d.walls;
            Some(LightKind::CornellBox(CornellBox {
                corners: [d.corners[0]?, d.corners[1]?],
                left: left?,
                right: right?,
                top: top?,
                bottom: bottom?,
                back: back?,
                emit: d.color?,
                samples: d.samples.unwrap_or(16),
            }))
        },
    },
];

fn mesh_light(parser: &mut Parser<'_>, draft: Draft, _: Span) -> Option<LightKind> {
    let Draft { name, color, power, samples, direct_samples, mesh, .. } = draft;
    let shape = parser.bare_triangles(mesh)?;
    let (radiance, samples) = (power.unwrap_or(1.0), samples.unwrap_or(direct_samples));
    Some(LightKind::Mesh { name, emit: color?, radiance, samples, shape })
}

/// `power F`, or in the old form `power COLOR`.
fn power(parser: &mut Parser<'_>, draft: &mut Draft, _: Span) -> Parsed<()> {
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
        parser.skip_block(head, Some(super::value::unknown_word("light type", &kind, names())));
        return Ok(());
    };
    let mut draft = Draft { direct_samples: parser.direct_samples, ..Draft::default() };
    let outcome = parser.block(head, &Grammar { what: light.name, keys: light.keys, bare: light.bare }, &mut draft);
    let place = parser.span(head);
    parser.require(light.name, &outcome, place, light.required);
    parser.require_color(&draft, &outcome, head);
    if light.bare.is_some() && !outcome.failed {
        parser.require_legacy_lists(&draft.mesh, place);
    }
    // What is left of a block that could not be read is no light.
    if let Some(kind) = (light.build)(parser, draft, place) {
        parser.scene.lights.push(Light { kind, span: outcome.span });
    }
    Ok(())
}

impl Parser<'_> {
    /// A point light has a colour, by itself or in the old form of `power`.
    fn require_color(&mut self, draft: &Draft, outcome: &Outcome, head: Token) {
        if outcome.has("power") && draft.power.is_some() && draft.color.is_none() && !outcome.has("color") {
            let diagnostic = Diagnostic::error(self.span(head), "`point` lacks `color`");
            self.diagnostics.push(diagnostic.hint("add `color 1 1 1`"));
        }
    }
}

/// All words of the block, for the test of the page on the format.
#[cfg(test)]
pub(super) fn words() -> impl Iterator<Item = &'static str> {
    let keys = LIGHTS.iter().flat_map(|light| light.keys).map(|key| key.name);
    keys.chain(LIGHTS.iter().map(|light| light.name))
}
