//! A baked set: a folder of maps and the files that name them, written whole or not at all.

use std::fmt;
use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use jaspe_render::{Cancelled, Depth, Format, Observer, encode};
use rayon::prelude::*;

use crate::bake::{Bake, Loop};
use crate::encode::{MapFormat, MapWriter, writer};
use crate::map::Map;
use crate::preview::preview;
use crate::{gltf, manifest, materialx};

/// How a set is written.
#[derive(Debug, Clone, PartialEq)]
pub struct SetOptions {
    /// The format of the maps.
    pub format: MapFormat,
    /// That of the height map.
    pub height_format: MapFormat,
    /// Whether a rendered preview is added: `preview.png`, or `preview.jpg` beside JPEG maps.
    pub preview: Preview,
}

impl SetOptions {
    /// All maps in a format; but heights, which eight bits show as steps, in PNG of 16 bits in place of those.
    pub fn new(format: MapFormat) -> Self {
        let height_format = if format.bits() == 8 { MapFormat::Png16 } else { format };
        SetOptions { format, height_format, preview: Preview::None }
    }

    /// The format of a map.
    pub fn format_of(&self, map: Map) -> MapFormat {
        if map == Map::Height { self.height_format } else { self.format }
    }
}

/// Whether a set has a rendered preview.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Preview {
    /// It has none.
    #[default]
    None,
    /// It has one, in so many pixels.
    Rendered([u32; 2]),
}

/// Why a set could not be written. Nothing of it is left behind.
#[derive(Debug)]
pub enum SetError {
    /// A file or folder could not be written.
    Write {
        /// Which one.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// The folder holds a file that is not of a set: writing the set would take it away.
    Occupied {
        /// The folder.
        folder: PathBuf,
        /// The file in it.
        file: String,
    },
    /// The format cannot hold maps of this size.
    TooLarge {
        /// The format.
        format: MapFormat,
        /// Its longest side.
        most: u32,
    },
    /// The observer asked for it.
    Cancelled,
}

impl fmt::Display for SetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SetError::Write { path, error } => write!(f, "cannot write `{}`: {error}", path.display()),
            SetError::Occupied { folder, file } => {
                write!(f, "`{}` holds `{file}`, which is not of a baked set", folder.display())
            }
            SetError::TooLarge { format, most } => write!(f, "{format} holds at most {most} pixels a side"),
            SetError::Cancelled => f.write_str("the bake was stopped"),
        }
    }
}

impl std::error::Error for SetError {}

impl From<Cancelled> for SetError {
    fn from(_: Cancelled) -> Self {
        SetError::Cancelled
    }
}

/// A set that has been written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// Its files and their sizes in bytes.
    pub files: Vec<(String, u64)>,
}

/// A folder that appears under its name when it is complete, and not at all otherwise.
#[derive(Debug)]
pub struct SetFolder {
    target: PathBuf,
    folder: tempfile::TempDir,
}

/// The file that says what was baked.
pub(crate) const MANIFEST: &str = "material.json";
/// The file that lists a gallery.
pub(crate) const GALLERY: &str = "gallery.json";

impl SetFolder {
    /// Makes sure that the folder can be written, and begins it beside its final place. A set that is there is replaced at the
    /// end.
    ///
    /// # Errors
    /// When the place cannot be written to, or holds other things than a set.
    pub fn new(target: &Path) -> Result<SetFolder, SetError> {
        let failed = |error| SetError::Write { path: target.to_owned(), error };
        // A link stays a link; a name without a folder before it lies in the current one.
        let target = fs::canonicalize(target).unwrap_or_else(|_| target.to_owned());
        match fs::read_dir(&target) {
            Ok(entries) => check_replaceable(&target, entries)?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(failed(error)),
        }
        let parent = match target.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        let mut builder = tempfile::Builder::new();
        builder.prefix(".jaspe-").suffix(".tmp");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt as _;
            builder.permissions(fs::Permissions::from_mode(0o777));
        }
        let folder = builder.tempdir_in(parent).map_err(failed)?;
        Ok(SetFolder { target, folder })
    }

    /// Where a file of this name will lie.
    fn named(&self, name: &str) -> PathBuf {
        self.target.join(name)
    }

    fn create(&self, name: &str) -> Result<File, SetError> {
        File::create(self.folder.path().join(name)).map_err(|error| SetError::Write { path: self.named(name), error })
    }

    /// Writes a file.
    pub(crate) fn write(&self, name: &str, bytes: &[u8]) -> Result<(), SetError> {
        let failed = |error| SetError::Write { path: self.named(name), error };
        self.create(name)?.write_all(bytes).map_err(failed)
    }

    /// Puts the folder in its place.
    pub(crate) fn complete(self) -> Result<Written, SetError> {
        let failed = |error| SetError::Write { path: self.target.clone(), error };
        let mut files = Vec::new();
        for entry in fs::read_dir(self.folder.path()).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let size = entry.metadata().map_err(failed)?.len();
            files.push((entry.file_name().to_string_lossy().into_owned(), size));
        }
        files.sort();
        // The old set steps aside, and comes back if the new one cannot take its place.
        let parent = self.folder.path().parent().unwrap_or(Path::new("."));
        let old = tempfile::Builder::new().prefix(".jaspe-").suffix(".old").tempdir_in(parent).map_err(failed)?;
        let aside = old.path().join("set");
        let stood = self.target.exists();
        if stood {
            fs::rename(&self.target, &aside).map_err(failed)?;
        }
        let folder = self.folder.path().to_owned();
        if let Err(error) = fs::rename(&folder, &self.target) {
            if stood {
                let _ = fs::rename(&aside, &self.target);
            }
            return Err(failed(error));
        }
        let _ = self.folder.keep();
        Ok(Written { files })
    }
}

/// A folder may be replaced if it is empty, or if the list that was written with it names all that is in it.
fn check_replaceable(folder: &Path, entries: fs::ReadDir) -> Result<(), SetError> {
    let mut listed = Vec::new();
    for list in [MANIFEST, GALLERY] {
        let list = fs::read(folder.join(list)).unwrap_or_default();
        let list: serde_json::Value = serde_json::from_slice(&list).unwrap_or_default();
        listed
            .extend(list["files"].as_array().into_iter().flatten().filter_map(|file| file.as_str().map(str::to_owned)));
    }
    for entry in entries {
        let entry = entry.map_err(|error| SetError::Write { path: folder.to_owned(), error })?;
        let file = entry.file_name().to_string_lossy().into_owned();
        if !listed.contains(&file) {
            return Err(SetError::Occupied { folder: folder.to_owned(), file });
        }
    }
    Ok(())
}

/// The name of a map's file; frames are numbered if there are several.
pub(crate) fn file_name(bake: &Bake, options: &SetOptions, map: Map, frame: u32) -> String {
    format!("{}.{}", numbered(bake, map.name(), frame), options.format_of(map).extension())
}

/// A name, with the number of the frame if there are several.
pub(crate) fn numbered(bake: &Bake, name: &str, frame: u32) -> String {
    match bake.settings().animation {
        None => name.to_owned(),
        Some(Loop { first, .. }) => format!("{name}.{:04}", first + frame),
    }
}

/// A part of a set's work, as a part of the whole for those who wait.
pub(crate) struct Work<'a> {
    pub observer: &'a dyn Observer,
    pub before: u64,
    pub most: u64,
    pub total: u64,
}

/// A row of maps takes so many times as long as one of heights.
const ROW_WORK: u64 = 16;
/// A preview takes as long as so many rows of heights.
const PREVIEW_WORK: u64 = 8000;

impl Observer for Work<'_> {
    fn progress(&self, done: u64, total: u64) {
        self.observer.progress(self.before + self.most * done / total.max(1), self.total);
    }

    fn cancelled(&self) -> bool {
        self.observer.cancelled()
    }
}

/// Bakes a set into a folder: the maps, `material.json`, and the files by which other programs open it.
///
/// # Errors
/// [`SetError`]; then the folder is as it was before.
pub fn write_set(
    bake: &Bake,
    options: &SetOptions,
    folder: SetFolder,
    observer: &dyn Observer,
) -> Result<Written, SetError> {
    let extent = [bake.width(), bake.height()];
    for &map in &bake.settings().maps {
        let format = options.format_of(map);
        if let Some(most) = format.max_side().filter(|&most| extent[0].max(extent[1]) > most) {
            return Err(SetError::TooLarge { format, most });
        }
    }
    let rows = u64::from(bake.frames()) * u64::from(bake.height());
    let preview_work = if options.preview == Preview::None { 0 } else { PREVIEW_WORK };
    let total = (1 + ROW_WORK) * rows + preview_work;
    let work = |before: u64, each: u64| Work { observer, before, most: each, total };
    let height_range = bake.height_range(&work(0, rows))?;
    for frame in 0..bake.frames() {
        let part = ROW_WORK * u64::from(bake.height());
        let observer = work(rows + part * u64::from(frame), part);
        write_frame(bake, options, &folder, frame, height_range, &observer)?;
    }
    if let Preview::Rendered(size) = options.preview {
        let film = preview(bake, 0, size, &work(total - preview_work, preview_work))?;
        let (name, format) = match options.format {
            MapFormat::Jpeg => ("preview.jpg", Format::Jpeg),
            _ => ("preview.png", Format::Png(Depth::Eight)),
        };
        folder.write(name, &encode(&film, format).expect("previews fit every format"))?;
    }
    let described = manifest::Described { bake, options, height_range };
    for (name, bytes) in gltf::files(bake, options) {
        folder.write(&name, &bytes)?;
    }
    folder.write(&format!("{}.mtlx", described.name()), materialx::document(&described).as_bytes())?;
    let mut files: Vec<String> = fs::read_dir(folder.folder.path())
        .map_err(|error| SetError::Write { path: folder.target.clone(), error })?
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .chain([MANIFEST.to_owned()])
        .collect();
    files.sort();
    folder.write(MANIFEST, described.json(&files).as_bytes())?;
    folder.complete()
}

fn write_frame(
    bake: &Bake,
    options: &SetOptions,
    folder: &SetFolder,
    frame: u32,
    height_range: [f64; 2],
    observer: &dyn Observer,
) -> Result<(), SetError> {
    struct Open {
        path: PathBuf,
        writer: Box<dyn MapWriter>,
        /// Which of the maps, and whether its green is turned over.
        source: usize,
        flipped: bool,
    }
    let maps = &bake.settings().maps;
    let mut files: Vec<(String, usize, bool)> =
        maps.iter().enumerate().map(|(i, &map)| (file_name(bake, options, map, frame), i, false)).collect();
    if let Some(name) = gltf::green_up_file(bake, options, frame) {
        files.extend(maps.iter().position(|&map| map == Map::Normal).map(|i| (name, i, true)));
    }
    let mut open = Vec::new();
    for (name, source, flipped) in files {
        let (path, map) = (folder.named(&name), maps[source]);
        let writer = writer(folder.create(&name)?, map, options.format_of(map), [bake.width(), bake.height()]);
        let writer = writer.map_err(|error| SetError::Write { path: path.clone(), error })?;
        open.push(Open { path, writer, source, flipped });
    }
    bake.bands::<SetError>(frame, height_range, observer, |band| {
        open.par_iter_mut().try_for_each(|file| {
            let rows = &band.maps[file.source];
            let written = if file.flipped { file.writer.rows(&green_flipped(rows)) } else { file.writer.rows(rows) };
            written.map_err(|error| SetError::Write { path: file.path.clone(), error })
        })
    })?;
    let finish = |file: Open| file.writer.finish().map_err(|error| SetError::Write { path: file.path, error });
    open.into_par_iter().try_for_each(finish)
}

/// Normals of the other convention.
fn green_flipped(rows: &[f32]) -> Vec<f32> {
    let mut rows = rows.to_vec();
    rows.chunks_exact_mut(3).for_each(|normal| normal[1] = 1.0 - normal[1]);
    rows
}
