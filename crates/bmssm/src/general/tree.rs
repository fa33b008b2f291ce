//! Blocks of blocks: the levels above the objects. A node is a block whose 64 bits stand for blocks.

use super::maps::{BlockMaps, UnitBox};
use super::partition::Split;
use accel::objects::BLOCK;
use accel::simd::{ROW, Row};

/// A block of up to 64 blocks: the maps of its children's boxes, and the boxes.
#[derive(Clone, Debug)]
pub struct Node {
    /// Bit per child.
    pub maps: BlockMaps,
    /// First group of child boxes; a group holds 16.
    pub boxes: u32,
    /// Index of the first child that is a block of objects.
    pub first_block: u32,
    /// Index of the first child that is a node.
    pub first_node: u32,
    /// Children below this number are blocks of objects, the others nodes.
    pub blocks: u32,
}

/// Six rows, x y z of the least and of the greatest coordinates, for 16 boxes.
pub type BoxGroup = [Row; 6];

/// All levels.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    /// Nodes; the root is the first.
    pub nodes: Vec<Node>,
    /// Boxes of the nodes' children.
    pub boxes: Vec<BoxGroup>,
    /// For each block in order its first item, its number of items and its box.
    pub blocks: Vec<(usize, usize, UnitBox)>,
}

impl Tree {
    /// Collapses a binary tree of splits into nodes of up to 64 children.
    pub fn new(root: &Split) -> Self {
        let mut tree = Self::default();
        let blocks = root.blocks as usize;
        tree.blocks.reserve_exact(blocks);
        tree.nodes.push(Node::EMPTY);
        let mut open = vec![(0, root)];
        while let Some((index, split)) = open.pop() {
            let mut children = children_of(split);
            children.sort_by_key(|child| child.halves.is_some());
            let blocks = children.iter().take_while(|child| child.halves.is_none()).count();
            let node = Node {
                maps: BlockMaps::new(&split.bounds, children.iter().map(|child| child.bounds)),
                boxes: tree.boxes.len() as u32,
                first_block: tree.blocks.len() as u32,
                first_node: tree.nodes.len() as u32,
                blocks: blocks as u32,
            };
            for group in children.chunks(ROW) {
                tree.boxes.push(box_group(group));
            }
            for child in &children[..blocks] {
                tree.blocks.push((child.first, child.len, child.bounds));
            }
            for child in &children[blocks..] {
                open.push((tree.nodes.len(), child));
                tree.nodes.push(Node::EMPTY);
            }
            tree.nodes[index] = node;
        }
        tree.nodes.shrink_to_fit();
        tree.boxes.shrink_to_fit();
        tree
    }
}

impl Node {
    const EMPTY: Self = Self { maps: BlockMaps::EMPTY, boxes: 0, first_block: 0, first_node: 0, blocks: 0 };
}

/// The descendants that become a node's children: the one with the most blocks is replaced by its halves until
/// there are 64, or until all are as small as the levels below can hold evenly.
fn children_of(split: &Split) -> Vec<&Split> {
    let blocks = f64::from(split.blocks);
    let levels = (blocks.ln() / (BLOCK as f64).ln()).ceil().max(1.0);
    let enough = blocks.powf((levels - 1.0) / levels).ceil() as u32;
    let mut children = vec![split];
    while children.len() < BLOCK {
        let largest = (0..children.len()).max_by_key(|i| children[*i].blocks).unwrap_or(0);
        let Some(halves) = &children[largest].halves else { break };
        if children[largest].blocks <= enough && children.len() > 1 {
            break;
        }
        children[largest] = &halves[0];
        children.push(&halves[1]);
    }
    children
}

/// Lanes without a child hold a box that no ray meets.
fn box_group(children: &[&Split]) -> BoxGroup {
    let mut group = [Row([f32::INFINITY; ROW]); 6];
    for (lane, child) in children.iter().enumerate() {
        let UnitBox { min, max } = child.bounds.widened();
        for axis in 0..3 {
            group[axis].0[lane] = min[axis];
            group[3 + axis].0[lane] = max[axis];
        }
    }
    for row in &mut group[3..] {
        for value in row.0.iter_mut().skip(children.len()) {
            *value = f32::NEG_INFINITY;
        }
    }
    group
}
