//! The one chart maker: [`Plot`] draws lines and marks on logarithmic axes, in a page or on a [`Sheet`] of its own.

mod labels;
pub mod palette;
mod plot;
mod scale;
mod sheet;
mod style;
mod svg;

pub use labels::Rect;
pub use plot::{Axis, Line, Mark, Plot, WIDTH};
pub use sheet::{Sheet, Sign};
pub use style::{RULES, Styles};
pub use svg::{Anchor, Point, Svg, width};
