//! The modules of one crate, as its files declare them.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use super::syntax::{self, Import, Written};

/// A module's place in its [`Tree`]; the root is the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ModuleId(usize);

/// One module, without its tests.
#[derive(Debug)]
pub struct Module {
    /// Its last name; empty for the root.
    pub name: String,
    /// Names that its `use` declarations bind.
    pub imports: Vec<Import>,
    /// Names that it defines.
    pub items: BTreeSet<String>,
    /// Every path written in it, `use` declarations included.
    pub paths: Vec<Vec<String>>,
    parent: Option<ModuleId>,
    children: Vec<ModuleId>,
    lines: usize,
}

/// All modules under one `lib.rs` or `main.rs`.
#[derive(Debug)]
pub struct Tree(Vec<Module>);

impl Tree {
    /// Root of the crate.
    pub const ROOT: ModuleId = ModuleId(0);

    /// Reads the file and every module that it declares, tests left out.
    ///
    /// # Errors
    /// Where a file can't be read or isn't Rust.
    pub fn read(entry: &Path) -> Result<Self, String> {
        let source = |path: &Path| fs::read_to_string(path).ok();
        Self::from_files(entry, &source)
    }

    fn from_files(entry: &Path, source: &dyn Fn(&Path) -> Option<String>) -> Result<Self, String> {
        let mut tree = Self(Vec::new());
        let folder = entry.parent().unwrap_or(Path::new("")).to_path_buf();
        tree.load(entry, &folder, String::new(), None, source)?;
        Ok(tree)
    }

    /// Takes in a file. `folder` is where the files of its children lie.
    fn load(
        &mut self,
        file: &Path,
        folder: &Path,
        name: String,
        parent: Option<ModuleId>,
        source: &dyn Fn(&Path) -> Option<String>,
    ) -> Result<(), String> {
        let text = source(file).ok_or_else(|| format!("cannot read {}", file.display()))?;
        let written = syntax::read(&text).map_err(|e| format!("{}: {e}", file.display()))?;
        self.add(written, folder, name, parent, source)
    }

    fn add(
        &mut self,
        written: Written,
        folder: &Path,
        name: String,
        parent: Option<ModuleId>,
        source: &dyn Fn(&Path) -> Option<String>,
    ) -> Result<(), String> {
        let id = ModuleId(self.0.len());
        if let Some(parent) = parent {
            self.0[parent.0].children.push(id);
        }
        let Written { imports, items, paths, inline, declared, lines } = written;
        self.0.push(Module { name, imports, items, paths, parent, children: Vec::new(), lines });
        for (name, inner) in inline {
            self.add(inner, &folder.join(&name), name, Some(id), source)?;
        }
        for declared in declared {
            let inner = folder.join(&declared.name);
            let beside: PathBuf = folder.join(format!("{}.rs", declared.name));
            let file = match declared.file {
                Some(file) => folder.join(file),
                None if source(&beside).is_some() => beside,
                None => inner.join("mod.rs"),
            };
            self.load(&file, &inner, declared.name, Some(id), source)?;
        }
        Ok(())
    }

    /// Every module with its place.
    pub fn modules(&self) -> impl Iterator<Item = (ModuleId, &Module)> {
        self.0.iter().enumerate().map(|(i, module)| (ModuleId(i), module))
    }

    /// The module at a place of this tree.
    pub fn module(&self, id: ModuleId) -> &Module {
        &self.0[id.0]
    }

    /// The module around this one.
    pub fn parent(&self, id: ModuleId) -> Option<ModuleId> {
        self.module(id).parent
    }

    /// The module of this name directly inside `id`.
    pub fn child(&self, id: ModuleId, name: &str) -> Option<ModuleId> {
        self.module(id).children.iter().copied().find(|child| self.module(*child).name == name)
    }

    /// From the root down to the module, both included.
    pub fn line_of(&self, id: ModuleId) -> Vec<ModuleId> {
        let mut line: Vec<ModuleId> = std::iter::successors(Some(id), |id| self.parent(*id)).collect();
        line.reverse();
        line
    }

    /// `::a::b`; empty for the root.
    pub fn path(&self, id: ModuleId) -> String {
        self.line_of(id)[1..].iter().map(|id| format!("::{}", self.module(*id).name)).collect()
    }

    /// Lines of all files, without those of tests.
    pub fn lines(&self) -> usize {
        self.0.iter().map(|module| module.lines).sum()
    }

    /// A crate given as file names and texts, the first of them its root.
    #[cfg(test)]
    pub fn of_texts(files: &[(&str, &str)]) -> Self {
        let text = |path: &Path| {
            let found = files.iter().find(|(name, _)| Path::new(name) == path);
            found.map(|(_, text)| (*text).to_owned())
        };
        Self::from_files(Path::new(files[0].0), &text).unwrap()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_beside_and_in_folders_are_found_and_tests_are_not_read() {
        let tree = Tree::of_texts(&[
            ("lib.rs", "mod a;\nmod b;\n#[cfg(test)]\nmod tests;\n"),
            ("a.rs", "mod inner;\n"),
            ("a/inner.rs", "mod flat { mod deep; }"),
            ("a/inner/flat/deep.rs", ""),
            ("b/mod.rs", "fn f() {}\n\n#[cfg(test)]\nmod tests {\n    fn g() {}\n}\n"),
        ]);
        let mut paths: Vec<String> = tree.modules().map(|(id, _)| tree.path(id)).collect();
        paths.sort();
        assert_eq!(paths, ["", "::a", "::a::inner", "::a::inner::flat", "::a::inner::flat::deep", "::b"]);
        // Two of the root, one each of a and inner, two of b.
        assert_eq!(tree.lines(), 6);
    }

    #[test]
    fn a_missing_file_is_named() {
        let error = Tree::from_files(Path::new("lib.rs"), &|path| {
            (path == Path::new("lib.rs")).then(|| "mod gone;".to_owned())
        });
        assert!(error.unwrap_err().contains("gone"));
    }
}
