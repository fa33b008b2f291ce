//! Pictures of a scene's primary hits.

mod colour;
mod difference;
mod judged;
mod shade;

pub use difference::{Differences, difference};
pub use judged::{Compared, Wrongness, compare};
pub use shade::{Shading, shade};

use image::RgbaImage;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use std::io::Write;

/// Writes the picture as PNG.
///
/// # Errors
/// Whatever `out` answers.
pub fn write_png(picture: &RgbaImage, out: impl Write) -> image::ImageResult<()> {
    picture.write_with_encoder(PngEncoder::new_with_quality(out, CompressionType::Best, FilterType::Adaptive))
}
