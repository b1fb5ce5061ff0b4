//! Values that several commands take, and how they are read from words.

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use jaspe_render::Look;
use jaspe_scene::Dialect;

/// Longest side of a picture, as in the scene format.
pub const MAX_SIDE: u32 = 16_384;

/// How results are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum OutputFormat {
    /// For people.
    Text,
    /// For programs.
    Json,
}

/// Whose meaning a scene's words have.
pub fn dialect() -> impl TypedValueParser<Value = Dialect> {
    let words = Dialect::ALL.iter().map(|dialect| {
        PossibleValue::new(dialect.name()).help(match dialect {
            Dialect::Sunflow => "Sunflow's: inverse-square lights, linear light",
            Dialect::Report => "That of the 2010 program: its camera, lights, mirrors and display colours",
        })
    });
    PossibleValuesParser::new(words).map(|name| Dialect::from_name(&name).expect("the parser accepts dialects only"))
}

/// Quick looks.
pub fn look() -> impl TypedValueParser<Value = Look> {
    let words = Look::ALL.iter().map(|look| {
        PossibleValue::new(look.name()).help(match look {
            Look::Normals => "Directions of the surfaces as colours",
            Look::Uvs => "Texture coordinates as red and green",
            Look::Ids => "A colour per object",
            Look::AmbientOcclusion => "Ambient occlusion",
            Look::Gray => "Matte grey under the scene's lights",
        })
    });
    PossibleValuesParser::new(words).map(|name| Look::from_name(&name).expect("the parser accepts looks only"))
}

/// `WIDTHxHEIGHT` in pixels.
pub fn size(text: &str) -> Result<[u32; 2], String> {
    let expected = || "expected WIDTHxHEIGHT in pixels, such as 640x480".to_owned();
    let (width, height) = text.split_once(['x', 'X', '×']).ok_or_else(expected)?;
    let side = |text: &str| text.trim().parse::<u32>().map_err(|_| expected());
    let size = [side(width)?, side(height)?];
    match size.iter().find(|side| !(1..=MAX_SIDE).contains(*side)) {
        Some(side) => Err(format!("a side of {side} pixels; each side is from 1 to {MAX_SIDE}")),
        None => Ok(size),
    }
}

/// `X0,Y0,X1,Y1` in pixels.
pub fn crop(text: &str) -> Result<[u32; 4], String> {
    let expected = || "expected X0,Y0,X1,Y1 in pixels from the top left, such as 0,0,320,240".to_owned();
    let numbers: Vec<u32> =
        text.split(',').map(|n| n.trim().parse().map_err(|_| expected())).collect::<Result<_, _>>()?;
    let [x0, y0, x1, y1] = numbers.try_into().map_err(|_| expected())?;
    if x0 < x1 && y0 < y1 {
        Ok([x0, y0, x1, y1])
    } else {
        Err("holds no pixel: X1 must be larger than X0, and Y1 than Y0".to_owned())
    }
}

/// `PX,PY,PZ`, or `P` for all axes; 0 leaves an axis alone.
pub fn period(text: &str) -> Result<[u32; 3], String> {
    let expected =
        || "expected PX,PY,PZ in whole units, such as 4,4,4; 0 stands for an axis that does not repeat".to_owned();
    let numbers: Vec<u32> =
        text.split(',').map(|n| n.trim().parse().map_err(|_| expected())).collect::<Result<_, _>>()?;
    match numbers[..] {
        [all] => Ok([all; 3]),
        [x, y] => Ok([x, y, 0]),
        [x, y, z] => Ok([x, y, z]),
        _ => Err(expected()),
    }
}

/// `KEY=VALUE`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Assignment {
    /// Before the first `=`.
    pub key: String,
    /// After it.
    pub value: String,
}

impl std::fmt::Display for Assignment {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}={}", self.key, self.value)
    }
}

/// `KEY=VALUE`.
pub fn assignment(text: &str) -> Result<Assignment, String> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() && !value.trim().is_empty() => {
            Ok(Assignment { key: key.trim().to_owned(), value: value.trim().to_owned() })
        }
        _ => Err("expected KEY=VALUE, such as depth=5".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_or_explained() {
        assert_eq!(size("640x480"), Ok([640, 480]));
        assert_eq!(size("1X16384"), Ok([1, 16384]));
        assert!(size("0x5").is_err_and(|message| message.contains("from 1 to 16384")));
        for wrong in ["640", "640x", "x480", "640x480x3", "-1x5", "1e3x5", ""] {
            assert!(size(wrong).is_err_and(|message| message.contains("such as 640x480")), "{wrong}");
        }
    }

    #[test]
    fn crops_hold_pixels() {
        assert_eq!(crop("0,0,320, 240"), Ok([0, 0, 320, 240]));
        assert!(crop("5,0,5,9").is_err_and(|message| message.contains("no pixel")));
        assert!(crop("1,2,3").is_err_and(|message| message.contains("X0,Y0,X1,Y1")));
    }

    #[test]
    fn assignments_split_at_the_first_sign() {
        let read = assignment("wood.sum=a=b").map(|read| (read.key, read.value));
        assert_eq!(read, Ok(("wood.sum".to_owned(), "a=b".to_owned())));
        assert!(assignment("depth").is_err() && assignment("=5").is_err() && assignment("depth=").is_err());
    }
}
