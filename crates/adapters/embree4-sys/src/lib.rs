//! The part of Embree 4's C interface that this workspace and the crate `embree4-rs` 0.0.16 use, under the names that
//! `embree4/rtcore_*.h` give it (Embree 4.0 to 4.4, <https://github.com/RenderKit/embree>).
//!
//! It stands in for the registry's `embree4-sys` 0.0.10 by `[patch.crates-io]`, and differs from it in three ways:
//!
//! - It is written by hand: building it takes neither the headers nor libclang.
//! - [`RTCRayHit`] has room for the field that Embree 4.3 added behind the hit and writes at every hit. The
//!   registry's is made from the headers of 4.2 and ends before it.
//! - What Embree calls an enumeration is a number with named values, so that a value which a later Embree returns is
//!   no undefined behaviour.
//!
//! `docs/embree.md` says more. Everything here is as unsafe as C; the safe side is `rayscale-adapter-embree`.
#![allow(non_snake_case)]

mod codes;
mod functions;
mod queries;
mod rays;

pub use codes::*;
pub use functions::*;
pub use queries::*;
pub use rays::*;
