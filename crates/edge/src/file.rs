//! Pictures and other files, written whole or not at all.

use std::fmt::Display;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use jaspe_render::{Depth, Film, Format, encode};

use crate::refusal::{Refusal, plain};

/// Where a picture goes and as what: checked before any long work begins.
#[derive(Debug)]
pub struct Output {
    target: Target,
    format: Format,
}

/// Where a file goes: checked before any long work begins.
#[derive(Debug)]
pub struct Target {
    path: PathBuf,
}

impl Output {
    /// Decides on the format and makes sure that the file can be written.
    pub fn new(path: &Path, bits: Option<u8>) -> Result<Self, Refusal> {
        let format = Format::from_path(path).map_err(|error| {
            let known = Format::EXTENSIONS.iter().map(|extension| format!(".{extension}")).collect::<Vec<_>>();
            let refusal = writing(path, error);
            refusal.hint(format!("the extension chooses the format: {}", known.join(", ")))
        })?;
        let format = match bits {
            None => format,
            Some(bits) => with_bits(format, bits)?,
        };
        Ok(Output { target: Target::new(path)?, format })
    }

    /// The path as it was asked for.
    pub fn path(&self) -> &Path {
        &self.target.path
    }

    /// Encodes a film, writes it and returns the size of the file.
    pub fn write(&self, film: &Film) -> Result<usize, Refusal> {
        let bytes = encode(film, self.format).map_err(|error| {
            let message = format!("`{}` {error}", self.path().display());
            Refusal::new(message).hint("choose another format by its extension, such as .png")
        })?;
        self.target.write(&bytes)?;
        Ok(bytes.len())
    }
}

impl Target {
    /// Makes sure that the file can be written.
    pub fn new(path: &Path) -> Result<Self, Refusal> {
        let target = Target { path: path.to_owned() };
        target.check()?;
        Ok(target)
    }

    /// Writes it.
    pub fn write(&self, bytes: &[u8]) -> Result<(), Refusal> {
        self.store(bytes).map_err(|error| writing(&self.path, plain(&error)))
    }

    /// Beside the final file and then renamed, so that nobody ever sees half a picture.
    fn store(&self, bytes: &[u8]) -> io::Result<()> {
        if self.is_special() {
            return fs::OpenOptions::new().write(true).open(&self.path)?.write_all(bytes);
        }
        // A link stays a link: the file behind it is replaced.
        let target = fs::canonicalize(&self.path).unwrap_or_else(|_| self.path.clone());
        let mut file = temporary(folder_of(&target))?;
        file.write_all(bytes)?;
        file.persist(&target).map_err(|error| error.error)?;
        Ok(())
    }

    /// Pipes and devices are written to; they cannot be replaced.
    fn is_special(&self) -> bool {
        fs::metadata(&self.path).is_ok_and(|metadata| !metadata.is_file() && !metadata.is_dir())
    }

    fn check(&self) -> Result<(), Refusal> {
        let refusal = |reason: &str| writing(&self.path, reason);
        if self.path.is_dir() {
            return Err(refusal("it is a folder").hint("name a file in it"));
        }
        let folder = folder_of(&self.path);
        if !folder.is_dir() {
            let command = format!("create it first: mkdir -p {}", folder.display());
            return Err(refusal(&format!("there is no folder `{}`", folder.display())).hint(command));
        }
        if self.is_special() {
            return Ok(());
        }
        // The only honest test of a folder is to write into it.
        match temporary(folder) {
            Ok(_) => Ok(()),
            Err(error) => Err(refusal(&plain(&error)).hint("choose another place")),
        }
    }
}

/// `path` could not be written.
fn writing(path: &Path, error: impl Display) -> Refusal {
    Refusal::new(format!("cannot write `{}`: {error}", path.display()))
}

fn with_bits(format: Format, bits: u8) -> Result<Format, Refusal> {
    let depth = if bits == 16 { Depth::Sixteen } else { Depth::Eight };
    format.with_depth(depth).ok_or_else(|| {
        let refusal = Refusal::new(format!("{} offers no choice of bits", format.name()));
        refusal.hint("leave the bits out, or write .png or .tiff")
    })
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

/// A file that vanishes unless it is renamed, with the permissions that a new file gets.
fn temporary(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".jaspe-").suffix(".tmp");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::*;
    use jaspe_render::Encoding;

    #[test]
    fn writing_leaves_one_file_and_replaces_an_old_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.png");
        fs::write(&path, "old").expect("written");
        let output = Output::new(&path, None).expect("it can be written");
        assert_eq!(fs::read(&path).expect("still there"), b"old");
        let size = output.write(&Film::new(2, 2, Encoding::Linear)).expect("written");
        assert_eq!(fs::read(&path).expect("there").len(), size);
        assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 1);
    }
}
