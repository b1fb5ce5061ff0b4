//! The options of the scene: picture, depths, indirect light.

use super::super::Parser;
use super::super::gi::{MOST_PHOTONS, MOST_SAMPLES};
use super::super::image::SAMPLERS;
use super::super::statement::FILTERS;
use super::value::Parameters;
use crate::description::{Caustics, Color, Gi, GiKind, GlobalPhotons, PhotonMap};
use crate::source::{Span, Spanned};

/// Sets what the parameters say.
pub(super) fn apply(parser: &mut Parser<'_>, p: &mut Parameters) {
    let span = parser.end_span();
    image(parser, p, span);
    let mut depth = |name: &str| p.whole(name, 0, u32::MAX).map(|depth| Spanned::new(depth, span));
    let depths = [depth("depths.diffuse"), depth("depths.reflection"), depth("depths.refraction")];
    let known = &mut parser.scene.trace_depths;
    known.diffuse = depths[0].or(known.diffuse);
    known.reflection = depths[1].or(known.reflection);
    known.refraction = depths[2].or(known.refraction);
    if let Some(name) = p.string("override.shader") {
        parser.scene.override_shader = (name.value != "none").then_some(name);
    }
    if let Some(photons) = p.bool("override.photons") {
        parser.scene.override_photons = photons;
    }
    if let Some(engine) = p.string("gi.engine") {
        parser.scene.gi = gi(p, &engine.value, span).map(|kind| Gi { kind, span: engine.span });
    }
    if let Some(map) = p.string("caustics") {
        let emit = p.whole("caustics.emit", 0, MOST_PHOTONS).unwrap_or(10_000);
        let gather = p.whole("caustics.gather", 0, MOST_PHOTONS).unwrap_or(50);
        let radius = p.float("caustics.radius").unwrap_or(0.5);
        parser.scene.caustics = (map.value == "kd").then_some(Caustics { emit, gather, radius, span: map.span });
    }
    // The last camera counts here, and no speed depends on these.
    for name in ["camera", "bucket.order", "accel", "gi.path.bounces"] {
        let _ = (p.string(name), p.int(name));
    }
}

fn image(parser: &mut Parser<'_>, p: &mut Parameters, span: Span) {
    let image = &mut parser.scene.image;
    fn at<T>(value: T, span: Span) -> Option<Spanned<T>> {
        Some(Spanned::new(value, span))
    }
    let [width, height] = image.resolution.map_or([640, 480], |size| size.value);
    let (x, y) = (p.whole("resolutionX", 1, 16384), p.whole("resolutionY", 1, 16384));
    if x.is_some() || y.is_some() {
        image.resolution = at([x.unwrap_or(width), y.unwrap_or(height)], span);
    }
    let [least, most] = image.aa.map_or([0, 0], |aa| aa.value);
    let (min, max) = (p.int("aa.min"), p.int("aa.max"));
    if min.is_some() || max.is_some() {
        let least = min.unwrap_or(i64::from(least)).clamp(-4, 5) as i32;
        image.aa = at([least, max.unwrap_or(i64::from(most)).clamp(i64::from(least), 5) as i32], span);
    }
    image.samples = p.whole("aa.samples", 1, 256).and_then(|samples| at(samples, span)).or(image.samples);
    image.contrast = p.float("aa.contrast").and_then(|c| at(c.clamp(0.0, 1.0), span)).or(image.contrast);
    image.jitter = p.bool("aa.jitter").and_then(|jitter| at(jitter, span)).or(image.jitter);
    image.cache = p.bool("aa.cache").and_then(|cache| at(cache, span)).or(image.cache);
    image.bucket = p.whole("bucket.size", 16, 512).and_then(|size| at(size, span)).or(image.bucket);
    let named = |name: &str| FILTERS.iter().find(|(known, _)| *known == name).map(|(_, filter)| *filter);
    image.filter =
        p.string("filter").and_then(|name| at(named(&name.value).unwrap_or_default(), name.span)).or(image.filter);
    let named = |name: &str| SAMPLERS.iter().find(|(known, _)| *known == name).map(|(_, sampler)| *sampler);
    image.sampler = p.string("sampler").and_then(|name| at(named(&name.value)?, name.span)).or(image.sampler);
}

fn gi(p: &mut Parameters, engine: &str, span: Span) -> Option<GiKind> {
    let color = |p: &mut Parameters, name: &str, default: f32| {
        p.color(name).unwrap_or_else(|| Color::new_linear([default; 3], span))
    };
    let mut count = |name: &str, default: u32| p.whole(name, 0, MOST_SAMPLES).unwrap_or(default);
    Some(match engine {
        "path" => GiKind::Path { samples: count("gi.path.samples", 16) },
        "irr-cache" => {
            let samples = count("gi.irr-cache.samples", 256);
            let emit = p.whole("gi.irr-cache.gmap.emit", 0, MOST_PHOTONS).unwrap_or(100_000);
            let gather = p.whole("gi.irr-cache.gmap.gather", 0, MOST_PHOTONS).unwrap_or(50);
            let radius = p.float("gi.irr-cache.gmap.radius").unwrap_or(0.5);
            let map = p.string("gi.irr-cache.gmap").and_then(|map| match map.value.as_str() {
                "grid" => Some(PhotonMap::Grid),
                "kd" => Some(PhotonMap::Kd),
                _ => None,
            });
            let mut number = |name: &str, default: f32| p.float(name).unwrap_or(default);
            GiKind::IrradianceCache {
                samples,
                tolerance: number("gi.irr-cache.tolerance", 0.05),
                spacing: [number("gi.irr-cache.min_spacing", 0.05), number("gi.irr-cache.max_spacing", 5.0)],
                global: map.map(|map| GlobalPhotons { emit, map, gather, radius }),
            }
        }
        "igi" => GiKind::Instant {
            samples: count("gi.igi.samples", 64),
            sets: count("gi.igi.sets", 1).max(1),
            bias_samples: count("gi.igi.bias_samples", 0),
            bias: p.float("gi.igi.c").unwrap_or(0.00003),
        },
        "ambocc" => GiKind::AmbientOcclusion {
            samples: count("gi.ambocc.samples", 32),
            bright: color(p, "gi.ambocc.bright", 1.0),
            dark: color(p, "gi.ambocc.dark", 0.0),
            max_distance: p.float("gi.ambocc.maxdist").unwrap_or(0.0),
        },
        "fake" => GiKind::Fake {
            up: p.point("gi.fake.up").filter(|up| *up != [0.0; 3]).unwrap_or([0.0, 1.0, 0.0]),
            sky: color(p, "gi.fake.sky", 1.0),
            ground: color(p, "gi.fake.ground", 0.0),
        },
        _ => return None,
    })
}
