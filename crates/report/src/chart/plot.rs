//! The one chart: lines and marks on two logarithmic axes, labelled so that nothing covers anything.

use super::labels::{Rect, line, place};
use super::palette::Shape;
use super::scale::Log;
use super::svg::{Anchor, Point, Svg, width};
use maud::Markup;

/// An axis: what it shows and how its figures are written.
pub struct Axis {
    /// What it shows.
    pub title: String,
    /// Values that must be on it.
    pub values: Vec<f64>,
    /// A figure in words.
    pub label: fn(f64) -> String,
    /// Figures to show; chosen by the room there is where there are none.
    pub ticks: &'static [f64],
}

impl Axis {
    /// An axis that holds these values.
    pub fn new(title: &str, values: impl IntoIterator<Item = f64>, label: fn(f64) -> String) -> Self {
        Self { title: title.to_owned(), values: values.into_iter().collect(), label, ticks: &[] }
    }

    /// The ends of the axis, a little beyond its values.
    pub fn range(&self) -> (f64, f64) {
        self.scale(0.0, 1.0).range()
    }

    fn scale(&self, from: f64, to: f64) -> Log {
        Log::around(self.values.iter().chain(self.ticks).copied(), from, to)
    }

    fn ticks(&self, scale: &Log, vertical: bool) -> Vec<(f64, String)> {
        match self.ticks {
            [] => scale.ticks(vertical, self.label),
            ticks => ticks.iter().map(|tick| (*tick, (self.label)(*tick))).collect(),
        }
    }
}

/// A line through values.
pub struct Line {
    /// The values, along the line.
    pub values: Vec<Point>,
    /// How it looks.
    pub class: String,
    /// What it says on hovering.
    pub tip: Option<String>,
    /// Whether labels stay clear of it.
    pub clear: bool,
}

impl Line {
    /// A line that labels may cross.
    pub fn new(values: impl IntoIterator<Item = Point>, class: &str) -> Self {
        Self { values: values.into_iter().collect(), class: class.to_owned(), tip: None, clear: false }
    }

    /// From the left end of the chart to the right.
    pub fn level(value: f64, class: &str) -> Self {
        Self::new([(f64::MIN_POSITIVE, value), (f64::MAX, value)], class)
    }

    /// Steps from one point of a front to the next: what is right of them and above is beaten.
    pub fn steps(front: &[Point], class: &str) -> Self {
        let steps = front.windows(2).flat_map(|pair| [(pair[1].0, pair[0].1), pair[1]]);
        let values: Vec<Point> = front.iter().copied().take(1).chain(steps).collect();
        Self { clear: true, ..Self::new(values, class) }
    }
}

/// A mark at a value.
pub struct Mark {
    /// The value.
    pub value: Point,
    /// Its shape.
    pub shape: Shape,
    /// How it looks.
    pub class: String,
    /// What it says on hovering.
    pub tip: String,
    /// What it is called.
    pub label: Option<String>,
}

/// A chart.
pub struct Plot {
    /// Its name, for screen readers, or for all where charts stand side by side.
    pub name: String,
    /// Width and height.
    pub size: (f64, f64),
    /// To the right.
    pub horizontal: Axis,
    /// Upward.
    pub vertical: Axis,
    /// Lines, under the marks.
    pub lines: Vec<Line>,
    /// Marks; labels of the first ones get the best places.
    pub marks: Vec<Mark>,
}

/// Width of every chart of a page: what fits a phone.
pub const WIDTH: f64 = 350.0;

const LEFT: f64 = 58.0;
const RIGHT: f64 = 8.0;
const TOP: f64 = 22.0;
const BOTTOM: f64 = 40.0;

impl Plot {
    /// As an element of a page.
    pub fn svg(&self) -> Markup {
        let mut svg = Svg::default();
        self.draw(&mut svg, (0.0, 0.0));
        svg.finish(self.size, &self.name)
    }

    /// Draws it with its upper left corner at `corner`.
    pub fn draw(&self, svg: &mut Svg, corner: Point) {
        let (left, top) = (corner.0 + LEFT, corner.1 + TOP);
        let area =
            Rect { x: left, y: top, width: self.size.0 - LEFT - RIGHT, height: self.size.1 - TOP - BOTTOM };
        let x = self.horizontal.scale(area.x, area.x + area.width);
        let y = self.vertical.scale(area.y + area.height, area.y);
        self.axes(svg, corner, area, (&x, &y));
        let at = |(a, b): Point| (x.at(a), y.at(b));
        let mut obstacles = Vec::new();
        for Line { values, class, tip, clear } in &self.lines {
            // What leaves the chart upward is not drawn along its upper edge.
            let highest = y.range().1;
            let points: Vec<Point> =
                values.iter().take_while(|(_, value)| *value <= highest).map(|v| at(*v)).collect();
            if *clear {
                obstacles.extend(obstacle(&points));
            }
            match tip {
                _ if points.len() < 2 => {}
                Some(tip) => svg.tip(tip, |svg| svg.path(&points, class)),
                None => svg.path(&points, class),
            }
        }
        self.marks(svg, area, &at, obstacles);
    }

    fn axes(&self, svg: &mut Svg, corner: Point, area: Rect, (x, y): (&Log, &Log)) {
        let (right, low, end) = (area.x + area.width, area.y + area.height, corner.0 + self.size.0);
        for (value, label) in self.horizontal.ticks(x, false) {
            let at = x.at(value);
            svg.line((at, area.y), (at, low), "grid");
            // A label at the end would be cut by the drawing's edge.
            let half = width(&label) / 2.0;
            svg.text((at.min(end - half), low + 14.0), Anchor::Middle, "tick", &label);
        }
        for (value, label) in self.vertical.ticks(y, true) {
            let at = y.at(value);
            svg.line((area.x, at), (right, at), "grid");
            svg.text((area.x - 5.0, at + 4.0), Anchor::End, "tick", &label);
        }
        let foot = corner.1 + self.size.1 - 8.0;
        svg.text((area.x + area.width / 2.0, foot), Anchor::Middle, "axis", &self.horizontal.title);
        svg.text((corner.0 + 4.0, corner.1 + 12.0), Anchor::Start, "axis", &self.vertical.title);
    }

    fn marks(&self, svg: &mut Svg, area: Rect, at: &impl Fn(Point) -> Point, obstacles: Vec<Rect>) {
        // The labelled ones first, as places are given in this order; all are kept clear of.
        let (named, unnamed): (Vec<&Mark>, Vec<&Mark>) =
            self.marks.iter().partition(|mark| mark.label.is_some());
        let points: Vec<Point> = named.iter().chain(&unnamed).map(|mark| at(mark.value)).collect();
        let names: Vec<&str> = named.iter().filter_map(|mark| mark.label.as_deref()).collect();
        let mut labels = place(&points, &names, area, obstacles).into_iter();
        for (mark, point) in named.into_iter().chain(unnamed).zip(points) {
            let label = labels.next().flatten();
            svg.tip(&mark.tip, |svg| {
                if let Some(end) = label.and_then(|label| label.leader) {
                    svg.line(point, end, "leader");
                }
                svg.marker(point, mark.shape, &mark.class);
                if let (Some(label), Some(name)) = (label, &mark.label) {
                    svg.text(label.at, Anchor::Start, "label halo", name);
                }
            });
        }
    }
}

/// The rectangles that a line takes: its own where it is level or upright, its points' otherwise.
fn obstacle(points: &[Point]) -> Vec<Rect> {
    let straight = points.windows(2).filter(|pair| pair[0].0 == pair[1].0 || pair[0].1 == pair[1].1);
    let straight = straight.map(|pair| line(pair[0], pair[1]));
    straight.chain(points.iter().map(|point| line(*point, *point))).collect()
}
