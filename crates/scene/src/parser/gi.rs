//! Reads the blocks of indirect light: `gi`, `photons` and the old `lightserver`.

use super::block::{Grammar, Key, Required};
use super::value::{put, shorten, unknown_word};
use super::{Parsed, Parser};
use crate::description::{Caustics, Color, Gi, GiKind, GlobalPhotons, PhotonMap};
use crate::diagnostic::Diagnostic;
use crate::lexer::Token;
use crate::source::{Span, Spanned};

/// More photons than this are not asked for: they would fill the memory of most machines.
pub(super) const MOST_PHOTONS: u32 = 20_000_000;

/// More rays from one point than this make no picture better.
pub(super) const MOST_SAMPLES: u32 = 1_000_000;

/// The keywords of a `gi` block as far as they were written.
#[derive(Debug, Default)]
struct Draft {
    samples: Option<u32>,
    sets: Option<u32>,
    tolerance: Option<f32>,
    spacing: Option<[f32; 2]>,
    global: Option<GlobalPhotons>,
    bias: Option<f32>,
    bias_samples: Option<u32>,
    bright: Option<Color>,
    dark: Option<Color>,
    max_distance: Option<f32>,
    up: Option<[f32; 3]>,
    sky: Option<Color>,
    ground: Option<Color>,
}

struct Engine {
    name: &'static str,
    keys: &'static [Key<Draft>],
    required: &'static [Required],
    build: fn(Draft) -> Option<GiKind>,
}

const TYPE: Key<Draft> = Key::new("type", "type path", |p, _, _| p.word("a method").map(drop));
const SAMPLES: Key<Draft> = Key::new("samples", "samples 16", |p, d, _| put(&mut d.samples, p.samples()));
const SAMPLES_REQUIRED: Required = (&["samples"], "samples 64");

const ENGINES: &[Engine] = &[
    Engine {
        name: "path",
        // Sunflow: the number of bounces is that of `trace-depths`.
        keys: &[TYPE, SAMPLES, Key::new("bounces", "bounces 1", |p, _, _| p.int().map(drop))],
        required: &[SAMPLES_REQUIRED],
        build: |d| Some(GiKind::Path { samples: d.samples? }),
    },
    Engine {
        name: "irr-cache",
        keys: &[
            TYPE,
            SAMPLES,
            Key::new("tolerance", "tolerance 0.05", |p, d, _| put(&mut d.tolerance, p.number())),
            Key::new("spacing", "spacing 0.05 5", |p, d, _| put(&mut d.spacing, p.numbers())),
            Key::new("global", "global 100000 grid 50 0.5", |p, d, _| {
                d.global = p.global_photons()?;
                Ok(())
            }),
        ],
        required: &[SAMPLES_REQUIRED, (&["tolerance"], "tolerance 0.05"), (&["spacing"], "spacing 0.05 5")],
        build: |d| {
            let (samples, tolerance, spacing) = (d.samples?, d.tolerance?, d.spacing?);
            Some(GiKind::IrradianceCache { samples, tolerance, spacing, global: d.global })
        },
    },
    Engine {
        name: "igi",
        keys: &[
            TYPE,
            SAMPLES,
            Key::new("sets", "sets 1", |p, d, _| put(&mut d.sets, p.samples())),
            Key::new("b", "b 0.00003", |p, d, _| put(&mut d.bias, p.number())),
            Key::new("c", "c 0.00003", |p, d, _| put(&mut d.bias, p.number())),
            Key::new("bias-samples", "bias-samples 0", |p, d, _| put(&mut d.bias_samples, p.samples())),
        ],
        required: &[
            SAMPLES_REQUIRED,
            (&["sets"], "sets 1"),
            (&["b", "c"], "b 0.00003"),
            (&["bias-samples"], "bias-samples 0"),
        ],
        build: |d| {
            let (samples, sets, bias) = (d.samples?, d.sets?.max(1), d.bias?);
            Some(GiKind::Instant { samples, sets, bias, bias_samples: d.bias_samples? })
        },
    },
    Engine {
        name: "ambocc",
        keys: &[
            TYPE,
            SAMPLES,
            Key::new("bright", "bright 1 1 1", |p, d, _| put(&mut d.bright, p.color())),
            Key::new("dark", "dark 0 0 0", |p, d, _| put(&mut d.dark, p.color())),
            Key::new("maxdist", "maxdist 5", |p, d, _| put(&mut d.max_distance, p.number())),
        ],
        required: &[(&["bright"], "bright 1 1 1"), (&["dark"], "dark 0 0 0"), SAMPLES_REQUIRED],
        build: |d| {
            let (bright, dark, samples) = (d.bright?, d.dark?, d.samples?);
            Some(GiKind::AmbientOcclusion { bright, dark, samples, max_distance: d.max_distance.unwrap_or(0.0) })
        },
    },
    Engine {
        name: "fake",
        keys: &[
            TYPE,
            Key::new("up", "up 0 1 0", |p, d, _| put(&mut d.up, p.direction())),
            Key::new("sky", "sky 1 1 1", |p, d, _| put(&mut d.sky, p.color())),
            Key::new("ground", "ground 0 0 0", |p, d, _| put(&mut d.ground, p.color())),
        ],
        required: &[(&["up"], "up 0 1 0"), (&["sky"], "sky 1 1 1"), (&["ground"], "ground 0 0 0")],
        build: |d| Some(GiKind::Fake { up: d.up?, sky: d.sky?, ground: d.ground? }),
    },
];

/// Words that switch indirect light off.
const OFF: [&str; 2] = ["none", "null"];

pub(super) fn gi(parser: &mut Parser<'_>, head: Token) -> Parsed<()> {
    parser.open("gi")?;
    let names = || ENGINES.iter().map(|engine| engine.name).chain(["none"]);
    let Some(kind) = parser.outline().kind else {
        let remark = parser.missing_type(head, "gi", names());
        parser.skip_block(head, Some(remark));
        return Ok(());
    };
    if OFF.contains(&kind.value.as_str()) {
        parser.scene.gi = None;
        parser.block(head, &Grammar { what: "none", keys: &[TYPE], bare: None }, &mut Draft::default());
        return Ok(());
    }
    let Some(engine) = ENGINES.iter().find(|engine| engine.name == kind.value) else {
        parser.skip_block(head, Some(unknown_word("gi type", &kind, names())));
        return Ok(());
    };
    let mut draft = Draft::default();
    let outcome = parser.block(head, &Grammar { what: engine.name, keys: engine.keys, bare: None }, &mut draft);
    parser.require(engine.name, &outcome, parser.span(head), engine.required);
    if let Some(kind) = (engine.build)(draft) {
        parser.scene.gi = Some(Gi { kind, span: outcome.span });
    }
    Ok(())
}

/// The keywords of a `photons` block as far as they were written.
#[derive(Debug, Default)]
struct PhotonsDraft {
    emit: Option<u32>,
    /// `None` inside where the map is switched off.
    caustics: Option<Option<(Option<u32>, u32, f32)>>,
}

const PHOTONS: &[Key<PhotonsDraft>] = &[
    Key::new("emit", "emit 100000", |p, d, _| put(&mut d.emit, p.photon_count())),
    // Sunflow: the global map belongs to `gi`.
    Key::new("global", "global 100000 grid 50 0.5", |p, _, _| p.photon_map().map(drop)),
    Key::new("caustics", "caustics 100000 kd 64 0.5", |p, d, _| {
        let (emit, map, gather, radius) = p.photon_map()?;
        if !matches!(map.value.as_str(), "kd" | "none") {
            let message = format!("there is no caustic map `{}`: there will be none", shorten(&map.value));
            p.diagnostics.push(Diagnostic::warning(map.span, message).hint("the only one is `kd`"));
        }
        d.caustics = Some((map.value == "kd").then_some((emit, gather, radius)));
        Ok(())
    }),
];

pub(super) fn photons(parser: &mut Parser<'_>, head: Token) -> Parsed<()> {
    parser.open("photons")?;
    let mut draft = PhotonsDraft::default();
    let outcome = parser.block(head, &Grammar { what: "photons", keys: PHOTONS, bare: None }, &mut draft);
    let place = parser.span(head);
    parser.require("photons", &outcome, place, &[(&["caustics"], "caustics 100000 kd 64 0.5")]);
    match draft.caustics {
        Some(Some((emit, gather, radius))) => {
            let Some(emit) = emit.or(draft.emit) else {
                let diagnostic = Diagnostic::error(outcome.place("caustics"), "`caustics` lacks the number of photons");
                parser.diagnostics.push(diagnostic.hint("for example `caustics 100000 kd 64 0.5`"));
                return Ok(());
            };
            parser.scene.caustics = Some(Caustics { emit, gather, radius, span: outcome.span });
        }
        Some(None) => parser.scene.caustics = None,
        None => {}
    }
    Ok(())
}

/// The old block of everything about light: two of its keywords have an effect (format reference, §2.6).
const LIGHTSERVER: &[Key<()>] = &[
    Key::new("shadows", "shadows true", |p, (), _| p.boolean().map(drop)),
    Key::new("direct-samples", "direct-samples 4", |p, (), _| {
        p.direct_samples = p.samples()?;
        Ok(())
    }),
    Key::new("glossy-samples", "glossy-samples 4", |p, (), _| p.int().map(drop)),
    Key::new("max-depth", "max-depth 4", |p, (), key| {
        let depth = p.spanned(Parser::int)?;
        let span = key.to(depth.span);
        let depths = [1, depth.value - 1, 0].map(|depth| depth.clamp(0, i64::from(u32::MAX)) as u32);
        let [diffuse, reflection, refraction] = depths.map(|depth| Some(Spanned::new(depth, span)));
        p.scene.trace_depths = crate::description::TraceDepths { diffuse, reflection, refraction };
        Ok(())
    }),
    Key::new("global", "global false 0 0 0 0", |p, (), _| p.switch_and_numbers(4)),
    Key::new("caustics", "caustics false 0 0 0 0", |p, (), _| p.switch_and_numbers(4)),
    Key::new("irr-cache", "irr-cache 0 0 0 0", |p, (), _| p.numbers::<f32, 4>().map(drop)),
];

pub(super) fn lightserver(parser: &mut Parser<'_>, head: Token) -> Parsed<()> {
    parser.open("lightserver")?;
    parser.block(head, &Grammar { what: "lightserver", keys: LIGHTSERVER, bare: None }, &mut ());
    Ok(())
}

impl Parser<'_> {
    /// `true` or `false` and some numbers, all without effect.
    fn switch_and_numbers(&mut self, count: usize) -> Parsed<()> {
        self.boolean()?;
        (0..count).try_for_each(|_| self.number::<f32>().map(drop))
    }

    /// A number of rays, brought into its range.
    pub(super) fn samples(&mut self) -> Parsed<u32> {
        let count = self.spanned(Parser::int)?;
        Ok(self.clamped("the number of samples", count, 0, MOST_SAMPLES.into()) as u32)
    }

    /// A number of photons, brought into its range.
    fn photon_count(&mut self) -> Parsed<u32> {
        let count = self.spanned(Parser::int)?;
        Ok(self.clamped("the number of photons", count, 0, MOST_PHOTONS.into()) as u32)
    }

    /// `[N] MAP GATHER RADIUS`.
    fn photon_map(&mut self) -> Parsed<(Option<u32>, Spanned<String>, u32, f32)> {
        let emit = if self.number_follows() { Some(self.photon_count()?) } else { None };
        let map = self.word("a kind of photon map")?;
        let gather = self.spanned(Parser::int)?;
        let gather = self.clamped("the number of photons to gather", gather, 0, MOST_PHOTONS.into()) as u32;
        Ok((emit, map, gather, self.number()?))
    }

    /// `EMIT MAP GATHER RADIUS`; as in Sunflow an unknown map is none.
    fn global_photons(&mut self) -> Parsed<Option<GlobalPhotons>> {
        let before = self.peek();
        let (emit, map, gather, radius) = self.photon_map()?;
        let Some(emit) = emit else { return Err(self.expected("the number of photons", before)) };
        let kind = match map.value.as_str() {
            "grid" => PhotonMap::Grid,
            "kd" => PhotonMap::Kd,
            "none" => return Ok(None),
            other => {
                let message = format!("there is no photon map `{}`: there will be none", shorten(other));
                self.diagnostics.push(Diagnostic::warning(map.span, message).hint("expected `grid` or `kd`"));
                return Ok(None);
            }
        };
        Ok(Some(GlobalPhotons { emit, map: kind, gather, radius }))
    }

    /// A direction: three numbers, not all of them zero.
    pub(super) fn direction(&mut self) -> Parsed<[f32; 3]> {
        let direction = self.spanned(Parser::numbers::<f32, 3>)?;
        if direction.value == [0.0; 3] {
            let message = format!("`{}` expects a direction other than `0 0 0`", self.context.name);
            return Err(self.refuse(direction.span, message));
        }
        Ok(direction.value)
    }

    /// Reports a value that was read and makes no sense.
    pub(super) fn refuse(&mut self, span: Span, message: String) -> super::Failed {
        self.failed_at = span.end;
        self.diagnostics.push(Diagnostic::error(span, message));
        super::Failed
    }
}

/// All words of these blocks, for the test of the page on the format.
#[cfg(test)]
pub(super) fn words() -> impl Iterator<Item = &'static str> {
    let engines = ENGINES.iter().flat_map(|engine| engine.keys).map(|key| key.name);
    let photons = PHOTONS.iter().map(|key| key.name).chain(LIGHTSERVER.iter().map(|key| key.name));
    engines.chain(ENGINES.iter().map(|engine| engine.name)).chain(OFF).chain(photons)
}
