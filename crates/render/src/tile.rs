//! Tiles: the rectangles that threads work at, with the sums over the samples of their pixels.

use glam::Vec3;

use crate::checkpoint::{Tape, Unfit};
use crate::film::Pixel;
use crate::wave::Seen;

/// Pixels along the edge of a tile.
pub(crate) const TILE: u32 = 32;

/// Sums over the samples of one pixel.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sum {
    /// Colour and coverage.
    pub color: [f32; 4],
    pub count: f32,
}

impl Sum {
    /// Adds samples, one after the other.
    pub fn add(&mut self, samples: &[Pixel]) {
        let mut color = self.color;
        for sample in samples {
            (0..4).for_each(|i| color[i] += sample[i]);
        }
        self.color = color;
        self.count += samples.len() as f32;
    }

    pub fn mean(&self) -> Pixel {
        match self.count {
            0.0 => [0.0; 4],
            1.0 => self.color,
            count => self.color.map(|sum| sum / count),
        }
    }
}

/// What decides whether a pixel gets more samples, beside its sum.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spread {
    /// Brightness of the samples and its square, summed.
    brightness: [f32; 2],
    pub count: u32,
    /// What the first sample saw.
    pub seen: Seen,
}

impl Spread {
    pub const EMPTY: Spread = Spread { brightness: [0.0; 2], count: 0, seen: Seen::NOTHING };

    pub fn add(&mut self, &[red, green, blue, _]: &Pixel, seen: Seen) {
        if self.count == 0 {
            self.seen = seen;
        }
        let brightness = red.max(green).max(blue);
        self.brightness[0] += brightness;
        self.brightness[1] += brightness * brightness;
        self.count += 1;
    }

    /// Standard deviation of the samples' brightness over their mean.
    pub fn deviation(&self) -> f32 {
        let n = self.count as f32;
        let mean = self.brightness[0] / n;
        let variance = (self.brightness[1] / n - mean * mean).max(0.0);
        if mean > 0.0 { variance.sqrt() / mean } else { 0.0 }
    }
}

/// A rectangle of pixels: x0, y0, x1, y1, ends excluded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Rect(pub [u32; 4]);

impl Rect {
    pub fn width(self) -> u32 {
        self.0[2] - self.0[0]
    }

    pub fn height(self) -> u32 {
        self.0[3] - self.0[1]
    }

    pub fn index(self, x: u32, y: u32) -> usize {
        (y - self.0[1]) as usize * self.width() as usize + (x - self.0[0]) as usize
    }

    /// The part that two rectangles share, perhaps none.
    pub fn meet(self, other: Rect) -> Rect {
        let ([ax0, ay0, ax1, ay1], [bx0, by0, bx1, by1]) = (self.0, other.0);
        let (x0, y0) = (ax0.max(bx0), ay0.max(by0));
        Rect([x0, y0, ax1.min(bx1).max(x0), ay1.min(by1).max(y0)])
    }

    /// Columns and rows of its pixels, row by row.
    pub fn places(self) -> impl Iterator<Item = (u32, u32)> {
        let [x0, y0, x1, y1] = self.0;
        (y0..y1).flat_map(move |y| (x0..x1).map(move |x| (x, y)))
    }

    pub fn pixels(self) -> u64 {
        u64::from(self.width()) * u64::from(self.height())
    }
}

/// The part of the picture that one thread works at.
pub(crate) struct Tile {
    pub rect: Rect,
    /// Made when the first sample falls, by the thread that traces it; then one for each pixel.
    pub sums: Vec<Sum>,
    /// As many, where samples decide about more samples; else none.
    pub spreads: Vec<Spread>,
    /// Pixels that the current pass adds samples to.
    pub active: Active,
    /// How many of its waves the current pass has traced, or [`Tile::FINISHED`].
    pub waves: u32,
}

/// A choice of a tile's pixels, as indices into its sums.
pub(crate) enum Active {
    All,
    Some(Vec<u32>),
}

impl Tile {
    /// As a number of waves: all that there are.
    pub const FINISHED: u32 = u32::MAX;

    pub fn new(rect: Rect) -> Tile {
        Tile { rect, sums: Vec::new(), spreads: Vec::new(), active: Active::All, waves: 0 }
    }

    /// Waits for the next pass, which adds samples to these pixels.
    pub fn begin(&mut self, active: Active) {
        (self.active, self.waves) = (active, 0);
    }

    pub fn is_finished(&self) -> bool {
        self.waves == Tile::FINISHED
    }

    /// How many pixels the current pass adds samples to.
    pub fn active_count(&self) -> u64 {
        match &self.active {
            Active::All => self.rect.pixels(),
            Active::Some(pixels) => pixels.len() as u64,
        }
    }

    /// Column and row of a pixel.
    pub fn position(&self, slot: u32) -> [u32; 2] {
        [self.rect.0[0] + slot % self.rect.width(), self.rect.0[1] + slot / self.rect.width()]
    }

    /// The colours of a part of the tile, row by row.
    pub fn pixels(&self, part: Rect) -> Vec<Pixel> {
        let [x0, y0, x1, y1] = part.0;
        let row = |y: u32| &self.sums[self.rect.index(x0, y)..][..(x1 - x0) as usize];
        let mut pixels = Vec::with_capacity(part.pixels() as usize);
        (y0..y1).for_each(|y| pixels.extend(row(y).iter().map(Sum::mean)));
        pixels
    }

    /// Writes or reads the choice of pixels, a bit for each.
    pub fn transfer_active(&mut self, tape: &mut impl Tape) -> Result<(), Unfit> {
        let mut bits = vec![0; (self.rect.pixels() as usize).div_ceil(32)];
        match &self.active {
            Active::All => bits.fill(u32::MAX),
            Active::Some(pixels) => pixels.iter().for_each(|&slot| bits[slot as usize / 32] |= 1 << (slot % 32)),
        }
        bits.iter_mut().try_for_each(|word| tape.word(word))?;
        let chosen = |&slot: &u32| bits[slot as usize / 32] >> (slot % 32) & 1 == 1;
        self.active = Active::Some((0..self.rect.pixels() as u32).filter(chosen).collect());
        Ok(())
    }

    /// Writes or reads the sums over at most `most` samples per pixel, and where they decide about more samples, what
    /// they decide by.
    pub fn transfer_sums(&mut self, most: u32, decides: bool, tape: &mut impl Tape) -> Result<(), Unfit> {
        let count = self.rect.pixels() as usize;
        self.sums.resize(count, Sum::default());
        self.spreads.resize(if decides { count } else { 0 }, Spread::EMPTY);
        for (slot, sum) in self.sums.iter_mut().enumerate() {
            let mut samples = sum.count as u32;
            tape.bounded(&mut samples, most)?;
            sum.count = samples as f32;
            tape.numbers(&mut sum.color)?;
            if let Some(spread) = self.spreads.get_mut(slot) {
                spread.count = samples;
                tape.numbers(&mut spread.brightness)?;
                tape.word(&mut spread.seen.object)?;
                let mut normal = spread.seen.normal.to_array();
                tape.numbers(&mut normal)?;
                spread.seen.normal = Vec3::from_array(normal);
            }
        }
        Ok(())
    }
}
