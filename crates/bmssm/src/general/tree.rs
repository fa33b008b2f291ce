//! The levels above the blocks: a wide tree of their boxes.
//!
//! A level of maps of its own would be the paper's way once more (a bit per block), but boxes, which
//! there are few of, sort out sixteen children in one go and say where the ray enters each.

use crate::id::ID;
use accel::parallel::prelude::*;
use accel::{BuildError, filled};
use lanes::split::{Divide, Extremes, Item, Left, Scratch, Shape, UnitBox};
use lanes::{Level, ROW, Row};

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

    /// Adds to the indices of children that are nodes. The root, 0, is nobody's child.
    fn move_by(&mut self, places: u32) {
        for child in &mut self.children {
            if (1..Self::BLOCK).contains(child) {
                *child += places;
            }
        }
    }
}

/// How blocks are shared out among nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fill {
    /// As surfaces suggest, so that rays visit few nodes; some hold few blocks.
    Surface,
    /// Sixteen blocks to a node but for the last of a row of splits, so that there are few nodes.
    Full,
}

/// A child in the making: consecutive items, each a block.
struct Part<'i> {
    items: &'i mut [Item],
    bounds: UnitBox,
    /// What its surface is.
    area: f32,
}

impl<'i> Part<'i> {
    fn of(shape: &Shape, items: &'i mut [Item]) -> Self {
        let bounds = Extremes::of(items).bounds();
        Self { area: shape.area(&bounds), items, bounds }
    }
}

/// Blocks from which on the children of a node are trees of tasks of their own.
const PARALLEL: usize = 1 << 10;

/// The tree over blocks, given by their boxes and numbers; the root is the first node. Empty where there is no block.
///
/// # Errors
/// [`BuildError::TooLarge`] if the system doesn't give the memory.
pub fn over(shape: &Shape, mut blocks: Vec<Item>, fill: Fill, simd: Level) -> Result<Vec<Node>, BuildError> {
    if blocks.is_empty() {
        return Ok(Vec::new());
    }
    let (mut items, mut marks) = (filled(ID, Item::EMPTY, blocks.len())?, accel::zeroed(ID, blocks.len())?);
    let scratch = Scratch { items: &mut items, marks: &mut marks };
    let mut nodes = Tree { shape, fill, simd }.grown(Part::of(shape, &mut blocks), scratch)?;
    nodes.shrink_to_fit();
    Ok(nodes)
}

/// What all parts of a tree have in common.
#[derive(Clone, Copy)]
struct Tree<'a> {
    shape: &'a Shape,
    fill: Fill,
    simd: Level,
}

impl Tree<'_> {
    /// The tree over a part. Children are trees of their own where they are worth it, whatever the number of threads.
    fn grown(self, part: Part, mut scratch: Scratch) -> Result<Vec<Node>, BuildError> {
        if part.items.len() < PARALLEL {
            return self.grown_alone(part, scratch);
        }
        let mut root = Node::EMPTY;
        let children = self.children(part, &mut scratch);
        let mut rest = scratch;
        let mut tasks = Vec::with_capacity(WIDTH);
        for (lane, part) in children.into_iter().enumerate() {
            match *part.items {
                [block] => root.set(lane, &part.bounds, Node::BLOCK | block.number()),
                _ => tasks.push((lane, part.bounds, rest.take(part.items.len()), part)),
            }
        }
        let grow = |(lane, bounds, room, part)| Ok((lane, bounds, self.grown(part, room)?));
        let trees: Vec<_> = tasks.into_par_iter().map(grow).collect::<Result<_, BuildError>>()?;
        let mut nodes = accel::reserved(ID, 1 + trees.iter().map(|(.., tree)| tree.len()).sum::<usize>())?;
        nodes.push(root);
        for (lane, bounds, mut tree) in trees {
            let first = nodes.len() as u32;
            nodes[0].set(lane, &bounds, first);
            tree.iter_mut().for_each(|node| node.move_by(first));
            nodes.append(&mut tree);
        }
        Ok(nodes)
    }

    /// The tree over a part, by one thread.
    fn grown_alone(self, part: Part, mut scratch: Scratch) -> Result<Vec<Node>, BuildError> {
        let mut nodes: Vec<Node> = accel::reserved(ID, part.items.len().div_ceil(WIDTH / 2).max(1))?;
        nodes.push(Node::EMPTY);
        let mut open = vec![(0, part)];
        while let Some((index, part)) = open.pop() {
            for (lane, part) in self.children(part, &mut scratch).into_iter().enumerate() {
                let what =
                    if let [block] = *part.items { Node::BLOCK | block.number() } else { nodes.len() as u32 };
                nodes[index].set(lane, &part.bounds, what);
                if part.items.len() > 1 {
                    open.push((nodes.len(), part));
                    accel::append(ID, &mut nodes, Node::EMPTY)?;
                }
            }
        }
        Ok(nodes)
    }

    /// Splits the part of the largest surface until there are enough children.
    fn children<'i>(self, part: Part<'i>, scratch: &mut Scratch) -> Vec<Part<'i>> {
        let Self { shape, fill, simd } = self;
        let (most, left) = if fill == Fill::Full && part.items.len() > WIDTH {
            (WIDTH, Left::Whole(WIDTH))
        } else {
            (1, Left::Any)
        };
        let mut parts = vec![part];
        while parts.len() < WIDTH {
            let largest = (0..parts.len())
                .filter(|i| parts[*i].items.len() > most)
                .max_by(|a, b| parts[*a].area.total_cmp(&parts[*b].area));
            let Some(largest) = largest else { break };
            let Part { items, .. } = parts.swap_remove(largest);
            let at = simd.run(Divide { shape, items: &mut *items, scratch, left });
            let (left, right) = items.split_at_mut(at);
            parts.extend([left, right].map(|items| Part::of(shape, items)));
        }
        parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blocks of one size in a row that bends.
    fn blocks(count: u32) -> Vec<Item> {
        let block = |number: u32| {
            let along = number as f32 / count as f32;
            let min = [along, along * along, 0.5];
            Item::new(number, 1, &UnitBox { min, max: min.map(|at| at + 0.01) })
        };
        (0..count).map(block).collect()
    }

    #[test]
    fn each_block_is_one_child_of_few_nodes_if_they_are_to_be_full() {
        let shape = Shape { extent: [1.0; 3] };
        for count in [1, 2, 16, 17, 33, 1000, 3000] {
            let grown = |fill| over(&shape, blocks(count), fill, Level::Portable).unwrap();
            let (surface, full) = (grown(Fill::Surface), grown(Fill::Full));
            for nodes in [&surface, &full] {
                let children = nodes.iter().flat_map(|node| node.children);
                let mut found: Vec<u32> = children
                    .filter(|child| child & Node::BLOCK != 0)
                    .map(|child| child & !Node::BLOCK)
                    .collect();
                found.sort_unstable();
                assert!(found.into_iter().eq(0..count));
            }
            assert!(full.len() <= surface.len(), "{count}: {} {}", full.len(), surface.len());
            assert!(full.len() <= count.div_ceil(16) as usize * 5 / 4 + 2, "{count}: {}", full.len());
        }
    }
}
