//! What rays that go the same way have in common: where any of them may enter a box.
//!
//! Intervals of origins and directions stand in for numbers ([Boulos, Wald, Shirley 2006] "Geometric and Arithmetic Culling
//! Methods for Entire Ray Packets"). Many neighbours together find by them where they come into the tree, as in [Reshetov,
//! Soupikov, Hurley 2005] "Multi-Level Ray Tracing Algorithm", and go on from there in packets.

use super::bvh::{Child, Node, Octant, Sides};
use super::kernel;
use super::rays::Group;
use super::simd::{Lanes, Simd, Vec3s};
use super::traverse::Tree;

/// Intervals of origins and directions, lane by lane, turned such that all directions are positive.
#[derive(Clone, Copy)]
pub(super) struct Span<L> {
    octant: Octant,
    /// One in all lanes, with the signs of the directions.
    sign: Vec3s<L>,
    /// Origins and directions.
    least: (Vec3s<L>, Vec3s<L>),
    most: (Vec3s<L>, Vec3s<L>),
}

impl<L: Lanes> Span<L> {
    /// That of rays whose directions all have the signs of an octant.
    #[inline(always)]
    pub fn of(group: &Group<L>, octant: Octant) -> Self {
        let &Group { origin, direction, .. } = group;
        let one = L::splat(1.0);
        let sign = Vec3s { x: one.copysign(direction.x), y: one.copysign(direction.y), z: one.copysign(direction.z) };
        let ends = (sane(origin.mul(sign), f32::NEG_INFINITY), sane(direction.mul(sign), 0.0));
        Span { octant, sign, least: ends, most: ends }
    }

    /// Takes in more rays of the same octant.
    #[inline(always)]
    pub fn include(&mut self, other: &Span<L>) {
        self.least = (self.least.0.min(other.least.0), self.least.1.min(other.least.1));
        self.most = (self.most.0.max(other.most.0), self.most.1.max(other.most.1));
    }
}

/// What is not a number is the least that there is: such a ray meets nothing, and narrows no interval.
#[inline(always)]
fn sane<L: Lanes>(v: Vec3s<L>, least: f32) -> Vec3s<L> {
    v.max(Vec3s::of([least; 3]))
}

/// A ray that enters boxes no later and leaves them no earlier than any of many.
#[derive(Clone, Copy)]
pub(super) struct Hull<S> {
    pub octant: Octant,
    pub sides: Sides,
    enter: (Vec3s<S>, Vec3s<S>),
    leave: (Vec3s<S>, Vec3s<S>),
}

impl<S: Simd> Hull<S> {
    /// With directions of positive sign a box is entered the earliest by the origin that lies farthest and the smallest
    /// inverse, unless it lies behind, where all is cut off at 0; it is left the latest by the opposite.
    #[inline(always)]
    pub fn around<L: Lanes>(span: &Span<L>) -> Self {
        let Span { octant, sign, least, most } = span;
        let (x, y, z) = (sign.x.store().as_ref()[0], sign.y.store().as_ref()[0], sign.z.store().as_ref()[0]);
        let sign = S::load(&[x, y, z, x, y, z, 1.0, 1.0]);
        let [least, most] = [least, most].map(|(o, d)| [o.x, o.y, o.z, d.x, d.y, d.z, d.x, d.x]);
        let (enter, leave) = (S::load(&L::mosts(most)).mul(sign), S::load(&L::leasts(least)).mul(sign));
        // Of numbers of one sign, the greatest has the smallest inverse.
        let (less, more) = (kernel::inverse(enter).enter.store(), kernel::inverse(leave).leave.store());
        let ([ex, ey, ez, ..], [lx, ly, lz, ..]) = (enter.store(), leave.store());
        let ([.., dx, dy, dz, _, _], [.., mx, my, mz, _, _]) = (less, more);
        Hull {
            octant: *octant,
            sides: octant.sides(),
            enter: (Vec3s::of([ex, ey, ez]), Vec3s::of([dx, dy, dz])),
            leave: (Vec3s::of([lx, ly, lz]), Vec3s::of([mx, my, mz])),
        }
    }

    /// The children of a node that any of the rays may enter: their slots, from the farthest to the nearest, and how many
    /// they are.
    #[inline(always)]
    pub fn enters(&self, node: &Node) -> ([u32; 8], usize) {
        const SLOTS: [u32; 8] = [0, 1, 2, 3, 4, 5, 6, 7];
        let near = node.near(self.sides).sub(self.enter.0).mul(self.enter.1);
        let far = node.far(self.sides).sub(self.leave.0).mul(self.leave.1);
        let enter = near.x.max(near.y).max(near.z.max(S::splat(0.0)));
        let leave = far.x.min(far.y).min(far.z);
        let (mut values, mut slots) = ([0.0; 8], [0; 8]);
        let count = enter.pack(leave, &node.order, self.octant.shift(), &SLOTS, &mut values, &mut slots);
        (slots, count)
    }

    /// Goes down the tree as long as there is but one way: to the node at which the rays may part or come to a leaf, or to
    /// [`Child::NONE`] if they enter nothing. The rest of the tree concerns none of them.
    #[inline(always)]
    pub fn gate(&self, tree: &Tree) -> Child {
        let mut gate = tree.root;
        while gate.is_node() {
            let node = &tree.nodes[gate.index()];
            let (slots, count) = self.enters(node);
            let next = node.child(slots[0] as usize);
            match count {
                0 => return Child::NONE,
                1 if next.is_node() => gate = next,
                _ => break,
            }
        }
        gate
    }
}
