//! How a user names a scene: an id, a definition's path, or a mesh's path.

use crate::error::SceneError;
use crate::modifier::Modifiers;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// A scene by name.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSpec {
    /// Where it is described.
    pub source: Source,
    /// What is changed about it.
    pub modifiers: Modifiers,
    /// The modifiers as written, `@` included; part of the scene's id.
    pub suffix: String,
}

/// Where a scene is described.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// One of the suite's own scenes.
    Id(String),
    /// A TOML definition.
    Definition(PathBuf),
    /// An OBJ or ASCII PLY file.
    Mesh(PathBuf),
}

impl FromStr for SceneSpec {
    type Err = SceneError;

    /// `.toml`, `.obj`, `.ply` and `.bpt` make a path of a name; all else is an id. Modifiers follow
    /// after `@`.
    fn from_str(text: &str) -> Result<Self, SceneError> {
        // A path may hold an @ of its own: the modifiers begin at the last one that a path can end at.
        let ends = text.match_indices('@').map(|(i, _)| i).chain([text.len()]);
        let path_end = ends.rev().find(|end| file(&text[..*end]).is_some());
        let (base, suffix) = text.split_at(path_end.or(text.find('@')).unwrap_or(text.len()));
        let bad = |reason| SceneError::Definition { origin: format!("`{text}`"), reason };
        let modifiers = Modifiers::parse(suffix).map_err(bad)?;
        let source = match file(base) {
            Some(source) => source,
            None if Path::new(base).is_file() => {
                return Err(bad(
                    "a file must end in .obj, .ply (ASCII), .bpt (patches) or .toml (a definition)".into(),
                ));
            }
            None => Source::Id(base.to_owned()),
        };
        Ok(Self { source, modifiers, suffix: suffix.to_owned() })
    }
}

fn file(text: &str) -> Option<Source> {
    let path = PathBuf::from(text);
    match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
        "toml" => Some(Source::Definition(path)),
        "obj" | "ply" | "bpt" => Some(Source::Mesh(path)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_paths_are_told_apart() {
        let source = |text: &str| text.parse::<SceneSpec>().unwrap().source;
        assert_eq!(source("small-10k"), Source::Id("small-10k".into()));
        assert_eq!(source("a/b@c.OBJ"), Source::Mesh("a/b@c.OBJ".into()));
        assert_eq!(source("a@b/c@d.obj@up=z"), Source::Mesh("a@b/c@d.obj".into()));
        assert_eq!(source("x.ply@scale=3"), Source::Mesh("x.ply".into()));
        assert_eq!(source("x.toml"), Source::Definition("x.toml".into()));
        assert_eq!("x@scale=3".parse::<SceneSpec>().unwrap().suffix, "@scale=3");
        assert!("x@scale=".parse::<SceneSpec>().is_err());
    }
}
