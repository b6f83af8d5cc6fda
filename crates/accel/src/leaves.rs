//! Which parts of a binary tree become leaves.
//!
//! Primitives that can be tested several at once share leaves where that is expected to cost less than
//! the boxes between them: by the surface area heuristic (MacDonald & Booth 1990), bottom up,
//!
//! ```text
//! cost(leaf) = A · PACKET · ⌈n/LANES⌉      cost(node) = A · NODE + cost(left) + cost(right)
//! ```
//!
//! with A the surface of the box. Others have a leaf each.

use obvhs::bvh2::Bvh2;

use crate::wide::area;

/// Primitives that are tested at once.
const LANES: u32 = 8;
/// A leaf has at most so many.
const MOST: u32 = 64;
/// What the test of up to [`LANES`] primitives costs, beside that of two boxes. Not tuned: 0.7 and 2
/// were as fast for paths, and within the noise on a mesh of 100 000 triangles.
const PACKET: f32 = 1.0;
/// What the test of two boxes costs.
const NODE: f32 = 1.0;

/// Leaves, and what is in them.
#[derive(Clone)]
pub(crate) struct Leaves {
    /// By binary node: the number of the leaf that it is, or [`Leaves::NONE`].
    number: Vec<u32>,
    /// Leaf l holds `members[starts[l]..starts[l + 1]]`.
    starts: Vec<u32>,
    members: Vec<u32>,
}

/// What a binary node would be as a leaf, and costs as it is.
#[derive(Clone, Copy, Default)]
struct Cost {
    members: u32,
    joins: bool,
    price: f32,
    leaf: bool,
}

impl Leaves {
    const NONE: u32 = u32::MAX;

    /// Of a binary tree with one primitive in each leaf; `joins` tells which may share one.
    pub(crate) fn new(tree: &Bvh2, joins: impl Fn(usize) -> bool) -> Self {
        let mut order: Vec<usize> = Vec::with_capacity(tree.nodes.len());
        order.extend(tree.nodes.first().map(|_| 0));
        for place in 0..tree.nodes.len() {
            let node = &tree.nodes[order[place]];
            if !node.is_leaf() {
                let first = node.first_index as usize;
                order.extend([first, first + 1]);
            }
        }
        let mut costs = vec![Cost::default(); tree.nodes.len()];
        for &index in order.iter().rev() {
            let node = &tree.nodes[index];
            costs[index] = if node.is_leaf() {
                let primitive = tree.primitive_indices[node.first_index as usize] as usize;
                let (joins, price) = (joins(primitive), PACKET * area(node));
                Cost { members: 1, joins, price, leaf: true }
            } else {
                let first = node.first_index as usize;
                joined(area(node), costs[first], costs[first + 1])
            };
        }
        let mut leaves =
            Self { number: vec![Self::NONE; tree.nodes.len()], starts: vec![0], members: vec![] };
        // In the order of the tree: neighbours in space are neighbours in memory.
        let mut open: Vec<usize> = order.first().copied().into_iter().collect();
        while let Some(index) = open.pop() {
            let first = tree.nodes[index].first_index as usize;
            if costs[index].leaf {
                leaves.number[index] = leaves.count() as u32;
                leaves.add(tree, index);
            } else {
                open.extend([first + 1, first]);
            }
        }
        leaves
    }

    /// Adds all primitives below a node as a leaf.
    fn add(&mut self, tree: &Bvh2, index: usize) {
        let mut open = vec![index];
        while let Some(index) = open.pop() {
            let node = &tree.nodes[index];
            let first = node.first_index as usize;
            if node.is_leaf() {
                self.members.push(tree.primitive_indices[first]);
            } else {
                open.extend([first + 1, first]);
            }
        }
        self.starts.push(self.members.len() as u32);
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.starts.len() - 1
    }

    /// The number of the leaf that a binary node is.
    pub(crate) fn number(&self, node: usize) -> Option<u32> {
        Some(self.number[node]).filter(|&number| number != Self::NONE)
    }

    /// The primitives of each.
    pub(crate) fn members(&self) -> impl Iterator<Item = &[u32]> {
        self.starts.windows(2).map(|ends| &self.members[ends[0] as usize..ends[1] as usize])
    }
}

/// A node of two others: a leaf, if that costs no more.
fn joined(area: f32, left: Cost, right: Cost) -> Cost {
    let members = left.members.saturating_add(right.members);
    let joins = left.joins && right.joins;
    let inner = area * NODE + left.price + right.price;
    let leaf = area * PACKET * members.div_ceil(LANES) as f32;
    if joins && members <= MOST && leaf <= inner {
        Cost { members, joins, price: leaf, leaf: true }
    } else {
        Cost { members, joins, price: inner, leaf: false }
    }
}
