//! Binary Map of Space Subdivision Method (V. Skala, *Memory saving technique for space
//! subdivision technique*, Machine GRAPHICS and VISION 2(3), 1993): a bit for each object and slice
//! instead of a list of objects for each cell. Stands behind `accel::Accel`.
#![forbid(unsafe_code)]

pub mod dense;
pub mod fast;
pub mod general;
pub mod image_space;
pub mod raster;
