//! Eight rays at a time through the hierarchy, for rays that go the same way: a box or a primitive is loaded once for
//! all of them. What they meet is what they would meet alone, to the last bit.

use glam::Vec3;

use super::bvh::{Aabb, Child, Kind, Node};
use super::kernel::{self, Crossing, Lanes};
use super::simd::{Simd, Vec3x8};
use super::traverse::{STACK, Scratch, SphereBlock, Tree, TriangleBlock};
use super::{Hit, Id, PlaneShape, Ray};

/// Rays in a packet.
pub(crate) const SIZE: usize = 8;
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
pub(crate) struct Packet<'a, R, S, const ANY: bool> {
    rays: &'a [R; SIZE],
    lanes: Lanes<S>,
    /// Rays that are still looking: with `ANY`, a ray stops at the first hit.
    alive: u32,
    t: S,
    u: S,
    v: S,
    ids: [Id; SIZE],
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

impl<'a, R: AsRef<Ray>, S: Simd, const ANY: bool> Packet<'a, R, S, ANY> {
    #[inline(always)]
    pub fn new(rays: &'a [R; SIZE]) -> Self {
        let mut origin = [[0.0; SIZE]; 3];
        let mut direction = [[0.0; SIZE]; 3];
        let mut ends = [[0.0; SIZE]; 2];
        for i in 0..SIZE {
            let ray = rays[i].as_ref();
            for axis in 0..3 {
                origin[axis][i] = ray.origin[axis];
                direction[axis][i] = ray.direction[axis];
            }
            ends[0][i] = ray.t_min;
            ends[1][i] = ray.t_max;
        }
        let lanes =
            Lanes { origin: Vec3x8::load(&origin), direction: Vec3x8::load(&direction), t_min: S::load(&ends[0]) };
        let zero = S::splat(0.0);
        Packet { rays, lanes, alive: ALL, t: S::load(&ends[1]), u: zero, v: zero, ids: [Id::NONE; SIZE] }
    }

    /// What the rays have met.
    #[inline(always)]
    pub fn hits(&self) -> [Hit; SIZE] {
        let (t, u, v) = (self.t.store(), self.u.store(), self.v.store());
        std::array::from_fn(|i| Hit { t: t[i], u: u[i], v: v[i], id: self.ids[i] })
    }

    /// Which rays have met anything.
    #[inline(always)]
    pub fn blocked(&self) -> [bool; SIZE] {
        std::array::from_fn(|i| self.alive >> i & 1 == 0)
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
            Kind::Instance => self.alone(tree, child, active, near.store(), scratch),
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
        let mut hits = self.hits();
        let mut rest = active & self.alive;
        while rest != 0 {
            let i = rest.trailing_zeros() as usize & 7;
            rest &= rest - 1;
            let from = (near[i], child);
            tree.trace::<S, ANY>(from, self.rays[i].as_ref(), &mut hits[i], &mut scratch.outer, &mut scratch.inner);
            if ANY && hits[i].id != Id::NONE {
                self.alive &= !(1 << i);
            }
        }
        if !ANY {
            self.ids = hits.map(|hit| hit.id);
            self.t = S::load(&hits.map(|hit| hit.t));
            self.u = S::load(&hits.map(|hit| hit.u));
            self.v = S::load(&hits.map(|hit| hit.v));
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
        // Rays that skip this primitive, or have met a better one just as far away.
        let closer = crossing.t.lt(self.t);
        let mut rest = mask;
        while rest != 0 {
            let i = rest.trailing_zeros() as usize & 7;
            rest &= rest - 1;
            if self.rays[i].as_ref().skip == id || closer >> i & 1 == 0 && !id.precedes(self.ids[i]) {
                mask &= !(1 << i);
            } else if !ANY {
                self.ids[i] = id;
            }
        }
        if ANY {
            self.alive &= !mask;
        } else {
            self.t = S::select(mask, crossing.t, self.t);
            self.u = S::select(mask, crossing.u, self.u);
            self.v = S::select(mask, crossing.v, self.v);
        }
    }

    /// `None` if the directions differ in a sign.
    #[inline(always)]
    fn space(&self) -> Option<Space<S>> {
        let mut inverses = [[0.0; SIZE]; 3];
        let (mut origins, mut reciprocals) = (Aabb::EMPTY, Aabb::EMPTY);
        for (i, ray) in self.rays.iter().enumerate() {
            let ray = ray.as_ref();
            let inverse = kernel::inverse(ray.direction);
            for (axis, row) in inverses.iter_mut().enumerate() {
                row[i] = inverse[axis];
            }
            origins = origins.extend(ray.origin);
            reciprocals = reciprocals.extend(inverse);
        }
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
        Some(Space { inverse: Vec3x8::load(&inverses), sides, hull })
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
