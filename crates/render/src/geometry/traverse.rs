//! Rays against the hierarchy: closest hit, and whether anything is hit at all.
//!
//! One ray at a time, eight boxes or eight primitives a step. Triangles are tested by the signs of their edge
//! functions ([Davidovič et al. 2012] "3D Rasterization: A Bridge between Rasterization and Ray Tracing"), which are
//! exact negatives of each other on the two sides of a shared edge, so that no ray slips between two neighbours.
//! Spheres follow [Haines, Günther, Akenine-Möller 2019] "Precision Improvements for Ray/Sphere Intersection".

use glam::Vec3;

use super::bvh::{Child, Kind, MAX_DEPTH, Node};
use super::simd::{Simd, Vec3x8};
use super::{Hit, Id, Ray};
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
    pub object_from_world: Affine,
    /// The object that it shows; hits inside carry it in place of the tree's own.
    pub object: u32,
}

/// All nodes and leaves of a scene.
#[derive(Debug, Clone)]
pub(crate) struct Tree {
    pub root: Child,
    pub nodes: Vec<Node>,
    pub triangles: Vec<TriangleBlock>,
    pub spheres: Vec<SphereBlock>,
    pub instances: Vec<InstanceLeaf>,
}

/// A ray prepared for one space.
struct Prepared<S> {
    origin: Vec3x8<S>,
    direction: Vec3x8<S>,
    /// One over the direction, component by component; never infinite.
    inverse: Vec3,
    raw_origin: Vec3,
}

impl<S: Simd> Prepared<S> {
    #[inline(always)]
    fn new(origin: Vec3, direction: Vec3) -> Self {
        // A zero component would make 0 × ∞ where the origin lies on a side of a box.
        let nonzero = |d: f32| if d.abs() < 1e-18 { 1e-18f32.copysign(d) } else { d };
        let inverse = Vec3::new(1.0 / nonzero(direction.x), 1.0 / nonzero(direction.y), 1.0 / nonzero(direction.z));
        Prepared { origin: Vec3x8::splat(origin), direction: Vec3x8::splat(direction), inverse, raw_origin: origin }
    }

    /// Entry distances of the boxes of `node`, and which of them are entered before `t_max`.
    #[inline(always)]
    fn enter(&self, node: &Node, t_max: f32) -> ([f32; 8], u32) {
        let slab = |axis: usize| {
            let (near, far) = if self.inverse[axis] < 0.0 { (1, 0) } else { (0, 1) };
            let (o, i) = (S::splat(self.raw_origin[axis]), S::splat(self.inverse[axis]));
            let near = S::load(&node.bounds[axis][near]).sub(o).mul(i);
            let far = S::load(&node.bounds[axis][far]).sub(o).mul(i);
            (near, far)
        };
        let ((nx, fx), (ny, fy), (nz, fz)) = (slab(0), slab(1), slab(2));
        let near = nx.max(ny).max(nz.max(S::splat(0.0)));
        // Two roundings more on the far side keep rays that graze a box ([Ize 2013] "Robust BVH Ray Traversal").
        let far = fx.min(fy).min(fz).mul(S::splat(1.000_000_5)).min(S::splat(t_max));
        (near.store(), near.le(far))
    }
}

/// Where the traversal goes on later: the entry distance and what is entered.
type Stack = [(f32, Child); MAX_DEPTH * 7 + 8];

/// Room for the traversal of one thread; made once per batch, because clearing it costs as much as a short ray.
pub(crate) struct Scratch {
    outer: Box<Stack>,
    inner: Box<Stack>,
}

impl Default for Scratch {
    fn default() -> Self {
        let stack = || Box::new([(0.0, Child::NONE); MAX_DEPTH * 7 + 8]);
        Scratch { outer: stack(), inner: stack() }
    }
}

impl InstanceLeaf {
    /// `ray` in the space of the instance's tree. Distances along it stay what they are.
    #[inline(always)]
    fn localize(&self, ray: &Ray) -> Ray {
        let skip = if ray.skip.object == self.object { Id { object: Id::NONE.object, ..ray.skip } } else { Id::NONE };
        Ray {
            origin: self.object_from_world.point(ray.origin),
            direction: self.object_from_world.vector(ray.direction),
            skip,
            ..*ray
        }
    }
}

impl Tree {
    /// Replaces `hit` where something is closer along `ray`.
    #[inline(always)]
    pub fn closest<S: Simd>(&self, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) {
        *hit = self.trace::<S, false>(ray, *hit, scratch);
    }

    /// Whether anything lies along `ray` before its end.
    #[inline(always)]
    pub fn occluded<S: Simd>(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
        self.trace::<S, true>(ray, Hit { t: ray.t_max, ..Hit::NONE }, scratch).id != Id::NONE
    }

    #[inline(always)]
    fn trace<S: Simd, const ANY: bool>(&self, ray: &Ray, hit: Hit, scratch: &mut Scratch) -> Hit {
        let Scratch { outer, inner } = scratch;
        let mut best = hit;
        let mut nested = Nested::<ANY> { tree: self, ray, stack: inner };
        self.walk::<S, ANY>(self.root, ray, outer, &mut best, &mut nested);
        best
    }

    /// Goes through the tree below `root`, nearest boxes first, and improves `best`.
    #[inline(always)]
    fn walk<S: Simd, const ANY: bool>(
        &self,
        root: Child,
        ray: &Ray,
        stack: &mut Stack,
        best: &mut Hit,
        instances: &mut impl Instances,
    ) {
        if root == Child::NONE {
            return;
        }
        let space = Prepared::<S>::new(ray.origin, ray.direction);
        let known = best.id;
        stack[0] = (0.0, root);
        let mut top = 1;
        while top > 0 {
            top -= 1;
            let (t, child) = stack[top];
            if t > best.t {
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
                Kind::Triangles => self.triangles[child.index()].intersect(&space, ray, best),
                Kind::Spheres => self.spheres[child.index()].intersect(&space, ray, best),
                Kind::Instance => instances.enter::<S>(&self.instances[child.index()], best),
            }
            if ANY && best.id != known {
                return;
            }
        }
    }
}

/// What happens at the leaf of an instance. (A trait and not a closure: a closure is compiled without the instruction
/// set of the function it stands in, and would call every intrinsic out of line.)
trait Instances {
    fn enter<S: Simd>(&mut self, leaf: &InstanceLeaf, best: &mut Hit);
}

/// Goes on in the instance's own tree.
struct Nested<'a, const ANY: bool> {
    tree: &'a Tree,
    ray: &'a Ray,
    stack: &'a mut Stack,
}

impl<const ANY: bool> Instances for Nested<'_, ANY> {
    #[inline(always)]
    fn enter<S: Simd>(&mut self, leaf: &InstanceLeaf, best: &mut Hit) {
        let mut found = Hit { id: Id::NONE, ..*best };
        self.tree.walk::<S, ANY>(leaf.root, &leaf.localize(self.ray), self.stack, &mut found, &mut NoInstances);
        if found.id != Id::NONE {
            *best = Hit { id: Id { object: leaf.object, ..found.id }, ..found };
        }
    }
}

/// Trees of instances hold no instances.
struct NoInstances;

impl Instances for NoInstances {
    #[inline(always)]
    fn enter<S: Simd>(&mut self, _: &InstanceLeaf, _: &mut Hit) {}
}

impl TriangleBlock {
    #[inline(always)]
    fn intersect<S: Simd>(&self, space: &Prepared<S>, ray: &Ray, best: &mut Hit) {
        let [a, b, c] = [0, 1, 2].map(|i| Vec3x8::<S>::load(&self.vertices[i]).sub(space.origin));
        let (e0, e1, e2) = (c.sub(a), a.sub(b), b.sub(c));
        let d = space.direction;
        // Edge functions: weights of b, c and a, up to a common factor.
        let wb = c.add(a).cross(e0).dot(d);
        let wc = a.add(b).cross(e1).dot(d);
        let wa = b.add(c).cross(e2).dot(d);
        let zero = S::splat(0.0);
        let least = wa.min(wb).min(wc);
        let most = wa.max(wb).max(wc);
        let mut mask = zero.le(least) | most.le(zero);
        if mask == 0 {
            return;
        }
        let normal = e0.cross(e1);
        let t = a.dot(normal).div(d.dot(normal));
        mask &= S::splat(ray.t_min).lt(t) & t.lt(S::splat(best.t));
        if mask == 0 {
            return;
        }
        let total = wa.add(wb).add(wc);
        let (t, u, v) = (t.store(), wb.div(total).store(), wc.div(total).store());
        while mask != 0 {
            let i = mask.trailing_zeros() as usize & 7;
            mask &= mask - 1;
            if t[i] < best.t && self.ids[i] != ray.skip && u[i].is_finite() && v[i].is_finite() {
                *best = Hit { t: t[i], u: u[i], v: v[i], id: self.ids[i] };
            }
        }
    }
}

impl SphereBlock {
    #[inline(always)]
    fn intersect<S: Simd>(&self, space: &Prepared<S>, ray: &Ray, best: &mut Hit) {
        let radius = S::load(&self.radii);
        let d = space.direction;
        let f = space.origin.sub(Vec3x8::load(&self.centers));
        let a = d.dot(d);
        let zero = S::splat(0.0);
        let b = zero.sub(f.dot(d));
        let nearest = f.add(d.scale(b.div(a)));
        let discriminant = radius.mul(radius).sub(nearest.dot(nearest));
        let hit = zero.le(discriminant);
        if hit == 0 {
            return;
        }
        let q = b.add(a.mul(discriminant).sqrt().copysign(b));
        let c = f.dot(f).sub(radius.mul(radius));
        let (t0, t1) = (c.div(q), q.div(a));
        let (near, far) = (t0.min(t1), t0.max(t1));
        let t_min = S::splat(ray.t_min);
        let t = t_min.select_lt(near, near, far);
        let mut mask = hit & t_min.lt(t) & t.lt(S::splat(best.t));
        if mask == 0 {
            return;
        }
        let t = t.store();
        while mask != 0 {
            let i = mask.trailing_zeros() as usize & 7;
            mask &= mask - 1;
            if t[i] < best.t && self.ids[i] != ray.skip {
                *best = Hit { t: t[i], u: 0.0, v: 0.0, id: self.ids[i] };
            }
        }
    }
}
