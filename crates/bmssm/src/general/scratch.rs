//! What a thread keeps while it takes rays through the levels.

use super::beam::{Beam, BeamRays};
use super::state::TraversalState;
use accel::grid::Span;
use accel::{Counters, Nearest};
use lanes::{BLOCK, ROW};

/// Rays of a stream at most: as many as short numbers tell apart.
pub(super) const STREAM: usize = 1 << 16;

/// Rays that wait to visit a node or a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Waiting {
    /// As in [`super::tree::Node::children`].
    pub(super) what: u32,
    /// Where their numbers begin in the lists, and how many they are.
    pub(super) first: u32,
    pub(super) len: u32,
    /// Up to where the lists are in use.
    pub(super) top: u32,
}

/// Buffers that are kept from stream to stream; only the first places, one for each ray of the stream, mean something.
#[derive(Default)]
pub(super) struct Scratch {
    pub(super) states: Vec<TraversalState>,
    pub(super) spans: Vec<Span>,
    pub(super) best: Vec<Nearest>,
    /// Those of neighbours that are taken together.
    pub(super) beams: Vec<Beam>,
    pub(super) beam_rays: Vec<BeamRays>,
    /// The candidates of beams in a block.
    pub(super) masks: Vec<u64>,
    /// Lists of rays, or of beams, by number.
    pub(super) lists: Vec<u16>,
    pub(super) stack: Vec<Waiting>,
    pub(super) pairs: PairList,
    /// Steps taken.
    pub(super) steps: Counters,
}

/// Pairs of all rays of a packet and all objects of a block, and as many again to be written at once.
const PAIRS: usize = (ROW + 1) * BLOCK;

/// Rays and candidates in pairs.
pub(super) struct PairList {
    /// Places of rays in a packet.
    pub(super) rays: [u8; PAIRS],
    /// Places of candidates in a block.
    pub(super) slots: [u8; PAIRS],
    /// How many pairs there are.
    pub(super) len: usize,
}

impl Default for PairList {
    fn default() -> Self {
        Self { rays: [0; PAIRS], slots: [0; PAIRS], len: 0 }
    }
}
