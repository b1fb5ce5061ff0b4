//! Reads the blocks `image`, `background` and `trace-depths`.

use std::fmt::Display;

use super::block::{Grammar, Key};
use super::{Parsed, Parser};
use crate::description::{Background, Color, Sampler};
use crate::diagnostic::Diagnostic;
use crate::lexer::Token;
use crate::source::{Span, Spanned};

/// Values of the `image` block go straight into the scene, where later blocks win.
const IMAGE: &[Key<()>] = &[
    Key::new("resolution", "resolution 640 480", |p, (), _| {
        let [width, height] = p.two_ints()?;
        let size = [p.clamped("width", width, 1, 16384), p.clamped("height", height, 1, 16384)];
        p.scene.image.resolution = Some(Spanned::new(size.map(|side| side as u32), width.span.to(height.span)));
        Ok(())
    }),
    Key::new("aa", "aa 0 2", |p, (), _| {
        let [min, max] = p.two_ints()?;
        let least = p.clamped("the first number of `aa`", min, -4, 5);
        let most = p.clamped("the second number of `aa`", max, least, 5);
        p.scene.image.aa = Some(Spanned::new([least as i32, most as i32], min.span.to(max.span)));
        Ok(())
    }),
    Key::new("samples", "samples 4", |p, (), _| {
        let samples = p.spanned(Parser::int)?;
        let value = p.clamped("`samples`", samples, 1, 256) as u32;
        p.scene.image.samples = Some(Spanned::new(value, samples.span));
        Ok(())
    }),
    Key::new("contrast", "contrast 0.1", |p, (), _| {
        let contrast = p.spanned(Parser::number::<f32>)?;
        let value = p.clamped("`contrast`", contrast, 0.0, 1.0);
        p.scene.image.contrast = Some(Spanned::new(value, contrast.span));
        Ok(())
    }),
    Key::new("filter", "filter mitchell", |p, (), _| p.filter()),
    Key::new("jitter", "jitter true", |p, (), _| {
        p.scene.image.jitter = Some(p.boolean()?);
        Ok(())
    }),
    Key::new("sampler", "sampler bucket", |p, (), _| {
        p.scene.image.sampler = Some(p.choice("a sampler", SAMPLERS)?);
        Ok(())
    }),
    Key::new("cache", "cache false", |p, (), _| {
        p.scene.image.cache = Some(p.boolean()?);
        Ok(())
    }),
    // Sunflow: read and without effect.
    Key::new("show-aa", "show-aa false", |p, (), _| p.boolean().map(drop)),
    Key::new("output", "output picture.png", |p, (), _| p.word("a file name").map(drop)),
];

/// Samplers by their names in the format.
pub(crate) const SAMPLERS: &[(&str, Sampler)] =
    &[("bucket", Sampler::Bucket), ("ipr", Sampler::Fast), ("fast", Sampler::Fast), ("multipass", Sampler::Multipass)];

pub(super) fn image(parser: &mut Parser<'_>, head: Token) -> Parsed<()> {
    parser.open("image")?;
    parser.block(head, &Grammar { what: "image", keys: IMAGE, bare: None }, &mut ());
    Ok(())
}

const BACKGROUND: &[Key<Option<Color>>] = &[Key::new("color", "color 0.1 0.2 0.3", |p, color, _| {
    *color = Some(p.color()?);
    Ok(())
})];

pub(super) fn background(parser: &mut Parser<'_>, head: Token) -> Parsed<()> {
    parser.open("background")?;
    let mut color = None;
    let outcome = parser.block(head, &Grammar { what: "background", keys: BACKGROUND, bare: None }, &mut color);
    let place = parser.span(head);
    parser.require("background", &outcome, place, &[(&["color"], "color 0.1 0.2 0.3")]);
    match (&parser.scene.background, color) {
        (Some(first), Some(_)) => {
            let first = first.span;
            let diagnostic = Diagnostic::warning(place, "skipped: the scene has a background already");
            parser.diagnostics.push(diagnostic.label(first, "this one counts"));
        }
        (None, Some(color)) => parser.scene.background = Some(Background { color, span: outcome.span }),
        (_, None) => {}
    }
    Ok(())
}

const TRACE_DEPTHS: &[Key<()>] = &[
    Key::new("diff", "diff 1", |p, (), span| {
        p.scene.trace_depths.diffuse = Some(p.depth(span)?);
        Ok(())
    }),
    Key::new("refl", "refl 4", |p, (), span| {
        p.scene.trace_depths.reflection = Some(p.depth(span)?);
        Ok(())
    }),
    Key::new("refr", "refr 4", |p, (), span| {
        p.scene.trace_depths.refraction = Some(p.depth(span)?);
        Ok(())
    }),
];

pub(super) fn trace_depths(parser: &mut Parser<'_>, head: Token) -> Parsed<()> {
    parser.open("trace-depths")?;
    parser.block(head, &Grammar { what: "trace-depths", keys: TRACE_DEPTHS, bare: None }, &mut ());
    Ok(())
}

impl Parser<'_> {
    fn two_ints(&mut self) -> Parsed<[Spanned<i64>; 2]> {
        Ok([self.spanned(Parser::int)?, self.spanned(Parser::int)?])
    }

    /// A number of bounces; as in Sunflow a negative one is 0.
    fn depth(&mut self, key: Span) -> Parsed<Spanned<u32>> {
        let depth = self.spanned(Parser::int)?;
        let value = depth.value.clamp(0, i64::from(u32::MAX)) as u32;
        Ok(Spanned::new(value, key.to(depth.span)))
    }

    /// As in Sunflow, brought into its range, with a warning.
    pub(super) fn clamped<T: PartialOrd + Copy + Display>(
        &mut self,
        what: &str,
        value: Spanned<T>,
        min: T,
        max: T,
    ) -> T {
        let nearest = match value.value {
            low if low < min => min,
            high if high > max => max,
            _ => return value.value,
        };
        let message = format!("{what} is {}, and {nearest} is used: it must be from {min} to {max}", value.value);
        self.diagnostics.push(Diagnostic::warning(value.span, message));
        nearest
    }
}

/// All words of these blocks, for the test of the page on the format.
#[cfg(test)]
pub(super) fn words() -> impl Iterator<Item = &'static str> {
    let keys = IMAGE.iter().chain(TRACE_DEPTHS).map(|key| key.name);
    keys.chain(BACKGROUND.iter().map(|key| key.name)).chain(SAMPLERS.iter().map(|(name, _)| *name))
}
