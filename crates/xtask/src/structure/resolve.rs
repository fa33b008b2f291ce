//! Which modules of a crate a path leads to.

use std::collections::BTreeSet;

use super::modules::{ModuleId, Tree};

/// A name handed on more often than this runs in a circle of imports.
const MAX_HANDS: usize = 16;

/// The modules that `path`, written in `from`, depends on: the last one it names, and the one that defines
/// the item where the named module only hands it on. Paths to other crates lead to none.
pub fn targets(tree: &Tree, from: ModuleId, path: &[String]) -> BTreeSet<ModuleId> {
    let mut found = BTreeSet::new();
    // One word alone is a variable far more often than a module.
    if path.len() == 1 && tree.child(from, &path[0]).is_some() {
        return found;
    }
    follow(tree, from, path, MAX_HANDS, &mut found);
    found
}

/// Collects the modules where the path ends; whether it leads anywhere in this crate.
fn follow(
    tree: &Tree,
    from: ModuleId,
    path: &[String],
    hands: usize,
    found: &mut BTreeSet<ModuleId>,
) -> bool {
    let Some((at, rest)) = start(tree, from, path) else {
        return path.split_first().is_some_and(|(name, rest)| bound(tree, from, name, rest, hands, found));
    };
    walk(tree, at, rest, hands, found)
}

/// The module that a path begins at, and what follows; none where its first name is bound by an import.
fn start<'p>(tree: &Tree, from: ModuleId, path: &'p [String]) -> Option<(ModuleId, &'p [String])> {
    let (first, mut rest) = path.split_first()?;
    match first.as_str() {
        "crate" => Some((Tree::ROOT, rest)),
        "self" => Some((from, rest)),
        "super" => {
            let mut at = tree.parent(from)?;
            while rest.first().is_some_and(|name| name == "super") {
                at = tree.parent(at)?;
                rest = &rest[1..];
            }
            Some((at, rest))
        }
        name => tree.child(from, name).is_some().then_some((from, path)),
    }
}

/// Goes down from a module as far as names are modules, then through the import that binds the next name.
fn walk(
    tree: &Tree,
    mut at: ModuleId,
    path: &[String],
    hands: usize,
    found: &mut BTreeSet<ModuleId>,
) -> bool {
    let mut rest = path;
    while let Some((name, after)) = rest.split_first() {
        let Some(child) = tree.child(at, name) else { break };
        (at, rest) = (child, after);
    }
    if let Some((name, after)) = rest.split_first()
        && bound(tree, at, name, after, hands, found)
    {
        // Who hands a name on is named too, unless it is the face of all that it contains.
        if rest.len() < path.len() {
            found.insert(at);
        }
        return true;
    }
    found.insert(at);
    true
}

/// Follows `name`, bound by an import of the module at `at`, and the rest of the path from there.
fn bound(
    tree: &Tree,
    at: ModuleId,
    name: &str,
    rest: &[String],
    hands: usize,
    found: &mut BTreeSet<ModuleId>,
) -> bool {
    let Some(hands) = hands.checked_sub(1) else { return false };
    let imports = &tree.module(at).imports;
    if let Some(import) = imports.iter().find(|import| import.name.as_deref() == Some(name)) {
        let path = [&import.path, rest].concat();
        // `use a::a` or the name of another crate would come back to itself.
        return path.first().is_none_or(|first| first != name || import.path.len() > 1)
            && follow(tree, at, &path, hands, found);
    }
    let globs = imports.iter().filter(|import| import.name.is_none());
    for glob in globs {
        let Some((module, below)) = start(tree, at, &glob.path) else { continue };
        let Some(module) = descend(tree, module, below) else { continue };
        if module != at && has(tree, module, name, hands) {
            return walk(tree, module, &[&[name.to_owned()], rest].concat(), hands, found);
        }
    }
    false
}

/// The module at the end of a path all of whose names are modules.
fn descend(tree: &Tree, at: ModuleId, path: &[String]) -> Option<ModuleId> {
    path.iter().try_fold(at, |at, name| tree.child(at, name))
}

/// Whether a module offers a name: as a module, by an import or as an item.
fn has(tree: &Tree, module: ModuleId, name: &str, hands: usize) -> bool {
    let one = tree.module(module);
    tree.child(module, name).is_some()
        || one.items.contains(name)
        || one.imports.iter().any(|import| import.name.as_deref() == Some(name))
        || bound(tree, module, name, &[], hands, &mut BTreeSet::new())
}
