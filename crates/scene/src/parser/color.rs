//! Reads colours in every colour space of the format (format reference, §1.7).

use super::value::unknown_word;
use super::{Failed, Parsed, Parser};
use crate::description::{Color, ColorSpec, Name};
use crate::diagnostic::Diagnostic;
use crate::lexer::Syntax;
use crate::number;

/// The colour spaces, as messages list them.
const SPACES: [&str; 5] = ["sRGB nonlinear", "sRGB linear", "XYZ", "blackbody", "spectrum 400 700"];

impl Parser<'_> {
    /// `r g b` or `{ SPACE … }`; in an assignment also `#rrggbb`.
    pub(super) fn color(&mut self) -> Parsed<Color> {
        let spec = self.spanned(|parser| match parser.peek() {
            Some(token) if parser.is(token, "{") => parser.color_group(),
            Some(token) if parser.syntax == Syntax::Assignment && token.bytes(&parser.bytes).starts_with(b"#") => {
                parser.hexadecimal()
            }
            Some(token) if number::float::<f32>(token.bytes(&parser.bytes)).is_some() => {
                Ok(ColorSpec::Linear(parser.numbers()?))
            }
            found => Err(parser.expected("a colour", found)),
        })?;
        self.usable(Color { spec: spec.value, span: spec.span })
    }

    /// The colour, if its numbers are finite.
    fn usable(&mut self, color: Color) -> Parsed<Color> {
        if color.linear().iter().all(|value| value.is_finite()) {
            return Ok(color);
        }
        self.failed_at = color.span.end;
        self.diagnostics.push(Diagnostic::error(color.span, "this colour is too bright to be a number"));
        Err(Failed)
    }

    /// Whether a colour can start here.
    pub(super) fn color_follows(&self) -> bool {
        self.number_follows() || self.peek().is_some_and(|token| self.is(token, "{"))
    }

    fn color_group(&mut self) -> Parsed<ColorSpec> {
        self.next();
        let spec = self.color_of_space()?;
        match self.next() {
            Some(token) if self.is(token, "}") => Ok(spec),
            found => Err(self.expected("`}` after the colour", found)),
        }
    }

    /// `SPACE …`, as the generic form of the scene writes it.
    pub(super) fn color_in_space(&mut self) -> Parsed<Color> {
        let spec = self.spanned(Self::color_of_space)?;
        self.usable(Color { spec: spec.value, span: spec.span })
    }

    fn color_of_space(&mut self) -> Parsed<ColorSpec> {
        let space = self.word("a colour space")?;
        Ok(match space.value.as_str() {
            "sRGB nonlinear" => ColorSpec::SrgbNonlinear(self.numbers()?),
            "sRGB linear" => ColorSpec::Linear(self.numbers()?),
            "XYZ" => ColorSpec::Xyz(self.numbers()?),
            "blackbody" => ColorSpec::Blackbody(self.number()?),
            name if name.starts_with("spectrum") => self.spectrum(&space)?,
            _ => return Err(self.unknown_space(&space)),
        })
    }

    fn unknown_space(&mut self, space: &Name) -> Failed {
        self.failed_at = space.span.start;
        let mut diagnostic = unknown_word("colour space", space, SPACES.into_iter());
        if number::float::<f32>(space.value.as_bytes()).is_some() {
            diagnostic.hints = vec!["name the colour space: `{ \"sRGB nonlinear\" 1 0.5 0 }`".to_owned()];
        } else if space.value == "sRGB" {
            diagnostic.hints = vec!["put the name in quotes: `\"sRGB nonlinear\"`".to_owned()];
        }
        self.diagnostics.push(diagnostic);
        Failed
    }

    /// `"spectrum λ0 λ1" N v…`, the name and the range in one word.
    fn spectrum(&mut self, space: &Name) -> Parsed<ColorSpec> {
        let words: Vec<&str> = space.value.split_whitespace().collect();
        let range = match words.as_slice() {
            ["spectrum", first, last] => number::float(first.as_bytes()).zip(number::float(last.as_bytes())),
            _ => None,
        };
        let range = range.filter(|(first, last): &(f32, f32)| first < last && first.is_finite() && last.is_finite());
        let Some((first, last)) = range else {
            self.failed_at = space.span.start;
            let message = "`spectrum` expects its first and last wavelength within the quotes";
            let hint = "for example `{ \"spectrum 400 700\" 3 0.1 0.5 1 }`";
            self.diagnostics.push(Diagnostic::error(space.span, message).hint(hint));
            return Err(Failed);
        };
        let before = self.peek();
        let count = self.int()?;
        if count < 2 {
            return Err(self.expected("at least two samples", before));
        }
        let mut samples = Vec::new();
        for _ in 0..count {
            samples.push(self.number()?);
        }
        Ok(ColorSpec::Spectrum { range: [first, last], samples })
    }

    fn hexadecimal(&mut self) -> Parsed<ColorSpec> {
        let found = self.next();
        let text = found.map(|token| self.text(token)).unwrap_or_default();
        let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6 && digits.is_ascii());
        let Some(rgb) = digits.and_then(|digits| u32::from_str_radix(digits, 16).ok()) else {
            return Err(self.expected("a colour like `#ff8000`", found));
        };
        let channel = |shift: u32| (rgb >> shift & 0xff) as f32 / 255.0;
        Ok(ColorSpec::SrgbNonlinear([channel(16), channel(8), channel(0)]))
    }
}
