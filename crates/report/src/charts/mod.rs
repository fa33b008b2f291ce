//! The charts of a report.

mod bars;
mod errors;
mod growth;
mod memory;
mod pareto;
#[cfg(test)]
mod tests;

pub use bars::bars;
pub use errors::errors;
pub use growth::growth;
pub use memory::memory_ratio;
pub use pareto::pareto;
