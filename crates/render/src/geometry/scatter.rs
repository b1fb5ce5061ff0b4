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

/// Flights by what comes next for them.
struct Lists {
    nodes: [u8; FLIGHTS],
    leaves: [u8; FLIGHTS],
    done: [u8; FLIGHTS],
    counts: [usize; 3],
}

impl Lists {
    /// Adds a flight to its list. All three are written to and one is made longer: there is nothing to guess.
    #[inline(always)]
    fn add(&mut self, flight: usize, next: Child) {
        let (node, done) = (next.is_node(), next == Child::NONE);
        let [nodes, leaves, ended] = &mut self.counts;
        let number = flight as u8;
        self.nodes[*nodes % FLIGHTS] = number;
        self.leaves[*leaves % FLIGHTS] = number;
        self.done[*ended % FLIGHTS] = number;
        *nodes += usize::from(node);
        *leaves += usize::from(!node & !done);
        *ended += usize::from(done);
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
    let mut lists = Lists { nodes: [0; FLIGHTS], leaves: [0; FLIGHTS], done: [0; FLIGHTS], counts: [0; 3] };
    let (first, mut rest) = members.split_at(members.len().min(FLIGHTS));
    for (i, member) in first.iter().enumerate() {
        begin(&mut flights[i], tree, rays, member, outcome);
        lists.add(i, flights[i].next());
    }
    while lists.counts != [0; 3] {
        for i in 0..std::mem::take(&mut lists.counts[0]) {
            let number = lists.nodes[i % FLIGHTS] as usize % FLIGHTS;
            let flight = &mut flights[number];
            flight.open::<S>(&tree.nodes[flight.next().index()]);
            tree.prefetch::<S>(flight.next());
            lists.add(number, flight.next());
        }
        for i in 0..std::mem::take(&mut lists.counts[1]) {
            let number = lists.leaves[i % FLIGHTS] as usize % FLIGHTS;
            let flight = &mut flights[number];
            if flight.meet::<S>(tree, &mut Nested { flight: inner, any: O::ANY }) {
                if O::ANY { flight.stop() } else { flight.prune::<S>() }
            }
            tree.prefetch::<S>(flight.next());
            lists.add(number, flight.next());
        }
        for i in 0..std::mem::take(&mut lists.counts[2]) {
            let number = lists.done[i % FLIGHTS] as usize % FLIGHTS;
            let flight = &mut flights[number];
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
