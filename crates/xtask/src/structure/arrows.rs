//! Arrows among the nodes of one folder, or among crates.

use std::collections::BTreeMap;
use std::fmt;

use super::modules::{ModuleId, Tree};
use super::resolve;

/// Which node names which, with one path that shows it and how many there are.
#[derive(Debug, Default)]
pub struct Arrows(BTreeMap<(String, String), Evidence>);

#[derive(Debug)]
struct Evidence {
    first: String,
    count: usize,
}

impl Arrows {
    /// One more path by which `from` names `to`.
    pub fn add(&mut self, from: &str, to: &str, path: &str) {
        let evidence = self
            .0
            .entry((from.to_owned(), to.to_owned()))
            .or_insert_with(|| Evidence { first: path.to_owned(), count: 0 });
        evidence.count += 1;
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// From and to of every arrow.
    pub fn pairs(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.keys().map(|(from, to)| (from.as_str(), to.as_str()))
    }

    /// The arrows that `keep` accepts, in words.
    pub fn lines(&self, keep: impl Fn(&str, &str) -> bool) -> Vec<String> {
        let kept = self.0.iter().filter(|((from, to), _)| keep(from, to));
        kept.map(|((from, to), evidence)| format!("{from} -> {to} ({})", evidence.first)).collect()
    }
}

impl fmt::Display for Arrows {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let mut last = "";
        for ((from, to), evidence) in &self.0 {
            if from == last {
                write!(f, ", ")?;
            } else {
                let break_before = if last.is_empty() { "" } else { "\n" };
                write!(f, "{break_before}  {from} -> ")?;
                last = from;
            }
            write!(f, "{to}")?;
            if evidence.count > 1 {
                write!(f, " ({})", evidence.count)?;
            }
        }
        writeln!(f)
    }
}

/// The arrows of every folder of a crate, by the folder's path: `""` for the root, `::check` for a module.
pub fn of_tree(tree: &Tree) -> BTreeMap<String, Arrows> {
    let mut folders: BTreeMap<String, Arrows> = BTreeMap::new();
    for (id, module) in tree.modules() {
        for path in &module.paths {
            for target in resolve::targets(tree, id, path) {
                if let Some((folder, from, to)) = siblings(tree, id, target) {
                    let arrows = folders.entry(tree.path(folder)).or_default();
                    arrows.add(&tree.module(from).name, &tree.module(to).name, &path.join("::"));
                }
            }
        }
    }
    folders
}

/// The innermost folder that holds both modules, and the two nodes of it that hold one each. None where one
/// module lies inside the other: a folder and its contents are one node of every folder further out.
fn siblings(tree: &Tree, from: ModuleId, to: ModuleId) -> Option<(ModuleId, ModuleId, ModuleId)> {
    let (a, b) = (tree.line_of(from), tree.line_of(to));
    let shared = a.iter().zip(&b).take_while(|(x, y)| x == y).count();
    Some((*a.get(shared.checked_sub(1)?)?, *a.get(shared)?, *b.get(shared)?))
}

#[cfg(test)]
mod tests {
    use super::super::cycles;
    use super::*;

    fn cycles_of(files: &[(&str, &str)]) -> Vec<String> {
        let tree = Tree::of_texts(files);
        let folders = of_tree(&tree);
        let faults = |(folder, arrows): (&String, &Arrows)| {
            cycles::of(arrows).into_iter().map(|cycle| format!("{folder}: {cycle}")).collect::<Vec<_>>()
        };
        folders.iter().flat_map(faults).collect()
    }

    fn only_ring_of(files: &[(&str, &str)]) -> String {
        let mut cycles = cycles_of(files);
        assert_eq!(cycles.len(), 1, "{cycles:?}");
        cycles.remove(0)
    }

    #[test]
    fn a_planted_ring_of_two_modules_is_found() {
        let lib = ("lib.rs", "mod a; mod b;");
        let a = ("a.rs", "use crate::b::B; pub struct A(B);");
        assert!(cycles_of(&[lib, a, ("b.rs", "pub struct B;")]).is_empty());
        for back in
            ["use super::a::A;", "fn f() -> crate::a::A {}", "fn f() { println!(\"{}\", crate::a::g()) }"]
        {
            let cycles = cycles_of(&[lib, a, ("b.rs", back)]);
            assert_eq!(cycles.len(), 1, "{back}: {cycles:?}");
            assert!(cycles[0].contains("b -> a"), "{cycles:?}");
        }
    }

    #[test]
    fn a_planted_ring_of_two_folders_is_found_though_no_two_files_make_one() {
        only_ring_of(&[
            ("lib.rs", "mod a; mod b;"),
            ("a/mod.rs", "mod x; mod y;"),
            ("a/x.rs", "use crate::b::p::P;"),
            ("a/y.rs", "pub struct Y;"),
            ("b/mod.rs", "pub mod p; mod q;"),
            ("b/p.rs", "pub struct P;"),
            ("b/q.rs", "use crate::a::y::Y;"),
        ]);
    }

    #[test]
    fn a_ring_inside_a_folder_is_found() {
        let ring = only_ring_of(&[
            ("lib.rs", "mod a;"),
            ("a/mod.rs", "mod x; mod y;"),
            ("a/x.rs", "use super::y::Y;"),
            ("a/y.rs", "use super::x::X;"),
        ]);
        assert!(ring.starts_with("::a: "), "{ring}");
    }

    #[test]
    fn a_ring_through_names_that_the_root_hands_on_is_found() {
        only_ring_of(&[
            ("lib.rs", "mod a; mod b; pub use a::A; pub use b::*;"),
            ("a.rs", "use crate::B; pub struct A;"),
            ("b.rs", "use crate::A; pub struct B;"),
        ]);
    }

    #[test]
    fn tests_may_look_anywhere() {
        let cycles = cycles_of(&[
            ("lib.rs", "mod a; mod b; #[cfg(test)] mod testing;"),
            ("a.rs", "use crate::b::B; #[cfg(test)] mod tests;"),
            ("a/tests.rs", "use crate::b::B;"),
            (
                "b.rs",
                "pub struct B; #[cfg(test)] mod tests { use crate::a::A; } #[cfg(test)] use crate::a::A;",
            ),
            ("testing.rs", "use crate::a::A;"),
        ]);
        assert!(cycles.is_empty(), "{cycles:?}");
    }
}
