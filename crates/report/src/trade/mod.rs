//! What accuracy costs, as a table and as a plot.

mod plot;
mod table;

pub use plot::svg;
pub use table::table;
