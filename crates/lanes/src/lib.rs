//! Lanes of `f32` whose instruction set is chosen at run time, and what is made of them: packets
//! of rays, bit maps along a path, objects packed in blocks of 64, and the splits that put them there.

mod bits;
mod blocks;
mod ids;
mod one_by_one;
pub mod packet;
mod ranks;
mod row;
mod simd;
pub mod split;
mod tile;

pub use bits::{next_bit, next_lane, ones};
pub use blocks::{BLOCK, Blocks, EMPTY_SLOT, PackedObjects, Shared};
pub use ids::Ids;
pub use one_by_one::{OneByOne, Unpacked, one_by_one};
pub use ranks::ranks;
pub use row::{ROW, Row};
pub use simd::path;
pub use simd::{Level, Lists, Portable, SHARE, Scalar, Simd, Task, prefetch};
pub use tile::Tile;
