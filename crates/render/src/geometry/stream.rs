//! Rays through the hierarchy, many at a time.
//!
//! They begin as packets of rays that go the same way ([`Packet`]): neighbours, where they do so by themselves, or rays
//! gathered by where they go, since those that bounce off a surface side by side have the way down to it in common. What
//! only few of them enter they look into alone, as [`Flight`]s, of which several are on their way at a time, so that one
//! computes while another waits for memory. In every round all that come to a node open it, then all that come to a leaf
//! meet what is in it, then those that are done make room for others: a loop that does one thing leaves the processor
//! nothing to guess.

use std::ops::Range;

use super::bvh::{Child, Octant};
use super::hull::{Hull, Span};
use super::packet::{Packet, Trail};
use super::rays::{Group, Hits, Queue, RayView};
use super::simd::{Lanes, Simd, Vec3s};
use super::traverse::{Course, Flight, Line, Nested, Tree};
use super::{Geometry, Hit, Id};

/// Flights that are on their way at a time, at least a packet of them: fewer wait for memory, and more do not stay in the
/// cache.
const FLIGHTS: usize = 20;
/// Places in lists of them: a power of two.
const PLACES: usize = 32;

/// Most rays that look together for where they come into the tree.
const ROW: usize = 128;

/// Room for the traversal of one thread; made once, because clearing it costs as much as a short ray.
pub(crate) struct Scratch {
    trail: Box<Trail>,
    pub(super) pool: Box<Pool>,
    /// By octant; empty between calls.
    queues: [Queue; 8],
}

impl Default for Scratch {
    fn default() -> Self {
        Scratch { trail: Box::new(Trail::EMPTY), pool: Pool::new(), queues: [Queue::EMPTY; 8] }
    }
}

/// Where the results go.
pub(super) trait Outcome {
    /// Whether anything that is met will do.
    const ANY: bool;
    /// Takes what a ray has met at the end; `blocked` also where it has looked for nothing.
    fn take(&mut self, ray: usize, hit: &Hit, blocked: bool);
    /// Takes what consecutive rays have met.
    fn take_row<L: Lanes, S: Simd>(&mut self, first: usize, packet: &Packet<L, S>);
    /// Takes consecutive rays that meet nothing, and the ends of all rays.
    fn pass(&mut self, rays: Range<usize>, t_max: &[f32]);
}

/// The closest hits.
pub(super) struct Closest<'a>(pub &'a mut Hits);

impl Outcome for Closest<'_> {
    const ANY: bool = false;

    #[inline(always)]
    fn take(&mut self, ray: usize, hit: &Hit, _: bool) {
        (self.0.t[ray], self.0.u[ray], self.0.v[ray]) = (hit.t, hit.u, hit.v);
        self.0.id.set(ray, hit.id);
    }

    #[inline(always)]
    fn take_row<L: Lanes, S: Simd>(&mut self, first: usize, packet: &Packet<L, S>) {
        packet.store(first, self.0);
    }

    #[inline(always)]
    fn pass(&mut self, rays: Range<usize>, t_max: &[f32]) {
        let Hits { t, u, v, id, .. } = &mut *self.0;
        t[rays.clone()].copy_from_slice(&t_max[rays.clone()]);
        u[rays.clone()].fill(0.0);
        v[rays.clone()].fill(0.0);
        id.object[rays.clone()].fill(Id::NONE.object);
        id.index[rays].fill(Id::NONE.index);
    }
}

/// Whether there are any.
pub(super) struct Blocked<'a>(pub &'a mut [bool]);

impl Outcome for Blocked<'_> {
    const ANY: bool = true;

    #[inline(always)]
    fn take(&mut self, ray: usize, _: &Hit, blocked: bool) {
        self.0[ray] = blocked;
    }

    #[inline(always)]
    fn take_row<L: Lanes, S: Simd>(&mut self, first: usize, packet: &Packet<L, S>) {
        packet.store_blocked(&mut self.0[first..]);
    }

    #[inline(always)]
    fn pass(&mut self, rays: Range<usize>, t_max: &[f32]) {
        for (blocked, t_max) in self.0[rays.clone()].iter_mut().zip(&t_max[rays]) {
            // What is not a number counts as an end before the beginning.
            *blocked = !(0.0..=f32::INFINITY).contains(t_max);
        }
    }
}

/// Where the rays of packets come from.
struct Source<'a> {
    rays: RayView<'a>,
    tree: &'a Tree,
    /// Rays of each octant that wait until there are enough.
    queues: &'a mut [Queue; 8],
    /// Octants of which there are enough.
    full: u32,
    /// How many rays have been handed over or put into queues.
    seen: usize,
    /// Up to here, rays go the same way as they lie.
    row_end: usize,
    /// Where those come into the tree.
    gate: Child,
    /// Whether there is anything beside the tree.
    planes: bool,
}

impl Source<'_> {
    /// Rays that go the same way: whose directions have the same signs. They come into the tree by the gate.
    #[inline(always)]
    fn next<L: Lanes, S: Simd, O: Outcome>(&mut self, outcome: &mut O) -> Option<Group<L>> {
        while self.full == 0 && self.seen < self.rays.len() {
            let group = Group::row(&self.rays, self.seen);
            if self.row_end <= self.seen {
                self.look::<L, S>(&group);
            }
            if self.row_end <= self.seen {
                self.sort(&group, outcome);
            } else if self.gate == Child::NONE && !self.planes {
                outcome.pass(self.seen..self.row_end, self.rays.t_max);
                self.seen = self.row_end;
            } else {
                self.seen += group.count;
                return Some(group);
            }
        }
        self.gate = self.tree.root;
        let octant = if self.full != 0 {
            self.full.trailing_zeros() as usize % 8
        } else {
            self.queues.iter().position(|queue| queue.count > 0)?
        };
        let queue = &mut self.queues[octant];
        let group = queue.take();
        self.full &= !(u32::from(queue.count < L::COUNT) << octant);
        Some(group)
    }

    /// Sees how far rays from a group on go the same way as they lie, and where those come into the tree.
    #[inline(always)]
    fn look<L: Lanes, S: Simd>(&mut self, group: &Group<L>) {
        let Some(octant) = octant(group) else { return };
        let mut span = Span::of(group, octant);
        self.row_end = self.seen + group.count;
        let end = self.rays.len().min(self.seen + ROW);
        while self.row_end < end {
            let more = Group::<L>::row(&self.rays, self.row_end);
            if self::octant(&more) != Some(octant) {
                break;
            }
            span.include(&Span::of(&more, octant));
            self.row_end += more.count;
        }
        self.gate = Hull::<S>::around(&span).gate(self.tree);
    }

    /// Puts the rays of a group into queues. Those that end before they begin are done.
    #[inline(always)]
    fn sort<L: Lanes, O: Outcome>(&mut self, group: &Group<L>, outcome: &mut O) {
        let all = L::ALL >> (L::COUNT - group.count);
        let mut rest = all & L::splat(0.0).le(group.t_max);
        let mut dead = all & !rest;
        let [x, y, z] = negative(group);
        while rest != 0 {
            let k = rest.trailing_zeros();
            let (nx, ny, nz) = (x >> k & 1, y >> k & 1, z >> k & 1);
            let same = rest & (x ^ nx.wrapping_sub(1)) & (y ^ ny.wrapping_sub(1)) & (z ^ nz.wrapping_sub(1));
            let octant = nx | ny << 1 | nz << 2;
            let queue = &mut self.queues[octant as usize % 8];
            queue.add(group, same);
            self.full |= u32::from(queue.count >= L::COUNT) << octant;
            rest &= !same;
        }
        while dead != 0 {
            let ray = self.seen + dead.trailing_zeros() as usize;
            outcome.take(ray, &Hit { t: self.rays.t_max[ray], ..Hit::NONE }, true);
            dead &= dead - 1;
        }
        self.seen += group.count;
    }
}

/// Lanes whose directions are negative, by axis.
#[inline(always)]
fn negative<L: Lanes>(group: &Group<L>) -> [u32; 3] {
    let (Vec3s { x, y, z }, zero, one) = (group.direction, L::splat(0.0), L::splat(1.0));
    // A zero has a sign too.
    [one.copysign(x).lt(zero), one.copysign(y).lt(zero), one.copysign(z).lt(zero)]
}

/// Where the directions of a group go, if all have the same signs.
#[inline(always)]
fn octant<L: Lanes>(group: &Group<L>) -> Option<Octant> {
    let [x, y, z] = negative(group);
    let same = (x == 0 || x == L::ALL) && (y == 0 || y == L::ALL) && (z == 0 || z == L::ALL);
    same.then(|| Octant::new([x != 0, y != 0, z != 0]))
}

/// Flights by what comes next for them.
struct Lists {
    nodes: [u8; PLACES],
    leaves: [u8; PLACES],
    done: [u8; PLACES],
    counts: [usize; 3],
}

impl Lists {
    /// Adds a flight to its list. All three are written to and one is made longer: there is nothing to guess.
    #[inline(always)]
    fn add(&mut self, place: usize, next: Child) {
        let (node, done) = (next.is_node(), next == Child::NONE);
        let [nodes, leaves, ended] = &mut self.counts;
        let number = place as u8;
        self.nodes[*nodes % PLACES] = number;
        self.leaves[*leaves % PLACES] = number;
        self.done[*ended % PLACES] = number;
        *nodes += usize::from(node);
        *leaves += usize::from(!node & !done);
        *ended += usize::from(done);
    }
}

/// Rays that go on alone.
pub(super) struct Pool {
    flights: [Flight; PLACES],
    /// For one that enters an instance.
    pub inner: Flight,
    lists: Lists,
    free: [u8; PLACES],
    free_count: usize,
}

impl Pool {
    fn new() -> Box<Pool> {
        let mut free = [0; PLACES];
        for (i, place) in free.iter_mut().enumerate() {
            *place = i as u8;
        }
        let flights = [const { Flight::IDLE }; PLACES];
        let lists = Lists { nodes: [0; PLACES], leaves: [0; PLACES], done: [0; PLACES], counts: [0; 3] };
        Box::new(Pool { flights, inner: Flight::IDLE, lists, free, free_count: FLIGHTS })
    }

    #[inline(always)]
    pub fn flight(&mut self, place: usize) -> &mut Flight {
        &mut self.flights[place % PLACES]
    }

    /// A place for a flight that is about to begin.
    #[inline(always)]
    pub fn begin(&mut self, line: Line, course: Course, best: Hit) -> usize {
        self.free_count -= 1;
        let place = self.free[self.free_count % PLACES] as usize;
        self.flight(place).begin(line, course, best);
        place
    }

    /// Lets it go.
    #[inline(always)]
    pub fn go<S: Simd>(&mut self, tree: &Tree, place: usize) {
        let next = self.flight(place).next();
        tree.prefetch::<S>(next);
        self.lists.add(place, next);
    }

    /// Goes on until so many places are free, at most [`FLIGHTS`].
    #[inline(always)]
    pub fn make_room<S: Simd, O: Outcome>(&mut self, room: usize, tree: &Tree, outcome: &mut O) {
        let Pool { flights, inner, lists, free, free_count } = self;
        while *free_count < room {
            for i in 0..std::mem::take(&mut lists.counts[0]) {
                let place = lists.nodes[i % PLACES] as usize % PLACES;
                let flight = &mut flights[place];
                flight.open::<S>(&tree.nodes[flight.next().index()]);
                tree.prefetch::<S>(flight.next());
                lists.add(place, flight.next());
            }
            for i in 0..std::mem::take(&mut lists.counts[1]) {
                let place = lists.leaves[i % PLACES] as usize % PLACES;
                let flight = &mut flights[place];
                if flight.meet::<S>(tree, &mut Nested { flight: inner, any: O::ANY }) {
                    if O::ANY { flight.stop() } else { flight.prune::<S>() }
                }
                tree.prefetch::<S>(flight.next());
                lists.add(place, flight.next());
            }
            for i in 0..std::mem::take(&mut lists.counts[2]) {
                let place = lists.done[i % PLACES];
                let flight = &flights[place as usize % PLACES];
                outcome.take(flight.course.number as usize, &flight.best, flight.best.id != Id::NONE);
                free[*free_count % PLACES] = place;
                *free_count += 1;
            }
        }
    }
}

/// Traces rays.
#[inline(always)]
pub(super) fn trace<S: Simd, O: Outcome>(
    geometry: &Geometry,
    rays: RayView<'_>,
    scratch: &mut Scratch,
    outcome: &mut O,
) {
    let Scratch { trail, pool, queues } = scratch;
    let tree = &geometry.tree;
    let planes = !geometry.planes.is_empty();
    let mut source = Source { rays, tree, queues, full: 0, seen: 0, row_end: 0, gate: tree.root, planes };
    while let Some(group) = source.next::<S::Wide, S, O>(outcome) {
        let mut packet = Packet::<S::Wide, S>::new::<O>(&group, rays.t_min);
        packet.planes::<O>(&geometry.planes);
        packet.walk::<O>(tree, source.gate, trail);
        packet.disperse(rays, tree, trail, pool, outcome);
    }
    pool.make_room::<S, O>(FLIGHTS, tree, outcome);
}
