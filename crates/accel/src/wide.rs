//! The hierarchy itself: nodes of four boxes, which one ray tests at once.
//!
//! It is made from a binary tree, whose lower parts [`crate::leaves`] has made leaves: a node takes the
//! two children of a binary one, and then replaces the child with the largest surface by its children
//! until it has four (Wald, Benthin & Boulos 2008, "Getting Rid of Packets", section 3).

use glam::{BVec4A, Vec3A, Vec4};
use obvhs::bvh2::{Bvh2, node::Bvh2Node};
use smallvec::SmallVec;

use crate::leaves::Leaves;
use crate::{Next, Visitor};

/// Boxes in a node.
const WIDTH: usize = 4;
/// Marks a child that is a leaf; the rest is its number.
const LEAF: u32 = 1 << 31;

/// Four boxes, and what is in them.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Node {
    /// By axis: the lower and the upper planes. A place without a box has none between them.
    planes: [[Vec4; 2]; 3],
    children: [u32; WIDTH],
}

impl Node {
    const EMPTY: Self =
        Self { planes: [[Vec4::INFINITY, Vec4::NEG_INFINITY]; 3], children: [0; WIDTH] };

    fn set(&mut self, place: usize, aabb: &obvhs::aabb::Aabb, child: u32) {
        for (axis, [lower, upper]) in self.planes.iter_mut().enumerate() {
            (lower[place], upper[place]) = (aabb.min[axis], aabb.max[axis]);
        }
        self.children[place] = child;
    }

    /// Where the ray enters each box, and whether it does at all.
    #[inline(always)]
    fn enter(&self, ray: &Ray) -> (Vec4, BVec4A) {
        let (mut near, mut far) = (Vec4::ZERO, Vec4::splat(ray.end));
        for (axis, planes) in self.planes.iter().enumerate() {
            let (origin, inverse) = (ray.origin[axis], ray.inverse[axis]);
            let backwards = ray.backwards[axis];
            near = near.max((planes[backwards & 1] - origin) * inverse);
            far = far.min((planes[backwards & 1 ^ 1] - origin) * inverse);
        }
        (near, near.cmple(far))
    }
}

/// A ray, in the boxes' coordinates.
pub(crate) struct Ray {
    origin: [Vec4; 3],
    /// 1/direction.
    inverse: [Vec4; 3],
    /// By axis: 1 where it goes to lower coordinates, else 0.
    backwards: [usize; 3],
    /// Boxes beyond this distance are not met.
    pub(crate) end: f32,
}

impl Ray {
    #[inline(always)]
    pub(crate) fn new(origin: Vec3A, inverse: Vec3A, end: f32) -> Self {
        Self {
            origin: [0, 1, 2].map(|axis| Vec4::splat(origin[axis])),
            inverse: [0, 1, 2].map(|axis| Vec4::splat(inverse[axis])),
            backwards: [0, 1, 2].map(|axis| usize::from(inverse[axis] < 0.0)),
            end,
        }
    }
}

/// A box on the ray: where the ray enters it, and what it is.
type Met = (f32, u32);

/// Nodes, the root first; none if there is but one leaf.
#[derive(Clone)]
pub(crate) struct Wide {
    nodes: Vec<Node>,
}

impl Wide {
    /// From a binary tree, cut off at its leaves.
    pub(crate) fn new(tree: &Bvh2, leaves: &Leaves) -> Self {
        let mut wide = Self { nodes: Vec::new() };
        if leaves.count() < 2 {
            return wide;
        }
        // The node to make, and the binary one that it takes the children of.
        let mut open = vec![(0, 0)];
        wide.nodes.push(Node::EMPTY);
        while let Some((index, binary)) = open.pop() {
            for (place, child) in children(tree, leaves, binary).into_iter().enumerate() {
                let code = leaves.number(child).map_or_else(
                    || {
                        open.push((wide.nodes.len(), child));
                        wide.nodes.push(Node::EMPTY);
                        wide.nodes.len() as u32 - 1
                    },
                    |leaf| LEAF | leaf,
                );
                wide.nodes[index].set(place, tree.nodes[child].aabb(), code);
            }
        }
        wide
    }

    /// Shows a visitor the leaves that the ray may meet; nearer ones tend to come first.
    #[inline(always)]
    pub(crate) fn walk(&self, ray: &mut Ray, end: impl Fn(f64) -> f32, visitor: &mut impl Visitor) {
        let mut stack: SmallVec<[Met; 32]> = SmallVec::new();
        let mut next = 0;
        loop {
            let node = &self.nodes[next as usize];
            let (near, met) = node.enter(ray);
            let mut left = met.bitmask();
            let mut nearest = None;
            if left != 0 {
                let near = near.to_array();
                let others = stack.len();
                let mut first = (near[place(left)], node.children[place(left)]);
                left &= left - 1;
                while left != 0 {
                    let other = (near[place(left)], node.children[place(left)]);
                    left &= left - 1;
                    let closer = other.0 < first.0;
                    stack.push(if closer { first } else { other });
                    first = if closer { other } else { first };
                }
                if stack.len() > others + 1 {
                    farthest_first(&mut stack[others..]);
                }
                nearest = Some(first);
            }
            // The nearest, or what was left for later; leaves have no nodes.
            loop {
                let Some((near, child)) = nearest.take().or_else(|| stack.pop()) else { return };
                if near > ray.end {
                    continue;
                }
                if child & LEAF == 0 {
                    next = child;
                    break;
                }
                match visitor.meet((child & !LEAF) as usize) {
                    Next::On => {}
                    Next::Until(t) => ray.end = end(t),
                    Next::Stop => return,
                }
            }
        }
    }
}

/// The first place of a bit mask.
#[inline(always)]
fn place(mask: u32) -> usize {
    mask.trailing_zeros() as usize % WIDTH
}

/// Sorts two or three.
#[inline(always)]
fn farthest_first(met: &mut [Met]) {
    for last in 1..met.len() {
        for place in (0..last).rev() {
            if met[place].0 < met[place + 1].0 {
                met.swap(place, place + 1);
            }
        }
    }
}

/// The up to four nodes, by number, that stand for a binary one, which is no leaf.
fn children(tree: &Bvh2, leaves: &Leaves, binary: usize) -> SmallVec<[usize; WIDTH]> {
    let both = |node: usize| {
        let first = tree.nodes[node].first_index as usize;
        [first, first + 1]
    };
    let mut children: SmallVec<[usize; WIDTH]> = SmallVec::from_slice(&both(binary));
    while children.len() < WIDTH {
        let inner = (0..children.len()).filter(|&place| leaves.number(children[place]).is_none());
        let area = |&place: &usize| area(&tree.nodes[children[place]]);
        let Some(largest) = inner.max_by(|a, b| area(a).total_cmp(&area(b))) else { break };
        let [left, right] = both(children[largest]);
        children[largest] = left;
        children.push(right);
    }
    children
}

/// Half the surface of a node's box: in proportion to the rays that meet it.
pub(crate) fn area(node: &Bvh2Node) -> f32 {
    node.aabb().half_area()
}
