//! The charts of a report.

mod bars;
mod errors;
mod frame;
mod growth;
mod memory;
mod pareto;

pub use bars::bars;
pub use errors::errors;
pub use growth::growth;
pub use memory::memory_ratio;
pub use pareto::pareto;

/// Width of every chart: what fits a phone.
pub const WIDTH: f64 = 350.0;
