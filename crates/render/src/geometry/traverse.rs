//! The tree of a scene, and one ray on its way through it, eight boxes or eight primitives a step.
//!
//! The hit that wins is the closest, and of equally close ones that of the smallest [`Id`]. It does not depend on the
//! way through the tree: see [`kernel::triangle`] about the boxes of the leaves.

use glam::Vec3;

use super::analytic;
use super::build::MAX_DEPTH;
use super::bvh::{Child, Kind, Node, Octant};
use super::kernel::{self, Crossing, Inverse, Plain, Shear, Slab};
use super::packet::LEFT;
use super::simd::{Simd, Vec3s};
use super::{Hit, Id, Motions, Object, Ray};
use crate::affine::Affine;

/// Eight triangles; unused lanes hold NaN and are never hit.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(super) struct TriangleBlock {
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
pub(super) struct SphereBlock {
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
pub(super) struct InstanceLeaf {
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
pub(super) struct Tree {
    pub root: Child,
    pub nodes: Vec<Node>,
    pub triangles: Vec<TriangleBlock>,
    pub spheres: Vec<SphereBlock>,
    pub instances: Vec<InstanceLeaf>,
    pub analytic: analytic::Leaves,
    pub motions: Motions,
}

impl Tree {
    /// How much memory nodes and leaves take.
    pub fn bytes(&self) -> usize {
        let instances = self.instances.len() * size_of::<InstanceLeaf>();
        let blocks = self.triangles.len() * size_of::<TriangleBlock>();
        let spheres = self.spheres.len() * size_of::<SphereBlock>();
        self.nodes.len() * size_of::<Node>() + blocks + spheres + instances
    }
}

impl Tree {
    /// Has a child at hand soon.
    #[inline(always)]
    pub fn prefetch<S: Simd>(&self, child: Child) {
        let (nodes, blocks) = (self.nodes.as_ptr().cast::<u8>(), self.triangles.as_ptr().cast::<u8>());
        let (start, size) =
            if child.is_node() { (nodes, size_of::<Node>()) } else { (blocks, size_of::<TriangleBlock>()) };
        // What is nowhere would be looked for in vain, which takes its time.
        let index = if child == Child::NONE { 0 } else { child.index() };
        S::prefetch(start.wrapping_add(index * size));
    }
}

/// Most children that wait at a time: a node takes one from the stack and may add eight. Eight places more are written to.
pub(super) const STACK: usize = MAX_DEPTH * 7 + 8 + 8;

/// The same for a ray that goes on alone, above the stack of its packet and what that has left to it; and some, so that not
/// all flights want the same sets of the cache.
const ALONE: usize = 2 * STACK + LEFT + 16;

const ROOM: &str = "the stack has room for eight more than ever wait";

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

/// What boxes and primitives need to know of a ray, in one line of the cache: its origin, [`Inverse`] (to enter, to leave),
/// slopes and scale of its [`Shear`], its direction and where it ends.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(super) struct Line(pub [f32; 16]);

impl Line {
    #[inline(always)]
    fn origin(&self) -> Vec3 {
        let [x, y, z, ..] = self.0;
        Vec3::new(x, y, z)
    }

    #[inline(always)]
    fn inverse<S: Simd>(&self) -> Inverse<S> {
        let [_, _, _, ex, ey, ez, lx, ly, lz, ..] = self.0;
        Inverse { enter: Vec3s::of([ex, ey, ez]), leave: Vec3s::of([lx, ly, lz]) }
    }

    #[inline(always)]
    fn direction(&self) -> Vec3 {
        let [.., x, y, z, _] = self.0;
        Vec3::new(x, y, z)
    }
}

/// What else there is to know of a ray.
#[derive(Debug, Clone, Copy)]
pub(super) struct Course {
    pub octant: Octant,
    /// The axis along which it is the longest.
    pub dominant: u32,
    pub t_min: f32,
    pub skip: Id,
    pub time: Option<f32>,
    /// Which of the caller's rays it is.
    pub number: u32,
}

/// A ray as flights have it.
#[inline(always)]
fn course<S: Simd>(ray: &Ray) -> (Line, Course) {
    let dominant = kernel::dominant(ray.direction);
    let (o, d, turned) = (ray.origin, ray.direction.to_array(), kernel::turned(dominant));
    let inverse = kernel::inverse(S::load(&[d[0], d[1], d[2], 1.0, 1.0, 1.0, 1.0, 1.0]));
    let ([ex, ey, ez, ..], [lx, ly, lz, ..]) = (inverse.enter.store(), inverse.leave.store());
    let [i, j, k] = [d[turned[0]], d[turned[1]], d[turned[2]]];
    let [i, j, scale, ..] = S::load(&[i, j, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]).div(S::splat(k)).store();
    let octant = Octant::new([d[0].is_sign_negative(), d[1].is_sign_negative(), d[2].is_sign_negative()]);
    let line = Line([o.x, o.y, o.z, ex, ey, ez, lx, ly, lz, i, j, scale, d[0], d[1], d[2], ray.t_max]);
    let &Ray { t_min, skip, time, .. } = ray;
    (line, Course { octant, dominant: dominant as u32, t_min, skip, time, number: 0 })
}

/// A ray on its way: what the boxes and the primitives need to know of it, the best that it has met, and what it has
/// still to look into.
#[derive(Debug, Clone)]
#[repr(C)]
pub(super) struct Flight {
    line: Line,
    pub course: Course,
    pub best: Hit,
    /// How many children wait, with what lies at the bottom of the stack.
    top: usize,
    /// Where they are entered.
    near: [f32; ALONE],
    waiting: [u32; ALONE],
}

impl Flight {
    /// On no way.
    pub const IDLE: Flight = Flight {
        line: Line([0.0; 16]),
        course: Course { octant: Octant(0), dominant: 0, t_min: 0.0, skip: Id::NONE, time: None, number: 0 },
        best: Hit::NONE,
        top: 0,
        near: [0.0; ALONE],
        waiting: [Child::NONE.code(); ALONE],
    };

    /// Sends off a ray that has already met `best`, with nothing to look into yet.
    #[inline(always)]
    pub fn begin(&mut self, line: Line, course: Course, best: Hit) {
        (self.line, self.course, self.best) = (line, course, best);
        // The bottom of the stack is reached when nothing waits.
        (self.near[0], self.waiting[0]) = (f32::NEG_INFINITY, Child::NONE.code());
        self.top = 1;
    }

    /// Adds a child that the ray enters at `near`: it comes next.
    #[inline(always)]
    pub fn push(&mut self, near: f32, child: Child) {
        (self.near[self.top], self.waiting[self.top]) = (near, child.code());
        self.top += 1;
    }

    /// The ray itself.
    #[inline(always)]
    fn ray(&self) -> Ray {
        let Course { t_min, skip, time, .. } = self.course;
        Ray { origin: self.line.origin(), direction: self.line.direction(), t_min, t_max: self.line.0[15], skip, time }
    }

    /// Goes all the way through the tree below a root, or up to the first hit where any will do.
    #[inline(always)]
    pub fn travel<S: Simd>(&mut self, ray: &Ray, tree: &Tree, root: Child, best: Hit, instances: &mut impl Instances) {
        let (line, course) = course::<S>(ray);
        self.begin(line, course, best);
        self.push(0.0, root);
        self.fly::<S>(tree, instances);
    }

    /// What comes next; [`Child::NONE`] where nothing waits any more.
    #[inline(always)]
    pub fn next(&self) -> Child {
        Child::of(self.waiting[self.top - 1])
    }

    /// Puts the children of a node, which comes next, in its place.
    #[inline(always)]
    pub fn open<S: Simd>(&mut self, node: &Node) {
        let octant = self.course.octant;
        let sides = octant.sides();
        let slab = Slab { origin: Vec3s::splat(self.line.origin()), inverse: self.line.inverse::<S>() };
        let (enter, leave) = kernel::slab(node.near(sides), node.far(sides), &slab);
        let limit = leave.min(S::splat(self.best.t));
        let at = self.top - 1;
        let room = (self.near[at..].first_chunk_mut(), self.waiting[at..].first_chunk_mut());
        let (Some(near), Some(waiting)) = room else { unreachable!("{ROOM}") };
        self.top = at + enter.pack(limit, &node.order, octant.shift(), &node.codes, near, waiting);
    }

    /// Meets what is in the leaf that comes next, and returns whether that made the hit better.
    #[inline(always)]
    pub fn meet<S: Simd>(&mut self, tree: &Tree, instances: &mut impl Instances) -> bool {
        self.top -= 1;
        let (child, enter) = (Child::of(self.waiting[self.top]), self.near[self.top]);
        let known = (self.best.t, self.best.id);
        match child.kind() {
            Kind::Triangles => self.triangles::<S>(&tree.triangles[child.index()], enter),
            Kind::Spheres => self.spheres::<S>(&tree.spheres[child.index()], enter),
            Kind::Instance => {
                instances.enter::<S>(tree, &tree.instances[child.index()], enter, &self.ray(), &mut self.best)
            }
            Kind::Analytic => tree.analytic.meet(child.index(), &self.ray(), enter, &tree.motions, &mut self.best),
        }
        known != (self.best.t, self.best.id)
    }

    /// Lets nothing wait any more.
    #[inline(always)]
    pub fn stop(&mut self) {
        self.top = 1;
    }

    /// Drops what waits farther away than the best hit.
    #[inline(always)]
    pub fn prune<S: Simd>(&mut self) {
        const AS_THEY_LIE: [u32; 8] = [0, 1, 2, 3, 4, 5, 6, 7];
        let limit = S::splat(self.best.t);
        let (mut from, mut to) = (0, 0);
        // What lies above the top does not count.
        self.near[self.top..][..8].fill(f32::INFINITY);
        while from < self.top {
            let (near, waiting) = (S::load(&self.near[from..]), self.waiting[from..].first_chunk().copied());
            let room = (self.near[to..].first_chunk_mut(), self.waiting[to..].first_chunk_mut());
            let (Some(waiting), (Some(near_room), Some(waiting_room))) = (waiting, room) else {
                unreachable!("{ROOM}")
            };
            to += near.pack(limit, &AS_THEY_LIE, 0, &waiting, near_room, waiting_room);
            from += 8;
        }
        self.top = to;
    }

    #[inline(always)]
    fn fly<S: Simd>(&mut self, tree: &Tree, instances: &mut impl Instances) {
        while self.next() != Child::NONE {
            if self.near[self.top - 1] > self.best.t {
                self.top -= 1;
            } else if self.next().is_node() {
                self.open::<S>(&tree.nodes[self.next().index()]);
            } else if self.meet::<S>(tree, instances) && instances.any() {
                return;
            }
        }
    }

    #[inline(always)]
    fn triangles<S: Simd>(&mut self, block: &TriangleBlock, enter: f32) {
        let turned = kernel::turned(self.course.dominant as usize);
        let [x, y, z, _, _, _, _, _, _, i, j, scale, ..] = self.line.0;
        let origin = [x, y, z];
        let shear = Shear {
            origin: Vec3s::of([origin[turned[0]], origin[turned[1]], origin[turned[2]]]),
            slope: (S::splat(i), S::splat(j)),
            scale: S::splat(scale),
            t_min: S::splat(self.course.t_min),
        };
        if let Some(crossing) = block.cross(&shear, turned, enter, self.best.t) {
            crossing.improve(&mut self.best, &block.ids, self.course.skip);
        }
    }

    #[inline(always)]
    fn spheres<S: Simd>(&mut self, block: &SphereBlock, enter: f32) {
        let plain = Plain {
            origin: Vec3s::splat(self.line.origin()),
            direction: Vec3s::splat(self.line.direction()),
            t_min: S::splat(self.course.t_min),
        };
        let (centers, radii) = (Vec3s::load(&block.centers), S::load(&block.radii));
        if let Some(crossing) = kernel::sphere(&plain, centers, radii, S::splat(enter), S::splat(self.best.t)) {
            crossing.improve(&mut self.best, &block.ids, self.course.skip);
        }
    }
}

impl TriangleBlock {
    /// Where a ray, which enters the box of the block at `enter`, meets its triangles.
    #[inline(always)]
    pub fn cross<S: Simd>(&self, shear: &Shear<S>, turned: [usize; 3], enter: f32, t_max: f32) -> Option<Crossing<S>> {
        let [a, b, c] = &self.vertices;
        let corners = [load(a, turned), load(b, turned), load(c, turned)];
        kernel::triangle::<S, false>(shear, corners, S::splat(enter), S::splat(t_max))
    }
}

/// Eight corners in turned coordinates.
#[inline(always)]
fn load<S: Simd>(rows: &[[f32; 8]; 3], [i, j, k]: [usize; 3]) -> Vec3s<S> {
    Vec3s { x: S::load(&rows[i % 3]), y: S::load(&rows[j % 3]), z: S::load(&rows[k % 3]) }
}

/// What happens at the leaf of an instance. (A trait and not a closure: a closure is compiled without the instruction
/// set of the function it stands in, and would call every intrinsic out of line.)
pub(super) trait Instances {
    /// Whether anything that is met will do.
    fn any(&self) -> bool;
    fn enter<S: Simd>(&mut self, tree: &Tree, leaf: &InstanceLeaf, enter: f32, ray: &Ray, best: &mut Hit);
}

/// Goes on in the instance's own tree.
pub(super) struct Nested<'a> {
    pub flight: &'a mut Flight,
    /// Whether anything that is met will do.
    pub any: bool,
}

impl Instances for Nested<'_> {
    #[inline(always)]
    fn any(&self) -> bool {
        self.any
    }

    #[inline(always)]
    fn enter<S: Simd>(&mut self, tree: &Tree, leaf: &InstanceLeaf, enter: f32, ray: &Ray, best: &mut Hit) {
        // Hits as far as the best so far may still win by their object.
        let farthest = Hit { t: best.t.next_up(), ..Hit::NONE };
        let local = leaf.localize(ray, &tree.motions);
        self.flight.travel::<S>(&local, tree, leaf.root, farthest, &mut NoInstances { any: self.any });
        let found = self.flight.best;
        if found.id != Id::NONE {
            best.improve(Hit { t: found.t.max(enter), id: Id { object: leaf.object, ..found.id }, ..found });
        }
    }
}

/// Trees of instances hold no instances.
struct NoInstances {
    any: bool,
}

impl Instances for NoInstances {
    #[inline(always)]
    fn any(&self) -> bool {
        self.any
    }

    #[inline(always)]
    fn enter<S: Simd>(&mut self, _: &Tree, _: &InstanceLeaf, _: f32, _: &Ray, _: &mut Hit) {}
}

impl<S: Simd> Crossing<S> {
    /// Keeps the best of the hits with eight primitives.
    #[inline(always)]
    pub fn improve(self, best: &mut Hit, ids: &[Id; 8], skip: Id) {
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
