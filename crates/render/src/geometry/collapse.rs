//! Collapses a binary tree to nodes of eight children, of all ways the one of least cost.
//!
//! The dynamic program of [Ylitie, Karras, Laine 2017] "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide
//! BVHs", section 3: of every subtree we know what it costs as one child of a node, as two, and so on up to seven.

use std::ops::Range;

use super::build::Extent;
use super::bvh::{Child, Node};

/// A node of the binary tree. Children come after their parents.
#[derive(Debug, Clone, Copy)]
pub(super) struct Binary {
    pub bounds: Extent,
    /// How many nodes lie above it.
    pub depth: u32,
    pub content: Content,
}

/// What is in it.
#[derive(Debug, Clone, Copy)]
pub(super) enum Content {
    Children([u32; 2]),
    /// A range of the items, which is all that lies below.
    Items {
        first: u32,
        count: u32,
    },
    /// It has its place in the tree.
    Done {
        root: Child,
    },
}

impl Binary {
    /// The same node where so many come before its own.
    pub fn shifted(self, offset: u32) -> Binary {
        match self.content {
            Content::Children(children) => {
                Binary { content: Content::Children(children.map(|child| child + offset)), ..self }
            }
            _ => self,
        }
    }
}

/// Cost of a leaf, where that of a node is 1.
const LEAF: f32 = 1.0;

/// How a subtree is best divided among the slots of a node above it.
#[derive(Debug, Clone, Copy)]
struct Plan {
    /// What it costs in at most 1 to 7 slots.
    cost: [f32; 7],
    /// How many of so many slots (2 to 8) go to the left child; 0 where the best is to leave one free.
    left: [u8; 7],
    /// Its items; more than a leaf holds where it is none.
    first: u32,
    count: u32,
    /// Whether it is best a leaf when it has one slot.
    leaf: bool,
}

/// Adds wide nodes for a binary tree to `nodes` and returns their root. `leaf` makes a leaf of a range of items.
pub(super) fn collapse(
    binary: &[Binary],
    leaf_size: usize,
    nodes: &mut Vec<Node>,
    leaf: &mut dyn FnMut(Range<usize>) -> Child,
) -> Child {
    let mut plans = vec![Plan { cost: [0.0; 7], left: [0; 7], first: 0, count: u32::MAX, leaf: false }; binary.len()];
    for at in (0..binary.len()).rev() {
        plans[at] = plan(&binary[at], &plans, leaf_size);
    }
    Collapse { binary, plans, nodes, leaf }.child(0)
}

fn plan(node: &Binary, plans: &[Plan], leaf_size: usize) -> Plan {
    let area = node.bounds.half_area();
    match node.content {
        Content::Items { first, count } => Plan { cost: [area * LEAF; 7], left: [0; 7], first, count, leaf: true },
        Content::Done { .. } => Plan { cost: [0.0; 7], left: [0; 7], first: 0, count: u32::MAX, leaf: true },
        Content::Children([a, b]) => {
            let (a, b) = (&plans[a as usize], &plans[b as usize]);
            let count = a.count.saturating_add(b.count);
            let mut plan = Plan { cost: [0.0; 7], left: [0; 7], first: a.first.min(b.first), count, leaf: false };
            let divided = |slots: usize| {
                let cost = |left: usize| a.cost[left - 1] + b.cost[slots - left - 1];
                (1..slots)
                    .map(|left| (cost(left), left as u8))
                    .fold((f32::INFINITY, 1), |best, other| if other.0 < best.0 { other } else { best })
            };
            let (below, left) = divided(8);
            plan.left[6] = left;
            plan.cost[0] = below + area;
            if count as usize <= leaf_size && area * LEAF <= plan.cost[0] {
                (plan.cost[0], plan.leaf) = (area * LEAF, true);
            }
            for slots in 2..8 {
                let (cost, left) = divided(slots);
                let fewer = plan.cost[slots - 2];
                (plan.cost[slots - 1], plan.left[slots - 2]) = if cost < fewer { (cost, left) } else { (fewer, 0) };
            }
            plan
        }
    }
}

/// Writes what was planned.
struct Collapse<'a> {
    binary: &'a [Binary],
    plans: Vec<Plan>,
    nodes: &'a mut Vec<Node>,
    leaf: &'a mut dyn FnMut(Range<usize>) -> Child,
}

impl Collapse<'_> {
    /// A subtree in one slot.
    fn child(&mut self, at: u32) -> Child {
        let plan = self.plans[at as usize];
        match self.binary[at as usize].content {
            Content::Done { root } => root,
            Content::Children([a, b]) if !plan.leaf => {
                let mut slots = Vec::with_capacity(8);
                let left = plan.left[6];
                self.gather(a, left, &mut slots);
                self.gather(b, 8 - left, &mut slots);
                let place = self.nodes.len();
                self.nodes.push(Node::EMPTY);
                let bounds = |at: u32| self.binary[at as usize].bounds.aabb();
                let mut children = Vec::with_capacity(8);
                children.extend(slots.iter().map(|&at| (bounds(at), Child::NONE)));
                for (child, &at) in children.iter_mut().zip(&slots) {
                    child.1 = self.child(at);
                }
                self.nodes[place] = Node::new(&children);
                Child::node(place)
            }
            _ => (self.leaf)(plan.first as usize..(plan.first + plan.count) as usize),
        }
    }

    /// The subtrees that a subtree becomes in so many slots.
    fn gather(&self, at: u32, mut slots: u8, out: &mut Vec<u32>) {
        let plan = &self.plans[at as usize];
        while slots > 1 && plan.left[slots as usize - 2] == 0 {
            slots -= 1;
        }
        match self.binary[at as usize].content {
            Content::Children([a, b]) if slots > 1 => {
                let left = plan.left[slots as usize - 2];
                self.gather(a, left, out);
                self.gather(b, slots - left, out);
            }
            _ => out.push(at),
        }
    }
}
