//! What accuracy costs: time and memory beside errors decided by exact arithmetic, for every
//! structure and kernel on the same rays.
//!
//! Ordinary rays and such as hunt for errors are judged apart. Beside the rows there is a curve over precisions of
//! coordinates ([`curve`]), a table of extremes ([`extremes`]), and what becomes of rays that leave surfaces ([`leaving`]).

#![forbid(unsafe_code)]

mod accuracy;
pub mod curve;
pub mod extremes;
mod judged;
pub mod leaving;
mod record;
mod row;
mod run;
mod timing;

pub use accuracy::Accuracy;
pub use judged::{Judged, KindBounds, Set};
pub use record::{FORMAT, Trade};
pub use row::{TradeRow, mark_front};
pub use run::{HUNTING, ORDINARY, Plan, TIMED, defaults, run};
