//! Spreads a rendering over tiles and threads, and decides where more samples are needed.
//!
//! The picture is rendered in passes. The first gives every pixel its least number of samples; each further one adds
//! samples where neighbours or the samples themselves disagree. Decisions are made between passes, from whole
//! pictures, so that neither tiles nor threads leave a trace.
//!
//! Between two waves a rendering may be paused and its state saved: which pass it is in, how many waves of each tile are
//! done, and the sums so far. From there it goes on to the same bits.

use std::cmp::Reverse;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use glam::Vec3;
use rayon::prelude::*;

use crate::checkpoint::{Checkpoint, Tape, Unfit};
use crate::clock::Spent;
use crate::compile::{CompiledScene, Meaning, Sampling};
use crate::film::{Encoding, Film, Pixel};
use crate::options::{Cancelled, Observer, RenderOptions, ResumeError, Stats};
use crate::threads;
use crate::tile::{Active, Rect, Spread, Sum, TILE, Tile};
use crate::wave::{Results, Rules, Samples, Seen, Shots, Workspace};

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

/// One pass: the chosen pixels get the samples `first..end` of their sequence.
#[derive(Debug, Clone, Copy)]
struct Pass {
    choice: Choice,
    first: u32,
    end: u32,
    /// Sums start anew: a single sample at the centre is none of those that spread over the pixel.
    restart: bool,
}

/// Which pixels a pass adds samples to.
#[derive(Debug, Clone, Copy)]
enum Choice {
    All,
    /// Those that differ from a neighbour, and those whose own samples differ, by this threshold.
    Edges(f32),
    /// Those whose own samples differ, and those that differ from such a neighbour.
    Uneven(f32),
}

impl Pass {
    /// So many samples for all pixels.
    fn first(end: u32) -> Pass {
        Pass { choice: Choice::All, first: 0, end, restart: false }
    }
}

/// Renders with the rules of the scene's dialect, from the beginning or from where a checkpoint was taken.
pub(crate) fn render(
    scene: &CompiledScene,
    options: &RenderOptions,
    from: Option<&Checkpoint>,
    observer: &dyn Observer,
) -> Result<(Film, Stats), ResumeError> {
    threads::run(options.threads, || match &scene.meaning {
        Meaning::Sunflow { rules, .. } => {
            let state = Job::new(scene, rules, options, observer).state(from)?;
            let (rules, spent) = rules.prepare(&scene.world, observer);
            Ok(Job::new(scene, &rules, options, observer).finish(state, spent)?)
        }
        Meaning::Report { rules, .. } => {
            let job = Job::new(scene, rules, options, observer);
            Ok(job.finish(job.state(from)?, Spent::default())?)
        }
    })
}

/// How far a rendering is.
struct State {
    /// The current pass.
    pass: u32,
    tiles: Vec<Tile>,
    /// The means of finished tiles.
    film: Mutex<Film>,
    /// Samples traced, and known to be wanted.
    done: u64,
    total: u64,
}

/// One rendering under way.
struct Job<'a, R: Rules> {
    scene: &'a CompiledScene,
    rules: &'a R,
    options: &'a RenderOptions,
    observer: &'a dyn Observer,
    passes: Vec<Pass>,
    /// What is asked for.
    crop: Rect,
    /// What the filter needs for it.
    frame: Rect,
    /// What is rendered: one pixel more on each side for every pass that asks neighbours, which have asked theirs.
    region: Rect,
    done: AtomicU64,
    total: AtomicU64,
    /// Somebody wants a checkpoint: threads stop after their waves.
    paused: AtomicBool,
    /// Rooms that no thread works in.
    rooms: Mutex<Vec<Box<Room<R>>>>,
}

impl<'a, R: Rules> Job<'a, R> {
    fn new(scene: &'a CompiledScene, rules: &'a R, options: &'a RenderOptions, observer: &'a dyn Observer) -> Self {
        let [width, height] = scene.size;
        let crop = options.crop.map_or([0, 0, width, height], |[x0, y0, x1, y1]| {
            let (x1, y1) = (x1.clamp(1, width), y1.clamp(1, height));
            [x0.min(x1 - 1), y0.min(y1 - 1), x1, y1]
        });
        let passes = passes(scene.sampling);
        let crop = Rect(crop);
        let frame = wider(crop, scene.taps().reach(), scene.size);
        let region = wider(frame, passes.len() as u32 - 1, scene.size);
        let (done, total, paused) = (AtomicU64::new(0), AtomicU64::new(0), AtomicBool::new(false));
        let rooms = Mutex::default();
        Job { scene, rules, options, observer, passes, crop, frame, region, done, total, paused, rooms }
    }

    /// Whether samples decide about more samples.
    fn decides(&self) -> bool {
        self.passes.len() > 1
    }

    /// Where the work begins, or goes on.
    fn state(&self, from: Option<&Checkpoint>) -> Result<State, ResumeError> {
        let mut state = State {
            pass: 0,
            tiles: self.tiles().map(Tile::new).collect(),
            film: Mutex::new(self.film()),
            done: 0,
            total: self.region.pixels() * u64::from(self.passes[0].end),
        };
        if let Some(checkpoint) = from {
            checkpoint.restore(|tape| self.transfer(&mut state, tape)).map_err(|Unfit| ResumeError::Unfit)?;
            let State { tiles, film, .. } = &mut state;
            let film = film.get_mut().unwrap_or_else(PoisonError::into_inner);
            for tile in tiles.iter().filter(|tile| !tile.sums.is_empty()) {
                let part = tile.rect.meet(self.frame);
                self.put(film, part, &tile.pixels(part));
            }
        }
        Ok(state)
    }

    /// Goes through all passes that are left; `spent` has gone into preparations.
    fn finish(&self, mut state: State, spent: Spent) -> Result<(Film, Stats), Cancelled> {
        let mut stats = Stats { threads: rayon::current_num_threads(), spent, ..Stats::default() };
        self.done.store(state.done, Ordering::Relaxed);
        self.total.store(state.total, Ordering::Relaxed);
        loop {
            let pass = self.passes[state.pass as usize];
            self.pass(&mut state, pass, &mut stats)?;
            let Some(&next) = self.passes.get(state.pass as usize + 1) else { break };
            state.pass += 1;
            let later = self.passes.len() as u32 - 1 - state.pass;
            self.choose(&mut state.tiles, next.choice, wider(self.frame, later, self.scene.size));
            let samples = u64::from(next.end - next.first);
            let work: u64 = state.tiles.iter().map(|tile| tile.active_count() * samples).sum();
            self.total.fetch_add(work, Ordering::Relaxed);
        }
        let mut film = state.film.into_inner().unwrap_or_else(PoisonError::into_inner);
        self.scene.taps().apply(&mut film);
        Ok((self.cut(film, self.frame, self.crop), stats))
    }

    /// The part of a film that covers a rectangle.
    fn cut(&self, film: Film, of: Rect, part: Rect) -> Film {
        if of == part {
            return film;
        }
        let [x0, y0, x1, y1] = part.0;
        let row = |y: u32| &film.pixels[of.index(x0, y)..][..part.width() as usize];
        let pixels = if x0 < x1 { (y0..y1).flat_map(|y| row(y).iter().copied()).collect() } else { Vec::new() };
        Film { width: part.width(), height: part.height(), pixels, ..film }
    }

    /// The tiles of the region, row by row.
    fn tiles(&self) -> impl Iterator<Item = Rect> + use<R> {
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

    /// All that is left of a pass. Tiles go to the film when they are finished.
    fn pass(&self, state: &mut State, pass: Pass, stats: &mut Stats) -> Result<(), Cancelled> {
        loop {
            let State { tiles, film, .. } = &mut *state;
            let mut left: Vec<&mut Tile> = tiles.iter_mut().filter(|tile| !tile.is_finished()).collect();
            // Those with little to do fill what is left of the time in the end.
            left.sort_by_key(|tile| Reverse(tile.active_count()));
            let gathered = threads::deal(left.into_iter(), |tiles| {
                self.in_room(|room| {
                    tiles.map(|tile| self.work(tile, pass, film, room)).fold(Stats::default(), Stats::plus)
                })
            });
            *stats = gathered.into_iter().fold(*stats, Stats::plus);
            // Asked in this order, whoever is cancelled in between gets his checkpoint.
            let cancelled = self.observer.cancelled();
            if self.observer.wants_checkpoint() {
                self.observer.checkpoint(self.checkpoint(state));
            }
            self.paused.store(false, Ordering::Relaxed);
            if cancelled {
                return Err(Cancelled);
            }
            if state.tiles.iter().all(Tile::is_finished) {
                return Ok(());
            }
        }
    }

    /// Works in a room that is free, or a new one: there are never more than threads.
    fn in_room<T>(&self, work: impl FnOnce(&mut Room<R>) -> T) -> T {
        let rooms = || self.rooms.lock().unwrap_or_else(PoisonError::into_inner);
        let free = rooms().pop();
        let mut room = free.unwrap_or_default();
        let result = work(&mut room);
        rooms().push(room);
        result
    }

    /// Whether threads should leave their tiles as they are.
    fn stops(&self) -> bool {
        self.paused.load(Ordering::Relaxed) || self.observer.cancelled()
    }

    /// Adds the samples of a pass to the active pixels of a tile, a wave at a time, and writes the tile to the film.
    fn work(&self, tile: &mut Tile, pass: Pass, film: &Mutex<Film>, room: &mut Room<R>) -> Stats {
        if self.stops() {
            return Stats::default();
        }
        room.workspace.begin();
        let count = tile.rect.pixels() as usize;
        tile.sums.resize(count, Sum::default());
        tile.spreads.resize(if self.decides() { count } else { 0 }, Spread::EMPTY);
        let active = match std::mem::replace(&mut tile.active, Active::Some(Vec::new())) {
            Active::All => (0..count as u32).collect(),
            Active::Some(pixels) => pixels,
        };
        if pass.restart && tile.waves == 0 {
            for &slot in &active {
                tile.sums[slot as usize] = Sum::default();
                if let Some(spread) = tile.spreads.get_mut(slot as usize) {
                    *spread = Spread::EMPTY;
                }
            }
        }
        let mut whole = true;
        for (slots, indices) in self.waves(&active, pass).skip(tile.waves as usize) {
            if self.stops() {
                whole = false;
                break;
            }
            self.wave(tile, slots, indices, pass, room);
            tile.waves += 1;
            // At least one wave lies between two checkpoints.
            if self.observer.wants_checkpoint() {
                self.paused.store(true, Ordering::Relaxed);
            }
        }
        if !whole {
            tile.active = Active::Some(active);
            return room.workspace.end();
        }
        tile.waves = Tile::FINISHED;
        if !active.is_empty() {
            self.develop(tile, film);
        }
        if !self.decides() {
            tile.sums = Vec::new();
        }
        room.workspace.end()
    }

    /// The waves of a tile: as many pixels as fill one, or as many samples of one pixel.
    fn waves<'t>(&self, active: &'t [u32], pass: Pass) -> impl Iterator<Item = (&'t [u32], Range<u32>)> + use<'t, R> {
        let wave = self.rules.wave();
        let each = ((pass.end - pass.first) as usize).clamp(1, wave);
        active.chunks(wave / each).flat_map(move |slots| {
            let indices = move |first: u32| first..pass.end.min(first + each as u32);
            (pass.first..pass.end).step_by(each).map(move |first| (slots, indices(first)))
        })
    }

    /// Traces the samples `indices` of some pixels.
    fn wave(&self, tile: &mut Tile, slots: &[u32], indices: Range<u32>, pass: Pass, room: &mut Room<R>) {
        let Room { workspace, pixels, samples } = room;
        let each = indices.len();
        pixels.clear();
        pixels.extend(slots.iter().map(|&slot| tile.position(slot)));
        self.scene.aim(&Shots { pixels, indices, of: pass.end }, self.options.seed, samples);
        let looks = !tile.spreads.is_empty();
        workspace.trace(&self.scene.world, self.rules, samples, looks);
        let Results { pixels, seen } = &workspace.results;
        for (i, &slot) in slots.iter().enumerate() {
            let samples = i * each..(i + 1) * each;
            tile.sums[slot as usize].add(&pixels[samples.clone()]);
            if looks {
                let spread = &mut tile.spreads[slot as usize];
                samples.for_each(|k| spread.add(&pixels[k], seen[k]));
            }
        }
        let count = pixels.len() as u64;
        let done = self.done.fetch_add(count, Ordering::Relaxed) + count;
        self.observer.progress(done, self.total.load(Ordering::Relaxed));
    }

    /// Chooses the pixels of the next pass among those that count.
    fn choose(&self, tiles: &mut [Tile], choice: Choice, among: Rect) {
        let (first, threshold) = match choice {
            Choice::All => return tiles.iter_mut().for_each(|tile| tile.begin(Active::All)),
            Choice::Edges(threshold) => (true, threshold),
            Choice::Uneven(threshold) => (false, threshold),
        };
        let choose = |tile: &Tile| {
            let part = tile.rect.meet(among);
            let window = wider(part, 1, self.scene.size).meet(self.region);
            let looks = window.places().map(|(x, y)| Look::of(self.pixel(tiles, x, y), threshold));
            let mut looks: Vec<Look> = looks.collect();
            let width = window.width() as usize;
            // Each pixel with those after it: on the right, and the three below.
            for (at, (x, _)) in window.places().enumerate() {
                let (left, right) = (x > window.0[0], x + 1 < window.0[2]);
                let below = at + width;
                let others = [(right, at + 1), (left, below.wrapping_sub(1)), (true, below), (right, below + 1)];
                for other in others.into_iter().filter_map(|(is_inside, other)| is_inside.then_some(other)) {
                    let Ok([a, b]) = looks.get_disjoint_mut([at, other]) else { continue };
                    // Later an edge next door may just cut a corner of this pixel, where no sample was yet.
                    let (of_a, of_b) = (!a.is_chosen && (first || b.is_uneven), !b.is_chosen && (first || a.is_uneven));
                    if (of_a || of_b) && differ(a, b, threshold) {
                        a.is_chosen |= of_a;
                        b.is_chosen |= of_b;
                    }
                }
            }
            let chosen = part.places().filter(|&(x, y)| looks[window.index(x, y)].is_chosen);
            Active::Some(chosen.map(|(x, y)| tile.rect.index(x, y) as u32).collect())
        };
        let active: Vec<Active> = tiles.par_iter().with_max_len(4).map(choose).collect();
        tiles.iter_mut().zip(active).for_each(|(tile, active)| tile.begin(active));
    }

    /// A film for the frame. All threads clear it, which is no small part of the work for pictures of one sample.
    fn film(&self) -> Film {
        let [width, height] = [self.frame.width(), self.frame.height()];
        let pixels = rayon::iter::repeat_n([0.0; 4], self.frame.pixels() as usize).collect();
        Film { width, height, pixels, encoding: self.encoding() }
    }

    fn encoding(&self) -> Encoding {
        match self.scene.meaning {
            Meaning::Sunflow { .. } => Encoding::Linear,
            Meaning::Report { .. } => Encoding::Display,
        }
    }

    /// Writes a tile to the film, as far as the frame goes, and shows it.
    fn develop(&self, tile: &Tile, film: &Mutex<Film>) {
        let part = tile.rect.meet(self.frame);
        let pixels = tile.pixels(part);
        // Each tile writes its own pixels, in whatever order. A poisoned lock means a panic that is on its way.
        self.put(&mut film.lock().unwrap_or_else(PoisonError::into_inner), part, &pixels);
        let shown = tile.rect.meet(self.crop);
        if shown.pixels() > 0 {
            let film = Film { width: part.width(), height: part.height(), pixels, encoding: self.encoding() };
            let [[x, y, ..], [x0, y0, ..]] = [shown.0, self.crop.0];
            self.observer.tile([x - x0, y - y0], &self.cut(film, part, shown));
        }
    }

    /// Writes pixels to a part of the film.
    fn put(&self, film: &mut Film, part: Rect, pixels: &[Pixel]) {
        let [x0, y0, ..] = part.0;
        let width = part.width() as usize;
        for (row, y) in pixels.chunks_exact(width.max(1)).zip(y0..) {
            film.pixels[self.frame.index(x0, y)..][..width].copy_from_slice(row);
        }
    }

    /// The state as it is between two waves.
    fn checkpoint(&self, state: &mut State) -> Checkpoint {
        (state.done, state.total) = (self.done.load(Ordering::Relaxed), self.total.load(Ordering::Relaxed));
        Checkpoint::save(|tape| self.transfer(state, tape))
    }

    /// Writes or reads a state.
    fn transfer(&self, state: &mut State, tape: &mut impl Tape) -> Result<(), Unfit> {
        let State { pass, tiles, film, done, total } = state;
        // What both renderings have in common: another scene of the same outline is for the caller to notice.
        let [seed_low, seed_high] = [self.options.seed as u32, (self.options.seed >> 32) as u32];
        let outline = [self.scene.size[0], self.scene.size[1], TILE, self.rules.wave() as u32, seed_low, seed_high];
        outline.iter().chain(&self.crop.0).chain(&self.region.0).try_for_each(|&word| tape.same(word))?;
        tape.same(self.passes.len() as u32)?;
        self.passes.iter().try_for_each(|pass| tape.same(pass.end))?;

        tape.bounded(pass, self.passes.len() as u32 - 1)?;
        tape.long(done)?;
        tape.long(total)?;
        if done > total || *total > MOST_WORK {
            return Err(Unfit);
        }
        let film = film.get_mut().unwrap_or_else(PoisonError::into_inner);
        tiles.iter_mut().try_for_each(|tile| self.transfer_tile(*pass, tile, film, tape))
    }

    /// Writes or reads a tile: in a single pass its sums while it is worked at, and then what it left on the film; in one of
    /// several passes which pixels are active, and the sums, as soon as there are any.
    fn transfer_tile(&self, pass: u32, tile: &mut Tile, film: &mut Film, tape: &mut impl Tape) -> Result<(), Unfit> {
        tape.word(&mut tile.waves)?;
        if !self.decides() && tile.is_finished() {
            let [x0, y0, x1, y1] = tile.rect.meet(self.frame).0;
            return (y0..y1).try_for_each(|y| {
                let row = &mut film.pixels[self.frame.index(x0, y)..][..(x1 - x0) as usize];
                row.iter_mut().try_for_each(|pixel| tape.numbers(pixel))
            });
        }
        if pass > 0 && !tile.is_finished() {
            tile.transfer_active(tape)?;
        }
        let pass = (pass > 0, self.passes[pass as usize]);
        if pass.0 || tile.waves > 0 {
            tile.transfer_sums(pass.1.end, self.decides(), tape)?;
        }
        let all: Vec<u32>;
        let active = match &tile.active {
            Active::Some(pixels) => pixels,
            Active::All => {
                all = (0..tile.rect.pixels() as u32).collect();
                &all
            }
        };
        if tile.is_finished() || tile.waves as usize <= self.waves(active, pass.1).count() {
            Ok(())
        } else {
            Err(Unfit)
        }
    }
}

/// A part of a picture of a size with so many pixels more on each side, as far as there are any.
fn wider(Rect([x0, y0, x1, y1]): Rect, by: u32, [width, height]: [u32; 2]) -> Rect {
    Rect([x0.saturating_sub(by), y0.saturating_sub(by), (x1 + by).min(width), (y1 + by).min(height)])
}

/// More samples than any picture has: 16,384² pixels of 2²⁰ samples, and room for what several passes add up to.
const MOST_WORK: u64 = 1 << 52;

/// The passes that give pixels their samples.
fn passes(sampling: Sampling) -> Vec<Pass> {
    match sampling {
        Sampling::Fixed { count } => vec![Pass::first(count)],
        Sampling::Report { edge, repeats } => vec![Pass::first(edge * edge * repeats)],
        Sampling::Adaptive { min_level, max_level, repeats, contrast } => {
            let count = |level: u32| (1 << (2 * level)) * repeats;
            let further = (min_level + 1..=max_level).map(|level| {
                let threshold = contrast * (1 << (level - 1)) as f32;
                let choice = if level == min_level + 1 { Choice::Edges(threshold) } else { Choice::Uneven(threshold) };
                let single = count(level - 1) == 1;
                let first = if single { 0 } else { count(level - 1) };
                Pass { choice, first, end: count(level), restart: single }
            });
            std::iter::once(Pass::first(count(min_level))).chain(further).collect()
        }
    }
}

/// A pixel, as its neighbours see it.
#[derive(Clone, Copy)]
struct Look {
    seen: Seen,
    sum: Sum,
    /// Whether its own samples differ.
    is_uneven: bool,
    is_chosen: bool,
}

impl Look {
    fn of((tile, slot): (&Tile, usize), threshold: f32) -> Look {
        let (spread, sum) = (&tile.spreads[slot], tile.sums[slot]);
        // The deviation of a pair that differs by the threshold t, |a − b| / (a + b) = t, is t.
        let is_uneven = spread.count > 1 && spread.deviation() > threshold;
        Look { seen: spread.seen, sum, is_uneven, is_chosen: is_uneven }
    }
}

/// Whether two neighbours may have an edge between them (format reference, §3.3, step 4).
fn differ(a: &Look, b: &Look, threshold: f32) -> bool {
    let normals = |a: Vec3, b: Vec3| a != b && a.dot(b) < 0.9;
    if a.seen.object != b.seen.object || normals(a.seen.normal, b.seen.normal) {
        return true;
    }
    // The test is the same at any scale, so sums over crossed counts do for means, without divisions.
    a.sum.color.iter().zip(&b.sum.color).any(|(x, y)| {
        let (x, y) = (x * b.sum.count, y * a.sum.count);
        (x - y).abs() > threshold * (x + y).abs()
    })
}
