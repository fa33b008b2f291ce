//! The scenes that the suite knows: the definitions under `scenes/`, part of the program, and those of a folder of
//! the user's.

use crate::definition::Definition;
use crate::error::SceneError;
use crate::folders;
use crate::near::near;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// File name and text of every definition, listed at build time.
static TEXTS: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/definitions.rs"));

static CATALOG: LazyLock<Catalog> = LazyLock::new(Catalog::load);

/// The definitions of the program, and those of the folder that goes before them.
struct Catalog {
    entries: Vec<Entry>,
    /// Files of the folder that hold no definition.
    broken: Vec<SceneError>,
}

impl Catalog {
    fn load() -> Self {
        let embedded = TEXTS.iter().map(|(file, text)| {
            Entry::read(file, Cow::Borrowed(text)).unwrap_or_else(|error| panic!("{error}"))
        });
        let mut catalog = Self { entries: embedded.collect(), broken: Vec::new() };
        if let Some(folder) = folders::scenes() {
            catalog.add(&folder);
        }
        catalog
    }

    /// Adds the definitions of a folder; one of a name that is known takes its place.
    fn add(&mut self, folder: &Path) {
        let io = |source| SceneError::Io { path: folder.to_owned(), source };
        let files = fs::read_dir(folder).and_then(|files| files.collect::<Result<Vec<_>, _>>()).map_err(io);
        let mut paths: Vec<PathBuf> = match files {
            Ok(files) => files.into_iter().map(|file| file.path()).collect(),
            Err(error) => return self.broken.push(error),
        };
        paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
        paths.sort();
        for path in paths {
            let text =
                fs::read_to_string(&path).map_err(|source| SceneError::Io { path: path.clone(), source });
            let origin = path.display().to_string();
            match text.and_then(|text| Entry::read(&origin, Cow::Owned(text))) {
                Ok(entry) => match self.entries.iter_mut().find(|known| known.head.id == entry.head.id) {
                    Some(known) => *known = entry,
                    None => self.entries.push(entry),
                },
                Err(error) => self.broken.push(error),
            }
        }
    }
}

/// What is wrong with the folder of definitions or with files in it, which are passed over.
pub fn broken_definitions() -> &'static [SceneError] {
    &CATALOG.broken
}

/// What a list says of a scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SceneInfo {
    /// The scene's name.
    pub id: String,
    /// The family with its numbers in braces, if any numbers will do: `small-{objects}`.
    pub family: Option<String>,
    /// `generated`, `mesh` (fetched at set-up) or `derived` (another scene transformed).
    pub kind: &'static str,
    /// What it shows.
    pub description: String,
    /// The one character that it tests.
    pub character: String,
    /// Who should suffer from it.
    pub suffers: String,
    /// Seed of the generator.
    pub seed: u64,
    /// Whether it is in the default set.
    pub default: bool,
    /// Where a mesh comes from; empty for generated scenes.
    pub source: String,
    /// The terms of a mesh; empty for generated scenes.
    pub licence: String,
    /// For a mesh, whether its file is on this machine.
    pub available: bool,
}

struct Entry {
    /// The file's name, or its path where it is none of the program's.
    file: String,
    text: Cow<'static, str>,
    head: Head,
}

/// The part of a definition that holds before a template's numbers are filled in.
#[derive(Deserialize)]
struct Head {
    id: String,
    description: String,
    character: String,
    #[serde(default)]
    suffers: String,
    #[serde(default = "one")]
    seed: u64,
    #[serde(default)]
    default: bool,
    #[serde(default)]
    members: Vec<String>,
    #[serde(default)]
    default_members: Vec<String>,
    file: Option<crate::definition::MeshFile>,
    base: Option<String>,
}

fn one() -> u64 {
    1
}

/// Every scene that lists show: definitions, and the named members of families.
pub fn list() -> Vec<SceneInfo> {
    let mut all: Vec<SceneInfo> = CATALOG
        .entries
        .iter()
        .flat_map(|entry| {
            let ids =
                if entry.is_family() { entry.head.members.clone() } else { vec![entry.head.id.clone()] };
            ids.into_iter().map(|id| entry.info(id))
        })
        .collect();
    all.sort_by(|a, b| a.id.cmp(&b.id));
    all
}

/// What is known of scene `id`.
///
/// # Errors
/// [`SceneError::Unknown`] with suggestions.
pub fn describe(id: &str) -> Result<SceneInfo, SceneError> {
    let entry = CATALOG.entries.iter().find(|entry| entry.matches(id).is_some());
    entry.map(|entry| entry.info(id.to_owned())).ok_or_else(|| unknown(id))
}

/// The definition of scene `id`, numbers of a family filled in.
///
/// # Errors
/// [`SceneError::Unknown`] with suggestions, [`SceneError::Definition`] for numbers that the
/// family can't use.
pub fn definition(id: &str) -> Result<Definition, SceneError> {
    // A definition's own name goes before a family that it would fit.
    let named = CATALOG.entries.iter().find(|entry| entry.head.id == id);
    let fitting = || CATALOG.entries.iter().find(|entry| entry.matches(id).is_some());
    let entry = named.or_else(fitting).ok_or_else(|| unknown(id))?;
    let mut text = entry.text.clone().into_owned();
    for (name, number) in entry.matches(id).unwrap_or_default() {
        text = text.replace(&format!("\"{{{name}}}\""), &number);
    }
    let bad = |reason| SceneError::Definition { origin: format!("`{id}` ({})", entry.file), reason };
    let mut definition = Definition::parse(&text).map_err(bad)?;
    id.clone_into(&mut definition.id);
    Ok(definition)
}

/// The error for an unknown scene, with the nearest known names.
pub fn unknown(id: &str) -> SceneError {
    let all = list();
    SceneError::Unknown { id: id.to_owned(), near: near(id, all.iter().map(|info| info.id.as_str())) }
}

impl Entry {
    fn read(file: &str, text: Cow<'static, str>) -> Result<Self, SceneError> {
        let head = toml::from_str(&text).map_err(|error| SceneError::Definition {
            origin: file.to_owned(),
            reason: error.to_string().trim_end().to_owned(),
        })?;
        Ok(Self { file: file.to_owned(), text, head })
    }

    fn is_family(&self) -> bool {
        self.head.id.contains('{')
    }

    fn info(&self, id: String) -> SceneInfo {
        let head = &self.head;
        let file = head.file.as_ref();
        let kind = match (file, &head.base) {
            (Some(_), _) => "mesh",
            (None, Some(_)) => "derived",
            (None, None) => "generated",
        };
        SceneInfo {
            family: self.is_family().then(|| head.id.clone()),
            kind,
            description: head.description.clone(),
            character: head.character.clone(),
            suffers: head.suffers.clone(),
            seed: head.seed,
            default: head.default || head.default_members.contains(&id),
            source: file.map(|file| file.source.clone()).unwrap_or_default(),
            licence: file.map(|file| file.licence.clone()).unwrap_or_default(),
            available: file.is_none_or(|file| crate::reader::find(&file.name).is_some()),
            id,
        }
    }

    /// The numbers that turn this entry's name into `id`; none for a plain name.
    fn matches(&self, id: &str) -> Option<Vec<(String, String)>> {
        let mut rest = id;
        let mut numbers = Vec::new();
        for (i, piece) in self.head.id.split(['{', '}']).enumerate() {
            if i % 2 == 0 {
                rest = rest.strip_prefix(piece)?;
            } else {
                let (word, behind) = rest.split_at(rest.find('-').unwrap_or(rest.len()));
                numbers.push((piece.to_owned(), number(word)?));
                rest = behind;
            }
        }
        rest.is_empty().then_some(numbers)
    }
}

/// `10k` → 10000, `2m` → 2000000, `m100` → -100, `p100` → 100.
fn number(word: &str) -> Option<String> {
    let (sign, word) = match word.as_bytes().first()? {
        b'm' => ("-", &word[1..]),
        b'p' => ("", &word[1..]),
        _ => ("", word),
    };
    let (digits, zeros) = match word.as_bytes().last()? {
        b'k' => (&word[..word.len() - 1], "000"),
        b'm' => (&word[..word.len() - 1], "000000"),
        _ => (word, ""),
    };
    let is_number = !digits.is_empty() && digits.len() <= 12 && digits.bytes().all(|b| b.is_ascii_digit());
    let digits = match digits.trim_start_matches('0') {
        "" => "0",
        digits => digits,
    };
    is_number.then(|| format!("{sign}{digits}{zeros}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_goes_before_the_program() {
        let folder = tempfile::tempdir().unwrap();
        let own = "id = \"stadium\"\ndescription = \"mine\"\ncharacter = \"few\"\nbase = \"unit-one\"\n";
        fs::write(folder.path().join("anything.toml"), own).unwrap();
        fs::write(folder.path().join("slip.toml"), "id = 3").unwrap();
        let mut catalog = Catalog { entries: Vec::new(), broken: Vec::new() };
        catalog.entries.push(Entry::read("stadium.toml", Cow::Owned(own.replace("mine", "first"))).unwrap());
        catalog.add(folder.path());
        assert_eq!(catalog.entries.len(), 1);
        assert_eq!(catalog.entries[0].head.description, "mine");
        assert!(catalog.broken[0].to_string().contains("slip.toml"), "{}", catalog.broken[0]);
        catalog.add(&folder.path().join("none"));
        assert!(matches!(catalog.broken[1], SceneError::Io { .. }));
    }

    #[test]
    fn numbers_of_families() {
        for (word, value) in
            [("10k", "10000"), ("2m", "2000000"), ("m100", "-100"), ("p7", "7"), ("0", "0"), ("007", "7")]
        {
            assert_eq!(number(word).as_deref(), Some(value));
        }
        for word in ["", "k", "m", "10x", "1e5", "-5", "ten", "9999999999999"] {
            assert_eq!(number(word), None, "{word}");
        }
    }

    #[test]
    fn every_listed_scene_has_a_sound_definition() {
        let all = list();
        assert!(all.len() > 40, "{}", all.len());
        for info in &all {
            let definition = definition(&info.id).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(definition.id, info.id);
            assert_eq!(describe(&info.id).unwrap(), *info);
        }
        for pair in all.windows(2) {
            assert_ne!(pair[0].id, pair[1].id);
        }
    }

    #[test]
    fn slips_get_suggestions() {
        let SceneError::Unknown { near, .. } = unknown("stadum") else { panic!() };
        assert_eq!(near[0], "stadium");
        assert!(definition("small-10k").is_ok() && definition("small-12345").is_ok());
        for id in ["small-", "small-x", "small-10k-5", "boxes-10", ""] {
            assert!(matches!(definition(id), Err(SceneError::Unknown { .. })), "{id}");
        }
    }

    #[test]
    fn default_members_are_members() {
        for entry in CATALOG.entries.iter() {
            assert!(
                entry.head.default_members.iter().all(|id| entry.head.members.contains(id)),
                "{}",
                entry.file
            );
            assert_eq!(entry.is_family(), !entry.head.members.is_empty(), "{}", entry.file);
        }
    }
}
