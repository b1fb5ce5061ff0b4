//! The blocks that say how the picture is made: dialect, image, camera, indirect light.

use std::io::{self, Write};

use super::text::{Block, color, number, numbers, quoted, steps_of, still, transform};
use crate::description::{Camera, Dialect, GiKind, Image, Lens, PhotonMap, Scene, TraceDepths, TransformKind, View};
use crate::parser::{FILTERS, SAMPLERS};
use crate::source::Span;

/// The first word that means `value`.
fn word<T: PartialEq>(words: &[(&'static str, T)], value: T) -> &'static str {
    words.iter().find(|(_, known)| *known == value).map_or("", |(word, _)| word)
}

pub(super) fn dialect(scene: &Scene, out: &mut dyn Write) -> io::Result<()> {
    match scene.dialect.map(|dialect| dialect.value) {
        Some(Dialect::Report) => writeln!(out, "dialect report"),
        Some(Dialect::Sunflow) => writeln!(out, "dialect sunflow"),
        None => Ok(()),
    }
}

/// The parts of the block whose places pass.
pub(super) fn own_image(image: &Image, own: impl Fn(Span) -> bool) -> Image {
    Image {
        resolution: image.resolution.filter(|value| own(value.span)),
        aa: image.aa.filter(|value| own(value.span)),
        samples: image.samples.filter(|value| own(value.span)),
        contrast: image.contrast.filter(|value| own(value.span)),
        filter: image.filter.filter(|value| own(value.span)),
        jitter: image.jitter.filter(|value| own(value.span)),
        sampler: image.sampler.filter(|value| own(value.span)),
        cache: image.cache.filter(|value| own(value.span)),
        bucket: image.bucket.filter(|value| own(value.span)),
    }
}

/// The parts of the block whose places pass.
pub(super) fn own_depths(depths: &TraceDepths, own: impl Fn(Span) -> bool) -> TraceDepths {
    TraceDepths {
        diffuse: depths.diffuse.filter(|depth| own(depth.span)),
        reflection: depths.reflection.filter(|depth| own(depth.span)),
        refraction: depths.refraction.filter(|depth| own(depth.span)),
    }
}

/// Where the parts of the block were written.
pub(super) fn image_places(image: &Image) -> Vec<Option<Span>> {
    vec![
        image.resolution.map(|value| value.span),
        image.sampler.map(|value| value.span),
        image.aa.map(|value| value.span),
        image.samples.map(|value| value.span),
        image.contrast.map(|value| value.span),
        image.filter.map(|value| value.span),
        image.jitter.map(|value| value.span),
        image.cache.map(|value| value.span),
    ]
}

pub(super) fn image(image: &Image, out: &mut dyn Write) -> io::Result<()> {
    Block::new("image")
        .option("resolution", image.resolution.map(|size| numbers(&size.value)))
        .option("sampler", image.sampler.map(|sampler| word(SAMPLERS, sampler.value)))
        .option("aa", image.aa.map(|aa| numbers(&aa.value)))
        .option("samples", image.samples.map(|samples| number(samples.value)))
        .option("contrast", image.contrast.map(|contrast| number(contrast.value)))
        .option("filter", image.filter.map(|filter| word(FILTERS, filter.value)))
        .option("jitter", image.jitter.map(|jitter| jitter.value.to_string()))
        .option("cache", image.cache.map(|cache| cache.value.to_string()))
        .close(out)
}

pub(super) fn bucket(image: &Image, out: &mut dyn Write) -> io::Result<()> {
    image.bucket.map_or(Ok(()), |size| writeln!(out, "bucket {} hilbert", size.value))
}

pub(super) fn background(scene: &Scene, out: &mut dyn Write) -> io::Result<()> {
    let block = Block::new("background");
    block.option("color", scene.background.as_ref().map(|background| color(&background.color))).close(out)
}

pub(super) fn depth_places(depths: &TraceDepths) -> Vec<Option<Span>> {
    [depths.diffuse, depths.reflection, depths.refraction].map(|depth| depth.map(|depth| depth.span)).to_vec()
}

pub(super) fn trace_depths(depths: &TraceDepths, out: &mut dyn Write) -> io::Result<()> {
    Block::new("trace-depths")
        .option("diff", depths.diffuse.map(|depth| number(depth.value)))
        .option("refl", depths.reflection.map(|depth| number(depth.value)))
        .option("refr", depths.refraction.map(|depth| number(depth.value)))
        .close(out)
}

pub(super) fn override_shader(scene: &Scene, out: &mut dyn Write) -> io::Result<()> {
    let Some(name) = &scene.override_shader else { return Ok(()) };
    writeln!(out, "override {} {}", quoted(&name.value), scene.override_photons)
}

pub(super) fn gi(scene: &Scene, out: &mut dyn Write) -> io::Result<()> {
    let Some(gi) = &scene.gi else { return Ok(()) };
    let block = Block::new("gi").entry("type", gi.kind.keyword());
    match &gi.kind {
        GiKind::Path { samples } => block.entry("samples", number(*samples)),
        GiKind::IrradianceCache { samples, tolerance, spacing, global } => {
            let global = global.map(|global| {
                let map = match global.map {
                    PhotonMap::Grid => "grid",
                    PhotonMap::Kd => "kd",
                };
                format!("{} {map} {} {}", global.emit, global.gather, number(global.radius))
            });
            let block = block.entry("samples", number(*samples)).entry("tolerance", number(*tolerance));
            block.entry("spacing", numbers(spacing)).option("global", global)
        }
        GiKind::Instant { samples, sets, bias, bias_samples } => block
            .entry("samples", number(*samples))
            .entry("sets", number(*sets))
            .entry("b", number(*bias))
            .entry("bias-samples", number(*bias_samples)),
        GiKind::AmbientOcclusion { bright, dark, samples, max_distance } => block
            .entry("bright", color(bright))
            .entry("dark", color(dark))
            .entry("samples", number(*samples))
            .entry("maxdist", number(*max_distance)),
        GiKind::Fake { up, sky, ground } => {
            block.entry("up", numbers(up)).entry("sky", color(sky)).entry("ground", color(ground))
        }
    }
    .close(out)
}

pub(super) fn photons(scene: &Scene, out: &mut dyn Write) -> io::Result<()> {
    let Some(caustics) = &scene.caustics else { return Ok(()) };
    let value = format!("{} kd {} {}", caustics.emit, caustics.gather, number(caustics.radius));
    Block::new("photons").entry("caustics", value).close(out)
}

pub(super) fn camera(camera: &Camera, out: &mut dyn Write) -> io::Result<()> {
    let keyword = match camera.lens {
        Lens::Pinhole { .. } => "pinhole",
        Lens::Thinlens { .. } => "thinlens",
        Lens::Spherical => "spherical",
        Lens::Fisheye => "fisheye",
    };
    let block = Block::new("camera").entry("type", keyword);
    let block = block.option("shutter", camera.shutter.map(|shutter| numbers(&shutter.value)));
    let block = match &camera.view {
        View::LookAt { eye, target, up } => {
            block.entry("eye", numbers(eye)).entry("target", numbers(target)).entry("up", numbers(up))
        }
        View::Transform(moving) => match &moving.kind {
            TransformKind::Steps { times, steps } => {
                block.entry(&steps_of(*times, steps.iter().map(still), "\n      transform "), "")
            }
            _ => block.entry("transform", transform(moving)),
        },
    };
    match camera.lens {
        Lens::Pinhole { fov, aspect, shift } => view_angle(block, fov, aspect, shift),
        Lens::Thinlens { fov, aspect, shift, fdist, lensr, sides, rotation } => {
            let block = view_angle(block, fov, aspect, shift);
            let block = block.entry("fdist", number(fdist)).entry("lensr", number(lensr));
            let block = block.option("sides", (sides != 0).then(|| number(sides)));
            block.option("rotation", (rotation != 0.0).then(|| number(rotation)))
        }
        Lens::Spherical | Lens::Fisheye => block,
    }
    .close(out)
}

fn view_angle(block: Block, fov: f32, aspect: f32, shift: [f32; 2]) -> Block {
    let block = block.entry("fov", number(fov)).entry("aspect", number(aspect));
    block.option("shift", (shift != [0.0; 2]).then(|| numbers(&shift)))
}
