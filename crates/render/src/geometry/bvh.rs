//! The bounding hierarchy: a binary tree by the surface area heuristic, collapsed to nodes of eight children.
//!
//! Binned SAH as in [Wald 2007] "On fast Construction of SAH-based Bounding Volume Hierarchies"; the collapse opens
//! the child of largest area first, as in [Wald et al. 2008] "Getting Rid of Packets".
//! Leaves hold one block of up to eight primitives of one kind, so that a leaf costs one pass of the kernels.

use glam::Vec3;

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

    pub fn union(self, other: Aabb) -> Aabb {
        Aabb { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Half of the surface area; zero for the empty box.
    fn half_area(self) -> f32 {
        let d = (self.max - self.min).max(Vec3::ZERO);
        d.x * d.y + d.y * d.z + d.z * d.x
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

/// A child of a node: another node, a leaf, or nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Child(u32);

impl Child {
    /// No child. Its box is inverted, so no ray ever asks.
    pub const NONE: Child = Child(u32::MAX);
    const LEAF: u32 = 1 << 31;
    const INDEX: u32 = (1 << 29) - 1;

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
    /// `[axis][0 = min, 1 = max][child]`.
    pub bounds: [[[f32; 8]; 2]; 3],
    pub children: [Child; 8],
}

impl Node {
    /// A node without children; its boxes are inverted and never hit.
    pub const EMPTY: Node =
        Node { bounds: [[[f32::INFINITY; 8], [f32::NEG_INFINITY; 8]]; 3], children: [Child::NONE; 8] };

    pub fn set(&mut self, slot: usize, bounds: Aabb, child: Child) {
        for axis in 0..3 {
            self.bounds[axis][0][slot] = bounds.min[axis];
            self.bounds[axis][1][slot] = bounds.max[axis];
        }
        self.children[slot] = child;
    }
}

/// A node of the binary tree that is collapsed afterwards.
#[derive(Clone, Copy)]
struct BinaryNode {
    bounds: Aabb,
    /// The primitives below it, as a range of the reordered list.
    first: u32,
    count: u32,
    /// Indices of its children; none where the primitives fit one leaf.
    children: Option<[u32; 2]>,
}

/// Bins per axis. More bins gain less than 1 % in cost.
const BINS: usize = 16;
/// Past this depth ranges are halved, so that no input can make a deeper tree than this plus 32.
const SAH_DEPTH: u32 = 48;
/// Depth that no tree exceeds; the traversal's stack is sized by it.
pub(crate) const MAX_DEPTH: usize = SAH_DEPTH as usize + 32;
/// Ranges longer than this are built by two threads.
const PARALLEL: usize = 8192;

/// A primitive of the builder: its box, its centre and its index.
#[derive(Clone, Copy)]
pub(crate) struct Item {
    pub bounds: Aabb,
    pub index: u32,
}

impl Item {
    fn center(&self) -> Vec3 {
        // Halves first: the sum of two large coordinates may overflow.
        self.bounds.min * 0.5 + self.bounds.max * 0.5
    }
}

/// Adds a tree over `items` to `nodes` and returns its root and bounds; `leaf` turns up to `leaf_size` items into a leaf.
pub(crate) fn build(
    items: &mut [Item],
    leaf_size: usize,
    nodes: &mut Vec<Node>,
    leaf: &mut dyn FnMut(&[Item]) -> Child,
) -> Option<(Child, Aabb)> {
    if items.is_empty() {
        return None;
    }
    let mut binary = Vec::with_capacity(items.len() / leaf_size.max(1) * 3);
    build_range(items, 0, leaf_size, 0, &mut binary);
    Some((collapse(&binary, 0, items, nodes, leaf), binary[0].bounds))
}

/// Builds one range depth first, appends it to `nodes` and returns the index of its root.
fn build_range(items: &mut [Item], first: u32, leaf_size: usize, depth: u32, nodes: &mut Vec<BinaryNode>) -> u32 {
    let bounds = items.iter().fold(Aabb::EMPTY, |b, item| b.union(item.bounds));
    let at = nodes.len();
    nodes.push(BinaryNode { bounds, first, count: items.len() as u32, children: None });
    if items.len() <= leaf_size {
        return at as u32;
    }
    let middle = if depth < SAH_DEPTH { partition(items) } else { None }.unwrap_or(items.len() / 2);
    let parallel = items.len() > PARALLEL;
    let (left, right) = items.split_at_mut(middle);
    let build = |items, first, nodes: &mut _| build_range(items, first, leaf_size, depth + 1, nodes);
    let middle = first + middle as u32;
    let children = if parallel {
        let (mut a, mut b) = (Vec::new(), Vec::new());
        rayon::join(|| build(left, first, &mut a), || build(right, middle, &mut b));
        [append(nodes, a), append(nodes, b)]
    } else {
        [build(left, first, nodes), build(right, middle, nodes)]
    };
    nodes[at].children = Some(children);
    at as u32
}

/// Moves a subtree with indices of its own behind `nodes` and returns the new index of its root.
fn append(nodes: &mut Vec<BinaryNode>, subtree: Vec<BinaryNode>) -> u32 {
    let offset = nodes.len() as u32;
    nodes.extend(
        subtree.into_iter().map(|node| BinaryNode { children: node.children.map(|c| c.map(|i| i + offset)), ..node }),
    );
    offset
}

/// Sorts `items` into two sides by the cheapest of all binned splits; `None` where no split separates anything.
fn partition(items: &mut [Item]) -> Option<usize> {
    let centers = Aabb::around(items.iter().map(Item::center));
    let extent = centers.max - centers.min;
    let scale = Vec3::from_array(std::array::from_fn(|k| {
        let scale = BINS as f32 * 0.9999 / extent[k];
        if extent[k] > 0.0 && scale.is_finite() { scale } else { 0.0 }
    }));
    let bin =
        |item: &Item, axis: usize| (((item.center()[axis] - centers.min[axis]) * scale[axis]) as usize).min(BINS - 1);
    let mut bins = [[(Aabb::EMPTY, 0u32); BINS]; 3];
    for item in items.iter() {
        for (axis, bins) in bins.iter_mut().enumerate() {
            let slot = &mut bins[bin(item, axis)];
            *slot = (slot.0.union(item.bounds), slot.1 + 1);
        }
    }
    let (axis, split) = (0..3)
        .filter(|&axis| scale[axis] > 0.0)
        .filter_map(|axis| cheapest_split(&bins[axis]).map(|(cost, split)| (cost, axis, split)))
        .fold(None, |best: Option<(f32, usize, usize)>, (cost, axis, split)| match best {
            Some(best) if best.0 <= cost => Some(best),
            _ => Some((cost, axis, split)),
        })
        .map(|(_, axis, split)| (axis, split))?;
    let mut middle = 0;
    for i in 0..items.len() {
        if bin(&items[i], axis) <= split {
            items.swap(i, middle);
            middle += 1;
        }
    }
    (middle > 0 && middle < items.len()).then_some(middle)
}

/// The last bin of the left side, and the cost, of the cheapest split of one axis.
fn cheapest_split(bins: &[(Aabb, u32); BINS]) -> Option<(f32, usize)> {
    let mut right = [(0.0f32, 0u32); BINS];
    let mut side = (Aabb::EMPTY, 0);
    for i in (1..BINS).rev() {
        side = (side.0.union(bins[i].0), side.1 + bins[i].1);
        right[i] = (side.0.half_area(), side.1);
    }
    let mut best = None;
    let mut side = (Aabb::EMPTY, 0);
    for i in 0..BINS - 1 {
        side = (side.0.union(bins[i].0), side.1 + bins[i].1);
        let (area, count) = right[i + 1];
        if side.1 == 0 || count == 0 {
            continue;
        }
        let cost = side.0.half_area() * side.1 as f32 + area * count as f32;
        if best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, i));
        }
    }
    best
}

/// Turns the subtree at `index` into wide nodes.
fn collapse(
    binary: &[BinaryNode],
    index: u32,
    items: &[Item],
    nodes: &mut Vec<Node>,
    leaf: &mut dyn FnMut(&[Item]) -> Child,
) -> Child {
    let node = binary[index as usize];
    let Some(children) = node.children else {
        return leaf(&items[node.first as usize..][..node.count as usize]);
    };
    let mut open = children.to_vec();
    while open.len() < 8 {
        let widest = open
            .iter()
            .enumerate()
            .filter(|(_, i)| binary[**i as usize].children.is_some())
            .map(|(slot, i)| (binary[*i as usize].bounds.half_area(), slot))
            .reduce(|a, b| if b.0 > a.0 { b } else { a });
        let Some((_, slot)) = widest else { break };
        let [left, right] = binary[open[slot] as usize].children.expect("only inner nodes are opened");
        open[slot] = left;
        open.push(right);
    }
    let at = nodes.len();
    nodes.push(Node::EMPTY);
    for (slot, &child) in open.iter().enumerate() {
        let code = collapse(binary, child, items, nodes, leaf);
        nodes[at].set(slot, binary[child as usize].bounds, code);
    }
    Child::node(at)
}
