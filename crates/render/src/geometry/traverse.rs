//! One ray against the hierarchy, eight boxes or eight primitives a step.
//!
//! The hit that wins is the closest, and of equally close ones that of the smallest [`Id`]. It does not depend on the
//! way through the tree: see [`kernel::triangle`] about the boxes of the leaves.

use super::analytic;
use super::bvh::{Child, Kind, MAX_DEPTH, Node};
use super::kernel::{self, Crossing, Lanes};
use super::packet;
use super::simd::{Simd, Vec3x8};
use super::{Hit, Id, Motions, Object, Ray};
use crate::affine::Affine;

/// Eight triangles; unused lanes hold NaN and are never hit.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(crate) struct TriangleBlock {
    /// `[vertex][axis][lane]`.
    pub vertices: [[[f32; 8]; 3]; 3],
    pub ids: [Id; 8],
}

impl TriangleBlock {
    pub const EMPTY: TriangleBlock = TriangleBlock { vertices: [[[f32::NAN; 8]; 3]; 3], ids: [Id::NONE; 8] };
}

/// Eight spheres; unused lanes hold NaN and are never hit.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(crate) struct SphereBlock {
    /// `[axis][lane]`.
    pub centers: [[f32; 8]; 3],
    pub radii: [f32; 8],
    pub ids: [Id; 8],
}

impl SphereBlock {
    pub const EMPTY: SphereBlock =
        SphereBlock { centers: [[f32::NAN; 8]; 3], radii: [f32::NAN; 8], ids: [Id::NONE; 8] };
}

/// A tree placed somewhere else.
#[derive(Debug, Clone)]
pub(crate) struct InstanceLeaf {
    /// The root of its tree.
    pub root: Child,
    /// In the middle of the exposure.
    pub object_from_world: Affine,
    /// The object that it shows; hits inside carry it in place of the tree's own.
    pub object: u32,
    /// That object, if it moves during the exposure.
    pub moving: Option<Box<Object>>,
}

/// All nodes and leaves of a scene.
#[derive(Debug, Clone)]
pub(crate) struct Tree {
    pub root: Child,
    pub nodes: Vec<Node>,
    pub triangles: Vec<TriangleBlock>,
    pub spheres: Vec<SphereBlock>,
    pub instances: Vec<InstanceLeaf>,
    pub analytic: analytic::Leaves,
    pub motions: Motions,
}

/// Most children that wait at a time: a node takes one from the stack and may add eight.
pub(crate) const STACK: usize = MAX_DEPTH * 7 + 8;

/// Where the traversal goes on later: the entry distance and what is entered.
type Stack = [(f32, Child); STACK];

/// Room for the traversal of one thread; made once, because clearing it costs as much as a short ray.
pub(crate) struct Scratch {
    pub outer: Box<Stack>,
    pub inner: Box<Stack>,
    pub packet: packet::Stack,
}

impl Default for Scratch {
    fn default() -> Self {
        let stack = || Box::new([(0.0, Child::NONE); STACK]);
        Scratch { outer: stack(), inner: stack(), packet: packet::stack() }
    }
}

impl InstanceLeaf {
    /// `ray` in the space of the instance's tree. Distances along it stay what they are.
    #[inline(always)]
    fn localize(&self, ray: &Ray, motions: &Motions) -> Ray {
        let object_from_world = match &self.moving {
            Some(object) => motions.pose(object, ray.time).object_from_world,
            None => self.object_from_world,
        };
        let skip = if ray.skip.object == self.object { Id { object: Id::NONE.object, ..ray.skip } } else { Id::NONE };
        Ray {
            origin: object_from_world.point(ray.origin),
            direction: object_from_world.vector(ray.direction),
            skip,
            ..*ray
        }
    }
}

impl Tree {
    /// How much memory nodes and leaves take.
    pub fn bytes(&self) -> usize {
        let instances = self.instances.capacity() * size_of::<InstanceLeaf>();
        let blocks = self.triangles.capacity() * size_of::<TriangleBlock>();
        let spheres = self.spheres.capacity() * size_of::<SphereBlock>();
        self.nodes.capacity() * size_of::<Node>() + blocks + spheres + instances
    }

    /// Improves `hit` by what lies below `root`, whose box the ray enters at `enter`. With `ANY`, anything closer will
    /// do.
    #[inline(always)]
    pub fn trace<S: Simd, const ANY: bool>(
        &self,
        (enter, root): (f32, Child),
        ray: &Ray,
        hit: &mut Hit,
        outer: &mut Stack,
        inner: &mut Stack,
    ) {
        let mut nested = Nested::<ANY> { tree: self, ray, stack: inner };
        self.walk::<S, ANY>((enter, root), ray, outer, hit, &mut nested);
    }

    /// Goes through the tree below `root`, nearest boxes first, and improves `best`.
    #[inline(always)]
    fn walk<S: Simd, const ANY: bool>(
        &self,
        root: (f32, Child),
        ray: &Ray,
        stack: &mut Stack,
        best: &mut Hit,
        instances: &mut impl Instances,
    ) {
        if root.1 == Child::NONE {
            return;
        }
        let space = Space::<S>::new(ray);
        let known = best.id;
        stack[0] = root;
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let (enter, child) = stack[top];
            if enter > best.t {
                continue;
            }
            if child.is_node() {
                let node = &self.nodes[child.index()];
                let (near, mut mask) = space.enter(node, best.t);
                let first = top;
                while mask != 0 {
                    let slot = mask.trailing_zeros() as usize & 7;
                    mask &= mask - 1;
                    let mut at = top;
                    while at > first && stack[at - 1].0 < near[slot] {
                        stack[at] = stack[at - 1];
                        at -= 1;
                    }
                    stack[at] = (near[slot], node.children[slot]);
                    top += 1;
                }
                continue;
            }
            match child.kind() {
                Kind::Triangles => self.triangles[child.index()].intersect(&space.lanes, ray, enter, best),
                Kind::Spheres => self.spheres[child.index()].intersect(&space.lanes, ray, enter, best),
                Kind::Instance => instances.enter::<S>(&self.instances[child.index()], enter, best),
                Kind::Analytic => self.analytic.meet(child.index(), ray, enter, &self.motions, best),
            }
            if ANY && best.id != known {
                return;
            }
        }
    }
}

/// A ray prepared for one space.
struct Space<S> {
    lanes: Lanes<S>,
    inverse: Vec3x8<S>,
    /// Which side of a box is entered, by axis.
    sides: [usize; 3],
}

impl<S: Simd> Space<S> {
    #[inline(always)]
    fn new(ray: &Ray) -> Self {
        let direction = Vec3x8::splat(ray.direction);
        let inverse = Vec3x8 {
            x: kernel::inverse(direction.x),
            y: kernel::inverse(direction.y),
            z: kernel::inverse(direction.z),
        };
        let side = |component: f32| usize::from(component.is_sign_negative());
        Space {
            lanes: Lanes { origin: Vec3x8::splat(ray.origin), direction, t_min: S::splat(ray.t_min) },
            inverse,
            sides: [side(ray.direction.x), side(ray.direction.y), side(ray.direction.z)],
        }
    }

    /// Entry distances of the boxes of `node`, and which of them are entered up to `t_max`.
    #[inline(always)]
    fn enter(&self, node: &Node, t_max: f32) -> ([f32; 8], u32) {
        let ([x, y, z], [sx, sy, sz]) = (&node.bounds, self.sides);
        let near = Vec3x8 { x: S::load(&x[sx]), y: S::load(&y[sy]), z: S::load(&z[sz]) };
        let far = Vec3x8 { x: S::load(&x[1 - sx]), y: S::load(&y[1 - sy]), z: S::load(&z[1 - sz]) };
        let (enter, leave) = kernel::slab(near, far, self.lanes.origin, self.inverse);
        (enter.store(), enter.le(leave.min(S::splat(t_max))))
    }
}

/// What happens at the leaf of an instance. (A trait and not a closure: a closure is compiled without the instruction
/// set of the function it stands in, and would call every intrinsic out of line.)
trait Instances {
    fn enter<S: Simd>(&mut self, leaf: &InstanceLeaf, enter: f32, best: &mut Hit);
}

/// Goes on in the instance's own tree.
struct Nested<'a, const ANY: bool> {
    tree: &'a Tree,
    ray: &'a Ray,
    stack: &'a mut Stack,
}

impl<const ANY: bool> Instances for Nested<'_, ANY> {
    #[inline(always)]
    fn enter<S: Simd>(&mut self, leaf: &InstanceLeaf, enter: f32, best: &mut Hit) {
        // Hits as far as the best so far may still win by their object.
        let mut found = Hit { t: best.t.next_up(), ..Hit::NONE };
        let root = (0.0, leaf.root);
        self.tree.walk::<S, ANY>(
            root,
            &leaf.localize(self.ray, &self.tree.motions),
            self.stack,
            &mut found,
            &mut NoInstances,
        );
        if found.id != Id::NONE {
            best.improve(Hit { t: found.t.max(enter), id: Id { object: leaf.object, ..found.id }, ..found });
        }
    }
}

/// Trees of instances hold no instances.
struct NoInstances;

impl Instances for NoInstances {
    #[inline(always)]
    fn enter<S: Simd>(&mut self, _: &InstanceLeaf, _: f32, _: &mut Hit) {}
}

impl TriangleBlock {
    #[inline(always)]
    fn intersect<S: Simd>(&self, lanes: &Lanes<S>, ray: &Ray, enter: f32, best: &mut Hit) {
        let corners =
            [Vec3x8::load(&self.vertices[0]), Vec3x8::load(&self.vertices[1]), Vec3x8::load(&self.vertices[2])];
        if let Some(crossing) = kernel::triangle(lanes, corners, S::splat(enter), S::splat(best.t)) {
            crossing.improve(best, &self.ids, ray.skip);
        }
    }
}

impl SphereBlock {
    #[inline(always)]
    fn intersect<S: Simd>(&self, lanes: &Lanes<S>, ray: &Ray, enter: f32, best: &mut Hit) {
        let (centers, radii) = (Vec3x8::load(&self.centers), S::load(&self.radii));
        if let Some(crossing) = kernel::sphere(lanes, centers, radii, S::splat(enter), S::splat(best.t)) {
            crossing.improve(best, &self.ids, ray.skip);
        }
    }
}

impl<S: Simd> Crossing<S> {
    /// Keeps the best of the hits with eight primitives.
    #[inline(always)]
    fn improve(self, best: &mut Hit, ids: &[Id; 8], skip: Id) {
        let mut mask = self.mask;
        if mask == 0 {
            return;
        }
        let (t, u, v) = (self.t.store(), self.u.store(), self.v.store());
        while mask != 0 {
            let i = mask.trailing_zeros() as usize & 7;
            mask &= mask - 1;
            if ids[i] != skip {
                best.improve(Hit { t: t[i], u: u[i], v: v[i], id: ids[i], time: None });
            }
        }
    }
}
