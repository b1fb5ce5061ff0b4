//! Builds the hierarchy: a binary tree by the surface area heuristic, of which [`collapse`] makes wide nodes.
//!
//! Binned splits as in [Wald 2007] "On fast Construction of SAH-based Bounding Volume Hierarchies". The top of the tree is
//! split until *treelets* of some thousand primitives are left; each is built, collapsed and written in one go while it
//! lies in the cache, and then has its place in the tree. Whatever the number of threads, the tree is the same.

use std::ops::Range;

use glam::Vec4;
use rayon::prelude::*;

use super::bvh::{Aabb, Child, Kind, Node};
use super::collapse::{Binary, Content, collapse};
use super::pages;

/// Most bins per axis. Small ranges have fewer, since looking at the bins would take longer than filling them.
const BINS: usize = 32;
/// Past this depth ranges are halved, so that no input can make a deeper tree than this plus 32.
const SAH_DEPTH: u32 = 48;
/// Depth that no tree exceeds; the traversal's stack is sized by it.
pub(crate) const MAX_DEPTH: usize = SAH_DEPTH as usize + 32;
/// Primitives of a treelet, at most.
const TREELET: usize = 1024;
/// Treelets that are built at a time, so that no more than these wait for their place.
const BATCH: usize = 256;
/// Ranges longer than this are counted in pieces of this length by all threads.
const PIECE: usize = 1 << 13;

/// A primitive of the builder: its box, and its index as two halves in the fourth components.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Item(Extent);

impl Item {
    pub fn new(bounds: Aabb, index: u32) -> Item {
        // Numbers and not bits: what looks like a tiny number is slow to compute with.
        let (low, high) = ((index & 0xffff) as f32, (index >> 16) as f32);
        Item(Extent { min: bounds.min.extend(low), max: bounds.max.extend(high) })
    }

    pub fn index(&self) -> u32 {
        (self.0.max.w as u32) << 16 | self.0.min.w as u32
    }

    pub fn bounds(&self) -> Aabb {
        self.0.aabb()
    }

    pub fn is_finite(&self) -> bool {
        self.0.min.is_finite() && self.0.max.is_finite()
    }

    #[inline(always)]
    fn center(&self) -> Vec4 {
        // Halves first: the sum of two large coordinates may overflow.
        self.0.min * 0.5 + self.0.max * 0.5
    }
}

/// A box in the form that the processor computes with; the fourth components mean nothing.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    min: Vec4,
    max: Vec4,
}

impl Extent {
    const EMPTY: Extent = Extent { min: Vec4::INFINITY, max: Vec4::NEG_INFINITY };

    #[inline(always)]
    fn union(self, other: Extent) -> Extent {
        Extent { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    #[inline(always)]
    fn extend(self, point: Vec4) -> Extent {
        self.union(Extent { min: point, max: point })
    }

    /// Half of the surface area; zero for the empty box.
    pub fn half_area(self) -> f32 {
        let d = (self.max - self.min).max(Vec4::ZERO);
        d.x * d.y + d.y * d.z + d.z * d.x
    }

    pub fn aabb(self) -> Aabb {
        Aabb { min: self.min.truncate(), max: self.max.truncate() }
    }
}

/// Boxes around a range of items and around their centres.
#[derive(Debug, Clone, Copy)]
struct Cover {
    bounds: Extent,
    centers: Extent,
}

impl Cover {
    const EMPTY: Cover = Cover { bounds: Extent::EMPTY, centers: Extent::EMPTY };

    #[inline(always)]
    fn add(&mut self, item: &Item) {
        self.bounds = self.bounds.union(item.0);
        self.centers = self.centers.extend(item.center());
    }

    fn of(items: &[Item]) -> Cover {
        let piece = |items: &[Item]| {
            let mut cover = Cover::EMPTY;
            items.iter().for_each(|item| cover.add(item));
            cover
        };
        let union =
            |a: Cover, b: Cover| Cover { bounds: a.bounds.union(b.bounds), centers: a.centers.union(b.centers) };
        if items.len() <= PIECE {
            piece(items)
        } else {
            items.par_chunks(PIECE).map(piece).reduce(|| Cover::EMPTY, union)
        }
    }
}

/// Which bin an item falls into, by axis.
#[derive(Debug, Clone, Copy)]
struct Binning {
    origin: Vec4,
    scale: Vec4,
    /// How many bins there are.
    count: usize,
}

/// A bin: the box around what is in it, and how much that is.
type Bin = (Extent, u32);
type Bins = [[Bin; BINS]; 3];

const NO_BIN: Bin = (Extent::EMPTY, 0);

#[inline(always)]
fn add(bin: &mut Bin, item: &Item) {
    *bin = (bin.0.union(item.0), bin.1 + 1);
}

impl Binning {
    fn new(centers: Extent, items: usize) -> Binning {
        let count = (4 + items / 16).min(BINS);
        let extent = centers.max - centers.min;
        let scale = |extent: f32| {
            let scale = count as f32 * 0.9999 / extent;
            if extent > 0.0 && scale.is_finite() { scale } else { 0.0 }
        };
        let scale = Vec4::new(scale(extent.x), scale(extent.y), scale(extent.z), 0.0);
        Binning { origin: centers.min, scale, count }
    }

    #[inline(always)]
    fn bins(&self, item: &Item) -> [usize; 3] {
        let (at, last) = ((item.center() - self.origin) * self.scale, self.count - 1);
        [(at.x as i32 as usize).min(last), (at.y as i32 as usize).min(last), (at.z as i32 as usize).min(last)]
    }

    /// Sorts items into as many bins as there are; the others keep what they hold.
    fn fill(&self, items: &[Item], bins: &mut Bins) {
        bins.iter_mut().for_each(|bins| bins[..self.count].fill(NO_BIN));
        for item in items {
            let [x, y, z] = self.bins(item);
            add(&mut bins[0][x % BINS], item);
            add(&mut bins[1][y % BINS], item);
            add(&mut bins[2][z % BINS], item);
        }
    }

    /// The same on all threads where there are many.
    fn fill_by_all(&self, items: &[Item], bins: &mut Bins) {
        if items.len() <= PIECE {
            return self.fill(items, bins);
        }
        let count = |items: &[Item]| {
            let mut bins = [[NO_BIN; BINS]; 3];
            self.fill(items, &mut bins);
            bins
        };
        let merge = |mut a: Bins, b: Bins| {
            for (a, b) in a.iter_mut().flatten().zip(b.into_iter().flatten()) {
                *a = (a.0.union(b.0), a.1 + b.1);
            }
            a
        };
        *bins = items.par_chunks(PIECE).map(count).reduce(|| [[NO_BIN; BINS]; 3], merge);
    }

    /// Sorts items into those up to the last bin of the left side and the others; returns how many are on the left, and the
    /// boxes around the centres of both sides.
    fn part<const AXIS: usize>(&self, items: &mut [Item], last: usize) -> (usize, [Extent; 2]) {
        let component = |v: Vec4| v.to_array()[AXIS];
        let (origin, scale, limit) = (component(self.origin), component(self.scale), (last + 1) as f32);
        let (mut left, mut right, mut middle) = (Extent::EMPTY, Extent::EMPTY, 0);
        for i in 0..items.len() {
            let item = items[i];
            let at = (component(item.0.min) * 0.5 + component(item.0.max) * 0.5 - origin) * scale;
            let is_left = at < limit;
            // Every item changes places with the first of the right side, and is taken into both boxes, but into the wrong
            // one from infinitely far: that takes no guess of the processor's.
            items.swap(i, middle);
            middle += usize::from(is_left);
            let far = |far: bool| f32::from_bits(u32::from(far) * f32::INFINITY.to_bits());
            let (off_left, off_right) = (far(!is_left), far(is_left));
            let center = item.center();
            left.min = left.min.min(center + off_left);
            left.max = left.max.max(center - off_left);
            right.min = right.min.min(center + off_right);
            right.max = right.max.max(center - off_right);
        }
        (middle, [left, right])
    }

    /// The axis and the last bin of the left side of the cheapest split.
    fn cheapest(&self, bins: &Bins) -> Option<(usize, usize)> {
        let mut best = (f32::INFINITY, None);
        for (axis, bins) in bins.iter().enumerate() {
            if self.scale[axis] > 0.0 {
                let (cost, split) = cheapest_split(&bins[..self.count]);
                if cost < best.0 {
                    best = (cost, Some((axis, split)));
                }
            }
        }
        best.1
    }
}

/// The cost of the cheapest split of one axis, and the last bin of its left side.
fn cheapest_split(bins: &[Bin]) -> (f32, usize) {
    let mut right = [0.0f32; BINS];
    let mut side = (Extent::EMPTY, 0);
    for i in (1..bins.len()).rev() {
        side = (side.0.union(bins[i].0), side.1 + bins[i].1);
        // Where nothing is on one side, the split is none.
        right[i] = if side.1 == 0 { f32::INFINITY } else { side.0.half_area() * side.1 as f32 };
    }
    let mut best = (f32::INFINITY, 0);
    let mut side = (Extent::EMPTY, 0);
    for i in 0..bins.len() - 1 {
        side = (side.0.union(bins[i].0), side.1 + bins[i].1);
        let cost = side.0.half_area() * side.1 as f32 + right[i + 1];
        if side.1 > 0 && cost < best.0 {
            best = (cost, i);
        }
    }
    best
}

/// Sorts `items` into two sides by the cheapest of all binned splits, and returns how many are on the left, and the covers of
/// both sides. Where no split separates anything, or where the tree is deep, they are halved as they lie.
fn split(items: &mut [Item], cover: &Cover, depth: u32, bins: &mut Bins) -> (usize, [Cover; 2]) {
    let binning = Binning::new(cover.centers, items.len());
    let mut best = None;
    if depth < SAH_DEPTH && items.len() > 2 {
        binning.fill_by_all(items, bins);
        best = binning.cheapest(bins);
    }
    if let Some((axis, last)) = best {
        let (middle, centers) = match axis {
            0 => binning.part::<0>(items, last),
            1 => binning.part::<1>(items, last),
            _ => binning.part::<2>(items, last),
        };
        if middle > 0 && middle < items.len() {
            let union = |bins: &[Bin]| bins.iter().fold(Extent::EMPTY, |all, bin| all.union(bin.0));
            let (left, right) = bins[axis][..binning.count].split_at(last + 1);
            let [left, right] = [(union(left), centers[0]), (union(right), centers[1])];
            return (middle, [left, right].map(|(bounds, centers)| Cover { bounds, centers }));
        }
    }
    let middle = items.len() / 2;
    let (left, right) = items.split_at(middle);
    (middle, [Cover::of(left), Cover::of(right)])
}

/// Adds a tree over `items` to `nodes` and `blocks`, and returns its root and bounds. `block` makes a leaf's block of at
/// most `leaf_size` items, which are at most eight.
pub(crate) fn build<B: Send>(
    mut items: Vec<Item>,
    (kind, leaf_size): (Kind, usize),
    nodes: &mut Vec<Node>,
    blocks: &mut Vec<B>,
    block: &(impl Fn(&[Item]) -> B + Sync),
) -> Option<(Child, Aabb)> {
    if items.is_empty() {
        return None;
    }
    let cover = Cover::of(&items);
    let mut top = Vec::new();
    let range = 0..items.len();
    top_down(&mut items, range, &cover, 0, &mut top);
    let count = items.len();
    let (mut rest, mut done) = (&mut items[..], 0);
    let mut ranges = Vec::new();
    for terminal in top.iter_mut() {
        if let Content::Items { count, .. } = terminal.content {
            let (items, others) = rest.split_at_mut(count as usize);
            rest = others;
            ranges.push((items, terminal));
        }
    }
    let (nodes_before, blocks_before) = (nodes.len(), blocks.len());
    for batch in ranges.chunks_mut(BATCH) {
        let treelets: Vec<_> = batch
            .par_iter_mut()
            .map(|(items, terminal)| Treelet::build(items, terminal.depth, (kind, leaf_size), block))
            .collect();
        done += batch.iter().map(|(items, _)| items.len()).sum::<usize>();
        for ((_, terminal), treelet) in batch.iter_mut().zip(treelets) {
            terminal.content = Content::Done { root: treelet.append(nodes, blocks) };
        }
        // By what there is so far we know how much there will be.
        let ahead = |length: usize| (length as f64 * (count - done) as f64 / done as f64) as usize;
        if done < count {
            reserve(nodes, ahead(nodes.len() - nodes_before));
            reserve(blocks, ahead(blocks.len() - blocks_before));
        }
    }
    let root = match top[..] {
        [Binary { content: Content::Done { root }, .. }] => root,
        _ => collapse(&top, leaf_size, nodes, &mut |_| unreachable!("the leaves are in the treelets")),
    };
    Some((root, top[0].bounds.aabb()))
}

/// Makes room for so many more and some: memory that nothing is written to costs nothing, whereas to grow takes twice as
/// much for a while.
fn reserve<T>(list: &mut Vec<T>, more: usize) {
    if list.capacity() - list.len() < more {
        list.reserve_exact(more + more / 8 + 16);
        pages::enlarge(list);
    }
}

/// Splits a range down to treelets.
fn top_down(items: &mut [Item], range: Range<usize>, cover: &Cover, depth: u32, top: &mut Vec<Binary>) {
    let at = top.len();
    let content = Content::Items { first: range.start as u32, count: range.len() as u32 };
    top.push(Binary { bounds: cover.bounds, depth, content });
    if range.len() <= TREELET {
        return;
    }
    let (middle, [left_cover, right_cover]) = split(items, cover, depth, &mut [[NO_BIN; BINS]; 3]);
    let (left, right) = items.split_at_mut(middle);
    let middle = range.start + middle;
    let (mut a, mut b) = (Vec::new(), Vec::new());
    rayon::join(
        || top_down(left, range.start..middle, &left_cover, depth + 1, &mut a),
        || top_down(right, middle..range.end, &right_cover, depth + 1, &mut b),
    );
    let children = [a, b].map(|subtree| {
        let offset = top.len() as u32;
        top.extend(subtree.into_iter().map(|node| node.shifted(offset)));
        offset
    });
    top[at].content = Content::Children(children);
}

/// A part of the tree with indices of its own.
struct Treelet<B> {
    root: Child,
    nodes: Vec<Node>,
    blocks: Vec<B>,
}

impl<B> Treelet<B> {
    fn build(items: &mut [Item], depth: u32, (kind, leaf_size): (Kind, usize), block: &impl Fn(&[Item]) -> B) -> Self {
        let mut binary = Vec::with_capacity(2 * items.len());
        let cover = Cover::of(items);
        descend(items, 0, (&cover, depth), leaf_size.min(2), &mut [[NO_BIN; BINS]; 3], &mut binary);
        let (mut nodes, mut blocks) = (Vec::new(), Vec::new());
        let root = collapse(&binary, leaf_size, &mut nodes, &mut |range| {
            blocks.push(block(&items[range]));
            Child::leaf(kind, blocks.len() - 1)
        });
        Treelet { root, nodes, blocks }
    }

    /// Moves it behind others and returns its root there.
    fn append(self, nodes: &mut Vec<Node>, blocks: &mut Vec<B>) -> Child {
        let (before, blocks_before) = (nodes.len(), blocks.len());
        let shift = |child: Child| child.shifted(before, blocks_before);
        let codes = |codes: [u32; 8]| codes.map(|code| shift(Child::of(code)).code());
        nodes.extend(self.nodes.into_iter().map(|node| Node { codes: codes(node.codes), ..node }));
        blocks.extend(self.blocks);
        shift(self.root)
    }
}

/// Splits a range until no part is longer than `least`. (Pairs that fit a leaf are as good as single items, and half as many.)
fn descend(
    items: &mut [Item],
    first: u32,
    (cover, depth): (&Cover, u32),
    least: usize,
    bins: &mut Bins,
    binary: &mut Vec<Binary>,
) -> u32 {
    let at = binary.len();
    let content = Content::Items { first, count: items.len() as u32 };
    binary.push(Binary { bounds: cover.bounds, depth, content });
    if items.len() > least {
        let (middle, [left_cover, right_cover]) = split(items, cover, depth, bins);
        let (left, right) = items.split_at_mut(middle);
        let left = descend(left, first, (&left_cover, depth + 1), least, bins, binary);
        let right = descend(right, first + middle as u32, (&right_cover, depth + 1), least, bins, binary);
        binary[at].content = Content::Children([left, right]);
    }
    at as u32
}
