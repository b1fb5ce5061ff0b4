//! Eight rays at a time through the hierarchy, for rays that go the same way: a box or a primitive is loaded once for
//! all of them. What they meet is what they would meet alone, to the last bit.

use glam::Vec3;

use super::bvh::{Aabb, Child, Kind, Node};
use super::kernel::{self, Crossing, Lanes};
use super::rays::{GROUP as SIZE, Hits, RayView, eight};
use super::simd::{Simd, Vec3x8};
use super::traverse::{STACK, Scratch, SphereBlock, Tree, TriangleBlock};
use super::{Hit, Id, PlaneShape};

/// So few rays go on one by one: alone they test eight boxes in the time in which a packet tests one or two.
const FEW: u32 = 1;
/// All rays.
const ALL: u32 = (1 << SIZE) - 1;

/// A box that is to be entered: by which rays, and at which distance by each of them.
#[derive(Clone, Copy)]
pub(crate) struct Entry {
    child: Child,
    mask: u32,
    near: [f32; SIZE],
}

/// Where a packet goes on later.
pub(crate) type Stack = Box<[Entry; STACK]>;

/// A stack without entries.
pub(crate) fn stack() -> Stack {
    Box::new([Entry { child: Child::NONE, mask: 0, near: [0.0; SIZE] }; STACK])
}

/// Eight rays and the best that each has met so far.
pub(crate) struct Packet<'a, S, const ANY: bool> {
    rays: RayView<'a>,
    /// The first of the eight.
    start: usize,
    lanes: Lanes<S>,
    /// Rays that are still looking: with `ANY`, a ray stops at the first hit.
    alive: u32,
    /// Rays that start at a primitive and must not meet it.
    leaving: u32,
    skip: Names<S>,
    t: S,
    u: S,
    v: S,
    ids: Names<S>,
}

/// An [`Id`] in each lane, as bits.
#[derive(Clone, Copy)]
struct Names<S> {
    object: S,
    index: S,
}

impl<S: Simd> Names<S> {
    #[inline(always)]
    fn splat(id: Id) -> Self {
        Names { object: S::splat(f32::from_bits(id.object)), index: S::splat(f32::from_bits(id.index)) }
    }

    #[inline(always)]
    fn load(object: &[u32], index: &[u32], start: usize) -> Self {
        let none = u32::MAX;
        Names { object: S::load_bits(&eight(object, start, none)), index: S::load_bits(&eight(index, start, none)) }
    }

    #[inline(always)]
    fn store(self) -> [[u32; SIZE]; 2] {
        [self.object.store_bits(), self.index.store_bits()]
    }

    /// Lanes that hold the same name.
    #[inline(always)]
    fn same(self, other: Self) -> u32 {
        self.object.same_bits(other.object) & self.index.same_bits(other.index)
    }

    #[inline(always)]
    fn select(mask: u32, yes: Self, no: Self) -> Self {
        Names { object: S::select(mask, yes.object, no.object), index: S::select(mask, yes.index, no.index) }
    }
}

/// What the boxes need to know of a packet whose directions have the same signs.
struct Space<S> {
    inverse: Vec3x8<S>,
    /// Which side of a box is entered, by axis.
    sides: [usize; 3],
    hull: Hull<S>,
}

/// A ray, eight times over, that enters boxes no later and leaves them no earlier than any of the packet: intervals of
/// origins and directions in place of numbers ([Boulos, Wald, Shirley 2006] "Geometric and Arithmetic Culling Methods
/// for Entire Ray Packets").
struct Hull<S> {
    near_origin: Vec3x8<S>,
    near_inverse: Vec3x8<S>,
    far_origin: Vec3x8<S>,
    far_inverse: Vec3x8<S>,
}

impl<'a, S: Simd, const ANY: bool> Packet<'a, S, ANY> {
    /// The eight rays from `start` on. Past the end there are rays that look for nothing, and go where the last one
    /// goes, so that the packet stays as coherent as it is.
    #[inline(always)]
    pub fn new(rays: RayView<'a>, start: usize) -> Self {
        let (zero, t) = (S::splat(0.0), S::load(&eight(rays.t_max, start, -1.0)));
        let (origin, direction) = (rays.origin.group(start), rays.direction.group(start));
        let lanes = Lanes { origin, direction, t_min: S::splat(rays.t_min) };
        let (skip, none) = (Names::load(&rays.skip.object, &rays.skip.index, start), Names::splat(Id::NONE));
        let (alive, leaving) = (zero.le(t), ALL & !skip.same(none));
        Packet { rays, start, lanes, alive, leaving, skip, t, u: zero, v: zero, ids: none }
    }

    /// Whether no ray of the packet looks for anything.
    #[inline(always)]
    pub fn is_dead(&self) -> bool {
        self.alive == 0
    }

    /// Writes what the rays have met.
    #[inline(always)]
    pub fn store(&self, hits: &mut Hits) {
        let start = self.start;
        let [object, index] = self.ids.store();
        put(self.t.store(), &mut hits.t[start..]);
        put(self.u.store(), &mut hits.u[start..]);
        put(self.v.store(), &mut hits.v[start..]);
        put(object, &mut hits.id.object[start..]);
        put(index, &mut hits.id.index[start..]);
    }

    /// Writes which rays have met anything, or have not looked.
    #[inline(always)]
    pub fn store_blocked(&self, blocked: &mut [bool]) {
        for (i, blocked) in blocked[self.start..].iter_mut().take(SIZE).enumerate() {
            *blocked = self.alive >> i & 1 == 0;
        }
    }

    /// What ray `i` has met.
    #[inline(always)]
    fn hit(&self, i: usize) -> Hit {
        let [object, index] = self.ids.store();
        let (t, u, v) = (self.t.store(), self.u.store(), self.v.store());
        Hit { t: t[i], u: u[i], v: v[i], id: Id { object: object[i], index: index[i] }, time: None }
    }

    /// Goes through the tree.
    #[inline(always)]
    pub fn trace(&mut self, tree: &Tree, scratch: &mut Scratch) {
        let root = tree.root;
        if root == Child::NONE {
        } else if !root.is_node() {
            self.leaf(tree, root, ALL, S::splat(0.0), scratch);
        } else if let Some(space) = self.space() {
            self.walk(tree, &space, scratch);
        } else {
            self.alone(tree, root, ALL, [0.0; SIZE], scratch);
        }
    }

    /// Goes through the tree, nearest boxes of the first ray first.
    #[inline(always)]
    fn walk(&mut self, tree: &Tree, space: &Space<S>, scratch: &mut Scratch) {
        scratch.packet[0] = Entry { child: tree.root, mask: ALL, near: [0.0; SIZE] };
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let Entry { child, mask, near } = scratch.packet[top];
            let active = mask & self.alive & S::load(&near).le(self.t);
            if active == 0 {
                continue;
            }
            if active.count_ones() <= FEW {
                self.alone(tree, child, active, near, scratch);
            } else if child.is_node() {
                self.open(&tree.nodes[child.index()], space, active, &mut scratch.packet, &mut top);
            } else {
                self.leaf(tree, child, active, S::load(&near), scratch);
            }
            if self.alive == 0 {
                return;
            }
        }
    }

    /// Puts the children of a node on the stack.
    #[inline(always)]
    fn open(&self, node: &Node, space: &Space<S>, active: u32, stack: &mut [Entry; STACK], top: &mut usize) {
        let mut candidates = space.hull.enter(node, space.sides);
        let ([x, y, z], [sx, sy, sz]) = (&node.bounds, space.sides);
        let first = *top;
        let lead = active.trailing_zeros() as usize & 7;
        while candidates != 0 {
            let slot = candidates.trailing_zeros() as usize & 7;
            candidates &= candidates - 1;
            let near = Vec3x8 { x: S::splat(x[sx][slot]), y: S::splat(y[sy][slot]), z: S::splat(z[sz][slot]) };
            let far =
                Vec3x8 { x: S::splat(x[1 - sx][slot]), y: S::splat(y[1 - sy][slot]), z: S::splat(z[1 - sz][slot]) };
            let (enter, leave) = kernel::slab(near, far, self.lanes.origin, space.inverse);
            let mask = active & enter.le(leave.min(self.t));
            if mask == 0 {
                continue;
            }
            let near = enter.store();
            let mut at = *top;
            while at > first && stack[at - 1].near[lead] < near[lead] {
                stack[at] = stack[at - 1];
                at -= 1;
            }
            stack[at] = Entry { child: node.children[slot], mask, near };
            *top += 1;
        }
    }

    /// Meets what is in a leaf that the `active` rays enter at `near`.
    #[inline(always)]
    fn leaf(&mut self, tree: &Tree, child: Child, active: u32, near: S, scratch: &mut Scratch) {
        match child.kind() {
            Kind::Triangles => self.triangles(&tree.triangles[child.index()], active, near),
            Kind::Spheres => self.spheres(&tree.spheres[child.index()], active, near),
            Kind::Instance | Kind::Analytic => self.alone(tree, child, active, near.store(), scratch),
        }
    }

    #[inline(always)]
    fn triangles(&mut self, block: &TriangleBlock, active: u32, near: S) {
        for (slot, &id) in block.ids.iter().enumerate() {
            if id == Id::NONE {
                break;
            }
            let [a, b, c] = &block.vertices;
            let corners = [corner(a, slot), corner(b, slot), corner(c, slot)];
            if let Some(crossing) = kernel::triangle(&self.lanes, corners, near, self.t) {
                self.improve(crossing, active, id);
            }
        }
    }

    #[inline(always)]
    fn spheres(&mut self, block: &SphereBlock, active: u32, near: S) {
        for (slot, &id) in block.ids.iter().enumerate() {
            if id == Id::NONE {
                break;
            }
            let (center, radius) = (corner(&block.centers, slot), S::splat(block.radii[slot]));
            if let Some(crossing) = kernel::sphere(&self.lanes, center, radius, near, self.t) {
                self.improve(crossing, active, id);
            }
        }
    }

    /// Sends the `active` rays on without the others.
    #[inline(always)]
    fn alone(&mut self, tree: &Tree, child: Child, active: u32, near: [f32; SIZE], scratch: &mut Scratch) {
        let mut rest = active & self.alive;
        while rest != 0 {
            let i = rest.trailing_zeros() as usize & 7;
            rest &= rest - 1;
            let (from, known) = ((near[i], child), self.hit(i));
            let mut hit = known;
            tree.trace::<S, ANY>(
                from,
                &self.rays.get(self.start + i),
                &mut hit,
                &mut scratch.outer,
                &mut scratch.inner,
            );
            if hit.id == known.id {
            } else if ANY {
                self.alive &= !(1 << i);
            } else {
                self.set(1 << i, [hit.t, hit.u, hit.v].map(S::splat), hit.id);
            }
        }
    }

    /// The infinite planes.
    #[inline(always)]
    pub fn planes(&mut self, planes: &[PlaneShape]) {
        for plane in planes {
            let offset = Vec3x8::splat(plane.point).sub(self.lanes.origin);
            let normal = Vec3x8::splat(plane.normal);
            let t = offset.dot(normal).div(self.lanes.direction.dot(normal));
            let mask = self.lanes.t_min.lt(t) & t.le(self.t);
            let zero = S::splat(0.0);
            self.improve(Crossing { mask, t, u: zero, v: zero }, self.alive, plane.id());
        }
    }

    /// Keeps the better hit of every ray that met this primitive.
    #[inline(always)]
    fn improve(&mut self, crossing: Crossing<S>, active: u32, id: Id) {
        let mut mask = crossing.mask & active & self.alive;
        if mask == 0 {
            return;
        }
        if mask & self.leaving != 0 {
            mask &= !self.skip.same(Names::splat(id));
        }
        if ANY {
            self.alive &= !mask;
            return;
        }
        // Rays that have met a better one just as far away.
        let mut tied = mask & !crossing.t.lt(self.t);
        while tied != 0 {
            let i = tied.trailing_zeros() as usize & 7;
            tied &= tied - 1;
            if !id.precedes(self.hit(i).id) {
                mask &= !(1 << i);
            }
        }
        self.set(mask, [crossing.t, crossing.u, crossing.v], id);
    }

    /// What the rays of `mask` have met.
    #[inline(always)]
    fn set(&mut self, mask: u32, [t, u, v]: [S; 3], id: Id) {
        self.t = S::select(mask, t, self.t);
        self.u = S::select(mask, u, self.u);
        self.v = S::select(mask, v, self.v);
        self.ids = Names::select(mask, Names::splat(id), self.ids);
    }

    /// `None` if the directions differ in a sign.
    #[inline(always)]
    fn space(&self) -> Option<Space<S>> {
        let Vec3x8 { x, y, z } = self.lanes.direction;
        let inverse = Vec3x8 { x: kernel::inverse(x), y: kernel::inverse(y), z: kernel::inverse(z) };
        let (origins, reciprocals) = (self.lanes.origin.bounds(), inverse.bounds());
        let sides = reciprocals.min.cmplt(Vec3::ZERO);
        if reciprocals.max.cmplt(Vec3::ZERO) != sides {
            return None;
        }
        let hull = Hull {
            near_origin: Vec3x8::splat(Vec3::select(sides, origins.min, origins.max)),
            near_inverse: Vec3x8::splat(Vec3::select(sides, reciprocals.max, reciprocals.min)),
            far_origin: Vec3x8::splat(Vec3::select(sides, origins.max, origins.min)),
            far_inverse: Vec3x8::splat(Vec3::select(sides, reciprocals.min, reciprocals.max)),
        };
        let sides = [usize::from(sides.test(0)), usize::from(sides.test(1)), usize::from(sides.test(2))];
        Some(Space { inverse, sides, hull })
    }
}

/// As much of a group's row as there is room for.
#[inline(always)]
fn put<T: Copy>(values: [T; SIZE], row: &mut [T]) {
    match row.first_chunk_mut() {
        Some(chunk) => *chunk = values,
        None => row.iter_mut().zip(values).for_each(|(row, value)| *row = value),
    }
}

impl<S: Simd> Vec3x8<S> {
    /// The box around eight points.
    #[inline(always)]
    fn bounds(self) -> Aabb {
        let min = Vec3::new(self.x.least(), self.y.least(), self.z.least());
        Aabb { min, max: Vec3::new(self.x.most(), self.y.most(), self.z.most()) }
    }
}

impl<S: Simd> Hull<S> {
    /// The boxes of `node` that some ray of the packet may enter.
    ///
    /// With directions of positive sign a box is entered the earliest by the origin that lies farthest and the
    /// smallest inverse, unless it lies behind, where all is cut off at 0; it is left the latest by the opposite.
    #[inline(always)]
    fn enter(&self, node: &Node, [sx, sy, sz]: [usize; 3]) -> u32 {
        let [x, y, z] = &node.bounds;
        let near = Vec3x8 { x: S::load(&x[sx]), y: S::load(&y[sy]), z: S::load(&z[sz]) };
        let far = Vec3x8 { x: S::load(&x[1 - sx]), y: S::load(&y[1 - sy]), z: S::load(&z[1 - sz]) };
        let (enter, _) = kernel::slab(near, far, self.near_origin, self.near_inverse);
        let (_, leave) = kernel::slab(near, far, self.far_origin, self.far_inverse);
        enter.le(leave)
    }
}

/// A point of a block in all lanes.
#[inline(always)]
fn corner<S: Simd>(rows: &[[f32; 8]; 3], slot: usize) -> Vec3x8<S> {
    Vec3x8 { x: S::splat(rows[0][slot]), y: S::splat(rows[1][slot]), z: S::splat(rows[2][slot]) }
}
