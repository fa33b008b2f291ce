//! The frame of a chart with two logarithmic axes.

use super::super::labels::Rect;
use super::super::scale::Log;
use super::super::svg::{Anchor, Svg};
use super::WIDTH;

/// An axis: what it shows and how its figures are written.
pub struct Axis<'a> {
    /// What it shows.
    pub title: &'a str,
    /// Values that must be on it.
    pub values: &'a [f64],
    /// A figure in words.
    pub label: &'a dyn Fn(f64) -> String,
}

/// A frame with its scales.
pub struct Frame {
    /// The drawing.
    pub svg: Svg,
    /// Horizontal scale.
    pub x: Log,
    /// Vertical scale, growing upward.
    pub y: Log,
    /// The inner part.
    pub area: Rect,
}

const LEFT: f64 = 58.0;
const RIGHT: f64 = 8.0;
const TOP: f64 = 22.0;
const BOTTOM: f64 = 40.0;

impl Frame {
    /// Draws axes, ticks and titles.
    pub fn new(height: f64, horizontal: &Axis, vertical: &Axis) -> Self {
        let area = Rect { x: LEFT, y: TOP, width: WIDTH - LEFT - RIGHT, height: height - TOP - BOTTOM };
        let (right, low) = (area.x + area.width, area.y + area.height);
        let x = Log::around(horizontal.values.iter().copied(), area.x, right);
        let y = Log::around(vertical.values.iter().copied(), low, area.y);
        let mut svg = Svg::new(WIDTH, height);
        for (value, label) in x.ticks(false, horizontal.label) {
            let at = x.at(value);
            svg.line((at, area.y), (at, low), "grid");
            // A label at the end would be cut by the drawing's edge.
            let half = super::super::svg::width(&label) / 2.0;
            svg.text((at.min(WIDTH - half), low + 14.0), Anchor::Middle, "tick", &label);
        }
        for (value, label) in y.ticks(true, vertical.label) {
            let at = y.at(value);
            svg.line((area.x, at), (right, at), "grid");
            svg.text((area.x - 5.0, at + 4.0), Anchor::End, "tick", &label);
        }
        svg.text((area.x + area.width / 2.0, height - 8.0), Anchor::Middle, "axis", horizontal.title);
        svg.text((4.0, 12.0), Anchor::Start, "axis", vertical.title);
        Self { svg, x, y, area }
    }
}
