//! Rays that go their own ways: several are on their way at a time, so that one computes while another waits for memory.
//!
//! In every round all rays that come to a node open it, then all that come to a leaf meet what is in it, then those that
//! are done make room for others. A loop that does one thing leaves the processor nothing to guess.

use super::bvh::Child;
use super::rays::{Hits, RayView};
use super::simd::Simd;
use super::traverse::{Course, FLIGHTS, Flight, Nested, Tree};
use super::{Hit, Id};

/// Where the results go.
pub(super) trait Outcome {
    /// Whether anything that is met will do.
    const ANY: bool;
    /// What a ray has met before it begins.
    fn known(&self, ray: usize, t_max: f32) -> Hit;
    /// Takes what it has met at the end.
    fn take(&mut self, ray: usize, hit: &Hit);
}

/// The closest hits.
pub(super) struct Closest<'a>(pub &'a mut Hits);

impl Outcome for Closest<'_> {
    const ANY: bool = false;

    #[inline(always)]
    fn known(&self, ray: usize, _: f32) -> Hit {
        self.0.get(ray)
    }

    #[inline(always)]
    fn take(&mut self, ray: usize, hit: &Hit) {
        (self.0.t[ray], self.0.u[ray], self.0.v[ray]) = (hit.t, hit.u, hit.v);
        self.0.id.set(ray, hit.id);
    }
}

/// Whether there are any.
pub(super) struct Blocked<'a>(pub &'a mut [bool]);

impl Outcome for Blocked<'_> {
    const ANY: bool = true;

    #[inline(always)]
    fn known(&self, _: usize, t_max: f32) -> Hit {
        Hit { t: t_max, ..Hit::NONE }
    }

    #[inline(always)]
    fn take(&mut self, ray: usize, hit: &Hit) {
        self.0[ray] |= hit.id != Id::NONE;
    }
}

/// Numbers of flights, four bits each. (In memory each list would have to be read before the processor knows whether it is
/// just being written to, and all flights would wait for each other: half the speed.)
#[derive(Clone, Copy, Default)]
struct List {
    numbers: u64,
    count: u32,
}

impl List {
    /// Adds a number, or does not: there is nothing to guess.
    #[inline(always)]
    fn add(&mut self, number: u32, really: bool) {
        let really = u32::from(really);
        self.numbers |= u64::from(number * really) << (4 * self.count & 63);
        self.count += really;
    }

    /// Takes the first one out.
    #[inline(always)]
    fn take(&mut self) -> Option<u32> {
        self.count = self.count.checked_sub(1)?;
        let number = (self.numbers & 15) as u32;
        self.numbers >>= 4;
        Some(number)
    }
}

/// Flights by what comes next for them.
#[derive(Default)]
struct Lists {
    nodes: List,
    leaves: List,
    done: List,
}

impl Lists {
    #[inline(always)]
    fn add(&mut self, flight: u32, next: Child) {
        let (node, done) = (next.is_node(), next == Child::NONE);
        self.nodes.add(flight, node);
        self.leaves.add(flight, !node & !done);
        self.done.add(flight, done);
    }
}

/// Traces the rays of `members`.
#[inline(always)]
pub(super) fn trace<S: Simd, O: Outcome>(
    tree: &Tree,
    rays: RayView<'_>,
    members: &[(u32, Course)],
    flights: &mut [Flight; FLIGHTS],
    inner: &mut Flight,
    outcome: &mut O,
) {
    let mut lists = Lists::default();
    let (first, mut rest) = members.split_at(members.len().min(FLIGHTS));
    for (number, member) in first.iter().enumerate() {
        begin(&mut flights[number], tree, rays, member, outcome);
        lists.add(number as u32, flights[number].next());
    }
    while lists.nodes.count + lists.leaves.count + lists.done.count > 0 {
        let mut nodes = std::mem::take(&mut lists.nodes);
        while let Some(number) = nodes.take() {
            let flight = &mut flights[number as usize % FLIGHTS];
            let next = flight.open::<S>(&tree.nodes[flight.next().index()]);
            tree.prefetch::<S>(next);
            lists.add(number, next);
        }
        let mut leaves = std::mem::take(&mut lists.leaves);
        while let Some(number) = leaves.take() {
            let flight = &mut flights[number as usize % FLIGHTS];
            if flight.meet::<S>(tree, &mut Nested { flight: inner, any: O::ANY }) {
                if O::ANY { flight.stop() } else { flight.prune::<S>() }
            }
            tree.prefetch::<S>(flight.next());
            lists.add(number, flight.next());
        }
        let mut done = std::mem::take(&mut lists.done);
        while let Some(number) = done.take() {
            let flight = &mut flights[number as usize % FLIGHTS];
            outcome.take(flight.number as usize, &flight.best);
            if let Some((member, others)) = rest.split_first() {
                rest = others;
                begin(flight, tree, rays, member, outcome);
                lists.add(number, flight.next());
            }
        }
    }
}

#[inline(always)]
fn begin<O: Outcome>(flight: &mut Flight, tree: &Tree, rays: RayView<'_>, member: &(u32, Course), outcome: &O) {
    let &(number, course) = member;
    let ray = rays.get(number as usize);
    flight.begin(ray, course, (0.0, tree.root), outcome.known(number as usize, ray.t_max));
    flight.number = number;
}
