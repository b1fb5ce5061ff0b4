//! Rays and hits in rows: each coordinate of many rays lies in a row of its own, as the kernels read them and as the
//! loops of shading write them.

use glam::Vec3;

use super::simd::{self, Lanes, Simd, Vec3s};
use super::{Hit, Id, Ray};

/// Points or vectors.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Rows {
    pub x: Vec<f32>,
    pub y: Vec<f32>,
    pub z: Vec<f32>,
}

impl Rows {
    pub fn clear(&mut self) {
        self.resize(0);
    }

    /// Makes room for exactly `count`; what is new is zero.
    pub fn resize(&mut self, count: usize) {
        self.each(|row| row.resize(count, 0.0));
    }

    #[inline]
    pub fn push(&mut self, v: Vec3) {
        self.x.push(v.x);
        self.y.push(v.y);
        self.z.push(v.z);
    }

    #[inline]
    pub fn get(&self, i: usize) -> Vec3 {
        Vec3::new(self.x[i], self.y[i], self.z[i])
    }

    #[inline]
    pub fn set(&mut self, i: usize, v: Vec3) {
        (self.x[i], self.y[i], self.z[i]) = (v.x, v.y, v.z);
    }

    /// As many rows as asked for, all of the same length, which the compiler can then rely on.
    #[inline(always)]
    pub fn slices(&self, count: usize) -> [&[f32]; 3] {
        self.part(0, count)
    }

    /// [`Rows::slices`], from `first` on.
    #[inline(always)]
    pub fn part(&self, first: usize, count: usize) -> [&[f32]; 3] {
        [&self.x[first..][..count], &self.y[first..][..count], &self.z[first..][..count]]
    }

    /// As many as there are lanes from `start` on, all of which the rows must have: see [`padded`].
    #[inline(always)]
    pub fn lanes<L: Lanes>(&self, start: usize) -> Vec3s<L> {
        Vec3s { x: L::load(&self.x[start..]), y: L::load(&self.y[start..]), z: L::load(&self.z[start..]) }
    }

    /// Writes what [`Rows::lanes`] reads.
    #[inline(always)]
    pub fn set_lanes<L: Lanes>(&mut self, start: usize, v: Vec3s<L>) {
        v.x.write(&mut self.x[start..]);
        v.y.write(&mut self.y[start..]);
        v.z.write(&mut self.z[start..]);
    }

    /// [`Rows::slices`], to write to.
    #[inline(always)]
    pub fn slices_mut(&mut self, count: usize) -> [&mut [f32]; 3] {
        [&mut self.x[..count], &mut self.y[..count], &mut self.z[..count]]
    }

    /// The same everywhere.
    pub fn fill(&mut self, v: Vec3) {
        self.x.fill(v.x);
        self.y.fill(v.y);
        self.z.fill(v.z);
    }

    /// Adds the first of others.
    pub fn extend(&mut self, other: &Rows, count: usize) {
        let [x, y, z] = other.slices(count);
        self.x.extend_from_slice(x);
        self.y.extend_from_slice(y);
        self.z.extend_from_slice(z);
    }

    fn each(&mut self, f: impl FnMut(&mut Vec<f32>)) {
        [&mut self.x, &mut self.y, &mut self.z].into_iter().for_each(f);
    }
}

/// Names of primitives.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Ids {
    pub object: Vec<u32>,
    pub index: Vec<u32>,
}

impl Ids {
    pub fn clear(&mut self) {
        self.object.clear();
        self.index.clear();
    }

    pub fn resize(&mut self, count: usize) {
        self.object.resize(count, Id::NONE.object);
        self.index.resize(count, Id::NONE.index);
    }

    #[inline]
    pub fn push(&mut self, id: Id) {
        self.object.push(id.object);
        self.index.push(id.index);
    }

    #[inline]
    pub fn get(&self, i: usize) -> Id {
        Id { object: self.object[i], index: self.index[i] }
    }

    #[inline]
    pub fn set(&mut self, i: usize, id: Id) {
        (self.object[i], self.index[i]) = (id.object, id.index);
    }
}

/// Rays: see [`Ray`] for what the rows mean. A ray that ends before it begins meets nothing.
#[derive(Debug, Clone, Default)]
pub(crate) struct Rays {
    pub origin: Rows,
    pub direction: Rows,
    pub t_max: Vec<f32>,
    pub skip: Ids,
    /// Empty where nothing moves.
    pub time: Vec<f32>,
}

impl Rays {
    pub fn len(&self) -> usize {
        self.t_max.len()
    }

    pub fn is_empty(&self) -> bool {
        self.t_max.is_empty()
    }

    pub fn clear(&mut self) {
        self.origin.clear();
        self.direction.clear();
        self.t_max.clear();
        self.skip.clear();
        self.time.clear();
    }

    /// Room for `count` rays: all rows of that length, for those who write them one by one.
    pub fn resize(&mut self, count: usize) {
        self.origin.resize(count);
        self.direction.resize(count);
        self.t_max.resize(count, -1.0);
        self.skip.resize(count);
    }

    #[inline]
    pub fn push(&mut self, ray: Ray) {
        self.origin.push(ray.origin);
        self.direction.push(ray.direction);
        self.t_max.push(ray.t_max);
        self.skip.push(ray.skip);
        self.time.extend(ray.time);
    }

    /// Adds `count` rays that go on without end, in a world where nothing moves.
    pub fn extend(&mut self, count: usize, origin: &Rows, direction: &Rows, skip: &Ids) {
        self.origin.extend(origin, count);
        self.direction.extend(direction, count);
        self.t_max.resize(self.origin.x.len(), f32::INFINITY);
        self.skip.object.extend_from_slice(&skip.object[..count]);
        self.skip.index.extend_from_slice(&skip.index[..count]);
    }

    /// Makes these rays some of others, in an order.
    pub fn gather(&mut self, others: &Rays, order: &[u32]) {
        let Rays { origin, direction, t_max, skip, time } = self;
        for (to, from) in [(origin, &others.origin), (direction, &others.direction)] {
            pick(&mut to.x, &from.x, order);
            pick(&mut to.y, &from.y, order);
            pick(&mut to.z, &from.z, order);
        }
        pick(t_max, &others.t_max, order);
        pick(&mut skip.object, &others.skip.object, order);
        pick(&mut skip.index, &others.skip.index, order);
        pick(time, &others.time, if others.time.is_empty() { &[] } else { order });
    }

    /// Ray `i`, from 0 on.
    #[inline]
    pub fn get(&self, i: usize) -> Ray {
        let (origin, direction) = (self.origin.get(i), self.direction.get(i));
        let time = self.time.get(i).copied();
        Ray { origin, direction, t_min: 0.0, t_max: self.t_max[i], skip: self.skip.get(i), time }
    }

    /// These rays, to be traced from `t_min` on.
    pub fn view(&self, t_min: f32) -> RayView<'_> {
        let Rays { origin, direction, t_max, skip, time } = self;
        RayView { origin, direction, t_max, skip, t_min, time }
    }
}

/// Some of a row's numbers, in an order.
fn pick<T: Copy>(to: &mut Vec<T>, from: &[T], order: &[u32]) {
    to.clear();
    to.extend(order.iter().map(|&i| from[i as usize]));
}

/// Rays whose rows may come from different places.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RayView<'a> {
    pub origin: &'a Rows,
    pub direction: &'a Rows,
    pub t_max: &'a [f32],
    pub skip: &'a Ids,
    pub t_min: f32,
    pub time: &'a [f32],
}

impl RayView<'_> {
    pub fn len(&self) -> usize {
        self.t_max.len()
    }
}

impl Rows {
    /// As many as there are lanes from `start` on, filled up by the last one.
    #[inline(always)]
    pub fn group<L: Lanes>(&self, start: usize) -> Vec3s<L> {
        let [x, y, z] = [&self.x, &self.y, &self.z].map(|row| row.last().copied().unwrap_or_default());
        Vec3s { x: group(&self.x, start, x), y: group(&self.y, start, y), z: group(&self.z, start, z) }
    }
}

/// Most lanes that there are.
pub(super) const MOST: usize = 16;

/// So many numbers and as many more as fill the lanes: what those hold means nothing.
#[inline(always)]
pub(crate) fn padded(count: usize) -> usize {
    count.next_multiple_of(MOST)
}

/// As many of a row as there are lanes, filled up at its end.
#[inline(always)]
pub(crate) fn group<L: Lanes>(row: &[f32], start: usize, fill: f32) -> L {
    if row.len() - start >= L::COUNT { L::load(&row[start..]) } else { L::load(&filled(&row[start..], fill)) }
}

/// [`group`] of what are no numbers.
#[inline(always)]
pub(super) fn group_bits<L: Lanes>(row: &[u32], start: usize, fill: u32) -> L {
    if row.len() - start >= L::COUNT { L::load_bits(&row[start..]) } else { L::load_bits(&filled(&row[start..], fill)) }
}

#[inline(always)]
fn filled<T: Copy>(row: &[T], fill: T) -> [T; MOST] {
    std::array::from_fn(|i| row.get(i).copied().unwrap_or(fill))
}

/// A ray in each lane.
#[derive(Clone, Copy)]
pub(super) struct Group<L> {
    pub origin: Vec3s<L>,
    pub direction: Vec3s<L>,
    pub t_max: L,
    pub skip: Names<L>,
    /// Which of the caller's rays they are, as bits.
    pub numbers: L,
    /// How many lanes there are rays in, from the first on. In the others there are some of these again.
    pub count: usize,
    /// Whether they follow each other in the caller's rows.
    pub is_row: bool,
}

/// An [`Id`] in each lane, as bits.
#[derive(Clone, Copy)]
pub(super) struct Names<L> {
    pub object: L,
    pub index: L,
}

impl<L: Lanes> Names<L> {
    #[inline(always)]
    pub fn splat(id: Id) -> Self {
        Names { object: L::splat(f32::from_bits(id.object)), index: L::splat(f32::from_bits(id.index)) }
    }

    /// Lanes that hold the same name.
    #[inline(always)]
    pub fn same(self, other: Self) -> u32 {
        self.object.same_bits(other.object) & self.index.same_bits(other.index)
    }

    #[inline(always)]
    pub fn select(mask: u32, yes: Self, no: Self) -> Self {
        Names { object: L::select(mask, yes.object, no.object), index: L::select(mask, yes.index, no.index) }
    }

    #[inline(always)]
    pub fn get(&self, lane: usize) -> Id {
        let (object, index) = (self.object.store_bits(), self.index.store_bits());
        Id { object: object.as_ref()[lane], index: index.as_ref()[lane] }
    }
}

impl<L: Lanes> Group<L> {
    /// The rays from one on, as many as there are lanes.
    #[inline(always)]
    pub fn row(rays: &RayView<'_>, first: usize) -> Self {
        let mut numbers = [0; MOST];
        for (i, number) in numbers.iter_mut().enumerate() {
            *number = (first + i) as u32;
        }
        let (RayView { origin: o, direction: d, t_max, skip, .. }, end) = (rays, rays.len());
        Group {
            origin: Vec3s { x: until(&o.x, first, end), y: until(&o.y, first, end), z: until(&o.z, first, end) },
            direction: Vec3s { x: until(&d.x, first, end), y: until(&d.y, first, end), z: until(&d.z, first, end) },
            t_max: until(t_max, first, end),
            skip: Names {
                object: group_bits(&skip.object, first, Id::NONE.object),
                index: group_bits(&skip.index, first, Id::NONE.index),
            },
            numbers: L::load_bits(&numbers),
            count: L::COUNT.min(end - first),
            is_row: true,
        }
    }
}

/// As many of the first `end` of a row as there are lanes, filled up by the last of them.
#[inline(always)]
fn until<L: Lanes>(row: &[f32], first: usize, end: usize) -> L {
    group(&row[..end], first, row[end - 1])
}

/// Rays that wait to become a group, less than twice as many as there are lanes: the rows of [`Group`].
pub(super) struct Queue {
    rows: [[f32; 2 * MOST]; 10],
    pub count: usize,
}

impl Queue {
    pub const EMPTY: Queue = Queue { rows: [[0.0; 2 * MOST]; 10], count: 0 };

    /// Adds those rays of a group that are in `mask`.
    #[inline(always)]
    pub fn add<L: Lanes>(&mut self, group: &Group<L>, mask: u32) {
        let Group { origin: o, direction: d, t_max, skip, numbers, .. } = group;
        let at = self.count.min(MOST);
        let [ox, oy, oz, dx, dy, dz, t, object, index, number] = &mut self.rows;
        put(o.x.compress(mask).store().as_ref(), &mut ox[at..]);
        put(o.y.compress(mask).store().as_ref(), &mut oy[at..]);
        put(o.z.compress(mask).store().as_ref(), &mut oz[at..]);
        put(d.x.compress(mask).store().as_ref(), &mut dx[at..]);
        put(d.y.compress(mask).store().as_ref(), &mut dy[at..]);
        put(d.z.compress(mask).store().as_ref(), &mut dz[at..]);
        put(t_max.compress(mask).store().as_ref(), &mut t[at..]);
        put(skip.object.compress(mask).store().as_ref(), &mut object[at..]);
        put(skip.index.compress(mask).store().as_ref(), &mut index[at..]);
        put(numbers.compress(mask).store().as_ref(), &mut number[at..]);
        self.count += mask.count_ones() as usize;
    }

    /// Takes those that came last: as many as there are lanes, or all.
    #[inline(always)]
    pub fn take<L: Lanes>(&mut self) -> Group<L> {
        let count = self.count.min(L::COUNT);
        self.count -= count;
        let at = self.count.min(MOST);
        // The lanes behind them must go the same way.
        if count < L::COUNT {
            for row in &mut self.rows {
                let first = row[at];
                row[at + count..].fill(first);
            }
        }
        let [ox, oy, oz, dx, dy, dz, t, object, index, number] = &self.rows;
        Group {
            origin: Vec3s { x: L::load(&ox[at..]), y: L::load(&oy[at..]), z: L::load(&oz[at..]) },
            direction: Vec3s { x: L::load(&dx[at..]), y: L::load(&dy[at..]), z: L::load(&dz[at..]) },
            t_max: L::load(&t[at..]),
            skip: Names { object: L::load(&object[at..]), index: L::load(&index[at..]) },
            numbers: L::load(&number[at..]),
            count,
            is_row: false,
        }
    }
}

/// As much of a group as there is room for.
#[inline(always)]
pub(super) fn put<T: Copy>(group: &[T], row: &mut [T]) {
    if row.len() >= group.len() {
        row[..group.len()].copy_from_slice(group);
    } else {
        row.iter_mut().zip(group).for_each(|(to, from)| *to = *from);
    }
}

/// [`put`] of lanes.
#[inline(always)]
pub(crate) fn put_group<L: Lanes>(group: L, row: &mut [f32]) {
    put(group.store().as_ref(), row);
}

/// What rays met first: see [`Hit`] for what the rows mean.
#[derive(Debug, Clone, Default)]
pub(crate) struct Hits {
    pub t: Vec<f32>,
    pub u: Vec<f32>,
    pub v: Vec<f32>,
    pub id: Ids,
    /// Empty where nothing moves.
    pub time: Vec<f32>,
}

impl Hits {
    pub fn resize(&mut self, count: usize) {
        [&mut self.t, &mut self.u, &mut self.v].into_iter().for_each(|row| row.resize(count, 0.0));
        self.id.resize(count);
    }

    #[inline]
    pub fn get(&self, i: usize) -> Hit {
        Hit { t: self.t[i], u: self.u[i], v: self.v[i], id: self.id.get(i), time: self.time.get(i).copied() }
    }
}

/// A stretch of hits on the same object, all of one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Run {
    pub first: u32,
    pub count: u32,
    pub object: u32,
    pub material: u32,
}

impl Run {
    /// The positions of its hits.
    pub fn range(&self) -> std::ops::Range<usize> {
        self.first as usize..(self.first + self.count) as usize
    }
}

/// Rays that have met something, and what, in rows: some of the rays of a wave, moved together. The rows are [`padded`].
#[derive(Debug, Default)]
pub(crate) struct Met {
    pub origin: Rows,
    pub direction: Rows,
    pub hits: Hits,
}

impl Met {
    /// Takes the rays of some runs, whose positions are `members`.
    pub fn gather(&mut self, rays: &Rays, hits: &Hits, runs: &[Run], members: &[u32]) {
        // Short runs are quicker taken one by one.
        const SHORT: usize = 4;
        if members.len() >= runs.len() * SHORT {
            simd::run(Gather { met: self, rays, hits, runs, count: members.len() });
            return;
        }
        let Met { origin, direction, hits: to } = self;
        let take = |to: &mut Vec<f32>, from: &[f32]| {
            pick(to, from, members);
            to.resize(padded(members.len()), 0.0);
        };
        for (to, from) in [(origin, &rays.origin), (direction, &rays.direction)] {
            take(&mut to.x, &from.x);
            take(&mut to.y, &from.y);
            take(&mut to.z, &from.z);
        }
        take(&mut to.t, &hits.t);
        take(&mut to.u, &hits.u);
        take(&mut to.v, &hits.v);
        pick(&mut to.id.object, &hits.id.object, members);
        pick(&mut to.id.index, &hits.id.index, members);
        to.id.resize(padded(members.len()));
        pick(&mut to.time, &hits.time, if hits.time.is_empty() { &[] } else { members });
    }

    /// A ray, as far as it matters when it has arrived.
    #[inline]
    pub fn ray(&self, i: usize) -> Ray {
        let (origin, direction) = (self.origin.get(i), self.direction.get(i));
        let time = self.hits.time.get(i).copied();
        Ray { origin, direction, t_min: 0.0, t_max: f32::INFINITY, skip: Id::NONE, time }
    }
}

/// [`Met::gather`] as a kernel.
struct Gather<'a> {
    met: &'a mut Met,
    rays: &'a Rays,
    hits: &'a Hits,
    runs: &'a [Run],
    count: usize,
}

impl simd::Kernel for Gather<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Gather { met: Met { origin, direction, hits: to }, rays, hits: from, runs, count } = self;
        take(&mut origin.x, &rays.origin.x, runs, count);
        take(&mut origin.y, &rays.origin.y, runs, count);
        take(&mut origin.z, &rays.origin.z, runs, count);
        take(&mut direction.x, &rays.direction.x, runs, count);
        take(&mut direction.y, &rays.direction.y, runs, count);
        take(&mut direction.z, &rays.direction.z, runs, count);
        take(&mut to.t, &from.t, runs, count);
        take(&mut to.u, &from.u, runs, count);
        take(&mut to.v, &from.v, runs, count);
        take(&mut to.id.object, &from.id.object, runs, count);
        take(&mut to.id.index, &from.id.index, runs, count);
        to.time.clear();
        if !from.time.is_empty() {
            take(&mut to.time, &from.time, runs, count);
        }
    }
}

/// Takes the numbers of some runs, `count` altogether. Whole registers are moved, though runs end anywhere: the next run
/// writes over what is too much.
#[inline(always)]
fn take<T: Copy + Default>(to: &mut Vec<T>, from: &[T], runs: &[Run], count: usize) {
    to.resize(padded(count) + MOST, T::default());
    let mut at = 0;
    for run in runs {
        let range = run.range();
        for i in range.clone().step_by(MOST) {
            let to: &mut [T; MOST] = to[at + i - range.start..].first_chunk_mut().expect("there is room for one more");
            match from[i..].first_chunk() {
                Some(whole) => *to = *whole,
                None => to.iter_mut().zip(&from[i..]).for_each(|(to, from)| *to = *from),
            }
        }
        at += range.len();
    }
    to.truncate(padded(count));
}

/// Numbers for all members of a batch, of which each run has one; [`padded`].
#[inline(always)]
pub(crate) fn spread(to: &mut Vec<f32>, runs: &[Run], count: usize, of: impl Fn(&Run) -> f32) {
    to.resize(padded(count) + MOST, 0.0);
    let mut at = 0;
    for run in runs {
        let value = of(run);
        for i in (0..run.count as usize).step_by(MOST) {
            *to[at + i..].first_chunk_mut().expect("there is room for one more") = [value; MOST];
        }
        at += run.count as usize;
    }
    to.truncate(padded(count));
}
