//! Classes that give each structure its colour, in light and dark.

use super::palette::{self, Shape};
use std::fmt::Write;

/// Rules of all charts. Colours are variables, which a page sets by theme.
pub const RULES: &str = include_str!("chart.css");

/// The structures of a report with their classes.
pub struct Styles {
    names: Vec<String>,
}

impl Styles {
    /// For these structures.
    pub fn new<'n>(names: impl IntoIterator<Item = &'n str>) -> Self {
        let mut all: Vec<String> = Vec::new();
        for name in names {
            if !all.iter().any(|known| known == name) {
                all.push(name.to_owned());
            }
        }
        Self { names: all }
    }

    /// The class of a structure.
    pub fn class(&self, structure: &str) -> String {
        let index = self.names.iter().position(|name| name == structure).unwrap_or(self.names.len());
        format!("s{index}")
    }

    /// The shape of a structure's points.
    pub fn shape(&self, structure: &str) -> Shape {
        palette::of(structure).shape
    }

    /// The rules of all classes.
    pub fn css(&self) -> String {
        let (mut light, mut dark) = (String::new(), String::new());
        let strangers = std::iter::once("");
        for (i, name) in self.names.iter().map(String::as_str).chain(strangers).enumerate() {
            let look = palette::of(name);
            // Writing to a string does not fail.
            let _ = writeln!(light, ".s{i}{{--c:{}}}", look.light);
            let _ = write!(dark, ".s{i}{{--c:{}}}", look.dark);
        }
        format!("{light}@media screen and (prefers-color-scheme:dark){{{dark}}}\n")
    }
}
