//! What accuracy costs, as conclusions, tables and plots.

mod conclusions;
mod page;
mod plot;
mod table;

pub use conclusions::{Conclusions, conclusions};
pub use page::{extremes, page, summary};
pub use plot::{curve_svg, svg};
pub use table::{hunting, ordinary};
