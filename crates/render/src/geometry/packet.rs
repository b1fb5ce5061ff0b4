//! Rays that go the same way, eight or sixteen at a time through the hierarchy: a box or a primitive is loaded once for
//! all of them. What they meet is what they would meet alone, to the last bit.
//!
//! The same way means directions of the same signs. Where only few rays of a packet enter a node, those look into it
//! alone: the packet keeps a list of that, and in the end hands it over ([`Packet::disperse`]).

use super::bvh::{Child, Kind, Node, Octant};
use super::hull::{Hull, Span};
use super::kernel::{self, Crossing, Inverse, Plain, Shear, Slab};
use super::rays::{Group, Hits, MOST, Names, RayView, put, put_group};
use super::simd::{Lanes, Simd, Vec3s};
use super::stream::{Outcome, Pool};
use super::traverse::{Course, Line, STACK, SphereBlock, Tree, TriangleBlock};
use super::{Hit, Id, PlaneShape};

/// So few rays look into a node alone. Neighbours stay together to the last; where rays have been gathered from here and
/// there, they soon part in any case, and alone each knows how far it has to look.
const FEW_OF_ROW: u32 = 1;
const FEW_FOR_ANY: u32 = 6;
const FEW: u32 = 8;

/// So few rays meet the triangles of a leaf one by one, eight triangles at a time.
const SOME: u32 = 4;

/// Most entries that a packet leaves to its rays.
pub(super) const LEFT: usize = 64;

/// Where a packet has still to go: children, the rays that enter each, and where.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(super) struct Trail {
    near: [[f32; MOST]; STACK + LEFT],
    children: [Child; STACK + LEFT],
    masks: [u32; STACK + LEFT],
    /// How many of the first are for the packet: a stack.
    stack: usize,
    /// How many from [`STACK`] on are for each ray alone.
    left: usize,
}

impl Trail {
    pub const EMPTY: Trail = Trail {
        near: [[0.0; MOST]; STACK + LEFT],
        children: [Child::NONE; STACK + LEFT],
        masks: [0; STACK + LEFT],
        stack: 0,
        left: 0,
    };

    /// Keeps what some rays enter: for the packet, or for each of them if they are few.
    #[inline(always)]
    fn keep<L: Lanes>(&mut self, child: Child, mask: u32, near: L, few: u32) {
        let alone = if child.is_node() { mask.count_ones() <= few } else { child.kind().is_alone() };
        let at = if alone { STACK + self.left } else { self.stack };
        put_group(near, &mut self.near[at]);
        (self.children[at], self.masks[at]) = (child, mask);
        let any = mask != 0;
        self.stack += usize::from(any & !alone);
        self.left += usize::from(any & alone);
    }

    /// Where the children are, from those that come last to those that come first.
    #[inline(always)]
    fn all(&self) -> impl Iterator<Item = usize> + use<> {
        (0..self.stack).chain(STACK..STACK + self.left)
    }
}

/// Rays and the best that each has met so far.
#[derive(Clone, Copy)]
pub(super) struct Packet<L, S> {
    /// Which of the caller's rays they are.
    numbers: [u32; MOST],
    /// Whether they follow each other.
    is_row: bool,
    /// Lanes that there are rays in.
    all: u32,
    /// So few rays look into a node alone.
    few: u32,
    slab: Slab<L>,
    direction: Vec3s<L>,
    /// How far each ray goes along the axes that are not dominant while it goes 1 along that; see [`Shear`].
    slope: (L, L),
    scale: L,
    t_min: f32,
    hull: Hull<S>,
    /// Rays whose dominant axis is the first, and the second.
    longest: [u32; 2],
    /// That of all, where they have the same.
    turned: Option<[usize; 3]>,
    /// Whether [`Packet::aim`] has been done.
    is_aimed: bool,
    /// Rays that are still looking: where anything will do, a ray stops at the first hit.
    alive: u32,
    /// Rays that start at a primitive and must not meet it.
    leaving: u32,
    skip: Names<L>,
    t: L,
    u: L,
    v: L,
    ids: Names<L>,
}

/// What rays have met, to be looked at one by one.
struct LaneHits<L: Lanes> {
    t: L::Floats,
    u: L::Floats,
    v: L::Floats,
    object: L::Bits,
    index: L::Bits,
}

impl<L: Lanes> LaneHits<L> {
    /// That of lane `k`. Where anything will do, nothing has been met yet.
    #[inline(always)]
    fn get<O: Outcome>(&self, k: usize) -> Hit {
        let t = self.t.as_ref()[k];
        if O::ANY {
            return Hit { t, ..Hit::NONE };
        }
        let id = Id { object: self.object.as_ref()[k], index: self.index.as_ref()[k] };
        Hit { t, u: self.u.as_ref()[k], v: self.v.as_ref()[k], id, time: None }
    }
}

impl<L: Lanes, S: Simd> Packet<L, S> {
    /// Rays whose directions have the same signs. What the hull does not need is left to [`Packet::aim`].
    #[inline(always)]
    pub fn new<O: Outcome>(group: &Group<L>, t_min: f32) -> Self {
        let (zero, none) = (L::splat(0.0), Names::splat(Id::NONE));
        let &Group { origin, direction, t_max: t, skip, is_row, .. } = group;
        let all = L::ALL >> (L::COUNT - group.count);
        let mut numbers = [0; MOST];
        put(group.numbers.store_bits().as_ref(), &mut numbers);
        let Vec3s { x, y, z } = direction;
        let one = L::splat(1.0);
        // A zero has a sign too.
        let (nx, ny, nz) = (one.copysign(x).lt(zero), one.copysign(y).lt(zero), one.copysign(z).lt(zero));
        let octant = Octant::new([nx & 1 != 0, ny & 1 != 0, nz & 1 != 0]);
        Packet {
            numbers,
            is_row,
            all,
            few: if is_row {
                FEW_OF_ROW
            } else if O::ANY {
                FEW_FOR_ANY
            } else {
                FEW
            },
            hull: Hull::around(&Span::of(group, octant)),
            slab: Slab { origin, inverse: Inverse { enter: direction, leave: direction } },
            direction,
            slope: (zero, zero),
            scale: zero,
            t_min,
            longest: [0; 2],
            turned: None,
            is_aimed: false,
            alive: zero.le(t) & all,
            leaving: all & !skip.same(none),
            skip,
            t,
            u: zero,
            v: zero,
            ids: none,
        }
    }

    /// Works out what boxes and triangles need to know of directions.
    #[inline(always)]
    fn aim(&mut self) {
        let (Vec3s { x, y, z }, all, zero) = (self.direction, self.all, L::splat(0.0));
        let size = Vec3s { x: x.max(zero.sub(x)), y: y.max(zero.sub(y)), z: z.max(zero.sub(z)) };
        let first = size.y.le(size.x) & size.z.le(size.x);
        let second = size.z.le(size.y) & !first;
        let longest = L::select(first, x, L::select(second, y, z));
        let i = L::select(first, y, L::select(second, z, x)).div(longest);
        let j = L::select(first, z, L::select(second, x, y)).div(longest);
        self.turned = match [first & all, second & all] {
            [first, 0] if first == all => Some(kernel::turned(0)),
            [0, second] if second == all => Some(kernel::turned(1)),
            [0, 0] => Some(kernel::turned(2)),
            _ => None,
        };
        (self.slope, self.scale, self.longest) = ((i, j), L::splat(1.0).div(longest), [first, second]);
        self.slab.inverse = Inverse::new(self.direction);
        self.is_aimed = true;
    }

    /// The dominant axis of ray `k`.
    #[inline(always)]
    fn dominant(&self, k: usize) -> u32 {
        2 - 2 * (self.longest[0] >> k & 1) - (self.longest[1] >> k & 1)
    }

    /// What the rays have met.
    #[inline(always)]
    fn hits(&self) -> LaneHits<L> {
        let Names { object, index } = self.ids;
        let (t, u, v) = (self.t.store(), self.u.store(), self.v.store());
        LaneHits { t, u, v, object: object.store_bits(), index: index.store_bits() }
    }

    /// Whether no ray of the packet looks for anything.
    #[inline(always)]
    pub fn is_dead(&self) -> bool {
        self.alive == 0
    }

    /// Goes through the tree below a gate, nearest boxes first.
    #[inline(always)]
    pub fn walk<O: Outcome>(&mut self, tree: &Tree, gate: Child, trail: &mut Trail) {
        (trail.stack, trail.left) = (0, 0);
        if gate != Child::NONE {
            trail.keep(gate, self.alive, L::splat(0.0), self.few);
        }
        if self.alive.count_ones() <= self.few || !gate.is_node() {
            self.aim();
        }
        // Few rays go on alone, and so do all where there is no room for what is left to them.
        while trail.stack > 0 && trail.left <= LEFT - 9 && self.alive.count_ones() > self.few {
            let top = trail.stack - 1;
            trail.stack = top;
            let near = L::load(&trail.near[top]);
            let active = trail.masks[top] & self.alive & near.le(self.t);
            if active == 0 {
                continue;
            }
            let child = trail.children[top];
            if child.is_node() {
                let node = &tree.nodes[child.index()];
                let (slots, count) = self.hull.enters(node);
                if count == 0 {
                    continue;
                }
                if !self.is_aimed {
                    self.aim();
                }
                self.open::<O>(tree, trail, node, &slots[..count.min(8)], active);
            } else {
                self.meet::<O>(tree, child, active, near);
            }
        }
    }

    /// Keeps those of some children of a node that any of the `active` rays enters.
    #[inline(always)]
    fn open<O: Outcome>(&self, tree: &Tree, trail: &mut Trail, node: &Node, slots: &[u32], active: u32) {
        for &slot in slots {
            let slot = slot as usize & 7;
            let child = node.child(slot);
            let (enter, leave) = self.enter(node, slot);
            let mask = active & enter.le(leave.min(self.t));
            // Shadows meet many boxes in vain: guessing would cost more than it saves.
            if !O::ANY && mask == 0 {
                continue;
            }
            tree.prefetch::<S>(child);
            trail.keep(child, mask, enter, self.few);
        }
    }

    /// Where the rays enter and leave one child of a node.
    #[inline(always)]
    fn enter(&self, node: &Node, slot: usize) -> (L, L) {
        let (sides, [x, y, z]) = (&node.sides, self.hull.sides.0);
        let (x, y, z) = (x as usize, y as usize, z as usize);
        let near = Vec3s::of([sides[x][slot], sides[y][slot], sides[z][slot]]);
        let far = Vec3s::of([sides[x ^ 1][slot], sides[y ^ 1][slot], sides[z ^ 1][slot]]);
        kernel::slab(near, far, &self.slab)
    }

    /// Meets what is in a leaf that the `active` rays enter at `near`.
    #[inline(always)]
    fn meet<O: Outcome>(&mut self, tree: &Tree, child: Child, active: u32, near: L) {
        match (child.kind(), self.turned) {
            (Kind::Triangles, Some(turned)) if active.count_ones() > SOME => {
                self.triangles::<O>(&tree.triangles[child.index()], turned, active, near);
            }
            (Kind::Triangles, _) => self.triangles_alone::<O>(&tree.triangles[child.index()], active, near),
            (Kind::Spheres, _) => self.spheres::<O>(&tree.spheres[child.index()], u32::MAX, active, near),
            (Kind::Instance | Kind::Analytic, _) => unreachable!("rays go there alone"),
        }
    }

    #[inline(always)]
    fn triangles<O: Outcome>(&mut self, block: &TriangleBlock, turned: [usize; 3], active: u32, near: L) {
        let (origin, t_min) = (self.slab.origin.turned(turned), L::splat(self.t_min));
        let shear = Shear { origin, slope: self.slope, scale: self.scale, t_min };
        let [i, j, k] = [turned[0] % 3, turned[1] % 3, turned[2] % 3];
        for (slot, &id) in block.ids.iter().enumerate() {
            if id == Id::NONE {
                break;
            }
            let [a, b, c] = &block.vertices;
            let corners = [
                Vec3s::of([a[i][slot], a[j][slot], a[k][slot]]),
                Vec3s::of([b[i][slot], b[j][slot], b[k][slot]]),
                Vec3s::of([c[i][slot], c[j][slot], c[k][slot]]),
            ];
            if let Some(crossing) = kernel::triangle::<L, true>(&shear, corners, near, self.t) {
                self.improve::<O>(crossing, active, id);
            }
        }
    }

    /// The same, ray by ray with eight triangles at a time.
    #[inline(always)]
    fn triangles_alone<O: Outcome>(&mut self, block: &TriangleBlock, active: u32, near: L) {
        let near = near.store();
        let Vec3s { x, y, z } = self.slab.origin;
        let origin = [x.store(), y.store(), z.store()];
        let (i, j, scale) = (self.slope.0.store(), self.slope.1.store(), self.scale.store());
        let (t_min, hits) = (S::splat(self.t_min), self.hits());
        let mut rest = active;
        while rest != 0 {
            let k = rest.trailing_zeros() as usize % L::COUNT;
            rest &= rest - 1;
            let turned = kernel::turned(self.dominant(k) as usize);
            let shear = Shear {
                origin: Vec3s::of([
                    origin[turned[0] % 3].as_ref()[k],
                    origin[turned[1] % 3].as_ref()[k],
                    origin[turned[2] % 3].as_ref()[k],
                ]),
                slope: (S::splat(i.as_ref()[k]), S::splat(j.as_ref()[k])),
                scale: S::splat(scale.as_ref()[k]),
                t_min,
            };
            let mut hit = hits.get::<O>(k);
            let Some(crossing) = block.cross(&shear, turned, near.as_ref()[k], hit.t) else { continue };
            let skip = if self.leaving >> k & 1 != 0 { self.skip.get(k) } else { Id::NONE };
            let known = hit.id;
            crossing.improve(&mut hit, &block.ids, skip);
            if hit.id == known {
            } else if O::ANY {
                self.alive &= !(1 << k);
            } else {
                self.set(1 << k, [L::splat(hit.t), L::splat(hit.u), L::splat(hit.v)], hit.id);
            }
        }
    }

    /// Meets the spheres of a block that are in the mask `slots`.
    #[inline(always)]
    pub fn spheres<O: Outcome>(&mut self, block: &SphereBlock, slots: u32, active: u32, near: L) {
        let (origin, direction) = (self.slab.origin, self.direction);
        let plain = Plain { origin, direction, t_min: L::splat(self.t_min) };
        for (slot, &id) in block.ids.iter().enumerate() {
            if id == Id::NONE {
                break;
            }
            if slots >> slot & 1 == 0 {
                continue;
            }
            let [x, y, z] = &block.centers;
            let (center, radius) = (Vec3s::of([x[slot], y[slot], z[slot]]), L::splat(block.radii[slot]));
            if let Some(crossing) = kernel::sphere(&plain, center, radius, near, self.t) {
                self.improve::<O>(crossing, active, id);
            }
        }
    }

    /// The infinite planes.
    #[inline(always)]
    pub fn planes<O: Outcome>(&mut self, planes: &[PlaneShape]) {
        for plane in planes {
            let offset = Vec3s::splat(plane.point).sub(self.slab.origin);
            let normal = Vec3s::splat(plane.normal);
            let t = offset.dot(normal).div(self.direction.dot(normal));
            let mask = L::splat(self.t_min).lt(t) & t.le(self.t);
            let zero = L::splat(0.0);
            self.improve::<O>(Crossing { mask, t, u: zero, v: zero }, self.alive, plane.id());
        }
    }

    /// Keeps the better hit of every ray that met this primitive.
    #[inline(always)]
    fn improve<O: Outcome>(&mut self, crossing: Crossing<L>, active: u32, id: Id) {
        let mut mask = crossing.mask & active & self.alive;
        if mask == 0 {
            return;
        }
        if mask & self.leaving != 0 {
            mask &= !self.skip.same(Names::splat(id));
        }
        if O::ANY {
            self.alive &= !mask;
            return;
        }
        // Rays that have met a better one just as far away.
        let mut tied = mask & !crossing.t.lt(self.t);
        while tied != 0 {
            let i = tied.trailing_zeros() as usize % L::COUNT;
            tied &= tied - 1;
            if !id.precedes(self.ids.get(i)) {
                mask &= !(1 << i);
            }
        }
        self.set(mask, [crossing.t, crossing.u, crossing.v], id);
    }

    /// What the rays of `mask` have met.
    #[inline(always)]
    fn set(&mut self, mask: u32, [t, u, v]: [L; 3], id: Id) {
        self.t = L::select(mask, t, self.t);
        self.u = L::select(mask, u, self.u);
        self.v = L::select(mask, v, self.v);
        self.ids = Names::select(mask, Names::splat(id), self.ids);
    }

    /// Hands over what the rays have met that have nothing to look into any more, and sends off the others, each alone.
    #[inline(always)]
    pub fn disperse<O: Outcome>(
        &self,
        rays: RayView<'_>,
        tree: &Tree,
        trail: &mut Trail,
        pool: &mut Pool,
        outcome: &mut O,
    ) {
        let mut going = 0;
        for at in trail.all() {
            trail.masks[at] &= self.alive & L::load(&trail.near[at]).le(self.t);
            going |= trail.masks[at];
        }
        if self.is_row {
            outcome.take_row(self.numbers[0] as usize, self);
        } else {
            let hits = self.hits();
            let mut rest = !going & self.all;
            while rest != 0 {
                let k = rest.trailing_zeros() as usize % L::COUNT;
                rest &= rest - 1;
                outcome.take(self.numbers[k] as usize, &hits.get::<O>(k), self.alive >> k & 1 == 0);
            }
        }
        if going != 0 {
            pool.make_room::<S, O>(going.count_ones() as usize, tree, outcome);
            self.send::<O>(rays, tree, trail, pool, going);
        }
    }

    /// Sends some rays off, each with what is left for it.
    #[inline(always)]
    fn send<O: Outcome>(&self, rays: RayView<'_>, tree: &Tree, trail: &Trail, pool: &mut Pool, going: u32) {
        let Slab { origin: o, inverse: Inverse { enter, leave } } = self.slab;
        let ((i, j), d) = (self.slope, self.direction);
        let lines = L::lines([
            o.x, o.y, o.z, enter.x, enter.y, enter.z, leave.x, leave.y, leave.z, i, j, self.scale, d.x, d.y, d.z,
            self.t,
        ]);
        let hits = self.hits();
        let mut places = [0; MOST];
        let mut rest = going;
        while rest != 0 {
            let k = rest.trailing_zeros() as usize % L::COUNT;
            rest &= rest - 1;
            let number = self.numbers[k];
            let course = Course {
                octant: self.hull.octant,
                dominant: self.dominant(k),
                t_min: self.t_min,
                skip: if self.leaving >> k & 1 != 0 { self.skip.get(k) } else { Id::NONE },
                time: rays.time.get(number as usize).copied(),
                number,
            };
            places[k] = pool.begin(Line(lines[k]), course, hits.get::<O>(k));
        }
        for at in trail.all() {
            let (child, near) = (trail.children[at], &trail.near[at]);
            let mut rest = trail.masks[at];
            while rest != 0 {
                let k = rest.trailing_zeros() as usize % L::COUNT;
                rest &= rest - 1;
                pool.flight(places[k]).push(near[k], child);
            }
        }
        let mut rest = going;
        while rest != 0 {
            let k = rest.trailing_zeros() as usize % L::COUNT;
            rest &= rest - 1;
            pool.go::<S>(tree, places[k]);
        }
    }

    /// Writes what consecutive rays have met.
    #[inline(always)]
    pub fn store(&self, first: usize, hits: &mut Hits) {
        put_group(self.t, &mut hits.t[first..]);
        put_group(self.u, &mut hits.u[first..]);
        put_group(self.v, &mut hits.v[first..]);
        put(self.ids.object.store_bits().as_ref(), &mut hits.id.object[first..]);
        put(self.ids.index.store_bits().as_ref(), &mut hits.id.index[first..]);
    }

    /// Writes which of consecutive rays have met anything, or have not looked.
    #[inline(always)]
    pub fn store_blocked(&self, blocked: &mut [bool]) {
        for (i, blocked) in blocked.iter_mut().take(L::COUNT).enumerate() {
            *blocked = self.alive >> i & 1 == 0;
        }
    }
}
