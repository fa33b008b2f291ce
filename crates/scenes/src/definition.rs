//! Scene definitions: TOML files that say everything about a scene.

use crate::camera::Camera;
use crate::generate::Generator;
use crate::modifier::Transform;
use crate::solids::Tables;
use accel::Solid;
use serde::Deserialize;
use std::path::Path;

/// One TOML file under `scenes/`, or a user's own.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Definition {
    /// The scene's name. In a template it holds numbers in braces, as in `small-{objects}`.
    pub id: String,
    /// What it shows, in a sentence.
    pub description: String,
    /// The one character that it tests.
    pub character: String,
    /// Who should suffer from it.
    #[serde(default)]
    pub suffers: String,
    /// Seed of the generator.
    #[serde(default = "one")]
    pub seed: u64,
    /// Whether the scene belongs to the default set.
    #[serde(default)]
    pub default: bool,
    /// Template only: the scenes that lists show.
    #[serde(default)]
    pub members: Vec<String>,
    /// Template only: those of them in the default set.
    #[serde(default)]
    pub default_members: Vec<String>,
    /// Where the geometry comes from: a generator,
    pub generator: Option<Generator>,
    /// a mesh file,
    pub file: Option<MeshFile>,
    /// another scene by its id, to be transformed,
    pub base: Option<String>,
    /// or a table for each solid.
    #[serde(default, rename = "solid")]
    tables: Tables,
    /// The solids that these say.
    #[serde(skip)]
    pub solids: Vec<Solid>,
    /// Applied to every coordinate after all else.
    #[serde(default)]
    pub transform: Transform,
    /// Triangles are cut until no edge is longer (Skala 1993, §2).
    pub split: Option<f64>,
    /// The camera, before the transform; what is not told is as in one that sees the whole scene.
    #[serde(default)]
    pub view: Camera,
}

/// A mesh that is fetched at set-up, or a user's own.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct MeshFile {
    /// File name in the folder of meshes; for a user's definition relative to it.
    pub name: String,
    /// SHA-256 of the file's bytes in hex; unchecked if absent.
    pub sha256: Option<String>,
    /// Where it comes from.
    #[serde(default)]
    pub source: String,
    /// Under which terms.
    #[serde(default)]
    pub licence: String,
    /// Number of triangles, for lists; checked on loading.
    pub triangles: Option<u64>,
}

fn one() -> u64 {
    1
}

impl Definition {
    /// Reads a definition.
    ///
    /// # Errors
    /// In words, what is wrong and where in the text.
    pub fn parse(text: &str) -> Result<Self, String> {
        Self::parse_in(text, None)
    }

    /// As [`Definition::parse`], of a file in this folder.
    ///
    /// # Errors
    /// As [`Definition::parse`].
    pub fn parse_in(text: &str, folder: Option<&Path>) -> Result<Self, String> {
        let mut definition: Self =
            toml::from_str(text).map_err(|error| error.to_string().trim_end().to_owned())?;
        definition.validate()?;
        definition.solids = definition.tables.solids(text, folder)?;
        Ok(definition)
    }

    fn validate(&self) -> Result<(), String> {
        let listed = !self.tables.is_empty();
        let origins = [self.generator.is_some(), self.file.is_some(), self.base.is_some(), listed];
        if origins.iter().filter(|given| **given).count() != 1 {
            return Err("exactly one of `generator`, `file`, `base` and `solid` must be given".into());
        }
        if self.split.is_some_and(|length| !(length > 0.0 && length.is_finite())) {
            return Err("`split` must be a positive length".into());
        }
        self.transform.validate()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "id = 'a'\ndescription = 'b'\ncharacter = 'c'\n";

    #[test]
    fn slips_are_explained() {
        for (text, says) in [
            ("", "exactly one of"),
            ("base = 'x'\n[generator]\nkind = 'sombrero'\nsize_factor = 1", "exactly one of"),
            ("[generator]\nkind = 'sombrro'", "sombrro"),
            ("[generator]\nkind = 'sombrero'\nsize = 1", "size"),
            ("base = 'x'\nsplit = -1.0", "positive length"),
            ("base = 'x'\n[transform]\nscale_exponent = 4000", "exponent"),
            ("base = 'x'\n[view]\nup = 'w'", "axis"),
            ("base = 'x'\n[view]\nup = [0, 0, 0]", "other than zero"),
            ("base = 'x'\n[view]\nroll = 3", "roll"),
            ("base = 'x'\nbogus = 1", "bogus"),
        ] {
            let error = Definition::parse(&format!("{HEAD}{text}")).unwrap_err();
            assert!(error.contains(says), "{text:?} gave {error}");
        }
        assert!(Definition::parse(&format!("{HEAD}base = 'x'")).is_ok());
    }
}
