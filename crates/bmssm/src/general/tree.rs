//! The levels above the blocks: a wide tree of their boxes.
//!
//! A level of maps of its own would be the paper's way once more (a bit per block), but boxes, which
//! there are few of, sort out sixteen children in one go and say where the ray enters each.

use super::item::{Extremes, Item};
use super::maps::UnitBox;
use super::split::{Divide, Left, Scratch, Shape};
use accel::simd::{Level, ROW, Row};

/// Most children of a node.
pub const WIDTH: usize = ROW;

/// The boxes of a node's children, lane by lane, and which they are.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Node {
    /// x, y, z of the least, then of the greatest coordinates; lanes without a child hold a box that no ray
    /// meets.
    pub boxes: [Row; 6],
    /// A node's index, or a block's with [`Node::BLOCK`] set.
    pub children: [u32; WIDTH],
}

impl Node {
    /// Marks a child that is a block of objects.
    pub const BLOCK: u32 = 1 << 31;

    const EMPTY: Self = Self {
        boxes: {
            let (low, high) = (Row([f32::INFINITY; ROW]), Row([f32::NEG_INFINITY; ROW]));
            [low, low, low, high, high, high]
        },
        children: [0; WIDTH],
    };

    fn set(&mut self, lane: usize, bounds: &UnitBox, what: u32) {
        let UnitBox { min, max } = bounds.widened();
        for axis in 0..3 {
            self.boxes[axis].0[lane] = min[axis];
            self.boxes[3 + axis].0[lane] = max[axis];
        }
        self.children[lane] = what;
    }
}

/// A child in the making: consecutive items, each a block.
struct Part<'i> {
    items: &'i mut [Item],
    bounds: UnitBox,
}

/// The tree over blocks, given by their boxes and numbers; the root is the first node. Empty where there is no block.
pub fn over(shape: &Shape, mut blocks: Vec<Item>, simd: Level) -> Vec<Node> {
    let mut nodes = Vec::with_capacity(blocks.len().div_ceil(WIDTH / 2));
    if blocks.is_empty() {
        return nodes;
    }
    let (mut items, mut marks) = (blocks.clone(), vec![0; blocks.len()]);
    let mut scratch = Scratch { items: &mut items, marks: &mut marks };
    nodes.push(Node::EMPTY);
    let bounds = Extremes::of(&blocks).bounds();
    let mut open = vec![(0, Part { items: &mut blocks, bounds })];
    while let Some((index, part)) = open.pop() {
        for (lane, part) in children(shape, part, &mut scratch, simd).into_iter().enumerate() {
            let what =
                if let [block] = *part.items { Node::BLOCK | block.number() } else { nodes.len() as u32 };
            nodes[index].set(lane, &part.bounds, what);
            if part.items.len() > 1 {
                open.push((nodes.len(), part));
                nodes.push(Node::EMPTY);
            }
        }
    }
    nodes.shrink_to_fit();
    nodes
}

/// Splits the part of the largest surface until there are enough children.
fn children<'i>(shape: &Shape, part: Part<'i>, scratch: &mut Scratch, simd: Level) -> Vec<Part<'i>> {
    let mut parts = vec![part];
    while parts.len() < WIDTH {
        let largest = (0..parts.len())
            .filter(|i| parts[*i].items.len() > 1)
            .max_by(|a, b| shape.area(&parts[*a].bounds).total_cmp(&shape.area(&parts[*b].bounds)));
        let Some(largest) = largest else { break };
        let Part { items, .. } = parts.swap_remove(largest);
        let at = simd.run(Divide { shape, items: &mut *items, scratch, left: Left::Any });
        let (left, right) = items.split_at_mut(at);
        for items in [left, right] {
            let bounds = Extremes::of(items).bounds();
            parts.push(Part { items, bounds });
        }
    }
    parts
}
