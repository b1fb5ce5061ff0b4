//! The binary form, `.scb`: everything little-endian, words with their length before them.

use std::sync::Arc;

use super::super::Parser;
use super::value::{Interpolation, Value, affine};
use super::{Generic, Kind};
use crate::description::{Color, ColorSpec, Name};
use crate::diagnostic::Diagnostic;
use crate::source::{Span, Spanned};

/// A cursor in the bytes of the file.
struct Reader {
    bytes: Arc<[u8]>,
    at: usize,
    file: u32,
}

/// The bytes do not follow the format from here on; what follows cannot be found.
struct Broken;

type Read<T> = Result<T, Broken>;

pub(super) fn statements(parser: &mut Parser<'_>) -> usize {
    let mut reader = Reader { bytes: parser.bytes.clone(), at: 0, file: parser.file };
    let mut generic = Generic::default();
    let mut count = 0;
    while reader.at < reader.bytes.len() {
        let start = reader.at;
        if one(parser, &mut generic, &mut reader).is_err() {
            let message = format!("the file cannot be read any further than byte {start}");
            let hint = "it is cut, or no `.scb` file";
            parser.diagnostics.push(Diagnostic::error(reader.since(start), message).hint(hint));
            break;
        }
        count += 1;
    }
    // The words of the file are not looked at again.
    parser.lexer = crate::lexer::Lexer::at(reader.bytes.len(), parser.syntax);
    count
}

fn one(parser: &mut Parser<'_>, generic: &mut Generic, reader: &mut Reader) -> Read<()> {
    let start = reader.at;
    let kind = match reader.byte()? {
        b'p' => {
            let name = reader.name()?;
            let value = reader.value()?;
            generic.parameters.push(name, value);
            return Ok(());
        }
        b'x' => return extended(parser, reader, start),
        b'o' => {
            let name = reader.name()?;
            generic.declare(parser, Kind::Options, name, None, reader.since(start));
            return Ok(());
        }
        b'g' => Kind::Geometry,
        b'i' => Kind::Instance,
        b's' => Kind::Shader,
        b'm' => Kind::Modifier,
        b'l' => Kind::Light,
        b'c' => Kind::Camera,
        _ => return Err(Broken),
    };
    let (name, class) = (reader.name()?, reader.name()?);
    generic.declare(parser, kind, name, Some(class), reader.since(start));
    Ok(())
}

fn extended(parser: &mut Parser<'_>, reader: &mut Reader, start: usize) -> Read<()> {
    let kind = reader.byte()?;
    match kind {
        b'i' => {
            let name = reader.name()?;
            parser.generic_include(name, reader.since(start));
            return Ok(());
        }
        b's' => {
            let (kind, folder) = (reader.name()?, reader.name()?);
            parser.search_path(&kind.value, folder);
            return Ok(());
        }
        b'f' => return reader.int().map(drop),
        b'R' => {}
        b'r' => drop(reader.name()?),
        b'p' => drop([reader.name()?, reader.name()?, reader.name()?]),
        _ => return Err(Broken),
    }
    let what = match kind {
        b'R' => "`reset`",
        b'r' => "the removal of something",
        _ => "a plugin, which is written in Java,",
    };
    parser.diagnostics.push(Diagnostic::warning(reader.since(start), format!("skipped: {what} is not supported")));
    Ok(())
}

impl Reader {
    fn since(&self, start: usize) -> Span {
        Span { file: self.file, start: start as u32, end: self.at.min(self.bytes.len()) as u32 }
    }

    fn take(&mut self, count: usize) -> Read<&[u8]> {
        let end = self.at.checked_add(count).ok_or(Broken)?;
        let found = self.bytes.get(self.at..end).ok_or(Broken)?;
        self.at = end;
        Ok(found)
    }

    fn byte(&mut self) -> Read<u8> {
        Ok(self.take(1)?[0])
    }

    fn four(&mut self) -> Read<[u8; 4]> {
        self.take(4)?.try_into().map_err(|_| Broken)
    }

    fn int(&mut self) -> Read<i32> {
        self.four().map(i32::from_le_bytes)
    }

    /// A length, of something that takes `size` bytes at least.
    fn count(&mut self, size: usize) -> Read<usize> {
        let count = usize::try_from(self.int()?).map_err(|_| Broken)?;
        let fits = count.checked_mul(size).is_some_and(|bytes| bytes <= self.bytes.len() - self.at);
        if fits { Ok(count) } else { Err(Broken) }
    }

    /// A finite number.
    fn float(&mut self) -> Read<f32> {
        let value = f32::from_le_bytes(self.four()?);
        if value.is_finite() { Ok(value) } else { Err(Broken) }
    }

    fn floats<const N: usize>(&mut self) -> Read<[f32; N]> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = self.float()?;
        }
        Ok(values)
    }

    fn name(&mut self) -> Read<Name> {
        let start = self.at;
        let count = self.count(1)?;
        let text = String::from_utf8_lossy(self.take(count)?).into_owned();
        Ok(Spanned::new(text, self.since(start)))
    }

    fn tuples<const N: usize>(&mut self) -> Read<Vec<[f32; N]>> {
        let count = self.count(4 * N)?;
        (0..count).map(|_| self.floats()).collect()
    }

    fn interpolation(&mut self) -> Read<Interpolation> {
        Ok(match self.byte()? {
            b'n' => Interpolation::None,
            b'v' => Interpolation::Vertex,
            b'f' => Interpolation::FaceVarying,
            b'p' => Interpolation::Face,
            _ => return Err(Broken),
        })
    }

    /// `t`, the type, whether it is a list, and the data.
    fn value(&mut self) -> Read<Value> {
        if self.byte()? != b't' {
            return Err(Broken);
        }
        let start = self.at;
        let kind = self.byte()?;
        if self.byte()? != 0 {
            return self.list(kind);
        }
        Ok(match kind {
            b's' => Value::String(self.name()?),
            b'b' => Value::Bool(self.byte()? != 0),
            b'i' => Value::Int(i64::from(self.int()?)),
            b'f' => Value::Float(self.float()?),
            b'c' => {
                let spec = ColorSpec::Linear(self.floats()?);
                Value::Color(Color { spec, span: self.since(start) })
            }
            b'p' | b'v' => Value::Point(self.floats()?),
            // Nothing takes a single one.
            b't' => Value::TexCoords(Interpolation::None, vec![self.floats()?]),
            b'm' => Value::Matrix(affine(self.floats()?).ok_or(Broken)?),
            _ => return Err(Broken),
        })
    }

    fn list(&mut self, kind: u8) -> Read<Value> {
        Ok(match kind {
            b's' => {
                let count = self.count(4)?;
                Value::Strings((0..count).map(|_| self.name()).collect::<Read<_>>()?)
            }
            b'i' => {
                let count = self.count(4)?;
                Value::Ints((0..count).map(|_| self.int().map(i64::from)).collect::<Read<_>>()?)
            }
            b'f' => {
                self.interpolation()?;
                Value::Floats(self.tuples::<1>()?.into_iter().flatten().collect())
            }
            b'p' | b'v' => Value::Points(self.interpolation()?, self.tuples()?),
            b't' => Value::TexCoords(self.interpolation()?, self.tuples()?),
            _ => return Err(Broken),
        })
    }
}
