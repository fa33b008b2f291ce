//! Charts side by side in a file of their own, with a key.

use super::palette::Shape;
use super::plot::Plot;
use super::style::RULES;
use super::svg::{Anchor, Svg, TEXT, width};
use maud::{PreEscaped, html};

/// A sign of the key and what it means.
pub struct Sign {
    /// The shape; a line where there is none.
    pub shape: Option<Shape>,
    /// How it looks.
    pub class: String,
    /// What it means.
    pub name: String,
}

/// Charts of one size in rows, under a key. Paper is white: there is one theme.
pub struct Sheet {
    /// Charts in a row.
    pub columns: usize,
    /// The charts.
    pub plots: Vec<Plot>,
    /// The key, a row each kind of sign.
    pub key: Vec<Vec<Sign>>,
    /// What is to be said.
    pub note: String,
    /// Colours of the classes `s0`, `s1`, ….
    pub colours: Vec<&'static str>,
}

const MARGIN: f64 = 12.0;
const ROW: f64 = TEXT + 6.0;
/// Height of a chart's name.
const NAME: f64 = 20.0;

impl Sheet {
    /// The file.
    pub fn file(&self) -> String {
        let size = self.plots.first().map_or((0.0, 0.0), |plot| plot.size);
        let columns = self.columns.min(self.plots.len()).max(1);
        let full = (columns as f64 * size.0).max(360.0).max(width(&self.note)) + 2.0 * MARGIN;
        let mut svg = Svg::default();
        let top = self.head(&mut svg, full);
        for (i, plot) in self.plots.iter().enumerate() {
            let corner =
                (MARGIN + (i % columns) as f64 * size.0, top + (i / columns) as f64 * (size.1 + NAME) + NAME);
            svg.text((corner.0 + 4.0, corner.1 - 4.0), Anchor::Start, "name", &plot.name);
            plot.draw(&mut svg, corner);
        }
        let height = top + self.plots.len().div_ceil(columns) as f64 * (size.1 + NAME) + MARGIN;
        let style = self.css();
        let file = html! {
            svg xmlns="http://www.w3.org/2000/svg" viewBox={ "0 0 " (full) " " (height) } width=(full) height=(height) {
                style { (PreEscaped(style)) }
                rect width="100%" height="100%" fill="#fff" {}
                "\n" (svg.parts())
            }
        };
        file.into_string() + "\n"
    }

    /// Draws key and note; where they end.
    fn head(&self, svg: &mut Svg, full: f64) -> f64 {
        let mut y = MARGIN;
        for signs in &self.key {
            let mut x = MARGIN;
            y += ROW;
            for Sign { shape, class, name } in signs {
                let room = 18.0 + width(name) + 14.0;
                if x > MARGIN && x + room > full - MARGIN {
                    (x, y) = (MARGIN, y + ROW);
                }
                match shape {
                    Some(shape) => svg.marker((x + 6.0, y - 4.0), *shape, class),
                    None => svg.line((x, y - 4.0), (x + 13.0, y - 4.0), class),
                }
                svg.text((x + 18.0, y), Anchor::Start, "label", name);
                x += room;
            }
        }
        if !self.note.is_empty() {
            y += ROW;
            svg.text((MARGIN, y), Anchor::Start, "axis", &self.note);
        }
        y + 6.0
    }

    /// The rules, with colours instead of variables: programs that show files don't all know these.
    fn css(&self) -> String {
        let variables = [
            ("var(--text)", "#1b1f24"),
            ("var(--soft)", "#59626d"),
            ("var(--line)", "#d4d9df"),
            ("var(--ground)", "#fff"),
        ];
        let rules = variables.iter().fold(RULES.to_owned(), |css, (name, value)| css.replace(name, value));
        let (common, coloured): (Vec<&str>, Vec<&str>) =
            rules.lines().partition(|rule| !rule.contains("var(--c)"));
        let each = self.colours.iter().enumerate().flat_map(|(i, colour)| {
            coloured.iter().filter_map(move |rule| {
                let (selector, body) = rule.split_once('{')?;
                Some(format!("{selector}.s{i}{{{}", body.replace("var(--c)", colour)))
            })
        });
        let name = "text.name{font-weight:bold;font-size:12px}".to_owned();
        let common = common.into_iter().map(str::to_owned);
        common.chain([name]).chain(each).collect::<Vec<_>>().join("\n")
    }
}
