//! The bounding hierarchy: nodes of eight children, whose leaves hold one block of up to eight primitives of one kind, so
//! that a leaf costs one pass of the kernels. [`super::build`] makes it.

use glam::Vec3;

use super::simd::{Simd, Vec3s};

/// An axis-aligned box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Aabb {
    pub min: Vec3,
    pub max: Vec3,
}

impl Aabb {
    /// The box around nothing.
    pub const EMPTY: Aabb = Aabb { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    pub fn around(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Aabb::EMPTY, Aabb::extend)
    }

    pub fn extend(self, p: Vec3) -> Self {
        Aabb { min: self.min.min(p), max: self.max.max(p) }
    }

    /// A box that is a little larger: what holds for points within a few roundings of this one's size holds in it.
    pub fn padded(self) -> Aabb {
        let pad = Vec3::splat((self.max - self.min).max_element() * (2.0 * f32::EPSILON));
        let (min, max) = (self.min - pad, self.max + pad);
        // Where a rounding of the coordinates is more than that, it is one of them.
        let (down, up) = (self.min.map(f32::next_down), self.max.map(f32::next_up));
        Aabb { min: min.min(down), max: max.max(up) }
    }

    fn center(self) -> Vec3 {
        // Halves first: the sum of two large coordinates may overflow.
        self.min * 0.5 + self.max * 0.5
    }

    pub fn is_finite(self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    pub fn corners(self) -> [Vec3; 8] {
        std::array::from_fn(|i| {
            Vec3::new(
                if i & 1 == 0 { self.min.x } else { self.max.x },
                if i & 2 == 0 { self.min.y } else { self.max.y },
                if i & 4 == 0 { self.min.z } else { self.max.z },
            )
        })
    }
}

/// What a leaf holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Kind {
    Triangles = 0,
    Spheres = 1,
    Instance = 2,
    Analytic = 3,
}

impl Kind {
    /// Whether rays go there one by one.
    #[inline(always)]
    pub fn is_alone(self) -> bool {
        matches!(self, Kind::Instance | Kind::Analytic)
    }
}

/// A child of a node: another node, a leaf, or nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Child(u32);

impl Child {
    /// No child. Its box is inverted, so no ray ever asks.
    pub const NONE: Child = Child(u32::MAX);
    const LEAF: u32 = 1 << 31;
    const INDEX: u32 = (1 << 29) - 1;

    /// The child as a number.
    pub const fn code(self) -> u32 {
        self.0
    }

    /// The child of a number that was one.
    pub const fn of(code: u32) -> Child {
        Child(code)
    }

    pub fn node(index: usize) -> Child {
        debug_assert!(index as u32 <= Self::INDEX);
        Child(index as u32)
    }

    pub fn leaf(kind: Kind, block: usize) -> Child {
        debug_assert!(block as u32 <= Self::INDEX);
        Child(Self::LEAF | (kind as u32) << 29 | block as u32)
    }

    #[inline(always)]
    pub fn is_node(self) -> bool {
        self.0 & Self::LEAF == 0
    }

    #[inline(always)]
    pub fn index(self) -> usize {
        (self.0 & Self::INDEX) as usize
    }

    /// The same child where so many nodes and blocks come before its own.
    pub fn shifted(self, nodes: usize, blocks: usize) -> Child {
        if self == Child::NONE {
            self
        } else if self.is_node() {
            Child::node(self.index() + nodes)
        } else {
            Child::leaf(self.kind(), self.index() + blocks)
        }
    }

    #[inline(always)]
    pub fn kind(self) -> Kind {
        match self.0 >> 29 & 3 {
            0 => Kind::Triangles,
            1 => Kind::Spheres,
            2 => Kind::Instance,
            _ => Kind::Analytic,
        }
    }
}

/// Eight boxes and what is in them.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(crate) struct Node {
    /// Sides of the boxes of all children: the least x, the greatest x, the least y and so on.
    pub sides: [[f32; 8]; 6],
    /// The children, as [`Child::code`].
    pub codes: [u32; 8],
    /// The children from the farthest to the nearest, for rays of each octant: the slot at each place, in three bits for
    /// each octant. See [`Octant`].
    pub order: [u32; 8],
}

/// Which components of a direction are negative, as the bits x, y and z.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Octant(pub u32);

impl Octant {
    #[inline(always)]
    pub fn new([x, y, z]: [bool; 3]) -> Octant {
        Octant(u32::from(x) | u32::from(y) << 1 | u32::from(z) << 2)
    }

    /// Which [`Node::sides`] its rays cross first.
    #[inline(always)]
    pub fn sides(self) -> Sides {
        Sides([self.0 & 1, 2 + (self.0 >> 1 & 1), 4 + (self.0 >> 2 & 1)])
    }

    /// Where the octant's slots lie in [`Node::order`].
    #[inline(always)]
    pub fn shift(self) -> u32 {
        self.0 * 3
    }
}

/// Which of [`Node::sides`] rays of an octant cross first, by axis; opposite to each lies the one with the last bit turned.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sides(pub [u32; 3]);

impl Node {
    /// The sides of all children that are crossed first.
    #[inline(always)]
    pub fn near<S: Simd>(&self, Sides([x, y, z]): Sides) -> Vec3s<S> {
        let sides = &self.sides;
        Vec3s { x: S::load(&sides[x as usize]), y: S::load(&sides[y as usize]), z: S::load(&sides[z as usize]) }
    }

    /// The sides of all children that are crossed last.
    #[inline(always)]
    pub fn far<S: Simd>(&self, Sides([x, y, z]): Sides) -> Vec3s<S> {
        self.near(Sides([x ^ 1, y ^ 1, z ^ 1]))
    }

    #[inline(always)]
    pub fn child(&self, slot: usize) -> Child {
        Child(self.codes[slot & 7])
    }

    /// A node without children: their boxes are inverted and never hit.
    pub const EMPTY: Node = {
        let (min, max) = ([f32::INFINITY; 8], [f32::NEG_INFINITY; 8]);
        Node { sides: [min, max, min, max, min, max], codes: [Child::NONE.code(); 8], order: [0; 8] }
    };

    /// A node with these children, at most eight.
    pub fn new(children: &[(Aabb, Child)]) -> Node {
        let mut node = Node::EMPTY;
        let mut centers = [[0.0; 8]; 3];
        for (slot, &(bounds, child)) in children.iter().enumerate() {
            let center = bounds.center();
            for axis in 0..3 {
                node.sides[2 * axis][slot] = bounds.min[axis];
                node.sides[2 * axis + 1][slot] = bounds.max[axis];
                centers[axis][slot] = center[axis];
            }
            node.codes[slot] = child.code();
        }
        for octant in (0..8).map(Octant) {
            let distances = octant.distances(&centers, children.len());
            for (slot, place) in places(distances).into_iter().enumerate() {
                node.order[place as usize % 8] |= (slot as u32) << octant.shift();
            }
        }
        node
    }
}

impl Octant {
    /// How far away eight points lie for its rays, of which the first `count` are there: integers in the order of
    /// [`f32::total_cmp`], so that any distances can be sorted.
    fn distances(self, [x, y, z]: &[[f32; 8]; 3], count: usize) -> [i32; 8] {
        let [sx, sy, sz] = [0, 1, 2].map(|axis| if self.0 >> axis & 1 == 0 { 1.0f32 } else { -1.0 });
        let mut distances = [0; 8];
        for slot in 0..8 {
            let distance = x[slot] * sx + y[slot] * sy + z[slot] * sz;
            // What is not there is farther away than anything.
            let distance = if slot < count { distance } else { f32::INFINITY };
            let bits = distance.to_bits() as i32;
            // Negative numbers have the order of their bits turned round.
            distances[slot] = bits ^ (bits >> 31 & i32::MAX);
        }
        distances
    }
}

/// The place of each of eight numbers when they are sorted from the greatest to the least, equals as they lie.
fn places(numbers: [i32; 8]) -> [i32; 8] {
    let mut places = [0; 8];
    for (j, &other) in numbers.iter().enumerate() {
        for (i, &number) in numbers.iter().enumerate() {
            places[i] += i32::from(other > number) + i32::from(other == number && j < i);
        }
    }
    places
}
