//! Spreads a rendering over tiles and threads, and decides where more samples are needed.
//!
//! The picture is rendered in passes. The first gives every pixel its least number of samples; each further one adds
//! samples where neighbours or the samples themselves disagree. Decisions are made between passes, from whole
//! pictures, so that neither tiles nor threads leave a trace.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use glam::Vec3;
use rayon::prelude::*;

use crate::clock::Spent;
use crate::compile::{CompiledScene, Meaning, Sampling};
use crate::film::{Encoding, Film, Pixel};
use crate::options::{Cancelled, Observer, RenderOptions, Stats};
use crate::wave::{Results, Rules, Samples, Seen, Shots, Workspace};

/// Pixels along the edge of a tile.
const TILE: u32 = 32;

/// Sums over the samples of one pixel.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    /// Colour and coverage.
    color: [f32; 4],
    count: f32,
}

impl Sum {
    fn add(&mut self, color: Vec3, covered: bool) {
        self.color[0] += color.x;
        self.color[1] += color.y;
        self.color[2] += color.z;
        self.color[3] += if covered { 1.0 } else { 0.0 };
        self.count += 1.0;
    }

    fn mean(&self) -> Pixel {
        if self.count > 0.0 { self.color.map(|sum| sum / self.count) } else { [0.0; 4] }
    }
}

/// What decides whether a pixel gets more samples, beside its sum.
#[derive(Debug, Clone, Copy)]
struct Spread {
    /// Brightness of the samples and its square, summed.
    brightness: [f32; 2],
    count: u32,
    /// What the first sample saw.
    seen: Seen,
}

impl Spread {
    const EMPTY: Spread = Spread { brightness: [0.0; 2], count: 0, seen: Seen::NOTHING };

    fn add(&mut self, color: Vec3, seen: Seen) {
        if self.count == 0 {
            self.seen = seen;
        }
        let brightness = color.max_element();
        self.brightness[0] += brightness;
        self.brightness[1] += brightness * brightness;
        self.count += 1;
    }

    /// Standard deviation of the samples' brightness over their mean.
    fn deviation(&self) -> f32 {
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

    /// The part that two rectangles share, perhaps none.
    fn meet(self, other: Rect) -> Rect {
        let ([ax0, ay0, ax1, ay1], [bx0, by0, bx1, by1]) = (self.0, other.0);
        let (x0, y0) = (ax0.max(bx0), ay0.max(by0));
        Rect([x0, y0, ax1.min(bx1).max(x0), ay1.min(by1).max(y0)])
    }

    fn pixels(self) -> u64 {
        u64::from(self.width()) * u64::from(self.height())
    }
}

/// The part of the picture that one thread works at.
struct Tile {
    rect: Rect,
    /// Made when the first sample falls, by the thread that traces it; then one for each pixel.
    sums: Vec<Sum>,
    /// As many, where samples decide about more samples; else none.
    spreads: Vec<Spread>,
    /// Pixels that the current pass adds samples to, as indices into `sums`.
    active: Active,
}

/// A choice of a tile's pixels.
enum Active {
    All,
    Some(Vec<u32>),
}

impl Tile {
    fn new(rect: Rect) -> Tile {
        Tile { rect, sums: Vec::new(), spreads: Vec::new(), active: Active::All }
    }

    /// How many pixels the current pass adds samples to.
    fn active_count(&self) -> u64 {
        match &self.active {
            Active::All => self.rect.pixels(),
            Active::Some(pixels) => pixels.len() as u64,
        }
    }

    /// Column and row of a pixel.
    fn position(&self, slot: u32) -> [u32; 2] {
        [self.rect.0[0] + slot % self.rect.width(), self.rect.0[1] + slot / self.rect.width()]
    }
}

/// One thread's room for the waves of its tiles.
struct Room<R: Rules> {
    workspace: Workspace<R>,
    pixels: Vec<[u32; 2]>,
    samples: Samples,
}

impl<R: Rules> Default for Room<R> {
    fn default() -> Self {
        Room { workspace: Workspace::default(), pixels: Vec::new(), samples: Samples::default() }
    }
}

/// One pass: every active pixel gets the samples `first..end` of its sequence.
#[derive(Debug, Clone, Copy)]
struct Pass {
    first: u32,
    end: u32,
    /// Sums start anew: a single sample at the centre is none of those that spread over the pixel.
    restart: bool,
}

/// Renders with the rules of the scene's dialect.
pub(crate) fn render(
    scene: &CompiledScene,
    options: &RenderOptions,
    observer: &dyn Observer,
) -> Result<(Film, Stats), Cancelled> {
    match &scene.meaning {
        Meaning::Sunflow { rules, .. } => in_pool(options, || {
            let (rules, spent) = rules.prepare(&scene.world, observer);
            Job::new(scene, &rules, options, observer).passes(spent)
        }),
        Meaning::Report { rules, .. } => {
            in_pool(options, || Job::new(scene, rules, options, observer).passes(Spent::default()))
        }
    }
}

/// Runs work on as many threads as asked for.
fn in_pool<T: Send>(options: &RenderOptions, work: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().num_threads(options.threads.unwrap_or(0)).build() {
        Ok(pool) => pool.install(work),
        // No threads to be had: work goes on in this one's own pool.
        Err(_) => work(),
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
    /// What the filter needs for it.
    frame: Rect,
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
        let wider = |Rect([x0, y0, x1, y1]): Rect, by: u32| {
            Rect([x0.saturating_sub(by), y0.saturating_sub(by), (x1 + by).min(width), (y1 + by).min(height)])
        };
        let (crop, adaptive) = (Rect(crop), matches!(scene.sampling, Sampling::Adaptive { .. }));
        let frame = wider(crop, scene.taps().reach());
        let region = wider(frame, u32::from(adaptive));
        let (done, total) = (AtomicU64::new(0), AtomicU64::new(0));
        Job { scene, rules, options, observer, crop, frame, region, done, total }
    }

    /// All samples of the picture; `spent` has gone into preparations.
    fn passes(&self, spent: Spent) -> Result<(Film, Stats), Cancelled> {
        let mut stats = Stats { threads: rayon::current_num_threads(), spent, ..Stats::default() };
        let once = |end: u32| Pass { first: 0, end, restart: false };
        let film = match self.scene.sampling {
            Sampling::Fixed { count } => self.single_pass(once(count), &mut stats)?,
            Sampling::Report { edge, repeats } => self.single_pass(once(edge * edge * repeats), &mut stats)?,
            Sampling::Adaptive { min_level, max_level, repeats, contrast } => {
                let mut tiles: Vec<Tile> = self.tiles().map(Tile::new).collect();
                let count = |level: u32| (1 << (2 * level)) * repeats;
                self.pass(&mut tiles, once(count(min_level)), &mut stats)?;
                for level in min_level + 1..=max_level {
                    let threshold = contrast * (1 << (level - 1)) as f32;
                    self.refine(&mut tiles, level == min_level + 1, threshold);
                    let single = count(level - 1) == 1;
                    let first = if single { 0 } else { count(level - 1) };
                    self.pass(&mut tiles, Pass { first, end: count(level), restart: single }, &mut stats)?;
                }
                let mut film = self.film();
                tiles.iter().for_each(|tile| self.develop(tile, &mut film));
                film
            }
        };
        Ok((self.finish(film), stats))
    }

    /// Filters the frame, and cuts out what is asked for.
    fn finish(&self, mut frame: Film) -> Film {
        self.scene.taps().apply(&mut frame);
        if self.frame == self.crop {
            return frame;
        }
        let [x0, y0, x1, y1] = self.crop.0;
        let row = |y: u32| &frame.pixels[self.frame.index(x0, y)..][..(x1 - x0) as usize];
        let pixels = (y0..y1).flat_map(|y| row(y).iter().copied()).collect();
        Film { width: x1 - x0, height: y1 - y0, pixels, ..frame }
    }

    /// The tiles of the region, row by row.
    fn tiles(&self) -> impl Iterator<Item = Rect> {
        let [x0, y0, x1, y1] = self.region.0;
        let row = move |y: u32| {
            let rect = move |x: u32| Rect([x, y, (x + TILE).min(x1), (y + TILE).min(y1)]);
            (x0..x1).step_by(TILE as usize).map(rect)
        };
        (y0..y1).step_by(TILE as usize).flat_map(row)
    }

    /// A pixel of the region: its tile, and its place there.
    fn pixel<'t>(&self, tiles: &'t [Tile], x: u32, y: u32) -> (&'t Tile, usize) {
        let column = (x - self.region.0[0]) / TILE;
        let row = (y - self.region.0[1]) / TILE;
        let tile = &tiles[(row * self.region.width().div_ceil(TILE) + column) as usize];
        (tile, tile.rect.index(x, y))
    }

    /// All samples of all pixels at once: a tile goes to the film as soon as it is done.
    fn single_pass(&self, pass: Pass, stats: &mut Stats) -> Result<Film, Cancelled> {
        self.total.fetch_add(self.region.pixels() * u64::from(pass.end), Ordering::Relaxed);
        let film = Mutex::new(self.film());
        let tiles: Vec<Rect> = self.tiles().collect();
        let gathered = tiles.par_iter().map_init(Room::default, |room, &rect| {
            let mut tile = Tile::new(rect);
            let stats = self.work(&mut tile, pass, room);
            // Each tile writes its own pixels, in whatever order. A poisoned lock means a panic that is on its way.
            self.develop(&tile, &mut film.lock().unwrap_or_else(PoisonError::into_inner));
            stats
        });
        *stats = stats.plus(gathered.reduce(Stats::default, Stats::plus));
        if self.observer.cancelled() {
            return Err(Cancelled);
        }
        Ok(film.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    fn pass(&self, tiles: &mut [Tile], pass: Pass, stats: &mut Stats) -> Result<(), Cancelled> {
        let samples = u64::from(pass.end - pass.first);
        let work: u64 = tiles.iter().map(|tile| tile.active_count() * samples).sum();
        self.total.fetch_add(work, Ordering::Relaxed);
        let gathered = tiles.par_iter_mut().map_init(Room::default, |room, tile| {
            if tile.spreads.is_empty() {
                tile.spreads = vec![Spread::EMPTY; tile.rect.pixels() as usize];
            }
            self.work(tile, pass, room)
        });
        *stats = stats.plus(gathered.reduce(Stats::default, Stats::plus));
        if self.observer.cancelled() { Err(Cancelled) } else { Ok(()) }
    }

    /// Adds the samples of a pass to the active pixels of a tile, a wave at a time.
    fn work(&self, tile: &mut Tile, pass: Pass, room: &mut Room<R>) -> Stats {
        room.workspace.begin();
        tile.sums.resize(tile.rect.pixels() as usize, Sum::default());
        let active = match std::mem::replace(&mut tile.active, Active::Some(Vec::new())) {
            Active::All => (0..tile.sums.len() as u32).collect(),
            Active::Some(pixels) => pixels,
        };
        if pass.restart {
            for &slot in &active {
                tile.sums[slot as usize] = Sum::default();
                if let Some(spread) = tile.spreads.get_mut(slot as usize) {
                    *spread = Spread { seen: spread.seen, ..Spread::EMPTY };
                }
            }
        }
        // As many pixels as fill a wave, or as many samples of one.
        let wave = self.rules.wave();
        let each = ((pass.end - pass.first) as usize).clamp(1, wave);
        for slots in active.chunks(wave / each) {
            room.pixels.clear();
            room.pixels.extend(slots.iter().map(|&slot| tile.position(slot)));
            for first in (pass.first..pass.end).step_by(each) {
                if self.observer.cancelled() {
                    return room.workspace.end();
                }
                self.wave(tile, slots, first..pass.end.min(first + each as u32), pass, room);
            }
        }
        room.workspace.end()
    }

    /// Traces the samples `indices` of some pixels.
    fn wave(&self, tile: &mut Tile, slots: &[u32], indices: Range<u32>, pass: Pass, room: &mut Room<R>) {
        let Room { workspace, pixels, samples } = room;
        let each = indices.len();
        self.scene.aim(&Shots { pixels, indices, of: pass.end }, self.options.seed, samples);
        let looks = !tile.spreads.is_empty();
        workspace.trace(&self.scene.world, self.rules, samples, looks);
        let Results { colors, covered, seen } = &workspace.results;
        for (i, &slot) in slots.iter().enumerate() {
            let sum = &mut tile.sums[slot as usize];
            for k in i * each..(i + 1) * each {
                sum.add(colors[k], covered[k]);
            }
            if looks {
                let spread = &mut tile.spreads[slot as usize];
                (i * each..(i + 1) * each).for_each(|k| spread.add(colors[k], seen[k]));
            }
        }
        let count = colors.len() as u64;
        let done = self.done.fetch_add(count, Ordering::Relaxed) + count;
        self.observer.progress(done, self.total.load(Ordering::Relaxed));
    }

    /// Chooses the pixels of the next pass: on the first refinement those that differ from a neighbour, and always
    /// those whose own samples differ.
    fn refine(&self, tiles: &mut [Tile], first: bool, threshold: f32) {
        let choose = |tile: &Tile| {
            let [x0, y0, x1, y1] = tile.rect.0;
            let [cx0, cy0, cx1, cy1] = self.frame.0;
            let inner = (y0.max(cy0)..y1.min(cy1)).flat_map(|y| (x0.max(cx0)..x1.min(cx1)).map(move |x| (x, y)));
            let chosen = inner.filter(|&(x, y)| {
                let slot = tile.rect.index(x, y);
                let spread = &tile.spreads[slot];
                // The deviation of a pair that differs by the threshold t, |a − b| / (a + b) = t, is t.
                let uneven = spread.count > 1 && spread.deviation() > threshold;
                let neighbours = || self.neighbours(x, y).map(|(x, y)| self.pixel(tiles, x, y));
                uneven || first && neighbours().any(|other| differ((tile, slot), other, threshold))
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

    /// A film for the frame.
    fn film(&self) -> Film {
        let encoding = match self.scene.meaning {
            Meaning::Sunflow { .. } => Encoding::Linear,
            Meaning::Report { .. } => Encoding::Display,
        };
        Film::new(self.frame.width(), self.frame.height(), encoding)
    }

    /// Writes a tile to the film, as far as the frame goes.
    fn develop(&self, tile: &Tile, film: &mut Film) {
        let [x0, y0, x1, y1] = tile.rect.meet(self.frame).0;
        for y in y0..y1 {
            let (from, to) = (tile.rect.index(x0, y), self.frame.index(x0, y));
            let count = (x1 - x0) as usize;
            for (pixel, sum) in film.pixels[to..to + count].iter_mut().zip(&tile.sums[from..from + count]) {
                *pixel = sum.mean();
            }
        }
    }
}

/// Whether two neighbours may have an edge between them (format reference, §3.3, step 4).
fn differ((a, i): (&Tile, usize), (b, j): (&Tile, usize), threshold: f32) -> bool {
    let (seen, other) = (a.spreads[i].seen, b.spreads[j].seen);
    let normals = |a: Vec3, b: Vec3| a != b && a.dot(b) < 0.9;
    if seen.object != other.object || normals(seen.normal, other.normal) {
        return true;
    }
    let (a, b) = (&a.sums[i], &b.sums[j]);
    // The test is the same at any scale, so sums over crossed counts do for means, without divisions.
    a.color.iter().zip(&b.color).any(|(x, y)| {
        let (x, y) = (x * b.count, y * a.count);
        (x - y).abs() > threshold * (x + y).abs()
    })
}
