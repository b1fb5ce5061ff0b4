//! Rays that go the same way, eight or sixteen at a time through the hierarchy: a box or a primitive is loaded once for
//! all of them. What they meet is what they would meet alone, to the last bit.

use glam::Vec3;

use super::bvh::{Aabb, Child, Kind, Node, Octant, Sides};
use super::kernel::{self, Crossing, Inverse, Plain, Shear, Slab};
use super::rays::{Hits, RayView, group, group_bits, put, put_group};
use super::simd::{Lanes, Simd, Vec3s};
use super::traverse::{Course, Flight, Nested, STACK, SphereBlock, Tree, TriangleBlock};
use super::{Hit, Id, PlaneShape};

/// So few rays go on one by one: alone they test eight boxes in the time in which a packet tests one or two.
const FEW: u32 = 1;

/// So few rays meet the triangles of a leaf one by one, eight triangles at a time.
const SOME: u32 = 5;

/// Where a packet goes on later: children, each as its node and its slot there, where the packet's hull enters them, and
/// which rays may.
pub(super) struct Stack {
    near: [f32; STACK],
    places: [u32; STACK],
    masks: [u32; STACK],
}

/// A stack without entries.
pub(super) fn stack() -> Box<Stack> {
    Box::new(Stack { near: [0.0; STACK], places: [0; STACK], masks: [0; STACK] })
}

/// Rays and the best that each has met so far.
pub(super) struct Packet<'a, L> {
    rays: RayView<'a>,
    /// The first of them.
    start: usize,
    any: bool,
    origin: Vec3s<L>,
    direction: Vec3s<L>,
    t_min: L,
    /// Rays that are still looking: with `any`, a ray stops at the first hit.
    alive: u32,
    /// Rays that start at a primitive and must not meet it.
    leaving: u32,
    skip: Names<L>,
    t: L,
    u: L,
    v: L,
    ids: Names<L>,
}

/// An [`Id`] in each lane, as bits.
#[derive(Clone, Copy)]
struct Names<L> {
    object: L,
    index: L,
}

impl<L: Lanes> Names<L> {
    #[inline(always)]
    fn splat(id: Id) -> Self {
        Names { object: L::splat(f32::from_bits(id.object)), index: L::splat(f32::from_bits(id.index)) }
    }

    /// Lanes that hold the same name.
    #[inline(always)]
    fn same(self, other: Self) -> u32 {
        self.object.same_bits(other.object) & self.index.same_bits(other.index)
    }

    #[inline(always)]
    fn select(mask: u32, yes: Self, no: Self) -> Self {
        Names { object: L::select(mask, yes.object, no.object), index: L::select(mask, yes.index, no.index) }
    }
}

/// Which rays of a packet go where, as masks.
pub(super) struct Heading {
    /// By axis: down it.
    negative: [u32; 3],
    /// Mostly along the first axis, and mostly along the second.
    longest: [u32; 2],
}

/// What a packet that goes one way needs besides: directions of the same signs, and the same dominant axis.
pub(super) struct Way<L, S> {
    slab: Slab<L>,
    shear: Shear<L>,
    turned: [usize; 3],
    sides: Sides,
    octant: Octant,
    hull: Hull<S>,
}

/// A ray that enters boxes no later and leaves them no earlier than any of the packet: intervals of origins and directions
/// in place of numbers ([Boulos, Wald, Shirley 2006] "Geometric and Arithmetic Culling Methods for Entire Ray Packets").
struct Hull<S> {
    enter: (Vec3s<S>, Vec3s<S>),
    leave: (Vec3s<S>, Vec3s<S>),
}

impl<'a, L: Lanes> Packet<'a, L> {
    /// The rays from `start` on. Past the end there are rays that look for nothing, and go where the last one goes, so
    /// that the packet stays as coherent as it is.
    #[inline(always)]
    pub fn new(rays: RayView<'a>, start: usize, any: bool) -> Self {
        let (zero, t) = (L::splat(0.0), group(rays.t_max, start, -1.0));
        let (object, index) = (&rays.skip.object, &rays.skip.index);
        let skip = Names { object: group_bits(object, start, u32::MAX), index: group_bits(index, start, u32::MAX) };
        let none = Names::splat(Id::NONE);
        Packet {
            rays,
            start,
            any,
            origin: rays.origin.group(start),
            direction: rays.direction.group(start),
            t_min: L::splat(rays.t_min),
            alive: zero.le(t),
            leaving: L::ALL & !skip.same(none),
            skip,
            t,
            u: zero,
            v: zero,
            ids: none,
        }
    }

    /// Whether no ray of the packet looks for anything.
    #[inline(always)]
    pub fn is_dead(&self) -> bool {
        self.alive == 0
    }

    /// Writes what the rays have met.
    #[inline(always)]
    pub fn store(&self, hits: &mut Hits) {
        put_group(self.t, &mut hits.t[self.start..]);
        put_group(self.u, &mut hits.u[self.start..]);
        put_group(self.v, &mut hits.v[self.start..]);
        put(self.ids.object.store_bits().as_ref(), &mut hits.id.object[self.start..]);
        put(self.ids.index.store_bits().as_ref(), &mut hits.id.index[self.start..]);
    }

    /// Writes which rays have met anything, or have not looked.
    #[inline(always)]
    pub fn store_blocked(&self, blocked: &mut [bool]) {
        for (i, blocked) in blocked[self.start..].iter_mut().take(L::COUNT).enumerate() {
            *blocked = self.alive >> i & 1 == 0;
        }
    }

    /// Leaves the rays that look for something to whoever traces them one by one.
    #[inline(always)]
    pub fn scatter(&self, heading: &Heading, scattered: &mut Vec<(u32, Course)>) {
        let (first, second) = (heading.longest[0], heading.longest[1]);
        let inverse = Inverse::new(self.direction);
        let Vec3s { x, y, z } = self.direction;
        let longest = L::select(first, x, L::select(second, y, z));
        let i = L::select(first, y, L::select(second, z, x)).div(longest).store();
        let j = L::select(first, z, L::select(second, x, y)).div(longest).store();
        let scale = L::splat(1.0).div(longest).store();
        let ([ex, ey, ez], [lx, ly, lz]) = (inverse.enter.store(), inverse.leave.store());
        let (i, j, scale, ex, ey, ez) = (i.as_ref(), j.as_ref(), scale.as_ref(), ex.as_ref(), ey.as_ref(), ez.as_ref());
        let (lx, ly, lz) = (lx.as_ref(), ly.as_ref(), lz.as_ref());
        let [sx, sy, sz] = heading.negative;
        let mut rest = self.alive;
        while rest != 0 {
            let k = rest.trailing_zeros() as usize % L::COUNT;
            rest &= rest - 1;
            let course = Course {
                enter: [ex[k], ey[k], ez[k]],
                leave: [lx[k], ly[k], lz[k]],
                slope: [i[k], j[k]],
                scale: scale[k],
                octant: Octant((sx >> k & 1) | (sy >> k & 1) << 1 | (sz >> k & 1) << 2),
                dominant: 2 - 2 * (first >> k & 1) - (second >> k & 1),
            };
            scattered.push(((self.start + k) as u32, course));
        }
    }

    /// What ray `i` has met.
    #[inline(always)]
    fn hit(&self, i: usize) -> Hit {
        let (object, index) = (self.ids.object.store_bits(), self.ids.index.store_bits());
        let (t, u, v) = (self.t.store(), self.u.store(), self.v.store());
        let id = Id { object: object.as_ref()[i], index: index.as_ref()[i] };
        Hit { t: t.as_ref()[i], u: u.as_ref()[i], v: v.as_ref()[i], id, time: None }
    }

    /// Which way each ray goes.
    #[inline(always)]
    pub fn heading(&self) -> Heading {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let Vec3s { x, y, z } = self.direction;
        // A zero has a sign too.
        let negative = [one.copysign(x).lt(zero), one.copysign(y).lt(zero), one.copysign(z).lt(zero)];
        let (x, y, z) = (x.max(zero.sub(x)), y.max(zero.sub(y)), z.max(zero.sub(z)));
        let first = y.le(x) & z.le(x);
        Heading { negative, longest: [first, z.le(y) & !first] }
    }

    /// `None` if the rays do not go one way.
    #[inline(always)]
    pub fn way<S: Simd>(&self, heading: &Heading) -> Option<Way<L, S>> {
        let [x, y, z] = heading.negative;
        let dominant = match heading.longest {
            [first, 0] if first == L::ALL => 0,
            [0, second] if second == L::ALL => 1,
            [0, 0] => 2,
            _ => return None,
        };
        if (x != 0 && x != L::ALL) || (y != 0 && y != L::ALL) || (z != 0 && z != L::ALL) {
            return None;
        }
        let inverse = Inverse::new(self.direction);
        let turned = kernel::turned(dominant);
        let (origin, direction) = (self.origin.turned(turned), self.direction.turned(turned));
        let slope = (direction.x.div(direction.z), direction.y.div(direction.z));
        let scale = L::splat(1.0).div(direction.z);
        let negative = [x != 0, y != 0, z != 0];
        let octant = Octant::new(negative);
        Some(Way {
            shear: Shear { origin, slope, scale, t_min: self.t_min },
            turned,
            sides: octant.sides(),
            octant,
            hull: Hull::around(self.origin, &inverse, negative),
            slab: Slab { origin: self.origin, inverse },
        })
    }

    /// Goes through the tree, nearest boxes first.
    #[inline(always)]
    pub fn walk<S: Simd>(
        &mut self,
        tree: &Tree,
        way: &Way<L, S>,
        stack: &mut Stack,
        [flight, inner]: [&mut Flight; 2],
    ) {
        let root = tree.root;
        if !root.is_node() {
            if root != Child::NONE {
                self.leaf::<S>(tree, root, way, self.alive, L::splat(0.0), [flight, inner]);
            }
            return;
        }
        let mut farthest = self.t.most();
        let mut top = way.open(tree, root.index(), self.alive, farthest, stack, 0);
        while top > 0 {
            top -= 1;
            let (place, mask) = (stack.places[top], stack.masks[top] & self.alive);
            if mask == 0 || stack.near[top] > farthest {
                continue;
            }
            let (node, slot) = (&tree.nodes[place as usize >> 3], place as usize & 7);
            let (enter, leave) = way.enter(node, slot);
            let active = mask & enter.le(leave.min(self.t));
            if active == 0 {
                continue;
            }
            let child = node.child(slot);
            if active.count_ones() <= FEW {
                self.alone::<S>(tree, child, active, enter, [&mut *flight, &mut *inner]);
            } else if child.is_node() {
                top = way.open(tree, child.index(), active, farthest, stack, top);
                continue;
            } else {
                self.leaf::<S>(tree, child, way, active, enter, [&mut *flight, &mut *inner]);
            }
            if self.any {
                if self.alive == 0 {
                    return;
                }
            } else {
                farthest = self.t.most();
            }
        }
    }

    /// Meets what is in a leaf that the `active` rays enter at `near`.
    #[inline(always)]
    fn leaf<S: Simd>(
        &mut self,
        tree: &Tree,
        child: Child,
        way: &Way<L, S>,
        active: u32,
        near: L,
        flights: [&mut Flight; 2],
    ) {
        match child.kind() {
            Kind::Triangles if active.count_ones() <= SOME => {
                self.triangles_alone(&tree.triangles[child.index()], way, active, near);
            }
            Kind::Triangles => self.triangles(&tree.triangles[child.index()], way, active, near),
            Kind::Spheres => self.spheres(&tree.spheres[child.index()], u32::MAX, active, near),
            Kind::Instance | Kind::Analytic => self.alone::<S>(tree, child, active, near, flights),
        }
    }

    #[inline(always)]
    fn triangles<S>(&mut self, block: &TriangleBlock, way: &Way<L, S>, active: u32, near: L) {
        let [i, j, k] = [way.turned[0] % 3, way.turned[1] % 3, way.turned[2] % 3];
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
            if let Some(crossing) = kernel::triangle(&way.shear, corners, near, self.t) {
                self.improve(crossing, active, id);
            }
        }
    }

    /// The same, ray by ray with eight triangles at a time.
    #[inline(always)]
    fn triangles_alone<S: Simd>(&mut self, block: &TriangleBlock, way: &Way<L, S>, active: u32, near: L) {
        let Shear { origin, slope, scale, .. } = way.shear;
        let (near, scale, t) = (near.store(), scale.store(), self.t.store());
        let ([x, y, z], i, j) = (origin.store(), slope.0.store(), slope.1.store());
        let t_min = S::splat(self.rays.t_min);
        let mut rest = active;
        while rest != 0 {
            let k = rest.trailing_zeros() as usize % L::COUNT;
            rest &= rest - 1;
            let shear = Shear {
                origin: Vec3s::of([x.as_ref()[k], y.as_ref()[k], z.as_ref()[k]]),
                slope: (S::splat(i.as_ref()[k]), S::splat(j.as_ref()[k])),
                scale: S::splat(scale.as_ref()[k]),
                t_min,
            };
            let skip = if self.leaving >> k & 1 != 0 { self.rays.skip.get(self.start + k) } else { Id::NONE };
            let t = t.as_ref()[k];
            let Some(crossing) = block.cross(&shear, way.turned, near.as_ref()[k], t) else { continue };
            let mut hit = self.hit(k);
            let known = hit.id;
            crossing.improve(&mut hit, &block.ids, skip);
            if hit.id == known {
            } else if self.any {
                self.alive &= !(1 << k);
            } else {
                self.set(1 << k, [L::splat(hit.t), L::splat(hit.u), L::splat(hit.v)], hit.id);
            }
        }
    }

    /// Meets the spheres of a block that are in the mask `slots`.
    #[inline(always)]
    pub fn spheres(&mut self, block: &SphereBlock, slots: u32, active: u32, near: L) {
        let plain = Plain { origin: self.origin, direction: self.direction, t_min: self.t_min };
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
                self.improve(crossing, active, id);
            }
        }
    }

    /// Sends the `active` rays on without the others.
    #[inline(always)]
    fn alone<S: Simd>(&mut self, tree: &Tree, child: Child, active: u32, near: L, [flight, inner]: [&mut Flight; 2]) {
        let near = near.store();
        let mut rest = active & self.alive;
        while rest != 0 {
            let i = rest.trailing_zeros() as usize % L::COUNT;
            rest &= rest - 1;
            let known = self.hit(i);
            let ray = self.rays.get(self.start + i);
            flight.begin(ray, Course::new::<S>(ray.direction), (near.as_ref()[i], child), known);
            flight.fly::<S>(tree, self.any, &mut Nested { flight: &mut *inner, any: self.any });
            let hit = flight.best;
            if hit.id == known.id {
            } else if self.any {
                self.alive &= !(1 << i);
            } else {
                self.set(1 << i, [L::splat(hit.t), L::splat(hit.u), L::splat(hit.v)], hit.id);
            }
        }
    }

    /// The infinite planes.
    #[inline(always)]
    pub fn planes(&mut self, planes: &[PlaneShape]) {
        for plane in planes {
            let offset = Vec3s::splat(plane.point).sub(self.origin);
            let normal = Vec3s::splat(plane.normal);
            let t = offset.dot(normal).div(self.direction.dot(normal));
            let mask = self.t_min.lt(t) & t.le(self.t);
            let zero = L::splat(0.0);
            self.improve(Crossing { mask, t, u: zero, v: zero }, self.alive, plane.id());
        }
    }

    /// Keeps the better hit of every ray that met this primitive.
    #[inline(always)]
    fn improve(&mut self, crossing: Crossing<L>, active: u32, id: Id) {
        let mut mask = crossing.mask & active & self.alive;
        if mask == 0 {
            return;
        }
        if mask & self.leaving != 0 {
            mask &= !self.skip.same(Names::splat(id));
        }
        if self.any {
            self.alive &= !mask;
            return;
        }
        // Rays that have met a better one just as far away.
        let mut tied = mask & !crossing.t.lt(self.t);
        while tied != 0 {
            let i = tied.trailing_zeros() as usize % L::COUNT;
            tied &= tied - 1;
            if !id.precedes(self.hit(i).id) {
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
}

impl<S: Simd> Hull<S> {
    /// With directions of positive sign a box is entered the earliest by the origin that lies farthest and the smallest
    /// inverse, unless it lies behind, where all is cut off at 0; it is left the latest by the opposite.
    #[inline(always)]
    fn around<L: Lanes>(origin: Vec3s<L>, inverse: &Inverse<L>, negative: [bool; 3]) -> Self {
        let (origins, enter, leave) = (Aabb::of(origin), Aabb::of(inverse.enter), Aabb::of(inverse.leave));
        let negative = glam::BVec3::from_array(negative);
        let pick = |positive: Vec3, other: Vec3| Vec3::select(negative, other, positive);
        let (last, first) = (pick(origins.max, origins.min), pick(origins.min, origins.max));
        Hull {
            enter: (Vec3s::splat(last), Vec3s::splat(pick(enter.min, enter.max))),
            leave: (Vec3s::splat(first), Vec3s::splat(pick(leave.max, leave.min))),
        }
    }
}

impl Aabb {
    /// The box around a point in each lane.
    #[inline(always)]
    fn of<L: Lanes>(points: Vec3s<L>) -> Self {
        let Vec3s { x, y, z } = points;
        Aabb { min: Vec3::new(x.least(), y.least(), z.least()), max: Vec3::new(x.most(), y.most(), z.most()) }
    }
}

impl<L: Lanes, S: Simd> Way<L, S> {
    /// Puts the children of a node that the hull enters on the stack, and returns the new top.
    #[inline(always)]
    fn open(&self, tree: &Tree, node: usize, active: u32, farthest: f32, stack: &mut Stack, top: usize) -> usize {
        let at = (node as u32) << 3;
        let node = &tree.nodes[node];
        let near = node.near(self.sides).sub(self.hull.enter.0).mul(self.hull.enter.1);
        let far = node.far(self.sides).sub(self.hull.leave.0).mul(self.hull.leave.1);
        let enter = near.x.max(near.y).max(near.z.max(S::splat(0.0)));
        let leave = far.x.min(far.y).min(far.z);
        let room = (
            stack.near[top..].first_chunk_mut(),
            stack.places[top..].first_chunk_mut(),
            stack.masks[top..].first_chunk_mut::<8>(),
        );
        let (Some(near), Some(places), Some(masks)) = room else { unreachable!("the stack has room for eight more") };
        *masks = [active; 8];
        let slots = [at, at | 1, at | 2, at | 3, at | 4, at | 5, at | 6, at | 7];
        let limit = leave.min(S::splat(farthest));
        top + enter.pack(limit, &node.order, self.octant.shift(), &slots, near, places)
    }

    /// Where the rays enter and leave one child of a node.
    #[inline(always)]
    fn enter(&self, node: &Node, slot: usize) -> (L, L) {
        let (sides, [x, y, z]) =
            (&node.sides, [self.sides.0[0] as usize, self.sides.0[1] as usize, self.sides.0[2] as usize]);
        let near = Vec3s::of([sides[x][slot], sides[y][slot], sides[z][slot]]);
        let far = Vec3s::of([sides[x ^ 1][slot], sides[y ^ 1][slot], sides[z ^ 1][slot]]);
        kernel::slab(near, far, &self.slab)
    }
}
