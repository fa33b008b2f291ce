//! Settings of a structure as words: `name=value`.

use super::{RegistryError, near};
use accel::KernelId;
use accel::simd::Level;
use std::str::FromStr;

/// A setting that a structure understands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Its name.
    pub name: &'static str,
    /// Its values and what they do, in a line.
    pub help: &'static str,
}

/// The ray-triangle test; see [`Settings::kernel`].
pub const KERNEL: Setting =
    Setting { name: "kernel", help: "ray-triangle test: moller-trumbore (default), watertight, …" };
/// The instruction set; see [`Settings::simd`].
pub const SIMD: Setting =
    Setting { name: "simd", help: "portable, avx2, avx512 or neon; the widest present by default" };

/// A structure by name with settings, as written: `id` or `id:name=value,name=value`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StructureSpec {
    /// The structure's id.
    pub id: String,
    /// Names and values in the order given.
    pub settings: Vec<(String, String)>,
}

impl StructureSpec {
    /// With a setting added, unless it is set already.
    #[must_use]
    pub fn with_default(mut self, name: &str, value: impl ToString) -> Self {
        if self.get(name).is_none() {
            self.settings.push((name.to_owned(), value.to_string()));
        }
        self
    }

    /// The value of a setting, if given.
    pub fn get(&self, name: &str) -> Option<&str> {
        self.settings.iter().find(|(n, _)| n == name).map(|(_, value)| value.as_str())
    }
}

impl FromStr for StructureSpec {
    type Err = RegistryError;

    fn from_str(text: &str) -> Result<Self, RegistryError> {
        let (id, rest) = text.split_once(':').unwrap_or((text, ""));
        let mut spec = Self { id: id.trim().to_owned(), settings: Vec::new() };
        for pair in rest.split([',', ' ']).filter(|pair| !pair.is_empty()) {
            let syntax = || RegistryError::Syntax { text: text.to_owned(), pair: pair.to_owned() };
            let (name, value) = pair.split_once('=').ok_or_else(syntax)?;
            if name.is_empty() || value.is_empty() || spec.get(name).is_some() {
                return Err(syntax());
            }
            spec.settings.push((name.to_owned(), value.to_owned()));
        }
        Ok(spec)
    }
}

impl std::fmt::Display for StructureSpec {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.id)?;
        for (i, (name, value)) in self.settings.iter().enumerate() {
            write!(f, "{}{name}={value}", if i == 0 { ':' } else { ',' })?;
        }
        Ok(())
    }
}

/// The settings of one structure, every name known to it.
#[derive(Clone, Copy, Debug)]
pub struct Settings<'a>(&'a StructureSpec);

impl<'a> Settings<'a> {
    /// Checks the names.
    ///
    /// # Errors
    /// [`RegistryError::UnknownSetting`] with near names.
    pub fn new(spec: &'a StructureSpec, known: &[Setting]) -> Result<Self, RegistryError> {
        for (name, _) in &spec.settings {
            if !known.iter().any(|setting| setting.name == name) {
                return Err(RegistryError::UnknownSetting {
                    structure: spec.id.clone(),
                    setting: name.clone(),
                    near: near(name, known.iter().map(|s| s.name)),
                    known: known.iter().map(|s| s.name.to_owned()).collect(),
                });
            }
        }
        Ok(Self(spec))
    }

    /// The value as written, if given.
    pub fn text(&self, name: &str) -> Option<&'a str> {
        self.0.get(name)
    }

    /// A setting of any type that can be read from a word, or `None` where it isn't given.
    ///
    /// # Errors
    /// [`RegistryError::Value`] with `expected` where `read` finds no value.
    pub fn read<T>(
        &self,
        name: &str,
        expected: &str,
        read: impl FnOnce(&str) -> Option<T>,
    ) -> Result<Option<T>, RegistryError> {
        self.text(name)
            .map(|value| {
                read(value).ok_or_else(|| RegistryError::Value {
                    structure: self.0.id.clone(),
                    setting: name.to_owned(),
                    value: value.to_owned(),
                    expected: expected.to_owned(),
                })
            })
            .transpose()
    }

    /// A number.
    ///
    /// # Errors
    /// As [`Settings::read`].
    pub fn number<T: FromStr>(&self, name: &str) -> Result<Option<T>, RegistryError> {
        self.read(name, "a number", |value| value.parse().ok())
    }

    /// `true` or `false`.
    ///
    /// # Errors
    /// As [`Settings::read`].
    pub fn flag(&self, name: &str) -> Result<Option<bool>, RegistryError> {
        self.read(name, "true or false", |value| value.parse().ok())
    }

    /// Slices per axis: `64` for all, or `64x32x1`.
    ///
    /// # Errors
    /// As [`Settings::read`].
    pub fn resolution(&self, name: &str) -> Result<Option<[u32; 3]>, RegistryError> {
        self.read(name, "slices per axis such as 64 or 64x32x1, each at least 1", |value| {
            let each: Option<Vec<u32>> =
                value.split('x').map(|n| n.parse().ok().filter(|n| *n > 0)).collect();
            match each?[..] {
                [n] => Some([n; 3]),
                [x, y, z] => Some([x, y, z]),
                _ => None,
            }
        })
    }

    /// One of some words.
    ///
    /// # Errors
    /// As [`Settings::read`].
    pub fn word(&self, name: &str, words: &[&'static str]) -> Result<Option<&'static str>, RegistryError> {
        let expected = format!("one of {}", words.join(", "));
        self.read(name, &expected, |value| words.iter().find(|word| **word == value).copied())
    }

    /// The ray-triangle test; Möller–Trumbore by default.
    ///
    /// # Errors
    /// As [`Settings::read`].
    pub fn kernel(&self) -> Result<KernelId, RegistryError> {
        let expected = format!("one of {}", KernelId::ALL.map(KernelId::id).join(", "));
        Ok(self.read("kernel", &expected, KernelId::from_id)?.unwrap_or(KernelId::MollerTrumbore))
    }

    /// The instruction set; the widest of this machine by default.
    ///
    /// # Errors
    /// As [`Settings::read`]; also for an instruction set that this machine lacks.
    pub fn simd(&self) -> Result<Level, RegistryError> {
        let here: Vec<_> = Level::here().map(Level::id).collect();
        let expected = format!("one of this machine's {}", here.join(", "));
        let level =
            self.read("simd", &expected, |id| Level::from_id(id).filter(|level| level.available()))?;
        Ok(level.unwrap_or_else(Level::best))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn specs_are_read_and_written_back() {
        for text in ["brute", "minmax:kernel=watertight", "x:a=1,b=2x3x4"] {
            assert_eq!(text.parse::<StructureSpec>().unwrap().to_string(), text);
        }
        for text in ["x:a", "x:=1", "x:a=", "x:a=1,a=2"] {
            assert!(matches!(text.parse::<StructureSpec>(), Err(RegistryError::Syntax { .. })), "{text}");
        }
    }

    #[test]
    fn values_are_typed() {
        let known = [Setting { name: "n", help: "" }, KERNEL, SIMD];
        let with = |text: &str, test: &dyn Fn(Settings)| {
            let spec = text.parse().unwrap();
            test(Settings::new(&spec, &known).unwrap());
        };
        with("x:n=4", &|s| assert_eq!(s.resolution("n").unwrap(), Some([4; 3])));
        with("x:n=4x5x6", &|s| assert_eq!(s.resolution("n").unwrap(), Some([4, 5, 6])));
        for bad in ["x:n=0", "x:n=4x5", "x:n=-1", "x:n=1x0x1"] {
            with(bad, &|s| assert!(s.resolution("n").is_err(), "{bad}"));
        }
        with("x:kernel=watertight", &|s| assert_eq!(s.kernel().unwrap(), KernelId::Watertight));
        with("x:kernel=water", &|s| assert!(s.kernel().unwrap_err().to_string().contains("moller-trumbore")));
        with("x:simd=portable", &|s| assert_eq!(s.simd().unwrap(), Level::Portable));
        with("x", &|s| assert_eq!(s.number::<f32>("n").unwrap(), None));
    }

    #[test]
    fn unknown_settings_get_near_names() {
        let spec = "x:kernal=watertight".parse().unwrap();
        let error = Settings::new(&spec, &[KERNEL, SIMD]).unwrap_err();
        assert!(error.to_string().contains("near: kernel"), "{error}");
    }
}
