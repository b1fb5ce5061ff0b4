//! A bake: settings checked once, then rows of maps on all cores.

use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};

use jaspe_render::{Cancelled, Observer};
use jaspe_texture::Texture;
use rayon::prelude::*;

use crate::field::Field;
use crate::layout::Layout;
use crate::map::{Map, NormalConvention};
use crate::surface::{Frame, Surface};

/// What is baked, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The width of the maps in pixels; their height follows from the surface.
    pub size: u32,
    /// The width of the surface in units of the texture: the side of a plane or a cube, the diameter of a sphere or a cylinder,
    /// the longest side of the box around a mesh. `None` is what shows the material well on a plane, 2 as for the unit sphere,
    /// and a mesh's own width. (On a plane, the material is scaled by some per cent, so that a whole number of noise cells fits.)
    pub tile: Option<f64>,
    /// What is unrolled into the maps.
    pub surface: Surface,
    /// Which maps, each once.
    pub maps: Vec<Map>,
    /// Which way green points in the normal map.
    pub normal: NormalConvention,
    /// A sequence of frames, in place of one picture.
    pub animation: Option<Loop>,
}

/// A sequence of frames that returns to its beginning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Loop {
    /// How many frames; after the last one comes the first again.
    pub frames: u32,
    /// The number of the first one, for the names of files.
    pub first: u32,
    /// How many noise cells of time pass meanwhile: more is livelier.
    pub cells: u32,
}

impl Default for Settings {
    /// A plane of 1024 pixels with all the maps that every material has.
    fn default() -> Self {
        Settings {
            size: 1024,
            tile: None,
            surface: Surface::Plane,
            maps: vec![Map::Color, Map::Height, Map::Normal, Map::Roughness, Map::Occlusion],
            normal: NormalConvention::OpenGl,
            animation: None,
        }
    }
}

impl Settings {
    /// The maps that tell all of a material: the five that every one has, and emission where it glows.
    pub fn maps_of(texture: &Texture) -> Vec<Map> {
        let glows = texture.finish().emission > 0.0;
        Map::ALL.iter().copied().filter(|&map| map != Map::Emission || glows).collect()
    }
}

/// Why settings cannot be baked.
#[derive(Debug, Clone, PartialEq)]
pub enum BakeError {
    /// The size is out of range.
    Size(u32),
    /// The tile is not a positive number.
    Tile(f64),
    /// A tile holds more noise cells than its pixels can show.
    TooFine {
        /// The noise cells along the width of the surface.
        cells: f64,
        /// The most that pixels can show.
        most: f64,
    },
    /// No map was asked for.
    NoMaps,
    /// A map was asked for twice.
    Twice(Map),
    /// The texture coordinates of a mesh cover no pixel.
    NoLayout,
    /// An animation without frames or without time, or with too much of it.
    Animation(Loop),
}

impl fmt::Display for BakeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BakeError::Size(size) => write!(f, "a size of {size} pixels; it is from 1 to {}", Bake::MAX_SIZE),
            BakeError::Tile(tile) => write!(f, "a tile of {tile} units; it takes a positive number"),
            BakeError::TooFine { cells, most } => {
                write!(f, "{cells:.0} noise cells along a side, where pixels can show {most:.0}")
            }
            BakeError::NoLayout => f.write_str("the texture coordinates of the mesh cover no pixel"),
            BakeError::NoMaps => f.write_str("no map was asked for"),
            BakeError::Twice(map) => write!(f, "the map `{}` was asked for twice", map.name()),
            BakeError::Animation(Loop { frames, cells, .. }) => {
                write!(f, "{frames} frames over {cells} noise cells of time; both are from 1 to {}", Bake::MAX_FRAMES)
            }
        }
    }
}

impl std::error::Error for BakeError {}

/// A bake, ready to run. Immutable.
#[derive(Debug, Clone)]
pub struct Bake {
    texture: Texture,
    settings: Settings,
    extent: [u32; 2],
    /// The width of the surface in units of the texture.
    tile: f64,
    /// The width of the surface in noise cells.
    cells: f64,
    /// Of a mesh.
    layout: Option<Layout>,
    field: Field,
}

/// Some rows of every map.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// The first row, from the top.
    pub top: u32,
    /// For each map, in the order of the settings, rows of pixels with their channels interleaved: 0 to 1.
    pub maps: Vec<Vec<f32>>,
}

/// Whole maps in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct Arrays {
    /// Pixels per row.
    pub width: u32,
    /// Rows, from the top.
    pub height: u32,
    /// The heights that 0 and 1 of the height map stand for, in units of the texture.
    pub height_range: [f64; 2],
    /// The maps, in the order of the settings.
    pub maps: Vec<MapArray>,
}

/// A whole map in memory.
#[derive(Debug, Clone, PartialEq)]
pub struct MapArray {
    /// Which one.
    pub map: Map,
    /// Row by row from the top, channels interleaved: 0 to 1. Colours are display-encoded, and 0.5 is the middle of a
    /// normal's components.
    pub values: Vec<f32>,
}

/// The largest pixel that is of any use, in noise cells.
const COARSEST: f64 = 0.5;

/// Rows that are worked on between two looks at the observer: enough for many threads.
const BAND: u32 = 64;

impl Bake {
    /// The longest side of a map, in pixels.
    pub const MAX_SIZE: u32 = 16_384;
    /// The most frames of an animation, and the most cells of time.
    pub const MAX_FRAMES: u32 = 100_000;

    /// Checks the settings, and prepares the material for them.
    ///
    /// # Errors
    /// [`BakeError`] says which setting cannot be.
    pub fn new(texture: Texture, settings: Settings) -> Result<Bake, BakeError> {
        if !(1..=Self::MAX_SIZE).contains(&settings.size) {
            return Err(BakeError::Size(settings.size));
        }
        if settings.maps.is_empty() {
            return Err(BakeError::NoMaps);
        }
        let twice = |(i, map): (usize, &Map)| settings.maps[..i].contains(map).then_some(*map);
        if let Some(map) = settings.maps.iter().enumerate().find_map(twice) {
            return Err(BakeError::Twice(map));
        }
        let within = |number: u32| (1..=Self::MAX_FRAMES).contains(&number);
        if let Some(animation) =
            settings.animation.filter(|a| !within(a.frames) || !within(a.cells) || a.first > Self::MAX_FRAMES)
        {
            return Err(BakeError::Animation(animation));
        }
        let tile = settings.tile.or(settings.surface.own_width()).unwrap_or(texture.finish().tile);
        if !(tile > 0.0 && tile.is_finite()) {
            return Err(BakeError::Tile(tile));
        }
        let extent = settings.surface.extent(settings.size);
        let wanted = tile * texture.cells_per_unit();
        let cells = if settings.surface.tiles() { wanted.round().max(1.0) } else { wanted };
        let pixel = settings.surface.pixel(extent);
        let most = COARSEST / pixel;
        if cells > most.max(1.0) {
            return Err(BakeError::TooFine { cells, most });
        }
        let layout = match &settings.surface {
            Surface::Mesh(model) => Some(Layout::new(model, extent).ok_or(BakeError::NoLayout)?),
            _ => None,
        };
        let side = if settings.surface.tiles() { cells as u32 } else { 0 };
        let time = settings.animation.map_or(0, |animation| animation.cells);
        let repeating = texture.in_cells([side, side, 0, time]).expect("the periods are within what a noise can have");
        let field = Field::new(&repeating, cells * pixel);
        Ok(Bake { texture, settings, extent, tile, cells, layout, field })
    }

    /// Pixels per row of each map.
    pub fn width(&self) -> u32 {
        self.extent[0]
    }

    /// Rows of each map.
    pub fn height(&self) -> u32 {
        self.extent[1]
    }

    /// What is baked.
    pub fn texture(&self) -> &Texture {
        &self.texture
    }

    /// How it is baked.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// How many bands of the material's own (marble's) lie along the width of the surface: a whole number where it repeats.
    pub fn bands_across(&self) -> Option<f64> {
        self.shown().bands(self.cells)
    }

    /// How many frames there are: 1 without an animation.
    pub fn frames(&self) -> u32 {
        self.settings.animation.map_or(1, |animation| animation.frames)
    }

    /// The width of the surface in units of the texture.
    pub fn tile(&self) -> f64 {
        self.tile
    }

    /// The noise cells along the width of the surface: a whole number where it repeats.
    pub fn cells(&self) -> f64 {
        self.cells
    }

    /// The material as the centres of pixels show it: its points are noise cells, it repeats as the maps do, and it has the
    /// octaves that pixels can show. Heights and normals are those of this texture.
    pub fn shown(&self) -> &Texture {
        self.field.shown()
    }

    /// The point of the material, in noise cells, at the centre of a pixel; those outside of a map that repeats are in its
    /// next tile.
    pub fn point(&self, x: i64, y: i64) -> [f64; 3] {
        self.frame(x, y).point.to_array()
    }

    fn frame(&self, x: i64, y: i64) -> Frame {
        self.settings.surface.frame([x, y], self.extent, self.cells, self.layout.as_ref())
    }

    /// The lowest and the highest point of the surface in all frames, in units of the texture: what 0 and 1 of the height map
    /// stand for.
    ///
    /// # Errors
    /// [`Cancelled`] when the observer asked for it.
    pub fn height_range(&self, observer: &dyn Observer) -> Result<[f64; 2], Cancelled> {
        let range = self.height_range_in_cells(observer)?;
        Ok(range.map(|height| self.units(height)))
    }

    /// A height in cells, in units of the texture.
    fn units(&self, height: f32) -> f64 {
        f64::from(height) * self.tile() / self.cells
    }

    fn height_range_in_cells(&self, observer: &dyn Observer) -> Result<[f32; 2], Cancelled> {
        let rows = u64::from(self.frames()) * u64::from(self.height());
        let done = AtomicU64::new(0);
        let row = |row: u64| {
            if observer.cancelled() {
                return Err(Cancelled);
            }
            let height = u64::from(self.height());
            let (frame, y) = ((row / height) as u32, row % height);
            let frames = self.row_of_frames(y as u32);
            let heights = match self.time(frame) {
                None => self.field.heights::<3>(&frames, 0.0),
                Some(time) => self.field.heights::<4>(&frames, time),
            };
            observer.progress(done.fetch_add(1, Ordering::Relaxed) + 1, rows);
            let start = [f32::INFINITY, f32::NEG_INFINITY];
            Ok(heights.iter().fold(start, |[low, high], &height| [low.min(height), high.max(height)]))
        };
        let join = |a: [f32; 2], b: [f32; 2]| Ok([a[0].min(b[0]), a[1].max(b[1])]);
        (0..rows).into_par_iter().map(row).try_reduce(|| [f32::INFINITY, f32::NEG_INFINITY], join)
    }

    fn row_of_frames(&self, y: u32) -> Vec<Frame> {
        (0..self.width()).map(|x| self.frame(i64::from(x), i64::from(y))).collect()
    }

    /// The time of a frame in cells, if there is any.
    fn time(&self, frame: u32) -> Option<f32> {
        let Loop { frames, cells, .. } = self.settings.animation?;
        Some((f64::from(cells) * f64::from(frame % frames) / f64::from(frames)) as f32)
    }

    /// Bakes a frame, some rows of all maps at a time, from the top: `sink` gets them in order. The range is that of
    /// [`Bake::height_range`].
    ///
    /// # Errors
    /// What the sink returns; or [`Cancelled`], as it takes it, when the observer asked for it.
    pub fn bands<E: From<Cancelled>>(
        &self,
        frame: u32,
        height_range: [f64; 2],
        observer: &dyn Observer,
        mut sink: impl FnMut(Band) -> Result<(), E>,
    ) -> Result<(), E> {
        let range = height_range.map(|height| (height * self.cells / self.tile()) as f32);
        let time = self.time(frame);
        for top in (0..self.height()).step_by(BAND as usize) {
            if observer.cancelled() {
                return Err(Cancelled.into());
            }
            let rows = top..self.height().min(top + BAND);
            let rows: Vec<Vec<Vec<f32>>> = rows.into_par_iter().map(|y| self.row(y, time, range)).collect();
            let map = |i: usize| rows.iter().flat_map(|row| row[i].iter().copied()).collect();
            sink(Band { top, maps: (0..self.settings.maps.len()).map(map).collect() })?;
            observer.progress(u64::from(self.height().min(top + BAND)), u64::from(self.height()));
        }
        Ok(())
    }

    fn row(&self, y: u32, time: Option<f32>, range: [f32; 2]) -> Vec<Vec<f32>> {
        let frames = self.row_of_frames(y);
        let Settings { maps, normal, .. } = &self.settings;
        match time {
            None => self.field.row::<3>(&frames, 0.0, maps, *normal, range),
            Some(time) => self.field.row::<4>(&frames, time, maps, *normal, range),
        }
    }

    /// Bakes a frame into memory.
    ///
    /// # Errors
    /// [`Cancelled`] when the observer asked for it.
    pub fn arrays(&self, frame: u32, observer: &dyn Observer) -> Result<Arrays, Cancelled> {
        let has_height = self.settings.maps.contains(&Map::Height);
        let height_range = if has_height { self.height_range(observer)? } else { [0.0; 2] };
        let pixels = self.width() as usize * self.height() as usize;
        let empty = |&map: &Map| MapArray { map, values: Vec::with_capacity(pixels * map.declaration().channels) };
        let mut maps: Vec<MapArray> = self.settings.maps.iter().map(empty).collect();
        self.bands::<Cancelled>(frame, height_range, observer, |band| {
            for (map, rows) in maps.iter_mut().zip(band.maps) {
                map.values.extend(rows);
            }
            Ok(())
        })?;
        Ok(Arrays { width: self.width(), height: self.height(), height_range, maps })
    }
}
