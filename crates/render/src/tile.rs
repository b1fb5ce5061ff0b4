//! Spreads a rendering over tiles and threads, and decides where more samples are needed.
//!
//! The picture is rendered in passes. The first gives every pixel its least number of samples; each further one adds
//! samples where neighbours or the samples themselves disagree. Decisions are made between passes, from whole
//! pictures, so that neither tiles nor threads leave a trace.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::Vec3;
use rayon::prelude::*;

use crate::compile::{CompiledScene, Meaning, Sampling};
use crate::film::{Encoding, Film};
use crate::options::{Cancelled, Observer, RenderOptions, Stats};
use crate::wave::{CameraSample, Rules, SampleResult, Seen, Target, Workspace};

/// Pixels along the edge of a tile.
const TILE: u32 = 32;
/// Camera samples per wave: enough to fill texture batches, few enough for the cache.
const WAVE: usize = 1024;

/// Sums over the samples of one pixel.
#[derive(Debug, Clone, Copy)]
struct Accumulator {
    /// Colour and coverage, weighted.
    sum: [f32; 4],
    /// Weights.
    weight: f32,
    /// Brightness and its square, for the spread within the pixel.
    brightness: [f32; 2],
    count: u32,
    /// What the first sample saw.
    seen: Seen,
}

impl Accumulator {
    const EMPTY: Accumulator =
        Accumulator { sum: [0.0; 4], weight: 0.0, brightness: [0.0; 2], count: 0, seen: Seen::NOTHING };

    fn add(&mut self, result: &SampleResult, weight: f32) {
        if self.count == 0 {
            self.seen = result.seen;
        }
        let c = result.color;
        let brightness = c.max_element();
        self.sum[0] += c.x * weight;
        self.sum[1] += c.y * weight;
        self.sum[2] += c.z * weight;
        self.sum[3] += result.coverage * weight;
        self.weight += weight;
        self.brightness[0] += brightness;
        self.brightness[1] += brightness * brightness;
        self.count += 1;
    }

    fn mean(&self) -> [f32; 4] {
        // Over the weights and not the count: where all samples agree, negative lobes leave no trace.
        if self.weight > 0.0 { self.sum.map(|sum| sum / self.weight) } else { [0.0; 4] }
    }

    /// Standard deviation of the samples' brightness over their mean.
    fn spread(&self) -> f32 {
        let n = self.count as f32;
        let mean = self.brightness[0] / n;
        let variance = (self.brightness[1] / n - mean * mean).max(0.0);
        if mean > 0.0 { variance.sqrt() / mean } else { 0.0 }
    }
}

/// A rectangle of pixels: x0, y0, x1, y1, ends excluded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Rect([u32; 4]);

impl Rect {
    fn width(self) -> u32 {
        self.0[2] - self.0[0]
    }

    fn height(self) -> u32 {
        self.0[3] - self.0[1]
    }

    fn index(self, x: u32, y: u32) -> usize {
        (y - self.0[1]) as usize * self.width() as usize + (x - self.0[0]) as usize
    }

    fn pixels(self) -> u64 {
        u64::from(self.width()) * u64::from(self.height())
    }
}

/// The part of the picture that one thread works at.
struct Tile {
    rect: Rect,
    /// Made when the first sample falls, by the thread that traces it; then one for each pixel.
    pixels: Vec<Accumulator>,
    /// Pixels that the current pass adds samples to, as indices into `pixels`.
    active: Active,
}

/// A choice of a tile's pixels.
enum Active {
    All,
    Some(Vec<u32>),
}

impl Tile {
    /// How many pixels the current pass adds samples to.
    fn active_count(&self) -> u64 {
        match &self.active {
            Active::All => self.rect.pixels(),
            Active::Some(pixels) => pixels.len() as u64,
        }
    }
}

/// One thread's room for the waves of its tiles.
#[derive(Default)]
struct Room {
    workspace: Workspace,
    targets: Vec<Target>,
    samples: Vec<CameraSample>,
    results: Vec<SampleResult>,
}

/// One pass: every active pixel gets the samples `first..end` of its sequence.
#[derive(Debug, Clone, Copy)]
struct Pass {
    first: u32,
    end: u32,
    /// Sums start anew: a single sample at the centre does not belong to the filtered ones.
    restart: bool,
}

/// Renders with the rules of the scene's dialect.
pub(crate) fn render(
    scene: &CompiledScene,
    options: &RenderOptions,
    observer: &dyn Observer,
) -> Result<(Film, Stats), Cancelled> {
    match &scene.meaning {
        Meaning::Sunflow { rules, .. } => Job::new(scene, rules, options, observer).run(),
        Meaning::Report { rules, .. } => Job::new(scene, rules, options, observer).run(),
    }
}

/// One rendering under way.
struct Job<'a, R> {
    scene: &'a CompiledScene,
    rules: &'a R,
    options: &'a RenderOptions,
    observer: &'a dyn Observer,
    /// What is asked for.
    crop: Rect,
    /// What is rendered: one pixel more on each side, if decisions need neighbours.
    region: Rect,
    done: AtomicU64,
    total: AtomicU64,
}

impl<'a, R: Rules> Job<'a, R> {
    fn new(scene: &'a CompiledScene, rules: &'a R, options: &'a RenderOptions, observer: &'a dyn Observer) -> Self {
        let [width, height] = scene.size;
        let crop = options.crop.map_or([0, 0, width, height], |[x0, y0, x1, y1]| {
            let (x1, y1) = (x1.clamp(1, width), y1.clamp(1, height));
            [x0.min(x1 - 1), y0.min(y1 - 1), x1, y1]
        });
        let margin = u32::from(matches!(scene.sampling, Sampling::Adaptive { .. }));
        let [x0, y0, x1, y1] = crop;
        let region =
            [x0.saturating_sub(margin), y0.saturating_sub(margin), (x1 + margin).min(width), (y1 + margin).min(height)];
        let (done, total) = (AtomicU64::new(0), AtomicU64::new(0));
        Job { scene, rules, options, observer, crop: Rect(crop), region: Rect(region), done, total }
    }

    fn run(&self) -> Result<(Film, Stats), Cancelled> {
        let threads = self.options.threads.unwrap_or(0);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        match pool {
            Ok(pool) => pool.install(|| self.passes()),
            // No threads to be had: work goes on in this one's own pool.
            Err(_) => self.passes(),
        }
    }

    fn passes(&self) -> Result<(Film, Stats), Cancelled> {
        let mut tiles = self.tiles();
        let mut stats = Stats { threads: rayon::current_num_threads(), ..Stats::default() };
        match self.scene.sampling {
            Sampling::Fixed { count } => {
                self.pass(&mut tiles, Pass { first: 0, end: count, restart: false }, &mut stats)?;
            }
            Sampling::Report { edge, repeats } => {
                self.pass(&mut tiles, Pass { first: 0, end: edge * edge * repeats, restart: false }, &mut stats)?;
            }
            Sampling::Adaptive { min_level, max_level, repeats, contrast } => {
                let count = |level: u32| (1 << (2 * level)) * repeats;
                self.pass(&mut tiles, Pass { first: 0, end: count(min_level), restart: false }, &mut stats)?;
                for level in min_level + 1..=max_level {
                    let threshold = contrast * (1 << (level - 1)) as f32;
                    self.refine(&mut tiles, level == min_level + 1, threshold);
                    let single = count(level - 1) == 1;
                    let first = if single { 0 } else { count(level - 1) };
                    self.pass(&mut tiles, Pass { first, end: count(level), restart: single }, &mut stats)?;
                }
            }
        }
        Ok((self.film(&tiles), stats))
    }

    /// The tiles of the region, row by row, every pixel active.
    fn tiles(&self) -> Vec<Tile> {
        let [x0, y0, x1, y1] = self.region.0;
        let mut tiles = Vec::new();
        for y in (y0..y1).step_by(TILE as usize) {
            for x in (x0..x1).step_by(TILE as usize) {
                let rect = Rect([x, y, (x + TILE).min(x1), (y + TILE).min(y1)]);
                tiles.push(Tile { rect, pixels: Vec::new(), active: Active::All });
            }
        }
        tiles
    }

    /// A pixel of the region.
    fn pixel<'t>(&self, tiles: &'t [Tile], x: u32, y: u32) -> &'t Accumulator {
        let column = (x - self.region.0[0]) / TILE;
        let row = (y - self.region.0[1]) / TILE;
        let tile = &tiles[(row * self.region.width().div_ceil(TILE) + column) as usize];
        &tile.pixels[tile.rect.index(x, y)]
    }

    fn pass(&self, tiles: &mut [Tile], pass: Pass, stats: &mut Stats) -> Result<(), Cancelled> {
        let samples = u64::from(pass.end - pass.first);
        let work: u64 = tiles.iter().map(|tile| tile.active_count() * samples).sum();
        self.total.fetch_add(work, Ordering::Relaxed);
        let gathered = tiles
            .par_iter_mut()
            .map_init(Room::default, |room, tile| {
                room.workspace.queues.stats = Stats::default();
                if tile.active_count() > 0 && !self.observer.cancelled() {
                    self.tile(tile, pass, room);
                }
                room.workspace.queues.stats
            })
            .reduce(Stats::default, Stats::plus);
        *stats = stats.plus(gathered);
        if self.observer.cancelled() { Err(Cancelled) } else { Ok(()) }
    }

    /// Adds the samples of a pass to the active pixels of a tile, a wave at a time.
    fn tile(&self, tile: &mut Tile, pass: Pass, room: &mut Room) {
        tile.pixels.resize(tile.rect.pixels() as usize, Accumulator::EMPTY);
        let active = match std::mem::replace(&mut tile.active, Active::Some(Vec::new())) {
            Active::All => (0..tile.pixels.len() as u32).collect(),
            Active::Some(pixels) => pixels,
        };
        for &pixel in &active {
            let at = [tile.rect.0[0] + pixel % tile.rect.width(), tile.rect.0[1] + pixel / tile.rect.width()];
            if pass.restart {
                let seen = tile.pixels[pixel as usize].seen;
                tile.pixels[pixel as usize] = Accumulator { seen, ..Accumulator::EMPTY };
            }
            for index in pass.first..pass.end {
                room.targets.push(Target { pixel: at, slot: pixel, index });
                if room.targets.len() == WAVE {
                    self.wave(tile, pass, room);
                    if self.observer.cancelled() {
                        return;
                    }
                }
            }
        }
        self.wave(tile, pass, room);
    }

    fn wave(&self, tile: &mut Tile, pass: Pass, room: &mut Room) {
        let Room { workspace, targets, samples, results } = room;
        samples.clear();
        self.scene.camera_samples(targets, pass.end, self.options.seed, samples);
        workspace.trace(&self.scene.world, self.rules, samples, results);
        for ((target, sample), result) in targets.iter().zip(&*samples).zip(&*results) {
            tile.pixels[target.slot as usize].add(result, sample.weight);
        }
        let done = self.done.fetch_add(samples.len() as u64, Ordering::Relaxed) + samples.len() as u64;
        self.observer.progress(done, self.total.load(Ordering::Relaxed));
        targets.clear();
    }

    /// Chooses the pixels of the next pass: on the first refinement those that differ from a neighbour, and always
    /// those whose own samples differ.
    fn refine(&self, tiles: &mut [Tile], first: bool, threshold: f32) {
        let choose = |tile: &Tile| {
            let [x0, y0, x1, y1] = tile.rect.0;
            let [cx0, cy0, cx1, cy1] = self.crop.0;
            let inner = (y0.max(cy0)..y1.min(cy1)).flat_map(|y| (x0.max(cx0)..x1.min(cx1)).map(move |x| (x, y)));
            let chosen = inner.filter(|&(x, y)| {
                let pixel = &tile.pixels[tile.rect.index(x, y)];
                // The spread of a pair that differs by the threshold t, |a − b| / (a + b) = t, is t.
                let uneven = pixel.count > 1 && pixel.spread() > threshold;
                uneven || first && self.neighbours(x, y).any(|(x, y)| differ(pixel, self.pixel(tiles, x, y), threshold))
            });
            Active::Some(chosen.map(|(x, y)| tile.rect.index(x, y) as u32).collect())
        };
        let active: Vec<Active> = tiles.par_iter().map(choose).collect();
        tiles.iter_mut().zip(active).for_each(|(tile, active)| tile.active = active);
    }

    /// The up to eight pixels around one, within the region.
    fn neighbours(&self, x: u32, y: u32) -> impl Iterator<Item = (u32, u32)> {
        let [x0, y0, x1, y1] = self.region.0;
        let columns = x.saturating_sub(1).max(x0)..(x + 2).min(x1);
        let rows = y.saturating_sub(1).max(y0)..(y + 2).min(y1);
        rows.flat_map(move |row| columns.clone().map(move |column| (column, row))).filter(move |&at| at != (x, y))
    }

    fn film(&self, tiles: &[Tile]) -> Film {
        let encoding = match self.scene.meaning {
            Meaning::Sunflow { .. } => Encoding::Linear,
            Meaning::Report { .. } => Encoding::Display,
        };
        let mut film = Film::new(self.crop.width(), self.crop.height(), encoding);
        let [x0, y0, ..] = self.crop.0;
        film.pixels.par_chunks_mut(self.crop.width() as usize).enumerate().for_each(|(row, pixels)| {
            let y = y0 + row as u32;
            pixels.iter_mut().zip(x0..).for_each(|(pixel, x)| *pixel = self.pixel(tiles, x, y).mean());
        });
        film
    }
}

/// Whether two neighbours may have an edge between them (format reference, §3.3, step 4).
fn differ(a: &Accumulator, b: &Accumulator, threshold: f32) -> bool {
    let normals = |a: Vec3, b: Vec3| a != b && a.dot(b) < 0.9;
    if a.seen.object != b.seen.object || normals(a.seen.normal, b.seen.normal) {
        return true;
    }
    // The test is the same at any scale, so sums over crossed weights do for means, without divisions.
    a.sum.iter().zip(&b.sum).any(|(x, y)| {
        let (x, y) = (x * b.weight, y * a.weight);
        (x - y).abs() > threshold * (x + y).abs()
    })
}
