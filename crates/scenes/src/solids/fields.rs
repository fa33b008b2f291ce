//! The fields of a solid's table.

use accel::{Solid, Vec3};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::{Spanned, Value};

/// A solid's table while it is read.
pub struct Table<'a> {
    /// What the table says, such as `solid 3`.
    name: String,
    kind: String,
    /// Where it begins, as far as its fields tell.
    line: usize,
    fields: BTreeMap<&'a str, (usize, &'a Value)>,
    /// The lines of those that were read.
    read: BTreeMap<&'static str, usize>,
    /// The definition's.
    folder: Option<&'a Path>,
}

impl<'a> Table<'a> {
    /// The `number`th solid of the definition `text`.
    pub fn new(
        number: usize,
        table: &'a BTreeMap<String, Spanned<Value>>,
        text: &str,
        folder: Option<&'a Path>,
    ) -> Self {
        let line = |at: usize| 1 + text.bytes().take(at).filter(|byte| *byte == b'\n').count();
        let field = |(name, value): (&'a String, &'a Spanned<Value>)| {
            (name.as_str(), (line(value.span().start), value.get_ref()))
        };
        let fields: BTreeMap<_, _> = table.iter().map(field).collect();
        let first = fields.values().map(|(line, _)| *line).min();
        Self {
            name: format!("solid {number}"),
            kind: String::new(),
            line: first.unwrap_or(1),
            fields,
            read: BTreeMap::new(),
            folder,
        }
    }

    /// The tables of a field, which are parts of this one's solid. Where they stand is known no better than where the field does.
    pub fn parts(&mut self, field: &'static str) -> Result<Vec<Self>, String> {
        let value = self.value(field)?;
        let line = self.read.get(field).copied().unwrap_or(self.line);
        let tables: Option<Vec<&'a toml::Table>> =
            value.as_array().and_then(|parts| parts.iter().map(Value::as_table).collect());
        let Some(tables) = tables.filter(|tables| tables.len() >= 2) else {
            return Err(self.refuse(field, "must be two tables or more, each a solid"));
        };
        let part = |(number, table): (usize, &'a toml::Table)| Self {
            name: format!("{} ({}), part {}", self.name, self.kind, number + 1),
            kind: String::new(),
            line,
            fields: table.iter().map(|(name, value)| (name.as_str(), (line, value))).collect(),
            read: BTreeMap::new(),
            folder: self.folder,
        };
        Ok(tables.into_iter().enumerate().map(part).collect())
    }

    /// A file, which a definition names relative to its own folder.
    pub fn path(&mut self, field: &'static str) -> Result<PathBuf, String> {
        let name = self.text(field)?;
        Ok(self.folder.map_or_else(|| PathBuf::from(name), |folder| folder.join(name)))
    }

    fn error(&self, line: usize, what: &str) -> String {
        let kind = if self.kind.is_empty() { String::new() } else { format!(" ({})", self.kind) };
        format!("line {line}, {}{kind}: {what}", self.name)
    }

    /// Something wrong with a field that was read.
    pub fn refuse(&self, field: &str, what: &str) -> String {
        self.error(self.read.get(field).copied().unwrap_or(self.line), &format!("`{field}` {what}"))
    }

    /// What a field says, if it is there.
    pub fn optional(&mut self, field: &'static str) -> Option<&'a Value> {
        let (line, value) = self.fields.remove(field)?;
        self.read.insert(field, line);
        Some(value)
    }

    fn value(&mut self, field: &'static str) -> Result<&'a Value, String> {
        self.optional(field).ok_or_else(|| self.refuse(field, "is missing"))
    }

    /// A text.
    pub fn text(&mut self, field: &'static str) -> Result<&'a str, String> {
        let value = self.value(field)?;
        value.as_str().ok_or_else(|| self.refuse(field, &format!("must be a text, not {value}")))
    }

    /// The kind, which later errors name.
    pub fn kind(&mut self) -> Result<String, String> {
        let kind = self.text("kind")?.to_owned();
        self.kind.clone_from(&kind);
        Ok(kind)
    }

    /// An unknown kind.
    pub fn unknown_kind(&mut self, known: &[&str]) -> String {
        let kind = std::mem::take(&mut self.kind);
        let near = crate::near::near(&kind, known.iter().copied());
        let hint = match near.first() {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("there are {}", known.join(", ")),
        };
        self.refuse("kind", "").trim_end().to_owned() + &format!(": there is no kind `{kind}`; {hint}")
    }

    /// A number.
    pub fn number(&mut self, field: &'static str) -> Result<f32, String> {
        let value = self.value(field)?;
        number(value).ok_or_else(|| self.refuse(field, &format!("must be a number, not {value}")))
    }

    /// A number that may be left out.
    pub fn number_or(&mut self, field: &'static str, other: f32) -> Result<f32, String> {
        if self.fields.contains_key(field) { self.number(field) } else { Ok(other) }
    }

    /// So many numbers.
    pub fn numbers<const N: usize>(&mut self, field: &'static str) -> Result<[f32; N], String> {
        let value = self.value(field)?;
        let count = if N == 3 { "three".to_owned() } else { N.to_string() };
        numbers(value).ok_or_else(|| self.refuse(field, &format!("must be {count} numbers, not {value}")))
    }

    /// A point or a direction.
    pub fn point(&mut self, field: &'static str) -> Result<Vec3, String> {
        Ok(Vec3::from_array(self.numbers(field)?))
    }

    /// So many points.
    pub fn points<const N: usize>(&mut self, field: &'static str) -> Result<[Vec3; N], String> {
        let value = self.value(field)?;
        let points: Option<Vec<Vec3>> = value
            .as_array()
            .and_then(|points| points.iter().map(|point| numbers(point).map(Vec3::from_array)).collect());
        let count = points.as_ref().map_or(0, Vec::len);
        points.and_then(|points| points.try_into().ok()).ok_or_else(|| {
            self.refuse(field, &format!("must be {N} points of three numbers each; {count} are there"))
        })
    }

    /// That nothing else was said, and that the solid can be traced.
    pub fn finish(&self, solid: &Solid) -> Result<(), String> {
        if let Some((name, (line, _))) = self.fields.first_key_value() {
            return Err(self.error(*line, &format!("there is no field `{name}`")));
        }
        solid.validate().map_err(|error| self.refuse(self.said(error.field), &error.reason))
    }

    /// A cylinder's radius stands for both of the cone that it becomes, a file for its mesh.
    fn said(&self, field: &'static str) -> &'static str {
        match field {
            field if self.read.contains_key(field) => field,
            field if field.ends_with("radius") => "radius",
            "mesh" => "file",
            field => field,
        }
    }
}

fn number(value: &Value) -> Option<f32> {
    match value {
        Value::Float(number) => Some(*number as f32),
        Value::Integer(number) => Some(*number as f32),
        _ => None,
    }
}

fn numbers<const N: usize>(value: &Value) -> Option<[f32; N]> {
    let all: Option<Vec<f32>> = value.as_array()?.iter().map(number).collect();
    all?.try_into().ok()
}
