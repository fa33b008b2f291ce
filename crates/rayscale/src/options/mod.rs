//! Options that verbs share.

mod camera;
mod filter;
mod kernel;
mod limits;
mod names;
mod selection;
mod values;

pub use camera::CameraOptions;
pub use filter::Filter;
pub use kernel::KernelOptions;
pub use limits::LimitOptions;
pub use names::structures;
pub use selection::Selection;
pub use values::{measures, shadings};
