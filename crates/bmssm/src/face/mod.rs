//! What others use: structures for rays of any kind and for one image, and how they are built.

mod build;
mod camera;
mod image;
mod options;
mod structure;

pub use camera::{Camera, CameraError};
pub use image::Image;
pub use options::Options;
pub use structure::Bmssm;
