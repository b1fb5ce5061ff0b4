//! The state of a rendering that was stopped, as bytes from which it goes on.
//!
//! ```text
//! magic · version of the program · origin · state · CRC-32 of all that
//! ```
//!
//! Texts have their length in front; everything is in little-endian words of 32 bits but the texts. The state is what
//! `passes.rs` makes of it: every count in it follows from the scene, so that a file decides nothing about memory.

use std::fmt;

/// The state of a rendering between two waves: see [`crate::Observer::checkpoint`] and [`crate::resume`].
///
/// It holds what has been summed up so far, some 20 to 44 bytes for each pixel that is begun. It belongs to one scene with one
/// set of options, and to one version of this program, since another might trace other rays. The default is no state at
/// all, and fits no rendering.
#[derive(Clone, Default, PartialEq, Eq)]
pub struct Checkpoint {
    state: Vec<u8>,
}

/// Why bytes are no checkpoint that a rendering can go on from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CheckpointError {
    /// They are something else.
    Foreign,
    /// They were written by this other version of the program.
    Version(String),
    /// They are cut off or altered.
    Damaged,
    /// They belong to another rendering: this is the text it was saved with.
    Origin(String),
}

impl fmt::Display for CheckpointError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CheckpointError::Foreign => f.write_str("is no checkpoint"),
            CheckpointError::Version(theirs) => {
                write!(f, "was written by version {theirs}, but this is version {VERSION}")
            }
            CheckpointError::Damaged => f.write_str("is cut off or damaged"),
            CheckpointError::Origin(_) => f.write_str("belongs to another rendering"),
        }
    }
}

impl std::error::Error for CheckpointError {}

/// A name, and signs that a transfer as text would spoil.
const MAGIC: &[u8; 8] = b"\x89Jaspe\r\n";
const VERSION: &str = env!("CARGO_PKG_VERSION");

impl Checkpoint {
    /// The bytes to keep. `origin` is whatever the caller wants to recognise the rendering by, such as its files and options.
    pub fn to_bytes(&self, origin: &str) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        for text in [VERSION, origin] {
            bytes.extend((text.len() as u32).to_le_bytes());
            bytes.extend(text.as_bytes());
        }
        bytes.extend(&self.state);
        bytes.extend(crc32fast::hash(&bytes).to_le_bytes());
        bytes
    }

    /// The checkpoint that was saved as these bytes, with the same `origin`.
    ///
    /// # Errors
    /// [`CheckpointError`] says what the bytes are instead.
    pub fn from_bytes(bytes: &[u8], origin: &str) -> Result<Checkpoint, CheckpointError> {
        let rest = bytes.strip_prefix(MAGIC).ok_or(CheckpointError::Foreign)?;
        let (version, rest) = split_text(rest)?;
        if version.len() > 32 || version.chars().any(|c| !c.is_ascii_graphic()) {
            return Err(CheckpointError::Damaged);
        }
        if version != VERSION {
            return Err(CheckpointError::Version(version));
        }
        let (sealed, seal) = bytes
            .split_last_chunk::<4>()
            .map(|(sealed, seal)| (sealed, u32::from_le_bytes(*seal)))
            .ok_or(CheckpointError::Damaged)?;
        if crc32fast::hash(sealed) != seal {
            return Err(CheckpointError::Damaged);
        }
        let (theirs, rest) = split_text(rest)?;
        if theirs != origin {
            return Err(CheckpointError::Origin(theirs));
        }
        let state = rest.strip_suffix(&seal.to_le_bytes()).ok_or(CheckpointError::Damaged)?;
        Ok(Checkpoint { state: state.to_vec() })
    }

    /// Writes a state down.
    pub(crate) fn save(transfer: impl FnOnce(&mut Writer) -> Result<(), Unfit>) -> Checkpoint {
        let mut writer = Writer(Vec::new());
        transfer(&mut writer).expect("whatever is written fits itself");
        Checkpoint { state: writer.0 }
    }

    /// Reads it again, to its end.
    pub(crate) fn restore(&self, transfer: impl FnOnce(&mut Reader<'_>) -> Result<(), Unfit>) -> Result<(), Unfit> {
        let mut reader = Reader(&self.state);
        transfer(&mut reader)?;
        if reader.0.is_empty() { Ok(()) } else { Err(Unfit) }
    }
}

impl fmt::Debug for Checkpoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Checkpoint({} bytes)", self.state.len())
    }
}

/// A text with its length in front, and what follows it.
fn split_text(bytes: &[u8]) -> Result<(String, &[u8]), CheckpointError> {
    let (length, rest) = bytes.split_first_chunk::<4>().ok_or(CheckpointError::Damaged)?;
    let (text, rest) = rest.split_at_checked(u32::from_le_bytes(*length) as usize).ok_or(CheckpointError::Damaged)?;
    let text = std::str::from_utf8(text).map_err(|_| CheckpointError::Damaged)?;
    Ok((text.to_owned(), rest))
}

/// A state does not fit the rendering.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Unfit;

/// Words that are written or read, so that one description of a state serves both ways.
pub(crate) trait Tape {
    /// Writes the value, or replaces it by what was written.
    fn word(&mut self, value: &mut u32) -> Result<(), Unfit>;

    /// A value up to `most`.
    fn bounded(&mut self, value: &mut u32, most: u32) -> Result<(), Unfit> {
        self.word(value)?;
        if *value <= most { Ok(()) } else { Err(Unfit) }
    }

    /// A value that both sides know.
    fn same(&mut self, value: u32) -> Result<(), Unfit> {
        let mut other = value;
        self.word(&mut other)?;
        if other == value { Ok(()) } else { Err(Unfit) }
    }

    /// Every bit of a number.
    fn number(&mut self, value: &mut f32) -> Result<(), Unfit> {
        let mut bits = value.to_bits();
        self.word(&mut bits)?;
        *value = f32::from_bits(bits);
        Ok(())
    }

    fn numbers(&mut self, values: &mut [f32]) -> Result<(), Unfit> {
        values.iter_mut().try_for_each(|value| self.number(value))
    }

    /// Two words.
    fn long(&mut self, value: &mut u64) -> Result<(), Unfit> {
        let (mut low, mut high) = (*value as u32, (*value >> 32) as u32);
        self.word(&mut low)?;
        self.word(&mut high)?;
        *value = u64::from(high) << 32 | u64::from(low);
        Ok(())
    }
}

pub(crate) struct Writer(Vec<u8>);

impl Tape for Writer {
    fn word(&mut self, value: &mut u32) -> Result<(), Unfit> {
        self.0.extend(value.to_le_bytes());
        Ok(())
    }
}

pub(crate) struct Reader<'a>(&'a [u8]);

impl Tape for Reader<'_> {
    fn word(&mut self, value: &mut u32) -> Result<(), Unfit> {
        let (word, rest) = self.0.split_first_chunk::<4>().ok_or(Unfit)?;
        (*value, self.0) = (u32::from_le_bytes(*word), rest);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checkpoint() -> Checkpoint {
        Checkpoint::save(|tape| (0..9).try_for_each(|mut word| tape.word(&mut word)))
    }

    #[test]
    fn bytes_give_back_what_was_saved() {
        let bytes = checkpoint().to_bytes("a scene");
        assert_eq!(Checkpoint::from_bytes(&bytes, "a scene"), Ok(checkpoint()));
        assert_eq!(Checkpoint::from_bytes(&bytes, "another"), Err(CheckpointError::Origin("a scene".to_owned())));
    }

    #[test]
    fn whatever_is_cut_or_changed_is_noticed() {
        let bytes = checkpoint().to_bytes("a scene");
        for length in 0..bytes.len() {
            assert!(Checkpoint::from_bytes(&bytes[..length], "a scene").is_err(), "cut to {length}");
        }
        for at in 0..8 * bytes.len() {
            let mut bytes = bytes.clone();
            bytes[at / 8] ^= 1 << (at % 8);
            assert!(Checkpoint::from_bytes(&bytes, "a scene").is_err(), "bit {at}");
        }
        assert_eq!(Checkpoint::from_bytes(b"\x89PNG\r\n\x1a\n", ""), Err(CheckpointError::Foreign));
        assert_eq!(Checkpoint::from_bytes(&bytes[..bytes.len() - 1], "a scene"), Err(CheckpointError::Damaged));
        let mut newer = bytes;
        newer[12] = b'9';
        assert!(
            matches!(Checkpoint::from_bytes(&newer, "a scene"), Err(CheckpointError::Version(theirs)) if theirs.starts_with('9'))
        );
    }
}
