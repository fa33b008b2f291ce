//! Settings of a structure as words: `name=value`.

use super::RegistryError;
use lanes::Level;
use primitives::KernelId;
use scenes::near::near;
use std::str::FromStr;

/// A setting that a structure understands: its name, and its values in a line.
pub type Setting = (&'static str, &'static str);

/// The ray-triangle test; see [`Settings::kernel`].
pub const KERNEL: Setting = ("kernel", "ray-triangle test; quantised and box are lossy");
/// The instruction set; see [`Settings::simd`].
pub const SIMD: Setting = ("simd", "instruction set");

/// A structure by name with settings, as written: `id` or `id:name=value,name=value`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StructureSpec {
    /// The structure's id.
    pub id: String,
    /// Names and values in the order given.
    pub settings: Vec<(String, String)>,
}

impl StructureSpec {
    /// A structure by its default settings.
    pub fn plain(id: &str) -> Self {
        Self { id: id.to_owned(), settings: Vec::new() }
    }

    /// With a setting added, unless it is set already.
    #[must_use]
    pub fn with_default(mut self, name: &str, value: impl ToString) -> Self {
        if self.get(name).is_none() {
            self.settings.push((name.to_owned(), value.to_string()));
        }
        self
    }

    /// With this value of a setting, whatever it was before.
    #[must_use]
    pub fn with(&self, name: &str, value: &str) -> Self {
        let mut spec = self.clone();
        spec.settings.retain(|(n, _)| n != name);
        spec.settings.push((name.to_owned(), value.to_owned()));
        spec
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
            if !known.iter().any(|(known, _)| known == name) {
                return Err(RegistryError::UnknownSetting {
                    structure: spec.id.clone(),
                    setting: name.clone(),
                    near: near(name, known.iter().map(|(name, _)| *name)),
                    known: known.iter().map(|(name, _)| (*name).to_owned()).collect(),
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
    /// [`RegistryError::Value`] with what `read` says.
    pub fn read<T>(
        &self,
        name: &str,
        read: impl FnOnce(&str) -> Result<T, String>,
    ) -> Result<Option<T>, RegistryError> {
        let error = |problem| RegistryError::Value {
            structure: self.0.id.clone(),
            setting: name.to_owned(),
            problem,
        };
        self.text(name).map(|value| read(value).map_err(error)).transpose()
    }

    /// Names and values as written.
    pub fn pairs(&self) -> impl Iterator<Item = (&'a str, &'a str)> {
        self.0.settings.iter().map(|(name, value)| (name.as_str(), value.as_str()))
    }

    /// The ray-triangle test; Möller–Trumbore by default.
    ///
    /// # Errors
    /// As [`Settings::read`].
    pub fn kernel(&self) -> Result<KernelId, RegistryError> {
        Ok(self.read("kernel", KernelId::parse)?.unwrap_or(KernelId::MollerTrumbore))
    }

    /// The instruction set; the widest of this machine by default.
    ///
    /// # Errors
    /// As [`Settings::read`]; also for an instruction set that this machine lacks.
    pub fn simd(&self) -> Result<Level, RegistryError> {
        Ok(self.read("simd", Level::parse)?.unwrap_or_else(Level::best))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::settings::number;

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
        let known = [("n", ""), KERNEL, SIMD];
        let with = |text: &str, test: &dyn Fn(Settings)| {
            let spec = text.parse().unwrap();
            test(Settings::new(&spec, &known).unwrap());
        };
        with("x:kernel=watertight", &|s| assert_eq!(s.kernel().unwrap(), KernelId::Watertight));
        with("x:kernel=water", &|s| assert!(s.kernel().unwrap_err().to_string().contains("moller-trumbore")));
        with("x:simd=portable", &|s| assert_eq!(s.simd().unwrap(), Level::Portable));
        with("x:n=4", &|s| assert_eq!(s.read("n", |n| number(n, 1, 9)).unwrap(), Some(4)));
        with("x:n=?", &|s| assert!(s.read("n", |n| number(n, 1, 9)).is_err()));
    }

    #[test]
    fn unknown_settings_get_near_names() {
        let spec = "x:kernal=watertight".parse().unwrap();
        let error = Settings::new(&spec, &[KERNEL, SIMD]).unwrap_err();
        assert!(error.to_string().contains("near: kernel"), "{error}");
    }
}
