//! Drawings as SVG, with text as text.

use std::fmt::{Display, Write};

/// Text safe in HTML and SVG, attributes included.
pub fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            c => safe.push(c),
        }
    }
    safe
}

/// Height of text in a drawing, in its units.
pub const TEXT: f64 = 11.0;

/// A width that the text does not exceed at size [`TEXT`] in the usual sans-serif fonts; DejaVu
/// Sans is the widest of them.
pub fn width(text: &str) -> f64 {
    let em = |c: char| match c {
        'i' | 'j' | 'l' | '.' | ',' | ':' | '\'' | '|' | '!' => 0.33,
        'f' | 't' | 'r' | '-' | '(' | ')' | ' ' | '/' => 0.42,
        'm' | 'w' | 'M' | 'W' | '%' | '@' => 1.0,
        'A'..='Z' | '×' | '→' | '–' | '≤' | '≥' | '∞' => 0.8,
        _ => 0.64,
    };
    text.chars().map(em).sum::<f64>() * TEXT
}

/// Where a text's position is on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// At its left end.
    Start,
    /// In its middle.
    Middle,
    /// At its right end.
    End,
}

/// A drawing under way.
pub struct Svg {
    body: String,
    width: f64,
    height: f64,
}

impl Svg {
    /// An empty drawing of this size in CSS pixels.
    pub const fn new(width: f64, height: f64) -> Self {
        Self { body: String::new(), width, height }
    }

    /// Adds what `element` writes.
    fn add(&mut self, element: impl Display) {
        // Writing to a string does not fail.
        let _ = writeln!(self.body, "{element}");
    }

    /// A straight line.
    pub fn line(&mut self, (x1, y1): (f64, f64), (x2, y2): (f64, f64), class: &str) {
        self.add(format_args!(
            r#"<line x1="{x1:.1}" y1="{y1:.1}" x2="{x2:.1}" y2="{y2:.1}" class="{class}"/>"#
        ));
    }

    /// Lines through points.
    pub fn path(&mut self, points: &[(f64, f64)], class: &str) {
        let mut d = String::new();
        for (i, (x, y)) in points.iter().enumerate() {
            let _ = write!(d, "{}{x:.1} {y:.1}", if i == 0 { "M" } else { " L" });
        }
        self.add(format_args!(r#"<path d="{d}" class="{class}"/>"#));
    }

    /// A rectangle.
    pub fn rect(&mut self, (x, y): (f64, f64), (width, height): (f64, f64), class: &str) {
        self.add(format_args!(
            r#"<rect x="{x:.1}" y="{y:.1}" width="{width:.1}" height="{height:.1}" class="{class}"/>"#
        ));
    }

    /// Text; `y` is its base line.
    pub fn text(&mut self, (x, y): (f64, f64), anchor: Anchor, class: &str, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let text = escape(text);
        self.add(format_args!(
            r#"<text x="{x:.1}" y="{y:.1}" text-anchor="{anchor}" class="{class}">{text}</text>"#
        ));
    }

    /// A point's marker.
    pub fn marker(&mut self, (x, y): (f64, f64), shape: crate::palette::Shape, class: &str) {
        use crate::palette::Shape;
        match shape {
            Shape::Circle => {
                self.add(format_args!(r#"<circle cx="{x:.1}" cy="{y:.1}" r="{MARKER}" class="{class}"/>"#));
            }
            Shape::Square => {
                let half = MARKER * 0.89;
                self.rect((x - half, y - half), (2.0 * half, 2.0 * half), class);
            }
            Shape::Triangle => self.polygon(&[(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)], (x, y), class),
            Shape::Diamond => {
                self.polygon(&[(0.0, -1.25), (1.25, 0.0), (0.0, 1.25), (-1.25, 0.0)], (x, y), class)
            }
        }
    }

    fn polygon(&mut self, corners: &[(f64, f64)], (x, y): (f64, f64), class: &str) {
        let corners: Vec<String> =
            corners.iter().map(|(dx, dy)| format!("{:.1},{:.1}", x + dx * MARKER, y + dy * MARKER)).collect();
        self.add(format_args!(r#"<polygon points="{}" class="{class}"/>"#, corners.join(" ")));
    }

    /// What `draw` draws, with figures that show on hovering and to screen readers.
    pub fn tip(&mut self, tip: &str, draw: impl FnOnce(&mut Self)) {
        self.add(format_args!(r#"<g class="tip" tabindex="0"><title>{}</title>"#, escape(tip)));
        draw(self);
        self.add("</g>");
    }

    /// The drawing as an element, with a name for screen readers.
    pub fn finish(self, label: &str) -> String {
        let Self { body, width, height } = self;
        let label = escape(label);
        format!(
            "<svg viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" height=\"{height:.0}\" role=\"group\" \
             aria-label=\"{label}\">\n{body}</svg>\n"
        )
    }
}

/// Radius of a point's marker.
pub const MARKER: f64 = 4.5;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_can_not_break_out() {
        let mut svg = Svg::new(10.0, 10.0);
        svg.text((0.0, 0.0), Anchor::Start, "", "</text><script>&'\"");
        let drawn = svg.finish("\"><script>");
        assert!(!drawn.contains("<script>"), "{drawn}");
        assert!(drawn.contains("&lt;script&gt;&amp;&#39;&quot;"));
    }

    #[test]
    fn longer_text_is_wider() {
        assert!(width("obvhs-cwbvh") > width("obvhs"));
        assert_eq!(width(""), 0.0);
    }
}
