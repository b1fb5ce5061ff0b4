//! Words, numbers, colours, transforms, and the blocks that they stand in.

use std::fmt::{Debug, Write as _};
use std::io::{self, Write};

use crate::description::{Color, ColorSpec, Op, Transform, TransformKind};

/// Blocks up to this long stand on one line.
const LINE: usize = 100;

/// A block on its way into the file: its entries stand on one line where they fit.
pub(super) struct Block {
    keyword: &'static str,
    entries: Vec<String>,
    is_open: bool,
}

impl Block {
    pub fn new(keyword: &'static str) -> Self {
        Block { keyword, entries: Vec::new(), is_open: false }
    }

    /// Adds a keyword and its value.
    pub fn entry(mut self, keyword: &str, value: impl AsRef<str>) -> Self {
        let value = value.as_ref();
        self.entries.push(if value.is_empty() { keyword.to_owned() } else { format!("{keyword} {value}") });
        self
    }

    /// Adds a keyword and its value, if there is one.
    pub fn option(self, keyword: &str, value: Option<impl AsRef<str>>) -> Self {
        match value {
            Some(value) => self.entry(keyword, value),
            None => self,
        }
    }

    /// Writes what there is so far, so that long lists can follow.
    fn open(&mut self, out: &mut dyn Write) -> io::Result<()> {
        if !self.is_open {
            writeln!(out, "{} {{", self.keyword)?;
            self.is_open = true;
        }
        self.entries.drain(..).try_for_each(|entry| writeln!(out, "   {entry}"))
    }

    /// A keyword and a list that may be long: one row to a line.
    pub fn rows<T: Copy + Number, const N: usize>(
        &mut self,
        heading: &str,
        rows: &[[T; N]],
        out: &mut dyn Write,
    ) -> io::Result<()> {
        self.open(out)?;
        writeln!(out, "   {heading}")?;
        rows.iter().try_for_each(|row| writeln!(out, "      {}", numbers(row)))
    }

    /// Writes the rest and the closing brace.
    pub fn close(mut self, out: &mut dyn Write) -> io::Result<()> {
        let length: usize = self.entries.iter().map(|entry| entry.chars().count() + 1).sum();
        if !self.is_open && length + self.keyword.len() + 4 <= LINE {
            let entries = self.entries.join(" ");
            return writeln!(out, "{} {{ {entries}{}}}", self.keyword, if entries.is_empty() { "" } else { " " });
        }
        self.open(out)?;
        writeln!(out, "}}")
    }
}

/// A number that is written in the fewest digits from which it is read again.
pub(super) trait Number: Debug {}

impl Number for f32 {}
impl Number for f64 {}
impl Number for u32 {}
impl Number for i32 {}
impl Number for i64 {}

pub(super) fn number(value: impl Number) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map(str::to_owned).unwrap_or(text)
}

pub(super) fn numbers<T: Copy + Number>(values: &[T]) -> String {
    let words: Vec<String> = values.iter().map(|value| number(*value)).collect();
    words.join(" ")
}

/// A word, in quotes where it needs them.
pub(super) fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_./:|+".contains(c);
    if word.chars().all(is_plain) { word.to_owned() } else { format!("\"{word}\"") }
}

pub(super) fn color(color: &Color) -> String {
    match &color.spec {
        ColorSpec::Linear(rgb) => numbers(rgb),
        ColorSpec::SrgbNonlinear(rgb) => format!("{{ \"sRGB nonlinear\" {} }}", numbers(rgb)),
        ColorSpec::Xyz(xyz) => format!("{{ \"XYZ\" {} }}", numbers(xyz)),
        ColorSpec::Blackbody(kelvin) => format!("{{ \"blackbody\" {} }}", number(*kelvin)),
        ColorSpec::Spectrum { range, samples } => {
            format!("{{ \"spectrum {}\" {} {} }}", numbers(range), samples.len(), numbers(samples))
        }
    }
}

pub(super) fn transform(transform: &Transform) -> String {
    match &transform.kind {
        TransformKind::Steps { times, steps } => steps_of(*times, steps.iter().map(still), "\n      "),
        kind => still(kind),
    }
}

/// `steps N times t0 t1` and the steps, each after `separator`.
pub(super) fn steps_of(times: [f32; 2], steps: impl ExactSizeIterator<Item = String>, separator: &str) -> String {
    let mut text = format!("steps {} times {}", steps.len(), numbers(&times));
    for step in steps {
        let _ = write!(text, "{separator}{step}");
    }
    text
}

/// A transform that does not move.
pub(super) fn still(kind: &TransformKind) -> String {
    match kind {
        TransformKind::Ops(ops) if ops.is_empty() => "{ }".to_owned(),
        TransformKind::Ops(ops) => {
            let words: Vec<String> = ops.iter().map(operation).collect();
            format!("{{ {} }}", words.join(" "))
        }
        TransformKind::Matrix(rows) => {
            let rows: Vec<String> = rows.iter().map(|row| numbers(row)).collect();
            format!("row {}", rows.join("  "))
        }
        // Steps do not hold steps.
        TransformKind::Steps { steps, .. } => steps.first().map_or_else(|| "{ }".to_owned(), still),
    }
}

fn operation(op: &Op) -> String {
    match *op {
        Op::Translate(offset) => format!("translate {}", numbers(&offset)),
        Op::Scale(factors) => format!("scale {}", numbers(&factors)),
        // Sunflow knows no scale along one axis.
        Op::ScaleX(factor) => format!("scale {} 1 1", number(factor)),
        Op::ScaleY(factor) => format!("scale 1 {} 1", number(factor)),
        Op::ScaleZ(factor) => format!("scale 1 1 {}", number(factor)),
        Op::ScaleU(factor) => format!("scaleu {}", number(factor)),
        Op::RotateX(angle) => format!("rotatex {}", number(angle)),
        Op::RotateY(angle) => format!("rotatey {}", number(angle)),
        Op::RotateZ(angle) => format!("rotatez {}", number(angle)),
        Op::Rotate { axis, angle } => format!("rotate {} {}", numbers(&axis), number(angle)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_exact() {
        for (value, text) in [(1.0f32, "1"), (-0.5, "-0.5"), (0.1, "0.1"), (1e-7, "1e-7"), (1.5e20, "1.5e20")] {
            assert_eq!(number(value), text);
        }
        for bits in (0..u32::MAX).step_by(100_003) {
            let value = f32::from_bits(bits);
            if value.is_finite() {
                let read = crate::number::float::<f32>(number(value).as_bytes()).expect("a number");
                assert_eq!(read.to_bits(), value.to_bits(), "{value:?}");
            }
        }
    }

    #[test]
    fn words_with_blanks_are_quoted() {
        assert_eq!(quoted("Sphere.001"), "Sphere.001");
        assert_eq!(quoted("a b"), "\"a b\"");
        assert_eq!(quoted("a{"), "\"a{\"");
    }
}
