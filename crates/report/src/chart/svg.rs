//! Drawings as SVG, with text as text.

use super::palette::{Shape, outline};
use crate::table::printable;
use maud::{Markup, Render, html};
use std::borrow::Cow;

/// Height of text in a drawing, in its units.
pub const TEXT: f64 = 11.0;

/// A width that the text does not exceed at the size of all text in the usual sans-serif fonts; DejaVu
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

impl Anchor {
    const fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Middle => "middle",
            Self::End => "end",
        }
    }
}

/// A position or length in a drawing.
#[derive(Clone, Copy)]
struct At(f64);

impl Render for At {
    fn render_to(&self, out: &mut String) {
        format_args!("{:.1}", self.0).render_to(out);
    }
}

/// A place in a drawing: to the right and down.
pub type Point = (f64, f64);

/// A drawing under way.
#[derive(Default)]
pub struct Svg {
    parts: Vec<Markup>,
}

impl Svg {
    /// A straight line.
    pub fn line(&mut self, (x1, y1): Point, (x2, y2): Point, class: &str) {
        self.parts.push(html! { line x1=(At(x1)) y1=(At(y1)) x2=(At(x2)) y2=(At(y2)) class=(class) {} "\n" });
    }

    /// Lines through points.
    pub fn path(&mut self, points: &[Point], class: &str) {
        let d = html! { @for (i, (x, y)) in points.iter().enumerate() {
            @if i == 0 { "M" } @else { " L" } (At(*x)) " " (At(*y))
        } };
        self.parts.push(html! { path d=(d) class=(class) {} "\n" });
    }

    /// A rectangle.
    pub fn rect(&mut self, (x, y): Point, (width, height): (f64, f64), class: &str) {
        self.parts.push(html! {
            rect x=(At(x)) y=(At(y)) width=(At(width)) height=(At(height)) class=(class) {} "\n"
        });
    }

    /// Text; the place's height is that of its base line.
    pub fn text(&mut self, (x, y): Point, anchor: Anchor, class: &str, text: &str) {
        let text = plain(text);
        self.parts.push(html! {
            text x=(At(x)) y=(At(y)) text-anchor=(anchor.name()) class=(class) { (text) } "\n"
        });
    }

    /// A point's marker.
    pub fn marker(&mut self, (x, y): Point, shape: Shape, class: &str) {
        self.parts.push(html! {
            path.(class) d=(outline(shape)) transform={ "translate(" (At(x)) " " (At(y)) ")" } {} "\n"
        });
    }

    /// What `draw` draws, with figures that show on hovering and to screen readers.
    pub fn tip(&mut self, tip: &str, draw: impl FnOnce(&mut Self)) {
        let mut inner = Self::default();
        draw(&mut inner);
        let tip = plain(tip);
        self.parts.push(html! { g.tip tabindex="0" { title { (tip) } "\n" (inner.parts()) } "\n" });
    }

    /// What was drawn, without a frame.
    pub fn parts(&self) -> Markup {
        html! { @for part in &self.parts { (part) } }
    }

    /// The drawing as an element of a page, of this size in CSS pixels, with a name for screen readers.
    pub fn finish(self, (width, height): (f64, f64), label: &str) -> Markup {
        let label = plain(label);
        html! {
            svg viewBox={ "0 0 " (width) " " (height) } width=(width) height=(height) role="group" aria-label=(label) {
                "\n" (self.parts())
            }
        }
    }
}

/// Characters that no XML may hold would make the whole drawing unreadable.
fn plain(text: &str) -> Cow<'_, str> {
    printable(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_can_not_break_out() {
        let mut svg = Svg::default();
        svg.text((0.0, 0.0), Anchor::Start, "", "</text><script>&'\"\0");
        svg.tip("</title><script>", |_| {});
        let drawn = svg.finish((10.0, 10.0), "\"><script>").into_string();
        assert!(!drawn.contains("<script>") && !drawn.contains('\0'), "{drawn}");
        assert!(drawn.contains("&lt;script&gt;&amp;'&quot;"));
    }

    #[test]
    fn longer_text_is_wider() {
        assert!(width("obvhs-cwbvh") > width("obvhs"));
        assert_eq!(width(""), 0.0);
    }
}
